/*
 * Frames of any file that holds states: those of an H5MD trajectory, ours or another's, and the one of a checkpoint.
 * A process of its own reads the file (far.h); what it hands over is judged and ranged here.
 */
#ifndef UNCROSS_FILES_FRAMES_H
#define UNCROSS_FILES_FRAMES_H

#include "files/checkpoint.h"
#include "files/far.h"
#include "files/structure.h"
#include "scene/scene.h"

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

/* Where a trajectory has them. */
struct frames_layout {
  char group[320];        /* of the particles */
  bool ours;              /* this program wrote it, in a format of this ... */
  int32_t version;        /* ... */
  bool times;             /* are stored */
  bool images;            /* of the particles, too */
  bool edges_change;      /* the box is stored for each frame */
  struct far_thing edges; /* as they are stored */
  bool unread;            /* something that is there could not be read */
};

struct frames {
  char *path;
  struct far file;
  struct frames_about about;
  struct frames_layout layout;
  struct structure structure;
  char *scene; /* the scene's text; NULL: none */
  struct picture picture;
};

/* Opens a file, finds out what it holds, and reads particles, bonds and scene. NULL, with the kind of trouble and a
 * message, on failure. */
struct frames *frames_open(const char *path, enum h5_trouble *trouble, struct message *message);
void frames_close(struct frames *frames); /* NULL too */

/* The scene that it holds, without its model's lists: the file may claim any number of fibers; images of a sheared box
 * slide as they did then. False if there is none, or it cannot be read; errno is ENOMEM then if memory is short. */
bool frames_scene(const struct frames *frames, struct scene *scene);

enum frame_verdict {
  FRAME_LOST = -1, /* no more frames can be read: the file cannot be, or memory is short */
  FRAME_FINE,
  FRAME_DAMAGED /* this one is not what was written, or holds numbers that no frame has */
};

/* Puts a frame into frames->picture. With a message that names file, frame, step and table if it is not fine; of a
 * damaged frame only picture.step is set, as it stands in the file. */
enum frame_verdict frames_read(struct frames *frames, uint64_t frame, struct message *message);

/* The same, but numbers need not be finite. */
enum frame_verdict frames_check(struct frames *frames, uint64_t frame, struct message *message);

/* --- of a trajectory, for a model --------------------------------------------------------------------------------- */

/* NULL, with a message, if it cannot be read or is a checkpoint. */
struct frames *trajectory_open_read(const char *path, struct message *message);
bool trajectory_has_solvent(const struct frames *frames, const struct model *model);

/* A frame into a state: vertices always; velocities and solvent if stored, else as they were; positions come back to
 * the very lattice points they were; lag 0. FRAME_LOST, too, with a message, if it is none of this model. */
enum frame_verdict trajectory_read(struct frames *frames, const struct model *model, uint64_t frame,
                                   struct state *state, struct message *message);

/* --- of an H5MD file, for files of this room --------------------------------------------------------------------- */

/* Finds the datasets, and checks that it is one of ours of a known version, or another's. False, with a message, on
 * failure. */
bool h5md_find(struct frames *frames, struct message *message);

/* What it says of its seed, creator, box. */
void h5md_tell(struct frames *frames);

/* Reads one frame into the picture, and holds it against its checksums. False, with a message that names what is wrong
 * with the frame. */
bool h5md_load(struct frames *frames, uint64_t frame, struct message *message);

#endif
