/* Verdicts on tables of observables: single numbers by hand, rates of false alarms and of detection by drawing tables
 * from the errors of the committed reference. */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "oracle/judge.h"
#include "support.h"

static struct observable_mean row(const char *name, double value, double error, double blocks)
{
  struct observable_mean r = {.value = value, .error = error, .blocks = blocks, .theory = NAN, .resolve = 0.02};
  snprintf(r.name, sizeof r.name, "%s", name);
  return r;
}

static void one_observable_by_hand(void **unused)
{
  (void)unused;
  const struct observable_mean ours = row("a", -2.0, 0.003, 11), theirs = row("a", -1.98, 0.004, 21);
  const struct judgement j = judge_one(&ours, &theirs, 1e-3);
  assert_close(j.difference, 0.02, 1e-15);
  assert_close(j.error, 0.005, 1e-15);
  assert_true(j.freedoms == 29.0); /* 625/(81/10 + 256/20) = 29.9 */
  assert_close(j.t, 4.0, 1e-12);
  assert_close(j.p, 2.0 * gsl_cdf_tdist_Q(4.0, 29.0), 1e-12);
  /* scipy.stats: limit = t.isf(.5e-3, 29); brentq(lambda d: nct.sf(limit, 29, d) - .9, 3, 9) */
  assert_close(j.sees, 5.0499 * 0.005 / 2.0, 1e-3 * j.sees);
  assert_true(j.judged && !j.differs);
}

static void what_cannot_be_judged(void **unused)
{
  (void)unused;
  const struct observable_mean ours = row("a", 1.0, 1e-4, 40), coarse = row("a", 1.0, 0.006, 40),
                               few = row("a", 5.0, 1e-4, JUDGE_LEAST_BLOCKS - 1),
                               enough = row("a", 1.0, 1e-4, JUDGE_LEAST_BLOCKS);
  assert_false(judge_one(&ours, &coarse, 1e-3).judged);
  assert_false(judge_one(&ours, NULL, 1e-3).judged);
  assert_true(judge_one(&ours, NULL, 1e-3).p == 1.0);
  assert_false(judge_one(&ours, &few, 1e-3).judged);
  assert_true(judge_one(&ours, &few, 1e-3).p == 1.0);
  assert_true(judge_one(&ours, &enough, 1e-3).judged);
}

/* R: p.adjust(c(.01, .04, .03, .005), "holm") is .03 .06 .06 .02. */
static void holm_by_hand(void **unused)
{
  (void)unused;
  const double p[] = {0.01, 0.04, 0.03, 0.005};
  const struct {
    double rate;
    bool differs[4];
  } cases[] = {{0.05, {1, 0, 0, 1}}, {0.061, {1, 1, 1, 1}}, {0.025, {0, 0, 0, 1}}, {0.019, {0, 0, 0, 0}}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    struct judgement j[4] = {{.p = p[0]}, {.p = p[1]}, {.p = p[2]}, {.p = p[3]}};
    judge_together(j, 4, cases[c].rate);
    for (int k = 0; k < 4; k++)
      assert_int_equal(j[k].differs, cases[c].differs[k]);
  }
}

/* --- whole tables ------------------------------------------------------------------------------------------------- */

static enum judge_verdict verdict_of(const struct observable_means *ours, const struct observable_means *theirs,
                                     const char *only)
{
  struct message message;
  enum judge_verdict verdict;
  FILE *out = fopen("/dev/null", "w");
  const struct judge_options options = {1e-3, only};
  assert_true(oracle_judge(ours, theirs, &options, out, &verdict, &message));
  fclose(out);
  return verdict;
}

static void verdicts(void **unused)
{
  (void)unused;
  const struct observable_mean a = row("a", 1.0, 1e-3, 40), b = row("b", 2.0, 1e-3, 40), far = row("b", 2.02, 1e-3, 40),
                               coarse = row("b", 2.0, 0.1, 40);
  const struct observable_means ours = {2, {a, b}}, swapped = {2, {b, a}}, part = {1, {a}}, wrong = {2, {a, far}},
                                wrong_part = {1, {far}}, vague = {2, {a, coarse}};
  assert_int_equal(verdict_of(&ours, &ours, NULL), JUDGE_CONSISTENT);
  assert_int_equal(verdict_of(&ours, &swapped, NULL), JUDGE_CONSISTENT);
  assert_int_equal(verdict_of(&ours, &part, NULL), JUDGE_CANNOT_TELL);
  assert_int_equal(verdict_of(&ours, &part, "a"), JUDGE_CONSISTENT);
  assert_int_equal(verdict_of(&ours, &vague, NULL), JUDGE_CANNOT_TELL);
  assert_int_equal(verdict_of(&ours, &vague, "a"), JUDGE_CONSISTENT);
  assert_int_equal(verdict_of(&ours, &wrong, NULL), JUDGE_DIFFERS);
  assert_int_equal(verdict_of(&ours, &wrong_part, NULL), JUDGE_DIFFERS);
  assert_int_equal(verdict_of(&ours, &wrong, "a"), JUDGE_CONSISTENT);
}

