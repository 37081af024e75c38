#include "mpc/collide.h"

#include <string.h>

#include "mpc/border.h"
#include "mpc/cell.h"
#include "mpc/grid.h"
#include "mpc/overflow.h"
#include "mpc/rule.h"
#include "mpc/rules/spin.h"
#include "mpc/sort.h"
#include "mpc/stress.h"

/* Particles are sorted by cell again after so many collisions. At the paper's mean free path of 0.02 a0, most
 * neighbors in memory are still neighbors in space after them. Where the cells do not fit the caches, disorder costs
 * more than sorting. */
static uint32_t collisions_per_sort(const struct mpc *mpc)
{
  return mpc->prefetch ? 50 : 100;
}

/* Particles per block. A block goes through several operations while it is in the cache. Smaller blocks would keep the
 * processor from reading ahead. */
#define BLOCK 16384

static uint32_t block_size(uint32_t n, uint32_t first, uint32_t most)
{
  return n - first < most ? n - first : most;
}

static void clear_sums(struct mpc *c)
{
  if (!c->sum_is_clear)
    memset(c->sum, 0, (size_t)c->cells * sizeof *c->sum);
  c->sum_is_clear = false;
  if (c->rule->spinning && !c->spin_is_clear)
    memset(c->spin, 0, (size_t)c->cells * sizeof *c->spin);
  c->spin_is_clear = false;
}

static uint64_t member_energy(const struct cell_turn *turn, double mass, struct vec3 v)
{
  return (uint64_t)llrint(CELL_ENERGY_SCALE * cell_energy(turn, mass, v));
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
    const uint64_t energy = member_energy(&c->turn[cell[i]], 1.0, solvent_velocity(&state->solvent, i));
    add_energy(total, &c->relative[cell[i]], energy);
    span |= energy;
  }
  return span;
}

/* The energies of all members: to mpc->relative of their cells, or to *total, as energies of struct kernel. */
static uint64_t add_energies(const struct state *state, const struct model *model, struct mpc *c, energy_sum *total)
{
  uint64_t span = c->kernel.energies(state, c, 0, state->solvent.n, total);
  for (uint32_t v = 0; v < state->vertices; v++) {
    const uint32_t cell = c->vertex_cell[v];
    const uint64_t energy = member_energy(&c->turn[cell], model->mass[v], state->velocity[v]);
    add_energy(total, &c->relative[cell], energy);
    span |= energy;
  }
  return span;
}

/* Sums the energies of all members cell by cell, in integers like the momenta. Momenta have been found in range before,
 * so every energy is a number. */
static bool sum_relative_energy(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                                struct fault *fault)
{
  memset(c->relative, 0, (size_t)c->cells * sizeof *c->relative);
  return overflow_of_energies(state, model, c, add_energies(state, model, c, NULL), step, fault);
}

bool collide_sum(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                 struct fault *fault)
{
  const uint32_t n = state->solvent.n;
  uint64_t span = 0;
  clear_sums(mpc);
  for (uint32_t i = 0; i < n; i += BLOCK)
    span |= mpc->rule->add_particles(state, model, mpc, step, i, block_size(n, i, BLOCK));
  span |= mpc->rule->add_vertices(state, model, mpc, step);
  return overflow_of_momenta(state, model, mpc, span, step, fault);
}

/* Cells of n particles, and their sums. */
static uint64_t bin_and_add(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            uint32_t first, uint32_t n)
{
  if (mpc->border->enter)
    mpc->border->enter(state, model, first, n, mpc);
  mpc->border->bin_particles(state, model, first, n, mpc);
  return mpc->rule->add_particles(state, model, mpc, step, first, n);
}

