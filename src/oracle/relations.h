/*
 * Inside the oracle: what their values are to ours. A relation is a guess of a bug: what would come out with it. Some
 * are of any operator (the negative, another row's numbers, twice the change), most compute one operator anew with one
 * thing changed.
 */
#ifndef UNCROSS_ORACLE_RELATIONS_H
#define UNCROSS_ORACLE_RELATIONS_H

#include "oracle/evidence.h"

#define RELATION_TEXT 160

/* Number k of a kind of relations: fills e->guess, and the text. False if there is no such number. A guess that cannot
 * be made is NaN. */
typedef bool relation_maker(struct evidence *e, uint32_t k, char text[RELATION_TEXT]);

struct relation {
  const char *operator_name, *table; /* NULL: any */
  relation_maker *make;
  bool together; /* of all tables of the operator: the guess must make each of them */
};

/* Each list ends with one that makes none. From the most to the least telling. Those of any operator say what the
 * values are, and no cause. */
extern const struct relation oracle_relations_random[], oracle_relations_permutation[], oracle_relations_contact[],
    oracle_relations_fiber[], oracle_relations_event[], oracle_relations_tube[], oracle_relations_grid[],
    oracle_relations_sum[], oracle_relations_rotate[], oracle_relations_andersen[], oracle_relations_spin[],
    oracle_relations_walls[], oracle_relations_shear[], oracle_relations_dumbbell[], oracle_relations_thermostat[],
    oracle_relations_medium[], oracle_relations_pairs[], oracle_relations_any[];

/* Writes the text; true, for makers to return. */
bool relation_say(char text[RELATION_TEXT], const char *format, ...);

/* Guesses all values one by one: f(part, its row, column, twist). */
typedef double relation_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist);
void relation_fill(struct evidence *e, relation_value *f, const void *twist);

/* Guesses all values part by part: false if the pack has not what it takes. */
typedef bool relation_table(const struct evidence_part *part, const void *twist, double *guess);
void relation_fill_tables(struct evidence *e, relation_table *f, const void *twist);

/* True, and the text, if errors have one side, in all of at least 8 values: toward zero, away from it, below, above. */
bool oracle_one_sided(const struct evidence *e, char text[RELATION_TEXT]);

#endif
