/* The operators of a solvent between walls and in a sheared box, each alone, and those of dumbbells: docs/port/flow.md,
 * *Walls and shear* and *Dumbbells*. Scenes of walls and shear have no fibers. */
#include <stdlib.h>
#include <string.h>

#include "fluid/fluid.h"
#include "mpc/border.h"
#include "mpc/collide.h"
#include "mpc/drive.h"
#include "mpc/grid.h"
#include "mpc/thermostat.h"
#include "oracle/columns.h"
#include "oracle/stages.h"
#include "system/account.h"

/* Intervals of which the motion is asked: the first ones, and later ones than 32 bits hold. */
static const uint64_t intervals[] = {0, 1, 2, 3, 4, 5, 6, 7, 1000, 4294967295, 4294967296, 1234567890123};
enum { INTERVALS = sizeof intervals / sizeof *intervals };

static void put_vector(double to[3], struct vec3 v)
{
  to[0] = v.x, to[1] = v.y, to[2] = v.z;
}

/* The interval of the flight that comes. */
static uint64_t interval_now(const struct oracle_stage *g)
{
  return shear_interval(g->model, g->state->solvent_time);
}

/* --- walls -------------------------------------------------------------------------------------------------------- */

bool oracle_run_wall_motion(struct oracle_stage *g)
{
  int64_t *in = oracle_put_integers(g, "in.interval", "interval", INTERVALS);
  double *flight = oracle_put_reals(g, "out.flight", "lower_x lower_y lower_z upper_x upper_y upper_z", INTERVALS);
  double *end = oracle_put_reals(g, "out.end", "lower_x lower_y lower_z upper_x upper_y upper_z", INTERVALS);
  for (int k = 0; in && flight && end && k < INTERVALS; k++) {
    in[k] = (int64_t)intervals[k];
    for (int w = 0; w < WALLS; w++) {
      put_vector(&flight[6 * k + 3 * w], shear_wall_velocity(g->model, (enum wall)w, intervals[k]));
      put_vector(&end[6 * k + 3 * w], shear_wall_velocity_at_end(g->model, (enum wall)w, intervals[k]));
    }
  }
  return true;
}

static void put_walls(struct oracle_stage *g, struct vec3 velocity(const struct model *, enum wall, uint64_t),
                      uint64_t interval)
{
  const struct vec3 wall[WALLS] = {velocity(g->model, WALL_LOWER, interval), velocity(g->model, WALL_UPPER, interval)};
  oracle_put_vectors(g, "in.wall", wall, WALLS);
}

/* What this share of the account has more than before. */
static void put_given(struct oracle_stage *g, enum account_share share, const struct point before[WALLS])
{
  const struct point *now = &g->state->wall_momentum[account_row(share, WALL_LOWER)];
  struct point given[WALLS];
  for (int w = 0; w < WALLS; w++)
    given[w] = (struct point){now[w].x - before[w].x, now[w].y - before[w].y, now[w].z - before[w].z};
  oracle_put_points(g, "out.given", given, WALLS);
}

bool oracle_run_wall_stream(struct oracle_stage *g)
{
  const struct point *account = &g->state->wall_momentum[account_row(ACCOUNT_HITS, WALL_LOWER)];
  const struct point before[WALLS] = {account[WALL_LOWER], account[WALL_UPPER]};
  state_solvent_slots(g->state, g->slot);
  oracle_put_number(g, "in.time", "dt", 0.5 * g->state->solvent_lag * g->model->time_step);
  put_walls(g, shear_wall_velocity, interval_now(g));
  oracle_put_solvent_positions(g, "in.position");
  oracle_put_solvent_velocities(g, "in.velocity");
  const bool ok = fluid_stream(g->state, g->model, &g->work->fault);
  oracle_put_solvent_positions(g, "out.position");
  oracle_put_solvent_velocities(g, "out.velocity");
  put_given(g, ACCOUNT_HITS, before);
  return ok;
}

bool oracle_run_wall_bin(struct oracle_stage *g)
{
  const struct point shift = grid_shift(g->model, g->place.step);
  oracle_put_points(g, "in.shift", &shift, 1);
  oracle_put_solvent_positions(g, "in.solvent");
  grid_bin(g->state, g->model, shift, &g->work->mpc);
  int64_t *to = oracle_put_integers(g, "out.solvent", "cell", g->state->solvent.n);
  for (uint32_t id = 0; to && id < g->state->solvent.n; id++)
    to[id] = g->work->mpc.solvent_cell[g->slot[id]];
  return true;
}

static uint32_t cut_cells(const struct oracle_stage *g)
{
  return 2 * (uint32_t)g->model->box.rows[0] * (uint32_t)g->model->box.rows[2];
}

static void put_filled(struct oracle_stage *g, const char *name)
{
  const uint32_t cuts = cut_cells(g);
  double *to = oracle_put_reals(g, name, "number x y z", cuts);
  for (uint32_t k = 0; to && k < cuts; k++) {
    const struct virtual_members *v = &g->work->mpc.filled[k];
    to[4 * k] = v->n;
    if (v->n > 0.0)
      put_vector(&to[4 * k + 1], v->velocity);
  }
}

