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

static bool bond_fits(struct work *work, const struct model *model, uint64_t step, uint32_t j, double squared)
{
  const double limit = 0.5 * box_shortest_edge(&model->box);
  return squared < limit * limit || work_fault(work, FAULT_BOND_TOO_LONG, step, j, sqrt(squared), limit);
}

static void add_pair(struct vec3 *force, uint32_t j, uint32_t next, struct vec3 f)
{
  force[j] = vec3_add(force[j], f);
  force[next] = vec3_sub(force[next], f);
}

/* Springs without a rest length pull along the bond vector itself: no square root. */
static bool springs_of_zero_length(const struct state *state, const struct model *model, struct work *work,
                                   uint64_t step, const struct fiber_kind *kind, uint32_t first)
{
  bool ok = true;
  for (uint32_t j = first; j < first + kind->vertices; j++) {
    if (model->next[j] < 0)
      continue;
    struct vec3 r = fiber_bond(state, model, j);
    ok = ok && bond_fits(work, model, step, j, vec3_dot(r, r));
    add_pair(work->fiber.force, j, (uint32_t)model->next[j], vec3_scale(kind->spring, r));
  }
  return ok;
}

static bool springs(const struct state *state, const struct model *model, struct work *work, uint64_t step,
                    const struct fiber_kind *kind, uint32_t first)
{
  struct fiber_work *f = &work->fiber;
  bool ok = true;
  for (uint32_t j = first; j < first + kind->vertices; j++) {
    if (model->next[j] < 0)
      continue;
    struct vec3 r = fiber_bond(state, model, j);
    double squared = vec3_dot(r, r), length = sqrt(squared);
    ok = ok && bond_fits(work, model, step, j, squared);
    f->inverse_length[j] = length > 0.0 ? 1.0 / length : 0.0;
    f->direction[j] = vec3_scale(f->inverse_length[j], r);
    add_pair(f->force, j, (uint32_t)model->next[j], vec3_scale(bond_tension(kind, length), f->direction[j]));
  }
  return ok;
}

static void bends(const struct model *model, struct work *work, const struct fiber_kind *kind, uint32_t first)
{
  struct fiber_work *f = &work->fiber;
  for (uint32_t i = first; i < first + kind->vertices; i++) {
    if (model->prev[i] < 0 || model->next[i] < 0)
      continue;
    uint32_t before = (uint32_t)model->prev[i], after = (uint32_t)model->next[i];
    struct vec3 u0 = f->direction[before], u1 = f->direction[i];
    double cosine = vec3_dot(u0, u1);
    struct vec3 on_before = vec3_scale(-kind->bending * f->inverse_length[before], vec3_add_scaled(u1, -cosine, u0));
    struct vec3 on_after = vec3_scale(kind->bending * f->inverse_length[i], vec3_add_scaled(u0, -cosine, u1));
    f->force[before] = vec3_add(f->force[before], on_before);
    f->force[after] = vec3_add(f->force[after], on_after);
    f->force[i] = vec3_sub(f->force[i], vec3_add(on_before, on_after));
  }
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
    bool plain = kind->bond_length == 0.0 && kind->bending == 0.0;
    ok &= (plain ? springs_of_zero_length : springs)(state, model, work, step, kind, first);
    if (kind->bending != 0.0)
      bends(model, work, kind, first);
  }
  return ok;
}

/* Padding 2009, Eq. (8). */
void fiber_kick(struct state *state, const struct model *model, const struct work *work, double fraction)
{
  const double dt = fraction * model->time_step;
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v] = vec3_add_scaled(state->velocity[v], dt * model->inverse_mass[v], work->fiber.force[v]);
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
