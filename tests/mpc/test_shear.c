/*
 * A sheared box (images of Lees and Edwards: fluid/boundary_shear.c, mpc/border_shear.c) and its affine force
 * (mpc/drive.h). Exact tests first: they compare runs with each other, or energies with stresses that are
 * summed here by plain loops.
 */
#include "exact.h"
#include "fluid/fluid.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/rule.h"
#include "statistics.h"
#include "support.h"
#include "wall/motion.h"

/* A sheared solvent: the paper's gamma, one step between collisions. */
static struct model sheared(int lx, int ly, int lz, double dt, double rate)
{
  struct model m = test_model(lx, ly, lz, 5.0, dt, 1);
  m.shear.rate = rate;
  m.seed = dice_seed(3001);
  return m;
}

/* --- a rate of 0 is a periodic box ------------------------------------------------------------------------------- */

static struct test_run start_at_rest(enum boundary_kind kind, enum scheme scheme)
{
  struct test_run r = {.model = test_model(5, 4, 3, 5.0, 0.25, 2)};
  r.model.scheme = scheme;
  r.model.seed = dice_seed(3002);
  test_finish(&r.model);
  box_bound(&r.model.box, 1, kind);
  assert_true(state_alloc(&r.state, &r.model));
  assert_true(work_alloc(&r.work, &r.model));
  assert_true(start_state(&r.state, &r.model, &r.work));
  return r;
}

static void no_shear_is_periodic(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++) {
    struct test_run plain = start_at_rest(BOUNDARY_PERIODIC, scheme), still = start_at_rest(BOUNDARY_SHEAR, scheme);
    for (int k = 0; k < 40; k++) {
      test_steps(&plain, 1);
      test_steps(&still, 1);
      assert_true(state_hash(&plain.state) == state_hash(&still.state));
    }
    test_end(&plain);
    test_end(&still);
  }
}

/* --- rows are alike ---------------------------------------------------------------------------------------------- */

static double rate_now(const struct model *m, const struct state *state)
{
  return shear_rate(m, shear_interval(m, state->solvent_time));
}

/* Each particle one row up and faster by the rate, in the image that is in the box. */
static void move_up(struct state *state, const struct model *m)
{
  struct solvent *s = &state->solvent;
  const int64_t offset = shear_offset(m, state->solvent_time);
  const double rate = rate_now(m, state);
  for (uint32_t i = 0; i < s->n; i++) {
    s->y[i] += LATTICE_CELL;
    s->vx[i] += rate;
    if (s->y[i] < m->box.edge[1])
      continue;
    s->y[i] -= m->box.edge[1];
    s->x[i] = lattice_fold(s->x[i] - offset, m->box.edge[0]);
    s->vx[i] -= rate * m->box.cells[1];
  }
}

/* Distance of two lattice coordinates in a periodic box, a0. */
static double apart(int64_t x, int64_t y, int64_t edge)
{
  const int64_t d = lattice_fold(x - y, edge);
  return (double)(d < edge - d ? d : edge - d) * LATTICE_UNIT;
}

/* The state moved up by a row, and along x by so many cells, is the other one. */
static void compare_rows(const struct test_run *low, const struct test_run *high, int64_t cells)
{
  const struct solvent *a = &low->state.solvent, *b = &high->state.solvent;
  const int64_t *edge = low->model.box.edge;
  const uint32_t n = a->n;
  struct state copy;
  uint32_t *slot[2] = {calloc(n, sizeof(uint32_t)), calloc(n, sizeof(uint32_t))};
  assert_true(state_alloc(&copy, &low->model));
  for (uint32_t i = 0; i < n; i++) {
    copy.solvent.x[i] = lattice_fold(a->x[i] + cells * LATTICE_CELL, edge[0]);
    copy.solvent.y[i] = a->y[i], copy.solvent.z[i] = a->z[i];
    copy.solvent.vx[i] = a->vx[i], copy.solvent.vy[i] = a->vy[i];
  }
  copy.solvent_time = low->state.solvent_time;
  move_up(&copy, &low->model);
  state_solvent_slots(&low->state, slot[0]);
  state_solvent_slots(&high->state, slot[1]);
  for (uint32_t id = 0; id < n; id++) {
    const uint32_t i = slot[0][id], k = slot[1][id];
    assert_true(apart(copy.solvent.x[i], b->x[k], edge[0]) < 1e-9);
    assert_true(apart(copy.solvent.y[i], b->y[k], edge[1]) < 1e-9);
    assert_true(fabs(copy.solvent.vx[i] - b->vx[k]) < 1e-10);
    assert_true(fabs(copy.solvent.vy[i] - b->vy[k]) < 1e-10);
  }
  free(slot[0]);
  free(slot[1]);
  state_free(&copy);
}

