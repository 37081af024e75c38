#include "mpc/stress.h"

#include <math.h>

#include "mpc/border.h"
#include "system/shear.h"

#define FIXED 0x1p28 /* units per kT: sums of up to 2^31 terms below 2^4 on average */
#define FIXED_UNIT 0x1p-28

/* The linear flow that the boundary asks for: velocity = at_zero + rate y along x. */
struct applied {
  struct vec3 at_zero, rate;
};

static struct applied applied_flow(const struct state *state, const struct model *model)
{
  /* The collision ends an interval: velocities are those of this one. */
  const uint64_t begins = shear_interval(model, state->solvent_time + state->solvent_lag);
  const uint64_t interval = begins > 0 ? begins - 1 : 0;
  const double edge = model->box.cells[1];
  if (model_has_walls(model)) {
    const struct vec3 low = shear_wall_velocity(model, WALL_LOWER, interval);
    const struct vec3 high = shear_wall_velocity(model, WALL_UPPER, interval);
    return (struct applied){low, vec3_scale(1.0 / edge, vec3_sub(high, low))};
  }
  const double rate = model_is_sheared(model) ? shear_rate(model, interval) : 0.0;
  return (struct applied){vec3_add(model->flow, (struct vec3){-0.5 * rate * edge, 0, 0}), {rate, 0, 0}};
}

static int64_t fixed(double x)
{
  return lattice_round(FIXED * x);
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

static void add_place(int64_t sum[STRESS_COMPONENTS], const struct mpc *c, struct point at, double mass, struct vec3 v)
{
  const double y = within(at.y, c->shift.y);
  sum[STRESS_XY] += fixed(mass * y * v.x);
  sum[STRESS_XX] += fixed(mass * within(at.x, c->shift.x) * v.x);
  sum[STRESS_YY] += fixed(mass * y * v.y);
  sum[STRESS_ZZ] += fixed(mass * within(at.z, c->shift.z) * v.z);
}

/* Adds sign times the sum of m b v_a over all members. */
static void add_places(const struct state *state, const struct model *model, struct mpc *c, double sign)
{
  const struct solvent *s = &state->solvent;
  const double edge = model->box.cells[1], bulk = model_has_walls(model) ? (edge - 1.0) / edge : 1.0;
  int64_t sum[STRESS_COMPONENTS] = {0};
  for (uint32_t i = 0; i < s->n; i++)
    if (in_whole_cell(model, c, s->y[i]))
      add_place(sum, c, (struct point){s->x[i], s->y[i], s->z[i]}, 1.0, solvent_velocity(s, i));
  for (uint32_t v = 0; v < state->vertices; v++)
    add_place(sum, c, state->position[v], model->mass[v], state->velocity[v]);
  for (int k = 0; k < STRESS_COMPONENTS; k++)
    c->stress->collisional[k] += sign * FIXED_UNIT * (double)sum[k] / (bulk * box_volume(&model->box));
}

/* --- kinetic ----------------------------------------------------------------------------------------------------- */

struct kinetic {
  int64_t n, wx, wy, wz, product[STRESS_COMPONENTS];
};

static void add_kinetic(struct kinetic *k, struct vec3 w)
{
  k->n++;
  k->wx += fixed(w.x);
  k->wy += fixed(w.y);
  k->wz += fixed(w.z);
  k->product[STRESS_XY] += fixed(w.x * w.y);
  k->product[STRESS_XX] += fixed(w.x * w.x);
  k->product[STRESS_YY] += fixed(w.y * w.y);
  k->product[STRESS_ZZ] += fixed(w.z * w.z);
}

/* Solvent particles. Those that entered the image beyond y = L have its velocities, so their y is there, too. */
static void sum_kinetic(const struct state *state, const struct model *model, const struct mpc *c, struct kinetic *k)
{
  const struct solvent *s = &state->solvent;
  const struct applied flow = applied_flow(state, model);
  const double half = 0.5 * model_collision_interval(model), edge = model->box.cells[1];
  const int64_t beyond = model_is_sheared(model) ? model->box.edge[1] - c->shift.y : INT64_MAX;
  for (uint32_t i = 0; i < s->n; i++) {
    const struct vec3 v = solvent_velocity(s, i);
    const double y = (double)s->y[i] * LATTICE_UNIT - (s->y[i] >= beyond ? edge : 0.0) - half * v.y;
    if (!model_has_walls(model) || (y >= 1.0 && y < edge - 1.0))
      add_kinetic(k, vec3_sub(v, vec3_add_scaled(flow.at_zero, y, flow.rate)));
  }
}

static void add_products(const struct model *model, struct mpc *c, const struct kinetic *k)
{
  const double edge = model->box.cells[1], bulk = model_has_walls(model) ? (edge - 2.0) / edge : 1.0;
  const double scale = FIXED_UNIT / (bulk * box_volume(&model->box)), n = k->n > 0 ? (double)k->n : 1.0;
  const double wx = (double)k->wx, wy = (double)k->wy, wz = (double)k->wz;
  const double common[STRESS_COMPONENTS] = {
      [STRESS_XY] = wx * wy, [STRESS_XX] = wx * wx, [STRESS_YY] = wy * wy, [STRESS_ZZ] = wz * wz};
  for (int a = 0; a < STRESS_COMPONENTS; a++)
    c->stress->kinetic[a] += scale * ((double)k->product[a] - FIXED_UNIT * common[a] / n);
}

void stress_before(const struct state *state, const struct model *model, struct mpc *mpc)
{
  struct kinetic k = {0};
  sum_kinetic(state, model, mpc, &k);
  add_products(model, mpc, &k);
  add_places(state, model, mpc, -1.0);
}

void stress_after(const struct state *state, const struct model *model, struct mpc *mpc)
{
  add_places(state, model, mpc, 1.0);
  mpc->stress->collisions += 1.0;
}
