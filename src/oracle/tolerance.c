/*
 * Tolerances, derived in docs/porting.md: two implementations that differ in the order of operations only, or in fused
 * multiply-adds, differ by at most  n u S.  n counts the roundings of both, u is half an ulp of 1, and S bounds the
 * sizes of the terms; all of it from the pack.
 */
#include <math.h>
#include <string.h>

#include "base/lattice.h"
#include "oracle/pair.h"
#include "solvent/srd.h"

/* Largest size in columns from .. to-1 of a table; 0 if there is none. */
static double largest(const struct pack_table *t, uint32_t from, uint32_t to)
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

static double size_of(const struct oracle_pair *p, const char *name)
{
  return largest(oracle_sibling(p, name), 0, PACK_COLUMNS);
}

static const struct pack_table *of_model(const struct oracle_pair *p, const char *name)
{
  return pack_find(p->pack, &(struct pack_place){"model", 0}, name);
}

enum vertex_column { MASS, BOND_LENGTH, SPRING, BENDING, FORCE };

static double most_of(const struct oracle_pair *p, enum vertex_column column)
{
  return largest(of_model(p, "in.vertex"), (uint32_t)column, (uint32_t)column + (column == FORCE ? 3 : 1));
}

static double heaviest(const struct oracle_pair *p)
{
  return fmax(1.0, most_of(p, MASS));
}

static double lightest(const struct oracle_pair *p)
{
  return smallest(of_model(p, "in.vertex"), MASS);
}

static double velocities(const struct oracle_pair *p)
{
  return fmax(size_of(p, "in.velocity"), fmax(size_of(p, "in.solvent"), size_of(p, "in.vertex")));
}

/* --- rules: what n S is; times u it is the tolerance ------------------------------------------------------------- */

typedef double rule(const struct oracle_pair *p, uint32_t row, uint32_t column);

static double exact(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)p, (void)row, (void)column;
  return 0.0;
}

static double normal_pair(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 24.0 * 8.6 * p->rounding;
}

/* The root sqrt(1-q) = sqrt((1+z)/2) amplifies the rounding of q. */
static double axis(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  const double root = sqrt(fmax(0.5 * (1.0 + pack_value(p->ours, row, 2)), 0x1p-31));
  return 16.0 / root * p->rounding;
}

static double hit(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *t = oracle_sibling(p, "bound.hit");
  const double condition = t && row < t->rows ? pack_value(t, row, 0) : 1.0;
  const double scale = column == 6 ? 8.0 * heaviest(p) * size_of(p, "in.velocity") : 1.0;
  return 64.0 * condition * scale * p->rounding;
}

static double sweep_velocity(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  const double exchange = 64.0 * size_of(p, "bound.hit") * 8.0 * heaviest(p) / lightest(p);
  return (8.0 + exchange) * size_of(p, "in.velocity") * p->rounding;
}

static double sweep_position(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double time = size_of(p, "in.time");
  return 1.0 + LATTICE_PER_A0 * time * (4.0 * size_of(p, "in.velocity") * p->rounding + sweep_velocity(p, row, column));
}

/* Longest and shortest bond of the positions that went in. */
static void bonds(const struct oracle_pair *p, double *longest, double *shortest)
{
  const struct pack_table *r = oracle_sibling(p, "in.position"), *chain = of_model(p, "in.chain");
  *longest = 0.0;
  *shortest = INFINITY;
  for (uint32_t v = 0; r && chain && v < r->rows; v++) {
    const double next = pack_value(chain, v, 0) < r->rows ? pack_value(chain, v, 0) : -1.0;
    double squared = 0.0;
    for (uint32_t k = 0; next >= 0.0 && k < 3; k++) {
      const double d = (pack_value(r, (uint32_t)next, k) - pack_value(r, v, k)) * LATTICE_UNIT;
      squared += d * d;
    }
    *longest = fmax(*longest, sqrt(squared));
    *shortest = next >= 0.0 ? fmin(*shortest, sqrt(squared)) : *shortest;
  }
}

