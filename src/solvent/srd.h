/*
 * The SRD collision rule: what happens in one cell (Padding 2009, Sec. III, step 4). It knows nothing of grids, boxes
 * or memory: members are masses and velocities, solvent particles and fiber vertices alike.
 *
 *   srd_add    what a member adds to its cell's sums
 *   srd_solve  the cell's transform, from its sums
 *   srd_energy twice the member's energy that a thermostat scales
 *   srd_apply  the transform of one member's velocity
 *
 * Momentum is summed in integers (2^-44 m a0/t0), so the sums do not depend on the order of the members. The price is
 * a momentum of the order of 2^-44 sqrt(members) per cell and collision, about 1e-13; docs/accuracy.md measures it.
 */
#ifndef UNCROSS_SRD_H
#define UNCROSS_SRD_H

#include <stdbool.h>

#include "base/random.h"
#include "state/work.h"

#define SRD_MOMENTUM_SCALE 0x1p44 /* momentum units per m a0/t0 */
#define SRD_MOMENTUM_UNIT 0x1p-44
#define SRD_MEMBER ((uint64_t)1 << 40) /* one member, in cell_sum.load */
#define SRD_MASS_SCALE 0x1p16          /* mass units per m, in cell_sum.load */
#define SRD_MASS_UNIT 0x1p-16
#define SRD_ENERGY_SCALE 0x1p32 /* energy units per kT */
#define SRD_ENERGY_UNIT 0x1p-32

/* load of a member of this mass; exact for multiples of MODEL_MASS_UNIT */
static inline uint64_t srd_load(double mass)
{
  return SRD_MEMBER + (uint64_t)(mass * SRD_MASS_SCALE + 0.5);
}

static inline uint32_t srd_members(const struct cell_sum *sum)
{
  return (uint32_t)(sum->load >> 40);
}

static inline double srd_mass(const struct cell_sum *sum)
{
  return (double)(sum->load & (SRD_MEMBER - 1)) * SRD_MASS_UNIT;
}

/* Adds a member. Returns a number that is at least the size of each momentum component, in momentum units; it is
 * 2^63 - 1 if a component was out of range or not a number (llrint gives INT64_MIN then). */
static inline uint64_t srd_add(struct cell_sum *sum, double mass, uint64_t load, struct vec3 v)
{
  const double scale = mass * SRD_MOMENTUM_SCALE;
  int64_t px = llrint(scale * v.x), py = llrint(scale * v.y), pz = llrint(scale * v.z);
  sum->px = (int64_t)((uint64_t)sum->px + (uint64_t)px); /* wraps, where signed addition may not: see range.h */
  sum->py = (int64_t)((uint64_t)sum->py + (uint64_t)py);
  sum->pz = (int64_t)((uint64_t)sum->pz + (uint64_t)pz);
  sum->load += load;
  return (uint64_t)(px ^ (px >> 63)) | (uint64_t)(py ^ (py >> 63)) | (uint64_t)(pz ^ (pz >> 63));
}

/* v_cm of a cell: its momentum over its mass (below Eq. (6)). */
static inline struct vec3 srd_center(const struct cell_sum *sum)
{
  double scale = SRD_MOMENTUM_UNIT / srd_mass(sum);
  return (struct vec3){(double)sum->px * scale, (double)sum->py * scale, (double)sum->pz * scale};
}

/* The transform of a cell, its axis still open; a lone member's velocity is left as it is. */
static inline void srd_solve(const struct cell_sum *sum, struct cell_turn *turn)
{
  turn->active = srd_members(sum) >= 2;
  turn->factor = 1.0;
  if (turn->active != 0.0)
    turn->center = srd_center(sum);
}

/* Twice a member's kinetic energy relative to its cell's v_cm. 0 if it is alone: srd_solve sets no center then, and
 * what stands there is that of an earlier collision. */
static inline double srd_energy(const struct cell_turn *turn, double mass, struct vec3 v)
{
  struct vec3 w = vec3_sub(v, turn->center);
  return turn->active * mass * vec3_dot(w, w);
}

/* w turned about n by 90 degrees: R w = n (n.w) + n x w. */
static inline struct vec3 srd_quarter_turn(struct vec3 w, struct vec3 n)
{
  return vec3_add(vec3_scale(vec3_dot(n, w), n), vec3_cross(n, w));
}

/* w turned about n by the angle of this cosine and sine (Rodrigues): R w = cos w + (1-cos) n (n.w) + sin n x w. */
static inline struct vec3 srd_turn(struct vec3 w, struct vec3 n, double cosine, double sine)
{
  struct vec3 along = vec3_scale((1.0 - cosine) * vec3_dot(n, w), n);
  return vec3_add(vec3_add(vec3_scale(cosine, w), along), vec3_scale(sine, vec3_cross(n, w)));
}

/* A member's velocity after the collision: Padding 2009, Eqs. (5) and (6); `scaled`: times the thermostat's factor. */
static inline struct vec3 srd_apply(const struct cell_turn *turn, struct vec3 v, bool quarter, double cosine,
                                    double sine, bool scaled)
{
  struct vec3 w = vec3_sub(v, turn->center);
  struct vec3 turned = quarter ? srd_quarter_turn(w, turn->axis) : srd_turn(w, turn->axis, cosine, sine);
  return scaled ? vec3_add_scaled(turn->center, turn->factor, turned) : vec3_add(turn->center, turned);
}

#endif
