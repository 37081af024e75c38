/*
 * Forces of pairs: see repulsion.h. A step sums them in fixed point: what a member gets is what its partner gives, to
 * the bit, and no order of pairs matters. With many bodies a first search sums the densities, and a second one the
 * forces.
 */
#include "medium/repulsion.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "medium/near.h"

static const double pi = 3.14159265358979323846;

/* The weight of a density is crowd_factor (1 - r/d)^2. */
static double crowd_factor(double d)
{
  return 15.0 / (2.0 * pi * d * d * d);
}

/* --- one block of pairs --------------------------------------------------------------------------------------------
 */

/* a of each pair, kT/a0. */
static void strengths(const struct near_search *s, const struct near_pairs *p, double *a)
{
  const struct medium_model *m = &s->model->medium;
  const uint32_t first = m->second.first, particles = s->model->solvent.particles;
  for (uint32_t k = 0; k < p->n; k++)
    a[k] = m->repulsion;
  if (m->second.share == 0.0)
    return;
  for (uint32_t k = 0; k < p->n; k++) {
    const uint32_t i = s->medium->number[p->a[k]], j = s->medium->number[p->b[k]];
    if ((i >= first && i < particles) != (j >= first && j < particles))
      a[k] = m->second.repulsion;
  }
}

static inline double crowd_at(const struct medium *m, uint32_t place)
{
  return (double)m->crowd[place] * CROWD_UNIT;
}

/* F over r of each pair: a0^-2 kT. */
static void pushes(const struct near_search *s, const struct near_pairs *p, double *push)
{
  const double b = s->model->medium.many.repulsion, inverse = 1.0 / s->model->medium.many.range;
  strengths(s, p, push);
  for (uint32_t k = 0; k < p->n; k++)
    push[k] *= 1.0 - p->r[k];
  for (uint32_t k = 0; b != 0.0 && k < p->n; k++) {
    const double near = 1.0 - p->r[k] * inverse;
    if (near > 0.0)
      push[k] += b * near * (crowd_at(s->medium, p->a[k]) + crowd_at(s->medium, p->b[k]));
  }
  for (uint32_t k = 0; k < p->n; k++)
    push[k] /= p->r[k];
}

static bool add_crowd(const struct near_search *s, struct near_pairs *p)
{
  const double d = s->model->medium.many.range, factor = crowd_factor(d) * CROWD_SCALE;
  for (uint32_t k = 0; k < p->n; k++) {
    const double near = 1.0 - p->r[k] / d;
    const int64_t w = near > 0.0 ? lattice_round(factor * near * near) : 0;
    s->medium->crowd[p->a[k]] += w;
    s->medium->crowd[p->b[k]] += w;
  }
  return true;
}

static bool add_pushes(const struct near_search *s, struct near_pairs *p)
{
  double push[NEAR_BLOCK];
  int64_t x[NEAR_BLOCK], y[NEAR_BLOCK], z[NEAR_BLOCK];
  pushes(s, p, push);
  for (uint32_t k = 0; k < p->n; k++) {
    const double scaled = push[k] * REPULSION_SCALE;
    x[k] = lattice_round(scaled * p->x[k]);
    y[k] = lattice_round(scaled * p->y[k]);
    z[k] = lattice_round(scaled * p->z[k]);
  }
  for (uint32_t k = 0; k < p->n; k++) {
    int64_t *a = &s->medium->push[3 * p->a[k]], *b = &s->medium->push[3 * p->b[k]];
    a[0] += x[k], a[1] += y[k], a[2] += z[k];
    b[0] -= x[k], b[1] -= y[k], b[2] -= z[k];
  }
  return true;
}

static bool add_pushes_and_list(const struct near_search *s, struct near_pairs *p)
{
  return add_pushes(s, p) && encounters_list(s, p);
}

static bool over_pairs(const struct model *model, struct medium *m,
                       bool (*look)(const struct near_search *, struct near_pairs *), void *context)
{
  const struct near_search search = {.model = model, .medium = m, .look = look, .context = context};
  return near_find(&search);
}

