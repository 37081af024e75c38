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

/* When this vertex has its turn. */
static uint32_t turn_of(const struct swept *w, double vertex)
{
  uint32_t k = 0;
  while (k < w->order->rows && pack_value(w->order, k, 0) != vertex)
    k++;
  return k;
}

double swept_first_mover(const struct swept *w)
{
  const uint32_t row = swept_first_other(w);
  const double ours = row < w->event.ours->rows ? pack_value(w->event.ours, row, VERTEX) : -1.0;
  const double theirs = row < w->event.theirs->rows ? pack_value(w->event.theirs, row, VERTEX) : -1.0;
  return turn_of(w, theirs) < turn_of(w, ours) ? theirs : ours;
}

static bool contains(const struct pack_table *t, const struct pack_table *other, uint32_t row)
{
  for (uint32_t k = 0; k < t->rows; k++)
    if (swept_same_event(t, k, other, row))
      return true;
  return false;
}

/* A row of the first mover's in t that the other table has not; its rows if there is none. */
static uint32_t row_alone(const struct swept *w, const struct pack_table *t, const struct pack_table *other)
{
  const double mover = swept_first_mover(w);
  uint32_t row = 0;
  while (row < t->rows && (pack_value(t, row, VERTEX) != mover || contains(other, t, row)))
    row++;
  return row;
}

bool swept_missed(const struct swept *w, uint32_t *row)
{
  *row = row_alone(w, w->event.ours, w->event.theirs);
  return *row < w->event.ours->rows;
}

bool swept_invented(const struct swept *w, uint32_t *row)
{
  *row = row_alone(w, w->event.theirs, w->event.ours);
  return *row < w->event.theirs->rows;
}

/* --- the state that a move found --------------------------------------------------------------------------------- */

static int64_t next_of(const struct swept *w, int64_t vertex)
{
  return vertex >= 0 && vertex < w->chain->rows ? oracle_model_integer(w->pair, "in.chain", (uint32_t)vertex, 0) : -1;
}

bool swept_vertices(const struct swept *w, const struct pack_table *t, uint32_t row, uint32_t four[4])
{
  const double vertex = pack_value(t, row, VERTEX), moving = pack_value(t, row, MOVING);
  const double standing = pack_value(t, row, STANDING), vertices = w->chain->rows;
  if (!(vertex >= 0.0 && vertex < vertices && moving >= 0.0 && moving < vertices && standing >= 0.0 &&
        standing < vertices))
    return false;
  const int64_t at[4] = {(int64_t)vertex, moving == vertex ? next_of(w, (int64_t)moving) : (int64_t)moving,
                         (int64_t)standing, next_of(w, (int64_t)standing)};
  for (int k = 0; k < 4; k++) {
    if (at[k] < 0 || at[k] >= w->chain->rows)
      return false;
    four[k] = (uint32_t)at[k];
  }
  return true;
}

void swept_levers(const struct swept *w, uint32_t row, bool swapped, double lever[4])
{
  const double s = pack_value(w->hit.ours, row, S), t = pack_value(w->hit.ours, row, S_STANDING);
  const double right[4] = {1.0 - s, s, t - 1.0, -t}, wrong[4] = {s, 1.0 - s, -t, t - 1.0};
  memcpy(lever, swapped ? wrong : right, sizeof right);
}

struct vec3 swept_normal(const struct swept *w, uint32_t row)
{
  return (struct vec3){pack_value(w->hit.ours, row, NORMAL_X), pack_value(w->hit.ours, row, NORMAL_Y),
                       pack_value(w->hit.ours, row, NORMAL_Z)};
}

double swept_mass(const struct swept *w, uint32_t vertex)
{
  const struct pack_table *t = oracle_model(w->pair, "in.vertex");
  return t ? pack_value(t, vertex, 0) : NAN;
}

struct vec3 swept_velocity(const struct swept *w, uint32_t vertex, uint32_t rows, double mover)
{
  struct vec3 v = oracle_vector(w->start, vertex);
  for (uint32_t row = 0; row < rows && row < w->event.ours->rows; row++) {
    uint32_t four[4];
    double lever[4];
    if (pack_value(w->event.ours, row, EXECUTED) == 0.0 || pack_value(w->event.ours, row, VERTEX) == mover ||
        !swept_vertices(w, w->event.ours, row, four))
      continue;
    swept_levers(w, row, false, lever);
    for (int k = 0; k < 4; k++)
      if (four[k] == vertex)
        v = vec3_add_scaled(v, -lever[k] * pack_value(w->hit.ours, row, MOMENTUM) / swept_mass(w, vertex),
                            swept_normal(w, row));
  }
  return v;
}
