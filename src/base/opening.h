/* The one way in which files that may be anything are opened for reading. Regular files only: a pipe or a device would
 * be waited for, or have no end. */
#ifndef UNCROSS_BASE_OPENING_H
#define UNCROSS_BASE_OPENING_H

#include <stdint.h>
#include <stdio.h>

#include "base/message.h"

/* The file's descriptor; below 0, with a message, if it is not a regular file or cannot be read. */
int open_regular(const char *path, struct message *message);

/* The same as a stream, and its size in bytes; NULL, with a message. */
FILE *open_input(const char *path, uint64_t *bytes, struct message *message);

#endif
