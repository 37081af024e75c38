/* Permutations, and velocities that are swapped by one, made with one thing changed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "oracle/edges.h"
#include "oracle/patterns.h"
#include "oracle/relations.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

enum { PURPOSE, DRAW, STEP, ENTITY };

/* --- permutations ------------------------------------------------------------------------------------------------- */

enum deviate { WHOLE, LOW_WORD, HIGH_WORD, HIGH_FIRST, LOW_WORD_ALONE, HIGH_WORD_ALONE };

struct shuffle_twist {
  int purpose, draw, later;
  int range;  /* added to k + 1 */
  int single; /* 1 + the way of edges_single_index; 0: integers */
  enum deviate deviate;
  const char *text;
  bool of_all, uniform, last_zero, remainder, forward, other_half, entity_per_number, without_last, upward, doubles;
};

/* Where a permutation's random numbers are. */
struct shuffle_address {
  uint64_t seed, step;
  enum random_purpose purpose;
  uint32_t draw;
};

/* Of an operator that is not given an address, the scene has it. */
static struct shuffle_address address_of(const struct oracle_pair *p)
{
  const struct pack_table *in = oracle_sibling(p, "in.address");
  const bool swap = strcmp(p->ours->place.operator_name, "swap") == 0;
  struct shuffle_address a = {oracle_seed(p), p->ours->place.step, swap ? RANDOM_VELOCITY_SWAP : RANDOM_VERTEX_ORDER,
                              0};
  if (in && !in->real && in->rows == 1 && in->columns == 4) {
    a.purpose = (enum random_purpose)in->value.integer[PURPOSE];
    a.draw = (uint32_t)in->value.integer[DRAW];
    a.step = (uint64_t)in->value.integer[STEP];
  }
  return a;
}

static uint64_t deviate_of(const struct shuffle_twist *t, const struct shuffle_address *a, uint32_t k)
{
  const uint32_t half = t->entity_per_number ? 0 : t->other_half ? 1 - k % 2 : k % 2;
  const struct random_words r =
      random_at(a->seed, t->purpose ? (enum random_purpose)t->purpose : a->purpose, a->draw + (uint32_t)t->draw,
                a->step + (uint64_t)(int64_t)t->later, t->entity_per_number ? k : k / 2);
  const uint64_t low = r.w[2 * half], high = r.w[2 * half + 1];
  return t->deviate == LOW_WORD          ? low << 32
         : t->deviate == HIGH_WORD       ? high << 32
         : t->deviate == HIGH_FIRST      ? low << 32 | high
         : t->deviate == LOW_WORD_ALONE  ? low
         : t->deviate == HIGH_WORD_ALONE ? high
                                         : high << 32 | low;
}

static uint32_t place_of(const struct shuffle_twist *t, uint64_t deviate, uint64_t range)
{
  if (t->uniform)
    return (uint32_t)((double)range * (((double)(deviate >> 12) + 0.5) * 0x1p-52));
  if (t->remainder)
    return (uint32_t)(range ? deviate % range : 0);
  if (t->doubles)
    return (uint32_t)((double)range * ((double)deviate * 0x1p-64));
  if (t->single)
    return edges_single_index(deviate, (uint32_t)range, t->single - 1);
  const uint64_t low = (deviate & UINT32_MAX) * range, high = (deviate >> 32) * range;
  return (uint32_t)((high + (low >> 32)) >> 32);
}

static bool make_order(const struct evidence_part *part, const void *twist, double *order)
{
  const struct shuffle_twist *t = twist;
  const uint32_t n = part->rows;
  const struct shuffle_address address = address_of(&part->pair);
  for (uint32_t k = 0; k < n; k++)
    order[k] = k;
  for (uint32_t i = 1; i < n; i++) {
    const uint32_t k = t->forward ? i : n - i;
    if (t->without_last && i + 1 == n)
      break;
    const uint64_t deviate = t->last_zero && k == n - 1 && n % 2 == 1 ? 0 : deviate_of(t, &address, k);
    const uint32_t j = t->of_all   ? place_of(t, deviate, n)
                       : t->upward ? k + place_of(t, deviate, n - k)
                                   : place_of(t, deviate, (uint64_t)((int64_t)k + 1 + t->range));
    if (j >= n)
      return false;
    const double kept = order[k];
    order[k] = order[j];
    order[j] = kept;
  }
  return true;
}

