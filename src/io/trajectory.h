/* An open H5MD file, for those in io/ who read it without a model; docs/files.md lists the contents. */
#ifndef UNCROSS_TRAJECTORY_H
#define UNCROSS_TRAJECTORY_H

#include <stdbool.h>
#include <stdint.h>

#include "io/hdf5.h"
#include "io/message.h"
#include "io/snapshot.h"

#define TRAJECTORY_LIMIT 8192.0 /* a0: below this a double holds every lattice point */

struct trajectory {
  char *path;
  hid_t file, group;        /* group: particles/trajectory, or another's first group of particles */
  hid_t position, velocity; /* [frames][particles][3]; velocity is below 0 if not stored */
  hid_t edges, step, time;  /* [frames][3][3], [frames], [frames]; below 0 if stored otherwise or not at all */
  uint64_t frames;
  uint64_t last_step; /* of the last frame; when writing */
  uint32_t particles; /* rows of a frame */
  bool solvent;       /* frames hold the solvent; when writing */
  bool unread;        /* something that is there could not be read */
  bool broken;        /* a write failed: nothing more is written */
  double *row;        /* [3 particles] */
  uint32_t *slot;     /* [solvent particles]; when writing solvent */
};

/* A handle with nothing open, or NULL; one that is closed because something failed, for `return trajectory_give_up(t)`.
 */
struct trajectory *trajectory_allocate(const char *path);
struct trajectory *trajectory_give_up(struct trajectory *trajectory);

/* Opens what is there and finds its datasets; NULL, with the sort of trouble and a message, on failure. */
struct trajectory *trajectory_open_existing(const char *path, bool writable, enum h5_trouble *trouble,
                                            struct message *message);

/* What a frame shows of a state, in a0 and a0/t0: the vertices, unwrapped, then, if slot[id] is given, the solvent
 * where it is now. row: [3 (vertices + particles)]. */
void frame_positions(const struct state *state, const struct model *model, const uint32_t *slot, double *row);
void frame_velocities(const struct state *state, const struct model *model, const uint32_t *slot, double *row);

/* One frame of positions or velocities, in a0 or a0/t0: rows [3 particles]. */
bool trajectory_rows(const struct trajectory *trajectory, hid_t dataset, uint64_t frame, double *rows);

/* Edges of the box in a frame, in a0; false if there are none or the box is not rectangular. */
bool trajectory_edges(const struct trajectory *trajectory, uint64_t frame, double edge[3]);

/* Step and time of a frame; 0 where they are not stored frame by frame. */
bool trajectory_moment(const struct trajectory *trajectory, uint64_t frame, uint64_t *step, double *time);

#endif
