/* The interval search at length: near contacts of all kinds against exact polynomials (contact/exact_flight.h), more of
 * them through a filter in long doubles with rigorous bounds, and whole drifts replayed by brute force. `stress_flight
 * 4` gives the numbers of docs/accuracy.md: 10^7 searches by exact polynomials, 10^8 through the filter. */
#include <float.h>
#include <time.h>

#include "stress.h"

#include "contact/flight_replay.h"
#include "contact/flights.h"

static void tell_time(const char *what, clock_t since)
{
  print_message("  %s: %.1f s of CPU\n", what, (double)(clock() - since) / CLOCKS_PER_SEC);
  fflush(stdout);
}

static void near_contacts(void **unused)
{
  (void)unused;
  clock_t since = clock();
  audit_contacts(dice_seed(2901), scaled_count(10000));
  tell_time("contacts by construction", since);
  since = clock();
  audit_near_contacts(dice_seed(2902), scaled_count(110000));
  tell_time("near contacts", since);
}

/* --- a filter ----------------------------------------------------------------------------------------------------- */

/* Without the machinery of src/: f in powers of time, u = (t - from) / (to - from), in long double, with the sum of the
 * sizes of all products beside it. 2^-58 times that sum is far above what rounding adds (some 30 roundings by 2^-64).
 */
struct bounded {
  long double value, size;
};
_Static_assert(LDBL_MANT_DIG >= 64, "the filter needs a long double of 64 bits");

static struct bounded plus_product(struct bounded sum, long double a, long double b, long double c)
{
  return (struct bounded){sum.value + a * b * c, sum.size + fabsl(a * b * c)};
}

/* sum += (a x b).c */
static struct bounded plus_volume(struct bounded sum, const long double a[3], const long double b[3],
                                  const long double c[3])
{
  for (int k = 0; k < 3; k++) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    sum = plus_product(sum, a[k], b[l], c[m]);
    sum = plus_product(sum, -a[k], b[m], c[l]);
  }
  return sum;
}

static void at_and_change(struct point at, struct point rate, int64_t from, int64_t to, long double v[2][3])
{
  const int64_t x[3] = {at.x + rate.x * from, at.y + rate.y * from, at.z + rate.z * from},
                y[3] = {rate.x * (to - from), rate.y * (to - from), rate.z * (to - from)};
  for (int k = 0; k < 3; k++)
    v[0][k] = (long double)x[k], v[1][k] = (long double)y[k];
}

enum verdict { APART, UNDECIDED };

/* APART is certain. */
static enum verdict filter(const struct flight_pair *pair, int64_t from, int64_t to)
{
  if (boxes_apart(pair, from, to))
    return APART;
  long double p[2][3], q[2][3], w[2][3];
  at_and_change(pair->p, pair->p_rate, from, to, p);
  at_and_change(pair->q, pair->q_rate, from, to, q);
  at_and_change(pair->w, pair->w_rate, from, to, w);
  struct bounded power[4] = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
  for (int i = 0; i < 8; i++)
    power[(i & 1) + (i >> 1 & 1) + (i >> 2)] =
        plus_volume(power[(i & 1) + (i >> 1 & 1) + (i >> 2)], p[i & 1], q[i >> 1 & 1], w[i >> 2]);
  const long double a = power[0].value, b = power[1].value, c = power[2].value, d = power[3].value;
  const long double doubt = 0x1p-58L * (power[0].size + power[1].size + power[2].size + power[3].size);
  const long double bernstein[4] = {a, a + b / 3, a + (2 * b + c) / 3, a + b + c + d};
  bool above = true, below = true;
  for (int k = 0; k < 4; k++) {
    above &= bernstein[k] > doubt;
    below &= bernstein[k] < -doubt;
  }
  return above || below ? APART : UNDECIDED;
}

/* Surely apart on [from, to]: by the filter, on halves of halves; else by exact polynomials. */
static bool touch(struct flight_audit *a, const struct flight_pair *pair, int64_t from, int64_t to, uint64_t *exact)
{
  for (int64_t at = from, step = to - from; at < to;) {
    if (step < 1 + (to - from) / 64) {
      ++*exact;
      return exact_touch(&a->exact, pair, at, to);
    }
    const int64_t end = at + step < to ? at + step : to;
    if (filter(pair, at, end) == APART)
      at = end;
    else
      step /= 2;
  }
  return false;
}

