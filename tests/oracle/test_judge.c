/* Verdicts on tables of observables: single numbers by hand, rates of false alarms and of detection by drawing tables
 * from the errors of the committed reference. */
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "oracle/judge.h"
#include "support.h"

static struct observable_mean row(const char *name, double value, double error, double blocks)
{
  struct observable_mean r = {
      .value = value, .error = error, .blocks = blocks, .time = 1.0, .theory = NAN, .resolve = 0.02, .bound = NAN};
  snprintf(r.name, sizeof r.name, "%s", name);
  return r;
}

/* What is conserved: a bound, and no error to compare with. */
static struct observable_mean kept(const char *name, double value, double error, double blocks)
{
  struct observable_mean r = row(name, value, error, blocks);
  r.resolve = NAN;
  r.bound = 1e-3;
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
  assert_true(!j.undecided && !j.differs);
}

static void undecided_because(struct observable_mean theirs, const char *why)
{
  const struct observable_mean ours = row("a", 1.0, 1e-4, 40);
  const struct judgement j = judge_one(&ours, &theirs, 1e-3);
  if (why)
    assert_string_equal(j.undecided, why);
  else
    assert_null(j.undecided);
  assert_false(j.differs);
}

static void what_cannot_be_judged(void **unused)
{
  (void)unused;
  const struct observable_mean ours = row("a", 1.0, 1e-4, 40), few = row("a", 5.0, 1e-4, JUDGE_LEAST_BLOCKS - 1);
  undecided_because(row("a", 1.0, 1e-4, 40), NULL);
  undecided_because(row("a", 1.0, 2e-4, JUDGE_LEAST_BLOCKS), NULL);
  undecided_because(few, "too few blocks");
  assert_true(judge_one(&ours, &few, 1e-3).p == 1.0);
  undecided_because(row("a", 1.0, 0.006, 40), "error too large");
  undecided_because(row("a", 1.0, 0.0, 40), "all blocks are equal");
  /* Ratios of variances of 39 degrees of freedom that are found by chance once in a thousand, from GSL. */
  const double low = sqrt(gsl_cdf_fdist_Pinv(0.5e-3, 39, 39)), high = sqrt(gsl_cdf_fdist_Qinv(0.5e-3, 39, 39));
  undecided_because(row("a", 1.0, 0.98e-4 * low, 40), "blocks scatter otherwise");
  undecided_because(row("a", 1.0, 1.02e-4 * low, 40), NULL);
  undecided_because(row("a", 1.0, 0.98e-4 * high, 40), NULL);
  undecided_because(row("a", 1.0, 1.02e-4 * high, 40), "blocks scatter otherwise");
  assert_string_equal(judge_one(&ours, NULL, 1e-3).undecided, "missing");
  assert_true(judge_one(&ours, NULL, 1e-3).p == 1.0);
}

/* Blocks 3, 4, 5 have mean 4, variance 1, mean square 50/3. */
static void root_mean_square_by_hand(void **unused)
{
  (void)unused;
  const struct observable_mean r = row("a", 4.0, sqrt(1.0 / 3.0), 3);
  assert_close(observable_rms(&r), sqrt(50.0 / 3.0), 1e-14);
}

