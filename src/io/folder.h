/* Folders that runs write into, and files put in place as a whole. */
#ifndef UNCROSS_FOLDER_H
#define UNCROSS_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

#include "io/message.h"

enum folder_trouble {
  FOLDER_FINE,
  FOLDER_IS_NONE, /* what was named is no folder, and cannot be one: bad input */
  FOLDER_REFUSED  /* by the system: no permission, no room, ... */
};

/* Makes the folder and those above it, if they are not there, and checks that it may be written into. With a message if
 * it is not fine. */
enum folder_trouble folder_prepare(const char *folder, struct message *message);

enum folder_answer {
  FOLDER_HAS_NOT,
  FOLDER_HAS,
  FOLDER_UNKNOWN /* it may not be looked into, and may hold anything */
};

/* Whether the folder holds a file of this name; with a message if that is unknown. */
enum folder_answer folder_find(const char *folder, const char *name, struct message *message);

/* The same, true if unknown: what may be there is neither passed over nor written over. */
bool folder_has(const char *folder, const char *name);

/* Keeps other processes that ask for this lock out of the folder, as long as the descriptor that is handed back stays
 * open. Below 0, with a message, if another one is in it or it cannot be opened. */
int folder_lock(const char *folder, struct message *message);

/* Writes path.part, syncs it, and renames it to path: path is at every moment either the old file or the new one.
 * False, with a message, on any failure; path is then untouched, and path.part gone. */
bool file_replace(const char *path, const void *data, size_t bytes, struct message *message);

#endif
