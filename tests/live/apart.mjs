// The rules of "A step taken apart" (live/apart-exact.js, apart-rules.js) beside the C program's answers in reference-data/: signs and ticks
// must be equal, doubles agree to rounding. Planted errors are seen: each must be found by these data.
// The packs: python/uncross_construct makes the inputs of edges and contacts, `uncross oracle` the answers (reference-data/README.md).
// usage: node tests/live/apart.mjs
import {readFileSync} from 'node:fs';
import {gunzipSync} from 'node:zlib';
import * as exact from '../../live/apart-exact.js';
import * as rules from '../../live/apart-rules.js';
import {both, STEP} from '../../live/apart-flight.js';
import {mistakes, tests, round, verdict} from '../../live/apart-break.js';
import {lessons} from '../../live/lessons-list.js';
import {link_of} from '../../live/lessons.js';

const ROOT = new URL('../../', import.meta.url);

/** A pack's text as {operator: {step: {row: {column: number or word}}}}. */
function read_pack(name) {
  const operators = {};
  for (const line of gunzipSync(readFileSync(new URL(`reference-data/${name}.pack.txt.gz`, ROOT))).toString().split('\n').slice(1)) {
    const [operator, step, row, column, value] = line.split(' ');
    if (value !== undefined) (((operators[operator] ??= {})[step] ??= {})[row] ??= {})[column] = value;
  }
  return operators;
}

const steps = operator => Object.entries(operator ?? {}), rows = table => Object.values(table);
const all_rows = operator => steps(operator).flatMap(([, table]) => rows(table));
const vector = (row, name, of = Number) => ['x', 'y', 'z'].map(axis => of(row[`${name}.${axis}`]));
const close = (a, b, size) => a.every((x, k) => Math.abs(x - b[k]) <= 1e-12 * size);

const packs = Object.fromEntries(['edges', 'contacts', 'dense', 'mixed'].map(name => [name, read_pack(name)]));
const sample = name => Object.values(packs).flatMap(pack => all_rows(pack[name]));

const query_of = row => ({...Object.fromEntries(['from', 'to', 'pivot', 'a', 'b'].map(name => [name, vector(row, `in.${name}`, BigInt)])), flip: row['in.flip.flip'] === '1'});

