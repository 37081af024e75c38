/* Tubes in flight: the search for their contacts against a march in continuous time, and what a contact does. */
#include "contact/tubes.h"

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

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(no_contact_is_late_and_none_invented),
                                     cmocka_unit_test(the_audit_sees_planted_errors)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