static bool orders(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct shuffle_twist known[] = {
      {.draw = 1, .text = "random address: the order of the other sweep of the step"},
      {.later = -1, .text = "random address: the permutation of the step before or after (the one before)"},
      {.later = 1, .text = "random address: the permutation of the step before or after (the one after)"},
      {.range = -1, .text = "permutation: entry k changes places with one of k, not of k + 1"},
      {.last_zero = true, .text = "permutation of an odd number: the last entry's random number is left out"},
      {.remainder = true, .text = "permutation by remainder: floor((k + 1) R / 2^64), not R modulo k + 1"},
      {.of_all = true, .text = "permutation: entry k changes places with any of n, not with one of k + 1"},
      {.of_all = true,
       .remainder = true,
       .text = "permutation: entry k changes places with any of n, by remainder, not with one of k + 1"},
      {.of_all = true,
       .forward = true,
       .text = "permutation from the front: entry k changes places with any of n, not with one of k + 1"},
      {.range = -1, .remainder = true, .text = "permutation by remainder of k, not k + 1"},
      {.remainder = true, .deviate = LOW_WORD_ALONE, .text = "permutation by remainder of the low word"},
      {.remainder = true, .deviate = HIGH_WORD_ALONE, .text = "permutation by remainder of the high word"},
      {.uniform = true, .text = "permutation of uniforms of 52 bits: its index needs all 64 bits of the integer"},
      {.deviate = LOW_WORD, .text = "permutation of the low word only: R has 64 bits"},
      {.deviate = HIGH_WORD, .text = "permutation of the high word only: R has 64 bits"},
      {.deviate = HIGH_FIRST, .text = "permutation: R with the high word first; the first of two words is the low one"},
      {.forward = true, .text = "permutation from the front: k goes down from n - 1 to 1"},
      {.upward = true, .forward = true, .text = "permutation from the front: entry k changes with one after it"},
      {.other_half = true, .text = "permutation: integers 0 and 1 of a draw exchanged"},
      {.entity_per_number = true, .text = "permutation: entity k for k/2, integer 0 only"},
      {.without_last = true, .text = "permutation without its last exchange, k = 1"},
      {.doubles = true, .text = "permutation in doubles: the product (k + 1) R is of integers"},
      {.single = 1, .text = "permutation: its index in single precision; it needs all 64 bits of the integer"},
      {.single = 2, .text = "permutation: its index in single precision; it needs all 64 bits of the integer"},
      {.single = 3, .text = "permutation: its index in single precision; it needs all 64 bits of the integer"},
      {.single = 4, .text = "permutation: its index in single precision; it needs all 64 bits of the integer"},
  };
  struct shuffle_twist t = {0};
  if (k < COUNT_OF(known)) {
    t = known[k];
    relation_say(text, "%s", t.text);
  } else if (k < COUNT_OF(known) + 24) {
    t.purpose = (int)(k - COUNT_OF(known));
    relation_say(text, "random address: the permutation with purpose %d", t.purpose);
  } else {
    return false;
  }
  relation_fill_tables(e, make_order, &t);
  return true;
}

static double own_number(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  (void)part, (void)column, (void)twist;
  return row;
}

static double inverse_number(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  (void)column, (void)twist;
  for (uint32_t k = 0; k < part->rows; k++)
    if (pack_value(part->pair.ours, k, 0) == row)
      return k;
  return NAN;
}

static double backward_number(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  (void)column, (void)twist;
  return pack_value(part->pair.ours, part->rows - 1 - row, 0);
}

static double first_two_exchanged(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  (void)column, (void)twist;
  return pack_value(part->pair.ours, row < 2 && part->rows > 1 ? 1 - row : row, 0);
}

static bool order_changed(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct {
    relation_value *f;
    const char *text;
  } known[] = {{inverse_number, "the inverse permutation: applied from the other side"},
               {own_number, "not permuted: the order of their numbers"},
               {first_two_exchanged, "the permutation with its first two entries exchanged"},
               {backward_number, "the permutation backwards: from its last entry to its first"}};
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, known[k].f, NULL);
  return relation_say(text, "%s", known[k].text);
}

