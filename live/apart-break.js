// Break it: a mistake is switched on, and tests say what they find. Numbers come from small runs in this page, in the plane; expected ones from theory.
import {make, equation, button, table, short, with_error} from './apart-draw.js';
import {add, inner, levers, approach_of, pushed, kinetic, row_of, center_of, collided, dice} from './apart-rules.js';
import {mean_and_error} from './averages.js';

const CELLS = 16, PER_CELL = 5, ANGLE = Math.PI / 2, FLIGHT = 0.05, COLLISIONS = 10, FRAME = 0.37; // FRAME: cells per flight that the moving frame goes

const LEAST = 12; // runs before a verdict on a mean: fewer have no sure error

/** Each changes one thing. `hint` is told with the answer. */
export const mistakes = [
  {id: 'none', label: 'Nothing is broken', hint: ''},
  {id: 'twice', label: 'The impulse acts twice', impulse: 2, hint: 'Momentum does not notice: what one bond gives, the other one gets. Energy does.'},
  {id: 'levers', label: 's and 1 − s are exchanged', levers: true, hint: 'Momentum and energy are conserved to the last digit. Only the point of contact shows it: it is not turned back, so the bonds meet again.'},
  {id: 'center', label: 'Cells turn about rest, not about V', about: true, hint: 'The energy is conserved, even of each particle. But a cell loses its momentum, and there is no fluid any more.'},
  {id: 'half', label: 'A quarter turn is a half turn', angle: Math.PI, hint: 'Energy and momentum are conserved to the last digit. The velocity after one collision has another mean, which theory knows.'},
  {id: 'shift', label: 'The grid is never shifted', still: true, hint: 'All conservation laws hold, and one collision is right. But particles keep their partners, so the fluid depends on how fast it passes the grid.'},
];

/** A contact of two bonds as the rule answers it: changes of energy and momentum, and the part of the approach that is turned back. */
export function contact_with(mistake, random) {
  const vector = () => [random.normal(), random.normal(), random.normal()], n0 = vector(), n = n0.map(x => x / Math.hypot(...n0)), s = random.uniform(), t = random.uniform();
  const inverse_mass = [5, 5, 5, 5].map(m => 1 / m);
  let v = inverse_mass.map(w => vector().map(x => x * Math.sqrt(w)));
  const true_lever = levers(s, t), lever = mistake.levers ? levers(1 - s, 1 - t) : true_lever, before = approach_of(v, inverse_mass, true_lever, n).approach;
  const used = approach_of(v, inverse_mass, lever, n), after = pushed(v, inverse_mass, lever, (mistake.impulse ?? 1) * 2 * used.approach / used.compliance, n);
  const momentum = list => list.reduce((sum, one, k) => add(sum, one, 1 / inverse_mass[k]), [0, 0, 0]);
  return {energy: kinetic(after, inverse_mass) - kinetic(v, inverse_mass), momentum: Math.hypot(...add(momentum(after), momentum(v), -1)),
          back: approach_of(after, inverse_mass, true_lever, n).approach * before, approach: before * before};
}

/** The solvent in the plane, in a frame that moves past the grid by `drift` a0 per flight. Returns what its tests need. */
export function solvent_with(mistake, random, drift) {
  const n = CELLS * CELLS * PER_CELL, x = Array.from({length: n}, () => [CELLS * random.uniform(), CELLS * random.uniform()]);
  let v = x.map(() => [random.normal(), random.normal(), 0]);
  const first = v, way = x.map(() => [0, 0]), frame = [drift / FLIGHT, 0, 0], result = {energy: [], momentum: []};
  for (let collision = 1; collision <= COLLISIONS; collision++) {
    const shift = [mistake.still ? 0 : random.uniform(), mistake.still ? 0 : random.uniform()], cells = Array.from({length: CELLS * CELLS}, () => []);
    for (let k = 0; k < n; k++) {
      for (const axis of [0, 1]) {
        way[k][axis] += FLIGHT * v[k][axis];
        x[k][axis] += FLIGHT * (v[k][axis] + frame[axis]);
      }
      cells[row_of(x[k][0], shift[0], CELLS) + CELLS * row_of(x[k][1], shift[1], CELLS)].push(k);
    }
    const next = [...v], angle = mistake.angle ?? ANGLE;
    for (const members of cells) {
      if (members.length < 2) continue;
      const sign = random.uniform() < 0.5 ? -1 : 1, own = members.map(k => v[k]), about = mistake.about ? [0, 0, 0] : center_of(own, own.map(() => 1));
      members.forEach((k, at) => { next[k] = collided(own[at], about, [0, 0, 1], Math.cos(angle), sign * Math.sin(angle)); });
      if (collision === 1) {
        const sum = list => list.reduce((all, one) => add(all, one), [0, 0, 0]), turned = members.map(k => next[k]);
        result.momentum.push(Math.hypot(...add(sum(turned), sum(own), -1)));
        result.energy.push(turned.reduce((all, one) => all + inner(one, one) / 2, 0) - own.reduce((all, one) => all + inner(one, one) / 2, 0));
      }
    }
    v = next;
    if (collision === 1) result.kept = v.reduce((sum, one, k) => sum + inner(one, first[k]), 0) / first.reduce((sum, one) => sum + inner(one, one), 0);
  }
  result.spread = way.reduce((sum, d) => sum + d[0] * d[0] + d[1] * d[1], 0) / n / (4 * COLLISIONS * FLIGHT);
  return result;
}

