/* Rings and their Gauss linking numbers, exactly: what all sweeps together must keep. */
#ifndef UNCROSS_TESTS_RINGS_H
#define UNCROSS_TESTS_RINGS_H

#include "exact.h"
#include "topology/diagram.h"

/* Gauss linking number of two rings, the second in an image: signed crossings of their shadows. */
static inline int linking(const struct test_run *r, uint32_t one, uint32_t other, struct point shift)
{
  const uint32_t *begin = r->model.fiber_first;
  const uint32_t own = begin[one + 1] - begin[one];
  const uint32_t first[3] = {0, own, own + begin[other + 1] - begin[other]};
  struct point *at = malloc(first[2] * sizeof *at);
  for (uint32_t k = 0; k < first[2]; k++) {
    const struct point p = r->state.position[k < own ? begin[one] + k : begin[other] + k - own];
    at[k] = k < own ? p : (struct point){p.x + shift.x, p.y + shift.y, p.z + shift.z};
  }
  struct diagram d = {0};
  int sum[2] = {0, 0};
  assert_int_equal(diagram_make(&d, &(struct polygons){2, first, at}, false, UINT32_MAX), DIAGRAM_FINE);
  for (uint32_t k = 0; k < d.crossings; k++)
    sum[d.crossing[k].member[0]] += d.crossing[k].sign;
  assert_int_equal(sum[0], sum[1]);
  diagram_free(&d);
  free(at);
  return sum[0];
}

enum { MOST_LINKS = 400 };

/* Two rings that are linked, the second in an image. */
struct link {
  uint32_t ring, other;
  int64_t image[3], lk;
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
static inline void link_pair(const struct test_run *r, uint32_t one, uint32_t other, struct links *links)
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
        const int lk = linking(r, one, other, (struct point){i * edge[0], j * edge[1], k * edge[2]});
        links->judged++;
        if (lk == 0)
          continue;
        assert_true(links->n < MOST_LINKS);
        links->link[links->n++] = (struct link){one, other, {i, j, k}, lk};
      }
}

/* All links between rings, those of a ring with its own images included. */
static inline void find_links(const struct test_run *r, struct links *links)
{
  memset(links, 0, sizeof *links);
  for (uint32_t a = 0; a < r->model.fibers; a++)
    for (uint32_t b = a; b < r->model.fibers; b++)
      link_pair(r, a, b, links);
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
  struct links start, now;
  find_links(r, &start);
  assert_true(start.n >= 1);
  f.links = start.n;
  for (; f.steps < steps && steps_until_hot(r, 100); f.steps += 100) {
    find_links(r, &now);
    f.changed += now.n != start.n || memcmp(now.link, start.link, now.n * sizeof *now.link) != 0;
  }
  f.executed = r->state.counts.executed;
  return f;
}

#endif
