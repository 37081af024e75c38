/* run.json: identity, progress and end of a run. */
#ifndef UNCROSS_FILES_RECORD_H
#define UNCROSS_FILES_RECORD_H

#include <jansson.h>

#include "base/message.h"
#include "files/folder.h"
#include "observe/observe.h"
#include "scene/scene.h"
#include "system/state.h"
#include "system/stream.h"

struct record {
  const char *status; /* "finished", "interrupted", "stopped", "running" */
  const char *reason; /* why it stopped; NULL if it did not */
  struct stream stream;
  uint64_t step; /* of the last checkpoint, as what follows */
  struct collision_counts counts;
  double wall_seconds;     /* over all sessions */
  double steps_per_second; /* of this session, everything included */
  double start_energy;     /* kT */
  struct vec3 start_momentum;
  struct conserved now;
  uint64_t state_hash, state_digest;
};

/* Writes run.json in the folder, in place of an earlier one. */
bool record_write(const struct folder *folder, const struct scene *scene, const struct record *record,
                  struct message *message);

#define RECORD_MOST_BYTES (16 << 20)

/* Any JSON of a file; NULL, with a message, if it is none, cannot be read, or is larger than a record can be. */
json_t *record_read(const char *path, struct message *message);

#endif
