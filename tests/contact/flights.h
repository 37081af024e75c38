/* Pairs of bonds in straight flight, made to be hard to judge: contacts by construction, at a known time, and pairs
 * that nearly touch. And the audit of the interval search (contact/flight.h) against exact arithmetic (exact_flight.h).
 */
#ifndef UNCROSS_TESTS_FLIGHTS_H
#define UNCROSS_TESTS_FLIGHTS_H

#include "contact/exact_flight.h"

/* A pair that touches at tick ticks / 2^bits, by construction. */
struct made_contact {
  struct flight_pair pair;
  int64_t ticks;
  int bits;
};

static inline struct point add(struct point p, int64_t factor, struct point q)
{
  return (struct point){p.x + factor * q.x, p.y + factor * q.y, p.z + factor * q.z};
}

/* factor p / divisor, where the division has no remainder */
static inline struct point scale(struct point p, int64_t factor, int64_t divisor)
{
  return (struct point){p.x / divisor * factor, p.y / divisor * factor, p.z / divisor * factor};
}

static inline struct point cube_of(struct dice *d, int64_t size)
{
  return dice_point(d, size, size, size);
}

/* Evenly spread in the logarithm, 2^low .. 2^high. */
static inline int64_t dice_power(struct dice *d, int low, int high)
{
  return (int64_t)1 << dice_integer(d, low, high);
}

/* Sizes, lattice units: bond vectors from a few units to 500 a0, motions in a tick from one unit to half a box edge in
 * a drift. */
enum { LARGEST_BOND = 49, LARGEST_RATE = 32 };

/* What a kind of contact asks for. */
struct contact_wish {
  const char *name;
  int bond[2], rate[2]; /* powers of two: sizes of bonds and of motions in a tick */
  enum { ANY_PLACE, END_ON_BOND, END_ON_END, NEAR_END } place;
  enum { ANY_DIRECTION, PARALLEL_ALWAYS, PARALLEL_THEN, COLLINEAR, IN_A_PLANE, NEEDLE, WEDGE } direction;
  enum { ANY_MOTION, GRAZING, NO_ROTATION } motion;
};

/* The place s along a bond where it is touched: numerator of s, of 2^bits. */
static inline int64_t draw_place(struct dice *d, const struct contact_wish *wish, bool end, int *bits)
{
  *bits = wish->place == NEAR_END ? (int)dice_integer(d, 4, 20) : (int)dice_integer(d, 1, 8);
  const int64_t whole = (int64_t)1 << *bits;
  if (end)
    return dice_u64(d) & 1 ? whole : 0;
  if (wish->place == NEAR_END)
    return dice_u64(d) & 1 ? 1 : whole - 1;
  return dice_integer(d, 1, whole - 1);
}

/* A contact at time T = ticks / 2^bits: w = s p - s' q - T V and w_rate = s p_rate - s' q_rate + V for any V that is a
 * multiple of 2^bits, and for p, q and their rates multiples of the denominators of s and s'. */
