// What can be changed, as rows: keys of docs/scene.md, values to choose from, and what to watch for.
import {value_at, as_text} from './scene.js';

/**
 * @typedef {{label: string, settings: [string, string][]}} Option   what an option sets
 * @typedef {object} Choice
 * @property {string} id
 * @property {string} label
 * @property {string} watch        one sentence: what to watch for
 * @property {'few'|'slide'} look  radio buttons, or a slider over the options
 * @property {string} [unit]
 * @property {(values: object) => string|null} absent  why a scene cannot have it, in words; null if it may
 * @property {(values: object, base: object) => Option[]} options   base: values of the scene without settings
 * @property {(values: object) => string} now  label of the option that holds
 */

const fibers = values => values.fibers?.length ? null : 'This scene has no fibers.';
const solvent = values => values.solvent ? null : 'This scene has no solvent.';
const number = value => String(Number(Number(value).toPrecision(6)));

/** Options of a slider that sets one path to each number; the base's own number is always among them. */
function slide(path, numbers, base, write = number) {
  const all = [...new Set([...numbers, base].filter(Number.isFinite).map(value => Number(number(value))))].sort((a, b) => a - b);
  return all.map(value => ({label: number(value), settings: [[path, write(value)]]}));
}

const shear_path = values => values.walls ? 'walls.shear_rate' : 'shear.rate';
function shear_now(values) {
  if (values.shear) return values.shear.rate ?? 0;
  if (!values.walls) return 0;
  return values.walls.shear_rate ?? ((values.walls.upper?.[0] ?? 0) - (values.walls.lower?.[0] ?? 0)) / values.box[1];
}

/** @type {Choice[]} */
export const choices = [
  {id: 'hydrodynamics', label: 'Hydrodynamics', look: 'few', absent: solvent,
   watch: 'Without them the solvent still rubs, but carries no flow from fiber to fiber. Fibers then move less at short times.',
   options: () => [{label: 'on', settings: [['solvent.hydrodynamics', 'true']]}, {label: 'off', settings: [['solvent.hydrodynamics', 'false']]}],
   now: values => values.solvent.hydrodynamics ? 'on' : 'off'},
  {id: 'crossing', label: 'Crossing', look: 'few', absent: fibers,
   watch: 'The paper’s rule rejects moves and heats; the event-driven rule lets bonds bounce and keeps the energy. Watch the energy plot.',
   options: () => [
     {label: 'free', settings: [['crossing.forbidden', 'false']]},
     {label: 'the paper’s rule', settings: [['crossing.forbidden', 'true'], ['crossing.rule', 'sequential']]},
     {label: 'event-driven', settings: [['crossing.forbidden', 'true'], ['crossing.rule', 'event-driven']]}],
   now: values => !values.crossing?.forbidden ? 'free' : values.crossing.rule === 'sequential' ? 'the paper’s rule' : 'event-driven'},
  {id: 'count', label: 'Number of fibers', look: 'slide', absent: fibers,
   watch: 'More fibers make a narrower tube and more contacts. Contacts grow as the square of the number.',
   options: (values, base) => {
     const most = value_at(base, 'fibers.0.count');
     const all = [.05, .1, .2, .3, .4, .5, .6, .8, 1, 1.25, 1.5, 2].map(part => Math.max(1, Math.round(part * most)));
     return slide('fibers.0.count', all, value_at(values, 'fibers.0.count'));
   },
   now: values => number(value_at(values, 'fibers.0.count'))},
  {id: 'stiffness', label: 'Bending stiffness', look: 'slide', unit: 'kT', absent: fibers,
   watch: 'Stiff fibers are rods and turn slowly. At 0 they coil up. The tube is narrower for stiff ones.',
   options: (values, base) => {
     // A scene that gives persistence_length takes no bending: bending is persistence_length over bond_length.
     const lengths = base.written?.fibers?.[0]?.persistence_length !== undefined, bond = value_at(base, 'fibers.0.bond_length');
     return slide(lengths ? 'fibers.0.persistence_length' : 'fibers.0.bending', [0, 1, 2, 4, 8, 16, 32, 64, 128], value_at(base, 'fibers.0.bending'),
       value => number(lengths ? value * bond : value));
   },
   now: values => number(value_at(values, 'fibers.0.bending'))},
  {id: 'density', label: 'Solvent particles per cell', look: 'slide', absent: solvent,
   watch: 'More particles make a heavier and more viscous fluid, and a slower run.',
   options: (values, base) => slide('solvent.per_cell', [2, 3, 5, 8, 10, 15, 20], value_at(base, 'solvent.per_cell')),
   now: values => number(values.solvent.per_cell)},
  {id: 'shear', label: 'Shear rate', look: 'slide', unit: '1/t₀', absent: () => null,
   watch: 'Walls, or else the images above and below, slide. Fibers turn into the flow; the profile is a line.',
   options: (values, base) => slide(shear_path(base), [0, .01, .02, .05, .1, .2, .4], shear_now(base)),
   now: values => number(shear_now(values))},
  {id: 'acceleration', label: 'Force on the solvent, along x', look: 'slide', unit: 'a₀/t₀²', absent: solvent,
   watch: 'Between walls the flow becomes a parabola; with a sine profile it becomes a sine. In an open box all of it speeds up.',
   options: (values, base) => slide('solvent.acceleration', [0, .003, .01, .02, .05, .1, .2], base.solvent?.acceleration?.[0] ?? 0,
     value => as_text([value, ...(base.solvent?.acceleration ?? [0, 0, 0]).slice(1)])),
   now: values => number(values.solvent.acceleration?.[0] ?? 0)},
  {id: 'thermostat', label: 'Collisions and thermostat', look: 'few', absent: solvent,
   watch: 'Without a thermostat the total energy is kept. With one the temperature stays at 1, and hides what a rule heats.',
   options: () => [
     {label: 'SRD, none', settings: [['solvent.rule', 'srd'], ['solvent.thermostat', 'none']]},
     {label: 'SRD, rescale', settings: [['solvent.rule', 'srd'], ['solvent.thermostat', 'rescale']]},
     {label: 'SRD, Maxwell–Boltzmann', settings: [['solvent.rule', 'srd'], ['solvent.thermostat', 'maxwell-boltzmann']]},
     {label: 'Andersen (AT−a)', settings: [['solvent.rule', 'at-a'], ['solvent.thermostat', 'none']]}],
   now: values => values.solvent.rule === 'at-a' ? 'Andersen (AT−a)' : values.solvent.rule !== 'srd' ? values.solvent.rule :
     {none: 'SRD, none', rescale: 'SRD, rescale', 'maxwell-boltzmann': 'SRD, Maxwell–Boltzmann'}[values.solvent.thermostat] ?? values.solvent.thermostat},
  {id: 'time-step', label: 'Time step dt', look: 'slide', unit: 't₀', absent: () => null,
   watch: 'A longer step is faster and worse: the energy of stiff bonds oscillates, and the paper’s rule heats more.',
   options: (values, base) => slide('time_step', [.25, .5, 1, 2, 4].map(part => part * base.time_step), base.time_step),
   now: values => number(values.time_step)},
];
