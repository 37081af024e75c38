#include "oracle/stages.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fiber/force.h"
#include "fiber/mobility.h"
#include "fiber/overdamped.h"
#include "fluid/fluid.h"
#include "medium/near.h"
#include "medium/repulsion.h"
#include "mpc/border.h"
#include "mpc/collide.h"
#include "mpc/drive.h"
#include "mpc/grid.h"
#include "mpc/sort.h"
#include "mpc/thermostat.h"
#include "oracle/rows.h"

/* --- random numbers ---------------------------------------------------------------------------------------------- */

bool oracle_begin_addresses(struct oracle_stage *g)
{
  static const struct oracle_address addresses[] = {
      {RANDOM_GRID_SHIFT, 0, 0, 1},
      {RANDOM_GRID_SHIFT, 0, 0, 2},
      {RANDOM_GRID_SHIFT, 0, 0, 0x100000001},
      {RANDOM_ROTATION_AXIS, 0, 0, 2},
      {RANDOM_ROTATION_AXIS, 0, 1, 2},
      {RANDOM_ROTATION_AXIS, 1, 1, 2},
      {RANDOM_ROTATION_AXIS, 0, 59, 4},
      {RANDOM_ROTATION_AXIS, 0, 0x10005, 2},
      {RANDOM_VERTEX_ORDER, 0, 0, 1},
      {RANDOM_VERTEX_ORDER, 1, 0, 1},
      {RANDOM_VERTEX_ORDER, 0, 7, 1},
      {RANDOM_VELOCITY_SWAP, 0, 0, 2},
      {RANDOM_VELOCITY_SWAP, 0, 3, 2},
      {RANDOM_THERMOSTAT, 0, 5, 2},
      {RANDOM_THERMOSTAT, 1, 5, 2},
      {RANDOM_THERMOSTAT, 2, 5, 2},
      {RANDOM_SOLVENT_POSITION, 0, 11, 0},
      {RANDOM_SOLVENT_POSITION, 1, 11, 0},
      {RANDOM_SOLVENT_VELOCITY, 0, 11, 0},
      {RANDOM_SOLVENT_VELOCITY, 0, 0x3000007, 0},
      {RANDOM_VERTEX_VELOCITY, 0, 3, 0},
      {RANDOM_FIBER_POSITION, 0, 2, 0},
      {RANDOM_FIBER_DIRECTION, 0, 2, 0},
      {RANDOM_BOND_LENGTH, 0, 4, 0},
      {RANDOM_BEND, 0, 4, 0},
      {RANDOM_BEND_AZIMUTH, 0, 4, 0},
  };
  return oracle_add_rows(g, addresses, sizeof addresses / sizeof *addresses, sizeof *addresses);
}

bool oracle_run_order(struct oracle_stage *g)
{
  random_permutation(g->model->seed, RANDOM_VERTEX_ORDER, 0, g->place.step, g->state->vertices, g->work->contact.order);
  return true;
}

/* --- forces of fibers -------------------------------------------------------------------------------------------- */

/* Forces of a model whose kinds keep only some of their constants. */
static bool find_forces(struct oracle_stage *g, bool springs, bool bends, bool body)
{
  struct model part = *g->model;
  part.kind = malloc((part.kinds + 1) * sizeof *part.kind);
  g->pack->failed |= !part.kind;
  if (!part.kind)
    return false;
  for (uint32_t k = 0; k < part.kinds; k++) {
    part.kind[k] = g->model->kind[k];
    part.kind[k].spring *= springs;
    part.kind[k].bending *= bends;
    part.kind[k].force = vec3_scale(body, part.kind[k].force);
  }
  const bool ok = fiber_forces(g->state, &part, g->work->fiber.force, g->place.step, &g->work->fault);
  free(part.kind);
  return ok;
}

bool oracle_run_bond_force(struct oracle_stage *g)
{
  return find_forces(g, true, false, false);
}

bool oracle_run_bend_force(struct oracle_stage *g)
{
  return find_forces(g, false, true, false);
}

bool oracle_run_force(struct oracle_stage *g)
{
  return find_forces(g, true, true, true);
}

bool oracle_run_kick(struct oracle_stage *g)
{
  fiber_kick(g->state, g->model, g->work->fiber.force, 0.5);
  return true;
}

