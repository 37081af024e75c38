#include "oracle/relations.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "oracle/patterns.h"
#include "oracle/single.h"

/* --- what all relations use --------------------------------------------------------------------------------------- */

typedef double value_of(const struct evidence *e, uint32_t row, uint32_t column);

static size_t at(const struct evidence *e, uint32_t row, uint32_t column)
{
  return (size_t)row * e->columns + column;
}

static void fill(struct evidence *e, value_of *f)
{
  for (uint32_t row = 0; row < e->rows; row++)
    for (uint32_t column = 0; column < e->columns; column++)
      e->guess[at(e, row, column)] = f(e, row, column);
}

bool relation_say(char text[RELATION_TEXT], const char *format, ...)
{
  va_list list;
  va_start(list, format);
  vsnprintf(text, RELATION_TEXT, format, list);
  va_end(list);
  return true;
}

void relation_fill(struct evidence *e, relation_value *f, const void *twist)
{
  for (uint32_t row = 0; row < e->rows; row++) {
    uint32_t own;
    const struct evidence_part *part = evidence_part_of(e, row, &own);
    for (uint32_t column = 0; column < e->columns; column++)
      e->guess[at(e, row, column)] = f(part, own, column, twist);
  }
}

void relation_fill_tables(struct evidence *e, relation_table *f, const void *twist)
{
  for (uint32_t k = 0; k < e->parts; k++) {
    const struct evidence_part *part = &e->part[k];
    double *guess = &e->guess[(size_t)part->first * e->columns];
    /* Whole tables are made: a table of theirs that lacks rows gets no guess. */
    const bool made = part->rows == part->pair.ours->rows && f(part, twist, guess);
    for (size_t j = 0; !made && j < (size_t)part->rows * e->columns; j++)
      guess[j] = NAN;
  }
}

static double input(const struct evidence *e, uint32_t row, uint32_t column)
{
  uint32_t own;
  const struct evidence_part *part = evidence_part_of(e, row, &own);
  const struct pack_table *in = oracle_before(&part->pair);
  return in ? pack_value(in, own, column) : NAN;
}

static double ours(const struct evidence *e, uint32_t row, uint32_t column)
{
  return e->ours[at(e, row, column)];
}

/* The wrong value of which the wanted one is largest: free numbers are taken from it. */
static size_t largest_wrong(const struct evidence *e)
{
  size_t best = 0;
  double most = -1.0;
  for (size_t k = 0; k < (size_t)e->rows * e->columns; k++)
    if (e->wrong[k] && fabs(e->ours[k]) > most)
      most = fabs(e->ours[k]), best = k;
  return best;
}

/* --- functions of our value --------------------------------------------------------------------------------------- */

static double nothing(const struct evidence *e, uint32_t row, uint32_t column)
{
  return isnan(e->theirs[at(e, row, column)]) ? EVIDENCE_NAN : ours(e, row, column);
}

static double zero(const struct evidence *e, uint32_t row, uint32_t column)
{
  (void)e, (void)row, (void)column;
  return 0.0;
}

static double negative(const struct evidence *e, uint32_t row, uint32_t column)
{
  return -ours(e, row, column);
}

static double one(const struct evidence *e, uint32_t row, uint32_t column)
{
  (void)e, (void)row, (void)column;
  return 1.0;
}

static double complement(const struct evidence *e, uint32_t row, uint32_t column)
{
  return 1.0 - ours(e, row, column);
}

static double inverse(const struct evidence *e, uint32_t row, uint32_t column)
{
  return 1.0 / ours(e, row, column);
}

static double square(const struct evidence *e, uint32_t row, uint32_t column)
{
  return ours(e, row, column) * ours(e, row, column);
}

static double root(const struct evidence *e, uint32_t row, uint32_t column)
{
  return sqrt(ours(e, row, column));
}

static double inverse_square(const struct evidence *e, uint32_t row, uint32_t column)
{
  return 1.0 / square(e, row, column);
}

static double size(const struct evidence *e, uint32_t row, uint32_t column)
{
  return fabs(ours(e, row, column));
}

