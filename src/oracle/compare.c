#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "oracle/name.h"
#include "oracle/schema.h"

/* Doubles in the order of their values, as integers: neighbors differ by one, -0 and +0 by none. */
static int64_t rank_of(double x)
{
  int64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits < 0 ? INT64_MIN - bits : bits;
}

/* Distance in ulps; of integers in units. */
static uint64_t distance(const struct oracle_pair *p, size_t k)
{
  const bool reals = p->ours->real;
  int64_t a = reals ? rank_of(p->ours->value.number[k]) : p->ours->value.integer[k];
  double other = p->theirs->real ? p->theirs->value.number[k] : (double)p->theirs->value.integer[k];
  int64_t b = reals             ? rank_of(other)
              : p->theirs->real ? (fabs(other) < 0x1p62 ? llrint(other) : INT64_MAX)
                                : p->theirs->value.integer[k];
  return a > b ? (uint64_t)a - (uint64_t)b : (uint64_t)b - (uint64_t)a;
}

/* Size of the difference that a tolerance is for. Reals of theirs that stand for integers are taken as they are. */
static double difference(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const size_t k = (size_t)row * p->ours->columns + column;
  if (!p->ours->real && !p->theirs->real)
    return (double)distance(p, k);
  return fabs(pack_value(p->ours, row, column) - pack_value(p->theirs, row, column));
}

struct tally {
  uint64_t values, different, beyond, worst; /* worst: ulps */
  uint64_t nans;                             /* of theirs, where ours is a number */
  uint64_t unjudged;
  double largest, largest_of_all; /* difference over tolerance, where there is one; of the table, of all */
  char first_words[256], meaning[ORACLE_TEXT];
  bool found, found_beyond; /* a first one is known, and beyond tolerance if any is */
  struct oracle_pair first;
  uint32_t row, column;
  double tolerance;
  bool found_plain; /* the first beyond tolerance that is not of a drift, which has all other operators in it */
  struct oracle_pair plain;
  uint32_t plain_row;
};

static void tally_plain(struct tally *t, const struct oracle_pair *p, uint32_t row)
{
  if (t->found_plain && (p->ours == t->plain.ours || oracle_flow(p->ours, t->plain.ours) >= 0))
    return;
  if (oracle_is_drift(p->ours->place.operator_name))
    return;
  t->found_plain = true;
  t->plain = *p;
  t->plain.known = NULL;
  t->plain_row = row;
}

/* largest: size in our table. */
static void tally_value(struct tally *t, const struct oracle_pair *p, double largest, uint32_t row, uint32_t column)
{
  const uint64_t ulps = distance(p, (size_t)row * p->ours->columns + column);
  const double tolerance = oracle_tolerance(p, row, column), size = difference(p, row, column);
  t->values++;
  t->unjudged += largest > 0.0 && tolerance > 0.0 && !(tolerance < largest);
  if (ulps == 0 && size == 0.0)
    return;
  t->different++;
  if (isnan(size))
    t->nans++;
  else
    t->worst = ulps > t->worst ? ulps : t->worst;
  if (tolerance > 0.0 && isfinite(size))
    t->largest = fmax(t->largest, size / tolerance);
  const bool beyond = !(size <= tolerance);
  const bool earlier = t->found && beyond == t->found_beyond && oracle_flow(p->ours, t->first.ours) < 0;
  if ((beyond && !t->found_beyond) || !t->found || earlier) {
    t->first = *p;
    t->first.known = NULL;
    t->row = row, t->column = column, t->tolerance = tolerance;
    t->found = true;
    t->found_beyond = beyond;
  }
  t->beyond += beyond;
  if (beyond)
    tally_plain(t, p, row);
}

static void print_number(FILE *out, const struct pack_table *t, uint32_t row, uint32_t column)
{
  const size_t k = (size_t)row * t->columns + column;
  if (t->real && isnan(t->value.number[k]))
    fputs("NaN", out);
  else if (t->real)
    fprintf(out, "%.17g", t->value.number[k]);
  else
    fprintf(out, "%" PRId64, t->value.integer[k]);
}

static const char *entity_of(const struct pack_table *t)
{
  const struct oracle_table *row = oracle_table_of(t->place.operator_name, t->name, NULL);
  return row ? row->source->of->word : "row";
}

/* Operator, step and table, at the beginning of a line. A pack may come from anywhere, and its names with it. */
static void print_place(FILE *out, const struct pack_table *t)
{
  fprintf(out, "%-18s %6" PRIu64 "  %-14s", text_shown(t->place.operator_name), t->place.step, text_shown(t->name));
}

