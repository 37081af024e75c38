/* What `uncross check` says of a scene that takes far longer than another choice (docs/claims/settings.md). */
#ifndef UNCROSS_CLI_CHECK_CHOICE_H
#define UNCROSS_CLI_CHECK_CHOICE_H

#include "system/model.h"

/* Prints at most one sentence. cost: seconds of a step, an estimate. */
void check_choice(const struct model *model, double (*cost)(const struct model *model));

#endif
