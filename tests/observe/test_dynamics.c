/* Averages against lag: exact for motions made by hand, honest for random walks. */
#include "tables.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "fiber/start.h"
#include "observe/dynamics.h"

static const char table[] = "dynamics-kind1";

static size_t row_of(const struct kept *kept, double time)
{
  for (size_t row = 0; row < kept->table[0].rows; row++)
    if (fabs(kept_value(kept, kept->table[0].name, row, "time") - time) < 1e-9)
      return row;
  fail_msg("no lag of %g t0", time);
  return 0;
}

static double at(const struct kept *kept, double time, const char *column)
{
  return kept_value(kept, table, row_of(kept, time), column);
}

static void shift_fiber(struct puppet *p, uint32_t fiber, struct vec3 by)
{
  for (uint32_t v = p->model.fiber_first[fiber]; v < p->model.fiber_first[fiber + 1]; v++)
    p->state.position[v] = point_move(p->state.position[v], by);
}

static void lags_are_powers_of_two_and_three_halves_of_them(void **unused)
{
  (void)unused;
  const uint64_t expected[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
  for (uint32_t k = 0; k < 12; k++)
    assert_true(dynamics_lag(k) == expected[k]);
}

/* Free vertices, each at its own constant velocity v: g = g_cm = d^2 = <v^2> t^2 at every lag, number of intervals =
 * floor(samples/lag), D = g/6t. Velocities are multiples of 2^-10, so every move is exact. Sampled every 5 steps. */
static void free_flight(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.125, 1);
  test_add_kind(&m, 10, 1);
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 5, 5 * 24);
  double mean = 0;
  for (uint64_t step = 0; step <= 500; step++) {
    p.state.step = step;
    if (observers_due(p.observers, step))
      puppet_sample(&p);
    for (uint32_t i = 0; step < 500 && i < 10; i++)
      shift_fiber(&p, i, (struct vec3){i * 0x1p-10, 0x1p-6, -(i * 0x1p-9)});
  }
  for (int i = 0; i < 10; i++)
    mean += (i * i * (0x1p-20 + 0x1p-18) + 0x1p-12) * 64 / 10; /* (a0/t0)^2: per step of 1/8 t0 */
  struct kept *kept = keep_summaries(p.observers, &p.model);
  assert_int_equal(kept->table[0].rows, 9); /* 1, 2, 3, 4, 6, 8, 12, 16, 24 */
  for (size_t row = 0; row < 9; row++) {
    const double lag = (double)dynamics_lag((uint32_t)row), t = 5 * 0.125 * lag, g = mean * t * t;
    assert_close(kept_value(kept, table, row, "time"), t, 0);
    assert_close(kept_value(kept, table, row, "intervals"), floor(100 / lag), 0);
    assert_close(kept_value(kept, table, row, "g"), g, 1e-13 * g);
    assert_close(kept_value(kept, table, row, "g_cm"), g, 1e-13 * g);
    assert_close(kept_value(kept, table, row, "g_middle"), g, 1e-13 * g);
    assert_close(kept_value(kept, table, row, "d2"), g, 1e-13 * g);
    assert_close(kept_value(kept, table, row, "d2_contour"), g, 1e-13 * g);
    assert_close(kept_value(kept, table, row, "d2_third"), g, 1e-13 * g);
    assert_close(kept_value(kept, table, row, "D"), g / (6 * t), 1e-13 * g / t);
    assert_true(isnan(kept_value(kept, table, row, "end_to_end")));
    assert_true(isnan(kept_value(kept, table, row, "axis_unit")));
  }
  free(kept);
  puppet_end(&p);
}

/* A straight fiber along x with bonds l, shifted as a whole by `by`. */
static struct fiber_motion straight_shifted(uint32_t vertices, double l, struct vec3 by, struct vec3 drift)
{
  const struct fiber_kind kind = {.vertices = vertices};
  struct point then[64], now[64];
  struct vec3 scratch[64];
  for (uint32_t j = 0; j < vertices; j++) {
    then[j] = point_move((struct point){0, 0, 0}, (struct vec3){j * l, 3, -2});
    now[j] = point_move(then[j], by);
  }
  return fiber_motion(&kind, then, now, drift, scratch);
}

