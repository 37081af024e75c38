/*
 * Dumbbells between collisions: Tao, Goetze and Gompper 2008, Eqs. (2) and (3).
 *
 * Expected places and velocities come from a plain simulation in long doubles: the velocity Verlet rule with many small
 * steps, and hits of walls found by halving a step.
 */
#include "exact.h"
#include "fluid/boundary.h"
#include "fluid/dumbbell.h"
#include "fluid/fluid.h"
#include "statistics.h"
#include "system/sound.h"
#include "wall/account.h"
#include "wall/motion.h"

static struct model fluid_model(double spring, double dt)
{
  struct model m = test_model(5, 4, 3, 10.0, dt, 1);
  m.dumbbells.spring = spring;
  return m;
}

static struct test_run thrown(struct model m, struct dice *d)
{
  struct test_run r = dice_run(m, d);
  r.state.solvent_lag = 2;
  return r;
}

static void fly(struct test_run *r)
{
  if (!fluid_stream(&r->state, &r->model, &r->work.fault)) {
    char text[512];
    fault_describe(&r->work.fault, text, sizeof text);
    fail_msg("%s", text);
  }
  struct fault fault = {.code = FAULT_NONE};
  assert_true(state_sound(&r->state, &r->model, &fault));
}

/* --- without boundaries (E1) ------------------------------------------------------------------------------------- */

/* At the time to which the fluid was streamed. */
static double energy(const struct test_run *r)
{
  struct state streamed = r->state;
  streamed.solvent_lag = 0;
  double kinetic = 0.0;
  for (uint32_t i = 0; i < r->state.solvent.n; i++)
    kinetic += 0.5 * vec3_dot(solvent_v(&r->state, i), solvent_v(&r->state, i));
  return kinetic + fluid_dumbbell_energy(&streamed, &r->model);
}

static double largest_offset(const struct test_run *a, const struct test_run *b)
{
  double most = 0.0;
  for (uint32_t i = 0; i < a->state.solvent.n; i++)
    most = fmax(most, vec3_norm(vec3_sub(solvent_v(&a->state, i), solvent_v(&b->state, i))));
  for (uint32_t p = 0; p < a->state.dumbbells.n; p++) {
    const struct dumbbells *x = &a->state.dumbbells, *y = &b->state.dumbbells;
    most = fmax(most, fmax(llabs(x->x[p] - y->x[p]), fmax(llabs(x->y[p] - y->y[p]), llabs(x->z[p] - y->z[p]))) *
                          LATTICE_UNIT);
  }
  return most;
}

/* Positions are rounded to 2^-41 a0, which a spring turns into a velocity of w 2^-41: the bounds are a few of these. */
static void two_halves_are_one(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 50; k++) {
    struct dice d = {dice_seed(2901) + k};
    const double spring = pow(10.0, dice_between(&d, -1.0, 3.0)), dt = dice_between(&d, 0.01, 0.2);
    struct test_run r = thrown(fluid_model(spring, dt), &d);
    struct dice again = {dice_seed(2901) + k};
    dice_between(&again, -1.0, 3.0), dice_between(&again, 0.01, 0.2);
    struct test_run s = thrown(fluid_model(spring, dt), &again);
    const double before = energy(&r), w = r.model.dumbbells.frequency;
    fly(&r);
    for (int half = 0; half < 2; half++) {
      s.state.solvent_lag = 1;
      fly(&s);
    }
    assert_true(largest_offset(&r, &s) < 8.0 * (1.0 + w) * LATTICE_UNIT);
    assert_close(energy(&r), before, 1e-11 * before);
    test_end(&r);
    test_end(&s);
  }
}

/* After a period 2 pi/w all vectors are as they were; after a flight, with velocities reversed and flown again, all
 * places are. */