static inline struct made_contact make_contact(struct dice *d, const struct contact_wish *wish)
{
  struct made_contact m = {.bits = (int)dice_integer(d, 0, 3) * (int)(dice_u64(d) & 1)};
  m.ticks = dice_integer(d, 0, (int64_t)FLIGHT_TICKS << m.bits);
  if (dice_u64(d) % 8 == 0) /* often at the beginning and at the end, and near them */
    m.ticks = dice_u64(d) & 1 ? dice_integer(d, 0, 2) : ((int64_t)FLIGHT_TICKS << m.bits) - dice_integer(d, 0, 2);
  const int64_t fraction = (int64_t)1 << m.bits;
  int bits[2];
  const bool first_end = wish->place == END_ON_END || (wish->place == END_ON_BOND && dice_u64(d) & 1);
  const bool other_end = wish->place == END_ON_END || (wish->place == END_ON_BOND && !first_end);
  const int64_t s = draw_place(d, wish, first_end, &bits[0]), t = draw_place(d, wish, other_end, &bits[1]);
  const int64_t whole[2] = {(int64_t)1 << bits[0], (int64_t)1 << bits[1]},
                unit = whole[0] > whole[1] ? whole[0] : whole[1];
  const int64_t bond = dice_power(d, wish->bond[0], wish->bond[1]), rate = dice_power(d, wish->rate[0], wish->rate[1]);
  const int64_t units = bond / unit > 0 ? bond / unit : 1, rate_units = rate / unit;
  struct flight_pair *pair = &m.pair;
  struct point v = cube_of(d, rate / fraction);
  pair->p = cube_of(d, units), pair->q = cube_of(d, units);
  pair->p_rate = cube_of(d, rate_units), pair->q_rate = cube_of(d, rate_units);
  const struct point zero = {0, 0, 0};
  if (wish->motion == NO_ROTATION)
    pair->p_rate = pair->q_rate = zero;
  const int64_t times = dice_integer(d, 1, 3) * (dice_u64(d) & 1 ? 1 : -1);
  if (wish->direction == PARALLEL_ALWAYS || wish->direction == COLLINEAR) {
    pair->q = scale(pair->p, times, 1), pair->q_rate = scale(pair->p_rate, times, 1);
    if (wish->direction == COLLINEAR) { /* V along p: all on one line, unless it turns */
      pair->p_rate = pair->q_rate = zero;
      v = scale(pair->p, rate / fraction / (units > 0 ? units : 1), 1);
    }
  }
  if (wish->direction == PARALLEL_THEN) { /* q(T) = times p(T) */
    const struct point turn = scale(cube_of(d, rate_units / fraction), fraction, 1);
    pair->q = add(scale(pair->p, times, 1), -(m.ticks >> m.bits), turn);
    pair->q = add(pair->q, -(m.ticks & (fraction - 1)), scale(turn, 1, fraction));
    pair->q_rate = add(scale(pair->p_rate, times, 1), 1, turn);
  }
  if (wish->direction == NEEDLE) /* at a tiny angle */
    pair->q = add(scale(pair->p, times, 1), 1, cube_of(d, dice_integer(d, 1, 3)));
  if (wish->direction == WEDGE) { /* at a small one, from a common corner nearly */
    pair->q = add(pair->p, 1, cube_of(d, units / 64 + 1));
    pair->q_rate = add(pair->p_rate, 1, cube_of(d, rate_units / 64 + 1));
  }
  if (wish->direction == IN_A_PLANE) { /* spanned by p and another vector */
    const struct point one = cube_of(d, units / 8 + 1), other = cube_of(d, units / 8 + 1);
    struct point *all[] = {&pair->p, &pair->q};
    for (int k = 0; k < 2; k++)
      *all[k] = add(scale(one, dice_integer(d, -3, 3), 1), dice_integer(d, -3, 3), other);
    const int64_t slow = dice_integer(d, 0, rate / (units / 8 + 1) + 1);
    struct point *rates[] = {&pair->p_rate, &pair->q_rate, &v};
    for (int k = 0; k < 3; k++)
      *rates[k] = add(scale(one, dice_integer(d, -slow, slow), 1), dice_integer(d, -slow, slow), other);
  }
  struct point *all[] = {&pair->p, &pair->q, &pair->p_rate, &pair->q_rate};
  for (int k = 0; k < 4; k++)
    *all[k] = scale(*all[k], unit, 1);
  v = scale(v, fraction, 1);
  if (wish->motion == GRAZING) { /* V in the plane of p(T) and q(T), here for bonds that do not turn: f = 0 twice */
    pair->q_rate = scale(pair->q_rate, fraction, 1);
    pair->p_rate = scale(pair->p_rate, fraction, 1);
    const int64_t whole_ticks = m.ticks >> m.bits, rest = m.ticks & (fraction - 1);
    const struct point p = add(add(pair->p, whole_ticks, pair->p_rate), rest, scale(pair->p_rate, 1, fraction)),
                       q = add(add(pair->q, whole_ticks, pair->q_rate), rest, scale(pair->q_rate, 1, fraction));
    const int64_t by = (int64_t)1 << 20;
    const struct point along = {p.x / by * 3 - q.x / by, p.y / by * 3 - q.y / by, p.z / by * 3 - q.z / by};
    v = scale(along, fraction, 1);
  }
  pair->w_rate = add(add(scale(pair->p_rate, s, whole[0]), 1, v), -t, scale(pair->q_rate, 1, whole[1]));
  pair->w = add(scale(pair->p, s, whole[0]), -t, scale(pair->q, 1, whole[1]));
  pair->w = add(pair->w, -m.ticks, scale(v, 1, fraction));
  return m;
}

