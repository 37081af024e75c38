// One swept triangle and its exact sign: five points on a lattice that can be dragged, five determinants, three conditions.
import {make, equation, draw, picture, line, disc, text, drag, button, choice, slider, table, short} from './apart-draw.js';
import {determinants, conditions, crossing} from './apart-exact.js';

const WIDTH = 380, HEIGHT = 300, UNIT = 22, REACH = 7, TURN = 0.42, TILT = 0.38, FLOOR = -6; // px for a lattice unit; the direction of sight; y of the floor
const names = {from: 'i', to: 'i′', pivot: 'pivot', a: 'j', b: 'j+1'}, points = Object.keys(names);
const small = rows => Object.fromEntries(points.map((name, k) => [name, rows[k].map(BigInt)]));

/** The last one has coordinates as the program has them, 2⁴⁰ to an a0: `unit` of them are a unit of the picture. */
const presets = {
  through: {words: 'Through', unit: 1n, at: small([[-5, 3, 1], [5, 2, 0], [0, -5, 0], [3, 1, -5], [-3, -1, 5]])},
  beside: {words: 'Beside', unit: 1n, at: small([[-5, 3, 1], [5, 2, 0], [0, -5, 0], [3, 5, -5], [-3, 4, 5]])},
  tie: {words: 'Exactly onto it', unit: 1n, at: small([[-5, 3, 1], [0, 4, 0], [0, -5, 0], [3, 0, -5], [-3, 0, 5]])},
  doubles: {words: 'Doubles fail', unit: 109951162778n, at: null},
};

/** i′ = j + (bond) − (arm) lies in the plane of j, j+1 and the pivot, to the last digit. */
presets.doubles.at = (() => {
  const a = [329867988644n, 109953015084n, -549740393307n], b = [-219901278647n, -109945446103n, 549763777032n], pivot = [19130601n, -549745405358n, 14539834n];
  return {from: [-549741795520n, 329872702067n, 109963441875n], to: b.map((x, k) => x - pivot[k] + a[k]), pivot, a, b};
})();

const sight = {right: [Math.cos(TURN), 0, -Math.sin(TURN)], up: [-Math.sin(TILT) * Math.sin(TURN), Math.cos(TILT), -Math.sin(TILT) * Math.cos(TURN)], near: [Math.cos(TILT) * Math.sin(TURN), Math.sin(TILT), Math.cos(TILT) * Math.cos(TURN)]};
const along = (v, p) => v[0] * p[0] + v[1] * p[1] + v[2] * p[2];

function words_of(x) { // of a BigInt, or of a double
  if (typeof x === 'number') return short(x, 2);
  const digits = x.toString().replace('-', '');
  return digits.length > 9 ? short(Number(x), 2) : x.toString().replace('-', '−');
}

