/* What `uncross check` says of a bead. */
#ifndef UNCROSS_CLI_CHECK_BEAD_H
#define UNCROSS_CLI_CHECK_BEAD_H

#include "cli/sheet.h"
#include "system/model.h"

/* Prints the numbers of a bead. The model must have one. */
void check_bead(bool exact, const struct model *model);

#endif