static double signed_word(const struct evidence *e, uint32_t row, uint32_t column)
{
  const double x = ours(e, row, column);
  return x >= 0x1p31 && x < 0x1p32 ? x - 0x1p32 : x;
}

static double clipped(const struct evidence *e, uint32_t row, uint32_t column)
{
  return fmax(ours(e, row, column), 0.0);
}

static double single(const struct evidence *e, uint32_t row, uint32_t column)
{
  return single_of(ours(e, row, column));
}

static double change(const struct evidence *e, uint32_t row, uint32_t column, double part)
{
  const double in = input(e, row, column);
  return in + part * (ours(e, row, column) - in);
}

static double half_change(const struct evidence *e, uint32_t row, uint32_t column)
{
  return change(e, row, column, 0.5);
}

static double twice_change(const struct evidence *e, uint32_t row, uint32_t column)
{
  return change(e, row, column, 2.0);
}

static double other_change(const struct evidence *e, uint32_t row, uint32_t column)
{
  return change(e, row, column, -1.0);
}

static double only_change(const struct evidence *e, uint32_t row, uint32_t column)
{
  return ours(e, row, column) - input(e, row, column);
}

static bool of_value(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct {
    value_of *f;
    const char *text;
  } known[] = {
      {input, "nothing done: what came out is what went in"},
      {nothing, "NaN: 0/0, or the root or logarithm of a negative number"},
      {zero, "0 came out"},
      {one, "1 came out"},
      {negative, "sign: the negative of what is wanted"},
      {half_change, "changed by half of what is wanted"},
      {twice_change, "changed by twice what is wanted"},
      {other_change, "sign: changed by the negative of what is wanted"},
      {only_change, "what went in is replaced by the change, which is to be added to it"},
      {complement, "the rest to 1: 1 - x for x"},
      {inverse, "inverted: 1/x for x"},
      {square, "squared, or a root that is missing: x^2 for x"},
      {root, "a root too many: sqrt(x) for x"},
      {inverse_square, "inverted and squared: 1/x^2 for x"},
      {size, "without its sign: |x| for x"},
      {signed_word, "a word of 32 bits taken as signed: it is unsigned"},
      {clipped, "negative values cut to 0"},
      {single, "rounded to single precision at the end"},
  };
  if (k >= sizeof known / sizeof *known)
    return false;
  fill(e, known[k].f);
  return relation_say(text, "%s", known[k].text);
}

/* --- one free number ---------------------------------------------------------------------------------------------- */

static bool by_factor(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  const size_t best = largest_wrong(e);
  const double c = e->theirs[best] / e->ours[best];
  e->free = 1;
  for (size_t j = 0; j < (size_t)e->rows * e->columns; j++)
    e->guess[j] = c * e->ours[j];
  return k == 0 && isfinite(c) && c != 0.0 && c != 1.0 &&
         relation_say(text, "a constant factor: %.9g times what is wanted", c);
}

static bool by_offset(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  const size_t best = largest_wrong(e);
  const double c = e->theirs[best] - e->ours[best];
  e->free = 1;
  for (size_t j = 0; j < (size_t)e->rows * e->columns; j++)
    e->guess[j] = e->ours[j] + c;
  return k == 0 && isfinite(c) &&
         relation_say(text, "a constant offset: %.17g %s than wanted", fabs(c), c > 0.0 ? "more" : "less");
}

static bool by_change(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  double most = 0.0, c = NAN;
  e->free = 1;
  for (uint32_t row = 0; row < e->rows; row++)
    for (uint32_t column = 0; column < e->columns; column++) {
      const double in = input(e, row, column), wanted = ours(e, row, column) - in;
      if (e->wrong[at(e, row, column)] && fabs(wanted) > most)
        most = fabs(wanted), c = (e->theirs[at(e, row, column)] - in) / wanted;
    }
  for (uint32_t row = 0; row < e->rows; row++)
    for (uint32_t column = 0; column < e->columns; column++)
      e->guess[at(e, row, column)] = change(e, row, column, c);
  return k == 0 && isfinite(c) && relation_say(text, "changed by %.10g times what is wanted", c);
}

