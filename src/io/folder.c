#include "io/folder.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool folder_make(const char *folder, struct message *message)
{
  char path[4096];
  if (snprintf(path, sizeof path, "%s", folder) >= (int)sizeof path || path[0] == '\0')
    return message_set(message, "'%s': not the name of a folder", folder);
  for (char *p = path + 1;; p++) {
    if (*p != '/' && *p != '\0')
      continue;
    char rest = *p;
    *p = '\0';
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
      return message_set(message, "%s: cannot make this folder: %s", path, strerror(errno));
    if (rest == '\0')
      break;
    *p = rest;
  }
  struct stat status;
  if (stat(folder, &status) != 0 || !S_ISDIR(status.st_mode))
    return message_set(message, "%s: is not a folder", folder);
  return access(folder, W_OK | X_OK) == 0 || message_set(message, "%s: cannot write here: %s", folder, strerror(errno));
}

bool folder_has(const char *folder, const char *name)
{
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return access(path, F_OK) == 0;
}
