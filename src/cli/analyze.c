/* `uncross analyze`: the observables of a scene, from the frames of a trajectory. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cli/command.h"
#include "files/folder.h"
#include "files/output.h"
#include "files/snapshot.h"
#include "observe/meaning.h"
#include "scene/scene.h"

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
 * all that moves was stored, with its velocities, and neither counts of crossings nor stresses nor springs of
 * dumbbells, which are not in frames. */
static void fit_plan(struct scene *scene, const struct trajectory *frames)
{
  const struct model *m = &scene->model;
  const bool still = !model_is_overdamped(m) && !trajectory_has_velocities(frames);
  const char *const all = still ? "velocities are not in the frames"
                          : model_has_solvent(m) && !trajectory_has_solvent(frames, m)
                              ? "the solvent is not in the frames"
                          : model_has_bead(m) ? "the bead is not in the frames"
                                              : NULL;
  const char *const springs = "springs of dumbbells are not in the frames";
  const char *const missing[OBSERVABLES] = {/* NULL: nothing */
                                            [OBSERVE_CONSERVED] = model_has_dumbbells(&scene->model) ? springs : all,
                                            [OBSERVE_TEMPERATURE] = all,
                                            [OBSERVE_COLLISIONS] = "counts of crossings are not in the frames",
                                            [OBSERVE_PROFILE] = all,
                                            [OBSERVE_STRESS] = "flights and contacts are not in the frames",
                                            [OBSERVE_DUMBBELLS] = springs,
                                            [OBSERVE_BEAD] = "the bead is not in the frames",
                                            [OBSERVE_MEMORY] = "collisions are not in the frames",
                                            [OBSERVE_PRESSURE] = "forces and contacts are not in the frames",
                                            [OBSERVE_WAKE] = "the bead is not in the frames"};
  _Static_assert(OBSERVABLES == OBSERVE_TOPOLOGY + 1, "what frames lack of a new observable");
  for (int k = 0; k < OBSERVABLES; k++) {
    uint64_t *every = &scene->observe.every[k];
    const char *refused = meaning_refusal(&scene->model, (enum observable)k), *why = missing[k] ? missing[k] : refused;
    if (*every > 0 && why)
      fprintf(stderr, "uncross: %s: left out: %s\n", observable_names[k], why);
    *every = *every > 0 && !why ? least_common_multiple(*every, scene->trajectory_every) : 0;
  }
}

/* A frame into the state; false, with a message, if it cannot be. `skip`: it is damaged, and may be left out. */
static bool read_frame(struct trajectory *frames, const struct model *model, uint64_t frame, bool may_skip,
                       struct state *state, bool *skip, struct message *message)
{
  const bool ok = trajectory_read(frames, model, frame, state, message);
  *skip = !ok && may_skip && trajectory_damaged(frames);
  return ok || *skip;
}

/* Reads each frame once and discards it, so that an unusable frame is found before anything is written. Names those
 * that are left out. */
static bool check_frames(const struct scene *scene, struct trajectory *frames, bool may_skip, struct state *state,
                         uint64_t *skipped, struct message *message)
{
  bool ok = true, skip;
  uint64_t next = 0; /* 1 + the step of the last frame */
  *skipped = 0;
  for (uint64_t k = 0; ok && k < trajectory_frames(frames); k++) {
    ok = read_frame(frames, &scene->model, k, may_skip, state, &skip, message);
    if (ok && !skip && state->step < next)
      ok = message_set(message,
                       "%s: frame %" PRIu64 ": its step %" PRIu64 " does not come after %" PRIu64
                       ", the step of the frame before",
                       scene->path, k, state->step, next - 1);
    next = ok && !skip ? state->step + 1 : next;
    if (ok && skip)
      fprintf(stderr, "uncross: left out: %s\n", message->text);
    *skipped += ok && skip;
  }
  return ok;
}

static bool sample_frames(const struct scene *scene, struct trajectory *frames, bool may_skip,
                          const struct folder *folder, struct state *state, struct observers *observers,
                          struct message *message)
{
  struct output output;
  bool ok = output_open(&output, scene, observers, folder, false, 0, 0, message), skip;
  for (uint64_t k = 0; ok && k < trajectory_frames(frames); k++)
    ok = read_frame(frames, &scene->model, k, may_skip, state, &skip, message) &&
         (skip || output_sample(&output, observers, &scene->model, state, message));
  ok = ok && output_summaries(&output, observers, &scene->model, message);
  return output_close(&output, message) && ok;
}

