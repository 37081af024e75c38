/* Folders that runs write into, and files put in place as a whole. */
#ifndef UNCROSS_FOLDER_H
#define UNCROSS_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

#include "io/message.h"

/* Makes the folder and those above it, if they are not there, and checks that it may be written into. */
bool folder_make(const char *folder, struct message *message);

/* True if the folder holds a file of this name. */
bool folder_has(const char *folder, const char *name);

/* Keeps other processes that ask for this lock out of the folder, as long as the descriptor that is handed back stays
 * open. Below 0, with a message, if another one is in it or it cannot be opened. */
int folder_lock(const char *folder, struct message *message);

/* Writes path.part, syncs it, and renames it to path: path is at every moment either the old file or the new one.
 * False, with a message, on any failure; path is then untouched, and path.part gone. */
bool file_replace(const char *path, const void *data, size_t bytes, struct message *message);

#endif
