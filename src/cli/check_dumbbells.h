/* What `uncross check` says of a fluid of dumbbells. */
#ifndef UNCROSS_CLI_CHECK_DUMBBELLS_H
#define UNCROSS_CLI_CHECK_DUMBBELLS_H

#include "cli/sheet.h"
#include "system/model.h"

/* Prints the numbers of dumbbells. The model must have some. */
void check_dumbbells(bool exact, const struct model *model);

#endif
