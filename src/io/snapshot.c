/* States that scenes start from: checkpoints, and last frames of trajectories. */
#include "io/snapshot.h"

#include "io/checkpoint.h"
#include "io/structure.h"
#include "io/trajectory.h"

/* Streams the solvent to where it is now. */
static void make_up_lag(struct state *state, const struct model *model)
{
  struct solvent *p = &state->solvent;
  for (uint32_t i = 0; state->solvent_lag > 0 && i < p->n; i++) {
    const struct point r = state_solvent_position(state, model, i);
    const struct vec3 v = state_solvent_velocity(state, model, i);
    p->x[i] = r.x, p->y[i] = r.y, p->z[i] = r.z;
    p->vx[i] = v.x, p->vy[i] = v.y, p->vz[i] = v.z;
  }
}

static bool start_from_checkpoint(const char *path, const struct model *model, struct state *state,
                                  struct message *message)
{
  struct checkpoint_summary summary;
  hid_t file = checkpoint_open_for(path, model, &summary, state, message);
  if (file < 0)
    return false;
  h5_close(file);
  /* The lag is time that passed under the checkpoint's own time step and body force. */
  struct model then = *model;
  then.time_step = summary.time_step;
  then.solvent.acceleration = summary.acceleration;
  make_up_lag(state, &then);
  return true;
}

/* Rows must be in the scene's order: vertices fiber by fiber, then solvent. */
static bool in_order(const struct trajectory *t, const struct model *model, const char *path, struct message *message)
{
  bool same = true;
  hid_t connectivity = h5_open_group(t->file, "connectivity");
  if (connectivity >= 0 && h5_has(connectivity, "bonds"))
    same = structure_same_bonds(connectivity, model);
  h5_close(connectivity);
  return same || message_set(message, "%s: its bonds are not the scene's", path);
}

static bool last_frame(struct trajectory *t, const char *path, const struct model *model, struct state *state,
                       struct message *message)
{
  if (trajectory_frames(t) == 0)
    return message_set(message, "%s: a trajectory without frames", path);
  if (!trajectory_has_velocities(t))
    return message_set(message, "%s: its frames hold no velocities; a start needs them", path);
  if (model_has_solvent(model) && !trajectory_has_solvent(t, model))
    return message_set(message, "%s: its frames hold %u particles; a start needs %u vertices and %u solvent particles",
                       path, t->particles, model->vertices, model->solvent.particles);
  return in_order(t, model, path, message) && trajectory_read(t, model, trajectory_frames(t) - 1, state, message);
}

static bool start_from_trajectory(const char *path, const struct model *model, struct state *state,
                                  struct message *message)
{
  struct trajectory *t = trajectory_open_read(path, message);
  if (!t)
    return false;
  struct message ignored;
  bool ok = last_frame(t, path, model, state, message);
  trajectory_close(t, &ignored);
  return ok;
}

bool snapshot_read_start(const char *path, const struct model *model, struct state *state, struct message *message)
{
  enum h5_trouble trouble;
  hid_t file = h5_open(path, false, &trouble, message);
  if (file < 0)
    return false;
  bool checkpoint = checkpoint_is(file), trajectory = h5_has(file, "particles");
  h5_close(file);
  if (!checkpoint && !trajectory)
    return message_set(message, "%s: an HDF5 file, but neither a checkpoint nor an H5MD trajectory", path);
  if (!(checkpoint ? start_from_checkpoint : start_from_trajectory)(path, model, state, message))
    return false;
  state->step = 0;
  state->solvent_lag = 0;
  state->counts = (struct collision_counts){0};
  return true;
}
