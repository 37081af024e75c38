/*
 * One collision cell: its sums, and what every collision rule computes from them. Nothing here depends on grid, box or
 * memory. Members are masses and velocities; solvent particles and fiber vertices are treated alike.
 *
 *   cell_add     adds a member to its cell's sums
 *   cell_solve   velocity of the center of mass, and whether there are two members or more
 *   cell_energy  twice the kinetic energy of a member that a thermostat scales
 *
 * Momentum is summed in integers (2^-44 m a0/t0), so the sums do not depend on the order of the members. The rounding
 * changes a cell's momentum by about 2^-44 sqrt(members), 1e-13, in each collision; docs/accuracy.md measures it.
 */
#ifndef UNCROSS_MPC_CELL_H
#define UNCROSS_MPC_CELL_H

#include "base/random.h"
#include "mpc/mpc.h"
#include "wall/account.h"

#define CELL_MOMENTUM_SCALE ACCOUNT_SCALE /* momentum units per m a0/t0 */
#define CELL_MOMENTUM_UNIT ACCOUNT_UNIT
#define CELL_MEMBER ((uint64_t)1 << 40) /* one member, in cell_sum.load */
#define CELL_MASS_SCALE 0x1p16          /* mass units per m, in cell_sum.load */
#define CELL_MASS_UNIT 0x1p-16
#define CELL_ENERGY_SCALE 0x1p32 /* energy units per kT */
#define CELL_ENERGY_UNIT 0x1p-32

/* load of a member of this mass; exact for multiples of MODEL_MASS_UNIT */
static inline uint64_t cell_load(double mass)
{
  return CELL_MEMBER + (uint64_t)(mass * CELL_MASS_SCALE + 0.5);
}

static inline uint32_t cell_members(const struct cell_sum *sum)
{
  return (uint32_t)(sum->load >> 40);
}

static inline double cell_mass(const struct cell_sum *sum)
{
  return (double)(sum->load & (CELL_MEMBER - 1)) * CELL_MASS_UNIT;
}

/* Counts a cell among all of them (struct solved). */
static inline void cell_count(const struct cell_sum *sum, struct solved *all)
{
  all->loads |= sum->load;
  all->others += cell_members(sum) - (cell_members(sum) > 0);
}

/* Adds a member. Returns a number that is at least the size of each momentum component, in momentum units; it is
 * 2^63 - 1 if a component was out of range or not a number (llrint gives INT64_MIN then). */
static inline uint64_t cell_add(struct cell_sum *sum, double mass, uint64_t load, struct vec3 v)
{
  const double scale = mass * CELL_MOMENTUM_SCALE;
  int64_t px = llrint(scale * v.x), py = llrint(scale * v.y), pz = llrint(scale * v.z);
  sum->px = (int64_t)((uint64_t)sum->px + (uint64_t)px); /* unsigned: it may wrap, see overflow.h */
  sum->py = (int64_t)((uint64_t)sum->py + (uint64_t)py);
  sum->pz = (int64_t)((uint64_t)sum->pz + (uint64_t)pz);
  sum->load += load;
  return (uint64_t)(px ^ (px >> 63)) | (uint64_t)(py ^ (py >> 63)) | (uint64_t)(pz ^ (pz >> 63));
}

/* v_cm of a cell: its momentum over its mass (below Eq. (6)). */
static inline struct vec3 cell_center(const struct cell_sum *sum)
{
  double scale = CELL_MOMENTUM_UNIT / cell_mass(sum);
  return (struct vec3){(double)sum->px * scale, (double)sum->py * scale, (double)sum->pz * scale};
}

/* Sets the center of a cell, and factor 1; the collision rule sets the rest of `turn`. A member that is alone keeps its
 * velocity.
 */
static inline void cell_solve(const struct cell_sum *sum, struct cell_turn *turn)
{
  turn->active = cell_members(sum) >= 2;
  turn->factor = 1.0;
  if (turn->active != 0.0)
    turn->center = cell_center(sum);
}

/* Twice a member's kinetic energy relative to its cell's v_cm. 0 if it is alone: cell_solve sets no center then, and
 * turn->center is left over from an earlier collision. */
static inline double cell_energy(const struct cell_turn *turn, double mass, struct vec3 v)
{
  struct vec3 w = vec3_sub(v, turn->center);
  return turn->active * mass * vec3_dot(w, w);
}

/* The same in units of 2^-32 kT, as cells sum it; beyond their range it has the sign bit. */
static inline uint64_t cell_whole_energy(const struct cell_turn *turn, double mass, struct vec3 v)
{
  return (uint64_t)llrint(CELL_ENERGY_SCALE * cell_energy(turn, mass, v));
}

#endif