/* A state that is moved up by a row has the same future, but that it drifts along x with the rate. The rule is at-a,
 * which addresses its random numbers by particles, and the drift is a whole cell per collision, so that cells hold the
 * same members. Rounding is not amplified by this rule. In a period of 4 intervals the rate is sqrt(1/2) of the largest
 * in each, forwards or backwards. */
static void compare_futures(double rate, double period)
{
  struct model m = sheared(8, 6, 3, 1.0, rate);
  m.shear.period = period;
  m.solvent.rule = RULE_AT_A;
  m.scheme = SCHEME_PAPER;
  struct test_run low = test_start(m), high = test_start(m);
  move_up(&high.state, &high.model);
  int64_t cells = 0;
  for (uint64_t step = 1; step <= 10; step++) {
    const double each = shear_rate(&low.model, step - 1);
    assert_close(fabs(each), 1.0, 1e-14);
    cells += each > 0.0 ? 1 : -1;
    test_steps(&low, 1);
    test_steps(&high, 1);
    compare_rows(&low, &high, cells);
  }
  test_end(&low);
  test_end(&high);
}

static void rows_are_alike(void **unused)
{
  (void)unused;
  compare_futures(1.0, 0.0);
  compare_futures(sqrt(2.0), 4.0);
}

/* --- memory and halves ------------------------------------------------------------------------------------------- */

/* Where particles stand in memory is not part of their future: every rule, steady and oscillating. */
static void order_in_memory_is_free(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(3003)};
  for (int rule = 0; rule < RULES; rule++)
    for (int oscillates = 0; oscillates < 2; oscillates++) {
      struct model m = sheared(6, 5, 4, 0.25, 0.3);
      m.shear.period = oscillates ? 1.75 : 0.0;
      m.solvent.rule = rule;
      m.solvent.thermostat = collision_rule_of(&m)->thermal ? THERMOSTAT_NONE : THERMOSTAT_RESCALE;
      struct test_run tidy = test_start(m), mixed = test_start(m);
      tidy.work.mpc.since_sort = mixed.work.mpc.since_sort = 1; /* not sorted in this run */
      shuffle_memory(&mixed.state, &d);
      for (int step = 0; step < 30; step++) {
        test_steps(&tidy, 1);
        test_steps(&mixed, 1);
        assert_true(state_hash(&tidy.state) == state_hash(&mixed.state));
      }
      test_end(&tidy);
      test_end(&mixed);
    }
}

/* A flight in parts ends where the whole one does, through the images of every time between; but for the rounding of
 * each part to lattice units. */
static void flights_add_up(void **unused)
{
  (void)unused;
  const uint32_t parts = 8;
  struct model m = sheared(6, 3, 4, 0.5, 0.3);
  m.solvent.collision_interval = 2.0;
  struct test_run whole = test_start(m), halves = test_start(m);
  whole.state.solvent_lag = parts;
  assert_true(fluid_stream(&whole.state, &whole.model, &whole.work.fault));
  for (uint32_t k = 0; k < parts; k++) {
    halves.state.solvent_lag = 1;
    assert_true(fluid_stream(&halves.state, &halves.model, &halves.work.fault));
  }
  const struct solvent *a = &whole.state.solvent, *b = &halves.state.solvent;
  uint32_t crossed = 0;
  for (uint32_t i = 0; i < a->n; i++) {
    /* A particle that is on the boundary to within rounding could be in different images; none of these is. The slide
     * of an image is exact, but a particle's own flight is 8 roundings of half a unit. */
    assert_true(apart(a->x[i], b->x[i], whole.model.box.edge[0]) <= 8 * LATTICE_UNIT);
    assert_true(apart(a->y[i], b->y[i], whole.model.box.edge[1]) <= 8 * LATTICE_UNIT);
    assert_true(fabs(a->vx[i] - b->vx[i]) < 1e-14);
    crossed += fabs(a->vy[i]) * 2.0 > 3.0;
  }
  assert_true(crossed > 10);
  test_end(&whole);
  test_end(&halves);
}

