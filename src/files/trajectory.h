/* An open H5MD file, for files of this room that read it without a model. docs/files.md lists the contents. */
#ifndef UNCROSS_FILES_TRAJECTORY_H
#define UNCROSS_FILES_TRAJECTORY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/message.h"
#include "files/hdf5.h"
#include "files/snapshot.h"

#define TRAJECTORY_VERSION 2                                    /* with checksums; version 1 has none */
#define TRAJECTORY_REACH ((double)LATTICE_REACH * LATTICE_UNIT) /* a0: no vertex is further out */

struct frames;

struct trajectory {
  char *path;
  struct frames *frames_apart; /* when reading: all below that is not said to be for writing is a copy, or closed */
  hid_t file, group;           /* group: particles/trajectory, or another's first group of particles */
  hid_t position, velocity;    /* [frames][particles][3]; velocity is below 0 if not stored */
  hid_t edges, step, time;     /* [frames][3][3], [frames], [frames]; below 0 if stored otherwise or not at all */
  hid_t checksum;              /* [frames][FRAME_SUMS]; below 0: its frames carry none */
  uint64_t frames;
  uint64_t last_step; /* of the last frame; when writing */
  uint32_t particles; /* rows of a frame */
  bool solvent;       /* frames hold the solvent; when writing */
  bool unread;        /* something that is there could not be read */
  bool ours;          /* this program wrote it, in a format of this ... */
  int32_t version;    /* ... when reading */
  bool broken;        /* a write failed: nothing more is written */
  bool read;          /* by another process, when the last frame was written */
  bool damaged;       /* the last frame that was to be read is */
  double *row;        /* [3 particles] */
  uint32_t *slot;     /* [solvent particles]; when writing solvent */
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

/* Finds the datasets of a file that is open, and checks that it is one of ours of a known version, or another's. False,
 * with a message, on failure. */
bool trajectory_find(struct trajectory *trajectory, struct message *message);

/* The text of its scene, to be freed: 1; 0 if it holds none; -1 if that cannot be read. */
int trajectory_read_scene(const struct trajectory *trajectory, char **text);

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

/* Reads row `frame` of a dataset of this rank whose first dimension counts frames. */
bool trajectory_read_block(hid_t dataset, uint64_t frame, int rank, hid_t type, void *data);

/* Reads one frame, in a0 and a0/t0, and holds it against its checksums: step and time are 0 where they are not stored;
 * has_box is false if no box is stored, or one that is not rectangular. position, velocity: [3 particles]; velocity is
 * not touched if it is not stored. False, with a message that names what is wrong with the frame. */
bool trajectory_load(const struct trajectory *trajectory, uint64_t frame, uint64_t *step, double *time, double edge[3],
                     bool *has_box, double *position, double *velocity, struct message *message);

#endif
