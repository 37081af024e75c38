/* What `uncross check` says of a flow between walls. */
#ifndef UNCROSS_CLI_CHECK_WALLS_H
#define UNCROSS_CLI_CHECK_WALLS_H

#include "cli/sheet.h"
#include "system/model.h"

/* Prints the numbers of the flow. The model must have walls. */
void check_walls(bool exact, const struct model *model);

#endif
