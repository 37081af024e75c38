/* Tolerances of the operators of media: docs/port/tolerances.md. */
#include <math.h>

#include "base/lattice.h"
#include "oracle/tolerance.h"

enum { NORMAL = 9 };                                                    /* no normal number is larger */
enum { RATE, RADIUS, REPULSION, BETWEEN, MANY_BODY, MANY_RANGE, FLOW }; /* columns of in.bath */

static double of_bath(const struct oracle_pair *p, uint32_t from, uint32_t to)
{
  return tolerance_largest(tolerance_of_model(p, "in.bath"), from, to);
}

/* 1 over the root of the smallest mass of a member, or of a pair. */
static double lightness(const struct oracle_pair *p)
{
  return sqrt(2.0 / fmin(1.0, tolerance_lightest(p)));
}

/* What rounding of the loss leaves of the noise's amplitude: its root has the slope 1/sqrt(loss) at most. */
static double amplitude(double loss, double u)
{
  return 8.0 * u + fmin(4.0 * u / sqrt(fmax(loss, 0x1p-1000)), sqrt(8.0 * u));
}

double tolerance_private_bath(const struct oracle_pair *p)
{
  const double flow = of_bath(p, FLOW, FLOW + 3);
  return 16.0 * (tolerance_size_of(p, "in.velocity") + flow) * p->rounding +
         NORMAL * lightness(p) * (24.0 * p->rounding + sqrt(8.0 * p->rounding) * (p->rounding > 0x1p-30));
}

double tolerance_pair_along(const struct oracle_pair *p)
{
  return 8.0 * p->rounding;
}

double tolerance_pair_draw(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double loss = pack_value(p->ours, row, 0);
  return column == 0 ? 16.0 * p->rounding : NORMAL * lightness(p) * (24.0 * p->rounding + amplitude(loss, p->rounding));
}

/* Each pair adds its own roundings, and no pair makes those before it larger but by the masses. */
double tolerance_pair_bath(const struct oracle_pair *p)
{
  const struct pack_table *pair = oracle_sibling(p, "in.pair");
  const double fastest = tolerance_velocities(p) + tolerance_largest(oracle_sibling(p, "in.bath"), 1, 2);
  const double masses = tolerance_heaviest(p) / fmin(1.0, tolerance_lightest(p));
  return (8.0 + 16.0 * (pair ? pair->rows : 0.0)) * fastest * sqrt(masses) * p->rounding;
}

static double members(const struct oracle_pair *p)
{
  const struct pack_table *solvent = oracle_sibling(p, "in.solvent"), *vertex = oracle_sibling(p, "in.vertex");
  return (solvent ? solvent->rows : 0.0) + (vertex ? vertex->rows : 0.0);
}

/* 2^-32 units: the largest term, its roundings and its own rounding to a unit, of each of the others. */
double tolerance_crowd(const struct oracle_pair *p)
{
  const double d = fmax(of_bath(p, MANY_RANGE, MANY_RANGE + 1), 0x1p-20);
  return members(p) * (1.0 + 0x1p32 * 2.4 / (d * d * d) * 16.0 * p->rounding);
}

double tolerance_repulsion(const struct oracle_pair *p)
{
  const double crowd = tolerance_size_of(p, "in.crowd") * 0x1p-32;
  const double strongest = of_bath(p, REPULSION, BETWEEN + 1) + 2.0 * of_bath(p, MANY_BODY, MANY_BODY + 1) * crowd;
  return members(p) * (1.0 + 0x1p32 * strongest * 24.0 * p->rounding);
}

double tolerance_repulsion_kick(const struct oracle_pair *p)
{
  const double kick =
      tolerance_size_of(p, "in.time") * tolerance_size_of(p, "in.force") * 0x1p-32 / fmin(1.0, tolerance_lightest(p));
  return 8.0 * (tolerance_velocities(p) + kick) * p->rounding;
}

double tolerance_mobility(const struct oracle_pair *p)
{
  return 32.0 * p->rounding;
}

static double order(const struct oracle_pair *p)
{
  const struct pack_table *chain = tolerance_of_model(p, "in.chain");
  return 3.0 * (chain ? chain->rows : 0.0);
}

/* D has ones on its diagonal, so rows of L have the length 1, and a factorization is that of a matrix which differs by
 * n u in each entry at most. */
double tolerance_root(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *bound = oracle_sibling(p, "bound.root");
  const double n = order(p), condition = bound && row < bound->rows ? pack_value(bound, row, 0) : 1.0;
  (void)column;
  return 2.0 * n * (n + 1.0) * sqrt(n) * condition * p->rounding;
}

double tolerance_move(const struct oracle_pair *p)
{
  const double dt = tolerance_largest(tolerance_of_model(p, "in.reals"), 0, 1), n = order(p);
  const double drift = dt / (fmax(of_bath(p, RATE, RATE + 1), 0x1p-20) * tolerance_lightest(p));
  const double path =
      drift * n * tolerance_size_of(p, "in.force") + sqrt(2.0 * drift) * n * NORMAL + dt * of_bath(p, FLOW, FLOW + 3);
  return 1.0 + LATTICE_PER_A0 * (n + 24.0) * path * p->rounding;
}
