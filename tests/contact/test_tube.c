/* Tubes in flight: the search for their contacts against a march in continuous time and exact polynomials, and what a
 * contact does. */
#include "contact/exact_tube_audit.h"

static void no_contact_is_late_and_none_invented(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(1901);
  const struct tube_tally t = audit_all_tubes(seed, 8000);
  if (t.missed + t.invented > 0)
    fail_msg("seed %lu: %lu missed, %lu invented", (unsigned long)seed, (unsigned long)t.missed,
             (unsigned long)t.invented);
  assert_true(t.queries >= 100000 && t.answers > t.queries / 4);
}

static void exact_polynomials_agree(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(1908);
  const struct exact_tally t = audit_tubes_exactly(seed, 2000);
  if (t.missed + t.invented + t.open > 0)
    fail_msg("seed %lu: %lu missed, %lu invented, %lu open", (unsigned long)seed, (unsigned long)t.missed,
             (unsigned long)t.invented, (unsigned long)t.open);
  assert_true(t.contacts > t.queries / 4);
}

/* --- the audit sees what it should ------------------------------------------------------------------------------- */

static int32_t late(const struct flight_pair *pair, int64_t reach, int32_t from)
{
  const int32_t tick = tube_contact(pair, reach, from);
  return tick < FLIGHT_TICKS ? tick + 1 : tick;
}

static int32_t early(const struct flight_pair *pair, int64_t reach, int32_t from)
{
  const int32_t tick = tube_contact(pair, reach, from);
  return tick < FLIGHT_TICKS && tick > from + 2 ? tick - 2 : tick;
}

static int32_t thicker(const struct flight_pair *pair, int64_t reach, int32_t from)
{
  return tube_contact(pair, reach + (reach >> 20) + 2, from);
}

static int32_t thinner(const struct flight_pair *pair, int64_t reach, int32_t from)
{
  return tube_contact(pair, reach - 1, from);
}

static int32_t second_root(const struct flight_pair *pair, int64_t reach, int32_t from)
{
  return tube_excluded(pair, reach, from, from) && tube_excluded(pair, reach, FLIGHT_TICKS, FLIGHT_TICKS)
             ? FLIGHT_TICKS
             : tube_contact(pair, reach, from);
}

static void the_audit_sees_planted_errors(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1902)};
  const struct tube_tally t[] = {
      audit_tube_kind(&d, TUBE_SIDES, 1000, late), audit_tube_kind(&d, TUBE_SIDES, 1000, early),
      audit_tube_kind(&d, TUBE_SIDES, 1000, thicker), audit_tube_kind(&d, TUBE_RESTING, 3000, thinner),
      audit_tube_kind(&d, TUBE_DEEP, 1000, second_root)};
  for (int k = 0; k < 5; k++)
    tell_tubes((const char *const[]){"late", "early", "thicker", "thinner", "second root"}[k], &t[k]);
  assert_true(t[0].missed > 500 && t[1].invented > 500 && t[2].invented > 10 && t[4].missed > 20);
}

static void exact_polynomials_see_them_too(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1909)};
  const struct exact_tally t[] = {
      audit_kind_exactly(&d, TUBE_SIDES, 1000, late), audit_kind_exactly(&d, TUBE_SIDES, 1000, early),
      audit_kind_exactly(&d, TUBE_SIDES, 1000, thicker), audit_kind_exactly(&d, TUBE_SLOW, 3000, thinner),
      audit_kind_exactly(&d, TUBE_DEEP, 1000, second_root)};
  for (int k = 0; k < 5; k++)
    tell_exact((const char *const[]){"late", "early", "thicker", "thinner", "second root"}[k], &t[k]);
  assert_true(t[0].missed > 500 && t[1].invented > 500 && t[2].invented > 10 && t[3].missed > 50 && t[4].missed > 20);
  assert_true(t[0].overlap > 1e-10 && t[0].open + t[1].open + t[2].open + t[3].open + t[4].open == 0);
}

/* By hand, in lattice units: rods of 1000 along z that approach along x by one in a tick, from 900. The reach is
 * 100. They touch at tick 800: apart up to 799, and with a reach that is less by 2^-20. */
static void exact_polynomials_by_hand(void **unused)
{
  (void)unused;
  struct exact_tubes *e = exact_tubes_open();
  struct flight_pair pair = {.p = {0, 0, 1000}, .q = {0, 0, 1000}, .w = {900, 0, 0}, .w_rate = {-1, 0, 0}};
  const int64_t reach = (int64_t)100 << REACH_BITS;
  const int64_t high[] = {0, 999, 1000, 1001, 1099, 1100, 1101, -1100, -1101}; /* caps reach 100 beyond the ends */
  for (size_t k = 0; k < sizeof high / sizeof *high; k++) {
    pair.w.z = high[k];
    const int64_t beyond = llabs(high[k]) - 1000, late = beyond <= 0 ? 800 : beyond > 100 ? 1000 : 0;
    assert_int_equal(exact_tubes_verdict(e, &pair, reach, 0, 799), TUBES_APART);
    if (late == 800)
      assert_int_equal(exact_tubes_verdict(e, &pair, reach, 0, 800), TUBES_TOUCH);
    if (late == 800)
      assert_int_equal(exact_tubes_verdict(e, &pair, reach - 1, 0, 800), TUBES_APART);
    if (beyond == 100) /* end on end, at x = 0 alone */
      assert_int_equal(exact_tubes_verdict(e, &pair, reach, 0, 1800), TUBES_TOUCH);
    if (beyond == 100)
      assert_int_equal(exact_tubes_verdict(e, &pair, reach - 1, 0, 1800), TUBES_APART);
    if (late == 1000)
      assert_int_equal(exact_tubes_verdict(e, &pair, reach, 0, 1800), TUBES_APART);
  }
  exact_tubes_close(e);
}

