/*
 * Times of collisions, rates and velocities of boundaries, and how far a sheared image has slid (wall/motion.h),
 * against plain sums over half time steps and products in 128 bits.
 */
#include "exact.h"
#include "support.h"
#include "wall/motion.h"

__extension__ typedef __int128 wide;

/* A sheared box with an x edge of 5 a0 and a y edge of 3 a0. Strain 0: a steady rate. */
static struct model box_with(enum scheme scheme, uint32_t interval, double rate, double strain, double period)
{
  struct model m = test_model(5, 3, 2, 2.0, 0.0371, interval);
  m.scheme = scheme;
  m.shear.rate = strain > 0.0 ? 0.0 : rate;
  m.shear.strain = strain;
  m.shear.period = period * m.solvent.collision_interval;
  test_finish(&m);
  return m;
}

/* --- time -------------------------------------------------------------------------------------------------------- */

/* Half steps at which the plain algorithm collides: in the middle of a step with drift-split, else at its end. */
static void intervals_end_at_collisions(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++)
    for (uint32_t each = 1; each < 5; each++) {
      struct model m = box_with(scheme, each, 0.1, 0.0, 0.0);
      uint64_t interval = 0;
      for (uint64_t half = 0; half < 100; half++) {
        const uint64_t last_of_step = 2 * each * (interval + 1);
        const uint64_t collision = scheme == SCHEME_DRIFT_SPLIT ? last_of_step - 1 : last_of_step;
        assert_true(shear_collision_time(&m, interval + 1) == collision);
        interval += half == collision;
        assert_true(shear_interval(&m, half) == interval);
      }
      model_free(&m);
    }
}

/* --- rate -------------------------------------------------------------------------------------------------------- */

/* 2 pi strain/period cos(2 pi t/period) at the middle of intervals, for periods of even and odd length. */
static void rate_is_that_of_the_middle(void **unused)
{
  (void)unused;
  const long double turn = 8.0L * atanl(1.0L);
  for (uint32_t n = 4; n < 40; n++) {
    struct model m = box_with(SCHEME_PAPER, 2, 0.0, 0.07, n);
    const long double period = (long double)m.shear.period;
    for (uint64_t k = 0; k < 3 * n; k++) {
      const long double expected = turn * 0.07L / period * cosl(turn * ((long double)k + 0.5L) / n);
      assert_close(shear_rate(&m, k), (double)expected, 1e-14);
      assert_true(shear_rate(&m, k) == shear_rate(&m, k + 1000000007ull * n));
    }
    model_free(&m);
  }
}

/* Both walls at the middle and at the end of an interval. */
static void walls_follow_the_wave(void **unused)
{
  (void)unused;
  const long double turn = 8.0L * atanl(1.0L);
  struct model m = test_model(5, 3, 2, 2.0, 0.05, 2);
  m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .lower = {-0.2, 0, 0.3}, .upper = {0.4, 0, 0}, .period = 0.7};
  test_finish(&m);
  for (uint64_t k = 0; k < 21; k++) {
    const double middle = (double)cosl(turn * ((long double)k + 0.5L) / 7.0L);
    const double end = (double)cosl(turn * ((long double)k + 1.0L) / 7.0L);
    assert_close(shear_wall_velocity(&m, WALL_LOWER, k).x, -0.2 * middle, 1e-15);
    assert_close(shear_wall_velocity(&m, WALL_LOWER, k).z, 0.3 * middle, 1e-15);
    assert_close(shear_wall_velocity(&m, WALL_UPPER, k).x, 0.4 * middle, 1e-15);
    assert_close(shear_wall_velocity_at_end(&m, WALL_UPPER, k).x, 0.4 * end, 1e-15);
    assert_close(shear_wall_velocity_at_end(&m, WALL_LOWER, k).x, -0.2 * end, 1e-15);
  }
  assert_true(shear_rate(&m, 3) == 0.0 && shear_offset(&m, 12345) == 0);
  model_free(&m);
}

/* --- the sliding image ------------------------------------------------------------------------------------------- */

/* Lattice units by which the image slides in the half step that ends at `half`: its velocity, rate times L, for half a
 * step, rounded. */
static wide slide_of_half_step(const struct model *m, uint64_t half)
{
  const double rate = shear_rate(m, shear_interval(m, half - 1));
  return (wide)llrint(rate * m->box.cells[1] * (0.5 * m->time_step) * 0x1p40);
}

static int64_t folded(wide x, int64_t edge)
{
  const wide r = x % edge;
  return (int64_t)(r < 0 ? r + edge : r);
}

/* Steady and oscillating, forwards and backwards, every scheme, half step by half step. A half step belongs to the
 * interval in which it begins. */
