/*
 * Inside the oracle: which rows are wrong. A rule is a fact about rows, or two or three of them joined, and is told
 * only if it is exact: true of every wrong row and of no right one. The simplest rule wins. A rule that would fit by
 * chance is not told: the choice of the wrong rows among all must be worth more bits than the rule.
 */
#ifndef UNCROSS_ORACLE_ROWS_H
#define UNCROSS_ORACLE_ROWS_H

#include "oracle/evidence.h"

#define ROWS_TEXT 400

/* True, and the rule with the number of rows in text; false, and the rows' numbers, if none is known. */
bool oracle_describe_rows(const struct evidence *e, char text[ROWS_TEXT]);

#endif
