/* The table of options, and the words of a command line read with it. */
#include <errno.h>
#include <getopt.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cli/command.h"

#define OF(code) (1u << COMMAND_##code)
#define ALL ((1u << COMMANDS) - 1u)
#define AT(member) offsetof(struct arguments, member)
#define ONLY_VALUE .flag = OPTION_NOWHERE

const struct option_row option_rows[] = {
    {"out", "DIR", OF(RUN) | OF(ANALYZE) | OF(SWEEP), OF(RUN) | OF(ANALYZE) | OF(SWEEP), OPTION_TEXT, 'o', AT(out),
     ONLY_VALUE, .text = "the folder that is written to; it is made if it is not there"},
    {"out", "FILE", OF(EMIT) | OF(START), OF(EMIT) | OF(START), OPTION_TEXT, 'o', AT(out), ONLY_VALUE,
     .text = "the file that is written, which must not exist"},
    {"out", "FILE", OF(EXPORT) | OF(TRACE) | OF(DUMP), 0, OPTION_TEXT, 'o', AT(out), ONLY_VALUE,
     .text = "the file that is written, which must not exist; standard output without it"},
    {"out", "FILE", OF(PLOT), 0, OPTION_TEXT, 'o', AT(out), ONLY_VALUE,
     .text = "the page, which must not exist; without it FOLDER/page.html, or FILE with the ending .html"},
    {"out", "FILE", OF(CHECK_PORT), 0, OPTION_TEXT, 'o', AT(out), ONLY_VALUE,
     .text = "a report in JSON, a file that must not exist"},
    {"grid", "KEY=V1,V2,...", OF(SWEEP), 0, OPTION_LIST, 0, AT(set), ONLY_VALUE,
     .text = "a run for each of these values of a key; given again: for each combination"},
    {"seeds", "A..B", OF(SWEEP), 0, OPTION_TEXT, 0, AT(seeds), ONLY_VALUE,
     .text = "a run for each of these seeds, and averages over them; also A,B,C; the scene's seed without it"},
    {"jobs", "N", OF(SWEEP), 0, OPTION_WHOLE, 0, AT(jobs), ONLY_VALUE, .least = 1, .most = 4096,
     .text = "runs at a time; as many as there are processors without it"},
    {"list", NULL, OF(SWEEP), 0, OPTION_SWITCH, 0, AT(list), ONLY_VALUE,
     .text = "print the command of each run, and run none"},
    {"slurm", NULL, OF(SWEEP), 0, OPTION_SWITCH, 0, AT(slurm), ONLY_VALUE,
     .text = "print a script for Slurm's sbatch with a task for each run, and run none"},
    {"set", "KEY=VALUE", OF(RUN) | OF(CHECK) | OF(SWEEP), 0, OPTION_LIST, 0, AT(set), ONLY_VALUE,
     .text = "this value instead of the scene's, e.g. solvent.per_cell=10; may be given again and again"},
    {"set", "observe.KEY=VALUE", OF(ANALYZE), 0, OPTION_LIST, 0, AT(set), ONLY_VALUE,
     .text =
         "this observable, e.g. observe.dynamics.every=10, whatever the run observed; may be given again and again"},
    {"units", "a0=50nm,T=300K", OF(CHECK) | OF(PLOT), 0, OPTION_TEXT, 0, AT(units), ONLY_VALUE,
     .text = "SI units beside; time by one of eta=1mPas, rho=1000kg/m3, mass=, t0= (docs/units.md)"},
    {"numbers", NULL, OF(CHECK), 0, OPTION_SWITCH, 0, AT(numbers), ONLY_VALUE,
     .text = "for programs: numbers with all digits, a byte 0x1f before each part of their rows"},
    {"units", "T=300K,eta=1mPas", OF(MAP), OF(MAP), OPTION_TEXT, 0, AT(units), ONLY_VALUE,
     .text = "temperature, and what fixes the time: one of eta=, rho=, mass=, t0= (docs/units.md)"},
    {"steps", "N", OF(RUN) | OF(SWEEP), 0, OPTION_WHOLE, 0, AT(steps), AT(has_steps), .most = INT64_MAX,
     .text = "run to step N instead of the scene's `steps`; with --resume: extend a run"},
    {"seed", "S", OF(RUN), 0, OPTION_WHOLE, 0, AT(seed), AT(has_seed), .most = UINT64_MAX,
     .text = "use this seed instead of the scene's"},
    {"resume", NULL, OF(RUN), 0, OPTION_SWITCH, 0, AT(resume), ONLY_VALUE, .text = "go on from DIR/checkpoint.h5"},
    {"resume", NULL, OF(SWEEP), 0, OPTION_SWITCH, 0, AT(resume), ONLY_VALUE,
     .text = "go on with runs that are not finished, begin those that are not begun"},
    {"quiet", NULL, OF(TOPOLOGY), 0, OPTION_SWITCH, 0, AT(quiet), ONLY_VALUE, .text = "no progress"},
    {"quiet", NULL, OF(RUN) | OF(SWEEP), 0, OPTION_SWITCH, 0, AT(quiet), ONLY_VALUE,
     .text = "no progress, no closing words"},
    {"format", "xyz|lammps|lammps-dump|vtf", OF(EXPORT), 0, OPTION_TEXT, 0, AT(format), ONLY_VALUE,
     .text = "extended XYZ (without it), LAMMPS data (one frame, the last), LAMMPS dump, VTF"},
    {"solvent", NULL, OF(EXPORT), 0, OPTION_SWITCH, 0, AT(solvent), ONLY_VALUE,
     .text = "with the solvent particles, if the file has them"},
    {"wrapped", NULL, OF(EXPORT), 0, OPTION_SWITCH, 0, AT(wrapped), ONLY_VALUE,
     .text = "vertices folded into the box, the images of a sheared one where they are then"},
    {"first", "N", OF(EXPORT), 0, OPTION_WHOLE, 0, AT(first), ONLY_VALUE, .most = UINT64_MAX,
     .text = "the first frame; frames are numbered from 0"},
    {"last", "N", OF(EXPORT), 0, OPTION_WHOLE, 0, AT(last), ONLY_VALUE, .most = UINT64_MAX, .text = "the last frame"},
    {"stride", "N", OF(EXPORT), 0, OPTION_WHOLE, 0, AT(stride), ONLY_VALUE, .least = 1, .most = UINT64_MAX,
     .text = "every N-th frame only"},
    {"skip-damaged", NULL, OF(EXPORT) | OF(ANALYZE), 0, OPTION_SWITCH, 0, AT(skip_damaged), ONLY_VALUE,
     .text = "leave out frames that are damaged, and name them on standard error"},
    {"decimal", NULL, OF(DUMP), 0, OPTION_SWITCH, 0, AT(decimal), ONLY_VALUE,
     .text = "reals in 17 decimal digits, exact too, instead of hexadecimal ones"},
    {"whole", NULL, OF(ANSWER), 0, OPTION_SWITCH, 0, AT(whole), ONLY_VALUE,
     .text = "all else that the pack has too, as it is: so a pack is made of constructed inputs"},
    {"every", "N", OF(TRACE), 0, OPTION_WHOLE, 0, AT(every), ONLY_VALUE, .least = 1, .most = UINT64_MAX,
     .text = "the end of each N-th step, and of the last one, instead of every stage"},
    {"packs", "DIR", OF(CHECK_PORT), 0, OPTION_TEXT, 0, AT(packs), ONLY_VALUE,
     .text = "the folder of packs and traces; without it those that belong to this program"},
    {"text", NULL, OF(CHECK_PORT), 0, OPTION_SWITCH, 0, AT(text), ONLY_VALUE,
     .text = "the port reads packs as decimal text, not as HDF5"},
    {"no-traces", NULL, OF(CHECK_PORT), 0, OPTION_SWITCH, 0, AT(no_traces), ONLY_VALUE,
     .text = "the port makes no whole steps"},
    {"seconds", "N", OF(CHECK_PORT), 0, OPTION_WHOLE, 0, AT(seconds), ONLY_VALUE, .least = 1, .most = 1000000,
     .text = "how long each call of the port may take; 600 without it"},
    {"repeat", "N", OF(CHECK_PORT), 0, OPTION_WHOLE, 0, AT(repeat), ONLY_VALUE, .least = 1, .most = 1000000,
     .text = "calls of the port with each input, which must give the same bits; 1 without it"},
    {"single", NULL, OF(COMPARE) | OF(CHECK_PORT), 0, OPTION_SWITCH, 0, AT(oracle.single), ONLY_VALUE,
     .text = "tolerances of single precision instead of double"},
    {"no-name", NULL, OF(COMPARE) | OF(CHECK_PORT), 0, OPTION_SWITCH, 0, AT(no_name), ONLY_VALUE,
     .text = "the first difference only, not the mistake that makes it"},
    {"case", "FILE", OF(COMPARE), 0, OPTION_TEXT, 0, AT(oracle.case_file), ONLY_VALUE,
     .text = "write what names the mistake to FILE, for uncross-name, and do not name it"},
    {"only", "NAME[,NAME ...]", OF(COMPARE) | OF(CHECK_PORT), 0, OPTION_TEXT, 0, AT(oracle.only), ONLY_VALUE,
     .text = "these operators only"},
    {"only", "NAME[,NAME ...]", OF(JUDGE), 0, OPTION_TEXT, 0, AT(oracle.only), ONLY_VALUE,
     .text = "these observables only"},
    {"false-alarm", "P", OF(JUDGE), 0, OPTION_REAL, 0, AT(false_alarm), ONLY_VALUE, .low = 1e-9, .high = 0.5,
     .text = "chance that equal codes are found different; 1e-3 without it"},
    {"document", NULL, OF(SCHEMA), 0, OPTION_SWITCH, 0, AT(document), ONLY_VALUE,
     .text = "the tables of docs/scene.md instead, for tools/document-keys"},
    {"movie", NULL, OF(PLOT), 0, OPTION_SWITCH, 0, AT(movie), ONLY_VALUE,
     .text = "the frames of the trajectory as an animated picture"},
    {"compare", NULL, OF(PLOT), 0, OPTION_SWITCH, 0, AT(compare), ONLY_VALUE,
     .text = "two runs, or two tables, in the same figures, with differences over their errors"},
    {"bonds", "FILE", OF(TOPOLOGY), 0, OPTION_TEXT, 0, AT(bonds), ONLY_VALUE,
     .text = "the bonds: LAMMPS data, or two numbers of atoms on each line"},
    {"chain", "N", OF(TOPOLOGY), 0, OPTION_WHOLE, 0, AT(chain), ONLY_VALUE, .least = 2, .most = INT32_MAX,
     .text = "each N atoms that follow one another are an open chain"},
    {"ring", "N", OF(TOPOLOGY), 0, OPTION_WHOLE, 0, AT(ring), ONLY_VALUE, .least = 3, .most = INT32_MAX,
     .text = "each N atoms that follow one another are a ring"},
    {"every-step", NULL, OF(TOPOLOGY), 0, OPTION_SWITCH, 0, AT(every_step), ONLY_VALUE,
     .text = "the frames are of every step, which the file does not tell"},
    {"csv", "FILE", OF(TOPOLOGY), 0, OPTION_TEXT, 0, AT(csv), ONLY_VALUE,
     .text = "a line for each meeting of bonds, a file that must not exist"},
    {"page", "FILE", OF(TOPOLOGY), 0, OPTION_TEXT, 0, AT(page), ONLY_VALUE,
     .text = "a page with figures, the first crossing drawn, and linking numbers; an HTML file that must not exist"},
    {"links", "first|last|N", OF(TOPOLOGY), 0, OPTION_TEXT, 0, AT(links), ONLY_VALUE,
     .text = "links and knots of this frame instead of crossings; frames are numbered from 0"},
    {"closure", "sphere|directions", OF(TOPOLOGY), 0, OPTION_TEXT, 0, AT(closure), ONLY_VALUE,
     .text = "with --links: knots of open chains too, which are closed in this way"},
    {"help", NULL, ALL, 0, OPTION_SWITCH, 'h', AT(help), ONLY_VALUE, .text = "this text"},
};
const size_t option_count = sizeof option_rows / sizeof *option_rows;

