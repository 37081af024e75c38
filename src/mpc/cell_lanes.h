/* The formulas of cell.h and grid.c once more, of LANES members or cells at once: the same operations in the same
 * order. Columns of struct cell_sum and of struct cell_turn are those of base/records.h. */
#ifndef UNCROSS_MPC_CELL_LANES_H
#define UNCROSS_MPC_CELL_LANES_H

#include "base/records.h"
#include "mpc/cell.h"

_Static_assert(offsetof(struct cell_turn, center) == 0 && offsetof(struct cell_turn, active) == 3 * sizeof(double) &&
                   offsetof(struct cell_turn, axis) == 4 * sizeof(double) &&
                   offsetof(struct cell_turn, factor) == 7 * sizeof(double) &&
                   sizeof(struct cell_turn) == 8 * sizeof(double),
               "center, active, axis, factor");

/* cell_index of grid.c: places along an axis of coordinates in the box, of so many cells, less than 2^31. */
INLINE words cell_places_lanes(words x, uint64_t shift, uint32_t cells)
{
  return but_not((x + shift) >> LATTICE_BITS, cells);
}

/* Members but one of cells with these loads; all ones in cells without a member. */
INLINE words cell_others_lanes(words load)
{
  return (load >> 40) - 1;
}

/* All ones for cells with two members or more, else 0. */
INLINE words cell_collides_lanes(words others)
{
  return ~negative(others - 1);
}

#define CELL_LANES_MOST                                                                                                \
  ((uint64_t)1 << 51) /* of round_to_words: larger momenta and energies go to the plain functions */

/* What cell_add adds for particles of mass 1: momenta in units of the sums, where they are below CELL_LANES_MOST.
 * *span: or'ed with their sizes. */
INLINE reals cell_momenta_lanes(reals v, words *span)
{
  const words p = round_to_words(CELL_MOMENTUM_SCALE * v);
  *span |= sizes(p);
  return (reals)p;
}

/* cell_center: what a component of a momentum is multiplied by. */
INLINE reals cell_center_scale_lanes(words load)
{
  return CELL_MOMENTUM_UNIT / (reals_from_small(load & (CELL_MEMBER - 1)) * CELL_MASS_UNIT);
}

/* cell_energy of particles of mass 1, in units of mpc->relative. turn: columns 0 to 3. */
INLINE words cell_energy_lanes(const reals turn[4], reals vx, reals vy, reals vz)
{
  const reals x = vx - turn[0], y = vy - turn[1], z = vz - turn[2];
  return round_to_words(CELL_ENERGY_SCALE * (turn[3] * (x * x + y * y + z * z)));
}

#endif