static bool plain_gather(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, uint32_t first,
                         uint32_t n, uint64_t *span, struct fault *fault)
{
  if (!mpc->fluid->stream(state, model, first, n, fault))
    return false;
  *span |= bin_and_add(state, model, mpc, step, first, n);
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

static void plain_turn(struct state *state, const struct model *model, const struct mpc *mpc, bool scaled)
{
  mpc->rule->apply(state, model, mpc, scaled);
}

static void plain_canonical(const struct model *model, struct mpc *mpc, uint64_t step, bool last)
{
  (void)last;
  thermostat_canonical(model, mpc, step, 0);
}

const struct kernel kernel_plain = {.name = "plain",
                                    .gather = plain_gather,
                                    .solve = plain_solve,
                                    .energies = plain_energies,
                                    .canonical = plain_canonical,
                                    .turn = plain_turn};

/* Flight of the fluid, grid_bin and collide_sum without its test: the three in one pass, block by block. *span: the
 * bitwise or of all that add_particles and add_vertices returned. */
static bool gather(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, uint64_t *span,
                   struct fault *fault)
{
  const struct border *border = mpc->border;
  *span = 0;
  mpc->shift = grid_shift(model, step);
  mpc->entered = 0;
  clear_sums(mpc);
  for (uint32_t i = 0; i < state->solvent.n; i += BLOCK) {
    const uint32_t n = block_size(state->solvent.n, i, BLOCK);
    if (state->solvent_lag == 0)
      *span |= bin_and_add(state, model, mpc, step, i, n);
    else if (!mpc->kernel.gather(state, model, mpc, step, i, n, span, fault))
      return false;
  }
  if (border->rebound && !border->rebound(state, model, mpc, step, span, fault))
    return false;
  state_streamed(state);
  if (border->enter_vertices)
    border->enter_vertices(state, model, mpc);
  border->bin_vertices(state, model, mpc);
  *span |= mpc->rule->add_vertices(state, model, mpc, step);
  return true;
}

/* Whether something but a thermostat reads the sums of cells after, or before, they are solved. */
static bool sums_are_read(const struct mpc *mpc)
{
  return mpc->keeps_sums || mpc->border->fill || mpc->border->account || mpc->stress;
}

/* Turns of cells of which nobody reads the sums. So the sums are read once, and in the same pass they may be cleared
 * for the next collision. Their range is tested afterwards, by bounds, with sums made anew if the bounds allow a doubt.
 */
static bool solve_only(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                       uint64_t span, struct fault *fault)
{
  const struct solved all = mpc->kernel.solve(model, mpc, step, true);
  return !overflow_may_be(model, span, all.loads) || collide_sum(state, model, mpc, step, fault);
}

/* Factors of cells, by their energies. last: nobody reads the sums after this. */
static bool set_factors(const struct state *state, const struct model *model, struct mpc *mpc,
                        const struct thermostat *thermostat, uint64_t step, bool last, struct fault *fault)
{
  if (!sum_relative_energy(state, model, mpc, step, fault))
    return false;
  thermostat->factors(mpc, model, step, last);
  return true;
}

/* The same with a thermostat. One that has one factor for all cells needs what all of them have together, and no sums.
 * Another one reads the sums, and may clear them itself. If the bound of the energies allows a doubt, the sums are made
 * anew, and the energies of each cell are tested. */
static bool solve_and_scale(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            uint64_t span, struct fault *fault)
{
  const bool common = mpc->thermostat->common;
  const struct solved all = mpc->kernel.solve(model, mpc, step, common);
  if (overflow_may_be(model, span, all.loads) && !collide_sum(state, model, mpc, step, fault))
    return false;
  if (!common)
    return set_factors(state, model, mpc, mpc->thermostat, step, true, fault);
  energy_sum energy = 0;
  if (overflow_of_energies_may_be(add_energies(state, model, mpc, &energy), all.loads))
    return collide_sum(state, model, mpc, step, fault) &&
           set_factors(state, model, mpc, mpc->thermostat, step, true, fault);
  thermostat_set_factor(mpc, model->dimensions * (double)all.others, energy);
  return true;
}

/* The same where sums are read. */
static bool solve_and_share(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            uint64_t span, struct fault *fault)
{
  const struct border *border = mpc->border;
  if (!overflow_of_momenta(state, model, mpc, span, step, fault) ||
      (border->fill && !border->fill(state, model, mpc, step, fault)))
    return false;
  if (mpc->stress)
    stress_before(state, model, mpc);
  collide_solve(model, mpc, step);
  return !mpc->thermostat || collide_thermostat(state, model, mpc, mpc->thermostat, step, fault);
}

void collide_solve(const struct model *model, struct mpc *mpc, uint64_t step)
{
  mpc->kernel.solve(model, mpc, step, false);
}

bool collide_thermostat(const struct state *state, const struct model *model, struct mpc *mpc,
                        const struct thermostat *thermostat, uint64_t step, struct fault *fault)
{
  return set_factors(state, model, mpc, thermostat, step, false, fault);
}

void collide_turn(struct state *state, const struct model *model, const struct mpc *mpc, bool scaled)
{
  mpc->kernel.turn(state, model, mpc, scaled);
}

typedef bool solving(const struct state *, const struct model *, struct mpc *, uint64_t, uint64_t, struct fault *);

/* How the turns of cells are found: the shortest way that who reads sums of cells allows. */
static solving *way_of(const struct mpc *mpc)
{
  return sums_are_read(mpc) ? solve_and_share : mpc->thermostat ? solve_and_scale : solve_only;
}

bool mpc_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, struct fault *fault)
{
  const struct border *border = mpc->border;
  uint64_t span;
  if (!gather(state, model, mpc, step, &span, fault) || !way_of(mpc)(state, model, mpc, step, span, fault))
    return false;
  collide_turn(state, model, mpc, mpc->thermostat);
  if (mpc->stress)
    stress_after(state, model, mpc);
  if (border->account)
    border->account(state, model, mpc, step);
  if (border->leave)
    border->leave(state, model, mpc);
  if (!model->solvent.hydrodynamics)
    mpc_swap_velocities(state, model, mpc, step);
  if (mpc->since_sort++ % collisions_per_sort(mpc) == 0)
    mpc_sort(state, model, mpc);
  return true;
}