enum { MOST_OPTIONS = sizeof option_rows / sizeof *option_rows, FIRST_CODE = 256 };

enum exit_code usage_error(const char *command, const char *format, ...)
{
  char text[512];
  va_list values;
  va_start(values, format);
  vsnprintf(text, sizeof text, format, values);
  va_end(values);
  fprintf(stderr, "uncross: %s; `uncross %s%s--help` lists what is allowed\n", text_shown(text), command,
          *command ? " " : "");
  return EXIT_BAD_INPUT;
}

/* --- values ------------------------------------------------------------------------------------------------------ */

static bool take_whole(const struct option_row *row, const char *text, uint64_t *value)
{
  char *end;
  errno = 0;
  *value = text[0] >= '0' && text[0] <= '9' ? strtoull(text, &end, 10) : 0;
  if (text[0] >= '0' && text[0] <= '9' && errno == 0 && *end == '\0' && *value >= row->least && *value <= row->most)
    return true;
  fprintf(stderr, "uncross: --%s %s: not a whole number from %" PRIu64 " to %" PRIu64 "\n", row->name, text_shown(text),
          row->least, row->most);
  return false;
}

static bool take_real(const struct option_row *row, const char *text, double *value)
{
  char *end;
  *value = strtod(text, &end);
  if (end != text && *end == '\0' && *value >= row->low && *value <= row->high)
    return true;
  fprintf(stderr, "uncross: --%s %s: not a number from %g to %g\n", row->name, text_shown(text), row->low, row->high);
  return false;
}

