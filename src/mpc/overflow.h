/*
 * The ranges of a cell's sums, and which member is too fast or too heavy if one is exceeded. cell_add lets sums wrap
 * without a test, for speed. The functions here test afterwards: members times the largest addend bounds every sum.
 */
#ifndef UNCROSS_MPC_OVERFLOW_H
#define UNCROSS_MPC_OVERFLOW_H

#include "mpc/mpc.h"

/* False if no sum can have wrapped, by two bounds. span: as below; loads: as solve of struct kernel returns it. */
bool overflow_may_be(const struct model *model, uint64_t span, uint64_t loads);

/* Tests momenta and masses in mpc->sum. span: the bitwise or of all that cell_add returned. False, with the fault
 * recorded, if a sum may have wrapped. */
bool overflow_of_momenta(const struct state *state, const struct model *model, const struct mpc *mpc, uint64_t span,
                         uint64_t step, struct fault *fault);

/* False if no energy of a cell can have exceeded its range, by two bounds. span: the bitwise or of all energies of
 * members; loads: as above. */
bool overflow_of_energies_may_be(uint64_t span, uint64_t loads);

/* Tests energies in mpc->relative. span: the bitwise or of all that was added. False, with the fault recorded, if a sum
 * may have wrapped. */
bool overflow_of_energies(const struct state *state, const struct model *model, const struct mpc *mpc, uint64_t span,
                          uint64_t step, struct fault *fault);

#endif