static double bond_force(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  double longest, shortest;
  (void)row, (void)column;
  bonds(p, &longest, &shortest);
  return 26.0 * 2.0 * most_of(p, SPRING) * (longest + most_of(p, BOND_LENGTH)) * p->rounding;
}

static double bend_force(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  double longest, shortest;
  (void)row, (void)column;
  bonds(p, &longest, &shortest);
  return 50.0 * 8.0 * most_of(p, BENDING) / shortest * p->rounding;
}

static double force(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return bond_force(p, row, column) + bend_force(p, row, column) + 14.0 * most_of(p, FORCE) * p->rounding;
}

static double kick(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 8.0 * (velocities(p) + size_of(p, "in.time") * size_of(p, "in.force") / lightest(p)) * p->rounding;
}

static double acceleration(const struct oracle_pair *p)
{
  return largest(of_model(p, "in.reals"), 3, 6);
}

static double stream_velocity(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 4.0 * (velocities(p) + acceleration(p) * size_of(p, "in.time")) * p->rounding;
}

static double stream_position(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double t = size_of(p, "in.time");
  (void)row, (void)column;
  return 1.0 + LATTICE_PER_A0 * 10.0 * (velocities(p) * t + 0.5 * acceleration(p) * t * t) * p->rounding;
}

static double members(const struct oracle_pair *p)
{
  const struct pack_table *load = oracle_sibling(p, "out.load");
  return largest(load ? load : oracle_sibling(p, "in.load"), 0, 1);
}

static double momentum(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double n = members(p);
  (void)row, (void)column;
  return 0.5 * n + 1.0 + SRD_MOMENTUM_SCALE * n * n * heaviest(p) * velocities(p) * p->rounding;
}

static double center(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 6.0 * largest(p->ours, 0, 3) * p->rounding;
}

static double relative(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double n = members(p), w = velocities(p) + size_of(p, "in.center");
  (void)row, (void)column;
  return 0.5 * n + 1.0 + 0x1p32 * n * (n + 16.0) * 3.0 * heaviest(p) * w * w * p->rounding;
}

static double rescale(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return (p->ours->rows + 10.0) * largest(p->ours, 0, 1) * p->rounding;
}

static double boltzmann(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 256.0 * largest(p->ours, 0, 1) * p->rounding;
}

static double rotate(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 24.0 * 3.0 * size_of(p, "in.factor") * (velocities(p) + size_of(p, "in.center")) * p->rounding;
}

static const struct {
  const char *operator_name, *table;
  rule *tolerance;
} rules[] = {
    {"random", "out.normal", normal_pair},
    {"random", "out.axis", axis},
    {"sweep", "out.hit", hit},
    {"sweep", "out.position", sweep_position},
    {"sweep", "out.velocity", sweep_velocity},
    {"bond_force", "out.force", bond_force},
    {"bend_force", "out.force", bend_force},
    {"force", "out.force", force},
    {"kick", "out.velocity", kick},
    {"stream", "out.position", stream_position},
    {"stream", "out.velocity", stream_velocity},
    {"sum", "out.momentum", momentum},
    {"solve", "out.center", center},
    {"solve", "out.axis", axis},
    {"rescale", "out.relative", relative},
    {"rescale", "out.factor", rescale},
    {"maxwell_boltzmann", "out.relative", relative},
    {"maxwell_boltzmann", "out.factor", boltzmann},
    {"rotate", "out.solvent", rotate},
    {"rotate", "out.vertex", rotate},
};

double oracle_tolerance(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  rule *found = exact;
  const char *operator_name = p->ours->place.operator_name;
  if (strcmp(operator_name, "long_sweep") == 0)
    operator_name = "sweep";
  for (size_t k = 0; k < sizeof rules / sizeof *rules; k++)
    if (strcmp(rules[k].operator_name, operator_name) == 0 && strcmp(rules[k].table, p->ours->name) == 0)
      found = rules[k].tolerance;
  return found(p, row, column);
}
