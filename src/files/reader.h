/*
 * The reader: the process that does work apart (apart.h).
 *
 * Where the parent finds it: $UNCROSS_READER names it by an absolute path, and then no other is taken. A program that
 * is a reader itself sets it (reader_is_here). Else, in this order: the program `uncross` beside the file that holds
 * this code, or in ../bin or, for build/lib/libuncross.so, in ..; PREFIX/bin/uncross, PREFIX being that of `make
 * install`. One that belongs to neither root, nor this user, nor the owner of the file that holds this code is not
 * taken.
 */
#ifndef UNCROSS_FILES_READER_H
#define UNCROSS_FILES_READER_H

#include <stdbool.h>
#include <stddef.h>

#include "files/apart.h"

#define READER_ASKED "read-apart" /* the only argument that a reader is started with */
#define READER_SOCKET 3

/* The path of the reader. False, with a message, if there is none. */
bool reader_find(char *path, size_t size, struct message *message);

/* Kinds of work: the last has no name. serve: returns when all is said. */
struct apart_work {
  const char *name;
  void (*serve)(struct apart *link);
};

/* For a program that is a reader, before anything else. It serves and does not return if it was started as one; else
 * its children will be readers of this very program. */
void reader_is_here(int count, char **words, const struct apart_work *works);

/* In the reader. apart_shut: from now on no file can be opened. apart_go_on: processor time is counted anew. */
void apart_shut(void);
void apart_go_on(const struct apart *link);

#endif
