// Exercises of docs/course.md that run in the page, as rows: the line that changes, what is read off, and what was measured with docs/exercises/measure.

/** Column of a table by its name. */
const column = (tables, name, of) => {
  const table = tables.find(one => one.name === name), at = table?.columns.indexOf(of) ?? -1;
  return at < 0 ? [] : Array.from({length: table.rows}, (_, row) => table.value[row * table.columns.length + at]);
};
const last = list => list.at(-1);
const mean = list => list.reduce((sum, x) => sum + x, 0) / list.length;
const nearest = (list, value) => list.reduce((best, x, at) => Math.abs(x - value) < Math.abs(list[best] - value) ? at : best, 0);

/** Slope of v_x over y in the middle six tenths of the gap, as docs/exercises/measure takes it. */
function bulk_rate(tables) {
  const y = column(tables, 'profile', 'y'), v = column(tables, 'profile', 'vx'), middle = (y[0] + y.at(-1)) / 2, reach = 0.3 * 20;
  const inside = y.map((_, at) => at).filter(at => Math.abs(y[at] - middle) < reach), [ym, vm] = [mean(inside.map(at => y[at])), mean(inside.map(at => v[at]))];
  return inside.reduce((sum, at) => sum + (y[at] - ym) * (v[at] - vm), 0) / inside.reduce((sum, at) => sum + (y[at] - ym) ** 2, 0);
}

/**
 * number: of docs/course.md (name: where an entry has two). before, after: {label, settings, seen}; seen is what docs/course.md says, shown when it is unfolded.
 * Of the scatter with a thermostat it says 1.00006(11), the mean of eight runs: 0.00011 √8 = 0.0003.
 * value(tables): one number of a run. curve(tables): {x, y} of a run. theory: rows {label, value}. unit: of the value.
 */