/* --- solvent ----------------------------------------------------------------------------------------------------- */

bool oracle_run_stream(struct oracle_stage *g)
{
  return fluid_stream(g->state, g->model, &g->work->fault);
}

bool oracle_run_bin(struct oracle_stage *g)
{
  grid_bin(g->state, g->model, grid_shift(g->model, g->place.step), &g->work->mpc);
  return true;
}

/* By the rules at-a and at+a velocities are drawn where sums are made. */
bool oracle_run_sum(struct oracle_stage *g)
{
  return collide_sum(g->state, g->model, &g->work->mpc, g->place.step, &g->work->fault);
}

bool oracle_run_solve(struct oracle_stage *g)
{
  collide_solve(g->model, &g->work->mpc, g->place.step);
  return true;
}

/* All thermostats are run on the same input; their factors are not used further on. */
static bool run_thermostat(struct oracle_stage *g, enum thermostat_kind kind)
{
  return collide_thermostat(g->state, g->model, &g->work->mpc, thermostat_of(kind), g->place.step, &g->work->fault);
}

bool oracle_run_rescale(struct oracle_stage *g)
{
  return run_thermostat(g, THERMOSTAT_RESCALE);
}

bool oracle_run_maxwell_boltzmann(struct oracle_stage *g)
{
  return run_thermostat(g, THERMOSTAT_MAXWELL_BOLTZMANN);
}

bool oracle_run_rescale_layers(struct oracle_stage *g)
{
  return run_thermostat(g, THERMOSTAT_RESCALE_LAYERS);
}

/* Factors of its own, so that a port that forgets them is found: 1, 1 + 1/64, ... exact in binary. */
bool oracle_begin_rotate(struct oracle_stage *g)
{
  for (uint32_t k = 0; k < (uint32_t)box_cell_count(&g->model->box); k++)
    g->work->mpc.turn[k].factor = 1.0 + 0x1p-6 * (k % 8);
  return true;
}

bool oracle_run_rotate(struct oracle_stage *g)
{
  collide_turn(g->state, g->model, &g->work->mpc, true); /* without a thermostat, factors have no say */
  return true;
}

bool oracle_run_give(struct oracle_stage *g)
{
  collide_turn(g->state, g->model, &g->work->mpc, false);
  return true;
}

bool oracle_run_swap(struct oracle_stage *g)
{
  mpc_swap_velocities(g->state, g->model, &g->work->mpc, g->place.step);
  return true;
}

/* --- walls, shear, dumbbells ------------------------------------------------------------------------------------- */

bool oracle_run_fill(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  return c->border->fill(g->state, g->model, c, g->place.step, &g->work->fault);
}

/* After `rotate`, whose factors are in turn. */
bool oracle_run_account(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  const struct thermostat *own = c->thermostat;
  c->thermostat = thermostat_of(THERMOSTAT_RESCALE_LAYERS); /* factors count */
  c->border->account(g->state, g->model, c, g->place.step);
  c->thermostat = own;
  return true;
}

bool oracle_begin_enter(struct oracle_stage *g)
{
  g->work->mpc.shift = grid_shift(g->model, g->place.step);
  g->work->mpc.entered = 0;
  return true;
}

bool oracle_run_enter(struct oracle_stage *g)
{
  g->work->mpc.border->enter(g->state, g->model, 0, g->state->solvent.n, &g->work->mpc);
  return true;
}

bool oracle_run_leave(struct oracle_stage *g)
{
  g->work->mpc.border->leave(g->state, g->model, &g->work->mpc);
  return true;
}

bool oracle_run_affine_kick(struct oracle_stage *g)
{
  drive_affine_kick(g->state, g->model);
  return true;
}

/* A start of its own: particles stand in the order of their numbers. */
bool oracle_begin_dumbbells(struct oracle_stage *g)
{
  if (!state_alloc(&g->fresh, g->model))
    return fault_no_memory(&g->work->fault, g->state->step + 1);
  fluid_of(g->model)->start(&g->fresh, g->model);
  return true;
}

/* --- baths of pairs, forces of pairs ------------------------------------------------------------------------------ */

bool oracle_run_private_bath(struct oracle_stage *g)
{
  return private_collide(g->state, g->model, &g->work->medium, g->place.step, &g->work->fault);
}

