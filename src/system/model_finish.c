/* Checks and completes a model. Every bound is checked here, so that it holds for scenes and for models built by hand.
 * Then the derived part is filled. */
#include <inttypes.h>
#include <math.h>

#include "base/elementary.h"
#include "system/bead.h"
#include "system/fiber_kind.h"
#include "system/flow.h"
#include "system/medium.h"
#include "system/model.h"
#include "system/model_keys.h"
#include "system/shear.h"
#include "system/topology.h"

/* --- solvent ----------------------------------------------------------------------------------------------------- */

static void derive_rotation(struct solvent_model *solvent)
{
  const struct circle_point p = elementary_circle_degrees(solvent->rotation_angle);
  solvent->cosine = p.cosine;
  solvent->sine = p.sine;
}

static bool derive_interval(struct model *m, struct model_error *error)
{
  const double interval = m->solvent.collision_interval, ratio = interval / m->time_step, whole = nearbyint(ratio);
  if (!(whole >= 1.0 && whole <= 1e9 && fabs(ratio - whole) <= 1e-9 * whole))
    return model_reject(
        error, "solvent.collision_interval",
        "%.15g is %.10g time steps of %.15g; allowed: a whole multiple of the time step, 1 to 1e9 of them", interval,
        ratio, m->time_step);
  m->solvent.interval_steps = (uint32_t)whole;
  m->solvent.collision_interval = model_collision_interval(m);
  return true;
}

/* Per cell: keeps their momentum within a part of its sum's range, see mpc/random_solvent.c. */
enum { MOST_PHANTOMS = 1000 };

