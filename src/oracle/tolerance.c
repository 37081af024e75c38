/*
 * Tolerances, derived in docs/port/tolerances.md: two implementations that differ in the order of operations only, or
 * in fused multiply-adds, differ by at most  n u S.  n counts the roundings of both, u is half an ulp of 1, and S
 * bounds the sizes of the terms; all of it from the pack.
 */
#include <math.h>
#include <string.h>

#include "base/lattice.h"
#include "mpc/rules/srd.h"
#include "oracle/schema.h"
#include "oracle/tolerance.h"

double tolerance_largest(const struct pack_table *t, uint32_t from, uint32_t to)
{
  double most = 0.0;
  for (uint32_t row = 0; t && row < t->rows; row++)
    for (uint32_t k = from; k < to && k < t->columns; k++)
      most = fmax(most, fabs(pack_value(t, row, k)));
  return most;
}

static double smallest(const struct pack_table *t, uint32_t column)
{
  double least = INFINITY;
  for (uint32_t row = 0; t && row < t->rows; row++)
    least = fmin(least, fabs(pack_value(t, row, column)));
  return least;
}

double tolerance_size_of(const struct oracle_pair *p, const char *name)
{
  return tolerance_largest(oracle_sibling(p, name), 0, PACK_COLUMNS);
}

const struct pack_table *tolerance_of_model(const struct oracle_pair *p, const char *name)
{
  return pack_find(p->pack, &(struct pack_place){"model", 0}, name);
}

static double heaviest(const struct oracle_pair *p)
{
  return fmax(1.0, tolerance_largest(tolerance_of_model(p, "in.vertex"), MASS, MASS + 1));
}

double tolerance_heaviest(const struct oracle_pair *p)
{
  return tolerance_once(p, heaviest);
}

static double lightest(const struct oracle_pair *p)
{
  return smallest(tolerance_of_model(p, "in.vertex"), MASS);
}

double tolerance_lightest(const struct oracle_pair *p)
{
  return tolerance_once(p, lightest);
}

static double velocities(const struct oracle_pair *p)
{
  return fmax(tolerance_size_of(p, "in.velocity"),
              fmax(tolerance_size_of(p, "in.solvent"), tolerance_size_of(p, "in.vertex")));
}

double tolerance_velocities(const struct oracle_pair *p)
{
  return tolerance_once(p, velocities);
}

/* --- rules: what n S is; times u it is the tolerance ------------------------------------------------------------- */

/* What is exact in doubles is rounded once in single precision. */
double tolerance_uniform(const struct oracle_pair *p)
{
  return tolerance_single(p) ? p->rounding : 0.0;
}

double tolerance_copied_velocity(const struct oracle_pair *p)
{
  return tolerance_single(p) ? p->rounding * tolerance_velocities(p) : 0.0;
}

/* Rounding the uniform u changes -2 ln u by 2u, and its root r by u/r, or sqrt(2u) where r is small. */
double tolerance_normal_pair(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double r = hypot(pack_value(p->ours, row, 0), pack_value(p->ours, row, 1));
  (void)column;
  return 24.0 * 8.6 * p->rounding + (tolerance_single(p) ? fmin(p->rounding / r, sqrt(2.0 * p->rounding)) : 0.0);
}

/* The root sqrt(1-q) = sqrt((1+z)/2) amplifies the rounding of q. */
double tolerance_axis(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  const double root = sqrt(fmax(0.5 * (1.0 + pack_value(p->ours, row, 2)), 0x1p-31));
  return 16.0 / root * p->rounding;
}

/* --- solvent ------------------------------------------------------------------------------------------------------ */

double tolerance_acceleration(const struct oracle_pair *p)
{
  return tolerance_largest(tolerance_of_model(p, "in.reals"), 3, 6);
}

double tolerance_stream_velocity(const struct oracle_pair *p)
{
  return 4.0 * (tolerance_velocities(p) + tolerance_acceleration(p) * tolerance_size_of(p, "in.time")) * p->rounding;
}

