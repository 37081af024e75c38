/* The reader's own side: limits, and what it is asked for. */
#include "files/reader.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#define LEAST_MEMORY (1u << 30) /* bytes, besides what the program takes */
#define MEMORY_PER_BYTE 8       /* of the file: its numbers, some of them twice */

/* --- limits ------------------------------------------------------------------------------------------------------ */

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

/* --- signals ----------------------------------------------------------------------------------------------------- */

/* Each second: is the parent still there? A signal at its death (PR_SET_PDEATHSIG) would come when the thread ends that
 * started this process, which may be long before. */
static void look_for_parent(int number)
{
  struct pollfd end = {.fd = READER_SOCKET};
  const int before = errno;
  (void)number;
  if (poll(&end, 1, 0) > 0 && (end.revents & (POLLHUP | POLLERR | POLLNVAL)))
    _exit(1);
  alarm(1);
  errno = before;
}

/* A terminal sends its signals to both processes: the parent decides what they mean. What the host had blocked or
 * ignored is of no concern here. */
static void set_signals(void)
{
  static const int ignored[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2};
  static const int plain[] = {SIGXCPU, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGPIPE};
  const struct sigaction look = {.sa_handler = look_for_parent, .sa_flags = SA_RESTART};
  sigset_t none;
  for (size_t k = 0; k < sizeof ignored / sizeof *ignored; k++)
    signal(ignored[k], SIG_IGN);
  for (size_t k = 0; k < sizeof plain / sizeof *plain; k++)
    signal(plain[k], SIG_DFL);
  sigaction(SIGALRM, &look, NULL);
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, NULL);
  alarm(1);
}

/* What the host has open and did not keep from its children. */
static void close_others(void)
{
  DIR *folder = opendir("/proc/self/fd");
  const int own = folder ? dirfd(folder) : -1;
  for (struct dirent *entry = folder ? readdir(folder) : NULL; entry; entry = readdir(folder)) {
    const int fd = (int)strtol(entry->d_name, NULL, 10);
    if (fd > READER_SOCKET && fd != own)
      close(fd);
  }
  if (folder)
    closedir(folder);
}

/* --- work -------------------------------------------------------------------------------------------------------- */

static void serve(const struct apart_work *works)
{
  struct apart link = {.path = "", .socket = READER_SOCKET};
  struct apart_hello hello;
  char build[APART_BUILD];
  apart_build(build);
  if (!apart_put(&link, build, sizeof build) || !apart_get(&link, &hello, sizeof hello))
    return;
  hello.work[sizeof hello.work - 1] = hello.path[sizeof hello.path - 1] = '\0';
  link.path = hello.path;
  link.seconds = hello.seconds;
  limit_memory(hello.bytes);
  apart_go_on(&link);
  while (works->name && strcmp(works->name, hello.work) != 0)
    works++;
  if (works->name)
    works->serve(&link);
}

void reader_is_here(int count, char **words, const struct apart_work *works)
{
  char path[PATH_MAX];
  const struct rlimit no_core = {0, 0};
  if (count != 2 || strcmp(words[1], READER_ASKED) != 0) {
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path - 1);
    path[length > 0 ? length : 0] = '\0';
    if (length > 0)
      setenv("UNCROSS_READER", path, 1);
    return;
  }
  set_signals();
  close_others();
  setrlimit(RLIMIT_CORE, &no_core);
  serve(works);
  _exit(0);
}
