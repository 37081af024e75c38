/* Error bars: exact small cases, and honesty of the rule on noise of known correlation (coverage). */
#include "support.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "observe/block.h"
#include "observe/tally.h"

enum { LEVELS = 24 };

/* 32 values of +-1. Level 0: variance sum 32, so the error is sqrt(32/(32 31)) = 1/sqrt(31). Alternating, pairs have
 * mean 0, and level 0 is the largest; in equal pairs, level 1 has 16 blocks of +-1 and error 1/sqrt(15). */
static void largest_level_counts(void **unused)
{
  (void)unused;
  struct block_level alternating[LEVELS] = {0}, pairs[LEVELS] = {0};
  for (int i = 0; i < 32; i++) {
    block_add(alternating, LEVELS, i % 2 ? -1 : 1, 0);
    block_add(pairs, LEVELS, i % 4 < 2 ? -1 : 1, 0);
  }
  assert_close(block_error(alternating, LEVELS, 1, 0), 1 / sqrt(31.0), 1e-15);
  assert_close(block_error(pairs, LEVELS, 1, 0), 1 / sqrt(15.0), 1e-15);
  assert_close(block_error(pairs, LEVELS, 3, 0), 3 / sqrt(15.0), 1e-15);
  assert_close(block_error(pairs, 1, 1, 0), 1 / sqrt(31.0), 1e-15);
}

static void few_values_have_no_error(void **unused)
{
  (void)unused;
  struct block_level level[LEVELS] = {0};
  for (int i = 0; i < 15; i++)
    block_add(level, LEVELS, i, 0);
  assert_true(isnan(block_error(level, LEVELS, 1, 0)));
  block_add(level, LEVELS, 15, 0);
  /* variance of 0 .. 15: (16^2 - 1)/12; error of the mean sqrt(340/(16 15)) */
  assert_close(block_error(level, LEVELS, 1, 0), sqrt(340.0 / 240.0), 1e-14);
  assert_close(level[0].mean[0], 7.5, 0);
  assert_close(level[3].mean[0], 7.5, 0);
  assert_close(level[3].count, 2, 0);
}

/* y = 2 x + 1: x - y/2 does not vary, and a large offset costs no digits of the spread. */
static void pairs_know_their_covariance(void **unused)
{
  (void)unused;
  struct block_level level[LEVELS] = {0};
  for (int i = 0; i < 64; i++) {
    const double x = 1e6 + (i * 37 % 64);
    block_add(level, LEVELS, x, 2 * x + 1);
  }
  assert_close(block_error(level, LEVELS, 1, -0.5), 0, 1e-9);
  assert_close(block_error(level, LEVELS, 0, 1) / block_error(level, LEVELS, 1, 0), 2, 1e-12);
  assert_true(block_error(level, LEVELS, 1, 0) >= sqrt((64.0 * 64 - 1) / 12 / 63) * (1 - 1e-12));
}

/* Of so many series x' = phi x + sqrt(1-phi^2) noise, of n values and true mean 0: how often the mean is within two
 * errors, and the mean error over the true one. Autocorrelation phi^t, so the variance of the mean is, exactly,
 * (1/n) [ (1+phi)/(1-phi) - (2 phi/n) (1-phi^n)/(1-phi)^2 ]. */
struct honesty {
  double coverage, ratio;
};

static struct honesty measure_honesty(double phi, int n, int series, unsigned long seed)
{
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  const double variance = ((1 + phi) / (1 - phi) - 2 * phi / n * (1 - pow(phi, n)) / ((1 - phi) * (1 - phi))) / n;
  struct honesty h = {0, 0};
  for (int s = 0; s < series; s++) {
    struct block_level level[LEVELS] = {0};
    double x = gsl_ran_gaussian(rng, 1);
    for (int i = 0; i < n; i++) {
      block_add(level, LEVELS, x, 0);
      x = phi * x + sqrt(1 - phi * phi) * gsl_ran_gaussian(rng, 1);
    }
    const double error = block_error(level, LEVELS, 1, 0);
    h.coverage += fabs(level[0].mean[0]) < 2 * error;
    h.ratio += error / sqrt(variance);
  }
  gsl_rng_free(rng);
  h.coverage /= series;
  h.ratio /= series;
  print_message("  phi %.2f, %d values: %.3f within two errors, error / true error %.3f\n", phi, n, h.coverage,
                h.ratio);
  return h;
}

