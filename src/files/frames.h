/*
 * Frames of any file that holds states: those of an H5MD trajectory, ours or another's, and the one of a checkpoint.
 * The file is read by a process of its own (apart.h), which hands over what is declared here. All numbers are ranged on
 * the way.
 */
#ifndef UNCROSS_FILES_FRAMES_H
#define UNCROSS_FILES_FRAMES_H

#include "files/apart.h"
#include "files/checkpoint.h"
#include "files/structure.h"

/* What an HDF5 file is, by what it says first. False, with the kind of trouble and a message, if it cannot be read. */
enum h5_sort { H5_CHECKPOINT, H5_TRAJECTORY, H5_PACK, H5_OTHER };
bool h5_find_sort(const char *path, enum h5_sort *sort, enum h5_trouble *trouble, struct message *message);

/* What a file says about itself. */
struct frames_about {
  bool checkpoint; /* else a trajectory */
  bool checked;    /* a checkpoint has a seal, or each frame of a trajectory checksums: damage does not go unseen */
  bool steps;      /* steps are stored */
  bool velocities;
  char unfit[256]; /* why no run starts from a trajectory; empty: it may */
  bool has_stream; /* a trajectory of this program: it tells its seed and stream */
  uint64_t seed;   /* of its scene */
  uint64_t stream; /* of its random numbers */
  uint64_t slide;  /* of a sheared box's images at step 0: model.shear.slid */
  uint64_t frames;
  uint32_t rows;                     /* particles of a frame */
  bool bounded;                      /* the file says along which axes its box is periodic */
  bool closed[3];                    /* it is not, along this one; false where the file does not say it */
  struct checkpoint_summary summary; /* of a checkpoint */
  char creator[128], version[64], author[128];
};

/* One frame, in a0, a0/t0 and t0. */
struct picture {
  double *position, *velocity; /* [3 rows]; NULL if not stored */
  bool has_box;                /* it is stored, and rectangular */
  double edge[3];
  uint64_t step; /* 0 where it is not stored */
  double time;
};

struct frames {
  char *path;
  struct apart apart;
  struct frames_about about;
  struct structure structure;
  char *scene; /* the scene's text; NULL: none */
  struct picture picture;
};

/* Opens a file, finds out what it holds, and reads particles, bonds and scene. NULL, with the kind of trouble and a
 * message, on failure. */
struct frames *frames_open(const char *path, enum h5_trouble *trouble, struct message *message);
void frames_close(struct frames *frames); /* NULL too */

enum frame_verdict {
  FRAME_LOST = -1, /* no more frames can be read: the file cannot be, or memory is short */
  FRAME_FINE,
  FRAME_DAMAGED /* this one is not what was written, or holds numbers that no frame has */
};

/* Puts a frame into frames->picture. With a message that names file, frame, step and table if it is not fine; of a
 * damaged frame only picture.step is set, as it stands in the file. */
enum frame_verdict frames_read(struct frames *frames, uint64_t frame, struct message *message);

/* The same, but only step, time and box arrive; all of the frame is checked. */
enum frame_verdict frames_check(struct frames *frames, uint64_t frame, struct message *message);

#endif