static void periods_and_time_reversal(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2902)}, e = d, f = d;
  const double spring = 2.0 * 3.14159265358979324 * 3.14159265358979324 / (0.5 * 0.5); /* a period of 0.5 */
  struct test_run r = thrown(fluid_model(spring, 0.5), &d), s = thrown(fluid_model(spring, 0.5), &e);
  struct test_run t = thrown(fluid_model(7.0, 0.1), &f);
  fly(&r);
  assert_true(largest_offset(&r, &s) < 1e-10);
  struct point *start = malloc(t.state.solvent.n * sizeof *start);
  for (int flight = 0; flight < 2; flight++) {
    for (uint32_t i = 0; i < t.state.solvent.n; i++) {
      struct solvent *p = &t.state.solvent;
      if (flight == 0)
        start[i] = (struct point){p->x[i], p->y[i], p->z[i]};
      else
        p->vx[i] = -p->vx[i], p->vy[i] = -p->vy[i], p->vz[i] = -p->vz[i];
    }
    t.state.solvent_lag = 2;
    fly(&t);
  }
  for (uint32_t i = 0; i < t.state.solvent.n; i++) {
    const int64_t off = llabs(t.state.solvent.x[i] - start[i].x);
    assert_true(off < 64 || off > t.model.box.edge[0] - 64);
  }
  free(start);
  test_end(&r);
  test_end(&s);
  test_end(&t);
}

/* --- the plain simulation ---------------------------------------------------------------------------------------- */

struct plain {
  long double x[2][3], v[2][3], given[WALLS];
  int hits;
};

struct place {
  long double spring, edge, pull, reach;
  long double wall[WALLS][3];
  bool walls, slip;
  long double a[3];
};

static void accelerate(const struct place *m, const struct plain *p, long double a[2][3])
{
  const long double middle = (p->x[0][1] + p->x[1][1]) / 2;
  const long double pull = middle < m->reach ? -m->pull : m->edge - middle < m->reach ? m->pull : 0;
  for (int k = 0; k < 3; k++) {
    const long double f = -m->spring * (p->x[0][k] - p->x[1][k]);
    a[0][k] = f + m->a[k] + (k == 1 && m->walls ? pull : 0);
    a[1][k] = -f + m->a[k] + (k == 1 && m->walls ? pull : 0);
  }
}

static void verlet(const struct place *m, struct plain *p, long double h)
{
  long double a[2][3], b[2][3];
  accelerate(m, p, a);
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++)
      p->x[i][k] += p->v[i][k] * h + a[i][k] * h * h / 2;
  accelerate(m, p, b);
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++)
      p->v[i][k] += (a[i][k] + b[i][k]) * h / 2;
}

static bool outside(const struct place *m, const struct plain *p, int *who, enum wall *wall)
{
  for (int i = 0; i < 2; i++)
    if (p->x[i][1] < 0 || p->x[i][1] > m->edge) {
      *who = i;
      *wall = p->x[i][1] < 0 ? WALL_LOWER : WALL_UPPER;
      return true;
    }
  return false;
}

/* Steps are halved until the one that crosses a wall is 2^-40 of the whole. */
static void plain_fly(const struct place *m, struct plain *p, long double time, int steps)
{
  const long double h = time / steps;
  for (long double left = time; left > 0;) {
    long double step = left < h ? left : h;
    struct plain next = *p;
    int who = 0;
    enum wall wall = WALL_LOWER;
    verlet(m, &next, step);
    while (m->walls && outside(m, &next, &who, &wall) && step > h * 0x1p-36L) {
      step /= 2;
      next = *p;
      verlet(m, &next, step);
    }
    if (m->walls && outside(m, &next, &who, &wall)) {
      const long double vy = p->v[who][1];
      for (int k = 0; k < 3; k++)
        p->v[who][k] = k == 1 ? -vy : m->slip ? p->v[who][k] : 2 * m->wall[wall][k] - p->v[who][k];
      p->hits++;
      continue;
    }
    *p = next;
    left -= step;
  }
}

