/*
 * HDF5 files, as a process of its own reads them (apart.h). It answers one question after the other, each about an
 * object by its path, and understands nothing of what is in the file; who asks judges what comes.
 *
 * An object is named by a group and what is in it, `in` and `name`, both paths or empty; "" and "" is the file itself.
 * What cannot be read looks the same if the reader is no more, or memory is short: far_fail and far_whole tell.
 */
#ifndef UNCROSS_FILES_FAR_H
#define UNCROSS_FILES_FAR_H

#include <stdbool.h>
#include <stdint.h>

#include "files/apart.h"
#include "files/hdf5.h"

struct far {
  struct apart apart;  /* apart.path: the file */
  bool sealed;         /* every byte fits its seal */
  uint64_t failures;   /* calls of HDF5 that failed so far: of a whole file none does (h5_watch) */
  char reason[256];    /* of the last answer, as HDF5 says it; empty: none */
  uint64_t budget;     /* bytes that may still be allocated for what the file claims to hold */
  struct message lost; /* once nothing more can be read: how the reader ended, or that memory is short */
};

/* Opens a file. False, with the kind of trouble and a message, if it cannot be read. path must outlive it. far_close
 * after either. */
bool far_open(struct far *far, const char *path, enum h5_trouble *trouble, struct message *message);
void far_close(struct far *far);

/* Says what was lost, or `path: doing: reason`. Returns 0. */
int far_fail(const struct far *far, struct message *message, const char *doing);

/* True if nothing is lost and no call of HDF5 has failed since there were so many failures; else with a message. */
bool far_whole(const struct far *far, uint64_t failures, const char *damaged, struct message *message);

/* A file may claim more numbers than it holds, if they are compressed: there is no memory for more than the reader may
 * have. far_affords: so many bytes are taken of it. far_room: cleared memory for so many of this size, and one more; or
 * NULL, with a message without the file. */
bool far_affords(struct far *far, uint64_t bytes);
void *far_room(struct far *far, size_t count, size_t size, struct message *message);

/* --- questions --------------------------------------------------------------------------------------------------- */

enum far_kind {
  FAR_BROKEN = -1, /* cannot be read, or is in another file */
  FAR_NOTHING,
  FAR_GROUP,
  FAR_DATASET,
  FAR_OTHER
};
enum far_class { FAR_STRANGE, FAR_REALS, FAR_INTEGERS, FAR_ENUMERATION, FAR_TEXTS }; /* of what a dataset holds */

#define FAR_RANK 4
struct far_thing {
  int64_t kind, class;
  int64_t rank;            /* of a dataset; -1: more than FAR_RANK dimensions, -2: a shape that cannot be believed */
  uint64_t dims[FAR_RANK]; /* [rank] */
  uint64_t size;           /* bytes of one of its texts */
  uint64_t links;          /* of a group; names of an enumeration */
};
struct far_thing far_look(struct far *far, const char *in, const char *name);
bool far_has(struct far *far, const char *in, const char *name); /* of any kind */

/* True if it is a dataset of this rank. */
bool far_is(const struct far_thing *thing, int rank);

/* Name of the k-th link of a group; false if there is none, or it is longer. */
bool far_link(struct far *far, const char *in, uint64_t k, char *name, size_t size);

/* Types in memory; the last ones are for this file's own use. */
enum far_type {
  FAR_REAL,
  FAR_INTEGER,
  FAR_SHORT,
  FAR_COUNT,
  FAR_SHORT_COUNT,
  FAR_NUMBERS,
  FAR_TEXT,
  FAR_NAMES,
  FAR_LINK,
  FAR_THING
};

/* A row of a dataset of this shape, whose first dimension may be any; or all of it, which then fits its hash if it has
 * one (FAR_ALL), or may be of another type than it was written in (FAR_PLAIN). */
#define FAR_ALL UINT64_MAX
#define FAR_PLAIN (UINT64_MAX - 1)
bool far_read(struct far *far, const char *in, const char *name, uint64_t row, enum far_type type, int rank,
              const uint64_t *dims, void *data);

/* The text of a dataset; and the names of a dataset's enumeration by their values, `size` bytes each, of which there
 * are none of other numbers. To be freed; NULL if that cannot be read. */
char *far_text(struct far *far, const char *in, const char *name);
void *far_names(struct far *far, const char *in, const char *name, size_t size, uint64_t *count);

/* An attribute, a scalar (count 0) or a row of `count`: numbers; or texts of less than `size` bytes. 1: it is read; 0:
 * there is none; -1: it is another, or cannot be read. */
int far_get(struct far *far, const char *in, const char *name, const char *attribute, enum far_type type, size_t count,
            void *data);
int far_get_text(struct far *far, const char *in, const char *name, const char *attribute, size_t count, char *text,
                 size_t size);

/* The work of the process that reads, "hdf5" (reader.h); and what is said: a question, its answer, and if the thing was
 * found as wanted so many bytes. Members are as wide as the widest: no unset byte is sent. */
void far_serve(struct apart *link);

#define FAR_PATH 512
struct far_question {
  char path[FAR_PATH], attribute[64]; /* attribute: empty: none */
  uint64_t type, row, rank, dims[FAR_RANK], bytes;
};
struct far_answer {
  int64_t found; /* as that of an attribute */
  uint64_t failures, no_memory;
  char reason[256];
};

#endif
