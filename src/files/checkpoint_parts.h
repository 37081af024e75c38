/* What the files about checkpoints share. */
#ifndef UNCROSS_FILES_CHECKPOINT_PARTS_H
#define UNCROSS_FILES_CHECKPOINT_PARTS_H

#include "files/checkpoint.h"

/* Writes or reads the numbers of a summary that are attributes of groups; of group `state`, the numbers of the state.
 */
bool checkpoint_fields(hid_t file, struct checkpoint_summary *summary, bool write);
bool checkpoint_numbers(hid_t group, struct state *numbers, bool write);

/* Copies the state's numbers. */
void checkpoint_take_numbers(struct state *state, const struct state *numbers);

/* True if a file has the arrays of this group. */
bool checkpoint_has_group(const struct state_group *group);

/* Types in memory; the name of a block as that of a dataset. */
hid_t checkpoint_field_type(const struct state_field *field);
hid_t checkpoint_block_type(const struct observe_block *block);
void checkpoint_block_name(const struct observe_block *block, char *name, size_t size);

/* Fills rows, [group->rows][3], of a field from somewhere, or says why it cannot. */
typedef bool checkpoint_rows(void *from, const struct state_group *group, const struct state_field *field, void *rows,
                             struct message *message);

/* The one that reads them from group `state` of a file; from: struct checkpoint_arrays. */
struct checkpoint_arrays {
  hid_t group;
  const char *path;
};
checkpoint_rows checkpoint_rows_of_file;

/* Fills all fields of a state. */
bool checkpoint_each_array(struct state *state, checkpoint_rows *read, void *from, const char *path,
                           struct message *message);

/* Whether it is the state that was written, and a state at all: a file that somebody made up fits its checksums too.
 * next: of the model's bonds; NULL if none is known. */
bool checkpoint_check(const struct state *state, const struct checkpoint_summary *summary, int32_t *next,
                      const char *path, struct message *message);

#endif
