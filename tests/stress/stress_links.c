/* Linking numbers of rings through 1.2 million steps in all: Hopf links, chains of three, unlinked rings, many rings in
 * a small box; across the boundary, at several dt, with and without solvent. */
#include "stress.h"

#include "contact/rings.h"

static const struct scene {
  const char *name;
  struct model (*make)(double per_cell, double dt);
  double per_cell, dt;
  uint64_t runs; /* of 20 000 steps each: without solvent nothing takes the heat of the exchanges */
} scenes[] = {
    {"pairs", pairs, 0, 0.005, 5},      {"pairs", pairs, 0, 0.01, 5},       {"pairs", pairs, 0, 0.02, 5},
    {"pairs", pairs, 3, 0.005, 4},      {"pairs", pairs, 3, 0.01, 4},       {"pairs", pairs, 3, 0.02, 4},
    {"chain", chain, 0, 0.005, 5},      {"chain", chain, 0, 0.01, 5},       {"chain", chain, 0, 0.02, 5},
    {"chain", chain, 3, 0.005, 4},      {"chain", chain, 3, 0.01, 4},       {"chain", chain, 3, 0.02, 4},
    {"dense", dense_rings, 0, 0.01, 2}, {"dense", dense_rings, 3, 0.01, 2}, {"dense", dense_rings, 3, 0.02, 2},
};
enum { SCENES = sizeof scenes / sizeof scenes[0] };

static void follow(const struct scene *scene, uint64_t *steps)
{
  const uint64_t each = scaled_count(20000);
  uint64_t executed = 0, made = 0;
  uint32_t links = 0;
  for (uint64_t run = 0; run < scene->runs; run++) {
    struct model m = scene->make(scene->per_cell, scene->dt);
    m.seed = dice_seed(2602) + 100 * run;
    m.crossing.exclusion = run % 2 ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
    m.crossing.rejection = (run + (uint64_t)(scene - scenes)) % 3 == 2 ? REJECTION_BOUNCE : REJECTION_STAY;
    struct test_run r = test_start(m);
    const struct followed f = follow_links(&r, each);
    if (f.changed > 0)
      fail_msg("%s, dt %g, gamma %g, run %lu: a linking number changes", scene->name, scene->dt, scene->per_cell,
               (unsigned long)run);
    executed += f.executed;
    made += f.steps;
    links = f.links;
    test_end(&r);
  }
  print_message("  %-6s gamma %g dt %-6g %2u links kept through %lu steps of %lu, %lu crossings prevented\n",
                scene->name, scene->per_cell, scene->dt, links, (unsigned long)made,
                (unsigned long)(scene->runs * each), (unsigned long)executed);
  *steps += made;
}

static void links_are_kept(void **unused)
{
  (void)unused;
  uint64_t steps = 0;
  for (int k = 0; k < SCENES; k++)
    follow(&scenes[k], &steps);
  print_message("  %lu steps in all\n", (unsigned long)steps);
  assert_true(stress_scale < 1.0 || steps >= 1000000);
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {cmocka_unit_test(links_are_kept)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
