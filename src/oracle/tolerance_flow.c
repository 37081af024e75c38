/* Tolerances of the operators of walls, of shear and of dumbbells: docs/port/tolerances.md. */
#include <math.h>

#include "base/lattice.h"
#include "mpc/cell.h"
#include "oracle/tolerance.h"

static double fastest(const struct oracle_pair *p)
{
  return tolerance_velocities(p) + tolerance_size_of(p, "in.wall") + tolerance_size_of(p, "in.speed") +
         tolerance_acceleration(p) * tolerance_size_of(p, "in.time");
}

double tolerance_motion(const struct oracle_pair *p)
{
  return 4.0 * tolerance_largest(p->ours, 0, PACK_COLUMNS) * p->rounding;
}

/* A flight has at most LATTICE_MAX_MOVE/1 hits; packs have one or two, and each adds 2 w. */
double tolerance_wall_velocity(const struct oracle_pair *p)
{
  return 32.0 * fastest(p) * p->rounding;
}

double tolerance_wall_position(const struct oracle_pair *p)
{
  return 1.0 + LATTICE_PER_A0 * 40.0 * fastest(p) * tolerance_size_of(p, "in.time") * p->rounding;
}

/* Each hit is rounded once to the unit of the sum. */
double tolerance_wall_given(const struct oracle_pair *p)
{
  const struct pack_table *particles = oracle_sibling(p, "in.position");
  const double n = particles ? particles->rows : 0.0;
  return n + CELL_MOMENTUM_SCALE * n * 64.0 * fastest(p) * p->rounding;
}

double tolerance_slid(const struct oracle_pair *p)
{
  return 4.0 * fastest(p) * p->rounding;
}

double tolerance_affine(const struct oracle_pair *p)
{
  return 4.0 *
         (tolerance_velocities(p) +
          tolerance_size_of(p, "in.position") * LATTICE_UNIT * tolerance_size_of(p, "in.change")) *
         p->rounding;
}

static double most_virtual(const struct oracle_pair *p)
{
  const struct pack_table *out = oracle_sibling(p, "out.filled");
  return fmax(1.0, tolerance_largest(out ? out : oracle_sibling(p, "in.filled"), 0, 1));
}

static double virtual_speed(const struct oracle_pair *p)
{
  const struct pack_table *out = oracle_sibling(p, "out.filled");
  return 9.0 + tolerance_size_of(p, "in.wall") + tolerance_largest(out ? out : oracle_sibling(p, "in.filled"), 1, 4);
}

/* Numbers are whole, or multiples of 2^-16: exact. Velocities have the tolerance of a normal deviate. */
double tolerance_filled(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)row;
  return column == 0 ? 0.0 : 24.0 * virtual_speed(p) * (p->rounding + (tolerance_single(p) ? sqrt(p->rounding) : 0.0));
}

double tolerance_filled_momentum(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return 1.0 + CELL_MOMENTUM_SCALE * most_virtual(p) *
                   (tolerance_filled(p, row, column + 1) + 4.0 * virtual_speed(p) * p->rounding);
}

double tolerance_account_given(const struct oracle_pair *p)
{
  const struct pack_table *cells = oracle_sibling(p, "in.filled");
  const double n = cells ? cells->rows : 0.0;
  return n + CELL_MOMENTUM_SCALE * n * most_virtual(p) * 100.0 * tolerance_size_of(p, "in.factor") *
                 (virtual_speed(p) + tolerance_size_of(p, "in.center")) * p->rounding;
}

/* --- dumbbells ---------------------------------------------------------------------------------------------------- */

static double longest_vector(const struct oracle_pair *p)
{
  return tolerance_size_of(p, "in.vector") * LATTICE_UNIT;
}

static double of_spring(const struct oracle_pair *p, uint32_t column)
{
  return tolerance_largest(tolerance_of_model(p, "in.spring"), column, column + 1);
}

/* Speeds that occur in a flight: w times the vector is one, and what the potential of the walls adds. */
static double fastest_swing(const struct oracle_pair *p)
{
  const double pull = 0.5 * of_spring(p, 2) * sqrt(of_spring(p, 0)) / fmax(of_spring(p, 3), 0x1p-40);
  return fastest(p) + of_spring(p, 1) * longest_vector(p) + pull * tolerance_size_of(p, "in.time");
}

/* A hit may be found a few lattice units early or late: a port may look for it in its own way. Its time is then off by
 * that over the rate at which the particle comes, and the velocity by the acceleration times it. */
static double hit_units(const struct oracle_pair *p)
{
  return oracle_sibling(p, "in.wall") ? 4096.0 : 0.0;
}

/* Each component is a normal deviate of at most 9 over sqrt(K), halved, and two roundings. */
double tolerance_drawn_place(const struct oracle_pair *p)
{
  const double spring = of_spring(p, 0);
  return 2.0 + LATTICE_PER_A0 * 48.0 * 9.0 / sqrt(fmax(spring, 0x1p-40)) * p->rounding;
}

double tolerance_swing_position(const struct oracle_pair *p)
{
  const double path = longest_vector(p) + fastest_swing(p) * tolerance_size_of(p, "in.time");
  return 2.0 + hit_units(p) + LATTICE_PER_A0 * 64.0 * path * p->rounding;
}

double tolerance_swing_velocity(const struct oracle_pair *p)
{
  return 64.0 * fastest_swing(p) * p->rounding + of_spring(p, 1) * hit_units(p) * LATTICE_UNIT;
}

double tolerance_swing_given(const struct oracle_pair *p)
{
  const struct pack_table *particles = oracle_sibling(p, "in.position");
  const double n = particles ? particles->rows : 0.0;
  return 4.0 * n * (1.0 + CELL_MOMENTUM_SCALE * tolerance_swing_velocity(p));
}
