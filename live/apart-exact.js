// Does a move cross a bond, and in which tick do two bonds touch? In exact integers, as src/contact/line.h and flight.h decide it.
// Points are arrays of three BigInts: lattice units. docs/conventions.md and docs/port/contacts.md have the words of it.

export const CELL = 1n << 40n; // lattice units in a0
export const TICKS = 65536;    // of a drift

export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const plus = (a, b, factor) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** (p × q)·r, of BigInts exact, of numbers rounded. */
export const determinant = (p, q, r) => dot(cross(p, q), r);

/** Lattice units of a place in a0, and back. */
export const to_lattice = at => at.map(x => BigInt(Math.round(x * 2 ** 40)));
export const to_a0 = point => point.map(x => Number(x) * 2 ** -40);

/** The five determinants of the test, in the order of docs/conventions.md: the volume at `from` and at `to`, the path, the sides of a and of b. */
export function determinants({from, to, pivot, a, b}) {
  const ab = minus(b, a), arm = minus(pivot, a), move = minus(to, from), leg = minus(pivot, from);
  return {before: determinant(ab, arm, minus(from, a)), after: determinant(ab, arm, minus(to, a)), path: determinant(ab, minus(from, a), minus(to, a)),
          of_a: determinant(move, leg, minus(a, from)), of_b: determinant(move, leg, minus(b, from))};
}

/** Zero counts as positive; among the two volumes, with flip, as negative. `same` (the planted error of the test) forgets flip. */
export function conditions({before, after, path, of_a, of_b}, flip) {
  const positive = x => x >= 0, volume = x => flip ? x > 0 : x >= 0;
  return [volume(before) !== volume(after), positive(path) === volume(before), positive(of_a) !== positive(of_b)];
}

export const crosses = query => conditions(determinants(query), query.flip).every(Boolean);

/** Time of the move in [0, 1], s, s' and n of a move that crosses: Eqs. (11)-(21), in doubles. */
export function crossing(query) {
  const {before, after} = determinants(query), [from, to, pivot, a, b] = ['from', 'to', 'pivot', 'a', 'b'].map(name => to_a0(minus(query[name], query.a)));
  const time = Number(before) / (Number(before) - Number(after)), d = minus(to, from), at = plus(from, d, time);
  const p = minus(pivot, at), q = minus(b, a), r = at;
  const [A, B, C, D, E] = [dot(p, p), dot(p, q), dot(q, q), dot(p, r), dot(q, r)], lower = A * C - B * B, clamp = x => Math.min(1, Math.max(0, x));
  const n = cross(p, q), size = Math.sqrt(dot(n, n)) * (dot(n, d) < 0 ? -1 : 1);
  return {time, s: clamp(lower > 0 ? (B * E - C * D) / lower : 0.5), s_standing: clamp(lower > 0 ? (A * E - B * D) / lower : 0.5), normal: n.map(x => x / size)};
}

// --- two bonds in flight ---------------------------------------------------------------------------------------------

/** Bernstein coefficients of the volume between two ticks, two of them times 3. a, b: [p, q, w] at these ticks. */
function coefficients([p, q, w], [p1, q1, w1]) {
  const pq = cross(p, q), mixed = plus(cross(p1, q), cross(p, q1), 1n), last = cross(p1, q1);
  return [dot(pq, w), dot(mixed, w) + dot(pq, w1), dot(last, w) + dot(mixed, w1), dot(last, w1)];
}

const one_sign = list => list.every(x => x > 0n) || list.every(x => x < 0n);

/** Is there a d with d·x > 0 for all points? Fourier and Motzkin's elimination, a component of d at a time. */
function has_plane(points) {
  let rows = points;
  for (let axis = 0; axis < 3; axis++) {
    const above = rows.filter(row => row[axis] > 0n), below = rows.filter(row => row[axis] < 0n);
    rows = rows.filter(row => row[axis] === 0n);
    for (const p of above) for (const n of below) rows.push(p.map((x, k) => -n[axis] * x + p[axis] * n[k]));
    if (rows.some(row => row.every(x => x === 0n))) return false; // 0 > 0
    rows = [...new Map(rows.map(row => [row.join(), row])).values()];
  }
  return true;
}

const at_tick = (pair, tick) => ['p', 'q', 'w'].map(name => plus(pair[name], pair[`${name}_rate`], BigInt(tick)));

function excluded(pair, first, last) {
  const a = at_tick(pair, first), b = at_tick(pair, last);
  return one_sign(coefficients(a, b)) ||
    has_plane([a, b].flatMap(([p, q, w]) => [w, plus(w, q, 1n), minus(w, p), minus(plus(w, q, 1n), p)]));
}

/** The first tick in which two bonds may touch, TICKS if there is none. pair: p, q, w and p_rate, q_rate, w_rate. */
export function first_contact(pair, first = 0, last = TICKS) {
  if (['p_rate', 'q_rate', 'w_rate'].every(name => pair[name].every(x => x === 0n)) || excluded(pair, first, last)) return TICKS;
  if (last - first === 1) return first;
  const middle = (first + last) >> 1, tick = first_contact(pair, first, middle);
  return tick < TICKS ? tick : first_contact(pair, middle, last);
}
