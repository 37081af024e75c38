/*
 * For the fuzzer: one reader for many inputs, instead of a process started afresh for each (src/files/apart.h), which
 * takes some 15 ms. It is a fork of the fuzzer, serves one connection after another, and closes between them what HDF5
 * has open. If it dies it is replaced; so it is after so many inputs, since HDF5 forgets memory. The fuzzer sees which
 * code the reader reaches: the counters of coverage are memory of both.
 *
 * Linked with -Wl,--wrap for the functions below.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/opening.h"
#include "files/checkpoint.h"
#include "files/frames_apart.h"
#include "files/hdf5.h"
#include "files/reader.h"
#include "oracle/pack.h"

#define MOST_SERVED 5000
#define SECONDS 2.0 /* of processor time for an input */

bool __wrap_apart_start(struct apart *parent, const char *path, const char *work, struct message *message);
void __wrap_apart_end(struct apart *parent);
int __wrap_apart_lost(struct apart *parent, struct message *message);
void __wrap_apart_shut(void);
void __wrap_apart_go_on(const struct apart *link);
void __real_apart_end(struct apart *parent);
int __real_apart_lost(struct apart *parent, struct message *message);

/* In a program without coverage there are none. */
extern char __start___sancov_cntrs[] __attribute__((weak)), __stop___sancov_cntrs[] __attribute__((weak));

static struct {
  pid_t process; /* 0: none */
  int control;   /* work is handed over here, each with a connection of its own */
  unsigned served;
} standing;

static void fail(const char *what)
{
  perror(what);
  abort();
}

/* --- the reader ------------------------------------------------------------------------------------------------------
 */

void __wrap_apart_shut(void)
{
}

void __wrap_apart_go_on(const struct apart *link)
{
  struct rusage used;
  struct rlimit limit;
  getrusage(RUSAGE_SELF, &used);
  getrlimit(RLIMIT_CPU, &limit);
  limit.rlim_cur = (rlim_t)((double)used.ru_utime.tv_sec + (double)used.ru_stime.tv_sec + link->seconds) + 2;
  setrlimit(RLIMIT_CPU, &limit);
}

/* Objects before the files that they are in: HDF5 keeps such a file open. What stays open, of a damaged file, ends this
 * process. */
static void close_everything(void)
{
  static const unsigned order[] = {H5F_OBJ_ALL & ~H5F_OBJ_FILE, H5F_OBJ_FILE};
  hid_t open[256];
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  for (size_t k = 0; k < sizeof order / sizeof *order; k++) {
    const ssize_t count = H5Fget_obj_ids(H5F_OBJ_ALL, order[k], sizeof open / sizeof *open, open);
    for (ssize_t i = 0; i < count; i++)
      h5_close(open[i]);
  }
  if (H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_ALL) != 0)
    _exit(0);
}

/* Says first that it is ready: nothing is handed over to a reader that dies of the input before. */
static bool receive(int control, struct apart_hello *hello, int *connection)
{
  if (send(control, "", 1, MSG_NOSIGNAL) != 1)
    return false;
  struct iovec part = {hello, sizeof *hello};
  union {
    char room[CMSG_SPACE(sizeof(int))];
    struct cmsghdr align;
  } aside;
  struct msghdr header = {
      .msg_iov = &part, .msg_iovlen = 1, .msg_control = aside.room, .msg_controllen = sizeof aside.room};
  if (recvmsg(control, &header, MSG_WAITALL) != (ssize_t)sizeof *hello || !CMSG_FIRSTHDR(&header))
    return false;
  memcpy(connection, CMSG_DATA(CMSG_FIRSTHDR(&header)), sizeof *connection);
  return true;
}

static void serve_for_ever(int control)
{
  static const struct apart_work works[] = {{"checkpoint", checkpoint_serve},
                                            {"frames", frames_serve},
                                            {"sort", sort_serve},
                                            {"pack", pack_serve},
                                            {NULL, NULL}};
  static const int plain[] = {SIGXCPU, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL, SIGPIPE, SIGALRM};
  static struct apart_hello hello;
  struct apart link = {.path = hello.path, .seconds = SECONDS};
  for (size_t k = 0; k < sizeof plain / sizeof *plain; k++)
    signal(plain[k], SIG_DFL);
  while (receive(control, &hello, &link.socket)) {
    const struct apart_work *work = works;
    link.broken = false;
    __wrap_apart_go_on(&link);
    while (work->name && strcmp(work->name, hello.work) != 0)
      work++;
    if (work->name)
      work->serve(&link);
    close(link.socket);
    close_everything();
  }
}

