#include "solvent/solvent.h"

/* Moves one Cartesian component of all particles by its whole flight, wrapped once, and lets the body force act on the
 * velocity over that time: Padding 2009, Eq. (7). Returns a value with its sign bit set if some particle is still
 * outside the box, or moved beyond what lattice_round can hold. */
static int64_t stream_component(uint32_t n, int64_t *restrict x, double *restrict v, double t, double a, int64_t edge)
{
  const double gain = a * t;
  int64_t outside = 0;
  for (uint32_t i = 0; i < n; i++) {
    int64_t p =
        (int64_t)((uint64_t)x[i] + (uint64_t)state_flight(v[i], a, t)); /* wraps, where a sum of int64 may not */
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

/* Finishes what one wrap did not, for n particles from number `first` on: folds those that flew further than a box
 * edge, and finds those for which the flight itself was out of range. lattice_round of a displacement beyond its range,
 * or of a NaN, is some integer: so the velocity, not the position, is judged. */
static bool fold_far(struct state *state, const struct model *model, struct work *work, double t, uint32_t first,
                     uint32_t n)
{
  struct solvent *s = &state->solvent;
  int64_t *x[3] = {s->x, s->y, s->z};
  double *v[3] = {s->vx, s->vy, s->vz};
  for (int k = 0; k < 3; k++)
    for (uint32_t i = first; i < first + n; i++) {
      if (!(fabs(v[k][i] * t) < LATTICE_MAX_MOVE))
        return work_fault(work, FAULT_SOLVENT_MOVE, state->step + 1, s->id[i], v[k][i] * t, LATTICE_MAX_MOVE);
      x[k][i] = lattice_fold(x[k][i], model->box.edge[k]);
    }
  return true;
}

bool solvent_stream_some(struct state *state, const struct model *model, struct work *work, uint32_t first, uint32_t n)
{
  struct solvent *s = &state->solvent;
  const double t = 0.5 * state->solvent_lag * model->time_step;
  const struct vec3 a = model->solvent.acceleration;
  const int64_t *edge = model->box.edge;
  int64_t outside = stream_component(n, &s->x[first], &s->vx[first], t, a.x, edge[0]);
  outside |= stream_component(n, &s->y[first], &s->vy[first], t, a.y, edge[1]);
  outside |= stream_component(n, &s->z[first], &s->vz[first], t, a.z, edge[2]);
  return outside >= 0 || fold_far(state, model, work, t, first, n);
}

bool solvent_stream(struct state *state, const struct model *model, struct work *work)
{
  const bool ok = solvent_stream_some(state, model, work, 0, state->solvent.n);
  state->solvent_lag = 0;
  return ok;
}
