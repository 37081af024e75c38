#include "oracle/pack_text.h"
#include "base/text.h"
#include "oracle/pack.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* With a point or an exponent, so that it reads back as a real. */
static void write_decimal(FILE *out, double value)
{
  char text[32];
  snprintf(text, sizeof text, "%.17g", value);
  fprintf(out, "%s%s\n", text, text[strcspn(text, ".en")] ? "" : ".0");
}

bool pack_dump(const struct pack *pack, bool decimal, FILE *out)
{
  fprintf(out, "# %s %d: operator step row table.component value\n", PACK_FORMAT, PACK_VERSION);
  for (size_t n = 0; n < pack->count; n++) {
    const struct pack_table *t = &pack->table[n];
    const char *name = text_shown(t->name), *operator_name = text_shown(t->place.operator_name);
    char component[PACK_COLUMNS][4 * PACK_WORD];
    for (uint32_t k = 0; k < t->columns; k++)
      text_escape(t->component[k], component[k], sizeof component[k]);
    for (uint32_t row = 0; row < t->rows; row++)
      for (uint32_t k = 0; k < t->columns; k++) {
        const size_t at = (size_t)row * t->columns + k;
        fprintf(out, "%s %" PRIu64 " %" PRIu32 " %s.%s ", operator_name, t->place.step, row, name, component[k]);
        if (t->real && isnan(t->value.number[at]))
          fputs("nan\n", out);
        else if (t->real && decimal)
          write_decimal(out, t->value.number[at]);
        else if (t->real)
          fprintf(out, "%a\n", t->value.number[at]);
        else
          fprintf(out, "%" PRId64 "\n", t->value.integer[at]);
      }
  }
  return !ferror(out);
}

#define MOST_TABLES 4096
#define MOST_ROWS (UINT32_MAX / PACK_COLUMNS - 1)

/* --- reading ----------------------------------------------------------------------------------------------------- */

/* One line. A value that is a whole number in decimal digits is kept exactly. */
struct line {
  struct pack_place place;
  uint32_t row;
  size_t column; /* where the name begins, counted from 1 */
  char table[PACK_WORD], component[PACK_WORD];
  bool real;
  int64_t integer;
  double number;
};

/* Rows of all tables of a file. Each row needs a line of its own, so no claimed number asks for memory. */
struct budget {
  uint64_t rows, most;
};

/* What is known of a table while its lines come in, in any order of rows; columns in the order first met. */
struct draft {
  size_t values, room; /* lines so far; rows that fit */
  double *number;      /* [room * PACK_COLUMNS] */
  int64_t *integer;    /* [room * PACK_COLUMNS] */
  uint16_t *given;     /* [room], a bit for each column */
};
_Static_assert(PACK_COLUMNS == 16, "a bit of `given` for each column");

static bool parse_value(const char *text, struct line *line)
{
  char *end;
  errno = 0;
  line->integer = strtoll(text, &end, 10);
  line->real = *end != '\0' || end == text;
  if (!line->real && errno != 0)
    return false;
  line->number = strtod(text, &end); /* -0 keeps its sign */
  return end != text && *end == '\0';
}

/* A whole number in decimal digits, and nothing else. */
static bool parse_whole(const char *word, uint64_t most, uint64_t *value)
{
  char *end;
  errno = 0;
  *value = strtoull(word, &end, 10);
  return word[0] >= '0' && word[0] <= '9' && *end == '\0' && errno == 0 && *value <= most;
}

/* Splits `table.component` at its last dot. */
static bool parse_name(const char *word, struct line *line)
{
  const char *dot = strrchr(word, '.');
  if (!dot || dot == word || dot - word >= PACK_WORD || dot[1] == '\0' || strlen(dot + 1) >= PACK_WORD)
    return false;
  snprintf(line->table, sizeof line->table, "%.*s", (int)(dot - word), word);
  snprintf(line->component, sizeof line->component, "%s", dot + 1);
  return true;
}

enum word { OPERATOR, STEP, ROW, NAME, VALUE, WORDS };

static bool parse_word(const char *text, enum word which, struct line *line)
{
  uint64_t row = 0;
  switch (which) {
  case OPERATOR:
    snprintf(line->place.operator_name, PACK_WORD, "%s", text);
    return text[0] != '\0' && strlen(text) < PACK_WORD;
  case STEP:
    return parse_whole(text, UINT64_MAX, &line->place.step);
  case ROW:
    if (!parse_whole(text, MOST_ROWS, &row))
      return false;
    line->row = (uint32_t)row;
    return true;
  case NAME:
    return parse_name(text, line);
  default:
    return parse_value(text, line);
  }
}

