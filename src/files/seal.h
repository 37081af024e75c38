/*
 * A seal: 32 bytes behind the end of a file that is written once and as a whole (checkpoints, packs):
 *
 *   16 bytes "uncross seal v1\n"; uint64, little-endian: the length of what is before; its XXH64, seed 0
 *
 * HDF5 ignores what is behind the end of its data. So one look at the bytes says whether any of them has changed,
 * before HDF5 is asked to make sense of them.
 */
#ifndef UNCROSS_FILES_SEAL_H
#define UNCROSS_FILES_SEAL_H

#include <stddef.h>

#include "base/message.h"

#define SEAL_BYTES 32

/* The seal of these bytes. */
void seal_make(const void *data, size_t bytes, unsigned char seal[SEAL_BYTES]);

enum seal {
  SEAL_NONE,      /* the file has none */
  SEAL_FITS,      /* every byte is as it was written */
  SEAL_BROKEN,    /* it does not fit the bytes before it; with a message */
  SEAL_UNREADABLE /* the file cannot be read; with a message */
};
enum seal seal_check(const char *path, struct message *message);

#endif
