#include "system/flow.h"

#include <math.h>

#define MOST_INTERVALS 1e7 /* of a period: its tables have 24 bytes for each */
#define LEAST_INTERVALS 4.0
#define SOUND 1.0 /* a0/t0: isothermal speed of sound, sqrt(kT/m) */

/* What a scene may not combine. */
struct refusal {
  bool refused;
  const char *path, *why;
};

static bool refuse_first(const struct refusal *row, size_t rows, struct model_error *error)
{
  for (size_t i = 0; i < rows; i++)
    if (row[i].refused)
      return model_reject(error, row[i].path, "%s", row[i].why);
  return true;
}

static bool check_plane(const struct model *m, struct model_error *error)
{
  const bool flat = m->dimensions == 2;
  const struct refusal rows[] = {
      {flat && m->box.cells[2] != 1, "box", "with dimensions: 2 the box is one cell thick; allowed: [Lx, Ly, 1]"},
      {flat && m->flow.z != 0.0, "flow", "with dimensions: 2 nothing moves along z; allowed: a z component of 0"},
      {flat && m->solvent.acceleration.z != 0.0, "solvent.acceleration",
       "with dimensions: 2 nothing moves along z; allowed: a z component of 0"},
      {flat && (m->walls.lower.z != 0.0 || m->walls.upper.z != 0.0), "walls",
       "with dimensions: 2 nothing moves along z; allowed: velocities with a z component of 0"},
      {flat && m->kinds > 0 && m->crossing.forbidden, "crossing.forbidden",
       "in a plane fibers cannot pass over each other, so the rule has no side on which to keep them; allowed with "
       "dimensions: 2: false"},
      {flat && model_has_phantoms(m), "solvent.bath",
       "phantoms are drawn in space; allowed with dimensions: 2: particles"},
      {flat && !m->solvent.hydrodynamics, "solvent.hydrodynamics",
       "velocities are not permuted in a plane; allowed with dimensions: 2: true"},
  };
  return refuse_first(rows, sizeof rows / sizeof *rows, error);
}

static bool check_force(const struct model *m, struct model_error *error)
{
  const bool walls = m->walls.kind != WALL_ABSENT, shear = m->shear.rate != 0.0;
  const bool profiled = m->solvent.profile != PROFILE_UNIFORM;
  const struct refusal rows[] = {
      {profiled && (walls || shear), "solvent.profile",
       "the profile repeats with the box; allowed between walls and with shear: uniform"},
      {profiled && m->solvent.acceleration.y != 0.0, "solvent.acceleration",
       "a force along y that depends on y compresses the solvent; allowed with this profile: a y component of 0"},
      {profiled && !m->solvent.hydrodynamics && !model_has_phantoms(m), "solvent.hydrodynamics",
       "velocities that are permuted have no profile; allowed with this profile: true"},
      {profiled && model_has_phantoms(m), "solvent.profile", "phantoms are not accelerated; allowed: uniform"},
      {walls && m->solvent.acceleration.y != 0.0, "solvent.acceleration",
       "the solvent would be pressed against a wall; allowed between walls: a y component of 0"},
      {shear && m->solvent.acceleration.y != 0.0, "solvent.acceleration",
       "the solvent would be moved across the shear; allowed with shear: a y component of 0"},
  };
  return refuse_first(rows, sizeof rows / sizeof *rows, error);
}

static bool check_boundary(const struct model *m, struct model_error *error)
{
  const bool walls = m->walls.kind != WALL_ABSENT, shear = m->shear.rate != 0.0, any = walls || shear;
  const struct refusal rows[] = {
      {walls && shear, "shear", "walls and shear are both along y; allowed: one of the two"},
      {walls && model_has_phantoms(m), "walls",
       "phantoms are drawn about the same velocity everywhere; allowed with bath: particles"},
      {any && !model_has_solvent(m) && m->kinds == 0, walls ? "walls" : "shear",
       "they act on solvent and fibers, and there are none; allowed with solvent particles or fibers"},
      {shear && m->kinds > 0 && m->crossing.forbidden && m->box.cells[0] % m->box.cells[1] != 0, "box",
       "with shear and bonds that must not cross, the edge along x is a whole multiple of that along y, so that images "
       "stay on the lattice; allowed: [2, 1, 1] times any number, for example"},
      {any && !m->solvent.hydrodynamics && !model_has_phantoms(m), "solvent.hydrodynamics",
       "velocities that are permuted have no profile; allowed between walls and with shear: true"},
      {any && m->flow.y != 0.0, "flow", "a flow across walls or shear; allowed: a y component of 0"},
      {walls && (m->walls.lower.y != 0.0 || m->walls.upper.y != 0.0), "walls",
       "a wall that leaves its plane; allowed: velocities with a y component of 0"},
      {walls && m->walls.kind == WALL_SLIP && m->walls.fill != FILL_PLANAR, "walls.fill",
       "slip walls have no virtual particles; allowed: planar, which has no effect there"},
      {walls && m->dumbbells.spring != 0.0 && 4.0 > m->dumbbells.spring * m->box.cells[1] * m->box.cells[1],
       "dumbbells.spring",
       "a dumbbell at rest is longer than half of the gap; allowed between walls: sqrt(kT/spring) up to L/2"},
      {m->dumbbells.depth != 0.0 && !walls, "dumbbells.depth",
       "a potential of walls, and there are none; allowed with walls"},
      {m->dumbbells.depth != 0.0 && 2.0 * m->dumbbells.range > m->box.cells[1] * sqrt(m->dumbbells.spring),
       "dumbbells.range", "the potentials of the two walls overlap; allowed: range/sqrt(spring) up to half of L"},
      {walls && m->walls.fill == FILL_PAPER && m->solvent.rule == RULE_AT_PLUS_A &&
           m->solvent.per_cell != nearbyint(m->solvent.per_cell),
       "walls.fill",
       "per_cell less the members of a cell is not a whole number of virtual particles, and at+a gives each a place; "
       "allowed with at+a: planar or none, or a whole per_cell"},
  };
  return refuse_first(rows, sizeof rows / sizeof *rows, error);
}

