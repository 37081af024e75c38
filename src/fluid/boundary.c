#include "fluid/boundary.h"

#include "system/fluid.h"
#include "wall/motion.h"

static bool boundaries_move(const struct model *model)
{
  return (model_has_walls(model) || model_is_sheared(model)) && model->solvent.interval_steps > 0;
}

struct span boundary_lag(const struct state *state, const struct model *model)
{
  return (struct span){.time = 0.5 * state->solvent_lag * model->time_step,
                       .begin = state->solvent_time,
                       .end = state->solvent_time + state->solvent_lag,
                       .interval = boundaries_move(model) ? shear_interval(model, state->solvent_time) : 0,
                       .acceleration = fluid_acceleration(state, model)};
}

int64_t boundary_fly_periodic(uint32_t n, int64_t *restrict x, double *restrict v, double t, double a, int64_t edge)
{
  const double gain = a * t;
  int64_t outside = 0;
  for (uint32_t i = 0; i < n; i++) {
    int64_t p = (int64_t)((uint64_t)x[i] + (uint64_t)boundary_flight(v[i], a, t)); /* wraps; a sum of int64 may not */
    p += p < 0 ? edge : 0;
    p -= p >= edge ? edge : 0;
    outside |= p | (int64_t)((uint64_t)(edge - 1) - (uint64_t)p);
    x[i] = p;
  }
  if (gain != 0.0)
    for (uint32_t i = 0; i < n; i++)
      v[i] += gain;
  return outside;
}

/* Beyond its range, or for a NaN, lattice_round gives an arbitrary integer. So the test uses the velocity, not the
 * position. */
bool boundary_fold(struct state *state, const struct model *model, int axis, double t, uint32_t first, uint32_t n,
                   struct fault *fault)
{
  struct solvent *s = &state->solvent;
  int64_t *x[3] = {s->x, s->y, s->z};
  const double *v[3] = {s->vx, s->vy, s->vz};
  for (uint32_t i = first; i < first + n; i++) {
    const double move = v[axis][i] * t;
    if (!(fabs(move) < LATTICE_MAX_MOVE))
      return fault_record(fault, FAULT_SOLVENT_MOVE, state->step + 1, s->id[i], move, LATTICE_MAX_MOVE);
    x[axis][i] = lattice_fold(x[axis][i], model->box.edge[axis]);
  }
  return true;
}

static bool fly_periodic(struct state *state, const struct model *model, const struct span *span, uint32_t first,
                         uint32_t n, struct fault *fault)
{
  struct solvent *s = &state->solvent;
  const double t = span->time;
  const struct vec3 a = span->acceleration;
  const int64_t *edge = model->box.edge;
  int64_t outside = boundary_fly_periodic(n, &s->x[first], &s->vx[first], t, a.x, edge[0]);
  outside |= boundary_fly_periodic(n, &s->y[first], &s->vy[first], t, a.y, edge[1]);
  outside |= boundary_fly_periodic(n, &s->z[first], &s->vz[first], t, a.z, edge[2]);
  return outside >= 0 ||
         (boundary_fold(state, model, 0, t, first, n, fault) && boundary_fold(state, model, 1, t, first, n, fault) &&
          boundary_fold(state, model, 2, t, first, n, fault));
}

static void now_periodic(const struct model *model, const struct span *span, struct point *x, struct vec3 *v)
{
  const struct vec3 a = span->acceleration;
  const int64_t *edge = model->box.edge;
  *x = (struct point){lattice_fold(x->x + boundary_flight(v->x, a.x, span->time), edge[0]),
                      lattice_fold(x->y + boundary_flight(v->y, a.y, span->time), edge[1]),
                      lattice_fold(x->z + boundary_flight(v->z, a.z, span->time), edge[2])};
  *v = vec3_add_scaled(*v, span->time, a);
}

const struct boundary boundary_periodic = {"periodic", fly_periodic, now_periodic};

const struct boundary *boundary_of(const struct box *box)
{
  static const struct boundary *const boundaries[BOUNDARIES] = {[BOUNDARY_PERIODIC] = &boundary_periodic,
                                                                [BOUNDARY_WALL] = &boundary_walls,
                                                                [BOUNDARY_SHEAR] = &boundary_sheared};
  return boundaries[box->boundary[1]];
}
