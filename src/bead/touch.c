/* When does a particle touch the bead? In exact integers; ticks are those of flight.c. */
#include <math.h>

#include "bead/flight.h"

__extension__ typedef __int128 wide;

static wide product(struct point a, struct point b)
{
  return (wide)a.x * b.x + (wide)a.y * b.y + (wide)a.z * b.z;
}

/* Square of the distance at a tick, less that of the radius. */
struct gap {
  wide square, along, start; /* of the rate; rate times distance; at tick 0 */
};

static wide gap_at(const struct gap *g, int64_t tick)
{
  return g->start + (2 * g->along + g->square * tick) * tick;
}

/* The gap falls from tick 0, where it is not negative, to tick `inside`, where it is. The root in doubles is next to
 * the tick in nearly all cases. */
static int64_t last_outside(const struct gap *g, int64_t inside)
{
  enum { STEPS = 4 };
  const double a = (double)g->square, b = (double)g->along, c = (double)g->start;
  const double root = fmin(c / (-b + sqrt(fmax(0.0, b * b - a * c))), (double)(inside - 1));
  int64_t low = 0, high = inside, look = root < 1.0 ? 1 : (int64_t)root;
  for (int k = 0; high - low > 1; k++) {
    const bool outside = gap_at(g, look) >= 0;
    *(outside ? &low : &high) = look;
    look = k >= STEPS ? low + (high - low) / 2 : outside ? low + 1 : high - 1;
  }
  return low;
}

/* The paths pass each other by more than doubles can be wrong. */
static bool passes(const struct gap *g)
{
  const double along = (double)g->along;
  return (double)g->start * (double)g->square > along * along * (1.0 + 1e-12);
}

int64_t bead_touch(const struct approach *approach, int64_t radius, int64_t most)
{
  const struct gap g = {product(approach->rate, approach->rate), product(approach->apart, approach->rate),
                        product(approach->apart, approach->apart) - (wide)radius * radius};
  if (g.along >= 0) /* the distance grows from here on */
    return -1;
  if (g.start < 0)
    return 0;
  if (passes(&g))
    return -1;
  const int64_t lowest = (int64_t)(-g.along / g.square < most ? -g.along / g.square : most);
  const int64_t inside = gap_at(&g, lowest) < 0 ? lowest : lowest + 1;
  if (gap_at(&g, inside) >= 0)
    return -1;
  const int64_t tick = last_outside(&g, inside);
  return tick <= most ? tick : -1;
}
