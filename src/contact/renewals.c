#include "contact/renewals.h"

#include <math.h>
#include <string.h>

#include "contact/candidates.h"

void renewals_hold_until(struct neighbors *nb, uint32_t i, struct point to)
{
  const double off = vec3_norm(point_difference(to, point_plus(nb->reference[i].at, nb->moved)));
  const double left = fmin(fmax(nb->reference[i].skin - off, 0.0), 1.0);
  nb->hold[i] = nb->path[i] + (uint32_t)(int32_t)(left * (1 << CANDIDATES_UNITS));
}

/* New reference positions for the vertices that have waited longest. */
static bool renew(const struct state *state, const struct model *model, struct contact *contact, struct renewals *r,
                  struct fault *fault)
{
  const uint32_t n = r->count < NEIGHBORS_AT_ONCE ? r->count : NEIGHBORS_AT_ONCE, left = r->count - n;
  if (!neighbors_renew(state, model, contact, n, r->vertex, r->from, r->to, fault))
    return false;
  for (uint32_t k = 0; k < n; k++)
    renewals_hold_until(&contact->neighbors, r->vertex[k], r->to[k]);
  memmove(r->vertex, &r->vertex[n], left * sizeof *r->vertex);
  memmove(r->from, &r->from[n], left * sizeof *r->from);
  memmove(r->to, &r->to[n], left * sizeof *r->to);
  r->count = left;
  return true;
}

bool renewals_add(const struct state *state, const struct model *model, struct contact *contact, struct renewals *r,
                  uint32_t i, struct point from, struct point to, struct fault *fault)
{
  neighbors_fetch(&contact->neighbors, model, i);
  r->vertex[r->count] = i, r->from[r->count] = from, r->to[r->count] = to;
  return ++r->count < RENEWALS_MOST || renew(state, model, contact, r, fault);
}

bool renewals_end(const struct state *state, const struct model *model, struct contact *contact, struct renewals *r,
                  struct fault *fault)
{
  while (r->count > 0)
    if (!renew(state, model, contact, r, fault))
      return false;
  return true;
}
