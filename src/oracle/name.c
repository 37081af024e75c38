#include "oracle/name.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "oracle/called.h"
#include "oracle/tolerance.h"

#define SECONDS 600 /* uncross-name ends itself after a tenth of it on a core of its own */

/* --- the case ----------------------------------------------------------------------------------------------------- */

/* What a case has of a pack, which may come from anywhere and may have tables of other names. */
static bool is_of_operators(const struct pack_table *t)
{
  static const char *const kinds[] = {"in.", "out.", "bound."};
  bool any = false;
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
    any |= strncmp(t->name, kinds[k], strlen(kinds[k])) == 0;
  return any;
}

/* PREFIX.X of a table out.X; its numbers are not copied. */
static void put(struct pack *made, const struct pack_table *t, const char *prefix)
{
  struct pack_table *new = &made->table[made->count++];
  *new = *t;
  if (prefix)
    snprintf(new->name, sizeof new->name, "%s.%.18s", prefix, t->name + strlen("out."));
}

static bool put_tolerance(struct pack *made, const struct oracle_pair *p)
{
  struct pack_table t = *p->ours;
  t.real = true;
  t.rows = p->ours->rows < p->theirs->rows ? p->ours->rows : p->theirs->rows;
  t.value.number = calloc((size_t)t.rows * t.columns + 1, sizeof *t.value.number);
  if (!t.value.number)
    return false;
  struct tolerance_known known = {0};
  struct oracle_pair pair = *p;
  pair.known = &known;
  for (uint32_t row = 0; row < t.rows; row++)
    for (uint32_t column = 0; column < t.columns; column++)
      t.value.number[(size_t)row * t.columns + column] = oracle_tolerance(&pair, row, column);
  tolerance_forget(&known);
  put(made, &t, "tolerance");
  return true;
}

static void put_first(struct pack *made, const struct pack_table *t, int64_t values[2])
{
  struct pack_table first = *t;
  first.real = false, first.rows = 1, first.columns = 2, first.value.integer = values;
  snprintf(first.component[0], PACK_WORD, "row");
  snprintf(first.component[1], PACK_WORD, "single");
  put(made, &first, "first");
}

static bool is_made_here(const struct pack_table *t)
{
  return strncmp(t->name, "tolerance.", strlen("tolerance.")) == 0;
}

static bool write_case(const struct oracle_pair *first, uint32_t row, const char *path, struct message *message)
{
  int64_t values[2] = {row, first->rounding > 0x1p-30};
  struct pack made = {0, calloc(3 * first->pack->count + 1, sizeof *made.table), false};
  bool ok = made.table != NULL;
  for (size_t k = 0; ok && k < first->pack->count; k++) {
    struct oracle_pair pair = *first;
    const struct pack_table *t = pair.ours = &first->pack->table[k];
    if (is_of_operators(t))
      put(&made, t, NULL);
    pair.theirs = strncmp(t->name, "out.", 4) == 0 ? oracle_sibling_of_theirs(&pair, t->name) : NULL;
    if (!pair.theirs || pair.theirs->columns != t->columns)
      continue;
    put(&made, pair.theirs, "theirs");
    ok = put_tolerance(&made, &pair);
    if (t == first->ours)
      put_first(&made, t, values);
  }
  FILE *out = ok ? fopen(path, "wbx") : NULL;
  ok = ok ? (out || message_set(message, "%s: cannot create: %s", path, strerror(errno)))
          : message_no_memory(message, "memory is short");
  ok = ok && pack_write(&made, out, path, message);
  if (out && fclose(out) != 0)
    ok = message_set(message, "%s: cannot write", path);
  for (size_t k = 0; k < made.count; k++)
    if (is_made_here(&made.table[k]))
      free(made.table[k].value.data);
  free(made.table);
  return ok;
}

/* --- the program that reads it ------------------------------------------------------------------------------------ */

/* The first line of the file, as a terminal can show it. */
static bool take_line(const char *path, char text[ORACLE_TEXT], struct message *message)
{
  char line[ORACLE_TEXT] = "";
  FILE *in = fopen(path, "r");
  const bool ok = in && fgets(line, sizeof line, in) && line[0] != '\n';
  if (in)
    fclose(in);
  line[strcspn(line, "\n")] = '\0';
  text_escape(line, text, ORACLE_TEXT);
  return ok || message_set(message, "uncross-name says nothing");
}

/* words: of the command; they end with NULL. */
static bool ask(const char *const *words, const char *folder, char text[ORACLE_TEXT], struct message *message)
{
  char said[PATH_MAX];
  int status = 0;
  const char *namer = words[0];
  snprintf(said, sizeof said, "%s/said", folder);
  const struct call call = {"uncross-name", words, said, folder, SECONDS};
  bool ok = (access(namer, X_OK) == 0 ||
             message_set(message, "there is no program %s; make puts it there", text_shown(namer))) &&
            called_run(&call, &status, message);
  if (ok && status == CALLED_NO_PROGRAM)
    ok = message_set(message, "%s cannot be run; it needs /usr/bin/python3, which `apt-get install python3` installs",
                     text_shown(namer));
  ok = ok && (status == 0 || message_set(message, "uncross-name ended with exit code %d", status));
  ok = ok && take_line(said, text, message);
  remove(said);
  return ok;
}

bool oracle_name(const struct oracle_pair *first, uint32_t row, const struct oracle_options *o, char text[ORACLE_TEXT],
                 struct message *message)
{
  char folder[PATH_MAX - 64], path[PATH_MAX];
  const char *temporary = getenv("TMPDIR");
  struct message why = {.text = ""};
  text[0] = '\0';
  if (o->case_file)
    return write_case(first, row, o->case_file, message);
  if (!o->namer)
    return true;
  snprintf(folder, sizeof folder, "%s/uncross-name.XXXXXX", temporary && temporary[0] ? temporary : "/tmp");
  if (o->scratch)
    snprintf(folder, sizeof folder, "%s", o->scratch);
  const bool there =
      o->scratch || mkdtemp(folder) || message_set(&why, "%s: cannot create: %s", folder, strerror(errno));
  snprintf(path, sizeof path, "%s/case.h5", folder);
  const char *const words[] = {o->namer, path, NULL};
  if (!there || !write_case(first, row, path, &why) || !ask(words, folder, text, &why))
    snprintf(text, ORACLE_TEXT, "no name: %.500s", why.text);
  if (there)
    remove(path);
  if (there && !o->scratch)
    called_clean(folder);
  return true;
}

void oracle_name_trace(const char *start, const char *theirs, const struct oracle_options *o, char text[ORACLE_TEXT])
{
  const char *const words[] = {o->namer, start, theirs, NULL};
  struct message why = {.text = ""};
  text[0] = '\0';
  if (o->namer && !ask(words, o->scratch, text, &why))
    snprintf(text, ORACLE_TEXT, "no name: %.500s", why.text);
}
