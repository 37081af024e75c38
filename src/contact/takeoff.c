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

static struct point end_of_flight(const struct drift_frame *frame, struct vec3 velocity, struct point from)
{
  return flight_place(from, takeoff_rate(frame, velocity, from.y), FLIGHT_TICKS);
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
  return renewals_of_late(state, model, contact, end_of_flight, fault);
}