static void find_crowds(const struct model *model, struct medium *m)
{
  if (model->medium.many.repulsion == 0.0)
    return;
  memset(m->crowd, 0, m->members * sizeof *m->crowd);
  over_pairs(model, m, add_crowd, NULL);
}

/* With a choice, encounters are listed by the same search. False if memory is short for them. */
static bool find_forces(const struct model *model, struct medium *m, struct encounter_choice *choice)
{
  find_crowds(model, m);
  memset(m->push, 0, 3 * (size_t)m->members * sizeof *m->push);
  if (!over_pairs(model, m, choice ? add_pushes_and_list : add_pushes, choice))
    return false;
  for (uint32_t k = 0; k < m->members; k++) {
    const int64_t *f = &m->push[3 * k];
    m->force[m->number[k]] = vec3_scale(REPULSION_UNIT, (struct vec3){(double)f[0], (double)f[1], (double)f[2]});
  }
  return true;
}

/* --- a step --------------------------------------------------------------------------------------------------------
 */

/* Members at the places of now. */
static bool gather_now(struct state *state, const struct model *model, struct medium *medium, struct fault *fault)
{
  if (state->solvent_lag > 0 && !medium->fluid->stream(state, model, 0, state->solvent.n, fault))
    return false;
  state_streamed(state);
  members_gather(state, model, medium);
  return true;
}

bool repulsion_forces(struct state *state, const struct model *model, struct medium *medium, struct fault *fault)
{
  return gather_now(state, model, medium, fault) && find_forces(model, medium, NULL);
}

bool repulsion_forces_and_encounters(struct state *state, const struct model *model, struct medium *medium,
                                     uint64_t step, struct fault *fault)
{
  if (!gather_now(state, model, medium, fault))
    return false;
  struct encounter_choice choice = encounters_begin(model, medium, step);
  return find_forces(model, medium, &choice) || fault_no_memory(fault, step);
}

void repulsion_kick(struct state *state, const struct model *model, const struct medium *medium, double fraction)
{
  const double dt = fraction * model->time_step;
  struct solvent *s = &state->solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    const struct vec3 f = medium->force[s->id[i]];
    s->vx[i] += dt * f.x;
    s->vy[i] += dt * f.y;
    s->vz[i] += dt * f.z;
  }
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v] = vec3_add_scaled(state->velocity[v], dt * model->inverse_mass[v], medium->force[s->n + v]);
}

/* --- sums for observers --------------------------------------------------------------------------------------------
 */

struct summing {
  struct repulsion_sums *sums;
  struct vec3 *slope; /* [members] of the density about a place; with many bodies */
  double *curve;      /* [members] sum of the squares of the slopes of its weights; the same */
};

/* 1 for each end of a pair that may move. */
static double free_ends(const struct near_search *s, const struct near_pairs *p, uint32_t k)
{
  const struct model *m = s->model;
  const uint32_t n = m->solvent.particles, i = s->medium->number[p->a[k]], j = s->medium->number[p->b[k]];
  return (i < n || !model_is_held(m, i - n)) + (j < n || !model_is_held(m, j - n));
}

/* Of a density's weight w at the distance r: -w' and w'' + 2 w'/r. */
static void add_slopes(const struct near_search *s, const struct near_pairs *p, uint32_t k, double ends)
{
  const struct summing *t = s->context;
  const struct medium_model *m = &s->model->medium;
  const double d = m->many.range, near = 1.0 - p->r[k] / d, factor = crowd_factor(d), r = p->r[k];
  const uint32_t a = p->a[k], b = p->b[k];
  if (near <= 0.0)
    return;
  const double first = -2.0 * factor * near / d, second = 2.0 * factor / (d * d);
  const double derived = pi * d * d * d * d * m->many.repulsion / 15.0;
  const struct vec3 e = vec3_scale(first / r, (struct vec3){p->x[k], p->y[k], p->z[k]});
  t->slope[a] = vec3_add(t->slope[a], e);
  t->slope[b] = vec3_sub(t->slope[b], e);
  t->curve[a] += first * first;
  t->curve[b] += first * first;
  t->sums->laplacian += ends * derived * (crowd_at(s->medium, a) + crowd_at(s->medium, b)) * (second + 2.0 * first / r);
}

