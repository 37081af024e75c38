/*
 * Every scheme keeps what step.c says of them all: a leap-frog, with or without a collision in it.
 *
 * Positions stand at a time, and velocities half a step ahead; a drift moves the positions' time, a kick that of the
 * velocities. What is tested of a plan follows from that, whatever the scheme.
 */
#include "contract/contract.h"

static bool is(const struct stage *stage, const char *name)
{
  return stage->name && strcmp(stage->name, name) == 0;
}

/* What the stages of a plan add up to. */
struct sums {
  double drift, kick;
  uint32_t drifts, kicks, forces, collisions, silent;
  double drifted, kicked; /* when the collision came; -1: not at all */
};

static struct sums sums_of(const struct plan *plan)
{
  struct sums s = {.drifted = -1, .kicked = -1};
  for (uint32_t k = 0; k < plan->stages; k++) {
    const struct stage *stage = &plan->stage[k];
    if (is(stage, "drift")) {
      s.drift += stage->fraction;
      s.drifts++;
      assert_true(s.forces == 0 && s.kicks == 0); /* forces are those of where the vertices come to be */
    } else if (is(stage, "kick")) {
      s.kick += stage->fraction;
      s.kicks++;
      assert_int_equal(s.forces, 1);
    } else if (is(stage, "force")) {
      s.forces++;
      assert_true(s.drift == 1.0);
    } else if (is(stage, "collide")) {
      s.collisions++;
      s.drifted = s.drift;
      s.kicked = s.kick;
    } else {
      assert_null(stage->name);
      assert_true(stage->drift == s.drifts); /* the vertices' part of the drift that is told next */
      assert_true(k + 1 < plan->stages && is(stage + 1, "drift") && stage[1].fraction == stage->fraction);
      s.silent++;
    }
  }
  assert_true(plan->stages <= PLAN_MOST_STAGES);
  return s;
}

/* A scheme's plans: everything once and whole, one collision where it belongs, and vertices in every drift. Solvent
 * alone: no vertices' drifts, forces, kicks. Fibers alone: no collision. */
static void plans_are_whole(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++)
    for (int bath = 0; bath < BATHS; bath++) {
      struct test_run r = test_start(contract_scene((struct choice){.scheme = scheme, .bath = bath}));
      for (int collides = 0; collides < 2; collides++) {
        const struct sums s = sums_of(&r.work.plan[collides]);
        assert_true(s.drift == 1.0 && s.kick == 1.0 && s.forces == 1);
        assert_true(s.collisions == (uint32_t)collides && s.silent == s.drifts);
      }
      const struct sums s = sums_of(&r.work.plan[true]);
      print_message("  scheme %d: positions of %+.2f, velocities of %+.2f collide\n", scheme, s.drifted,
                    s.kicked - 0.5 + 1.0);
      test_end(&r);
    }
}

static void unused_stages_are_not_there(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++) {
    struct model solvent = test_model(6, 6, 6, 3, 0.01, 2);
    contract_choose(&solvent, (struct choice){.scheme = scheme});
    struct model fibers = contract_scene((struct choice){.scheme = scheme});
    fibers.solvent.per_cell = 0.0;
    struct test_run s = test_start(solvent), f = test_start(fibers);
    for (int collides = 0; collides < 2; collides++) {
      const struct sums of_solvent = sums_of(&s.work.plan[collides]);
      assert_true(of_solvent.drift == 1.0 && of_solvent.collisions == (uint32_t)collides);
      assert_true(of_solvent.silent == 0 && of_solvent.forces == 0 && of_solvent.kicks == 0);
      const struct sums of_fibers = sums_of(&f.work.plan[collides]);
      assert_true(of_fibers.drift == 1.0 && of_fibers.kick == 1.0 && of_fibers.collisions == 0);
    }
    for (uint64_t step = 0; step < 10; step++)
      assert_false(step_collides(&f.model, step));
    test_end(&s);
    test_end(&f);
  }
}

/* No two schemes are the same. The word for each is a key's. */
static void schemes_differ(void **unused)
{
  (void)unused;
  int words;
  for (int a = 0; a < SCHEMES; a++) {
    assert_non_null(contract_word(NULL, "order", a, &words));
    assert_int_equal(words, SCHEMES);
    for (int b = 0; b < a; b++) {
      struct test_run x = test_start(contract_scene((struct choice){.scheme = a})),
                      y = test_start(contract_scene((struct choice){.scheme = b}));
      const struct plan *p = &x.work.plan[true], *q = &y.work.plan[true];
      bool same = p->stages == q->stages;
      for (uint32_t k = 0; same && k < p->stages; k++)
        same = p->stage[k].act == q->stage[k].act && p->stage[k].fraction == q->stage[k].fraction;
      assert_false(same);
      test_end(&x);
      test_end(&y);
    }
  }
}

/* --- against the plain leap-frog --------------------------------------------------------------------------------- */

static struct model crossable(int scheme)
{
  for (int k = 0; k < CROSSINGS; k++)
    if (!crossing_rule_row(k)->forbids)
      return contract_scene((struct choice){.scheme = scheme, .crossing = k});
  fail();
  return (struct model){0};
}

