/*
 * Flights between walls: bounce-back, Tao, Goetze and Gompper 2008.
 *
 * Expected places and velocities are those of a plain simulation in long doubles, which looks for the next hit and
 * flies there, one hit after the other.
 */
#include "exact.h"
#include "fluid/boundary.h"
#include "fluid/fluid.h"
#include "wall/account.h"

static struct model slit_model(struct dice *d, enum wall_kind kind, bool moving, bool driven)
{
  struct model m = test_model(3, 1 + (int)(dice_u64(d) % 4), 2, 30.0, dice_between(d, 0.05, 0.4), 1);
  m.walls.kind = kind;
  if (moving) {
    m.walls.lower = (struct vec3){dice_between(d, -0.6, 0.6), 0.0, dice_between(d, -0.6, 0.6)};
    m.walls.upper = (struct vec3){dice_between(d, -0.6, 0.6), 0.0, dice_between(d, -0.6, 0.6)};
  }
  if (driven)
    m.solvent.acceleration = (struct vec3){dice_between(d, -2.0, 2.0), 0.0, dice_between(d, -2.0, 2.0)};
  return m;
}

/* Some are on a wall at the start, and some hit walls several times. */
static struct test_run slit(struct dice *d, enum wall_kind kind, bool moving, bool driven)
{
  struct test_run r = dice_run(slit_model(d, kind, moving, driven), d);
  struct solvent *s = &r.state.solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    const double faster = i % 4 == 0 ? 20.0 : 1.0;
    s->y[i] = i % 7 == 0 ? 0 : i % 7 == 1 ? r.model.box.edge[1] : s->y[i];
    s->vx[i] *= faster, s->vy[i] *= faster, s->vz[i] *= faster;
  }
  r.state.solvent_lag = 2;
  return r;
}

/* --- the plain simulation ---------------------------------------------------------------------------------------- */

struct plain {
  long double x[3], v[3], given[WALLS][3];
  int hits;
};

static void plain_move(struct plain *p, const long double a[3], long double t)
{
  for (int k = 0; k < 3; k++) {
    p->x[k] += p->v[k] * t + a[k] * t * t / 2;
    p->v[k] += a[k] * t;
  }
}

static void plain_fly(struct plain *p, const struct model *m)
{
  const struct vec3 wall[WALLS] = {m->walls.lower, m->walls.upper}, g = m->solvent.acceleration;
  const long double a[3] = {g.x, 0, g.z}, height = m->box.cells[1];
  long double left = m->time_step;
  for (;;) {
    const enum wall w = p->v[1] < 0 ? WALL_LOWER : WALL_UPPER;
    const long double t = p->v[1] == 0 ? INFINITY : ((w == WALL_LOWER ? 0 : height) - p->x[1]) / p->v[1];
    if (t >= left)
      break;
    plain_move(p, a, t);
    left -= t;
    const double u[3] = {wall[w].x, 0.0, wall[w].z};
    for (int k = 0; k < 3; k++)
      if (m->walls.kind == WALL_NO_SLIP || k == 1) {
        p->given[w][k] += 2 * (u[k] - p->v[k]);
        p->v[k] = 2 * u[k] - p->v[k];
      }
    p->hits++;
  }
  plain_move(p, a, left);
}

/* Lattice units between two coordinates of a periodic axis. */
static double apart(int64_t x, long double expected, int64_t edge)
{
  const long double off = fmodl((long double)x - expected * LATTICE_PER_A0, (long double)edge);
  return (double)fminl(fabsl(off), fabsl(edge - fabsl(off)));
}

/* Places to a few lattice units, velocities to rounding; the account has what all hits gave. */
static void flights_are_those_of_a_plain_simulation(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2801)};
  int hits = 0, several = 0;
  for (int round = 0; round < 300; round++) {
    const enum wall_kind kind = round % 3 == 0 ? WALL_SLIP : WALL_NO_SLIP;
    struct test_run r = slit(&d, kind, round % 2, round % 5 < 3);
    struct solvent *s = &r.state.solvent;
    struct plain *p = calloc(s->n, sizeof *p), total = {.hits = 0};
    double *speed = calloc(s->n, sizeof *speed); /* along the walls, as a multiple of that towards them */
    for (uint32_t i = 0; i < s->n; i++) {
      speed[i] = (fabs(s->vx[i]) + fabs(s->vz[i]) + 2.0) / fabs(s->vy[i]);
      p[i] = (struct plain){
          {ldexpl(s->x[i], -40), ldexpl(s->y[i], -40), ldexpl(s->z[i], -40)}, {s->vx[i], s->vy[i], s->vz[i]}, {{0}}, 0};
      plain_fly(&p[i], &r.model);
      hits += p[i].hits;
      several += p[i].hits > 1;
      for (int k = 0; k < 6; k++)
        total.given[k / 3][k % 3] += p[i].given[k / 3][k % 3];
    }
    assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
    for (uint32_t i = 0; i < s->n; i++) {
      /* what the walls give adds up from hit to hit; y is rounded to the lattice, and so hits are off by 1/v_y units */
      const double tolerance = 3.0 * (1 + p[i].hits) * (1 + p[i].hits) * (1.0 + speed[i]);
      assert_true(s->y[i] >= 0 && s->y[i] <= r.model.box.edge[1]);
      assert_true(apart(s->x[i], p[i].x[0], r.model.box.edge[0]) <= tolerance);
      assert_true(fabs((double)(s->y[i] - p[i].x[1] * LATTICE_PER_A0)) <= tolerance);
      assert_true(apart(s->z[i], p[i].x[2], r.model.box.edge[2]) <= tolerance);
      assert_close(s->vx[i], (double)p[i].v[0], 1e-12 * tolerance);
      assert_close(s->vy[i], (double)p[i].v[1], 1e-12 * tolerance);
      assert_close(s->vz[i], (double)p[i].v[2], 1e-12 * tolerance);
    }
    for (int w = 0; w < WALLS; w++) {
      const struct vec3 got =
          account_between((struct point){0, 0, 0}, r.state.wall_momentum[account_row(ACCOUNT_HITS, w)]);
      assert_close(got.x, (double)total.given[w][0], 1e-9);
      assert_close(got.y, (double)total.given[w][1], 1e-9);
      assert_close(got.z, (double)total.given[w][2], 1e-9);
      assert_true(r.state.wall_momentum[account_row(ACCOUNT_COLLISIONS, w)].y == 0);
    }
    free(p);
    free(speed);
    test_end(&r);
  }
  print_message("  %d hits, %d flights with several\n", hits, several);
  assert_true(hits > 5000 && several > 1000);
}