/* Lengths and rates within what the search promises to judge: below 4096 a0 throughout. Two bonds at rest are not
 * searched. */
static inline bool pair_is_legal(const struct flight_pair *pair)
{
  const int64_t *at = &pair->p.x, *rate = &pair->p_rate.x, limit = (int64_t)1 << 51;
  bool moves = false;
  for (int k = 0; k < 9; k++)
    moves |= rate[k] != 0;
  for (int k = 0; k < 9; k++)
    if (!moves || llabs(at[k]) > limit || llabs(rate[k]) > (int64_t)1 << 35 ||
        llabs(at[k] + rate[k] * FLIGHT_TICKS) > limit)
      return false;
  return true;
}

static const struct contact_wish contact_wishes[] = {
    {"any", {20, 41}, {4, 24}, ANY_PLACE, ANY_DIRECTION, ANY_MOTION},
    {"end on bond", {20, 41}, {4, 24}, END_ON_BOND, ANY_DIRECTION, ANY_MOTION},
    {"end on end", {20, 41}, {4, 24}, END_ON_END, ANY_DIRECTION, ANY_MOTION},
    {"near an end", {30, 41}, {4, 24}, NEAR_END, ANY_DIRECTION, ANY_MOTION},
    {"parallel", {20, 41}, {4, 24}, ANY_PLACE, PARALLEL_ALWAYS, ANY_MOTION},
    {"parallel, ends", {20, 41}, {4, 24}, END_ON_BOND, PARALLEL_ALWAYS, ANY_MOTION},
    {"parallel then", {30, 41}, {10, 24}, ANY_PLACE, PARALLEL_THEN, ANY_MOTION},
    {"collinear", {20, 41}, {10, 24}, END_ON_END, COLLINEAR, NO_ROTATION},
    {"coplanar", {20, 38}, {10, 24}, ANY_PLACE, IN_A_PLANE, ANY_MOTION},
    {"coplanar, end", {20, 38}, {10, 24}, END_ON_BOND, IN_A_PLANE, ANY_MOTION},
    {"grazing", {30, 41}, {4, 20}, ANY_PLACE, ANY_DIRECTION, GRAZING},
    {"grazing an end", {30, 41}, {4, 20}, END_ON_BOND, ANY_DIRECTION, GRAZING},
    {"no rotation", {20, 41}, {4, 24}, ANY_PLACE, ANY_DIRECTION, NO_ROTATION},
    {"nearly at rest", {30, 41}, {0, 3}, ANY_PLACE, ANY_DIRECTION, ANY_MOTION},
    {"ends at rest", {30, 41}, {0, 3}, END_ON_BOND, ANY_DIRECTION, ANY_MOTION},
    {"very fast", {36, 41}, {28, 32}, ANY_PLACE, ANY_DIRECTION, ANY_MOTION},
    {"few units", {0, 4}, {0, 12}, ANY_PLACE, ANY_DIRECTION, ANY_MOTION},
    {"hundreds of a0", {46, 48}, {16, 30}, ANY_PLACE, ANY_DIRECTION, ANY_MOTION},
    {"long, ends", {46, 48}, {0, 20}, END_ON_BOND, ANY_DIRECTION, ANY_MOTION},
    {"needle", {30, 41}, {0, 20}, ANY_PLACE, NEEDLE, ANY_MOTION},
    {"needle, end", {30, 41}, {0, 20}, END_ON_BOND, NEEDLE, ANY_MOTION},
    {"wedge", {30, 41}, {4, 24}, ANY_PLACE, WEDGE, ANY_MOTION},
    {"wedge, end", {30, 41}, {4, 24}, END_ON_BOND, WEDGE, ANY_MOTION},
};
enum { CONTACT_KINDS = sizeof contact_wishes / sizeof contact_wishes[0] };

