/* The format of checkpoints, for files of this room that read them without a model. docs/files.md lists the contents.
 */
#ifndef UNCROSS_FILES_CHECKPOINT_H
#define UNCROSS_FILES_CHECKPOINT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/message.h"
#include "files/far.h"
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

/* --- of an open file --------------------------------------------------------------------------------------------- */

/* True if the file says that it is a checkpoint, of whatever version. */
bool checkpoint_is(struct far *far);

/* Reads the summary, and checks that all its numbers are within their ranges and that the arrays have the rows that it
 * claims. False, with a message, if the file is no checkpoint of a known version, or is damaged. */
bool checkpoint_find(struct far *far, struct checkpoint_summary *summary, struct message *message);

/* Reads the arrays into a state that has room for them, its solvent in id order, and checks it as checkpoint_fetch
 * does. next: of the model's bonds; NULL if none is known. */
bool checkpoint_read_state(struct far *far, const struct checkpoint_summary *summary, struct state *state,
                           int32_t *next, struct message *message);

/* --- by its path ------------------------------------------------------------------------------------------------- */

/* Reads the summary only. */
bool checkpoint_look(const char *path, struct checkpoint_summary *summary, struct message *message);

/* Reads a checkpoint's state into one allocated for this model, after comparing numbers, box and bonds, and the memory
 * of observers into their blocks. The state hash must be right, and each number one that a state can have. */
bool checkpoint_fetch(const char *path, const struct model *model, struct checkpoint_summary *summary,
                      struct state *state, const struct observe_block *blocks, size_t block_count,
                      struct message *message);

#endif
