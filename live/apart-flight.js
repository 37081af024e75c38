// Two bonds with springs through one step in which they touch: by the event-driven rule, and by the paper's. No solvent.
import {TICKS, minus, plus, to_lattice, to_a0, first_contact, crosses, crossing} from './apart-exact.js';
import {add, inner, levers, approach_of, pushed, exchange, exchange_at_own_time, kinetic} from './apart-rules.js';

export const MASS = 5, SPRING = 100, LENGTH = 0.5, STEP = 0.01; // a stiff fiber of docs/exercises/crowd.yaml
const inverse_mass = [1, 1, 1, 1].map(() => 1 / MASS), bonds = [[0, 1], [2, 3]];

/** Forces on the four vertices at places in a0: springs k (R - l0)²/2. */
export function forces(at) {
  const force = at.map(() => [0, 0, 0]);
  for (const [i, j] of bonds) {
    const r = add(at[j], at[i], -1), size = Math.hypot(...r), pull = SPRING * (1 - LENGTH / size);
    force[i] = add(force[i], r, pull);
    force[j] = add(force[j], r, -pull);
  }
  return force;
}

/** What the leap-frog keeps, to fourth order: Eq. (1) of docs/contacts.md. middle: the places in the middle of the flight. */
export function energy(middle, v) {
  const force = forces(middle);
  let potential = 0, bent = 0;
  for (const [i, j] of bonds) {
    const r = add(middle[j], middle[i], -1), size = Math.hypot(...r), w = add(v[j], v[i], -1), along = inner(w, r) / size;
    potential += 0.5 * SPRING * (size - LENGTH) ** 2;
    bent += SPRING * ((1 - LENGTH / size) * inner(w, w) + LENGTH / size * along * along);
  }
  return kinetic(v, inverse_mass) + potential - STEP * STEP / 24 * bent + STEP * STEP / 12 * force.reduce((sum, f) => sum + inner(f, f) / MASS, 0);
}

/** Energy of the flight that follows, from the places at its beginning. */
export const energy_of_flight = (places, v) => energy(places.map((point, k) => add(to_a0(point), v[k], STEP / 2)), v);

const kicked = (places, v) => { const force = forces(places.map(to_a0)); return v.map((one, k) => add(one, force[k], STEP / MASS)); };

/** Where two bonds are closest, as numbers along them from 0 to 1, and the unit vector from the one to the other while they approach. */
function touch(at, v) {
  const p = add(at[1], at[0], -1), q = add(at[3], at[2], -1), w = add(at[2], at[0], -1), clamp = x => Math.min(1, Math.max(0, x));
  const [pp, pq, qq, pw, qw] = [inner(p, p), inner(p, q), inner(q, q), inner(p, w), inner(q, w)], nn = pp * qq - pq * pq;
  const t = clamp((clamp((pw * qq - pq * qw) / nn) * pq - qw) / qq), s = clamp((t * pq + pw) / pp);
  const n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]], size = Math.hypot(...n);
  const lever = levers(s, t), normal = n.map(x => x / size), {approach} = approach_of(v, inverse_mass, lever, normal);
  const side = inner(n, w) || approach; // from bond 1 to bond 2
  return {s, t, normal: side < 0 ? normal.map(x => -x) : normal};
}

/** A flight of the event-driven rule. places: lattice points. @returns {{places, velocity, contacts}} */
export function event_driven(places, velocity) {
  const contacts = [], rates = () => v.map(one => one.map(x => BigInt(Math.round(STEP * x * 2 ** 24))));
  let x = places, v = velocity, rate = rates(), from = 0;
  while (contacts.length < 50) {
    const now = k => x[k], tick = first_contact({p: minus(now(1), now(0)), q: minus(now(3), now(2)), w: minus(now(2), now(0)), p_rate: minus(rate[1], rate[0]), q_rate: minus(rate[3], rate[2]), w_rate: minus(rate[2], rate[0])}, from);
    if (tick >= TICKS) break;
    const there = x.map((point, k) => plus(point, rate[k], BigInt(tick))), at = there.map(to_a0), hit = touch(at, v), tau = STEP * (tick / TICKS - 0.5);
    const answer = exchange_at_own_time(v, forces(at), inverse_mass, hit.s, hit.t, hit.normal, tau);
    if (answer.answer === 0) break; // bonds that are driven together: rigid clusters of the program, which no contact here needs
    contacts.push({...hit, tick, tau, at, before: v, after: answer.velocity, impulse: answer.impulse});
    v = answer.velocity;
    rate = rates();
    x = there.map((point, k) => plus(point, rate[k], BigInt(-tick)));
    from = tick;
  }
  return {places: x.map((point, k) => plus(point, rate[k], BigInt(TICKS))), velocity: v, contacts};
}

