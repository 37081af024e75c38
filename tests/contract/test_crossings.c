/* Every crossing rule keeps the contract of contact/rule.h: in crowded rings and fibers, with every way in which a
 * rejected move may end, and in every frame of the moves. */
#include "contract/contract.h"

#include "contact/rings.h"

/* How a scene of this suite differs from the usual one. */
struct variant {
  enum crossing_kind crossing;
  enum rejection rejection;
  enum frame frame;
};

static struct model with_variant(struct model m, struct variant v)
{
  contract_choose(&m, (struct choice){.crossing = v.crossing, .scheme = m.scheme});
  m.crossing.rejection = v.rejection;
  m.crossing.frame = v.frame;
  m.flow = (struct vec3){0.4, -0.3, 0.2};
  return m;
}

/* Fibers and rings of two masses, four vertices per a0^3, with steps so long that moves meet several bonds. */
static struct model crowd(struct variant v)
{
  struct model m = contract_scene((struct choice){0});
  m.box = box_of_cells(4, 4, 4);
  m.time_step = 0.03;
  m.solvent.collision_interval = 0.06;
  return with_variant(m, v);
}

static void over_variants(void (*check)(const struct crossing_rule *, struct variant))
{
  for (int k = 0; k < CROSSINGS; k++) /* moves are rejected, in a frame, by rules that move in turns */
    for (int rejection = 0; rejection < (crossing_rule_row(k)->in_turns ? REJECTIONS : 1); rejection++)
      for (int frame = 0; frame < (crossing_rule_row(k)->in_turns ? FRAMES : 1); frame++) {
        print_message("  %s, rejection %d, frame %d\n", crossing_rule_row(k)->name, rejection, frame);
        check(crossing_rule_row(k), (struct variant){k, rejection, frame});
      }
}

static void rows_are_there(void **unused)
{
  (void)unused;
  int forbidding = 0;
  for (int k = 0; k < CROSSINGS; k++) {
    assert_true(crossing_rule_row(k) && crossing_rule_row(k)->name && crossing_rule_row(k)->drift);
    forbidding += crossing_rule_row(k)->forbids;
  }
  assert_true(forbidding > 0 && forbidding < CROSSINGS);
}

/* --- what exchanges keep ----------------------------------------------------------------------------------------- */

struct heard {
  uint64_t told, executed;
};

static void hear(void *context, const struct contact_event *event)
{
  struct heard *h = context;
  h->told++;
  h->executed += event->executed;
  assert_true(event->hit.time >= 0.0 && event->hit.time <= 1.0);
  assert_true(event->executed || event->impulse == 0.0);
}

struct mechanics {
  long double momentum[3], energy; /* energy: twice the kinetic one */
  double fastest, heaviest;
};

static struct mechanics mechanics_of(const struct test_run *r)
{
  struct mechanics m = {{0}, 0, 0, 0};
  for (uint32_t i = 0; i < r->state.vertices; i++) {
    const struct vec3 v = r->state.velocity[i];
    const double u[3] = {v.x, v.y, v.z};
    for (int c = 0; c < 3; c++) {
      m.momentum[c] += (long double)r->model.mass[i] * u[c];
      m.energy += (long double)r->model.mass[i] * u[c] * u[c];
    }
    m.fastest = fmax(m.fastest, vec3_norm(v));
    m.heaviest = fmax(m.heaviest, r->model.mass[i]);
  }
  return m;
}

/* A drift changes velocities by exchanges only. Each exchange rounds the velocities of four vertices, and the impulse,
 * fewer than 32 operations on numbers not larger than m v of the fastest and heaviest: 2^-46 of that, and of m v^2, for
 * each. (An exchange may take a vertex beyond the fastest before and after; 2^-46 has room for four times as fast.) A
 * rule that forbids nothing tells of nothing, and changes no velocity. */