static inline struct made_contact draw_contact(struct dice *d, const struct contact_wish *wish)
{
  for (;;) {
    const struct made_contact m = make_contact(d, wish);
    if (pair_is_legal(&m.pair))
      return m;
  }
}

/* --- the audit ---------------------------------------------------------------------------------------------------- */

struct flight_tally {
  uint64_t intervals, contacts, answers, missed, early;
  uint64_t invented; /* answers without a contact within that tick */
};

struct flight_audit {
  struct exact_flight exact;
  struct exact_distance distance;
  struct dice dice;
  uint64_t seed;
};

static inline void flight_audit_open(struct flight_audit *a, uint64_t seed)
{
  exact_flight_open(&a->exact);
  exact_distance_open(&a->distance);
  a->dice.state = a->seed = seed;
}

static inline void flight_audit_close(struct flight_audit *a)
{
  exact_flight_close(&a->exact);
  exact_distance_close(&a->distance);
}

static inline void print_pair(const struct flight_pair *pair)
{
  const int64_t *x = &pair->p.x;
  for (int k = 0; k < 6; k++)
    print_message("    {%ld, %ld, %ld},\n", (long)x[3 * k], (long)x[3 * k + 1], (long)x[3 * k + 2]);
}

/* The answer of a search from a tick on: nothing touches before it, and there the bonds are near. */
static inline void audit_search(struct flight_audit *a, const struct flight_pair *pair, int32_t from,
                                struct flight_tally *t)
{
  const int32_t tick = flight_contact(pair, from);
  assert_true(tick >= from && tick <= FLIGHT_TICKS);
  t->intervals++;
  t->missed += tick > from && exact_touch(&a->exact, pair, from, tick);
  if (tick == FLIGHT_TICKS)
    return;
  t->answers++;
  if (exact_touch(&a->exact, pair, tick, tick + 1))
    t->contacts++;
  else
    t->invented++;
  t->early += !exact_near(&a->distance, pair, tick, 1);
}

/* No interval that contains the contact may be excluded, and a search from before it answers no later. */
static inline void audit_contact(struct flight_audit *a, const struct made_contact *m, struct flight_tally *t)
{
  const int32_t before = (int32_t)(m->ticks >> m->bits);
  const int32_t after = before + ((m->ticks & (((int64_t)1 << m->bits) - 1)) != 0);
  int32_t from[5] = {0, before, before, (int32_t)dice_integer(&a->dice, 0, before), before - 1};
  int32_t to[5] = {FLIGHT_TICKS, after + 1, after, (int32_t)dice_integer(&a->dice, after, FLIGHT_TICKS), after};
  for (int k = 0; k < 5; k++) {
    if (from[k] < 0 || from[k] >= to[k] || to[k] > FLIGHT_TICKS)
      continue;
    t->intervals++;
    t->missed += flight_excluded(&m->pair, from[k], to[k]);
    const int32_t tick = from[k] < FLIGHT_TICKS ? flight_contact(&m->pair, from[k]) : FLIGHT_TICKS;
    t->missed += tick > before || (tick == FLIGHT_TICKS);
  }
}