static bool check_speed(const char *path, struct vec3 v, struct model_error *error)
{
  return vec3_norm(v) < SOUND ||
         model_reject(error, path, "a wall at %.6g a0/t0; allowed: below the speed of sound, %g a0/t0", vec3_norm(v),
                      SOUND);
}

/* The period in collision intervals. */
static bool derive_period(struct model *m, const char *path, double period, struct model_error *error)
{
  const double ratio = period / model_collision_interval(m), whole = nearbyint(ratio);
  if (period == 0.0)
    return true;
  if (!(whole >= LEAST_INTERVALS && whole <= MOST_INTERVALS && fabs(ratio - whole) <= 1e-9 * whole))
    return model_reject(error, path,
                        "%.15g is %.10g collision intervals of %.15g; allowed: a whole number of them, %g to %g",
                        period, ratio, model_collision_interval(m), LEAST_INTERVALS, MOST_INTERVALS);
  m->wave.intervals = (uint32_t)whole;
  return true;
}

/* Amplitude of the rate of a strain that oscillates: 2 pi strain/period. */
static bool derive_rate(const char *path, double strain, double period, double *rate, struct model_error *error)
{
  if (strain == 0.0)
    return true;
  if (period == 0.0)
    return model_reject(error, path, "a strain without a period; allowed with a period above 0");
  *rate = 6.283185307179586 * strain / period;
  return true;
}

static bool finish_walls(struct model *m, struct model_error *error)
{
  struct wall_model *w = &m->walls;
  if (w->kind == WALL_ABSENT)
    return true;
  if (!derive_rate("walls.strain", w->strain, w->period, &w->shear_rate, error))
    return false;
  if (w->shear_rate != 0.0) {
    if (vec3_norm(w->lower) != 0.0 || vec3_norm(w->upper) != 0.0)
      return model_reject(error, "walls.shear_rate", "velocities of the walls are given too; allowed: one of the two");
    w->upper.x = 0.5 * w->shear_rate * m->box.cells[1];
    w->lower.x = -w->upper.x;
  }
  box_bound(&m->box, 1, BOUNDARY_WALL);
  return check_speed("walls.lower", w->lower, error) && check_speed("walls.upper", w->upper, error) &&
         derive_period(m, "walls.period", w->period, error);
}

/* A half step's slide must be within the range of lattice_from_a0, and a particle that crosses the boundary must not be
 * faster than sound there. */
static bool finish_shear(struct model *m, struct model_error *error)
{
  struct shear_model *s = &m->shear;
  if (!derive_rate("shear.strain", s->strain, s->period, &s->rate, error))
    return false;
  if (s->rate == 0.0)
    return s->period == 0.0 ||
           model_reject(error, "shear.period", "a period without a rate or strain; allowed: with one of the two");
  const double most = fmin(2.0 * SOUND, LATTICE_MAX_MOVE / (m->box.cells[1] * m->time_step));
  if (!(fabs(s->rate) < most))
    return model_reject(error, "shear.rate", "%.6g / t0; allowed: below %.6g / t0", s->rate, most);
  box_bound(&m->box, 1, BOUNDARY_SHEAR);
  return derive_period(m, "shear.period", s->period, error);
}

bool flow_finish(struct model *m, struct model_error *error)
{
  return check_plane(m, error) && check_force(m, error) && finish_walls(m, error) && finish_shear(m, error) &&
         check_boundary(m, error);
}
