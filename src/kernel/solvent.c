/*
 * The fast kernel: SRD, AT-a and AT+a. One source; the Makefile compiles it once for each instruction set
 * (base/registers.h), and choose.c takes the best one that the processor has. The formulas for several particles at
 * once stand beside the plain ones whose bits they give, in headers *_lanes.h; here are the loops. What is rare goes to
 * the plain ones: flights beyond the next image of the box, momenta beyond the range of lattice_round, the last
 * particles if they do not fill a register, and all that are near a wall or the boundary of a sheared box.
 */
#include <string.h>

#include "base/axis_lanes.h"
#include "fluid/flight_lanes.h"
#include "fluid/fluid.h"
#include "kernel/choose.h"
#include "kernel/collide.h"
#include "mpc/border.h"
#include "mpc/gather_lanes.h"
#include "mpc/members.h"
#include "mpc/rule.h"
#include "mpc/rules/andersen.h"
#include "mpc/rules/andersen_lanes.h"
#include "mpc/rules/spin_lanes.h"
#include "mpc/rules/srd.h"
#include "mpc/rules/srd_lanes.h"
#include "mpc/thermostat_lanes.h"

#ifndef KERNEL /* the Makefile names them */
#define KERNEL kernel_sse2
#define KERNEL_NAME "sse2"
#endif

/* --- flight, cells, sums ----------------------------------------------------------------------------------------- */

/* Particles whose flight comes before their sums: all of it stays in the nearest cache. */
enum { CHUNK = ANDERSEN_LANES_MOST };
_Static_assert((int)BOUNDARY_BLOCK <= (int)CHUNK && BOUNDARY_BLOCK % LANES == 0,
               "a block has room, and fills registers");

/* How particles get to their places: by a periodic flight; by one in which a block of them stays clear of what is at
 * the ends of the box along y, or else flies by the plain kernel; or they are there, for other fluids than points fly
 * by themselves. */
enum course { COURSE_PERIODIC, COURSE_CLEAR, COURSE_THERE };

/* Flight, cells and records of a chunk. The sign bit of the result is set where that of boundary_fly_periodic is. */
INLINE uint64_t fly_chunk(const struct flight flight[3], const struct gather_axis grid[3], const struct mpc *c,
                          uint32_t first, uint32_t n, const enum course course, const bool accelerated,
                          const bool draws, double *record, uint64_t *span)
{
  const struct flight f[3] = {flight[0], flight[1], flight[2]};
  const struct gather_axis axis[3] = {grid[0], grid[1], grid[2]};
  const double *const drawn[3] = {c->drawn[0], c->drawn[1], c->drawn[2]};
  uint32_t *cell = c->solvent_cell;
  words seen[3] = {{0}, {0}, {0}}, size = {0};
  for (uint32_t k = 0; k < n; k += LANES) {
    const uint32_t i = first + k;
    reals v[3];
    words x[3];
    UNROLL
    for (int a = 0; a < 3; a++) {
      v[a] = load_reals(&f[a].v[i]);
      x[a] = course == COURSE_THERE ? load_words(&f[a].x[i]) : flight_lanes(&f[a], i, accelerated, &v[a], &seen[a]);
    }
    gather_cells_lanes(axis, x, &cell[i]);
    gather_records_lanes(v, drawn, i, draws, &size, &record[(size_t)4 * k]);
  }
  *span = any(size);
  return any(was_outside(seen[0], f[0].edge) | was_outside(seen[1], f[1].edge) | was_outside(seen[2], f[2].edge));
}

static void bin_and_add(const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                        uint32_t first, uint32_t n, uint64_t *span)
{
  c->border->bin_particles(state, model, first, n, c);
  *span |= c->rule->add_particles(state, model, c, step, first, n);
}

