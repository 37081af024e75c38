/*
 * A drift reads every vertex, so what is read is kept short: velocities, for ranges. Reference positions
 * are read now and then. A vertex that is `left` inside of its skin cannot leave it before its way has grown by `left`.
 * The path of bond i is a bound on the way of vertex i; so the vertex has a limit, `hold`, and its skin is looked at
 * when the path exceeds it.
 */
#include "contact/takeoff.h"

#include "contact/candidates.h"
#include "contact/renewals.h"

enum { BLOCK = 64 }; /* vertices worked on at a time */

/* a0: a rate is rounded by half a lattice unit along each axis, and flown for all ticks: 2^-25 sqrt(3) at most. */
#define FLIGHT_ROUNDING 0x1p-24

static void ranges_of(const struct vec3 *restrict displacement, uint32_t n, uint32_t *restrict range)
{
  for (uint32_t k = 0; k < n; k++)
    range[k] = candidates_units(vec3_norm(displacement[k]) + FLIGHT_ROUNDING);
}

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

/* New reference positions for those that need them. */
static bool renew_late(const struct state *state, const struct model *model, struct contact *contact,
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
      const struct point from = state->position[i], rate = takeoff_rate(&contact->frame, state->velocity[i], from.y),
                         to = flight_place(from, rate, FLIGHT_TICKS);
      if (neighbors_hold(nb, i, to))
        renewals_hold_until(nb, i, to);
      else if (!renewals_add(state, model, contact, &r, i, from, to, fault))
        return false;
    }
  }
  return renewals_end(state, model, contact, &r, fault);
}

bool take_off(const struct state *state, const struct model *model, struct contact *contact, struct fault *fault)
{
  struct vec3 displacement[BLOCK];
  for (uint32_t first = 0; first < state->vertices; first += BLOCK) {
    const uint32_t n = state->vertices - first < BLOCK ? state->vertices - first : BLOCK;
    if (!drift_displacements(state, model, &contact->frame, first, n, displacement, fault))
      return false;
    ranges_of(displacement, n, &contact->range[first]);
  }
  candidates_lengthen(model, contact);
  return renew_late(state, model, contact, fault);
}
