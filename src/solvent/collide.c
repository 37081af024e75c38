#include <string.h>

#include "solvent/solvent.h"
#include "solvent/srd.h"
#include "solvent/thermostat.h"

/* Particles are sorted by cell again after this many collisions: at the paper's mean free path of 0.02 a0 most
 * neighbors in memory are then still neighbors in space. */
#define COLLISIONS_PER_SORT 50

#define RELATIVE_SCALE 0x1p32

static struct vec3 solvent_velocity(const struct solvent *s, uint32_t i)
{
  return (struct vec3){s->vx[i], s->vy[i], s->vz[i]};
}

/* Sums of all cells. Returns the union of the members' momentum spans, see srd_add. */
static uint64_t sum_cells(const struct state *state, const struct model *model, struct work *work)
{
  const struct solvent *s = &state->solvent;
  struct collision_work *c = &work->collision;
  memset(c->sum, 0, (size_t)box_cell_count(&model->box) * sizeof *c->sum);
  uint64_t span = 0;
  const uint64_t load = srd_load(1.0);
  for (uint32_t i = 0; i < s->n; i++)
    span |= srd_add(&c->sum[c->solvent_cell[i]], 1.0, load, solvent_velocity(s, i));
  for (uint32_t v = 0; v < state->vertices; v++)
    span |= srd_add(&c->sum[c->vertex_cell[v]], model->mass[v], srd_load(model->mass[v]), state->velocity[v]);
  return span;
}

/* The sums are right if members times the largest momentum fits in 63 bits, and members times the largest mass in
 * 40. */
static bool check_range(const struct model *model, struct work *work, uint64_t span, uint64_t step)
{
  const struct cell_sum *sum = work->collision.sum;
  const int64_t cells = box_cell_count(&model->box);
  uint32_t most = 0;
  int64_t where = 0;
  for (int64_t k = 0; k < cells; k++)
    if (srd_members(&sum[k]) > most) {
      most = srd_members(&sum[k]);
      where = k;
    }
  double largest = ((double)span + 1.0) * SRD_MOMENTUM_UNIT;
  double limit = 0x1p63 * SRD_MOMENTUM_UNIT / most;
  if (!(largest < limit))
    return work_fault(work, FAULT_CELL_RANGE, step, where, largest, limit);
  if (!(most * model->max_mass < 0x1p24))
    return work_fault(work, FAULT_CELL_RANGE, step, where, most * model->max_mass, 0x1p24);
  return true;
}

static void solve_cells(const struct model *model, struct work *work, uint64_t step)
{
  struct collision_work *c = &work->collision;
  const int64_t cells = box_cell_count(&model->box);
  for (int64_t k = 0; k < cells; k++) {
    srd_solve(&c->sum[k], &c->turn[k]);
    if (c->turn[k].active != 0.0)
      c->turn[k].axis = random_axis(model->seed, RANDOM_ROTATION_AXIS, step, (uint32_t)k);
  }
}

/* Twice the kinetic energy of each cell's members relative to its v_cm, summed in integers as the momenta are. */
static bool sum_relative_energy(const struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  const struct solvent *s = &state->solvent;
  struct collision_work *c = &work->collision;
  memset(c->relative, 0, (size_t)box_cell_count(&model->box) * sizeof *c->relative);
  double total = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    struct vec3 w = vec3_sub(solvent_velocity(s, i), c->turn[c->solvent_cell[i]].center);
    total += vec3_dot(w, w);
    c->relative[c->solvent_cell[i]] += llrint(RELATIVE_SCALE * vec3_dot(w, w));
  }
  for (uint32_t v = 0; v < state->vertices; v++) {
    struct vec3 w = vec3_sub(state->velocity[v], c->turn[c->vertex_cell[v]].center);
    total += model->mass[v] * vec3_dot(w, w);
    c->relative[c->vertex_cell[v]] += llrint(RELATIVE_SCALE * model->mass[v] * vec3_dot(w, w));
  }
  const double limit = 0x1p62 / RELATIVE_SCALE; /* if all of them fit, so does each cell */
  return total < limit || work_fault(work, FAULT_CELL_RANGE, step, -1, total, limit);
}

/* Inlined twice, with quarter a constant in each. */
static inline __attribute__((always_inline)) void turn_members(struct state *state, const struct model *model,
                                                               const struct work *work, const bool quarter)
{
  struct solvent *s = &state->solvent;
  const struct cell_turn *turn = work->collision.turn;
  const uint32_t *cell = work->collision.solvent_cell;
  const double cosine = model->solvent.cosine, sine = model->solvent.sine;
  for (uint32_t i = 0; i < s->n; i++) {
    const struct cell_turn *t = &turn[cell[i]];
    if (t->active == 0.0)
      continue;
    struct vec3 v = srd_apply(t, solvent_velocity(s, i), quarter, cosine, sine);
    s->vx[i] = v.x;
    s->vy[i] = v.y;
    s->vz[i] = v.z;
  }
  for (uint32_t v = 0; v < state->vertices; v++) {
    const struct cell_turn *t = &turn[work->collision.vertex_cell[v]];
    if (t->active != 0.0)
      state->velocity[v] = srd_apply(t, state->velocity[v], quarter, cosine, sine);
  }
}

static void turn_quarter(struct state *state, const struct model *model, const struct work *work)
{
  turn_members(state, model, work, true);
}

static void turn_by_angle(struct state *state, const struct model *model, const struct work *work)
{
  turn_members(state, model, work, false);
}

bool solvent_collide(struct state *state, const struct model *model, struct work *work, uint64_t step)
{
  solvent_bin(state, model, work, solvent_grid_shift(model, step));
  if (!check_range(model, work, sum_cells(state, model, work), step))
    return false;
  solve_cells(model, work, step);
  if (model->solvent.thermostat != THERMOSTAT_NONE) {
    if (!sum_relative_energy(state, model, work, step))
      return false;
    thermostat_factors(work, model, step);
  }
  (model->solvent.cosine == 0.0 ? turn_quarter : turn_by_angle)(state, model, work);
  if (!model->solvent.hydrodynamics)
    solvent_swap_velocities(state, model, work, step);
  if (work->collision.since_sort++ % COLLISIONS_PER_SORT == 0)
    solvent_sort(state, model, work);
  return true;
}