/* --- work becomes heat ------------------------------------------------------------------------------------------- */

/* The solvent by ids, positions unwrapped along y in lattice units. */
struct look {
  uint32_t n;
  int64_t *y;
  struct vec3 *v;
};

static struct look look_at(const struct state *state)
{
  const struct solvent *s = &state->solvent;
  struct look l = {s->n, calloc(s->n, sizeof *l.y), calloc(s->n, sizeof *l.v)};
  for (uint32_t i = 0; i < s->n; i++) {
    l.y[s->id[i]] = s->y[i];
    l.v[s->id[i]] = solvent_velocity(s, i);
  }
  return l;
}

static void look_away(struct look *l)
{
  free(l->y);
  free(l->v);
}

/* Energy relative to the profile rate (y - L/2). */
static double peculiar_energy(const struct look *l, const struct model *m, double rate)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < l->n; i++) {
    struct vec3 v = l->v[i];
    v.x -= rate * ((double)l->y[i] * LATTICE_UNIT - 0.5 * m->box.cells[1]);
    sum += 0.5 * vec3_dot(v, v);
  }
  return sum;
}

/* In a flight: -sum (v_x - rate y_mid) v_y t, times the rate, with y where the particle began. In a collision:
 * -sum y (v_x' - v_x) times the rate; y is that of the member's image in its cell. */
static double work_of_flight(const struct look *before, const struct model *m, double rate, double t)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < before->n; i++) {
    const struct vec3 v = before->v[i];
    const double y = (double)before->y[i] * LATTICE_UNIT - 0.5 * m->box.cells[1] + 0.5 * v.y * t;
    sum -= (v.x - rate * y) * v.y * t;
  }
  return rate * sum;
}

static double work_of_collision(const struct look *before, const struct look *after, const struct model *m, double rate,
                                struct point shift)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < before->n; i++) {
    const bool beyond = before->y[i] + shift.y >= m->box.edge[1];
    const double y = (double)before->y[i] * LATTICE_UNIT - (beyond ? m->box.cells[1] : 0.0);
    sum -= y * (after->v[i].x - before->v[i].x);
  }
  return rate * sum;
}

/* A sheared box without thermostat, collision by collision: the heat is the stress times rate and volume, to rounding.
 * Fails if a velocity or a place is wrong on either side of the boundary, since cells there would not keep energy. */
static void work_becomes_heat(void **unused)
{
  (void)unused;
  struct test_run r = test_start(sheared(7, 6, 5, 0.5, 0.2));
  const struct model *m = &r.model;
  const double rate = m->shear.rate;
  double heat = 0.0, largest = 0.0;
  for (uint64_t step = 1; step <= 60; step++) {
    struct look start = look_at(&r.state);
    r.state.solvent_lag = 2;
    assert_true(fluid_stream(&r.state, m, &r.work.fault));
    struct look middle = look_at(&r.state);
    const double flight = peculiar_energy(&middle, m, rate) - peculiar_energy(&start, m, rate);
    largest = fmax(largest, fabs(flight - work_of_flight(&start, m, rate, m->time_step)));
    assert_true(mpc_collide(&r.state, m, &r.work.mpc, step, &r.work.fault));
    struct look end = look_at(&r.state);
    const double collision = peculiar_energy(&end, m, rate) - peculiar_energy(&middle, m, rate);
    largest = fmax(largest, fabs(collision - work_of_collision(&middle, &end, m, rate, grid_shift(m, step))));
    heat += flight + collision;
    look_away(&start);
    look_away(&middle);
    look_away(&end);
  }
  assert_true(largest < 1e-9);
  assert_true(heat > 10.0); /* there was something to compare */
  test_end(&r);
}

/* The start: thermal velocities about the profile, without momentum relative to it. */
static void starts_with_its_profile(void **unused)
{
  (void)unused;
  struct test_run r = test_start(sheared(8, 10, 8, 0.1, 0.3));
  struct look l = look_at(&r.state);
  const double energy = peculiar_energy(&l, &r.model, 0.3), degrees = 3.0 * (l.n - 1.0);
  assert_sigma(2.0 * energy / degrees, sqrt(2.0 / degrees), 1.0, 5.0);
  double p = 0.0;
  for (uint32_t i = 0; i < l.n; i++)
    p += l.v[i].x - 0.3 * ((double)l.y[i] * LATTICE_UNIT - 5.0);
  assert_true(fabs(p) < 1e-9);
  look_away(&l);
  test_end(&r);
}

