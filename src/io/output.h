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

/* Whether a table that the scene would make is in the folder already; the message is then its name. */
bool output_left(const struct scene *scene, const struct observers *observers, const char *folder,
                 struct message *name);

/* Whether tables and trajectory go as far as a checkpoint says, whose memory the observers have; frames_end: its
 * head's. Rows and frames that the folder has lost would be missing for good. Changes nothing. */
bool output_whole(const struct scene *scene, const struct observers *observers, const char *folder, uint64_t frames_end,
                  struct message *message);

/* Opens what the scene asks for. On a resume, which observers that remember their samples make of it, cuts everything
 * back to what it was at step `step`; the message is then a note for the user, or empty. frames_end: the checkpoint
 * head's. */
bool output_open(struct output *output, const struct scene *scene, const struct observers *observers,
                 const char *folder, bool resume, uint64_t frames_end, uint64_t step, struct message *message);

/* Writes what is due of this state: samples of observables, a frame. */
bool output_sample(struct output *output, struct observers *observers, const struct model *model,
                   const struct state *state, struct message *message);

/* Waits until everything written so far is on the disk: no checkpoint may know more than its tables. */
bool output_sync(struct output *output, struct message *message);

/* Writes the summaries as they stand now. */
bool output_summaries(struct output *output, const struct observers *observers, const struct model *model,
                      struct message *message);

bool output_close(struct output *output, struct message *message);

#endif