/* Two standard errors should hold 95.4 %. The bounds are those of docs/observables.md; 2000 series know the coverage to
 * 0.005. Deviations inwards mean false alarms, outwards wasted data. */
static void errors_are_honest(void **unused)
{
  (void)unused;
  static const struct {
    double phi;
    int n;
  } cases[] = {{0, 16}, {0, 100}, {0, 1024}, {0.5, 1024}, {0.9, 4096}, {0.98, 20000}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    const struct honesty h = measure_honesty(cases[k].phi, cases[k].n, 2000, 100 + k);
    assert_close(h.coverage, 0.955, 0.03);
    assert_close(h.ratio, 1.1, 0.15);
  }
}

static void add_sample(const struct tally_shape *shape, double *memory, double (*value)(void *, uint32_t),
                       void *context)
{
  double *sums = calloc(tally_sums(shape), sizeof *sums);
  for (uint32_t f = 0; f < shape->fibers; f++) {
    double pair[1][2] = {{value(context, f), 0}};
    tally_fiber(shape, sums, f, pair);
  }
  tally_add(shape, memory, sums);
  free(sums);
}

static double same_as_ever(void *context, uint32_t fiber)
{
  return ((double *)context)[fiber];
}

/* Fibers that never change: the series has no spread at all, the fibers have. */
static double frozen_coverage(uint32_t fibers, int samples)
{
  const struct tally_shape shape = {fibers, 1, LEVELS};
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, fibers);
  double value[256], covered = 0;
  enum { TRIALS = 1000 };
  for (int trial = 0; trial < TRIALS; trial++) {
    double *memory = calloc(tally_size(&shape), sizeof *memory), mean = 0;
    for (uint32_t f = 0; f < fibers; f++)
      mean += (value[f] = gsl_ran_gaussian(rng, 1)) / fibers;
    for (int s = 0; s < samples; s++)
      add_sample(&shape, memory, same_as_ever, value);
    assert_close(tally_mean(&shape, memory, 0, 0), mean, 1e-12);
    covered += fabs(mean) < 2 * tally_error(&shape, memory, 0, 1, 0);
    free(memory);
  }
  gsl_rng_free(rng);
  print_message("  %u frozen fibers, %d samples: %.3f within two errors\n", fibers, samples, covered / TRIALS);
  return covered / TRIALS;
}

/* Student's t with G-1 degrees of freedom has 2 errors at 91.4 % for G = 8, 94.5 % for 32, 95.0 % for 64 (GSL
 * gsl_cdf_tdist_P); 1000 trials know it to 0.009. 100 fibers in 64 groups: unequal groups. */
static void fibers_tell_what_time_cannot(void **unused)
{
  (void)unused;
  assert_close(frozen_coverage(8, 3), 0.914, 0.03);
  assert_close(frozen_coverage(32, 20), 0.945, 0.03);
  assert_close(frozen_coverage(100, 20), 0.950, 0.03);
}

static double next_digit(void *context, uint32_t fiber)
{
  (void)fiber;
  int *i = context;
  return (*i)++ % 10;
}

static void neither_can_tell(void **unused)
{
  (void)unused;
  const struct tally_shape shape = {7, 1, LEVELS};
  double *memory = calloc(tally_size(&shape), sizeof *memory);
  int digit = 0;
  assert_true(isnan(tally_mean(&shape, memory, 0, 0)) && isnan(tally_error(&shape, memory, 0, 1, 0)));
  for (int s = 0; s < 15; s++)
    add_sample(&shape, memory, next_digit, &digit);
  assert_true(isnan(tally_error(&shape, memory, 0, 1, 0)));
  add_sample(&shape, memory, next_digit, &digit);
  assert_true(tally_error(&shape, memory, 0, 1, 0) > 0);
  assert_close(tally_count(&shape, memory), 16, 0);
  free(memory);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(largest_level_counts),         cmocka_unit_test(few_values_have_no_error),
      cmocka_unit_test(pairs_know_their_covariance),  cmocka_unit_test(errors_are_honest),
      cmocka_unit_test(fibers_tell_what_time_cannot), cmocka_unit_test(neither_can_tell),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
