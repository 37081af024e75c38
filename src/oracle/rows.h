/*
 * Inside the oracle: which rows are wrong. A rule is a fact about rows, or two or three of them joined, and is told
 * only if it is exact: true of every wrong row and of no right one. The simplest rule wins. A rule that would fit by
 * chance is not told. A rule of b bits is one of 2^b of its weight, all weights together are 1; so the odds that any
 * rule at all fits w wrong rows of n that are drawn at random are below 2^-10 if b + 10 <= log2 of n over w.
 */
#ifndef UNCROSS_ORACLE_ROWS_H
#define UNCROSS_ORACLE_ROWS_H

#include "oracle/evidence.h"

#define ROWS_TEXT 400

/* True, and the rule with the number of rows, or the few rows themselves, in text: exactly what is wrong. False, and
 * the first rows' numbers, if they are many and no rule is known, or if all of the table is wrong. */
bool oracle_describe_rows(const struct evidence *e, char text[ROWS_TEXT]);

#endif
