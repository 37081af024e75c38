/* What contacts of the rule `event-driven` do to the energy of the leap-frog: shared by `contact_heat`
 * (docs/accuracy.md, docs/contacts.md) and the test of it.
 *
 * The leap-frog conserves, to fourth order in dt (Hairer, Lubich, Wanner, Geometric Numerical Integration, Sec. IX.3),
 *
 *   H(x, v) = (1/2) v.M v + V(x) - (dt^2/24) v.V''(x) v + (dt^2/12) F(x).F(x)/M
 *
 * x being the positions in the middle between two kicks, v the velocities there. The bonds' paths are straight between
 * the kicks, so at a time tau from the middle x = x(tau) - tau v, whatever comes before or after in this drift. A
 * contact changes v of four vertices at a given x(tau); H of before and after differ by
 *
 *   heat      Delta H: heat of this contact, kT. Mean over contacts: what a contact heats.
 *   balance   q = J exp(-Delta H), J = (a'/a) |da'/da|, a and a' being the speeds of approach and of rebound along the
 *             normal. In equilibrium, <q> = 1 over contacts of a map that is reversible (docs/contacts.md).
 *   bilinear  Delta H (1 - q)/2: its mean over contacts is that of Delta H in equilibrium, if the map is reversible,
 *             and its scatter is smaller by an order of dt.
 *
 * Energies and forces are written apart from src/fiber, so that either can tell on the other. */
#ifndef UNCROSS_CONTACTS_H
#define UNCROSS_CONTACTS_H

#include "../../tests/statistics.h"
#include "contact/takeoff.h"
#include "energy.h"
#include "measure.h"
#include "theory/theory.h"

enum { CONTACTS_MOST_VERTICES = 128 };

/* Sums over the contacts of a part of the run. */
struct contact_sums {
  double contacts, heat, bilinear, square, balance, naive; /* naive: q with J = a'/a for every contact */
  double softened, softened_heat, self, again;             /* again: same pair as in this drift or the one before */
  double largest;
};

struct contact_watch {
  const struct run *run;
  struct contact_sums sums;
  double start, length; /* of the drift at hand, t0; start: from the middle between two kicks */
  uint32_t drift;
  uint64_t *last; /* open hash of pairs: step of their last contact */
  uint64_t *key;
};

/* --- one or two fibers, in the middle of the drift ---------------------------------------------------------------- */

struct contact_chain {
  const struct fiber_kind *kind;
  uint32_t first, n;
  struct vec3 x[CONTACTS_MOST_VERTICES], v[CONTACTS_MOST_VERTICES];
};

/* Potential energy; adds to force. Open fibers and rings. */
static inline double contact_chain_forces(const struct contact_chain *c, const struct vec3 *x, struct vec3 *force)
{
  struct vec3 before = {0, 0, 0};
  double length_before = 0.0, energy = 0.0;
  const uint32_t bonds = c->kind->ring ? c->n : c->n - 1;
  for (uint32_t i = 0; i < c->n; i++)
    force[i] = (struct vec3){0, 0, 0};
  for (uint32_t j = 0; j < bonds + (c->kind->ring ? 1 : 0); j++) {
    const uint32_t a = (j + c->n - 1) % c->n, b = j % c->n, d = (j + 1) % c->n;
    const struct vec3 bond = vec3_sub(x[d], x[b]);
    const double length = vec3_norm(bond);
    const struct vec3 u = vec3_scale(1.0 / length, bond);
    if (j < bonds) {
      const double stretch = length - c->kind->bond_length;
      energy += 0.5 * c->kind->spring * stretch * stretch;
      force[b] = vec3_add_scaled(force[b], c->kind->spring * stretch, u);
      force[d] = vec3_add_scaled(force[d], -c->kind->spring * stretch, u);
    }
    if (j > 0) {
      const double cosine = vec3_dot(before, u);
      const struct vec3 to_a = vec3_scale(-c->kind->bending / length_before, vec3_add_scaled(u, -cosine, before)),
                        to_d = vec3_scale(c->kind->bending / length, vec3_add_scaled(before, -cosine, u));
      energy += c->kind->bending * (1.0 - cosine);
      force[a] = vec3_add(force[a], to_a);
      force[d] = vec3_add(force[d], to_d);
      force[b] = vec3_sub(force[b], vec3_add(to_a, to_d));
    }
    before = u;
    length_before = length;
  }
  return energy;
}