export function begin(panel) {
  let at, unit, held = 'to', name = 'through';
  const svg = picture(WIDTH, HEIGHT, 'A bond sweeps a triangle; another bond stands. Points can be dragged.');
  svg.setAttribute('role', 'group');
  const shown = point => point.map(x => Number(x) / Number(unit));
  const place = p => [WIDTH / 2 + UNIT * along(sight.right, p), HEIGHT / 2 - UNIT * along(sight.up, p)];
  const query = () => ({...at, flip: false});

  /** The place on the screen, and the depth z that the point has: x and y of the lattice. */
  function lattice_at([sx, sy], z) {
    const u = (sx - WIDTH / 2) / UNIT - sight.right[2] * z, v = (HEIGHT / 2 - sy) / UNIT - sight.up[2] * z;
    const y = (v - sight.up[0] * u / sight.right[0]) / sight.up[1];
    return [u / sight.right[0], y];
  }

  const whole = x => BigInt(Math.round(Math.max(-REACH, Math.min(REACH, x)) * (unit > 1n ? 1000 : 1))) * (unit > 1n ? unit / 1000n : 1n);

  function put(point, x, y, z) {
    at = {...at, [point]: [x ?? shown(at[point])[0], y ?? shown(at[point])[1], z ?? shown(at[point])[2]].map((value, k) => [x, y, z][k] === undefined ? at[point][k] : whole(value))};
    show();
  }

  function hold(point) {
    held = point;
    depth.set(shown(at[held])[2]);
    show();
  }

  function choose(next) {
    name = next;
    unit = presets[name].unit;
    at = {...presets[name].at};
    hold('to');
  }

  function keys(event, point) {
    const [x, y, z] = shown(at[point]), by = {ArrowRight: [1, 0, 0], ArrowLeft: [-1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], PageUp: [0, 0, 1], PageDown: [0, 0, -1]}[event.key];
    if (!by) return;
    event.preventDefault();
    held = point;
    put(point, by[0] ? x + by[0] : undefined, by[1] ? y + by[1] : undefined, by[2] ? z + by[2] : undefined);
    depth.set(shown(at[held])[2]);
    handles.get(point).focus();
  }

  const handles = new Map(points.map(point => [point, draw('circle', {r: 20, class: 'handle', tabindex: 0, role: 'button', onkeydown: event => keys(event, point), onfocus: () => { if (held !== point) hold(point); }})]));
  const figure = draw('g'), numbers = make('div'), verdict = make('p', {class: 'apart-verdict', role: 'status'}), doubt = make('p', {class: 'apart-source'});
  svg.append(figure, ...handles.values());

  function show() {
    const p = Object.fromEntries(points.map(point => [point, shown(at[point])])), on = Object.fromEntries(points.map(point => [point, place(p[point])]));
    const found = determinants(query()), met = conditions(found, false), all = met.every(Boolean);
    const parts = [];
    for (const point of points) parts.push(line(on[point], place([p[point][0], FLOOR, p[point][2]]), 'flight')); // to the floor
    const floor = [[-5, FLOOR, -5], [5, FLOOR, -5], [5, FLOOR, 5], [-5, FLOOR, 5]].map(place);
    parts.unshift(draw('polygon', {points: floor.map(q => q.join()).join(' '), class: 'frame'}));
    const triangle = draw('polygon', {points: [on.from, on.to, on.pivot].map(q => q.join()).join(' '), class: 'swept'});
    const bonds = [line(on.from, on.pivot, 'bond one'), line(on.to, on.pivot, 'bond one ghost')];
    // The standing bond is drawn behind the triangle as far as it is behind its plane, as seen from here.
    const normal = cross_of(p), side = point => along(normal, minus_of(p[point], p.from)) * Math.sign(along(normal, sight.near) || 1), [za, zb] = [side('a'), side('b')];
    if (za * zb < 0) {
      const part = za / (za - zb), middle = place(p.a.map((x, k) => x + part * (p.b[k] - x))), [back, front] = za < 0 ? ['a', 'b'] : ['b', 'a'];
      parts.push(line(on[back], middle, 'bond two'), triangle, ...bonds, line(middle, on[front], 'bond two'));
    } else {
      const standing = line(on.a, on.b, 'bond two');
      parts.push(...(za + zb < 0 ? [standing, triangle, ...bonds] : [triangle, ...bonds, standing]));
    }
    for (const point of points) parts.push(disc(on[point], 6, point === 'a' || point === 'b' ? 'two' : point === 'to' ? 'open' : 'one'));
    const middle = [(on.from[0] + on.to[0] + on.pivot[0]) / 3, (on.from[1] + on.to[1] + on.pivot[1]) / 3];
    for (const point of points) {
      const out = point === 'a' || point === 'b' ? [on[point][0] - (on.a[0] + on.b[0]) / 2, on[point][1] - (on.a[1] + on.b[1]) / 2] : [on[point][0] - middle[0], on[point][1] - middle[1]], size = Math.hypot(...out) || 1;
      const far = point === held ? 31 : 20; // outside the ring of the point that is held
      parts.push(text([on[point][0] + far * out[0] / size, on[point][1] + far * out[1] / size + 5], names[point], point === 'a' || point === 'b' ? 'two' : 'one'));
    }
    let when = '';
    if (all) {
      const hit = crossing(query()), touch = p.a.map((x, k) => x + hit.s_standing * (p.b[k] - x)), moved = p.from.map((x, k) => x + hit.time * (p.to[k] - x));
      parts.push(line(place(moved), on.pivot, 'one flight'), disc(place(touch), 8, 'hit'));
      when = ` They meet at ${short(100 * hit.time)} % of the move, at the parts s = ${short(hit.s)} of the moving bond and s′ = ${short(hit.s_standing)} of the other one.`;
    }
    figure.replaceChildren(...parts);
    for (const [point, handle] of handles) {
      handle.setAttribute('cx', on[point][0]);
      handle.setAttribute('cy', on[point][1]);
      handle.classList.toggle('held', point === held);
      handle.setAttribute('aria-label', `Point ${names[point]}: ${p[point].map(x => short(x, 1)).join(', ')}. Arrow keys move it, page up and down along z.`);
    }
    depth.box.querySelector('span').firstChild.textContent = `Depth z of point ${names[held]}`;
    const mark = (yes, words) => make('span', {class: yes ? 'pass' : 'fail'}, `${yes ? '✓' : '✗'} ${words}`);
    numbers.replaceChildren(table(['three conditions', 'exact integers', ''], [
      ['1. The volume of the two bonds changes its sign: at i, at i′', make('span', {}, words_of(found.before), make('br'), words_of(found.after)), mark(met[0], met[0] ? 'changes' : 'same')],
      ['2. The line j … j+1 passes on the pivot’s side of the path', words_of(found.path), mark(met[1], met[1] ? 'sign of i' : 'other sign')],
      ['3. j and j+1 lie on both sides of the triangle’s plane', make('span', {}, words_of(found.of_a), make('br'), words_of(found.of_b)), mark(met[2], met[2] ? 'differ' : 'same')],
    ], 'Signs that decide'));
    verdict.textContent = all ? `The bond crosses: the move is rejected.${when}` : 'The bond does not cross: the vertex moves to i′.';
    doubt.textContent = doubles_say(all);
  }

  /** What the same formula in doubles would decide. */
  function doubles_say(all) {
    const near = Object.fromEntries(points.map(point => [point, at[point].map(Number)])), found = determinants(near), exact = determinants(at);
    const wrong = Object.keys(found).filter(key => Math.sign(found[key]) !== Number(exact[key] > 0n) - Number(exact[key] < 0n));
    if (wrong.length) {
      const other = conditions(found, false).every(Boolean), key = wrong[0];
      return `In doubles rounding gives ${short(found[key])} where the integer is ${words_of(exact[key])}. ${other !== all ? `So doubles alone would say “${other ? 'crosses' : 'does not cross'}”: wrong, and a fiber may be tangled forever.` : 'Here the answer is the same by luck.'}`;
    }
    const zero = Object.values(exact).some(x => x === 0n);
    return zero ? 'An integer is exactly 0. Zero counts as positive, always: of two moves that share the tie, one counts it, so no crossing is lost.' : 'Signs in doubles would be right here. The program uses doubles where rounding cannot change a sign, else integers.';
  }

  const depth = slider('Depth z of point i′', {min: -REACH, max: REACH, step: 1, value: 0, words: z => String(Math.round(z)).replace('-', '−'), input: z => put(held, undefined, undefined, z)});
  drag(svg, spot => {
    const near = points.map(point => [point, Math.hypot(...place(shown(at[point])).map((x, k) => x - spot[k]))]).sort((a, b) => a[1] - b[1])[0];
    if (near[1] > 24) return null;
    hold(near[0]);
    return near[0];
  }, (point, spot) => put(point, ...lattice_at(spot, shown(at[point])[2])));
  const which = choice('Cases', Object.entries(presets).map(([key, {words}]) => [key, words]), choose);
  panel.append(
    make('p', {}, 'In the paper’s rule one vertex moves at a time, from i to i′. Its bond sweeps the shaded triangle, and all other bonds stand. Does the bond j … j+1 pierce the triangle?'),
    make('p', {}, 'Drag the points. Three signs decide, each of an exact integer: one crossing that is missed is a tangle forever.'),
    which.box, svg, depth.box, verdict, numbers, doubt,
    equation('(R(j+1) − R(j)) × (R(pivot) − R(j)) · (R(i; t) − R(j)) = 0   Eq. (10)'),
    make('p', {class: 'apart-source'}, 'In C: src/contact/line.c, determinant.h. The same sign is computed here, and both are tested with the same data.'));
  choose(name);
}

const minus_of = (a, b) => a.map((x, k) => x - b[k]);
function cross_of(p) {
  const [a, b] = [minus_of(p.to, p.from), minus_of(p.pivot, p.from)];
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