/* Prepares the folder: makes and locks it, and checks that it holds none of the tables. */
static enum exit_code write_tables(const struct scene *scene, struct trajectory *frames, bool may_skip,
                                   const char *path, struct state *state, struct observers *observers,
                                   struct message *message)
{
  struct folder folder = {path, FOLDER_BY_NAME};
  struct message name;
  size_t made;
  enum exit_code code = EXIT_BAD_INPUT;
  const enum folder_trouble trouble = folder_prepare(path, &made, message);
  if (trouble != FOLDER_FINE)
    return trouble == FOLDER_IS_NONE ? EXIT_BAD_INPUT : EXIT_NOT_WRITTEN;
  if (!folder_lock(&folder, message))
    return EXIT_NOT_WRITTEN;
  if (message->text[0] != '\0')
    fprintf(stderr, "uncross: %s\n", message->text);
  if (output_left(scene, observers, &folder, &name))
    message_set(message, "%s/%s: is there already, and nothing is written over; name another folder", path, name.text);
  else
    code = sample_frames(scene, frames, may_skip, &folder, state, observers, message) ? EXIT_DONE : EXIT_NOT_WRITTEN;
  folder_close(&folder);
  return code;
}

/* Dynamics count lags in frames: none may be missing in between. */
static void drop_dynamics(struct scene *scene, uint64_t skipped)
{
  uint64_t *every = &scene->observe.every[OBSERVE_DYNAMICS];
  if (skipped > 0 && *every > 0) {
    fprintf(stderr, "uncross: %s: cannot be had with frames left out\n", observable_names[OBSERVE_DYNAMICS]);
    *every = 0;
  }
}

static enum exit_code observe(struct scene *scene, struct trajectory *frames, bool may_skip, const char *folder,
                              struct state *state, struct message *message)
{
  struct observers *observers = observers_create(&scene->observe, &scene->model);
  if (!observers) {
    message_set(message, "no memory for this trajectory");
    return EXIT_TROUBLE;
  }
  const enum exit_code code = write_tables(scene, frames, may_skip, folder, state, observers, message);
  observers_free(observers);
  return code;
}

static enum exit_code analyze(struct scene *scene, struct trajectory *frames, bool may_skip, const char *folder,
                              struct message *message)
{
  struct state state;
  uint64_t skipped;
  enum exit_code code = EXIT_BAD_INPUT;
  fit_plan(scene, frames);
  scene->trajectory_every = 0; /* tables only */
  if (!state_alloc(&state, &scene->model)) {
    message_set(message, "no memory for this trajectory");
    return EXIT_TROUBLE;
  }
  if (check_frames(scene, frames, may_skip, &state, &skipped, message)) {
    drop_dynamics(scene, skipped);
    code = observe(scene, frames, may_skip, folder, &state, message);
  }
  state_free(&state);
  return code;
}

/* The physics is the run's; what is observed may be set. */
static bool sets_observables(const struct arguments *a, struct message *message)
{
  for (size_t k = 0; k < a->sets; k++)
    if (strncmp(a->set[k], "observe.", strlen("observe.")) != 0)
      return message_set(message,
                         "--set %s: the run has been made; allowed: keys of observe, such as observe.dynamics.every=10",
                         text_shown(a->set[k]));
  return true;
}

enum exit_code command_analyze(const struct arguments *a)
{
  const char *path = a->file[0], *folder = a->out;
  struct message message;
  struct scene scene;
  enum exit_code code = EXIT_BAD_INPUT;
  struct trajectory *frames = trajectory_open_read(path, &message);
  char *text = frames ? trajectory_scene_text(frames) : NULL;
  bool ours = text && trajectory_has_steps(frames);
  if (frames && !ours)
    message_set(&message, "%s: holds no scene or no steps; only trajectories that uncross wrote can be analyzed", path);
  const struct scene_settings settings = {a->sets, a->set, a->sets};
  if (ours && sets_observables(a, &message) &&
      scene_read_text_set(path, text, strlen(text), &settings, &scene, &message)) {
    code = analyze(&scene, frames, a->skip_damaged, folder, &message);
    scene_free(&scene);
  }
  free(text);
  if (frames) {
    struct message ignored;
    trajectory_close(frames, &ignored);
  }
  if (code != EXIT_DONE)
    fprintf(stderr, "uncross: %s\n", message.text);
  return code == EXIT_BAD_INPUT && message.kind == MESSAGE_NO_MEMORY ? EXIT_TROUBLE : code;
}
