#include "wall/motion.h"

/* Half steps by which all collisions are early. */
static uint64_t early(const struct model *m)
{
  return m->scheme == SCHEME_DRIFT_SPLIT;
}

/* Without a solvent there are no collisions, and a motion is constant: any number will do. */
static uint64_t half_steps_per_interval(const struct model *m)
{
  return m->solvent.interval_steps > 0 ? 2 * (uint64_t)m->solvent.interval_steps : 2;
}

uint64_t shear_interval(const struct model *m, uint64_t half_steps)
{
  return (half_steps + early(m)) / half_steps_per_interval(m);
}

uint64_t shear_collision_time(const struct model *m, uint64_t collision)
{
  return collision * half_steps_per_interval(m) - early(m);
}

static struct vec3 wall_velocity(const struct model *m, enum wall wall, uint64_t half_intervals)
{
  return vec3_scale(shear_wave(m, half_intervals), wall == WALL_LOWER ? m->walls.lower : m->walls.upper);
}

struct vec3 shear_wall_velocity(const struct model *m, enum wall wall, uint64_t interval)
{
  return wall_velocity(m, wall, 2 * interval + 1);
}

struct vec3 shear_wall_velocity_at_end(const struct model *m, enum wall wall, uint64_t interval)
{
  return wall_velocity(m, wall, 2 * interval + 2);
}

/* --- the sliding image ------------------------------------------------------------------------------------------- */

/* a n mod edge, for a < edge < 2^51: the product is summed bit by bit, as it may need more than 64 bits. */
static uint64_t times_mod(uint64_t a, uint64_t n, uint64_t edge)
{
  uint64_t sum = 0;
  for (; n > 0; n >>= 1) {
    sum = n & 1 ? (sum + a) % edge : sum;
    a = 2 * a % edge;
  }
  return sum;
}

/* The slide of the first n intervals. Intervals of an oscillation repeat after a period. */
static uint64_t slide_of_intervals(const struct model *m, uint64_t n)
{
  const uint64_t edge = (uint64_t)m->box.edge[0], period = m->wave.intervals;
  if (period == 0)
    return times_mod(shear_slide(m, 0), n, edge);
  const uint64_t whole = m->wave.slid[period], rest = m->wave.slid[n % period];
  return (times_mod(whole, n / period, edge) + rest) % edge;
}

/* The slide from the beginning of interval 0, which with drift-split is half a step before the start. */
static uint64_t slide_until(const struct model *m, uint64_t half_steps)
{
  const uint64_t edge = (uint64_t)m->box.edge[0], each = half_steps_per_interval(m), n = half_steps / each;
  const uint64_t whole = times_mod(slide_of_intervals(m, n), each, edge);
  return (whole + times_mod(shear_slide(m, n), half_steps % each, edge)) % edge;
}

int64_t shear_offset(const struct model *m, uint64_t half_steps)
{
  if (!model_is_sheared(m))
    return 0;
  const uint64_t edge = (uint64_t)m->box.edge[0];
  return (int64_t)((slide_until(m, half_steps + early(m)) + edge - slide_until(m, early(m)) + m->shear.slid) % edge);
}

void shear_begin(struct model *m, uint64_t slid)
{
  m->shear.slid = model_is_sheared(m) ? slid % (uint64_t)m->box.edge[0] : 0;
}
