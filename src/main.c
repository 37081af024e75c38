/* The command line: one table of commands, one of options each. */
#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/build_info.h"
#include "io/scene.h"
#include "io/snapshot.h"
#include "oracle.h"
#include "run.h"
#include "version.h"

static const char help[] =
    "uncross: noncrossing fibers and chains in a hydrodynamic solvent\n"
    "(SRD solvent, semiflexible fibers, bonds that exchange momentum instead of crossing: Padding, JCP 130, 144903, "
    "2009)\n"
    "\n"
    "usage:\n"
    "  uncross check SCENE                    what a scene says, all its derived numbers, memory, time, warnings\n"
    "  uncross run SCENE --out DIR [options]  runs it; DIR gets checkpoint.h5, run.json, tables, trajectory.h5\n"
    "      --steps N       run to step N (0 .. 2^63-1) instead of the scene's `steps`; with --resume: extend a run\n"
    "      --seed S        use this seed instead of the scene's (0 .. 2^64-1)\n"
    "      --resume        go on from DIR/checkpoint.h5\n"
    "      --quiet         no progress, no closing words\n"
    "  uncross info FILE                      what a file is: scene, checkpoint, trajectory, run.json, table\n"
    "  uncross export FILE [options]          extended XYZ of a trajectory or checkpoint, to standard output\n"
    "      --output FILE   write to this file instead, which must not exist\n"
    "      --solvent       with the solvent particles, if the file has them\n"
    "      --wrapped       vertices folded into the box\n"
    "      --first N, --last N, --stride N   these frames only (numbered from 0)\n"
    "  uncross analyze TRAJECTORY --out DIR   recomputes the observables of its scene from its frames, as new tables\n"
    "  uncross oracle ACTION ...              what to hold other implementations against: `uncross oracle "
    "--help`\n"
    "  uncross --help, uncross --version\n"
    "\n"
    "exit codes:\n"
    "  0  done\n"
    "  1  no memory, or an internal error\n"
    "  2  bad input (options, scene, snapshot): nothing was written\n"
    "  3  the run had to stop (a bond too long, a velocity out of range, ...): run.json says why; the last checkpoint "
    "stays\n"
    "  4  a file or DIR could not be written, or another process writes into DIR; the last checkpoint stays\n"
    "  5  interrupted by SIGINT or SIGTERM; a checkpoint was written, --resume goes on\n"
    "  6  oracle compare: different, but within the derived tolerances\n"
    "  7  oracle compare: different beyond them; oracle judge: different\n"
    "  8  oracle judge: cannot tell, since observables are missing or their errors too large\n"
    "\n"
    "Scenes are YAML files: docs/scene.md lists every key, scenes/ holds examples.\n";

static enum exit_code usage_error(const char *what, const char *which)
{
  fprintf(stderr, "uncross: %s%s; `uncross --help` lists what is allowed\n", what, which);
  return EXIT_BAD_INPUT;
}

/* Options of all commands. */
enum option_code {
  OPTION_OUT = 256,
  OPTION_STEPS,
  OPTION_SEED,
  OPTION_RESUME,
  OPTION_QUIET,
  OPTION_OUTPUT,
  OPTION_SOLVENT,
  OPTION_WRAPPED,
  OPTION_FIRST,
  OPTION_LAST,
  OPTION_STRIDE
};

struct arguments {
  const char *file;
  const char *output;
  struct run_options run;
  struct export_options export;
};

static bool parse_number(const char *text, uint64_t *value)
{
  char *end;
  errno = 0;
  if (text[0] < '0' || text[0] > '9')
    return false;
  unsigned long long x = strtoull(text, &end, 10);
  *value = x;
  return errno == 0 && *end == '\0';
}

static enum exit_code take_number(const char *name, const char *text, uint64_t most, uint64_t *value)
{
  if (parse_number(text, value) && *value <= most)
    return EXIT_DONE;
  fprintf(stderr, "uncross: --%s %s: not a whole number from 0 to %" PRIu64 "\n", name, text, most);
  return EXIT_BAD_INPUT;
}

