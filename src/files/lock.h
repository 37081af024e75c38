/*
 * Locks of files and folders (flock), by which processes of this program keep out of each other's way. HDF5's own locks
 * are off for our files (h5_open): it takes a file system without locks for a damaged file.
 *
 * A lock is advice: it binds those who ask for it. Some file systems have none (EOPNOTSUPP, ENOSYS, EINVAL), or a
 * server that has none to give (ENOLCK). Work goes on there without, as nothing is damaged by it; whoever waits for the
 * lock is told.
 */
#ifndef UNCROSS_FILES_LOCK_H
#define UNCROSS_FILES_LOCK_H

#include <stdbool.h>

enum lock {
  LOCK_TAKEN,
  LOCK_IN_USE, /* another process has it */
  LOCK_NONE    /* there are no locks here: errno says why */
};

/* Asks once for the lock of an open file or folder; it lasts until lock_leave, or until the last copy of fd is closed.
 * A child that was forked meanwhile has a copy, so whoever closes fd leaves the lock first; no child does that. alone:
 * no other process may have it; else all of them may share it. */
enum lock lock_take(int fd, bool alone);

/* Asks again and again for so many seconds, as long as another process has it. */
enum lock lock_wait(int fd, bool alone, double seconds);
void lock_leave(int fd);

#endif
