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

enum { MOST_LINKS = 400 };

/* Two rings that are linked, the second in an image. */
struct link {
  uint32_t ring, other;
  int64_t image[3], twice;
};

struct links {
  uint32_t n;
  uint64_t judged; /* pairs and images whose boxes overlap */
  struct link link[MOST_LINKS];
};

static inline void ring_extent(const struct test_run *r, uint32_t ring, int64_t low[3], int64_t high[3])
{
  for (int c = 0; c < 3; c++) {
    low[c] = INT64_MAX;
    high[c] = INT64_MIN;
  }
  for (uint32_t v = r->model.fiber_first[ring]; v < r->model.fiber_first[ring + 1]; v++) {
    const int64_t at[3] = {r->state.position[v].x, r->state.position[v].y, r->state.position[v].z};
    for (int c = 0; c < 3; c++) {
      low[c] = at[c] < low[c] ? at[c] : low[c];
      high[c] = at[c] > high[c] ? at[c] : high[c];
    }
  }
}

/* Linking of one pair in all images in which the boxes around them overlap. */
static inline void link_pair(const struct test_run *r, struct exact_test *x, uint32_t one, uint32_t other,
                             struct links *links)
{
  int64_t low[3], high[3], low2[3], high2[3], from[3], to[3];
  const int64_t *edge = r->model.box.edge;
  ring_extent(r, one, low, high);
  ring_extent(r, other, low2, high2);
  for (int c = 0; c < 3; c++) {
    from[c] = -floor_divide(high2[c] - low[c], edge[c]);
    to[c] = floor_divide(high[c] - low2[c], edge[c]);
  }
  for (int64_t i = from[0]; i <= to[0]; i++)
    for (int64_t j = from[1]; j <= to[1]; j++)
      for (int64_t k = from[2]; k <= to[2]; k++) {
        if (one == other && i == 0 && j == 0 && k == 0)
          continue;
        const int twice = linking_twice(r, x, one, other, (struct point){i * edge[0], j * edge[1], k * edge[2]});
        assert_true(twice % 2 == 0);
        links->judged++;
        if (twice == 0)
          continue;
        assert_true(links->n < MOST_LINKS);
        links->link[links->n++] = (struct link){one, other, {i, j, k}, twice};
      }
}

/* All links between rings, those of a ring with its own images included. */
static inline void find_links(const struct test_run *r, struct exact_test *x, struct links *links)
{
  memset(links, 0, sizeof *links);
  for (uint32_t a = 0; a < r->model.fibers; a++)
    for (uint32_t b = a; b < r->model.fibers; b++)
      link_pair(r, x, a, b, links);
}

/* A model of rings that start at these places. */
static inline struct model ring_model(int cells, double per_cell, double dt, uint32_t rings, uint32_t vertices,
                                      const struct vec3 *center, const struct vec3 *direction)
{
  struct model m = test_model(cells, cells, cells, per_cell, dt, 2);
  m.solvent.thermostat = per_cell > 0.0 ? THERMOSTAT_RESCALE : THERMOSTAT_NONE;
  struct fiber_kind *k = test_add_kind(&m, rings, vertices);
  k->ring = true;
  k->bending = 2.0;
  k->start = START_CIRCLE;
  k->placed = rings;
  k->place = malloc(rings * sizeof *k->place);
  for (uint32_t i = 0; i < rings; i++)
    k->place[i] = (struct fiber_place){center[i], direction[i]};
  return m;
}

/* Three rings in a chain across the corner of the box, and a fourth about them. */
static inline struct model chain(double per_cell, double dt)
{
  const struct vec3 center[4] = {{0.1, 0.1, 0.1}, {1.3, 0.1, 0.2}, {2.5 - 4.0, 0.2, 4.1}, {2.0, 2.3, 2.2}};
  const struct vec3 direction[4] = {{0.1, 0.13, 1}, {0.07, 1, 0.11}, {0.12, 0.09, 1}, {1, 1, 0.17}};
  return ring_model(4, per_cell, dt, 4, 14, center, direction);
}

/* Rings 0 and 1 form a Hopf link across the corner of the box (ring 1 is placed an image away), rings 2 and 3 lie about
 * unlinked. All are so large that they touch their images. */
static inline struct model pairs(double per_cell, double dt)
{
  const struct vec3 center[4] = {{0.1, 0.2, 4.1}, {1.3 - 4.0, 0.2, 0.1}, {2.2, 2.2, 1.7}, {2.0, 2.6, 3.0}};
  const struct vec3 direction[4] = {{0.1, 0.13, 1}, {0.07, 1, 0.11}, {1, 0.2, 0.3}, {1, 1, 0.17}};
  return ring_model(4, per_cell, dt, 4, 14, center, direction);
}

/* Sixteen rings at random in a box hardly wider than one. */
static inline struct model dense_rings(double per_cell, double dt)
{
  struct vec3 center[16], direction[16];
  struct dice d = {2601};
  for (int k = 0; k < 16; k++) {
    center[k].x = dice_between(&d, 0, 3);
    center[k].y = dice_between(&d, 0, 3);
    center[k].z = dice_between(&d, 0, 3);
    direction[k] = dice_direction(&d);
  }
  return ring_model(3, per_cell, dt, 16, 10, center, direction);
}

/* As test_steps; but where no solvent takes the heat of the exchanges, a run that becomes too hot ends early: that is
 * told, and false returned. */
static inline bool steps_until_hot(struct test_run *r, uint64_t steps)
{
  for (uint64_t k = 0; k < steps; k++)
    if (!step_advance(&r->state, &r->model, &r->work, NULL)) {
      char text[512];
      fault_describe(&r->work.fault, text, sizeof text);
      if (r->model.solvent.thermostat != THERMOSTAT_NONE || r->work.fault.code == FAULT_NO_MEMORY)
        fail_msg("%s", text);
      print_message("  seed %lu, dt %g, no thermostat: stopped by its own heat at %s\n", (unsigned long)r->model.seed,
                    r->model.time_step, text);
      return false;
    }
  return true;
}

struct followed {
  uint64_t steps;    /* made: fewer than asked for if the run became too hot */
  uint64_t executed; /* crossings prevented */
  uint32_t links;    /* that there are */
  uint32_t changed;  /* how often the links were found changed: looked at every 100 steps */
};

static inline struct followed follow_links(struct test_run *r, uint64_t steps)
{
  struct followed f = {0};
  struct exact_test x;
  exact_open(&x);
  struct links start, now;
  find_links(r, &x, &start);
  assert_true(start.n >= 1);
  f.links = start.n;
  for (; f.steps < steps && steps_until_hot(r, 100); f.steps += 100) {
    find_links(r, &x, &now);
    f.changed += now.n != start.n || memcmp(now.link, start.link, now.n * sizeof *now.link) != 0;
  }
  exact_close(&x);
  f.executed = r->state.counts.executed;
  return f;
}

#endif