export const lessons = [
  {number: 1, name: '1 and 2', title: 'What decides the temperature?', scene: 'solvent', steps: 400, seeds: 8,
   question: 'A solvent without a thermostat, and the same with thermostat: rescale. Each seed draws other velocities. What is the standard deviation of the temperatures of the runs, without and with it?',
   guess: 'Standard deviation without the thermostat (kT)', scatter: true,
   before: {label: 'thermostat: none', settings: [], seen: '0.0042'}, after: {label: 'thermostat: rescale', settings: ['solvent.thermostat=rescale'], seen: '0.0003'},
   quantity: 'kT of the solvent, mean of the second half',
   value: tables => { const kept = column(tables, 'temperature', 'solvent'); return mean(kept.slice(Math.ceil(kept.length / 2))); },
   see: 'Without a thermostat kT is decided by the velocities drawn at the start. 3N velocities scatter by √(2/3N) = 0.0057 (N = 20,480), and each run keeps its own. With the thermostat all are 1.0001 within 0.0004 or so. A diffusion coefficient D is proportional to kT, so quote D/kT instead of D. A standard deviation from 8 runs is itself uncertain by a quarter.'},
  {number: 4, title: 'The order of a step', scene: 'dumbbells', steps: 40000, seeds: 2,
   question: 'Three schemes are “leap-frog plus collisions”. What is the energy after 400 t₀, over that at the start, with kick-split, and with the paper’s scheme?',
   guess: 'Energy with the paper’s scheme, over that at the start',
   before: {label: 'order: kick-split', settings: [], seen: '1.000000(1)'}, after: {label: 'order: paper', settings: ['order=paper'], seen: '1.86(1)'},
   quantity: 'energy at the end over energy at the start', axis: ['time, t₀', 'energy over that of the start'],
   value: tables => { const total = column(tables, 'conserved', 'total'); return last(total) / total[0]; },
   curve: tables => { const total = column(tables, 'conserved', 'total'); return {x: column(tables, 'conserved', 'time'), y: total.map(one => one / total[0])}; },
   see: '1.000000(1), and 1.86(1) with the paper’s scheme. It collides velocities of half a step ago at the present positions. This removes the correlation between velocities and positions by which a leap-frog conserves energy.'},
  {number: 7, title: 'May fibers cross?', scene: 'crowd', steps: 4000, seeds: 2,
   question: 'A crowd of stiff fibers, once forbidden to cross and once not. How far does the middle of a fiber move off its old contour in 19.2 t₀, as d² in a₀²?',
   guess: 'd² where fibers may cross (a₀²)',
   before: {label: 'forbidden: true', settings: [], seen: '0.099(2)'}, after: {label: 'forbidden: false', settings: ['crossing.forbidden=false'], seen: '0.116(1)'},
   quantity: 'd² to the contour after 19.2 t₀, a₀²', axis: ['lag, t₀', 'd² to the contour, a₀²'], log: true, theory: [{label: '2L⊥² of Eq. (35)', value: 0.14}],
   value: tables => column(tables, 'dynamics-fiber', 'd2_contour')[nearest(column(tables, 'dynamics-fiber', 'time'), 19.2)],
   curve: tables => ({x: column(tables, 'dynamics-fiber', 'time'), y: column(tables, 'dynamics-fiber', 'd2_contour')}),
   see: 'At 0.8 t₀ both are 0.0118: fibers have not met yet. At 19.2 t₀ it is 0.099(2) with the rule and 0.116(1) without, on the way to a tube: Eq. (35) gives 2L⊥² = 0.14. ⟨R²⟩ is the same in both, because a line has no volume.'},
  {number: 8, title: 'Half the time step', scene: 'crowd', steps: 2000, seeds: 2,
   question: 'The paper’s rule heats: a rejected vertex stays behind. How much of the heat of a rejected move is left at half the time step?',
   guess: 'Heat at half the step (kT)',
   before: {label: 'time_step: 0.01', settings: [], seen: '0.0121(3)'}, after: {label: 'time_step: 0.005', settings: ['time_step=0.005'], steps: 4000, seen: '0.0032(1)'},
   quantity: 'heat of a rejected move, kT', axis: ['time, t₀', 'energy gained, kT'],
   value: tables => { const total = column(tables, 'conserved', 'total'); return (last(total) - total[0]) / last(column(tables, 'collisions', 'executed')); },
   curve: tables => { const total = column(tables, 'conserved', 'total'); return {x: column(tables, 'conserved', 'time'), y: total.map(one => one - total[0])}; },
   see: '0.0121(3) and 0.0032(1) kT, a factor of 3.8(1): dt². So half the step leaves a quarter of the heat. The number of rejected moves per t₀ does not change. (The rule event-driven hardly heats at all: try it in the controls.)'},
  {number: 10, title: 'A softer spring', scene: 'dumbbells', steps: 2000, seeds: 12,
   question: 'Two vertices on a spring without a rest length, 64 times. The spring constant falls from 100 to 25. What is ⟨l²⟩, the mean square of its length l?',
   guess: '⟨l²⟩ with spring: 25 (a₀²)',
   before: {label: 'spring: 100', settings: [], seen: '0.0300(2)'}, after: {label: 'spring: 25', settings: ['fibers.0.spring=25'], seen: '0.1202(5)'},
   quantity: '⟨l²⟩, a₀²', theory: [{label: '3kT/100', value: 0.03}, {label: '3kT/25', value: 0.12}],
   value: tables => column(tables, 'statics-dumbbell', 'l2')[0],
   see: '⟨l²⟩ = 3kT/k: 0.0300(2) becomes 0.1202(5). The energy of a spring without a rest length stays 3/2 kT, whatever k is.'},
  {number: 13, title: 'What makes a wall rough?', scene: 'slit', steps: 12000, seeds: 2,
   question: 'Two walls slide past each other, at −0.5 and 0.5 a₀/t₀, 20 a₀ apart. Particles that hit a wall are sent back where they came from. Is that no slip? Virtual particles in the cells at the wall are then left out (fill: none).',
   guess: 'Shear rate in the middle, without them (1/t₀)',
   before: {label: 'fill: planar', settings: [], seen: '0.0490(3)'}, after: {label: 'fill: none', settings: ['walls.fill=none'], seen: '0.0335(3)'},
   quantity: 'shear rate in the bulk, 1/t₀', axis: ['y, a₀', 'v_x, a₀/t₀'], theory: [{label: 'no slip', value: 0.05}],
   value: bulk_rate, curve: tables => ({x: column(tables, 'profile', 'y'), y: column(tables, 'profile', 'vx')}),
   see: '0.0490(3) becomes 0.0335(3): a slip length of 0.2 a₀ becomes 4.9(1) a₀. Without virtual particles a cell that a wall cuts has few members, and pulls little at the fluid.'},
  {number: 19, title: 'Twice the shear', scene: 'sheared', steps: 5000, seeds: 4,
   question: 'A fluid is sheared twice as fast. What are the stress and the viscosity?',
   guess: 'Stress at twice the rate (kT/a₀³)',
   before: {label: 'rate: 0.05', settings: [], seen: '1.82(2)'}, after: {label: 'rate: 0.1', settings: ['shear.rate=0.1'], seen: '3.69(4)'},
   quantity: 'shear stress', value: tables => mean(column(tables, 'stress', 'sigma_xy').filter(Number.isFinite)),
   see: 'The stress is 1.82(2) and 3.69(4), the viscosity 36.5(4) and 36.9(4): a Newtonian fluid. Heat grows fourfold.'},
  {number: 25, title: 'Rods twice as thick', scene: 'sticks', steps: 12000, seeds: 6,
   question: 'Rods of one bond fly without a solvent. They become twice as thick. Do they touch twice as often?',
   guess: 'Contacts in 60 t₀, of the thicker rods',
   before: {label: 'diameter: 0.1', settings: [], seen: '442(11)'}, after: {label: 'diameter: 0.2', settings: ['fibers.0.diameter=0.2'], seen: '740(12)'},
   quantity: 'contacts in 60 t₀', axis: ['time, t₀', 'contacts so far'], theory: [{label: 'theory of 0.1', value: 449}, {label: 'theory of 0.2', value: 722}],
   value: tables => last(column(tables, 'collisions', 'executed')),
   curve: tables => ({x: column(tables, 'collisions', 'time'), y: column(tables, 'collisions', 'executed')}),
   see: '442(11) become 740(12): 1.68 times as many. Kinetic theory: 226 sides, 201 ends on sides, 22 ends on ends, 449 in all; then 227, 406 and 89, 722 in all. Sides do not depend on the diameter.'},
];
