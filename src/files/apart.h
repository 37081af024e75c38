/*
 * Work done apart: by a process of its own, which hands plain numbers over.
 *
 * HDF5 1.10.8 cannot be trusted with a file that comes from anywhere: on a damaged one it may free memory twice, loop,
 * or ask for any amount of memory; and a file may name other files that HDF5 then opens. So no file is read by the
 * process that needs its contents. A child does it, the reader; if it dies, the file is called damaged and the parent
 * goes on.
 *
 * The reader is the program uncross, started afresh: a mere copy of the parent (fork) would wait for ever for a lock
 * that another thread of the parent has, in HDF5 or elsewhere. It says first of which build it is, since what is sent
 * are plain structs. reader.h says how it is found.
 *
 * The reader ignores the signals that end a run, has limits of its own for memory and for processor time (both grow
 * with the file), and can open no other file once apart_shut is called. It never writes. It ends with its work, when
 * the parent lets go, and within a second of the parent's end. A parent waits for an answer for a limited time.
 */
#ifndef UNCROSS_FILES_APART_H
#define UNCROSS_FILES_APART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include "base/message.h"

/* One end of the connection between the two processes. */
struct apart {
  const char *path; /* the file, for messages; must outlive this */
  int socket;
  pid_t child;     /* 0: this is the child */
  double seconds;  /* of processor time that one piece of work may take */
  double patience; /* s; so long the parent waits for the next bytes */
  bool broken;     /* the other side is gone: nothing more is sent or received */
  bool died;       /* the child did, and of the file */
  bool silent;     /* the child did not answer */
};

/* Has a reader do the work of this name (struct apart_work, reader.h) with a file. A path that is not that of a regular
 * file is refused before. False, with a message, if there can be no reader; then there is nothing to end. */
bool apart_start(struct apart *parent, const char *path, const char *work, struct message *message);

/* Ends the child, whatever it does. */
void apart_end(struct apart *parent);

/* Sends or receives so many bytes. False if the other side is gone. */
bool apart_put(struct apart *link, const void *data, size_t bytes);
bool apart_get(struct apart *link, void *data, size_t bytes);

/* A text of any length, or none (NULL). Received: memory to be freed; at most `most` bytes; *text is NULL for none. */
bool apart_put_text(struct apart *link, const char *text);
bool apart_get_text(struct apart *link, size_t most, char **text);

/* How a piece of work went, as a number: 0 if it went well, another from 1 on with a message. Received: -1, with a
 * message that names the file, if the child is no more. */
void apart_put_verdict(struct apart *link, int verdict, const struct message *message);
int apart_get_verdict(struct apart *parent, struct message *message);

/* Says that, and if it is known how, the child died. Returns 0. */
int apart_lost(struct apart *parent, struct message *message);

/* What both sides say first: the child its build; the parent this, and what the work itself asks for. */
#define APART_WORD 32
#define APART_BUILD 128
struct apart_hello {
  char work[APART_WORD], path[4096]; /* PATH_MAX of Linux */
  double seconds;
  uint64_t bytes; /* of the file */
};
void apart_build(char build[APART_BUILD]);

#endif
