#include "oracle/evidence.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/tolerance.h"

static bool takes_part(const struct pack_table *ours, const struct pack_table *theirs, const struct oracle_pair *pair)
{
  return theirs && ours->columns == pair->ours->columns && theirs->columns == ours->columns &&
         strcmp(ours->place.operator_name, pair->ours->place.operator_name) == 0 &&
         strcmp(ours->name, pair->ours->name) == 0;
}

static void find_parts(const struct oracle_pair *pair, struct evidence *e)
{
  for (size_t k = 0; k < pair->pack->count && e->parts < EVIDENCE_PARTS; k++) {
    const struct pack_table *ours = &pair->pack->table[k];
    const struct pack_table *theirs = pack_find(pair->pack_theirs, &ours->place, ours->name);
    if (!takes_part(ours, theirs, pair))
      continue;
    struct evidence_part *part = &e->part[e->parts++];
    *part = (struct evidence_part){{pair->pack, pair->pack_theirs, ours, theirs, pair->rounding, NULL}, 0, e->rows};
    part->rows = ours->rows < theirs->rows ? ours->rows : theirs->rows;
    e->rows += part->rows;
  }
}

static void take_values(struct evidence *e)
{
  for (uint32_t k = 0; k < e->parts; k++) {
    const struct evidence_part *part = &e->part[k];
    struct tolerance_known known = {0};
    struct oracle_pair pair = part->pair;
    pair.known = &known;
    for (uint32_t row = 0; row < part->rows; row++)
      for (uint32_t column = 0; column < e->columns; column++) {
        const size_t at = (size_t)(part->first + row) * e->columns + column;
        e->ours[at] = pack_value(part->pair.ours, row, column);
        e->theirs[at] = pack_value(part->pair.theirs, row, column);
        e->tolerance[at] = oracle_tolerance(&pair, row, column);
        e->different[at] = e->ours[at] != e->theirs[at];
        e->wrong[at] = !(fabs(e->ours[at] - e->theirs[at]) <= e->tolerance[at]);
        e->differences += e->different[at];
        e->wrongs += e->wrong[at];
      }
    tolerance_forget(&known);
  }
}

static void count_wrong_rows(struct evidence *e)
{
  e->wrong_rows = 0;
  for (uint32_t row = 0; row < e->rows; row++) {
    bool any = false;
    for (uint32_t column = 0; column < e->columns; column++)
      any |= e->wrong[(size_t)row * e->columns + column];
    e->wrong_rows += any;
  }
}

void evidence_count_all(struct evidence *e)
{
  memcpy(e->wrong, e->different, (size_t)e->rows * e->columns * sizeof *e->wrong);
  e->wrongs = e->differences;
  count_wrong_rows(e);
}

/* Different values of a column, ours and theirs, up to 64: beyond that a guess is not right by chance. */
static double choices(const struct evidence *e, uint32_t column)
{
  double seen[64];
  uint32_t count = 0;
  for (uint32_t k = 0; k < 2 * e->rows && count < 64; k++) {
    const double x = (k % 2 ? e->theirs : e->ours)[(size_t)(k / 2) * e->columns + column];
    uint32_t j = 0;
    while (j < count && seen[j] != x)
      j++;
    if (j == count)
      seen[count++] = x;
  }
  double most = 0.0;
  for (uint32_t row = 0; row < e->rows; row++)
    most = fmax(most, fabs(e->ours[(size_t)row * e->columns + column]));
  /* Nearly all are different: then what counts is how large they may be. */
  return count > 1 && count >= e->rows ? fmin(20.0, log2(1.0 + most)) : count > 1 ? log2(count - 1.0) : 0.0;
}

bool evidence_load(const struct oracle_pair *pair, struct evidence *e)
{
  memset(e, 0, sizeof *e);
  e->columns = pair->ours->columns;
  find_parts(pair, e);
  const size_t n = (size_t)e->rows * e->columns + 1;
  e->ours = calloc(n, sizeof *e->ours), e->theirs = calloc(n, sizeof *e->theirs);
  e->tolerance = calloc(n, sizeof *e->tolerance), e->guess = calloc(n, sizeof *e->guess);
  e->different = calloc(n, sizeof *e->different), e->wrong = calloc(n, sizeof *e->wrong);
  e->choice = calloc((size_t)e->columns + 1, sizeof *e->choice);
  e->moved = calloc((size_t)e->rows + 1, sizeof *e->moved);
  if (!e->ours || !e->theirs || !e->tolerance || !e->guess || !e->different || !e->wrong || !e->choice || !e->moved)
    return false;
  take_values(e);
  count_wrong_rows(e);
  for (uint32_t column = 0; column < e->columns; column++)
    e->choice[column] = choices(e, column);
  return true;
}

