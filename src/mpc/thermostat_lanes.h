/* thermostat_canonical once more (thermostat.c), of LANES cells at once: the same operations in the same order. */
#ifndef UNCROSS_MPC_THERMOSTAT_LANES_H
#define UNCROSS_MPC_THERMOSTAT_LANES_H

#include "base/elementary_lanes.h"
#include "base/philox_lanes.h"
#include "mpc/cell_lanes.h"
#include "mpc/thermostat.h"

/* Uniform deviates of the first attempts of LANES cells: two for a normal deviate, and the one that decides. */
struct thermostat_draw {
  reals u, v, decides;
};

INLINE struct thermostat_draw thermostat_draw_lanes(uint64_t seed, uint64_t step, words cell)
{
  words w[4], next[4];
  philox_words(seed, RANDOM_THERMOSTAT, 0, step, cell, w);
  philox_words(seed, RANDOM_THERMOSTAT, 1, step, cell, next);
  return (struct thermostat_draw){uniform_lanes(w[0], w[1]), uniform_lanes(w[2], w[3]),
                                  uniform_lanes(next[0], next[1])};
}

/* The first of random_normal_pair. */
INLINE reals thermostat_normal_lanes(reals u, reals v)
{
  return square_root(-2.0 * elementary_log_lanes(u)) * elementary_cosine_turns_lanes(v);
}

/* Gamma deviates of these shapes where the first attempt is certain to be taken; else -1. An attempt is taken if -ln u
 * is above d v - d - d ln v - x^2/2 = 3 d (y^4/4 - y^5/5 + ...), v = (1 + y)^3, y = c x. For y > -1 that is at most
 * 3/4 d y^4 / min(1, 1 + y), and -ln u is at least 1 - u. So no logarithm is needed, but for one cell in a hundred at 5
 * members. Roundings of both sides, times min(1, 1 + y), are below 2^-46 d where an attempt is certain. */
INLINE reals thermostat_attempt_lanes(reals shape, reals normal, reals u)
{
  const double doubt = 0x1p-40;
  const reals d = shape - 1.0 / 3.0, c = 1.0 / square_root(9.0 * d);
  const reals y = c * normal, root = 1.0 + y, v = root * root * root, w = y * y;
  const reals least = choose(y < 0.0, root, (reals){0} + 1.0) * (1.0 - u);
  return choose(least > d * (0.75 * w * w + doubt), d * v, (reals){0} - 1.0);
}

/* The factors of cells first .. first + LANES - 1; column lane k is of cell[k]. */
INLINE void thermostat_factors_lanes(const struct model *model, struct mpc *c, uint64_t step, uint32_t first,
                                     words cell, reals normal, reals u)
{
  reals sum[4];
  load_records(&c->sum[first], sum);
  const words others = cell_others_lanes((words)sum[3]), two = cell_collides_lanes(others);
  const reals shape = 0.5 * model->dimensions * reals_from_small(others & two);
  reals wanted = thermostat_attempt_lanes(shape, normal, u);
  const words doubtful = (words)(wanted < 0.0) & two;
  if (!none(doubtful))
    for (int k = 0; k < LANES; k++)
      wanted[k] = doubtful[k] == 0 ? wanted[k] : thermostat_gamma(model->seed, step, (uint32_t)cell[k], shape[k]);
  const reals energy = reals_from_signed(load_as_records(&c->relative[first])) * (0.5 * CELL_ENERGY_UNIT);
  const reals factor = choose((energy > 0.0) & (wholes)two, square_root(wanted / energy), (reals){0} + 1.0);
  UNROLL
  for (int k = 0; k < LANES; k++)
    c->turn[first + lane_record[k]].factor = factor[k];
}

/* canonical of struct kernel. Words first, then normals, then factors: one loop of all is so long that the processor
 * sees too little of the next pass while it waits for the divisions and roots of this one. */
INLINE void thermostat_canonical_lanes(const struct model *model, struct mpc *c, uint64_t step, bool last)
{
  enum { REGISTERS = 8, SOME = REGISTERS * LANES };
  const uint64_t seed = model->seed;
  const uint32_t whole = c->cells - c->cells % LANES;
  const words lane_cell = lane_records();
  for (uint32_t first = 0; first < whole; first += SOME) {
    const uint32_t left = (whole - first) / LANES, n = left < REGISTERS ? left : REGISTERS;
    struct thermostat_draw drawn[REGISTERS];
    reals normal[REGISTERS];
    for (uint32_t k = 0; k < n; k++)
      drawn[k] = thermostat_draw_lanes(seed, step, lane_cell + (first + k * LANES));
    for (uint32_t k = 0; k < n; k++)
      normal[k] = thermostat_normal_lanes(drawn[k].u, drawn[k].v);
    for (uint32_t k = 0; k < n; k++)
      thermostat_factors_lanes(model, c, step, first + k * LANES, lane_cell + (first + k * LANES), normal[k],
                               drawn[k].decides);
    if (last)
      memset(&c->sum[first], 0, n * LANES * sizeof *c->sum);
  }
  thermostat_canonical(model, c, step, whole);
  if (last)
    memset(&c->sum[whole], 0, (c->cells - whole) * sizeof *c->sum);
  c->sum_is_clear = last;
}

#endif
