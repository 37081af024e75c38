#define _GNU_SOURCE /* posix_spawn_file_actions_addclosefrom_np. NOLINT(bugprone-reserved-identifier) */
#include "files/apart.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/opening.h"
#include "files/build_info.h"
#include "files/reader.h"
#include "version.h"

#define LEAST_SECONDS 60.0    /* of processor time, for a small file */
#define BYTES_PER_SECOND 20e6 /* slower than any machine reads and checks */
#define PATIENCE 10.0         /* times as long by the clock: the machine may be busy, the disk slow */

extern char **environ;

/* --- the parent -------------------------------------------------------------------------------------------------- */

static bool regular_size(const char *path, uint64_t *bytes, struct message *message)
{
  const int fd = open_regular(path, message);
  if (fd < 0)
    return false;
  struct stat status = {0};
  const bool known = fstat(fd, &status) == 0;
  close(fd);
  *bytes = (uint64_t)status.st_size;
  return known || message_set(message, "%s: cannot be read: %s", path, strerror(errno));
}

void apart_build(char build[APART_BUILD])
{
  memset(build, 0, APART_BUILD);
  snprintf(build, APART_BUILD, "uncross %s %s", UNCROSS_VERSION, build_info.commit);
}

/* What the host has open and did not keep from its children would hold its locks until the reader closes it. Older C
 * libraries cannot say this; there the reader closes all, once it is loaded. */
static int close_others(posix_spawn_file_actions_t *files)
{
#ifdef __GLIBC__
#if __GLIBC_PREREQ(2, 34)
  return posix_spawn_file_actions_addclosefrom_np(files, READER_SOCKET + 1);
#endif
#endif
  (void)files;
  return 0;
}

/* Starts the program at the other end of the socket, which it has as READER_SOCKET; 0, or errno. It has no standard
 * streams: of some damages HDF5 tells standard error before it aborts, and the parent says it in one sentence. */
static int spawn(const char *program, int socket, pid_t *child)
{
  char word[] = READER_ASKED;
  char *const words[] = {(char *)(uintptr_t)program, word, NULL};
  posix_spawn_file_actions_t files;
  int code = posix_spawn_file_actions_init(&files);
  if (code != 0)
    return code;
  code = posix_spawn_file_actions_adddup2(&files, socket, READER_SOCKET);
  if (code == 0)
    code = close_others(&files); /* before anything else */
  for (int fd = 0; code == 0 && fd < READER_SOCKET; fd++)
    code = posix_spawn_file_actions_addopen(&files, fd, "/dev/null", O_RDWR, 0);
  if (code == 0)
    code = posix_spawn(child, program, &files, NULL, words, environ);
  posix_spawn_file_actions_destroy(&files);
  return code;
}

/* Waits for the child, which a host may have done already. */
static pid_t wait_for(pid_t child, int *status, int how)
{
  pid_t found;
  do
    found = waitpid(child, status, how);
  while (found < 0 && errno == EINTR);
  return found;
}

/* The program has not said what it is: of the file nothing was read yet. */
static bool never_began(struct apart *parent, const char *program, struct message *message)
{
  int status = 0;
  if (parent->silent)
    return message_set(message, "%s: cannot be read: %s, the program that is to do it, does not answer", parent->path,
                       program);
  bool known = false; /* it closed the socket as it ended, or goes on without it */
  for (int k = 0; k < 100 && !known; k++, nanosleep(&(struct timespec){.tv_nsec = 10000000}, NULL))
    known = wait_for(parent->child, &status, WNOHANG) == parent->child;
  if (known)
    parent->child = 0;
  return message_set(message, "%s: cannot be read: %s, the program that is to do it, ended before it began: %s",
                     parent->path, program,
                     known && WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "it is no uncross, or cannot start");
}

/* What the other side is must be known before anything is sent, or understood. */
static bool greet(struct apart *parent, const char *program, const char *work, uint64_t bytes, struct message *message)
{
  char ours[APART_BUILD], theirs[APART_BUILD] = "";
  struct apart_hello hello = {.seconds = parent->seconds, .bytes = bytes};
  snprintf(hello.work, sizeof hello.work, "%s", work);
  snprintf(hello.path, sizeof hello.path, "%s", parent->path);
  apart_build(ours);
  if (!apart_get(parent, theirs, sizeof theirs))
    return never_began(parent, program, message);
  if (memcmp(ours, theirs, sizeof ours) == 0)
    return apart_put(parent, &hello, sizeof hello) || apart_lost(parent, message);
  return message_set(message, "%s: cannot be read: %s, the program that is to do it, is not of this build (%s)",
                     parent->path, program, ours);
}