bool evidence_take(const struct oracle_pair *pair, struct evidence *e)
{
  if (!evidence_load(pair, e))
    return false;
  if (e->wrongs == 0) {
    evidence_count_all(e);
    /* What is off by rounding only is held against guesses without any. */
    for (size_t k = 0; !pair->ours->real && k < (size_t)e->rows * e->columns; k++)
      e->tolerance[k] = 0.0;
  }
  return e->wrongs > 0;
}

void evidence_free(struct evidence *e)
{
  free(e->ours);
  free(e->theirs);
  free(e->tolerance);
  free(e->guess);
  free(e->different);
  free(e->wrong);
  free(e->choice);
  free(e->moved);
  memset(e, 0, sizeof *e);
}

/* Where theirs is wrong, the guess must be far nearer than ours is: else a bound as wide as the error lets anything
 * pass. */
bool evidence_is(const struct evidence *e, size_t k, double x)
{
  const double off = fabs(e->theirs[k] - x);
  if (isnan(e->theirs[k]))
    return x == EVIDENCE_NAN;
  if (off == 0.0)
    return true;
  if (!isfinite(x))
    return false;
  return (off <= e->tolerance[k] || off <= 0x1p-40 * fabs(x)) &&
         (!e->wrong[k] || off <= 0x1p-8 * fabs(e->theirs[k] - e->ours[k]));
}

/* Rows that a guess changes, if they are not many more than are wrong. */
static void mark_moved(struct evidence *e)
{
  for (int pass = 0; pass < 2; pass++) {
    uint32_t rows = 0;
    for (uint32_t row = 0; row < e->rows; row++) {
      bool any = false;
      for (size_t k = (size_t)row * e->columns; k < (size_t)(row + 1) * e->columns; k++)
        any |= !isnan(e->guess[k]) && !(fabs(e->guess[k] - e->ours[k]) <= e->tolerance[k]);
      rows += any;
      e->moved[row] |= any && pass == 1;
    }
    if (rows > 4 * e->wrong_rows)
      return;
  }
}

double evidence_ways(double n, double chosen)
{
  return (lgamma(n + 1.0) - lgamma(chosen + 1.0) - lgamma(n - chosen + 1.0)) / log(2.0);
}

double evidence_choice(const struct evidence *e)
{
  uint32_t n = 0;
  for (uint32_t row = 0; row < e->rows; row++)
    n += e->moved[row];
  return n > e->wrong_rows ? evidence_ways(n, e->wrong_rows) : 0.0;
}

static double bits_of_value(const struct evidence *e, size_t k)
{
  const double off = fabs(e->theirs[k] - e->guess[k]), error = fabs(e->theirs[k] - e->ours[k]);
  if (!e->part[0].pair.ours->real)
    return e->choice[k % e->columns];
  if (isnan(e->theirs[k]))
    return 20.0;
  const double doubt = error > e->tolerance[k] ? e->tolerance[k] : 0.0;
  const double least = fmax(fmax(off, doubt), 0x1p-52 * fabs(e->theirs[k]));
  return fmin(20.0, fmax(0.0, log2(error / least)));
}

#define PAIRS 64 /* more tell nothing new */

double evidence_bits(const struct evidence *e)
{
  size_t seen[PAIRS];
  uint32_t count = 0;
  double bits = 0.0;
  for (size_t k = 0; k < (size_t)e->rows * e->columns && count < PAIRS + e->free; k++) {
    bool known = !e->wrong[k];
    for (uint32_t j = 0; j < count && j < PAIRS; j++)
      known |= e->ours[seen[j]] == e->ours[k] && e->theirs[seen[j]] == e->theirs[k];
    if (known)
      continue;
    bits += count < e->free ? 0.0 : bits_of_value(e, k);
    if (count < PAIRS)
      seen[count] = k;
    count++;
  }
  return bits;
}

enum evidence_fit evidence_judge(struct evidence *e)
{
  mark_moved(e);
  enum evidence_fit fit = FIT_WHOLE;
  for (size_t k = 0; k < (size_t)e->rows * e->columns; k++) {
    if (evidence_is(e, k, e->guess[k]))
      continue;
    if (e->wrong[k])
      return FIT_NOT;
    fit = FIT_WRONG;
  }
  return fit;
}

const struct evidence_part *evidence_part_of(const struct evidence *e, uint32_t row, uint32_t *own)
{
  uint32_t k = 0;
  while (k + 1 < e->parts && row >= e->part[k + 1].first)
    k++;
  *own = row - e->part[k].first;
  return &e->part[k];
}