static enum exit_code take_option(struct arguments *a, int code)
{
  switch (code) {
  case OPTION_OUT:
    a->run.folder = optarg;
    return EXIT_DONE;
  case OPTION_STEPS:
    a->run.has_steps = true;
    return take_number("steps", optarg, INT64_MAX, &a->run.steps);
  case OPTION_SEED:
    a->run.has_seed = true;
    return take_number("seed", optarg, UINT64_MAX, &a->run.seed);
  case OPTION_RESUME:
    a->run.resume = true;
    return EXIT_DONE;
  case OPTION_QUIET:
    a->run.quiet = true;
    return EXIT_DONE;
  case OPTION_OUTPUT:
    a->output = optarg;
    return EXIT_DONE;
  case OPTION_SOLVENT:
    a->export.solvent = true;
    return EXIT_DONE;
  case OPTION_WRAPPED:
    a->export.wrapped = true;
    return EXIT_DONE;
  case OPTION_FIRST:
    return take_number("first", optarg, UINT64_MAX, &a->export.first);
  case OPTION_LAST:
    return take_number("last", optarg, UINT64_MAX, &a->export.last);
  case OPTION_STRIDE:
    return take_number("stride", optarg, UINT64_MAX, &a->export.stride);
  default:
    return usage_error("wrong options", ""); /* getopt_long has said which */
  }
}

/* What was to be printed must have arrived where it went. Who says a failure has said it all. */
static enum exit_code told(enum exit_code code)
{
  const bool failure = code != EXIT_DONE && code < EXIT_CLOSE;
  if (failure || (fflush(stdout) == 0 && !ferror(stdout)))
    return code;
  fprintf(stderr, "uncross: standard output: cannot write: %s\n", strerror(errno));
  return EXIT_NOT_WRITTEN;
}

/* --- commands ---------------------------------------------------------------------------------------------------- */

static enum exit_code command_check(struct arguments *a)
{
  struct scene scene;
  struct message message;
  if (!scene_read(a->file, &scene, &message)) {
    fprintf(stderr, "uncross: %s\n", message.text);
    return EXIT_BAD_INPUT;
  }
  scene_report(&scene);
  scene_free(&scene);
  return told(EXIT_DONE);
}

static enum exit_code command_run(struct arguments *a)
{
  if (!a->run.folder)
    return usage_error("run: ", "--out DIR is missing");
  a->run.scene = a->file;
  return run_scene(&a->run);
}

static enum exit_code command_info(struct arguments *a)
{
  struct message message;
  if (file_info(a->file, &message))
    return told(EXIT_DONE);
  fprintf(stderr, "uncross: %s\n", message.text);
  return EXIT_BAD_INPUT;
}

static enum exit_code command_export(struct arguments *a)
{
  struct message message;
  if (a->export.stride == 0)
    return usage_error("export: ", "--stride must be at least 1");
  FILE *out = a->output ? fopen(a->output, "wx") : stdout;
  if (!out) {
    int why = errno;
    fprintf(stderr, "uncross: %s: cannot create: %s\n", a->output, strerror(why));
    return why == EEXIST ? EXIT_BAD_INPUT : EXIT_NOT_WRITTEN;
  }
  bool ok = trajectory_export(a->file, &a->export, out, &message);
  enum exit_code code = ok ? EXIT_DONE : ferror(out) ? EXIT_NOT_WRITTEN : EXIT_BAD_INPUT;
  if (!ok)
    fprintf(stderr, "uncross: %s\n", message.text);
  if ((out == stdout ? fflush(out) : fclose(out)) != 0 && ok) {
    fprintf(stderr, "uncross: %s: cannot write: %s\n", a->output ? a->output : "standard output", strerror(errno));
    code = EXIT_NOT_WRITTEN;
  }
  if (code != EXIT_DONE && a->output)
    remove(a->output);
  return code;
}