bool oracle_run_pairs(struct oracle_stage *g)
{
  struct medium *m = &g->work->medium;
  members_gather(g->state, g->model, m);
  g->pack->failed |= !encounters_find(g->model, m, g->place.step);
  encounters_order(m);
  return !g->pack->failed;
}

/* After `pairs`, with its members. */
bool oracle_run_pair_bath(struct oracle_stage *g)
{
  struct medium *m = &g->work->medium;
  for (uint32_t k = 0; k < m->encounters; k++)
    encounter_act(&m->encounter[(uint32_t)m->key[k]], m->mover);
  members_scatter(g->state, m);
  return true;
}

bool oracle_run_repulsion(struct oracle_stage *g)
{
  return repulsion_forces(g->state, g->model, &g->work->medium, &g->work->fault);
}

bool oracle_run_repulsion_kick(struct oracle_stage *g)
{
  repulsion_kick(g->state, g->model, &g->work->medium, 0.5);
  return true;
}

/* --- overdamped motion ------------------------------------------------------------------------------------------- */

/* |D^-1| of Frobenius, from L: of which the rounding of L is a multiple (docs/port/tolerances.md). */
static double inverse_norm(uint32_t n, const double *l, double *x, double *y)
{
  double sum = 0.0;
  for (uint32_t k = 0; k < n; k++) {
    memset(x, 0, n * sizeof *x);
    for (uint32_t i = k; i < n; i++) { /* L x = e_k */
      double rest = i == k ? 1.0 : 0.0;
      for (uint32_t j = k; j < i; j++)
        rest -= l[(size_t)j * n + i] * x[j];
      x[i] = rest / l[(size_t)i * n + i];
    }
    for (uint32_t i = n; i-- > 0;) { /* L^T y = x */
      double rest = x[i];
      for (uint32_t j = i + 1; j < n; j++)
        rest -= l[(size_t)i * n + j] * y[j];
      y[i] = rest / l[(size_t)i * n + i];
      sum += y[i] * y[i];
    }
  }
  return sqrt(sum);
}

/* Entries of the lower triangle of a fiber's tensor, column by column; of its root, if the tensor is positive. */
static bool add_entries(struct oracle_stage *g, uint32_t fiber, double *scratch)
{
  const struct model *m = g->model;
  const uint32_t first = m->fiber_first[fiber], vertices = m->fiber_first[fiber + 1] - first, n = 3 * vertices;
  struct vec3 *place = (struct vec3 *)scratch;
  double *d = scratch + n, *l = d + (size_t)n * n, *x = l + (size_t)n * n, pivot = 0.0;
  for (uint32_t v = 0; v < vertices; v++)
    place[v] = point_difference(g->state->position[first + v], g->state->position[first]);
  mobility_fill(mobility_of(m->medium.tensor), m->medium.radius, vertices, place, d);
  memcpy(l, d, (size_t)n * n * sizeof *l);
  if (!mobility_factor(n, l, &pivot))
    return fault_record(&g->work->fault, FAULT_MOBILITY, g->place.step, first, pivot, 0.0);
  const double condition = inverse_norm(n, l, x, x + n);
  for (uint32_t k = 0; k < n; k++)
    for (uint32_t i = k; i < n; i++) {
      const struct oracle_entry e = {d[(size_t)k * n + i], l[(size_t)k * n + i], condition};
      if (!oracle_add_rows(g, &e, 1, sizeof e))
        return false;
    }
  return true;
}

bool oracle_begin_entries(struct oracle_stage *g)
{
  const struct model *m = g->model;
  bool ok = true;
  for (uint32_t f = 0; ok && m->medium.tensor != TENSOR_NONE && f < m->fibers; f++) {
    const size_t n = 3 * (size_t)(m->fiber_first[f + 1] - m->fiber_first[f]);
    double *scratch = malloc((2 * n * n + 3 * n + 1) * sizeof *scratch);
    g->pack->failed |= !scratch;
    ok = scratch && add_entries(g, f, scratch);
    free(scratch);
  }
  return ok;
}

/* After `force`. */
bool oracle_run_move(struct oracle_stage *g)
{
  const struct fiber *f = &g->work->fiber;
  return overdamped_move(g->state, g->model, f->force, f->overdamped, g->place.step, &g->work->fault);
}
