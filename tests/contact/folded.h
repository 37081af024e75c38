/* Chains that fold, without bending stiffness: bonds caught in the wedges between two others. Counts what a drift of
 * the rule `event-driven` makes of them. */
#ifndef UNCROSS_TESTS_FOLDED_H
#define UNCROSS_TESTS_FOLDED_H

#include "contact/contact.h"
#include "exact.h"

struct folded {
  const char *name;
  double bond_length, spring, bending, per_cell, dt;
  uint32_t chains, vertices;
};

static const struct folded folded[] = {
    {"stiff", 0.5, 100.0, 64.0, 0.0, 0.01, 40, 16},
    {"kappa 0", 0.5, 100.0, 0.0, 0.0, 0.01, 40, 16},
    {"kappa 0, dt 0.02", 0.5, 100.0, 0.0, 0.0, 0.02, 40, 16},
    {"kappa 0, solvent", 0.5, 100.0, 0.0, 5.0, 0.02, 40, 16},
    {"l0 0", 0.0, 12.0, 0.0, 0.0, 0.01, 40, 16},
    {"l0 0, dt 0.02", 0.0, 12.0, 0.0, 0.0, 0.02, 40, 16},
    {"l0 0, solvent", 0.0, 12.0, 0.0, 5.0, 0.02, 40, 16},
    {"crowded", 0.0, 12.0, 0.0, 0.0, 0.01, 120, 16},
};
enum { FOLDED = sizeof folded / sizeof folded[0] };

/* Contacts of each vertex in the step at hand. */
struct folded_tally {
  const struct model *model;
  uint32_t *of_vertex, *touched, touched_count;
  uint64_t steps, contacts, softened, rigid;
  uint32_t most_of_vertex, most_of_step, of_step;
  uint64_t with[4]; /* steps in which a vertex had at least 4, 16, 64, 256 contacts */
};

static inline void count_contact(void *context, const struct contact_event *e)
{
  struct folded_tally *t = context;
  const uint32_t vertex[4] = {e->moving_bond, (uint32_t)t->model->next[e->moving_bond], e->standing_bond,
                              (uint32_t)t->model->next[e->standing_bond]};
  t->of_step++;
  for (int k = 0; k < 4; k++)
    if (t->of_vertex[vertex[k]]++ == 0)
      t->touched[t->touched_count++] = vertex[k];
}

static inline void end_step(struct folded_tally *t)
{
  uint32_t most = 0;
  for (uint32_t k = 0; k < t->touched_count; k++) {
    most = t->of_vertex[t->touched[k]] > most ? t->of_vertex[t->touched[k]] : most;
    t->of_vertex[t->touched[k]] = 0;
  }
  for (int k = 0; k < 4; k++)
    t->with[k] += most >= 4u << 2 * k;
  t->most_of_vertex = most > t->most_of_vertex ? most : t->most_of_vertex;
  t->most_of_step = t->of_step > t->most_of_step ? t->of_step : t->most_of_step;
  t->contacts += t->of_step;
  t->steps++;
  t->touched_count = t->of_step = 0;
}

/* Steps of one suspension in 4^3. */
static inline struct folded_tally fold(const struct folded *f, uint64_t seed, uint64_t steps)
{
  struct model m = test_model(4, 4, 4, f->per_cell, f->dt, 2);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  m.solvent.thermostat = f->per_cell > 0.0 ? THERMOSTAT_RESCALE : THERMOSTAT_NONE;
  m.seed = seed;
  struct fiber_kind *kind = test_add_kind(&m, f->chains, f->vertices);
  kind->bond_length = f->bond_length;
  kind->spring = f->spring;
  kind->bending = f->bending;
  struct test_run r = test_start(m);
  struct folded_tally t = {.model = &r.model};
  t.of_vertex = calloc(r.state.vertices, sizeof *t.of_vertex);
  t.touched = calloc(r.state.vertices, sizeof *t.touched);
  const struct contact_log log = {count_contact, &t};
  for (uint64_t k = 0; k < steps; k++) {
    if (!step_advance(&r.state, &r.model, &r.work, &log)) {
      char text[512];
      fault_describe(&r.work.fault, text, sizeof text);
      fail_msg("%s, seed %lu: %s", f->name, (unsigned long)seed, text);
    }
    end_step(&t);
  }
  t.softened = r.state.counts.softened, t.rigid = r.state.counts.rigid;
  free(t.of_vertex);
  free(t.touched);
  test_end(&r);
  return t;
}

static inline void tell_folded(const char *name, const struct folded_tally *t)
{
  print_message(
      "  %-18s %8lu steps %9lu contacts, %lu softened, %lu rigid; most: %u of a vertex, %u in a step; steps with a "
      "vertex of 4, 16, 64, 256: %lu, %lu, %lu, %lu\n",
      name, (unsigned long)t->steps, (unsigned long)t->contacts, (unsigned long)t->softened, (unsigned long)t->rigid,
      t->most_of_vertex, t->most_of_step, (unsigned long)t->with[0], (unsigned long)t->with[1],
      (unsigned long)t->with[2], (unsigned long)t->with[3]);
}

#endif
