/* What `uncross check` says of a bath other than that of collision cells. */
#ifndef UNCROSS_CLI_CHECK_MEDIUM_H
#define UNCROSS_CLI_CHECK_MEDIUM_H

#include "cli/sheet.h"
#include "system/model.h"

/* Prints the numbers of the bath. The model must have one. */
void check_medium(bool exact, const struct model *model);

/* The same of a vertex of this kind in it. */
void check_medium_vertex(bool exact, const struct model *model, const struct fiber_kind *kind);

/* Times for the length l, a0, of a vertex with this diffusion coefficient, in any solvent: of sound, of momentum, of
 * diffusion. A fluid that is hardly compressible, and whose flow follows the vertices at once, has t_s << t_H << t_D.
 */
void check_times(bool exact, const struct model *model, double l, double diffusion);

/* Time per particle and step, ns, measured on one core of an x86-64 of the 2020s: for a guess within a factor of 2. */
double check_medium_cost(const struct model *model);

/* The same per vertex and step of overdamped motion: the mean over all fibers, each with its own tensor, whose root
 * takes a time that grows as the cube of its vertices. 0 in other baths. */
double check_medium_vertex_cost(const struct model *model);

#endif
