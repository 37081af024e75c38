/* Averages of single fibers against exact values of the phantom chain, and of simple shapes. */
#include "tables.h"

#include "fiber/start.h"
#include "observe/statics.h"

/* One kind of fibers, started, and sampled once for its statics. */
static struct kept *sample_start(struct fiber_kind kind, unsigned seed)
{
  struct model m = test_model(32, 32, 32, 0, 0.01, 2);
  m.seed = seed;
  struct fiber_kind *k = test_add_kind(&m, 0, 0);
  memcpy(kind.name, k->name, sizeof kind.name);
  *k = kind;
  struct puppet p = puppet_start(m, OBSERVE_STATICS, 10, 0);
  fiber_start(&p.state, &p.model, NULL, &(uint32_t){0});
  puppet_sample(&p);
  struct kept *kept = keep_summaries(p.observers, &p.model);
  puppet_end(&p);
  return kept;
}

static void check(const struct kept *kept, const char *column, double expected)
{
  char error[64];
  snprintf(error, sizeof error, "%s_error", column);
  print_message("  %-12s", column);
  assert_sigma(kept_value(kept, "statics-kind1", 0, column), kept_value(kept, "statics-kind1", 0, error), expected,
               3.5);
}

static struct fiber_kind fibers(uint32_t count, uint32_t vertices, double l0, double k, double kappa)
{
  return (struct fiber_kind){.count = count,
                             .vertices = vertices,
                             .mass = 5,
                             .bond_length = l0,
                             .spring = k,
                             .bending = kappa,
                             .start = START_EQUILIBRIUM};
}

/* The paper's fibers. Lengths from p(l) ~ l^2 exp(-k (l-l0)^2/2), s2 = kT/k: <l> = (l0^3 + 3 l0 s2)/(l0^2 + s2),
 * <l^2> = (l0^4 + 6 l0^2 s2 + 3 s2^2)/(l0^2 + s2), <U> = 0.538462 kT (corrections below 1e-5); bends from exp(kappa
 * cos): <cos> = coth kappa - 1/kappa, <U> = kappa (1 - <cos>); <R^2> = (N-1)<l^2> + 2 <l>^2 sum_d (N-1-d) <cos>^d;
 * R_g^2 as the mean of <R^2> over all pairs; lp = -<l>/ln<cos>. */
static void paper_fibers_in_equilibrium(void **unused)
{
  (void)unused;
  struct kept *kept = sample_start(fibers(3000, 64, 0.5, 100, 64), 5);
  check(kept, "l", 0.538462);
  check(kept, "l2", 0.299231);
  check(kept, "cos", 0.984375);
  check(kept, "bond_energy", 0.538462);
  check(kept, "bend_energy", 1.0);
  check(kept, "Ree2", 849.233);
  check(kept, "Rg2", 82.036);
  check(kept, "lp", -0.538462 / log(0.984375));
  assert_close(kept_value(kept, "statics-kind1", 0, "samples"), 1, 0);
  /* what the errors should be: sd(l) = 0.09638, and bonds are independent; sd of cos is 1/kappa */
  assert_close(kept_value(kept, "statics-kind1", 0, "l_error"), 0.09638 / sqrt(3000.0 * 63), 0.25 * 2.2e-4);
  assert_close(kept_value(kept, "statics-kind1", 0, "cos_error"), 1 / 64.0 / sqrt(3000.0 * 62), 0.25 * 3.6e-5);
  /* lp = -l/ln c, the error of c outweighs that of l: lp (error of c)/(c |ln c|) */
  assert_close(kept_value(kept, "statics-kind1", 0, "lp_error"), 34.19 * 3.62e-5 / (0.984375 * 0.015748), 0.25 * 0.08);
  free(kept);
}

/* Gaussian chain: <l^2> = 3/k = 1, <U> = 3/2 kT, <R^2> = N-1, R_g^2 = (N^2-1)/(6N); no bend, so <cos> = 0. */
static void flexible_chains_in_equilibrium(void **unused)
{
  (void)unused;
  struct kept *kept = sample_start(fibers(4000, 10, 0, 3, 0), 6);
  check(kept, "l", 0.921318);
  check(kept, "l2", 1);
  check(kept, "cos", 0);
  check(kept, "bond_energy", 1.5);
  check(kept, "Ree2", 9);
  check(kept, "Rg2", 1.65);
  assert_close(kept_value(kept, "statics-kind1", 0, "bend_energy"), 0, 0);
  free(kept);
}

