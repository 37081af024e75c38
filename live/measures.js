// What the plots show, as rows: each makes series from the library's tables, and lines from what `uncross check` prints.
import {number_of} from './scene.js';
import {mean_and_error, running_means} from './averages.js';

/**
 * @typedef {{label: string, x: number[], y: number[], error?: number[], role: 'main'|'second'|'faint'|'theory', points?: boolean}} Series
 * @typedef {{series: Series[], now?: string}} Drawing
 * A measure's `see` is its sentence, or a function of the values of the scene that makes it.
 *
 * @typedef {object} Source
 * @property {(name: string) => {[column: string]: number[]}|null} table   columns of a table; null if there is none
 * @property {(name: string, key: string, at: number[]) => number[][]} past  adds a row to a history and returns its columns
 * @property {object} values     of the effective scene
 * @property {string} check      what `uncross check` prints
 * @property {string} kind       name of the kind of the marked fiber
 * @property {number} time       t0
 * @property {object} info       of the worker
 */

const short = (value, digits = 3) => Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : '–';
const with_error = (value, error) => Number.isFinite(error) && error > 0 ? `${value.toFixed(Math.max(0, Math.min(6, 1 - Math.floor(Math.log10(error)))))} ± ${short(error, 2)}` : short(value);
const level = (label, value, x) => Number.isFinite(value) && x.length ? [{label, x: [x[0], x.at(-1)], y: [value, value], role: 'theory'}] : [];
const thermostat = values => values.solvent && (values.solvent.rule !== 'srd' || values.solvent.thermostat !== 'none') || values.medium;
const driven = values => values.shear || values.walls?.upper?.some(Boolean) || values.walls?.lower?.some(Boolean) || values.solvent?.acceleration?.some(Boolean) || values.bead?.drive;
const begins = source => (source.values.observe?.from ?? 0) * source.values.time_step;

/** Where the scene has a flow along x whose profile is known: its velocity at y, and its name. */
function profile_theory({values, check}) {
  const [, height] = values.box, rate = values.shear?.rate, driven = values.solvent?.acceleration?.[0] ?? 0;
  if (values.shear?.period || values.walls?.period || values.fibers) return null;
  if (values.shear) return y => rate * (y - height / 2);
  if (!values.walls) {
    const largest = number_of(check, 'largest velocity');
    return values.solvent?.profile === 'sine' && Number.isFinite(largest) ? y => largest * Math.sin(2 * Math.PI * y / height) : null;
  }
  const slip = number_of(check, 'slip length'), density = values.solvent.per_cell, viscosity = number_of(check, 'viscosity');
  const effective = number_of(check, 'effective shear rate');
  const drag = driven ? density * driven / (2 * viscosity) : 0, middle = ((values.walls.upper?.[0] ?? 0) + (values.walls.lower?.[0] ?? 0)) / 2;
  return y => middle + (Number.isFinite(effective) ? effective * (y - height / 2) : 0) + drag * (y * (height - y) + (slip || 0) * height);
}

