/* The contacts that are to come in a drift, the earliest first. */
#ifndef UNCROSS_CONTACT_EVENT_QUEUE_H
#define UNCROSS_CONTACT_EVENT_QUEUE_H

#include <stdbool.h>
#include <stdint.h>

/* Bonds and image as in struct candidate. version: that of both bonds' flights when it was found. */
struct event {
  int32_t tick;
  uint32_t bond, other;
  int32_t image[3]; /* of the other bond */
  uint32_t version;
};

struct event_queue {
  uint32_t count, room;
  struct event *at; /* a binary heap */
};

/* False if memory is short. */
bool event_queue_push(struct event_queue *queue, const struct event *event);

/* Takes the earliest event; at equal ticks that of the least numbers, so that the order never depends on the order in
 * which events came. False if there is none. */
bool event_queue_pop(struct event_queue *queue, struct event *event);

#endif
