#include "oracle.h"

#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/judge.h"
#include "oracle/oracle.h"

static const char help[] =
    "uncross oracle: what other implementations are held against (docs/porting.md)\n"
    "\n"
    "usage:\n"
    "  uncross oracle emit SCENE -o PACK.h5      inputs and outputs of every operator, at two steps\n"
    "  uncross oracle trace SCENE -o TRACE.csv   state hashes and sums after every stage of the scene's steps\n"
    "  uncross oracle dump PACK                  the pack as text, to standard output (or -o FILE)\n"
    "  uncross oracle compare OURS THEIRS        packs, each HDF5 or text: the first difference and what it means\n"
    "      --single                              tolerances of single precision instead of double\n"
    "      --only OPERATOR[,OPERATOR ...]        these operators only\n"
    "  uncross oracle judge OURS THEIRS          tables of observables (docs/judging.md): could both be the same "
    "code?\n"
    "      --only OBSERVABLE[,OBSERVABLE ...]    these observables only\n"
    "      --false-alarm P                       chance that equal codes are found different (1e-9 .. 0.5; default "
    "1e-3)\n"
    "What -o names must not exist.\n"
    "\n"
    "exit codes of compare:              of judge:\n"
    "  0  the same, every bit              0  consistent\n"
    "  2  bad input                        2  bad input\n"
    "  6  different, but all within        7  different\n"
    "     the derived tolerances           8  cannot tell: an observable is missing,\n"
    "  7  different beyond them,              or its error too large\n"
    "     or something is missing\n"
    "The others end as all of uncross: see `uncross --help`.\n";

struct words {
  const char *file[2];
  const char *output;
  struct oracle_options options;
  double false_alarm;
};

static enum exit_code complain(const struct message *message, enum exit_code code)
{
  fprintf(stderr, "uncross: %s\n", message->text);
  return code;
}

/* The file asked for, which must not exist, or standard output. */
static enum exit_code open_output(const char *path, FILE **out)
{
  struct message message;
  *out = path ? fopen(path, "wx") : stdout;
  if (*out)
    return EXIT_DONE;
  const int why = errno;
  message_set(&message, "%s: cannot create: %s", path, strerror(why));
  return complain(&message, why == EEXIST ? EXIT_BAD_INPUT : EXIT_NOT_WRITTEN);
}

/* `code`: how it went so far, with a message if not well. */
static enum exit_code close_output(FILE *out, enum exit_code code, const char *path, struct message *message)
{
  bool written = !ferror(out);
  written = (out == stdout ? fflush(out) : fclose(out)) == 0 && written;
  if (code == EXIT_DONE && !written) {
    message_set(message, "%s: cannot write", path ? path : "standard output");
    code = EXIT_NOT_WRITTEN;
  }
  if (code != EXIT_DONE && path)
    remove(path);
  return code == EXIT_DONE ? code : complain(message, code);
}

static enum exit_code emit(const struct words *w)
{
  struct message message;
  struct scene scene;
  struct pack pack;
  if (!w->output) {
    message_set(&message, "oracle emit: -o PACK.h5 is missing");
    return complain(&message, EXIT_BAD_INPUT);
  }
  if (!scene_read(w->file[0], &scene, &message))
    return complain(&message, EXIT_BAD_INPUT);
  FILE *out;
  enum exit_code code = open_output(w->output, &out);
  if (code == EXIT_DONE) {
    code = !oracle_emit(&scene, &pack, &message)          ? EXIT_BAD_INPUT
           : !pack_write(&pack, out, w->output, &message) ? EXIT_NOT_WRITTEN
                                                          : EXIT_DONE;
    code = close_output(out, code, w->output, &message);
    pack_free(&pack);
  }
  scene_free(&scene);
  return code;
}

static enum exit_code trace(const struct words *w)
{
  struct message message;
  struct scene scene;
  if (!scene_read(w->file[0], &scene, &message))
    return complain(&message, EXIT_BAD_INPUT);
  FILE *out;
  enum exit_code code = open_output(w->output, &out);
  if (code == EXIT_DONE)
    code = close_output(out, oracle_trace(&scene, out, &message) ? EXIT_DONE : EXIT_BAD_INPUT, w->output, &message);
  scene_free(&scene);
  return code;
}

static enum exit_code dump(const struct words *w)
{
  struct message message;
  struct pack pack;
  if (!pack_read(w->file[0], &pack, &message))
    return complain(&message, EXIT_BAD_INPUT);
  oracle_sort(&pack);
  FILE *out;
  enum exit_code code = open_output(w->output, &out);
  if (code == EXIT_DONE) {
    pack_dump(&pack, out);
    code = close_output(out, code, w->output, &message);
  }
  pack_free(&pack);
  return code;
}

