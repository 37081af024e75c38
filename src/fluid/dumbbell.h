/*
 * Flights of dumbbells: two particles of mass m with the energy (K/2) r^2 of their distance r (Tao, Goetze and Gompper,
 * J. Chem. Phys. 128, 144902 (2008)). The center flies freely. The vector r from the second to the first, and its
 * velocity u, turn into each other at the frequency w = sqrt(2 K/m):
 *
 *   r(t) = r cos(w t) + (u/w) sin(w t),   u(t) = -w r sin(w t) + u cos(w t)
 *
 * which is exact for any time t.
 */
#ifndef UNCROSS_FLUID_DUMBBELL_H
#define UNCROSS_FLUID_DUMBBELL_H

#include "base/elementary.h"
#include "fluid/boundary.h"
#include "system/fluid.h"
#include "wall/account.h"

/* What the flights of all dumbbells for a time have in common. */
struct swing {
  double time, frequency; /* t, t0; w, 1/t0 */
  double return_r;        /* (cos(w t) - 1)/2: of r, in the change of r/2 */
  double advance_u;       /* sin(w t)/(2 w), t0: of u */
  double pull_r;          /* -w sin(w t)/2, 1/t0: of r, in u/2 at the end */
  double keep_u;          /* cos(w t)/2: of u */
};

/* frequency: w, 1/t0, above 0; time: t, t0. */
static inline struct swing swing_for(double frequency, double time)
{
  const double turns_per_radian = 0x1.45f306dc9c883p-3; /* 1/(2 pi) */
  const struct circle_point half = elementary_circle_turns(0.5 * frequency * time * turns_per_radian);
  const double sine = 2.0 * half.sine * half.cosine, square = half.sine * half.sine;
  return (struct swing){time, frequency, -square, 0.5 * sine / frequency, -0.5 * frequency * sine, 0.5 - square};
}

/* Dumbbells in a row: the particles 2p and 2p + 1 of one stand side by side. Along each axis x, y, z. */
struct pairs {
  uint32_t n;
  int64_t *at[3];    /* [2n] positions, lattice units */
  double *v[3];      /* [2n] a0/t0 */
  int64_t *apart[3]; /* [n] r, lattice units */
};

/* The longest vector and place of a dumbbell along an axis, lattice units: 2048 a0. */
#define LONGEST ((int64_t)1 << 51)

/* Lattice units as a double, below LONGEST either way. Unlike a conversion this form vectorises on every x86-64. */
static inline double pairs_real(int64_t x)
{
  const double magic = LATTICE_ROUND_MAGIC;
  return elementary_from_bits((uint64_t)x + elementary_bits(magic)) - magic;
}

/* The dumbbells at places first to first + n - 1 of the list. */
struct pairs pairs_of(const struct state *state, uint32_t first, uint32_t n);

/* All of them fly along one axis, with the acceleration a. If `edge` is not 0, particles are brought into [0, edge).
 * The result is not 0 if a flight was out of the range of lattice_round. */
int64_t pairs_fly(const struct pairs *pairs, int axis, const struct swing *swing, double a, int64_t edge);

/* The flights of dumbbells in a box, which they do not leave. */
struct dumbbell_boundary {
  const char *name;

  /* account: of hits. Not 0 if a flight was out of range. */
  int64_t (*fly)(const struct pairs *pairs, const struct model *model, const struct span *span,
                 const struct swing *swing, struct account account);
};

extern const struct dumbbell_boundary dumbbells_periodic, dumbbells_between_walls, dumbbells_sheared;

/* The boundary of a box along y. */
const struct dumbbell_boundary *dumbbell_boundary_of(const struct box *box);

/* The potential energy of the center of a dumbbell, kT, at a height y above the lower wall: 0 without such a
 * potential. */
double dumbbell_wall_energy(const struct model *model, double y);

/* The stress that dumbbells carry in flight: `flux` of struct fluid. */
void dumbbells_flux(const struct state *state, const struct model *model, const struct flux_frame *frame,
                    struct flux_sum *sum);

#endif