double tolerance_stream_position(const struct oracle_pair *p)
{
  const double t = tolerance_size_of(p, "in.time");
  return 1.0 +
         LATTICE_PER_A0 * 10.0 * (tolerance_velocities(p) * t + 0.5 * tolerance_acceleration(p) * t * t) * p->rounding;
}

static double members(const struct oracle_pair *p)
{
  const struct pack_table *load = oracle_sibling(p, "out.load");
  return tolerance_largest(load ? load : oracle_sibling(p, "in.load"), 0, 1);
}

double tolerance_momentum(const struct oracle_pair *p)
{
  const double n = members(p);
  return 0.5 * n + 1.0 +
         CELL_MOMENTUM_SCALE * n * (n + 1.0) * tolerance_heaviest(p) * tolerance_velocities(p) * p->rounding;
}

double tolerance_center(const struct oracle_pair *p)
{
  return 8.0 * tolerance_largest(p->ours, 0, 3) * p->rounding;
}

double tolerance_relative(const struct oracle_pair *p)
{
  const double n = members(p), w = tolerance_velocities(p) + tolerance_size_of(p, "in.center");
  return 0.5 * n + 1.0 + 0x1p32 * n * (n + 16.0) * 3.0 * tolerance_heaviest(p) * w * w * p->rounding;
}

/* A factor is the root over the sum of relative energies that it belongs to: that of its cell, or of all cells that
 * have the same factor. Half of the relative error of the sum is allowed in it. */
static double of_relative(const struct oracle_pair *p, uint32_t row, bool of_all)
{
  const struct pack_table *energy = oracle_sibling(p, "out.relative");
  const double factor = pack_value(p->ours, row, 0);
  const double of_each = tolerance_relative(p);
  double sum = 0.0, error = 0.0;
  for (uint32_t k = 0; energy && k < energy->rows; k++)
    if (pack_value(energy, k, 0) != 0.0 && (of_all ? pack_value(p->ours, k, 0) == factor : k == row)) {
      sum += pack_value(energy, k, 0);
      error += of_each;
    }
  return sum > 0.0 ? 0.5 * factor * error / sum : 0.0;
}

double tolerance_rescale(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return (p->ours->rows + 10.0) * tolerance_largest(p->ours, 0, 1) * p->rounding + of_relative(p, row, true);
}

double tolerance_boltzmann(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return 256.0 * tolerance_largest(p->ours, 0, 1) * p->rounding + of_relative(p, row, false);
}

double tolerance_rotate(const struct oracle_pair *p)
{
  return 24.0 * 3.0 * tolerance_size_of(p, "in.factor") *
         (tolerance_velocities(p) + tolerance_size_of(p, "in.center")) * p->rounding;
}

/* The third normal has the radius of a pair of its own, which is no smaller than it. */
double tolerance_drawn(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double x = pack_value(p->ours, row, 0), y = pack_value(p->ours, row, 1), z = pack_value(p->ours, row, 2);
  const double r = column == 2 ? fabs(z) : hypot(x, y);
  return 24.0 * 8.6 * p->rounding + (tolerance_single(p) ? fmin(p->rounding / r, sqrt(2.0 * p->rounding)) : 0.0);
}

double tolerance_give(const struct oracle_pair *p)
{
  return 2.0 *
         (tolerance_velocities(p) + tolerance_size_of(p, "in.center") +
          fmax(tolerance_size_of(p, "in.solvent_drawn"), tolerance_size_of(p, "in.vertex_drawn"))) *
         p->rounding;
}

static const struct oracle_table *table_of(const struct oracle_pair *p)
{
  struct tolerance_known *known = p->known;
  if (known && known->table)
    return known->table;
  const struct oracle_table *t = oracle_table_of(p->ours->place.operator_name, p->ours->name, NULL);
  if (known && t)
    known->table = t, known->bound = t->all ? t->all(p) : NAN;
  return t;
}

double oracle_tolerance(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct oracle_table *t = table_of(p);
  if (t && t->all)
    return p->known ? p->known->bound : t->all(p);
  return t && t->each ? t->each(p, row, column) : 0.0;
}
