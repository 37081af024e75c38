#include "base/normal.h"

#include "base/normal_lanes.h"

static inline double radius_from(double u)
{
  return sqrt(-2.0 * elementary_log(u));
}

void random_normal_pair(struct random_words r, double out[2])
{
  const double radius = radius_from(random_uniform(r, 0));
  const struct circle_point p = elementary_circle_turns(random_uniform(r, 1));
  out[0] = radius * p.cosine;
  out[1] = radius * p.sine;
}

static void radii(const double *restrict u, uint32_t n, double *restrict radius)
{
  for (uint32_t k = 0; k < n; k++)
    radius[k] = radius_from(u[k]);
}

static void pairs(const double *restrict radius, const double *restrict turns, uint32_t n, double *restrict x,
                  double *restrict y)
{
  for (uint32_t k = 0; k < n; k++) {
    const struct circle_point p = elementary_circle_turns(turns[k]);
    x[k] = radius[k] * p.cosine;
    y[k] = radius[k] * p.sine;
  }
}

static void firsts(const double *restrict radius, const double *restrict turns, uint32_t n, double *restrict z)
{
  for (uint32_t k = 0; k < n; k++)
    z[k] = radius[k] * elementary_circle_turns(turns[k]).cosine;
}

void random_normal_firsts(const double *u, const double *v, uint32_t n, double *x)
{
  double radius[RANDOM_UNIFORMS];
  radii(u, n, radius);
  firsts(radius, v, n, x);
}

void random_normal_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                           uint32_t n, double *restrict x, double *restrict y, double *restrict z)
{
  double u[4][RANDOM_UNIFORMS], radius[RANDOM_UNIFORMS];
  for (uint32_t first = 0; first < n; first += RANDOM_UNIFORMS) {
    const uint32_t m = n - first < RANDOM_UNIFORMS ? n - first : RANDOM_UNIFORMS;
    random_uniform_columns(seed, purpose, step, entity + first, m, u);
    radii(u[0], m, radius);
    pairs(radius, u[1], m, x + first, y + first);
    radii(u[2], m, radius);
    firsts(radius, u[3], m, z + first);
  }
}

/* --- three of one draw -------------------------------------------------------------------------------------------- */

#define ONE 0x3ff0000000000000 /* the bits of 1; 52 bits of a fraction come after it */

/* -ln u, to 2e-12 of it: u = (k + 1/2) 2^-40, k the 32 bits of `high` and then the first 8 of `low`. Only the low
 * halves of both count. As elementary_log, without what is lost in rounding: ln m = 2 artanh s. */
static inline double minus_log(uint64_t high, uint64_t low)
{
  const uint64_t root_half = 0x3fe6a09e667f3bcd;
  const uint64_t fraction = (high & 0xffffffff) << 20 | (low & 0xff000000) >> 12;
  const double u = elementary_from_bits(ONE | fraction) - (1.0 - 0x1p-41);
  const uint64_t t = elementary_bits(u) + (ONE - root_half);
  const double e = elementary_from_bits((t >> 52) | 0x4330000000000000) - (0x1p52 + 1023.0);
  const double f = elementary_from_bits((t & 0x000fffffffffffff) + root_half) - 1.0;
  const double s = f / (2.0 + f), w = s * s, q = w * w;
  const double odd = 2.0 / 3.0 + q * (2.0 / 7.0 + q * (2.0 / 11.0));
  const double even = 2.0 + q * (2.0 / 5.0 + q * (2.0 / 9.0 + q * (2.0 / 13.0)));
  return -(e * 0x1.62e42fefa39efp-1) - s * (even + w * odd);
}

