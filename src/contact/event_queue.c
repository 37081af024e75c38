#include "contact/event_queue.h"

#include <stddef.h>

#include "base/memory.h"

static bool before(const struct event *a, const struct event *b)
{
  if (a->tick != b->tick)
    return a->tick < b->tick;
  if (a->bond != b->bond)
    return a->bond < b->bond;
  if (a->other != b->other)
    return a->other < b->other;
  for (int k = 0; k < 3; k++)
    if (a->image[k] != b->image[k])
      return a->image[k] < b->image[k];
  return false;
}

bool event_queue_push(struct event_queue *q, const struct event *event)
{
  if (q->count == q->room && !memory_double((void **)&q->at, &q->room, 64, sizeof *q->at))
    return false;
  uint32_t k = q->count++;
  for (; k > 0 && before(event, &q->at[(k - 1) / 2]); k = (k - 1) / 2)
    q->at[k] = q->at[(k - 1) / 2];
  q->at[k] = *event;
  return true;
}

bool event_queue_pop(struct event_queue *q, struct event *event)
{
  if (q->count == 0)
    return false;
  *event = q->at[0];
  const struct event last = q->at[--q->count];
  uint32_t k = 0;
  for (uint32_t child = 1; child < q->count; child = 2 * k + 1) {
    child += child + 1 < q->count && before(&q->at[child + 1], &q->at[child]);
    if (!before(&q->at[child], &last))
      break;
    q->at[k] = q->at[child];
    k = child;
  }
  q->at[k] = last;
  return true;
}
