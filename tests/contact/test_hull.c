/* Is the origin in the hull of eight points: points made to be on one side of a plane, or to have the origin among
 * their means, small and large, and in every degenerate position. */
#include "contact/hull.h"
#include "dice.h"
#include "support.h"

enum { TRIES = 4000 };

static struct difference draw(struct dice *d, int64_t size)
{
  return (struct difference){dice_integer(d, size), dice_integer(d, size), dice_integer(d, size)};
}

static int128 along(struct difference a, struct difference b)
{
  return (int128)a.x * b.x + (int128)a.y * b.y + (int128)a.z * b.z;
}

/* Points in a plane or on a line through the origin: multiples of one vector, or of two, or of three. */
static struct difference within(struct dice *d, const struct difference basis[3], int dimensions, int64_t size)
{
  struct difference p = {0, 0, 0};
  for (int k = 0; k < dimensions; k++) {
    const int64_t c = dice_integer(d, size);
    p = (struct difference){p.x + c * basis[k].x, p.y + c * basis[k].y, p.z + c * basis[k].z};
  }
  return p;
}

/* Some d has d.x > 0 for all points: by construction. */
static void points_on_one_side(void **unused)
{
  (void)unused;
  struct dice d = {811};
  for (int k = 0; k < TRIES; k++) {
    const int64_t size = k % 3 == 0 ? 3 : k % 3 == 1 ? 1 << 20 : (int64_t)1 << 40;
    const struct difference basis[3] = {draw(&d, size), draw(&d, size), draw(&d, size)}, normal = draw(&d, size);
    struct difference point[HULL_POINTS];
    for (int j = 0; j < HULL_POINTS; j++) {
      int tries = 0;
      do {
        point[j] = within(&d, basis, 1 + k % 3, 5);
        const int128 side = along(point[j], normal);
        if (side < 0)
          point[j] = (struct difference){-point[j].x, -point[j].y, -point[j].z};
        if (side != 0)
          break;
      } while (++tries < 50);
      if (tries == 50)
        point[j] = normal;
    }
    if (along(normal, normal) > 0)
      assert_true(hull_misses_origin(point));
  }
}

/* The origin is a mean of some of the points, with positive weights, and the others are anywhere. */
static void origin_among_them(void **unused)
{
  (void)unused;
  struct dice d = {812};
  for (int k = 0; k < TRIES; k++) {
    const int64_t size = k % 3 == 0 ? 3 : k % 3 == 1 ? 1 << 20 : (int64_t)1 << 40;
    const int parts = 1 + k % 4;
    struct difference point[HULL_POINTS], sum = {0, 0, 0};
    for (int j = 0; j < HULL_POINTS; j++)
      point[j] = draw(&d, size);
    for (int j = 0; j < parts - 1; j++) {
      const int64_t weight = 5 + dice_integer(&d, 4);
      sum = (struct difference){sum.x - weight * point[j].x, sum.y - weight * point[j].y, sum.z - weight * point[j].z};
    }
    const int last = parts - 1 + (int)(dice_u64(&d) % (uint64_t)(HULL_POINTS + 1 - parts));
    point[last] = sum;
    assert_false(hull_misses_origin(point));
    for (int j = parts; j < HULL_POINTS; j++) /* nor without the others */
      if (j != last)
        point[j] = sum;
    assert_false(hull_misses_origin(point));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_on_one_side),
      cmocka_unit_test(origin_among_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
