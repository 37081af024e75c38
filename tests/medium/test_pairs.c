/* The bath of pairs: one pair exactly; which pairs are found; which are chosen; in which order. */
#include "base/normal.h"
#include "exact.h"
#include "medium/near.h"
#include "medium/repulsion.h"
#include "statistics.h"

static struct model gas(int lx, int ly, int lz, double density, double probability)
{
  struct model m = test_model(lx, ly, lz, 0, 0.02, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_PAIRS, .rate = probability / m.time_step, .density = density};
  return m;
}

/* --- one pair ----------------------------------------------------------------------------------------------------- */

static struct vec3 cross(struct vec3 a, struct vec3 b)
{
  return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* u' = c u + sqrt(1 - c^2) sqrt(1/mu) xi, and nothing else changes: momentum, the velocity across the line, and the
 * angular momentum about any point, since both changes are along the line. Unequal masses, every draw. */
static void one_pair(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(3101)};
  for (int k = 0; k < 3000; k++) {
    const struct bath_draw *draw = bath_draw_of((enum medium_draw)(k % MEDIUM_DRAWS));
    const double x = dice_between(&d, 0.0, 6.0), xi = dice_normal(&d);
    double loss;
    draw->lose(&x, 1, &loss);
    const double c = k % MEDIUM_DRAWS == DRAW_REPLACE ? 0.0
                     : k % MEDIUM_DRAWS == DRAW_RELAX ? exp(-x)
                                                      : (1.0 - 0.5 * x) / (1.0 + 0.5 * x);
    assert_close(1.0 - loss, c, 1e-15);
    struct mover m[2] = {{dice_vector(&d, 1.0), dice_between(&d, 0.1, 10.0)},
                         {dice_vector(&d, 1.0), dice_between(&d, 0.1, 10.0)}};
    const struct mover old[2] = {m[0], m[1]};
    struct vec3 e = dice_vector(&d, 1.0), apart = e;
    e = vec3_scale(1.0 / vec3_norm(e), e);
    const double mu = m[0].mass * m[1].mass / (m[0].mass + m[1].mass);
    const double noise = bath_noise(loss, 1.0 / m[0].mass + 1.0 / m[1].mass) * xi;
    encounter_act(&(struct encounter){e, loss, noise, 0, 1}, m);
    const struct vec3 gain[2] = {vec3_sub(m[0].velocity, old[0].velocity), vec3_sub(m[1].velocity, old[1].velocity)};
    const struct vec3 change = vec3_add(vec3_scale(m[0].mass, gain[0]), vec3_scale(m[1].mass, gain[1]));
    const struct vec3 turn = cross(apart, vec3_scale(m[0].mass, gain[0])); /* about b, which stands at the origin */
    const double u = vec3_dot(e, vec3_sub(old[0].velocity, old[1].velocity)),
                 after = vec3_dot(e, vec3_sub(m[0].velocity, m[1].velocity));
    assert_close(vec3_norm(change), 0.0, 1e-13);
    assert_close(vec3_norm(turn), 0.0, 1e-12);
    assert_close(after, c * u + sqrt((1.0 - c * c) / mu) * xi, 1e-13);

    /* the other way round: the same bits */
    struct mover n[2] = {old[1], old[0]};
    encounter_act(&(struct encounter){vec3_scale(-1.0, e), loss, noise, 0, 1}, n);
    assert_memory_equal(&n[0], &m[1], sizeof n[0]);
    assert_memory_equal(&n[1], &m[0], sizeof n[1]);
  }
}

/* Shardlow's two half steps, both with the same noise, as his paper has them: explicit, then implicit; masses 1,
 * e = gamma w dt, s = sqrt(2 gamma w dt) per particle. e > 1 overshoots, and is exact too. */
static void shardlow_in_two_halves(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(3102)};
  for (int k = 0; k < 1000; k++) {
    const double e = dice_between(&d, 0.0, 3.0), s = sqrt(2.0 * e), xi = dice_normal(&d), u = dice_normal(&d);
    const double half = (1.0 - e) * u + s * xi, whole = (half + s * xi) / (1.0 + e), x = 2.0 * e;
    double loss;
    bath_draw_of(DRAW_CAYLEY)->lose(&x, 1, &loss);
    assert_close(u + bath_change(u, loss, bath_noise(loss, 2.0) * xi), whole, 1e-14 * (1.0 + fabs(whole)));
  }
}