static void exchanges_keep(const struct crossing_rule *row, struct variant v)
{
  struct test_run r = test_start(crowd(v));
  struct heard heard = {0, 0};
  const struct contact_log log = {hear, &heard};
  struct vec3 *velocity = malloc(r.state.vertices * sizeof *velocity);
  for (uint64_t step = 1; step <= 200; step++) {
    const struct collision_counts old = r.state.counts;
    const struct heard then = heard;
    const struct mechanics before = mechanics_of(&r);
    memcpy(velocity, r.state.velocity, r.state.vertices * sizeof *velocity);
    const struct moment now = {&r.state, &r.model, &r.work.fault, &log, step};
    const struct plan *plan = &r.work.plan[step_collides(&r.model, step)];
    bool drifting = true, ok = true;
    for (uint32_t k = 0; k < plan->stages; k++) {
      const struct stage *s = &plan->stage[k];
      ok &= s->act((char *)&r.work + s->room, &now, s);
      if (drifting && s->name) { /* the drift is complete: in this scheme it comes first, whole */
        assert_string_equal(s->name, "drift");
        const struct mechanics after = mechanics_of(&r);
        const double exchanges = (double)(r.state.counts.executed - old.executed);
        const double mv = fmax(before.heaviest, after.heaviest) * fmax(before.fastest, after.fastest);
        for (int c = 0; c < 3; c++)
          assert_close((double)(after.momentum[c] - before.momentum[c]), 0.0, exchanges * 0x1p-46 * mv);
        if (row->in_turns || !row->forbids)
          assert_close((double)(after.energy - before.energy), 0.0, exchanges * 0x1p-46 * mv * after.fastest);
        assert_true(heard.executed - then.executed == r.state.counts.executed - old.executed);
        assert_true(heard.told - then.told == r.state.counts.possible - old.possible);
        if (exchanges == 0.0)
          assert_memory_equal(velocity, r.state.velocity, r.state.vertices * sizeof *velocity);
        drifting = false;
      }
    }
    assert_true(ok);
    r.state.step = step;
  }
  print_message("    %lu exchanges, %lu contacts\n", (unsigned long)heard.executed, (unsigned long)heard.told);
  assert_true(row->forbids ? heard.executed > 100 && heard.told >= heard.executed : heard.told == 0);
  free(velocity);
  test_end(&r);
}

static void exchanges_keep_momentum_and_energy(void **unused)
{
  (void)unused;
  over_variants(exchanges_keep);
}

/* --- bits -------------------------------------------------------------------------------------------------------- */

static void swap_words(uint32_t *list, uint32_t i, uint32_t j)
{
  const uint32_t word = list[i];
  list[i] = list[j];
  list[j] = word;
}

/* The pairs of bonds that are near each other, in another order. */
static void shuffle_pairs(struct contact *contact, struct dice *d)
{
  struct pair_list *p = &contact->neighbors.pairs;
  for (uint32_t k = p->count; k-- > 1;) {
    const uint32_t j = (uint32_t)dice_integer(d, 0, k);
    const struct pair_detail detail = p->detail[k];
    swap_words(p->bond, k, j);
    swap_words(p->other, k, j);
    swap_words(p->limit, k, j);
    p->detail[k] = p->detail[j];
    p->detail[j] = detail;
  }
}

static void same_bits(const struct crossing_rule *row, struct variant v)
{
  struct dice d = {dice_seed(2741)};
  struct test_run plain = test_start(crowd(v)), shuffled = test_start(crowd(v)), thrown = test_start(crowd(v));
  uint64_t pairs = 0;
  for (int k = 0; k < 2 * BIT_STEPS; k++) {
    test_steps(&plain, 1);
    test_steps(&shuffled, 1);
    shuffle_pairs(&shuffled.work.contact, &d);
    pairs += shuffled.work.contact.neighbors.pairs.count;
    test_steps(&thrown, 1);
    rebuild_work(&thrown);
  }
  assert_same_state(&plain, &shuffled, "pairs in another order");
  assert_same_state(&plain, &thrown, "work rebuilt after every step");
  assert_true((pairs > 0) == row->forbids && (plain.state.counts.executed > 0) == row->forbids);
  test_end(&plain);
  test_end(&shuffled);
  test_end(&thrown);
}

static void order_of_lists_does_not_matter(void **unused)
{
  (void)unused;
  over_variants(same_bits);
}

static void memory_does_not_matter(void **unused)
{
  (void)unused;
  for (int k = 0; k < CROSSINGS; k++)
    contract_bits((struct choice){.crossing = k});
}

static void scratch_is_what_is_used(void **unused)
{
  (void)unused;
  for (int k = 0; k < CROSSINGS; k++)
    contract_scratch((struct choice){.crossing = k});
}

/* --- links ------------------------------------------------------------------------------------------------------- */

/* Exact linking numbers of crowded rings, their images included: kept by rules that forbid crossing, lost by others. */
static void links_of(const struct crossing_rule *row, struct variant v)
{
  struct model m = with_variant(dense_rings(5, 0.01), v);
  m.solvent.thermostat = THERMOSTAT_NONE + 1; /* any takes the heat of the exchanges */
  struct test_run r = test_start(m);
  const struct followed f = follow_links(&r, 400);
  print_message("    %u links, changed in %u of 4 looks; %lu exchanges\n", f.links, f.changed,
                (unsigned long)f.executed);
  assert_true(f.steps == 400);
  assert_true(row->forbids ? f.changed == 0 && f.executed > 100 : f.changed > 0 && f.executed == 0);
  test_end(&r);
}

static void links_are_kept_where_promised(void **unused)
{
  (void)unused;
  over_variants(links_of);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_there),
      cmocka_unit_test(exchanges_keep_momentum_and_energy),
      cmocka_unit_test(order_of_lists_does_not_matter),
      cmocka_unit_test(memory_does_not_matter),
      cmocka_unit_test(scratch_is_what_is_used),
      cmocka_unit_test(links_are_kept_where_promised),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