bool oracle_run_fill(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  oracle_put_points(g, "in.shift", &c->shift, 1);
  put_walls(g, shear_wall_velocity_at_end, g->place.step / g->model->solvent.interval_steps - 1);
  oracle_put_sums(g, "in.momentum", "in.load");
  const bool ok = c->border->fill(g->state, g->model, c, g->place.step, &g->work->fault);
  put_filled(g, "out.filled");
  oracle_put_sums(g, "out.momentum", "out.load");
  return ok;
}

/* After `rotate`, whose factors are in turn. */
bool oracle_run_account(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  const struct point *account = &g->state->wall_momentum[account_row(ACCOUNT_COLLISIONS, WALL_LOWER)];
  const struct point before[WALLS] = {account[WALL_LOWER], account[WALL_UPPER]};
  const struct thermostat *own = c->thermostat;
  double *factor = oracle_put_reals(g, "in.factor", "factor", c->cells);
  for (uint32_t k = 0; factor && k < c->cells; k++)
    factor[k] = c->turn[k].factor;
  oracle_put_active(g, "in.active");
  oracle_put_centers(g, "in.center");
  oracle_put_axes(g, "in.axis");
  put_filled(g, "in.filled");
  c->thermostat = thermostat_of(THERMOSTAT_RESCALE_LAYERS); /* factors count */
  c->border->account(g->state, g->model, c, g->place.step);
  c->thermostat = own;
  put_given(g, ACCOUNT_COLLISIONS, before);
  return true;
}

/* --- shear -------------------------------------------------------------------------------------------------------- */

bool oracle_run_shear_motion(struct oracle_stage *g)
{
  int64_t *interval = oracle_put_integers(g, "in.interval", "interval", INTERVALS);
  int64_t *time = oracle_put_integers(g, "in.half_steps", "half_steps", INTERVALS);
  double *rate = oracle_put_reals(g, "out.rate", "rate", INTERVALS);
  int64_t *offset = oracle_put_integers(g, "out.offset", "offset", INTERVALS);
  for (int k = 0; interval && time && rate && offset && k < INTERVALS; k++) {
    interval[k] = time[k] = (int64_t)intervals[k];
    rate[k] = shear_rate(g->model, intervals[k]);
    offset[k] = shear_offset(g->model, intervals[k]);
  }
  return true;
}

static void put_slide(struct oracle_stage *g, uint64_t half_steps, uint64_t interval)
{
  int64_t *offset = oracle_put_integers(g, "in.offset", "offset", 1);
  if (offset)
    *offset = shear_offset(g->model, half_steps);
  oracle_put_number(g, "in.speed", "speed", shear_rate(g->model, interval) * g->model->box.cells[1]);
}

static void put_particles(struct oracle_stage *g, const char *position, const char *velocity)
{
  oracle_put_solvent_positions(g, position);
  oracle_put_solvent_velocities(g, velocity);
}

bool oracle_run_shear_stream(struct oracle_stage *g)
{
  state_solvent_slots(g->state, g->slot);
  oracle_put_number(g, "in.time", "dt", 0.5 * g->state->solvent_lag * g->model->time_step);
  put_slide(g, g->state->solvent_time + g->state->solvent_lag, interval_now(g));
  put_particles(g, "in.position", "in.velocity");
  const bool ok = fluid_stream(g->state, g->model, &g->work->fault);
  put_particles(g, "out.position", "out.velocity");
  return ok;
}

static void put_slide_of_collision(struct oracle_stage *g)
{
  const uint64_t interval = interval_now(g);
  put_slide(g, g->state->solvent_time, interval > 0 ? interval - 1 : 0);
}

bool oracle_run_enter(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  c->shift = grid_shift(g->model, g->place.step);
  c->entered = 0;
  oracle_put_points(g, "in.shift", &c->shift, 1);
  put_slide_of_collision(g);
  put_particles(g, "in.position", "in.velocity");
  c->border->enter(g->state, g->model, 0, g->state->solvent.n, c);
  put_particles(g, "out.position", "out.velocity");
  return true;
}

bool oracle_run_leave(struct oracle_stage *g)
{
  struct mpc *c = &g->work->mpc;
  oracle_put_points(g, "in.shift", &c->shift, 1);
  put_slide_of_collision(g);
  put_particles(g, "in.position", "in.velocity");
  c->border->leave(g->state, g->model, c);
  put_particles(g, "out.position", "out.velocity");
  return true;
}

bool oracle_run_affine_kick(struct oracle_stage *g)
{
  const uint64_t begins = interval_now(g);
  oracle_put_number(g, "in.change", "rate",
                    shear_rate(g->model, begins) - (begins > 0 ? shear_rate(g->model, begins - 1) : 0.0));
  put_particles(g, "in.position", "in.velocity");
  drive_affine_kick(g->state, g->model);
  oracle_put_solvent_velocities(g, "out.velocity");
  return true;
}

/* --- dumbbells ---------------------------------------------------------------------------------------------------- */

