#include "oracle/facts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/facts_make.h"

/* --- sets --------------------------------------------------------------------------------------------------------- */

/* A fact; of two that are true of the same units, the cheaper is kept. */
static void add(struct facts *f, const struct units *u, double cost, const bool *true_of, const char *text)
{
  uint64_t *bits = calloc(f->words + 1, sizeof *bits);
  struct fact *same, *grown = bits ? realloc(f->fact, (f->count + 1) * sizeof *grown) : NULL;
  f->fact = grown ? grown : f->fact;
  f->failed |= !grown;
  if (!grown) {
    free(bits);
    return;
  }
  for (uint32_t k = 0; k < u->n; k++)
    bits[k / 64] |= (uint64_t)true_of[k] << (k % 64);
  for (same = f->fact; same < f->fact + f->count; same++)
    if (memcmp(same->bits, bits, f->words * sizeof *bits) == 0)
      break;
  const bool known = same < f->fact + f->count;
  if (known)
    free(bits);
  if (known && same->cost <= cost)
    return;
  same->cost = cost;
  snprintf(same->text, sizeof same->text, "%s", text);
  if (!known)
    same->bits = bits, f->count++;
}

void facts_free(struct facts *f)
{
  for (uint32_t k = 0; k < f->count; k++)
    free(f->fact[k].bits);
  free(f->fact);
  memset(f, 0, sizeof *f);
}

/* --- facts from a number for each unit ---------------------------------------------------------------------------- */

typedef bool test(double value, double x);

static bool is_equal(double value, double x)
{
  return value == x;
}

static bool is_least(double value, double x)
{
  return value >= x;
}

static bool is_most(double value, double x)
{
  return value <= x;
}

static bool is_below(double value, double x)
{
  return value < x;
}

static bool is_above(double value, double x)
{
  return value > x;
}

static bool is_odd(double value, double x)
{
  return fmod(fabs(value), 2.0) == x;
}

/* A fact and its negation. */
static void add_test(struct maker *m, double cost, test *holds, double x, const char *yes, const char *no)
{
  for (uint32_t k = 0; k < m->u->n; k++)
    m->true_of[k] = !isnan(m->value[k]) && holds(m->value[k], x);
  add(m->f, m->u, cost, m->true_of, yes);
  for (uint32_t k = 0; no && k < m->u->n; k++)
    m->true_of[k] = !m->true_of[k];
  if (no)
    add(m->f, m->u, cost + 0.5, m->true_of, no);
}

static void add_flag(struct maker *m, const char *text)
{
  char yes[FACT_TEXT];
  const char *bar = strchr(text, '|');
  snprintf(yes, sizeof yes, "%.*s", bar ? (int)(bar - text) : (int)strlen(text), text);
  add_test(m, 3.0, is_equal, 1.0, yes, bar ? bar + 1 : NULL);
}

static void add_sign(struct maker *m, const char *name)
{
  char yes[FACT_TEXT], no[FACT_TEXT];
  snprintf(yes, sizeof yes, "%.60s is negative", name), snprintf(no, sizeof no, "%.60s is not negative", name);
  add_test(m, 5.0, is_below, 0.0, yes, no);
  snprintf(yes, sizeof yes, "%.60s is positive", name), snprintf(no, sizeof no, "%.60s is not positive", name);
  add_test(m, 5.0, is_above, 0.0, yes, no);
  snprintf(yes, sizeof yes, "%.60s is 0", name), snprintf(no, sizeof no, "%.60s is not 0", name);
  add_test(m, 4.5, is_equal, 0.0, yes, no);
}

/* Each of a few values, in the order in which they come. */
static void add_equal(struct maker *m, const char *name)
{
  double seen[17];
  uint32_t count = 0;
  for (uint32_t k = 0; k < m->u->n; k++) {
    bool known = isnan(m->value[k]);
    for (uint32_t j = 0; j < count; j++)
      known |= seen[j] == m->value[k];
    if (!known && count == 16)
      return;
    if (!known)
      seen[count++] = m->value[k];
  }
  for (uint32_t j = 0; j < count; j++) {
    char yes[FACT_TEXT], no[FACT_TEXT];
    snprintf(yes, sizeof yes, "%.60s is %.10g", name, seen[j]);
    snprintf(no, sizeof no, "%.60s is not %.10g", name, seen[j]);
    add_test(m, 4.0 + log2(count), is_equal, seen[j], yes, no);
  }
}

/* From the least that is wrong on, and up to the most: the only two ranges that can help. */
static void add_range(struct maker *m, const char *name)
{
  double least = INFINITY, most = -INFINITY;
  char text[FACT_TEXT];
  for (uint32_t k = 0; k < m->u->n; k++)
    if (m->u->wrong[k])
      least = fmin(least, m->value[k]), most = fmax(most, m->value[k]);
  const double cost = 5.0 + log2(m->u->n);
  snprintf(text, sizeof text, "%.60s is %.10g or more", name, least);
  add_test(m, cost, is_least, least, text, NULL);
  snprintf(text, sizeof text, "%.60s is %.10g or less", name, most);
  add_test(m, cost, is_most, most, text, NULL);
}

static void add_parity(struct maker *m, const char *name)
{
  char yes[FACT_TEXT], no[FACT_TEXT];
  snprintf(yes, sizeof yes, "%.60s is odd", name), snprintf(no, sizeof no, "%.60s is even", name);
  add_test(m, 4.0, is_odd, 1.0, yes, no);
}

void facts_make(struct maker *m, enum sort sort, const char *name)
{
  if (sort & FLAG)
    add_flag(m, name);
  if (sort & SIGN)
    add_sign(m, name);
  if (sort & EQUAL)
    add_equal(m, name);
  if (sort & PARITY)
    add_parity(m, name);
  if (sort & RANGE)
    add_range(m, name);
}

/* --- where numbers come from -------------------------------------------------------------------------------------- */

void facts_make_of(struct maker *m, enum sort sort, const char *name, number_of *f)
{
  for (uint32_t k = 0; k < m->u->n; k++) {
    uint32_t own;
    const struct evidence_part *part = evidence_part_of(m->u->e, unit_row(m->u, k), &own);
    m->value[k] = f(part, own, m->u->values ? m->u->column[k % m->u->columns] : 0);
  }
  facts_make(m, sort, name);
}

/* --- all ---------------------------------------------------------------------------------------------------------- */

void facts_collect(const struct units *u, struct facts *f)
{
  *f = (struct facts){.words = (u->n + 63) / 64};
  struct maker m = {u, f, calloc((size_t)u->n + 1, sizeof *m.value), calloc((size_t)u->n + 1, sizeof *m.true_of)};
  f->failed = !m.value || !m.true_of;
  if (!f->failed) {
    facts_of_places(&m);
    facts_of_fibers(&m);
    facts_of_cells(&m);
    facts_of_contacts(&m);
    facts_of_tables(&m);
  }
  free(m.value);
  free(m.true_of);
}
