/*
 * Averages over time in slabs of equal thickness along y: one table "profile" with a row for each slab. Names and
 * meanings of its columns are in docs/observables.md.
 *
 * Each sample adds the sums over a slab's particles to the blocks of the slab (block.h). Averages are ratios of such
 * sums: momentum over number, energy over degrees of freedom. So slabs with few particles count as much as they should.
 *
 * Where the boundary oscillates, the first harmonic of the velocity is taken over whole periods: the sums of
 * v cos(2 pi t/period) and v sin(2 pi t/period) of a period are one value of its blocks.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "base/memory.h"
#include "fluid/fluid.h"
#include "medium/repulsion.h"
#include "observe/background.h"
#include "observe/block.h"
#include "observe/observer.h"

/* Quantities of a slab, each a pair (x, y). */
enum {
  ALONG_X,   /* momentum along x, number */
  ALONG_Y,   /* momentum along y, number */
  ALONG_Z,   /* momentum along z, number */
  HEAT,      /* sum of (v - <v>)^2, degrees of freedom */
  HARMONICS, /* amplitudes of v_x in phase and out of phase, of a period */
  QUANTITIES
};

enum { LEVELS = 24, OPEN_SUMS = 3, FLIGHT = 256 };

/* Reals: the blocks, [slabs][QUANTITIES][LEVELS], then the sums of the period that goes on, [slabs][OPEN_SUMS]: of
 * momentum times cosine, times sine, and of numbers. Integers: */
enum { MARK, PERIOD, INTEGERS };

#define FIXED 0x1p32 /* units per a0/t0, and per its square */
#define FIXED_UNIT 0x1p-32
#define FASTEST 512.0 /* a0/t0: beyond it a sample is not a number */

/* Sums over the particles of a slab, in units of FIXED_UNIT: they do not depend on the order of particles. */
struct slab {
  int64_t n, wild, px, py, pz, squares;
};

static void size_profile(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  const size_t slabs = observer->slabs;
  const size_t open = model->wave.intervals > 0 ? OPEN_SUMS : 0;
  size->reals = slabs * (QUANTITIES * LEVELS * BLOCK_LEVEL_DOUBLES + open);
  size->integers = INTEGERS;
  size->scratch = slabs * sizeof(struct slab) / sizeof(double);
}

static struct block_level *blocks_of(const struct observer *o, uint64_t slab, int quantity)
{
  return (struct block_level *)o->real + (slab * QUANTITIES + (uint64_t)quantity) * LEVELS;
}

static double *open_sums(const struct observer *o, uint64_t slab)
{
  return o->real + o->slabs * QUANTITIES * LEVELS * BLOCK_LEVEL_DOUBLES + slab * OPEN_SUMS;
}

static void slab_add(struct slab *s, struct vec3 v)
{
  const bool wild = !(fabs(v.x) < FASTEST && fabs(v.y) < FASTEST && fabs(v.z) < FASTEST);
  s->n++;
  s->wild += wild;
  if (wild)
    return;
  s->px += lattice_round(FIXED * v.x);
  s->py += lattice_round(FIXED * v.y);
  s->pz += lattice_round(FIXED * v.z);
  s->squares += lattice_round(FIXED * vec3_dot(v, v));
}

/* Velocities are those of the time at which collisions act: under forces of pairs those of the state may be ahead of
 * it. pair: these forces by number; NULL: none. */
static void now_colliding(const struct view *view, uint32_t first, uint32_t n, const struct vec3 *pair,
                          struct point *at, struct vec3 *v)
{
  const struct state *state = view->state;
  fluid_of(view->model)->now(state, view->model, first, n, at, v);
  for (uint32_t i = 0; pair && i < n; i++)
    v[i] = vec3_add_scaled(v[i], -background_ahead(view->model), pair[state->solvent.id[first + i]]);
}

static void sum_slabs(const struct observer *o, const struct view *view, struct slab *slab)
{
  const struct model *model = view->model;
  const struct state *state = view->state;
  struct point at[FLIGHT];
  struct vec3 v[FLIGHT], *pair;
  struct repulsion_sums ignored;
  const size_t members = model_repels(model) ? (size_t)state->solvent.n + state->vertices : 0;
  const struct memory_need need = {(void **)&pair, members, sizeof *pair};
  const bool known = memory_take(&need, 1) && repulsion_measure(state, model, pair, &ignored);
  memset(slab, 0, o->slabs * sizeof *slab);
  for (uint32_t first = 0; first < state->solvent.n; first += FLIGHT) {
    const uint32_t rest = state->solvent.n - first, n = rest < FLIGHT ? rest : FLIGHT;
    now_colliding(view, first, n, pair, at, v);
    for (uint32_t i = 0; i < n; i++) {
      const uint64_t k = (uint64_t)at[i].y * o->slabs / (uint64_t)model->box.edge[1];
      slab_add(&slab[k < o->slabs ? k : o->slabs - 1], v[i]); /* a particle may stand on the upper wall */
    }
  }
  for (uint64_t k = 0; k < o->slabs; k++)
    slab[k].wild += !known;
  memory_release(&need, 1);
}

/* --- the first harmonic ------------------------------------------------------------------------------------------ */

