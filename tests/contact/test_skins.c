/* A drift looks at a vertex's skin only when the vertex may leave it (contact/renewals.h). */
#include "contact/neighbors.h"
#include "flight_replay.h"

/* After a drift every vertex is within its skin; and while its skin need not be looked at for some way, it is at least
 * as far from leaving it. Returns the number of vertices that wait. */
static uint64_t check_skins(const struct test_run *r)
{
  const struct neighbors *nb = &r->work.contact.neighbors;
  uint64_t waiting = 0;
  for (uint32_t v = 0; v < r->state.vertices; v++) {
    const struct reference_position *reference = &nb->reference[v];
    const double off = vec3_norm(point_difference(r->state.position[v], reference->at));
    const int32_t left = (int32_t)nb->hold[v];
    if (!(off <= reference->skin + 1e-12))
      fail_msg("vertex %u has left its skin: %g of %g a0", v, off, reference->skin);
    if (left > 0 && !(off + left * 0x1p-20 <= reference->skin + 1e-12))
      fail_msg("vertex %u is %g a0 off, of %g, and need not be looked at for %g", v, off, reference->skin,
               left * 0x1p-20);
    waiting += left > 0;
  }
  return waiting;
}

/* Suspensions that fly on for many drifts, with a few vertices that are fast; whole steps alternate with halves. */
static void check_rule(enum crossing_kind rule)
{
  uint64_t waiting = 0, looked_at = 0, executed = 0;
  for (uint64_t k = 0; k < 10; k++) {
    struct dice d = {dice_seed(1821) + k};
    struct test_run r = dense(5, 4, 4, 60, 8, 0.54, &d);
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
  check_rule(CROSSING_EVENT_DRIVEN);
}

/* Those that are hit before their turns go further than they were about to, the ends of fibers among them. */
static void skins_hold_in_turns(void **unused)
{
  (void)unused;
  check_rule(CROSSING_SEQUENTIAL);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(skins_hold),
      cmocka_unit_test(skins_hold_in_turns),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