/* Vectors of dumbbells, by number. */
void oracle_put_springs(struct oracle_stage *g, const char *name, const struct state *state)
{
  const struct dumbbells *d = &state->dumbbells;
  int64_t *to = oracle_put_integers(g, name, "x y z", d->n);
  for (uint32_t p = 0; to && p < d->n; p++) {
    int64_t *row = &to[3 * (size_t)d->id[p]];
    row[0] = d->x[p], row[1] = d->y[p], row[2] = d->z[p];
  }
}

/* A state of its own: particles stand in the order of their numbers. */
bool oracle_run_dumbbell_start(struct oracle_stage *g)
{
  struct state fresh = {0};
  if (!state_alloc(&fresh, g->model))
    return fault_no_memory(&g->work->fault, g->state->step + 1);
  fluid_of(g->model)->start(&fresh, g->model);
  const uint32_t n = 2 * fresh.dumbbells.n;
  int64_t *to = oracle_put_integers(g, "out.position", "x y z", n);
  for (uint32_t i = 0; to && i < n; i++)
    to[3 * i] = fresh.solvent.x[i], to[3 * i + 1] = fresh.solvent.y[i], to[3 * i + 2] = fresh.solvent.z[i];
  oracle_put_springs(g, "out.vector", &fresh);
  state_free(&fresh);
  return true;
}

static bool fly_dumbbells(struct oracle_stage *g)
{
  state_solvent_slots(g->state, g->slot);
  oracle_put_number(g, "in.time", "dt", 0.5 * g->state->solvent_lag * g->model->time_step);
  put_particles(g, "in.position", "in.velocity");
  oracle_put_springs(g, "in.vector", g->state);
  const bool ok = fluid_stream(g->state, g->model, &g->work->fault);
  put_particles(g, "out.position", "out.velocity");
  oracle_put_springs(g, "out.vector", g->state);
  return ok;
}

bool oracle_run_dumbbell_stream(struct oracle_stage *g)
{
  return fly_dumbbells(g);
}

bool oracle_run_dumbbell_wall_stream(struct oracle_stage *g)
{
  const struct point *account = &g->state->wall_momentum[account_row(ACCOUNT_HITS, WALL_LOWER)];
  const struct point before[WALLS] = {account[WALL_LOWER], account[WALL_UPPER]};
  put_walls(g, shear_wall_velocity, interval_now(g));
  const bool ok = fly_dumbbells(g);
  put_given(g, ACCOUNT_HITS, before);
  return ok;
}

bool oracle_run_dumbbell_shear_stream(struct oracle_stage *g)
{
  int64_t *begin = oracle_put_integers(g, "in.begin", "offset", 1);
  if (begin)
    *begin = shear_offset(g->model, g->state->solvent_time);
  put_slide(g, g->state->solvent_time + g->state->solvent_lag, interval_now(g));
  return fly_dumbbells(g);
}

void oracle_put_dumbbells(struct oracle_stage *g)
{
  const struct dumbbell_model *d = &g->model->dumbbells;
  int64_t *number = oracle_put_integers(g, "in.dumbbells", "number", 1);
  if (number)
    *number = d->pairs;
  double *to = oracle_put_reals(g, "in.spring", "spring frequency depth range", 1);
  const double spring[4] = {d->spring, d->frequency, d->depth, d->range};
  if (to)
    memcpy(to, spring, sizeof spring);
}

/* --- layers ------------------------------------------------------------------------------------------------------- */

bool oracle_run_rescale_layers(struct oracle_stage *g)
{
  const uint32_t cells = oracle_cells(g);
  struct mpc *c = &g->work->mpc;
  if (c->filled)
    put_filled(g, "in.filled");
  return oracle_run_thermostat(g, THERMOSTAT_RESCALE_LAYERS) && cells > 0;
}

/* --- the model ---------------------------------------------------------------------------------------------------- */

/* What only such scenes have. */
void oracle_put_flow(struct oracle_stage *g)
{
  const struct model *m = g->model;
  const bool walls = model_has_walls(m);
  const int64_t n[5] = {m->box.boundary[1], m->walls.kind == WALL_SLIP, m->walls.fill, m->wave.intervals,
                        m->scheme == SCHEME_DRIFT_SPLIT};
  int64_t *boundary = oracle_put_integers(g, "in.boundary", "kind slip fill intervals early", 1);
  if (boundary)
    memcpy(boundary, n, sizeof n);
  double *flow = oracle_put_reals(g, "in.flow", "per_cell rate", 1);
  if (flow)
    flow[0] = m->solvent.per_cell, flow[1] = m->shear.rate;
  const struct vec3 wall[WALLS] = {m->walls.lower, m->walls.upper};
  if (walls)
    oracle_put_vectors(g, "in.wall", wall, WALLS);
  double *cosine = m->wave.intervals ? oracle_put_reals(g, "in.wave", "cosine", 2 * m->wave.intervals) : NULL;
  for (uint32_t k = 0; cosine && k < 2 * m->wave.intervals; k++)
    cosine[k] = m->wave.cosine[k];
}
