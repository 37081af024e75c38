#include "fiber/force.h"

/* Derivative of bond_energy; positive pulls the ends of the bond together. */
static inline double bond_tension(const struct fiber_kind *k, double length)
{
  return k->spring * (length - k->bond_length);
}

/* Padding 2009, Eq. (1), with k = K/l0. */
static inline double bond_energy(const struct fiber_kind *k, double length)
{
  return 0.5 * k->spring * (length - k->bond_length) * (length - k->bond_length);
}

/* Padding 2009, Eq. (2), with kappa = l_p/l0. Its forces are derived in force.h. */
static inline double bend_energy(const struct fiber_kind *k, double cosine)
{
  return k->bending * (1.0 - cosine);
}

static double longest_bond(const struct model *model)
{
  return 0.5 * box_shortest_edge(&model->box);
}

static bool bond_fits(struct work *work, const struct model *model, uint64_t step, uint32_t j, double squared)
{
  const double limit = longest_bond(model);
  return squared < limit * limit || work_fault(work, FAULT_BOND_TOO_LONG, step, j, sqrt(squared), limit);
}

static void add_pair(struct vec3 *force, uint32_t j, uint32_t next, struct vec3 f)
{
  force[j] = vec3_add(force[j], f);
  force[next] = vec3_sub(force[next], f);
}

enum { BLOCK = 64 }; /* bonds or bends worked on at a time, in loops that vectorise */

/* Consecutive bonds first .. first + n - 1, n <= BLOCK; next: the other end of the first; number: of the first in its
 * fiber. */
struct bonds {
  uint32_t first, next, number, n;
};

/* Bond vectors; false, with the fault recorded, if one is too long. */
static bool measure_bonds(const struct state *state, const struct model *model, struct work *work, uint64_t step,
                          struct bonds b, struct vec3 *restrict r)
{
  const struct point *restrict from = &state->position[b.first], *restrict to = &state->position[b.next];
  const double limit = longest_bond(model);
  int64_t beyond = 0;
  for (uint32_t k = 0; k < b.n; k++) {
    r[k] = point_difference(to[k], from[k]);
    beyond |= !(vec3_dot(r[k], r[k]) < limit * limit);
  }
  bool ok = true;
  for (uint32_t k = 0; beyond && k < b.n; k++)
    ok = ok && bond_fits(work, model, step, b.first + k, vec3_dot(r[k], r[k]));
  return ok;
}

/* Springs without a rest length pull along the bond vector itself: no square root. */
static void pull_of_zero_length(struct fiber_work *f, const struct fiber_kind *kind, struct bonds b,
                                struct vec3 *restrict r)
{
  (void)f;
  for (uint32_t k = 0; k < b.n; k++)
    r[k] = vec3_scale(kind->spring, r[k]);
}

static void pull(struct fiber_work *f, const struct fiber_kind *kind, struct bonds b, struct vec3 *restrict r)
{
  struct vec3 *restrict direction = &f->direction[b.number];
  double *restrict inverse_length = &f->inverse_length[b.number];
  for (uint32_t k = 0; k < b.n; k++) {
    const double length = sqrt(vec3_dot(r[k], r[k])), inverse = length > 0.0 ? 1.0 / length : 0.0;
    inverse_length[k] = inverse;
    direction[k] = vec3_scale(inverse, r[k]);
    r[k] = vec3_scale(bond_tension(kind, length), vec3_scale(inverse, r[k]));
  }
}

static bool springs_of(const struct state *state, const struct model *model, struct work *work, uint64_t step,
                       const struct fiber_kind *kind, struct bonds b)
{
  const bool plain = kind->bond_length == 0.0 && kind->bending == 0.0;
  struct vec3 r[BLOCK];
  const bool ok = measure_bonds(state, model, work, step, b, r);
  (plain ? pull_of_zero_length : pull)(&work->fiber, kind, b, r);
  for (uint32_t k = 0; k < b.n; k++)
    add_pair(work->fiber.force, b.first + k, b.next + k, r[k]);
  return ok;
}

static uint32_t at_most(uint32_t n)
{
  return n < BLOCK ? n : BLOCK;
}

