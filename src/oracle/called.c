#include "oracle/called.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* --- what the port is given -------------------------------------------------------------------------------------- */

static bool has_inputs(const struct pack *pack, const struct pack_place *place)
{
  for (size_t k = 0; k < pack->count; k++)
    if (strncmp(pack->table[k].name, "in.", 3) == 0 && pack->table[k].place.step == place->step &&
        strcmp(pack->table[k].place.operator_name, place->operator_name) == 0)
      return true;
  return false;
}

void called_ask(struct pack *pack)
{
  for (size_t k = 0; k < pack->count && !pack->failed; k++) {
    const struct pack_place place = pack->table[k].place;
    int64_t *step = has_inputs(pack, &place) ? NULL : pack_put_integers(pack, &place, "in.step", "step", 1);
    if (step)
      *step = (int64_t)place.step;
  }
}

bool called_give(const struct check_options *o, const struct pack *pack, const char *path, struct message *message)
{
  FILE *out = fopen(path, "wbx");
  if (!out)
    return message_set(message, "%s: cannot create: %s", path, strerror(errno));
  struct pack inputs = {0, malloc((pack->count + 1) * sizeof *inputs.table), false};
  for (size_t k = 0; inputs.table && k < pack->count; k++)
    if (strncmp(pack->table[k].name, "in.", 3) == 0)
      inputs.table[inputs.count++] = pack->table[k]; /* its numbers stay the pack's */
  bool ok = inputs.table && (o->text ? pack_dump(&inputs, true, out) : pack_write(&inputs, out, path, message));
  free(inputs.table);
  ok = fclose(out) == 0 && ok;
  return ok || message_set(message, "%s: cannot write", path);
}

/* --- calls ------------------------------------------------------------------------------------------------------- */

/* A port that computes in a group of its own is out of reach of the keyboard: its interrupts come by way of us. */
static const int interrupts[] = {SIGINT, SIGTERM, SIGHUP};

static void watched_signals(sigset_t *set)
{
  sigemptyset(set);
  sigaddset(set, SIGCHLD);
  for (size_t k = 0; k < sizeof interrupts / sizeof *interrupts; k++)
    sigaddset(set, interrupts[k]);
}

#define MOST_BYTES ((uint64_t)1 << 28) /* of a file that a port writes; ours have some megabytes, as text */
#define SHELL_ADDS 128                 /* to the signal that ended what a shell has run */
#define MOST_SIGNALS 64

/* So no port fills the disk. */
static void limit_files(void)
{
  struct rlimit limit;
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur > MOST_BYTES)) {
    limit.rlim_cur = MOST_BYTES;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
}

static void become(const struct call *call, const sigset_t *before)
{
  const int nothing = open("/dev/null", O_RDONLY);
  const int output = call->output ? open(call->output, O_WRONLY | O_CREAT | O_EXCL, 0666) : STDERR_FILENO;
  setpgid(0, 0);
  limit_files();
  sigprocmask(SIG_SETMASK, before, NULL);
  dup2(nothing, STDIN_FILENO);
  if (dup2(output, STDOUT_FILENO) < 0)
    _exit(EXIT_FAILURE);
  execvp(call->words[0], (char *const *)call->words);
  _exit(CALLED_NO_PROGRAM);
}

/* Until the child ends (0), its time is over (SIGALRM), or this program is to end (the signal). */
static int wait_for(pid_t child, uint64_t seconds, const sigset_t *watched, int *status)
{
  struct timespec now, end;
  clock_gettime(CLOCK_MONOTONIC, &end);
  end.tv_sec += (time_t)seconds;
  for (;;) {
    if (waitpid(child, status, WNOHANG) == child)
      return 0;
    clock_gettime(CLOCK_MONOTONIC, &now);
    struct timespec left = {end.tv_sec - now.tv_sec, end.tv_nsec - now.tv_nsec};
    if (left.tv_nsec < 0)
      left = (struct timespec){left.tv_sec - 1, left.tv_nsec + 1000000000L};
    if (left.tv_sec < 0)
      return SIGALRM;
    const int signal = sigtimedwait(watched, NULL, &left);
    if (signal > 0 && signal != SIGCHLD)
      return signal;
  }
}

static bool tell(int status, const char *out, struct message *message)
{
  if (status == SHELL_ADDS + SIGXFSZ)
    return message_set(message, "the port writes a file of more than %" PRIu64 " bytes", MOST_BYTES);
  if (status > SHELL_ADDS && status <= SHELL_ADDS + MOST_SIGNALS)
    return message_set(message, "the port was ended by signal %d", status - SHELL_ADDS);
  if (status != 0)
    return message_set(message, "the port's exit code is %d%s", status,
                       status == CALLED_NO_PROGRAM ? ": is it a program?" : "");
  return access(out, R_OK) == 0 || message_set(message, "the port has not written its output");
}

void called_clean(const char *folder)
{
  char path[PATH_MAX];
  DIR *open = opendir(folder);
  for (struct dirent *entry; open && (entry = readdir(open));)
    if (snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) < (int)sizeof path)
      unlink(path);
  if (open)
    closedir(open);
  rmdir(folder);
}

bool called_run(const struct call *call, int *code, struct message *message)
{
  int status = 0;
  sigset_t watched, before;
  watched_signals(&watched);
  fflush(NULL);
  sigprocmask(SIG_BLOCK, &watched, &before);
  const pid_t child = fork();
  if (child == 0)
    become(call, &before);
  int ended = 0;
  const int why = errno;
  if (child > 0) {
    setpgid(child, child); /* whoever of both comes first */
    ended = wait_for(child, call->seconds, &watched, &status);
    kill(-child, SIGKILL);
    if (ended)
      waitpid(child, &status, 0);
  }
  sigprocmask(SIG_SETMASK, &before, NULL);
  if (ended && ended != SIGALRM) {
    called_clean(call->folder);
    raise(ended);
  }
  if (child < 0)
    return message_set(message, "%s cannot be run: %s", call->who, strerror(why));
  if (ended)
    return message_set(message, "%s took more than %" PRIu64 " s", call->who, call->seconds);
  *code = WIFSIGNALED(status) ? SHELL_ADDS + WTERMSIG(status) : WEXITSTATUS(status);
  return true;
}

bool called_port(const struct check_options *o, bool trace, const char *folder, const char *in, const char *out,
                 struct message *message)
{
  int status = 0;
  const char *const pack[] = {o->port, in, out, NULL}, *const start[] = {o->port, "--trace", in, out, NULL};
  const struct call call = {"the port", trace ? start : pack, NULL, folder, o->seconds};
  return called_run(&call, &status, message) && tell(status, out, message);
}