static enum exit_code compare(const struct words *w)
{
  static const enum exit_code codes[] = {
      [ORACLE_SAME] = EXIT_DONE, [ORACLE_CLOSE] = EXIT_CLOSE, [ORACLE_DIFFERS] = EXIT_DIFFERS};
  struct message message;
  struct pack ours, theirs;
  enum oracle_verdict verdict = ORACLE_DIFFERS;
  if (!pack_read(w->file[0], &ours, &message))
    return complain(&message, EXIT_BAD_INPUT);
  if (!pack_read(w->file[1], &theirs, &message)) {
    pack_free(&ours);
    return complain(&message, EXIT_BAD_INPUT);
  }
  oracle_sort(&ours);
  bool ok = oracle_compare(&ours, &theirs, &w->options, stdout, &verdict, &message);
  pack_free(&ours);
  pack_free(&theirs);
  return ok ? codes[verdict] : complain(&message, EXIT_BAD_INPUT);
}

static enum exit_code judge(const struct words *w)
{
  static const enum exit_code codes[] = {
      [JUDGE_CONSISTENT] = EXIT_DONE, [JUDGE_CANNOT_TELL] = EXIT_CANNOT_TELL, [JUDGE_DIFFERS] = EXIT_DIFFERS};
  const struct judge_options how = {w->false_alarm, w->options.only};
  struct message message;
  struct observable_means ours, theirs;
  enum judge_verdict verdict = JUDGE_CANNOT_TELL;
  const bool ok = observable_means_read(w->file[0], NULL, &ours, &message) &&
                  observable_means_read(w->file[1], &ours, &theirs, &message) &&
                  oracle_judge(&ours, &theirs, &how, stdout, &verdict, &message);
  return ok ? codes[verdict] : complain(&message, EXIT_BAD_INPUT);
}

static const struct {
  const char *name;
  int files;
  enum exit_code (*act)(const struct words *);
} actions[] = {{"emit", 1, emit}, {"trace", 1, trace}, {"dump", 1, dump}, {"compare", 2, compare}, {"judge", 2, judge}};

enum option_code { OPTION_HELP = 256, OPTION_SINGLE, OPTION_ONLY, OPTION_FALSE_ALARM };

static const struct option options[] = {{"output", 1, NULL, 'o'},       {"single", 0, NULL, OPTION_SINGLE},
                                        {"only", 1, NULL, OPTION_ONLY}, {"false-alarm", 1, NULL, OPTION_FALSE_ALARM},
                                        {"help", 0, NULL, OPTION_HELP}, {0, 0, NULL, 0}};

static enum exit_code usage_error(const char *what, const char *which)
{
  fprintf(stderr, "uncross: oracle%s%s; `uncross oracle --help` lists what is allowed\n", what, which);
  return EXIT_BAD_INPUT;
}

static bool take_false_alarm(const char *text, double *rate)
{
  char *end;
  *rate = strtod(text, &end);
  return end != text && *end == '\0' && *rate >= 1e-9 && *rate <= 0.5;
}

enum exit_code oracle_command(int count, char **arguments)
{
  struct words w = {.false_alarm = 1e-3};
  int code;
  while ((code = getopt_long(count, arguments, "o:", options, NULL)) != -1) {
    if (code == OPTION_HELP)
      return fputs(help, stdout) >= 0 ? EXIT_DONE : EXIT_NOT_WRITTEN;
    if (code == 'o')
      w.output = optarg;
    else if (code == OPTION_SINGLE)
      w.options.single = true;
    else if (code == OPTION_ONLY)
      w.options.only = optarg;
    else if (code == OPTION_FALSE_ALARM && !take_false_alarm(optarg, &w.false_alarm))
      return usage_error(": --false-alarm takes a number from 1e-9 to 0.5, not ", optarg);
    else if (code != OPTION_FALSE_ALARM)
      return EXIT_BAD_INPUT; /* getopt_long has said why */
  }
  const char *name = optind < count ? arguments[optind] : "";
  for (size_t k = 0; k < sizeof actions / sizeof *actions; k++) {
    if (strcmp(name, actions[k].name) != 0)
      continue;
    if (count - optind - 1 != actions[k].files)
      return usage_error(" ", actions[k].files == 2 ? "takes two files" : "takes one file");
    for (int f = 0; f < actions[k].files; f++)
      w.file[f] = arguments[optind + 1 + f];
    return actions[k].act(&w);
  }
  return usage_error(": no such action: ", name[0] ? name : "(none given)");
}