static bool by_modulus(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  const bool is_signed = k % 2;
  const int bits = 8 + (int)k / 2;
  if (k > 88 || e->part[0].pair.ours->real)
    return false;
  const double range = ldexp(1.0, bits);
  for (size_t j = 0; j < (size_t)e->rows * e->columns; j++)
    e->guess[j] = e->ours[j] - range * floor(e->ours[j] / range + (is_signed ? 0.5 : 0.0));
  return relation_say(text, "an integer cut to %d bits%s", bits, is_signed ? " with sign" : "");
}

/* --- other rows and columns --------------------------------------------------------------------------------------- */

static bool is_wrong_column(const struct evidence *e, uint32_t column)
{
  bool any = false;
  for (uint32_t row = 0; row < e->rows; row++)
    any |= e->wrong[at(e, row, column)];
  return any;
}

static bool by_columns(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const uint8_t from[][3] = {{1, 0, 2}, {0, 2, 1}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}};
  const bool pairs = e->columns == 2;
  if (k >= (pairs ? 1U : 5U) || (e->columns != 2 && e->columns != 3))
    return false;
  bool moved = true; /* only wrong columns, and all of them */
  for (uint32_t column = 0; column < e->columns; column++)
    moved &= (from[k][column] != column) == is_wrong_column(e, column);
  for (uint32_t row = 0; row < e->rows; row++)
    for (uint32_t column = 0; column < e->columns; column++)
      e->guess[at(e, row, column)] = moved ? ours(e, row, from[k][column]) : NAN;
  const struct pack_table *t = e->part[0].pair.ours;
  return relation_say(text, "columns exchanged: %.10s %.10s%s%.10s are what %.10s %.10s%s%.10s should be",
                      t->component[0], t->component[1], pairs ? "" : " ", pairs ? "" : t->component[2],
                      t->component[from[k][0]], t->component[from[k][1]], pairs ? "" : " ",
                      pairs ? "" : t->component[from[k][2]]);
}

/* Two columns of any table, if only they are wrong. */
static bool by_two_columns(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  uint32_t wrong[2] = {0, 0}, count = 0;
  for (uint32_t column = 0; column < e->columns; column++) {
    const bool any = is_wrong_column(e, column);
    if (any && count < 2)
      wrong[count] = column;
    count += any;
  }
  if (k > 0 || count != 2)
    return false;
  for (uint32_t row = 0; row < e->rows; row++)
    for (uint32_t j = 0; j < 2; j++)
      e->guess[at(e, row, wrong[j])] = ours(e, row, wrong[1 - j]);
  const struct pack_table *t = e->part[0].pair.ours;
  return relation_say(text, "columns exchanged: %.20s is what %.20s should be, and %.20s what %.20s should",
                      t->component[wrong[0]], t->component[wrong[1]], t->component[wrong[1]], t->component[wrong[0]]);
}

static bool by_one_column(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  if (e->columns != 3 || k >= 3)
    return false;
  for (uint32_t row = 0; row < e->rows; row++)
    for (uint32_t column = 0; column < 3; column++)
      e->guess[at(e, row, column)] = ours(e, row, k);
  return relation_say(text, "the same along axes: that of %s", e->part[0].pair.ours->component[k]);
}

/* The numbers of another row of the same part. */
static bool by_rows(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const char *const which[] = {"the next row's numbers", "those of the row before",
                                      "rows backwards: the first has what the last should have"};
  if (k >= 3)
    return false;
  for (uint32_t row = 0; row < e->rows; row++) {
    uint32_t own;
    const struct evidence_part *part = evidence_part_of(e, row, &own);
    const uint32_t n = part->rows, other = k == 0 ? (own + 1) % n : k == 1 ? (own + n - 1) % n : n - 1 - own;
    const bool wraps = k < 2 && other != own + 1 && other + 1 != own;
    for (uint32_t column = 0; column < e->columns; column++)
      e->guess[at(e, row, column)] = !(wraps && n > 2)              ? ours(e, part->first + other, column)
                                     : e->wrong_rows > 2 * e->parts ? e->theirs[at(e, row, column)]
                                                                    : NAN;
  }
  return relation_say(text, "%s", which[k]);
}

