/* boundary_fly_periodic once more (boundary.h), of LANES particles at once: the same operations in the same order; and
 * what is done after a flight that it does not reach (flight_far). */
#ifndef UNCROSS_FLUID_FLIGHT_LANES_H
#define UNCROSS_FLUID_FLIGHT_LANES_H

#include "base/registers.h"
#include "fluid/boundary.h"

/* What one periodic axis of the flight needs. Lengths are in lattice units: a scale of 2^40 does not change how a
 * product rounds. */
struct flight {
  int64_t *x;
  double *v;
  double time; /* in lattice units per a0/t0 */
  double fall; /* a t^2/2 of the acceleration a */
  double gain; /* a t, a0/t0; if there is none -0.0, which changes no number that it is added to */
  uint64_t edge;
};

/* Along this axis, for the time by which the solvent is late. */
static inline struct flight flight_along(const struct state *state, const struct model *model, int axis)
{
  const struct solvent *s = &state->solvent;
  const struct span span = boundary_lag(state, model);
  const struct vec3 accelerations = span.acceleration;
  const double t = span.time, a = (const double[]){accelerations.x, accelerations.y, accelerations.z}[axis];
  return (struct flight){.x = (int64_t *[]){s->x, s->y, s->z}[axis],
                         .v = (double *[]){s->vx, s->vy, s->vz}[axis],
                         .time = t * LATTICE_PER_A0,
                         .fall = 0.5 * a * t * t * LATTICE_PER_A0,
                         .gain = a * t != 0.0 ? a * t : -0.0,
                         .edge = (uint64_t)model->box.edge[axis]};
}

/* The flight of LANES particles from place i on. Returns their coordinates after it. *v: their velocities then. *seen
 * remembers whether one is outside of the box (see, was_outside). */
INLINE words flight_lanes(const struct flight *f, uint32_t i, const bool accelerated, reals *v, words *seen)
{
  const reals before = load_reals(&f->v[i]), way = before * f->time;
  const words p = wrap(load_words(&f->x[i]) + round_to_words(accelerated ? way + f->fall : way), f->edge);
  *seen = see(*seen, p, f->edge);
  store_words(&f->x[i], p);
  *v = accelerated ? before + f->gain : before;
  if (accelerated)
    store_reals(&f->v[i], *v);
  return p;
}

/* True if n particles, a multiple of LANES, from place i on would end in [0, below) along this axis, where nothing
 * accelerates them. */
INLINE bool flight_stays_lanes(const struct flight *f, uint32_t i, uint32_t n, uint64_t below)
{
  words seen = {0};
  for (uint32_t k = i; k < i + n; k += LANES)
    seen = see(seen, load_words(&f->x[k]) + round_to_words(load_reals(&f->v[k]) * f->time), below);
  return (int64_t)any(was_outside(seen, below)) >= 0;
}

/* Particles begin .. flown - 1 have flown, one of them more than an edge out of the box. The others up to `end` follow,
 * and all from `begin` on are looked at, as fly_periodic of boundary.c does: so the fault is the same. The same for a
 * block that is clear of walls, or of the end of a sheared box: nothing of it is folded along y. */
static inline bool flight_far(struct state *state, const struct model *model, uint32_t begin, uint32_t flown,
                              uint32_t end, struct fault *fault)
{
  const struct solvent *s = &state->solvent;
  const struct span span = boundary_lag(state, model);
  const double a[3] = {span.acceleration.x, span.acceleration.y, span.acceleration.z};
  int64_t *const x[3] = {&s->x[flown], &s->y[flown], &s->z[flown]};
  double *const v[3] = {&s->vx[flown], &s->vy[flown], &s->vz[flown]};
  for (int k = 0; k < 3; k++)
    boundary_fly_periodic(end - flown, x[k], v[k], span.time, a[k], model->box.edge[k]);
  for (int k = 0; k < 3; k++)
    if (!boundary_fold(state, model, k, span.time, begin, end - begin, fault))
      return false;
  return true;
}

#endif
