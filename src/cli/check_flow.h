/* What `uncross check` says of a sheared box, and of a flow that a force with a profile drives. */
#ifndef UNCROSS_CLI_CHECK_FLOW_H
#define UNCROSS_CLI_CHECK_FLOW_H

#include "cli/sheet.h"
#include "system/model.h"
#include "theory/flow.h"

/* Prints the numbers of the shear. The model must be sheared. */
void check_shear(bool exact, const struct model *model);

/* Prints the numbers of the flow. The model's force must have a profile. */
void check_drive(bool exact, const struct model *model);

/* Prints what the shear of the solvent does to fibers of a kind, by their length and by their persistence length;
 * nothing without shear. */
void check_kind_in_shear(bool exact, const struct model *model, const struct theory_shear *shear,
                         const struct fiber_kind *kind);

#endif