/** C after one collision: 1 - (1 - cos α)(1 - (1 - e^-γ)/γ), exact for members that come as in a gas. */
export const kept_by_theory = 1 - (1 - Math.cos(ANGLE)) * (1 - (1 - Math.exp(-PER_CELL)) / PER_CELL);

/** The tests: what, where it belongs, the samples that it takes, and the expected value. exact: rounding is allowed, no scatter. */
export const tests = [
  {id: 'contact-energy', what: 'Contact: change of the energy, kT', expected: 0, exact: true},
  {id: 'contact-momentum', what: 'Contact: change of the momentum', expected: 0, exact: true},
  {id: 'contact-back', what: 'Contact: rebound over approach', expected: -1, exact: true},
  {id: 'cell-energy', what: 'Cell: change of the energy, kT', expected: 0, exact: true},
  {id: 'cell-momentum', what: 'Cell: change of the momentum', expected: 0, exact: true},
  {id: 'kept', what: 'Velocity kept by one collision, C', expected: kept_by_theory},
  {id: 'frame', what: 'D in a moving frame, over D at rest', expected: 1},
];

/** One round: adds samples to `samples` (by id). */
export function round(mistake, random, samples) {
  const put = (id, value) => (samples[id] ??= []).push(value), contacts = Array.from({length: 100}, () => contact_with(mistake, random)), rest = solvent_with(mistake, random, 0), moving = solvent_with(mistake, random, FRAME);
  for (const one of contacts) {
    put('contact-energy', one.energy);
    put('contact-momentum', one.momentum);
  }
  put('contact-back', contacts.reduce((sum, one) => sum + one.back, 0) / contacts.reduce((sum, one) => sum + one.approach, 0));
  for (const [id, name] of [['cell-energy', 'energy'], ['cell-momentum', 'momentum']]) rest[name].forEach(value => put(id, value));
  put('kept', (rest.kept + moving.kept) / 2);
  put('frame', moving.spread / rest.spread);
}

/** Mean, its error, and the verdict: exact tests allow 1e-9, the others four errors. */
export function verdict({id, expected, exact}, samples) {
  const [mean, error] = mean_and_error(samples[id]), off = Math.abs(mean - expected);
  if (exact) return {mean, error, words: off < 1e-9 ? 'pass' : 'fail'};
  return {mean, error, words: !(error > 0) || samples[id].length < LEAST ? 'more runs' : off < 4 * error ? 'pass' : 'fail'};
}

const ROUNDS = 24;

export function begin(panel) {
  let mistake = mistakes[0], samples = {}, rounds = 0, seed = 1, turn = 0;
  const numbers = make('div'), line = make('p', {class: 'apart-verdict', role: 'status'}), hint = make('p', {}), random = () => dice(1000 + seed++);
  let own = random();

  const select = make('select', {'aria-label': 'Mistake', onchange: () => { mistake = mistakes.find(one => one.id === select.value); again(); }}, ...mistakes.map(one => make('option', {value: one.id}, one.label)));

  function again() {
    samples = {};
    rounds = 0;
    turn++;
    own = random();
    show();
  }

  function measure() {
    const mine = ++turn;
    rounds = 0;
    samples = {};
    const go = () => {
      if (mine !== turn) return;
      round(mistake, own, samples);
      rounds++;
      show();
      if (rounds < ROUNDS && panel.isConnected) setTimeout(go, 10);
    };
    setTimeout(go);
  }

  function show() {
    const found = tests.map(test => samples[test.id] ? verdict(test, samples) : null), failed = found.filter(one => one?.words === 'fail').length;
    numbers.replaceChildren(table(['test', 'measured', 'expected', ''], tests.map((test, at) => {
      const one = found[at];
      return [test.what, !one ? '–' : test.exact && one.words === 'pass' ? `${short(test.expected)} ± ${short(Math.max(1e-16, Math.abs(one.mean - test.expected)), 1)}` : with_error(one.mean, one.error),
        short(test.expected, 3), one ? make('span', {class: one.words}, one.words) : ''];
    }), 'Tests and their verdicts'));
    line.className = `apart-verdict ${!rounds ? '' : failed ? 'fail' : 'pass'}`;
    line.textContent = !rounds ? 'Which of the seven lines will turn to “fail”? Say it before you press.' :
      failed ? `FAIL: ${failed} of 7 tests find “${mistake.label}” (${rounds} of ${ROUNDS} runs).` : `PASS: ${mistake.id === 'none' ? 'all tests agree with what is expected' : `nothing has found “${mistake.label}” yet`} (${rounds} of ${ROUNDS} runs).`;
    hint.textContent = rounds >= 8 ? mistake.hint : '';
  }

  panel.append(
    make('p', {}, 'A good test is known by the bugs that it finds. Choose a mistake, guess which tests will find it, and measure: error bars shrink from run to run.'),
    make('div', {class: 'apart-choice'}, select, button('Measure', measure, {class: 'primary'})),
    line, numbers, hint,
    equation('C = 1 − (1 − cos α)(1 − (1 − exp(−γ))/γ)', `= ${kept_by_theory.toFixed(4)} for α = 90°, γ = 5, in the plane`),
    make('p', {class: 'apart-source'}, 'Small runs in this page: 100 contacts and 1280 particles in 16 × 16 cells, twice, for each run. The C program has the same mistakes as a part of its own tests: docs/course.md, “Break it”, and docs/mutants.md.'));
  show();
}
