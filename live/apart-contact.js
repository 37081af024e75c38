// One contact, its time and its impulse: two bonds through one step, by the event-driven rule or by the paper's.
import {make, equation, draw, picture, line, disc, text, arrow, button, choice, slider, table, short, fixed, with_error} from './apart-draw.js';
import {TICKS, to_a0} from './apart-exact.js';
import {add, inner, levers, dice} from './apart-rules.js';
import {MASS, STEP, both, forces} from './apart-flight.js';
import {mean_and_error} from './averages.js';

const WIDTH = 380, HEIGHT = 250, SCALE = 330, LARGER = 15, PUSH = 62; // px for an a0; motion is drawn so many times larger; px of the largest impulse

export function begin(panel) {
  const random = dice(11), counted = dice(12);
  let found, axes, rule = 'event', counting = 0;
  const tally = {event: [], paper: []};
  const svg = picture(WIDTH, HEIGHT, 'Two bonds in one step'), words = make('p', {class: 'apart-verdict', role: 'status'}), numbers = make('div'), sums = make('div');
  const contact = () => found.event.contacts[0];

  /** Axes of the picture: along the first bond, up along the normal, and away. */
  function look() {
    const {at, normal} = contact(), p = add(at[1], at[0], -1), size = Math.hypot(...p), x = p.map(v => v / size), y = normal;
    axes = [x, y, [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]];
  }

  const project = r => { const [x, y, z] = axes.map(axis => inner(axis, r)); return [0.95 * x + 0.6 * z, y + 0.4 * z - 0.12 * x]; };
  /** Where a vertex is drawn: its place at the contact, and from there the motion, larger. */
  function spot(k, place) {
    const {at, s} = contact(), middle = add(at[0], add(at[1], at[0], -1), s), still = project(add(at[k], middle, -1)), moved = project(add(place, at[k], -1));
    return [WIDTH / 2 + SCALE * still[0] + LARGER * SCALE * moved[0], HEIGHT / 2 - SCALE * still[1] - LARGER * SCALE * moved[1]];
  }

  /** Places of a flight at a tick. */
  function flown(tick) {
    const c = contact(), rate = v => v.map(one => one.map(x => BigInt(Math.round(STEP * x * 2 ** 24))));
    const v = tick <= c.tick ? c.before : c.after, r = rate(v);
    return c.at.map((place, k) => add(place, to_a0(r[k]), tick - c.tick));
  }

  function bonds_of(places, cls = '') {
    const on = places.map((place, k) => spot(k, place));
    return draw('g', {}, line(on[2], on[3], `bond two ${cls}`), line(on[0], on[1], `bond one ${cls}`), ...(cls ? [] : on.map((p, k) => disc(p, 6, k < 2 ? 'one' : 'two'))));
  }

  function show_event(tick) {
    const c = contact(), parts = [bonds_of(flown(0), 'ghost')], places = flown(tick), start = flown(0);
    places.forEach((place, k) => parts.push(line(spot(k, start[k]), spot(k, tick > c.tick ? c.at[k] : place), 'flight'), line(spot(k, tick > c.tick ? c.at[k] : place), spot(k, place), 'flight')));
    parts.push(bonds_of(places));
    const after = tick >= c.tick, lever = levers(c.s, c.t), point = places.map((place, k) => spot(k, place));
    const on = [0, 1].map(i => [0, 1].map(axis => point[2 * i][axis] + (i ? c.t : c.s) * (point[2 * i + 1][axis] - point[2 * i][axis])));
    if (after) {
      const largest = Math.max(...lever.map(Math.abs));
      places.forEach((place, k) => parts.push(arrow(point[k], [point[k][0], point[k][1] + PUSH * lever[k] / largest], 'impulse')));
      parts.push(disc(spot_of_contact(), 9, 'hit'));
    } else parts.push(line(on[0], on[1], 'flight'));
    svg.replaceChildren(...parts, text([10, 18], `tick ${tick} of ${TICKS}`, 'soft', 'start'));
    words.textContent = tick < c.tick ? 'All four vertices fly straight, at once. Move the slider: when do the bonds touch?' :
      `They touch in tick ${c.tick}. An impulse passes along the normal, shared by levers (green), and they fly on. No vertex stays behind.`;
  }

  function spot_of_contact() {
    const {at, s} = contact(), a = spot(0, at[0]), b = spot(1, at[1]);
    return [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
  }

  function show_paper(turns) {
    const made = found.paper.turns.slice(0, turns), start = found.places.map(to_a0), places = (made.at(-1)?.places ?? found.places).map(to_a0), last = made.at(-1), parts = [bonds_of(start, 'ghost')];
    if (last?.rejected) {
      const trial = spot(last.vertex, to_a0(last.to)), pivot = [1, 0, 3, 2][last.vertex], lever = [1 - last.s, last.s, last.s_standing - 1, -last.s_standing];
      parts.push(draw('polygon', {class: 'swept', points: [spot(last.vertex, places[last.vertex]), trial, spot(pivot, places[pivot])].map(p => p.join()).join(' ')}),
        line(trial, spot(pivot, places[pivot]), `bond ${last.vertex < 2 ? 'one' : 'two'} ghost`));
      const sign = inner(last.normal, axes[1]) * last.impulse > 0 ? 1 : -1, largest = Math.max(...lever.map(Math.abs));
      last.four.forEach((k, at) => parts.push(arrow(spot(k, places[k]), [spot(k, places[k])[0], spot(k, places[k])[1] + sign * PUSH * lever[at] / largest], 'impulse')));
    }
    parts.push(bonds_of(places));
    svg.replaceChildren(...parts, text([10, 18], `${turns} of 4 turns`, 'soft', 'start'));
    words.textContent = !last ? 'Vertices move one after the other, in a random order. Move the slider: one turn at a time.' :
      last.rejected ? 'This vertex would cross. It stays where it is, and an impulse passes (green). The step counts on the new place: now the energy of the springs is wrong.' : 'This vertex moves to its new place. Nothing is in the way.';
  }

  function show() {
    if (rule === 'event') show_event(time.value);
    else show_paper(turns.value);
    time.box.hidden = rule !== 'event';
    turns.box.hidden = rule === 'event';
    const c = contact(), lever = levers(c.s, c.t), force = forces(c.at), present = v => v.map((one, k) => add(one, force[k], c.tau / MASS));
    const speed = v => v.reduce((sum, one, k) => sum + lever[k] * inner(one, c.normal), 0), kinetic = v => v.reduce((sum, one) => sum + MASS * inner(one, one) / 2, 0);
    const hit = found.paper.turns.find(turn => turn.rejected), fast = v => hit.four.reduce((sum, k, at) => sum + [1 - hit.s, hit.s, hit.s_standing - 1, -hit.s_standing][at] * inner(v[k], hit.normal), 0);
    const rows = rule === 'event' ? [
      ['Approach of the points, now u', short(speed(present(c.before)), 3), short(speed(present(c.after)), 3)],
      ['Kinetic energy of u, kT', fixed(kinetic(present(c.before)), 6), fixed(kinetic(present(c.after)), 6)],
    ] : [
      ['Approach of the points, v', short(fast(hit.before), 3), short(fast(hit.after), 3)],
      ['Kinetic energy of v, kT', fixed(kinetic(hit.before), 6), fixed(kinetic(hit.after), 6)],
    ];
    const where = rule === 'event' ? [`Contact at ${fixed(100 * c.tick / TICKS, 1)} % of Δt (tick ${c.tick} of ${TICKS}), at the parts`, c.s, c.t, c.impulse] : ['Rejected move: it would cross at the parts', hit.s, hit.s_standing, hit.impulse];
    numbers.replaceChildren(make('p', {}, `${where[0]} s = ${fixed(where[1])} of one bond and s′ = ${fixed(where[2])} of the other. Impulse ΔP = ${short(where[3], 3)}.`), table(['', 'before', 'after'], rows, 'Numbers of this contact'));
    sums.replaceChildren(table(['change of the energy by a contact, kT', 'this one', tally.event.length ? `rms of ${tally.event.length} others` : 'rms of others', 'their mean'],
      [['event-driven', ...balance('event')], ['the paper’s rule', ...balance('paper')]], 'Heat of contacts'));
  }

  function balance(name) {
    const list = tally[name], heat = short(found.heat[name]), size = list.length ? short(Math.sqrt(list.reduce((sum, x) => sum + x * x, 0) / list.length)) : '–';
    return [make('span', {class: Math.abs(found.heat[name]) < 2e-3 ? 'pass' : 'fail'}, heat), size, list.length < 8 ? '–' : with_error(...mean_and_error(list))];
  }

  function next() {
    found = both(random, true);
    look();
    time.set(0);
    turns.set(0);
    show();
  }

  /** 200 contacts, some at a time, so that the page goes on. */
  function many() {
    counting += 200;
    many_button.disabled = true;
    const some = () => {
      const began = performance.now();
      while (counting > 0 && performance.now() - began < 25) {
        const {heat} = both(counted);
        for (const name of ['event', 'paper']) tally[name].push(heat[name]);
        counting--;
      }
      show();
      if (counting > 0) setTimeout(some);
      else many_button.disabled = false;
    };
    some();
  }

  const time = slider('Time in the step', {min: 0, max: TICKS, step: 64, value: 0, words: tick => `${fixed(100 * tick / TICKS, 0)} % of Δt`, input: show});
  const turns = slider('Turn', {min: 0, max: 4, value: 0, words: count => count ? `vertex ${found.order[count - 1] + 1}` : 'none yet', input: show});
  const many_button = button('Measure 200 others', many);
  const which = choice('Rule', [['event', 'Event-driven'], ['paper', 'The paper’s rule']], name => { rule = name; show(); });
  panel.append(
    make('p', {}, 'Two bonds of stiff fibers meet in one step. What happens instead of a crossing? Choose the rule, and move the slider.'),
    which.box, svg,
    make('ul', {class: 'apart-key'}, make('li', {}, make('i', {class: 'one'}), 'a bond'), make('li', {}, make('i', {class: 'two'}), 'another bond'), make('li', {}, make('i', {class: 'three'}), 'impulse on each vertex'), make('li', {}, `motion drawn ${LARGER} times as large`)),
    time.box, turns.box, words, numbers,
    make('div', {class: 'apart-choice'}, button('Another contact', next), many_button), sums,
    make('p', {}, 'Both exchanges conserve kinetic energy to the last digit. But in the paper’s rule a vertex stays, and its springs keep the energy of the old place. Single changes have either sign. Two bonds alone, as here, show no mean: 6000 contacts gave 0.0006 ± 0.0007 kT. In a crowd of whole fibers the mean is 0.012 kT (exercise 8), so a suspension heats.'),
    equation('ΔP = 2 (Σ λ V·n) / (Σ λ²/M),  V ← V − λ ΔP n/M,', 'λ = 1 − s, s, s′ − 1, −s′   Eqs. (22)–(28)'),
    make('p', {class: 'apart-source'}, 'In C: src/contact/impulse.h, event_driven.c, sequential.c. u = v + τ F/M is the velocity at the time of the contact, τ after the middle of the step: docs/contacts.md.'));
  next();
}
