/* Tolerances of forces and kicks (docs/port/tolerances.md). */
#include <math.h>

#include "base/lattice.h"
#include "oracle/tolerance.h"

static double most_of(const struct oracle_pair *p, enum vertex_column column)
{
  return tolerance_largest(tolerance_of_model(p, "in.vertex"), (uint32_t)column,
                           (uint32_t)column + (column == FORCE ? 3 : 1));
}

/* Length of the bond from a vertex to its neighbor (0: next, 1: the one before) in the positions that went in; 0 for
 * none. */
static double bond_to(const struct oracle_pair *p, uint32_t v, uint32_t way)
{
  const struct pack_table *r = oracle_sibling(p, "in.position"), *chain = tolerance_of_model(p, "in.chain");
  const double other = r && chain ? pack_value(chain, v, way) : -1.0;
  double squared = 0.0;
  for (uint32_t k = 0; r && other >= 0.0 && other < r->rows && k < 3; k++) {
    const double d = (pack_value(r, (uint32_t)other, k) - pack_value(r, v, k)) * LATTICE_UNIT;
    squared += d * d;
  }
  return sqrt(squared);
}

static double longest_bond(const struct oracle_pair *p)
{
  const struct pack_table *r = oracle_sibling(p, "in.position");
  double longest = 0.0;
  for (uint32_t v = 0; r && v < r->rows; v++)
    longest = fmax(longest, bond_to(p, v, 0));
  return longest;
}

/* The largest kappa over a bond's length, of all vertices with a bend. */
static double strongest_bend(const struct oracle_pair *p)
{
  const struct pack_table *r = oracle_sibling(p, "in.position"), *kinds = tolerance_of_model(p, "in.vertex");
  double most = 0.0;
  for (uint32_t v = 0; r && kinds && v < r->rows; v++) {
    const double shortest = fmin(bond_to(p, v, 0), bond_to(p, v, 1)), bending = pack_value(kinds, v, BENDING);
    if (shortest > 0.0 && bending > 0.0)
      most = fmax(most, bending / shortest);
  }
  return most;
}

double tolerance_bond_force(const struct oracle_pair *p)
{
  return 26.0 * 2.0 * most_of(p, SPRING) * (longest_bond(p) + most_of(p, BOND_LENGTH)) * p->rounding;
}

double tolerance_bend_force(const struct oracle_pair *p)
{
  return 50.0 * 8.0 * strongest_bend(p) * p->rounding;
}

double tolerance_force(const struct oracle_pair *p)
{
  return tolerance_bond_force(p) + tolerance_bend_force(p) + 14.0 * most_of(p, FORCE) * p->rounding;
}

static double strongest(const struct oracle_pair *p)
{
  return 4.0 * most_of(p, SPRING) * (longest_bond(p) + most_of(p, BOND_LENGTH)) + 8.0 * strongest_bend(p) +
         most_of(p, FORCE);
}

double tolerance_strongest(const struct oracle_pair *p)
{
  return tolerance_once(p, strongest);
}

double tolerance_kick(const struct oracle_pair *p)
{
  return 8.0 *
         (tolerance_velocities(p) +
          tolerance_size_of(p, "in.time") * tolerance_size_of(p, "in.force") / tolerance_lightest(p)) *
         p->rounding;
}
