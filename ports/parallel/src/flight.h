// When two bonds in flight may touch: docs/port/contacts.md, *The search*.
#pragma once

#include "model.h"

constexpr int64_t ticks = 65536;

// Differences p, q, w of a pair of bonds at tick 0, and what they change by in a tick.
struct Flight3 {
  Point p, q, w, p_rate, q_rate, w_rate;
};

// The first tick from `from` that is not excluded; `ticks` if there is none.
int64_t first_contact(const Flight3 &flight, int64_t from);

// Sign of the exact (a x b).c
int sign_of_volume(Point a, Point b, Point c);
// The exact (a x b).c, above and below 2^64: high 2^64 + low.
__extension__ typedef __int128 Whole;
struct Wide {
  Whole high;
  uint64_t low;
};
Wide exact_volume(Point a, Point b, Point c);

ANYWHERE Point at_tick(Point place, Point rate, int64_t tick)
{
  return place + tick * rate;
}