/* Takes a line apart, in place. The column, counted from 1, of what is wrong; 0 if nothing is. */
static size_t parse_line(char *text, struct line *line)
{
  size_t at = strspn(text, " ");
  for (int k = 0; k < WORDS; k++) {
    const size_t length = strcspn(text + at, " "), next = at + length + strspn(text + at + length, " ");
    const bool last = text[next] == '\0';
    text[at + length] = '\0';
    if (k == NAME)
      line->column = at + 1;
    if (!parse_word(text + at, (enum word)k, line))
      return at + 1;
    if (last != (k == WORDS - 1))
      return next + 1;
    at = next;
  }
  return 0;
}

static int column_of(struct pack_table *t, const char *component)
{
  for (uint32_t k = 0; k < t->columns; k++)
    if (strcmp(t->component[k], component) == 0)
      return (int)k;
  if (t->columns == PACK_COLUMNS)
    return -1;
  snprintf(t->component[t->columns], PACK_WORD, "%s", component);
  return (int)t->columns++;
}

/* Numbers stay unset until their lines come, and realloc moves large memory without a look at it: so a row of a large
 * number may well come first, and costs two bytes for each row before it. */
static bool make_room(struct draft *d, uint32_t row)
{
  size_t room = d->room ? d->room : 64;
  while (room <= row)
    room *= 2;
  if (room == d->room)
    return true;
  double *number = realloc(d->number, room * PACK_COLUMNS * sizeof *number);
  d->number = number ? number : d->number;
  int64_t *integer = realloc(d->integer, room * PACK_COLUMNS * sizeof *integer);
  d->integer = integer ? integer : d->integer;
  uint16_t *given = number && integer ? realloc(d->given, room * sizeof *given) : NULL;
  if (!given)
    return false;
  memset(given + d->room, 0, (room - d->room) * sizeof *given);
  d->given = given;
  d->room = room;
  return true;
}

static void draft_free(struct draft *d)
{
  free(d->number);
  free(d->integer);
  free(d->given);
}

/* Consecutive lines mostly belong to one table, so the last one is looked at first. */
static size_t table_of(struct pack *pack, const struct line *line)
{
  for (size_t k = pack->count; k-- > 0;)
    if (pack_find(&(struct pack){.count = 1, .table = &pack->table[k]}, &line->place, line->table))
      return k;
  if (pack->count == MOST_TABLES || !pack_put_integers(pack, &line->place, line->table, "", 0))
    return SIZE_MAX;
  return pack->count - 1;
}

/* NULL, or what is wrong. */
static const char *take(struct pack *pack, struct draft drafts[MOST_TABLES], struct budget *budget,
                        const struct line *line)
{
  size_t n = table_of(pack, line);
  if (n == SIZE_MAX)
    return "more than 4096 tables, or memory is short";
  struct pack_table *t = &pack->table[n];
  struct draft *d = &drafts[n];
  int column = column_of(t, line->component);
  if (column < 0)
    return "more than 16 components in one table";
  if (line->row >= t->rows) {
    budget->rows += line->row + 1 - t->rows;
    t->rows = line->row + 1;
  }
  if (budget->rows > budget->most)
    return "so many rows cannot be in a file of this size: each has a line";
  if (!make_room(d, line->row))
    return "memory is short";
  const unsigned bit = 1u << column;
  if (d->given[line->row] & bit)
    return "given before; each value is given once";
  d->given[line->row] = (uint16_t)(d->given[line->row] | bit);
  const size_t at = (size_t)line->row * PACK_COLUMNS + (size_t)column;
  d->number[at] = line->number;
  d->integer[at] = line->integer;
  d->values++;
  t->real |= line->real;
  return NULL;
}

/* Puts the draft's numbers where they belong, if none is missing. */
static bool finish(struct pack_table *t, const struct draft *d, const char *path, struct message *message)
{
  if (d->values != (size_t)t->rows * t->columns)
    return message_set(message,
                       "%s: %s step %" PRIu64 " %s: %zu values for %" PRIu32 " rows of %" PRIu32
                       " components; each is given once, rows from 0",
                       path, t->place.operator_name, t->place.step, t->name, d->values, t->rows, t->columns);
  int64_t *data = calloc(d->values + 1, sizeof *data);
  if (!data)
    return message_set(message, "%s: memory is short", path);
  free(t->value.data);
  t->value.integer = data;
  for (size_t k = 0; k < d->values; k++) {
    const size_t at = k / t->columns * PACK_COLUMNS + k % t->columns;
    if (t->real)
      t->value.number[k] = d->number[at];
    else
      data[k] = d->integer[at];
  }
  return true;
}

