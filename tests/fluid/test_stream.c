/* Free flight: exact places, wrapping, constant acceleration, lag, and numbers that cannot be. */
#include "exact.h"
#include "fluid/fluid.h"
#include "mpc/grid.h"

/* round(2^40 (v t + a t^2 / 2)) in exact rationals; how far the code's displacement may be off is half a unit, and the
 * rounding of a few double operations. */
static double exact_units(double v, double a, double t)
{
  mpq_t x, y;
  mpq_inits(x, y, NULL);
  mpq_set_d(x, a);
  mpq_set_d(y, t);
  mpq_mul(x, x, y);
  mpq_div_2exp(x, x, 1);
  mpq_t w;
  mpq_init(w);
  mpq_set_d(w, v);
  mpq_add(x, x, w);
  mpq_mul(x, x, y);
  mpq_mul_2exp(x, x, 40);
  double units = mpq_get_d(x);
  mpq_clears(x, y, w, NULL);
  return units;
}

/* Boxes from one cell, flights up to many box edges, with and without acceleration. */
static void flight_is_exact(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 60; k++) {
    const uint64_t seed = dice_seed(401) + k;
    struct dice d = {seed};
    struct model m = test_model(1 + (int)(k % 3), 1 + (int)(k % 5), 4, 30, dice_between(&d, 0.001, 0.2), 2);
    if (k % 2)
      m.solvent.acceleration = dice_vector(&d, 3.0);
    const double size = k % 4 == 3 ? 300.0 : 1.0; /* the latter flies around the box many times */
    struct test_run r = dice_run(m, &d);
    struct solvent *s = &r.state.solvent;
    for (uint32_t i = 0; i < s->n; i++)
      set_solvent_v(&r.state, i, vec3_scale(size, solvent_v(&r.state, i)));
    r.state.solvent_lag = (uint32_t)dice_integer(&d, 1, 9);
    const double t = 0.5 * r.state.solvent_lag * m.time_step;

    const double a[3] = {m.solvent.acceleration.x, m.solvent.acceleration.y, m.solvent.acceleration.z};
    int64_t *x[3] = {s->x, s->y, s->z};
    double *v[3] = {s->vx, s->vy, s->vz};
    struct point *seen = malloc(s->n * sizeof *seen);
    int64_t *before[3];
    double *speed[3];
    for (uint32_t i = 0; i < s->n; i++)
      seen[i] = fluid_position_now(&r.state, &r.model, i);
    for (int c = 0; c < 3; c++) {
      before[c] = malloc(s->n * sizeof *before[c]);
      speed[c] = malloc(s->n * sizeof *speed[c]);
      memcpy(before[c], x[c], s->n * sizeof **x);
      memcpy(speed[c], v[c], s->n * sizeof **v);
    }
    assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
    assert_int_equal(r.state.solvent_lag, 0);
    for (int c = 0; c < 3; c++) {
      const int64_t edge = r.model.box.edge[c];
      for (uint32_t i = 0; i < s->n; i++) {
        const double units = exact_units(speed[c][i], a[c], t);
        int64_t whole = (int64_t)rint(units), off = x[c][i] - (before[c][i] + whole);
        off -= floor_divide(off + edge / 2, edge) * edge; /* to the nearest image */
        if (x[c][i] < 0 || x[c][i] >= edge || !(fabs((double)off) <= 1.0 + 0x1p-51 * fabs(units)))
          fail_msg("seed %lu: particle %u: %ld units off", (unsigned long)seed, i, (long)off);
        assert_close(v[c][i], speed[c][i] + a[c] * t, 1e-15 * (1.0 + fabs(v[c][i])));
        if (a[c] == 0.0)
          assert_true(v[c][i] == speed[c][i]);
      }
      free(before[c]);
      free(speed[c]);
    }
    for (uint32_t i = 0; i < s->n; i++) /* where observers see a particle is where it will be streamed to */
      assert_true(seen[i].x == s->x[i] && seen[i].y == s->y[i] && seen[i].z == s->z[i]);
    free(seen);
    test_end(&r);
  }
}

/* Known numbers: 0.75 a0 at 3 a0/t0 for 2 half steps of 0.25 t0 ends at 1.5 of a box of 2; a = 8 adds 1/4, and 2 to v.
 */
static void one_flight_by_hand(void **unused)
{
  (void)unused;
  struct model m = test_model(2, 2, 2, 0.125, 0.25, 4);
  m.solvent.acceleration = (struct vec3){0, 8, 0};
  struct dice d = {1};
  struct test_run r = dice_run(m, &d);
  assert_int_equal(r.state.solvent.n, 1);
  r.state.solvent.x[0] = r.state.solvent.y[0] = r.state.solvent.z[0] = 3 * LATTICE_CELL / 4;
  set_solvent_v(&r.state, 0, (struct vec3){3, 3, -3.5});
  r.state.solvent_lag = 2;
  assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
  assert_true(r.state.solvent.x[0] == 3 * LATTICE_CELL / 2);
  assert_true(r.state.solvent.y[0] == 7 * LATTICE_CELL / 4);
  assert_true(r.state.solvent.z[0] == 15 * LATTICE_CELL / 8);
  assert_true(r.state.solvent.vx[0] == 3.0 && r.state.solvent.vy[0] == 5.0 && r.state.solvent.vz[0] == -3.5);
  test_end(&r);
}