static struct place place_of(const struct model *m)
{
  const struct vec3 w[WALLS] = {m->walls.lower, m->walls.upper}, a = m->solvent.acceleration;
  struct place place = {.spring = m->dumbbells.spring,
                        .edge = m->box.cells[1],
                        .walls = model_has_walls(m),
                        .slip = m->walls.kind == WALL_SLIP,
                        .a = {a.x, a.y, a.z}};
  for (int k = 0; k < WALLS; k++)
    place.wall[k][0] = w[k].x, place.wall[k][1] = w[k].y, place.wall[k][2] = w[k].z;
  if (m->dumbbells.depth > 0.0) { /* an energy A (Y/reach - 1) of a mass of 2 */
    place.reach = m->dumbbells.range / sqrtl(m->dumbbells.spring);
    place.pull = m->dumbbells.depth / (2 * place.reach);
  }
  return place;
}

static struct plain plain_of(const struct state *s, uint32_t p)
{
  struct plain plain = {.hits = 0};
  const struct solvent *q = &s->solvent;
  const int64_t apart[3] = {s->dumbbells.x[p], s->dumbbells.y[p], s->dumbbells.z[p]};
  const int64_t at[3] = {q->x[2 * p], q->y[2 * p], q->z[2 * p]};
  for (int k = 0; k < 3; k++) {
    plain.x[0][k] = (long double)at[k] * LATTICE_UNIT;
    plain.x[1][k] = (long double)(at[k] - apart[k]) * LATTICE_UNIT;
  }
  for (int i = 0; i < 2; i++) {
    const struct vec3 v = solvent_v(s, 2 * p + (uint32_t)i);
    plain.v[i][0] = v.x, plain.v[i][1] = v.y, plain.v[i][2] = v.z;
  }
  return plain;
}

/* The error of the plain rule: h^2 of the fastest motion. */
enum { PLAIN_STEPS = 2000 };

static void free_flights_are_those_of_small_steps(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2903)};
  struct model m = fluid_model(2.0, 0.3);
  m.solvent.acceleration = (struct vec3){0.3, -0.4, 0.7};
  struct test_run r = thrown(m, &d);
  struct plain *plain = malloc(r.state.dumbbells.n * sizeof *plain);
  const struct place place = place_of(&r.model);
  for (uint32_t p = 0; p < r.state.dumbbells.n; p++)
    plain[p] = plain_of(&r.state, p);
  fly(&r);
  for (uint32_t p = 0; p < r.state.dumbbells.n; p++) {
    plain_fly(&place, &plain[p], 0.3L, PLAIN_STEPS);
    const struct dumbbells *b = &r.state.dumbbells;
    const struct vec3 v = solvent_v(&r.state, 2 * p);
    assert_close((double)b->x[p] * LATTICE_UNIT, (double)(plain[p].x[0][0] - plain[p].x[1][0]), 1e-6);
    assert_close((double)b->y[p] * LATTICE_UNIT, (double)(plain[p].x[0][1] - plain[p].x[1][1]), 1e-6);
    assert_close(v.x, (double)plain[p].v[0][0], 1e-6);
    assert_close(v.y, (double)plain[p].v[0][1], 1e-6);
    assert_close(v.z, (double)plain[p].v[0][2], 1e-6);
  }
  free(plain);
  test_end(&r);
}

/* --- between walls (E13) ----------------------------------------------------------------------------------------- */

static struct model slit_model(struct dice *d, bool slip, bool moving, bool attracted)
{
  struct model m = fluid_model(pow(10.0, dice_between(d, -0.3, 1.5)), dice_between(d, 0.1, 0.5));
  m.walls.kind = slip ? WALL_SLIP : WALL_NO_SLIP;
  if (moving) {
    m.walls.lower = (struct vec3){dice_between(d, -0.6, 0.6), 0.0, dice_between(d, -0.6, 0.6)};
    m.walls.upper = (struct vec3){dice_between(d, -0.6, 0.6), 0.0, dice_between(d, -0.6, 0.6)};
  }
  if (attracted) {
    m.dumbbells.depth = 2.0;
    m.dumbbells.range = 1.2;
  }
  return m;
}