/* --- which pairs are found ---------------------------------------------------------------------------------------- */

static double to_image(double difference, double edge)
{
  return difference - edge * floor(difference / edge + 0.5);
}

struct found {
  uint32_t low, high;
  struct vec3 along;
};

static int by_numbers(const void *a, const void *b)
{
  const struct found *x = a, *y = b;
  const uint64_t i = (uint64_t)x->low << 32 | x->high, j = (uint64_t)y->low << 32 | y->high;
  return (i > j) - (i < j);
}

/* All encounters of a step, by the numbers of their members, the line from the larger to the smaller one. */
static struct found *find(struct test_run *r, uint64_t step, uint32_t *n)
{
  struct medium *m = &r->work.medium;
  members_gather(&r->state, &r->model, m);
  assert_true(encounters_find(&r->model, m, step));
  struct found *all = calloc(m->encounters + 1, sizeof *all);
  for (uint32_t k = 0; k < m->encounters; k++) {
    const struct encounter *e = &m->encounter[k];
    const uint32_t i = m->number[e->a], j = m->number[e->b];
    all[k] = (struct found){i < j ? i : j, i < j ? j : i, i < j ? e->along : vec3_scale(-1.0, e->along)};
  }
  *n = m->encounters;
  qsort(all, *n, sizeof *all, by_numbers);
  return all;
}

/* By all pairs of all members, with the nearest image by floor: each pair nearer than 1 a0, once, in the smallest box
 * too (3 a0), in random places and among fibers that have left the box. */
static void every_pair_once(void **unused)
{
  (void)unused;
  for (int k = 0; k < 6; k++) {
    struct model m = gas(3, 3 + k % 3, 3 + k % 2, 4.0, 1.0);
    m.seed = dice_seed(3103) + (uint64_t)k;
    test_add_kind(&m, 3, 8)->bending = 0.0;
    struct test_run r = test_start(m);
    const struct solvent *s = &r.state.solvent;
    const double edge[3] = {m.box.cells[0], m.box.cells[1], m.box.cells[2]};
    for (uint32_t v = 0; v < r.state.vertices; v++) {
      r.state.position[v].x += 5 * r.model.box.edge[0];
      r.state.position[v].y -= 3 * r.model.box.edge[1];
    }
    const uint32_t all = s->n + r.state.vertices;
    struct vec3 *at = calloc(all, sizeof *at);
    for (uint32_t i = 0; i < s->n; i++)
      at[s->id[i]] = point_in_a0((struct point){s->x[i], s->y[i], s->z[i]});
    for (uint32_t v = 0; v < r.state.vertices; v++)
      at[s->n + v] = point_in_a0(r.state.position[v]);
    uint32_t n, expected = 0;
    struct found *found = find(&r, 1, &n);
    for (uint32_t i = 0; i < all; i++)
      for (uint32_t j = i + 1; j < all; j++) {
        const struct vec3 apart = {to_image(at[i].x - at[j].x, edge[0]), to_image(at[i].y - at[j].y, edge[1]),
                                   to_image(at[i].z - at[j].z, edge[2])};
        const double r2 = vec3_dot(apart, apart);
        if (r2 >= 1.0)
          continue;
        assert_true(expected < n);
        assert_int_equal(found[expected].low, i);
        assert_int_equal(found[expected].high, j);
        assert_close(vec3_norm(vec3_sub(found[expected].along, vec3_scale(1.0 / sqrt(r2), apart))), 0.0, 1e-14);
        expected++;
      }
    assert_int_equal(n, expected);
    assert_true(n > 300);
    free(found);
    free(at);
    test_end(&r);
  }
}

/* Pairs as they are shown, in the order in which they are. */
struct shown {
  uint32_t n;
  struct {
    uint32_t a, b;
    double x, y, z, r;
  } pair[200000];
};

static bool keep_pairs(const struct near_search *s, struct near_pairs *p)
{
  struct shown *shown = s->context;
  for (uint32_t k = 0; k < p->n; k++, shown->n++) {
    assert_true(shown->n < sizeof shown->pair / sizeof *shown->pair);
    shown->pair[shown->n].a = p->a[k];
    shown->pair[shown->n].b = p->b[k];
    shown->pair[shown->n].x = p->x[k];
    shown->pair[shown->n].y = p->y[k];
    shown->pair[shown->n].z = p->z[k];
    shown->pair[shown->n].r = p->r[k];
  }
  return true;
}

