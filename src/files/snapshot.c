/* States that scenes start from: checkpoints, and last frames of trajectories. */
#include "files/snapshot.h"

#include <string.h>

#include "files/checkpoint.h"
#include "files/frames.h"
#include "files/structure.h"
#include "files/trajectory.h"
#include "fluid/fluid.h"
#include "scene/scene.h"
#include "start/start.h"
#include "system/bead.h"
#include "wall/motion.h"

/* Rows must be in the scene's order: vertices fiber by fiber, then solvent. */
static bool in_order(const struct frames *frames, const struct model *model, const char *path, struct message *message)
{
  struct message why;
  if (frames->about.unfit[0])
    return message_set(message, "%s: %s", path, frames->about.unfit);
  return !structure_differs(&frames->structure, model, &why) || message_set(message, "%s: %s", path, why.text);
}

/* Streams the solvent to where it is now. */
static bool make_up_lag(struct state *state, const struct model *model, struct message *message)
{
  struct fault fault = {.code = FAULT_NONE};
  if (model_has_dumbbells(model)) /* two particles move together, and their vector with them */
    return fluid_stream(state, model, &fault) || message_fault(message, &fault);

  struct solvent *p = &state->solvent;
  for (uint32_t i = 0; state->solvent_lag > 0 && i < p->n; i++) {
    const struct point r = fluid_position_now(state, model, i);
    const struct vec3 v = fluid_velocity_now(state, model, i);
    p->x[i] = r.x, p->y[i] = r.y, p->z[i] = r.z;
    p->vx[i] = v.x, p->vy[i] = v.y, p->vz[i] = v.z;
  }
  return true;
}

/* What a file says of the run that made it. */
struct past {
  bool known; /* else nothing below */
  struct scene scene;
};

/* The scene, if it can be read and is of a box as this one. */
static void look_back(struct past *past, const struct frames *frames, const struct model *model)
{
  struct message ignored;
  past->known = frames->scene &&
                scene_read_text_numbers(frames->path, frames->scene, strlen(frames->scene), &past->scene, &ignored);
  if (!past->known)
    return;
  struct model *m = &past->scene.model;
  past->known = memcmp(m->box.cells, model->box.cells, sizeof model->box.cells) == 0 && shear_finish(m);
  if (past->known)
    shear_begin(m, frames->about.slide);
  else
    scene_free(&past->scene);
}

static void forget(struct past *past)
{
  if (past->known)
    scene_free(&past->scene);
}

/* Where the images of a sheared box are by now. No other program's file says it: they begin without a slide, and
 * start_warnings tells. */
static bool find_slide(const struct past *past, const struct model *model, uint64_t step,
                       struct snapshot_origin *origin, const char *path, struct message *message)
{
  origin->slide = past->known ? (uint64_t)shear_offset(&past->scene.model, 2 * step) : 0;
  origin->untold |= !past->known && model_is_sheared(model) ? UNTOLD_SLIDE : 0;
  return past->known || !origin->has_stream || !model_is_sheared(model) ||
         message_set(message,
                     "%s: its scene cannot be read, so nobody knows how far the images of a sheared box have "
                     "slid; allowed: a whole file of this program, or a box that is not sheared",
                     path);
}

/* A state of one model is one of the other. */
static bool same_form(const struct model *m, const struct model *other)
{
  return m->solvent.particles == other->solvent.particles && m->vertices == other->vertices &&
         m->dumbbells.pairs == other->dumbbells.pairs && model_has_bead(m) == model_has_bead(other) &&
         model_has_walls(m) == model_has_walls(other);
}

/* The lag is time that passed in the run that made the checkpoint: its walls, images and forces were there. */
static bool make_up_lag_of(const struct past *past, const struct checkpoint_summary *summary, struct state *state,
                           const struct model *model, struct message *message)
{
  struct model then = past->known && same_form(&past->scene.model, model) ? past->scene.model : *model;
  then.time_step = summary->time_step;
  then.solvent.acceleration = summary->acceleration;
  return make_up_lag(state, &then, message);
}

/* The bead's drive so far ends: the next one begins with the velocities of now. */
static bool end_drive_of(const struct past *past, const struct checkpoint_summary *summary, struct state *state,
                         const struct model *model, const char *path, struct message *message)
{
  struct model then = *model;
  if (!model_has_bead(model))
    return true;
  if (!past->known)
    return message_set(message,
                       "%s: its scene cannot be read, so nobody knows what drove its bead; allowed: a whole file of "
                       "this program, or a scene without a bead",
                       path);
  then.bead = past->scene.model.bead;
  then.time_step = summary->time_step;
  start_end_drive(state, &then);
  return true;
}

/* What is counted since the start. */
static void begin_accounts(struct state *state)
{
  state->counts = (struct collision_counts){0};
  for (uint32_t k = 0; k < state->wall_rows; k++) {
    state->wall_momentum[k] = (struct point){0, 0, 0};
    state->wall_turns[k] = 0;
  }
  if (state->beads > 0)
    state->bead->account = (struct point){0, 0, 0};
}

/* By its scene, or else by its own word; 0: none. */
static bool same_dimensions(const struct past *past, uint32_t dimensions, const struct model *m, const char *path,
                            struct message *message)
{
  const uint32_t its = past->known ? past->scene.model.dimensions : dimensions;
  return its == 0 || its == m->dimensions ||
         message_set(message, "%s: it is of a scene with dimensions: %u, this one has %u", path, its, m->dimensions);
}

