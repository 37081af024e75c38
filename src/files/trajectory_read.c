/* Frames of trajectories become states. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "files/frames.h"
#include "files/trajectory.h"

struct frames *trajectory_open_read(const char *path, struct message *message)
{
  enum h5_trouble trouble;
  struct frames *f = frames_open(path, &trouble, message);
  if (!f || !f->about.checkpoint)
    return f;
  message_set(message, "%s: an HDF5 file without an H5MD trajectory: a checkpoint", path);
  frames_close(f);
  return NULL;
}

bool trajectory_has_solvent(const struct frames *f, const struct model *model)
{
  return model_has_solvent(model) && f->about.rows == model->vertices + model->solvent.particles;
}

static bool fits_model(const struct frames *f, const struct model *m, struct message *message)
{
  const struct picture *p = &f->picture;
  if (f->about.rows != m->vertices && !trajectory_has_solvent(f, m))
    return message_set(message, "%s: its frames hold %u particles; the scene has %u vertices and %u solvent particles",
                       f->path, f->about.rows, m->vertices, m->solvent.particles);
  if (!p->has_box)
    return message_set(message, "%s: its box (box/edges) cannot be read or is not rectangular", f->path);
  for (int k = 0; k < 3; k++)
    if (p->edge[k] != m->box.cells[k])
      return message_set(message, "%s: its box has edges %.17g, %.17g, %.17g; the scene %d, %d, %d", f->path,
                         p->edge[0], p->edge[1], p->edge[2], m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  return true;
}

/* Positions must be within reach; that all numbers are finite has been looked at. */
static bool within_limit(const struct frames *f, uint64_t frame, struct message *message)
{
  const double *position = f->picture.position;
  for (size_t k = 0; k < 3 * (size_t)f->about.rows; k++)
    if (!(fabs(position[k]) <= TRAJECTORY_REACH))
      return message_set(message,
                         "%s: frame %" PRIu64 ": a position of particle %zu is %g; allowed are numbers up to %.7g",
                         f->path, frame, k / 3, position[k], TRAJECTORY_REACH);
  return true;
}

/* llrint instead of lattice_round: the latter ends at 2048 a0. */
static int64_t to_lattice(double x)
{
  return llrint(x * LATTICE_PER_A0);
}

/* Along a periodic edge solvent may be in any image; beyond a wall nothing is, and images that slide have velocities of
 * their own. */
static bool solvent_inside(const struct frames *f, const struct model *m, struct message *message)
{
  const double *row = f->picture.position + 3 * (size_t)m->vertices;
  const enum boundary_kind kind = m->box.boundary[1];
  if (kind == BOUNDARY_PERIODIC || !trajectory_has_solvent(f, m))
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
                       f->path, i, place, m->box.cells[1]);
  }
  return true;
}

static void take_positions(const struct frames *f, const struct model *m, struct state *state)
{
  const double *row = f->picture.position;
  struct solvent *p = &state->solvent;
  for (uint32_t v = 0; v < state->vertices; v++, row += 3)
    state->position[v] = (struct point){to_lattice(row[0]), to_lattice(row[1]), to_lattice(row[2])};
  if (!trajectory_has_solvent(f, m))
    return;
  for (uint32_t i = 0; i < p->n; i++, row += 3) {
    p->id[i] = i;
    p->x[i] = lattice_fold(to_lattice(row[0]), m->box.edge[0]);
    p->y[i] = m->box.boundary[1] == BOUNDARY_PERIODIC ? lattice_fold(to_lattice(row[1]), m->box.edge[1])
                                                      : to_lattice(row[1]); /* solvent_inside */
    p->z[i] = lattice_fold(to_lattice(row[2]), m->box.edge[2]);
  }
}

static void take_velocities(const struct frames *f, const struct model *m, struct state *state)
{
  const double *row = f->picture.velocity;
  memcpy(state->velocity, row, (size_t)state->vertices * sizeof *state->velocity);
  row += 3 * (size_t)state->vertices;
  for (uint32_t i = 0; trajectory_has_solvent(f, m) && i < state->solvent.n; i++, row += 3) {
    state->solvent.vx[i] = row[0];
    state->solvent.vy[i] = row[1];
    state->solvent.vz[i] = row[2];
  }
}

enum frame_verdict trajectory_read(struct frames *f, const struct model *model, uint64_t frame, struct state *state,
                                   struct message *message)
{
  const enum frame_verdict verdict = frames_read(f, frame, message);
  if (verdict != FRAME_FINE)
    return verdict;
  if (!fits_model(f, model, message) || !within_limit(f, frame, message) || !solvent_inside(f, model, message))
    return FRAME_LOST;
  state->step = f->picture.step;
  state->solvent_lag = 0;
  take_positions(f, model, state);
  if (f->about.velocities)
    take_velocities(f, model, state);
  return FRAME_FINE;
}

/* --- steps -------------------------------------------------------------------------------------------------------- */

enum frame_verdict trajectory_find_kept(struct frames *frames, uint64_t keep_to_step, uint64_t *keep,
                                        uint64_t *last_step, struct message *message)
{
  const struct frames_about *about = &frames->about;
  if (about->checkpoint || !about->steps) {
    message_set(message, "%s: not a trajectory of this program", frames->path);
    return FRAME_DAMAGED;
  }
  *last_step = 0;
  for (*keep = 0; *keep < about->frames; ++*keep) {
    const enum frame_verdict verdict = frames_check(frames, *keep, message);
    const uint64_t step = frames->picture.step;
    if (verdict != FRAME_LOST && step > keep_to_step)
      return FRAME_FINE;
    if (verdict != FRAME_FINE)
      return verdict;
    if (*keep > 0 && step <= *last_step) {
      message_set(message, "%s: frame %" PRIu64 " is of step %" PRIu64 ", the frame before it of step %" PRIu64,
                  frames->path, *keep, step, *last_step);
      return FRAME_DAMAGED;
    }
    *last_step = step;
  }
  return FRAME_FINE;
}

bool trajectory_find_end(const char *path, uint64_t keep_to_step, uint64_t *end)
{
  enum h5_trouble trouble;
  struct message ignored;
  uint64_t keep, last_step;
  struct frames *frames = frames_open(path, &trouble, &ignored);
  const bool ok = frames && trajectory_find_kept(frames, keep_to_step, &keep, &last_step, &ignored) == FRAME_FINE;
  if (ok)
    *end = keep > 0 ? last_step + 1 : 0;
  frames_close(frames);
  return ok;
}
