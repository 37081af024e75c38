// What the page knows of a scene: values of the effective one, and numbers that `uncross check` prints.
import {load} from './packages/js-yaml/js-yaml.mjs';

/** The effective scene as an object. The seed stays a text, since it may have 64 bits. */
export function values_of(text) {
  const values = load(text) ?? {};
  values.seed = /^seed: *([0-9]+)/m.exec(text)?.[1] ?? '1';
  return values;
}

/** The value at a path such as `fibers.0.count`; undefined if there is none. */
export const value_at = (values, path) => path.split('.').reduce((value, key) => value?.[key], values);

/** A value as the library reads it. */
export const as_text = value => Array.isArray(value) ? `[${value.join(', ')}]` : String(value);

/**
 * The number that `uncross check` prints in the row of this name; of a kind of fibers if `kind` is given, NaN if there
 * is no such row. Rows are `name  symbol  number unit  note`; kinds begin with `Fibers 'name'`.
 */
export function number_of(check, name, kind) {
  let within = kind === undefined;
  for (const line of check.split('\n')) {
    if (/^\S/.test(line)) within = kind === undefined || line.startsWith(`Fibers '${kind}'`);
    const row = line.trim();
    if (!within || !row.startsWith(name)) continue;
    const found = /^\s{2,}(?:\S+(?: [+\-] \S+)?\s{2,})?(-?[0-9.]+(?:e[-+]?[0-9]+)?)/.exec(row.slice(name.length));
    if (found) return Number(found[1]);
  }
  return NaN;
}

/** Cadences that the plots ask for where the scene has none, or a slower one. They do not touch the state's bits. */
export function wanted_tables(values) {
  const observe = values.observe ?? {}, every = Math.max(1, Math.round(0.2 / values.time_step));
  const fibers = (values.fibers ?? []).some(kind => kind.vertices > 1);
  const flows = values.walls || values.shear || values.solvent?.profile !== 'uniform';
  const wanted = [['conserved', every], ['temperature', every]];
  if (fibers) wanted.push(['orientation', every], ['statics', every], ['dynamics', every]);
  if (fibers && values.crossing?.forbidden) wanted.push(['collisions', every]);
  if (values.solvent && flows) wanted.push(['profile', every], ['stress', every]);
  if (values.bead) wanted.push(['bead', every]);
  return wanted.filter(([name, cadence]) => !(observe[name]?.every <= cadence)).map(([name, cadence]) =>
    [[`observe.${name}.every`, String(cadence)], ...(name === 'profile' && !observe.profile ? [['observe.profile.slabs', String(values.box[1])]] : [])]);
}

/** What a scene file says by itself, without defaults; {} if it cannot be read. */
export function written(text) {
  try { return load(text) ?? {}; } catch { return {}; }
}

/** The text that is run: in a sheared box fibers have no displacements, so the line that asks for them is left out. */
export const fitting = (text, settings) => [...settings].some(([path, value]) => path.startsWith('shear.') && value !== '0') ?
  text.replace(/^ +dynamics: *\{[^}\n]*\}.*\n/m, '') : text;

/** Lines of what `uncross check` prints: {name, value, more: symbol and remark} of a quantity, {name} of others. Columns are two spaces apart or more. */
export function lines_of_check(check) {
  return check.split('\n').map(line => {
    const [name, ...rest] = line.trim().split(/ {2,}/), value = rest.slice(0, 2).findIndex(words => /^-?[0-9.]+(e[-+]?[0-9]+)?( |$)/.test(words));
    return value < 0 ? {name: line} : {name: line.match(/^ */)[0] + name, value: rest[value], more: rest.filter((_, at) => at !== value).join(', ')};
  });
}
