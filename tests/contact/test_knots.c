/* What all drifts of the rule `event-driven` together must keep: linking numbers of rings, and knots. `make stress`
 * runs the same for longer. */
#include "contact/knots.h"

/* The instrument: knots of known determinant, in many views. */
static void determinants_of_known_knots(void **unused)
{
  (void)unused;
  struct point at[64];
  for (int kind = 0; kind < KNOT_KINDS; kind++)
    for (int view = 0; view < 20; view++)
      for (uint32_t n = 32; n <= 64; n += 16) {
        lay_knot(at, n, (enum knot_kind)kind, 0.5, (struct vec3){0.1, 0.2, 0.3}, 0.1 + 0.31 * view);
        assert_close(knot_determinant(at, n), knot_determinant_of_kind((enum knot_kind)kind), 0.0);
      }
}

static struct model event_driven(struct model m, uint64_t seed)
{
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  m.seed = seed;
  return m;
}

static void links_are_kept(void **unused)
{
  (void)unused;
  const struct {
    struct model (*make)(double per_cell, double dt);
    double per_cell, dt;
    uint64_t steps;
  } runs[] = {{pairs, 0, 0.01, 10000}, {pairs, 3, 0.02, 4000}, {chain, 0, 0.02, 10000}, {dense_rings, 0, 0.01, 3000}};
  for (uint64_t k = 0; k < 4; k++) {
    struct test_run r = test_start(event_driven(runs[k].make(runs[k].per_cell, runs[k].dt), dice_seed(1701) + k));
    const struct followed f = follow_links(&r, runs[k].steps);
    print_message("  gamma %g, dt %g: %u links kept through %lu contacts in %lu steps\n", runs[k].per_cell, runs[k].dt,
                  f.links, (unsigned long)f.executed, (unsigned long)f.steps);
    assert_true(f.changed == 0 && f.steps == runs[k].steps && f.executed > 40);
    test_end(&r);
  }
}

static const enum knot_kind three_kinds[] = {TREFOIL, UNKNOT, FIGURE_EIGHT};

static void knots_are_kept(void **unused)
{
  (void)unused;
  struct test_run r =
      start_knots(event_driven(test_model(4, 4, 4, 0, 0.01, 2), dice_seed(1702)), 6, 32, three_kinds, 3);
  const struct knots_followed f = follow_knots(&r, 4000, 200, three_kinds, 3);
  print_message("  %u looks at knots, %lu contacts in %lu steps\n", f.looked, (unsigned long)f.executed,
                (unsigned long)f.steps);
  assert_true(f.changed == 0 && f.executed > 1000);
  test_end(&r);
}

/* The same rings as phantoms do not stay knotted: the test above can fail. */
static void phantom_knots_are_lost(void **unused)
{
  (void)unused;
  struct model m = test_model(4, 4, 4, 0, 0.01, 2);
  m.crossing.forbidden = false;
  struct test_run r = start_knots(m, 6, 32, three_kinds, 3);
  const struct knots_followed f = follow_knots(&r, 4000, 200, three_kinds, 3);
  print_message("  %u of %u looks found another knot\n", f.changed, f.looked);
  assert_true(f.changed > 20 && f.executed == 0);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(determinants_of_known_knots),
      cmocka_unit_test(links_are_kept),
      cmocka_unit_test(knots_are_kept),
      cmocka_unit_test(phantom_knots_are_lost),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
