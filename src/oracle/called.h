/* Calls of a port: a program that is not trusted to end, nor to end what it has started. */
#ifndef UNCROSS_ORACLE_CALLED_H
#define UNCROSS_ORACLE_CALLED_H

#include "oracle/check.h"

/* Puts `in.step` to each operator that takes nothing but the step's number: without a table nothing would ask for it.
 */
void called_ask(struct pack *pack);

/* Writes the pack as the port is to read it, to a new file: without answers, nor bounds of them. */
bool called_give(const struct check_options *options, const struct pack *pack, const char *path,
                 struct message *message);

/* One call of another program. */
struct call {
  const char *who;          /* it is called so in messages */
  const char *const *words; /* of its command; ends with NULL */
  const char *output;       /* a file that takes what it prints; NULL: standard error does */
  const char *folder;       /* is removed, with all that is in it, if this program is interrupted */
  uint64_t seconds;         /* at most */
};

enum { CALLED_NO_PROGRAM = 127 };

/* Runs it to its end, and kills what is left of its group of processes. An interrupt (SIGINT, SIGTERM, SIGHUP) kills
 * them too, and ends this program. status: its exit code, or 128 and the signal that ended it. False, with a message,
 * if it cannot be run or takes too long. */
bool called_run(const struct call *call, int *status, struct message *message);

/* Runs the port once on a pack, or on a start (called_run), for options->seconds at most; nobody writes into a later
 * output then. folder: of `in` and `out`. What the port prints goes to standard error. False, with a message, if it
 * fails or writes nothing. */
bool called_port(const struct check_options *options, bool trace, const char *folder, const char *in, const char *out,
                 struct message *message);

/* Removes a folder of such files with all that is in it. */
void called_clean(const char *folder);

#endif
