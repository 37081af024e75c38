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
#include "system/refusals.h"
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

static bool derive_particles(struct model *m, struct model_error *error)
{
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
  if (!refusals_check(AT_DUMBBELLS, m, NULL, error))
    return false;
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
  if (!refusals_check(AT_SOLVENT, m, NULL, error))
    return false;
  if (m->solvent.per_cell == 0.0)
    return true;
  m->solvent.particles = 0;
  return model_has_phantoms(m) || derive_particles(m, error);
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
      !flow_finish(m, error) || !fibers_finish(m, error) || !bead_finish(m, error) ||
      !refusals_check(AT_END, m, NULL, error))
    return false;
  model_count(m);
  return true;
}

bool model_finish(struct model *m, struct model_error *error)
{
  return model_finish_numbers(m, error) &&
         ((model_lay(m) && shear_finish(m)) || model_reject(error, "", "out of memory for this many vertices"));
}
