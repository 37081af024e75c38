/* What a run's folder fills with while it runs: trajectory.h5, and tables of its observables. */
#ifndef UNCROSS_OUTPUT_H
#define UNCROSS_OUTPUT_H

#include "io/message.h"
#include "io/scene.h"
#include "io/snapshot.h"
#include "io/table.h"
#include "observe/observe.h"
#include "state/state.h"

struct output {
  const char *folder;
  uint64_t trajectory_every;
  struct trajectory *trajectory;     /* NULL: none asked for */
  struct series series[OBSERVABLES]; /* not open where not asked for, or not a series */
};

/* Opens what the scene asks for; on a resume, cuts everything back to what it was at step `step`. */
bool output_open(struct output *output, const struct scene *scene, const char *folder, bool resume, uint64_t step,
                 struct message *message);

/* Writes what is due of this state: samples of observables, a frame. */
bool output_sample(struct output *output, struct observers *observers, const struct model *model,
                   const struct state *state, struct message *message);

/* Everything written so far is in the hands of the operating system. */
bool output_flush(struct output *output, struct message *message);

/* Writes the summaries as they stand now. */
bool output_summaries(struct output *output, const struct observers *observers, const struct model *model,
                      struct message *message);

bool output_close(struct output *output, struct message *message);

#endif
