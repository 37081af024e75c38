/* What pulls the bead, and what takes up the momentum. */
#include "base/elementary.h"
#include "system/bead.h"
#include "system/fluid.h"

/* Where the bead is at the start, on the lattice. */
static struct point start_of(const struct model *model)
{
  const struct vec3 c = model->bead.center;
  return (struct point){lattice_from_a0(c.x), lattice_from_a0(c.y), lattice_from_a0(c.z)};
}

/* How far the trap is from where it was at the start, a0. */
static struct vec3 trap_way(const struct bead_drive *d, double time)
{
  const struct vec3 way = vec3_scale(time, d->velocity);
  if (d->period == 0.0)
    return way;
  const double turn = fmod(time, d->period) / d->period;
  return vec3_add_scaled(way, elementary_circle_turns(turn).sine, d->amplitude);
}

static double time_of(const struct model *model, uint64_t half_steps)
{
  return 0.5 * (double)half_steps * model->time_step;
}

struct vec3 bead_trap(const struct model *model, uint64_t half_steps)
{
  const struct bead_drive *d = &model->bead.drive;
  if (d->spring == 0.0)
    return (struct vec3){0, 0, 0};
  return vec3_add(point_in_a0(start_of(model)), trap_way(d, time_of(model, half_steps)));
}

/* The way of the bead since the start is taken on the lattice, so that it is exact far from the origin. */
struct vec3 bead_force(const struct model *model, struct point place, uint64_t half_steps)
{
  const struct bead_drive *d = &model->bead.drive;
  const struct vec3 way = point_in_a0(point_minus(place, start_of(model)));
  return vec3_add_scaled(vec3_add(d->force, model->bead.carried), -d->spring,
                         vec3_sub(way, trap_way(d, time_of(model, half_steps))));
}

struct vec3 bead_counter(const struct state *state, const struct model *model)
{
  if (!model->bead.driven || model_has_walls(model))
    return (struct vec3){0, 0, 0};
  const struct vec3 force = bead_force(model, state->bead->position, state->solvent_time);
  return vec3_scale(-1.0 / model->total_mass, force);
}

struct vec3 fluid_acceleration(const struct state *state, const struct model *model)
{
  const bool uniform = model->solvent.profile == PROFILE_UNIFORM;
  return vec3_add(bead_counter(state, model), uniform ? model->solvent.acceleration : (struct vec3){0, 0, 0});
}

/* Vertices take up their share of what a drive gives to the bead: half of it, twice in a step. */
static bool act_counter(void *room, const struct moment *now, const struct stage *stage)
{
  const struct vec3 half = vec3_scale(0.5 * now->model->time_step, bead_counter(now->state, now->model));
  struct vec3 *velocity = now->state->velocity;
  (void)room, (void)stage;
  for (size_t i = 0; i < now->state->vertices; i++)
    velocity[i] = vec3_add(velocity[i], half);
  return true;
}

void bead_plan_counter(struct plan *plan, const struct model *model)
{
  if (model->bead.driven && model->vertices > 0)
    plan_append(plan, (struct stage){.act = act_counter});
}

void bead_kick(struct bead *bead, const struct model *model, uint64_t half_steps, double time)
{
  const struct vec3 force = bead_force(model, bead->position, half_steps);
  bead->velocity = vec3_add_scaled(bead->velocity, time / model->bead.mass, force);
}

void bead_work(struct bead *bead, const struct model *model, struct point from, uint64_t begin, uint64_t end)
{
  const struct vec3 before = bead_force(model, from, begin), after = bead_force(model, bead->position, end);
  const struct vec3 way = point_in_a0(point_minus(bead->position, from));
  bead_account(&bead->account.y, 0.5 * vec3_dot(vec3_add(before, after), way));
}

struct vec3 bead_velocity_now(const struct state *state, const struct model *model)
{
  const struct bead *bead = state->bead;
  if (!model->bead.driven)
    return bead->velocity;
  const struct vec3 force = bead_force(model, bead->position, state->solvent_time);
  return vec3_add_scaled(bead->velocity, -0.5 * model->time_step / model->bead.mass, force);
}
