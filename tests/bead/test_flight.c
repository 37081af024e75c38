/*
 * Flights around a bead.
 *
 * Times of hits: exact rationals (GMP). Flights: a plain simulation in long doubles of all particles and the bead,
 * which looks for the next hit of all and flies there. It shares no cells, no ticks and no lists with the program.
 */
#include "ball.h"
#include "bead/flight.h"
#include "exact.h"
#include "fluid/fluid.h"

__extension__ typedef __int128 wide;

/* --- the tick of a hit ------------------------------------------------------------------------------------------- */

/* Sign of the square of the distance at a tick less R^2. */
static int gap_sign(const struct approach *a, int64_t radius, int64_t tick)
{
  const int64_t x[3] = {a->apart.x, a->apart.y, a->apart.z}, w[3] = {a->rate.x, a->rate.y, a->rate.z};
  mpz_t sum, term;
  mpz_inits(sum, term, NULL);
  for (int k = 0; k < 3; k++) {
    mpz_set_si(term, w[k]);
    mpz_mul_si(term, term, tick);
    mpz_t at;
    mpz_init_set_si(at, x[k]);
    mpz_add(at, at, term);
    mpz_addmul(sum, at, at);
    mpz_clear(at);
  }
  mpz_set_si(term, radius);
  mpz_submul(sum, term, term);
  const int sign = mpz_sgn(sum);
  mpz_clears(sum, term, NULL);
  return sign;
}

/* Is this answer right? `tick` is outside and the next one inside, and no earlier tick is inside: the square of the
 * distance falls until then, which one look at the tick before shows, as it is convex. */
static void check_touch(const struct approach *a, int64_t radius, int64_t most, int64_t tick, long *touches)
{
  const wide along = (wide)a->apart.x * a->rate.x + (wide)a->apart.y * a->rate.y + (wide)a->apart.z * a->rate.z;
  if (tick < 0) {
    /* none: nothing inside at the two ticks around the nearest point, or at the last one */
    const wide square = (wide)a->rate.x * a->rate.x + (wide)a->rate.y * a->rate.y + (wide)a->rate.z * a->rate.z;
    const int64_t lowest = along >= 0 ? 0 : -along / square < most ? (int64_t)(-along / square) : most;
    if (along < 0)
      assert_true(gap_sign(a, radius, lowest) >= 0 && (lowest == most || gap_sign(a, radius, lowest + 1) >= 0));
    return;
  }
  ++*touches;
  assert_true(tick <= most);
  assert_true(along < 0);
  if (gap_sign(a, radius, 0) < 0) {
    assert_true(tick == 0);
    return;
  }
  assert_true(gap_sign(a, radius, tick) >= 0);
  assert_true(gap_sign(a, radius, tick + 1) < 0);
}

/* Head-on, grazing (the line passes at R and a few lattice units), slow, deep inside, from the surface, tangential. */
static struct approach draw_approach(struct dice *d, int kind, int64_t radius)
{
  const double r = (double)radius;
  const struct vec3 n = dice_direction(d), m = dice_direction(d), along = vec3_sub(m, vec3_scale(vec3_dot(m, n), n));
  const struct vec3 side = vec3_scale(1.0 / vec3_norm(along), along);
  const double speed = exp2(dice_between(d, 0.0, 27.0)), away = exp2(dice_between(d, 10.0, 42.0));
  struct vec3 from = vec3_scale(r + away, n), rate = dice_vector(d, speed);
  if (kind == 1) { /* grazing: nearest point at R + a few units, along `side` */
    from = vec3_add_scaled(vec3_scale(r + dice_between(d, -4.0, 4.0), n), -away, side);
    rate = vec3_scale(speed, side);
  } else if (kind == 2) /* on the surface, to a few units */
    from = vec3_scale(r + dice_between(d, -2.0, 2.0), n);
  else if (kind == 3) /* inside */
    from = vec3_scale(r * dice_uniform(d), n);
  else if (kind == 4) /* head-on */
    rate = vec3_scale(-speed, n);
  else if (kind == 5) { /* on the surface, tangential */
    from = vec3_scale(r, n);
    rate = vec3_scale(speed, side);
  }
  return (struct approach){{llrint(from.x), llrint(from.y), llrint(from.z)},
                           {llrint(rate.x), llrint(rate.y), llrint(rate.z)}};
}

