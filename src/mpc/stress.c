#include "mpc/stress.h"

#include <math.h>

#include "mpc/border.h"
#include "wall/motion.h"

/* The flights that end: relative to the linear flow that the boundary asks for. */
static struct flux_frame frame_of(const struct state *state, const struct model *model, const struct mpc *c)
{
  const double time = model_collision_interval(model);
  const int64_t beyond = model_is_sheared(model) ? model->box.edge[1] - c->shift.y : INT64_MAX;
  /* The collision ends an interval: velocities are those of this one. */
  const uint64_t begins = shear_interval(model, state->solvent_time + state->solvent_lag);
  const uint64_t interval = begins > 0 ? begins - 1 : 0;
  const double edge = model->box.cells[1];
  if (model_has_walls(model)) {
    const struct vec3 low = shear_wall_velocity(model, WALL_LOWER, interval);
    const struct vec3 high = shear_wall_velocity(model, WALL_UPPER, interval);
    return (struct flux_frame){time, low, vec3_scale(1.0 / edge, vec3_sub(high, low)), beyond};
  }
  const double rate = model_is_sheared(model) ? shear_rate(model, interval) : 0.0;
  return (struct flux_frame){
      time, vec3_add(model->flow, (struct vec3){-0.5 * rate * edge, 0, 0}), {rate, 0, 0}, beyond};
}

/* Of the bulk, a0. */
static double bulk_height(const struct model *model)
{
  return model->box.cells[1] - (model_has_walls(model) ? 2.0 : 0.0);
}

/* The part of the place within its cell that is not a whole number of cells, about the cell's middle; a0. */
static double within(int64_t x, int64_t shift)
{
  return (double)((x + shift) & (LATTICE_CELL - 1)) * LATTICE_UNIT - 0.5;
}

/* --- collisional ------------------------------------------------------------------------------------------------- */

/* Members of the cells that no wall cuts: rows 1 to L - 1 of the rows 0 to L. */
static bool in_whole_cell(const struct model *model, const struct mpc *c, int64_t y)
{
  const int64_t row = (y + c->shift.y) >> LATTICE_BITS;
  return !model_has_walls(model) || (row > 0 && row < model->box.cells[1]);
}

/* What passes through planes below 1 or above L - 1 does not count: moving members onto these planes takes it away,
 * because a cell gives its members no momentum in all. */
static double within_bulk(const struct model *model, const struct mpc *c, int64_t y)
{
  const int64_t low = LATTICE_CELL, high = model->box.edge[1] - LATTICE_CELL;
  const double outside = model_has_walls(model) ? (double)((y < low ? low - y : 0) - (y > high ? y - high : 0)) : 0.0;
  return within(y, c->shift.y) + outside * LATTICE_UNIT;
}

static void add_place(int64_t sum[STRESS_COMPONENTS], const struct model *model, const struct mpc *c, struct point at,
                      double mass, struct vec3 v)
{
  const double y = within_bulk(model, c, at.y);
  sum[STRESS_XY] += flux_fixed(mass * y * v.x);
  sum[STRESS_XX] += flux_fixed(mass * within(at.x, c->shift.x) * v.x);
  sum[STRESS_YY] += flux_fixed(mass * y * v.y);
  sum[STRESS_ZZ] += flux_fixed(mass * within(at.z, c->shift.z) * v.z);
}

