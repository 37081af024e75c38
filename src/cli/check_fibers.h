/* What `uncross check` says of fibers: of each kind, and of all together. */
#ifndef UNCROSS_CLI_CHECK_FIBERS_H
#define UNCROSS_CLI_CHECK_FIBERS_H

#include "cli/sheet.h"
#include "system/model.h"

/* Prints the numbers of each kind, and those of the suspension if there is a vertex. */
void check_fibers(bool exact, const struct model *model);

#endif
