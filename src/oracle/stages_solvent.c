#include "base/random.h"
#include "fluid/fluid.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/sort.h"
#include "oracle/columns.h"
#include "oracle/stages.h"

bool oracle_run_stream(struct oracle_stage *g)
{
  state_solvent_slots(g->state, g->slot);
  oracle_put_number(g, "in.time", "dt", 0.5 * g->state->solvent_lag * g->model->time_step);
  oracle_put_solvent_positions(g, "in.position");
  oracle_put_solvent_velocities(g, "in.velocity");
  bool ok = fluid_stream(g->state, g->model, &g->work->fault);
  oracle_put_solvent_positions(g, "out.position");
  oracle_put_solvent_velocities(g, "out.velocity");
  return ok;
}

bool oracle_run_shift(struct oracle_stage *g)
{
  const struct point shift = grid_shift(g->model, g->place.step);
  oracle_put_points(g, "out.shift", &shift, 1);
  return true;
}

bool oracle_run_bin(struct oracle_stage *g)
{
  const struct point shift = grid_shift(g->model, g->place.step);
  oracle_put_points(g, "in.shift", &shift, 1);
  oracle_put_solvent_positions(g, "in.solvent");
  oracle_put_points(g, "in.vertex", g->state->position, g->state->vertices);
  grid_bin(g->state, g->model, shift, &g->work->mpc);
  oracle_put_cells(g, "out.solvent", "out.vertex");
  return true;
}

bool oracle_run_sum(struct oracle_stage *g)
{
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  bool ok = collide_sum(g->state, g->model, &g->work->mpc, g->place.step, &g->work->fault);
  oracle_put_sums(g, "out.momentum", "out.load");
  return ok;
}

bool oracle_run_solve(struct oracle_stage *g)
{
  oracle_put_sums(g, "in.momentum", "in.load");
  collide_solve(g->model, &g->work->mpc, g->place.step);
  oracle_put_active(g, "out.active");
  oracle_put_centers(g, "out.center");
  oracle_put_axes(g, "out.axis");
  return true;
}

/* All thermostats are run on the same input. */
bool oracle_run_thermostat(struct oracle_stage *g, enum thermostat_kind kind)
{
  const uint32_t cells = oracle_cells(g);
  struct mpc *c = &g->work->mpc;
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  oracle_put_sums(g, "in.momentum", "in.load");
  oracle_put_centers(g, "in.center");
  bool ok = collide_thermostat(g->state, g->model, c, thermostat_of(kind), g->place.step, &g->work->fault);
  int64_t *relative = oracle_put_integers(g, "out.relative", "energy", cells);
  for (uint32_t k = 0; relative && k < cells; k++)
    relative[k] = c->turn[k].active != 0.0 ? c->relative[k] : 0;
  double *factor = oracle_put_reals(g, "out.factor", "factor", cells);
  for (uint32_t k = 0; factor && k < cells; k++)
    factor[k] = c->turn[k].active != 0.0 ? c->turn[k].factor : 1.0;
  return ok;
}

bool oracle_run_rescale(struct oracle_stage *g)
{
  return oracle_run_thermostat(g, THERMOSTAT_RESCALE);
}

bool oracle_run_maxwell_boltzmann(struct oracle_stage *g)
{
  return oracle_run_thermostat(g, THERMOSTAT_MAXWELL_BOLTZMANN);
}

/* Factors of its own, so that a port that forgets them is found: 1, 1 + 1/64, ... exact in binary. */
bool oracle_run_rotate(struct oracle_stage *g)
{
  const uint32_t cells = oracle_cells(g);
  double *factor = oracle_put_reals(g, "in.factor", "factor", cells);
  for (uint32_t k = 0; factor && k < cells; k++)
    factor[k] = g->work->mpc.turn[k].factor = 1.0 + 0x1p-6 * (k % 8);
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  oracle_put_active(g, "in.active");
  oracle_put_centers(g, "in.center");
  oracle_put_axes(g, "in.axis");
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  collide_turn(g->state, g->model, &g->work->mpc, true); /* without a thermostat, factors have no say */
  oracle_put_velocities(g, "out.solvent", "out.vertex");
  return true;
}

bool oracle_run_swap(struct oracle_stage *g)
{
  oracle_put_solvent_velocities(g, "in.velocity");
  mpc_swap_velocities(g->state, g->model, &g->work->mpc, g->place.step);
  oracle_put_counts(g, "out.order", "particle", g->work->mpc.order, g->state->solvent.n);
  oracle_put_solvent_velocities(g, "out.velocity");
  return true;
}