INLINE bool gather_all(struct state *state, const struct model *model, struct mpc *c, uint64_t step, uint32_t first,
                       uint32_t n, const enum course course, const bool draws, uint64_t *span, struct fault *fault)
{
  const struct flight f[3] = {flight_along(state, model, 0), flight_along(state, model, 1),
                              flight_along(state, model, 2)};
  const struct gather_axis axis[3] = {gather_axis_of(model, c, 0), gather_axis_of(model, c, 1),
                                      gather_axis_of(model, c, 2)};
  const bool accelerated = f[0].gain != 0.0 || f[1].gain != 0.0 || f[2].gain != 0.0;
  const uint64_t clear = f[1].edge - (model_is_sheared(model) ? axis[1].shift : 0); /* border_shear.c */
  const uint32_t chunk = course == COURSE_CLEAR ? BOUNDARY_BLOCK : CHUNK, end = first + n,
                 whole = end - n % (course == COURSE_CLEAR ? chunk : LANES);
  double record[4 * CHUNK];
  uint32_t i = first;
  for (uint32_t m; i < whole; i += m) {
    m = whole - i < chunk ? whole - i : chunk;
    if (course == COURSE_CLEAR && !flight_stays_lanes(&f[1], i, m, clear)) {
      if (!kernel_short.ways.gather(state, model, c, step, i, m, span, fault))
        return false;
      continue;
    }
    uint64_t size;
    if (draws)
      andersen_draw_lanes(&state->solvent, model, c, step, i, m);
    const uint64_t outside = accelerated ? fly_chunk(f, axis, c, i, m, course, true, draws, record, &size)
                                         : fly_chunk(f, axis, c, i, m, course, false, draws, record, &size);
    if ((int64_t)outside < 0) {
      const uint32_t flown = i + m;
      m = course == COURSE_CLEAR ? m : end - i;
      if (!flight_far(state, model, course == COURSE_CLEAR ? i : first, flown, i + m, fault))
        return false;
      bin_and_add(state, model, c, step, i, m, span);
      continue;
    }
    for (uint32_t k = i; c->prefetch && k < i + m; k++)
      __builtin_prefetch(&c->sum[c->solvent_cell[k]], 1);
    if (size < CELL_LANES_MOST) {
      gather_add_lanes(c->sum, &c->solvent_cell[i], m, record);
      if (draws && c->spin_in_halves)
        spin_add_lanes(&state->solvent, c, i, m);
    } else
      size = c->rule->add_particles(state, model, c, step, i, m);
    *span |= size;
  }
  if (course != COURSE_THERE)
    return i == end || kernel_short.ways.gather(state, model, c, step, i, end - i, span, fault);
  bin_and_add(state, model, c, step, i, end - i, span);
  return true;
}

INLINE bool gather_by(struct state *state, const struct model *model, struct mpc *c, uint64_t step, uint32_t first,
                      uint32_t n, const enum course course, uint64_t *span, struct fault *fault)
{
  return c->rule->thermal ? gather_all(state, model, c, step, first, n, course, true, span, fault)
                          : gather_all(state, model, c, step, first, n, course, false, span, fault);
}

static bool gather_fast(struct state *state, const struct model *model, struct mpc *c, uint64_t step, uint32_t first,
                        uint32_t n, uint64_t *span, struct fault *fault)
{
  if (c->fluid == &fluid_points)
    return model->box.boundary[1] == BOUNDARY_PERIODIC
               ? gather_by(state, model, c, step, first, n, COURSE_PERIODIC, span, fault)
               : gather_by(state, model, c, step, first, n, COURSE_CLEAR, span, fault);
  if (!c->fluid->stream(state, model, first, n, fault))
    return false;
  if (c->border->enter)
    c->border->enter(state, model, first, n, c);
  return gather_by(state, model, c, step, first, n, COURSE_THERE, span, fault);
}

/* --- centers and axes -------------------------------------------------------------------------------------------- */

/* cell_solve, and the axis if cells turn, of LANES cells. Those whose axis needs another draw, one in twenty, are
 * appended to a list. Returns its length. Their loads and members are counted (struct solved). clears: their sums are
 * set to 0. */
INLINE uint32_t solve_lanes(uint64_t seed, struct mpc *c, uint64_t step, uint32_t first, words lane_cell,
                            const bool turns, const bool clears, uint32_t *list, uint32_t n, words counts[2])
{
  reals p[4], turn[8] = {{0}};
  load_records(&c->sum[first], p);
  const words load = (words)p[3], others = cell_others_lanes(load), two = cell_collides_lanes(others);
  counts[0] |= load;
  counts[1] += others & two;
  if (clears)
    memset(&c->sum[first], 0, LANES * sizeof *c->sum);
  if (none(two)) {
    for (uint32_t k = first; k < first + LANES; k++)
      c->turn[k].active = 0.0, c->turn[k].factor = 1.0;
    return n;
  }
  const words cell = lane_cell + first;
  const reals scale = cell_center_scale_lanes(load);
  for (int k = 0; k < 3; k++)
    turn[k] = (reals)((words)(reals_from_signed((words)p[k]) * scale) & two);
  if (turns) {
    axis_lanes(seed, RANDOM_ROTATION_AXIS, 0, step, cell, &turn[4]);
    n = append(list, n, cell, (words)((turn[6] <= -1.0) & (wholes)two));
  }
  turn[7] = (reals){0} + 1.0;
  turn[3] = (reals)((words)turn[7] & two);
  store_columns((double *)c->turn, first, turn);
  return n;
}

