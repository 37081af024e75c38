#include "io/folder.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static enum folder_trouble trouble_is(enum folder_trouble trouble, struct message *message, const char *path,
                                      const char *what)
{
  if (trouble == FOLDER_REFUSED)
    message_set(message, "%s: %s: %s", path, what, strerror(errno));
  else
    message_set(message, "%s: %s", path, what);
  return trouble;
}

enum folder_trouble folder_prepare(const char *folder, struct message *message)
{
  char path[4096];
  if (snprintf(path, sizeof path, "%s", folder) >= (int)sizeof path || path[0] == '\0') {
    message_set(message, "'%s': not the name of a folder", folder);
    return FOLDER_IS_NONE;
  }
  for (char *p = path + 1;; p++) {
    if (*p != '/' && *p != '\0')
      continue;
    char rest = *p;
    *p = '\0';
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
      return errno == ENOTDIR ? trouble_is(FOLDER_IS_NONE, message, path, "what is above it is not a folder")
                              : trouble_is(FOLDER_REFUSED, message, path, "cannot make this folder");
    if (rest == '\0')
      break;
    *p = rest;
  }
  struct stat status;
  if (stat(folder, &status) != 0)
    return trouble_is(FOLDER_REFUSED, message, folder, "cannot find out what this is");
  if (!S_ISDIR(status.st_mode))
    return trouble_is(FOLDER_IS_NONE, message, folder, "is not a folder");
  if (access(folder, W_OK | X_OK) != 0)
    return trouble_is(FOLDER_REFUSED, message, folder, "cannot write here");
  return FOLDER_FINE;
}

enum folder_answer folder_find(const char *folder, const char *name, struct message *message)
{
  char path[4096];
  const bool fits = snprintf(path, sizeof path, "%s/%s", folder, name) < (int)sizeof path;
  if (fits && access(path, F_OK) == 0)
    return FOLDER_HAS;
  if (fits && (errno == ENOENT || errno == ENOTDIR))
    return FOLDER_HAS_NOT;
  message_set(message, "%s/%s: cannot find out whether it is there: %s", folder, name,
              fits ? strerror(errno) : "path too long");
  return FOLDER_UNKNOWN;
}

bool folder_has(const char *folder, const char *name)
{
  struct message ignored;
  return folder_find(folder, name, &ignored) != FOLDER_HAS_NOT;
}

/* Locks of folders stay on one machine. A file system that knows none at all is no reason not to run. */
int folder_lock(const char *folder, struct message *message)
{
  int fd = open(folder, O_RDONLY | O_CLOEXEC);
  if (fd < 0) {
    message_set(message, "%s: cannot open this folder: %s", folder, strerror(errno));
  } else if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    message_set(message, "%s: in use by another process, which writes into this folder", folder);
    close(fd);
    fd = -1;
  }
  return fd;
}

/* --- files put in place ------------------------------------------------------------------------------------------ */

/* Writes all and waits until it is on the disk; false with errno set. */
static bool write_through(const char *path, const char *data, size_t bytes)
{
  int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (fd < 0)
    return false;
  size_t done = 0;
  while (done < bytes) {
    ssize_t n = write(fd, data + done, bytes - done);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      break;
    done += (size_t)n;
  }
  bool ok = done == bytes && fsync(fd) == 0;
  int error = errno;
  ok &= close(fd) == 0;
  if (done < bytes)
    errno = error ? error : ENOSPC;
  return ok;
}

/* Makes the rename last. The new file is in place by now, whatever a file system makes of syncing a folder. */
static void sync_folder_of(const char *path)
{
  char folder[4096];
  const char *slash = strrchr(path, '/');
  snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 1, slash ? path : ".");
  int fd = open(folder, O_RDONLY);
  if (fd < 0)
    return;
  fsync(fd);
  close(fd);
}

bool file_replace(const char *path, const void *data, size_t bytes, struct message *message)
{
  char part[4096];
  if ((size_t)snprintf(part, sizeof part, "%s.part", path) >= sizeof part)
    return message_set(message, "%.200s...: path too long", path);
  errno = 0;
  if (!write_through(part, data, bytes) || rename(part, path) != 0) {
    message_set(message, "%s: cannot write it (%zu bytes): %s; an earlier one is untouched", path, bytes,
                strerror(errno));
    unlink(part);
    return false;
  }
  sync_folder_of(path);
  return true;
}
