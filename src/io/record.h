/* run.json: what a run was, how it went, and how it ended. */
#ifndef UNCROSS_RECORD_H
#define UNCROSS_RECORD_H

#include "io/message.h"
#include "io/scene.h"
#include "observe/observe.h"
#include "state/state.h"

struct record {
  const char *status;      /* "finished", "interrupted", "stopped", "running" */
  const char *reason;      /* why it stopped; NULL if it did not */
  double wall_seconds;     /* over all sessions */
  double steps_per_second; /* of this session, everything included */
  double start_energy;     /* kT */
  struct vec3 start_momentum;
};

/* Writes folder/run.json, aside first, then renamed. */
bool record_write(const char *folder, const struct scene *scene, const struct state *state, const struct record *record,
                  struct message *message);

#endif