/* Faces belong to the next cell: a particle that lands on the upper face is at 0, one unit below stays. */
static void faces_wrap(void **unused)
{
  (void)unused;
  struct dice d = {1};
  const int64_t edge = 3 * LATTICE_CELL;
  for (int k = 0; k < 6; k++) {
    const int64_t back = k % 3 - 1;
    const double v = k < 3 ? 1.0 : 7.0; /* half a cell, or a box edge more: wrapped once, it still lies outside */
    struct test_run r = dice_run(test_model(3, 3, 3, 1, 0.5, 2), &d);
    r.state.solvent.x[0] = edge - LATTICE_CELL / 2 + back;
    r.state.solvent.y[0] = LATTICE_CELL / 2 + back;
    set_solvent_v(&r.state, 0, (struct vec3){v, -v, 0});
    r.state.solvent_lag = 2;
    assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
    assert_true(r.state.solvent.x[0] == (back < 0 ? edge + back : back));
    assert_true(r.state.solvent.y[0] == (back < 0 ? edge + back : back));
    test_end(&r);
  }
}

/* No displacement that the lattice cannot hold may pass, whatever integer its rounding gives: every magnitude from the
 * limit on, both signs, NaN, each component, first and last particle. */
static void impossible_flights_are_found(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(402)};
  for (int k = 0; k < 4000; k++) {
    struct model m = test_model(k % 2 ? 1 : 1024, 1, k % 2 ? 2 : 1, 0.02, 0.5, 2);
    test_particles(&m, 20);
    struct test_run r = dice_run(m, &d);
    r.state.solvent_lag = 2;
    double flight = LATTICE_MAX_MOVE * exp2(k < 2000 ? dice_between(&d, 0.0, 12.0) : dice_between(&d, 0.0, 1000.0));
    if (k % 50 == 0)
      flight = NAN;
    if (k % 50 == 1)
      flight = INFINITY;
    double v = 2.0 * (dice_u64(&d) & 1 ? flight : -flight),
           *component[] = {r.state.solvent.vx, r.state.solvent.vy, r.state.solvent.vz};
    uint32_t who = k % 3 == 0 ? 0 : k % 3 == 1 ? 19 : 7;
    component[k % 3][who] = v;
    if (fluid_stream(&r.state, &r.model, &r.work.fault) || r.work.fault.code != FAULT_SOLVENT_MOVE)
      fail_msg("a flight of %g a0 passed", 0.5 * v);
    assert_true(r.work.fault.entity == who && r.work.fault.step == 1);
    assert_true(r.work.fault.value == 0.5 * v || isnan(v)); /* t is 0.5: what is told is the flight */
    test_end(&r);
  }
}

static void farthest_flight_is_made(void **unused)
{
  (void)unused;
  struct dice d = {3};
  struct model m = test_model(1024, 1, 7, 0.01, 0.5, 2);
  struct test_run r = dice_run(m, &d);
  for (int sign = -1; sign <= 1; sign += 2) {
    r.state.solvent.x[0] = r.state.solvent.y[0] = r.state.solvent.z[0] = 5;
    set_solvent_v(&r.state, 0, (struct vec3){sign * 4092.0, sign * 4092.0, sign * 4092.0});
    r.state.solvent_lag = 2;
    assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
    assert_true(r.state.solvent.x[0] == 5 + (sign > 0 ? 2046 - 1024 : 2 * 1024 - 2046) * LATTICE_CELL);
    assert_true(r.state.solvent.y[0] == 5);
    assert_true(r.state.solvent.z[0] == 5 + (sign > 0 ? 2046 % 7 : 7 - 2046 % 7) * LATTICE_CELL);
  }
  test_end(&r);
}

/* Without lag nothing moves. */
static void no_lag_no_flight(void **unused)
{
  (void)unused;
  struct dice d = {4};
  struct test_run r = dice_run(test_model(3, 3, 3, 5, 0.01, 2), &d);
  const uint64_t before = state_hash(&r.state);
  assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
  assert_true(state_hash(&r.state) == before);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flight_is_exact),
      cmocka_unit_test(one_flight_by_hand),
      cmocka_unit_test(faces_wrap),
      cmocka_unit_test(impossible_flights_are_found),
      cmocka_unit_test(farthest_flight_is_made),
      cmocka_unit_test(no_lag_no_flight),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
