/*
 * The stress of the solvent, averaged over the collisions since the row before (mpc/stress.h); that of fibers at the
 * step of the row; that of contacts of thick fibers since the row before (observe/handed_on.h); and the stress on
 * walls, from the momentum that they have given since the row before (wall/account.h).
 *
 * Fibers: -(1/volume) sum of M w_a w_b + F_a r_b, w being the velocity of a vertex relative to the applied flow, F the
 * force of its bonds and bends, and r its place. These forces have no sum within a fiber, so the origin does not
 * matter. At a contact thin bonds are at one place and get opposite impulses: such contacts add nothing.
 */
#include <math.h>
#include <string.h>

#include "fiber/force.h"
#include "mpc/stress.h"
#include "observe/background.h"
#include "observe/handed_on.h"
#include "observe/observer.h"
#include "wall/account.h"

enum { ROWS = WALLS * ACCOUNT_SHARES };
enum { MARK, LAST_STEP, LAST_ACCOUNT, LAST_TURNS = LAST_ACCOUNT + ROWS, INTEGERS = LAST_TURNS + ROWS };

static void size_stress(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  size->reals = stress_doubles(model);
  size->integers = INTEGERS;
  handed_on_size(observer, model, size);
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

/* --- fibers ------------------------------------------------------------------------------------------------------ */

static void add_products(double sum[STRESS_COMPONENTS], double factor, struct vec3 a, struct vec3 b)
{
  sum[STRESS_XY] += factor * a.x * b.y;
  sum[STRESS_XX] += factor * a.x * b.x;
  sum[STRESS_YY] += factor * a.y * b.y;
  sum[STRESS_ZZ] += factor * a.z * b.z;
}

/* Sums over all vertices. */
static void fiber_stress(const struct view *view, double stress[STRESS_COMPONENTS])
{
  const struct model *model = view->model;
  const struct state *state = view->state;
  const double scale = -1.0 / box_volume(&model->box);
  struct fault ignored = {.code = FAULT_NONE}; /* a bond too long for the box stops the run, not its observers */
  double sum[STRESS_COMPONENTS] = {0};
  if (state->vertices > 0)
    fiber_forces(state, model, view->force, state->step, &ignored);
  for (uint32_t i = 0; i < state->vertices; i++) {
    const uint32_t fiber = model->fiber_of[i];
    const struct point at = state->position[i];
    const struct vec3 force = view->force[i], outer = model->kind[model->fiber_kind_of[fiber]].force,
                      w = background_peculiar(model, state, i, force, background_applied);
    if (!model_is_overdamped(model))
      add_products(sum, model->mass[i], w, w);
    add_products(sum, 1.0, vec3_sub(force, outer), point_difference(at, state->position[model->fiber_first[fiber]]));
  }
  for (int k = STRESS_XX; k <= STRESS_ZZ && model_is_overdamped(model); k++)
    sum[k] += state->vertices; /* kT of each: velocities have been averaged over */
  for (int k = 0; k < STRESS_COMPONENTS; k++)
    stress[k] = scale * sum[k];
}

/* --- a row ------------------------------------------------------------------------------------------------------- */

/* From here on the next row counts. */
static void begin(struct observer *o, const struct model *model, const struct state *state)
{
  memset(o->real, 0, stress_doubles(model) * sizeof(double));
  o->integer[LAST_STEP] = (int64_t)state->step;
  for (uint32_t k = 0; k < (model_has_walls(model) ? ROWS : 0); k++) {
    o->integer[LAST_ACCOUNT + k] = state->wall_momentum[k].x;
    o->integer[LAST_TURNS + k] = (int64_t)state->wall_turns[k];
  }
}

/* A row that has nothing to average over is left out: the next one averages over its time as well. */
static bool stress_row(struct observer *o, struct view *view, double *row)
{
  const struct model *model = view->model;
  const struct state *state = view->state;
  const struct mpc_stress *s = (struct mpc_stress *)o->real;
  const double area = (double)model->box.cells[0] * model->box.cells[2], n = s->collisions;
  const double passed = (double)(int64_t)(state->step - (uint64_t)o->integer[LAST_STEP]) * model->time_step;
  const bool walls = model_has_walls(model), solvent = model_has_solvent(model);
  double kinetic[STRESS_COMPONENTS], collisional[STRESS_COMPONENTS], spring[STRESS_COMPONENTS] = {0};
  double total[STRESS_COMPONENTS], fibers[STRESS_COMPONENTS], contacts[STRESS_COMPONENTS];
  if (passed == 0.0)
    begin(o, model, state);
  if ((solvent && n == 0.0) || (walls && passed == 0.0) || !handed_on_mean(o, view, contacts))
    return false;
  fiber_stress(view, fibers);
  for (int k = 0; k < STRESS_COMPONENTS; k++) {
    kinetic[k] = n > 0.0 ? -s->kinetic[k] / n : NAN;
    collisional[k] = n > 0.0 ? -s->collisional[k] / (n * model_collision_interval(model)) : NAN;
    if (model_has_dumbbells(model))
      spring[k] = n > 0.0 ? s->spring[k] / n : NAN;
    contacts[k] /= -box_volume(&model->box);
    total[k] = (solvent ? kinetic[k] + collisional[k] + spring[k] : 0.0) + fibers[k] + contacts[k];
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
                           spring[STRESS_XX] - spring[STRESS_YY],
                           fibers[STRESS_XY],
                           fibers[STRESS_XX] - fibers[STRESS_YY],
                           contacts[STRESS_XY],
                           contacts[STRESS_XX] - contacts[STRESS_YY]};
  memcpy(row, values, sizeof values);
  begin(o, model, state);
  return true;
}

static const char *const columns[] = {"time",
                                      "sigma_xy",
                                      "sigma_xy_kinetic",
                                      "sigma_xy_collisional",
                                      "N1",
                                      "pressure",
                                      "sigma_lower",
                                      "sigma_upper",
                                      "sigma_xy_spring",
                                      "N1_spring",
                                      "sigma_xy_fibers",
                                      "N1_fibers",
                                      "sigma_xy_contacts",
                                      "N1_contacts"};

const struct observer_type stress_observer = {
    .column = columns,
    .columns = sizeof columns / sizeof *columns,
    .size = size_stress,
    .row = stress_row,
    .contact = handed_on_add,
};