/* --- the fuzzer ------------------------------------------------------------------------------------------------------
 */

/* Whole pages of the counters become memory that a child shares. */
static void share_coverage(void)
{
  const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
  const uintptr_t first = ((uintptr_t)__start___sancov_cntrs + page - 1) / page * page;
  const uintptr_t end = (uintptr_t)__stop___sancov_cntrs / page * page;
  static bool shared;
  if (shared || end <= first)
    return;
  void *were = malloc(end - first);
  memcpy(were, (void *)first, end - first);
  if (mmap((void *)first, end - first, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0) ==
      MAP_FAILED)
    fail("mmap");
  memcpy((void *)first, were, end - first);
  free(were);
  shared = true;
}

static void leave(bool waited_for)
{
  close(standing.control);
  if (!waited_for)
    waitpid(standing.process, NULL, 0);
  standing.process = 0;
}

static void end(void)
{
  if (standing.process > 0)
    leave(false);
}

static void begin(void)
{
  int pair[2];
  share_coverage();
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
    fail("socketpair");
  standing.process = fork();
  if (standing.process < 0)
    fail("fork");
  if (standing.process == 0) {
    for (int fd = 3; fd < 256; fd++) /* connections of others would never end */
      if (fd != pair[1])
        close(fd);
    serve_for_ever(pair[1]);
    _exit(0);
  }
  close(pair[1]);
  if (standing.control == 0)
    atexit(end);
  standing.control = pair[0];
  standing.served = 0;
}

static bool hand_over(const struct apart_hello *hello, int connection)
{
  struct iovec part = {(void *)(uintptr_t)hello, sizeof *hello};
  char ready;
  if (recv(standing.control, &ready, 1, 0) != 1)
    return false;
  union {
    char room[CMSG_SPACE(sizeof(int))];
    struct cmsghdr align;
  } aside;
  struct msghdr header = {
      .msg_iov = &part, .msg_iovlen = 1, .msg_control = aside.room, .msg_controllen = sizeof aside.room};
  struct cmsghdr *c = CMSG_FIRSTHDR(&header);
  c->cmsg_level = SOL_SOCKET;
  c->cmsg_type = SCM_RIGHTS;
  c->cmsg_len = CMSG_LEN(sizeof connection);
  memcpy(CMSG_DATA(c), &connection, sizeof connection);
  return sendmsg(standing.control, &header, MSG_NOSIGNAL) == (ssize_t)sizeof *hello;
}

bool __wrap_apart_start(struct apart *parent, const char *path, const char *work, struct message *message)
{
  struct apart_hello hello = {.seconds = SECONDS};
  int pair[2];
  *parent = (struct apart){.path = path, .socket = -1, .broken = true};
  const int fd = open_regular(path, message);
  if (fd < 0)
    return false;
  close(fd);
  snprintf(hello.work, sizeof hello.work, "%s", work);
  snprintf(hello.path, sizeof hello.path, "%s", path);
  if (standing.process > 0 && ++standing.served > MOST_SERVED)
    leave(false);
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
    fail("socketpair");
  for (int try = 0; try < 2; try++) { /* it may have died when it closed the last file */
    if (standing.process == 0)
      begin();
    if (hand_over(&hello, pair[1]))
      break;
    leave(false);
  }
  close(pair[1]);
  *parent = (struct apart){
      .path = path, .socket = pair[0], .child = standing.process, .seconds = SECONDS, .patience = 10.0 * SECONDS};
  return true;
}

void __wrap_apart_end(struct apart *parent)
{
  parent->child = 0; /* it serves the next input */
  __real_apart_end(parent);
}

int __wrap_apart_lost(struct apart *parent, struct message *message)
{
  siginfo_t how = {.si_pid = 0};
  for (int k = 0; k < 200 && parent->child > 0 && how.si_pid == 0 && !parent->silent; k++) {
    waitid(P_PID, (id_t)parent->child, &how, WEXITED | WNOWAIT | WNOHANG);
    if (how.si_pid == 0)
      nanosleep(&(struct timespec){.tv_nsec = 5000000}, NULL);
  }
  const bool dead = how.si_pid != 0;
  if (!dead)
    parent->child = 0; /* it lives, and ended the connection: there is nothing to wait for */
  __real_apart_lost(parent, message);
  if (dead)
    leave(true);
  return 0;
}
