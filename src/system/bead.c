#include "system/bead.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "system/fiber_kind.h"

__extension__ typedef __int128 wide;

/* x folded into [-edge/2, edge/2). */
static int64_t nearest(int64_t x, int64_t edge)
{
  return lattice_fold(x + edge / 2, edge) - edge / 2;
}

struct point bead_to_image(const struct box *box, struct point from, struct point to)
{
  return (struct point){nearest(to.x - from.x, box->edge[0]), nearest(to.y - from.y, box->edge[1]),
                        nearest(to.z - from.z, box->edge[2])};
}

bool bead_is_outside(const struct model *model, struct point center, struct point place)
{
  const struct point d = bead_to_image(&model->box, center, place);
  const wide r = bead_radius(model);
  return (wide)d.x * d.x + (wide)d.y * d.y + (wide)d.z * d.z >= r * r;
}

/* Particles of a few thermal velocities must not reach an image of the bead. */
bool bead_fits(const struct model *m, struct model_error *error)
{
  const double half = 0.5 * box_shortest_edge(&m->box), beside = 2.0 + 20.0 * m->solvent.collision_interval;
  if (!model_has_bead(m))
    return true;
  return m->bead.radius + beside <= half ||
         model_reject(
             error, "bead.radius",
             "%.6g a0 in a box whose shortest edge is %d a0; allowed: at most %.6g a0, half the edge less 2 a0 "
             "and 20 collision intervals",
             m->bead.radius, box_shortest_edge(&m->box), fmax(0.0, half - beside));
}