/** A drift of the paper's rule: vertices one by one, in this order. @returns {{places, velocity, turns}} */
export function one_by_one(places, velocity, order) {
  let x = [...places], v = [...velocity];
  const turns = [];
  for (const i of order) {
    const [pivot, a, b] = [[1, 2, 3], [0, 2, 3], [3, 0, 1], [2, 0, 1]][i], to = plus(x[i], to_lattice(v[i].map(y => STEP * y)), 1n);
    const query = {from: x[i], to, pivot: x[pivot], a: x[a], b: x[b], flip: i < pivot}, turn = {vertex: i, to, rejected: crosses(query)};
    if (turn.rejected) {
      const hit = crossing(query), four = [i, pivot, a, b], changed = exchange(four.map(k => v[k]), inverse_mass, hit.s, hit.s_standing, hit.normal);
      Object.assign(turn, hit, {impulse: changed.impulse, four, before: v});
      v = [...v];
      four.forEach((k, at) => { v[k] = changed.velocity[at]; });
      turn.after = v;
    } else {
      x = [...x];
      x[i] = to;
    }
    turns.push({...turn, places: x});
  }
  return {places: x, velocity: v, turns};
}

/** Change of the energy by a step with a contact: from its flight to the next one, kT. */
export const heat = (places, velocity, after) => energy_of_flight(after.places, kicked(after.places, after.velocity)) - energy_of_flight(places, velocity);

/** Two bonds that are about to touch in the flight, as they do in equilibrium: places at its beginning, and velocities.
 * clear: one that is easy to see, away from ends and from the ends of the step. */
export function about_to_touch(dice, clear) {
  const direction = () => { const v = [dice.normal(), dice.normal(), dice.normal()], size = Math.hypot(...v); return v.map(x => x / size); };
  const length = () => { for (;;) { const l = LENGTH + dice.normal() / Math.sqrt(SPRING); if (l > 0.05 && dice.uniform() < l ** 3) return l; } };
  for (;;) {
    const [u, w] = [direction(), direction()], n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]], sine = Math.hypot(...n);
    if (dice.uniform() > sine) continue; // the area that two bonds show each other
    if (clear && sine < 0.8) continue;
    const sign = dice.uniform() < 0.5 ? -1 : 1, normal = n.map(x => sign * x / sine), s = dice.uniform(), t = dice.uniform(), tau = STEP * (dice.uniform() - 0.5), lever = levers(s, t);
    if (clear && (Math.abs(s - 0.5) > 0.25 || Math.abs(t - 0.5) > 0.25 || Math.abs(tau) > 0.2 * STEP)) continue;
    const [long, other] = [length(), length()], first = u.map(x => x * long), q = w.map(x => x * other);
    const at = [first.map(x => -s * x), first.map(x => (1 - s) * x), q.map(x => -t * x), q.map(x => (1 - t) * x)];
    let v = at.map(() => [0, 0, 0].map(() => dice.normal() / Math.sqrt(MASS)));
    const {approach, compliance} = approach_of(v, inverse_mass, lever, normal), wanted = Math.sqrt(-2 * compliance * Math.log(dice.uniform())); // faster ones meet more often
    v = pushed(v, inverse_mass, lever, (approach - wanted) / compliance, normal);
    return {places: at.map((place, k) => to_lattice(add(place, v[k], -(tau + STEP / 2)))), velocity: v};
  }
}

/** One contact under both rules. order: of the paper's turns. */
export function both(dice, clear = false) {
  for (;;) {
    const {places, velocity} = about_to_touch(dice, clear), order = [0, 1, 2, 3].map(k => [dice.uniform(), k]).sort((a, b) => a[0] - b[0]).map(pair => pair[1]);
    const event = event_driven(places, velocity), paper = one_by_one(places, velocity, order);
    if (event.contacts.length !== 1 || !paper.turns.some(turn => turn.rejected)) continue;
    return {places, velocity, event, paper, order, heat: {event: heat(places, velocity, event), paper: heat(places, velocity, paper)}};
  }
}