static bool take_text(const struct option_row *row, const char *text, const char **value)
{
  *value = text;
  if (*text)
    return true;
  fprintf(stderr, "uncross: --%s: an empty value; allowed: %s\n", row->name, row->argument);
  return false;
}

static bool take(const struct option_row *row, const char *text, struct arguments *a)
{
  char *place = (char *)a + row->at;
  bool ok = true;
  switch (row->type) {
  case OPTION_SWITCH:
    *(bool *)place = true;
    break;
  case OPTION_TEXT:
    ok = take_text(row, text, (const char **)(void *)place);
    break;
  case OPTION_WHOLE:
    ok = take_whole(row, text, (uint64_t *)(void *)place);
    break;
  case OPTION_REAL:
    ok = take_real(row, text, (double *)(void *)place);
    break;
  case OPTION_LIST:
    a->set[a->sets++] = text;
    break;
  }
  if (row->flag != OPTION_NOWHERE)
    *(bool *)((char *)a + row->flag) = true;
  return ok;
}

/* --- words ------------------------------------------------------------------------------------------------------- */

/* The rows of a command as getopt_long wants them. */
struct getopt_table {
  struct option option[MOST_OPTIONS + 1];
  char letters[2 * MOST_OPTIONS + 1];
};

static void make_table(enum command_code command, struct getopt_table *t)
{
  size_t options = 0, letters = 0;
  memset(t, 0, sizeof *t);
  for (size_t k = 0; k < option_count; k++) {
    const struct option_row *row = &option_rows[k];
    if (!option_is_of(row, command))
      continue;
    t->option[options++] = (struct option){row->name, row->argument != NULL, NULL, FIRST_CODE + (int)k};
    if (row->letter)
      t->letters[letters++] = row->letter;
    if (row->letter && row->argument)
      t->letters[letters++] = ':';
  }
}

