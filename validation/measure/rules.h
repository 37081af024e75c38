/* Crossing rules and schemes as words of a program's arguments. */
#ifndef UNCROSS_MEASURE_RULES_H
#define UNCROSS_MEASURE_RULES_H

#include "contact/rule.h"
#include "measure.h"

/* The row of this name, or the end of the program. */
static inline enum crossing_kind rule_of_word(const char *word)
{
  for (int k = 0; k < CROSSINGS; k++)
    if (strcmp(crossing_rule_row((enum crossing_kind)k)->name, word) == 0)
      return (enum crossing_kind)k;
  fprintf(stderr, "%s: no such crossing rule\n", word);
  exit(2);
}

static const char *const scheme_words[SCHEMES] = {
    [SCHEME_PAPER] = "paper", [SCHEME_KICK_SPLIT] = "kick-split", [SCHEME_DRIFT_SPLIT] = "drift-split"};

static inline enum scheme scheme_of_word(const char *word)
{
  for (int k = 0; k < SCHEMES; k++)
    if (strcmp(scheme_words[k], word) == 0)
      return (enum scheme)k;
  fprintf(stderr, "%s: no such scheme\n", word);
  exit(2);
}

static inline void set_crossing(struct model *m, enum crossing_kind rule)
{
  m->crossing.forbidden = rule != CROSSING_FREE;
  m->crossing.rule = rule;
}

#endif
