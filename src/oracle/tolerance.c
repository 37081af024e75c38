/*
 * Tolerances, derived in docs/porting.md: two implementations that differ in the order of operations only, or in fused
 * multiply-adds, differ by at most  n u S.  n counts the roundings of both, u is half an ulp of 1, and S bounds the
 * sizes of the terms; all of it from the pack.
 */
#include <math.h>
#include <string.h>

#include "base/lattice.h"
#include "mpc/rules/srd.h"
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

enum vertex_column { MASS, BOND_LENGTH, SPRING, BENDING, FORCE };

static double most_of(const struct oracle_pair *p, enum vertex_column column)
{
  return tolerance_largest(tolerance_of_model(p, "in.vertex"), (uint32_t)column,
                           (uint32_t)column + (column == FORCE ? 3 : 1));
}

double tolerance_heaviest(const struct oracle_pair *p)
{
  return fmax(1.0, most_of(p, MASS));
}

double tolerance_lightest(const struct oracle_pair *p)
{
  return smallest(tolerance_of_model(p, "in.vertex"), MASS);
}

double tolerance_velocities(const struct oracle_pair *p)
{
  return fmax(tolerance_size_of(p, "in.velocity"),
              fmax(tolerance_size_of(p, "in.solvent"), tolerance_size_of(p, "in.vertex")));
}

/* --- rules: what n S is; times u it is the tolerance ------------------------------------------------------------- */

static double exact(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)p, (void)row, (void)column;
  return 0.0;
}

/* What is exact in doubles is rounded once in single precision. */
static double uniform(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return tolerance_single(p) ? p->rounding : 0.0;
}

static double copied_velocity(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return tolerance_single(p) ? p->rounding * tolerance_velocities(p) : 0.0;
}

/* Rounding the uniform u changes -2 ln u by 2u, and its root r by u/r, or sqrt(2u) where r is small. */
static double normal_pair(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double r = hypot(pack_value(p->ours, row, 0), pack_value(p->ours, row, 1));
  (void)column;
  return 24.0 * 8.6 * p->rounding + (tolerance_single(p) ? fmin(p->rounding / r, sqrt(2.0 * p->rounding)) : 0.0);
}

/* The root sqrt(1-q) = sqrt((1+z)/2) amplifies the rounding of q. */
static double axis(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  const double root = sqrt(fmax(0.5 * (1.0 + pack_value(p->ours, row, 2)), 0x1p-31));
  return 16.0 / root * p->rounding;
}

/* --- fibers and solvent ------------------------------------------------------------------------------------------ */

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

static double bond_force(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 26.0 * 2.0 * most_of(p, SPRING) * (longest_bond(p) + most_of(p, BOND_LENGTH)) * p->rounding;
}

static double bend_force(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 50.0 * 8.0 * strongest_bend(p) * p->rounding;
}

static double force(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return bond_force(p, row, column) + bend_force(p, row, column) + 14.0 * most_of(p, FORCE) * p->rounding;
}

double tolerance_strongest(const struct oracle_pair *p)
{
  return 4.0 * most_of(p, SPRING) * (longest_bond(p) + most_of(p, BOND_LENGTH)) + 8.0 * strongest_bend(p) +
         most_of(p, FORCE);
}

static double kick(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 8.0 *
         (tolerance_velocities(p) +
          tolerance_size_of(p, "in.time") * tolerance_size_of(p, "in.force") / tolerance_lightest(p)) *
         p->rounding;
}

double tolerance_acceleration(const struct oracle_pair *p)
{
  return tolerance_largest(tolerance_of_model(p, "in.reals"), 3, 6);
}

static double stream_velocity(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 4.0 * (tolerance_velocities(p) + tolerance_acceleration(p) * tolerance_size_of(p, "in.time")) * p->rounding;
}

static double stream_position(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double t = tolerance_size_of(p, "in.time");
  (void)row, (void)column;
  return 1.0 +
         LATTICE_PER_A0 * 10.0 * (tolerance_velocities(p) * t + 0.5 * tolerance_acceleration(p) * t * t) * p->rounding;
}

static double members(const struct oracle_pair *p)
{
  const struct pack_table *load = oracle_sibling(p, "out.load");
  return tolerance_largest(load ? load : oracle_sibling(p, "in.load"), 0, 1);
}

static double momentum(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double n = members(p);
  (void)row, (void)column;
  return 0.5 * n + 1.0 +
         CELL_MOMENTUM_SCALE * n * (n + 1.0) * tolerance_heaviest(p) * tolerance_velocities(p) * p->rounding;
}

