// The small rules of a step in doubles: a cell's collision, the exchange of two bonds, random numbers. Each has its equation and its file in src/.
// `mistakes` are those of "Break it" (docs/course.md); a rule without them is the program's.

export const add = (a, b, factor = 1) => a.map((x, k) => x + factor * b[k]);
export const inner = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);

// --- a cell (src/mpc/grid.c, cell.h, rules/srd.h) --------------------------------------------------------------------

/** Row of a coordinate in a periodic box of so many cells, the grid shifted by `shift` (0 to 1, all in a0). */
export const row_of = (x, shift, cells) => ((Math.floor(x + shift) % cells) + cells) % cells;

/** Mean velocity of members, weighted by their masses. */
export function center_of(velocities, masses) {
  const mass = masses.reduce((sum, one) => sum + one, 0);
  return velocities[0].map((_, k) => velocities.reduce((sum, v, at) => sum + masses[at] * v[k], 0) / mass);
}

/** w turned about the unit vector n: R w = cos w + (1 - cos) n (n·w) + sin n × w. */
export function turn(w, n, cosine, sine) {
  const along = (1 - cosine) * inner(n, w), [x, y, z] = w;
  return [cosine * x + along * n[0] + sine * (n[1] * z - n[2] * y), cosine * y + along * n[1] + sine * (n[2] * x - n[0] * z), cosine * z + along * n[2] + sine * (n[0] * y - n[1] * x)];
}

/** Eqs. (5) and (6): v <- V_cm + R (v - V_cm). about: V_cm, or, by mistake, another velocity. */
export const collided = (v, about, n, cosine, sine) => add(about, turn(add(v, about, -1), n, cosine, sine));

// --- two bonds (src/contact/impulse.h) -------------------------------------------------------------------------------

export const levers = (s, t) => [1 - s, s, t - 1, -t];

/** Speed of approach of the points of contact, and c = sum of lever²/M. */
export function approach_of(velocity, inverse_mass, lever, n) {
  let approach = 0, compliance = 0;
  for (let k = 0; k < 4; k++) {
    approach += lever[k] * inner(velocity[k], n);
    compliance += lever[k] * lever[k] * inverse_mass[k];
  }
  return {approach, compliance};
}

export const pushed = (velocity, inverse_mass, lever, impulse, n) => velocity.map((v, k) => add(v, n, -lever[k] * impulse * inverse_mass[k]));

/** The paper's exchange, Eqs. (22)-(28): the velocities after it, and dP. */
export function exchange(velocity, inverse_mass, s, s_standing, n) {
  const lever = levers(s, s_standing), {approach, compliance} = approach_of(velocity, inverse_mass, lever, n), impulse = 2 * approach / compliance;
  return {velocity: pushed(velocity, inverse_mass, lever, impulse, n), impulse};
}

/** Speed of the rebound for the approach a and what forces add to it, h: Eq. (2) of docs/contacts.md. */
export function rebound(a, h) {
  const straight = a + 2 * h, size = Math.abs(h);
  return straight < 0.2 * a ? a * size / (size + 1.6 * a) : 0.2 * straight > a ? a * size / (size - 1.6 * a) : straight;
}

/** The event-driven exchange, tau after the middle of the flight: answer 0 (they part), 1, or 2 (softened). */
export function exchange_at_own_time(velocity, force, inverse_mass, s, t, n, tau) {
  const lever = levers(s, t), {approach, compliance} = approach_of(velocity, inverse_mass, lever, n);
  if (!(approach > 0)) return {velocity, impulse: 0, answer: 0};
  const h = tau * force.reduce((sum, f, k) => sum + lever[k] * inner(f, n) * inverse_mass[k], 0), away = rebound(approach, h), impulse = (approach + away) / compliance;
  return {velocity: pushed(velocity, inverse_mass, lever, impulse, n), impulse, answer: away === approach + 2 * h ? 1 : 2};
}

export const kinetic = (velocity, inverse_mass) => velocity.reduce((sum, v, k) => sum + 0.5 * inner(v, v) / inverse_mass[k], 0);

// --- random numbers with addresses (src/base/philox.h, random.h) -----------------------------------------------------

/** Product of two words: its high and low half. */
function product(a, b) {
  const low = Math.imul(a, b) >>> 0, a1 = a >>> 16, a0 = a & 0xffff, b1 = b >>> 16, b0 = b & 0xffff;
  const middle = a1 * b0 + ((a0 * b0) >>> 16), other = a0 * b1 + (middle & 0xffff);
  return [(a1 * b1 + Math.floor(middle / 65536) + (other >>> 16)) >>> 0, low];
}

/** The four words of an address. seed: {low, high}. */
export function words_at(seed, purpose, draw, step, entity) {
  let c = [entity >>> 0, (purpose + 256 * draw) >>> 0, step >>> 0, 0], [key0, key1] = [seed.low, seed.high];
  for (let round = 0; round < 10; round++) {
    const [high0, low0] = product(0xd2511f53, c[0]), [high1, low1] = product(0xcd9e8d57, c[2]);
    c = [(high1 ^ c[1] ^ key0) >>> 0, low1, (high0 ^ c[3] ^ key1) >>> 0, low0];
    key0 = (key0 + 0x9e3779b9) >>> 0;
    key1 = (key1 + 0xbb67ae85) >>> 0;
  }
  return c;
}

export const GRID_SHIFT = 1;

/** Uniform numbers in (0, 1) and normal ones, one after the other, of a seed. */
export function dice(seed) {
  let words = [], count = 0, spare = null;
  const uniform = () => {
    if (!words.length) words = words_at({low: seed >>> 0, high: 0}, 0, 0, 0, count++);
    return (words.pop() + 0.5) / 2 ** 32;
  };
  const normal = () => {
    if (spare !== null) { const kept = spare; spare = null; return kept; }
    const size = Math.sqrt(-2 * Math.log(uniform())), angle = 2 * Math.PI * uniform();
    spare = size * Math.sin(angle);
    return size * Math.cos(angle);
  };
  return {uniform, normal};
}