/* A sign that changes from block to block leaves no mean, and is seen; one bad block among 1000 is, too. */
static void what_is_conserved_has_a_bound(void **unused)
{
  (void)unused;
  const struct observable_mean ours = kept("a", 1e-14, 1e-15, 40);
  const struct {
    struct observable_mean theirs;
    bool differs;
  } cases[] = {{row("a", 0.9e-3, 0.0, 2), false},
               {row("a", 1.1e-3, 0.0, 2), true},
               {row("a", -1.1e-3, 0.0, 40), true},
               {row("a", 0.0, 0.9e-3 / sqrt(39.0), 40), false},
               {row("a", 0.0, 1.1e-3 / sqrt(39.0), 40), true},
               {row("a", 1e-4, 1e-4, 1000), true}}; /* blocks of 0, and one of 0.1 */
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    const struct judgement j = judge_one(&ours, &cases[c].theirs, 1e-3);
    assert_int_equal(j.differs, cases[c].differs);
    assert_null(j.undecided);
    assert_true(j.conserved);
  }
  assert_string_equal(judge_one(&ours, NULL, 1e-3).undecided, "missing");
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
    /* what is conserved takes no part of the rate */
    struct judgement with[6] = {{.p = p[0]}, {.p = 1.0, .conserved = true},
                                {.p = p[1]}, {.p = 1.0, .conserved = true, .differs = true},
                                {.p = p[2]}, {.p = p[3]}};
    const bool differs[6] = {cases[c].differs[0], false, cases[c].differs[1], true, cases[c].differs[2],
                             cases[c].differs[3]};
    judge_together(with, 6, cases[c].rate);
    for (int k = 0; k < 6; k++)
      assert_int_equal(with[k].differs, differs[k]);
  }
}

static void read_reference(struct observable_means *reference)
{
  struct message message;
  if (!observable_means_read("reference-data/observables.csv", NULL, reference, &message))
    fail_msg("%s", message.text);
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
  const struct observable_mean calm = kept("c", 1e-14, 1e-15, 40), still = row("c", 0.0, 0.0, 2),
                               leaks = row("c", 0.1, 0.01, 2);
  const struct observable_means more = {3, {a, b, calm}}, sound = {3, {a, b, still}}, leaking = {3, {a, b, leaks}};
  assert_int_equal(verdict_of(&more, &sound, NULL), JUDGE_CONSISTENT);
  assert_int_equal(verdict_of(&more, &sound, "c"), JUDGE_CONSISTENT);
  assert_int_equal(verdict_of(&more, &ours, NULL), JUDGE_CANNOT_TELL);
  assert_int_equal(verdict_of(&more, &leaking, NULL), JUDGE_DIFFERS);
  assert_int_equal(verdict_of(&more, &leaking, "c"), JUDGE_DIFFERS);
  assert_int_equal(verdict_of(&more, &leaking, "a,b"), JUDGE_CONSISTENT);
}

/* Every observable of the reference has words for its verdict. */
static void every_observable_has_words(void **unused)
{
  (void)unused;
  struct observable_means reference;
  read_reference(&reference);
  for (size_t k = 0; k < reference.count; k++) {
    const struct observable_words *w = observable_words_of(reference.row[k].name);
    assert_string_equal(w->name, reference.row[k].name);
    assert_true(*w->look && w->scale > 0.0);
  }
  assert_string_equal(observable_words_of("none")->what, "it is");
}

/* --- rates, by drawing -------------------------------------------------------------------------------------------- */

#define THEIR_BLOCKS 40

/* The mean and the standard error of so many normal blocks: independent, and the latter from chi^2. */
static void draw(gsl_rng *rng, struct observable_mean *r, double mean, double block_spread, double blocks)
{
  const double error = block_spread / sqrt(blocks);
  r->value = mean + gsl_ran_gaussian(rng, error);
  r->error = error * sqrt(gsl_ran_chisq(rng, blocks - 1.0) / (blocks - 1.0));
  r->blocks = blocks;
}

/* Tables of theirs and of ours, both drawn from the reference's values and errors: how many are found different; `odd`:
 * in how many a scatter is. */
