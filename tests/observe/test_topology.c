/* Crossings that a run counts: by hand. Against frames of whole runs: tests/topology/test_observed.py. */
#include "tables.h"

#include "observe/observe.h"
#include "topology/pair.h"

/* Two rods, a chain of three vertices, and two frozen rods. */
enum { ROD, OTHER = 2, CHAIN = 4, FROZEN = 7, FROZEN_OTHER = 9, VERTICES = 11, BONDS = 6 };

static struct test_run rods(enum boundary_kind along_y)
{
  struct model m = test_model(8, 8, 8, 2, 0.1, 1);
  test_add_kind(&m, 2, 2);
  test_add_kind(&m, 1, 3);
  test_add_kind(&m, 2, 2)->frozen = along_y == BOUNDARY_PERIODIC;
  m.crossing.forbidden = false;
  m.walls.kind = along_y == BOUNDARY_WALL ? WALL_NO_SLIP : WALL_ABSENT;
  struct test_run r = test_start(m);
  assert_int_equal(r.model.vertices, VERTICES);
  assert_int_equal(r.model.bonds, BONDS);
  return r;
}

static struct point place(double x, double y, double z)
{
  return point_move((struct point){0, 0, 0}, (struct vec3){x, y, z});
}

/* All far from each other: the rod along x, the other along y. */
static void set_out(struct test_run *r)
{
  struct point *x = r->state.position;
  x[ROD] = place(1, 1, 1), x[ROD + 1] = place(2, 1, 1);
  x[OTHER] = place(1.5, 0.5, 3), x[OTHER + 1] = place(1.5, 1.5, 3);
  x[CHAIN] = place(5, 5, 5), x[CHAIN + 1] = place(5.5, 5, 5), x[CHAIN + 2] = place(6, 5, 5);
  x[FROZEN] = place(1, 6, 6), x[FROZEN + 1] = place(2, 6, 6);
  x[FROZEN_OTHER] = place(1.5, 6, 6), x[FROZEN_OTHER + 1] = place(2.5, 6, 6); /* lies on it */
}

static void lift(struct test_run *r, int first, double to)
{
  for (int k = 0; k < 2; k++)
    r->state.position[first + k].z = lattice_from_a0(to);
}

static void look(struct observers *o, struct test_run *r, uint64_t step)
{
  r->state.step = step;
  assert_true(observers_sample(o, &r->model, &r->state, NULL));
}

struct expected {
  double intervals, crossed, net, odd_pairs, unsure;
};

static void expect(struct observers *o, struct test_run *r, struct expected e)
{
  struct kept *kept = keep_summaries(o, &r->model);
  assert_close(kept_value(kept, "topology", 0, "intervals"), e.intervals, 0);
  assert_close(kept_value(kept, "topology", 0, "crossed"), e.crossed, 0);
  assert_close(kept_value(kept, "topology", 0, "net"), e.net, 0);
  assert_close(kept_value(kept, "topology", 0, "odd_pairs"), e.odd_pairs, 0);
  assert_close(kept_value(kept, "topology", 0, "unsure"), e.unsure, 0);
  free(kept);
}

static struct observers *every(struct test_run *r, uint64_t steps, uint64_t from)
{
  struct observe_plan plan = {.from = from};
  plan.every[OBSERVE_TOPOLOGY] = steps;
  struct observers *o = observers_create(&plan, &r->model);
  assert_non_null(o);
  return o;
}

/* The other rod falls through the first, half a unit of 2.1 into an interval of two steps, and comes back. */
static void through_and_back(void **unused)
{
  (void)unused;
  struct test_run r = rods(BOUNDARY_PERIODIC);
  struct observers *o = every(&r, 2, 0);
  set_out(&r);
  lift(&r, OTHER, 1.5);
  look(o, &r, 0);
  expect(o, &r, (struct expected){0, 0, 0, 0, 0});
  lift(&r, OTHER, -0.6);
  look(o, &r, 2);
  expect(o, &r, (struct expected){1, 1, -1, 1, 0});
  look(o, &r, 2); /* once more: counts once */
  look(o, &r, 3); /* not due */
  lift(&r, OTHER, 1.5);
  look(o, &r, 4);
  expect(o, &r, (struct expected){2, 2, 0, 2, 0});
  struct kept *kept = keep_summaries(o, &r.model);
  assert_close(kept_value(kept, "topology", 0, "first_time"), 0.1 * 2 * 0.5 / 2.1, 1e-7);
  assert_close(kept_value(kept, "topology", 0, "last_time"), 0.1 * (2 + 2 * 1.6 / 2.1), 1e-7);
  assert_close(kept_value(kept, "topology", 0, "rate"), 2.0 / (BONDS * 0.4), 1e-12);
  assert_true(kept_value(kept, "topology", 0, "looked_at") >= 2.0);
  free(kept);
  observers_free(o);
  test_end(&r);
}

/* The same where the rod is the image beyond a face; there is none beyond a wall. */
static void through_an_image(void **unused)
{
  (void)unused;
  for (int wall = 0; wall < 2; wall++) {
    struct test_run r = rods(wall ? BOUNDARY_WALL : BOUNDARY_PERIODIC);
    struct observers *o = every(&r, 1, 0);
    set_out(&r);
    lift(&r, FROZEN_OTHER, 6.5); /* between walls nothing is frozen */
    for (int k = 0; k < 2; k++)
      r.state.position[OTHER + k].y += r.model.box.edge[1];
    lift(&r, OTHER, 1.5);
    look(o, &r, 0);
    lift(&r, OTHER, 0.4);
    look(o, &r, 1);
    expect(o, &r, (struct expected){1, !wall, -!wall, !wall, 0});
    observers_free(o);
    test_end(&r);
  }
}

