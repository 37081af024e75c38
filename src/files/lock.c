#include "files/lock.h"

#include <errno.h>
#include <sys/file.h>
#include <time.h>

#include "base/clock.h"

/* More signals do not come while one call is made; some file systems say EINTR whatever comes. */
#define MOST_INTERRUPTIONS 100

enum lock lock_take(int fd, bool alone)
{
  for (int k = 0; k < MOST_INTERRUPTIONS; k++)
    if (flock(fd, (alone ? LOCK_EX : LOCK_SH) | LOCK_NB) == 0)
      return LOCK_TAKEN;
    else if (errno != EINTR)
      return errno == EWOULDBLOCK ? LOCK_IN_USE : LOCK_NONE;
  return LOCK_NONE;
}

enum lock lock_wait(int fd, bool alone, double seconds)
{
  const double until = clock_seconds() + seconds;
  enum lock lock;
  while ((lock = lock_take(fd, alone)) == LOCK_IN_USE && clock_seconds() < until)
    nanosleep(&(struct timespec){.tv_nsec = 5000000}, NULL);
  return lock;
}

void lock_leave(int fd)
{
  flock(fd, LOCK_UN);
}
