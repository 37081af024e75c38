/* Help, man page and completion, from the tables of commands and options. */
#include <string.h>

#include "cli/command.h"
#include "version.h"

static const char *const code_text[EXIT_CODES] = {
    [EXIT_DONE] = "done",
    [EXIT_TROUBLE] = "no memory, or an internal error",
    [EXIT_BAD_INPUT] = "bad input (options, scene, snapshot): nothing was written",
    [EXIT_STOPPED] =
        ("the run had to stop (a bond too long, a velocity out of range, ...): run.json says why; the last "
         "checkpoint stays"),
    [EXIT_NOT_WRITTEN] = ("a file or DIR could not be written, or another process writes into DIR; a checkpoint that "
                          "was there stays"),
    [EXIT_INTERRUPTED] =
        "interrupted by a signal; a checkpoint was written, --resume goes on (or nothing was, before step 0)",
    [EXIT_CLOSE] = "oracle compare: different, but within the derived tolerances",
    [EXIT_DIFFERS] = "oracle compare: different beyond them, or something is missing; oracle judge: different",
    [EXIT_DAMAGED] = "verify: a file is damaged",
    [EXIT_CROSSED] = "topology: bonds crossed each other between two frames",
    [EXIT_CANNOT_TELL] =
        "oracle judge: cannot tell, since observables are missing, or their blocks too few, equal or too uncertain",
};

static const char title[] = "noncrossing fibers and chains in a hydrodynamic solvent";
static const char method[] =
    "SRD solvent, semiflexible fibers, bonds that exchange momentum instead of crossing: Padding, "
    "JCP 130, 144903, 2009";

enum { MOST_USAGE = 256 };

static bool ends_with(const struct command *c, int code)
{
  return code <= EXIT_BAD_INPUT || c->codes >> code & 1u;
}

/* Besides those that it needs, and --help. */
static bool has_options(enum command_code command)
{
  for (size_t k = 0; k < option_count; k++)
    if (option_is_of(&option_rows[k], command) && !(option_rows[k].needed >> command & 1u) &&
        strcmp(option_rows[k].name, "help") != 0)
      return true;
  return false;
}

/* "run SCENE --out DIR [options]" */
static void usage(enum command_code command, char *text, size_t size)
{
  size_t used = (size_t)snprintf(text, size, "%s%s%s", commands[command].name, *commands[command].files ? " " : "",
                                 commands[command].files);
  for (size_t k = 0; k < option_count; k++)
    if (option_rows[k].needed >> command & 1u)
      used += (size_t)snprintf(text + used, size - used, " --%s %s", option_rows[k].name, option_rows[k].argument);
  snprintf(text + used, size - used, "%s", has_options(command) ? " [options]" : "");
}

/* "--steps N", "-o, --out DIR" */
static int option_words(const struct option_row *row, char *text, size_t size)
{
  char letter[8] = "";
  if (row->letter)
    snprintf(letter, sizeof letter, "-%c, ", row->letter);
  return snprintf(text, size, "%s--%s%s%s", letter, row->name, row->argument ? " " : "",
                  row->argument ? row->argument : "");
}

/* The range, where the text does not tell it. */
static void print_range(FILE *out, const struct option_row *row)
{
  if (row->type == OPTION_WHOLE && row->most == UINT64_MAX)
    fprintf(out, " (%llu .. 2^64-1)", (unsigned long long)row->least);
  else if (row->type == OPTION_WHOLE && row->most == INT64_MAX)
    fprintf(out, " (%llu .. 2^63-1)", (unsigned long long)row->least);
  else if (row->type == OPTION_REAL)
    fprintf(out, " (%g .. %g)", row->low, row->high);
}

static void print_options(FILE *out, enum command_code command)
{
  char words[64];
  for (size_t k = 0; k < option_count; k++) {
    if (!option_is_of(&option_rows[k], command))
      continue;
    option_words(&option_rows[k], words, sizeof words);
    fprintf(out, "  %-24s  %s", words, option_rows[k].text);
    print_range(out, &option_rows[k]);
    fputc('\n', out);
  }
}

