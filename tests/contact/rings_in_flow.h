/* Linking numbers of rings in a sheared box, those of rings with images included. */
#ifndef UNCROSS_TESTS_RINGS_IN_FLOW_H
#define UNCROSS_TESTS_RINGS_IN_FLOW_H

#include "contact/drift.h"
#include "contact/rings.h"

/* The state of a sheared run in sheared coordinates, in which images are the box's own. */
static inline struct test_run in_sheared_coordinates(const struct test_run *r)
{
  struct test_run copy = *r;
  const struct drift_frame f = drift_frame_now(&r->state, &r->model, 1.0, 0, true);
  copy.state.position = malloc(r->state.vertices * sizeof *copy.state.position);
  for (uint32_t i = 0; i < r->state.vertices; i++)
    copy.state.position[i] = f.sheared ? drift_enter(&f, r->state.position[i]) : r->state.position[i];
  return copy;
}

/* Of each pair of rings: number of images in which they are linked, and the sum of their linking numbers and of the
 * squares. Which image is which changes as fibers are taken back into the box. */
struct bonds_of_rings {
  int64_t of[20][20][3];
  uint32_t links;
};

static inline void judge_links(const struct test_run *r, struct bonds_of_rings *sums)
{
  struct test_run straight = in_sheared_coordinates(r);
  struct links *links = malloc(sizeof *links);
  memset(sums, 0, sizeof *sums);
  find_links(&straight, links);
  for (uint32_t k = 0; k < links->n; k++) {
    const struct link *l = &links->link[k];
    int64_t *of = sums->of[l->ring][l->other];
    of[0]++, of[1] += l->lk, of[2] += l->lk * l->lk;
  }
  sums->links = links->n;
  free(links);
  free(straight.state.position);
}

#endif
