/* The units of all columns. A unit is the same in every table that has a column of this name. */
#ifndef UNCROSS_OBSERVE_UNITS_H
#define UNCROSS_OBSERVE_UNITS_H

#include "observe/observe.h"

/* "kT/a0^3"; "1" for a pure number. An error has the unit of its column. NULL: there is no such column. */
const char *observe_unit(const char *column);

/* Tells column and unit of what the plan asks for and the model has, without the columns of errors. */
void observe_units(const struct observe_plan *plan, const struct model *model,
                   void (*tell)(void *context, const char *column, const char *unit), void *context);

#endif