/* word: what is wrong. */
static bool complain(const char *word, const char *path, size_t number, size_t column, struct message *message)
{
  uint64_t value;
  if (parse_whole(word, UINT64_MAX, &value) && value > INT64_MAX)
    return message_at(message, path, number, column,
                      "%" PRIu64 " is too large; whole numbers have 64 bits and a sign, and %" PRId64
                      " without its sign is printed so",
                      value, (int64_t)value);
  return message_at(message, path, number, column,
                    "'%.40s' is not understood; a line is `operator step row table.component value`", text_shown(word));
}

/* Takes line number `number` in, comments and empty lines aside. */
static bool read_line(char *text, struct budget *budget, const char *path, size_t number, struct pack *pack,
                      struct draft drafts[MOST_TABLES], struct message *message)
{
  struct line line = {.row = 0};
  text[strcspn(text, "\r\n")] = '\0';
  if (text[0] == '#' || text[0] == '\0')
    return true;
  const size_t column = parse_line(text, &line);
  if (column > 0)
    return complain(text + column - 1, path, number, column, message);
  const char *wrong = take(pack, drafts, budget, &line);
  return !wrong || message_at(message, path, number, line.column, "%s", wrong);
}

#define LEAST_LINE 12        /* bytes of `o 0 0 t.x 1` and its end */
#define FREE_ROWS (1u << 21) /* so many rows may be claimed for nothing: they cost two bytes each */

/* The rows that a file of this size may have; one that leaves out some is told what is missing. Of a file with holes,
 * what is on the disk counts, which a file system may have compressed. */
static struct budget budget_of(FILE *in)
{
  struct stat status;
  const bool known = fstat(fileno(in), &status) == 0 && status.st_size > 0;
  const uint64_t size = known ? (uint64_t)status.st_size : 0, on_disk = known ? (uint64_t)status.st_blocks * 512 : 0;
  return (struct budget){0, FREE_ROWS + (size < 32 * on_disk ? size : 32 * on_disk) / LEAST_LINE};
}

static bool read_lines(FILE *in, const char *path, struct pack *pack, struct draft drafts[MOST_TABLES],
                       struct message *message)
{
  char *text = NULL;
  size_t room = 0;
  struct budget budget = budget_of(in);
  bool ok = true;
  ssize_t length = 0;
  for (size_t number = 1; ok && (length = text_line(&text, &room, in)) >= 0; number++) {
    const size_t zero = strlen(text);
    ok = zero == (size_t)length
             ? read_line(text, &budget, path, number, pack, drafts, message)
             : message_at(message, path, number, zero + 1, "a NUL byte; a pack is HDF5 or lines of text");
  }
  free(text);
  if (ok && length == TEXT_TOO_LONG)
    return message_set(message, "%s: a line of more than %d bytes; a pack is HDF5 or lines of text", path,
                       TEXT_LONGEST_LINE);
  return ok && (feof(in) || message_set(message, "%s: cannot be read", path));
}

bool pack_text_begins(FILE *in)
{
  static const char ours[] = "# " PACK_FORMAT;
  char *text = NULL;
  size_t room = 0;
  bool begins = false, more = true;
  while (!begins && more && text_line(&text, &room, in) >= 0) {
    struct line line = {.row = 0};
    text[strcspn(text, "\r\n")] = '\0';
    begins = strncmp(text, ours, sizeof ours - 1) == 0;
    more = text[0] == '#' || text[0] == '\0';
    if (!begins && !more)
      begins = parse_line(text, &line) == 0;
  }
  free(text);
  return begins;
}

bool pack_read_text(FILE *in, const char *path, struct pack *pack, struct message *message)
{
  struct draft *drafts = calloc(MOST_TABLES, sizeof *drafts);
  if (!drafts)
    return message_set(message, "%s: memory is short", path);
  bool ok = read_lines(in, path, pack, drafts, message);
  for (size_t n = 0; n < pack->count; n++) {
    ok = ok && finish(&pack->table[n], &drafts[n], path, message);
    draft_free(&drafts[n]);
  }
  free(drafts);
  return ok && (pack->count > 0 || message_set(message, "%s: holds no values; a pack is HDF5 or lines of text", path));
}