static void hits_are_at_the_right_tick(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4101)};
  const long queries = 600000;
  long touches = 0;
  for (long k = 0; k < queries; k++) {
    const int64_t radius = llrint(dice_between(&d, 1.5, 20.0) * LATTICE_PER_A0);
    const struct approach a = draw_approach(&d, (int)(k % 6), radius);
    const int64_t most = dice_integer(&d, 0, FLIGHT_TICKS - 1);
    check_touch(&a, radius, most, bead_touch(&a, radius, most), &touches);
  }
  print_message("  %ld queries, %ld hits\n", queries, touches);
  assert_true(touches > queries / 10);
}

/* --- the plain simulation ---------------------------------------------------------------------------------------- */

static void move(struct ball *b, long double t)
{
  for (int k = 0; k < 3; k++)
    b->x[k] += b->v[k] * t;
}

/* Returns the number of hits. */
static int plain_flight(struct ball *p, uint32_t n, struct ball *bead, long double radius, long double mass,
                        long double time)
{
  int hits = 0;
  for (long double left = time;; hits++) {
    uint32_t who = n;
    long double first = left;
    for (uint32_t i = 0; i < n; i++) {
      const long double t = time_to_bead(&p[i], bead, radius);
      if (t < first)
        first = t, who = i;
    }
    for (uint32_t i = 0; i < n; i++)
      move(&p[i], first);
    move(bead, first);
    left -= first;
    if (who == n)
      return hits;
    for (int k = 0; k < 3; k++) {
      const long double u = (p[who].v[k] + mass * bead->v[k]) / (1 + mass), old = p[who].v[k];
      p[who].v[k] = 2 * u - old;
      bead->v[k] -= (p[who].v[k] - old) / mass;
    }
  }
}

static struct model bead_model(struct dice *d, double mass_over_displaced)
{
  struct model m = test_model(12, 12, 12, 5.0, 0.1, 1);
  m.seed = dice_u64(d);
  m.bead.radius = dice_between(d, 1.5, 2.0);
  m.bead.center = dice_vector(d, 10.0);
  m.bead.mass = mass_over_displaced * 5.0 * 4.18879020478639098 * pow(m.bead.radius, 3.0) * (1.0 + 1e-12);
  return m;
}

/* The flight alone, of all particles: what a collision does before it adds virtual particles. */
static void fly_all(struct test_run *r)
{
  struct bead_flight all = {0};
  struct solvent *s = &r->state.solvent;
  assert_true(bead_flight_alone(&r->state, &r->model, &all, &r->work.fault));
  r->state.solvent_lag = 2;
  assert_true(fluid_points.stream(&r->state, &r->model, 0, s->n, &r->work.fault));
  for (uint32_t k = 0; k < all.n; k++) {
    const struct bead_visit *m = &all.at[k];
    s->x[m->place] = m->at.x, s->y[m->place] = m->at.y, s->z[m->place] = m->at.z;
    set_solvent_v(&r->state, m->place, m->velocity);
  }
  *r->state.bead = all.bead;
  r->state.solvent_lag = 0;
  free(all.at);
}

