#include "contact/renewals.h"

#include <math.h>
#include <string.h>

#include "contact/candidates.h"

#define WAIT_MOST (2 * NEIGHBORS_AT_ONCE)
enum { BLOCK = 64 }; /* vertices worked on at a time */

/* --- vertices that wait ------------------------------------------------------------------------------------------ */

struct renewals {
  uint32_t count, vertex[WAIT_MOST]; /* the one that has waited longest comes first */
  struct point from[WAIT_MOST], to[WAIT_MOST];
};

/* Vertex i, which ends its move at `to` within its skin, cannot leave it before its path has grown by what is left of
 * it. */
static void hold_until(struct neighbors *nb, uint32_t i, struct point to)
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
    hold_until(&contact->neighbors, r->vertex[k], r->to[k]);
  memmove(r->vertex, &r->vertex[n], left * sizeof *r->vertex);
  memmove(r->from, &r->from[n], left * sizeof *r->from);
  memmove(r->to, &r->to[n], left * sizeof *r->to);
  r->count = left;
  return true;
}

/* Vertex i is about to leave its skin by a straight move. If WAIT_MOST vertices wait, the first NEIGHBORS_AT_ONCE of
 * them take new reference positions. */
static bool add(const struct state *state, const struct model *model, struct contact *contact, struct renewals *r,
                uint32_t i, struct point from, struct point to, struct fault *fault)
{
  neighbors_fetch(&contact->neighbors, model, i);
  r->vertex[r->count] = i, r->from[r->count] = from, r->to[r->count] = to;
  return ++r->count < WAIT_MOST || renew(state, model, contact, r, fault);
}

/* All vertices that wait take new reference positions. */
static bool finish(const struct state *state, const struct model *model, struct contact *contact, struct renewals *r,
                   struct fault *fault)
{
  while (r->count > 0)
    if (!renew(state, model, contact, r, fault))
      return false;
  return true;
}

/* --- who is late ------------------------------------------------------------------------------------------------- */

/* Vertices whose skins have to be looked at. */
struct due {
  uint32_t count, vertex[BLOCK];
};

/* Lists the vertices among first .. first + BLOCK - 1 whose paths exceed their limits, and prefetches their data. */
static void list_due(const struct state *state, const struct contact *contact, uint32_t first, struct due *restrict due)
{
  const uint32_t left = first < state->vertices ? state->vertices - first : 0, n = left < BLOCK ? left : BLOCK;
  const uint32_t *restrict path = contact->neighbors.path, *restrict hold = contact->neighbors.hold;
  due->count = 0;
  for (uint32_t i = first; i < first + n; i++) {
    due->vertex[due->count] = i;
    due->count += (hold[i] - path[i]) >> 31; /* less than 0 */
  }
  for (uint32_t k = 0; k < due->count; k++) {
    __builtin_prefetch(&state->position[due->vertex[k]]);
    __builtin_prefetch(&state->position[due->vertex[k]].z);
    __builtin_prefetch(&state->velocity[due->vertex[k]]);
    __builtin_prefetch(&state->velocity[due->vertex[k]].z);
    __builtin_prefetch(&contact->neighbors.reference[due->vertex[k]]);
  }
}

bool renewals_of_late(const struct state *state, const struct model *model, struct contact *contact, end_of_move *end,
                      struct fault *fault)
{
  struct neighbors *nb = &contact->neighbors;
  struct renewals r;
  struct due due[2] = {{0, {0}}, {0, {0}}};
  uint32_t now = 0;
  r.count = 0;
  list_due(state, contact, 0, &due[now]);
  for (uint32_t first = 0; first < state->vertices; first += BLOCK, now = !now) {
    list_due(state, contact, first + BLOCK, &due[!now]);
    for (uint32_t k = 0; k < due[now].count; k++) {
      const uint32_t i = due[now].vertex[k];
      const struct point from = state->position[i], to = end(&contact->frame, state->velocity[i], from);
      if (neighbors_hold(nb, i, to))
        hold_until(nb, i, to);
      else if (!add(state, model, contact, &r, i, from, to, fault))
        return false;
    }
  }
  return finish(state, model, contact, &r, fault);
}
