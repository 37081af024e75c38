/* What differences usually mean: the search for a bug that makes them, else for a description of the rows that are
 * wrong; and what all patterns use. */
#include <math.h>
#include <string.h>

#include "oracle/pair.h"
#include "oracle/patterns.h"
#include "oracle/relations.h"
#include "oracle/replay.h"
#include "oracle/rows.h"

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

const struct oracle_pattern oracle_patterns_any[] = {
    {NULL, NULL, "single precision somewhere: right to 5 to 8 digits (--single has its tolerances)", is_single},
    {.meaning = NULL},
};

/* --- the search -------------------------------------------------------------------------------------------------- */

static const char *name_of(const struct oracle_pair *p)
{
  const char *name = p->ours->place.operator_name;
  return strncmp(name, "long_", strlen("long_")) == 0 ? name + strlen("long_") : name;
}

static bool is_for(const char *operator_name, const char *table, const struct oracle_pair *p)
{
  return (!operator_name || strcmp(operator_name, name_of(p)) == 0) && (!table || strcmp(table, p->ours->name) == 0);
}

static bool search_patterns(const struct oracle_pattern *pattern, const struct oracle_pair *p, char *text)
{
  while (pattern->meaning && !(is_for(pattern->operator_name, pattern->table, p) && pattern->fits(p)))
    pattern++;
  if (pattern->meaning)
    snprintf(text, ORACLE_TEXT, "%s", pattern->meaning);
  return pattern->meaning != NULL;
}

/* One more name for what was found: two bugs that make the same numbers cannot be told apart. */
void oracle_name(char text[ORACLE_TEXT], bool *named, const char *name)
{
  const size_t used = *named ? strlen(text) : 0;
  if (!*named || !strstr(text, name))
    snprintf(text + used, ORACLE_TEXT - used, "%s%s", *named ? "; or: " : "", name);
  *named = true;
}

/* All relations that are right everywhere, or the first if so wanted. Of those that are right wherever theirs is wrong,
 * but not everywhere, the first is kept. */
static bool search_relations(const struct relation *r, struct evidence *e, bool all, char *text,
                             char partial[RELATION_TEXT])
{
  bool named = false;
  for (; r->make; r++) {
    char said[RELATION_TEXT];
    if (!is_for(r->operator_name, r->table, &e->part[0].pair) || e->wrongs < r->least)
      continue;
    for (uint32_t k = 0; r->make(e, k, said) && (all || !named); k++) {
      const enum evidence_fit fit = evidence_judge(e);
      if (fit == FIT_WHOLE)
        oracle_name(text, &named, said);
      if (fit == FIT_WRONG && !*partial)
        snprintf(partial, RELATION_TEXT, "%s", said);
    }
  }
  return named;
}

static bool search_all_relations(struct evidence *e, char *text, char partial[RELATION_TEXT])
{
  static const struct relation *const lists[] = {oracle_relations_random, oracle_relations_contact,
                                                 oracle_relations_fiber, oracle_relations_event,
                                                 oracle_relations_solvent};
  bool found = false;
  for (size_t k = 0; k < sizeof lists / sizeof lists[0] && !found; k++)
    found = search_relations(lists[k], e, true, text, partial);
  return found || search_relations(oracle_relations_any, e, false, text, partial);
}

/* Of an operator that has two tables of a kind, solvent and vertices, one may be right. */
static void say_which_table(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  const char *other = strcmp(p->ours->name, "out.solvent") == 0  ? "out.vertex"
                      : strcmp(p->ours->name, "out.vertex") == 0 ? "out.solvent"
                                                                 : NULL;
  struct oracle_pair pair = *p;
  pair.ours = other ? oracle_sibling(p, other) : NULL;
  pair.theirs = other ? oracle_sibling_of_theirs(p, other) : NULL;
  if (!pair.ours || !pair.theirs || pair.theirs->rows != pair.ours->rows || pair.ours->rows == 0)
    return;
  for (uint32_t row = 0; row < pair.ours->rows; row++)
    for (uint32_t k = 0; k < pair.ours->columns; k++)
      if (!oracle_agrees(&pair, row, k))
        return;
  snprintf(text + strlen(text), ORACLE_TEXT - strlen(text), " (in %s only; %s is right)", p->ours->name, other);
}

/* Which rows are wrong, by an exact rule if there is one, and what their values are if a relation is right there. */
static void describe(struct evidence *e, const char *partial, char *text)
{
  char rows[ROWS_TEXT], side[RELATION_TEXT] = "";
  bool exact = oracle_describe_rows(e, rows);
  if (!exact && e->differences > e->wrongs) {
    char all[ROWS_TEXT];
    evidence_count_all(e);
    exact = oracle_describe_rows(e, all);
    if (exact)
      memcpy(rows, all, sizeof rows);
  }
  if (!*partial)
    oracle_one_sided(e, side);
  snprintf(text, ORACLE_TEXT, "%s%s%s", *partial ? partial : side, *partial || *side ? "; " : "", rows);
}

/* Of a hit, the first row that differs counts: what follows is consequence. */
static void say_first_hit(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  bool wrong = false;
  for (uint32_t row = 0; row < oracle_common_rows(p) && !wrong; row++)
    for (uint32_t k = 0; k < p->ours->columns; k++) {
      if (oracle_agrees(p, row, k))
        continue;
      const size_t used = wrong ? strlen(text) : 0;
      snprintf(text + used, ORACLE_TEXT - used, "%s %s",
               wrong ? "," : "no rule known; the first hit that differs is wrong in", p->ours->component[k]);
      wrong = true;
    }
}

/* True if nothing else need be tried. */
static bool diagnose_sweep(const struct oracle_pair *p, bool beyond, char text[ORACLE_TEXT])
{
  const bool rows_follow = strcmp(p->ours->name, "out.event") == 0 || strcmp(p->ours->name, "out.hit") == 0;
  if (oracle_replay(p, text))
    return true;
  if (!beyond || !rows_follow)
    return search_patterns(oracle_patterns_sweep, p, text);
  if (strcmp(p->ours->name, "out.hit") == 0)
    say_first_hit(p, text);
  return oracle_judge_moves(p, text) || search_patterns(oracle_patterns_sweep, p, text) || true;
}

void oracle_diagnose(const struct oracle_pair *p, bool beyond, char text[ORACLE_TEXT])
{
  struct evidence e = {0};
  char partial[RELATION_TEXT] = "";
  const char *const unknown =
      beyond ? "none of those known" : "order of operations, fused multiply-add, or library functions";
  snprintf(text, ORACLE_TEXT, "%s", unknown);
  if (p->ours->columns != p->theirs->columns || (is_for("sweep", NULL, p) && diagnose_sweep(p, beyond, text)) ||
      (is_for("event_drift", NULL, p) && oracle_replay_events(p, text)))
    return;
  if (evidence_take(p, &e)) {
    if (search_all_relations(&e, text, partial) || search_patterns(oracle_patterns_contact, p, text) ||
        search_patterns(oracle_patterns_random, p, text) || search_patterns(oracle_patterns_solvent, p, text) ||
        search_patterns(oracle_patterns_any, p, text)) {
      say_which_table(p, text);
      evidence_free(&e);
      return;
    }
    char side[RELATION_TEXT];
    if (beyond)
      describe(&e, partial, text);
    else if (oracle_one_sided(&e, side))
      snprintf(text, ORACLE_TEXT, "%s", side);
  }
  evidence_free(&e);
}
