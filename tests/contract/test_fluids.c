/* Every fluid keeps the contract of system/fluid.h. */
#include "contract/contract.h"

/* A fluid thrown by dice that lags behind by so many half steps, and is accelerated. */
static struct test_run thrown(int fluid, struct vec3 acceleration, uint64_t round)
{
  struct dice d = {dice_seed(2721) + round};
  struct model m = contract_scene((struct choice){.fluid = fluid});
  m.solvent.acceleration = acceleration;
  struct test_run r = dice_run(m, &d);
  contract_taken(&r.model, (struct choice){.fluid = fluid});
  r.state.solvent_lag = (uint32_t)dice_integer(&d, 1, 5);
  return r;
}

static const struct vec3 pull = {0.3, -1.7, 0.9}, none = {0, 0, 0};

static void rows_are_there(void **unused)
{
  (void)unused;
  for (int k = 0; k < FLUIDS; k++) {
    const struct fluid *row = fluid_row(k);
    assert_true(row && row->name && row->start && row->stream && row->now && row->together <= 2);
    for (int i = 0; i < k; i++)
      assert_string_not_equal(row->name, fluid_row(i)->name);
  }
}

/* So many particles, or less, that no two are parted that stand together. */
static uint32_t whole(const struct fluid *fluid, uint32_t n)
{
  return fluid->together ? n - n % fluid->together : n;
}

static bool in_box(const struct box *box, struct point p)
{
  return p.x >= 0 && p.x < box->edge[0] && p.y >= 0 && p.y < box->edge[1] && p.z >= 0 && p.z < box->edge[2];
}

/* The start: within the box, uniform (chi^2 over octants of the box and of its cells), kT = 1 (chi^2 of 3 N
 * components), and the same whatever the order in memory. False alarms: 2e-6 per number. */
static void starts_are_equilibrium(void **unused)
{
  (void)unused;
  for (int k = 0; k < FLUIDS; k++) {
    struct test_run r = thrown(k, none, 0), s = thrown(k, none, 0);
    struct dice d = {dice_seed(2722)};
    uint64_t octant[8] = {0}, within[8] = {0};
    double square = 0.0;
    shuffle_memory(&s.state, &d);
    fluid_row(k)->start(&r.state, &r.model);
    fluid_row(k)->start(&s.state, &s.model);
    assert_true(state_hash(&r.state) == state_hash(&s.state));
    for (uint32_t i = 0; i < r.state.solvent.n; i++) {
      const struct solvent *p = &r.state.solvent;
      square += vec3_dot(solvent_v(&r.state, i), solvent_v(&r.state, i));
      if (i < 2 * r.state.dumbbells.n && i % 2 == 1) /* where it is depends on the one before */
        continue;
      const int64_t at[3] = {p->x[i], p->y[i], p->z[i]};
      int o = 0, w = 0;
      for (int c = 0; c < 3; c++) {
        o += (at[c] >= r.model.box.edge[c] / 2) << c;
        w += (at[c] % LATTICE_CELL >= LATTICE_CELL / 2) << c;
      }
      assert_true(in_box(&r.model.box, (struct point){at[0], at[1], at[2]}));
      octant[o]++;
      within[w]++;
    }
    const double chance = gsl_cdf_chisq_P(square, 3.0 * r.state.solvent.n);
    print_message("  %s: kT %.4f, chances %.3g %.3g %.3g\n", fluid_row(k)->name, square / 3.0 / r.state.solvent.n,
                  chance, equal_chances(octant, 8), equal_chances(within, 8));
    assert_true(chance > LEAST_CHANCE && chance < 1.0 - LEAST_CHANCE);
    assert_true(equal_chances(octant, 8) > LEAST_CHANCE && equal_chances(within, 8) > LEAST_CHANCE);
    test_end(&r);
    test_end(&s);
  }
}

/* Streamed at once, in blocks, and in another order in memory: the same bits, in the box, where `now` said they would
 * be; the lag stays. */