static const struct option_row *row_of(enum command_code command, int code)
{
  if (code >= FIRST_CODE)
    return &option_rows[code - FIRST_CODE];
  for (size_t k = 0; k < option_count; k++)
    if (option_rows[k].letter == code && option_is_of(&option_rows[k], command))
      return &option_rows[k];
  return NULL;
}

static bool takes_many(const struct command *c)
{
  return strstr(c->files, "...") != NULL;
}

/* --steps and --seed beside --set of the same key: one of the two values would be dropped. */
static bool is_set_twice(const struct arguments *a, const char *key, bool has, uint64_t value, char *text, size_t size)
{
  const size_t length = strlen(key);
  for (size_t k = 0; has && k < a->sets; k++)
    if (strncmp(a->set[k], key, length) == 0 && a->set[k][length] == '=') {
      snprintf(text, size, "--%s %" PRIu64 " and --set %s are one key; allowed: one of them", key, value, a->set[k]);
      return true;
    }
  return false;
}

static enum exit_code check_words(enum command_code command, int files, const struct arguments *a)
{
  const struct command *c = &commands[command];
  if (files != c->file_count && !(takes_many(c) && files > 1))
    return usage_error(c->name, "%s: %s", c->name,
                       c->file_count == 2   ? "two files are needed"
                       : c->file_count == 0 ? "takes no file"
                       : files == 0         ? "a file is missing"
                                            : "one file only");
  for (size_t k = 0; k < option_count; k++)
    if (option_rows[k].needed >> command & 1u &&
        !*(const char *const *)(const void *)((const char *)a + option_rows[k].at))
      return usage_error(c->name, "%s: --%s %s is missing", c->name, option_rows[k].name, option_rows[k].argument);
  char twice[256];
  if (command == COMMAND_RUN && (is_set_twice(a, "steps", a->has_steps, a->steps, twice, sizeof twice) ||
                                 is_set_twice(a, "seed", a->has_seed, a->seed, twice, sizeof twice)))
    return usage_error(c->name, "%s: %s", c->name, twice);
  return EXIT_DONE;
}