/* The plain search and the one that copies neighborhoods show the same pairs, to the bit and in the same order: where
 * cells have few members, many, and more than a block or a neighborhood holds. Some are at one place once. */
static void plain_and_copied(void **unused)
{
  (void)unused;
  static struct shown plain, copied;
  const double density[] = {0.3, 3.0, 12.0, 30.0, 45.0};
  for (int k = 0; k < 5; k++) {
    struct model m = gas(3 + k % 2, 4, 3, density[k], 1.0);
    m.seed = dice_seed(3109) + (uint64_t)k;
    test_add_kind(&m, 3, 8)->bending = 0.0;
    struct test_run r = test_start(m);
    for (uint32_t v = 1; v < 5 && k == 0; v++)
      r.state.position[v] = r.state.position[0];
    members_gather(&r.state, &r.model, &r.work.medium);
    plain.n = copied.n = 0;
    assert_true(near_find(&(struct near_search){&r.model, &r.work.medium, keep_pairs, &plain, true}));
    assert_true(near_find(&(struct near_search){&r.model, &r.work.medium, keep_pairs, &copied, false}));
    assert_int_equal(plain.n, copied.n);
    assert_true(plain.n > 20);
    assert_memory_equal(plain.pair, copied.pair, plain.n * sizeof *plain.pair);
    test_end(&r);
  }
}

/* --- which are chosen --------------------------------------------------------------------------------------------- */

/* Means over steps of a gas at rest: of N_s (N_s - 1)/2 pairs the part (4 pi/3)/V is near, and of these Gamma dt is
 * chosen; with (1 - r)^2 a tenth of that. The number is Poisson's; 4 standard errors: 1 false alarm in 16 000. */
static void share_that_is_chosen(void **unused)
{
  (void)unused;
  for (int weight = 0; weight < MEDIUM_WEIGHTS; weight++) {
    struct sample chosen = {0};
    for (int k = 0; k < 200; k++) {
      struct model m = gas(5, 4, 6, 3.0, 0.3);
      m.medium.weight = (enum medium_weight)weight;
      m.seed = dice_seed(3104) + (uint64_t)k;
      struct test_run r = test_start(m);
      uint32_t n;
      free(find(&r, 7, &n));
      sample_add(&chosen, n);
      test_end(&r);
    }
    const double particles = 360.0, pairs = 0.5 * particles * (particles - 1.0) * 4.18879020478639 / 120.0;
    assert_sigma(chosen.mean, sample_error(&chosen), 0.3 * pairs * (weight == WEIGHT_HAT ? 1.0 : 0.1), 4.0);
  }
}

/* The words of a pair are those of the address (smaller number, draw: larger number). */
static void random_numbers_have_addresses(void **unused)
{
  (void)unused;
  struct model m = gas(4, 4, 4, 3.0, 0.5);
  m.seed = dice_seed(3105);
  struct test_run r = test_start(m);
  struct medium *b = &r.work.medium;
  members_gather(&r.state, &r.model, b);
  assert_true(encounters_find(&r.model, b, 0x123456789ab));
  assert_true(b->encounters > 100);
  for (uint32_t k = 0; k < b->encounters; k++) {
    const struct encounter *e = &b->encounter[k];
    const uint32_t i = b->number[e->a], j = b->number[e->b];
    const struct random_words w = random_at(m.seed, RANDOM_BATH_PAIR, i < j ? j : i, 0x123456789ab, i < j ? i : j);
    double normal[3];
    random_normal_three(w, normal);
    assert_true((w.w[0] + 0.5) * 0x1p-32 < 0.5);
    assert_int_equal(b->key[k] >> 32, w.w[1]);
    assert_close(e->noise, sqrt(2.0) * normal[2], 1e-15 * fabs(e->noise));
  }
  test_end(&r);
}

/* --- order -------------------------------------------------------------------------------------------------------- */

