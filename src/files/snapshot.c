/* States that scenes start from: checkpoints, and last frames of trajectories. */
#include "files/snapshot.h"
#include "fluid/fluid.h"
#include "system/bead.h"

#include "files/checkpoint.h"
#include "files/frames.h"
#include "files/structure.h"
#include "files/trajectory.h"

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

static bool start_from_checkpoint(const char *path, const struct model *model, struct state *state,
                                  struct snapshot_origin *origin, struct message *message)
{
  struct checkpoint_summary summary;
  enum h5_trouble trouble;
  if (!checkpoint_fetch(path, model, &summary, state, NULL, 0, message))
    return false;
  struct frames *frames = frames_open(path, &trouble, message);
  const bool same = frames && in_order(frames, model, path, message);
  frames_close(frames);
  if (!same)
    return false;
  *origin = (struct snapshot_origin){true, summary.head.stream.key, state->step};
  /* The lag is time that passed under the checkpoint's own time step and body force. */
  struct model then = *model;
  then.time_step = summary.time_step;
  then.solvent.acceleration = summary.acceleration;
  struct fault fault = {.code = FAULT_NONE};
  return make_up_lag(state, &then, message) &&
         (bead_sound(state, model, &fault) || (message_fault(message, &fault), false));
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

static bool start_from_trajectory(const char *path, const struct model *model, struct state *state,
                                  struct snapshot_origin *origin, struct message *message)
{
  struct trajectory *t = trajectory_open_read(path, message);
  if (!t)
    return false;
  struct message ignored;
  const struct frames_about *about = &t->frames_apart->about;
  bool ok = last_frame(t, path, model, state, message);
  *origin = (struct snapshot_origin){about->has_stream, about->stream, state->step};
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
  state->counts = (struct collision_counts){0};
  return true;
}