static bool start_from_checkpoint(const char *path, const struct model *model, struct state *state,
                                  struct snapshot_origin *origin, struct message *message)
{
  struct checkpoint_summary summary;
  enum h5_trouble trouble;
  struct fault fault = {.code = FAULT_NONE};
  struct past past;
  if (!checkpoint_fetch(path, model, &summary, state, NULL, 0, message))
    return false;
  struct frames *frames = frames_open(path, &trouble, message);
  if (!frames)
    return false;
  look_back(&past, frames, model);
  *origin = (struct snapshot_origin){.has_stream = true, .stream = summary.head.stream.key, .step = state->step};
  const bool ok = same_dimensions(&past, summary.dimensions, model, path, message) &&
                  in_order(frames, model, path, message) &&
                  find_slide(&past, model, state->step, origin, path, message) &&
                  make_up_lag_of(&past, &summary, state, model, message) &&
                  end_drive_of(&past, &summary, state, model, path, message) &&
                  (bead_sound(state, model, &fault) || message_fault(message, &fault));
  forget(&past);
  frames_close(frames);
  return ok;
}

/* What the file says of its box: by its scene, else by its words, which know no images that slide. */
static bool same_boundary(const struct past *past, const struct frames_about *about, const struct model *m,
                          const char *path, struct message *message)
{
  struct message why;
  if (past->known)
    return !structure_walls_differ(model_has_walls(&past->scene.model), m, &why) ||
           message_set(message, "%s: %s", path, why.text);
  for (int k = 0; k < 3 && about->bounded; k++) {
    const bool walls = m->box.boundary[k] == BOUNDARY_WALL,
               any = k == 1 ? model_is_sheared(m) : k == 2 && m->dimensions == 2;
    if (!any && about->closed[k] != walls)
      return message_set(message, "%s: its box is %speriodic along %c; the scene%s along %c", path,
                         about->closed[k] ? "not " : "", "xyz"[k], walls ? " has walls" : "'s is periodic", "xyz"[k]);
  }
  return true;
}

static bool last_frame(struct trajectory *t, const char *path, const struct model *model, struct state *state,
                       struct message *message)
{
  if (trajectory_frames(t) == 0)
    return message_set(message, "%s: a trajectory without frames", path);
  if (!trajectory_has_velocities(t))
    return message_set(message, "%s: its frames hold no velocities; a start needs them", path);
  if (model_has_dumbbells(model))
    return message_set(message, "%s: its frames hold no springs of dumbbells; a start needs a checkpoint", path);
  if (model_has_bead(model))
    return message_set(message, "%s: its frames hold no bead; a start needs a checkpoint", path);
  if (model_has_solvent(model) && !trajectory_has_solvent(t, model))
    return message_set(message, "%s: its frames hold %u particles; a start needs %u vertices and %u solvent particles",
                       path, t->particles, model->vertices, model->solvent.particles);
  return in_order(t->frames_apart, model, path, message) &&
         trajectory_read(t, model, trajectory_frames(t) - 1, state, message);
}

/* Frames hold neither beads nor springs, and are none of a scene with them. */
static bool same_bodies(const struct past *past, const struct model *m, const char *path, struct message *message)
{
  const struct model *then = &past->scene.model;
  if (past->known && model_has_bead(then) && !model_has_bead(m))
    return message_set(message, "%s: it is of a solvent around a bead, the scene has none", path);
  return !past->known || !model_has_dumbbells(then) || model_has_dumbbells(m) ||
         message_set(message, "%s: it is of %u dumbbells, the scene has none", path, then->dumbbells.pairs);
}

static bool start_from_trajectory(const char *path, const struct model *model, struct state *state,
                                  struct snapshot_origin *origin, struct message *message)
{
  struct trajectory *t = trajectory_open_read(path, message);
  if (!t)
    return false;
  struct message ignored;
  struct past past;
  const struct frames_about *about = &t->frames_apart->about;
  const struct structure *s = &t->frames_apart->structure;
  look_back(&past, t->frames_apart, model);
  bool ok = same_dimensions(&past, 0, model, path, message) && same_bodies(&past, model, path, message) &&
            same_boundary(&past, about, model, path, message) && last_frame(t, path, model, state, message);
  *origin = (struct snapshot_origin){.has_stream = about->has_stream,
                                     .stream = about->stream,
                                     .step = state->step,
                                     .untold = model->bonds > 0 && !s->stored_bonds ? UNTOLD_BONDS : 0};
  ok = ok && find_slide(&past, model, state->step, origin, path, message);
  forget(&past);
  trajectory_close(t, &ignored);
  return ok;
}

bool snapshot_read_start(const char *path, const struct model *model, struct state *state,
                         struct snapshot_origin *origin, struct message *message)
{
  enum h5_sort sort;
  enum h5_trouble trouble;
  if (!h5_find_sort(path, &sort, &trouble, message))
    return false;
  if (sort != H5_CHECKPOINT && sort != H5_TRAJECTORY)
    return message_set(message, "%s: an HDF5 file, but neither a checkpoint nor an H5MD trajectory", path);
  if (!(sort == H5_CHECKPOINT ? start_from_checkpoint : start_from_trajectory)(path, model, state, origin, message))
    return false;
  state->step = 0;
  state->solvent_lag = 0;
  state->solvent_time = 0;
  begin_accounts(state);
  return true;
}