/* Arrives in one interval and leaves in the next: special, and so unsure in both. A fold of neighbors is nothing, and
 * frozen rods that lie on each other are nothing. */
static void special_places(void **unused)
{
  (void)unused;
  struct test_run r = rods(BOUNDARY_PERIODIC);
  struct observers *o = every(&r, 1, 0);
  set_out(&r);
  lift(&r, OTHER, 2);
  look(o, &r, 0);
  lift(&r, OTHER, 1);
  look(o, &r, 1);
  expect(o, &r, (struct expected){1, 0, 0, 0, 1});
  lift(&r, OTHER, 0);
  look(o, &r, 2);
  expect(o, &r, (struct expected){2, 0, 0, 0, 2});
  r.state.position[CHAIN + 2] = place(5.2, 5, 5);
  look(o, &r, 3);
  expect(o, &r, (struct expected){3, 0, 0, 0, 2});
  observers_free(o);
  test_end(&r);
}

/* A rod that goes through a frozen one crosses. */
static void through_a_frozen_rod(void **unused)
{
  (void)unused;
  struct test_run r = rods(BOUNDARY_PERIODIC);
  struct observers *o = every(&r, 1, 0);
  set_out(&r);
  r.state.position[OTHER] = place(1.25, 5.5, 6.5);
  r.state.position[OTHER + 1] = place(1.25, 6.5, 6.5);
  look(o, &r, 0);
  lift(&r, OTHER, 5.4);
  look(o, &r, 1);
  expect(o, &r, (struct expected){1, 1, -1, 1, 0});
  observers_free(o);
  test_end(&r);
}

/* What happens before `from`, or between samples that are further apart than `every`, is not counted. */
static void only_from_sample_to_sample(void **unused)
{
  (void)unused;
  struct test_run r = rods(BOUNDARY_PERIODIC);
  struct observers *o = every(&r, 2, 4);
  set_out(&r);
  for (uint64_t step = 0; step <= 8; step += 2) {
    lift(&r, OTHER, step % 4 ? -0.6 : 1.5);
    look(o, &r, step);
  }
  expect(o, &r, (struct expected){2, 2, 0, 2, 0}); /* 4 to 6, 6 to 8 */
  lift(&r, OTHER, -0.6);
  look(o, &r, 12); /* the sample of step 10 was damaged */
  expect(o, &r, (struct expected){2, 2, 0, 2, 0});
  lift(&r, OTHER, 1.5);
  look(o, &r, 14);
  expect(o, &r, (struct expected){3, 3, 1, 3, 0});
  observers_free(o);
  test_end(&r);
}

/* Beyond what can be searched, each bond of the interval is unsure. */
static void out_of_reach(void **unused)
{
  (void)unused;
  struct test_run r = rods(BOUNDARY_PERIODIC);
  struct observers *o = every(&r, 1, 0);
  set_out(&r);
  look(o, &r, 0);
  for (int k = 0; k < 2; k++)
    r.state.position[OTHER + k].x += (int64_t)1 << 59;
  look(o, &r, 1);
  expect(o, &r, (struct expected){1, 0, 0, 0, BONDS});
  observers_free(o);
  test_end(&r);
}

/* Lines that meet 10^-9 of a bond beyond its end, or before it: both are certain. */
static void ends_are_seen_closely(void **unused)
{
  (void)unused;
  const double bond = 0x1p39;
  for (int beyond = 0; beyond < 2; beyond++)
    for (int k = 1; k < 200; k++) {
      const double turn = 0x1p30 * k, end = bond * (beyond ? 1.0 + 1e-9 : 1.0 - 1e-9);
      const struct pair a = {
          .p = {{bond, 0, 0}, {bond, 0, 0}},
          .q = {{turn, bond, 0}, {turn, bond, 0}},
          .w = {{end - 0.5 * turn, -0.5 * bond, 0x1p35 * k}, {end - 0.5 * turn, -0.5 * bond, -0x1.1p36}}};
      struct crossing crossing[3];
      int crossings;
      assert_int_equal(pair_decide(&a, crossing, &crossings), beyond ? PAIR_APART : PAIR_CROSSED);
    }
}

/* Halvings hit the root itself: t = 1/4, 1/2, 3/8. */
static void roots_that_halvings_hit(void **unused)
{
  (void)unused;
  for (int eighth = 2; eighth <= 4; eighth++) {
    const struct pair a = {.p = {{0x1p39, 0, 0}, {0x1p39, 0, 0}},
                           .q = {{0, 0x1p39, 0}, {0, 0x1p39, 0}},
                           .w = {{0x1p38, -0x1p38, eighth * 0x1p36}, {0x1p38, -0x1p38, (eighth - 8) * 0x1p36}}};
    struct crossing crossing[3];
    int crossings;
    assert_int_equal(pair_decide(&a, crossing, &crossings), PAIR_CROSSED);
    assert_int_equal(crossings, 1);
    assert_close(crossing[0].t, eighth / 8.0, 1e-7);
    assert_close(crossing[0].s[0], 0.5, 1e-7);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(through_and_back),
      cmocka_unit_test(through_an_image),
      cmocka_unit_test(special_places),
      cmocka_unit_test(through_a_frozen_rod),
      cmocka_unit_test(only_from_sample_to_sample),
      cmocka_unit_test(out_of_reach),
      cmocka_unit_test(ends_are_seen_closely),
      cmocka_unit_test(roots_that_halvings_hit),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