static double center(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 8.0 * tolerance_largest(p->ours, 0, 3) * p->rounding;
}

static double relative(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double n = members(p), w = tolerance_velocities(p) + tolerance_size_of(p, "in.center");
  (void)row, (void)column;
  return 0.5 * n + 1.0 + 0x1p32 * n * (n + 16.0) * 3.0 * tolerance_heaviest(p) * w * w * p->rounding;
}

/* A factor is the root over the sum of relative energies that it belongs to: that of its cell, or of all cells that
 * have the same factor. Half of the relative error of the sum is allowed in it. */
static double of_relative(const struct oracle_pair *p, uint32_t row, bool of_all)
{
  const struct pack_table *energy = oracle_sibling(p, "out.relative");
  const double factor = pack_value(p->ours, row, 0);
  double sum = 0.0, error = 0.0;
  for (uint32_t k = 0; energy && k < energy->rows; k++)
    if (pack_value(energy, k, 0) != 0.0 && (of_all ? pack_value(p->ours, k, 0) == factor : k == row)) {
      sum += pack_value(energy, k, 0);
      error += relative(p, k, 0);
    }
  return sum > 0.0 ? 0.5 * factor * error / sum : 0.0;
}

static double rescale(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return (p->ours->rows + 10.0) * tolerance_largest(p->ours, 0, 1) * p->rounding + of_relative(p, row, true);
}

static double boltzmann(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return 256.0 * tolerance_largest(p->ours, 0, 1) * p->rounding + of_relative(p, row, false);
}

static double rotate(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 24.0 * 3.0 * tolerance_size_of(p, "in.factor") *
         (tolerance_velocities(p) + tolerance_size_of(p, "in.center")) * p->rounding;
}

/* The third normal has the radius of a pair of its own, which is no smaller than it. */
static double drawn(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double x = pack_value(p->ours, row, 0), y = pack_value(p->ours, row, 1), z = pack_value(p->ours, row, 2);
  const double r = column == 2 ? fabs(z) : hypot(x, y);
  return 24.0 * 8.6 * p->rounding + (tolerance_single(p) ? fmin(p->rounding / r, sqrt(2.0 * p->rounding)) : 0.0);
}

static double give(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return 2.0 *
         (tolerance_velocities(p) + tolerance_size_of(p, "in.center") +
          fmax(tolerance_size_of(p, "in.solvent_drawn"), tolerance_size_of(p, "in.vertex_drawn"))) *
         p->rounding;
}

