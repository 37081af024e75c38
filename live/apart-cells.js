// Stream, bin, rotate one cell by hand: a few particles in a plane of 3 × 3 cells.
import {make, equation, draw, picture, line, disc, text, arrow, drag, button, slider, table, fixed, short} from './apart-draw.js';
import {row_of, center_of, collided, inner, dice} from './apart-rules.js';

const CELLS = 3, EDGE = 116, LEFT = 16, TOP = 16, PARTICLES = 24, FLIGHT = 0.35, LONG = 34; // px for a velocity of 1

const radians = degrees => degrees * Math.PI / 180;
const wrapped = x => ((x % CELLS) + CELLS) % CELLS;

export function begin(panel) {
  let seed = 4, random, position, velocity, shift, cell, before, trail = null, angle = 0, flying = 0; // trail: how far each has flown
  const svg = picture(LEFT * 2 + CELLS * EDGE, TOP * 2 + CELLS * EDGE, 'Particles with their velocities in nine cells. The chosen cell is marked.');
  const svg_defs = draw('defs', {}, draw('clipPath', {id: 'apart-box'}, draw('rect', {x: LEFT, y: TOP, width: CELLS * EDGE, height: CELLS * EDGE})));
  const at = p => [LEFT + p[0] * EDGE, TOP + (CELLS - p[1]) * EDGE];
  const cell_of = p => row_of(p[0], shift[0], CELLS) + CELLS * row_of(p[1], shift[1], CELLS);
  const members = () => position.map((_, k) => k).filter(k => cell_of(position[k]) === cell);
  const sum = list => list.reduce((all, v) => [all[0] + v[0], all[1] + v[1], all[2] + inner(v, v) / 2], [0, 0, 0]);

  function start() {
    random = dice(seed++);
    position = Array.from({length: PARTICLES}, () => [CELLS * random.uniform(), CELLS * random.uniform()]);
    velocity = position.map(() => [random.normal(), random.normal(), 0]);
    shift = [0, 0];
    trail = null;
    cell = 4;
    crowded();
    chosen();
  }

  /** Keeps the cell if it has four members, else takes the fullest one. */
  function crowded() {
    const counts = new Array(CELLS * CELLS).fill(0);
    position.forEach(p => counts[cell_of(p)]++);
    if (counts[cell] < 4) cell = counts.indexOf(Math.max(...counts));
  }

  /** What the hand has turned is kept; from here on `before` is what was. */
  function chosen() {
    before = velocity.map(v => [...v]);
    angle = 0;
    hand.set(0);
    show();
  }

  function stream() {
    if (flying) return;
    const from = position, began = performance.now(), long = matchMedia('(prefers-reduced-motion: reduce)').matches ? 1 : 450;
    const fly = () => {
      const part = Math.min(1, (performance.now() - began) / long);
      trail = velocity.map(v => [part * FLIGHT * v[0], part * FLIGHT * v[1]]);
      position = from.map((p, k) => [wrapped(p[0] + trail[k][0]), wrapped(p[1] + trail[k][1])]);
      if (part < 1) { flying = requestAnimationFrame(fly); show(); return; }
      flying = 0;
      crowded();
      chosen();
    };
    fly();
  }

  function move_grid() {
    shift = [random.uniform(), random.uniform()];
    trail = null;
    crowded();
    chosen();
  }

  /** Turns the members of the chosen cell, from what was before. */
  function turn(degrees) {
    angle = degrees;
    const mine = members(), center = center_of(mine.map(k => before[k]), mine.map(() => 1));
    for (const k of mine) velocity[k] = collided(before[k], center, [0, 0, 1], Math.cos(radians(degrees)), Math.sin(radians(degrees)));
    show();
  }

  function turn_all() {
    const kept = cell;
    chosen();
    for (let one = 0; one < CELLS * CELLS; one++) {
      cell = one;
      if (members().length > 1) turn(random.uniform() < 0.5 ? 90 : -90);
    }
    cell = kept;
    show();
  }

  function show() {
    const parts = [svg_defs], inside = draw('g', {'clip-path': 'url(#apart-box)'}), mine = new Set(members());
    for (const dx of [-CELLS, 0, CELLS]) for (const dy of [-CELLS, 0, CELLS]) {
      const low = [cell % CELLS - shift[0] + dx, Math.floor(cell / CELLS) - shift[1] + dy], corner = at([low[0], low[1] + 1]);
      inside.append(draw('rect', {x: corner[0], y: corner[1], width: EDGE, height: EDGE, class: 'chosen'}));
    }
    for (let k = -1; k <= CELLS + 1; k++) {
      inside.append(line(at([k - shift[0], 0]), at([k - shift[0], CELLS]), 'grid'), line(at([0, k - shift[1]]), at([CELLS, k - shift[1]]), 'grid'));
    }
    parts.push(inside, draw('rect', {x: LEFT, y: TOP, width: CELLS * EDGE, height: CELLS * EDGE, class: 'frame'}));
    const all = draw('g', {'clip-path': 'url(#apart-box)'});
    position.forEach((p, k) => {
      const place = at(p), tip = v => [place[0] + LONG * v[0], place[1] - LONG * v[1]];
      if (trail) all.append(line(at([p[0] - trail[k][0], p[1] - trail[k][1]]), place, 'flight'));
      if (mine.has(k) && angle) all.append(arrow(place, tip(before[k]), 'before'));
      all.append(arrow(place, tip(velocity[k]), 'velocity'), disc(place, mine.has(k) ? 5.5 : 4, mine.has(k) ? 'one' : ''));
    });
    const list = [...mine];
    if (list.length) {
      const center = center_of(list.map(k => velocity[k]), list.map(() => 1)), middle = list.map(k => position[k]);
      const low = [cell % CELLS - shift[0], Math.floor(cell / CELLS) - shift[1]], spot = at([wrapped(low[0] + 0.5), wrapped(low[1] + 0.5)]);
      if (middle.length > 1) all.append(arrow(spot, [spot[0] + LONG * center[0], spot[1] - LONG * center[1]], 'mean'));
    }
    parts.push(all);
    svg.replaceChildren(...parts);
    const was = sum(list.map(k => before[k])), is = sum(list.map(k => velocity[k])), total = [sum(before), sum(velocity)];
    const row = (name, a, b) => [name, fixed(a, 6), fixed(b, 6), Math.abs(a - b) < 1e-12 ? make('span', {class: 'pass'}, 'equal') : make('span', {class: 'fail'}, short(b - a))];
    numbers.replaceChildren(table(['', 'before', 'now', ''], [
      row(`Cell of ${list.length}: momentum along x`, was[0], is[0]), row('… along y', was[1], is[1]), row('… kinetic energy', was[2], is[2]), row('All particles: energy', total[0][2], total[1][2])], 'Momentum and energy before and now'));
  }

  const hand = slider('Turn this cell by', {min: -180, max: 180, value: 0, words: degrees => `${fixed(degrees, 0)}°`, input: turn});
  const numbers = make('div');
  drag(svg, place => {
    const p = [(place[0] - LEFT) / EDGE, CELLS - (place[1] - TOP) / EDGE];
    if (p.some(x => x < 0 || x > CELLS)) return null;
    cell = cell_of(p);
    chosen();
    return null;
  }, () => {});
  panel.append(
    make('p', {}, 'The solvent repeats three steps, one on each button. 1: particles fly straight. 2: the plane is cut into cells, at another random place each time. 3: in each cell, all velocities relative to the cell’s mean velocity V are turned by one angle.'),
    make('p', {}, 'Press 1 and 2, then turn the marked cell with the slider below the picture. Its momentum and energy stay equal, whatever the angle.'),
    make('div', {class: 'apart-choice'}, button('1 Stream', stream), button('2 Shift the grid', move_grid), button('3 Turn all by ±90°', turn_all), button('Next cell', () => next()), button('New particles', start)),
    svg,
    make('ul', {class: 'apart-key'}, make('li', {}, make('i', {class: 'one'}), 'velocity v'), make('li', {}, make('i', {class: 'two'}), 'mean velocity V of the marked cell')),
    hand.box, numbers,
    equation('r ← r + v Δt   Eq. (3) of the paper', 'v ← V + R (v − V)   Eqs. (5), (6)'),
    make('p', {class: 'apart-source'}, 'In C: src/mpc/grid.c, src/mpc/rules/srd.h. In three dimensions the axis of R is random. A fiber’s vertex is a member of its cell like any particle: this is how fibers feel the fluid.'));

  function next() {
    do cell = (cell + 1) % (CELLS * CELLS); while (members().length < 2);
    chosen();
  }
  start();
}