static struct vec3 peculiar_momentum(const struct state *state, const struct model *m)
{
  struct look l = look_at(state);
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < l.n; i++) {
    p = vec3_add(p, l.v[i]);
    p.x -= rate_now(m, state) * ((double)l.y[i] * LATTICE_UNIT - 0.5 * m->box.cells[1]);
  }
  look_away(&l);
  return p;
}

/* Momentum relative to the profile is 0 at all times, steady and oscillating. */
static void peculiar_momentum_stays(void **unused)
{
  (void)unused;
  for (int oscillates = 0; oscillates < 2; oscillates++)
    for (int scheme = 0; scheme < SCHEMES; scheme++) {
      struct model m = sheared(5, 6, 4, 0.1, 0.4);
      m.shear.period = oscillates ? 1.3 : 0.0;
      m.scheme = scheme;
      m.solvent.thermostat = THERMOSTAT_RESCALE;
      struct test_run r = test_start(m);
      for (int k = 0; k < 50; k++) {
        test_steps(&r, 3);
        assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
        assert_true(vec3_norm(peculiar_momentum(&r.state, &r.model)) < 1e-8);
      }
      test_end(&r);
    }
}

/* --- statistics -------------------------------------------------------------------------------------------------- */

/* Mean of v_x in slabs of a cell, over collisions, minus the profile, in standard errors of equilibrium: 6 would be an
 * alarm once in 10^6 slabs. A kink at the boundary shows in the first and last slab. */
static void profile_is_linear(void **unused)
{
  (void)unused;
  struct model m = sheared(8, 8, 8, 0.1, 0.1);
  m.solvent.thermostat = THERMOSTAT_MAXWELL_BOLTZMANN;
  struct test_run r = test_start(m);
  double sum[8] = {0}, n[8] = {0};
  const int samples = 400, between = 5;
  for (int k = 0; k < samples; k++) {
    test_steps(&r, between);
    const struct solvent *s = &r.state.solvent;
    for (uint32_t i = 0; i < s->n; i++) {
      const int slab = (int)(s->y[i] >> LATTICE_BITS);
      sum[slab] += s->vx[i] - 0.1 * ((double)s->y[i] * LATTICE_UNIT - 4.0);
      n[slab] += 1.0;
    }
  }
  /* Modes of v_x(y) decay at nu k^2 >= 0.3: a sample is worth 1/(1 + 2/(0.3 between dt)) of an independent one. */
  const double worth = 1.0 / (1.0 + 2.0 / (0.3 * between * 0.1));
  for (int slab = 0; slab < 8; slab++) {
    const double error = 1.0 / sqrt(n[slab] * worth);
    assert_sigma(sum[slab] / n[slab], error, 0.0, 6.0);
  }
  test_end(&r);
}

/* In oscillating shear the profile is the rate of the interval times height, at all times: there is no inertia. */
static void profile_follows(void **unused)
{
  (void)unused;
  struct model m = sheared(8, 8, 8, 0.1, 0.0);
  m.shear.strain = 1.0;
  m.shear.period = 4.0;
  m.solvent.thermostat = THERMOSTAT_MAXWELL_BOLTZMANN;
  struct test_run r = test_start(m);
  double product = 0.0, square = 0.0;
  for (uint64_t step = 1; step <= 400; step++) {
    test_steps(&r, 1);
    const struct solvent *s = &r.state.solvent;
    const double rate = shear_rate(&r.model, shear_interval(&r.model, r.state.solvent_time));
    for (uint32_t i = 0; i < s->n; i++) {
      const double height = (double)s->y[i] * LATTICE_UNIT - 4.0;
      product += s->vx[i] * rate * height;
      square += rate * height * rate * height;
    }
  }
  /* One slope; thermal velocities of 1, correlated over 2/(nu k^2 dt) <= 70 samples. */
  assert_sigma(product / square, sqrt(70.0 / square), 1.0, 5.0);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_shear_is_periodic),    cmocka_unit_test(rows_are_alike),
      cmocka_unit_test(order_in_memory_is_free), cmocka_unit_test(flights_add_up),
      cmocka_unit_test(work_becomes_heat),       cmocka_unit_test(starts_with_its_profile),
      cmocka_unit_test(peculiar_momentum_stays), cmocka_unit_test(profile_is_linear),
      cmocka_unit_test(profile_follows),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
