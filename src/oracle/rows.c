#include "oracle/rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/facts.h"

#define MANY 160 /* facts of which threes are tried */
#define LISTED 8 /* rows that are told one by one */

/* --- which units are wrong ---------------------------------------------------------------------------------------- */

static bool row_is_wrong(const struct evidence *e, uint32_t row)
{
  bool wrong = false;
  for (uint32_t column = 0; column < e->columns; column++)
    wrong |= e->wrong[(size_t)row * e->columns + column];
  return wrong;
}

static bool take_units(const struct evidence *e, bool values, struct units *u)
{
  *u = (struct units){.e = e, .values = values};
  for (uint32_t column = 0; column < e->columns; column++) {
    bool any = false;
    for (uint32_t row = 0; row < e->rows; row++)
      any |= e->wrong[(size_t)row * e->columns + column];
    if (any)
      u->column[u->columns++] = column;
  }
  u->n = values ? e->rows * u->columns : e->rows;
  u->wrong = calloc((size_t)u->n + 1, sizeof *u->wrong);
  for (uint32_t k = 0; u->wrong && k < u->n; k++)
    u->wrong[k] =
        values ? e->wrong[(size_t)unit_row(u, k) * e->columns + u->column[k % u->columns]] : row_is_wrong(e, k);
  return u->wrong != NULL;
}

/* --- the search for a rule ---------------------------------------------------------------------------------------- */

struct rule {
  const struct fact *fact[3];
  uint32_t facts;
  bool any; /* of the facts; else all */
  double cost;
};

struct search {
  const struct facts *f;
  uint64_t *wrong, *joined; /* [words] */
  const struct fact **useful;
  uint32_t count;
  bool any;
  struct rule best;
};

/* With `all`, facts that hold for every wrong unit can help; with `any`, those that hold for wrong ones only. */
static bool helps(const struct search *s, const uint64_t *bits)
{
  bool some = false;
  for (uint32_t k = 0; k < s->f->words; k++) {
    if (s->any ? bits[k] & ~s->wrong[k] : s->wrong[k] & ~bits[k])
      return false;
    some |= bits[k] != 0;
  }
  return some;
}

static bool is_exact(const struct search *s, const struct fact *const *fact, uint32_t n)
{
  for (uint32_t k = 0; k < s->f->words; k++) {
    uint64_t joined = fact[0]->bits[k];
    for (uint32_t j = 1; j < n; j++)
      joined = s->any ? joined | fact[j]->bits[k] : joined & fact[j]->bits[k];
    if (joined != s->wrong[k])
      return false;
  }
  return true;
}

static void try_rule(struct search *s, const struct fact *const *fact, uint32_t n)
{
  double cost = n == 1 ? 1.0 : 2.0 * n - 1.0 + (s->any ? 1.0 : 0.0); /* 1/2 for one fact; 1/8, 1/16; 1/32, 1/64 */
  for (uint32_t k = 0; k < n; k++)
    cost += fact[k]->cost;
  if ((s->best.facts == 0 || cost < s->best.cost) && is_exact(s, fact, n)) {
    s->best = (struct rule){.facts = n, .any = s->any, .cost = cost};
    memcpy(s->best.fact, fact, n * sizeof(struct fact *));
  }
}

static void search_all(struct search *s)
{
  s->count = 0;
  for (uint32_t k = 0; k < s->f->count; k++)
    if (helps(s, s->f->fact[k].bits))
      s->useful[s->count++] = &s->f->fact[k];
  for (uint32_t i = 0; i < s->count; i++) {
    const struct fact *fact[3] = {s->useful[i]};
    try_rule(s, fact, 1);
    for (uint32_t j = 0; j < i; j++) {
      fact[1] = s->useful[j];
      try_rule(s, fact, 2);
      for (uint32_t k = 0; i < MANY && k < j; k++) {
        fact[2] = s->useful[k];
        try_rule(s, fact, 3);
      }
    }
  }
}

/* What the choice of the wrong units is worth. If it is the same at each step, it counts once. */
static double bits_of_choice(const struct units *u)
{
  const struct evidence *e = u->e;
  const uint32_t per_row = u->values ? u->columns : 1, n = e->part[0].rows * per_row;
  bool alike = e->parts > 1 && n > 0;
  double wrong = 0.0, of_first = 0.0;
  for (uint32_t k = 1; k < e->parts; k++)
    alike &= e->part[k].rows == e->part[0].rows;
  for (uint32_t k = 0; k < u->n; k++) {
    wrong += u->wrong[k];
    of_first += k < n && u->wrong[k];
    alike = alike && u->wrong[k] == u->wrong[k % n];
  }
  return alike ? evidence_ways(n, of_first) : evidence_ways(u->n, wrong);
}

/* Facts' costs are made weights 2^-cost that add up to 1. */
static void weigh(struct facts *f)
{
  double sum = 0.0;
  for (uint32_t k = 0; k < f->count; k++)
    sum += exp2(-f->fact[k].cost);
  for (uint32_t k = 0; k < f->count; k++)
    f->fact[k].cost += log2(sum);
}

