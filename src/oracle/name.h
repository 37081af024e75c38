/* Inside the oracle: what a difference means is said by another program, uncross-name (python/uncross_name). It is
 * given a case: a pack with the model, all that the operators are given and give at all steps, and beside each `out.X`
 *
 *   theirs.X      what the port gives, where it has as many columns
 *   tolerance.X   how much each value may differ (docs/port/tolerances.md), of the rows that both have
 *   first.X       [1][2] the first difference: its row, and whether single precision was asked for; of its table alone
 */
#ifndef UNCROSS_ORACLE_NAME_H
#define UNCROSS_ORACLE_NAME_H

#include "oracle/oracle.h"
#include "oracle/pair.h"

/* The meaning of what differs first, in one line for a terminal; why there is none, if uncross-name cannot say it;
 * empty if nobody is to say it. With options->case_file, the case is written to that file instead. False, with a
 * message, if it cannot be written. */
bool oracle_name(const struct oracle_pair *first, uint32_t row, const struct oracle_options *options,
                 char text[ORACLE_TEXT], struct message *message);

/* The meaning of the first difference of two traces, in one line for a terminal, from what the run starts from
 * (oracle_start) and their trace; empty if nobody is to say it. options->scratch is a folder. */
void oracle_name_trace(const char *start, const char *theirs, const struct oracle_options *options,
                       char text[ORACLE_TEXT]);

#endif
