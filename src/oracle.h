/* `uncross oracle`: packs and traces for other implementations. */
#ifndef UNCROSS_ORACLE_H
#define UNCROSS_ORACLE_H

#include "run.h"

/* The words behind `uncross oracle`: a subcommand, files, options. */
enum exit_code oracle_command(int count, char **arguments);

#endif
