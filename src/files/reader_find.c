#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files/build_info.h"
#include "files/reader.h"

/* The path of the file, program or library, in which this function is: as the kernel has it, since what a library was
 * called when it was loaded may lead elsewhere by now. */
static bool own_file(char path[PATH_MAX])
{
  char line[PATH_MAX + 128];
  const uintptr_t here = (uintptr_t)&own_file;
  FILE *maps = fopen("/proc/self/maps", "r");
  bool found = false;
  while (maps && !found && fgets(line, sizeof line, maps)) {
    char *end, *slash = strchr(line, '/');
    const uintptr_t first = (uintptr_t)strtoull(line, &end, 16);
    const uintptr_t last = *end == '-' ? (uintptr_t)strtoull(end + 1, NULL, 16) : 0;
    if (here < first || here >= last || !slash)
      continue;
    slash[strcspn(slash, "\n")] = '\0';
    found = (size_t)snprintf(path, PATH_MAX, "%s", slash) < PATH_MAX;
  }
  if (maps)
    fclose(maps);
  return found;
}

/* True if this user may run it, and nobody put it there who could not have changed this program itself. */
static bool may_be_run(const char *path, uid_t owner)
{
  struct stat status;
  return path[0] == '/' && stat(path, &status) == 0 && S_ISREG(status.st_mode) && access(path, X_OK) == 0 &&
         (status.st_uid == 0 || status.st_uid == geteuid() || status.st_uid == owner);
}

bool reader_find(char *path, size_t size, struct message *message)
{
  static const char *const beside[] = {"/uncross", "/../bin/uncross", "/../../bin/uncross"};
  const char *named = getenv("UNCROSS_READER");
  char own[PATH_MAX] = "";
  struct stat status;
  const uid_t owner = own_file(own) && stat(own, &status) == 0 ? status.st_uid : 0;
  if (named && *named)
    return ((size_t)snprintf(path, size, "%s", named) < size && may_be_run(path, owner)) ||
           message_set(
               message,
               "UNCROSS_READER names %s, which cannot be had; allowed: the absolute path of the program uncross "
               "that belongs to root, to this user or to the owner of %s",
               named, own);
  char *slash = strrchr(own, '/');
  if (slash)
    *slash = '\0';
  for (size_t k = 0; slash && k < sizeof beside / sizeof *beside; k++)
    if ((size_t)snprintf(path, size, "%s%s", own, beside[k]) < size && may_be_run(path, owner))
      return true;
  const size_t length = strlen(own);
  if (length > 4 && strcmp(own + length - 4, "/lib") == 0 &&
      (size_t)snprintf(path, size, "%s/../uncross", own) < size && may_be_run(path, owner))
    return true;
  if ((size_t)snprintf(path, size, "%s/bin/uncross", build_info.prefix) < size && may_be_run(path, owner))
    return true;
  return message_set(message,
                     "HDF5 files are read by the program uncross in a process of its own, and there is none beside "
                     "this program (%s), in ../bin or in %s/bin; UNCROSS_READER=/PATH/uncross names it",
                     own, build_info.prefix);
}
