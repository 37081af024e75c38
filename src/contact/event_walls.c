#include "contact/event_drift.h"
#include "contact/wall.h"

/* The last tick at which a vertex that flies to a wall is not beyond it; FLIGHT_TICKS if it does not get there. */
static int32_t last_tick(const struct event_drift *d, uint32_t i)
{
  const struct box *box = &d->model->box;
  const int64_t start = d->state->position[i].y, rate = event_rate(d, i).y;
  if (!wall_is_beyond(box, start + rate * FLIGHT_TICKS))
    return FLIGHT_TICKS;
  return (int32_t)(rate < 0 ? start / -rate : (box->edge[1] - start) / rate);
}

bool event_search_wall(const struct event_drift *d, uint32_t i)
{
  const struct event e = {.tick = last_tick(d, i), .bond = i, .other = EVENT_WALL};
  return e.tick == FLIGHT_TICKS || event_queue_push(&d->contact->flights.queue, &e) || event_no_memory(d);
}

bool event_search_walls(const struct event_drift *d)
{
  for (uint32_t i = 0; i < d->state->vertices; i++)
    if (!event_search_wall(d, i))
      return false;
  return true;
}

/* Vertex i goes along the wall. */
static bool slide(const struct event_drift *d, uint32_t i, int32_t tick)
{
  struct point rate = event_rate(d, i);
  rate.y = 0;
  return event_steer(d, i, rate, tick) && event_search_again(d, 1, &i, tick);
}

/* A cluster that moves rigidly goes along a wall that one of its vertices has reached. */
static bool slide_cluster(const struct event_drift *d, uint32_t cluster, int32_t tick)
{
  const struct bend_list *list = &d->contact->flights.bends;
  for (uint32_t k = 0; k < list->count; k++)
    if (list->at[k].cluster == cluster && !slide(d, list->at[k].vertex, tick))
      return false;
  return true;
}

bool event_answer_wall(const struct event_drift *d, const struct event *e)
{
  const uint32_t i = e->bond;
  if (last_tick(d, i) != e->tick)
    return true;
  struct bend_in_path *bend = event_bend(d, i);
  if (!bend)
    return event_no_memory(d);
  if (bend->cluster)
    return slide_cluster(d, bend->cluster, e->tick);
  if (bend->contacts++ >= EVENT_MOST_CONTACTS)
    return slide(d, i, e->tick);
  wall_hit(d->state, d->model, d->frame, event_rate(d, i).y < 0 ? WALL_LOWER : WALL_UPPER, i,
           event_force(d, i, e->tick), event_time(d, e->tick));
  return event_steer_freely(d, i, e->tick) && event_search_again(d, 1, &i, e->tick);
}