/* Across its axis, a stiff fiber's g, g_cm and d^2 are all the squared shift, nothing turns; in a frame that moves
 * along, nothing moves. */
static void rigid_translation(void **unused)
{
  (void)unused;
  const struct vec3 by = {0, 0.75, -0.5}, rest = {0, 0, 0};
  const double square = 0.75 * 0.75 + 0.25;
  const struct fiber_motion m = straight_shifted(64, 0.5, by, rest), moving = straight_shifted(64, 0.5, by, by);
  assert_close(m.vertices, square, 1e-15);
  assert_close(m.center, square, 1e-15);
  assert_close(m.middle, square, 1e-15);
  assert_close(m.tube, square, 1e-15);
  assert_close(m.tube_contour, square, 1e-15);
  assert_close(m.tube_third, square, 1e-15);
  assert_close(m.axis, 1, 1e-15);
  assert_close(m.turned, 0, 0);
  assert_close(m.square, 31.5 * 31.5, 0);
  assert_close(m.cosine, 1, 1e-15);
  assert_close(moving.vertices + moving.center + moving.middle + moving.tube + moving.tube_contour, 0, 0);
}

/* Along its axis the contour stays where it was, so the distance from it is 0, but the nearest vertex is up to l/2
 * away: over all shifts <d^2> = l^2/12 (a sawtooth). Beyond the end both count the distance from the end. */
static void reptation_along_a_straight_line(void **unused)
{
  (void)unused;
  double floor_of_vertices = 0;
  enum { SHIFTS = 1024 };
  for (int k = 0; k < SHIFTS; k++) {
    const double shift = (k + 0.5) / SHIFTS;
    const struct fiber_motion m = straight_shifted(64, 0.5, (struct vec3){4 * shift, 0, 0}, (struct vec3){0, 0, 0});
    assert_close(m.tube_contour, 0, 1e-20);
    assert_true(m.tube <= 0.0625 + 1e-12);
    floor_of_vertices += m.tube / SHIFTS;
  }
  assert_close(floor_of_vertices, 0.25 / 12, 1e-5);
  /* middle is vertex 31 of 0..63 (the paper's 32 of 1..64), 16 a0 before the end: 20 a0 on, it is 4 beyond */
  const struct fiber_motion out = straight_shifted(64, 0.5, (struct vec3){20, 0, 0}, (struct vec3){0, 0, 0});
  assert_close(out.tube, 16, 1e-12);
  assert_close(out.tube_contour, 16, 1e-12);
  /* and 15.5 after its beginning: 20 a0 back, it is 4.5 before */
  const struct fiber_motion back = straight_shifted(64, 0.5, (struct vec3){-20, 0, 0}, (struct vec3){0, 0, 0});
  assert_close(back.tube, 4.5 * 4.5, 1e-12);
  /* less than a bond beyond either end */
  assert_close(straight_shifted(64, 0.5, (struct vec3){16.25, 0, 1}, (struct vec3){0, 0, 0}).tube_contour, 1.0625,
               1e-12);
  assert_close(straight_shifted(64, 0.5, (struct vec3){-15.75, 0, 1}, (struct vec3){0, 0, 0}).tube_contour, 1.0625,
               1e-12);
}

/* A straight fiber of 64 vertices that is bent across by f(j). */
static struct fiber_motion straight_bent(double (*f)(double j))
{
  const struct fiber_kind kind = {.vertices = 64};
  struct point then[64], now[64];
  struct vec3 scratch[64];
  for (uint32_t j = 0; j < 64; j++) {
    then[j] = point_move((struct point){0, 0, 0}, (struct vec3){0.5 * j, 0, 0});
    now[j] = point_move(then[j], (struct vec3){0, f(j), 0});
  }
  return fiber_motion(&kind, then, now, (struct vec3){0, 0, 0}, scratch);
}

static double slope(double j)
{
  return j / 64;
}

/* The third power without its part along j - 31.5: sum x^4/sum x^2 = (3 n^2 - 7)/20 of n = 64 numbers about 0. */
static double wave(double j)
{
  const double x = j - 31.5;
  return 1e-4 * x * (x * x - (3 * 64 * 64 - 7) / 20.0);
}

