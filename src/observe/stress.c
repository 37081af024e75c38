/*
 * The stress of the solvent, averaged over the collisions since the row before (mpc/stress.h), and the stress on walls,
 * from the momentum that they have given since then (system/account.h).
 */
#include <math.h>
#include <string.h>

#include "mpc/stress.h"
#include "observe/observer.h"
#include "system/account.h"

enum { ROWS = WALLS * ACCOUNT_SHARES };
enum { MARK, LAST_STEP, LAST_ACCOUNT, LAST_TURNS = LAST_ACCOUNT + ROWS, INTEGERS = LAST_TURNS + ROWS };

static void size_stress(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  (void)observer;
  size->reals = stress_doubles(model);
  size->integers = INTEGERS;
}

/* Momentum along x that a wall has given since the row before, m a0/t0. */
static double given(const struct observer *o, const struct state *state, enum wall wall)
{
  double sum = 0.0;
  for (int share = 0; share < ACCOUNT_SHARES; share++) {
    const uint32_t row = account_row((enum account_share)share, wall);
    sum += account_along(o->integer[LAST_ACCOUNT + row], (uint64_t)o->integer[LAST_TURNS + row],
                         state->wall_momentum[row].x, state->wall_turns[row]);
  }
  return sum;
}

static void stress_row(struct observer *o, struct view *view, double *row)
{
  const struct model *model = view->model;
  const struct state *state = view->state;
  struct mpc_stress *s = (struct mpc_stress *)o->real;
  const double area = (double)model->box.cells[0] * model->box.cells[2], n = s->collisions;
  const double passed = (double)((int64_t)state->step - o->integer[LAST_STEP]) * model->time_step;
  const bool walls = model_has_walls(model) && passed > 0.0;
  double kinetic[STRESS_COMPONENTS], collisional[STRESS_COMPONENTS], spring[STRESS_COMPONENTS] = {0};
  double total[STRESS_COMPONENTS];
  for (int k = 0; k < STRESS_COMPONENTS; k++) {
    kinetic[k] = n > 0.0 ? -s->kinetic[k] / n : NAN;
    collisional[k] = n > 0.0 ? -s->collisional[k] / (n * model_collision_interval(model)) : NAN;
    if (model_has_dumbbells(model))
      spring[k] = n > 0.0 ? s->spring[k] / n : NAN;
    total[k] = kinetic[k] + collisional[k] + spring[k];
  }
  const double trace = total[STRESS_XX] + total[STRESS_YY] + (model->dimensions > 2 ? total[STRESS_ZZ] : 0.0);
  const double values[] = {view_time(view),
                           total[STRESS_XY],
                           kinetic[STRESS_XY],
                           collisional[STRESS_XY],
                           total[STRESS_XX] - total[STRESS_YY],
                           -trace / model->dimensions,
                           walls ? -given(o, state, WALL_LOWER) / (area * passed) : NAN,
                           walls ? given(o, state, WALL_UPPER) / (area * passed) : NAN,
                           spring[STRESS_XY],
                           spring[STRESS_XX] - spring[STRESS_YY]};
  memcpy(row, values, sizeof values);
  memset(s, 0, stress_doubles(model) * sizeof(double));
  o->integer[LAST_STEP] = (int64_t)state->step;
  for (uint32_t k = 0; k < (model_has_walls(model) ? ROWS : 0); k++) {
    o->integer[LAST_ACCOUNT + k] = state->wall_momentum[k].x;
    o->integer[LAST_TURNS + k] = (int64_t)state->wall_turns[k];
  }
}

static const char *const columns[] = {
    "time",     "sigma_xy",    "sigma_xy_kinetic", "sigma_xy_collisional", "N1",
    "pressure", "sigma_lower", "sigma_upper",      "sigma_xy_spring",      "N1_spring"};

const struct observer_type stress_observer = {
    .column = columns,
    .columns = sizeof columns / sizeof *columns,
    .of_dumbbells = 2,
    .size = size_stress,
    .row = stress_row,
};