static bool add_sums(const struct near_search *s, struct near_pairs *p)
{
  const struct summing *t = s->context;
  struct repulsion_sums *sums = t->sums;
  const uint32_t n = p->n;
  double push[NEAR_BLOCK], a[NEAR_BLOCK];
  pushes(s, p, push);
  strengths(s, p, a);
  for (uint32_t k = 0; k < n; k++) {
    const double near = 1.0 - p->r[k], ends = free_ends(s, p, k);
    sums->energy += 0.5 * a[k] * near * near;
    sums->virial[STRESS_XY] += push[k] * p->x[k] * p->y[k];
    sums->virial[STRESS_XX] += push[k] * p->x[k] * p->x[k];
    sums->virial[STRESS_YY] += push[k] * p->y[k] * p->y[k];
    sums->virial[STRESS_ZZ] += push[k] * p->z[k] * p->z[k];
    sums->laplacian += ends * a[k] * (1.0 - 2.0 * near / p->r[k]);
    if (t->slope)
      add_slopes(s, p, k, ends);
  }
  return true;
}

/* psi of the densities, and the part of the Laplacian that comes from psi''. */
static void add_crowds(const struct model *model, const struct medium *m, const struct summing *t)
{
  const double d = model->medium.many.range, factor = pi * d * d * d * d * model->medium.many.repulsion / 30.0;
  for (uint32_t k = 0; k < m->members && t->slope; k++) {
    t->sums->energy += factor * crowd_at(m, k) * crowd_at(m, k);
    t->sums->laplacian += 2.0 * factor * (vec3_dot(t->slope[k], t->slope[k]) + t->curve[k]);
  }
}

static void exchange(struct medium *m, uint32_t i, uint32_t j)
{
  const double x = m->x[i], y = m->y[i], z = m->z[i];
  const uint32_t number = m->number[i];
  m->x[i] = m->x[j], m->y[i] = m->y[j], m->z[i] = m->z[j], m->number[i] = m->number[j];
  m->x[j] = x, m->y[j] = y, m->z[j] = z, m->number[j] = number;
}

/* Sorts the members of each cell by number: sums in doubles then do not depend on the order in memory. */
static void settle(const struct model *model, struct medium *m)
{
  const uint32_t cells = (uint32_t)box_cell_count(&model->box);
  for (uint32_t c = 0; c < cells; c++)
    for (uint32_t k = m->first[c] + 1; k < m->first[c + 1]; k++)
      for (uint32_t i = k; i > m->first[c] && m->number[i] < m->number[i - 1]; i--)
        exchange(m, i, i - 1);
}

bool repulsion_measure(const struct state *state, const struct model *model, struct vec3 *force,
                       struct repulsion_sums *sums)
{
  struct medium medium;
  memset(sums, 0, sizeof *sums);
  if (!model_repels(model))
    return true;
  if (!medium_alloc(&medium, model, NULL))
    return false;
  struct summing summing = {.sums = sums};
  const size_t crowded = model->medium.many.repulsion != 0.0 ? medium.members : 0;
  const struct memory_need need[] = {{(void **)&summing.slope, crowded, sizeof *summing.slope},
                                     {(void **)&summing.curve, crowded, sizeof *summing.curve}};
  const bool ok = memory_take(need, 2);
  if (ok) {
    members_gather(state, model, &medium);
    settle(model, &medium);
    find_forces(model, &medium, NULL);
    over_pairs(model, &medium, add_sums, &summing);
    add_crowds(model, &medium, &summing);
    if (force)
      memcpy(force, medium.force, medium.members * sizeof *force);
  }
  memory_release(need, 2);
  medium_free(&medium);
  return ok;
}