/* All coordinates by up to `units` elsewhere, and sometimes all rates. */
static inline void shake(struct dice *d, struct flight_pair *pair, int64_t units)
{
  struct point *at[] = {&pair->p, &pair->q, &pair->w}, *rate[] = {&pair->p_rate, &pair->q_rate, &pair->w_rate};
  const bool rates = dice_u64(d) & 1;
  for (int k = 0; k < 3; k++) {
    *at[k] = add(*at[k], 1, cube_of(d, units));
    if (rates)
      *rate[k] = add(*rate[k], 1, cube_of(d, units < 16 ? units : 16));
  }
}

static inline void tell_kinds(void)
{
  print_message("  %-16s %10s %10s %10s %9s %7s %6s\n", "", "intervals", "answers", "contacts", "invented", "missed",
                "early");
}

static inline void tell_tally(const char *name, const struct flight_tally *t)
{
  print_message("  %-16s %10lu %10lu %10lu %9lu %7lu %6lu\n", name, (unsigned long)t->intervals,
                (unsigned long)t->answers, (unsigned long)t->contacts, (unsigned long)t->invented,
                (unsigned long)t->missed, (unsigned long)t->early);
}

static inline void judge_tally(const char *name, uint64_t seed, const struct flight_tally *t)
{
  if (t->missed > 0 || t->early > 0)
    fail_msg("seed %lu: %s: %lu missed, %lu answered too early", (unsigned long)seed, name, (unsigned long)t->missed,
             (unsigned long)t->early);
}

/* Contacts of every kind, exactly as made: the exact test sees each, and no search misses it. */
static inline void audit_contacts(uint64_t seed, uint64_t cases)
{
  struct flight_audit a;
  flight_audit_open(&a, seed);
  for (int kind = 0; kind < CONTACT_KINDS; kind++) {
    struct flight_tally t = {0};
    for (uint64_t k = 0; k < cases; k++) {
      const struct made_contact m = draw_contact(&a.dice, &contact_wishes[kind]);
      const int32_t before = (int32_t)(m.ticks >> m.bits), after = before + 1 > FLIGHT_TICKS ? before : before + 1;
      if (k % 8 == 0 && !exact_touch(&a.exact, &m.pair, before, after)) { /* the exact test itself is tested */
        print_pair(&m.pair);
        fail_msg("seed %lu: %s: the exact test does not see a contact that was made", (unsigned long)seed,
                 contact_wishes[kind].name);
      }
      audit_contact(&a, &m, &t);
    }
    judge_tally(contact_wishes[kind].name, seed, &t);
  }
  flight_audit_close(&a);
}

/* The same, shaken by units of the lattice up to some ticks of motion: they touch or just do not. */
static inline void audit_near_contacts(uint64_t seed, uint64_t cases)
{
  struct flight_audit a;
  flight_audit_open(&a, seed);
  tell_kinds();
  bool good = true;
  struct flight_tally sum = {0};
  for (int kind = 0; kind < CONTACT_KINDS; kind++) {
    struct flight_tally t = {0};
    for (uint64_t k = 0; k < cases; k++) {
      struct made_contact m = draw_contact(&a.dice, &contact_wishes[kind]);
      const int64_t largest = dice_power(&a.dice, 0, contact_wishes[kind].rate[1] + 2);
      shake(&a.dice, &m.pair, k % 3 == 0 ? 0 : k % 3 == 1 ? 2 : largest);
      if (pair_is_legal(&m.pair))
        audit_search(&a, &m.pair, k % 4 ? 0 : (int32_t)dice_integer(&a.dice, 0, FLIGHT_TICKS - 1), &t);
    }
    tell_tally(contact_wishes[kind].name, &t);
    good &= t.missed == 0 && t.early == 0;
    sum.intervals += t.intervals, sum.answers += t.answers, sum.contacts += t.contacts;
    sum.missed += t.missed, sum.early += t.early, sum.invented += t.invented;
  }
  tell_tally("all", &sum);
  flight_audit_close(&a);
  judge_tally("near contacts", seed, &sum);
  assert_true(good && sum.contacts > sum.intervals / 10 && 10 * sum.answers < 9 * sum.intervals);
}

#endif
