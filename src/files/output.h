/* The files that grow in a run's folder: trajectory.h5, and tables of observables. */
#ifndef UNCROSS_FILES_OUTPUT_H
#define UNCROSS_FILES_OUTPUT_H

#include "base/message.h"
#include "files/folder.h"
#include "files/snapshot.h"
#include "files/table.h"
#include "observe/observe.h"
#include "scene/scene.h"
#include "system/state.h"

struct output {
  const struct folder *folder;
  uint64_t trajectory_every;
  struct trajectory *trajectory;     /* NULL: none asked for */
  struct series series[OBSERVABLES]; /* not open where not asked for, or not a series */
};

/* True if a table that the scene would make is in the folder already; the message is then its name. */
bool output_left(const struct scene *scene, const struct observers *observers, const struct folder *folder,
                 struct message *name);

/* Names all files that output_open and output_summaries make for the scene; observers NULL: without the summaries. */
void output_files(const struct scene *scene, const struct observers *observers,
                  void (*take)(void *context, const char *file), void *context);

/* Removes them. */
void output_remove(const struct scene *scene, const struct observers *observers, const struct folder *folder);

/* True if there is no trajectory, or it is of the run of this scene, whose seed and stream are those of the run: as far
 * as it can be read. Else with a message. */
bool output_is_of_run(const struct scene *scene, const struct folder *folder, struct message *message);

/* True if the trajectory is of this run, and tables and trajectory reach as far as the checkpoint from which the
 * observers were filled; frames_end: from its head. Otherwise rows or frames would be missing for good. Changes
 * nothing. */
bool output_whole(const struct scene *scene, const struct observers *observers, const struct folder *folder,
                  uint64_t frames_end, struct message *message);

/* Opens the files that the scene asks for. On a resume the observers hold the samples of the checkpoint, and all files
 * are cut back to step `step`; the message is then a note for the user, or empty. frames_end: from the checkpoint's
 * head. */
bool output_open(struct output *output, const struct scene *scene, const struct observers *observers,
                 const struct folder *folder, bool resume, uint64_t frames_end, uint64_t step, struct message *message);

/* Writes the samples of observables and the frame that are due at this step. */
bool output_sample(struct output *output, struct observers *observers, const struct model *model,
                   const struct state *state, struct message *message);

/* Waits until everything written so far is on the disk: tables must reach at least as far as the next checkpoint.
 * False, with a message, if that fails, or if a file was deleted or replaced in the folder. */
bool output_sync(struct output *output, struct message *message);

/* Writes the summaries as they stand now. */
bool output_summaries(struct output *output, const struct observers *observers, const struct model *model,
                      struct message *message);

bool output_close(struct output *output, struct message *message);

#endif
