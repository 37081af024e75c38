#include "files/lock.h"

#include <errno.h>
#include <sys/file.h>

enum lock lock_take(int fd, bool alone)
{
  while (flock(fd, (alone ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0)
    if (errno != EINTR)
      return errno == EWOULDBLOCK ? LOCK_IN_USE : LOCK_NONE;
  return LOCK_TAKEN;
}

void lock_leave(int fd)
{
  flock(fd, LOCK_UN);
}
