/* Linking numbers and knots under the rule `event-driven`: 10^7 steps and more than 10^6 contacts. Rings in pairs, in a
 * chain, many in a small box, knotted ones; with and without solvent; several dt. */
#include "stress.h"

#include "contact/knots.h"

struct total {
  uint64_t steps, contacts, looks, changed, softened, rigid;
};

static struct model event_driven(struct model m, uint64_t seed)
{
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  m.seed = seed;
  return m;
}

static void end_of_run(struct test_run *r, struct total *t)
{
  t->contacts += r->state.counts.executed;
  t->softened += r->state.counts.softened;
  t->rigid += r->state.counts.rigid;
  test_end(r);
}

static void tell(const char *name, double per_cell, double dt, const struct total *t)
{
  print_message(
      "  %-8s gamma %g dt %-6g %9lu steps, %8lu contacts (%lu softened, %lu rigid), %7lu looks, %lu changed\n", name,
      per_cell, dt, (unsigned long)t->steps, (unsigned long)t->contacts, (unsigned long)t->softened,
      (unsigned long)t->rigid, (unsigned long)t->looks, (unsigned long)t->changed);
  fflush(stdout);
}

static void add_total(struct total *sum, const struct total *t)
{
  sum->steps += t->steps, sum->contacts += t->contacts, sum->looks += t->looks, sum->changed += t->changed;
}

static const struct link_scene {
  const char *name;
  struct model (*make)(double per_cell, double dt);
  double per_cell, dt;
  uint64_t runs, steps;
} link_scenes[] = {
    {"pairs", pairs, 0, 0.005, 4, 100000},       {"pairs", pairs, 0, 0.01, 10, 100000},
    {"pairs", pairs, 3, 0.02, 4, 20000},         {"chain", chain, 0, 0.01, 10, 100000},
    {"chain", chain, 0, 0.02, 10, 50000},        {"chain", chain, 3, 0.02, 4, 20000},
    {"dense", dense_rings, 0, 0.005, 5, 100000}, {"dense", dense_rings, 0, 0.01, 20, 100000},
    {"dense", dense_rings, 0, 0.02, 20, 25000},  {"dense", dense_rings, 3, 0.02, 4, 10000},
};

static void links_are_kept(void **unused)
{
  (void)unused;
  struct total sum = {0};
  for (size_t k = 0; k < sizeof link_scenes / sizeof link_scenes[0]; k++) {
    const struct link_scene *s = &link_scenes[k];
    struct total t = {0};
    const uint64_t steps = 100 * ((scaled_count((double)s->steps) + 99) / 100);
    for (uint64_t run = 0; run < s->runs; run++) {
      struct test_run r = test_start(event_driven(s->make(s->per_cell, s->dt), dice_seed(2801) + 100 * run));
      const struct followed f = follow_links(&r, steps);
      t.steps += f.steps, t.looks += f.steps / 100, t.changed += f.changed;
      end_of_run(&r, &t);
    }
    tell(s->name, s->per_cell, s->dt, &t);
    add_total(&sum, &t);
  }
  assert_true(sum.changed == 0);
  assert_true(stress_scale < 1.0 || (sum.steps >= 4000000 && sum.contacts >= 500000));
}

static const enum knot_kind kinds[] = {TREFOIL, UNKNOT, FIGURE_EIGHT};

static const struct knot_scene {
  double per_cell, dt;
  int cells;
  uint32_t rings, vertices;
  uint64_t runs, steps;
} knot_scenes[] = {
    {0, 0.005, 4, 6, 32, 4, 100000}, {0, 0.01, 4, 6, 32, 20, 100000}, {0, 0.02, 4, 6, 32, 20, 25000},
    {0, 0.01, 3, 6, 24, 20, 100000}, {0, 0.01, 5, 9, 48, 5, 100000},  {3, 0.02, 4, 6, 32, 4, 20000},
};

static void knots_are_kept(void **unused)
{
  (void)unused;
  struct total sum = {0};
  for (size_t k = 0; k < sizeof knot_scenes / sizeof knot_scenes[0]; k++) {
    const struct knot_scene *s = &knot_scenes[k];
    struct total t = {0};
    for (uint64_t run = 0; run < s->runs; run++) {
      struct model m = test_model(s->cells, s->cells, s->cells, s->per_cell, s->dt, 2);
      m.solvent.thermostat = s->per_cell > 0.0 ? THERMOSTAT_RESCALE : THERMOSTAT_NONE;
      struct test_run r = start_knots(event_driven(m, dice_seed(2802) + 100 * run), s->rings, s->vertices, kinds, 3);
      const struct knots_followed f = follow_knots(&r, scaled_count((double)s->steps), 500, kinds, 3);
      t.steps += f.steps, t.looks += f.looked, t.changed += f.changed;
      end_of_run(&r, &t);
    }
    tell("knots", s->per_cell, s->dt, &t);
    add_total(&sum, &t);
  }
  assert_true(sum.changed == 0);
  assert_true(stress_scale < 1.0 || (sum.steps >= 5000000 && sum.contacts >= 500000));
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {cmocka_unit_test(links_are_kept), cmocka_unit_test(knots_are_kept)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