/* One in four is on a wall; springs along y are as long as the gap allows. */
static struct test_run slit(struct dice *d, bool slip, bool moving, bool attracted)
{
  struct test_run r = dice_run(slit_model(d, slip, moving, attracted), d);
  for (uint32_t p = 0; p < r.state.dumbbells.n; p++) {
    struct solvent *s = &r.state.solvent;
    s->y[2 * p] = p % 8 == 0 ? 0 : p % 8 == 1 ? r.model.box.edge[1] : s->y[2 * p];
    r.state.dumbbells.y[p] = s->y[2 * p] - s->y[2 * p + 1];
  }
  r.state.solvent_lag = 2;
  return r;
}

static void flights_between_walls_are_those_of_small_steps(void **unused)
{
  (void)unused;
  uint64_t hits = 0, several = 0;
  for (int kind = 0; kind < 8; kind++) {
    struct dice d = {dice_seed(2904) + (uint64_t)kind};
    const bool slip = kind % 2, moving = kind / 2 % 2 && !slip, attracted = kind / 4;
    struct test_run r = slit(&d, slip, moving, attracted);
    const struct place place = place_of(&r.model);
    const uint32_t n = r.state.dumbbells.n;
    struct plain *plain = malloc(n * sizeof *plain);
    for (uint32_t p = 0; p < n; p++)
      plain[p] = plain_of(&r.state, p);
    fly(&r);
    uint32_t off = 0;
    /* h^2, and a step at each border of the potential */
    const double h = r.model.time_step / PLAIN_STEPS, bound = 1e-4 + 4.0 * (double)place.pull * h;
    for (uint32_t p = 0; p < n; p++) {
      plain_fly(&place, &plain[p], r.model.time_step, PLAIN_STEPS);
      hits += (uint64_t)plain[p].hits, several += plain[p].hits > 1;
      const struct dumbbells *b = &r.state.dumbbells;
      const double y = (double)r.state.solvent.y[2 * p] * LATTICE_UNIT;
      const struct vec3 v = solvent_v(&r.state, 2 * p), w = solvent_v(&r.state, 2 * p + 1);
      const double error =
          fmax(fabs(y - (double)plain[p].x[0][1]),
               fmax(fabs((double)b->y[p] * LATTICE_UNIT - (double)(plain[p].x[0][1] - plain[p].x[1][1])),
                    fmax(fmax(fabs(v.x - (double)plain[p].v[0][0]), fabs(v.y - (double)plain[p].v[0][1])),
                         fabs(w.x - (double)plain[p].v[1][0]))));
      off += !(error < bound);
    }
    /* a graze is seen by one of the two only: few */
    if (off > n / 100)
      fail_msg("kind %d: %u of %u flights differ", kind, off, n);
    free(plain);
    test_end(&r);
  }
  print_message("  %lu hits; %lu dumbbells with several\n", (unsigned long)hits, (unsigned long)several);
  assert_true(hits > 300 && several > 30);
}

/* No particle outside, whatever the flight; at walls at rest the energy is kept. 10^6 dumbbells in all. */
static void nobody_leaves_and_energy_is_kept(void **unused)
{
  (void)unused;
  double most = 0.0;
  for (uint64_t k = 0; k < 400; k++) {
    struct dice d = {dice_seed(2905) + k};
    struct test_run r = slit(&d, k % 3 == 0, false, k % 2);
    for (int flight = 0; flight < 10; flight++) {
      const double before = energy(&r);
      r.state.solvent_lag = 2;
      fly(&r);
      for (uint32_t i = 0; i < r.state.solvent.n; i++)
        assert_true(r.state.solvent.y[i] >= 0 && r.state.solvent.y[i] <= r.model.box.edge[1]);
      most = fmax(most, fabs(energy(&r) / before - 1.0));
    }
    test_end(&r);
  }
  print_message("  energy is kept to %.2g of it\n", most);
  assert_true(most < 1e-11);
}

