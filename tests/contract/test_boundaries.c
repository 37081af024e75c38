/*
 * Flights along a periodic axis, and the contract of fluid/boundary.h for every boundary.
 *
 * Velocities, times and accelerations along the axis are such that every flight is a whole or half number of lattice
 * units and every operation in doubles is exact: V 2^-20 a0/t0, T 2^-10 t0, A 2^-20 a0/t0^2 with whole V, T, A. The
 * plain model computes the same in integers.
 */
#include "contract/contract.h"

/* Where a coordinate is after a flight of this length. */
static int64_t plain(int64_t x, int64_t flight, int64_t edge)
{
  return x + flight - floor_divide(x + flight, edge) * edge;
}

/* 2^40 (V 2^-20 T 2^-10 + A 2^-20 T^2 2^-20 / 2) = 2^10 V T + A T^2/2, ties to even. */
static int64_t flight_of(int64_t v, int64_t a, int64_t t)
{
  const int64_t twice = 2048 * v * t + a * t * t, down = floor_divide(twice, 2);
  return twice % 2 == 0 ? down : down + (down % 2 != 0);
}

enum { MOST = 40, ROUNDS = 4000 };

struct flock {
  uint32_t n;
  int cells;
  int64_t edge, t, a, v[MOST], flight[MOST], from[MOST], at[MOST];
  double speed[MOST], now[MOST];
};

/* n particles whose flights are at most `reach` edges long. */
static struct flock throw_flock(struct dice *d, bool accelerated, double reach)
{
  struct flock f = {.n = (uint32_t)dice_integer(d, 1, MOST), .cells = (int)dice_integer(d, 1, 9)};
  f.edge = f.cells * LATTICE_CELL;
  f.t = dice_integer(d, 1, 200);
  f.a = accelerated ? dice_integer(d, -(1 << 22), 1 << 22) : 0;
  for (uint32_t i = 0; i < f.n; i++) {
    const int where = (int)dice_integer(d, 0, 9);
    const double most = reach * (double)f.edge / (1024.0 * (double)f.t);
    f.from[i] = where == 0 ? 0 : where == 1 ? f.edge - 1 : dice_integer(d, 0, f.edge - 1);
    f.v[i] = (int64_t)dice_between(d, -most, most);
    f.flight[i] = flight_of(f.v[i], f.a, f.t);
    if (where == 2) /* onto a face, as near as the grid of velocities lets it */
      f.from[i] = f.edge - f.flight[i] - (int64_t)(dice_u64(d) % 2);
    f.from[i] = f.from[i] < 0 ? 0 : f.from[i] >= f.edge ? f.edge - 1 : f.from[i];
    f.at[i] = f.from[i];
    f.speed[i] = f.now[i] = (double)f.v[i] * 0x1p-20;
  }
  return f;
}

static int64_t fly(struct flock *f)
{
  return boundary_fly_periodic(f->n, f->at, f->now, (double)f->t * 0x1p-10, (double)f->a * 0x1p-20, f->edge);
}

/* Flights within an edge: ends inside, where the plain model has them, unflagged. */
static void near_flights(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2731)};
  uint64_t through = 0;
  for (int round = 0; round < ROUNDS; round++) {
    struct flock f = throw_flock(&d, round % 2, 0.9);
    bool near = true;
    for (uint32_t i = 0; i < f.n; i++)
      near &= f.flight[i] > -f.edge && f.flight[i] < f.edge;
    const int64_t flag = fly(&f);
    assert_true(flag >= 0 || !near);
    for (uint32_t i = 0; near && i < f.n; i++) {
      const int64_t expected = plain(f.from[i], f.flight[i], f.edge);
      if (f.at[i] != expected)
        fail_msg("from %ld by %ld of %ld to %ld, not %ld", (long)f.from[i], (long)f.flight[i], (long)f.edge,
                 (long)f.at[i], (long)expected);
      assert_true(f.now[i] == (f.speed[i] + (double)f.a * 0x1p-20 * ((double)f.t * 0x1p-10)));
      through += f.from[i] + f.flight[i] < 0 || f.from[i] + f.flight[i] >= f.edge;
    }
  }
  assert_true(through > 1000);
}

