/* Linking numbers of rings, and of rings with their images, through 2.3 million steps in sheared boxes: steady and
 * oscillating shear, each rule that forbids crossings, two orders of a step, at two dt. The dense rings are linked all
 * through their box, so only an oscillating shear leaves their bonds whole. */
#include "stress.h"

#include "contact/rings_in_flow.h"

static const struct scene {
  const char *name;
  struct model (*make)(double per_cell, double dt);
  double dt, rate, period; /* period 0: steady */
  uint64_t runs;           /* under each rule, each with a seed of its own */
  double steps;            /* of a run */
} scenes[] = {
    {"chain", chain, 0.01, 0.4, 0.0, 10, 20000},        {"chain", chain, 0.02, -0.4, 0.0, 10, 20000},
    {"chain", chain, 0.01, 0.4, 16.0, 10, 20000},       {"pairs", pairs, 0.01, 0.4, 0.0, 10, 20000},
    {"pairs", pairs, 0.02, 0.4, 4.0, 10, 20000},        {"dense", dense_rings, 0.01, 0.3, 8.0, 10, 5000},
    {"dense", dense_rings, 0.02, -0.3, 8.0, 10, 10000},
};
enum { SCENES = sizeof scenes / sizeof scenes[0], EVERY = 50 };

static const enum crossing_kind forbidding[] = {CROSSING_SEQUENTIAL, CROSSING_EVENT_DRIVEN};

struct total {
  uint64_t steps, contacts, changed;
};

static struct model model_of(const struct scene *scene, enum crossing_kind rule, uint64_t run)
{
  struct model m = scene->make(3.0, scene->dt);
  m.seed = dice_seed(2603) + run;
  m.crossing.rule = rule;
  m.crossing.exclusion = rule == CROSSING_SEQUENTIAL && run % 2 ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
  m.scheme = run % 3 == 2 ? SCHEME_DRIFT_SPLIT : m.scheme;
  m.solvent.rule = RULE_AT_A;
  m.solvent.thermostat = THERMOSTAT_NONE;
  m.shear.rate = scene->rate;
  m.shear.period = scene->period;
  return m;
}

/* Number of looks at which links had changed. */
static uint64_t changed_links(struct test_run *r, uint64_t steps, uint32_t *links)
{
  struct bonds_of_rings start, now;
  uint64_t changed = 0;
  judge_links(r, &start);
  assert_true(start.links >= 1);
  for (uint64_t k = 0; k < steps; k += EVERY) {
    test_steps(r, EVERY);
    judge_links(r, &now);
    changed += memcmp(&now, &start, sizeof now) != 0;
  }
  *links = start.links;
  return changed;
}

static void follow(const struct scene *scene, enum crossing_kind rule, struct total *total)
{
  const uint64_t steps = scaled_count(scene->steps / EVERY) * EVERY;
  struct total here = {0};
  uint32_t links = 0;
  for (uint64_t run = 0; run < scene->runs; run++) {
    struct test_run r = test_start(model_of(scene, rule, run));
    here.changed += changed_links(&r, steps, &links);
    here.steps += steps;
    here.contacts += r.state.counts.executed;
    test_end(&r);
  }
  print_message("  %-6s %-12s dt %-5g rate %-5g period %-3g %2u links, %lu steps, %lu contacts, changed %lu times\n",
                scene->name, rule == CROSSING_SEQUENTIAL ? "sequential" : "event-driven", scene->dt, scene->rate,
                scene->period, links, (unsigned long)here.steps, (unsigned long)here.contacts,
                (unsigned long)here.changed);
  total->steps += here.steps;
  total->contacts += here.contacts;
  total->changed += here.changed;
}

static void links_are_kept_in_shear(void **unused)
{
  struct total total = {0};
  (void)unused;
  for (uint64_t k = 0; k < SCENES; k++)
    for (uint64_t rule = 0; rule < 2; rule++)
      follow(&scenes[k], forbidding[rule], &total);
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