/* A step with its collision left out is a step without collision, to the rounding of doubles and of the lattice: halves
 * of a drift and of a kick are as good as wholes. (Vertices that may cross: noncrossing ones move twice in two halves.)
 * In 20 steps 2^-40 a0 of rounding grows to less than 1e-9. */
static void without_its_collision_it_is_a_leap_frog(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++) {
    struct test_run r = test_start(crossable(scheme)), plain = test_start(crossable(scheme));
    for (uint64_t step = 1; step <= 20; step++)
      for (int k = 0; k < 2; k++) {
        struct test_run *of = k ? &plain : &r;
        const struct plan *plan = &of->work.plan[k == 0];
        const struct moment now = {&of->state, &of->model, &of->work.fault, NULL, step};
        for (uint32_t s = 0; s < plan->stages; s++)
          if (!is(&plan->stage[s], "collide"))
            assert_true(plan->stage[s].act((char *)&of->work + plan->stage[s].room, &now, &plan->stage[s]));
      }
    assert_int_equal(r.state.solvent_lag, plain.state.solvent_lag);
    for (uint32_t v = 0; v < r.state.vertices; v++) {
      assert_close(vec3_norm(point_difference(r.state.position[v], plain.state.position[v])), 0.0, 1e-9);
      assert_close(vec3_norm(vec3_sub(r.state.velocity[v], plain.state.velocity[v])), 0.0, 1e-8);
    }
    test_end(&r);
    test_end(&plain);
  }
}

/* --- what is told ------------------------------------------------------------------------------------------------ */

struct looks {
  const struct plan *plan;
  uint32_t next;
  uint64_t step;
  uint32_t lag;
};

static void look(void *context, const char *stage, const struct state *state)
{
  struct looks *l = context;
  while (l->next < l->plan->stages && !l->plan->stage[l->next].name)
    l->next++;
  assert_true(l->next < l->plan->stages);
  const struct stage *expected = &l->plan->stage[l->next++];
  assert_string_equal(stage, expected->name);
  assert_true(state->step == l->step);
  if (is(expected, "drift"))
    l->lag += (uint32_t)(2.0 * expected->fraction);
  if (is(expected, "collide"))
    l->lag = 0; /* the solvent is where the vertices are: in time */
  assert_int_equal(state->solvent_lag, l->lag);
}

/* A watched step tells of the plan's actions in its order, once each; the solvent lags by what has drifted since the
 * collision; and watching changes nothing. */
static void watched_steps(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++) {
    const struct choice c = {.scheme = scheme};
    struct test_run r = test_start(contract_scene(c)), s = test_start(contract_scene(c));
    uint32_t lag = 0;
    for (uint64_t step = 0; step < 40; step++) {
      struct looks l = {&r.work.plan[step_collides(&r.model, step + 1)], 0, step, lag};
      const struct step_watch watch = {look, &l};
      assert_true(step_advance_watched(&r.state, &r.model, &r.work, NULL, &watch));
      assert_int_equal(l.next, l.plan->stages);
      assert_true(r.state.step == step + 1);
      lag = l.lag;
    }
    test_steps(&s, 40);
    assert_same_state(&r, &s, "watched");
    test_end(&r);
    test_end(&s);
  }
}

static void bits_are_the_same(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++)
    for (int crossing = 0; crossing < CROSSINGS; crossing++)
      contract_bits((struct choice){.scheme = scheme, .crossing = crossing});
}

/* Momentum of everything over whole steps: kicks and contacts are pair forces, so nothing is gained but rounding. Per
 * step: the collision's 2^-44 for each of N members, as in contract.h, and 2^-46 of the sum of all m |v| for kicks. */
static void momentum_is_kept_over_steps(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++)
    for (int crossing = 0; crossing < CROSSINGS; crossing++) {
      struct test_run r = test_start(contract_scene((struct choice){.scheme = scheme, .crossing = crossing}));
      long double start[3] = {0};
      double sizes = 0.0;
      for (int look_at = 0; look_at < 2; look_at++) {
        struct member *all = contract_members(&r, 1);
        long double p[3] = {0};
        sizes = 0.0;
        for (uint32_t i = 0; i < contract_count(&r); i++) {
          p[0] += (long double)all[i].mass * all[i].velocity.x;
          p[1] += (long double)all[i].mass * all[i].velocity.y;
          p[2] += (long double)all[i].mass * all[i].velocity.z;
          sizes += all[i].mass * vec3_norm(all[i].velocity);
        }
        free(all);
        for (int c = 0; c < 3 && look_at == 0; c++)
          start[c] = p[c];
        if (look_at == 0)
          test_steps(&r, 50);
        for (int c = 0; c < 3; c++)
          assert_close((double)(p[c] - start[c]), 0.0, 50 * (0x1p-43 * contract_count(&r) + 0x1p-46 * sizes));
      }
      test_end(&r);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plans_are_whole),
      cmocka_unit_test(unused_stages_are_not_there),
      cmocka_unit_test(schemes_differ),
      cmocka_unit_test(without_its_collision_it_is_a_leap_frog),
      cmocka_unit_test(watched_steps),
      cmocka_unit_test(bits_are_the_same),
      cmocka_unit_test(momentum_is_kept_over_steps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