/* Longer ones: flagged if one of them ended outside, and then brought in by folding. */
static void far_flights(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2732)};
  uint64_t flagged = 0;
  for (int round = 0; round < ROUNDS; round++) {
    struct flock f = throw_flock(&d, round % 2, 40.0);
    const int64_t flag = fly(&f);
    bool outside = false;
    for (uint32_t i = 0; i < f.n; i++) {
      const int64_t expected = plain(f.from[i], f.flight[i], f.edge);
      outside |= f.at[i] < 0 || f.at[i] >= f.edge;
      assert_true(lattice_fold(f.at[i], f.edge) == expected);
    }
    assert_true((flag < 0) == outside);
    flagged += flag < 0;
  }
  assert_true(flagged > 1000);
}

/* A flight that is no number, or beyond the range of lattice_round, is flagged wherever in the list it stands. */
static void impossible_flights(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2733)};
  for (int round = 0; round < ROUNDS; round++) {
    struct flock f = throw_flock(&d, round % 2, 0.9);
    const double far = 2.0 * LATTICE_MAX_MOVE * exp2(dice_between(&d, 0.0, 1000.0)) * (round % 3 ? 1.0 : -1.0);
    f.now[dice_integer(&d, 0, f.n - 1)] = round % 5 == 0 ? NAN : round % 5 == 1 ? INFINITY : far / (f.t * 0x1p-10);
    assert_true(fly(&f) < 0);
  }
}

/* Without acceleration, the same time with the velocity turned around ends where it began, to the bit; and no speed has
 * changed. */
static void flights_run_backwards(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2734)};
  for (int round = 0; round < ROUNDS; round++) {
    struct flock f = throw_flock(&d, false, 0.9);
    assert_true(fly(&f) >= 0);
    for (uint32_t i = 0; i < f.n; i++) {
      assert_true(fabs(f.now[i]) == fabs(f.speed[i]));
      f.now[i] = -f.now[i];
    }
    assert_true(fly(&f) >= 0);
    for (uint32_t i = 0; i < f.n; i++)
      assert_true(f.at[i] == f.from[i] && f.now[i] == -f.speed[i]);
  }
}

/* --- every boundary ---------------------------------------------------------------------------------------------- */

/* A solvent in a box with this boundary along y, in motion at the boundary. */
static struct model model_with(enum boundary_kind kind, struct dice *d)
{
  struct model m = test_model(3, 4, 2, 20.0, 0.25, 1);
  m.seed = dice_u64(d);
  m.scheme = (enum scheme)(dice_u64(d) % SCHEMES);
  if (kind == BOUNDARY_WALL)
    m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .lower = {-0.25, 0, 0.5}, .upper = {0.5, 0, 0}};
  if (kind == BOUNDARY_SHEAR)
    m.shear.rate = 0.375;
  return m;
}

/* `fly` in blocks, and `now` one by one: the same bits. Everybody stays in the box. */
static void now_is_where_flights_end(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2735)};
  for (int k = 0; k < BOUNDARIES; k++)
    for (int round = 0; round < 200; round++) {
      struct test_run r = test_start(model_with(k, &d));
      struct solvent *s = &r.state.solvent;
      assert_int_equal(r.model.box.boundary[1], k);
      r.state.solvent_time = dice_u64(&d) % 1000;
      r.state.solvent_lag = 1 + (uint32_t)(dice_u64(&d) % 2);
      for (uint32_t i = 0; i < s->n; i++) { /* some fly further than the box is wide */
        const double scale = i % 5 == 0 ? 40.0 : 1.0;
        s->vx[i] *= scale, s->vy[i] *= scale, s->vz[i] *= scale;
      }
      struct point *x = calloc(s->n, sizeof *x);
      struct vec3 *v = calloc(s->n, sizeof *v);
      fluid_of(&r.model)->now(&r.state, &r.model, 0, s->n, x, v);
      assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
      assert_true(r.state.solvent_lag == 0);
      for (uint32_t i = 0; i < s->n; i++) {
        assert_true(s->x[i] == x[i].x && s->y[i] == x[i].y && s->z[i] == x[i].z);
        assert_true(s->vx[i] == v[i].x && s->vy[i] == v[i].y && s->vz[i] == v[i].z);
        assert_true(s->x[i] >= 0 && s->x[i] < r.model.box.edge[0] && s->z[i] >= 0 && s->z[i] < r.model.box.edge[2]);
        assert_true(s->y[i] >= 0 && s->y[i] < r.model.box.edge[1] + (k == BOUNDARY_WALL));
      }
      free(x);
      free(v);
      test_end(&r);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(near_flights),
      cmocka_unit_test(far_flights),
      cmocka_unit_test(impossible_flights),
      cmocka_unit_test(flights_run_backwards),
      cmocka_unit_test(now_is_where_flights_end),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
