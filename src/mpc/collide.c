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

const struct kernel kernel_plain = {.name = "plain", .collide = collide_plain};

bool mpc_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, struct fault *fault)
{
  return mpc->kernel.collide(state, model, mpc, step, fault);
}

/* --- sums of cells ------------------------------------------------------------------------------------------------ */

void collide_clear(struct mpc *c)
{
  memset(c->sum, 0, (size_t)c->cells * sizeof *c->sum);
  if (c->rule->spinning && !c->spin_is_clear)
    memset(c->spin, 0, (size_t)c->cells * sizeof *c->spin);
  c->sum_is_clear = c->spin_is_clear = c->spin_in_halves = false; /* what follows adds to them */
}

static uint32_t block_size(uint32_t n, uint32_t first)
{
  return n - first < COLLIDE_BLOCK ? n - first : COLLIDE_BLOCK;
}

uint64_t collide_bin_and_add(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                             uint32_t first, uint32_t n)
{
  if (mpc->border->enter)
    mpc->border->enter(state, model, first, n, mpc);
  mpc->border->bin_particles(state, model, first, n, mpc);
  return mpc->rule->add_particles(state, model, mpc, step, first, n);
}

/* Flight, cells and sums of the solvent, block by block. *span: at least the largest momentum component (cell_add). */
static bool gather(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, uint64_t *span,
                   struct fault *fault)
{
  mpc->shift = grid_shift(model, step);
  mpc->entered = 0;
  *span = 0;
  collide_clear(mpc);
  for (uint32_t i = 0; i < state->solvent.n; i += COLLIDE_BLOCK) {
    const uint32_t n = block_size(state->solvent.n, i);
    if (state->solvent_lag != 0 && !mpc->fluid->stream(state, model, i, n, fault))
      return false;
    *span |= collide_bin_and_add(state, model, mpc, step, i, n);
  }
  return true;
}

bool collide_add_vertices(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                          uint64_t *span, struct fault *fault)
{
  const struct border *border = mpc->border;
  const struct obstacle *o = mpc->obstacle;
  if (o && !o->rebound(o->room, state, model, mpc, step, span, fault))
    return false;
  state_streamed(state);
  if (border->enter_vertices)
    border->enter_vertices(state, model, mpc);
  border->bin_vertices(state, model, mpc);
  *span |= mpc->rule->add_vertices(state, model, mpc, step);
  return true;
}

bool collide_sum(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                 struct fault *fault)
{
  const uint32_t n = state->solvent.n;
  uint64_t span = 0;
  collide_clear(mpc);
  for (uint32_t i = 0; i < n; i += COLLIDE_BLOCK)
    span |= mpc->rule->add_particles(state, model, mpc, step, i, block_size(n, i));
  span |= mpc->rule->add_vertices(state, model, mpc, step);
  return overflow_of_momenta(state, model, mpc, span, step, fault);
}

bool collide_fill(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, uint64_t span,
                  struct fault *fault)
{
  const struct border *border = mpc->border;
  const struct obstacle *o = mpc->obstacle;
  if (!overflow_of_momenta(state, model, mpc, span, step, fault) ||
      (border->fill && !border->fill(state, model, mpc, step, fault)) ||
      (o && !o->fill(o->room, state, model, mpc, step, fault)))
    return false;
  if (mpc->stress)
    stress_before(state, model, mpc);
  return true;
}

/* --- turns of cells ----------------------------------------------------------------------------------------------- */

void collide_solve(const struct model *model, struct mpc *mpc, uint64_t step)
{
  mpc->rule->solve(model, mpc, step);
}

/* Unsigned: the sum of a cell may wrap; overflow_of_energies finds out afterwards. */
static uint64_t add_energy(struct mpc *c, uint32_t cell, double mass, struct vec3 v)
{
  const uint64_t energy = cell_whole_energy(&c->turn[cell], mass, v);
  c->relative[cell] = (int64_t)((uint64_t)c->relative[cell] + energy);
  return energy;
}

/* Energies are summed in integers like the momenta. Momenta have been found in range before, so every energy is a
 * number. */
bool collide_thermostat(const struct state *state, const struct model *model, struct mpc *mpc,
                        const struct thermostat *thermostat, uint64_t step, struct fault *fault)
{
  uint64_t span = 0;
  memset(mpc->relative, 0, (size_t)mpc->cells * sizeof *mpc->relative);
  for (uint32_t i = 0; i < state->solvent.n; i++)
    span |= add_energy(mpc, mpc->solvent_cell[i], 1.0, solvent_velocity(&state->solvent, i));
  for (uint32_t v = 0; v < state->vertices; v++)
    span |= add_energy(mpc, mpc->vertex_cell[v], model->mass[v], state->velocity[v]);
  if (!overflow_of_energies(state, model, mpc, span, step, fault))
    return false;
  thermostat->factors(mpc, model, step);
  return true;
}

/* --- new velocities ----------------------------------------------------------------------------------------------- */

void collide_turn(struct state *state, const struct model *model, const struct mpc *mpc, bool scaled)
{
  mpc->rule->apply(state, model, mpc, scaled);
}

/* Particles are sorted by cell again after so many collisions. At the paper's mean free path of 0.02 a0, most
 * neighbors in memory are still neighbors in space after them. Where the cells do not fit the caches, disorder costs
 * more than sorting. */
static uint32_t collisions_per_sort(const struct mpc *mpc)
{
  return mpc->prefetch ? 50 : 100;
}

void collide_leave(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step)
{
  const struct border *border = mpc->border;
  if (mpc->stress)
    stress_after(state, model, mpc);
  if (border->account)
    border->account(state, model, mpc, step);
  if (mpc->obstacle)
    mpc->obstacle->account(mpc->obstacle->room, state, model, mpc, step);
  if (border->leave)
    border->leave(state, model, mpc);
  if (!model->solvent.hydrodynamics)
    mpc_swap_velocities(state, model, mpc, step);
  if (mpc->since_sort++ % collisions_per_sort(mpc) == 0)
    mpc_sort(state, model, mpc);
}

/* --- the whole ---------------------------------------------------------------------------------------------------- */

bool collide_plain(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, struct fault *fault)
{
  uint64_t span;
  if (!gather(state, model, mpc, step, &span, fault) || !collide_add_vertices(state, model, mpc, step, &span, fault) ||
      !collide_fill(state, model, mpc, step, span, fault))
    return false;
  collide_solve(model, mpc, step);
  if (mpc->thermostat && !collide_thermostat(state, model, mpc, mpc->thermostat, step, fault))
    return false;
  collide_turn(state, model, mpc, mpc->thermostat);
  collide_leave(state, model, mpc, step);
  return true;
}