/* H of a chain; second: with its terms of second order in dt. */
static inline double contact_chain_energy(const struct contact_chain *c, double dt, bool second)
{
  static struct vec3 here[CONTACTS_MOST_VERTICES], ahead[CONTACTS_MOST_VERTICES], behind[CONTACTS_MOST_VERTICES],
      moved[CONTACTS_MOST_VERTICES];
  const double by = 1e-5;
  double energy = contact_chain_forces(c, c->x, here), curvature = 0.0, squares = 0.0;
  for (uint32_t i = 0; i < c->n; i++)
    energy += 0.5 * c->kind->mass * vec3_dot(c->v[i], c->v[i]);
  if (!second)
    return energy;
  for (uint32_t i = 0; i < c->n; i++)
    moved[i] = vec3_add_scaled(c->x[i], by, c->v[i]);
  contact_chain_forces(c, moved, ahead);
  for (uint32_t i = 0; i < c->n; i++)
    moved[i] = vec3_add_scaled(c->x[i], -by, c->v[i]);
  contact_chain_forces(c, moved, behind);
  for (uint32_t i = 0; i < c->n; i++) {
    curvature -= vec3_dot(c->v[i], vec3_sub(ahead[i], behind[i])) / (2.0 * by);
    squares += vec3_dot(here[i], here[i]) / c->kind->mass;
  }
  return energy - dt * dt / 24.0 * curvature + dt * dt / 12.0 * squares;
}

/* --- a contact ---------------------------------------------------------------------------------------------------- */

struct contact_at {
  uint32_t vertex[4];
  double lever[4];
  struct vec3 before[4]; /* velocities */
};

/* The place of a vertex at a tick of the drift at hand. */
static inline struct point contact_place(const struct run *r, uint32_t v, int64_t tick)
{
  const struct point p = r->state.position[v], rate = takeoff_rate_now(&r->state, &r->work.contact, v);
  return (struct point){p.x + rate.x * tick, p.y + rate.y * tick, p.z + rate.z * tick};
}

static inline double contact_energy(const struct contact_watch *w, const struct contact_at *at, int64_t tick,
                                    double tau, bool after, struct vec3 *force_at)
{
  static struct contact_chain chain;
  static struct vec3 here[CONTACTS_MOST_VERTICES], contact[CONTACTS_MOST_VERTICES];
  const struct run *r = w->run;
  const uint32_t fiber[2] = {r->model.fiber_of[at->vertex[0]], r->model.fiber_of[at->vertex[2]]};
  double energy = 0.0;
  for (int f = 0; f < (fiber[0] == fiber[1] ? 1 : 2); f++) {
    chain.first = r->model.fiber_first[fiber[f]];
    chain.n = r->model.fiber_first[fiber[f] + 1] - chain.first;
    chain.kind = &r->model.kind[r->model.fiber_kind_of[fiber[f]]];
    if (chain.n > CONTACTS_MOST_VERTICES)
      exit(3);
    const struct point origin = contact_place(r, chain.first, tick);
    for (uint32_t i = 0; i < chain.n; i++) {
      const uint32_t v = chain.first + i;
      contact[i] = point_difference(contact_place(r, v, tick), origin);
      chain.v[i] = r->state.velocity[v];
      for (int k = 0; k < 4 && !after; k++)
        if (at->vertex[k] == v)
          chain.v[i] = at->before[k];
      chain.x[i] = vec3_add_scaled(contact[i], -tau, chain.v[i]);
    }
    energy += contact_chain_energy(&chain, r->model.time_step, true);
    if (!force_at)
      continue;
    contact_chain_forces(&chain, contact, here);
    for (int k = 0; k < 4; k++)
      if (at->vertex[k] >= chain.first && at->vertex[k] < chain.first + chain.n)
        force_at[k] = here[at->vertex[k] - chain.first];
  }
  return energy;
}