static void now_is_where_it_streams_to(void **unused)
{
  (void)unused;
  for (int k = 0; k < FLUIDS; k++)
    for (uint64_t round = 0; round < 20; round++) {
      const struct vec3 a = round % 2 ? pull : none;
      struct test_run r = thrown(k, a, round), s = thrown(k, a, round);
      struct dice d = {dice_seed(2723) + round};
      struct solvent *p = &r.state.solvent;
      const uint32_t n = p->n, lag = r.state.solvent_lag;
      struct point *at = malloc(n * sizeof *at), *only = malloc(n * sizeof *only);
      struct vec3 *v = malloc(n * sizeof *v), *alone = malloc(n * sizeof *alone);
      fluid_row(k)->now(&r.state, &r.model, 0, n, at, v);
      fluid_row(k)->now(&r.state, &r.model, 0, n, only, NULL);
      fluid_row(k)->now(&r.state, &r.model, 0, n, NULL, alone);
      assert_memory_equal(at, only, n * sizeof *at);
      assert_memory_equal(v, alone, n * sizeof *v);
      assert_true(fluid_row(k)->stream(&r.state, &r.model, 0, n, &r.work.fault));
      assert_true(r.state.solvent_lag == lag);
      for (uint32_t i = 0; i < n; i++) {
        assert_true(in_box(&r.model.box, at[i]));
        assert_true(at[i].x == p->x[i] && at[i].y == p->y[i] && at[i].z == p->z[i]);
        assert_true(v[i].x == p->vx[i] && v[i].y == p->vy[i] && v[i].z == p->vz[i]);
      }
      shuffle_memory(&s.state, &d);
      for (uint32_t first = 0, some; first < n; first += some) {
        some = whole(fluid_row(k), (uint32_t)dice_integer(&d, 2, 100));
        some = some < n - first ? some : n - first;
        assert_true(fluid_row(k)->stream(&s.state, &s.model, first, some, &s.work.fault));
      }
      assert_same_state(&r, &s, "streamed in blocks");
      free(at), free(only), free(v), free(alone);
      test_end(&r);
      test_end(&s);
    }
}

/* A flight changes the momentum of all by N a t, to the rounding of doubles (2^-52 of each velocity); nobody changes
 * that is not told to fly. */
static void momentum_is_that_of_the_body_force(void **unused)
{
  (void)unused;
  for (int k = 0; k < FLUIDS; k++)
    for (uint64_t round = 0; round < 20; round++) {
      const struct vec3 a = round % 2 ? pull : none;
      struct test_run r = thrown(k, a, round);
      const uint32_t n = r.state.solvent.n, first = whole(fluid_row(k), n / 3), some = whole(fluid_row(k), n / 2);
      const double t = 0.5 * r.state.solvent_lag * r.model.time_step;
      long double p[3] = {0, 0, 0};
      double sizes = 0.0;
      struct member *before = contract_members(&r, 1);
      assert_true(fluid_row(k)->stream(&r.state, &r.model, first, some, &r.work.fault));
      struct member *after = contract_members(&r, 1);
      for (uint32_t i = 0; i < n; i++) { /* ids are in order of memory */
        const struct vec3 old = before[i].velocity, new = after[i].velocity;
        p[0] += (long double)new.x - old.x;
        p[1] += (long double)new.y - old.y;
        p[2] += (long double)new.z - old.z;
        sizes += vec3_norm(old) + vec3_norm(new);
        if (i < first || i >= first + some)
          assert_true(memcmp(&old, &new, sizeof new) == 0 && before[i].cell == after[i].cell);
      }
      assert_close((double)p[0], some * a.x * t, 0x1p-52 * sizes);
      assert_close((double)p[1], some * a.y * t, 0x1p-52 * sizes);
      assert_close((double)p[2], some * a.z * t, 0x1p-52 * sizes);
      free(before), free(after);
      test_end(&r);
    }
}

/* A particle that would move too far is found, and named. */
static void impossible_flights_are_found(void **unused)
{
  (void)unused;
  const double speeds[] = {1e6, -1e9, 1e300, NAN, INFINITY, -INFINITY};
  for (int k = 0; k < FLUIDS; k++)
    for (uint32_t i = 0; i < 18; i++) {
      struct test_run r = thrown(k, none, i);
      const uint32_t who = (i * 37) % r.state.solvent.n;
      double *v[3] = {r.state.solvent.vx, r.state.solvent.vy, r.state.solvent.vz};
      v[i % 3][who] = speeds[i / 3];
      assert_false(fluid_row(k)->stream(&r.state, &r.model, 0, r.state.solvent.n, &r.work.fault));
      assert_true(r.work.fault.code == FAULT_SOLVENT_MOVE && r.work.fault.entity == who);
      test_end(&r);
    }
}

static void over_fluids(void (*check)(struct choice))
{
  for (int k = 0; k < FLUIDS; k++)
    check((struct choice){.fluid = k});
}

static void temperature_is_one(void **unused)
{
  (void)unused;
  over_fluids(contract_equipartition);
}

static void bits_are_the_same(void **unused)
{
  (void)unused;
  over_fluids(contract_bits);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_there),
      cmocka_unit_test(starts_are_equilibrium),
      cmocka_unit_test(now_is_where_it_streams_to),
      cmocka_unit_test(momentum_is_that_of_the_body_force),
      cmocka_unit_test(impossible_flights_are_found),
      cmocka_unit_test(temperature_is_one),
      cmocka_unit_test(bits_are_the_same),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
