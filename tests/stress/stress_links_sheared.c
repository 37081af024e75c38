/* Linking numbers of rings, and of rings with their images, through 1.2 million steps in sheared boxes: steady and
 * oscillating shear, each rule that forbids crossings, two orders of a step, at two dt. */
#include "stress.h"

#include "contact/rings_in_flow.h"
#include "contact/rule.h"

static const struct scene {
  const char *name;
  struct model (*make)(double per_cell, double dt);
  double dt, rate, period; /* period 0: steady */
  double steps;            /* under each rule */
} scenes[] = {
    {"chain", chain, 0.01, 0.4, 0.0, 100000},       {"chain", chain, 0.02, -0.4, 0.0, 100000},
    {"chain", chain, 0.01, 0.4, 16.0, 100000},      {"pairs", pairs, 0.01, 0.8, 0.0, 100000},
    {"pairs", pairs, 0.02, 0.4, 4.0, 100000},       {"dense", dense_rings, 0.01, 0.3, 0.0, 50000},
    {"dense", dense_rings, 0.02, -0.3, 8.0, 50000},
};
enum { SCENES = sizeof scenes / sizeof scenes[0], EVERY = 50 };

static const enum crossing_kind forbidding[] = {CROSSING_SEQUENTIAL, CROSSING_EVENT_DRIVEN};

struct total {
  uint64_t steps, contacts, changed;
};

static struct model model_of(const struct scene *scene, enum crossing_kind rule, uint64_t number)
{
  struct model m = scene->make(3.0, scene->dt);
  m.seed = dice_seed(2603) + number;
  m.crossing.rule = rule;
  m.crossing.exclusion = number % 4 == 2 ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX; /* number is even: sequential */
  m.scheme = number % 3 == 2 ? SCHEME_DRIFT_SPLIT : m.scheme;
  m.solvent.rule = RULE_AT_A;
  m.solvent.thermostat = THERMOSTAT_NONE;
  m.shear.rate = scene->rate;
  m.shear.period = scene->period;
  return m;
}

static void follow(const struct scene *scene, enum crossing_kind rule, uint64_t number, struct total *total)
{
  struct test_run r = test_start(model_of(scene, rule, number));
  struct bonds_of_rings start, now;
  struct exact_test x;
  const uint64_t steps = scaled_count(scene->steps / EVERY) * EVERY;
  uint64_t changed = 0;
  exact_open(&x);
  judge_links(&r, &x, &start);
  assert_true(start.links >= 1);
  for (uint64_t k = 0; k < steps; k += EVERY) {
    test_steps(&r, EVERY);
    judge_links(&r, &x, &now);
    changed += memcmp(&now, &start, sizeof now) != 0;
  }
  exact_close(&x);
  print_message("  %-6s %-12s dt %-5g rate %-5g period %-3g %2u links, %lu steps, %lu contacts, changed %lu times\n",
                scene->name, crossing_rule_of(&r.model)->name, scene->dt, scene->rate, scene->period, start.links,
                (unsigned long)steps, (unsigned long)r.state.counts.executed, (unsigned long)changed);
  total->steps += steps;
  total->contacts += r.state.counts.executed;
  total->changed += changed;
  test_end(&r);
}

static void links_are_kept_in_shear(void **unused)
{
  struct total total = {0};
  (void)unused;
  for (uint64_t k = 0; k < SCENES; k++)
    for (uint64_t rule = 0; rule < 2; rule++)
      follow(&scenes[k], forbidding[rule], 2 * k + rule, &total);
  print_message("  %lu steps in all, %lu contacts\n", (unsigned long)total.steps, (unsigned long)total.contacts);
  assert_int_equal(total.changed, 0);
  assert_true(stress_scale < 1.0 || total.steps >= 1000000);
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {cmocka_unit_test(links_are_kept_in_shear)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