bool apart_start(struct apart *parent, const char *path, const char *work, struct message *message)
{
  uint64_t bytes = 0;
  int pair[2];
  char program[PATH_MAX];
  struct message why;
  *parent = (struct apart){.path = path, .socket = -1, .broken = true};
  if (!regular_size(path, &bytes, message))
    return false;
  if (!reader_find(program, sizeof program, &why))
    return message_set(message, "%s: cannot be read: %s", path, why.text);
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
    return message_set(message, "%s: no connection to a process that reads it: %s", path, strerror(errno));
  const double seconds = LEAST_SECONDS + (double)bytes / BYTES_PER_SECOND;
  pid_t child = 0;
  const int code = spawn(program, pair[1], &child);
  close(pair[1]);
  if (code != 0) {
    close(pair[0]);
    return message_set(message, "%s: no process to read it (%s): %s", path, program, strerror(code));
  }
  *parent = (struct apart){
      .path = path, .socket = pair[0], .child = child, .seconds = seconds, .patience = PATIENCE * seconds};
  if (greet(parent, program, work, bytes, message))
    return true;
  apart_end(parent);
  return false;
}

void apart_end(struct apart *parent)
{
  int status;
  if (parent->socket >= 0)
    close(parent->socket);
  if (parent->child > 0 && wait_for(parent->child, &status, WNOHANG) == 0) {
    kill(parent->child, SIGKILL); /* it has nothing to tidy up */
    wait_for(parent->child, &status, 0);
  }
  *parent = (struct apart){.path = parent->path, .socket = -1, .broken = true};
}

int apart_lost(struct apart *parent, struct message *message)
{
  int status = 0;
  if (parent->silent)
    return message_set(message, "%s: the process that reads it does not answer", parent->path);
  const bool known = parent->child > 0 && wait_for(parent->child, &status, 0) == parent->child;
  if (known)
    parent->child = 0;
  if (known && WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
    return message_set(message, "%s: the process that read it was killed (memory?)", parent->path);
  parent->died = known && WIFSIGNALED(status);
  if (known && WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return message_set(message, "%s: damaged: HDF5 does not come to an end with it", parent->path);
  if (known && WIFSIGNALED(status))
    return message_set(message, "%s: damaged: HDF5 dies of it (%s)", parent->path, strsignal(WTERMSIG(status)));
  return message_set(message, "%s: the process that read it ended early", parent->path);
}

/* --- between them ------------------------------------------------------------------------------------------------ */

/* How many bytes a call that returned n has moved. A call that a signal ended has moved none, and is made again. */
static size_t moved(struct apart *link, ssize_t n)
{
  link->broken = n == 0 || (n < 0 && errno != EINTR);
  return n > 0 ? (size_t)n : 0;
}

bool apart_put(struct apart *link, const void *data, size_t bytes)
{
  for (size_t done = 0; !link->broken && done < bytes;)
    done += moved(link, send(link->socket, (const char *)data + done, bytes - done, MSG_NOSIGNAL));
  return !link->broken;
}

/* A parent's patience has an end, by the clock; a child waits as long as its parent lives. */
static bool bytes_come(struct apart *link)
{
  struct pollfd end = {.fd = link->socket, .events = POLLIN};
  const double until = clock_seconds() + link->patience;
  double left = link->patience;
  while (link->child > 0 && left > 0.0 && poll(&end, 1, (int)fmin(1e3 * left + 1.0, 1e6)) <= 0)
    left = until - clock_seconds();
  link->silent = link->child > 0 && left <= 0.0;
  link->broken = link->silent;
  return !link->broken;
}

bool apart_get(struct apart *link, void *data, size_t bytes)
{
  for (size_t done = 0; !link->broken && done < bytes && bytes_come(link);)
    done += moved(link, recv(link->socket, (char *)data + done, bytes - done, 0));
  return !link->broken;
}

bool apart_put_text(struct apart *link, const char *text)
{
  const uint64_t length = text ? strlen(text) : UINT64_MAX;
  return apart_put(link, &length, sizeof length) && (!text || apart_put(link, text, strlen(text)));
}

bool apart_get_text(struct apart *link, size_t most, char **text)
{
  uint64_t length;
  *text = NULL;
  if (!apart_get(link, &length, sizeof length))
    return false;
  if (length == UINT64_MAX)
    return true;
  char *room = length <= most ? malloc((size_t)length + 1) : NULL;
  if (!room || !apart_get(link, room, (size_t)length)) {
    free(room);
    return false;
  }
  room[length] = '\0';
  *text = room;
  return true;
}

void apart_put_verdict(struct apart *link, int verdict, const struct message *message)
{
  const int32_t number = verdict;
  if (apart_put(link, &number, sizeof number) && verdict != 0)
    apart_put(link, message, sizeof *message);
}

int apart_get_verdict(struct apart *parent, struct message *message)
{
  int32_t number = -1;
  if (apart_get(parent, &number, sizeof number) && (number == 0 || apart_get(parent, message, sizeof *message))) {
    message->text[sizeof message->text - 1] = '\0';
    return number;
  }
  apart_lost(parent, message);
  return -1;
}
