/* The format of checkpoints, for those in io/ who read them without a model; docs/files.md lists the contents. */
#ifndef UNCROSS_CHECKPOINT_H
#define UNCROSS_CHECKPOINT_H

#include <stdbool.h>
#include <stdint.h>

#include "io/hdf5.h"
#include "io/message.h"
#include "io/snapshot.h"

#define CHECKPOINT_FORMAT "uncross checkpoint"
#define CHECKPOINT_VERSION 1

/* What a checkpoint says about itself, without its arrays. */
struct checkpoint_summary {
  struct checkpoint_head head;
  int cells[3];
  double time_step;
  struct vec3 acceleration; /* of the solvent, in a0/t0^2 */
  uint64_t step;
  uint32_t solvent_lag; /* half steps */
  uint32_t particles, vertices;
  struct collision_counts counts;
};

/* True if the file says that it is a checkpoint, of whatever version. */
bool checkpoint_is(hid_t file);

/* Opens a checkpoint of this version and reads its summary; below 0, with a message, if it is none or is damaged. */
hid_t checkpoint_open(const char *path, struct checkpoint_summary *summary, struct message *message);

/* Reads the arrays into a state that has room for them, its solvent in id order, and checks the state hash. */
bool checkpoint_read_state(hid_t file, const char *path, const struct checkpoint_summary *summary, struct state *state,
                           struct message *message);

/* Reads a checkpoint's state into one allocated for this model, after comparing numbers, box and bonds; hands back the
 * open file, or below 0 with a message. */
hid_t checkpoint_open_for(const char *path, const struct model *model, struct checkpoint_summary *summary,
                          struct state *state, struct message *message);

#endif
