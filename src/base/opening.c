#include "base/opening.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int open_regular(const char *path, struct message *message)
{
  struct stat status;
  const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (fd < 0) {
    message_unread(message, "%s: cannot be opened for reading: %s", path, strerror(errno));
    return -1;
  }
  if (fstat(fd, &status) == 0 && S_ISREG(status.st_mode))
    return fd;
  close(fd);
  message_unread(message, "%s: not a file but a folder, a pipe or a device", path);
  return -1;
}

FILE *open_input(const char *path, uint64_t *bytes, struct message *message)
{
  struct stat status;
  const int fd = open_regular(path, message);
  if (fd < 0)
    return NULL;
  FILE *file = fstat(fd, &status) == 0 ? fdopen(fd, "rb") : NULL;
  if (!file) {
    close(fd);
    message_unread(message, "%s: cannot be opened for reading: %s", path, strerror(errno));
    return NULL;
  }
  *bytes = (uint64_t)status.st_size;
  return file;
}
