/* What went wrong with random numbers: words, uniforms, the grid shift, permutations. Axes are the solvent's. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "oracle/patterns.h"

/* --- words ------------------------------------------------------------------------------------------------------- */

enum { PURPOSE, DRAW, STEP, ENTITY, ADDRESS_COLUMNS };

struct recipe {
  unsigned rounds;
  bool key_exchanged, entity_short, step_short;
};

/* True if their words are made so, and ours are not. */
static bool words_are(const struct oracle_pair *p, struct recipe r)
{
  const struct pack_table *in = oracle_sibling(p, "in.address"), *ours = oracle_sibling(p, "out.word"),
                          *theirs = oracle_sibling_of_theirs(p, "out.word");
  const uint64_t seed = oracle_seed(p);
  const uint32_t low = (uint32_t)seed, high = (uint32_t)(seed >> 32);
  const philox4x32_key_t key = {{r.key_exchanged ? high : low, r.key_exchanged ? low : high}};
  if (!in || in->real || in->columns != ADDRESS_COLUMNS || !ours || !theirs || theirs->rows != in->rows)
    return false;
  bool other = false;
  for (uint32_t row = 0; row < in->rows; row++) {
    const int64_t *a = &in->value.integer[ADDRESS_COLUMNS * (size_t)row];
    const uint32_t entity = (uint32_t)a[ENTITY] & (r.entity_short ? UINT16_MAX : UINT32_MAX);
    const uint32_t late = r.step_short ? 0 : (uint32_t)((uint64_t)a[STEP] >> 32);
    const philox4x32_ctr_t counter = {
        {entity, (uint32_t)a[PURPOSE] + 256 * (uint32_t)a[DRAW], (uint32_t)a[STEP], late}};
    const philox4x32_ctr_t words = philox4x32_R(r.rounds, counter, key);
    for (uint32_t k = 0; k < 4; k++) {
      if (pack_value(theirs, row, k) != words.v[k])
        return false;
      other |= pack_value(ours, row, k) != words.v[k];
    }
  }
  return other;
}

static bool rounds_wrong(const struct oracle_pair *p)
{
  for (unsigned rounds = 1; rounds <= 16; rounds++)
    if (rounds != 10 && words_are(p, (struct recipe){.rounds = rounds}))
      return true;
  return false;
}

static bool key_exchanged(const struct oracle_pair *p)
{
  return words_are(p, (struct recipe){.rounds = 10, .key_exchanged = true});
}

static bool entity_short(const struct oracle_pair *p)
{
  return words_are(p, (struct recipe){.rounds = 10, .entity_short = true});
}

static bool step_short(const struct oracle_pair *p)
{
  return words_are(p, (struct recipe){.rounds = 10, .step_short = true});
}

/* All but a few addresses, which may look the same either way. */
static bool words_unlike(const struct oracle_pair *p)
{
  const struct pack_table *ours = oracle_sibling(p, "out.word"), *theirs = oracle_sibling_of_theirs(p, "out.word");
  uint32_t values = 0, right = 0;
  for (uint32_t row = 0; ours && theirs && row < ours->rows; row++)
    for (uint32_t k = 0; k < ours->columns; k++) {
      values++;
      right += pack_value(ours, row, k) == pack_value(theirs, row, k);
    }
  return right < values && 8 * (uint64_t)right <= values;
}

static double without_half(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return pack_value(p->ours, row, column) - 0x1p-53;
}

static bool half_missing(const struct oracle_pair *p)
{
  for (uint32_t row = 0; row < oracle_common_rows(p); row++)
    for (uint32_t k = 0; k < p->ours->columns; k++)
      if (pack_value(p->theirs, row, k) != without_half(p, row, k))
        return false;
  return true;
}

/* --- grid shift -------------------------------------------------------------------------------------------------- */

static bool shift_is_of(const struct oracle_pair *p, uint64_t step)
{
  struct random_words r = random_at(oracle_seed(p), RANDOM_GRID_SHIFT, 0, step, 0);
  for (uint32_t k = 0; k < 3; k++)
    if (pack_value(p->theirs, 0, k) != (double)((uint64_t)r.w[k] << (LATTICE_BITS - 32)))
      return false;
  return true;
}

static bool shift_of_other_step(const struct oracle_pair *p)
{
  return p->theirs->rows == 1 && p->theirs->columns == 3 &&
         (shift_is_of(p, p->ours->place.step - 1) || shift_is_of(p, p->ours->place.step + 1));
}

/* --- permutations ------------------------------------------------------------------------------------------------ */

struct shuffle {
  uint32_t draw;
  int64_t later;    /* steps */
  bool short_range; /* k for k + 1 */
  bool last_zero;   /* the deviate of the last entry, if its number is odd, is none */
};