/* The second draw for LANES cells of the list, and if need be more. */
static void draw_again(const struct model *model, struct mpc *c, uint64_t step, const uint32_t *list)
{
  reals axis[3];
  axis_lanes(model->seed, RANDOM_ROTATION_AXIS, 1, step, load_low(list), axis);
  for (int k = 0; k < LANES; k++)
    c->turn[list[k]].axis = axis[2][k] > -1.0 ? (struct vec3){axis[0][k], axis[1][k], axis[2][k]}
                                              : random_axis_from(model->seed, RANDOM_ROTATION_AXIS, 2, step, list[k]);
}

/* The last cells, from `first` on, which do not fill a register: one at a time. */
INLINE void solve_rest(const struct model *model, struct mpc *c, uint64_t step, uint32_t first, const bool turns,
                       const bool spins, const bool clears, struct solved *all)
{
  for (uint32_t k = first; k < c->cells; k++) {
    cell_count(&c->sum[k], all);
    cell_solve(&c->sum[k], &c->turn[k]);
    if (turns)
      c->turn[k].axis = random_axis_from(model->seed, RANDOM_ROTATION_AXIS, 0, step, k);
    if (spins) {
      spin_widen(&c->spin[k]);
      spin_solve(&c->sum[k], &c->spin[k], &c->turn[k], &c->middle[k]);
      c->spin[k] = (struct cell_spin){0};
    }
    if (clears)
      c->sum[k] = (struct cell_sum){0};
  }
  c->sum_is_clear = clears;
  c->spin_is_clear = spins;
}

INLINE struct solved solve_all(const struct model *model, struct mpc *c, uint64_t step, const bool turns,
                               const bool clears)
{
  uint32_t list[2 * LANES + CHUNK], n = 0;
  const uint32_t whole = c->cells - c->cells % LANES;
  const uint64_t seed = model->seed; /* nothing that is written here can change it, and its keys are kept */
  const words lane_cell = lane_records();
  words counts[2] = {{0}, {0}};
  for (uint32_t k = 0; k < whole; k += LANES) {
    n = solve_lanes(seed, c, step, k, lane_cell, turns, clears, list, n, counts);
    if (n < CHUNK && k + LANES < whole)
      continue;
    for (; n >= LANES; n -= LANES)
      draw_again(model, c, step, &list[n - LANES]);
  }
  for (uint32_t k = 0; k < n; k++)
    c->turn[list[k]].axis = random_axis_from(model->seed, RANDOM_ROTATION_AXIS, 1, step, list[k]);
  struct solved all = {.loads = any(counts[0]), .others = sum_of(counts[1])};
  solve_rest(model, c, step, whole, turns, false, clears, &all);
  return all;
}

/* The same for AT+a, of sums in halves. */
INLINE struct solved solve_spins(const struct model *model, struct mpc *c, uint64_t step, const bool clears)
{
  const uint32_t whole = c->cells - c->cells % LANES;
  words counts[2] = {{0}, {0}};
  for (uint32_t k = 0; k < whole; k += LANES)
    spin_solve_lanes(c, k, clears, counts);
  struct solved all = {.loads = any(counts[0]), .others = sum_of(counts[1])};
  solve_rest(model, c, step, whole, false, true, clears, &all);
  return all;
}

static struct solved solve_fast(const struct model *model, struct mpc *c, uint64_t step, bool last)
{
  if (c->spin_in_halves)
    return last ? solve_spins(model, c, step, true) : solve_spins(model, c, step, false);
  if (c->rule->spinning)
    return kernel_short.ways.solve(model, c, step, last);
  if (c->rule->thermal)
    return last ? solve_all(model, c, step, false, true) : solve_all(model, c, step, false, false);
  return last ? solve_all(model, c, step, true, true) : solve_all(model, c, step, true, false);
}

