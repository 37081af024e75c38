/*
 * The boundary of the box, for particles in flight. This is the contract of the rows in boundary.c, one for each kind
 * of boundary along y; x and z are periodic.
 *
 * Each particle flies on its own: free flight, and whatever happens at the boundary, at the exact time at which it
 * happens. `fly` and `now` give the same positions and velocities, to the bit.
 */
#ifndef UNCROSS_FLUID_BOUNDARY_H
#define UNCROSS_FLUID_BOUNDARY_H

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"
#include "wall/account.h"

/* A span of time for which particles fly. It is within one collision interval. */
struct span {
  double time;              /* t0 */
  uint64_t begin;           /* half time steps since the start */
  uint64_t end;             /* half time steps since the start */
  uint64_t interval;        /* number of the collision interval (wall/motion.h) */
  struct vec3 acceleration; /* constant, a0/t0^2 */
};

/* Particles that fly together between walls, or in a sheared box; blocks begin at multiples of this from `first`. If
 * several particles would move too far, the fault is of the first block that has one: so it is the same with any
 * kernel.
 */
enum { BOUNDARY_BLOCK = 64 };

/* Of n particles, those of the block that begins at i. */
static inline uint32_t boundary_block(uint32_t n, uint32_t i)
{
  return n - i < BOUNDARY_BLOCK ? n - i : BOUNDARY_BLOCK;
}

struct boundary {
  const char *name;

  /* n particles, from place `first` of memory on, fly for the span and stay in the box. False, with the fault recorded,
   * if one would move too far. */
  bool (*fly)(struct state *state, const struct model *model, const struct span *span, uint32_t first, uint32_t n,
              struct fault *fault);

  /* Position (lattice units, in the box) and velocity (a0/t0) of one particle after the flight. */
  void (*now)(const struct model *model, const struct span *span, struct point *position, struct vec3 *velocity);
};

/* The boundary of a box along y. */
const struct boundary *boundary_of(const struct box *box);

/* Displacement of a particle of velocity v in a time t under a constant acceleration a, in lattice units: one component
 * of Padding 2009, Eq. (3). It is exact over any number of time steps, and valid below LATTICE_MAX_MOVE. */
static inline int64_t boundary_flight(double v, double a, double t)
{
  return lattice_from_a0(v * t + 0.5 * a * t * t);
}

/* n particles fly for a time t under a constant acceleration a along a periodic axis. x: their coordinates, lattice
 * units. v: their velocities, a0/t0, which grow by a t (Padding 2009, Eq. (7), one Cartesian component). A particle
 * that is less than one edge outside the box at the end is brought inside. The sign bit of the result is set if a
 * particle is further outside, or if a flight was beyond the range of lattice_round. */
int64_t boundary_fly_periodic(uint32_t n, int64_t *restrict x, double *restrict v, double t, double a, int64_t edge);

/* Folds the coordinates of these particles along this axis into the box: those that boundary_fly_periodic left outside.
 * t: the time that they flew. False, with the fault recorded, for a flight out of range. */
bool boundary_fold(struct state *state, const struct model *model, int axis, double t, uint32_t first, uint32_t n,
                   struct fault *fault);

/* The span by which the solvent is late. A force with a profile acts at collisions (mpc/), not in flight. */
struct span boundary_lag(const struct state *state, const struct model *model);

/* How the next image along y of a sheared box differs from the box. */
struct slide {
  int64_t offset; /* along x, lattice units in [0, edge) */
  double speed;   /* along x, a0/t0 */
};

/* At a time, in half time steps since the start, within this collision interval. */
struct slide boundary_slide(const struct model *model, uint64_t half_steps, uint64_t interval);

/* Replaces a particle that may be outside along y by its image in the box. An image is at most LATTICE_MAX_MOVE away,
 * and an offset is below 2^50 lattice units: their product fits. */
static inline void boundary_bring_in(const struct box *box, struct slide slide, int64_t *x, int64_t *y, double *vx)
{
  if ((uint64_t)*y < (uint64_t)box->edge[1])
    return;
  const int64_t image = lattice_image(*y, box->edge[1]);
  *y -= image * box->edge[1];
  *x = lattice_fold(*x - image * slide.offset, box->edge[0]);
  *vx -= (double)image * slide.speed;
}

/* Enters what walls give to one particle in its flight. */
void boundary_enter_hits(const struct model *model, const struct span *span, struct point position,
                         struct vec3 velocity, struct account account);

extern const struct boundary boundary_periodic, boundary_walls, boundary_sheared;

#endif
