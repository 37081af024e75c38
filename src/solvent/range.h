/*
 * The ranges of a cell's sums, and who is to blame if one is exceeded. Sums wrap silently (srd_add), so that adding
 * asks nothing: members times the largest addend, seen while adding, bounds every sum.
 */
#ifndef UNCROSS_RANGE_H
#define UNCROSS_RANGE_H

#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* Momenta and masses in sum, from the span of all momenta as srd_add returns it. False, with the fault recorded, if a
 * sum may have wrapped. */
bool range_of_momenta(const struct state *state, const struct model *model, struct work *work, uint64_t span,
                      uint64_t step);

/* Energies in relative, from the largest of all members'. False, with the fault recorded, if a sum may have wrapped. */
bool range_of_energies(const struct state *state, const struct model *model, struct work *work, double largest,
                       uint64_t step);

#endif