/* Sorted by the order word; equal words by the numbers, from any order in the list. */
static void order_does_not_depend_on_the_list(void **unused)
{
  (void)unused;
  enum { PAIRS = 5000 };
  struct dice d = {dice_seed(3106)};
  static uint32_t number[200];
  static struct encounter encounter[PAIRS];
  static uint64_t key[PAIRS], spare[PAIRS], last_words[PAIRS], last_numbers[PAIRS];
  for (uint32_t i = 0; i < 200; i++)
    number[i] = 7919 * i % 200;
  for (int round = 0; round < 4; round++) {
    struct medium m = {.number = number, .encounter = encounter, .key = key, .spare = spare, .encounters = PAIRS};
    struct dice same = {4711};
    for (uint32_t k = 0; k < PAIRS; k++) { /* few different words; each pair of numbers once */
      encounter[k].a = k / 100;
      encounter[k].b = 100 + k % 100;
      if (round % 2) {
        const uint32_t swap = encounter[k].a;
        encounter[k].a = encounter[k].b;
        encounter[k].b = swap;
      }
      const uint64_t word = dice_u64(&same) % 3 == 0 ? (dice_u64(&same) & 15) << 28 : dice_u64(&same) >> 32;
      key[k] = word << 32 | k;
    }
    for (uint32_t k = PAIRS; k-- > 1;) {
      const uint32_t j = (uint32_t)dice_integer(&d, 0, k);
      const uint64_t swap = key[k];
      key[k] = key[j];
      key[j] = swap;
    }
    encounters_order(&m);
    for (uint32_t k = 0; k < PAIRS; k++) {
      const struct encounter *e = &encounter[(uint32_t)m.key[k]];
      const uint64_t i = number[e->a], j = number[e->b], numbers = i < j ? i << 32 | j : j << 32 | i;
      const uint64_t word = m.key[k] >> 32;
      if (k > 0 && (word < last_words[k - 1] || (word == last_words[k - 1] && numbers < last_numbers[k - 1])))
        fail_msg("pair %u of round %d is out of order", k, round);
      if (round > 0)
        assert_int_equal(numbers, last_numbers[k]);
      last_words[k] = word;
      last_numbers[k] = numbers;
    }
  }
}

/*
 * One moving particle among resting ones, one sweep without noise in which every pair acts, c = 0: the momentum is
 * handed on within the sweep. Its first moment stays where it was in any order (the sweep keeps momentum and a uniform
 * flow). The third moment of the distances along x is 0 on average only if the order has no direction: an order by
 * cells hands momentum on along the cells. Sample: 300 sweeps with particles placed anew; 4 standard errors, 1 false
 * alarm in 16 000.
 */
static void order_has_no_direction(void **unused)
{
  (void)unused;
  struct sample first = {0}, third = {0}, against = {0};
  for (int k = 0; k < 300; k++) {
    struct model m = gas(12, 3, 3, 3.0, 1.0);
    m.seed = dice_seed(3107) + (uint64_t)k;
    struct test_run r = test_start(m);
    struct medium *b = &r.work.medium;
    double moment[2][2] = {{0.0}};
    members_gather(&r.state, &r.model, b);
    assert_true(encounters_find(&r.model, b, 1));
    for (int sorted = 0; sorted < 2; sorted++) {
      if (sorted)
        encounters_order(b);
      for (uint32_t i = 0; i < b->members; i++)
        b->mover[i].velocity = (struct vec3){0, 0, 0};
      const uint32_t mover = b->members / 2;
      b->mover[mover].velocity.x = 1.0;
      for (uint32_t i = 0; i < b->encounters; i++) {
        struct encounter e = b->encounter[(uint32_t)b->key[i]];
        e.noise = 0.0;
        encounter_act(&e, b->mover);
      }
      for (uint32_t i = 0; i < b->members; i++) {
        const double x = to_image(b->x[i] - b->x[mover], 12.0);
        moment[sorted][0] += x * b->mover[i].velocity.x;
        moment[sorted][1] += x * x * x * b->mover[i].velocity.x;
      }
    }
    sample_add(&first, moment[1][0]);
    sample_add(&third, moment[1][1]);
    sample_add(&against, moment[0][1]);
    test_end(&r);
  }
  assert_sigma(first.mean, sample_error(&first), 0.0, 4.0);
  assert_sigma(third.mean, sample_error(&third), 0.0, 4.0);
  print_message("  in the order of the list: %.4f +- %.4f\n", against.mean, sample_error(&against));
  assert_true(fabs(against.mean) > 5.0 * sample_error(&against)); /* or the test could not see it */
}

/* --- the whole ---------------------------------------------------------------------------------------------------- */