export const measures = [
  {id: 'energy', title: 'Total energy', x: 'time, t₀', y: 'kT per particle',
   see: values => driven(values) ? 'Whatever drives the flow puts energy in; a thermostat takes it out.' :
     thermostat(values) ? 'The thermostat takes energy and gives it, and hides what a rule heats.' :
     values.fibers && values.crossing?.forbidden ? 'Nothing takes energy away here. The event-driven rule keeps it; the paper’s rule heats.' :
       'Nothing takes energy away here, and nothing heats.',
   draw(source) {
     const rows = source.table('conserved');
     if (!rows?.total?.length) return null;
     const members = source.info.vertices + source.info.particles || 1, y = rows.total.map(total => (total - rows.total[0]) / members);
     const bounces = source.table('collisions'), hits = bounces?.executed?.at(-1);
     const heat = hits > 0 && !driven(source.values) && !thermostat(source.values) ? ` ${short((rows.total.at(-1) - rows.total[0]) / hits, 2)} kT for each contact.` : '';
     return {series: [{label: 'change of the total energy', x: rows.time, y, role: 'main'}], now: `Now ${short(y.at(-1))} kT per particle.${heat}`};
   }},
  {id: 'temperature', title: 'Temperature', x: 'time, t₀', y: 'kT', see: 'Both wobble about 1. Few vertices wobble more than many particles.',
   draw(source) {
     const rows = source.table('temperature');
     if (!rows?.time.length) return null;
     const series = [['solvent', 'main'], ['vertex', 'second']].filter(([name]) => rows[name]).map(([name, role]) => ({label: name === 'vertex' ? 'vertices' : name, x: rows.time, y: rows[name], role}));
     return {series: [...series, ...level('kT = 1', 1, rows.time)], now: series.map(one => `${one.label} ${with_error(...mean_and_error(one.y))}`).join(', ')};
   }},
  {id: 'contacts', title: 'Contacts per t₀', x: 'time, t₀', y: '1/t₀', see: 'How often bonds touch. The dashed line is kinetic theory: an ideal gas of bonds, with nothing fitted.',
   draw(source) {
     const rows = source.table('collisions');
     if (!rows?.executed || rows.time.length < 2) return null;
     const rate = rows.executed.map((all, at) => at ? (all - rows.executed[at - 1]) / (rows.time[at] - rows.time[at - 1]) : NaN);
     const mean = running_means(rows.time.slice(1), rate.slice(1)), theory = number_of(source.check, '... that the rule answers');
     const thick = source.values.fibers?.some(kind => kind.diameter > 0);
     const lines = thick ? [] : level('kinetic theory of lines', theory, rows.time);
     return {series: [{label: 'since the row before', x: rows.time, y: rate, role: 'faint'}, {label: 'mean since the start', ...mean, role: 'main', points: true}, ...lines],
       now: mean.y.length ? `Mean ${with_error(mean.y.at(-1), mean.error.at(-1))}${lines.length ? `; theory ${short(theory)}` : ''}` : ''};
   }},
  {id: 'tube', title: 'd²(t): does a tube hold the fiber?', x: 'lag t, t₀', y: 'a₀²', log: true,
   see: 'How far the middle of a fiber moves off its old contour. Fibers that may cross go on. In a crowd d² bends near the line 2L⊥².',
   draw(source) {
     const rows = source.table(`dynamics-${source.kind}`);
     if (!rows?.d2_third?.length) return null;
     const line = number_of(source.check, 'tube plateau of d^2(t)', source.kind);
     return {series: [{label: 'd² to the nearest vertex', x: rows.time, y: rows.d2, error: rows.d2_error, role: 'main', points: true},
       {label: 'd² to the contour', x: rows.time, y: rows.d2_third, error: rows.d2_third_error, role: 'second', points: true},
       ...level('2L⊥² of Eq. (35)', line, rows.time)],
       now: `At the lag ${short(rows.time.at(-1))} t₀: ${with_error(rows.d2.at(-1), rows.d2_error.at(-1))} a₀²${Number.isFinite(line) ? `; 2L⊥² is ${short(line)}` : ''}`};
   }},
  {id: 'motion', title: 'g(t): how far fibers move', x: 'lag t, t₀', y: 'a₀²', log: true,
   see: 'Mean square displacement of vertices and of centers of mass. Free flight at first (slope 2), diffusion at the end (slope 1).',
   draw(source) {
     const rows = source.table(`dynamics-${source.kind}`);
     if (!rows?.g?.length) return null;
     return {series: [{label: 'vertices', x: rows.time, y: rows.g, error: rows.g_error, role: 'main', points: true},
       {label: 'centers of mass', x: rows.time, y: rows.g_cm, error: rows.g_cm_error, role: 'second', points: true}]};
   }},
  {id: 'profile', title: 'Profile of the flow', x: 'y, a₀', y: 'velocity along x, a₀/t₀', see: 'Mean velocity of the solvent in slabs. Error bars shrink as samples come in.',
   draw(source) {
     const rows = source.table('profile');
     if (!rows?.vx?.some(Number.isFinite)) return null;
     const theory = profile_theory(source), height = source.values.box[1], at = Array.from({length: 41}, (_, step) => step * height / 40);
     return {series: [{label: 'measured', x: rows.y, y: rows.vx, error: rows.vx_error, role: 'main', points: true},
       ...(theory ? [{label: 'theory', x: at, y: at.map(theory), role: 'theory'}] : [])],
       now: rows.samples ? `${rows.samples[0]} samples` : ''};
   }},
  {id: 'stress', title: 'Shear stress', x: 'time, t₀', y: 'kT/a₀³', see: 'Stress over shear rate is the viscosity. The mean comes to rest, and its error shrinks.',
   draw(source) {
     const rows = source.table('stress');
     if (!rows?.sigma_xy || !(source.values.shear || Number.isFinite(number_of(source.check, 'effective shear rate')))) return null;
     const kept = rows.time.map((time, at) => at).filter(at => rows.time[at] >= begins(source)), x = kept.map(at => rows.time[at]), y = kept.map(at => rows.sigma_xy[at]);
     const mean = running_means(x, y), theory = number_of(source.check, 'shear stress');
     if (!mean.y.length) return null;
     return {series: [{label: 'mean', ...mean, role: 'main', points: true}, ...level(source.values.fibers ? 'theory of the solvent alone' : 'theory', theory, mean.x)],
       now: `Mean ${with_error(mean.y.at(-1), mean.error.at(-1))}${Number.isFinite(theory) ? `; theory ${short(theory)}` : ''}`};
   }},
  {id: 'order', title: 'Order of the bonds', x: 'time, t₀', y: 'S', see: 'S is 1 where all bonds are parallel, and near 0 where they point anywhere.',
   draw(source) {
     const rows = source.table(`orientation-${source.kind}`);
     if (!Number.isFinite(rows?.S?.[0])) return null;
     const [x, y, error] = source.past('order', source.kind, [source.time, rows.S[0], rows.S_error?.[0] ?? NaN]);
     return {series: [{label: 'mean since the start', x, y, error, role: 'main', points: true}], now: `S = ${with_error(y.at(-1), error.at(-1))}`};
   }},
  {id: 'angle', title: 'Angle with the flow', x: 'time, t₀', y: 'degrees', see: 'The longer axis of the fibers’ directions. At 0 they lie along the flow; at rest it is noise.',
   draw(source) {
     const rows = source.table(`orientation-${source.kind}`);
     if (!Number.isFinite(rows?.chi?.[0]) || !(source.values.shear || source.values.walls)) return null;
     const [x, y, error] = source.past('angle', source.kind, [source.time, rows.chi[0], rows.chi_error?.[0] ?? NaN]);
     return {series: [{label: 'mean since the start', x, y, error, role: 'main', points: true}], now: `${with_error(y.at(-1), error.at(-1))} degrees`};
   }},
  {id: 'springs', title: 'Extension of dumbbells', x: 'time, t₀', y: 'R/R₀', see: 'The flow stretches springs. Theory has the square root of 1 + (2/d) Wi².',
   draw(source) {
     const rows = source.table('dumbbells');
     if (!Number.isFinite(rows?.extension?.[0])) return null;
     const [x, y, error] = source.past('springs', '', [source.time, rows.extension[0], rows.extension_error?.[0] ?? NaN]);
     return {series: [{label: 'mean', x, y, error, role: 'main', points: true}, ...level('theory', number_of(source.check, 'extension'), x)], now: `R/R₀ = ${with_error(y.at(-1), error.at(-1))}`};
   }},
  {id: 'bead', title: 'Place of the bead', x: 'time, t₀', y: 'x, a₀', see: 'The bead follows its trap, late by its friction.',
   draw(source) {
     const rows = source.table('bead');
     if (!rows?.place_x?.length) return null;
     const trapped = source.values.bead?.drive?.spring;
     return {series: [{label: 'bead', x: rows.time, y: rows.place_x, role: 'main'}, ...(trapped ? [{label: 'middle of the trap', x: rows.time, y: rows.trap_x, role: 'second'}] : [])]};
   }},
];