/* A ring of 12 bonds of mean length l on a circle: radius l / (2 sin(pi/12)) = R_g, bends of 30 degrees.
 * l: the ratio of the integrals of l^3 and l^2 exp(-50 (l - 0.5)^2) over l > 0, by mpmath's quad at 30 digits (the
 * formula above takes all l). */
static void ring_has_no_ends(void **unused)
{
  (void)unused;
  struct fiber_kind ring = fibers(3, 12, 0.5, 100, 64);
  ring.ring = true;
  ring.start = START_CIRCLE;
  struct kept *kept = sample_start(ring, 7);
  const double l = 0.538461538901396306, radius = 0.5 * l / sin(3.14159265358979324 / 12);
  assert_close(kept_value(kept, "statics-kind1", 0, "l"), l, 1e-12);
  assert_close(kept_value(kept, "statics-kind1", 0, "l2"), l * l, 1e-12);
  assert_close(kept_value(kept, "statics-kind1", 0, "cos"), sqrt(3.0) / 2, 1e-11);
  assert_close(kept_value(kept, "statics-kind1", 0, "bend_energy"), 64 * (1 - sqrt(3.0) / 2), 1e-9);
  assert_close(kept_value(kept, "statics-kind1", 0, "Rg2"), radius * radius, 1e-10);
  assert_true(isnan(kept_value(kept, "statics-kind1", 0, "Ree2")));
  assert_true(isnan(kept_value(kept, "statics-kind1", 0, "Ree2_error")));
  assert_true(isnan(kept_value(kept, "statics-kind1", 0, "l_error"))); /* three fibers, one sample */
  free(kept);
}

/* Points and dumbbells lack bonds or bends; a dumbbell of length l has R_g^2 = l^2/4. */
static void small_kinds(void **unused)
{
  (void)unused;
  struct kept *kept = sample_start(fibers(20, 1, 0.5, 100, 64), 8);
  assert_true(isnan(kept_value(kept, "statics-kind1", 0, "l")));
  assert_true(isnan(kept_value(kept, "statics-kind1", 0, "Ree2_error")));
  assert_close(kept_value(kept, "statics-kind1", 0, "Rg2"), 0, 0);
  free(kept);
  kept = sample_start(fibers(20, 2, 0.5, 100, 64), 8);
  assert_true(isnan(kept_value(kept, "statics-kind1", 0, "cos")));
  assert_true(isnan(kept_value(kept, "statics-kind1", 0, "lp")));
  const double square = kept_value(kept, "statics-kind1", 0, "l2");
  assert_close(kept_value(kept, "statics-kind1", 0, "Ree2"), square, 1e-14);
  assert_close(kept_value(kept, "statics-kind1", 0, "Rg2"), 0.25 * square, 1e-14);
  assert_close(kept_value(kept, "statics-kind1", 0, "l_error"), 0.09638 / sqrt(20.0), 0.012);
  free(kept);
}

/* A bent trimer by hand: bonds of 3 and 4, at a right angle. */
static void shape_of_a_trimer(void **unused)
{
  (void)unused;
  const struct fiber_kind kind = {.vertices = 3};
  const struct point p[3] = {{0, 0, 0}, {3 * LATTICE_CELL, 0, 0}, {3 * LATTICE_CELL, 4 * LATTICE_CELL, 0}};
  const struct fiber_shape s = fiber_shape(&kind, p);
  assert_close(s.length, 3.5, 0);
  assert_close(s.length_squared, 12.5, 0);
  assert_close(s.cosine, 0, 0);
  assert_close(s.end_to_end, 25, 0);
  assert_close(s.gyration, (9 + 25 + 16) / 9.0, 1e-14); /* sum of squared pair distances over N^2 */
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(paper_fibers_in_equilibrium),
      cmocka_unit_test(flexible_chains_in_equilibrium),
      cmocka_unit_test(ring_has_no_ends),
      cmocka_unit_test(small_kinds),
      cmocka_unit_test(shape_of_a_trimer),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