/* Momentum over steps, to rounding: each pair rounds two velocities, at 2^-53 of about 2. In a uniform flow the same
 * velocities plus the flow, as long as rounding has not parted the two runs. */
static void momentum_and_flow(void **unused)
{
  (void)unused;
  struct model m = gas(5, 5, 5, 3.0, 0.5), n = gas(5, 5, 5, 3.0, 0.5);
  const struct vec3 flow = {0.5, -0.25, 1.0};
  m.seed = n.seed = dice_seed(3108);
  m.medium.draw = n.medium.draw = DRAW_RELAX;
  n.flow = flow;
  test_add_kind(&m, 5, 6)->mass = 3.0;
  test_add_kind(&n, 5, 6)->mass = 3.0;
  m.crossing.forbidden = n.crossing.forbidden = false;
  struct test_run r = test_start(m), f = test_start(n);
  test_steps(&r, 20);
  test_steps(&f, 20);
  struct vec3 p = {0, 0, 0};
  double off = 0.0;
  struct vec3 *v = calloc(r.state.solvent.n, sizeof *v);
  for (uint32_t i = 0; i < r.state.solvent.n; i++) {
    v[r.state.solvent.id[i]] = solvent_velocity(&r.state.solvent, i);
    p = vec3_add(p, solvent_velocity(&r.state.solvent, i));
  }
  for (uint32_t k = 0; k < r.state.vertices; k++)
    p = vec3_add_scaled(p, 3.0, r.state.velocity[k]);
  for (uint32_t i = 0; i < f.state.solvent.n; i++)
    off =
        fmax(off, vec3_norm(vec3_sub(vec3_sub(solvent_velocity(&f.state.solvent, i), flow), v[f.state.solvent.id[i]])));
  print_message("  momentum %.3g m a0/t0 after 20 steps, difference in a flow %.3g a0/t0\n", vec3_norm(p), off);
  assert_close(vec3_norm(p), 0.0, 1e-11);
  assert_close(off, 0.0, 1e-8);
  free(v);
  test_end(&r);
  test_end(&f);
}

static struct model repelling(int draw, int scheme)
{
  struct model m = gas(5, 4, 6, 3.0, 0.3);
  m.scheme = (enum scheme)scheme;
  m.medium.draw = (enum medium_draw)draw;
  m.medium.repulsion = 25.0;
  m.seed = dice_seed(3110);
  m.crossing.forbidden = false;
  test_add_kind(&m, 3, 6)->mass = 3.0;
  return m;
}

/* kick-split lists encounters while it finds forces. The same steps with a search for each, to the bit: particles,
 * vertices of another mass, all draws; and in the other schemes nothing is kept. */
static void one_search_for_both(void **unused)
{
  (void)unused;
  for (int kind = 0; kind < MEDIUM_DRAWS * SCHEMES; kind++) {
    const int draw = kind % MEDIUM_DRAWS, scheme = kind / MEDIUM_DRAWS;
    struct test_run r = test_start(repelling(draw, scheme)), s = test_start(repelling(draw, scheme));
    for (int k = 0; k < 10; k++) {
      test_steps(&r, 1);
      for (uint32_t i = 0; i < s.work.plan[true].stages; i++) {
        const struct stage *stage = &s.work.plan[true].stage[i];
        const struct moment now = {&s.state, &s.model, &s.work.fault, NULL, s.state.step + 1};
        if (stage->name && strcmp(stage->name, "collide") == 0)
          assert_true(pairs_collide(&s.state, &s.model, &s.work.medium, now.step, now.fault));
        else
          assert_true(stage->act((char *)&s.work + stage->room, &now, stage));
      }
      s.state.step++;
      assert_true(state_hash(&r.state) == state_hash(&s.state));
    }
    test_end(&r);
    test_end(&s);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_pair),
      cmocka_unit_test(shardlow_in_two_halves),
      cmocka_unit_test(every_pair_once),
      cmocka_unit_test(plain_and_copied),
      cmocka_unit_test(share_that_is_chosen),
      cmocka_unit_test(random_numbers_have_addresses),
      cmocka_unit_test(order_does_not_depend_on_the_list),
      cmocka_unit_test(order_has_no_direction),
      cmocka_unit_test(momentum_and_flow),
      cmocka_unit_test(one_search_for_both),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