static void flights_are_those_of_a_plain_simulation(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4102)};
  int hits = 0;
  double furthest = 0.0, fastest = 0.0;
  for (int round = 0; round < 40; round++) {
    struct test_run r = test_start(bead_model(&d, round % 3 == 0 ? 100.0 : 1.0));
    struct solvent *s = &r.state.solvent;
    struct bead *bead = r.state.bead;
    if (round % 2)
      bead->velocity = dice_vector(&d, 1.0);
    struct ball *p = calloc(s->n, sizeof *p), b = {{0, 0, 0}, {bead->velocity.x, bead->velocity.y, bead->velocity.z}};
    for (uint32_t i = 0; i < s->n; i++) {
      const struct vec3 x =
          point_in_a0(bead_to_image(&r.model.box, bead->position, (struct point){s->x[i], s->y[i], s->z[i]}));
      p[i] = (struct ball){{x.x, x.y, x.z}, {s->vx[i], s->vy[i], s->vz[i]}};
    }
    const struct point origin = bead->position;
    const int these = plain_flight(p, s->n, &b, r.model.bead.radius, r.model.bead.mass, r.model.time_step);
    fly_all(&r);
    assert_int_equal(bead->account.z, these);
    hits += these;
    for (uint32_t i = 0; i < s->n; i++) {
      const struct vec3 end = {(double)p[i].x[0], (double)p[i].x[1], (double)p[i].x[2]};
      const struct point expected = point_move(origin, end);
      const struct vec3 off =
          point_in_a0(bead_to_image(&r.model.box, expected, (struct point){s->x[i], s->y[i], s->z[i]}));
      furthest = fmax(furthest, vec3_norm(off));
      fastest = fmax(fastest, fmax(fabs(s->vx[i] - (double)p[i].v[0]),
                                   fmax(fabs(s->vy[i] - (double)p[i].v[1]), fabs(s->vz[i] - (double)p[i].v[2]))));
    }
    furthest = fmax(furthest, vec3_norm(vec3_sub(point_difference(bead->position, origin),
                                                 (struct vec3){(double)b.x[0], (double)b.x[1], (double)b.x[2]})));
    free(p);
    test_end(&r);
  }
  print_message("  %d hits; places to %.2g a0, velocities to %.2g a0/t0\n", hits, furthest, fastest);
  assert_true(hits > 200);
  /* A tick of two bodies that approach at 10 a0/t0 is 1.5e-5 a0; a hit that is early by it moves what follows by twice
   * that. Velocities follow from velocities alone: only the order of hits matters. */
  assert_true(furthest < 5e-5);
  assert_true(fastest < 1e-12);
}

/* --- what a flight keeps ----------------------------------------------------------------------------------------- */

struct total {
  long double momentum[3], energy;
};

static struct total total_of(const struct test_run *r)
{
  const struct solvent *s = &r->state.solvent;
  const struct vec3 w = r->state.bead->velocity;
  const long double mass = r->model.bead.mass;
  struct total t = {{mass * w.x, mass * w.y, mass * w.z}, mass * vec3_dot(w, w) / 2};
  for (uint32_t i = 0; i < s->n; i++) {
    const long double v[3] = {s->vx[i], s->vy[i], s->vz[i]};
    for (int k = 0; k < 3; k++)
      t.momentum[k] += v[k], t.energy += v[k] * v[k] / 2;
  }
  return t;
}

static void assert_outside(const struct test_run *r)
{
  struct fault fault = {.code = FAULT_NONE};
  char text[512];
  if (bead_sound(&r->state, &r->model, &fault))
    return;
  fault_describe(&fault, text, sizeof text);
  fail_msg("%s", text);
}

/* Momentum and energy to rounding, and nobody inside, exactly; with slow, thermal and very fast particles. */
static void flights_keep_momentum_and_energy_and_the_outside(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4103)};
  int64_t hits = 0;
  for (int round = 0; round < 300; round++) {
    struct test_run r = test_start(bead_model(&d, 1.0));
    const double faster = round % 3 == 0 ? 1.0 : round % 3 == 1 ? 0.01 : 10.0;
    for (uint32_t i = 0; i < r.state.solvent.n; i++)
      set_solvent_v(&r.state, i, vec3_scale(faster, solvent_v(&r.state, i)));
    for (int k = 0; k < 4; k++) {
      const struct total before = total_of(&r);
      fly_all(&r);
      const struct total after = total_of(&r);
      assert_close((double)(after.energy - before.energy), 0.0, 1e-13 * (double)before.energy);
      for (int c = 0; c < 3; c++)
        assert_close((double)(after.momentum[c] - before.momentum[c]), 0.0, 1e-11 * faster);
      assert_outside(&r);
    }
    hits += r.state.bead->account.z;
    test_end(&r);
  }
  print_message("  %ld hits\n", (long)hits);
  assert_true(hits > 10000);
}

