/* Tolerances of the operators of the rule at+a: docs/port/tolerances.md. A port may make the sums of a cell in doubles,
 * about the middle of the cell, where places are at most 1/2 a0 off along each axis. */
#include <math.h>
#include <string.h>

#include "base/lattice.h"
#include "mpc/cell.h"
#include "mpc/rules/spin.h"
#include "oracle/tolerance.h"

static double members_of(const struct oracle_pair *p, uint32_t row)
{
  return pack_value(oracle_sibling(p, "in.load"), row, 0);
}

double tolerance_spin_middle(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return 1.0 + LATTICE_PER_A0 * members_of(p, row) * p->rounding;
}

double tolerance_spin_beyond(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return LATTICE_UNIT * tolerance_spin_middle(p, row, column);
}

double tolerance_spin_second(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double n = members_of(p, row);
  (void)column;
  return 0.5 * n * (n + 16.0) * tolerance_heaviest(p) * p->rounding;
}

/* Momenta are rounded to the unit of a cell's sum, which not all ports do. */
double tolerance_spin_angular(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double n = members_of(p, row);
  (void)column;
  return n / CELL_MOMENTUM_SCALE + 2.0 * n * (n + 16.0) * tolerance_heaviest(p) * tolerance_velocities(p) * p->rounding;
}

/* The solution of Pi Omega = L is off by its condition, trace over least eigenvalue: determinant over minors, as in
 * spin_rate. On a line it is 1. */
double tolerance_spin_rate(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *second = oracle_sibling(p, "in.second");
  double c[6], largest = 0.0;
  (void)column;
  for (uint32_t k = 0; k < 6; k++)
    c[k] = pack_value(second, row, k);
  for (uint32_t k = 0; k < 3; k++)
    largest = fmax(largest, fabs(pack_value(p->ours, row, k)));
  const double xx = c[1] + c[2], yy = c[2] + c[0], zz = c[0] + c[1], trace = c[0] + c[1] + c[2];
  const double minor_x = yy * zz - c[3] * c[3], minor_y = zz * xx - c[4] * c[4], minor_z = xx * yy - c[5] * c[5];
  const double determinant = xx * minor_x - c[5] * (c[3] * c[4] + c[5] * zz) - c[4] * (c[5] * c[3] + yy * c[4]);
  const double least = determinant / (minor_x + minor_y + minor_z);
  if (tolerance_single(p) && !(least > 0x1p-12 * trace)) /* 24 bits do not tell a line from what is nearly one */
    return INFINITY;
  return 64.0 * (least > 1e-12 * 2.0 * trace ? 2.0 * trace / least : 1.0) * largest * p->rounding;
}

double tolerance_spin_center(const struct oracle_pair *p)
{
  return 8.0 * (tolerance_largest(p->ours, 0, 3) + tolerance_size_of(p, "in.beyond")) * p->rounding;
}

double tolerance_give_spin(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const bool vertex = strcmp(p->ours->name, "out.vertex") == 0;
  const struct pack_table *rate = oracle_sibling(p, "in.omega");
  const uint32_t cell = (uint32_t)pack_value(oracle_sibling(p, vertex ? "in.vertex_cell" : "in.solvent_cell"), row, 0);
  double turning = 0.0;
  (void)column;
  for (uint32_t k = 0; k < 3; k++)
    turning = fmax(turning, fabs(pack_value(rate, cell, k)));
  return 4.0 *
         (tolerance_velocities(p) + tolerance_size_of(p, "in.center") + 4.0 * turning +
          fmax(tolerance_size_of(p, "in.solvent_drawn"), tolerance_size_of(p, "in.vertex_drawn"))) *
         p->rounding;
}
