/* Whole ports: a program that reads packs and starts, and writes outputs and traces (docs/port/README.md, One command).
 */
#ifndef UNCROSS_ORACLE_CHECK_H
#define UNCROSS_ORACLE_CHECK_H

#include "oracle/oracle.h"

/* True if the file is a trace (CSV with its columns). */
bool oracle_is_trace(const char *path);

/* Prints the first step and stage at which two traces differ, and which sums differ there. False, with a message, if
 * one is not a trace, or has a column that ours has not. */
bool oracle_compare_traces(const char *ours, const char *theirs, FILE *out, struct oracle_summary *summary,
                           struct message *message);

struct check_options {
  const char *port;   /* the program */
  const char *folder; /* of packs NAME.pack.h5, traces NAME.trace.csv with NAME.yaml; NULL: of this program */
  const char *report; /* JSON; NULL: none. The file must not exist. */
  bool text;          /* packs and starts are given as text */
  bool no_traces;
  uint64_t seconds; /* for each call of the port */
  uint64_t repeat;  /* calls with the same input, which must give the same bits */
  struct oracle_options compare;
};

/* Runs the port over all packs and traces, prints one table and what differs, writes the report. False, with a message,
 * if there is nothing to check, the port is no program, or a file cannot be written. */
bool oracle_check(const struct check_options *options, FILE *out, enum oracle_verdict *verdict,
                  struct message *message);

#endif