static uint64_t period_steps(const struct model *model)
{
  return (uint64_t)model->wave.intervals * model->solvent.interval_steps;
}

/* The period that went on is over: its amplitudes are values of their blocks. */
static void close_period(struct observer *o)
{
  for (uint64_t k = 0; k < o->slabs; k++) {
    double *sum = open_sums(o, k);
    if (sum[2] > 0.0)
      block_add(blocks_of(o, k, HARMONICS), LEVELS, 2.0 * sum[0] / sum[2], 2.0 * sum[1] / sum[2]);
    memset(sum, 0, OPEN_SUMS * sizeof *sum);
  }
}

/* A sample belongs to the period that begins with it or before. The first whole one begins at `from` or later. */
static void add_harmonics(struct observer *o, const struct view *view, const struct slab *slab)
{
  const uint64_t length = period_steps(view->model), step = view->state->step, period = step / length;
  if (period * length < o->from)
    return;
  if ((int64_t)period != o->integer[PERIOD])
    close_period(o);
  o->integer[PERIOD] = (int64_t)period;
  const struct circle_point at = elementary_circle_turns((double)(step % length) / (double)length);
  for (uint64_t k = 0; k < o->slabs; k++) {
    const double px = slab[k].wild ? NAN : (double)slab[k].px * FIXED_UNIT;
    double *sum = open_sums(o, k);
    sum[0] += px * at.cosine;
    sum[1] += px * at.sine;
    sum[2] += (double)slab[k].n;
  }
}

/* --- samples ----------------------------------------------------------------------------------------------------- */

static void add_slab(struct observer *o, uint64_t k, const struct slab *s, uint32_t dimensions)
{
  const double n = (double)s->n, unit = s->wild ? NAN : FIXED_UNIT;
  const struct vec3 p = {(double)s->px * unit, (double)s->py * unit, (double)s->pz * unit};
  const double heat = s->n > 1 ? (double)s->squares * unit - vec3_dot(p, p) / n : 0.0;
  block_add(blocks_of(o, k, ALONG_X), LEVELS, p.x, n);
  block_add(blocks_of(o, k, ALONG_Y), LEVELS, p.y, n);
  block_add(blocks_of(o, k, ALONG_Z), LEVELS, p.z, n);
  block_add(blocks_of(o, k, HEAT), LEVELS, heat, s->n > 1 ? dimensions * (n - 1.0) : 0.0);
}

static void add_profile(struct observer *o, struct view *view)
{
  struct slab *slab = (struct slab *)o->scratch;
  sum_slabs(o, view, slab);
  for (uint64_t k = 0; k < o->slabs; k++)
    add_slab(o, k, &slab[k], view->model->dimensions);
  if (view->model->wave.intervals > 0)
    add_harmonics(o, view, slab);
}

/* --- the table --------------------------------------------------------------------------------------------------- */

static const char *const columns[] = {"y",
                                      "density",
                                      "density_error",
                                      "vx",
                                      "vx_error",
                                      "vy",
                                      "vy_error",
                                      "vz",
                                      "vz_error",
                                      "temperature",
                                      "temperature_error",
                                      "samples",
                                      "vx_in_phase",
                                      "vx_in_phase_error",
                                      "vx_out_of_phase",
                                      "vx_out_of_phase_error"};

enum { STEADY_COLUMNS = 12, COLUMNS = sizeof columns / sizeof *columns };

static double *put_mean(double *cell, const struct block_level *level, int part, double scale)
{
  cell[0] = level->count > 0.0 ? scale * level->mean[part] : NAN;
  cell[1] = block_error(level, LEVELS, part == 0 ? scale : 0.0, part == 0 ? 0.0 : scale);
  return cell + 2;
}

static void fill_row(const struct observer *o, const struct model *model, uint64_t k, double *cell)
{
  const double thickness = (double)model->box.cells[1] / (double)o->slabs;
  const double volume = box_volume(&model->box) / (double)o->slabs;
  *cell++ = ((double)k + 0.5) * thickness;
  cell = put_mean(cell, blocks_of(o, k, ALONG_X), 1, 1.0 / volume);
  for (int quantity = ALONG_X; quantity <= HEAT; quantity++, cell += 2)
    block_ratio(blocks_of(o, k, quantity), LEVELS, cell);
  *cell++ = blocks_of(o, k, ALONG_X)->count;
  if (model->wave.intervals == 0)
    return;
  cell = put_mean(cell, blocks_of(o, k, HARMONICS), 0, 1.0);
  put_mean(cell, blocks_of(o, k, HARMONICS), 1, 1.0);
}

static bool summarise_profile(const struct observer *o, const struct model *model, const struct observer_take *to)
{
  const size_t width = model->wave.intervals > 0 ? COLUMNS : STEADY_COLUMNS;
  double *value = calloc(o->slabs * width, sizeof *value);
  if (!value)
    return false;
  for (uint64_t k = 0; k < o->slabs; k++)
    fill_row(o, model, k, value + k * width);
  const struct observe_table table = {"profile", columns, width, o->slabs, value};
  const bool ok = to->take(to->context, &table);
  free(value);
  return ok;
}

const struct observer_type profile_observer = {
    .size = size_profile,
    .add = add_profile,
    .summarise = summarise_profile,
};
