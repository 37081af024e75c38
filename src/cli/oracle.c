/* `uncross oracle`: packs and traces for other implementations. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "oracle/check.h"
#include "oracle/judge.h"
#include "oracle/oracle.h"
#include "oracle/schema.h"

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
  if (code != EXIT_DONE && code != EXIT_STOPPED && path)
    remove(path);
  return code == EXIT_DONE ? code : complain(message, code);
}

/* Refuses what cannot be made there, and leaves no file: a pack may take long, and who ends it would find an empty one.
 */
static enum exit_code try_output(const char *path)
{
  FILE *out;
  const enum exit_code code = open_output(path, &out);
  if (code == EXIT_DONE && path) {
    fclose(out);
    remove(path);
  }
  return code;
}

/* Writes the pack that `make` fills of a scene. */
static enum exit_code write_pack(const struct arguments *a,
                                 bool (*make)(struct scene *, struct pack *, struct message *))
{
  struct message message;
  struct scene scene;
  struct pack pack = {0};
  FILE *out;
  if (!scene_read(a->file[0], &scene, &message))
    return complain(&message, EXIT_BAD_INPUT);
  enum exit_code code = try_output(a->out);
  if (code == EXIT_DONE && !make(&scene, &pack, &message))
    code = complain(&message, EXIT_BAD_INPUT);
  if (code == EXIT_DONE)
    code = open_output(a->out, &out);
  if (code == EXIT_DONE)
    code = close_output(out, pack_write(&pack, out, a->out, &message) ? EXIT_DONE : EXIT_NOT_WRITTEN, a->out, &message);
  pack_free(&pack);
  scene_free(&scene);
  return code;
}

enum exit_code oracle_schema(const struct arguments *a)
{
  (void)a;
  oracle_write_schema(stdout);
  return EXIT_DONE;
}

enum exit_code oracle_emit_file(const struct arguments *a)
{
  return write_pack(a, oracle_emit);
}

enum exit_code oracle_start_file(const struct arguments *a)
{
  return write_pack(a, oracle_start);
}

enum exit_code oracle_answer_file(const struct arguments *a)
{
  struct message message;
  struct pack pack, answers = {0};
  FILE *out;
  if (!pack_read(a->file[0], &pack, &message))
    return complain(&message, EXIT_BAD_INPUT);
  enum exit_code code = oracle_answer(&pack, a->whole, &answers, &message) ? open_output(a->file[1], &out)
                                                                           : complain(&message, EXIT_BAD_INPUT);
  if (code == EXIT_DONE)
    code = close_output(out, pack_write(&answers, out, a->file[1], &message) ? EXIT_DONE : EXIT_NOT_WRITTEN, a->file[1],
                        &message);
  pack_free(&pack);
  pack_free(&answers);
  return code;
}

enum exit_code oracle_trace_file(const struct arguments *a)
{
  struct message message;
  struct scene scene;
  if (!scene_read(a->file[0], &scene, &message))
    return complain(&message, EXIT_BAD_INPUT);
  FILE *out;
  enum exit_code code = open_output(a->out, &out);
  if (code == EXIT_DONE) {
    bool stopped;
    const bool ok = oracle_trace(&scene, a->every, out, &stopped, &message);
    code = close_output(out, ok ? EXIT_DONE : stopped ? EXIT_STOPPED : EXIT_BAD_INPUT, a->out, &message);
  }
  scene_free(&scene);
  return code;
}

enum exit_code oracle_dump_file(const struct arguments *a)
{
  struct message message;
  struct pack pack;
  if (!pack_read(a->file[0], &pack, &message))
    return complain(&message, EXIT_BAD_INPUT);
  oracle_sort(&pack);
  FILE *out;
  enum exit_code code = open_output(a->out, &out);
  if (code == EXIT_DONE) {
    pack_dump(&pack, a->decimal, out);
    code = close_output(out, code, a->out, &message);
  }
  pack_free(&pack);
  return code;
}

static const enum exit_code codes_of_verdicts[] = {
    [ORACLE_SAME] = EXIT_DONE, [ORACLE_CLOSE] = EXIT_CLOSE, [ORACLE_DIFFERS] = EXIT_DIFFERS};

/* With the program that names what differs, unless none is wanted; that it is not there is said in the name's place. */
static struct oracle_options options_of(const struct arguments *a, char namer[PATH_MAX])
{
  struct oracle_options options = a->oracle;
  if (!a->no_name) {
    outer_find("name", namer);
    options.namer = namer;
  }
  return options;
}

static bool compare_packs(const struct arguments *a, struct oracle_summary *summary, struct message *message)
{
  char namer[PATH_MAX];
  const struct oracle_options options = options_of(a, namer);
  struct pack ours, theirs;
  if (!pack_read(a->file[0], &ours, message))
    return false;
  if (!pack_read(a->file[1], &theirs, message)) {
    pack_free(&ours);
    return false;
  }
  oracle_sort(&ours);
  const bool ok =
      oracle_align(&ours, &theirs, message) && oracle_compare(&ours, &theirs, &options, stdout, summary, message);
  pack_free(&ours);
  pack_free(&theirs);
  return ok;
}

enum exit_code oracle_compare_files(const struct arguments *a)
{
  struct message message;
  struct oracle_summary summary = {.verdict = ORACLE_DIFFERS};
  const bool ok = oracle_is_trace(a->file[0])
                      ? oracle_compare_traces(a->file[0], a->file[1], stdout, &summary, &message)
                      : compare_packs(a, &summary, &message);
  return ok ? codes_of_verdicts[summary.verdict] : complain(&message, EXIT_BAD_INPUT);
}

enum exit_code oracle_check_port(const struct arguments *a)
{
  char namer[PATH_MAX];
  const struct check_options options = {a->file[0],   a->packs,   a->out,    a->text,
                                        a->no_traces, a->seconds, a->repeat, options_of(a, namer)};
  struct message message;
  enum oracle_verdict verdict = ORACLE_DIFFERS;
  return oracle_check(&options, stdout, &verdict, &message) ? codes_of_verdicts[verdict]
                                                            : complain(&message, EXIT_BAD_INPUT);
}

enum exit_code oracle_judge_files(const struct arguments *a)
{
  static const enum exit_code codes[] = {
      [JUDGE_CONSISTENT] = EXIT_DONE, [JUDGE_CANNOT_TELL] = EXIT_CANNOT_TELL, [JUDGE_DIFFERS] = EXIT_DIFFERS};
  const struct judge_options how = {a->false_alarm, a->oracle.only};
  struct message message;
  struct observable_means ours, theirs;
  enum judge_verdict verdict = JUDGE_CANNOT_TELL;
  const bool ok = observable_means_read(a->file[0], NULL, &ours, &message) &&
                  observable_means_read(a->file[1], &ours, &theirs, &message) &&
                  oracle_judge(&ours, &theirs, &how, stdout, &verdict, &message);
  return ok ? codes[verdict] : complain(&message, EXIT_BAD_INPUT);
}