/* The vertices of 0..63 that stand for the middle third are 22, 24, 27, 30, 32, 35, 38 and 40, 8 of 21..42 spread
 * evenly. Each is f(j) away from the contour that it left. */
static void middle_third_is_averaged(void **unused)
{
  (void)unused;
  const double j[8] = {22, 24, 27, 30, 32, 35, 38, 40};
  double mean = 0;
  for (int k = 0; k < 8; k++)
    mean += slope(j[k]) * slope(j[k]) / 8;
  assert_close(straight_bent(slope).tube_third, mean, 1e-12);
  /* A fiber of one to three vertices has one of them. */
  for (uint32_t n = 1; n < 4; n++) {
    const struct fiber_kind kind = {.vertices = n};
    assert_int_equal(dynamics_third(&kind), 1);
    assert_int_equal(dynamics_third_vertex(&kind, 0), dynamics_middle(&kind));
  }
}

/* A tilt turns both vectors by the same angle. A bend without tilt turns the end-to-end vector and leaves the
 * regression axis where it was. */
static void bends_do_not_turn_the_regression_axis(void **unused)
{
  (void)unused;
  const struct fiber_motion tilted = straight_bent(slope), bent = straight_bent(wave);
  assert_close(tilted.axis, cos(atan(1.0 / 32)), 1e-12);
  assert_close(tilted.cosine, cos(atan(1.0 / 32)), 1e-12);
  assert_close(bent.axis, 1, 1e-15);
  assert_close(bent.cosine, cos(atan(2 * wave(63) / 31.5)), 1e-12);
  assert_true(bent.cosine < 1 - 1e-4);
}

/* A square ring, 3 a0 wide, of 4 vertices: the middle one (number 1) moves to the middle of the closing bond. */
static void closing_bond_belongs_to_the_contour(void **unused)
{
  (void)unused;
  struct fiber_kind kind = {.vertices = 4, .ring = true};
  const int64_t a = 3 * LATTICE_CELL;
  const struct point then[4] = {{0, 0, 0}, {a, 0, 0}, {a, a, 0}, {0, a, 0}};
  struct point now[4];
  struct vec3 scratch[4];
  memcpy(now, then, sizeof now);
  now[1] = (struct point){LATTICE_CELL / 2, a / 2, 0};
  struct fiber_motion m = fiber_motion(&kind, then, now, (struct vec3){0, 0, 0}, scratch);
  assert_close(m.tube, 0.25 + 2.25, 1e-14);
  assert_close(m.tube_contour, 0.25, 1e-14);
  assert_close(m.turned + m.square + m.cosine + m.axis, 0, 0);
  kind.ring = false;
  m = fiber_motion(&kind, then, now, (struct vec3){0, 0, 0}, scratch);
  assert_close(m.tube_contour, 2.25, 1e-14);
}

/* Two fibers of lengths 1 and 3, turned by 30 degrees per sample: <R(t).R(0)>/<R^2> = cos(30 t), whatever the lengths.
 * Then the long one stands still: (1 cos(30 t) + 9)/10, but the unit vectors' mean is (cos(30 t) + 1)/2. */
static void end_to_end_vector_turns(void **unused)
{
  (void)unused;
  const double degrees = 3.14159265358979324 / 180;
  for (int still = 0; still < 2; still++) {
    struct model m = test_model(8, 8, 8, 0, 0.5, 1);
    test_add_kind(&m, 2, 2)->spring = 10.0;
    struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 1, 12);
    for (p.state.step = 0; p.state.step <= 48; p.state.step++) {
      for (uint32_t f = 0; f < 2; f++) {
        const double angle = f && still ? 0 : 30 * degrees * (double)p.state.step, l = f ? 3 : 1;
        p.state.position[2 * f] = point_move((struct point){0, 0, 0}, (struct vec3){5 * sin(angle), 0, 1});
        p.state.position[2 * f + 1] =
            point_move(p.state.position[2 * f], (struct vec3){l * cos(angle), l * sin(angle), 0});
      }
      puppet_sample(&p);
    }
    struct kept *kept = keep_summaries(p.observers, &p.model);
    for (uint32_t k = 0; k < 7; k++) {
      const double lag = (double)dynamics_lag(k), c = cos(30 * degrees * lag);
      assert_close(at(kept, 0.5 * lag, "end_to_end"), still ? (c + 9) / 10 : c, 1e-11);
      assert_close(at(kept, 0.5 * lag, "end_to_end_unit"), still ? (c + 1) / 2 : c, 1e-11);
      assert_close(at(kept, 0.5 * lag, "axis_unit"), still ? (c + 1) / 2 : c, 1e-11);
    }
    free(kept);
    puppet_end(&p);
  }
}

