/* Rings and their Gauss linking numbers, exactly: what all sweeps together must keep. */
#ifndef UNCROSS_TESTS_RINGS_H
#define UNCROSS_TESTS_RINGS_H

#include "exact.h"

__extension__ typedef __int128 int128;

/* Which side of the line through p, q the point r lies on, seen along (3, 2, 7): no image of a ring hides behind it.
 * Exact. */
static inline int side_in_plane(struct point p, struct point q, struct point r)
{
  const int128 qx = 7 * (q.x - p.x) - 3 * (q.z - p.z), qy = 7 * (q.y - p.y) - 2 * (q.z - p.z);
  const int128 rx = 7 * (r.x - p.x) - 3 * (r.z - p.z), ry = 7 * (r.y - p.y) - 2 * (r.z - p.z);
  const int128 area = qx * ry - qy * rx;
  return (area > 0) - (area < 0);
}

/* Twice the Gauss linking number of two rings, the second in an image: signed crossings of their shadows. */
static inline int linking_twice(const struct test_run *r, struct exact_test *x, uint32_t one, uint32_t other,
                                struct point shift)
{
  const struct model *m = &r->model;
  int twice = 0;
  for (uint32_t i = m->fiber_first[one]; i < m->fiber_first[one + 1]; i++)
    for (uint32_t j = m->fiber_first[other]; j < m->fiber_first[other + 1]; j++) {
      const struct point p = r->state.position[i], q = r->state.position[m->next[i]];
      struct point a = r->state.position[j], b = r->state.position[m->next[j]];
      a = (struct point){a.x + shift.x, a.y + shift.y, a.z + shift.z};
      b = (struct point){b.x + shift.x, b.y + shift.y, b.z + shift.z};
      const int sa = side_in_plane(p, q, a), sb = side_in_plane(p, q, b);
      const int sp = side_in_plane(a, b, p), sq = side_in_plane(a, b, q);
      assert_true(sa && sb && sp && sq); /* not by chance, and the start is tilted */
      if (sa != sb && sp != sq)
        twice += exact_orientation(x, p, q, a, b);
    }
  return twice;
}

enum { REACH = 1, IMAGES = 2 * REACH + 1 };

/* Linking of all pairs of rings in all images nearby, a ring with its own images included. */
static inline uint32_t linking_table(const struct test_run *r, struct exact_test *x, int *table)
{
  uint32_t n = 0;
  const int64_t *edge = r->model.box.edge;
  for (uint32_t a = 0; a < r->model.fibers; a++)
    for (uint32_t b = a; b < r->model.fibers; b++)
      for (int k = 0; k < IMAGES * IMAGES * IMAGES; k++) {
        const struct point shift = {(k % IMAGES - REACH) * edge[0], (k / IMAGES % IMAGES - REACH) * edge[1],
                                    (k / IMAGES / IMAGES - REACH) * edge[2]};
        if (a != b || shift.x || shift.y || shift.z)
          table[n++] = linking_twice(r, x, a, b, shift);
      }
  return n;
}

/* Rings 0 and 1 form a Hopf link across the corner of the box (ring 1 is placed an image away), rings 2 and 3 lie about
 * unlinked. All are so large that they touch their images. */
static inline struct test_run linked_rings(double per_cell, double dt, enum exclusion exclusion, bool forbidden,
                                           uint64_t seed)
{
  struct model m = test_model(4, 4, 4, per_cell, dt, 2);
  m.seed = seed;
  m.crossing.exclusion = exclusion;
  m.crossing.forbidden = forbidden;
  m.solvent.thermostat = per_cell > 0.0 ? THERMOSTAT_RESCALE : THERMOSTAT_NONE;
  struct fiber_kind *k = test_add_kind(&m, 4, 14);
  k->ring = true;
  k->bending = 2.0;
  k->start = START_CIRCLE;
  k->placed = 4;
  k->center = malloc(4 * sizeof *k->center);
  k->direction = malloc(4 * sizeof *k->direction);
  const struct vec3 center[4] = {{0.1, 0.2, 4.1}, {1.3 - 4.0, 0.2, 0.1}, {2.2, 2.2, 1.7}, {2.0, 2.6, 3.0}};
  const struct vec3 direction[4] = {{0.1, 0.13, 1}, {0.07, 1, 0.11}, {1, 0.2, 0.3}, {1, 1, 0.17}};
  memcpy(k->center, center, sizeof center);
  memcpy(k->direction, direction, sizeof direction);
  return test_start(m);
}

/* Returns how often the table of linking numbers was found changed. */
static inline uint32_t follow_links(struct test_run *r, uint64_t steps, uint64_t *executed)
{
  struct exact_test x;
  exact_open(&x);
  int start[10 * IMAGES * IMAGES * IMAGES], now[10 * IMAGES * IMAGES * IMAGES];
  const uint32_t n = linking_table(r, &x, start);
  uint32_t links = 0, changed = 0;
  for (uint32_t k = 0; k < n; k++) {
    assert_true(start[k] == 0 || abs(start[k]) == 2);
    links += start[k] != 0;
  }
  print_message("  %u pairs of rings, images included, %u of them linked\n", n, links);
  assert_true(links >= 1);
  for (uint64_t done = 0; done < steps; done += 100) {
    test_steps(r, 100);
    linking_table(r, &x, now);
    for (uint32_t k = 0; k < n; k++)
      assert_true(now[k] % 2 == 0);
    changed += memcmp(now, start, n * sizeof *now) != 0;
  }
  exact_close(&x);
  *executed = r->state.counts.executed;
  return changed;
}

#endif