/* What walls give is what the dumbbells get (E4 of flights), along x, y and z. */
static void the_account_is_that_of_the_momentum(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 40; k++) {
    struct dice d = {dice_seed(2906) + k};
    struct test_run r = slit(&d, k % 4 == 0, k % 4 != 0, k % 2);
    struct vec3 before = {0, 0, 0}, after = {0, 0, 0}, given = {0, 0, 0};
    for (uint32_t i = 0; i < r.state.solvent.n; i++)
      before = vec3_add(before, solvent_v(&r.state, i));
    fly(&r);
    for (uint32_t i = 0; i < r.state.solvent.n; i++)
      after = vec3_add(after, solvent_v(&r.state, i));
    for (int wall = 0; wall < WALLS; wall++)
      given = vec3_add(given, account_between((struct point){0, 0, 0},
                                              r.state.wall_momentum[account_row(ACCOUNT_HITS, (enum wall)wall)]));
    const double bound = 1e-12 * r.state.solvent.n;
    assert_close(after.x - before.x, given.x, bound);
    assert_close(after.y - before.y, given.y, bound);
    assert_close(after.z - before.z, given.z, bound);
    test_end(&r);
  }
}

/* --- sheared (E8, E9) -------------------------------------------------------------------------------------------- */

/* A box that is sheared at the rate 0 flies as a periodic one, to the bit. */
static void no_shear_is_periodic(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2907)}, e = d;
  struct test_run r = thrown(fluid_model(2.0, 0.1), &d), s = thrown(fluid_model(2.0, 0.1), &e);
  box_bound(&s.model.box, 1, BOUNDARY_SHEAR);
  fly(&r);
  fly(&s);
  assert_true(state_hash(&r.state) == state_hash(&s.state));
  test_end(&r);
  test_end(&s);
}

/* Another image of a box: everything one cell up, cyclically, and faster by the rate. What went over the upper face
 * goes x and v_x of its image. The vectors of dumbbells are what they were, and stay it. */
static void rows_may_be_moved(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 20; k++) {
    struct dice d = {dice_seed(2908) + k}, e = d;
    struct model m = fluid_model(1.0, 0.1);
    m.shear.rate = 0.3;
    struct test_run r = thrown(m, &d), s = thrown(m, &e);
    const double speed = 0.3 * r.model.box.cells[1];
    uint32_t across = 0;
    r.state.solvent_time = s.state.solvent_time = 2 * (5 + k);
    for (uint32_t i = 0; i < s.state.solvent.n; i++) {
      struct solvent *p = &s.state.solvent;
      p->y[i] += LATTICE_CELL;
      p->vx[i] += 0.3;
      const int64_t offset = shear_offset(&s.model, s.state.solvent_time);
      if (p->y[i] >= s.model.box.edge[1]) {
        p->y[i] -= s.model.box.edge[1];
        p->x[i] = lattice_fold(p->x[i] - offset, s.model.box.edge[0]);
        p->vx[i] -= speed;
      }
    }
    fly(&r);
    fly(&s);
    for (uint32_t p = 0; p < r.state.dumbbells.n; p++) {
      const struct dumbbells *a = &r.state.dumbbells, *b = &s.state.dumbbells;
      /* the vector along x grows by the velocity of the shear, which both have; velocities are rounded */
      assert_true(llabs(a->x[p] - b->x[p]) < 16 && llabs(a->y[p] - b->y[p]) < 16 && llabs(a->z[p] - b->z[p]) < 16);
      across += llabs(r.state.solvent.y[2 * p] - r.state.solvent.y[2 * p + 1] - a->y[p]) > LATTICE_CELL;
    }
    assert_true(across > 10);
    test_end(&r);
    test_end(&s);
  }
}

