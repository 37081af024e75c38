/* Tables of observables, read. */
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/opening.h"
#include "oracle/judge.h"

enum column { NAME, VALUE, ERROR, BLOCKS, TIME, THEORY, RESOLVE, BOUND, COLUMNS };

static const char *const column_names[COLUMNS] = {"observable", "value",  "error",   "blocks",
                                                  "time",       "theory", "resolve", "bound"};
static const char columns_allowed[] =
    "observable, value, error, blocks, time; also theory, bound, and resolve (which our table needs)";

#define SAME_TIME 1e-6 /* relative: lengths of blocks that are the same but for their decimals */

/* Where the reader is, and what the header said. */
struct reader {
  const char *path;
  size_t line;
  const struct observable_means *reference; /* NULL: this is it */
  size_t cells;                             /* columns of the table; 0 before its header */
  enum column at[COLUMNS];                  /* [cells] */
  struct observable_means *means;
  struct message *message;
};

struct cell {
  const char *text; /* blanks around it are cut off */
  size_t column;    /* in the file, from 1 */
};

static bool complain(const struct reader *r, const struct cell *cell, const char *what, const char *allowed)
{
  return message_at(r->message, r->path, r->line, cell->column, "%s%.60s%s%s; %s", cell->text[0] ? "'" : "nothing",
                    cell->text, cell->text[0] ? "' " : " ", what, allowed);
}

/* Takes a line apart, in place. The number of cells; room + 1 if there are more. */
static size_t split(char *line, struct cell *cell, size_t room)
{
  size_t count = 0;
  for (char *at = line;; at++) {
    char *end = at + strcspn(at, ",");
    const bool last = *end == '\0';
    char *first = at + strspn(at, " \t"), *behind = end;
    *end = '\0';
    while (behind > first && (behind[-1] == ' ' || behind[-1] == '\t'))
      *--behind = '\0';
    if (count == room)
      return room + 1;
    cell[count++] = (struct cell){first, (size_t)(first - line) + 1};
    at = end;
    if (last)
      return count;
  }
}

static bool take_header(struct reader *r, const struct cell *cell, size_t cells)
{
  bool given[COLUMNS] = {false};
  for (size_t k = 0; k < cells; k++) {
    size_t c = 0;
    while (c < COLUMNS && strcmp(cell[k].text, column_names[c]) != 0)
      c++;
    if (c == COLUMNS || given[c])
      return complain(r, &cell[k], c == COLUMNS ? "is no column" : "is there twice", columns_allowed);
    given[c] = true;
    r->at[k] = (enum column)c;
  }
  for (size_t c = 0; c < COLUMNS; c++)
    if (!given[c] && c != THEORY && c != BOUND && (c != RESOLVE || !r->reference))
      return message_at(r->message, r->path, r->line, 1, "no column '%s'; columns are %s", column_names[c],
                        columns_allowed);
  r->cells = cells;
  return true;
}

static bool parse_number(const char *text, double *x)
{
  char *end;
  *x = strtod(text, &end);
  return end != text && *end == '\0' && isfinite(*x);
}

static bool take_name(struct reader *r, const struct cell *cell, struct observable_mean *row)
{
  if (cell->text[0] == '\0' || strlen(cell->text) >= sizeof row->name)
    return complain(r, cell, "is no name of an observable", "names have 1 to 47 bytes");
  if (observable_means_find(r->means, cell->text))
    return complain(r, cell, "is there twice", "each observable has one row");
  if (r->reference && !observable_means_find(r->reference, cell->text))
    return complain(r, cell, "is no observable of the reference table", "docs/judging.md lists them");
  snprintf(row->name, sizeof row->name, "%s", cell->text);
  return true;
}

static bool in_range(enum column column, double x)
{
  switch (column) {
  case ERROR:
    return x >= 0.0;
  case BLOCKS:
    return x >= 2.0 && x == floor(x);
  case TIME:
  case RESOLVE:
  case BOUND:
    return x > 0.0;
  default:
    return true;
  }
}

static bool take_cell(struct reader *r, const struct cell *cell, enum column column, struct observable_mean *row)
{
  static const char *const allowed[COLUMNS] = {
      [VALUE] = "allowed is a finite number",
      [ERROR] = "allowed is one standard error, not negative; 0 only if all blocks are equal",
      [BLOCKS] = "allowed is a whole number, 2 or more",
      [TIME] = "allowed is the length of a block in t0, above 0",
      [THEORY] = "allowed is a finite number, or nothing",
      [RESOLVE] = "allowed is a number above 0, or nothing where there is a bound",
      [BOUND] = "allowed is a number above 0, or nothing"};
  double *const place[COLUMNS] = {
      [VALUE] = &row->value,   [ERROR] = &row->error,     [BLOCKS] = &row->blocks, [TIME] = &row->time,
      [THEORY] = &row->theory, [RESOLVE] = &row->resolve, [BOUND] = &row->bound};
  if (column == NAME)
    return take_name(r, cell, row);
  if (column >= THEORY && cell->text[0] == '\0')
    return true;
  if (!parse_number(cell->text, place[column]))
    return complain(r, cell, "is not a number", allowed[column]);
  return in_range(column, *place[column]) || complain(r, cell, "is out of range", allowed[column]);
}

