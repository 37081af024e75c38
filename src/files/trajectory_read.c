/* Frames of trajectories become states. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "files/frames.h"
#include "files/trajectory.h"

struct trajectory *trajectory_open_read(const char *path, struct message *message)
{
  struct trajectory *t = trajectory_allocate(path);
  if (!t) {
    message_no_memory(message, "%s: out of memory", path);
    return NULL;
  }
  enum h5_trouble trouble;
  t->frames_apart = frames_open(path, &trouble, message);
  if (!t->frames_apart)
    return trajectory_give_up(t);
  const struct frames_about *about = &t->frames_apart->about;
  if (about->checkpoint) {
    message_set(message, "%s: an HDF5 file without an H5MD trajectory: a checkpoint", path);
    return trajectory_give_up(t);
  }
  t->frames = about->frames;
  t->particles = about->rows;
  return t;
}

uint64_t trajectory_frames(const struct trajectory *t)
{
  return t->frames;
}

bool trajectory_has_steps(const struct trajectory *t)
{
  return t->frames_apart->about.steps;
}

bool trajectory_has_velocities(const struct trajectory *t)
{
  return t->frames_apart->about.velocities;
}

bool trajectory_has_solvent(const struct trajectory *t, const struct model *model)
{
  return model_has_solvent(model) && t->particles == model->vertices + model->solvent.particles;
}

char *trajectory_scene_text(const struct trajectory *t)
{
  return t->frames_apart->scene ? strdup(t->frames_apart->scene) : NULL;
}

bool trajectory_damaged(const struct trajectory *t)
{
  return t->damaged;
}

static bool fits_model(const struct trajectory *t, const struct model *m, struct message *message)
{
  const struct picture *p = &t->frames_apart->picture;
  if (t->particles != m->vertices && !trajectory_has_solvent(t, m))
    return message_set(message, "%s: its frames hold %u particles; the scene has %u vertices and %u solvent particles",
                       t->path, t->particles, m->vertices, m->solvent.particles);
  if (!p->has_box)
    return message_set(message, "%s: its box (box/edges) cannot be read or is not rectangular", t->path);
  for (int k = 0; k < 3; k++)
    if (p->edge[k] != m->box.cells[k])
      return message_set(message, "%s: its box has edges %.17g, %.17g, %.17g; the scene %d, %d, %d", t->path,
                         p->edge[0], p->edge[1], p->edge[2], m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  return true;
}

/* Positions must be within reach; that all numbers are finite has been looked at. */
static bool within_limit(const struct trajectory *t, uint64_t frame, struct message *message)
{
  const double *position = t->frames_apart->picture.position;
  for (size_t k = 0; k < 3 * (size_t)t->particles; k++)
    if (!(fabs(position[k]) <= TRAJECTORY_REACH))
      return message_set(message,
                         "%s: frame %" PRIu64 ": a position of particle %zu is %g; allowed are numbers up to %.7g",
                         t->path, frame, k / 3, position[k], TRAJECTORY_REACH);
  return true;
}

/* llrint instead of lattice_round: the latter ends at 2048 a0. */
static int64_t to_lattice(double x)
{
  return llrint(x * LATTICE_PER_A0);
}

/* Along a periodic edge solvent may be in any image; beyond a wall nothing is, and images that slide have velocities of
 * their own. */
static bool solvent_inside(const struct trajectory *t, const struct model *m, struct message *message)
{
  const double *row = t->frames_apart->picture.position + 3 * (size_t)m->vertices;
  const enum boundary_kind kind = m->box.boundary[1];
  if (kind == BOUNDARY_PERIODIC || !trajectory_has_solvent(t, m))
    return true;
  for (uint32_t i = 0; i < m->solvent.particles; i++) {
    const int64_t y = to_lattice(row[3 * (size_t)i + 1]);
    if (y >= 0 && y < m->box.edge[1] + (kind == BOUNDARY_WALL)) /* on a wall is inside */
      continue;
    char place[TEXT_REAL_SIZE];
    text_shortest(row[3 * (size_t)i + 1], place); /* may be beyond by a hair */
    return message_set(message,
                       kind == BOUNDARY_WALL
                           ? "%s: solvent particle %u is at y = %s, beyond the walls at 0 and %d"
                           : "%s: solvent particle %u is at y = %s, outside of a sheared box, whose images along y "
                             "slide and have other velocities; allowed: 0 to below %d",
                       t->path, i, place, m->box.cells[1]);
  }
  return true;
}

static void take_positions(const struct trajectory *t, const struct model *m, struct state *state)
{
  const double *row = t->frames_apart->picture.position;
  struct solvent *p = &state->solvent;
  for (uint32_t v = 0; v < state->vertices; v++, row += 3)
    state->position[v] = (struct point){to_lattice(row[0]), to_lattice(row[1]), to_lattice(row[2])};
  if (!trajectory_has_solvent(t, m))
    return;
  for (uint32_t i = 0; i < p->n; i++, row += 3) {
    p->id[i] = i;
    p->x[i] = lattice_fold(to_lattice(row[0]), m->box.edge[0]);
    p->y[i] = m->box.boundary[1] == BOUNDARY_PERIODIC ? lattice_fold(to_lattice(row[1]), m->box.edge[1])
                                                      : to_lattice(row[1]); /* solvent_inside */
    p->z[i] = lattice_fold(to_lattice(row[2]), m->box.edge[2]);
  }
}

static void take_velocities(const struct trajectory *t, const struct model *m, struct state *state)
{
  const double *row = t->frames_apart->picture.velocity;
  memcpy(state->velocity, row, (size_t)state->vertices * sizeof *state->velocity);
  row += 3 * (size_t)state->vertices;
  for (uint32_t i = 0; trajectory_has_solvent(t, m) && i < state->solvent.n; i++, row += 3) {
    state->solvent.vx[i] = row[0];
    state->solvent.vy[i] = row[1];
    state->solvent.vz[i] = row[2];
  }
}

bool trajectory_read(struct trajectory *t, const struct model *model, uint64_t frame, struct state *state,
                     struct message *message)
{
  const enum frame_verdict verdict = frames_read(t->frames_apart, frame, message);
  t->damaged = verdict == FRAME_DAMAGED;
  if (verdict != FRAME_FINE || !fits_model(t, model, message) || !within_limit(t, frame, message) ||
      !solvent_inside(t, model, message))
    return false;
  state->step = t->frames_apart->picture.step;
  state->solvent_lag = 0;
  take_positions(t, model, state);
  if (trajectory_has_velocities(t))
    take_velocities(t, model, state);
  return true;
}