/* --- through the filter ------------------------------------------------------------------------------------------- */

static int64_t spread(struct dice *d, double size)
{
  return llrint(size * dice_between(d, -1.0, 1.0));
}

static struct point spread_point(struct dice *d, double size)
{
  struct point p;
  p.x = spread(d, size);
  p.y = spread(d, size);
  p.z = spread(d, size);
  return p;
}

/* A pair as in a dense suspension: bonds of about 0.5 a0, which come to within `gap` a0 at some tick, at some places
 * along both; motions of `motion` a0 in a drift. */
static struct flight_pair draw_pair(struct dice *d, double gap, double motion)
{
  struct flight_pair pair;
  const double rate = motion * 0x1p24;
  pair.p = spread_point(d, 0x1p39), pair.q = spread_point(d, 0x1p39);
  pair.p_rate = spread_point(d, rate), pair.q_rate = spread_point(d, rate), pair.w_rate = spread_point(d, rate);
  const double s = dice_between(d, -0.1, 1.1), t = dice_between(d, -0.1, 1.1);
  const int64_t tick = dice_integer(d, 0, FLIGHT_TICKS);
  pair.w = spread_point(d, gap * 0x1p40);
  pair.w.x += llrint(s * (double)(pair.p.x + pair.p_rate.x * tick) - t * (double)(pair.q.x + pair.q_rate.x * tick)) -
              pair.w_rate.x * tick;
  pair.w.y += llrint(s * (double)(pair.p.y + pair.p_rate.y * tick) - t * (double)(pair.q.y + pair.q_rate.y * tick)) -
              pair.w_rate.y * tick;
  pair.w.z += llrint(s * (double)(pair.p.z + pair.p_rate.z * tick) - t * (double)(pair.q.z + pair.q_rate.z * tick)) -
              pair.w_rate.z * tick;
  return pair;
}

static const struct filtered {
  const char *name;
  double gap, motion; /* a0 */
} filtered[] = {
    {"dense", 0.05, 0.02}, {"listed", 0.3, 0.02}, {"near", 0.003, 0.01},
    {"fast", 0.3, 0.5},    {"slow", 1e-5, 1e-5},  {"at contact", 0.0, 0.01},
};
enum { FILTERED = sizeof filtered / sizeof filtered[0] };

static void pairs_through_a_filter(void **unused)
{
  (void)unused;
  struct flight_audit a;
  flight_audit_open(&a, dice_seed(2903));
  tell_kinds();
  struct flight_tally sum = {0};
  uint64_t exact = 0;
  for (int kind = 0; kind < FILTERED; kind++) {
    const clock_t since = clock();
    struct flight_tally t = {0};
    for (uint64_t k = scaled_count(2.5e7 / FILTERED); k > 0; k--) {
      const struct flight_pair pair = draw_pair(&a.dice, filtered[kind].gap, filtered[kind].motion);
      const int32_t tick = flight_contact(&pair, 0);
      t.intervals++;
      t.missed += tick > 0 && touch(&a, &pair, 0, tick, &exact);
      if (tick == FLIGHT_TICKS)
        continue;
      t.answers++;
      if (k % 16 == 0) { /* the others only count as answers */
        const bool real = exact_touch(&a.exact, &pair, tick, tick + 1);
        t.contacts += real, t.invented += !real;
        t.early += !exact_near(&a.distance, &pair, tick, 1);
      }
    }
    tell_tally(filtered[kind].name, &t);
    tell_time(filtered[kind].name, since);
    sum.intervals += t.intervals, sum.answers += t.answers, sum.contacts += t.contacts, sum.invented += t.invented;
    sum.missed += t.missed, sum.early += t.early;
  }
  tell_tally("all", &sum);
  print_message("  %lu of them by exact polynomials; contacts, invented, early: every 16th answer\n",
                (unsigned long)exact);
  flight_audit_close(&a);
  judge_tally("through the filter", a.seed, &sum);
}

static void whole_drifts(void **unused)
{
  (void)unused;
  for (int k = 0; k < REPLAYED; k++) {
    replay_suspensions(dice_seed(2904), &replayed[k], scaled_count(50));
    fflush(stdout);
  }
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {cmocka_unit_test(near_contacts), cmocka_unit_test(whole_drifts),
                                     cmocka_unit_test(pairs_through_a_filter)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
