/* Two traces: the first step and stage at which they differ. Columns go by name. */
#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/opening.h"
#include "base/text.h"
#include "oracle/check.h"

enum { COLUMNS = 16, NAME = 32 };

/* Sums of the same state differ by the order of their terms: less than this of the energies. That allows for 10^6 terms
 * with an error of 2^-53 of the largest partial sum each. */
#define SUMS 1e-9

struct trace {
  const char *path;
  FILE *in;
  size_t columns, line, room;
  bool too_long; /* so no more lines were read */
  char name[COLUMNS][NAME];
  char *text, *value[COLUMNS];
};

/* Cuts a line at its commas. */
static size_t split(char *text, char *value[COLUMNS])
{
  size_t n = 0;
  text[strcspn(text, "\r\n")] = '\0';
  for (char *at = text; at && n < COLUMNS;) {
    value[n++] = at;
    at = strchr(at, ',');
    if (at)
      *at++ = '\0';
  }
  return n;
}

/* The next line, cut. False at the end. */
static bool next_row(struct trace *t, size_t *values)
{
  const ssize_t length = text_line(&t->text, &t->room, t->in);
  t->too_long |= length == TEXT_TOO_LONG;
  if (length < 0)
    return false;
  t->line++;
  *values = split(t->text, t->value);
  return true;
}

static int column_of(const struct trace *t, const char *name)
{
  for (size_t k = 0; k < t->columns; k++)
    if (strcmp(t->name[k], name) == 0)
      return (int)k;
  return -1;
}

static bool open_trace(const char *path, struct trace *t, struct message *message)
{
  uint64_t bytes;
  *t = (struct trace){.path = path, .in = open_input(path, &bytes, message)};
  if (!t->in)
    return false;
  if (!next_row(t, &t->columns))
    return message_set(message, "%s: cannot be read; a trace is wanted", path);
  for (size_t k = 0; k < t->columns; k++) {
    snprintf(t->name[k], NAME, "%s", t->value[k]);
    for (size_t j = 0; j < k; j++)
      if (strcmp(t->name[j], t->name[k]) == 0)
        return message_at(message, path, 1, 1, "there are two columns %.31s", t->name[k]);
  }
  const char *missing = column_of(t, "step") < 0                                       ? "step"
                        : column_of(t, "stage") < 0                                    ? "stage"
                        : column_of(t, "state_hash") < 0 && column_of(t, "digest") < 0 ? "state_hash or digest"
                                                                                       : NULL;
  return !missing ||
         message_at(message, path, 1, 1, "no column %s; a trace has step, stage, state_hash, digest and sums", missing);
}

static void close_trace(struct trace *t)
{
  if (t->in)
    fclose(t->in);
  free(t->text);
}

bool oracle_is_trace(const char *path)
{
  struct trace t;
  struct message message;
  const bool is = open_trace(path, &t, &message);
  close_trace(&t);
  return is;
}

static const char *value_of(const struct trace *t, const char *name)
{
  const int k = column_of(t, name);
  return k < 0 ? NULL : t->value[k];
}

/* A value to be printed. */
#define SHOWN(trace, name) text_shown(value_of(trace, name))

static double sum_of(const struct trace *t, const char *name)
{
  const char *text = value_of(t, name);
  return text ? strtod(text, NULL) : 0.0;
}

/* --- one row ----------------------------------------------------------------------------------------------------- */

enum difference { NONE, PLACE, HASH, SUM };

/* Hashes, of states and of contacts: a trace may have either of each. */
static const char *const hashes[] = {"state_hash", "digest", "contacts_hash", "contacts_digest"};
enum { OF_STATES = 2, HASHES = sizeof hashes / sizeof *hashes };

static bool is_among(const char *name, size_t first)
{
  for (size_t k = 0; k < first; k++)
    if (strcmp(name, hashes[k]) == 0)
      return true;
  return false;
}

static bool is_sum(const char *name)
{
  return strcmp(name, "step") != 0 && strcmp(name, "stage") != 0 && !is_among(name, OF_STATES);
}

static bool same_hash(const char *a, const char *b)
{
  for (; *a && tolower((unsigned char)*a) == tolower((unsigned char)*b); a++)
    b++;
  return *a == *b;
}

/* A hash that both have. */
static bool hash_differs(const struct trace *ours, const struct trace *theirs, const char *name)
{
  const char *mine = value_of(ours, name), *its = value_of(theirs, name);
  return mine && its && !same_hash(mine, its);
}

/* Their sum of this name is not ours; or their hash, of contacts. */
static bool sum_differs(const struct trace *ours, const struct trace *theirs, const char *name)
{
  if (is_among(name, HASHES))
    return hash_differs(ours, theirs, name);
  const double x = sum_of(ours, name), y = sum_of(theirs, name);
  const double size = 1.0 + fabs(x) + sum_of(ours, "solvent_kinetic") + sum_of(ours, "vertex_kinetic");
  return !(fabs(x - y) <= SUMS * size);
}

