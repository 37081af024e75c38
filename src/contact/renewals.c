#include "contact/renewals.h"

#include <string.h>

#include "base/registers.h"
#include "contact/candidates.h"

#define WAIT_MOST (2 * NEIGHBORS_AT_ONCE)
enum { BLOCK = 64 }; /* vertices worked on at a time: bits of a word */

/* --- vertices that wait ------------------------------------------------------------------------------------------ */

struct renewals {
  uint32_t count, vertex[WAIT_MOST]; /* the one that has waited longest comes first */
  struct point from[WAIT_MOST], to[WAIT_MOST];
};

/* How far a vertex at p is inside of its skin, a0; negative if it is outside. */
static double inside_of_skin(const struct neighbors *nb, uint32_t i, struct point p)
{
  return nb->reference[i].skin - vec3_norm(point_difference(p, point_plus(nb->reference[i].at, nb->moved)));
}

/* Vertex i, which ends its move `inside` of its skin, cannot leave it before it has gone that far. */
static void hold_until(struct neighbors *nb, uint32_t i, double inside)
{
  const double left = capsule_least(capsule_most(inside, 0.0), 1.0);
  nb->hold[i] = (uint32_t)(int32_t)(left * (1 << CANDIDATES_UNITS));
}

/* New reference positions for the vertices that have waited longest. */
static bool renew(const struct state *state, const struct model *model, struct contact *contact, struct renewals *r,
                  struct fault *fault)
{
  const uint32_t n = r->count < NEIGHBORS_AT_ONCE ? r->count : NEIGHBORS_AT_ONCE, left = r->count - n;
  if (!neighbors_renew(state, model, contact, n, r->vertex, r->from, r->to, fault))
    return false;
  for (uint32_t k = 0; k < n; k++)
    hold_until(&contact->neighbors, r->vertex[k], inside_of_skin(&contact->neighbors, r->vertex[k], r->to[k]));
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

/* The vertices first .. first + BLOCK - 1 go on by their ranges. Lists those that may leave their skins, and prefetches
 * their data. */
static void list_due(const struct state *state, struct contact *contact, uint32_t first, struct due *restrict due)
{
  const uint32_t rest = first < state->vertices ? state->vertices - first : 0, n = rest < BLOCK ? rest : BLOCK;
  uint32_t left[BLOCK] = {0};
  due->count = 0;
  if (n == 0)
    return;
  const uint32_t *restrict range = &contact->range[first];
  uint32_t *restrict hold = &contact->neighbors.hold[first];
  for (uint32_t k = 0; k < n; k++)
    left[k] = hold[k] -= range[k];
  for (uint64_t late = negatives_of_64(left); late; late &= late - 1) {
    const uint32_t i = first + (uint32_t)__builtin_ctzll(late);
    due->vertex[due->count++] = i;
    __builtin_prefetch(&state->position[i]);
    __builtin_prefetch(&state->position[i].z);
    __builtin_prefetch(&state->velocity[i]);
    __builtin_prefetch(&state->velocity[i].z);
    __builtin_prefetch(&contact->neighbors.reference[i]);
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
      const double inside = inside_of_skin(nb, i, to);
      if (inside >= 0.0)
        hold_until(nb, i, inside);
      else if (!add(state, model, contact, &r, i, from, to, fault))
        return false;
    }
  }
  return finish(state, model, contact, &r, fault);
}
