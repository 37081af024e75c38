/*
 * The collision of mpc/collide.c once more, in shorter ways: solvent particles fly, get their cells and are summed in
 * one pass; several of them or several cells go through a register at once (solvent.c); and where nobody reads the sums
 * of cells, they are read once, cleared in the same pass, and their ranges are tested by bounds.
 */
#include "kernel/collide.h"

#include <string.h>

#include "mpc/border.h"
#include "mpc/cell.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/overflow.h"
#include "mpc/rule.h"
#include "mpc/rules/spin.h"

/* --- ways that suit every scene ----------------------------------------------------------------------------------- */

static bool plain_gather(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, uint32_t first,
                         uint32_t n, uint64_t *span, struct fault *fault)
{
  if (!mpc->fluid->stream(state, model, first, n, fault))
    return false;
  *span |= collide_bin_and_add(state, model, mpc, step, first, n);
  return true;
}

static struct solved plain_solve(const struct model *model, struct mpc *mpc, uint64_t step, bool last)
{
  struct solved all = {0};
  (void)last;
  mpc->rule->solve(model, mpc, step);
  for (uint32_t k = 0; k < mpc->cells; k++)
    cell_count(&mpc->sum[k], &all);
  return all;
}

/* Unsigned: the sum of a cell may wrap; overflow_of_energies finds out afterwards. */
static void add_energy(energy_sum *total, int64_t *cell, uint64_t energy)
{
  if (total)
    *total += energy;
  else
    *cell = (int64_t)((uint64_t)*cell + energy);
}

static uint64_t plain_energies(const struct state *state, struct mpc *c, uint32_t first, uint32_t n, energy_sum *total)
{
  const uint32_t *cell = c->solvent_cell;
  uint64_t span = 0;
  for (uint32_t i = first; i < first + n; i++) {
    const uint64_t energy = cell_whole_energy(&c->turn[cell[i]], 1.0, solvent_velocity(&state->solvent, i));
    add_energy(total, &c->relative[cell[i]], energy);
    span |= energy;
  }
  return span;
}

static void plain_canonical(const struct model *model, struct mpc *mpc, uint64_t step, bool last)
{
  (void)last;
  thermostat_canonical(model, mpc, step, 0);
}

static void plain_turn(struct state *state, const struct model *model, const struct mpc *mpc, bool scaled)
{
  mpc->rule->apply(state, model, mpc, scaled);
}

/* --- sums of cells ------------------------------------------------------------------------------------------------ */

/* Whether a cell has as many members as sums in halves cannot take: a power of two, so one bit of all loads says it. */
static bool cells_are_crowded(const struct mpc *mpc)
{
  uint64_t loads = 0;
  for (uint32_t k = 0; k < mpc->cells; k++)
    loads |= mpc->sum[k].load;
  return loads >= SPIN_HALVES_MOST * CELL_MEMBER;
}

/* All particles are in the sums. Sums in halves are made anew if a cell is crowded. They are made whole if others than
 * particles will be added: vertices, virtual members. */
static uint64_t leave_halves(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step)
{
  if (cells_are_crowded(mpc)) {
    collide_clear(mpc);
    return mpc->rule->add_particles(state, model, mpc, step, 0, state->solvent.n);
  }
  mpc->spin_in_halves = state->vertices == 0 && !mpc->border->fill && !mpc->obstacle;
  for (uint32_t k = 0; !mpc->spin_in_halves && k < mpc->cells; k++)
    spin_widen(&mpc->spin[k]);
  return 0;
}

/* gather of collide.c, its passes block by block in one. */
static bool gather(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, uint64_t *span,
                   struct fault *fault)
{
  const uint32_t particles = state->solvent.n;
  *span = 0;
  mpc->shift = grid_shift(model, step);
  mpc->entered = 0;
  if (!mpc->sum_is_clear)
    collide_clear(mpc);
  mpc->sum_is_clear = mpc->spin_is_clear = false;
  mpc->spin_in_halves = mpc->kernel.ways.halves;
  for (uint32_t i = 0; i < particles; i += COLLIDE_BLOCK) {
    const uint32_t n = particles - i < COLLIDE_BLOCK ? particles - i : COLLIDE_BLOCK;
    if (state->solvent_lag == 0)
      *span |= collide_bin_and_add(state, model, mpc, step, i, n);
    else if (!mpc->kernel.ways.gather(state, model, mpc, step, i, n, span, fault))
      return false;
  }
  if (mpc->spin_in_halves)
    *span |= leave_halves(state, model, mpc, step);
  return collide_add_vertices(state, model, mpc, step, span, fault);
}

