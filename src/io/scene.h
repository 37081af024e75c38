/* A scene: one commented YAML file that says everything about a run. docs/scene.md documents every key. */
#ifndef UNCROSS_SCENE_H
#define UNCROSS_SCENE_H

#include <stdbool.h>
#include <stdint.h>

#include "io/message.h"
#include "observe/observe.h"
#include "state/model.h"

struct scene {
  struct model model; /* finished (model_finish) */
  uint64_t steps;     /* wanted in all */
  char *snapshot;     /* start from this file instead of each kind's `start`; NULL: none. Relative to the scene file. */
  struct observe_plan observe;
  uint64_t trajectory_every;    /* steps between frames; 0: no trajectory */
  bool trajectory_solvent;      /* frames hold the solvent too */
  bool trajectory_velocities;   /* frames hold velocities */
  double checkpoint_seconds;    /* wall time between checkpoints; 0: only at the end and on signals */
  char *path;  /* as given */
  char *text;  /* the file, byte for byte, NUL-terminated */
  uint64_t fingerprint; /* XXH64 of all that decides the physics: what a resume must find unchanged. Not seed, steps,
                           cadences of output, checkpoints or comments. */
};

/* Reads, checks and finishes a scene. On failure returns false and leaves a message `file:line:col: what is wrong; what is
 * allowed`; the scene then needs no freeing. */
bool scene_read(const char *path, struct scene *scene, struct message *message);
void scene_free(struct scene *scene);

/* Prints to stdout: the effective scene, every derived number of the paper's Tables I and II, what this scene uses and
 * skips, memory, estimated time, warnings. `uncross check`. Errors of stability are found by scene_read already. */
void scene_report(const struct scene *scene);

/* Warnings where the paper's limits are left, one call of `tell` each; returns how many. */
int scene_warnings(const struct scene *scene, void (*tell)(void *context, const char *text), void *context);

#endif
