/* Needles of the pack `contacts` that bugs of images and of clusters need: docs/port/packs.md, *Constructed inputs*. */
#include "oracle/edges.h"
#include "system/state.h"

static void set(struct oracle_stage *g, uint32_t vertex, struct point at, struct vec3 velocity)
{
  g->state->position[vertex] = at;
  g->state->velocity[vertex] = velocity;
}

static struct point in_parts(struct point from, int x, int y, int z)
{
  return point_plus(from, (struct point){x * EDGES_PART, y * EDGES_PART, z * EDGES_PART});
}

void edges_tiny_pair(struct oracle_stage *g, uint32_t first, struct point middle, struct vec3 fly, double drift)
{
  static const struct point place[4] = {{1, -9, -2}, {-2, 2, -5}, {2, 7, 1}, {-7, 2, -11}};
  static const struct vec3 rate[4] = {{3, 2, -2}, {1, 0, 0}, {1, -3, -3}, {-2, 3, 3}};
  for (uint32_t k = 0; k < 4; k++)
    set(g, first + k, point_plus(middle, place[k]), vec3_scale(0x1p-24 / drift, vec3_add(rate[k], fly)));
}

/* Both are nearly half of the shortest edge, along it. They touch with their far ends, so their first ends are further
 * apart than half of the edge: the nearest image of one is not the one that is touched. */
void edges_long_needles(struct oracle_stage *g, uint32_t first, double drift)
{
  const struct point origin = {0, 0, 0};
  const struct vec3 rest = {0, 0, 0}, along = {0.25 / drift, 0, 0};
  set(g, first, in_parts(origin, 30, 40, 3), along);
  set(g, first + 1, in_parts(origin, 30, 40, 26), along);
  set(g, first + 2, in_parts(origin, 32, 45, 44), rest);
  set(g, first + 3, in_parts(origin, 32, 39, 22), rest);
}

/* A pair that falls, and one that rises, at 2^22 lattice units in a tick, and some: the sum of their rates over 4 is no
 * whole number. Each is met by a needle, which then flies with it. At last the two needles meet. */
void edges_joining_clusters(struct oracle_stage *g, uint32_t first, struct point corner, double drift)
{
  const struct vec3 down = {0, -0x1p22, 0}, up = {0, 0x1p22, 0}, faster = {0, 0.5 / drift, 0};
  const struct point low = in_parts(corner, 3, 2, 3), below = {0, -((int64_t)1 << 22) * 21845, 0};
  edges_tiny_pair(g, first, in_parts(corner, 0, 8, 0), down, drift);
  set(g, first + 4, in_parts(corner, 0, 4, -4), faster);
  set(g, first + 5, in_parts(corner, 0, 4, 4), faster);
  edges_tiny_pair(g, first + 6, low, up, drift);
  set(g, first + 10, in_parts(point_plus(low, below), -4, 0, -2), faster);
  set(g, first + 11, in_parts(point_plus(low, below), 4, 0, 2), faster);
}