static void false_alarms(double rate, uint32_t tables, unsigned long seed, uint32_t *odd)
{
  struct observable_means truth, ours, theirs;
  struct judgement judgement[OBSERVABLES_MOST];
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  read_reference(&truth);
  ours = theirs = truth;
  uint32_t alarms = 0, means = 0;
  for (size_t k = 0; k < truth.count; k++)
    means += isnan(truth.row[k].bound);
  *odd = 0;
  for (uint32_t n = 0; n < tables; n++) {
    bool any = false, scatters = false;
    for (size_t k = 0; k < truth.count; k++) {
      const struct observable_mean *t = &truth.row[k];
      draw(rng, &ours.row[k], t->value, t->error * sqrt(t->blocks), t->blocks);
      draw(rng, &theirs.row[k], t->value, t->error * sqrt(t->blocks), THEIR_BLOCKS);
      judgement[k] = judge_one(&ours.row[k], &theirs.row[k], rate / means);
      scatters |= judgement[k].undecided && strcmp(judgement[k].undecided, "blocks scatter otherwise") == 0;
    }
    judge_together(judgement, truth.count, rate);
    for (size_t k = 0; k < truth.count; k++)
      any |= judgement[k].differs;
    alarms += any;
    *odd += scatters;
  }
  gsl_rng_free(rng);
  /* Independent observables: 1 - (1 - rate/n)^n. 3.3 standard errors: fails by chance once in a thousand. */
  const double expected = 1.0 - pow(1.0 - rate / means, means);
  assert_sigma((double)alarms / tables, sqrt(expected * (1.0 - expected) / tables), expected, 3.3);
}

static void false_alarms_are_as_rare_as_stated(void **unused)
{
  (void)unused;
  uint32_t odd;
  false_alarms(0.05, 6000, 1, &odd);
  /* The share of scatters that are odd by chance has the same bound; Paulson's root is right to 10 % of it here. */
  const double expected = 1.0 - exp(-0.05);
  assert_sigma((double)odd / 6000, hypot(sqrt(expected * (1.0 - expected) / 6000), 0.1 * expected / 3.3), expected,
               3.3);
  false_alarms(1e-3, 20000, 2, &odd);
}

/* The share of so many tables of `blocks` blocks in which a true difference of `away` |value| is found at `level`. */
static double found(gsl_rng *rng, const struct observable_mean *truth, double away, double blocks, double level,
                    uint32_t tables)
{
  struct observable_mean ours = *truth, theirs = *truth;
  const double spread = truth->error * sqrt(truth->blocks);
  uint32_t seen = 0;
  for (uint32_t n = 0; n < tables; n++) {
    draw(rng, &ours, truth->value, spread, truth->blocks);
    draw(rng, &theirs, truth->value * (1.0 + away), spread, blocks);
    seen += judge_one(&ours, &theirs, level).p < level;
  }
  return (double)seen / tables;
}

/* The p of the reference below which the first difference counts. */
static double level_of(const struct observable_means *reference)
{
  uint32_t means = 0;
  for (size_t k = 0; k < reference->count; k++)
    means += isnan(reference->row[k].bound);
  return 1e-3 / means;
}

/* A difference of the size `sees`, put into one observable, is found in 90 % of the tables, from few blocks and from
 * many: 10000 tables each, of 3.3 standard errors besides what the formula is off. */
static void what_it_says_it_sees_is_seen(void **unused)
{
  (void)unused;
  static const double blocks[] = {10, 20, 40, 160};
  struct observable_means truth;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 3);
  read_reference(&truth);
  const double level = level_of(&truth);
  const struct observable_mean *t = observable_means_find(&truth, "energy_drift");
  assert_non_null(t);
  for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) {
    const double sees = judge_sees(t, t->error * sqrt(t->blocks), blocks[k], level);
    const double accuracy = blocks[k] < 20 ? 0.006 : 0.002; /* of 400 000 tables: docs/judging.md */
    assert_true(fabs(found(rng, t, sees, blocks[k], level, 10000) - 0.9) < accuracy + 3.3 * sqrt(0.9 * 0.1 / 10000));
  }
  gsl_rng_free(rng);
}

/* So many blocks as are said to be needed find what must be found, in 90 % of 2000 tables or more; half of them, where
 * these are not too few, do not. */
