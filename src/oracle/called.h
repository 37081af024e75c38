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

/* Runs the port once on a pack, or on a start, and waits for it, at most options->seconds. What is left of its group of
 * processes is then killed, so that nobody writes into a later output. An interrupt (SIGINT, SIGTERM, SIGHUP) kills
 * them too, removes the folder of `in` and `out`, and ends this program. What the port prints goes to standard error.
 * False, with a message, if it fails or writes nothing. */
bool called_port(const struct check_options *options, bool trace, const char *folder, const char *in, const char *out,
                 struct message *message);

/* Removes a folder of such files with all that is in it. */
void called_clean(const char *folder);

#endif