/* Phantoms are a heat bath by themselves: they have no memory, and nothing can act on them. */
static bool check_phantoms(const struct model *m, struct model_error *error)
{
  const struct solvent_model *s = &m->solvent;
  const struct {
    bool ok;
    const char *why;
  } rows[] = {
      {!s->hydrodynamics, "phantoms carry no hydrodynamic interactions; allowed with hydrodynamics: false"},
      {s->thermostat == THERMOSTAT_NONE, "phantoms are a thermostat; allowed with thermostat: none"},
      {vec3_norm(s->acceleration) == 0.0, "phantoms are not accelerated; allowed with acceleration: [0, 0, 0]"},
      {s->per_cell <= MOST_PHANTOMS, "too many phantoms; allowed with a per_cell of at most 1000"},
      {m->kinds > 0, "phantoms are drawn for fibers only, and there are none; allowed: particles"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!rows[i].ok)
      return model_reject(error, "solvent.bath", "%s", rows[i].why);
  return true;
}

static bool derive_particles(struct model *m, struct model_error *error)
{
  m->solvent.particles = 0;
  if (model_has_phantoms(m))
    return check_phantoms(m, error);
  const double particles = nearbyint(m->solvent.per_cell * (box_volume(&m->box) - bead_volume(m)));
  if (!(particles >= 1.0 && particles < 2147483648.0))
    return model_reject(error, "solvent.per_cell",
                        "%.15g in a box of %.0f cells makes %.0f particles; allowed: 1 to 2147483647",
                        m->solvent.per_cell, box_volume(&m->box), particles);
  m->solvent.particles = (uint32_t)particles;
  return true;
}

#define LOOSEST 1e-4 /* kT/a0^2: twenty standard deviations are below LATTICE_MAX_MOVE */

/* Dumbbells are as many as there are pairs among their share of the particles. */
static bool finish_dumbbells(struct model *m, struct model_error *error)
{
  struct dumbbell_model *d = &m->dumbbells;
  if (d->spring == 0.0)
    return true;
  if (!model_has_solvent(m))
    return model_reject(error, "dumbbells",
                        "they are pairs of solvent particles, and there are none; allowed with a "
                        "solvent of particles");
  if (!m->solvent.hydrodynamics)
    return model_reject(error, "solvent.hydrodynamics",
                        "velocities that are permuted are not those of springs; allowed with dumbbells: true");
  if (d->spring < LOOSEST)
    return model_reject(error, "dumbbells.spring",
                        "%.6g makes dumbbells of %.3g a0 along each axis, too long for a flight; allowed: %g and more",
                        d->spring, 1.0 / sqrt(d->spring), LOOSEST);
  d->pairs = (uint32_t)(0.5 * d->fraction * m->solvent.particles);
  d->frequency = sqrt(2.0 * d->spring);
  if (d->pairs == 0)
    return model_reject(error, "dumbbells.fraction", "%.6g of %" PRIu32 " particles are less than two; allowed: more",
                        d->fraction, m->solvent.particles);
  return true;
}

static bool finish_solvent(struct model *m, struct model_error *error)
{
  derive_rotation(&m->solvent);
  if (m->solvent.collision_interval != 0.0 && !derive_interval(m, error))
    return false;
  if (model_rule_is_thermal(m) && m->solvent.thermostat != THERMOSTAT_NONE)
    return model_reject(error, "solvent.thermostat",
                        "the collision rule holds the temperature by itself; allowed with it: none");
  if (m->solvent.per_cell != 0.0)
    return derive_particles(m, error);
  return !model_has_phantoms(m) ||
         model_reject(error, "solvent.bath", "phantoms without a per_cell; allowed with a per_cell above 0");
}

/* --- crossing ---------------------------------------------------------------------------------------------------- */

/* What only a rule knows that moves one vertex at a time. */
static bool check_crossing(const struct model *m, struct model_error *error)
{
  const struct crossing_model *c = &m->crossing;
  const struct {
    bool ok;
    const char *path, *why;
  } rows[] = {
      {c->rejection == REJECTION_STAY, "crossing.refusal",
       "with rule: event-driven no move is refused: bonds bounce at the time of contact; allowed: stay, which has no "
       "effect there"},
      {c->frame == FRAME_LABORATORY, "crossing.frame",
       "with rule: event-driven no vertex stands still, so there is no frame of the moves; allowed: laboratory, which "
       "has "
       "no effect there"},
      {c->exclusion == EXCLUSION_SHARED_VERTEX, "crossing.exclusion",
       "with rule: event-driven no bond moves alone, so none is linked to it; allowed: shared-vertex"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows && c->rule == CROSSING_EVENT_DRIVEN; i++)
    if (!rows[i].ok)
      return model_reject(error, rows[i].path, "%s", rows[i].why);
  return true;
}

/* --- the whole --------------------------------------------------------------------------------------------------- */

bool model_finish_numbers(struct model *m, struct model_error *error)
{
  if (m->crossing.rule == CROSSING_FREE) /* a model built by hand that leaves it open */
    m->crossing.rule = CROSSING_SEQUENTIAL;
  if (m->dimensions == 0) /* the same */
    m->dimensions = 3;
  if (m->dumbbells.spring != 0.0) {
    m->dumbbells.fraction = m->dumbbells.fraction == 0.0 ? 1.0 : m->dumbbells.fraction;
    m->dumbbells.range = m->dumbbells.range == 0.0 ? 1.2 : m->dumbbells.range;
  }
  if (!keys_check(&model_keys, m, error))
    return false;
  m->box = box_of_cells(m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  if (!medium_finish(m, error) || !bead_fits(m, error) || !finish_solvent(m, error) || !finish_dumbbells(m, error) ||
      !flow_finish(m, error) || !fibers_finish(m, error) || !bead_finish(m, error) || !check_crossing(m, error))
    return false;
  if (!model_collides(m) && m->kinds == 0)
    return model_reject(error, "",
                        "there is nothing to simulate; a scene has a 'solvent', a 'medium' of pairs, 'fibers', or more "
                        "than one of these");
  model_count(m);
  return true;
}

bool model_finish(struct model *m, struct model_error *error)
{
  return model_finish_numbers(m, error) &&
         ((model_lay(m) && shear_finish(m)) || model_reject(error, "", "out of memory for this many vertices"));
}
