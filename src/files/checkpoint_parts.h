/* What the files about checkpoints share. */
#ifndef UNCROSS_FILES_CHECKPOINT_PARTS_H
#define UNCROSS_FILES_CHECKPOINT_PARTS_H

#include "files/checkpoint.h"

/* Writes the numbers of a summary that are attributes of groups; into group `state`, the numbers of the state. */
bool checkpoint_put_fields(hid_t file, const struct checkpoint_summary *summary);
bool checkpoint_put_numbers(hid_t group, const struct state *numbers);

/* Copies the state's numbers. */
void checkpoint_take_numbers(struct state *state, const struct state *numbers);

/* True if a file has the arrays of this group. */
bool checkpoint_has_group(const struct state_group *group);

/* The name of a block as that of a dataset. */
void checkpoint_block_name(const struct observe_block *block, char *name, size_t size);

#endif