static bool springs(const struct state *state, const struct model *model, struct work *work, uint64_t step,
                    const struct fiber_kind *kind, uint32_t first)
{
  const uint32_t last = first + kind->vertices - 1;
  bool ok = true;
  for (uint32_t j = first; j < last; j += BLOCK)
    ok &= springs_of(state, model, work, step, kind, (struct bonds){j, j + 1, j - first, at_most(last - j)});
  if (kind->ring)
    ok &= springs_of(state, model, work, step, kind, (struct bonds){last, first, last - first, 1});
  return ok;
}

/* Bends at n <= BLOCK vertices of the fiber whose forces these are, from number i on, between bonds `before` and i, and
 * so on; `after`: the end of bond i. */
static void bends_at(const struct fiber_work *f, struct vec3 *force, const struct fiber_kind *kind, uint32_t before,
                     uint32_t i, uint32_t after, uint32_t n)
{
  const struct vec3 *restrict u0 = &f->direction[before], *restrict u1 = &f->direction[i];
  const double *restrict inverse0 = &f->inverse_length[before], *restrict inverse1 = &f->inverse_length[i];
  struct vec3 on_before[BLOCK], on_after[BLOCK];
  for (uint32_t k = 0; k < n; k++) {
    const double cosine = vec3_dot(u0[k], u1[k]);
    on_before[k] = vec3_scale(-kind->bending * inverse0[k], vec3_add_scaled(u1[k], -cosine, u0[k]));
    on_after[k] = vec3_scale(kind->bending * inverse1[k], vec3_add_scaled(u0[k], -cosine, u1[k]));
  }
  for (uint32_t k = 0; k < n; k++) {
    force[before + k] = vec3_add(force[before + k], on_before[k]);
    force[after + k] = vec3_add(force[after + k], on_after[k]);
    force[i + k] = vec3_sub(force[i + k], vec3_add(on_before[k], on_after[k]));
  }
}

static void bends(const struct fiber_work *f, struct vec3 *force, const struct fiber_kind *kind)
{
  const uint32_t last = kind->vertices - 1;
  if (kind->ring)
    bends_at(f, force, kind, last, 0, 1, 1);
  for (uint32_t i = 1; i < last; i += BLOCK)
    bends_at(f, force, kind, i - 1, i, i + 1, at_most(last - i));
  if (kind->ring)
    bends_at(f, force, kind, last - 1, last, 0, 1);
}

bool fiber_forces(const struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  bool ok = true;
  for (uint32_t n = 0; n < model->fibers; n++) {
    const struct fiber_kind *kind = &model->kind[model->fiber_kind_of[n]];
    const uint32_t first = model->fiber_first[n];
    for (uint32_t v = first; v < first + kind->vertices; v++)
      work->fiber.force[v] = kind->force;
    if (kind->vertices < 2)
      continue;
    ok &= springs(state, model, work, step, kind, first);
    if (kind->bending != 0.0)
      bends(&work->fiber, &work->fiber.force[first], kind);
  }
  return ok;
}

/* Padding 2009, Eq. (8). */
void fiber_kick(struct state *state, const struct model *model, const struct work *work, double fraction)
{
  const double dt = fraction * model->time_step;
  struct vec3 *restrict velocity = state->velocity;
  const struct vec3 *restrict force = work->fiber.force;
  const double *restrict inverse_mass = model->inverse_mass;
  for (uint32_t v = 0; v < state->vertices; v++)
    velocity[v] = vec3_add_scaled(velocity[v], dt * inverse_mass[v], force[v]);
}

struct fiber_energy fiber_energies(const struct state *state, const struct model *model)
{
  struct fiber_energy e = {0.0, 0.0};
  for (uint32_t j = 0; j < state->vertices; j++) {
    if (model->next[j] < 0)
      continue;
    const struct fiber_kind *kind = &model->kind[model->fiber_kind_of[model->fiber_of[j]]];
    struct vec3 r = fiber_bond(state, model, j);
    e.bond += bond_energy(kind, vec3_norm(r));
    if (kind->bending != 0.0 && model->prev[j] >= 0) {
      struct vec3 before = fiber_bond(state, model, (uint32_t)model->prev[j]);
      double lengths = vec3_norm(before) * vec3_norm(r);
      e.bend += bend_energy(kind, lengths > 0.0 ? vec3_dot(before, r) / lengths : 0.0); /* as the forces have it */
    }
  }
  return e;
}
