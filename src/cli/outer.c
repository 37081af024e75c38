/* Commands that another program does: `uncross plot` is uncross-plot. The table of commands names it. */
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "cli/command.h"

/* From the folder of this program: in a build folder, where the Makefile puts links to tools/; and where `make install`
 * puts programs. Nothing else that stands beside a build folder is looked at. */
static const struct {
  const char *folder; /* what the program's folder must be called; NULL: anything */
  const char *place;
} places[] = {{NULL, "/libexec/"}, {"bin", "/../libexec/uncross/"}};

/* True, and its path, if there is such a program; the path of this one too. */
static bool find(const struct command *c, char ours[PATH_MAX - 128], char path[PATH_MAX])
{
  const ssize_t length = readlink("/proc/self/exe", ours, PATH_MAX - 129);
  ours[length > 0 ? length : 0] = '\0';
  const char *slash = strrchr(ours, '/');
  const int folder = slash ? (int)(slash - ours) : 0;
  for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
    snprintf(path, PATH_MAX, "%.*s", folder, ours);
    const char *last = strrchr(path, '/'), *wanted = places[k].folder;
    if (wanted && !(last && strcmp(last + 1, wanted) == 0))
      continue;
    snprintf(path, PATH_MAX, "%.*s%suncross-%s", folder, ours, places[k].place, c->name);
    if (access(path, X_OK) == 0)
      return true;
  }
  return false;
}

enum exit_code outer_run(const struct command *c, char **words)
{
  char ours[PATH_MAX - 128], path[PATH_MAX];
  if (!find(c, ours, path)) {
    fprintf(
        stderr,
        "uncross: %s: there is no program uncross-%s: make puts it into libexec/ beside the program, make install into "
        "../libexec/uncross\n",
        c->name, c->name);
    return EXIT_TROUBLE;
  }
  fflush(NULL);
  words[0] = path;
  if (setenv("UNCROSS", ours, 1) == 0)
    execv(path, words);
  /* The file is there: so what is missing is the program of its first line. */
  const bool interpreter = errno == ENOENT;
  fprintf(stderr, "uncross: %s: cannot run %s: %s%s%s\n", c->name, text_shown(path),
          interpreter ? "there is no /usr/bin/python3; it comes with `tools/install-dependencies " : strerror(errno),
          interpreter ? c->name : "", interpreter ? "`" : "");
  return EXIT_TROUBLE;
}
