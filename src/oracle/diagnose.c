/* What patterns of differences usually mean: the search, what all patterns use, and patterns of any operator and of the
 * kick. */
#include <math.h>
#include <string.h>

#include "oracle/pair.h"
#include "oracle/patterns.h"

bool oracle_guessed(const struct oracle_pair *p, uint32_t row, uint32_t column, double guess)
{
  const double size = fabs(pack_value(p->theirs, row, column) - guess);
  return size <= 0x1p-40 * fabs(guess) || size <= oracle_tolerance(p, row, column);
}

bool oracle_agrees(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const double size = fabs(pack_value(p->theirs, row, column) - pack_value(p->ours, row, column));
  return size == 0.0 || size <= oracle_tolerance(p, row, column);
}

bool oracle_explains(const struct oracle_pair *p, oracle_guess *guess)
{
  bool any = false;
  for (uint32_t row = 0; row < oracle_common_rows(p); row++)
    for (uint32_t column = 0; column < p->ours->columns; column++) {
      if (oracle_agrees(p, row, column))
        continue;
      any = true;
      if (!oracle_guessed(p, row, column, guess(p, row, column)))
        return false;
    }
  return any;
}

const struct pack_table *oracle_model(const struct oracle_pair *p, const char *table)
{
  return pack_find(p->pack, &(struct pack_place){"model", 0}, table);
}

int64_t oracle_model_integer(const struct oracle_pair *p, const char *table, uint32_t row, uint32_t column)
{
  const struct pack_table *t = oracle_model(p, table);
  return t && !t->real && row < t->rows && column < t->columns ? t->value.integer[(size_t)row * t->columns + column]
                                                               : 0;
}

bool oracle_box(const struct oracle_pair *p, struct box *box)
{
  int edge[3];
  for (uint32_t k = 0; k < 3; k++) {
    const int64_t cells = oracle_model_integer(p, "in.box", 0, k);
    if (cells < 1 || cells > LATTICE_MAX_EDGE)
      return false;
    edge[k] = (int)cells;
  }
  *box = box_of_cells(edge[0], edge[1], edge[2]);
  return true;
}

uint64_t oracle_seed(const struct oracle_pair *p)
{
  return (uint64_t)oracle_model_integer(p, "in.numbers", 0, 0) | (uint64_t)oracle_model_integer(p, "in.numbers", 0, 1)
                                                                     << 32;
}

const struct pack_table *oracle_input(const struct oracle_pair *p)
{
  char name[PACK_WORD];
  snprintf(name, sizeof name, "in.%.27s", p->ours->name + strlen("out."));
  return oracle_sibling(p, name);
}

const struct pack_table *oracle_before(const struct oracle_pair *p)
{
  const struct pack_table *t = oracle_input(p);
  return t && t->rows == p->ours->rows && t->columns == p->ours->columns ? t : NULL;
}

/* --- patterns of any operator ------------------------------------------------------------------------------------ */

static double unchanged(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *in = oracle_before(p);
  return in ? pack_value(in, row, column) : NAN;
}

static double changed_by(const struct oracle_pair *p, uint32_t row, uint32_t column, double part)
{
  const double in = unchanged(p, row, column);
  return in + part * (pack_value(p->ours, row, column) - in);
}

static double half(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return changed_by(p, row, column, 0.5);
}

static double twice(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return changed_by(p, row, column, 2.0);
}

static double backwards(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return changed_by(p, row, column, -1.0);
}

static double negated(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return -pack_value(p->ours, row, column);
}

/* The rounding of numbers of 24 bits has either sign: the sum of n errors is within 4 sqrt(n) of their size. An error
 * that is the same everywhere is something else, and so are errors of a few ulps of doubles. */
bool oracle_is_single(const struct oracle_pair *p, uint32_t rows)
{
  double worst = 0.0, size = 0.0;
  uint32_t wrong = 0;
  for (uint32_t column = 0; column < p->ours->columns; column++) {
    double sum = 0.0, squares = 0.0;
    for (uint32_t row = 0; row < rows; row++) {
      const double ours = pack_value(p->ours, row, column), d = ours - pack_value(p->theirs, row, column);
      size = fmax(size, fabs(ours));
      worst = fabs(d) <= worst ? worst : fabs(d);
      sum += d;
      squares += d * d;
      wrong += d != 0.0;
    }
    if (!(fabs(sum) <= 4.0 * sqrt(squares)))
      return false;
  }
  return p->rounding < 0x1p-30 && wrong >= 8 && worst > 0x1p-32 * size && worst < 0x1p-16 * size;
}

static bool is_single(const struct oracle_pair *p)
{
  return oracle_is_single(p, oracle_common_rows(p));
}

static double without_mass(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *time = oracle_sibling(p, "in.time"), *force = oracle_sibling(p, "in.force");
  return time && force ? unchanged(p, row, column) + pack_value(time, 0, 0) * pack_value(force, row, column) : NAN;
}

const struct oracle_pattern oracle_patterns_any[] = {
    {"kick", "out.velocity", "kick without the mass: v + t F for v + t F/M", .guess = without_mass},
    {NULL, NULL, "single precision somewhere: right to 5 to 8 digits (--single has its tolerances)", .fits = is_single},
    {NULL, NULL, "sign: the negative of what is wanted", .guess = negated},
    {NULL, NULL, "nothing done: what came out is what went in", .guess = unchanged},
    {NULL, NULL, "half a step: changed by half of what is wanted", .guess = half},
    {NULL, NULL, "a step instead of half a step: changed by twice what is wanted", .guess = twice},
    {NULL, NULL, "sign: changed by the negative of what is wanted", .guess = backwards},
    {.meaning = NULL},
};

/* --- the search -------------------------------------------------------------------------------------------------- */

static const char *search(const struct oracle_pattern *pattern, const struct oracle_pair *p, const char *operator_name)
{
  for (; pattern->meaning; pattern++)
    if ((!pattern->operator_name || strcmp(pattern->operator_name, operator_name) == 0) &&
        (!pattern->table || strcmp(pattern->table, p->ours->name) == 0) &&
        (pattern->guess ? oracle_explains(p, pattern->guess) : pattern->fits(p)))
      return pattern->meaning;
  return NULL;
}

const char *oracle_diagnose(const struct oracle_pair *p)
{
  /* Those of an operator first. */
  static const struct oracle_pattern *const lists[] = {oracle_patterns_random, oracle_patterns_solvent,
                                                       oracle_patterns_sweep, oracle_patterns_any, NULL};
  const bool swept = strcmp(p->ours->place.operator_name, "long_sweep") == 0;
  const char *meaning = NULL;
  for (size_t k = 0; lists[k] && !meaning && p->ours->columns == p->theirs->columns; k++)
    meaning = search(lists[k], p, swept ? "sweep" : p->ours->place.operator_name);
  return meaning;
}