/* Eight fibers of lengths 1 to 8 that all turn by 90 degrees: however their lengths scatter, the ratio is 0 without
 * error, since |R(t) - R(0)|^2 / 2 and R^2 scatter together, by 30 % of the mean. */
static void error_of_the_ratio_knows_both_parts(void **unused)
{
  (void)unused;
  struct model m = test_model(32, 32, 32, 0, 1, 1);
  test_add_kind(&m, 8, 2)->spring = 2.0;
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 1, 1);
  for (p.state.step = 0; p.state.step < 4; p.state.step++) {
    for (uint32_t f = 0; f < 8; f++) {
      const int64_t length = (f + 1) * LATTICE_CELL;
      p.state.position[2 * f + 1] = p.state.step % 2 ? (struct point){length, 0, 0} : (struct point){0, length, 0};
    }
    puppet_sample(&p);
  }
  struct kept *kept = keep_summaries(p.observers, &p.model);
  assert_close(at(kept, 1, "end_to_end"), 0, 1e-15);
  assert_close(at(kept, 1, "end_to_end_error"), 0, 1e-15);
  /* one end stands still, so g = length^2: over {1, 4, ..., 64}, the mean and the squared deviations over 8 x 7 */
  assert_close(at(kept, 1, "g"), 25.5, 1e-12);
  assert_close(at(kept, 1, "g_error"), sqrt((8772 - 8 * 25.5 * 25.5) / 56), 1e-12); /* 8772 = sum of fourth powers */
  free(kept);
  puppet_end(&p);
}

/* Everything drifts with the flow, and speeds up under a net body force: in its own frame nothing happens. One fiber
 * also moves by itself: that is all that is seen. A step of 1/8 t0, x = u t + a t^2/2. */
static void background_motion_is_taken_out(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 5, 0.125, 1);
  struct fiber_kind *kind = test_add_kind(&m, 8, 4);
  kind->bending = 8.0;
  m.flow = (struct vec3){0.54, -0.25, 0.125};
  m.solvent.acceleration = (struct vec3){0, 0, 0.0625};
  kind->force = (struct vec3){0, 0, 5 * 0.0625}; /* M = 5: the same acceleration for all */
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 2, 64);
  struct point *start = malloc(p.model.vertices * sizeof *start);
  fiber_start(&p.state, &p.model, NULL, &(uint32_t){0});
  memcpy(start, p.state.position, p.model.vertices * sizeof *start);
  for (p.state.step = 0; p.state.step <= 128; p.state.step++) {
    const double t = 0.125 * (double)p.state.step;
    struct vec3 d = vec3_scale(t, p.model.flow);
    d.z += 0.5 * 0.0625 * t * t;
    for (uint32_t v = 0; v < p.model.vertices; v++)
      p.state.position[v] = point_move(start[v], d);
    shift_fiber(&p, 3, (struct vec3){0.5 * t, 0, 0});
    if (observers_due(p.observers, p.state.step))
      puppet_sample(&p);
  }
  struct kept *kept = keep_summaries(p.observers, &p.model);
  for (size_t row = 0; row < kept->table[0].rows; row++) {
    const double t = kept_value(kept, table, row, "time");
    assert_close(kept_value(kept, table, row, "g"), 0.25 * t * t / 8, 1e-9);
    assert_close(kept_value(kept, table, row, "g_cm"), 0.25 * t * t / 8, 1e-9);
  }
  free(kept);
  free(start);
  puppet_end(&p);
}

