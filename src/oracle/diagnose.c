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
    double sum = 0.0, squares = 0.0, most = 0.0, off = 0.0;
    for (uint32_t row = 0; row < rows; row++) {
      const double ours = pack_value(p->ours, row, column), d = ours - pack_value(p->theirs, row, column);
      size = fmax(size, fabs(ours));
      worst = fabs(d) <= worst ? worst : fabs(d);
      most = fmax(most, fabs(ours)), off = fabs(d) <= off ? off : fabs(d);
      sum += d;
      squares += d * d;
      wrong += d != 0.0;
    }
    if (!(fabs(sum) <= 4.0 * sqrt(squares)) || off > 0x1p-16 * most || (off > 0.0 && !p->ours->real && most < 0x1p30))
      return false;
  }
  return p->rounding < 0x1p-30 && wrong >= 8 && worst > 0x1p-32 * size && worst < 0x1p-16 * size;
}

static bool is_single(const struct oracle_pair *p)
{
  return oracle_is_single(p, oracle_common_rows(p));
}

const struct oracle_pattern oracle_patterns_any[] = {
    {NULL, NULL, ORACLE_AS_SINGLE, is_single},
    {.meaning = NULL},
};

/* --- the search -------------------------------------------------------------------------------------------------- */

#define MOST_FITS 24
#define MOST_TABLES 8

struct search {
  struct evidence *e;
  struct evidence other[MOST_TABLES]; /* the operator's other outputs */
  uint32_t others;
  bool others_known;
  double tried; /* guesses so far */
  char *text;
  bool named;
  char partial[RELATION_TEXT]; /* right wherever theirs is wrong, but not everywhere else */
};

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
    snprintf(text + used, ORACLE_TEXT - used, "%s%.200s", *named ? "; or: " : "", name);
  *named = true;
}

/* The other outputs of the pair's operator, at all steps. */
static void know_others(struct search *s)
{
  const struct oracle_pair *p = &s->e->part[0].pair;
  for (size_t k = 0; k < p->pack->count && !s->others_known && s->others < MOST_TABLES; k++) {
    const struct pack_table *ours = &p->pack->table[k], *theirs = pack_find(p->pack_theirs, &ours->place, ours->name);
    if (ours == p->ours || strncmp(ours->name, "out.", 4) != 0 || !theirs || theirs->columns != ours->columns ||
        memcmp(&ours->place, &p->ours->place, sizeof ours->place) != 0)
      continue;
    const struct oracle_pair pair = {p->pack, p->pack_theirs, ours, theirs, p->rounding, NULL};
    s->others += evidence_load(&pair, &s->other[s->others]);
  }
  s->others_known = true;
}

/* Number k of a relation makes theirs in all other tables of the operator, too. */
static bool makes_others(struct search *s, const struct relation *r, uint32_t k)
{
  char said[RELATION_TEXT];
  know_others(s);
  for (uint32_t j = 0; j < s->others; j++)
    if (!r->make(&s->other[j], k, said) || evidence_judge(&s->other[j]) != FIT_WHOLE)
      return false;
  return true;
}

static bool column_is_wrong(const struct evidence *e, uint32_t column)
{
  for (uint32_t row = 0; row < e->rows; row++)
    if (e->wrong[(size_t)row * e->columns + column])
      return true;
  return false;
}

/* Relations of any operator are about the columns that are wrong. True if there are others. */
static bool leave_right_columns(struct evidence *e)
{
  bool left = false;
  for (uint32_t column = 0; column < e->columns; column++) {
    const bool right = !column_is_wrong(e, column);
    for (uint32_t row = 0; right && row < e->rows; row++)
      e->guess[(size_t)row * e->columns + column] = e->theirs[(size_t)row * e->columns + column];
    left |= right;
  }
  return left;
}

static void say_wrong_columns(const struct evidence *e, char text[RELATION_TEXT])
{
  const char *between = " (in";
  for (uint32_t column = 0; column < e->columns; column++)
    if (column_is_wrong(e, column)) {
      snprintf(text + strlen(text), RELATION_TEXT - strlen(text), "%s %.20s", between,
               e->part[0].pair.ours->component[column]);
      between = ",";
    }
  snprintf(text + strlen(text), RELATION_TEXT - strlen(text), " only)");
}

/* All relations of a list that are right everywhere, if chance would not make them fit. One with free numbers is told
 * alone only. */