/* True if this pair had a contact in this step or the one before. */
static inline bool contact_again(struct contact_watch *w, uint64_t bond, uint64_t other, uint64_t step)
{
  const uint64_t key = bond << 32 | other;
  const size_t slot = (size_t)(key * 0x9e3779b97f4a7c15u >> 44);
  const bool again = w->key[slot] == key && step <= w->last[slot] + 1;
  w->key[slot] = key;
  w->last[slot] = step;
  return again;
}

static void contact_look(void *context, const struct contact_event *e)
{
  struct contact_watch *w = context;
  const struct run *r = w->run;
  const uint32_t b = e->moving_bond, o = e->standing_bond;
  struct contact_at at = {{b, (uint32_t)r->model.next[b], o, (uint32_t)r->model.next[o]},
                          {1.0 - e->hit.s, e->hit.s, e->hit.s_standing - 1.0, -e->hit.s_standing},
                          {{0, 0, 0}}};
  const int64_t tick = (int64_t)(e->hit.time * FLIGHT_TICKS + 0.5);
  const double tau = w->start + w->length * e->hit.time;
  double approach = 0.0, rebound = 0.0, pull = 0.0;
  struct vec3 force[4];
  for (int k = 0; k < 4; k++) {
    const double inverse = r->model.inverse_mass[at.vertex[k]];
    const struct vec3 now = r->state.velocity[at.vertex[k]];
    at.before[k] = vec3_add_scaled(now, at.lever[k] * e->impulse * inverse, e->hit.normal);
    approach += at.lever[k] * vec3_dot(at.before[k], e->hit.normal);
    rebound -= at.lever[k] * vec3_dot(now, e->hit.normal);
  }
  const double before = contact_energy(w, &at, tick, tau, false, force);
  const double heat = contact_energy(w, &at, tick, tau, true, NULL) - before;
  for (int k = 0; k < 4; k++)
    pull += at.lever[k] * vec3_dot(force[k], e->hit.normal) * r->model.inverse_mass[at.vertex[k]];
  /* Where a' differs from a + 2 h it is a multiple of a. */
  const double free_rebound = approach + 2.0 * tau * pull;
  const bool softened = fabs(rebound - free_rebound) > 1e-6 * (approach + fabs(free_rebound));
  const double ratio = rebound / approach, jacobian = softened ? ratio * ratio * ratio : ratio;
  const double q = jacobian * exp(-heat);
  struct contact_sums *s = &w->sums;
  s->contacts += 1.0;
  s->heat += heat;
  s->bilinear += 0.5 * heat * (1.0 - q);
  s->square += heat * heat;
  s->balance += q;
  s->naive += ratio * exp(-heat);
  s->softened += softened;
  s->softened_heat += softened ? heat : 0.0;
  s->self += r->model.fiber_of[b] == r->model.fiber_of[o];
  s->again += contact_again(w, b, o, r->state.step);
  s->largest = fmax(s->largest, fabs(heat));
}

static void contact_stage(void *context, const char *name, const struct state *state)
{
  struct contact_watch *w = context;
  (void)state;
  if (strcmp(name, "drift") == 0)
    w->start += w->length;
}

static inline void contact_watch_start(struct contact_watch *w, const struct run *run)
{
  memset(w, 0, sizeof *w);
  w->run = run;
  w->last = calloc((size_t)1 << 20, sizeof *w->last);
  w->key = calloc((size_t)1 << 20, sizeof *w->key);
}

static inline void contact_watch_end(struct contact_watch *w)
{
  free(w->last);
  free(w->key);
}

static inline void contact_step(struct run *run, struct contact_watch *w)
{
  const struct contact_log log = {contact_look, w};
  const struct step_watch watch = {contact_stage, w};
  const bool halves = run->model.scheme == SCHEME_DRIFT_SPLIT && step_collides(&run->model, run->state.step + 1);
  w->start = -0.5 * run->model.time_step;
  w->length = run->model.time_step * (halves ? 0.5 : 1.0);
  stop_unless(step_advance_watched(&run->state, &run->model, &run->work, &log, &watch), run);
}

#endif