static void blocks_that_are_needed(void **unused)
{
  (void)unused;
  struct observable_means truth;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 4);
  read_reference(&truth);
  const double level = level_of(&truth);
  for (size_t k = 0; k < truth.count; k++) {
    const struct observable_mean *t = &truth.row[k];
    if (!isnan(t->bound))
      continue;
    const double spread = t->error * sqrt(t->blocks), needed = judge_blocks_needed(t, spread, level);
    assert_true(needed >= JUDGE_LEAST_BLOCKS && judge_sees(t, spread, needed, level) <= t->resolve);
    const double error = 3.3 * sqrt(0.9 * 0.1 / 2000);
    assert_true(found(rng, t, t->resolve, needed, level, 2000) > 0.9 - error);
    if (needed > 2 * JUDGE_LEAST_BLOCKS) {
      assert_true(judge_sees(t, spread, needed - 1, level) > t->resolve);
      assert_true(found(rng, t, t->resolve, floor(needed / 2), level, 2000) < 0.9 - error);
    }
  }
  struct observable_mean t = row("a", 1.0, 0.02, 40);
  assert_true(isinf(judge_blocks_needed(&t, 0.1, level))); /* ours alone is too vague */
  gsl_rng_free(rng);
}

/* 40 runs of each scene, 320 of the wave, decide: in fewer than 1 % of 4000 tables of a right code is an error too
 * large, by 3.3 standard errors. */
static void forty_runs_suffice(void **unused)
{
  (void)unused;
  struct observable_means truth;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, 5);
  read_reference(&truth);
  const double level = level_of(&truth);
  const uint32_t tables = 4000;
  uint32_t vague = 0;
  for (uint32_t n = 0; n < tables; n++) {
    bool any = false;
    for (size_t k = 0; k < truth.count; k++) {
      const struct observable_mean *t = &truth.row[k];
      struct observable_mean theirs = *t;
      draw(rng, &theirs, t->value, t->error * sqrt(t->blocks), t->blocks > 1000 ? 8 * THEIR_BLOCKS : THEIR_BLOCKS);
      any |= isnan(t->bound) && !(judge_one(t, &theirs, level).sees <= t->resolve);
    }
    vague += any;
  }
  gsl_rng_free(rng);
  print_message("  error too large: %u of %u tables\n", vague, tables);
  assert_true((double)vague / tables + 3.3 * sqrt(0.01 * 0.99 / tables) < 0.01);
}

/* docs/judging.md tells, for each observable, the blocks that it needs, and what 10, 20, 40 and 160 blocks see. */
static void the_page_tells_the_blocks(void **unused)
{
  (void)unused;
  static const double blocks[] = {10, 20, 40, 160};
  struct observable_means truth;
  read_reference(&truth);
  const double level = level_of(&truth);
  char line[512], wanted[256];
  for (size_t k = 0; k < truth.count; k++) {
    const struct observable_mean *t = &truth.row[k];
    if (!isnan(t->bound))
      continue;
    const double spread = t->error * sqrt(t->blocks);
    const int many = t->blocks > 1000 ? 8 : 1; /* of the wave, eight times as many of each */
    size_t at = (size_t)snprintf(wanted, sizeof wanted, "| `%s` | %.3g | %.0f |", t->name, 100.0 * t->resolve,
                                 judge_blocks_needed(t, spread, level));
    for (size_t b = 0; b < sizeof blocks / sizeof *blocks; b++)
      at += (size_t)snprintf(wanted + at, sizeof wanted - at, " %.2g |",
                             100.0 * judge_sees(t, spread, many * blocks[b], level));
    bool there = false;
    FILE *page = fopen("docs/judging.md", "r");
    assert_non_null(page);
    while (!there && fgets(line, sizeof line, page))
      there = strncmp(line, wanted, strlen(wanted)) == 0;
    fclose(page);
    if (!there)
      fail_msg("docs/judging.md does not say: %s", wanted);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_observable_by_hand),
      cmocka_unit_test(what_cannot_be_judged),
      cmocka_unit_test(root_mean_square_by_hand),
      cmocka_unit_test(what_is_conserved_has_a_bound),
      cmocka_unit_test(holm_by_hand),
      cmocka_unit_test(verdicts),
      cmocka_unit_test(every_observable_has_words),
      cmocka_unit_test(false_alarms_are_as_rare_as_stated),
      cmocka_unit_test(what_it_says_it_sees_is_seen),
      cmocka_unit_test(blocks_that_are_needed),
      cmocka_unit_test(forty_runs_suffice),
      cmocka_unit_test(the_page_tells_the_blocks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