/* Theirs, by the address book with these changes. */
static bool is_shuffled(const struct oracle_pair *p, struct shuffle s)
{
  const uint32_t n = p->ours->rows;
  uint32_t *order = p->theirs->rows == n && n > 0 ? malloc((n + 1) * sizeof *order) : NULL;
  const enum random_purpose purpose =
      strcmp(p->ours->place.operator_name, "swap") == 0 ? RANDOM_VELOCITY_SWAP : RANDOM_VERTEX_ORDER;
  for (uint32_t k = 0; order && k < n; k++)
    order[k] = k;
  for (uint32_t k = n - 1; order && k > 0; k--) {
    const struct random_words r =
        random_at(oracle_seed(p), purpose, s.draw, p->ours->place.step + (uint64_t)s.later, k / 2);
    const uint64_t deviate = s.last_zero && k == n - 1 && n % 2 == 1 ? 0 : random_u64(r, (int)(k % 2));
    const uint64_t range = s.short_range ? k : (uint64_t)k + 1;
    const uint64_t low = (deviate & UINT32_MAX) * range, high = (deviate >> 32) * range; /* of range * deviate */
    const uint32_t j = (uint32_t)((high + (low >> 32)) >> 32);
    const uint32_t swap = order[k];
    order[k] = order[j];
    order[j] = swap;
  }
  bool same = order != NULL;
  for (uint32_t k = 0; same && k < n; k++)
    same = pack_value(p->theirs, k, 0) == order[k];
  free(order);
  return same;
}

static bool other_sweep(const struct oracle_pair *p)
{
  return is_shuffled(p, (struct shuffle){.draw = 1});
}

static bool other_step(const struct oracle_pair *p)
{
  return is_shuffled(p, (struct shuffle){.later = -1}) || is_shuffled(p, (struct shuffle){.later = 1});
}

static bool short_range(const struct oracle_pair *p)
{
  return is_shuffled(p, (struct shuffle){.short_range = true});
}

static bool odd_last(const struct oracle_pair *p)
{
  return is_shuffled(p, (struct shuffle){.last_zero = true});
}

static double inverse_of(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  for (uint32_t k = 0; k < p->ours->rows; k++)
    if (pack_value(p->ours, k, 0) == row)
      return k;
  return -1.0;
}

/* Velocity of the particle that has ours, instead of whose ours has. */
static double from_other_side(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *in = oracle_before(p);
  struct oracle_pair order = *p;
  order.ours = oracle_sibling(p, "out.order");
  const double from = in && order.ours ? inverse_of(&order, row, 0) : -1.0;
  return from >= 0.0 ? pack_value(in, (uint32_t)from, column) : NAN;
}

static bool is_permutation(const struct oracle_pair *p)
{
  const uint32_t n = p->ours->rows;
  bool *seen = calloc((size_t)n + 1, sizeof *seen), all = seen && p->theirs->rows == n;
  for (uint32_t k = 0; all && k < n; k++) {
    const double at = pack_value(p->theirs, k, 0);
    all = at >= 0.0 && at < n && !seen[(uint32_t)at];
    if (all)
      seen[(uint32_t)at] = true;
  }
  free(seen);
  return all;
}

static bool is_no_permutation(const struct oracle_pair *p)
{
  return !is_permutation(p);
}

const struct oracle_pattern oracle_patterns_random[] = {
    {"random", NULL, "Philox with another number of rounds than 10", .fits = rounds_wrong},
    {"random", NULL, "the key's words exchanged: the low one of the seed comes first", .fits = key_exchanged},
    {"random", NULL, "entities cut to 16 bits", .fits = entity_short},
    {"random", NULL, "steps cut to 32 bits: the high word is the counter's last", .fits = step_short},
    {"random", NULL, "hardly a word is right: counter, key or rounds of Philox", .fits = words_unlike},
    {"random", "out.uniform", "uniforms without their half: multiples of 2^-52, and 0 among them",
     .fits = half_missing},
    {"shift", "out.shift", "random address: the shift of the step before or after", .fits = shift_of_other_step},
    {NULL, "out.order", "the inverse permutation: applied from the other side", .guess = inverse_of},
    {"order", "out.order", "random address: the order of the other sweep of the step", .fits = other_sweep},
    {NULL, "out.order", "random address: the permutation of the step before or after", .fits = other_step},
    {NULL, "out.order", "permutation: entry k changes places with one of k, not of k + 1", .fits = short_range},
    {NULL, "out.order", "permutation of an odd number: the last entry's random number is left out", .fits = odd_last},
    {NULL, "out.order", "no permutation: a number is missing", .fits = is_no_permutation},
    {NULL, "out.order", "a permutation, but of other random numbers or exchanges", .fits = is_permutation},
    {"swap", "out.velocity", "the permutation is right, but applied from the other side", .guess = from_other_side},
    {.meaning = NULL},
};
