/* A fluid of independent particles, in free flight between collisions. */
#include "base/normal.h"
#include "fluid/boundary.h"
#include "fluid/fluid.h"

/* --- start ------------------------------------------------------------------------------------------------------- */

/* A height that is uniform in the box, moved into the part of it that the particle's group has. */
static int64_t start_height(const struct model *model, uint32_t id, int64_t y)
{
  const struct medium_model *m = &model->medium;
  if (m->second.start != LAYOUT_SLAB || m->second.share == 0.0)
    return y;
  const int64_t edge = model->box.edge[1], border = (int64_t)(m->second.share * (double)edge);
  const double part = (double)y / (double)edge;
  return id >= m->second.first ? (int64_t)(part * (double)border) : border + (int64_t)(part * (double)(edge - border));
}

struct point fluid_start_place(const struct model *model, uint32_t id, uint32_t attempt)
{
  const struct random_words xy = random_at(model->seed, RANDOM_SOLVENT_POSITION, 2 * attempt, 0, id);
  const struct random_words z = random_at(model->seed, RANDOM_SOLVENT_POSITION, 2 * attempt + 1, 0, id);
  return (struct point){lattice_uniform(random_u64(xy, 0), model->box.cells[0]),
                        start_height(model, id, lattice_uniform(random_u64(xy, 1), model->box.cells[1])),
                        model_is_flat(model) ? 0 : lattice_uniform(random_u64(z, 0), model->box.cells[2])};
}

/* Uniform positions, Maxwell velocities. In a plane, at z = 0. */
static void start_points(struct state *state, const struct model *model)
{
  const bool flat = model_is_flat(model);
  struct solvent *s = &state->solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    const uint32_t id = s->id[i];
    const struct point x = fluid_start_place(model, id, 0);
    s->x[i] = x.x, s->y[i] = x.y, s->z[i] = x.z;
    double a[2], b[2];
    random_normal_pair(random_at(model->seed, RANDOM_SOLVENT_VELOCITY, 0, 0, id), a);
    random_normal_pair(random_at(model->seed, RANDOM_SOLVENT_VELOCITY, 1, 0, id), b);
    s->vx[i] = a[0];
    s->vy[i] = a[1];
    s->vz[i] = flat ? 0.0 : b[0];
  }
}

/* --- flight ------------------------------------------------------------------------------------------------------ */

static bool stream_points(struct state *state, const struct model *model, uint32_t first, uint32_t n,
                          struct fault *fault)
{
  const struct span span = boundary_lag(state, model);
  return boundary_of(&model->box)->fly(state, model, &span, first, n, fault);
}

static void points_now(const struct state *state, const struct model *model, uint32_t first, uint32_t n,
                       struct point *position, struct vec3 *velocity)
{
  const struct solvent *s = &state->solvent;
  const struct span span = boundary_lag(state, model);
  const struct boundary *boundary = boundary_of(&model->box);
  for (uint32_t k = 0, i = first; k < n; k++, i++) {
    struct point x = {s->x[i], s->y[i], s->z[i]};
    struct vec3 v = solvent_velocity(s, i);
    boundary->now(model, &span, &x, &v);
    if (position)
      position[k] = x;
    if (velocity)
      velocity[k] = v;
  }
}

const struct fluid fluid_points = {.name = "points", .start = start_points, .stream = stream_points, .now = points_now};
