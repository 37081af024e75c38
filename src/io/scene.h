/* A scene: one commented YAML file that says everything about a run. docs/scene.md documents every key. */
#ifndef UNCROSS_SCENE_H
#define UNCROSS_SCENE_H

#include <stdbool.h>
#include <stdint.h>

#include <stdio.h>

#include "io/keys.h"
#include "io/message.h"
#include "observe/observe.h"
#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

struct scene {
  struct model model; /* finished (model_finish) */
  uint64_t steps;     /* wanted in all */
  char *snapshot; /* start from this file instead of each kind's `start`; NULL: none. As the scene says it: relative to
                     the scene file's folder (scene_snapshot_path). */
  struct observe_plan observe;
  uint64_t trajectory_every;  /* steps between frames; 0: no trajectory */
  bool trajectory_solvent;    /* frames hold the solvent too */
  bool trajectory_velocities; /* frames hold velocities */
  double checkpoint_seconds;  /* wall time between checkpoints; 0: only at the end and on signals */
  char *path;                 /* as given */
  char *text;                 /* the file, byte for byte, NUL-terminated */
  uint64_t fingerprint; /* XXH64 of all that decides the physics: what a resume must find unchanged. Not seed, steps,
                           cadences of output, checkpoints or comments. */
};

/* Reads, checks and finishes a scene. On failure returns false and leaves a message `file:line:col: what is wrong; what
 * is allowed`; the scene then needs no freeing. */
bool scene_read(const char *path, struct scene *scene, struct message *message);
void scene_free(struct scene *scene);

/* The same from text that is already at hand, e.g. stored in a trajectory; `path` serves messages only, and whether the
 * snapshot that the scene may name can be read is not looked at. */
bool scene_read_text(const char *path, const char *text, size_t size, struct scene *scene, struct message *message);

/* Where the snapshot file is, seen from the working folder: to be freed; NULL if the scene has none, or memory is
 * short. */
char *scene_snapshot_path(const struct scene *scene);

/* The state in which a run of the scene begins, drawn or its snapshot: a file whose bonds fit the box, and whose center
 * of mass moves with the scene's flow. state and work are allocated for scene->model. */
bool scene_start(const struct scene *scene, struct state *state, struct work *work, struct message *message);

/* Writes the effective scene, every default filled in, as YAML that reads back to the same scene. physics_only leaves
 * out seed, steps, observables, trajectory and checkpoints: the text whose hash is the fingerprint. */
void scene_write(const struct scene *scene, FILE *f, bool physics_only);

/* All tables of keys, the top level first: what docs/scene.md is held against. */
const struct key_table *const *scene_key_tables(size_t *count);

/* Prints to stdout: the effective scene, every derived number of the paper's Tables I and II, what this scene uses and
 * skips, memory, estimated time, warnings. `uncross check`. Errors of stability are found by scene_read already. */
void scene_report(const struct scene *scene);

/* Warnings where the paper's limits are left, one call of `tell` each; returns how many. */
int scene_warnings(const struct scene *scene, void (*tell)(void *context, const char *text), void *context);

#endif
