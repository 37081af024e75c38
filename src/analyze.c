/* `uncross analyze`: the observables of a scene, from the frames of a trajectory. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/folder.h"
#include "io/output.h"
#include "io/scene.h"
#include "io/snapshot.h"
#include "run.h"

static uint64_t least_common_multiple(uint64_t a, uint64_t b)
{
  uint64_t x = a, y = b;
  while (y != 0) {
    uint64_t rest = x % y;
    x = y;
    y = rest;
  }
  return a / x * b;
}

/* What the frames can show of what the scene asked for: only steps that were stored, energies and temperatures only if
 * solvent and velocities were, and no counts of crossings, which are not in frames. */
static void fit_plan(struct scene *scene, const struct trajectory *frames)
{
  const bool everything = trajectory_has_velocities(frames) && trajectory_has_solvent(frames, &scene->model);
  const bool possible[OBSERVABLES] = {[OBSERVE_CONSERVED] = everything,
                                      [OBSERVE_TEMPERATURE] = everything,
                                      [OBSERVE_STATICS] = true,
                                      [OBSERVE_DYNAMICS] = true,
                                      [OBSERVE_COLLISIONS] = false};
  for (int k = 0; k < OBSERVABLES; k++) {
    uint64_t *every = &scene->observe.every[k];
    if (*every > 0 && !possible[k])
      fprintf(stderr, "uncross: %s: cannot be had from this trajectory, left out\n", observable_names[k]);
    *every = *every > 0 && possible[k] ? least_common_multiple(*every, scene->trajectory_every) : 0;
  }
}

/* Each frame, given to nobody: so that a frame that cannot be used is met before anything is written. */
static bool check_frames(const struct scene *scene, struct trajectory *frames, struct state *state,
                         struct message *message)
{
  bool ok = true;
  for (uint64_t k = 0; ok && k < trajectory_frames(frames); k++)
    ok = trajectory_read(frames, &scene->model, k, state, message);
  return ok;
}

static bool sample_frames(const struct scene *scene, struct trajectory *frames, const char *folder, struct state *state,
                          struct observers *observers, struct message *message)
{
  struct output output;
  bool ok = output_open(&output, scene, observers, folder, false, 0, 0, message);
  for (uint64_t k = 0; ok && k < trajectory_frames(frames); k++)
    ok = trajectory_read(frames, &scene->model, k, state, message) &&
         output_sample(&output, observers, &scene->model, state, message);
  ok = ok && output_summaries(&output, observers, &scene->model, message);
  return output_close(&output, message) && ok;
}

/* Into a folder that is made, that nobody else writes to, and that holds none of the tables. */
static enum exit_code write_tables(const struct scene *scene, struct trajectory *frames, const char *folder,
                                   struct state *state, struct observers *observers, struct message *message)
{
  struct message name;
  enum exit_code code = EXIT_BAD_INPUT;
  const enum folder_trouble trouble = folder_prepare(folder, message);
  if (trouble != FOLDER_FINE)
    return trouble == FOLDER_IS_NONE ? EXIT_BAD_INPUT : EXIT_NOT_WRITTEN;
  const int lock = folder_lock(folder, message);
  if (lock < 0)
    return EXIT_NOT_WRITTEN;
  if (output_left(scene, observers, folder, &name))
    message_set(message, "%s/%s: is there already, and nothing is written over; name another folder", folder,
                name.text);
  else
    code = sample_frames(scene, frames, folder, state, observers, message) ? EXIT_DONE : EXIT_NOT_WRITTEN;
  close(lock);
  return code;
}

static enum exit_code analyze(struct scene *scene, struct trajectory *frames, const char *folder,
                              struct message *message)
{
  struct state state;
  fit_plan(scene, frames);
  scene->trajectory_every = 0; /* tables only */
  struct observers *observers = observers_create(&scene->observe, &scene->model);
  enum exit_code code = EXIT_TROUBLE;
  message_set(message, "no memory for this trajectory");
  if (observers && state_alloc(&state, &scene->model)) {
    code = check_frames(scene, frames, &state, message)
               ? write_tables(scene, frames, folder, &state, observers, message)
               : EXIT_BAD_INPUT;
    state_free(&state);
  }
  observers_free(observers);
  return code;
}

enum exit_code run_analyze(const char *path, const char *folder)
{
  struct message message;
  struct scene scene;
  enum exit_code code = EXIT_BAD_INPUT;
  struct trajectory *frames = trajectory_open_read(path, &message);
  char *text = frames ? trajectory_scene_text(frames) : NULL;
  bool ours = text && trajectory_has_steps(frames);
  if (frames && !ours)
    message_set(&message, "%s: holds no scene or no steps; only trajectories that uncross wrote can be analyzed", path);
  if (ours && scene_read_text(path, text, strlen(text), &scene, &message)) {
    code = analyze(&scene, frames, folder, &message);
    scene_free(&scene);
  }
  free(text);
  if (frames) {
    struct message ignored;
    trajectory_close(frames, &ignored);
  }
  if (code != EXIT_DONE)
    fprintf(stderr, "uncross: %s\n", message.text);
  return code;
}