/* A random walk of `walkers` points with variance `step` per component and sample: g = 3 step lag, D = step/(2 dt). */
static struct kept *walk(uint32_t walkers, double step, uint64_t samples, unsigned long seed)
{
  struct model m = test_model(8, 8, 8, 0, 1, 1);
  test_add_kind(&m, walkers, 1);
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 1, samples);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  for (p.state.step = 0; p.state.step <= samples; p.state.step++) {
    puppet_sample(&p);
    for (uint32_t i = 0; i < walkers; i++) {
      const double x = gsl_ran_gaussian(rng, sqrt(step)), y = gsl_ran_gaussian(rng, sqrt(step));
      shift_fiber(&p, i, (struct vec3){x, y, gsl_ran_gaussian(rng, sqrt(step))});
    }
  }
  gsl_rng_free(rng);
  struct kept *kept = keep_summaries(p.observers, &p.model);
  puppet_end(&p);
  return kept;
}

/* How often g and D are within two errors of the truth over 200 walks; 200 know 95 % to 1.5 %. The squared displacement
 * of one interval is skew (chi^2 with 3 degrees of freedom), which costs coverage where intervals x walkers are few. */
static void check_coverage(uint32_t walkers, uint64_t lag, double low)
{
  enum { WALKS = 200 };
  int g = 0, d = 0;
  for (unsigned long seed = 1; seed <= WALKS; seed++) {
    struct kept *kept = walk(walkers, 0.25, 256, seed);
    const double t = (double)lag;
    g += fabs(at(kept, t, "g") - 0.75 * t) < 2 * at(kept, t, "g_error");
    d += fabs(at(kept, t, "D") - 0.125) < 2 * at(kept, t, "D_error");
    free(kept);
  }
  print_message("  %u walkers, lag %u of 256: g within two errors %.3f\n", walkers, (unsigned)lag, g / (double)WALKS);
  assert_int_equal(g, d);
  assert_true(g >= low * WALKS && g <= 0.998 * WALKS);
}

static void error_bars_of_a_random_walk_are_honest(void **unused)
{
  (void)unused;
  check_coverage(4, 1, 0.92);   /* blocks of time only: four walkers are too few to ask */
  check_coverage(4, 8, 0.86);   /* 32 intervals */
  check_coverage(64, 1, 0.92);  /* both */
  check_coverage(64, 64, 0.90); /* walkers only: four intervals */
}

static void no_error_where_nothing_tells(void **unused)
{
  (void)unused;
  struct kept *kept = walk(4, 0.25, 64, 1);
  assert_true(isnan(at(kept, 6, "g_error"))); /* 10 intervals of 4 walkers */
  assert_true(at(kept, 4, "g_error") > 0);    /* 16 intervals */
  free(kept);
}

/* A sample that was never shown ends the interval it belongs to, without a comparison. */
static void missing_samples_make_no_intervals(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 1, 1);
  test_add_kind(&m, 1, 1);
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 1, 2);
  for (p.state.step = 0; p.state.step <= 8; p.state.step++) {
    p.state.position[0].x = (int64_t)p.state.step * LATTICE_CELL;
    if (p.state.step != 4)
      puppet_sample(&p);
  }
  struct kept *kept = keep_summaries(p.observers, &p.model);
  assert_close(at(kept, 1, "intervals"), 6, 0); /* 0-1-2-3, 5-6-7-8 */
  assert_close(at(kept, 2, "intervals"), 2, 0); /* 0-2, (2-4 is missing) 5-7 */
  assert_close(at(kept, 1, "g"), 1, 0);
  assert_close(at(kept, 2, "g"), 4, 0);
  free(kept);
  puppet_end(&p);
}