static bool check_company(const struct model *m, struct model_error *error)
{
  const struct solvent_model *s = &m->solvent;
  const struct {
    bool ok;
    const char *path, *why;
  } rows[] = {
      {model_has_solvent(m), "bead", "it needs solvent particles, and there are none; allowed with a solvent"},
      {m->dimensions == 3, "dimensions", "a sphere is not in a plane; allowed with a bead: 3"},
      {m->medium.kind == 0, "medium", "its pairs do not know the bead; allowed with a bead: no medium"},
      {m->walls.kind == WALL_ABSENT, "walls", "a bead does not touch walls; allowed with a bead: no walls"},
      {m->shear.rate == 0.0, "shear", "a bead has no image that moves; allowed with a bead: no shear"},
      {m->dumbbells.pairs == 0, "dumbbells", "springs do not touch a bead; allowed with a bead: no dumbbells"},
      {s->rule != RULE_AT_PLUS_A, "solvent.rule",
       "virtual particles of a bead have no angular momentum; allowed with a bead: srd | at-a"},
      {s->thermostat == THERMOSTAT_NONE, "solvent.thermostat",
       "its factors do not know the bead's virtual particles; allowed with a bead: none (rule: at-a holds kT = 1)"},
      {s->hydrodynamics, "solvent.hydrodynamics",
       "velocities that are permuted drag no bead; allowed with a bead: "
       "true"},
      {vec3_norm(s->acceleration) == 0.0, "solvent.acceleration",
       "the solvent around a bead is not accelerated; allowed with a bead: [0, 0, 0]"},
      {m->solvent.interval_steps == 1, "time_step",
       "a bead is moved with the solvent; allowed with a bead: the collision interval"},
      {m->scheme != SCHEME_DRIFT_SPLIT, "order",
       "half a drift would be late between steps; allowed with a bead: paper | kick-split"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!rows[i].ok)
      return model_reject(error, rows[i].path, "%s", rows[i].why);
  return true;
}

#define LONGEST 3.0 /* a0: of a bond, with 8 standard deviations of its length and its thickness */

/* A bond must not touch two images of the bead, and all must be answered in one timeline. */
static bool check_fibers(const struct model *m, struct model_error *error)
{
  const struct crossing_model *c = &m->crossing;
  if (m->kinds > 0 && (!c->forbidden || c->rule != CROSSING_EVENT_DRIVEN))
    return model_reject(error, c->forbidden ? "crossing.rule" : "crossing.forbidden",
                        "fibers do not touch the bead; allowed with both: {forbidden: true, rule: event-driven}");
  for (uint32_t k = 0; k < m->kinds; k++) {
    const struct fiber_kind *kind = &m->kind[k];
    const double longest = fiber_mean_bond(kind) + 8.0 / sqrt(kind->spring) + kind->diameter;
    const struct {
      bool ok;
      const char *key, *why;
    } rows[] = {
        {kind->vertices > 1, "vertices", "a vertex without a bond does not touch the bead; allowed: 2 or more"},
        {!kind->frozen || (m->bead.drive.spring == 0.0 && vec3_norm(m->bead.drive.force) == 0.0), "frozen",
         "they do not take up the momentum of the drive; allowed with a bead that is driven: false"},
        {longest <= LONGEST, "bond_length",
         "a bond may be so long that it touches two images of the bead; allowed with a bead: bond, 8/sqrt(spring) and "
         "diameter of 3 a0 together"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
      if (rows[i].ok)
        continue;
      model_reject(error, "fibers", "%s", rows[i].why);
      snprintf(error->path, sizeof error->path, "fibers.%" PRIu32 ".%s", k, rows[i].key);
      return false;
    }
  }
  return true;
}

static bool check_trap(const struct model *m, struct model_error *error)
{
  const struct bead_drive *d = &m->bead.drive;
  const bool moves = vec3_norm(d->velocity) > 0.0, swings = vec3_norm(d->amplitude) > 0.0;
  const struct {
    bool ok;
    const char *path, *why;
  } rows[] = {
      {d->spring > 0.0 || !moves, "bead.drive.velocity", "there is no trap to move; allowed with a spring"},
      {d->spring > 0.0 || !swings, "bead.drive.amplitude", "there is no trap to move; allowed with a spring"},
      {d->period > 0.0 || !swings, "bead.drive.amplitude", "an oscillation needs a period; allowed with one"},
      {d->period == 0.0 || swings, "bead.drive.period", "nothing oscillates; allowed with an amplitude"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!rows[i].ok)
      return model_reject(error, rows[i].path, "%s", rows[i].why);
  return true;
}

enum { LEAST_STEPS_OF_PERIOD = 8 };
#define MOST_TURN 0.5 /* of a trapped bead in a time step, omega dt */

/* What is resolved by steps, and slow beside sound. */
static bool check_pace(const struct model *m, struct model_error *error)
{
  const struct bead_drive *d = &m->bead.drive;
  const double dt = m->time_step, turn = sqrt(d->spring / m->bead.mass) * dt;
  const double swing = d->period > 0.0 ? 6.283185307179586 / d->period * vec3_norm(d->amplitude) : 0.0;
  if (d->period > 0.0 && d->period < LEAST_STEPS_OF_PERIOD * dt)
    return model_reject(error, "bead.drive.period", "%.6g t0; allowed: %d time steps, %.6g t0, or more", d->period,
                        LEAST_STEPS_OF_PERIOD, LEAST_STEPS_OF_PERIOD * dt);
  if (vec3_norm(d->velocity) > BEAD_MOST_SPEED)
    return model_reject(error, "bead.drive.velocity", "%.6g a0/t0 is too near the speed of sound; allowed: at most %g",
                        vec3_norm(d->velocity), BEAD_MOST_SPEED);
  if (swing > BEAD_MOST_SPEED)
    return model_reject(error, "bead.drive.amplitude",
                        "the trap's largest speed, 2 pi/period of it, is %.6g a0/t0, too near that of sound; allowed: "
                        "at most %g",
                        swing, BEAD_MOST_SPEED);
  return turn <= MOST_TURN ||
         model_reject(error, "bead.drive.spring",
                      "sqrt(spring/mass) times the time step is %.6g; allowed: at most %g, a spring of %.6g kT/a0^2",
                      turn, MOST_TURN, MOST_TURN * MOST_TURN * m->bead.mass / (dt * dt));
}

bool bead_finish(struct model *m, struct model_error *error)
{
  const double displaced = m->solvent.per_cell * bead_volume(m);
  if (!model_has_bead(m))
    return true;
  if (!check_company(m, error) || !check_fibers(m, error))
    return false;
  if (m->bead.mass == 0.0)
    m->bead.mass = displaced;
  if (m->bead.mass < displaced)
    return model_reject(error, "bead.mass", "%.15g m, and the solvent it displaces has %.15g m; allowed: at least that",
                        m->bead.mass, displaced);
  m->bead.driven = m->bead.drive.spring > 0.0 || vec3_norm(m->bead.drive.force) > 0.0;
  return check_trap(m, error) && check_pace(m, error);
}

bool bead_sound(const struct state *state, const struct model *model, struct fault *fault)
{
  const struct solvent *s = &state->solvent;
  for (uint32_t i = 0; state->beads > 0 && i < s->n; i++) {
    const struct point x = {s->x[i], s->y[i], s->z[i]}, center = state->bead->position;
    if (!bead_is_outside(model, center, x))
      return fault_record(fault, FAULT_IN_BEAD, state->step, s->id[i],
                          vec3_norm(point_in_a0(bead_to_image(&model->box, center, x))), model->bead.radius);
  }
  return true;
}
