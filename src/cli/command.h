/* Commands and options of the program. Each is declared once, in a table (main.c, options.c); parsing, help, the man
 * page and the completion of bash are made from these rows. */
#ifndef UNCROSS_CLI_COMMAND_H
#define UNCROSS_CLI_COMMAND_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "files/snapshot.h"
#include "oracle/oracle.h"

/* Exit codes of the program; their words are in help.c. Those to EXIT_NOT_WRITTEN are codes of the library too. */
enum exit_code {
  EXIT_DONE = 0,
  EXIT_TROUBLE = 1,     /* no memory, or a bug */
  EXIT_BAD_INPUT = 2,   /* options, scene, snapshot: nothing was written */
  EXIT_STOPPED = 3,     /* the physics could not go on; the last checkpoint stays */
  EXIT_NOT_WRITTEN = 4, /* a file or the folder could not be written, or the folder is another process's (its lock);
                           the last checkpoint stays */
  EXIT_INTERRUPTED = 5, /* by a signal; a checkpoint was written, --resume goes on */
  EXIT_CLOSE = 6,       /* oracle compare: different within tolerance */
  EXIT_DIFFERS = 7,     /* oracle compare: different beyond it; oracle judge: different */
  EXIT_CANNOT_TELL = 8, /* oracle judge: observables missing, or blocks that do not suffice */
  EXIT_DAMAGED = 9,     /* verify: a file is not what was written */
  EXIT_CROSSED = 10,    /* topology: bonds crossed each other */
  EXIT_CODES
};

/* Files and options of a command, as read from the command line. */
struct arguments {
  const char *program; /* as it was typed */
  const char *file[2];
  char **all_files; /* [files] */
  size_t files;
  const char *out;
  const char **set; /* [sets] "key=value" */
  size_t sets;
  bool has_steps, has_seed, resume, quiet, document, decimal, whole, skip_damaged, movie, compare, list, slurm, no_name,
      numbers, every_step, help;
  uint64_t steps, seed; /* instead of the scene's */
  const char *format;
  bool solvent, wrapped;
  uint64_t first, last, stride; /* of frames */
  struct oracle_options oracle;
  double false_alarm;
  const char *packs; /* folder */
  const char *seeds; /* "1..4" */
  uint64_t jobs;
  bool text, no_traces;
  uint64_t seconds, repeat, every;
  const char *units;
  const char *bonds, *csv, *page; /* files */
  const char *links, *closure;
  uint64_t chain, ring; /* vertices of each */
};

/* Rows of the table of commands, in the order in which help shows them. */
enum command_code {
  COMMAND_CHECK,
  COMMAND_MAP,
  COMMAND_RUN,
  COMMAND_INFO,
  COMMAND_VERIFY,
  COMMAND_SCHEMA,
  COMMAND_EXPORT,
  COMMAND_FRAMES,
  COMMAND_LINKS,
  COMMAND_TOPOLOGY,
  COMMAND_CROSSINGS,
  COMMAND_ANALYZE,
  COMMAND_PLOT,
  COMMAND_SWEEP,
  COMMAND_ORACLE_SCHEMA,
  COMMAND_EMIT,
  COMMAND_START,
  COMMAND_TRACE,
  COMMAND_ANSWER,
  COMMAND_DUMP,
  COMMAND_COMPARE,
  COMMAND_CHECK_PORT,
  COMMAND_JUDGE,
  COMMANDS
};

struct command {
  const char *name;    /* "run", "oracle emit" */
  const char *files;   /* its files, e.g. "SCENE", "OURS THEIRS" */
  int file_count;      /* the least number, if files end with "..." */
  unsigned codes;      /* exit codes besides 0, 1 and 2: bit 1 << code */
  const char *summary; /* one line */
  const char *text;    /* more, for its own help; lines of at most 100 characters */
  /* NULL: another program does it, uncross-NAME, in PREFIX/libexec/uncross or tools/. It gets the words as they came,
   * and the path of this program in $UNCROSS. */
  enum exit_code (*act)(const struct arguments *arguments);
};
extern const struct command commands[COMMANDS];

enum option_type {
  OPTION_SWITCH, /* bool */
  OPTION_TEXT,   /* const char * */
  OPTION_WHOLE,  /* uint64_t within least .. most */
  OPTION_REAL,   /* double within low .. high */
  OPTION_LIST    /* may be given again and again: const char ** */
};

#define OPTION_NOWHERE SIZE_MAX

struct option_row {
  const char *name;
  const char *argument; /* as help shows it; NULL: none */
  unsigned commands;    /* commands that take it: bit 1 << code */
  unsigned needed;      /* commands that require it */
  enum option_type type;
  char letter;     /* of the short form, 0: none */
  size_t at, flag; /* places in struct arguments: of the value; of a bool that becomes true, or OPTION_NOWHERE */
  uint64_t least, most;
  double low, high;
  const char *text;
};
extern const struct option_row option_rows[];
extern const size_t option_count;

/* True if this command takes this option. */
static inline bool option_is_of(const struct option_row *row, enum command_code command)
{
  return row->commands >> command & 1u;
}

/* Reads files and options of a command; words[0] is skipped. On failure prints the reason. Call arguments_free in any
 * case. */
enum exit_code arguments_read(enum command_code command, int count, char **words, struct arguments *a);
void arguments_free(struct arguments *a);

/* Prints on standard error what is wrong, and where help is. Returns EXIT_BAD_INPUT. */
enum exit_code usage_error(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Help of all commands, of one, or of those whose name begins with "oracle "; the man page; what bash completes with.
 */
void help_all(FILE *out);
void help_command(FILE *out, enum command_code command);
void help_group(FILE *out, const char *group);
void help_man(FILE *out);
void help_man_command(FILE *out, enum command_code command);
void help_names(FILE *out); /* of all commands, one a line */
void help_completion(FILE *out);

/* Prints to stdout: the effective scene, every derived number of the paper's Tables I and II, what this scene uses and
 * skips, memory, estimated time, warnings. `uncross check`. stream: that of its runs. exact: numbers with all digits,
 * for programs (cli/sheet.h). */
void scene_report(const struct scene *scene, const struct stream *stream, bool exact);

/* The path of the program uncross-NAME that stands beside this one, or where it would stand. False if it is not there.
 */
bool outer_find(const char *name, char path[PATH_MAX]);

/* Becomes the program of a command; words[0] is replaced. Returns if that cannot be, and has said why. */
enum exit_code outer_run(const struct command *command, char **words);

enum exit_code command_frames(const struct arguments *a);
enum exit_code command_links(const struct arguments *a);
enum exit_code command_crossings(const struct arguments *a);
enum exit_code command_run(const struct arguments *a);
enum exit_code command_analyze(const struct arguments *a);
enum exit_code command_verify(const struct arguments *a);
enum exit_code oracle_schema(const struct arguments *a);
enum exit_code oracle_emit_file(const struct arguments *a);
enum exit_code oracle_start_file(const struct arguments *a);
enum exit_code oracle_trace_file(const struct arguments *a);
enum exit_code oracle_answer_file(const struct arguments *a);
enum exit_code oracle_dump_file(const struct arguments *a);
enum exit_code oracle_compare_files(const struct arguments *a);
enum exit_code oracle_check_port(const struct arguments *a);
enum exit_code oracle_judge_files(const struct arguments *a);

#endif