static bool by_row_alike(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  const size_t best = largest_wrong(e) / e->columns * e->columns;
  char value[RELATION_TEXT] = "";
  e->free = e->columns;
  for (uint32_t column = 0; column < e->columns && column < 4; column++)
    snprintf(value + strlen(value), sizeof value - strlen(value), " %.6g", e->theirs[best + column]);
  for (uint32_t row = 0; row < e->rows; row++)
    for (uint32_t column = 0; column < e->columns; column++)
      e->guess[at(e, row, column)] = e->theirs[best + column];
  return k == 0 && relation_say(text, "the same in all rows:%.100s", value);
}

/* --- masses ------------------------------------------------------------------------------------------------------- */

static double mass_of(const struct evidence *e, int64_t vertex)
{
  const struct pack_table *t = oracle_model(&e->part[0].pair, "in.vertex");
  return t && vertex >= 0 && vertex < t->rows ? pack_value(t, (uint32_t)vertex, 0) : NAN;
}

/* Value, or change, times a power of the vertex' mass or of a neighbor's over its own. */
static bool by_mass(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct {
    int own, next, before;
    const char *text;
  } known[] = {{1, 0, 0, "times the mass"},
               {-1, 0, 0, "over the mass"},
               {2, 0, 0, "times the mass squared: it should be divided by it"},
               {1, -1, 0, "with the mass of the next vertex"},
               {1, 0, -1, "with the mass of the vertex before"},
               {-1, 1, 0, "times the mass of the next vertex"},
               {-1, 0, 1, "times the mass of the vertex before"}};
  const struct pack_table *masses = oracle_model(&e->part[0].pair, "in.vertex");
  const uint32_t kind = k / 2;
  if (kind >= sizeof known / sizeof *known || !masses)
    return false;
  for (uint32_t row = 0; row < e->rows; row++) {
    uint32_t own;
    const struct evidence_part *part = evidence_part_of(e, row, &own);
    const double n = masses->rows, next = fmod(own + 1.0, n), before = fmod(own + n - 1.0, n);
    const double factor = pow(mass_of(e, own), known[kind].own) * pow(mass_of(e, (int64_t)next), known[kind].next) *
                          pow(mass_of(e, (int64_t)before), known[kind].before);
    for (uint32_t column = 0; column < e->columns; column++)
      e->guess[at(e, row, column)] = part->rows != masses->rows ? NAN
                                     : k % 2 == 0               ? change(e, row, column, factor)
                                                                : factor * ours(e, row, column);
  }
  return relation_say(text, "%s%s", k % 2 == 0 ? "changed by what is wanted " : "what is wanted ", known[kind].text);
}

const struct relation oracle_relations_any[] = {
    {NULL, NULL, of_value, false},      {NULL, NULL, by_columns, false}, {NULL, NULL, by_two_columns, false},
    {NULL, NULL, by_one_column, false}, {NULL, NULL, by_rows, false},    {NULL, NULL, by_row_alike, false},
    {NULL, NULL, by_factor, false},     {NULL, NULL, by_offset, false},  {NULL, NULL, by_change, false},
    {NULL, NULL, by_modulus, false},    {NULL, NULL, by_mass, false},    {.make = NULL},
};

/* --- one side ----------------------------------------------------------------------------------------------------- */

bool oracle_one_sided(const struct evidence *e, char text[RELATION_TEXT])
{
  uint32_t n = 0, toward = 0, away = 0, below = 0, above = 0;
  for (size_t k = 0; k < (size_t)e->rows * e->columns; k++) {
    if (!e->wrong[k])
      continue;
    n++;
    toward += fabs(e->theirs[k]) < fabs(e->ours[k]);
    away += e->ours[k] != 0.0 && fabs(e->theirs[k]) > fabs(e->ours[k]);
    below += e->theirs[k] < e->ours[k];
    above += e->theirs[k] > e->ours[k];
  }
  const char *side = n < 8         ? NULL
                     : below == n  ? "below what is wanted"
                     : above == n  ? "above what is wanted"
                     : toward == n ? "toward zero"
                     : away == n   ? "away from zero"
                                   : NULL;
  return side && relation_say(text, "one-sided: all %u wrong values are %s", n, side);
}