/* --- energies of cells, factors ----------------------------------------------------------------------------------- */

/* The energies of all members: to mpc->relative of their cells, or to *total, as energies of struct kernel_ways. */
static uint64_t add_energies(const struct state *state, const struct model *model, struct mpc *c, energy_sum *total)
{
  uint64_t span = c->kernel.ways.energies(state, c, 0, state->solvent.n, total);
  for (uint32_t v = 0; v < state->vertices; v++) {
    const uint32_t cell = c->vertex_cell[v];
    const uint64_t energy = cell_whole_energy(&c->turn[cell], model->mass[v], state->velocity[v]);
    add_energy(total, &c->relative[cell], energy);
    span |= energy;
  }
  return span;
}

/* collide_thermostat. last: nobody reads the sums after this. */
static bool set_factors(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, bool last,
                        struct fault *fault)
{
  memset(mpc->relative, 0, (size_t)mpc->cells * sizeof *mpc->relative);
  if (!overflow_of_energies(state, model, mpc, add_energies(state, model, mpc, NULL), step, fault))
    return false;
  if (model->solvent.thermostat == THERMOSTAT_MAXWELL_BOLTZMANN && !mpc->filled)
    mpc->kernel.ways.canonical(model, mpc, step, last);
  else
    mpc->thermostat->factors(mpc, model, step);
  return true;
}

/* --- turns of cells ----------------------------------------------------------------------------------------------- */

/* Whether something but a thermostat reads the sums of cells after, or before, they are solved. */
static bool sums_are_read(const struct mpc *mpc)
{
  return mpc->keeps_sums || mpc->border->fill || mpc->border->account || mpc->obstacle || mpc->stress;
}

/* Turns of cells of which nobody reads the sums. So the sums are read once, and in the same pass they may be cleared
 * for the next collision. Their range is tested afterwards, by bounds, with sums made anew if the bounds allow a doubt.
 */
static bool solve_only(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                       uint64_t span, struct fault *fault)
{
  const struct solved all = mpc->kernel.ways.solve(model, mpc, step, true);
  return !overflow_may_be(model, span, all.loads) || collide_sum(state, model, mpc, step, fault);
}

/* The same with a thermostat. One that has one factor for all cells needs what all of them have together, and no sums.
 * Another one reads the sums, and may clear them itself. If the bound of the energies allows a doubt, the sums are made
 * anew, and the energies of each cell are tested. */
static bool solve_and_scale(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            uint64_t span, struct fault *fault)
{
  const bool common = mpc->thermostat->common;
  const struct solved all = mpc->kernel.ways.solve(model, mpc, step, common);
  if (overflow_may_be(model, span, all.loads) && !collide_sum(state, model, mpc, step, fault))
    return false;
  if (!common)
    return set_factors(state, model, mpc, step, true, fault);
  energy_sum energy = 0;
  if (overflow_of_energies_may_be(add_energies(state, model, mpc, &energy), all.loads))
    return collide_sum(state, model, mpc, step, fault) && set_factors(state, model, mpc, step, true, fault);
  thermostat_set_factor(mpc, model->dimensions * (double)all.others, energy);
  return true;
}

/* The same where sums are read: collide_fill, collide_solve and collide_thermostat. */
static bool solve_and_share(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            uint64_t span, struct fault *fault)
{
  if (!collide_fill(state, model, mpc, step, span, fault))
    return false;
  mpc->kernel.ways.solve(model, mpc, step, false);
  return !mpc->thermostat || set_factors(state, model, mpc, step, false, fault);
}

typedef bool solving(const struct state *, const struct model *, struct mpc *, uint64_t, uint64_t, struct fault *);

/* How the turns of cells are found: the shortest way that who reads sums of cells allows. */
static solving *way_of(const struct mpc *mpc)
{
  return sums_are_read(mpc) ? solve_and_share : mpc->thermostat ? solve_and_scale : solve_only;
}

/* --- the whole ---------------------------------------------------------------------------------------------------- */

bool kernel_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, struct fault *fault)
{
  uint64_t span;
  if (!gather(state, model, mpc, step, &span, fault) || !way_of(mpc)(state, model, mpc, step, span, fault))
    return false;
  mpc->kernel.ways.turn(state, model, mpc, mpc->thermostat);
  collide_leave(state, model, mpc, step);
  return true;
}

const struct kernel kernel_short = {.name = "short",
                                    .collide = kernel_collide,
                                    .ways = {.gather = plain_gather,
                                             .solve = plain_solve,
                                             .energies = plain_energies,
                                             .canonical = plain_canonical,
                                             .turn = plain_turn}};
