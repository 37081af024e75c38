#include "system/bead.h"

#include <math.h>

#include "system/refusals.h"

__extension__ typedef __int128 wide;

/* x folded into [-edge/2, edge/2). */
static int64_t nearest(int64_t x, int64_t edge)
{
  return lattice_fold(x + edge / 2, edge) - edge / 2;
}

struct point bead_to_image(const struct box *box, struct point from, struct point to)
{
  const int64_t y = to.y - from.y;
  return (struct point){nearest(to.x - from.x, box->edge[0]),
                        box->boundary[1] == BOUNDARY_WALL ? y : nearest(y, box->edge[1]),
                        nearest(to.z - from.z, box->edge[2])};
}

bool bead_is_outside(const struct model *model, struct point center, struct point place)
{
  const struct point d = bead_to_image(&model->box, center, place);
  const wide r = bead_radius(model);
  return (wide)d.x * d.x + (wide)d.y * d.y + (wide)d.z * d.z >= r * r;
}

double bead_half_edge(const struct model *m)
{
  const int *cells = m->box.cells;
  const int across = cells[0] < cells[2] ? cells[0] : cells[2];
  return m->walls.kind == WALL_ABSENT ? 0.5 * box_shortest_edge(&m->box) : 0.5 * across;
}

/* Particles of a few thermal velocities must not reach an image of the bead. */
bool bead_fits(const struct model *m, struct model_error *error)
{
  const double half = bead_half_edge(m), beside = 2.0 + 20.0 * m->solvent.collision_interval;
  const double y = m->bead.center.y, r = m->bead.radius;
  if (!model_has_bead(m))
    return true;
  if (m->walls.kind != WALL_ABSENT && !(y >= r && y <= m->box.cells[1] - r))
    return model_reject(error, "bead.center",
                        "its y is %.6g a0; allowed between walls: from %.6g to %.6g a0, radius and edge less radius", y,
                        r, m->box.cells[1] - r);
  return m->bead.radius + beside <= half ||
         model_reject(
             error, "bead.radius",
             "%.6g a0 in a box whose shortest edge is %g a0; allowed: at most %.6g a0, half the edge less 2 a0 "
             "and 20 collision intervals",
             m->bead.radius, 2.0 * half, fmax(0.0, half - beside));
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
  if (!refusals_check(AT_BEAD, m, NULL, error))
    return false;
  for (uint32_t k = 0; k < m->kinds; k++)
    if (!refusals_check(AT_BEAD_FIBERS, m, &m->kind[k], error))
      return false;
  if (m->bead.mass == 0.0)
    m->bead.mass = displaced;
  if (m->bead.mass < displaced)
    return model_reject(error, "bead.mass", "%.15g m, and the solvent it displaces has %.15g m; allowed: at least that",
                        m->bead.mass, displaced);
  m->bead.carried = vec3_scale(displaced, m->solvent.acceleration);
  m->bead.driven = m->bead.drive.spring > 0.0 || vec3_norm(vec3_add(m->bead.drive.force, m->bead.carried)) > 0.0;
  return refusals_check(AT_TRAP, m, NULL, error) && check_pace(m, error);
}

/* Of the center from the nearer wall, lattice units. */
static int64_t from_wall(const struct model *model, const struct bead *bead)
{
  const int64_t below = bead->position.y, above = model->box.edge[1] - below;
  return below < above ? below : above;
}

bool bead_sound(const struct state *state, const struct model *model, struct fault *fault)
{
  const struct solvent *s = &state->solvent;
  if (state->beads > 0 && model_has_walls(model) && from_wall(model, state->bead) + 1 < bead_radius(model))
    return fault_record(fault, FAULT_BEAD_WALL, state->step, 0, (double)from_wall(model, state->bead) * LATTICE_UNIT,
                        model->bead.radius);
  for (uint32_t i = 0; state->beads > 0 && i < s->n; i++) {
    const struct point x = {s->x[i], s->y[i], s->z[i]}, center = state->bead->position;
    if (!bead_is_outside(model, center, x))
      return fault_record(fault, FAULT_IN_BEAD, state->step, s->id[i],
                          vec3_norm(point_in_a0(bead_to_image(&model->box, center, x))), model->bead.radius);
  }
  return true;
}