static void offset_is_the_sum_of_slides(void **unused)
{
  (void)unused;
  const double rates[] = {0.3, -0.3, 1.9, -1e-9};
  for (int scheme = 0; scheme < SCHEMES; scheme++)
    for (uint32_t each = 1; each < 4; each++)
      for (int k = 0; k < 8; k++) {
        struct model m = box_with(scheme, each, rates[k % 4], k < 4 ? 0.0 : 0.01 * k, k < 4 ? 0.0 : 2.0 * k - 1.0);
        wide sum = 0;
        assert_true(shear_offset(&m, 0) == 0);
        for (uint64_t half = 1; half < 400; half++) {
          sum += slide_of_half_step(&m, half);
          if (shear_offset(&m, half) != folded(sum, m.box.edge[0]))
            fail_msg("scheme %d, %u steps, case %d: offset at %lu", scheme, each, k, (unsigned long)half);
        }
        model_free(&m);
      }
}

/* After 10^12 steps, where velocity times time in doubles would be off by 10^-4 a0. */
static void nothing_is_lost_in_long_times(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4101)};
  for (int scheme = 0; scheme < SCHEMES; scheme++) {
    struct model m = box_with(scheme, 3, 1.7, 0.0, 0.0);
    for (int k = 0; k < 100; k++) {
      const uint64_t half = 2000000000000ull + dice_u64(&d) % 1000000;
      assert_true(shear_offset(&m, half) == folded((wide)half * slide_of_half_step(&m, 1), m.box.edge[0]));
    }
    model_free(&m);
    m = box_with(scheme, 3, 0.0, 0.3, 11.0);
    const uint64_t period = 2 * 3 * 11, periods = 2000000000000ull / period;
    wide of_period = 0, rest = 0;
    for (uint64_t half = 1; half <= period; half++)
      of_period += slide_of_half_step(&m, half);
    for (uint64_t half = 1; half <= 3 * period; half++) {
      rest += slide_of_half_step(&m, half);
      assert_true(shear_offset(&m, periods * period + half) == folded(of_period * periods + rest, m.box.edge[0]));
    }
    model_free(&m);
  }
}

/* The offset of an oscillation is the strain, g0 sin(2 pi t/period), times L: to second order in the interval, which
 * makes the amplitude larger by (omega tau)^2/24. */
static void offset_is_the_strain(void **unused)
{
  (void)unused;
  struct model m = box_with(SCHEME_KICK_SPLIT, 1, 0.0, 0.2, 100.0);
  const double turn = 8.0 * atan(1.0), grows = 1.0 + turn * turn / (24.0 * 1e4);
  for (uint64_t k = 0; k <= 300; k++) {
    int64_t offset = shear_offset(&m, shear_collision_time(&m, k));
    offset -= 2 * offset > m.box.edge[0] ? m.box.edge[0] : 0;
    assert_close((double)offset * LATTICE_UNIT, 3.0 * 0.2 * grows * sin(turn * (double)k / 100.0), 1e-6);
  }
  model_free(&m);
}

/* Images that begin elsewhere are elsewhere by as much at all times; a box that is not sheared has none. */
static void images_begin_where_a_snapshot_has_them(void **unused)
{
  (void)unused;
  const uint64_t begins[] = {0, 1, 12345678901, 5 * (uint64_t)LATTICE_CELL - 1, 5 * (uint64_t)LATTICE_CELL, UINT64_MAX};
  for (int scheme = 0; scheme < SCHEMES; scheme++)
    for (int k = 0; k < 6; k++) {
      struct model m = box_with(scheme, 2, -0.3, k < 3 ? 0.0 : 0.02, k < 3 ? 0.0 : 5.0);
      shear_begin(&m, begins[k]);
      wide sum = begins[k];
      for (uint64_t half = 0; half < 40; sum += slide_of_half_step(&m, ++half))
        assert_true(shear_offset(&m, half) == folded(sum, m.box.edge[0]));
      model_free(&m);
    }
  struct model still = box_with(SCHEME_PAPER, 2, 0.0, 0.0, 0.0);
  shear_begin(&still, 7);
  assert_true(shear_offset(&still, 0) == 0 && still.shear.slid == 0);
  model_free(&still);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(intervals_end_at_collisions),
      cmocka_unit_test(rate_is_that_of_the_middle),
      cmocka_unit_test(walls_follow_the_wave),
      cmocka_unit_test(offset_is_the_sum_of_slides),
      cmocka_unit_test(nothing_is_lost_in_long_times),
      cmocka_unit_test(offset_is_the_strain),
      cmocka_unit_test(images_begin_where_a_snapshot_has_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