static void print_codes(FILE *out, const struct command *c)
{
  fputs("\nexit codes:\n", out);
  for (int code = 0; code < EXIT_CODES; code++)
    if (!c || ends_with(c, code))
      fprintf(out, "  %d  %s\n", code, code_text[code]);
}

void help_command(FILE *out, enum command_code command)
{
  const struct command *c = &commands[command];
  char words[MOST_USAGE];
  usage(command, words, sizeof words);
  fprintf(out, "uncross %s: %s\n%s\nusage: uncross %s\n\noptions:\n", c->name, c->summary, c->text ? c->text : "",
          words);
  print_options(out, command);
  print_codes(out, c);
}

static void list(FILE *out, const char *group)
{
  char words[MOST_USAGE];
  for (int command = 0; command < COMMANDS; command++) {
    const struct command *c = &commands[command];
    if (strncmp(c->name, group, strlen(group)) != 0)
      continue;
    usage((enum command_code)command, words, sizeof words);
    fprintf(out, "  uncross %-37s  %s\n", words, c->summary);
  }
}

void help_group(FILE *out, const char *group)
{
  fprintf(out, "uncross %s: what other implementations are held against (docs/port/README.md)\n\nusage:\n", group);
  list(out, group);
  fprintf(out, "`uncross %s ACTION --help` lists the options and exit codes of one.\n", group);
}

void help_all(FILE *out)
{
  fprintf(out, "uncross: %s\n(%s)\n\nusage:\n", title, method);
  list(out, "");
  fputs("  uncross --help, uncross --version, uncross --cite\n"
        "`uncross COMMAND --help` lists the options of one.\n",
        out);
  print_codes(out, NULL);
  fputs("\nScenes are YAML files: docs/scene.md lists every key, scenes/ holds examples.\n", out);
}

/* --- man page ---------------------------------------------------------------------------------------------------- */

static void roff(FILE *out, const char *text)
{
  for (const char *c = text; *c; c++) {
    if (*c == '\\')
      fputs("\\e", out);
    else if (*c == '-')
      fputs("\\-", out);
    else if ((*c == '.' || *c == '\'') && (c == text || c[-1] == '\n'))
      fprintf(out, "\\&%c", *c);
    else
      fputc(*c, out);
  }
}

static void man_options(FILE *out, enum command_code command)
{
  char words[64];
  for (size_t k = 0; k < option_count; k++) {
    if (!option_is_of(&option_rows[k], command))
      continue;
    option_words(&option_rows[k], words, sizeof words);
    fputs(".TP\n.B ", out);
    roff(out, words);
    fputc('\n', out);
    roff(out, option_rows[k].text);
    print_range(out, &option_rows[k]);
    fputc('\n', out);
  }
}

static void man_codes(FILE *out, const struct command *c)
{
  fputs(".SH EXIT STATUS\n", out);
  for (int code = 0; code < EXIT_CODES; code++) {
    if (c && !ends_with(c, code))
      continue;
    fprintf(out, ".TP\n.B %d\n", code);
    roff(out, code_text[code]);
    fputc('\n', out);
  }
}

/* The name of a command's page: "uncross-oracle-emit". */
static void man_name(FILE *out, const char *name)
{
  fputs("uncross\\-", out);
  for (const char *c = name; *c; c++)
    fputs(*c == ' ' ? "\\-" : (char[2]){*c}, out);
}

void help_names(FILE *out)
{
  for (int command = 0; command < COMMANDS; command++)
    fprintf(out, "%s\n", commands[command].name);
}

void help_man_command(FILE *out, enum command_code command)
{
  const struct command *c = &commands[command];
  char words[MOST_USAGE];
  usage(command, words, sizeof words);
  fputs(".TH ", out);
  man_name(out, c->name);
  fprintf(out, " 1 \"\" \"uncross %s\"\n.SH NAME\n", UNCROSS_VERSION);
  man_name(out, c->name);
  fputs(" \\- ", out);
  roff(out, c->summary);
  fputs("\n.SH SYNOPSIS\n.B uncross\n", out);
  roff(out, words);
  fputs("\n.SH DESCRIPTION\n", out);
  roff(out, c->text ? c->text : c->summary);
  fputs("\n.SH OPTIONS\n", out);
  man_options(out, command);
  man_codes(out, c);
  fputs(".SH SEE ALSO\n.BR uncross (1)\n", out);
}