/** Each returns how many rows do not agree with the program. `own` are the functions that are tested, or planted ones. */
const checks = {
  signs(own) {
    const wrong = row => own.crosses(query_of(row)) !== (row['out.crosses.crosses'] === '1');
    return count('crossing', wrong, row => true, 700);
  },
  places(own) {
    const wrong = row => {
      const found = own.crossing(query_of(row));
      return !close([found.time, found.s, found.s_standing, ...found.normal], ['time', 's', 's_standing', 'normal_x', 'normal_y', 'normal_z'].map(name => Number(row[`out.hit.${name}`])), 1);
    };
    // In edges.pack many bonds are parallel, and their s and n are not determined; packs of real scenes have none.
    return count_rows([packs.dense, packs.mixed].flatMap(pack => all_rows(pack.crossing)).filter(row => row['out.crosses.crosses'] === '1'), wrong, 40);
  },
  ticks(own) {
    const wrong = row => own.first_contact(Object.fromEntries(['p', 'q', 'w', 'p_rate', 'q_rate', 'w_rate'].map(name => [name, vector(row, `in.${name}`, BigInt)])), Number(row['in.from.tick'])) !== Number(row['out.tick.tick']);
    return count('contact_search', wrong, row => true, 300);
  },
  'impulse at its own time'(own) {
    const ends = ['p0', 'p1', 'q0', 'q1'], wrong = row => {
      const found = own.exchange_at_own_time(ends.map(end => vector(row, `in.${end}`)), ends.map(end => vector(row, `in.force_${end}`)), ends.map(end => 1 / Number(row[`in.mass.${end}`])),
        Number(row['in.contact.s']), Number(row['in.contact.t']), vector(row, 'in.normal'), Number(row['in.tau.tau']));
      const after = ends.map(end => vector(row, `out.${end}`)), size = 1 + Math.max(...after.flat().map(Math.abs));
      return found.answer !== Number(row['out.answer.answer']) || found.velocity.some((v, k) => !close(v, after[k], size)) ||
        !close([found.impulse], [Number(row['out.momentum.momentum'])], 1 + Math.abs(found.impulse));
    };
    return count('impulse', wrong, row => true, 140);
  },
  'exchange of the paper'(own) {
    const ends = ['moving', 'pivot', 'a', 'b'], wrong = row => {
      const found = own.exchange(ends.map(end => vector(row, `in.${end}`)), ends.map(end => 1 / Number(row[`in.mass.${end}`])), Number(row['in.contact.s']), Number(row['in.contact.s_standing']), vector(row, 'in.normal'));
      const after = ends.map(end => vector(row, `out.${end}`)), size = 1 + Math.max(...after.flat().map(Math.abs));
      return found.velocity.some((v, k) => !close(v, after[k], size));
    };
    return count('exchange', wrong, row => true, 100);
  },
  'rotation of a cell'(own) {
    const wrong = [];
    let n = 0;
    for (const pack of [packs.dense, packs.mixed]) {
      const {'in.reals.cosine': cosine, 'in.reals.sine': sine} = pack.model[0][0];
      for (const [, table] of steps(pack.rotate)) for (const kind of ['solvent', 'vertex']) for (const row of rows(table)) {
        const cell = table[row[`in.${kind}_cell.cell`]];
        if (cell?.['in.active.active'] !== '1' || row[`in.${kind}.x`] === undefined) continue;
        n++;
        const center = vector(cell, 'in.center'), turned = own.collided(vector(row, `in.${kind}`), center, vector(cell, 'in.axis'), Number(cosine), Number(sine));
        const found = rules.add(center, rules.add(turned, center, -1), Number(cell['in.factor.factor'])); // the thermostat's factor
        if (!close(found, vector(row, `out.${kind}`), 10)) wrong.push(row);
      }
    }
    return enough(wrong.length, n, 500);
  },
  'cells and shift'(own) {
    let wrong = 0, n = 0;
    for (const pack of [packs.dense, packs.mixed]) {
      const model = pack.model[0][0], seed = {low: Number(model['in.numbers.seed_low']), high: Number(model['in.numbers.seed_high'])}, [lx, ly, lz] = ['x', 'y', 'z'].map(axis => Number(model[`in.box.${axis}`]));
      for (const [step, table] of steps(pack.shift)) {
        const words = own.words_at(seed, rules.GRID_SHIFT, 0, Number(step), 0).slice(0, 3), shift = words.map(word => word / 2 ** 32);
        if (words.some((word, k) => BigInt(word) << 8n !== vector(table[0], 'out.shift', BigInt)[k])) wrong++;
        for (const kind of ['solvent', 'vertex']) for (const row of rows(pack.bin[step])) {
          if (row[`in.${kind}.x`] === undefined) continue;
          n++;
          const [x, y, z] = vector(row, `in.${kind}`).map((value, k) => own.row_of(value / 2 ** 40, shift[k], [lx, ly, lz][k]));
          if ((z * ly + y) * lx + x !== Number(row[`out.${kind}.cell`])) wrong++;
        }
      }
    }
    return enough(wrong, n, 1000);
  },
};

function enough(wrong, n, least) {
  if (n < least) throw new Error(`only ${n} rows; there should be ${least} or more`);
  return {wrong, n};
}
const count_rows = (list, wrong, least) => enough(list.filter(wrong).length, list.length, least);
const count = (name, wrong, keep, least) => count_rows(sample(name).filter(keep), wrong, least);

