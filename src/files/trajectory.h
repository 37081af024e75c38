/* Trajectories of ours, as they are written. docs/files.md lists the contents. */
#ifndef UNCROSS_FILES_TRAJECTORY_H
#define UNCROSS_FILES_TRAJECTORY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/message.h"
#include "files/frames.h"
#include "files/hdf5.h"
#include "files/snapshot.h"

#define TRAJECTORY_VERSION 2                                    /* with checksums; version 1 has none */
#define TRAJECTORY_REACH ((double)LATTICE_REACH * LATTICE_UNIT) /* a0: no vertex is further out */

struct trajectory {
  char *path;
  hid_t file;
  hid_t position, velocity;          /* [frames][particles][3]; velocity is below 0 if not stored */
  hid_t edges, step, time, checksum; /* [frames][3][3], [frames], [frames], [frames][FRAME_SUMS]; checksum is below 0 in
                                        a file of version 1 */
  uint64_t frames;
  uint64_t last_step; /* of the last frame */
  uint32_t particles; /* rows of a frame */
  bool solvent;       /* frames hold the solvent */
  bool broken;        /* a write failed: nothing more is written */
  bool read;          /* by another process, when the last frame was written */
  double *row;        /* [3 particles] */
  uint32_t *slot;     /* [solvent particles] */
};

/* trajectory_allocate: a handle with nothing open; NULL if memory is short. trajectory_give_up closes a handle after a
 * failure and returns NULL, for `return trajectory_give_up(t)`.
 */
struct trajectory *trajectory_allocate(const char *path);
struct trajectory *trajectory_give_up(struct trajectory *trajectory);

#define TRAJECTORY_CHUNK 65536  /* bytes: of small frames so many as fill this share a chunk */
#define TRAJECTORY_SLACK 262144 /* bytes: room for what HDF5 itself needs: headers, indices of chunks */

/* Asks the file system for so many bytes more, before HDF5 writes them. False, with a message, if there is no room. */
bool trajectory_reserve(const struct trajectory *trajectory, size_t bytes, struct message *message);

/* Once the file is whole and flushed: from now on others may read it, but not write it. */
void trajectory_let_readers_in(struct trajectory *trajectory);

/* Fills the rows of a frame from a state, in a0 and a0/t0: vertices, unwrapped; then, unless slot is NULL, the solvent
 * at its present positions, by id. row: [3 (vertices + particles)]. */
void frame_positions(const struct state *state, const struct model *model, const uint32_t *slot, double *row);
void frame_velocities(const struct state *state, const struct model *model, const uint32_t *slot, double *row);

/* Checksums of the tables of one frame: XXH64 with the number of the frame as seed, so that no frame can stand for
 * another. Of step and time: 8 bytes each, int64_t and double; of edges: the diagonal; 0 for velocities that are not
 * stored. */
enum frame_sum { SUM_MOMENT, SUM_EDGES, SUM_POSITION, SUM_VELOCITY, FRAME_SUMS };
uint64_t frame_sum_moment(uint64_t frame, int64_t step, double time);
uint64_t frame_sum_numbers(uint64_t frame, const double *number, size_t count);

/* How many frames are of steps up to this one, and the last step among them. Each of them is held against its
 * checksums. FRAME_DAMAGED, with a message, if one is damaged, or if steps do not increase; FRAME_LOST if that cannot
 * be found out. A frame that comes later may be damaged: it is not kept. */
enum frame_verdict trajectory_find_kept(struct frames *frames, uint64_t keep_to_step, uint64_t *keep,
                                        uint64_t *last_step, struct message *message);

#endif
