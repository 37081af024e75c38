/* A fluid of independent particles, in free flight between collisions. */
#include "base/normal.h"
#include "fluid/boundary.h"
#include "fluid/fluid.h"

/* --- start ------------------------------------------------------------------------------------------------------- */

/* A uniform lattice coordinate along an edge of `cells` cells, from 64 random bits. */
static int64_t uniform_coordinate(uint64_t r, int cells)
{
  int64_t within = (int64_t)(r & (uint64_t)(LATTICE_CELL - 1));
  return (int64_t)(((r >> LATTICE_BITS) * (uint64_t)cells) >> (64 - LATTICE_BITS)) * LATTICE_CELL + within;
}

/* Uniform positions, Maxwell velocities. */
static void start_points(struct state *state, const struct model *model)
{
  struct solvent *s = &state->solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    uint32_t id = s->id[i];
    struct random_words xy = random_at(model->seed, RANDOM_SOLVENT_POSITION, 0, 0, id);
    struct random_words z = random_at(model->seed, RANDOM_SOLVENT_POSITION, 1, 0, id);
    s->x[i] = uniform_coordinate(random_u64(xy, 0), model->box.cells[0]);
    s->y[i] = uniform_coordinate(random_u64(xy, 1), model->box.cells[1]);
    s->z[i] = uniform_coordinate(random_u64(z, 0), model->box.cells[2]);
    double a[2], b[2];
    random_normal_pair(random_at(model->seed, RANDOM_SOLVENT_VELOCITY, 0, 0, id), a);
    random_normal_pair(random_at(model->seed, RANDOM_SOLVENT_VELOCITY, 1, 0, id), b);
    s->vx[i] = a[0];
    s->vy[i] = a[1];
    s->vz[i] = b[0];
  }
}

/* --- flight ------------------------------------------------------------------------------------------------------ */

static double lag_time(const struct state *state, const struct model *model)
{
  return 0.5 * state->solvent_lag * model->time_step;
}

/* Handles particles that `fly` left outside: folds those that flew further than a box edge, and records a fault for a
 * flight out of range. Beyond its range, or for a NaN, lattice_round gives an arbitrary integer. So the test uses the
 * velocity, not the position. */
static bool fold_far(struct state *state, const struct model *model, double t, uint32_t first, uint32_t n,
                     struct fault *fault)
{
  struct solvent *s = &state->solvent;
  int64_t *x[3] = {s->x, s->y, s->z};
  double *v[3] = {s->vx, s->vy, s->vz};
  for (int k = 0; k < 3; k++)
    for (uint32_t i = first; i < first + n; i++) {
      if (!(fabs(v[k][i] * t) < LATTICE_MAX_MOVE))
        return fault_record(fault, FAULT_SOLVENT_MOVE, state->step + 1, s->id[i], v[k][i] * t, LATTICE_MAX_MOVE);
      x[k][i] = boundary_of(&model->box, k)->fold(x[k][i], model->box.edge[k]);
    }
  return true;
}

static bool stream_points(struct state *state, const struct model *model, uint32_t first, uint32_t n,
                          struct fault *fault)
{
  struct solvent *s = &state->solvent;
  const double t = lag_time(state, model);
  const struct vec3 a = model->solvent.acceleration;
  const struct box *box = &model->box;
  int64_t outside = boundary_of(box, 0)->fly(n, &s->x[first], &s->vx[first], t, a.x, box->edge[0]);
  outside |= boundary_of(box, 1)->fly(n, &s->y[first], &s->vy[first], t, a.y, box->edge[1]);
  outside |= boundary_of(box, 2)->fly(n, &s->z[first], &s->vz[first], t, a.z, box->edge[2]);
  return outside >= 0 || fold_far(state, model, t, first, n, fault);
}

/* --- now --------------------------------------------------------------------------------------------------------- */

struct vec3 fluid_gain(const struct state *state, const struct model *model)
{
  return vec3_scale(lag_time(state, model), model->solvent.acceleration);
}

/* Where a coordinate is after a flight. */
static int64_t flown(int64_t x, double v, double t, double a, const struct box *box, int axis)
{
  return boundary_of(box, axis)->fold(x + boundary_flight(v, a, t), box->edge[axis]);
}

static void points_now(const struct state *state, const struct model *model, uint32_t first, uint32_t n,
                       struct point *position, struct vec3 *velocity)
{
  const struct solvent *p = &state->solvent;
  const double t = lag_time(state, model);
  const struct vec3 a = model->solvent.acceleration, gain = fluid_gain(state, model);
  for (uint32_t k = 0, i = first; k < n; k++, i++) {
    if (position)
      position[k] = (struct point){flown(p->x[i], p->vx[i], t, a.x, &model->box, 0),
                                   flown(p->y[i], p->vy[i], t, a.y, &model->box, 1),
                                   flown(p->z[i], p->vz[i], t, a.z, &model->box, 2)};
    if (velocity)
      velocity[k] = vec3_add(solvent_velocity(p, i), gain);
  }
}

const struct fluid fluid_points = {.name = "points", .start = start_points, .stream = stream_points, .now = points_now};
