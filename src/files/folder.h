/*
 * Folders that runs write into, and files put in place as a whole.
 *
 * A run opens its folder once and locks it. From then on it names its files relative to the descriptor, so that all of
 * them go into the locked folder even if its name leads elsewhere by now. No link is followed within a folder.
 */
#ifndef UNCROSS_FILES_FOLDER_H
#define UNCROSS_FILES_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

#include "base/message.h"

#define FOLDER_BY_NAME (-1)
#define FOLDER_LONGEST_PATH 4000 /* bytes: with the name of a file, a path of at most 4095 (PATH_MAX of Linux) */

struct folder {
  const char *name; /* as the user gave it; "": names of files are paths of their own */
  int fd;           /* of the open and locked folder; FOLDER_BY_NAME: not open, files are found by the folder's name */
};

enum folder_trouble {
  FOLDER_FINE,
  FOLDER_IS_NONE, /* the path is not a folder and cannot become one: bad input */
  FOLDER_REFUSED  /* by the system: no permission, no room, ... */
};

/* False, with a message, if the name is empty, or so long that files could not be found by it. */
bool folder_name_fits(const char *name, struct message *message);

/* Makes the folder and those above it, if they are not there, and checks that it may be written into. made: length of
 * the part of the name that was there already, for folder_unmake. With a message if it is not fine; nothing is made
 * then. */
enum folder_trouble folder_prepare(const char *name, size_t *made, struct message *message);

/* Removes the folders that folder_prepare made, those that are empty. */
void folder_unmake(const char *name, size_t made);

/* Opens the folder, and keeps other processes that ask for this lock out of it as long as the descriptor stays open.
 * False, with a message, if another one is in it or it cannot be opened. After a success the message is empty, or says
 * that there are no locks here (lock.h). */
bool folder_lock(struct folder *folder, struct message *message);

/* True if another process has the lock of this folder: it writes into it. */
bool folder_in_use(const char *name);

/* Closes the folder, and so unlocks it. */
void folder_close(struct folder *folder);

/* True if the folder's name still leads to the open folder; else with a message. True if it is not open. */
bool folder_in_place(const struct folder *folder, struct message *message);

enum folder_answer {
  FOLDER_HAS_NOT,
  FOLDER_HAS,    /* a link counts, wherever it leads */
  FOLDER_UNKNOWN /* no permission to look into it: it may hold anything */
};

/* Whether the folder holds a file of this name; with a message if that is unknown. */
enum folder_answer folder_find(const struct folder *folder, const char *file, struct message *message);

/* The same, but true if unknown: a file that may be there must not be overwritten. */
bool folder_has(const struct folder *folder, const char *file);

/* True if the folder's file of this name is what the descriptor is open on, and no link; else with a message. For files
 * that a library opened by their path. */
bool folder_holds(const struct folder *folder, const char *file, int fd, struct message *message);

/* The path of a file, for messages and for libraries. False if it does not fit. */
bool folder_path(const struct folder *folder, const char *file, char *path, size_t size);

/* Opens a regular file of the folder; flags: as of open, O_CREAT makes a file with mode 0666. Below 0, with errno. */
int folder_open_file(const struct folder *folder, const char *file, int flags);

/* As rename and unlink, within the folder. */
bool folder_rename(const struct folder *folder, const char *from, const char *to);
bool folder_remove(const struct folder *folder, const char *file);

/* True if a file may be put there: nothing is there yet, or a file. Else with a message. */
bool folder_has_place(const struct folder *folder, const char *file, struct message *message);

/* Writes file.part, syncs it, and renames it to `file`: that is at every moment either the old file or the new one.
 * False, with a message, on any failure, and if `file` is there and is no file; `file` is then untouched, and file.part
 * gone. A file.part of before, be it a link, is removed: where others have files, ask folder_find. */
bool file_replace(const struct folder *folder, const char *file, const void *data, size_t bytes,
                  struct message *message);

#endif