static void search_relations(struct search *s, const struct relation *r, bool any_operator)
{
  struct {
    char text[RELATION_TEXT];
    double bits;
    uint32_t free;
  } fit[MOST_FITS];
  struct evidence *e = s->e;
  uint32_t fits = 0;
  memset(e->moved, 0, e->rows * sizeof *e->moved);
  for (; r->make; r++) {
    char said[RELATION_TEXT];
    if (!is_for(r->operator_name, r->table, &e->part[0].pair))
      continue;
    e->free = 0, e->decides = false;
    for (uint32_t k = 0; r->make(e, k, said); k++, e->free = 0, e->decides = false) {
      s->tried++;
      if (any_operator && leave_right_columns(e))
        say_wrong_columns(e, said);
      const enum evidence_fit how = evidence_judge(e);
      if (how == FIT_WHOLE && fits < MOST_FITS && (!r->together || makes_others(s, r, k))) {
        fit[fits].bits = e->decides ? 0.0 : evidence_bits(e), fit[fits].free = e->free;
        memcpy(fit[fits++].text, said, sizeof said);
      }
      if (how == FIT_WRONG && any_operator && !*s->partial && evidence_bits(e) >= EVIDENCE_SURE + log2(s->tried))
        memcpy(s->partial, said, sizeof said);
    }
  }
  const double choice = any_operator ? evidence_ways(e->rows, e->wrong_rows) : evidence_choice(e);
  for (uint32_t k = 0; k < fits; k++)
    if (fit[k].bits + choice >= EVIDENCE_SURE + log2(s->tried) && !(fit[k].free > 0 && s->named))
      oracle_name(s->text, &s->named, fit[k].text);
}

static bool search_all_relations(struct search *s)
{
  static const struct relation *const lists[] = {
      oracle_relations_random, oracle_relations_permutation, oracle_relations_contact,    oracle_relations_fiber,
      oracle_relations_event,  oracle_relations_tube,        oracle_relations_grid,       oracle_relations_sum,
      oracle_relations_rotate, oracle_relations_andersen,    oracle_relations_spin,       oracle_relations_walls,
      oracle_relations_shear,  oracle_relations_dumbbell,    oracle_relations_thermostat, oracle_relations_medium,
      oracle_relations_pairs};
  for (size_t k = 0; k < sizeof lists / sizeof lists[0] && !s->named; k++)
    search_relations(s, lists[k], false);
  if (!s->named)
    search_relations(s, oracle_relations_any, true);
  for (uint32_t k = 0; k < s->others; k++)
    evidence_free(&s->other[k]);
  return s->named;
}

/* --- words -------------------------------------------------------------------------------------------------------- */

static bool table_is_right(const struct oracle_pair *p)
{
  if (p->theirs->rows != p->ours->rows)
    return false;
  for (uint32_t row = 0; row < p->ours->rows; row++)
    for (uint32_t k = 0; k < p->ours->columns; k++)
      if (!oracle_agrees(p, row, k))
        return false;
  return true;
}

/* Of an operator that has tables of a kind, solvent and vertices, or four ends, all others may be right. */
static void say_which_table(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  const struct pack_table *other = NULL;
  uint32_t others = 0;
  if (!is_for("bin", NULL, p) && !is_for("rotate", NULL, p) && !is_for("exchange", NULL, p))
    return;
  for (size_t k = 0; k < p->pack->count; k++) {
    struct oracle_pair pair = *p;
    pair.ours = &p->pack->table[k];
    if (pair.ours == p->ours || memcmp(&pair.ours->place, &p->ours->place, sizeof p->ours->place) != 0 ||
        strncmp(pair.ours->name, "out.", 4) != 0 || pair.ours->columns != p->ours->columns ||
        memcmp(pair.ours->component, p->ours->component, sizeof p->ours->component) != 0 || pair.ours->rows == 0)
      continue;
    pair.theirs = oracle_sibling_of_theirs(p, pair.ours->name);
    if (!pair.theirs || pair.theirs->columns != pair.ours->columns || !table_is_right(&pair))
      return;
    other = pair.ours;
    others++;
  }
  if (others > 0)
    snprintf(text + strlen(text), ORACLE_TEXT - strlen(text), " (in %s only; %s %s right)", p->ours->name,
             others > 1 ? "its like" : other->name, others > 1 ? "are" : "is");
}

/* How far off the wrong values are. */
static void say_size(const struct evidence *e, char *text)
{
  double least = INFINITY, most = 0.0;
  for (size_t k = 0; k < (size_t)e->rows * e->columns; k++)
    if (e->wrong[k] && isfinite(e->theirs[k])) {
      const double off = fabs(e->theirs[k] - e->ours[k]);
      least = fmin(least, off), most = fmax(most, off);
    }
  if (most > 0.0)
    snprintf(text + strlen(text), ORACLE_TEXT - strlen(text), "; off by %.3g to %.3g", least, most);
}

