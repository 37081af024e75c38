/*
 * A run in a folder: all that `uncross run` does, except printing. The folder is locked, and nothing in it is
 * overwritten. The run writes tables, trajectory, checkpoints and run.json. Functions here do not print, end the
 * process or handle signals.
 */
#ifndef UNCROSS_FILES_RUN_H
#define UNCROSS_FILES_RUN_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#include "base/message.h"
#include "files/folder.h"
#include "files/output.h"
#include "files/record.h"
#include "files/snapshot.h"
#include "scene/scene.h"
#include "step.h"

/* How a function of this room, or of the library, ended. The numbers are exit codes of the program. */
enum run_code {
  RUN_FINE = 0,
  RUN_NO_MEMORY = 1,
  RUN_BAD_INPUT = 2,  /* scene, checkpoint, folder: nothing was written */
  RUN_STOPPED = 3,    /* the physics cannot go on: work->fault */
  RUN_NOT_WRITTEN = 4 /* a file or the folder cannot be written, or another process has the folder */
};

/* The objects that a run works on. The caller allocates all of them for the scene, and frees them after run_release. */
struct run_parts {
  struct scene *scene; /* a resumed run sets its seed */
  struct state *state;
  struct work *work;
  struct observers *observers;
};

struct run {
  struct run_parts parts;
  pid_t owner;          /* the process that opened it */
  char *name;           /* of the folder */
  struct folder folder; /* locked while the run writes */
  size_t made;          /* for folder_unmake */
  bool resume;
  bool writing; /* files are open */
  bool opened;  /* all of them were */
  bool over;    /* it failed, or was closed */
  struct output output;
  struct checkpoint_head head;
  struct record record;   /* as in run.json, or as it would be there */
  char reason[1024];      /* why it stopped */
  char unlocked[1024];    /* why the folder has no lock; "" if it has one */
  uint64_t first_step;    /* of this session */
  double session_started; /* clock_seconds, of all the following */
  double loop_started, last_checkpoint;
  bool first_interval;    /* no checkpoint was due in this session yet */
  double earlier_seconds; /* spent in earlier sessions */
};

/* False in a process that forked off since the run was opened, and has a copy of it. No other function may be called
 * there, as all files are the owner's, which goes on with them. */
bool run_is_ours(const struct run *run);

/* Makes the starting state of the scene, and the head of the checkpoints of a run that begins with it. */
enum run_code run_begin(const struct run_parts *parts, struct checkpoint_head *head, struct message *message);

/* Reads the state and the observers' memory from a checkpoint of the same scene. The scene gets the checkpoint's seed.
 * seed: the seed that it must be, or NULL. */
enum run_code run_continue(const struct run_parts *parts, const char *path, const uint64_t *seed,
                           struct checkpoint_head *head, struct message *message);

/* Locks the folder, begins or resumes the run, and writes the output of the first step; a new run, its first checkpoint
 * too. After a success the message is a note for the user, or empty. A run that is already past its scene's steps opens
 * no file. After a failure nothing needs to be released, and of a new run no file is left, nor a folder that it made.
 */
enum run_code run_open(struct run *run, const struct run_parts *parts, const char *folder, bool resume,
                       const uint64_t *seed, struct message *message);

/* Makes at most `steps` steps, up to the scene's steps. keep_on: called after each step, the run pauses if it returns
 * false; it may save and close the run, which ends there; NULL: not called. */
enum run_code run_advance(struct run *run, uint64_t steps, bool (*keep_on)(void *context), void *context,
                          struct message *message);

/* Writes tables, checkpoint and run.json at the present step. */
enum run_code run_save(struct run *run, struct message *message);

/* Saves for the last time, closes all files, and unlocks the folder. A failed run is closed without saving. After a
 * success the message is a note for the user, or empty. */
enum run_code run_close(struct run *run, struct message *message);

/* Closes open files without saving, unlocks the folder, and frees the memory of the run except its parts. */
void run_release(struct run *run);

#endif
