/* A sweep as it was: replayed from the events of our tables. */
#include "oracle/swept.h"

#include <string.h>

bool oracle_swept_take(const struct oracle_pair *p, struct swept *w)
{
  w->pair = p;
  w->event = w->hit = *p;
  w->event.ours = oracle_sibling(p, "out.event"), w->event.theirs = oracle_sibling_of_theirs(p, "out.event");
  w->hit.ours = oracle_sibling(p, "out.hit"), w->hit.theirs = oracle_sibling_of_theirs(p, "out.hit");
  w->order = oracle_sibling(p, "in.order");
  w->from = oracle_sibling(p, "in.position"), w->to = oracle_sibling(p, "out.position");
  w->start = oracle_sibling(p, "in.velocity"), w->chain = oracle_model(p, "in.chain");
  return w->event.ours && w->event.theirs && w->hit.ours && w->hit.theirs && w->order && w->from && w->to && w->start &&
         w->chain && w->event.ours->columns == EVENT_COLUMNS && w->event.theirs->columns == EVENT_COLUMNS &&
         w->hit.ours->columns == HIT_COLUMNS && w->hit.theirs->columns == HIT_COLUMNS &&
         w->hit.ours->rows == w->event.ours->rows && w->hit.theirs->rows == w->event.theirs->rows &&
         oracle_is_vectors(w->from, false, 0) && oracle_is_vectors(w->to, false, w->from->rows - 1) &&
         oracle_is_vectors(w->start, true, w->from->rows - 1) && w->chain->rows == w->from->rows;
}

/* --- events ------------------------------------------------------------------------------------------------------ */

bool swept_same_event(const struct pack_table *a, uint32_t row, const struct pack_table *b, uint32_t other)
{
  for (uint32_t k = VERTEX; k < EXECUTED; k++)
    if (pack_value(a, row, k) != pack_value(b, other, k))
      return false;
  return true;
}

uint32_t swept_first_other(const struct swept *w)
{
  uint32_t row = 0;
  while (row < oracle_common_rows(&w->event) && swept_same_event(w->event.ours, row, w->event.theirs, row) &&
         pack_value(w->event.ours, row, EXECUTED) == pack_value(w->event.theirs, row, EXECUTED))
    row++;
  return row;
}
