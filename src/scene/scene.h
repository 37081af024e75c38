/* A scene: one commented YAML file that says everything about a run. docs/scene.md documents every key. */
#ifndef UNCROSS_SCENE_SCENE_H
#define UNCROSS_SCENE_SCENE_H

#include <stdbool.h>
#include <stdint.h>

#include <stdio.h>

#include "base/message.h"
#include "observe/observe.h"
#include "scene/tree.h"
#include "system/model.h"
#include "system/state.h"

/* start.stream: which random numbers a run from a snapshot draws. */
enum scene_stream { SCENE_STREAM_OWN, SCENE_STREAM_SEED };

struct scene {
  struct model model; /* finished (model_finish) */
  uint64_t steps;     /* length of the whole run */
  uint64_t seed;      /* as the scene says it; model.seed is the stream that the run makes of it (system/stream.h) */
  char *snapshot; /* start from this file instead of each kind's `start`; NULL: none. As the scene says it: relative to
                     the scene file's folder (scene_snapshot_path). */
  enum scene_stream stream;
  struct observe_plan observe;
  double observe_from_time;   /* t0; as the scene says it, observe.from is made of it; 0: not said */
  uint64_t trajectory_every;  /* steps between frames; 0: no trajectory */
  bool trajectory_solvent;    /* frames hold the solvent too */
  bool trajectory_velocities; /* frames hold velocities */
  double checkpoint_seconds;  /* wall time between checkpoints; 0: none but at step 0, on signals, at the end */
  char *path;                 /* as given */
  char *text; /* stored in files, NUL-terminated: the scene file, byte for byte; or the effective scene, if keys were
                 set from outside or have defaults of today. It reads back to the same fingerprint */
  struct tree tree;     /* the keys that were given, and where: for scene_refuse_at */
  uint64_t fingerprint; /* XXH64 of all keys that affect the physics; a resume needs the same one. Seed, steps, cadences
                           of output, checkpoints and comments have no part in it. */
};

/* Keys that are set on top of the file, by --set or the library: "solvent.per_cell=5", "fibers.0.count=10",
 * "fibers.rods.count=10". Values are YAML scalars or lists [a, b, c]; docs/scene.md. */
struct scene_settings {
  size_t count;
  const char *const *option; /* [count] */
  size_t once; /* the first so many were given together: a key that two of them name is refused. Later ones replace */
};

/* Reads, checks and finishes a scene. Missing keys take their defaults. settings may be NULL. On failure returns false
 * and leaves a message `file:line:col: what is wrong; what is allowed`, or `--set key=value: ...`; the scene then needs
 * no freeing. */
bool scene_read(const char *path, struct scene *scene, struct message *message);
bool scene_read_set(const char *path, const struct scene_settings *settings, struct scene *scene,
                    struct message *message);
void scene_free(struct scene *scene);

/* The same without the model's lists of fibers and vertices (model_finish_numbers): for estimates. */
bool scene_read_numbers(const char *path, const struct scene_settings *settings, struct scene *scene,
                        struct message *message);

/* The same for a run that is resumed; fingerprint: that of its checkpoint. Missing keys take the defaults of today. If
 * the fingerprint then differs, the scene is read again with the keys' `absent` values, because a default may have
 * changed since the run began. If the fingerprint still differs, the result is that of scene_read_set, and the caller
 * has to compare fingerprints. The snapshot with which the run began may be gone: the checkpoint has its state. */
bool scene_read_as(const char *path, const struct scene_settings *settings, uint64_t fingerprint, struct scene *scene,
                   struct message *message);

/* The same from text that a file has kept, e.g. a trajectory: missing keys mean what they have always meant (`absent`).
 * `path` serves messages only, and whether the snapshot that the scene may name can be read is not looked at. */
bool scene_read_text(const char *path, const char *text, size_t size, struct scene *scene, struct message *message);

/* The same with keys that are set on top of it. */
bool scene_read_text_set(const char *path, const char *text, size_t size, const struct scene_settings *settings,
                         struct scene *scene, struct message *message);

/* The same without the model's lists (model_finish_numbers): the file may claim any number of fibers. */
bool scene_read_text_numbers(const char *path, const char *text, size_t size, struct scene *scene,
                             struct message *message);

/* Leaves the message "place: key: ..." about a key. path: such as "flow", "fibers.0.mass". The place is that of the key
 * in the scene, or that of the section around it. Always returns false. */
bool scene_refuse_at(const struct scene *scene, const char *path, const char *key, struct message *message,
                     const char *format, ...) __attribute__((format(printf, 5, 6)));

/* True if the scene's file, or a setting, gives the key of this path. */
bool scene_says(const struct scene *scene, const char *path);

/* Whether the snapshot of the scene, if it has one, can be read; else a message at its key. */
bool scene_finds_snapshot(const struct scene *scene, struct message *message);

/* Where the snapshot file is, seen from the working folder: to be freed; NULL if the scene has none, or memory is
 * short. */
char *scene_snapshot_path(const struct scene *scene);

/* Writes the effective scene, every default filled in, as YAML that reads back to the same scene. physics_only leaves
 * out seed, steps, observables, trajectory and checkpoints: the text whose hash is the fingerprint. False if memory is
 * short. */
bool scene_write(const struct scene *scene, FILE *f, bool physics_only);

/* Writes the JSON schema (draft 2020-12) of a scene: types, ranges, defaults and meanings of all keys. What keys must
 * be together is not in it. */
void scene_schema(FILE *f);

/* Writes the tables of docs/scene.md and of docs/observables.md, each between the comments that tools/document-keys
 * looks for. */
void scene_document(FILE *f);

/* Calls `tell` once for each of the paper's limits that the scene exceeds; returns the number of calls. */
int scene_warnings(const struct scene *scene, void (*tell)(void *context, const char *text), void *context);

#endif