/* --- whole drifts ------------------------------------------------------------------------------------------------- */

struct told {
  const struct test_run *run;
  uint64_t contacts, kinds[3]; /* by the number of ends that touch */
};

static bool is_end(double s)
{
  return s == 0.0 || s == 1.0;
}

static void tell(void *context, const struct contact_event *event)
{
  struct told *t = context;
  t->contacts++;
  t->kinds[is_end(event->hit.s) + is_end(event->hit.s_standing)]++;
  assert_true(event->impulse > 0.0);
  assert_close(vec3_norm(event->hit.normal), 1.0, 1e-12);
}

static struct vec3 momentum_of(const struct test_run *r)
{
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < r->state.vertices; i++)
    p = vec3_add_scaled(p, r->model.mass[i], r->state.velocity[i]);
  return p;
}

/* Thick fibers among themselves, rings and thin ones too: after no step do two of them overlap. */
static void no_overlap_begins(void **unused)
{
  (void)unused;
  struct model m = test_model(5, 5, 5, 0, 0.01, 1);
  m.solvent.collision_interval = 0;
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  test_add_kind(&m, 30, 8)->diameter = 0.1;
  test_add_kind(&m, 20, 6)->diameter = 0.02;
  test_add_kind(&m, 20, 8)->diameter = 0.0;
  struct fiber_kind *ring = test_add_kind(&m, 5, 12);
  ring->ring = true, ring->diameter = 0.3;
  struct test_run r = test_start(m);
  struct told told = {.run = &r};
  const struct contact_log log = {tell, &told};
  const struct vec3 before = momentum_of(&r);
  for (int step = 0; step < 600; step++) {
    assert_true(step_advance(&r.state, &r.model, &r.work, &log));
    if (!start_sound(&r.state, &r.model, &r.work.fault)) {
      char text[256];
      fault_describe(&r.work.fault, text, sizeof text);
      fail_msg("after step %d: %s", step, text);
    }
  }
  print_message("  %lu contacts: %lu side on side, %lu end on side, %lu end on end; %lu rigid\n",
                (unsigned long)told.contacts, (unsigned long)told.kinds[0], (unsigned long)told.kinds[1],
                (unsigned long)told.kinds[2], (unsigned long)r.state.counts.rigid);
  assert_true(told.contacts > 500 && told.kinds[1] > 20);
  assert_close(vec3_norm(vec3_sub(momentum_of(&r), before)), 0.0, 1e-9);
  test_end(&r);
}

/* --- bad input ---------------------------------------------------------------------------------------------------- */

static void what_tubes_cannot_be_is_refused(void **unused)
{
  (void)unused;
  const struct {
    double diameter;
    enum crossing_kind rule;
    bool forbidden;
    uint32_t vertices;
    const char *says; /* NULL: allowed */
  } rows[] = {
      {0.1, CROSSING_EVENT_DRIVEN, true, 4, NULL},         {0.53, CROSSING_EVENT_DRIVEN, true, 4, NULL},
      {0.54, CROSSING_EVENT_DRIVEN, true, 4, "0.538"},     {9e-5, CROSSING_EVENT_DRIVEN, true, 4, "from 0.0001"},
      {0.1, CROSSING_SEQUENTIAL, true, 4, "event-driven"}, {0.1, CROSSING_EVENT_DRIVEN, false, 4, "through each other"},
      {0.1, CROSSING_EVENT_DRIVEN, true, 1, "free point"},
  };
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    struct model m = test_model(8, 8, 8, 5, 0.01, 2);
    struct model_error error;
    m.crossing.rule = rows[k].rule, m.crossing.forbidden = rows[k].forbidden;
    test_add_kind(&m, 1, rows[k].vertices)->diameter = rows[k].diameter;
    const bool ok = model_finish(&m, &error);
    assert_int_equal(ok, rows[k].says == NULL);
    if (!ok) {
      assert_string_equal(error.path, "fibers.0.diameter");
      assert_non_null(strstr(error.text, rows[k].says));
    }
    model_free(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact_polynomials_by_hand),      cmocka_unit_test(exact_polynomials_agree),
      cmocka_unit_test(exact_polynomials_see_them_too), cmocka_unit_test(no_contact_is_late_and_none_invented),
      cmocka_unit_test(the_audit_sees_planted_errors),  cmocka_unit_test(no_overlap_begins),
      cmocka_unit_test(what_tubes_cannot_be_is_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