static void print_first(struct tally *t, FILE *out)
{
  const struct oracle_pair *p = &t->first;
  const uint64_t ulps = distance(p, (size_t)t->row * p->ours->columns + t->column);
  const double size = difference(p, t->row, t->column);
  snprintf(t->first_words, sizeof t->first_words, "%s, step %" PRIu64 ", %s %" PRIu32 ", %s.%s",
           text_shown(p->ours->place.operator_name), p->ours->place.step, entity_of(p->ours), t->row,
           text_shown(p->ours->name), text_shown(p->ours->component[t->column]));
  fprintf(out, "first difference: %s: ", t->first_words);
  print_number(out, p->ours, t->row, t->column);
  fputs(" here, ", out);
  print_number(out, p->theirs, t->row, t->column);
  if (isnan(size))
    fputs(" there: not a number\n", out);
  else
    fprintf(out, " there: %" PRIu64 " %s, tolerance %.3g\n", ulps, p->ours->real ? "ulps" : "units", t->tolerance);
}

/* Names of our columns that they have not. */
static void print_missing_columns(const struct oracle_pair *p, FILE *out)
{
  print_place(out, p->ours);
  if (p->theirs->unnamed) {
    fprintf(out, " %" PRIu32 " columns here, %" PRIu32 " without names there\n", p->ours->columns, p->theirs->columns);
    return;
  }
  fputs(" columns that are not there:", out);
  for (uint32_t k = 0; k < p->ours->columns; k++) {
    bool there = false;
    for (uint32_t j = 0; j < p->theirs->columns; j++)
      there |= strcmp(p->ours->component[k], p->theirs->component[j]) == 0;
    fprintf(out, "%s%s", there ? "" : " ", there ? "" : text_shown(p->ours->component[k]));
  }
  fputc('\n', out);
}

/* Tables of unlike shape are compared as far as both go; what is missing counts as beyond any tolerance. */
static void tally_table(struct tally *t, const struct oracle_pair *p, FILE *out)
{
  const struct tally before = *t;
  const uint32_t rows = p->ours->rows < p->theirs->rows ? p->ours->rows : p->theirs->rows;
  if (p->ours->columns != p->theirs->columns) {
    print_missing_columns(p, out);
    t->beyond++;
    return;
  }
  const double largest = tolerance_largest(p->ours, 0, PACK_COLUMNS);
  t->worst = t->nans = 0;
  t->largest = 0.0;
  struct tolerance_known known = {0};
  struct oracle_pair pair = *p;
  pair.known = &known;
  for (uint32_t row = 0; row < rows; row++)
    for (uint32_t column = 0; column < p->ours->columns; column++)
      tally_value(t, &pair, largest, row, column);
  tolerance_forget(&known);
  if (t->different > before.different) {
    print_place(out, p->ours);
    fprintf(out, " of %" PRIu64 " values %" PRIu64 " differ, %" PRIu64 " beyond tolerance, by up to %" PRIu64 " %s%s",
            t->values - before.values, t->different - before.different, t->beyond - before.beyond, t->worst,
            p->ours->real ? "ulps" : "units", t->largest > 0.0 || t->nans ? "" : "\n");
  }
  if (t->largest > 0.0)
    fprintf(out, ", %.2g of the tolerance%s", t->largest, t->nans ? "" : "\n");
  if (t->nans)
    fprintf(out, "; %" PRIu64 " are NaN\n", t->nans);
  t->largest_of_all = fmax(t->largest_of_all, t->largest);
  if (p->ours->rows != p->theirs->rows) {
    fprintf(out, "  rows: %" PRIu32 " here, %" PRIu32 " there\n", p->ours->rows, p->theirs->rows);
    if (!t->found_beyond || oracle_flow(p->ours, t->first.ours) < 0) {
      t->found = t->found_beyond = true;
      t->first = *p;
      t->row = rows, t->column = 0, t->tolerance = 0.0;
    }
    t->beyond++;
  }
}

static bool wanted(const char *only, const char *name)
{
  const size_t length = strlen(name);
  for (const char *at = only; at && (at = strstr(at, name)); at += length)
    if ((at == only || at[-1] == ',') && (at[length] == ',' || at[length] == '\0'))
      return true;
  return !only;
}

/* Whole reals may stand as integers in a text. */
static bool same_values(const struct pack_table *mine, const struct pack_table *its)
{
  if (mine->real == its->real)
    return memcmp(mine->value.data, its->value.data, (size_t)mine->rows * mine->columns * 8) == 0;
  for (uint32_t row = 0; row < mine->rows; row++)
    for (uint32_t k = 0; k < mine->columns; k++)
      if (pack_value(mine, row, k) != pack_value(its, row, k))
        return false;
  return true;
}

/* Inputs that they repeat must be ours, else the outputs are answers to another question. */
static bool same_inputs(const struct pack *ours, const struct pack *theirs, const struct pack_place *place,
                        const char **other)
{
  for (size_t k = 0; k < ours->count; k++) {
    const struct pack_table *mine = &ours->table[k];
    const struct pack_table *its = pack_find(theirs, place, mine->name);
    if (pack_find(ours, place, mine->name) != mine || strncmp(mine->name, "in.", 3) != 0 || !its)
      continue;
    *other = mine->name;
    if (mine->rows != its->rows || mine->columns != its->columns || !same_values(mine, its))
      return false;
  }
  return true;
}