void help_man(FILE *out)
{
  char words[MOST_USAGE];
  fprintf(out, ".TH UNCROSS 1 \"\" \"uncross %s\"\n.SH NAME\nuncross \\- %s\n.SH SYNOPSIS\n", UNCROSS_VERSION, title);
  for (int command = 0; command < COMMANDS; command++) {
    usage((enum command_code)command, words, sizeof words);
    fputs(".B uncross\n", out);
    roff(out, words);
    fputs("\n.br\n", out);
  }
  fputs(".B uncross \\-\\-help\n.br\n.B uncross \\-\\-version\n.br\n.B uncross \\-\\-cite\n.SH DESCRIPTION\n", out);
  roff(out, method);
  fputs(".\nScenes are YAML files.\n", out);
  for (int command = 0; command < COMMANDS; command++) {
    const struct command *c = &commands[command];
    fprintf(out, ".SH uncross %s %s\n", c->name, c->files);
    roff(out, c->summary);
    fputc('\n', out);
    if (c->text) {
      fputs(".PP\n", out);
      roff(out, c->text);
    }
    man_options(out, (enum command_code)command);
  }
  man_codes(out, NULL);
  fputs(".SH SEE ALSO\n", out);
  for (int command = 0; command < COMMANDS; command++) {
    fputs(".BR ", out);
    man_name(out, commands[command].name);
    fprintf(out, " (1)%s\n", command + 1 < COMMANDS ? "," : "");
  }
}

/* --- completion -------------------------------------------------------------------------------------------------- */

/* The words of commands, or the second ones of a group. */
static void complete_names(FILE *out, const char *group)
{
  const size_t skip = strlen(group);
  const char *last = "";
  for (int command = 0; command < COMMANDS; command++) {
    const char *name = commands[command].name;
    const size_t length = strncmp(name, group, skip) == 0 ? strcspn(name + skip, " ") : 0;
    if (length == 0 || strncmp(last, name + skip, length) == 0)
      continue;
    last = name + skip;
    fprintf(out, "%.*s ", (int)length, last);
  }
}

static void complete_options(FILE *out, enum command_code command)
{
  fprintf(out, "    \"%s\") words=\"", commands[command].name);
  for (size_t k = 0; k < option_count; k++)
    if (option_is_of(&option_rows[k], command))
      fprintf(out, "--%s ", option_rows[k].name);
  fputs("\" ;;\n", out);
}

void help_completion(FILE *out)
{
  fputs("# bash completion of uncross\n"
        "_uncross() {\n"
        "  local current=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]} words=\n"
        "  [ \"$command\" = oracle ] && [ \"$COMP_CWORD\" -gt 2 ] && command=\"oracle ${COMP_WORDS[2]}\"\n"
        "  case $COMP_CWORD:$command in\n"
        "    1:*) words=\"",
        out);
  complete_names(out, "");
  fputs("help --help --version --cite\" ;;\n    2:oracle) words=\"", out);
  complete_names(out, "oracle ");
  fputs("--help\" ;;\n  esac\n  if [ -z \"$words\" ]; then case $command in\n", out);
  for (int command = 0; command < COMMANDS; command++)
    complete_options(out, (enum command_code)command);
  fputs("  esac; fi\n"
        "  if [ \"$COMP_CWORD\" -gt 2 ] && [[ \"$current\" != -* ]] || [ \"$COMP_CWORD\" = 2 ] && [ \"$command\" != "
        "oracle ] &&\n"
        "    [[ \"$current\" != -* ]]; then\n"
        "    mapfile -t COMPREPLY < <(compgen -f -- \"$current\")\n"
        "  else\n"
        "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
        "  fi\n"
        "}\n"
        "complete -o filenames -F _uncross uncross\n",
        out);
}
