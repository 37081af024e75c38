/*
 * Files that hold states: checkpoint.h5 (everything a resume needs, written aside, synced, renamed) and trajectory.h5
 * (H5MD 1.1 frames, appended). docs/files.md lists their contents.
 */
#ifndef UNCROSS_SNAPSHOT_H
#define UNCROSS_SNAPSHOT_H

#include <stdbool.h>
#include <stdint.h>

#include "io/message.h"
#include "observe/observe.h"
#include "state/model.h"
#include "state/state.h"

/* What a checkpoint says about the run it is of, besides the state. */
struct checkpoint_head {
  uint64_t fingerprint; /* of the scene: scene.h */
  uint64_t seed;
  uint64_t state_hash;  /* of the state as written; checked when read */
  double wall_seconds;  /* spent so far, over all sessions */
  double start_energy;         /* kT, at step 0, for run.json of a resumed run */
  struct vec3 start_momentum;
  char version[64];
};

/* Writes path.part, syncs it, and renames it to path: path is at every moment either the old or the new checkpoint.
 * blocks: the observers' memory. False, with a message, on any failure; path is then untouched. */
bool checkpoint_write(const char *path, const struct checkpoint_head *head, const struct state *state,
                      const struct observe_block *blocks, size_t block_count, const char *scene_text,
                      struct message *message);

/* Reads a checkpoint into a state allocated for this model. Checks that it is one, is whole, has this model's numbers of
 * particles and vertices and box, and that the state hash is right. blocks: filled where given (block_count may be 0).
 * False, with a message that names the file and what is wrong, on any failure. */
bool checkpoint_read(const char *path, const struct model *model, struct checkpoint_head *head, struct state *state,
                     const struct observe_block *blocks, size_t block_count, struct message *message);

/* A start from somebody's state: a checkpoint, or the last frame of an H5MD file with vertices (and solvent, if the model
 * has one) with velocities. Sets step 0. */
bool snapshot_read_start(const char *path, const struct model *model, struct state *state, struct message *message);

/* --- trajectory ---------------------------------------------------------------------------------------------------- */

struct trajectory; /* an open H5MD file */

struct trajectory_options {
  bool solvent;    /* frames hold the solvent, else only the vertices */
  bool velocities;
  uint64_t seed;
  const char *author; /* creator fields of H5MD are filled from version.h */
};

/* Creates a trajectory, or opens the one that is there and drops frames after `keep_to_step` (a resume; keep_to_step is
 * UINT64_MAX to keep all). scene_text is stored in the file, so that `uncross analyze` needs nothing else. */
struct trajectory *trajectory_open(const char *path, const struct model *model, const struct trajectory_options *options,
                                   bool resume, uint64_t keep_to_step, const char *scene_text, struct message *message);
/* Appends the state as a frame, and flushes. Positions are unwrapped for vertices, wrapped for the solvent. */
bool trajectory_append(struct trajectory *trajectory, const struct model *model, const struct state *state,
                       struct message *message);
bool trajectory_close(struct trajectory *trajectory, struct message *message);

/* Reading: number of frames, scene text, and one frame into a state (vertices always; velocities and solvent if stored;
 * positions come back to the very lattice points they were). */
struct trajectory *trajectory_open_read(const char *path, struct message *message);
uint64_t trajectory_frames(const struct trajectory *trajectory);
char *trajectory_scene_text(const struct trajectory *trajectory); /* to be freed; NULL if not one of ours */
bool trajectory_read(struct trajectory *trajectory, const struct model *model, uint64_t frame, struct state *state,
                     struct message *message);

/* --- other forms --------------------------------------------------------------------------------------------------- */

/* Extended XYZ of a trajectory or checkpoint to a stdio stream (OVITO, ASE): `uncross export`. Bonds as a per-vertex
 * column. */
struct export_options {
  bool solvent;
  bool wrapped;
  uint64_t first, last, stride; /* frames */
};

/* Prints what a file is, in a few lines: `uncross info`. Knows scenes, checkpoints, trajectories, run.json, CSV tables.
 * False, with a message, if it is none of them or cannot be read. */
bool file_info(const char *path, struct message *message);

#endif