/* Velocity of the particle that has ours, instead of whose ours has. */
static double from_other_side(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *in = oracle_before(&part->pair), *order = oracle_sibling(&part->pair, "out.order");
  (void)twist;
  for (uint32_t k = 0; in && order && k < order->rows; k++)
    if (pack_value(order, k, 0) == row)
      return pack_value(in, k, column);
  return NAN;
}

static double twice_applied(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *in = oracle_before(&part->pair), *order = oracle_sibling(&part->pair, "out.order");
  const double first = order ? pack_value(order, row, 0) : NAN;
  const double from = first >= 0.0 && first < part->rows ? pack_value(order, (uint32_t)first, 0) : NAN;
  (void)twist;
  return in && from >= 0.0 && from < in->rows ? pack_value(in, (uint32_t)from, column) : NAN;
}

/* Velocities of one table, changed as they are read. */
static bool make_in_place(const struct evidence_part *part, const void *twist, double *guess)
{
  const bool exchanged = *(const bool *)twist;
  const struct pack_table *in = oracle_before(&part->pair), *order = oracle_sibling(&part->pair, "out.order");
  if (!in || !order || order->rows != part->rows || in->columns != part->pair.ours->columns)
    return false;
  const uint32_t columns = in->columns;
  for (size_t k = 0; k < (size_t)part->rows * columns; k++)
    guess[k] = pack_value(in, (uint32_t)(k / columns), (uint32_t)(k % columns));
  for (uint32_t row = 0; row < part->rows; row++) {
    const double from = pack_value(order, row, 0);
    if (!(from >= 0.0 && from < part->rows))
      return false;
    for (uint32_t column = 0; column < columns; column++) {
      double *const a = &guess[(size_t)row * columns + column], *const b = &guess[(size_t)from * columns + column];
      const double kept = *a;
      *a = *b;
      *b = exchanged ? kept : *b;
    }
  }
  return true;
}

/* Of the particle so many numbers on. */
static double further_on(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *in = oracle_before(&part->pair), *order = oracle_sibling(&part->pair, "out.order");
  const double from = order ? pack_value(order, row, 0) + part->rows + *(const int *)twist : NAN;
  return in && from >= 0.0 && part->rows > 0 ? pack_value(in, (uint32_t)fmod(from, part->rows), column) : NAN;
}

static double of_other_row(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *in = oracle_before(&part->pair), *order = oracle_sibling(&part->pair, "out.order");
  const uint32_t other = (row + part->rows + (uint32_t) * (const int *)twist) % part->rows;
  const double from = order ? pack_value(order, other, 0) : NAN;
  return in && from >= 0.0 && from < in->rows ? pack_value(in, (uint32_t)from, column) : NAN;
}

static bool swapped_otherwise(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const bool in_place[2] = {false, true};
  static const int steps[2] = {1, -1};
  static const char *const said[] = {
      "the permutation is right, but applied in place: velocities that have been replaced are taken",
      "the permutation is right, but velocities are exchanged in pairs, one by one",
      "the permutation is right, but the velocity is that of the particle after (order + 1)",
      "the permutation is right, but the velocity is that of the particle before (order - 1)",
      "the permutation is right, but of the next particle's entry",
      "the permutation is right, but of the entry of the particle before"};
  if (k >= COUNT_OF(said))
    return false;
  if (k < 2)
    relation_fill_tables(e, make_in_place, &in_place[k]);
  else
    relation_fill(e, k < 4 ? further_on : of_other_row, &steps[k % 2]);
  return relation_say(text, "%s", said[k]);
}

static bool swapped(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  relation_fill(e, k == 0 ? from_other_side : twice_applied, NULL);
  return k < 2 && relation_say(text, "%s",
                               k == 0 ? "the permutation is right, but applied from the other side"
                                      : "the permutation is right, but applied twice");
}

const struct relation oracle_relations_permutation[] = {
    {NULL, "out.order", order_changed, false},
    {NULL, "out.order", orders, false},
    {"swap", "out.velocity", swapped, false},
    {"swap", "out.velocity", swapped_otherwise, false},
    {.make = NULL},
};