/* Two kinds do not mix: the second's numbers are its own. */
static void kinds_are_kept_apart(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 1, 1);
  test_add_kind(&m, 3, 5);
  test_add_kind(&m, 2, 7)->ring = true;
  for (int k = 0; k < 2; k++)
    m.kind[k].spring = 2.0, m.kind[k].bending = 0.0;
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 1, 4);
  for (p.state.step = 0; p.state.step <= 8; p.state.step++) {
    puppet_sample(&p);
    for (uint32_t f = 0; f < 5; f++)
      shift_fiber(&p, f, (struct vec3){f < 3 ? 1 : 0, f < 3 ? 0 : 2, 0});
  }
  struct kept *kept = keep_summaries(p.observers, &p.model);
  assert_int_equal(kept->tables, 2);
  for (size_t row = 0; row < 4; row++) {
    const double t = kept_value(kept, "dynamics-kind2", row, "time");
    assert_close(kept_value(kept, "dynamics-kind1", row, "g"), t * t, 0);
    assert_close(kept_value(kept, "dynamics-kind2", row, "g_cm"), 4 * t * t, 0);
    assert_true(isnan(kept_value(kept, "dynamics-kind2", row, "end_to_end")));
  }
  free(kept);
  puppet_end(&p);
}

/* A coordinate within some a0 of 0, in lattice units. */
static int64_t any_place(gsl_rng *random, double within)
{
  return (int64_t)((2.0 * gsl_rng_uniform(random) - 1.0) * within * LATTICE_PER_A0);
}

static void random_fiber(gsl_rng *random, uint32_t n, struct point start, double moved, struct point *origin,
                         struct point *now)
{
  for (uint32_t j = 0; j < n; j++) {
    const struct point bond = {any_place(random, 0.6), any_place(random, 0.6), any_place(random, 0.6)},
                       by = {any_place(random, moved), any_place(random, moved), any_place(random, moved)};
    origin[j] = j > 0 ? point_plus(origin[j - 1], bond) : start;
    now[j] = point_plus(origin[j], by);
  }
}

/* By columns and point by point: the same bits, also of fibers that do not fill the last column, rings, and fibers that
 * are too long or went too far for columns. */
static void columns_make_the_same_bits(void **unused)
{
  (void)unused;
  static const uint32_t lengths[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 24, 63, 64, 255, 256, 257};
  static const double moves[] = {0.0, 0.01, 0.3, 3.0, 100.0, 5000.0, 1e5};
  enum { MOST = 300, TIMES = 30 };
  struct point origin[MOST], now[MOST];
  struct vec3 scratch[MOST];
  gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
  for (size_t l = 0; l < sizeof lengths / sizeof *lengths; l++)
    for (size_t m = 0; m < sizeof moves / sizeof *moves; m++)
      for (int time = 0; time < TIMES; time++) {
        const struct fiber_kind kind = {.vertices = lengths[l], .ring = time % 3 == 0 && lengths[l] > 2};
        const struct vec3 drift = time % 2 ? (struct vec3){0.1, -2.0, 1e-3} : (struct vec3){0, 0, 0};
        const struct point start = {time % 5 ? 0 : LATTICE_REACH / 2, any_place(random, 9.0), -any_place(random, 1e5)};
        random_fiber(random, lengths[l], start, moves[m], origin, now);
        const struct fiber_motion fast = fiber_motion(&kind, origin, now, drift, scratch),
                                  plain = fiber_motion_plain(&kind, origin, now, drift, scratch);
        assert_memory_equal(&fast, &plain, sizeof plain);
      }
  gsl_rng_free(random);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lags_are_powers_of_two_and_three_halves_of_them),
      cmocka_unit_test(free_flight),
      cmocka_unit_test(rigid_translation),
      cmocka_unit_test(reptation_along_a_straight_line),
      cmocka_unit_test(middle_third_is_averaged),
      cmocka_unit_test(bends_do_not_turn_the_regression_axis),
      cmocka_unit_test(closing_bond_belongs_to_the_contour),
      cmocka_unit_test(end_to_end_vector_turns),
      cmocka_unit_test(error_of_the_ratio_knows_both_parts),
      cmocka_unit_test(background_motion_is_taken_out),
      cmocka_unit_test(error_bars_of_a_random_walk_are_honest),
      cmocka_unit_test(no_error_where_nothing_tells),
      cmocka_unit_test(missing_samples_make_no_intervals),
      cmocka_unit_test(kinds_are_kept_apart),
      cmocka_unit_test(columns_make_the_same_bits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
