#include "contact/event_rigid.h"
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

/* Vertex i goes along the wall, and with it all that moves rigidly with it. */
static bool slide(const struct event_drift *d, uint32_t i, uint32_t cluster, int32_t tick)
{
  struct point rate = event_rate(d, i);
  rate.y = 0;
  if (cluster)
    return event_steer_cluster(d, cluster, rate, tick);
  return event_steer(d, i, rate, tick) && event_search_again(d, 1, &i, tick);
}

bool event_answer_wall(const struct event_drift *d, const struct event *e)
{
  const uint32_t i = e->bond;
  if (last_tick(d, i) != e->tick)
    return true;
  struct bend_in_path *bend = event_bend(d, i);
  if (!bend)
    return event_no_memory(d);
  if (bend->cluster || bend->contacts++ >= EVENT_MOST_CONTACTS)
    return slide(d, i, bend->cluster, e->tick);
  wall_hit(d->state, d->model, d->frame, event_rate(d, i).y < 0 ? WALL_LOWER : WALL_UPPER, i,
           event_force(d, i, e->tick), event_time(d, e->tick));
  return event_steer_freely(d, i, e->tick) && event_search_again(d, 1, &i, e->tick);
}
