/* Schedules of a drift of the rule `event-driven`: in which order may its events be answered? By components
 * (contact/components.h), in any order between them, all bits must be those of the drift itself. A second scheduler
 * looks ahead over events that share no vertex, as the contract allowed once: it must fail. */
#ifndef UNCROSS_TESTS_SCHEDULES_H
#define UNCROSS_TESTS_SCHEDULES_H

#include "contact/components.h"

/* --- a scheduler that looks one event too far ----------------------------------------------------------------------
 */

static inline bool pulls_at(const struct model *m, const struct event *a, const struct event *b)
{
  const uint32_t one[4] = {a->bond, (uint32_t)m->next[a->bond], a->other, (uint32_t)m->next[a->other]},
                 other[4] = {b->bond, (uint32_t)m->next[b->bond], b->other, (uint32_t)m->next[b->other]};
  uint32_t near[5], its[5];
  for (int i = 0; i < 4; i++)
    for (int j = 0, n = pulling(m, one[i], near); j < 4; j++)
      for (int k = pulling(m, other[j], its); k-- > 0;)
        for (int l = 0; l < n; l++)
          if (near[l] == its[k])
            return true;
  return false;
}

enum { AHEAD = 8 }; /* events that it looks at */

/* Of the first valid events at hand it takes any that shares no vertex with an earlier one. */
static inline void drift_looking_ahead(struct test_run *r, const struct vec3 *velocity, uint32_t drift,
                                       struct dice *dice, struct flown_copy *c)
{
  copy_open(c, r, velocity, drift);
  set_out(c);
  struct event_queue *all = &c->work.contact.flights.queue;
  for (;;) {
    struct event e[AHEAD];
    int n = 0;
    while (n < AHEAD && event_queue_pop(all, &e[n]))
      n += is_valid(c, &e[n]);
    if (n == 0)
      break;
    int k = (int)dice_integer(dice, 0, n - 1);
    for (int i = 0; i < k; i++)
      if (pulls_at(c->d.model, &e[i], &e[k]))
        k = 0;
    for (int i = 0; i < n; i++)
      assert_true(i == k || event_queue_push(all, &e[i]));
    assert_true(event_answer(&c->d, &e[k]));
  }
  come_down(c);
}

/* --- the comparison ------------------------------------------------------------------------------------------------
 */

/* One drift from where the run stands, with these velocities: as it is, by components, and looking ahead. */
static inline void compare_schedules(struct test_run *r, const struct vec3 *velocity, uint32_t drift, struct dice *dice,
                                     uint64_t seed, struct schedule_tally *t)
{
  struct flown_copy serial, parts, ahead;
  copy_open(&serial, r, velocity, drift);
  assert_true(
      event_driven_rule.drift(&serial.state, &r->model, &serial.work.contact, 7, drift, NULL, &serial.work.fault));
  drift_by_components(r, velocity, drift, dice, &parts, t);
  if (!copies_agree(&serial, &parts))
    fail_msg("seed %lu, drift %lu: components in a random order end elsewhere", (unsigned long)seed,
             (unsigned long)t->drifts);
  if (!parts.work.bead && t->drifts % 2 == 0) {
    drift_looking_ahead(r, velocity, drift, dice, &ahead);
    t->ahead_drifts++;
    t->ahead_wrong += !copies_agree(&serial, &ahead);
    copy_close(&ahead);
  }
  t->drifts++;
  copy_close(&serial);
  copy_close(&parts);
}

/* --- scenes --------------------------------------------------------------------------------------------------------
 */

static const struct scheduled {
  const char *name;
  int edge;
  double move;    /* a0: typical displacement in a drift */
  uint32_t crowd; /* fibers per a0^3 */
  bool thick, bead, sheared;
} scheduled[] = {
    {"dense", 5, 0.04, 1, false, false, false},        {"fast", 5, 0.1, 1, false, false, false},
    {"thick", 8, 0.06, 1, true, false, false},         {"bead", 8, 0.05, 1, false, true, false},
    {"thick and bead", 8, 0.06, 1, true, true, false}, {"sheared", 6, 0.06, 1, false, false, true},
    {"crowded", 3, 0.1, 4, false, false, false},
};
enum { SCHEDULED = sizeof scheduled / sizeof scheduled[0] };

static inline struct model scheduled_model(const struct scheduled *k, uint64_t seed)
{
  struct model m = test_model(k->edge, k->edge, k->edge, k->bead ? 1.0 : 0.0, 0.01, 1);
  m.seed = seed;
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  const uint32_t volume = (uint32_t)(k->edge * k->edge * k->edge);
  struct fiber_kind *f = test_add_kind(&m, k->thick ? volume / 2 : k->crowd * volume, 6);
  f->diameter = k->thick ? 0.15 : 0.0, f->bending = 2.0;
  f = test_add_kind(&m, volume / 8, 4);
  f->ring = true, f->mass = 1.25, f->bending = 0.0;
  if (k->bead)
    m.bead.radius = 1.6, m.bead.center = (struct vec3){0.3, k->edge - 0.2, 0.5 * k->edge};
  if (k->sheared)
    m.shear.rate = 0.4;
  return m;
}

/* Events of at least this number, each in a drift of its own scene. */
static inline struct schedule_tally run_schedules(const struct scheduled *k, uint64_t seed, uint64_t events)
{
  struct schedule_tally t = {0};
  struct dice d = {seed};
  while (t.events < events) {
    struct test_run r = test_start(scheduled_model(k, dice_u64(&d)));
    struct vec3 *velocity = malloc(r.state.vertices * sizeof *velocity);
    for (int drift = 0; drift < 8; drift++) {
      for (uint32_t v = 0; v < r.state.vertices; v++)
        velocity[v] = dice_vector(&d, k->move / r.model.time_step);
      compare_schedules(&r, velocity, (uint32_t)drift % 2, &d, seed, &t);
      test_steps(&r, 3);
    }
    free(velocity);
    test_end(&r);
  }
  print_message("  %-18s %8lu drifts, %8lu events in %8lu components, %6lu times joined; looking ahead %lu of %lu are "
                "wrong; %lu of the bead\n",
                k->name, (unsigned long)t.drifts, (unsigned long)t.events, (unsigned long)t.components,
                (unsigned long)t.joins, (unsigned long)t.ahead_wrong, (unsigned long)t.ahead_drifts,
                (unsigned long)t.bead_answers);
  return t;
}

static inline void judge_schedules(uint64_t seed, uint64_t events)
{
  struct schedule_tally sum = {0};
  for (int k = 0; k < SCHEDULED; k++) {
    const struct schedule_tally t = run_schedules(&scheduled[k], seed + (uint64_t)k, events);
    assert_true((t.components > 2 * t.drifts || scheduled[k].crowd > 1) && (!scheduled[k].bead || t.bead_answers > 0));
    sum.joins += t.joins, sum.ahead_wrong += t.ahead_wrong, sum.ahead_drifts += t.ahead_drifts;
  }
  assert_true(sum.joins > 0 && sum.ahead_wrong > 0);
}

#endif
