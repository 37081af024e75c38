/* Programs that stand beside this one: `uncross plot` is uncross-plot, and names of mistakes are uncross-name's. */
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

/* Into `ours`: this program. */
static bool find(const char *name, char ours[PATH_MAX - 128], char path[PATH_MAX])
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
    snprintf(path, PATH_MAX, "%.*s%suncross-%s", folder, ours, places[k].place, name);
    if (access(path, X_OK) == 0)
      return true;
  }
  snprintf(path, PATH_MAX, "%.*s%suncross-%s", folder, ours, places[0].place, name);
  return false;
}

bool outer_find(const char *name, char path[PATH_MAX])
{
  char ours[PATH_MAX - 128];
  return find(name, ours, path);
}

enum exit_code outer_run(const struct command *c, char **words)
{
  char ours[PATH_MAX - 128], path[PATH_MAX];
  if (!find(c->name, ours, path)) {
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
  fprintf(stderr, "uncross: %s: cannot run %s: %s\n", c->name, text_shown(path),
          errno == ENOENT ? "there is no /usr/bin/python3; `apt-get install python3` installs it" : strerror(errno));
  return EXIT_TROUBLE;
}