/* What getopt_long did not take. It would print the word as it is, which may act on a terminal. */
static enum exit_code refuse_word(enum command_code command, const char *word)
{
  const char *const name = commands[command].name;
  const struct option_row *row = optopt ? row_of(command, optopt) : NULL;
  if (row)
    return row->argument
               ? usage_error(name, "%s: option '--%s' requires an argument (%s)", name, row->name, row->argument)
               : usage_error(name, "%s: option '--%s' takes no argument", name, row->name);
  return optopt ? usage_error(name, "%s: unrecognized option '-%c'", name, optopt)
                : usage_error(name, "%s: unrecognized option '%s', or several begin like it", name, word);
}

enum exit_code arguments_read(enum command_code command, int count, char **words, struct arguments *a)
{
  struct getopt_table table;
  int code;
  *a = (struct arguments){.false_alarm = 1e-3, .seconds = 600};
  a->set = calloc((size_t)count + 1, sizeof *a->set);
  if (!a->set) {
    fprintf(stderr, "uncross: no memory to begin with\n");
    return EXIT_TROUBLE;
  }
  make_table(command, &table);
  opterr = 0;
  while ((code = getopt_long(count, words, table.letters, table.option, NULL)) != -1) {
    const struct option_row *row = row_of(command, code);
    if (!row)
      return refuse_word(command, words[optind - 1]);
    if (!take(row, optarg, a))
      return EXIT_BAD_INPUT;
  }
  if (a->help)
    return EXIT_DONE;
  for (int k = 0; k < 2 && optind + k < count; k++)
    a->file[k] = words[optind + k];
  a->all_files = words + optind;
  a->files = (size_t)(count - optind);
  return check_words(command, count - optind, a);
}

void arguments_free(struct arguments *a)
{
  free(a->set);
  a->set = NULL;
}
