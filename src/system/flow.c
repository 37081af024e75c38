#include "system/flow.h"

#include <math.h>

#include "system/refusals.h"

#define MOST_INTERVALS 1e7 /* of a period: its tables have 24 bytes for each */
#define LEAST_INTERVALS 4.0
#define SOUND 1.0 /* a0/t0: isothermal speed of sound, sqrt(kT/m) */

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
static void derive_rate(double strain, double period, double *rate)
{
  if (strain != 0.0 && period != 0.0)
    *rate = 6.283185307179586 * strain / period;
}

static bool finish_walls(struct model *m, struct model_error *error)
{
  struct wall_model *w = &m->walls;
  if (w->kind == WALL_ABSENT)
    return true;
  derive_rate(w->strain, w->period, &w->shear_rate);
  if (!refusals_check(AT_WALLS, m, NULL, error))
    return false;
  if (w->shear_rate != 0.0) {
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
  derive_rate(s->strain, s->period, &s->rate);
  if (!refusals_check(AT_SHEAR, m, NULL, error))
    return false;
  if (s->rate == 0.0)
    return true;
  const double most = fmin(2.0 * SOUND, LATTICE_MAX_MOVE / (m->box.cells[1] * m->time_step));
  if (!(fabs(s->rate) < most))
    return model_reject(error, "shear.rate", "%.6g / t0; allowed: below %.6g / t0", s->rate, most);
  box_bound(&m->box, 1, BOUNDARY_SHEAR);
  return derive_period(m, "shear.period", s->period, error);
}

bool flow_finish(struct model *m, struct model_error *error)
{
  return refusals_check(AT_FLOW, m, NULL, error) && finish_walls(m, error) && finish_shear(m, error) &&
         refusals_check(AT_BOUNDARY, m, NULL, error);
}
