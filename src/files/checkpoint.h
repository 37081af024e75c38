/* The format of checkpoints, for files of this room that read them without a model. docs/files.md lists the contents.
 */
#ifndef UNCROSS_FILES_CHECKPOINT_H
#define UNCROSS_FILES_CHECKPOINT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/message.h"
#include "files/apart.h"
#include "files/hdf5.h"
#include "files/snapshot.h"

#define CHECKPOINT_FORMAT "uncross checkpoint"
#define CHECKPOINT_VERSION 2 /* with a seal; version 1 has none */

/* The content of a checkpoint, without its arrays. */
struct checkpoint_summary {
  struct checkpoint_head head;
  int32_t version;
  int cells[3];
  uint32_t dimensions; /* 2: of a plane */
  double time_step;
  struct vec3 acceleration; /* of the solvent, in a0/t0^2 */
  uint32_t particles, vertices, dumbbells;
  uint32_t wall_rows;   /* of the account of the walls: system/state.h */
  uint32_t beads;       /* 0 or 1 */
  struct state numbers; /* only what state_numbers lists */
};

/* A model with the box, its dimensions, the numbers of particles and vertices, the time step and the body force of a
 * summary: enough for a state. */
struct model checkpoint_model(const struct checkpoint_summary *summary);

/* --- within a process of its own (apart.h) ----------------------------------------------------------------------- */

/* True if the file says that it is a checkpoint, of whatever version. */
bool checkpoint_is(hid_t file);

/* Reads the summary, and checks that all its numbers are within their ranges and that the arrays have the rows that it
 * claims. False, with a message, if the file is no checkpoint of a known version, or is damaged. */
bool checkpoint_find(hid_t file, const char *path, bool sealed, struct checkpoint_summary *summary,
                     struct message *message);

/* Reads the arrays into a state that has room for them, its solvent in id order, and checks it as checkpoint_fetch
 * does. */
bool checkpoint_read_state(hid_t file, const char *path, const struct checkpoint_summary *summary, struct state *state,
                           struct message *message);

/* The work "checkpoint" (reader.h). */
void checkpoint_serve(struct apart *link);

/* --- everywhere -------------------------------------------------------------------------------------------------- */

/* Reads the summary only. */
bool checkpoint_look(const char *path, struct checkpoint_summary *summary, struct message *message);

/* The fingerprint of its scene; false if the checkpoint cannot be read. */
bool checkpoint_fingerprint(const char *path, uint64_t *fingerprint);

/* Reads a checkpoint's state into one allocated for this model, after comparing numbers, box and bonds, and the memory
 * of observers into their blocks. The state hash must be right, and each number one that a state can have. */
bool checkpoint_fetch(const char *path, const struct model *model, struct checkpoint_summary *summary,
                      struct state *state, const struct observe_block *blocks, size_t block_count,
                      struct message *message);

#endif