/* Forward, turned around, forward: where it began, to the bit. Walls are at rest, no force acts. A particle that starts
 * on a wall must not move into it: its way back ends on the wall before the hit. */
static void flights_run_backwards(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2802)};
  for (int round = 0; round < 300; round++) {
    struct test_run r = slit(&d, round % 2 ? WALL_SLIP : WALL_NO_SLIP, false, false);
    struct solvent *s = &r.state.solvent;
    struct point *x = calloc(s->n, sizeof *x);
    struct vec3 *v = calloc(s->n, sizeof *v);
    for (uint32_t i = 0; i < s->n; i++) {
      const bool lower = s->y[i] == 0, upper = s->y[i] == r.model.box.edge[1];
      s->vy[i] = lower ? fabs(s->vy[i]) : upper ? -fabs(s->vy[i]) : s->vy[i];
    }
    for (uint32_t i = 0; i < s->n; i++)
      x[i] = (struct point){s->x[i], s->y[i], s->z[i]}, v[i] = solvent_v(&r.state, i);
    for (int way = 0; way < 2; way++) {
      r.state.solvent_lag = 2;
      assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
      for (uint32_t i = 0; i < s->n; i++)
        set_solvent_v(&r.state, i, vec3_scale(-1.0, solvent_v(&r.state, i)));
    }
    for (uint32_t i = 0; i < s->n; i++) {
      assert_true(s->x[i] == x[i].x && s->y[i] == x[i].y && s->z[i] == x[i].z);
      assert_true(s->vx[i] == v[i].x && s->vy[i] == v[i].y && s->vz[i] == v[i].z);
    }
    free(x);
    free(v);
    test_end(&r);
  }
}

/* A flight that cannot be is told, wherever it stands and whatever wall it goes to. */
static void impossible_flights_stop(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2803)};
  for (int round = 0; round < 60; round++) {
    struct test_run r = slit(&d, round % 2 ? WALL_SLIP : WALL_NO_SLIP, true, true);
    struct solvent *s = &r.state.solvent;
    double *const v[3] = {s->vx, s->vy, s->vz};
    const double far = 1.01 * LATTICE_MAX_MOVE / r.model.time_step;
    const double bad[5] = {NAN, INFINITY, -INFINITY, far, -far * exp2(dice_between(&d, 0.0, 900.0))};
    const uint32_t i = (uint32_t)dice_integer(&d, 0, s->n - 1);
    v[round % 3][i] = bad[round / 3 % 5];
    assert_false(fluid_stream(&r.state, &r.model, &r.work.fault));
    assert_int_equal(r.work.fault.code, FAULT_SOLVENT_MOVE);
    assert_int_equal(r.work.fault.entity, s->id[i]);
    test_end(&r);
  }
}

/* An oscillating wall has the velocity of the middle of the interval during a flight. */
static void oscillating_walls_have_the_middle_velocity(void **unused)
{
  (void)unused;
  const double pi = 3.14159265358979323846;
  for (uint64_t interval = 0; interval < 20; interval++) {
    struct model m = test_model(2, 2, 2, 1.0, 0.1, 1);
    m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .lower = {0.5, 0, 0}, .period = 0.8};
    struct test_run r = test_start(m);
    struct solvent *s = &r.state.solvent;
    s->y[0] = 0;
    set_solvent_v(&r.state, 0, (struct vec3){0.25, -0.01, 0.0});
    r.state.solvent_time = 2 * interval;
    r.state.solvent_lag = 2;
    assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
    assert_close(s->vx[0], 2.0 * 0.5 * cos(2.0 * pi * (interval + 0.5) / 8.0) - 0.25, 1e-14);
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(flights_are_those_of_a_plain_simulation),
      cmocka_unit_test(flights_run_backwards),
      cmocka_unit_test(impossible_flights_stop),
      cmocka_unit_test(oscillating_walls_have_the_middle_velocity),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