static enum difference compare_row(const struct trace *ours, const struct trace *theirs)
{
  if (strtoull(value_of(ours, "step"), NULL, 10) != strtoull(value_of(theirs, "step"), NULL, 10) ||
      strcmp(value_of(ours, "stage"), value_of(theirs, "stage")) != 0)
    return PLACE;
  for (size_t k = 0; k < OF_STATES; k++)
    if (hash_differs(ours, theirs, hashes[k]))
      return HASH;
  for (size_t k = 0; k < theirs->columns; k++)
    if (is_sum(theirs->name[k]) && sum_differs(ours, theirs, theirs->name[k]))
      return SUM;
  return NONE;
}

static void print_sums(const struct trace *ours, const struct trace *theirs, FILE *out)
{
  bool any = false, sums = false;
  for (size_t k = 0; k < theirs->columns; k++) {
    if (!is_sum(theirs->name[k]))
      continue;
    sums = true;
    if (sum_differs(ours, theirs, theirs->name[k])) {
      fprintf(out, "%s %s %s here, %s there", any ? ";" : "sums that differ there:", text_shown(theirs->name[k]),
              SHOWN(ours, theirs->name[k]), text_shown(theirs->value[k]));
      any = true;
    }
  }
  const char *none = sums ? "no sum differs there; the hash is of step and lag, too\n" : "their trace has no sums\n";
  fputs(any ? "\n" : none, out);
}

static void print_first(const struct trace *ours, const struct trace *theirs, enum difference what, FILE *out,
                        struct oracle_summary *s)
{
  snprintf(s->first, sizeof s->first, "step %s, stage %s", SHOWN(ours, "step"), SHOWN(ours, "stage"));
  fprintf(out, "first difference: %s: ", s->first);
  if (what == PLACE)
    fprintf(out, "step %s, stage %s there\n", SHOWN(theirs, "step"), SHOWN(theirs, "stage"));
  else if (what == SUM)
    fputs("the same state, other sums\n", out);
  else if (hash_differs(ours, theirs, "state_hash"))
    fprintf(out, "state hash %s here, %s there\n", SHOWN(ours, "state_hash"), SHOWN(theirs, "state_hash"));
  else
    fprintf(out, "state digest %s here, %s there\n", SHOWN(ours, "digest"), SHOWN(theirs, "digest"));
  if (what != PLACE)
    print_sums(ours, theirs, out);
}

/* --- all rows ---------------------------------------------------------------------------------------------------- */

/* False, with a message, if a row of theirs has not a value for each column. */
static bool compare_rows(struct trace *ours, struct trace *theirs, FILE *out, struct oracle_summary *s,
                         struct message *message)
{
  size_t mine = 0, its = 0;
  for (;;) {
    const bool more = next_row(ours, &mine), there = next_row(theirs, &its);
    if (ours->too_long || theirs->too_long) {
      const struct trace *bad = theirs->too_long ? theirs : ours;
      return message_at(message, bad->path, bad->line + 1, 1, "a line of more than %d bytes", TEXT_LONGEST_LINE);
    }
    if (!more && !there)
      return true;
    if ((more && mine != ours->columns) || (there && its != theirs->columns)) {
      const struct trace *bad = more && mine != ours->columns ? ours : theirs;
      return message_at(message, bad->path, bad->line, 1, "not %zu values; a row has one for each column",
                        bad->columns);
    }
    s->values++;
    if (more != there) {
      const struct trace *longer = more ? ours : theirs;
      if (s->different++ == 0) {
        snprintf(s->first, sizeof s->first, "step %.20s, stage %.20s", SHOWN(longer, "step"), SHOWN(longer, "stage"));
        fprintf(out, "first difference: %s: %s\n", s->first, more ? "missing" : "not here");
      }
      continue;
    }
    const enum difference what = compare_row(ours, theirs);
    if (what != NONE && s->different++ == 0)
      print_first(ours, theirs, what, out, s);
  }
}

static bool columns_are_known(const struct trace *ours, const struct trace *theirs, struct message *message)
{
  for (size_t k = 0; k < theirs->columns; k++)
    if (column_of(ours, theirs->name[k]) < 0 && !is_among(theirs->name[k], HASHES))
      return message_at(message, theirs->path, 1, 1, "unknown column %.31s", theirs->name[k]);
  return true;
}

bool oracle_compare_traces(const char *ours, const char *theirs, FILE *out, struct oracle_summary *s,
                           struct message *message)
{
  struct trace a = {.in = NULL}, b = {.in = NULL};
  *s = (struct oracle_summary){.verdict = ORACLE_SAME};
  const bool ok = open_trace(ours, &a, message) && open_trace(theirs, &b, message) &&
                  columns_are_known(&a, &b, message) && compare_rows(&a, &b, out, s, message);
  close_trace(&a);
  close_trace(&b);
  if (!ok)
    return false;
  s->beyond = s->different;
  s->verdict = s->different ? ORACLE_DIFFERS : ORACLE_SAME;
  fprintf(out, "%" PRIu64 " rows compared, %" PRIu64 " differ\n%s\n", s->values, s->different,
          s->different ? "differs" : "same: every state");
  return true;
}
