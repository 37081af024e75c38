/*
 * Small helpers over the HDF5 C API: little-endian types in the file, no time stamps (equal content makes equal bytes),
 * the library's own error printing silenced and turned into one sentence.
 *
 * Metadata written here carries HDF5's checksums (file format of HDF5 1.8); h5_array_* add an XXH64 of the data, kept
 * as attribute `xxh64` of the dataset, so that a flipped bit anywhere is found when it is read.
 *
 * Handles are below 0 where a call failed; h5_close takes such handles too.
 */
#ifndef UNCROSS_FILES_HDF5_H
#define UNCROSS_FILES_HDF5_H

#include <hdf5.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/message.h"

/* For a program, before anything else; a library must not decide this for its host. HDF5 does nothing at exit: it would
 * try once more to close a file that it could not write, and crash (1.10.8); our files are closed by then. */
void h5_own_process(void);

/* From now on, until the next file is opened, counts the calls of HDF5 that fail. Readers never make a call that fails
 * on a whole file: they ask first what there is. And after a failure HDF5 1.10.8 may take what it could not read for
 * absent: so a file is whole only if the count stays 0. */
void h5_watch(unsigned *failures);

/* The innermost entry of HDF5's error stack as a sentence; "unknown HDF5 error" if the stack is empty. */
void h5_reason(char *text, size_t size);

/* Says `path: doing: reason`, the reason from the error stack if HDF5 put one there. Returns 0. */
int h5_fail(struct message *message, const char *path, const char *doing);

/* Opens a file. Tests before whether it exists, is a regular file, is not in use, fits its seal (seal.h) if it has one,
 * and is HDF5, so that the message is plain. A file that may come from anywhere is only opened by a process of its own
 * (apart.h). */
enum h5_trouble {
  H5_FINE,
  H5_UNREADABLE, /* not there, no permission, in use by another process, or no memory: nothing is known of its bytes */
  H5_DAMAGED,    /* not HDF5, truncated, or its checksums are wrong */
  H5_DEADLY      /* the process that read it died: of its bytes, as far as can be known */
};
hid_t h5_open(const char *path, bool writable, bool *sealed, enum h5_trouble *trouble, struct message *message);

/* Creates a file on disk; below 0, with a message, if it cannot be, or if there is one already. */
hid_t h5_create(const char *path, struct message *message);

/* Closes a file on disk, and leaves its lock even if a child of this process has a copy of its descriptor. */
bool h5_close_locked(hid_t file);

/* False, with a message, if there is not so much memory besides what HDF5 needs for itself. HDF5 1.10.8 crashes, or
 * takes a whole file for damaged, where it is refused memory; so it is asked for before. */
bool h5_has_memory(const char *path, size_t bytes, struct message *message);

/* Creates a file in memory, with room for about so many bytes; h5_image gives its bytes and their seal,
 * to be freed. */
hid_t h5_create_in_memory(size_t bytes);
void *h5_image(hid_t file, size_t *bytes);

/* Reserves disk space for so many bytes behind the end of an open file; returns 0, or errno. HDF5 must not write to a
 * full disk: it can then neither close the file nor leave it valid. h5_trim releases the space that was not used. */
int h5_reserve(hid_t file, size_t bytes);
void h5_trim(hid_t file);

/* The descriptor of a file on disk; below 0 if it has none. */
int h5_descriptor(hid_t file);

/* Waits until what was flushed is on the disk; returns 0, or errno's number. */
int h5_sync(hid_t file);

/* Creates the group `name` (no path). */
hid_t h5_group(hid_t parent, const char *name);

/* Opens the group or dataset `name` (no path): below 0 if the parent is not open, has none, or it cannot be read; below
 * 0 too, with the reason on HDF5's stack of errors, if its data are in another file (an external link, external
 * storage, a virtual dataset). */
hid_t h5_open_object(hid_t parent, const char *name);
hid_t h5_open_group(hid_t parent, const char *name);
hid_t h5_open_dataset(hid_t parent, const char *name);

/* Creates a dataset of this rank; grows: the first dimension is unlimited, in chunks of `chunk` rows (dims[0] is 0
 * then). */
hid_t h5_dataset(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, bool grows, hsize_t chunk);

/* Closes a handle of any sort; true for one that never was. */
bool h5_close(hid_t handle);

/* Attributes: a scalar (count 0) or a row of `count`; reading checks the number. `type` is the type in memory, the file
 * gets its little-endian form. */
bool h5_put(hid_t object, const char *name, hid_t type, size_t count, const void *data);
bool h5_get(hid_t object, const char *name, hid_t type, size_t count, void *data);
bool h5_put_text(hid_t object, const char *name, const char *text);
bool h5_get_text(hid_t object, const char *name, char *text, size_t size); /* false if it does not fit */

/* Puts a reason of our own where h5_reason looks for it. Returns -1. */
int h5_refuse(const char *why);

/* The type of a text of so many bytes in UTF-8; to be closed. */
hid_t h5_text_type(size_t length);

/* Whole datasets, with the hash of their data. h5_array_read checks class of type, shape and, where there is one, the
 * hash. Rank at most 4. */
bool h5_array_write(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, const void *data);
bool h5_array_read(hid_t parent, const char *name, hid_t type, int rank, const hsize_t *dims, void *data);

/* True if there is a dataset of this shape, and its numbers are stored. */
bool h5_array_is(hid_t parent, const char *name, int rank, const hsize_t *dims);

/* A text of any length as a scalar dataset; reading returns memory to be freed, or NULL; errno is ENOMEM then if memory
 * is short. */
bool h5_text_write(hid_t parent, const char *name, const char *text);
char *h5_text_read(hid_t parent, const char *name);

/* Shape of a dataset: returns its rank; -1 if that is more than `most` dimensions, or there is no dataset; -2 if it
 * cannot be read, or claims more numbers than the file can hold, so that a shape may be believed. */
int h5_shape(hid_t dataset, int most, hsize_t *dims);

/* 1 if the link `name` (no path) is there and what it points to too, 0 if not (in a dataset there is nothing), below 0
 * if that cannot be found out or it points to another file. */
int h5_look(hid_t parent, const char *name);

/* True if h5_look is 1. */
bool h5_has(hid_t parent, const char *name);

#endif
