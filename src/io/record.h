/* run.json: what a run was, how it went, and how it ended. */
#ifndef UNCROSS_RECORD_H
#define UNCROSS_RECORD_H

#include "io/message.h"
#include "io/scene.h"
#include "observe/observe.h"
#include "state/state.h"

struct record {
  const char *status; /* "finished", "interrupted", "stopped", "running" */
  const char *reason; /* why it stopped; NULL if it did not */
  uint64_t step;      /* of the last checkpoint, as what follows */
  struct collision_counts counts;
  double wall_seconds;     /* over all sessions */
  double steps_per_second; /* of this session, everything included */
  double start_energy;     /* kT */
  struct vec3 start_momentum;
  struct conserved now;
  uint64_t state_hash;
};

/* Writes folder/run.json, in place of an earlier one. */
bool record_write(const char *folder, const struct scene *scene, const struct record *record, struct message *message);

#endif