/* --- energies ---------------------------------------------------------------------------------------------------- */

static uint64_t energies_fast(const struct state *state, struct mpc *c, uint32_t first, uint32_t n, energy_sum *total)
{
  const struct solvent *s = &state->solvent;
  const uint32_t end = first + n, whole = end - n % LANES;
  const uint32_t *cell = c->solvent_cell;
  uint64_t span = 0, *sum = (uint64_t *)c->relative; /* unsigned: see overflow.h */
  for (uint32_t i = first, m = 0; i < whole; i += m) {
    int64_t energy[CHUNK];
    words size = {0}, sums = {0};
    m = whole - i < CHUNK ? whole - i : CHUNK;
    members_prefetch_turns(c, i + m, whole - i - m < CHUNK ? whole - i - m : CHUNK);
    for (uint32_t k = 0; k < m; k += LANES) {
      reals turn[4];
      load_columns((const double *)c->turn, &cell[i + k], turn, 4);
      const words e =
          cell_energy_lanes(turn, load_reals(&s->vx[i + k]), load_reals(&s->vy[i + k]), load_reals(&s->vz[i + k]));
      size |= e;
      sums += e;
      store_words(&energy[k], e);
    }
    if (any(size) >= CELL_LANES_MOST)
      return span | kernel_short.ways.energies(state, c, i, end - i, total);
    if (total)
      *total += sum_of(sums);
    for (uint32_t k = 0; k < m && !total; k += LANES) {
      UNROLL
      for (uint32_t lane = 0; lane < LANES; lane++)
        sum[cell[i + k + lane]] += (uint64_t)energy[k + lane];
    }
    span |= any(size);
  }
  return span | kernel_short.ways.energies(state, c, whole, end - whole, total);
}

/* --- turns ------------------------------------------------------------------------------------------------------- */

INLINE void turn_whole(struct state *state, const struct model *model, const struct mpc *c, const bool draws,
                       const bool spins, const bool quarter, const bool scaled)
{
  const struct solvent *s = &state->solvent;
  const struct spin_columns columns = spin_columns_of(s, c);
  const double cosine = model->solvent.cosine, sine = model->solvent.sine;
  const uint32_t whole = s->n - s->n % LANES;
  for (uint32_t first = 0; first < whole; first += CHUNK) {
    const uint32_t end = whole - first < CHUNK ? whole : first + CHUNK;
    members_prefetch_turns(c, end, s->n - end < CHUNK ? s->n - end : CHUNK);
    for (uint32_t i = first; i < end && spins; i += LANES)
      spin_turn_lanes(&columns, c->turn, c->middle, i);
    for (uint32_t i = first; i < end && draws && !spins; i += LANES)
      andersen_turn_lanes(s, c, i);
    for (uint32_t i = first; i < end && !draws; i += LANES) {
      reals column[8];
      load_columns((const double *)c->turn, &c->solvent_cell[i], column, 8);
      srd_turn_lanes(s, i, column, cosine, sine, quarter, scaled);
    }
  }
}

static void turn_fast(struct state *state, const struct model *model, const struct mpc *c, bool scaled)
{
  const bool quarter = model->solvent.cosine == 0.0;
  const uint32_t n = state->solvent.n, whole = n - n % LANES;
  if (c->rule->spinning)
    turn_whole(state, model, c, true, true, false, false);
  else if (c->rule->thermal)
    turn_whole(state, model, c, true, false, false, false);
  else if (quarter && scaled)
    turn_whole(state, model, c, false, false, true, true);
  else if (quarter)
    turn_whole(state, model, c, false, false, true, false);
  else if (scaled)
    turn_whole(state, model, c, false, false, false, true);
  else
    turn_whole(state, model, c, false, false, false, false);
  if (c->rule->spinning)
    spin_turn_from(state, c, whole);
  else if (c->rule->thermal)
    andersen_turn_from(state, c, whole);
  else
    srd_turn_from(state, model, c, whole, scaled);
}

const struct kernel KERNEL = {.name = KERNEL_NAME,
                              .collide = kernel_collide,
                              .ways = {.gather = gather_fast,
                                       .solve = solve_fast,
                                       .energies = energies_fast,
                                       .canonical = thermostat_canonical_lanes,
                                       .turn = turn_fast,
                                       .halves = true}};