static const struct {
  const char *operator_name, *table;
  tolerance_rule *tolerance;
} rules[] = {
    {"private_bath", "out.velocity", tolerance_private_bath},
    {"pairs", "out.along", tolerance_pair_along},
    {"pairs", "out.bath", tolerance_pair_draw},
    {"pair_bath", "out.solvent", tolerance_pair_bath},
    {"pair_bath", "out.vertex", tolerance_pair_bath},
    {"crowd", "out.crowd", tolerance_crowd},
    {"repulsion", "out.force", tolerance_repulsion},
    {"repulsion_kick", "out.solvent", tolerance_repulsion_kick},
    {"repulsion_kick", "out.vertex", tolerance_repulsion_kick},
    {"mobility", "out.tensor", tolerance_mobility},
    {"root", "out.root", tolerance_root},
    {"move", "out.position", tolerance_move},
    {"dumbbell_start", "out.position", tolerance_drawn_place},
    {"dumbbell_start", "out.vector", tolerance_drawn_place},
    {"dumbbell_stream", "out.position", tolerance_swing_position},
    {"dumbbell_stream", "out.velocity", tolerance_swing_velocity},
    {"dumbbell_stream", "out.vector", tolerance_swing_position},
    {"dumbbell_wall_stream", "out.position", tolerance_swing_position},
    {"dumbbell_wall_stream", "out.velocity", tolerance_swing_velocity},
    {"dumbbell_wall_stream", "out.vector", tolerance_swing_position},
    {"dumbbell_wall_stream", "out.given", tolerance_swing_given},
    {"dumbbell_shear_stream", "out.position", tolerance_swing_position},
    {"dumbbell_shear_stream", "out.velocity", tolerance_swing_velocity},
    {"dumbbell_shear_stream", "out.vector", tolerance_swing_position},
    {"wall_motion", "out.flight", tolerance_motion},
    {"wall_motion", "out.end", tolerance_motion},
    {"shear_motion", "out.rate", tolerance_motion},
    {"wall_stream", "out.position", tolerance_wall_position},
    {"wall_stream", "out.velocity", tolerance_wall_velocity},
    {"wall_stream", "out.given", tolerance_wall_given},
    {"shear_stream", "out.position", tolerance_wall_position},
    {"shear_stream", "out.velocity", tolerance_slid},
    {"enter", "out.velocity", tolerance_slid},
    {"leave", "out.velocity", tolerance_slid},
    {"affine_kick", "out.velocity", tolerance_affine},
    {"fill", "out.filled", tolerance_filled},
    {"fill", "out.momentum", tolerance_filled_momentum},
    {"account", "out.given", tolerance_account_given},
    {"rescale_layers", "out.relative", relative},
    {"rescale_layers", "out.factor", rescale},
    {"random", "out.uniform", uniform},
    {"random", "out.normal", normal_pair},
    {"random", "out.axis", axis},
    {"crossing", "out.hit", tolerance_crossing_hit},
    {"exchange", "out.momentum", tolerance_exchange_momentum},
    {"exchange", "out.moving", tolerance_exchange_velocity},
    {"exchange", "out.pivot", tolerance_exchange_velocity},
    {"exchange", "out.a", tolerance_exchange_velocity},
    {"exchange", "out.b", tolerance_exchange_velocity},
    {"sweep", "out.hit", tolerance_sweep_hit},
    {"sweep", "out.position", tolerance_sweep_position},
    {"sweep", "out.velocity", tolerance_sweep_velocity},
    {"tube_search", "out.tick", tolerance_tube_tick},
    {"tube_contact", "out.contact", tolerance_tube_points},
    {"tube_contact", "out.normal", tolerance_tube_normal},
    {"bead_search", "out.tick", tolerance_tube_tick},
    {"bead_contact", "out.contact", tolerance_tube_points},
    {"bead_contact", "out.normal", tolerance_tube_normal},
    {"impulse", "out.answer", tolerance_impulse_answer},
    {"impulse", "out.momentum", tolerance_impulse_momentum},
    {"impulse", "out.p0", tolerance_impulse_velocity},
    {"impulse", "out.p1", tolerance_impulse_velocity},
    {"impulse", "out.q0", tolerance_impulse_velocity},
    {"impulse", "out.q1", tolerance_impulse_velocity},
    {"event_drift", "out.hit", tolerance_event_hit},
    {"event_drift", "out.position", tolerance_event_position},
    {"event_drift", "out.velocity", tolerance_event_velocity},
    {"bond_force", "out.force", bond_force},
    {"bend_force", "out.force", bend_force},
    {"force", "out.force", force},
    {"kick", "out.velocity", kick},
    {"stream", "out.position", stream_position},
    {"stream", "out.velocity", stream_velocity},
    {"draw", "out.solvent", drawn},
    {"draw", "out.vertex", drawn},
    {"sum", "out.momentum", momentum},
    {"solve", "out.center", center},
    {"mean", "out.center", center},
    {"solve", "out.axis", axis},
    {"rescale", "out.relative", relative},
    {"rescale", "out.factor", rescale},
    {"maxwell_boltzmann", "out.relative", relative},
    {"maxwell_boltzmann", "out.factor", boltzmann},
    {"rotate", "out.solvent", rotate},
    {"rotate", "out.vertex", rotate},
    {"give", "out.solvent", give},
    {"give", "out.vertex", give},
    {"moments", "out.middle", tolerance_spin_middle},
    {"moments", "out.beyond", tolerance_spin_beyond},
    {"moments", "out.second", tolerance_spin_second},
    {"moments", "out.angular", tolerance_spin_angular},
    {"spin", "out.center", tolerance_spin_center},
    {"spin", "out.omega", tolerance_spin_rate},
    {"give_spin", "out.solvent", tolerance_give_spin},
    {"give_spin", "out.vertex", tolerance_give_spin},
    {"swap", "out.velocity", copied_velocity},
};

double oracle_tolerance(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  tolerance_rule *found = exact;
  const char *operator_name = p->ours->place.operator_name;
  if (strncmp(operator_name, "long_", strlen("long_")) == 0)
    operator_name += strlen("long_");
  for (size_t k = 0; k < sizeof rules / sizeof *rules; k++)
    if (strcmp(rules[k].operator_name, operator_name) == 0 && strcmp(rules[k].table, p->ours->name) == 0)
      found = rules[k].tolerance;
  return found(p, row, column);
}