/* The cell of this column, which the table has. */
static const struct cell *cell_of(const struct reader *r, const struct cell *cell, enum column column)
{
  size_t k = 0;
  while (k + 1 < r->cells && r->at[k] != column)
    k++;
  return &cell[k];
}

/* A row of our table: what is compared has a scale, what is conserved keeps its own bound. */
static bool check_ours(struct reader *r, const struct cell *cell, const struct observable_mean *row)
{
  if (isnan(row->resolve) == isnan(row->bound))
    return complain(r, cell_of(r, cell, RESOLVE), "is not enough or too much",
                    "a row of the reference table has `resolve` or `bound`, and not both");
  if (!isnan(row->bound))
    return observable_rms(row) <= row->bound ||
           complain(r, cell_of(r, cell, VALUE), "is out of range", "the reference must keep its own bound");
  if (row->value == 0.0 || row->error == 0.0)
    return complain(r, cell_of(r, cell, row->value == 0.0 ? VALUE : ERROR), "is out of range",
                    "values and errors of the reference table are not 0");
  return true;
}

/* A row of theirs: averages over another time are another observable. */
static bool check_theirs(struct reader *r, const struct cell *cell, const struct observable_mean *row)
{
  const double ours = observable_means_find(r->reference, row->name)->time;
  char allowed[96];
  snprintf(allowed, sizeof allowed, "blocks of this observable are %.10g t0 long (docs/judging.md)", ours);
  return fabs(row->time - ours) <= SAME_TIME * ours || complain(r, cell_of(r, cell, TIME), "is another time", allowed);
}

static bool take_row(struct reader *r, const struct cell *cell, size_t cells)
{
  struct observable_mean row = {.theory = NAN, .resolve = NAN, .bound = NAN};
  if (cells != r->cells)
    return message_at(r->message, r->path, r->line, 1, "%s than the %zu columns of the header",
                      cells < r->cells ? "fewer" : "more", r->cells);
  if (r->means->count == OBSERVABLES_MOST)
    return message_at(r->message, r->path, r->line, 1, "too many rows; %d are allowed", OBSERVABLES_MOST);
  for (size_t k = 0; k < cells; k++)
    if (!take_cell(r, &cell[k], r->at[k], &row))
      return false;
  if (!(r->reference ? check_theirs(r, cell, &row) : check_ours(r, cell, &row)))
    return false;
  r->means->row[r->means->count++] = row;
  return true;
}

static bool read_lines(struct reader *r, FILE *in)
{
  char text[512];
  for (r->line = 1; fgets(text, sizeof text, in); r->line++) {
    struct cell cell[COLUMNS + 1];
    const size_t length = strcspn(text, "\r\n");
    if (text[length] == '\0' && !feof(in))
      return message_at(r->message, r->path, r->line, 1, "no line of text; lines have at most %zu bytes",
                        sizeof text - 2);
    text[length] = '\0';
    if (text[0] == '#' || text[strspn(text, " \t")] == '\0')
      continue;
    const size_t cells = split(text, cell, COLUMNS);
    if (!(r->cells == 0 ? take_header(r, cell, cells < COLUMNS ? cells : COLUMNS) : take_row(r, cell, cells)))
      return false;
  }
  if (ferror(in))
    return message_set(r->message, "%s: cannot be read: %s", r->path, strerror(errno));
  return r->means->count > 0 ||
         message_set(r->message, "%s: holds no observables; a table has a header and rows", r->path);
}

bool observable_means_read(const char *path, const struct observable_means *reference, struct observable_means *means,
                           struct message *message)
{
  means->count = 0;
  struct reader reader = {.path = path, .reference = reference, .means = means, .message = message};
  uint64_t bytes;
  FILE *in = open_input(path, &bytes, message);
  if (!in)
    return false;
  const bool ok = read_lines(&reader, in);
  fclose(in);
  return ok;
}

double observable_rms(const struct observable_mean *row)
{
  return hypot(row->value, sqrt(row->blocks - 1.0) * row->error);
}

const struct observable_mean *observable_means_find(const struct observable_means *means, const char *name)
{
  for (size_t k = 0; k < means->count; k++)
    if (strcmp(means->row[k].name, name) == 0)
      return &means->row[k];
  return NULL;
}
