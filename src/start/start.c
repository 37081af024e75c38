#include "start/start.h"

#include <string.h>

#include "bead/bead.h"
#include "fluid/fluid.h"
#include "medium/repulsion.h"
#include "start/fibers.h"
#include "system/bead.h"
#include "wall/motion.h"

struct vec3 start_conserved_axes(const struct model *model)
{
  const double y = !model_has_walls(model), along = y != 0.0 || model->walls.kind == WALL_SLIP;
  return !model_keeps_momentum(model) || model->total_mass == 0.0 ? (struct vec3){0, 0, 0}
                                                                  : (struct vec3){along, y, along};
}

/* Replaces the total momentum of the state by that of the flow: all velocities change by the same amount. Where
 * momentum is not conserved, it stays as it was drawn about the flow. */
static void set_total_momentum(struct state *state, const struct model *model)
{
  struct solvent *s = &state->solvent;
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < s->n; i++)
    p = vec3_add(p, solvent_velocity(s, i));
  for (uint32_t v = 0; v < state->vertices; v++)
    p = vec3_add_scaled(p, model->mass[v], state->velocity[v]);

  if (state->beads > 0)
    p = vec3_add_scaled(p, model->bead.mass, state->bead->velocity);

  const struct vec3 axes = start_conserved_axes(model);
  const double mass = model->total_mass + model->bead.mass, each = mass > 0.0 ? -1.0 / mass : 0.0;
  const struct vec3 change =
      vec3_add_scaled(model->flow, each, (struct vec3){axes.x * p.x, axes.y * p.y, axes.z * p.z});
  for (uint32_t i = 0; i < s->n; i++) {
    s->vx[i] += change.x;
    s->vy[i] += change.y;
    s->vz[i] += change.z;
  }
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v] = vec3_add(state->velocity[v], change);
  if (state->beads > 0)
    state->bead->velocity = vec3_add(state->bead->velocity, change);
}

/* As between steps, the velocity of a driven bead is that of the half step ahead; that of all else is half a step
 * behind with the counterforce, which acts in flight. half: of a step, t0; below 0: back to the time of the step. */
static void shift_drive(struct state *state, const struct model *model, double half)
{
  const struct vec3 behind = vec3_scale(-half, bead_counter(state, model));
  struct solvent *s = &state->solvent;
  if (!model->bead.driven)
    return;
  bead_kick(state->bead, model, state->solvent_time, half);
  for (uint32_t i = 0; i < s->n; i++)
    s->vx[i] += behind.x, s->vy[i] += behind.y, s->vz[i] += behind.z;
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v] = vec3_add(state->velocity[v], behind);
}

void start_begin_drive(struct state *state, const struct model *model)
{
  if (!model->bead.driven)
    return;
  if (vec3_norm(start_conserved_axes(model)) > 0.0) /* elsewhere a snapshot's velocities stay what they are */
    set_total_momentum(state, model);
  shift_drive(state, model, 0.5 * model->time_step);
}

void start_end_drive(struct state *state, const struct model *model)
{
  shift_drive(state, model, -0.5 * model->time_step);
}

/* A sheared box starts with its linear profile: velocities are thermal about it. */
static void add_shear(struct state *state, const struct model *model)
{
  const double rate = model_is_sheared(model) ? shear_rate(model, 0) : 0.0;
  const int64_t middle = model->box.edge[1] / 2;
  struct solvent *s = &state->solvent;
  if (rate == 0.0)
    return;
  for (uint32_t i = 0; i < s->n; i++)
    s->vx[i] += rate * (double)(s->y[i] - middle) * LATTICE_UNIT;
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v].x += rate * (double)(state->position[v].y - middle) * LATTICE_UNIT;
}

bool start_state(struct state *state, const struct model *model, struct work *work)
{
  state->step = 0;
  state->solvent_lag = 0;
  state->solvent_time = 0;
  contact_forget_places(&work->contact);
  fluid_of(model)->start(state, model);
  if (state->beads > 0)
    bead_start(state, model);
  if (!start_fibers(state, model, &work->watch, &work->fault))
    return false;
  if (model_is_overdamped(model)) {
    memset(state->velocity, 0, state->vertices * sizeof *state->velocity);
    return true;
  }
  set_total_momentum(state, model);
  shift_drive(state, model, 0.5 * model->time_step);
  add_shear(state, model);
  if (!fiber_forces(state, model, work->fiber.force, 0, &work->fault))
    return false;
  fiber_kick(state, model, work->fiber.force, 0.5);
  if (!model_repels(model))
    return true;
  if (!repulsion_forces(state, model, &work->medium, &work->fault))
    return false;
  repulsion_kick(state, model, &work->medium, 0.5);
  return true;
}
