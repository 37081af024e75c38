#include "files/same_run.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "files/structure.h"
#include "scene/differ.h"

/* Why the scenes of a run and of its resume are not the same: the key, if it can be found. */
static void tell_other_scene(const struct scene *scene, const struct scene *then, const char *path,
                             struct message *message)
{
  struct scene_difference d;
  char key[384] = "";
  if (then && scene_differs(scene, then, &d))
    snprintf(key, sizeof key, ": %s is %s there, %s in the run so far", d.key, d.value, d.other);
  message_set(message,
              "%s: is of another scene than %s%s; a resumed run keeps the scene of the run (it is kept in run.json)",
              path, scene->path, key);
}

/* Fingerprint and seed must be those of the checkpoint. A scene may say the seed that the run's own scene says,
 * although the run was begun with another one (--seed). seed: set from outside, or NULL. */
bool same_run(const struct scene *scene, const struct checkpoint_head *head, const struct scene *then,
              const uint64_t *seed, const char *path, struct message *message)
{
  if (head->fingerprint != scene->fingerprint) {
    tell_other_scene(scene, then, path, message);
    return false;
  }
  const bool same = seed ? *seed == head->seed : scene->seed == head->seed || !then || scene->seed == then->seed;
  return same ||
         message_set(message, "%s: was run with seed %" PRIu64 "; a resumed run keeps its seed", path, head->seed);
}

enum same_run same_run_as_begun(const struct scene *scene, const char *path, const uint64_t *seed,
                                struct message *message)
{
  enum h5_trouble trouble;
  struct message ignored;
  struct scene then;
  struct frames *f = frames_open(path, &trouble, message);
  if (!f)
    return SAME_RUN_UNKNOWN;
  errno = 0;
  const bool known =
      f->about.checkpoint && f->scene && scene_read_text_numbers(path, f->scene, strlen(f->scene), &then, &ignored);
  enum same_run same = SAME_RUN_UNKNOWN;
  if (!known && errno == ENOMEM)
    message_no_memory(message, "%s: no memory to compare its scene", path);
  else if (!f->about.checkpoint)
    message_set(message, "%s: not a checkpoint", path);
  else
    same = same_run(scene, &f->about.summary.head, known ? &then : NULL, seed, path, message) ? SAME_RUN : OTHER_RUN;
  if (known)
    scene_free(&then);
  frames_close(f);
  return same;
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

#define OTHERWISE "put the run's own file back, or move this one away"

/* A scene that cannot be read tells nothing. */
static bool same_scene(const struct frames *frames, uint64_t fingerprint, struct message *message)
{
  struct scene then;
  struct message ignored;
  if (fingerprint == 0 || !frames->scene)
    return true;
  errno = 0;
  if (!scene_read_text_numbers(frames->path, frames->scene, strlen(frames->scene), &then, &ignored))
    return errno != ENOMEM || message_no_memory(message, "%s: no memory to compare its scene", frames->path);
  const uint64_t its = then.fingerprint;
  scene_free(&then);
  return its == fingerprint ||
         message_set(message,
                     "%s: is of another run: its scene is another one, of the fingerprint %016" PRIx64
                     ", the run's %016" PRIx64 "; " OTHERWISE,
                     frames->path, its, fingerprint);
}

bool same_run_frames(const struct frames *frames, const struct model *model, const struct trajectory_options *options,
                     struct message *message)
{
  const struct frames_about *about = &frames->about;
  const struct {
    const char *name;
    uint64_t its, ours;
  } number[] = {{"seed", about->seed, options->seed},
                {"stream", about->stream, options->stream},
                {"slide", about->slide, model->shear.slid}};
  struct message why;
  if (!about->has_stream)
    return message_set(message, "%s: is of another run: not one of this program; " OTHERWISE, frames->path);
  for (size_t k = 0; k < sizeof number / sizeof *number; k++)
    if (number[k].its != number[k].ours)
      return message_set(message, "%s: is of another run: its %s is %" PRIu64 ", the run's is %" PRIu64 "; " OTHERWISE,
                         frames->path, number[k].name, number[k].its, number[k].ours);
  if (!same_scene(frames, options->fingerprint, message))
    return false;
  return !structure_differs(&frames->structure, model, &why) ||
         message_set(message, "%s: is of another run: %s; " OTHERWISE, frames->path, why.text);
}

bool same_run_trajectory(const char *path, const struct model *model, const struct trajectory_options *options,
                         struct message *message)
{
  enum h5_trouble trouble;
  struct message ignored;
  struct frames *frames = frames_open(path, &trouble, &ignored);
  const bool same = !frames || same_run_frames(frames, model, options, message);
  frames_close(frames);
  return same;
}
