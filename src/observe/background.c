#include "observe/background.h"

#include "theory/theory.h"
#include "wall/motion.h"

static bool sticks(const struct model *m)
{
  return model_has_walls(m) && m->walls.kind == WALL_NO_SLIP;
}

/* Both walls have one velocity, which does not change. */
static bool walls_go_together(const struct model *m)
{
  return vec3_norm(vec3_sub(m->walls.lower, m->walls.upper)) == 0.0 &&
         (m->walls.period == 0.0 || vec3_norm(m->walls.lower) == 0.0);
}

struct vec3 background_acceleration(const struct model *m)
{
  if (!model_keeps_momentum(m) || sticks(m) || m->held > 0)
    return (struct vec3){0, 0, 0};
  struct vec3 a = vec3_scale(1.0 / (m->total_mass + m->bead.mass), theory_net_force(m));
  if (model_has_walls(m))
    a.y = 0.0;
  return a;
}

/* At time 0. */
static struct vec3 steady_velocity(const struct model *m)
{
  if (!sticks(m))
    return m->flow;
  return walls_go_together(m) ? m->walls.lower : (struct vec3){0, 0, 0};
}

struct vec3 background_velocity(const struct model *m, double time)
{
  return vec3_add_scaled(steady_velocity(m), time, background_acceleration(m));
}

struct vec3 background_displacement(const struct model *m, double from, double to)
{
  return vec3_add_scaled(vec3_scale(to - from, steady_velocity(m)), 0.5 * (to - from) * (to + from),
                         background_acceleration(m));
}

struct vec3 background_flow(const struct model *m, const struct state *state, double y)
{
  const uint64_t interval = shear_interval(m, state->solvent_time + state->solvent_lag);
  const struct vec3 v = background_velocity(m, (double)state->step * m->time_step);
  return vec3_add(v, (struct vec3){shear_rate(m, interval) * (y - 0.5 * m->box.cells[1]), 0, 0});
}

struct vec3 background_applied(const struct model *m, const struct state *state, double y)
{
  const uint64_t interval = shear_interval(m, state->solvent_time + state->solvent_lag);
  if (!sticks(m))
    return background_flow(m, state, y);
  const struct vec3 low = shear_wall_velocity(m, WALL_LOWER, interval);
  return vec3_add_scaled(low, y / m->box.cells[1], vec3_sub(shear_wall_velocity(m, WALL_UPPER, interval), low));
}

static bool pulls_fibers(const struct model *m)
{
  bool any = false;
  for (uint32_t k = 0; k < m->kinds; k++)
    any |= vec3_norm(m->kind[k].force) > 0.0;
  return any;
}

bool background_differs(const struct model *m)
{
  const struct bead_drive *d = &m->bead.drive;
  const bool driven = vec3_norm(m->solvent.acceleration) > 0.0;
  const bool in_channel = sticks(m) && (driven || pulls_fibers(m) || !walls_go_together(m) ||
                                        vec3_norm(vec3_sub(m->flow, m->walls.lower)) > 0.0);
  return in_channel || (driven && m->solvent.profile != PROFILE_UNIFORM) ||
         vec3_norm(d->force) + vec3_norm(d->velocity) + vec3_norm(d->amplitude) > 0.0;
}

double background_ahead(const struct model *m)
{
  return m->scheme == SCHEME_DRIFT_SPLIT ? 0.0 : 0.5 * m->time_step;
}

struct vec3 background_peculiar(const struct model *m, const struct state *state, uint32_t vertex, struct vec3 force,
                                struct vec3 (*flow)(const struct model *, const struct state *, double y))
{
  const double back = background_ahead(m), forth = 0.5 * m->time_step - back;
  const struct vec3 ahead = state->velocity[vertex], v = vec3_add_scaled(ahead, -back * m->inverse_mass[vertex], force);
  return vec3_sub(v, flow(m, state, (double)state->position[vertex].y * LATTICE_UNIT + forth * ahead.y));
}