/* A particle that flies to the bead and back: turned around, everything runs backwards, to the rounding of ticks. */
static void a_head_on_hit(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4104)};
  struct test_run r = test_start(bead_model(&d, 1.0));
  struct solvent *s = &r.state.solvent;
  const double radius = r.model.bead.radius, mass = r.model.bead.mass;
  for (uint32_t i = 0; i < s->n; i++) /* all but one are at rest, as the bead */
    set_solvent_v(&r.state, i, (struct vec3){0, 0, 0});
  r.state.bead->velocity = (struct vec3){0, 0, 0};
  const struct point c = r.state.bead->position, start = point_move(c, (struct vec3){radius + 0.05, 0, 0});
  s->x[0] = lattice_fold(start.x, r.model.box.edge[0]), s->y[0] = lattice_fold(start.y, r.model.box.edge[1]);
  s->z[0] = lattice_fold(start.z, r.model.box.edge[2]);
  set_solvent_v(&r.state, 0, (struct vec3){-1.0, 0.0, 0.0});
  fly_all(&r);
  /* elastic: v' = (M - 1)/(M + 1), V = -2/(M + 1); half of the time to go */
  assert_close(s->vx[0], (mass - 1.0) / (mass + 1.0), 1e-14);
  assert_close(r.state.bead->velocity.x, -2.0 / (mass + 1.0), 1e-14);
  assert_close((double)(r.state.bead->position.x - c.x) * LATTICE_UNIT, -2.0 / (mass + 1.0) * 0.05, 1e-6);
  const struct vec3 off = point_in_a0(bead_to_image(&r.model.box, c, (struct point){s->x[0], s->y[0], s->z[0]}));
  assert_close(off.x, radius + 0.05 * (mass - 1.0) / (mass + 1.0), 1e-5);
  assert_int_equal(r.state.bead->account.z, 1);
  test_end(&r);
}

/* Two particles that hit the bead at one tick: that of the smaller id comes first, wherever both stand in memory. It
 * meets a bead at rest, so it turns straight around; the other one is carried sideways. */
static void two_hits_at_a_tick(void **unused)
{
  (void)unused;
  for (uint32_t first = 0; first < 2; first++) {
    struct dice d = {dice_seed(4105)};
    struct test_run r = test_start(bead_model(&d, 1.0));
    struct solvent *s = &r.state.solvent;
    const double away = r.model.bead.radius + 0.02, mass = r.model.bead.mass;
    for (uint32_t i = 0; i < s->n; i++)
      set_solvent_v(&r.state, i, (struct vec3){0, 0, 0});
    r.state.bead->velocity = (struct vec3){0, 0, 0};
    const uint32_t id = s->id[0];
    s->id[0] = s->id[first], s->id[first] = id;
    for (uint32_t i = 0; i < 2; i++) {
      const double x = i == first ? 1.0 : 0.0, y = 1.0 - x;
      const struct point at = point_move(r.state.bead->position, (struct vec3){away * x, away * y, 0});
      s->x[i] = lattice_fold(at.x, r.model.box.edge[0]), s->y[i] = lattice_fold(at.y, r.model.box.edge[1]);
      s->z[i] = lattice_fold(at.z, r.model.box.edge[2]);
      set_solvent_v(&r.state, i, (struct vec3){-x, -y, 0});
    }
    fly_all(&r);
    assert_int_equal(r.state.bead->account.z, 2);
    assert_close(s->vx[first], (mass - 1.0) / (mass + 1.0), 1e-14);
    assert_true(s->vy[first] == 0.0);
    assert_close(s->vx[1 - first], 2.0 * mass / (mass + 1.0) * (-2.0 / (mass + 1.0)), 1e-14);
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(hits_are_at_the_right_tick),
      cmocka_unit_test(flights_are_those_of_a_plain_simulation),
      cmocka_unit_test(flights_keep_momentum_and_energy_and_the_outside),
      cmocka_unit_test(a_head_on_hit),
      cmocka_unit_test(two_hits_at_a_tick),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
