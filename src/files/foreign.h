/* What else an H5MD file holds of its particles: each array is used, checked, or makes the file unfit for a start. */
#ifndef UNCROSS_FILES_FOREIGN_H
#define UNCROSS_FILES_FOREIGN_H

#include "files/frames.h"

/* False, with a message, if nobody knows which frame is meant: there are several groups of particles, or elements of
 * frames that are not of the steps of the positions. */
bool foreign_is_one(struct frames *frames, struct message *message);

/* The ids of its rows, to be freed: those of the last frame, if they change. NULL: there are none. */
int64_t *foreign_ids(struct frames *frames);

/* Looks at the group of particles: whether its rows are in the order of ids, its masses are one number for each row,
 * the words of its box are known, its numbers have no units, its species do not change, and nothing is there of which a
 * run knows nothing. about->unfit says what is wrong, or stays empty. */
void foreign_look(struct frames *frames);

/* Adds the images of a frame (`image`, whole edges) to the picture's positions. False if there are images that cannot
 * be read, or no box for them. */
bool foreign_unfold(struct frames *frames, uint64_t frame);

#endif