static enum exit_code command_analyze(struct arguments *a)
{
  if (!a->run.folder)
    return usage_error("analyze: ", "--out DIR is missing");
  return run_analyze(a->file, a->run.folder);
}

#define NO_ARGUMENT 0
#define WITH_ARGUMENT 1

static const struct option no_options[] = {{0, 0, NULL, 0}};
static const struct option run_table[] = {
    {"out", WITH_ARGUMENT, NULL, OPTION_OUT},   {"steps", WITH_ARGUMENT, NULL, OPTION_STEPS},
    {"seed", WITH_ARGUMENT, NULL, OPTION_SEED}, {"resume", NO_ARGUMENT, NULL, OPTION_RESUME},
    {"quiet", NO_ARGUMENT, NULL, OPTION_QUIET}, {0, 0, NULL, 0}};
static const struct option export_table[] = {{"output", WITH_ARGUMENT, NULL, OPTION_OUTPUT},
                                             {"solvent", NO_ARGUMENT, NULL, OPTION_SOLVENT},
                                             {"wrapped", NO_ARGUMENT, NULL, OPTION_WRAPPED},
                                             {"first", WITH_ARGUMENT, NULL, OPTION_FIRST},
                                             {"last", WITH_ARGUMENT, NULL, OPTION_LAST},
                                             {"stride", WITH_ARGUMENT, NULL, OPTION_STRIDE},
                                             {0, 0, NULL, 0}};
static const struct option analyze_table[] = {{"out", WITH_ARGUMENT, NULL, OPTION_OUT}, {0, 0, NULL, 0}};

static const struct command {
  const char *name;
  const struct option *options;
  enum exit_code (*act)(struct arguments *);
} commands[] = {
    {"check", no_options, command_check},        {"run", run_table, command_run},
    {"info", no_options, command_info},          {"export", export_table, command_export},
    {"analyze", analyze_table, command_analyze},
};

static enum exit_code dispatch(const struct command *command, int count, char **words)
{
  struct arguments a = {.export = {.last = UINT64_MAX, .stride = 1}};
  char name[64]; /* under which getopt_long complains */
  snprintf(name, sizeof name, "uncross %s", command->name);
  words[0] = name;
  int code;
  while ((code = getopt_long(count, words, "", command->options, NULL)) != -1) {
    enum exit_code taken = take_option(&a, code);
    if (taken != EXIT_DONE)
      return taken;
  }
  if (optind + 1 != count)
    return usage_error(command->name, optind == count ? ": a file is missing" : ": one file only");
  a.file = words[optind];
  return command->act(&a);
}

/* A standard stream that the caller closed is given to nobody: the next file that is opened would get its number, and
 * all that is said would go there. */
static void keep_streams(void)
{
  int fd;
  do
    fd = open("/dev/null", O_RDONLY);
  while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd >= 0)
    close(fd);
}

int main(int count, char **words)
{
  keep_streams();
  if (count < 2) {
    fputs(help, stderr);
    return EXIT_BAD_INPUT;
  }
  if (strcmp(words[1], "--help") == 0 || strcmp(words[1], "-h") == 0 || strcmp(words[1], "help") == 0) {
    fputs(help, stdout);
    return told(EXIT_DONE);
  }
  if (strcmp(words[1], "--version") == 0) {
    printf("uncross %s (commit %s; %s; %s)\n", UNCROSS_VERSION, build_info.commit, build_info.compiler,
           build_info.flags);
    return told(EXIT_DONE);
  }
  for (size_t k = 0; k < sizeof commands / sizeof *commands; k++)
    if (strcmp(words[1], commands[k].name) == 0)
      return dispatch(&commands[k], count - 1, words + 1);
  if (strcmp(words[1], "oracle") == 0)
    return told(oracle_command(count - 1, words + 1));
  return usage_error("unknown command ", words[1]);
}
