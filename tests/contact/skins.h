/* Skins of vertices (contact/renewals.h) after a drift, in a box that is not sheared. */
#ifndef UNCROSS_TESTS_SKINS_H
#define UNCROSS_TESTS_SKINS_H

#include "contact/neighbors.h"
#include "support.h"

/* Every vertex is within its skin; and while its skin need not be looked at for some way, it is at least as far from
 * leaving it. Returns the number of vertices that need not be looked at. */
static inline uint64_t check_skins(const struct test_run *r)
{
  const struct neighbors *nb = &r->work.contact.neighbors;
  uint64_t waiting = 0;
  for (uint32_t v = 0; v < r->state.vertices; v++) {
    const struct reference_position *reference = &nb->reference[v];
    const double off = vec3_norm(point_difference(r->state.position[v], point_plus(reference->at, nb->moved)));
    const uint32_t left = nb->hold[v];
    if (!(off <= reference->skin + 1e-12))
      fail_msg("vertex %u has left its skin: %g of %g a0", v, off, reference->skin);
    assert_true(left <= 1u << 20);
    if (left > 0 && !(off + left * 0x1p-20 <= reference->skin + 1e-12))
      fail_msg("vertex %u is %g a0 off, of %g, and need not be looked at for %g", v, off, reference->skin,
               left * 0x1p-20);
    waiting += left > 0;
  }
  return waiting;
}

#endif