/* One output table of ours. */
static void look_at(struct tally *t, const struct pack *ours, const struct pack *theirs, const struct pack_table *mine,
                    double rounding, FILE *out)
{
  const struct pack_table *its = pack_find(theirs, &mine->place, mine->name);
  const char *other = NULL;
  if (its && same_inputs(ours, theirs, &mine->place, &other)) {
    tally_table(t, &(struct oracle_pair){ours, theirs, mine, its, rounding, NULL}, out);
  } else if (its || mine->rows > 0) {
    if (!t->first_words[0])
      snprintf(t->first_words, sizeof t->first_words, "%s, step %" PRIu64 ", %s: not %s%s",
               text_shown(mine->place.operator_name), mine->place.step, text_shown(mine->name),
               its ? "compared, for another input: " : "there", its ? text_shown(other) : "");
    print_place(out, mine);
    fprintf(out, " not %s%s\n", its ? "compared, for another input: " : "there", its ? text_shown(other) : "");
    t->beyond++;
  }
}

/* Of events and hits, two tables of the same rows, the first row that differs counts: what follows is consequence. */
static void prefer_earlier_hit(struct tally *t)
{
  const struct oracle_pair *event = &t->first;
  if (!t->found_beyond || strcmp(event->ours->name, "out.event") != 0)
    return;
  struct oracle_pair hit = *event;
  hit.ours = oracle_sibling(event, "out.hit");
  hit.theirs = oracle_sibling_of_theirs(event, "out.hit");
  if (!hit.ours || !hit.theirs || hit.ours->columns != hit.theirs->columns)
    return;
  for (uint32_t row = 0; row < t->row && row < hit.ours->rows && row < hit.theirs->rows; row++)
    for (uint32_t column = 0; column < hit.ours->columns; column++) {
      const double tolerance = oracle_tolerance(&hit, row, column);
      if (difference(&hit, row, column) <= tolerance)
        continue;
      t->first = hit;
      t->row = row, t->column = column, t->tolerance = tolerance;
      return;
    }
}

static bool print_difference(struct tally *t, const struct oracle_options *options, FILE *out, struct message *message)
{
  const struct oracle_pair *p = &t->first;
  if (!t->found)
    return true;
  if (t->row < p->theirs->rows && t->row < p->ours->rows) {
    print_first(t, out);
  } else {
    snprintf(t->first_words, sizeof t->first_words, "%s, step %" PRIu64 ", %s %" PRIu32 ": %s",
             text_shown(p->ours->place.operator_name), p->ours->place.step, entity_of(p->ours), t->row,
             t->row < p->ours->rows ? "missing" : "not here");
    fprintf(out, "first difference: %s\n", t->first_words);
  }
  const bool plain = t->found_plain && oracle_is_drift(p->ours->place.operator_name);
  const bool ok = oracle_name(plain ? &t->plain : p, plain ? t->plain_row : t->row, options, t->meaning, message);
  if (t->meaning[0])
    fprintf(out, "this pattern: %s%s%s%s\n", plain ? "in " : "",
            plain ? text_shown(t->plain.ours->place.operator_name) : "", plain ? ": " : "", t->meaning);
  return ok;
}

bool oracle_compare(const struct pack *ours, const struct pack *theirs, const struct oracle_options *options, FILE *out,
                    struct oracle_summary *summary, struct message *message)
{
  struct tally t = {0};
  bool any = false;
  for (size_t k = 0; k < ours->count; k++) {
    const struct pack_table *mine = &ours->table[k];
    if (!wanted(options->only, mine->place.operator_name))
      continue;
    const bool output = strncmp(mine->name, "out.", 4) == 0;
    any |= output;
    if (output)
      look_at(&t, ours, theirs, mine, options->single ? 0x1p-24 : 0x1p-53, out);
  }
  if (!any)
    return message_set(message, "nothing to compare; --only takes names of operators of the pack, commas between");
  const enum oracle_verdict verdict = t.beyond ? ORACLE_DIFFERS : t.different ? ORACLE_CLOSE : ORACLE_SAME;
  fprintf(out, "%" PRIu64 " values compared, %" PRIu64 " differ, %" PRIu64 " beyond tolerance\n", t.values, t.different,
          t.beyond);
  if (t.unjudged > 0)
    fprintf(out, "%" PRIu64 " values not judged: their tolerance is not below the largest size in their table\n",
            t.unjudged);
  prefer_earlier_hit(&t);
  if (!print_difference(&t, options, out, message))
    return false;
  fprintf(out, "%s\n",
          verdict == ORACLE_SAME    ? "same: every bit"
          : verdict == ORACLE_CLOSE ? "close: all differences within tolerance"
                                    : "differs");
  *summary = (struct oracle_summary){verdict, t.values, t.different, t.beyond, t.unjudged, t.largest_of_all, "", ""};
  memcpy(summary->first, t.first_words, sizeof summary->first);
  snprintf(summary->meaning, sizeof summary->meaning, "%s", t.meaning);
  return true;
}