/** Errors that the data must show, each in a copy of the functions. */
const planted = [
  ['signs', 'zero counts as negative', {crosses: query => { const v = exact.determinants(query), sign = x => x > 0n; return sign(v.before) !== sign(v.after) && sign(v.path) === sign(v.before) && sign(v.of_a) !== sign(v.of_b); }}],
  ['signs', 'flip is forgotten', {crosses: query => exact.crosses({...query, flip: false})}],
  ['signs', 'doubles instead of integers', {crosses: query => exact.crosses({...Object.fromEntries(['from', 'to', 'pivot', 'a', 'b'].map(name => [name, query[name].map(Number)])), flip: query.flip})}],
  ['places', 's counts from the pivot', {crossing: query => { const hit = exact.crossing(query); return {...hit, s: 1 - hit.s}; }}],
  ['ticks', 'one tick late', {first_contact: (pair, from) => Math.min(exact.TICKS, exact.first_contact(pair, from) + 1)}],
  ['impulse at its own time', 'plain reversal', {exchange_at_own_time: (v, f, m, s, t, n) => rules.exchange_at_own_time(v, f, m, s, t, n, 0)}],
  ['exchange of the paper', 'levers exchanged', {exchange: (v, m, s, t, n) => rules.exchange(v, m, 1 - s, 1 - t, n)}],
  ['rotation of a cell', 'turned about zero', {collided: (v, about, n, c, s) => rules.collided(v, [0, 0, 0], n, c, s)}],
  ['rotation of a cell', 'turned the other way', {collided: (v, about, n, c, s) => rules.collided(v, about, n, c, -s)}],
  ['cells and shift', 'no shift', {row_of: (x, shift, cells) => rules.row_of(x, 0, cells)}],
];

let bad = 0;
for (const [name, check] of Object.entries(checks)) {
  const {wrong, n} = check({...exact, ...rules});
  if (wrong) bad++;
  console.log(`${wrong ? 'FAIL' : 'ok'}    ${name}: ${n} rows, ${wrong} differ`);
}
for (const [name, what, functions] of planted) {
  const {wrong, n} = checks[name]({...exact, ...rules, ...functions});
  if (!wrong) bad++;
  console.log(`${wrong ? 'ok' : 'FAIL'}    planted in ${name}: ${what}: ${wrong} of ${n} rows differ`);
}
/** What a contact changes of the energy that the leap-frog keeps. docs/contacts.md: the event-driven rule to fourth order in the step (here the springs are alone, without bends, so
 * smaller than its table has), the paper's rule by some 0.05 kT at this step, of either sign. */
function sizes_of_heat(contacts) {
  const dice = rules.dice(7), heats = Array.from({length: contacts}, () => both(dice).heat), size = name => Math.sqrt(heats.reduce((sum, heat) => sum + heat[name] ** 2, 0) / contacts);
  return {event: size('event'), paper: size('paper')};
}
const heat = sizes_of_heat(60), kept = STEP === 0.01 && heat.event < 1e-3 && heat.paper > 0.01 && heat.paper < 0.25;
if (!kept) bad++;
console.log(`${kept ? 'ok' : 'FAIL'}    contacts: sizes of the heat ${heat.event.toExponential(1)} and ${heat.paper.toExponential(1)} kT`);

/** Break it: the tests that must find each mistake, and no others. By the course: levers and half turn conserve energy and momentum; a twofold impulse p a - p² c/2 does not. */
const found_by = {none: [], twice: ['contact-energy', 'contact-back'], levers: ['contact-back'], center: ['cell-momentum', 'kept'], half: ['kept'], shift: ['frame']};
for (const mistake of mistakes) {
  const samples = {}, dice = rules.dice(2026);
  for (let k = 0; k < 16; k++) round(mistake, dice, samples);
  const failed = tests.filter(test => verdict(test, samples).words === 'fail').map(test => test.id), right = failed.join() === found_by[mistake.id].join();
  if (!right) bad++;
  console.log(`${right ? 'ok' : 'FAIL'}    break it, ${mistake.id}: found by ${failed.join(', ') || 'none'}`);
}

/** docs/course.md has the link of each exercise that the page has, and the numbers that the page says it says. */
const course = readFileSync(new URL('docs/course.md', ROOT), 'utf8');
for (const lesson of lessons) {
  const link = `live/${decodeURIComponent(link_of(lesson, lesson.after))}`, digits = lesson.see.match(/[0-9.]+\([0-9]+\)/g) ?? [];
  const wrong = [course.includes(link) ? '' : `no ${link}`, ...digits.map(number => course.includes(number) ? '' : `no ${number}`)].filter(Boolean);
  if (wrong.length) bad++;
  console.log(`${wrong.length ? 'FAIL' : 'ok'}    exercise ${lesson.number} in docs/course.md ${wrong.join(', ')}`);
}
process.exit(bad ? 1 : 0);
