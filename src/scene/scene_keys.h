/* The keys of a scene: those of its model, and those of its run. */
#ifndef UNCROSS_SCENE_SCENE_KEYS_H
#define UNCROSS_SCENE_SCENE_KEYS_H

#include "scene/read.h"
#include "scene/scene.h"
#include "system/keys.h"

/* The top level, of a struct scene. */
extern const struct key_table scene_keys;

/* The source of a scene, and how it is read. */
struct scene_source {
  const struct key_table *keys; /* scene_keys, or in tests a table that includes it */
  const char *path;             /* for messages, and where a snapshot is looked for */
  const char *text;             /* NULL: nothing but settings */
  size_t size;
  const struct scene_settings *settings; /* NULL: none */
  enum key_missing missing;
  const uint64_t *fingerprint; /* NULL: any; as in scene_read_as */
  bool look_for_files;         /* whether the snapshot can be read */
  const uint64_t *steps;       /* instead of the scene's; NULL: none */
  bool open_end;               /* other steps may follow: observe.from is not held against them */
  bool kept;                   /* a file has kept it: its observables are not held against it */
  bool numbers_only;           /* no lists of fibers and vertices: model_finish_numbers */
  struct message *message;
};

/* All functions that read a scene call this one. */
bool scene_read_source(const struct scene_source *source, struct scene *scene);

#endif