static bool find_rule(const struct units *u, struct facts *f, struct rule *rule)
{
  struct search s = {.f = f};
  facts_collect(u, f);
  weigh(f);
  s.wrong = calloc((size_t)f->words + 1, sizeof *s.wrong);
  s.useful = calloc((size_t)f->count + 1, sizeof(struct fact *));
  bool ok = !f->failed && s.wrong && s.useful;
  for (uint32_t k = 0; ok && k < u->n; k++)
    s.wrong[k / 64] |= (uint64_t)u->wrong[k] << (k % 64);
  for (int any = 0; ok && any < 2; any++) {
    s.any = any;
    search_all(&s);
  }
  *rule = s.best;
  free(s.wrong);
  free(s.useful);
  return ok && rule->facts > 0 && rule->cost + EVIDENCE_SURE <= bits_of_choice(u);
}

/* --- words -------------------------------------------------------------------------------------------------------- */

static uint32_t count_wrong(const struct units *u)
{
  uint32_t n = 0;
  for (uint32_t k = 0; k < u->n; k++)
    n += u->wrong[k];
  return n;
}

static void append(char text[ROWS_TEXT], const char *more)
{
  snprintf(text + strlen(text), ROWS_TEXT - strlen(text), "%s", more);
}

static void say_columns(const struct units *u, char text[ROWS_TEXT])
{
  if (u->columns == u->e->columns)
    return;
  append(text, u->columns > 1 ? "columns" : "column");
  for (uint32_t k = 0; k < u->columns; k++) {
    append(text, k == 0 ? " " : ", ");
    append(text, u->e->part[0].pair.ours->component[u->column[k]]);
  }
  append(text, " of ");
}

static void say_rule(const struct units *u, const struct rule *rule, char text[ROWS_TEXT])
{
  char number[64];
  snprintf(text, ROWS_TEXT, "wrong exactly in ");
  say_columns(u, text);
  if (rule)
    append(text, u->values ? "values where " : "rows where ");
  for (uint32_t k = 0; rule && k < rule->facts; k++) {
    append(text, k == 0 ? "" : rule->any ? ", or " : ", and ");
    append(text, rule->fact[k]->text);
  }
  snprintf(number, sizeof number, "%s: %u of %u %s%s",
           rule        ? ""
           : u->values ? "all values"
                       : "all rows",
           count_wrong(u), u->n, u->values ? "values" : "rows", count_wrong(u) < u->n ? ", and nowhere else" : "");
  append(text, number);
}

/* Rows by their numbers: all if they are few. */
static bool say_list(const struct units *u, char text[ROWS_TEXT])
{
  const uint32_t wrong = count_wrong(u);
  const bool few = wrong <= LISTED, many_steps = u->e->parts > 1;
  uint32_t told = 0;
  if (few)
    snprintf(text, ROWS_TEXT, "wrong exactly in %u of %u rows, too few for a rule:", wrong, u->n);
  else
    snprintf(text, ROWS_TEXT, "no rule known for the wrong rows, %u of %u:", wrong, u->n);
  for (uint32_t k = 0; k < u->n && told < LISTED; k++) {
    char number[80], step[32] = "";
    uint32_t own;
    const struct evidence_part *part = evidence_part_of(u->e, k, &own);
    if (many_steps)
      snprintf(step, sizeof step, " of step %llu", (unsigned long long)part->pair.ours->place.step);
    snprintf(number, sizeof number, "%s %u%s%s", told ? "," : "", own, few ? step : "",
             few && own + 1 == part->pair.ours->rows ? " (the last)" : "");
    if (u->wrong[k])
      append(text, number), told++;
  }
  if (told < wrong)
    append(text, ", ...");
  return few;
}

/* What is wrong is the whole table: no description. */
static void say_all(const struct units *u, char text[ROWS_TEXT])
{
  snprintf(text, ROWS_TEXT, "%s: %u of %u", u->values ? "all values" : "all rows", u->n, u->n);
}

/* Values tell nothing more than rows if each wrong row is wrong in all columns that are. */
static bool rows_are_whole(const struct units *u)
{
  for (uint32_t row = 0; row < u->e->rows; row++)
    for (uint32_t k = 0; u->wrong[row] && k < u->columns; k++)
      if (!u->e->wrong[(size_t)row * u->e->columns + u->column[k]])
        return false;
  return true;
}

bool oracle_describe_rows(const struct evidence *e, char text[ROWS_TEXT])
{
  bool found = false, listed = false, whole = false;
  for (int values = 0; values < 2 && !found && !whole; values++) {
    struct units u;
    struct facts f = {0};
    struct rule rule;
    if (!take_units(e, values, &u))
      break;
    const bool all = count_wrong(&u) == u.n, everywhere = all && u.columns == e->columns;
    found = !everywhere && (all || find_rule(&u, &f, &rule));
    if (found)
      say_rule(&u, all ? NULL : &rule, text);
    else if (everywhere)
      say_all(&u, text);
    else if (values == 0)
      listed = say_list(&u, text);
    whole = values == 0 && rows_are_whole(&u);
    facts_free(&f);
    free(u.wrong);
  }
  return found || listed;
}