/* Adds sign times the sum of m b v_a over all members. */
static void add_places(const struct state *state, const struct model *model, struct mpc *c, double sign)
{
  const struct solvent *s = &state->solvent;
  const double edge = model->box.cells[1], rows = model_has_walls(model) ? edge - 1.0 : edge;
  const double height[STRESS_COMPONENTS] = {bulk_height(model), rows, bulk_height(model), rows};
  int64_t sum[STRESS_COMPONENTS] = {0};
  for (uint32_t i = 0; i < s->n; i++)
    if (in_whole_cell(model, c, s->y[i]))
      add_place(sum, model, c, (struct point){s->x[i], s->y[i], s->z[i]}, 1.0, solvent_velocity(s, i));
  for (uint32_t v = 0; v < state->vertices; v++)
    if (in_whole_cell(model, c, state->position[v].y))
      add_place(sum, model, c, state->position[v], model->mass[v], state->velocity[v]);
  for (int k = 0; k < STRESS_COMPONENTS; k++)
    c->stress->collisional[k] += sign * FLUX_UNIT * (double)sum[k] * edge / (height[k] * box_volume(&model->box));
}

/* --- kinetic ----------------------------------------------------------------------------------------------------- */

static void add_kinetic(struct flux_sum *k, struct vec3 w)
{
  k->n++;
  k->wx += flux_fixed(w.x);
  k->wy += flux_fixed(w.y);
  k->wz += flux_fixed(w.z);
  k->product[STRESS_XY] += flux_fixed(w.x * w.y);
  k->product[STRESS_XX] += flux_fixed(w.x * w.x);
  k->product[STRESS_YY] += flux_fixed(w.y * w.y);
  k->product[STRESS_ZZ] += flux_fixed(w.z * w.z);
}

/* Independent particles. Those that entered the image beyond y = L have its velocities, so their y is there, too. */
static void sum_kinetic(const struct state *state, const struct model *model, const struct flux_frame *frame,
                        struct flux_sum *k)
{
  const struct solvent *s = &state->solvent;
  const double half = 0.5 * frame->time, edge = model->box.cells[1];
  for (uint32_t i = 2 * state->dumbbells.n; i < s->n; i++) {
    const struct vec3 v = solvent_velocity(s, i);
    const double y = (double)s->y[i] * LATTICE_UNIT - (s->y[i] >= frame->beyond ? edge : 0.0) - half * v.y;
    if (!model_has_walls(model) || (y >= 1.0 && y < edge - 1.0))
      add_kinetic(k, vec3_sub(v, vec3_add_scaled(frame->at_zero, y, frame->rate)));
  }
}

static void add_springs(const struct model *model, struct mpc *c, const struct flux_sum *k)
{
  const double scale = FLUX_UNIT * model->box.cells[1] / (bulk_height(model) * box_volume(&model->box));
  for (int a = 0; a < STRESS_COMPONENTS; a++)
    c->stress->spring[a] += scale * (double)k->spring[a];
}

static void add_products(const struct model *model, struct mpc *c, const struct flux_sum *k)
{
  const double scale = FLUX_UNIT * model->box.cells[1] / (bulk_height(model) * box_volume(&model->box));
  const double n = k->n > 0 ? (double)k->n : 1.0;
  const double wx = (double)k->wx, wy = (double)k->wy, wz = (double)k->wz;
  const double common[STRESS_COMPONENTS] = {
      [STRESS_XY] = wx * wy, [STRESS_XX] = wx * wx, [STRESS_YY] = wy * wy, [STRESS_ZZ] = wz * wz};
  for (int a = 0; a < STRESS_COMPONENTS; a++)
    c->stress->kinetic[a] += scale * ((double)k->product[a] - FLUX_UNIT * common[a] / n);
}

void stress_before(const struct state *state, const struct model *model, struct mpc *mpc)
{
  struct flux_sum k = {0};
  const struct flux_frame frame = frame_of(state, model, mpc);
  sum_kinetic(state, model, &frame, &k);
  if (mpc->fluid->flux && model_has_dumbbells(model)) {
    mpc->fluid->flux(state, model, &frame, &k);
    add_springs(model, mpc, &k);
  }
  add_products(model, mpc, &k);
  add_places(state, model, mpc, -1.0);
}

void stress_after(const struct state *state, const struct model *model, struct mpc *mpc)
{
  add_places(state, model, mpc, 1.0);
  mpc->stress->collisions += 1.0;
}