/* x and y, of word 1 and root = sqrt(-ln u). */
static inline void first_two(uint64_t word, double root, double *x, double *y)
{
  const double turn = elementary_from_bits(ONE | (word & 0x3fffff) << 30) - (1.5 - 0x1p-23);
  const double a = turn * 0x1.921fb54442d18p+0, w = a * a, q = w * w; /* pi/2 */
  const double s0 = 1.0 + q * (1.0 / 120.0 + q * (1.0 / 362880.0 + q * (1.0 / 6227020800.0)));
  const double s1 = -1.0 / 6.0 + q * (-1.0 / 5040.0 + q * (-1.0 / 39916800.0));
  const double c0 = 1.0 + q * (1.0 / 24.0 + q * (1.0 / 40320.0 + q * (1.0 / 479001600.0)));
  const double c1 = -1.0 / 2.0 + q * (-1.0 / 720.0 + q * (-1.0 / 3628800.0));
  const double sine = a * (s0 + w * s1), cosine = c0 + w * c1;
  const uint64_t sign = 0x8000000000000000;
  *x = elementary_from_bits(elementary_bits(root * (cosine - sine)) ^ (word << 40 & sign));
  *y = elementary_from_bits(elementary_bits(root * (cosine + sine)) ^ (word << 41 & sign));
}

/* z, of word 3 and radius = sqrt(-2 ln u'). */
static inline double third(uint64_t word, double radius)
{
  const double turn = elementary_from_bits(ONE | (word & 0xffffff) << 28) - (1.5 - 0x1p-25);
  const double b = turn * 0x1.921fb54442d18p+1, w = b * b, q = w * w; /* pi */
  const double s0 =
      1.0 + q * (1.0 / 120.0 + q * (1.0 / 362880.0 + q * (1.0 / 6227020800.0 + q * (1.0 / 355687428096000.0))));
  const double s1 = -1.0 / 6.0 + q * (-1.0 / 5040.0 + q * (-1.0 / 39916800.0 + q * (-1.0 / 1307674368000.0)));
  return radius * (b * (s0 + w * s1));
}

void random_normal_three(struct random_words r, double out[3])
{
  first_two(r.w[1], sqrt(minus_log(r.w[0], r.w[1])), &out[0], &out[1]);
  out[2] = third(r.w[3], sqrt(2.0 * minus_log(r.w[2], r.w[3])));
}

/* Of m entities, at most LANES: columns have room for these alone. */
INLINE void some_of_three(const words w[4], uint32_t m, double *x, double *y, double *z)
{
  reals out[3];
  normal_three_lanes(w, out);
  memcpy(x, &out[0], m * sizeof *x);
  memcpy(y, &out[1], m * sizeof *y);
  memcpy(z, &out[2], m * sizeof *z);
}

void random_normal_three_columns(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step,
                                 const uint32_t *entity, uint32_t n, double *restrict x, double *restrict y,
                                 double *restrict z)
{
  const uint32_t whole = n - n % LANES;
  words w[4];
  for (uint32_t k = 0; k < whole; k += LANES) {
    philox_words(seed, purpose, draw, step, load_low(&entity[k]), w);
    some_of_three(w, LANES, &x[k], &y[k], &z[k]);
  }
  if (whole == n)
    return;
  uint32_t rest[LANES] = {0};
  memcpy(rest, &entity[whole], (n - whole) * sizeof *rest);
  philox_words(seed, purpose, draw, step, load_low(rest), w);
  some_of_three(w, n - whole, &x[whole], &y[whole], &z[whole]);
}

INLINE void some_third(const uint64_t *word2, const uint64_t *word3, uint32_t m, double *z)
{
  words high = {0}, low = {0};
  memcpy(&high, word2, m * sizeof *word2);
  memcpy(&low, word3, m * sizeof *word3);
  const reals found = normal_third(low, square_root(2.0 * normal_minus_log(high, low)));
  memcpy(z, &found, m * sizeof *z);
}

void random_normal_third_column(const uint64_t *restrict word2, const uint64_t *restrict word3, uint32_t n,
                                double *restrict z)
{
  const uint32_t whole = n - n % LANES;
  for (uint32_t k = 0; k < whole; k += LANES)
    some_third(&word2[k], &word3[k], LANES, &z[k]);
  if (whole < n)
    some_third(&word2[whole], &word3[whole], n - whole, &z[whole]);
}