/* --- rates, by drawing -------------------------------------------------------------------------------------------- */

#define THEIR_BLOCKS 40

static void read_reference(struct observable_means *reference)
{
  struct message message;
  if (!observable_means_read("reference-data/observables.csv", NULL, reference, &message))
    fail_msg("%s", message.text);
}

/* The mean and the standard error of so many normal blocks: independent, and the latter from chi^2. */
static void draw(gsl_rng *rng, struct observable_mean *r, double mean, double block_spread, double blocks)
{
  const double error = block_spread / sqrt(blocks);
  r->value = mean + gsl_ran_gaussian(rng, error);
  r->error = error * sqrt(gsl_ran_chisq(rng, blocks - 1.0) / (blocks - 1.0));
  r->blocks = blocks;
}

/* Tables of theirs and of ours, both drawn from the reference's values and errors: how many are found different. */
static void false_alarms(double rate, uint32_t tables, unsigned long seed)
{
  struct observable_means truth, ours, theirs;
  struct judgement judgement[OBSERVABLES_MOST];
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  read_reference(&truth);
  ours = theirs = truth;
  uint32_t alarms = 0;
  for (uint32_t n = 0; n < tables; n++) {
    bool any = false;
    for (size_t k = 0; k < truth.count; k++) {
      const struct observable_mean *t = &truth.row[k];
      draw(rng, &ours.row[k], t->value, t->error * sqrt(t->blocks), t->blocks);
      draw(rng, &theirs.row[k], t->value, t->error * sqrt(t->blocks), THEIR_BLOCKS);
      judgement[k] = judge_one(&ours.row[k], &theirs.row[k], rate / (double)truth.count);
    }
    judge_together(judgement, truth.count, rate);
    for (size_t k = 0; k < truth.count; k++)
      any |= judgement[k].differs;
    alarms += any;
  }
  gsl_rng_free(rng);
  /* Independent observables: 1 - (1 - rate/n)^n. 3.3 standard errors: fails by chance once in a thousand. */
  const double expected = 1.0 - pow(1.0 - rate / (double)truth.count, (double)truth.count);
  assert_sigma((double)alarms / tables, sqrt(expected * (1.0 - expected) / tables), expected, 3.3);
}

static void false_alarms_are_as_rare_as_stated(void **unused)
{
  (void)unused;
  false_alarms(0.05, 6000, 1);
  false_alarms(1e-3, 20000, 2);
}

/* A difference of the size `sees`, put into one observable, is found in 90 % of the tables: 10000 of them, of 3.3
 * standard errors. */
static void what_it_says_it_sees_is_seen(void **unused)
{
  (void)unused;
  struct observable_means truth;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 3);
  read_reference(&truth);
  const struct observable_mean *t = observable_means_find(&truth, "viscosity");
  assert_non_null(t);
  struct observable_mean ours = *t, theirs = *t;
  const double level = 1e-3 / (double)truth.count, spread = t->error * sqrt(t->blocks);
  theirs.blocks = THEIR_BLOCKS;
  theirs.error = spread / sqrt(THEIR_BLOCKS);
  const double away = judge_one(&ours, &theirs, level).sees * t->value;
  uint32_t seen = 0;
  const uint32_t tables = 10000;
  for (uint32_t n = 0; n < tables; n++) {
    draw(rng, &ours, t->value, spread, t->blocks);
    draw(rng, &theirs, t->value + away, spread, THEIR_BLOCKS);
    seen += judge_one(&ours, &theirs, level).p < level;
  }
  gsl_rng_free(rng);
  assert_sigma((double)seen / tables, sqrt(0.9 * 0.1 / tables), 0.9, 3.3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_observable_by_hand),
      cmocka_unit_test(what_cannot_be_judged),
      cmocka_unit_test(holm_by_hand),
      cmocka_unit_test(verdicts),
      cmocka_unit_test(false_alarms_are_as_rare_as_stated),
      cmocka_unit_test(what_it_says_it_sees_is_seen),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
