/* What else an H5MD file holds of its particles: each array is used, checked, or makes the file unfit for a start. */
#ifndef UNCROSS_FILES_FOREIGN_H
#define UNCROSS_FILES_FOREIGN_H

#include "files/frames.h"
#include "files/trajectory.h"

/* Within a process of its own (apart.h). False, with a message, if nobody knows which frame is meant: there are several
 * groups of particles, or elements of frames that are not of the steps of the positions. */
bool foreign_is_one(const struct trajectory *trajectory, struct message *message);

/* The ids of its rows, [particles], to be freed: those of the last frame, if they change. NULL: there are none. */
int64_t *foreign_ids(const struct trajectory *trajectory);

/* Within a process of its own (apart.h). Looks at the group of particles: whether its rows are in the order of ids, its
 * masses are one number for each row, the words of its box are known, its numbers have no units, its species do not
 * change, and nothing is there of which a run knows nothing. about->unfit says what is wrong, or stays empty.
 * structure: as it was read. */
void foreign_look(const struct trajectory *trajectory, const struct structure *structure, struct frames_about *about);

/* Adds the images of a frame (`image`, whole edges) to its positions: [3 particles]. edge: the box, or 0 where it is
 * not known. False if there are images that cannot be read, or no box for them. */
bool foreign_unfold(const struct trajectory *trajectory, uint64_t frame, const double edge[3], double *position);

#endif