/* Which rows are wrong, by an exact rule if there is one, and what their values are if a relation of any operator is
 * right there. */
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
  snprintf(text, ORACLE_TEXT, "%s%s%s%s%s", exact ? "" : ORACLE_UNKNOWN, exact ? "" : "; ", *partial ? partial : side,
           *partial || *side ? "; " : "", rows);
  if (!exact)
    say_size(e, text);
}

/* --- sweeps ------------------------------------------------------------------------------------------------------- */

/* Of a hit, the first row that differs counts: what follows is consequence. */
static void say_first_hit(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  bool wrong = false;
  for (uint32_t row = 0; row < oracle_common_rows(p) && !wrong; row++)
    for (uint32_t k = 0; k < p->ours->columns; k++) {
      if (oracle_agrees(p, row, k))
        continue;
      const size_t used = wrong ? strlen(text) : 0;
      if (wrong)
        snprintf(text + used, ORACLE_TEXT - used, ", %s", p->ours->component[k]);
      else
        snprintf(text, ORACLE_TEXT, "%s; the first row that differs, %u, is wrong in %s", ORACLE_UNKNOWN, row,
                 p->ours->component[k]);
      wrong = true;
    }
}

/* All vertices end where they should. */
static bool moves_are_right(const struct oracle_pair *p)
{
  static const char *const names[] = {"out.position", "out.velocity"};
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    const struct oracle_pair pair = {
        p->pack, p->pack_theirs, oracle_sibling(p, names[k]), oracle_sibling_of_theirs(p, names[k]), p->rounding, NULL};
    if (!pair.ours || !pair.theirs || pair.ours->columns != pair.theirs->columns || !table_is_right(&pair))
      return false;
  }
  return true;
}

/* True if nothing else need be tried. */
static bool diagnose_sweep(const struct oracle_pair *p, bool beyond, char text[ORACLE_TEXT])
{
  const bool rows_follow = strcmp(p->ours->name, "out.event") == 0 || strcmp(p->ours->name, "out.hit") == 0;
  if (oracle_replay(p, text))
    return true;
  if (!beyond || !rows_follow)
    return false;
  if (moves_are_right(p)) /* then rows can be compared, if there are as many */
    return p->ours->rows != p->theirs->rows && oracle_judge_reports(p, text);
  say_first_hit(p, text);
  const bool events = strcmp(p->ours->name, "out.event") == 0;
  return (events && oracle_judge_moves(p, text)) || search_patterns(oracle_patterns_sweep, p, text) || true;
}

#define AS_ROUNDING                                                                                                    \
  "no larger than rounding: another order of operations, fused multiply-add, library functions, or a bug whose "       \
  "effect is as small"

/* Nothing but last bits: what a bug does here is nothing else than what rounding does, and they cannot be told apart.
 */
static bool is_rounding(const struct evidence *e)
{
  for (size_t k = 0; k < (size_t)e->rows * e->columns; k++)
    if (!(fabs(e->theirs[k] - e->ours[k]) <= 0x1p-30 * fabs(e->ours[k])))
      return false;
  return e->part[0].pair.ours->real;
}

void oracle_diagnose(const struct oracle_pair *p, bool beyond, char text[ORACLE_TEXT])
{
  struct evidence e = {0};
  struct search s = {.e = &e, .text = text};
  snprintf(text, ORACLE_TEXT, "%s", beyond ? ORACLE_UNKNOWN : AS_ROUNDING);
  if (p->ours->columns != p->theirs->columns || (is_for("sweep", NULL, p) && diagnose_sweep(p, beyond, text)) ||
      (is_for("event_drift", NULL, p) && oracle_replay_events(p, text)))
    return;
  if (evidence_take(p, &e)) {
    char side[RELATION_TEXT];
    const bool may_have_name = beyond || !is_rounding(&e);
    if ((may_have_name && search_all_relations(&s)) || search_patterns(oracle_patterns_random, p, text) ||
        search_patterns(oracle_patterns_flow, p, text) || search_patterns(oracle_patterns_any, p, text))
      say_which_table(p, text);
    else if (beyond)
      describe(&e, s.partial, text);
    else if (oracle_one_sided(&e, side))
      snprintf(text, ORACLE_TEXT, "%s", side);
  }
  evidence_free(&e);
}
