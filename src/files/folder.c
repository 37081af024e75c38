#include "files/folder.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files/lock.h"

/* --- folders are made -------------------------------------------------------------------------------------------- */

static enum folder_trouble trouble_is(enum folder_trouble trouble, struct message *message, const char *path,
                                      const char *what)
{
  if (trouble == FOLDER_REFUSED)
    message_set(message, "%s: %s: %s", path, what, strerror(errno));
  else
    message_set(message, "%s: %s", path, what);
  return trouble;
}

/* Makes the entry of a file or folder last. It is there by now, whatever a file system makes of syncing a folder. */
static void sync_above(char *path)
{
  char *slash = strrchr(path, '/'), after = slash ? slash[1] : '\0';
  if (slash)
    slash[1] = '\0';
  int fd = open(slash ? path : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (slash)
    slash[1] = after;
  if (fd < 0)
    return;
  fsync(fd);
  close(fd);
}

/* Makes those that are missing; *made: bytes of the path above the first one of them, all if none is missing. */
static enum folder_trouble make_all(char *path, size_t *made, struct message *message)
{
  *made = strlen(path);
  for (char *p = path + 1;; p++) {
    if (*p != '/' && *p != '\0')
      continue;
    char rest = *p;
    *p = '\0';
    if (mkdir(path, 0777) == 0) {
      const char *above = strrchr(path, '/');
      const size_t there = above ? (size_t)(above - path) : 0;
      *made = there < *made ? there : *made;
      sync_above(path);
    } else if (errno != EEXIST) {
      return errno == ENOTDIR ? trouble_is(FOLDER_IS_NONE, message, path, "what is above it is not a folder")
                              : trouble_is(FOLDER_REFUSED, message, path, "cannot make this folder");
    }
    if (rest == '\0')
      return FOLDER_FINE;
    *p = rest;
  }
}

static enum folder_trouble look_at(const char *name, struct message *message)
{
  struct stat status;
  if (stat(name, &status) != 0)
    return trouble_is(FOLDER_REFUSED, message, name, "cannot find out what this is");
  if (!S_ISDIR(status.st_mode))
    return trouble_is(FOLDER_IS_NONE, message, name, "is not a folder");
  if (access(name, W_OK | X_OK) != 0)
    return trouble_is(FOLDER_REFUSED, message, name, "cannot write here");
  return FOLDER_FINE;
}

bool folder_name_fits(const char *name, struct message *message)
{
  const size_t length = strlen(name);
  if (length == 0)
    return message_set(message, "'%s': not the name of a folder", name);
  return length <= FOLDER_LONGEST_PATH ||
         message_set(message, "%.60s...: a path of %zu bytes; a run's folder may have one of at most %d", name, length,
                     FOLDER_LONGEST_PATH);
}

enum folder_trouble folder_prepare(const char *name, size_t *made, struct message *message)
{
  char path[FOLDER_LONGEST_PATH + 1];
  if (!folder_name_fits(name, message))
    return FOLDER_IS_NONE;
  snprintf(path, sizeof path, "%s", name);
  enum folder_trouble trouble = make_all(path, made, message);
  if (trouble == FOLDER_FINE)
    trouble = look_at(name, message);
  if (trouble != FOLDER_FINE)
    folder_unmake(name, *made);
  return trouble;
}

void folder_unmake(const char *name, size_t made)
{
  char path[FOLDER_LONGEST_PATH + 1];
  if (snprintf(path, sizeof path, "%s", name) >= (int)sizeof path)
    return;
  for (size_t length = strlen(path); length > made; length--)
    if (path[length] == '\0' || path[length] == '/') {
      path[length] = '\0';
      if (path[length - 1] != '/' && rmdir(path) != 0 && errno != ENOENT)
        return;
    }
}

/* --- the open folder --------------------------------------------------------------------------------------------- */

/* Locks of folders stay on one machine. A file system that knows none at all is no reason not to run. */
bool folder_lock(struct folder *folder, struct message *message)
{
  int fd = open(folder->name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0)
    return message_set(message, "%s: cannot open this folder: %s", folder->name, strerror(errno));
  const enum lock lock = lock_take(fd, true);
  if (lock == LOCK_IN_USE) {
    close(fd);
    return message_set(message, "%s: in use by another process, which writes into this folder", folder->name);
  }
  message_set(message, "%s", "");
  if (lock == LOCK_NONE)
    message_set(message,
                "%s: locks cannot be had here (%s): see to it yourself that no other process writes into this folder",
                folder->name, strerror(errno));
  folder->fd = fd;
  return true;
}

bool folder_in_use(const char *name)
{
  const int fd = open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const enum lock lock = fd >= 0 ? lock_take(fd, false) : LOCK_NONE;
  if (lock == LOCK_TAKEN)
    lock_leave(fd);
  if (fd >= 0)
    close(fd);
  return lock == LOCK_IN_USE;
}

void folder_close(struct folder *folder)
{
  if (folder->fd >= 0) {
    lock_leave(folder->fd); /* of which a child may have a copy */
    close(folder->fd);
  }
  folder->fd = FOLDER_BY_NAME;
}

static bool same_file(const struct stat *a, const struct stat *b)
{
  return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

bool folder_in_place(const struct folder *folder, struct message *message)
{
  struct stat named, ours;
  return folder->fd < 0 ||
         (stat(folder->name, &named) == 0 && fstat(folder->fd, &ours) == 0 && same_file(&named, &ours)) ||
         message_set(message, "%s: this name no longer leads to the folder that was locked (it was moved, or replaced)",
                     folder->name);
}

/* --- its files --------------------------------------------------------------------------------------------------- */

bool folder_path(const struct folder *folder, const char *file, char *path, size_t size)
{
  return (size_t)snprintf(path, size, "%s%s%s", folder->name, folder->name[0] ? "/" : "", file) < size;
}

#define PATH_SIZE 4096

/* What the calls of the system take: a descriptor, and a name relative to it. */
struct at {
  int fd;
  const char *name; /* NULL: too long, errno says so */
  char path[PATH_SIZE];
};

static const struct at *locate(const struct folder *folder, const char *file, struct at *at)
{
  at->fd = folder->fd < 0 ? AT_FDCWD : folder->fd;
  at->name = folder->fd >= 0 ? file : folder_path(folder, file, at->path, sizeof at->path) ? at->path : NULL;
  if (!at->name)
    errno = ENAMETOOLONG;
  return at;
}

/* The file itself, not what a link leads to. */
static bool status_of(const struct folder *folder, const char *file, struct stat *status)
{
  struct at at;
  locate(folder, file, &at);
  return at.name && fstatat(at.fd, at.name, status, AT_SYMLINK_NOFOLLOW) == 0;
}

enum folder_answer folder_find(const struct folder *folder, const char *file, struct message *message)
{
  struct stat status;
  if (status_of(folder, file, &status))
    return FOLDER_HAS;
  if (errno == ENOENT || errno == ENOTDIR)
    return FOLDER_HAS_NOT;
  message_set(message, "%s/%s: cannot find out whether it is there: %s", folder->name, file, strerror(errno));
  return FOLDER_UNKNOWN;
}

bool folder_has(const struct folder *folder, const char *file)
{
  struct message ignored;
  return folder_find(folder, file, &ignored) != FOLDER_HAS_NOT;
}

bool folder_holds(const struct folder *folder, const char *file, int fd, struct message *message)
{
  struct stat named, opened;
  if (!status_of(folder, file, &named) || fstat(fd, &opened) != 0)
    return message_set(message, "%s/%s: cannot find out what was opened: %s", folder->name, file, strerror(errno));
  if (S_ISLNK(named.st_mode))
    return message_set(message, "%s/%s: is a link; files of a run are not", folder->name, file);
  return same_file(&named, &opened) ||
         message_set(message, "%s/%s: another file was opened than the one in the locked folder", folder->name, file);
}

/* A pipe must not make the program wait: O_NONBLOCK, which changes nothing for a regular file. */
int folder_open_file(const struct folder *folder, const char *file, int flags)
{
  struct at at;
  struct stat status;
  locate(folder, file, &at);
  const int fd = at.name ? openat(at.fd, at.name, flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666) : -1;
  if (fd < 0 || (fstat(fd, &status) == 0 && S_ISREG(status.st_mode)))
    return fd;
  close(fd);
  errno = S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
  return -1;
}

bool folder_rename(const struct folder *folder, const char *from, const char *to)
{
  struct at old, new;
  locate(folder, from, &old);
  locate(folder, to, &new);
  return old.name && new.name &&renameat(old.fd, old.name, new.fd, new.name) == 0;
}

bool folder_remove(const struct folder *folder, const char *file)
{
  struct at at;
  locate(folder, file, &at);
  return at.name && unlinkat(at.fd, at.name, 0) == 0;
}

/* --- files put in place ------------------------------------------------------------------------------------------ */

/* What a killed run left under this name, or somebody's link, is removed, never opened. */
static int create_part(const struct folder *folder, const char *part)
{
  const int how = O_WRONLY | O_CREAT | O_EXCL;
  const int fd = folder_open_file(folder, part, how);
  return fd >= 0 || errno != EEXIST || !folder_remove(folder, part) ? fd : folder_open_file(folder, part, how);
}

bool folder_has_place(const struct folder *folder, const char *file, struct message *message)
{
  struct stat status;
  return !status_of(folder, file, &status) || S_ISREG(status.st_mode) ||
         message_set(message, "%s%s%s: is a link, a folder, a pipe or a device; nothing is put in its place",
                     folder->name, folder->name[0] ? "/" : "", file);
}

/* Writes all and waits until it is on the disk; false with errno set. */
static bool write_through(const struct folder *folder, const char *part, const char *data, size_t bytes)
{
  int fd = create_part(folder, part);
  if (fd < 0)
    return false;
  errno = 0;
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

static void sync_folder_of(const struct folder *folder, const char *file)
{
  char path[PATH_SIZE];
  if (folder->fd >= 0)
    fsync(folder->fd);
  else if (folder_path(folder, file, path, sizeof path))
    sync_above(path);
}

bool file_replace(const struct folder *folder, const char *file, const void *data, size_t bytes,
                  struct message *message)
{
  char part[PATH_SIZE], path[PATH_SIZE];
  if ((size_t)snprintf(part, sizeof part, "%s.part", file) >= sizeof part ||
      !folder_path(folder, file, path, sizeof path))
    return message_set(message, "%.200s...: path too long", file);
  if (!folder_has_place(folder, file, message))
    return false;
  if (!write_through(folder, part, data, bytes) || !folder_rename(folder, part, file)) {
    message_set(message, "%s: cannot write it (%zu bytes): %s; an earlier one is untouched", path, bytes,
                strerror(errno));
    folder_remove(folder, part);
    return false;
  }
  sync_folder_of(folder, file);
  return true;
}
