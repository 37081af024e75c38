/*
 * Motion of fibers: averages against lag time, per kind of fiber, one table "dynamics-<kind>" with a row per lag. Names
 * and meanings of its columns are in docs/observables.md.
 *
 * Lags are 1, 2, 3, 4, 6, 8, 12, 16, 24, ... samples: 2^k and 3 2^(k-1). Each lag has an origin of its own, a copy of
 * all positions: when the lag has passed, origin and present are compared, and the present becomes the origin.
 * Intervals of a lag thus follow each other without overlap, and all lags together cost less than 8/3 comparisons per
 * sample.
 *
 * The displacement of the centres of mass that all fibers of a kind share is its drift. What is left about it gives a
 * diffusion coefficient under a force; see add_drift in dynamics.c.
 *
 * Displacements are exact differences of lattice points, minus the common displacement of everything (background.h).
 */
#ifndef UNCROSS_OBSERVE_DYNAMICS_H
#define UNCROSS_OBSERVE_DYNAMICS_H

#include "system/model.h"

/* Motion of one fiber between an origin and now. A quantity that the kind does not have is 0. */
struct fiber_motion {
  double vertices;           /* a0^2: squared displacement of its vertices, averaged */
  double center;             /* a0^2: of its centre of mass */
  struct vec3 moved;         /* a0: displacement of its centre of mass */
  double middle;             /* a0^2: of its middle vertex */
  double tube, tube_contour; /* a0^2: squared distance of the middle vertex now from the nearest vertex, and from the
                                nearest point of the contour, then */
  double tube_third;         /* a0^2: tube_contour averaged over vertices of the middle third */
  double turned; /* a0^2: |R(t) - R(0)|^2 / 2 of the end-to-end vector R; open fibers only, as the following */
  double square; /* a0^2: (R(0)^2 + R(t)^2) / 2, so that R(0).R(t) = square - turned */
  double cosine; /* of the angle between R(0) and R(t) */
  double axis; /* of the angle by which the regression axis sum (j - (n - 1)/2) r_j has turned; small bends leave it */
};

/* Measures the motion of a fiber. origin, now: [vertices]; drift: displacement of the frame, a0; scratch: [vertices].
 * The second is the plain way, for fibers of many vertices and those that went far: same bits, four times as slow. */
struct fiber_motion fiber_motion(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                                 struct vec3 drift, struct vec3 *scratch);
struct fiber_motion fiber_motion_plain(const struct fiber_kind *kind, const struct point *origin,
                                       const struct point *now, struct vec3 drift, struct vec3 *scratch);

/* The middle vertex, counted from 0: the paper's m = N_v/2, counted from 1, for even N_v; the middle one for odd N_v.
 */
static inline uint32_t dynamics_middle(const struct fiber_kind *kind)
{
  return (kind->vertices - 1) / 2;
}

/* Vertices that stand for the middle third of a fiber: at most 8, and at least 1. Its neighborhood changes over some
 * entanglement lengths, so more would say little more. */
static inline uint32_t dynamics_third(const struct fiber_kind *kind)
{
  const uint32_t third = kind->vertices / 3;
  return third > 8 ? 8 : third > 0 ? third : 1;
}

/* Vertex number k of them, counted from 0; they are spread evenly. */
static inline uint32_t dynamics_third_vertex(const struct fiber_kind *kind, uint32_t k)
{
  const uint32_t third = kind->vertices / 3;
  return third + (2 * k + 1) * third / (2 * dynamics_third(kind));
}

/* Lag number k = 0, 1, 2, ..., in samples. */
static inline uint64_t dynamics_lag(uint32_t k)
{
  return k % 2 ? (uint64_t)1 << (k + 1) / 2 : k ? (uint64_t)3 << (k / 2 - 1) : 1;
}

#endif