/* --- in equilibrium (S3) ----------------------------------------------------------------------------------------- */

/* <r^2> = d kT/K, T of the centers and of the relative motion 1, at the start and after many collisions. Errors are
 * those of so many independent dumbbells, and of samples a few relaxation times apart. */
static void springs_are_in_equilibrium(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < RULES; rule++) {
    struct model m = test_model(12, 12, 12, 5.0, 0.1, 1);
    m.dumbbells = (struct dumbbell_model){.spring = 0.7, .fraction = 0.8};
    m.solvent.rule = rule;
    m.solvent.thermostat = rule == RULE_SRD ? THERMOSTAT_MAXWELL_BOLTZMANN : THERMOSTAT_NONE;
    m.seed = dice_seed(2909);
    struct test_run r = test_start(m);
    struct sample square = {0}, center = {0}, relative = {0};
    for (int visit = 0; visit < 20; visit++) {
      double s = 0.0, c = 0.0, u2 = 0.0;
      const uint32_t n = r.state.dumbbells.n;
      for (uint32_t p = 0; p < n; p++) {
        const struct vec3 a = solvent_v(&r.state, 2 * p), b = solvent_v(&r.state, 2 * p + 1);
        const struct vec3 x = fluid_dumbbell_now(&r.state, &r.model, p), v = vec3_add(a, b), u = vec3_sub(a, b);
        s += vec3_dot(x, x) * 0.7 / (3.0 * n);
        c += 0.5 * vec3_dot(v, v) / (3.0 * n);
        u2 += 0.5 * vec3_dot(u, u) / (3.0 * n);
      }
      sample_add(&square, s), sample_add(&center, c), sample_add(&relative, u2);
      test_steps(&r, 100);
    }
    assert_int_equal(r.state.dumbbells.n, 3456);
    assert_sigma(square.mean, sample_error(&square), 1.0, 4.5);
    assert_sigma(center.mean, sample_error(&center), 1.0, 4.5);
    assert_sigma(relative.mean, sample_error(&relative), 1.0, 4.5);
    print_message("  rule %d: <r^2> %.4f(%.4f), T of centers %.4f, of springs %.4f\n", rule, square.mean,
                  sample_error(&square), center.mean, relative.mean);
    test_end(&r);
  }
}

/* Any order in memory, sorted or not: the same bits, in every box. */
static void order_in_memory_does_not_matter(void **unused)
{
  (void)unused;
  for (int kind = 0; kind < 3; kind++) {
    struct dice d = {dice_seed(2910)};
    struct model m = test_model(6, 6, 6, 5.0, 0.05, 2);
    m.dumbbells = (struct dumbbell_model){.spring = 1.3, .fraction = 0.6};
    if (kind == 1)
      m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .shear_rate = 0.2};
    if (kind == 2)
      m.shear.rate = 0.2;
    struct test_run r = test_start(m), s = test_start(m);
    for (int step = 0; step < 130; step++) {
      if (step % 11 == 0)
        shuffle_memory(&s.state, &d);
      test_steps(&r, 1);
      test_steps(&s, 1);
      struct fault fault = {.code = FAULT_NONE};
      assert_true(state_sound(&r.state, &r.model, &fault));
    }
    assert_true(state_hash(&r.state) == state_hash(&s.state));
    test_end(&r);
    test_end(&s);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(two_halves_are_one),
      cmocka_unit_test(periods_and_time_reversal),
      cmocka_unit_test(free_flights_are_those_of_small_steps),
      cmocka_unit_test(flights_between_walls_are_those_of_small_steps),
      cmocka_unit_test(nobody_leaves_and_energy_is_kept),
      cmocka_unit_test(the_account_is_that_of_the_momentum),
      cmocka_unit_test(no_shear_is_periodic),
      cmocka_unit_test(rows_may_be_moved),
      cmocka_unit_test(springs_are_in_equilibrium),
      cmocka_unit_test(order_in_memory_does_not_matter),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
