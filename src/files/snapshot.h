/*
 * Files that hold states: checkpoint.h5 (everything a resume needs, written aside, synced, renamed) and trajectory.h5
 * (H5MD 1.1 frames, appended). docs/files.md lists their contents.
 */
#ifndef UNCROSS_FILES_SNAPSHOT_H
#define UNCROSS_FILES_SNAPSHOT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/message.h"
#include "files/folder.h"
#include "observe/observe.h"
#include "system/model.h"
#include "system/state.h"
#include "system/stream.h"

/* The data of a checkpoint about its run, besides the state. */
struct checkpoint_head {
  uint64_t fingerprint; /* of the scene: scene.h */
  uint64_t seed;        /* of the scene */
  struct stream stream;
  uint64_t state_hash;   /* of the state as written; checked when read */
  uint64_t state_digest; /* the same; 0: the file is from before there were digests */
  uint64_t frames_end;   /* 1 + the step of the trajectory's last frame; 0: none, or not known */
  double wall_seconds;   /* spent so far, over all sessions */
  double start_energy;   /* kT, at step 0, for run.json of a resumed run */
  struct vec3 start_momentum;
  uint64_t slide; /* of a sheared box's images at step 0: model.shear.slid */
  char version[64];
};

/* Writes a checkpoint as file_replace does (folder.h): the file is at every moment either the old or the new one.
 * blocks: the observers' memory. The hash of the state is taken here and put into the head. False, with a message, on
 * any failure; the file is then untouched. */
bool checkpoint_write_in(const struct folder *folder, const char *file, struct checkpoint_head *head,
                         const struct model *model, const struct state *state, const struct observe_block *blocks,
                         size_t block_count, const char *scene_text, struct message *message);

/* The same, for a file that is named by its path. Nothing is written over but a checkpoint, nor into what is no file.
 */
bool checkpoint_write(const char *path, struct checkpoint_head *head, const struct model *model,
                      const struct state *state, const struct observe_block *blocks, size_t block_count,
                      const char *scene_text, struct message *message);
/* About how many bytes it takes, without the scene's text. observed: bytes of the memory of observers. */
double checkpoint_bytes(const struct model *model, uint64_t observed);

/* Reads a checkpoint into a state allocated for this model. Checks that it is one, is whole, has this model's numbers
 * of particles and vertices, its box and its bonds, and that the state hash is right. Particles come back in id order.
 * blocks: filled where given (block_count may be 0); a block that the file does not hold, or of another size, is a
 * failure, and so is a setting with another value; a setting that the file does not hold is accepted. False, with a
 * message that names the file and what is wrong, on any failure; the state must not be used then. The caller has to
 * compare the fingerprint, which is in *head. */
bool checkpoint_read(const char *path, const struct model *model, struct checkpoint_head *head, struct state *state,
                     const struct observe_block *blocks, size_t block_count, struct message *message);

/* What a snapshot says about the run that made it. */
struct snapshot_origin {
  bool has_stream;
  uint64_t stream, step;
  uint64_t slide;  /* lattice units: of the images of its sheared box; 0 for another box, and where nobody knows it */
  uint32_t untold; /* what its file does not say: bits of enum stream_untold */
};

/* Reads a starting state: a checkpoint, or the last frame of an H5MD file with positions and velocities of vertices
 * (and of solvent, if the model has one). Sets step, lag and counts of crossings to 0; solvent that lags in a
 * checkpoint is streamed to its present position. Velocities of vertices are taken to be of the half step ahead, as
 * uncross writes them. Box, numbers and bonds must be the model's; whether bonds fit the box is for the caller to
 * check. */
bool snapshot_read_start(const char *path, const struct model *model, struct state *state,
                         struct snapshot_origin *origin, struct message *message);

/* --- trajectory -------------------------------------------------------------------------------------------------- */

struct trajectory; /* an open H5MD file */

