#include "files/apart.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define LEAST_SECONDS 60.0      /* of processor time, for a small file */
#define BYTES_PER_SECOND 20e6   /* slower than any machine reads and checks */
#define LEAST_MEMORY (1u << 30) /* bytes, besides what the parent has */
#define MEMORY_PER_BYTE 8       /* of the file: its numbers, some of them twice */

/* --- the child --------------------------------------------------------------------------------------------------- */

/* Bytes of address space in use, 0 if that is unknown. */
static uint64_t address_space(void)
{
  char line[64] = "";
  FILE *file = fopen("/proc/self/statm", "r");
  if (!file)
    return 0;
  const uint64_t pages = fgets(line, sizeof line, file) ? strtoull(line, NULL, 10) : 0;
  fclose(file);
  return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

static void lower(int resource, uint64_t value)
{
  struct rlimit limit;
  if (getrlimit(resource, &limit) == 0 && (limit.rlim_cur == RLIM_INFINITY || value < limit.rlim_cur)) {
    limit.rlim_cur = (rlim_t)value;
    setrlimit(resource, &limit);
  }
}

static void limit_memory(uint64_t file_bytes)
{
  const uint64_t used = address_space();
  if (used > 0 && file_bytes < UINT64_MAX / MEMORY_PER_BYTE / 2)
    lower(RLIMIT_AS, used + LEAST_MEMORY + MEMORY_PER_BYTE * file_bytes);
}

/* A terminal sends its signals to both processes: the parent decides what they mean. */
static void keep_signals_away(void)
{
  static const int ignored[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2};
  static const int plain[] = {SIGXCPU, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGPIPE};
  for (size_t k = 0; k < sizeof ignored / sizeof *ignored; k++)
    signal(ignored[k], SIG_IGN);
  for (size_t k = 0; k < sizeof plain / sizeof *plain; k++)
    signal(plain[k], SIG_DFL);
}

void apart_shut(void)
{
  lower(RLIMIT_NOFILE, 0);
}

void apart_go_on(const struct apart *link)
{
  struct rusage used;
  struct rlimit limit;
  if (getrusage(RUSAGE_SELF, &used) != 0 || getrlimit(RLIMIT_CPU, &limit) != 0)
    return;
  const double spent = (double)used.ru_utime.tv_sec + (double)used.ru_stime.tv_sec;
  const rlim_t end = (rlim_t)(spent + link->seconds) + 2;
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY || end < limit.rlim_max ? end : limit.rlim_max;
  setrlimit(RLIMIT_CPU, &limit);
}

/* HDF5 writes of some damages to standard error before it aborts; the parent says it in one sentence. */
static void hush(void)
{
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0)
    dup2(nowhere, STDERR_FILENO);
  if (nowhere > STDERR_FILENO)
    close(nowhere);
}

static void be_child(struct apart *link, uint64_t file_bytes, void (*work)(struct apart *, void *), void *context)
{
  keep_signals_away();
  hush();
  const struct rlimit no_core = {0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  limit_memory(file_bytes);
  apart_go_on(link);
  work(link, context);
  _exit(0);
}

/* --- the parent -------------------------------------------------------------------------------------------------- */

int open_regular(const char *path, struct message *message)
{
  struct stat status;
  const int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (fd < 0) {
    message_set(message, "%s: cannot be opened for reading: %s", path, strerror(errno));
    return -1;
  }
  if (fstat(fd, &status) == 0 && S_ISREG(status.st_mode))
    return fd;
  close(fd);
  message_set(message, "%s: not a file but a folder, a pipe or a device", path);
  return -1;
}

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

bool apart_start(struct apart *parent, const char *path, void (*work)(struct apart *link, void *context), void *context,
                 struct message *message)
{
  uint64_t bytes = 0;
  int pair[2];
  *parent = (struct apart){.path = path, .socket = -1, .broken = true};
  if (!regular_size(path, &bytes, message))
    return false;
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
    return message_set(message, "%s: no connection to a process that reads it: %s", path, strerror(errno));
  const double seconds = LEAST_SECONDS + (double)bytes / BYTES_PER_SECOND;
  const pid_t child = fork();
  if (child == 0) {
    close(pair[0]);
    be_child(&(struct apart){.path = path, .socket = pair[1], .seconds = seconds}, bytes, work, context);
  }
  const int why = errno;
  close(pair[1]);
  if (child < 0) {
    close(pair[0]);
    return message_set(message, "%s: no process to read it: %s", path, strerror(why));
  }
  *parent = (struct apart){.path = path, .socket = pair[0], .child = child, .seconds = seconds};
  return true;
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

bool apart_get(struct apart *link, void *data, size_t bytes)
{
  for (size_t done = 0; !link->broken && done < bytes;)
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
    apart_put(link, message->text, sizeof message->text);
}

int apart_get_verdict(struct apart *parent, struct message *message)
{
  int32_t number;
  if (apart_get(parent, &number, sizeof number) &&
      (number == 0 || apart_get(parent, message->text, sizeof message->text))) {
    message->text[sizeof message->text - 1] = '\0';
    return number;
  }
  apart_lost(parent, message);
  return -1;
}
