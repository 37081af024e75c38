#include "oracle/edges_touch.h"

#include "contact/shape.h"
#include "contact/tube.h"

/* Bodies that would just pass by are made thicker, so that they graze: by so much that they touch in depth 2^graze. */
static bool make_grazing(struct oracle_search *s, int64_t least, int graze)
{
  int64_t passes = least, touches = s->reach;
  if (tube_contact(&s->pair, touches, 0) == FLIGHT_TICKS || tube_contact(&s->pair, passes, 0) < FLIGHT_TICKS)
    return false;
  while (touches - passes > 1) {
    const int64_t middle = passes + (touches - passes) / 2;
    *(tube_contact(&s->pair, middle, 0) < FLIGHT_TICKS ? &touches : &passes) = middle;
  }
  s->reach = touches + ((int64_t)1 << graze);
  return s->reach > (int64_t)1 << 34;
}

static bool is_wanted(const struct edges_touch *k, struct oracle_search *s)
{
  if (k->graze > 0 && !make_grazing(s, k->least, k->graze))
    return false;
  const int32_t tick = tube_contact(&s->pair, s->reach, 0);
  return oracle_search_is_legal(&s->pair, 0.0) && tube_excluded(&s->pair, s->reach, 0, 0) && tick > 0 &&
         tick < FLIGHT_TICKS - 1;
}

uint32_t edges_add_touches(struct dice *d, const struct edges_touch *wanted, struct oracle_search *search, uint32_t n)
{
  enum { TRIES = 4000 };
  const uint32_t end = n + wanted->rows;
  for (int tries = 0; n < end && tries < TRIES; tries++) {
    search[n] = wanted->draw(d, wanted->kind);
    n += is_wanted(wanted, &search[n]);
  }
  return n;
}

uint32_t edges_add_at_rest(struct oracle_search *search, uint32_t n)
{
  for (uint32_t k = 0; k < EDGES_AT_REST; k++) {
    struct oracle_search s = search[k];
    s.pair.p_rate = s.pair.q_rate = s.pair.w_rate = (struct point){0, 0, 0};
    if (k % 2)
      s.pair.w = (struct point){s.reach / 2, 0, 0};
    search[n++] = s;
  }
  return n;
}