struct trajectory_options {
  bool solvent; /* frames hold the solvent, else only the vertices */
  bool velocities;
  uint64_t seed, stream;
  uint64_t fingerprint;        /* of the scene; 0: frames are not held against it */
  const struct folder *folder; /* a run's: the path's last part must be a file of this folder, and no link; or NULL */
};

/* Creates a trajectory, or opens the one that is there and drops frames after `keep_to_step` (a resume; keep_to_step is
 * UINT64_MAX to keep all). scene_text is stored in the file, so that `uncross analyze` needs nothing else.
 * A resume that finds no file starts one; one that finds a file which cannot be read (a crash or a full disk broke it)
 * renames that to NAME.damaged.1.h5 (or .2, ...) and starts a new one. After a success message->text is empty, or such
 * a note for the user. NULL, with a message, on any failure; a readable file of other particles than asked for is one,
 * and so is any file where one is to be created: nothing is written over. */
struct trajectory *trajectory_open(const char *path, const struct model *model,
                                   const struct trajectory_options *options, bool resume, uint64_t keep_to_step,
                                   const char *scene_text, struct message *message);
/* Appends the state as a frame, and flushes. Positions are unwrapped for vertices, wrapped for the solvent, which is
 * shown where it is now. Doubles hold every lattice point up to 8192 a0 from the origin; further out it is the nearest
 * double, at most 1.2e-10 a0 away. */
bool trajectory_append(struct trajectory *trajectory, const struct model *model, const struct state *state,
                       struct message *message);
/* About how many bytes a file of so many frames takes, without the scene's text. rows: particles of a frame. */
double trajectory_bytes(uint64_t rows, uint64_t bonds, bool velocities, uint64_t frames);
/* Waits until all frames are on the disk. */
bool trajectory_sync(struct trajectory *trajectory, struct message *message);
/* Of its open file. */
int trajectory_descriptor(const struct trajectory *trajectory);
/* 1 + the step of the last frame of a trajectory that is being written; 0 if there is none, or for NULL. */
uint64_t trajectory_end(const struct trajectory *trajectory);
/* The same of a file, counting frames up to a step only; false if it is not there, is damaged, or is in use. */
bool trajectory_find_end(const char *path, uint64_t keep_to_step, uint64_t *end);
/* False if a readable file has frames of another run, or of other particles than asked for, with a message. */
bool trajectory_fits(const char *path, const struct model *model, const struct trajectory_options *options,
                     struct message *message);
/* Closes it, NULL too; the handle is freed in any case. False, with a message, if data could not be written. */
bool trajectory_close(struct trajectory *trajectory, struct message *message);

/* Reading: number of frames, scene text, and one frame into a state (vertices always; velocities and solvent if stored,
 * else as they were; positions come back to the very lattice points they were; lag 0). */
struct trajectory *trajectory_open_read(const char *path, struct message *message);
uint64_t trajectory_frames(const struct trajectory *trajectory);
char *trajectory_scene_text(const struct trajectory *trajectory); /* to be freed; NULL if not one of ours */
bool trajectory_has_steps(const struct trajectory *trajectory);   /* else every frame reads as step 0 */
bool trajectory_has_velocities(const struct trajectory *trajectory);
bool trajectory_has_solvent(const struct trajectory *trajectory, const struct model *model);
bool trajectory_read(struct trajectory *trajectory, const struct model *model, uint64_t frame, struct state *state,
                     struct message *message);
/* After trajectory_read failed: true if only this frame is to blame, and others may be read. */
bool trajectory_damaged(const struct trajectory *trajectory);

/* --- what a file is --------------------------------------------------------------------------------------------- */

/* Describes a file in a few lines: `uncross info`. Knows scenes, checkpoints, trajectories, run.json, CSV tables, and
 * folders of runs. False, with a message, if it is none of them or cannot be read. */
bool file_info(const char *path, struct message *message);

#endif
