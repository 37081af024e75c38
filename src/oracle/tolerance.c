/*
 * Tolerances, derived in docs/port/tolerances.md: two implementations that differ in the order of operations only, or
 * in fused multiply-adds, differ by at most  n u S.  n counts the roundings of both, u is half an ulp of 1, and S
 * bounds the sizes of the terms; all of it from the pack.
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

/* --- solvent ------------------------------------------------------------------------------------------------------ */

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
  const double of_each = relative(p, row, 0);
  double sum = 0.0, error = 0.0;
  for (uint32_t k = 0; energy && k < energy->rows; k++)
    if (pack_value(energy, k, 0) != 0.0 && (of_all ? pack_value(p->ours, k, 0) == factor : k == row)) {
      sum += pack_value(energy, k, 0);
      error += of_each;
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

/* of_table: one bound for the whole table, which is computed once. */
static const struct tolerance_row {
  const char *operator_name, *table;
  tolerance_rule *tolerance;
  bool of_table;
} rules[] = {
    {"private_bath", "out.velocity", tolerance_private_bath, true},
    {"pairs", "out.along", tolerance_pair_along, true},
    {"pairs", "out.bath", tolerance_pair_draw, false},
    {"pair_bath", "out.solvent", tolerance_pair_bath, true},
    {"pair_bath", "out.vertex", tolerance_pair_bath, true},
    {"crowd", "out.crowd", tolerance_crowd, true},
    {"repulsion", "out.force", tolerance_repulsion, true},
    {"repulsion_kick", "out.solvent", tolerance_repulsion_kick, true},
    {"repulsion_kick", "out.vertex", tolerance_repulsion_kick, true},
    {"mobility", "out.tensor", tolerance_mobility, true},
    {"root", "out.root", tolerance_root, false},
    {"move", "out.position", tolerance_move, true},
    {"dumbbell_start", "out.position", tolerance_drawn_place, true},
    {"dumbbell_start", "out.vector", tolerance_drawn_place, true},
    {"dumbbell_stream", "out.position", tolerance_swing_position, true},
    {"dumbbell_stream", "out.velocity", tolerance_swing_velocity, true},
    {"dumbbell_stream", "out.vector", tolerance_swing_position, true},
    {"dumbbell_wall_stream", "out.position", tolerance_swing_position, true},
    {"dumbbell_wall_stream", "out.velocity", tolerance_swing_velocity, true},
    {"dumbbell_wall_stream", "out.vector", tolerance_swing_position, true},
    {"dumbbell_wall_stream", "out.given", tolerance_swing_given, true},
    {"dumbbell_shear_stream", "out.position", tolerance_swing_position, true},
    {"dumbbell_shear_stream", "out.velocity", tolerance_swing_velocity, true},
    {"dumbbell_shear_stream", "out.vector", tolerance_swing_position, true},
    {"wall_motion", "out.flight", tolerance_motion, true},
    {"wall_motion", "out.end", tolerance_motion, true},
    {"shear_motion", "out.rate", tolerance_motion, true},
    {"wall_stream", "out.position", tolerance_wall_position, true},
    {"wall_stream", "out.velocity", tolerance_wall_velocity, true},
    {"wall_stream", "out.given", tolerance_wall_given, true},
    {"shear_stream", "out.position", tolerance_wall_position, true},
    {"shear_stream", "out.velocity", tolerance_slid, true},
    {"enter", "out.velocity", tolerance_slid, true},
    {"leave", "out.velocity", tolerance_slid, true},
    {"affine_kick", "out.velocity", tolerance_affine, true},
    {"fill", "out.filled", tolerance_filled, false},
    {"fill", "out.momentum", tolerance_filled_momentum, false},
    {"account", "out.given", tolerance_account_given, true},
    {"rescale_layers", "out.relative", relative, true},
    {"rescale_layers", "out.factor", rescale, false},
    {"random", "out.uniform", uniform, true},
    {"random", "out.normal", normal_pair, false},
    {"random", "out.axis", axis, false},
    {"crossing", "out.hit", tolerance_crossing_hit, false},
    {"exchange", "out.momentum", tolerance_exchange_momentum, false},
    {"exchange", "out.moving", tolerance_exchange_velocity, false},
    {"exchange", "out.pivot", tolerance_exchange_velocity, false},
    {"exchange", "out.a", tolerance_exchange_velocity, false},
    {"exchange", "out.b", tolerance_exchange_velocity, false},
    {"sweep", "out.hit", tolerance_sweep_hit, false},
    {"sweep", "out.position", tolerance_sweep_position, false},
    {"sweep", "out.velocity", tolerance_sweep_velocity, false},
    {"tube_search", "out.tick", tolerance_tube_tick, false},
    {"tube_contact", "out.contact", tolerance_tube_points, false},
    {"tube_contact", "out.normal", tolerance_tube_normal, false},
    {"bead_search", "out.tick", tolerance_tube_tick, false},
    {"bead_contact", "out.contact", tolerance_tube_points, false},
    {"bead_contact", "out.normal", tolerance_tube_normal, false},
    {"impulse", "out.answer", tolerance_impulse_answer, false},
    {"impulse", "out.momentum", tolerance_impulse_momentum, false},
    {"impulse", "out.p0", tolerance_impulse_velocity, false},
    {"impulse", "out.p1", tolerance_impulse_velocity, false},
    {"impulse", "out.q0", tolerance_impulse_velocity, false},
    {"impulse", "out.q1", tolerance_impulse_velocity, false},
    {"event_drift", "out.hit", tolerance_event_hit, false},
    {"event_drift", "out.position", tolerance_event_position, false},
    {"event_drift", "out.velocity", tolerance_event_velocity, false},
    {"bond_force", "out.force", tolerance_bond_force, true},
    {"bend_force", "out.force", tolerance_bend_force, true},
    {"force", "out.force", tolerance_force, true},
    {"kick", "out.velocity", tolerance_kick, true},
    {"stream", "out.position", stream_position, true},
    {"stream", "out.velocity", stream_velocity, true},
    {"draw", "out.solvent", drawn, false},
    {"draw", "out.vertex", drawn, false},
    {"sum", "out.momentum", momentum, true},
    {"solve", "out.center", center, true},
    {"mean", "out.center", center, true},
    {"solve", "out.axis", axis, false},
    {"rescale", "out.relative", relative, true},
    {"rescale", "out.factor", rescale, false},
    {"maxwell_boltzmann", "out.relative", relative, true},
    {"maxwell_boltzmann", "out.factor", boltzmann, false},
    {"rotate", "out.solvent", rotate, true},
    {"rotate", "out.vertex", rotate, true},
    {"give", "out.solvent", give, true},
    {"give", "out.vertex", give, true},
    {"moments", "out.middle", tolerance_spin_middle, false},
    {"moments", "out.beyond", tolerance_spin_beyond, false},
    {"moments", "out.second", tolerance_spin_second, false},
    {"moments", "out.angular", tolerance_spin_angular, false},
    {"spin", "out.center", tolerance_spin_center, true},
    {"spin", "out.omega", tolerance_spin_rate, false},
    {"give_spin", "out.solvent", tolerance_give_spin, false},
    {"give_spin", "out.vertex", tolerance_give_spin, false},
    {"swap", "out.velocity", copied_velocity, true},
};

static const struct tolerance_row *rule_of(const struct pack_table *t)
{
  static const struct tolerance_row none = {"", "", exact, true};
  const char *operator_name = t->place.operator_name;
  if (strncmp(operator_name, "long_", strlen("long_")) == 0)
    operator_name += strlen("long_");
  for (size_t k = 0; k < sizeof rules / sizeof *rules; k++)
    if (strcmp(rules[k].operator_name, operator_name) == 0 && strcmp(rules[k].table, t->name) == 0)
      return &rules[k];
  return &none;
}

double oracle_tolerance(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct tolerance_known *known = p->known;
  if (!known)
    return rule_of(p->ours)->tolerance(p, row, column);
  if (!known->rule) {
    known->rule = rule_of(p->ours);
    known->bound = known->rule->of_table ? known->rule->tolerance(p, UINT32_MAX, UINT32_MAX) : NAN;
  }
  return known->rule->of_table ? known->bound : known->rule->tolerance(p, row, column);
}
