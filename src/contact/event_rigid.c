#include "contact/event_rigid.h"

static struct bend_in_path *bend_of(const struct event_drift *d, uint32_t i)
{
  const struct flights *f = &d->contact->flights;
  return &f->bends.at[f->bend_of[i] - 1];
}

bool event_is_rigid(const struct event_drift *d, uint32_t n, const uint32_t *vertex)
{
  for (uint32_t k = 0; k < n; k++)
    if (bend_of(d, vertex[k])->cluster || bend_of(d, vertex[k])->contacts >= EVENT_MOST_CONTACTS)
      return true;
  return false;
}

/* The cluster that these vertices are of from now on: that of the body beside them, that of the first that has one, or
 * a new one. */
static uint32_t choose_cluster(const struct event_drift *d, uint32_t n, const uint32_t *vertex, bool with_body)
{
  const uint32_t of_body = d->contact->beside ? d->contact->beside->cluster : 0;
  uint32_t cluster = with_body ? of_body : 0;
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t its = bend_of(d, vertex[k])->cluster;
    if (its && (!cluster || its == of_body))
      cluster = its;
  }
  return cluster ? cluster : d->contact->flights.bend_of[vertex[0]];
}

/* Its rate, if nothing holds it. */
static struct point free_rate(const struct event_drift *d, uint32_t n, const uint32_t *vertex, uint32_t cluster)
{
  struct point sum = {0, 0, 0};
  const struct timeline *beside = d->contact->beside;
  if (beside && beside->cluster == cluster)
    return beside->rate(d);
  uint32_t k = 0;
  do {
    const struct bend_in_path *bend = bend_of(d, vertex[k]);
    if (bend->cluster == cluster)
      return bend->rate;
    sum = point_plus(sum, bend->rate);
  } while (++k < n);
  return (struct point){sum.x / k, sum.y / k, sum.z / k};
}

static void join(const struct event_drift *d, uint32_t n, const uint32_t *vertex, uint32_t cluster)
{
  const struct bend_list *list = &d->contact->flights.bends;
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t old = bend_of(d, vertex[k])->cluster;
    for (uint32_t m = 0; old && m < list->count; m++)
      if (list->at[m].cluster == old)
        list->at[m].cluster = cluster;
    bend_of(d, vertex[k])->cluster = cluster;
  }
}

static bool holds_one(const struct event_drift *d, uint32_t cluster)
{
  const struct bend_list *list = &d->contact->flights.bends;
  for (uint32_t k = 0; k < list->count; k++)
    if (list->at[k].cluster == cluster && model_is_held(d->model, list->at[k].vertex))
      return true;
  return false;
}

static bool same(struct point a, struct point b)
{
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool event_steer_cluster(const struct event_drift *d, uint32_t cluster, struct point rate, int32_t tick)
{
  const struct bend_list *list = &d->contact->flights.bends;
  for (uint32_t k = 0; k < list->count; k++) {
    const uint32_t i = list->at[k].vertex;
    if (list->at[k].cluster == cluster && !same(list->at[k].rate, rate) &&
        (!event_steer(d, i, rate, tick) || !event_search_again(d, 1, &i, tick)))
      return false;
  }
  return true;
}

bool event_make_rigid(const struct event_drift *d, uint32_t n, const uint32_t *vertex, bool with_body, int32_t tick)
{
  struct timeline *beside = d->contact->beside;
  const uint32_t cluster = choose_cluster(d, n, vertex, with_body);
  if (with_body)
    beside->cluster = cluster;
  struct point rate = free_rate(d, n, vertex, cluster);
  join(d, n, vertex, cluster);
  if (holds_one(d, cluster)) {
    rate = (struct point){0, 0, 0};
    if (beside && beside->cluster == cluster && !beside->hold(d, tick))
      return false;
  }
  d->state->counts.rigid++;
  return event_steer_cluster(d, cluster, rate, tick) && event_search_again(d, n, vertex, tick);
}
