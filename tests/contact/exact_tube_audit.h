/* The search for contacts of tubes (contact/tube.h) against polynomials over the integers: the pairs of
 * contact/tubes.h, the verdicts of contact/exact_tubes.h. */
#ifndef UNCROSS_TESTS_EXACT_TUBE_AUDIT_H
#define UNCROSS_TESTS_EXACT_TUBE_AUDIT_H

#include "contact/exact_tubes.h"
#include "contact/tubes.h"

/* Answers: those with a contact in their tick, and those that pass by within the doubt (tube_doubt). Missed: a contact
 * before the answer. Invented: further apart than the doubt in the whole tick. Open: not decided. */
struct exact_tally {
  uint64_t queries, answers, contacts, passes, missed, invented, open;
  double overlap; /* a0, the deepest before an answer */
};

static inline void count_answer(struct exact_tubes *e, const struct tube_query *k, int32_t tick, struct exact_tally *t)
{
  const int64_t reach = k->reach << REACH_BITS, doubt = (int64_t)ceil(tube_doubt(k) * 0x1p40 * (1 << REACH_BITS));
  t->answers++;
  if (exact_tubes_verdict(e, &k->pair, reach, tick, tick + 1) == TUBES_TOUCH) {
    t->contacts++;
    return;
  }
  const enum tube_verdict near = exact_tubes_verdict(e, &k->pair, reach + doubt, tick, tick + 1);
  t->passes += near == TUBES_TOUCH, t->invented += near == TUBES_APART, t->open += near == TUBES_OPEN;
}

static inline void audit_exactly(struct exact_tubes *e, const struct tube_query *k, tube_search *search,
                                 struct exact_tally *t)
{
  const int64_t reach = k->reach << REACH_BITS;
  if (exact_tubes_verdict(e, &k->pair, reach, k->from, k->from) != TUBES_APART) /* no question */
    return;
  const int32_t tick = search(&k->pair, k->reach, k->from);
  const enum tube_verdict before = exact_tubes_verdict(e, &k->pair, reach, k->from, tick);
  t->queries++;
  t->open += before == TUBES_OPEN;
  if (before == TUBES_TOUCH) {
    const long double apart = (long double)k->reach * 0x1p-40L;
    t->missed++;
    t->overlap = fmax(t->overlap, -(double)least_gap(&k->pair, apart, k->from, tick, -1.0L));
  }
  if (tick < FLIGHT_TICKS)
    count_answer(e, k, tick, t);
}

static inline void tell_exact(const char *name, const struct exact_tally *t)
{
  print_message("  %-12s %9lu queries %9lu answers: %9lu contacts %8lu passes; %lu missed, %lu invented, %lu open;"
                " overlap %.1e a0\n",
                name, (unsigned long)t->queries, (unsigned long)t->answers, (unsigned long)t->contacts,
                (unsigned long)t->passes, (unsigned long)t->missed, (unsigned long)t->invented, (unsigned long)t->open,
                t->overlap);
  fflush(stdout);
}

static inline struct exact_tally audit_kind_exactly(struct dice *d, enum tube_kind kind, uint64_t queries,
                                                    tube_search *search)
{
  struct exact_tubes *e = exact_tubes_open();
  struct exact_tally t = {0};
  while (t.queries < queries) {
    const struct tube_query k = draw_tubes(d, kind);
    audit_exactly(e, &k, search, &t);
  }
  exact_tubes_close(e);
  return t;
}

/* So many queries of each kind. */
static inline struct exact_tally audit_tubes_exactly(uint64_t seed, uint64_t queries)
{
  struct dice d = {seed};
  struct exact_tally sum = {0};
  for (int kind = 0; kind < TUBE_KINDS; kind++) {
    const struct exact_tally t = audit_kind_exactly(&d, (enum tube_kind)kind, queries, tube_contact);
    tell_exact(tube_kinds[kind], &t);
    sum.queries += t.queries, sum.answers += t.answers, sum.contacts += t.contacts, sum.passes += t.passes;
    sum.missed += t.missed, sum.invented += t.invented, sum.open += t.open;
    sum.overlap = fmax(sum.overlap, t.overlap);
  }
  tell_exact("all", &sum);
  return sum;
}

#endif
