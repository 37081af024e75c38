/* A drift looks at a vertex's skin only when the vertex may leave it (contact/renewals.h). */
#include "contact/skins.h"
#include "flight_replay.h"

/* Suspensions that fly on for many drifts, with a few vertices that are fast; whole steps alternate with halves. */
static void check_rule(enum crossing_kind rule, enum rejection rejection)
{
  uint64_t waiting = 0, looked_at = 0, executed = 0;
  for (uint64_t k = 0; k < 10; k++) {
    struct dice d = {dice_seed(1821) + k};
    struct test_run r = dense(5, 4, 4, 60, 8, 0.54, &d);
    r.model.crossing.rejection = rejection;
    follow_rule(&r, rule);
    for (uint32_t drift = 0; drift < 24; drift++) {
      for (uint32_t v = 0; v < r.state.vertices && drift % 8 == 0; v++)
        r.state.velocity[v] = dice_vector(&d, (dice_uniform(&d) < 0.05 ? 0.2 : 0.01) / r.model.time_step);
      assert_true(contact_drift(&r.state, &r.model, &r.work.contact, drift % 3 == 2 ? 0.5 : 1.0, 100 + drift, drift % 2,
                                NULL, &r.work.fault));
      waiting += check_skins(&r);
      looked_at += r.state.vertices;
    }
    executed += r.state.counts.executed;
    test_end(&r);
  }
  print_message("  %lu contacts; %lu of %lu times, a vertex was not due\n", (unsigned long)executed,
                (unsigned long)waiting, (unsigned long)looked_at);
  assert_true(executed > 1000 && 2 * waiting > looked_at);
}

static void skins_hold(void **unused)
{
  (void)unused;
  check_rule(CROSSING_EVENT_DRIVEN, REJECTION_STAY);
}

/* Those that are hit before their turns go further than they were about to, the ends of fibers among them. */
static void skins_hold_in_turns(void **unused)
{
  (void)unused;
  check_rule(CROSSING_SEQUENTIAL, REJECTION_STAY);
  check_rule(CROSSING_SEQUENTIAL, REJECTION_BOUNCE);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(skins_hold),
      cmocka_unit_test(skins_hold_in_turns),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
