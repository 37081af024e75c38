/*
 * Logarithm, exponential, cosine and sine of our own, for whatever acts on the dynamics. Those of C libraries differ in
 * their last bits. These use IEEE 754 double operations alone (+ - * /, comparisons, integers on bits), each rounded to
 * nearest, in a fixed order, so that the bits are the same for every compiler, optimisation level and instruction set.
 * The flag -ffp-contract=off is needed: a fused multiply-add changes bits (tests/base/test_elementary.c sees it).
 *
 * None has a branch, so that a loop over a column vectorises. docs/elementary.md has the algorithms for ports.
 *
 *   function                       arguments                             error stated, measured (ulp)
 *   elementary_log                 positive normal numbers                  1      0.92
 *   elementary_exp                 all numbers, infinities, NaN             1      0.95
 *   elementary_circle_turns        0 and |u| from 2^-1000 to 2^49           1      0.94
 *   elementary_circle_degrees      0 and |angle| from 2^-1000 to 2^49       1      0.96
 *   elementary_erf                 0, |x| from 2^-1000 on, infinities       2      1.67
 *
 * One ulp is the unit in the last place of the exact result. The test holds the errors stated, against MPFR; the
 * largest errors measured are those of 2 10^6 arguments of each of its kinds.
 *
 * The polynomials are truncated Taylor series of exact rational coefficients, each written as a quotient that is
 * rounded once. Each is summed as two series, one of even and one of odd powers, which halves the chain of operations
 * that wait for each other. An argument or product that one double cannot hold is kept as a sum of two, the second of
 * them the rounding error of the first (Dekker, Numer. Math. 18, 224 (1971)).
 */
#ifndef UNCROSS_BASE_ELEMENTARY_H
#define UNCROSS_BASE_ELEMENTARY_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

_Static_assert(FLT_EVAL_METHOD == 0, "expressions must be evaluated in double, without excess precision");

/* Added to a number below 2^51, rounds it to an integer k (ties to even) and leaves k in the low bits of the sum. */
#define ELEMENTARY_ROUND 0x1.8p52

/* ln 2 and its remainder. The first has 42 bits, so that its product with an exponent of a double is exact. */
#define ELEMENTARY_LN2 0x1.62e42fefa38p-1
#define ELEMENTARY_LN2_REST 0x1.ef35793c7673p-45

/* A quarter turn and a degree in radians, pi/2 and pi/180, each with its remainder; the first parts have 27 bits. */
#define ELEMENTARY_QUARTER 0x1.921fb54p+0
#define ELEMENTARY_QUARTER_REST 0x1.10b4611a62633p-30
#define ELEMENTARY_DEGREE 0x1.1df46a4p-6
#define ELEMENTARY_DEGREE_REST (-0x1.ad62c6ea3e274p-34)

static inline uint64_t elementary_bits(double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

static inline double elementary_from_bits(uint64_t bits)
{
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/* Natural logarithm of a positive normal number x; ln 1 = 0 exactly.
 *
 * x = 2^e m with m in [sqrt(1/2), sqrt(2)). With f = m - 1, h = f^2/2 and s = f/(2 + f), |s| < 0.172,
 *
 *   ln m = 2 artanh s = 2 s + s R(s^2),   R(z) = 2/3 z + 2/5 z^2 + ... + 2/21 z^10,   error below 2^-62
 *        = f - h + s (h + R), */
static inline double elementary_log(double x)
{
  const uint64_t one = 0x3ff0000000000000, root_half = 0x3fe6a09e667f3bcd; /* 1 and sqrt(1/2) */
  const uint64_t t = elementary_bits(x) + (one - root_half);
  const double e = elementary_from_bits((t >> 52) | 0x4330000000000000) - (0x1p52 + 1023.0);
  const double f = elementary_from_bits((t & 0x000fffffffffffff) + root_half) - 1.0;
  const double h = 0.5 * f * f, s = f / (2.0 + f), z = s * s, w = z * z;
  const double odd = 2.0 / 3.0 + w * (2.0 / 7.0 + w * (2.0 / 11.0 + w * (2.0 / 15.0 + w * (2.0 / 19.0))));
  const double even = 2.0 / 5.0 + w * (2.0 / 9.0 + w * (2.0 / 13.0 + w * (2.0 / 17.0 + w * (2.0 / 21.0))));
  const double rest = s * (h + (z * odd + w * even)) - h;
  const double whole = e * ELEMENTARY_LN2, sum = whole + f, lost = (whole - sum) + f;
  return sum + (rest + (lost + e * ELEMENTARY_LN2_REST));
}

/* Exponential; e^0 = 1 exactly. Below -708 the result is 0, above 709 infinity, so that it is never subnormal.
 *
 * x = n ln 2 + r + r', |r| < 0.347, r' the rounding error of r: e^x = 2^n (1 + r + r' + r^2 P(r)),
 * P(r) = 1/2! + r/3! + ... + r^11/13!, error below 2^-57. */
static inline double elementary_exp(double x)
{
  const double turned = x * 0x1.71547652b82fep+0 + ELEMENTARY_ROUND, n = turned - ELEMENTARY_ROUND; /* 1/ln 2 */
  const double near = x - n * ELEMENTARY_LN2, rest = n * ELEMENTARY_LN2_REST;
  const double r = near - rest, lost = (near - r) - rest, w = r * r;
  const double even =
      1.0 / 2.0 +
      w * (1.0 / 24.0 + w * (1.0 / 720.0 + w * (1.0 / 40320.0 + w * (1.0 / 3628800.0 + w * (1.0 / 479001600.0)))));
  const double odd =
      1.0 / 6.0 +
      w * (1.0 / 120.0 + w * (1.0 / 5040.0 + w * (1.0 / 362880.0 + w * (1.0 / 39916800.0 + w * (1.0 / 6227020800.0)))));
  const double less_one = r + (lost + w * (even + r * odd));
  const double result = (1.0 + less_one) * elementary_from_bits((elementary_bits(turned) + 1023) << 52);
  const double floored = x < -708.0 ? 0.0 : result;
  return x > 709.0 ? (double)INFINITY : floored;
}

/* A point of the unit circle. */
struct circle_point {
  double cosine, sine;
};

/* The point at angle (quarters pi/2 + t unit), |t unit| < 0.786, unit = high + low, the first of at most 27 bits. Of
 * `quarters` the two low bits count.
 *
 * t = t1 + t2, the first of 26 bits, so that t1 high is exact. Of x + x' = t unit, x' is the rounding error of x:
 *
 *   sin = x + x' + x z S(z),            z = x^2,  S = -1/3! + z/5! - ... + z^7/17!,      error below 2^-62
 *   cos = 1 - z/2 - x x' + z^2 C(z),              C = 1/4! - z/6! + ... + z^6/16!,       error below 2^-58 */
static inline struct circle_point elementary_circle(double t, double high, double low, uint64_t quarters)
{
  const double t1 = elementary_from_bits(elementary_bits(t) & 0xfffffffff8000000), t2 = t - t1;
  const double exact = t1 * high, rest = t2 * high + t * low;
  const double x = exact + rest, lost = rest - (x - exact), z = x * x, w = z * z;

  const double s0 = -1.0 / 6.0 + w * (-1.0 / 5040.0 + w * (-1.0 / 39916800.0 + w * (-1.0 / 1307674368000.0)));
  const double s1 = 1.0 / 120.0 + w * (1.0 / 362880.0 + w * (1.0 / 6227020800.0 + w * (1.0 / 355687428096000.0)));
  const double along = x + (lost + x * (z * (s0 + z * s1)));

  const double c0 = 1.0 / 24.0 + w * (1.0 / 40320.0 + w * (1.0 / 479001600.0 + w * (1.0 / 20922789888000.0)));
  const double c1 = -1.0 / 720.0 + w * (-1.0 / 3628800.0 + w * (-1.0 / 87178291200.0));
  const double h = 0.5 * z, less = 1.0 - h;
  const double across = less + (((1.0 - less) - h) + (w * (c0 + z * c1) - x * lost));

  /* An odd number of quarters exchanges the two; signs follow; adding 0 makes every zero +0. */
  const uint64_t swap = 0 - (quarters & 1), a = elementary_bits(along), c = elementary_bits(across);
  const uint64_t exchange = (a ^ c) & swap;
  const uint64_t sine_sign = (quarters & 2) << 62, cosine_sign = ((quarters + 1) & 2) << 62;
  return (struct circle_point){elementary_from_bits(c ^ exchange ^ cosine_sign) + 0.0,
                               elementary_from_bits(a ^ exchange ^ sine_sign) + 0.0};
}

/* cos(2 pi u) and sin(2 pi u), u in turns, |u| <= 2^49. The reduction to an eighth of a turn is exact; results at
 * multiples of a quarter are exactly 0, 1, -1. No zero is negative. */
static inline struct circle_point elementary_circle_turns(double u)
{
  const double quarters = 4.0 * u, turned = quarters + ELEMENTARY_ROUND, t = quarters - (turned - ELEMENTARY_ROUND);
  return elementary_circle(t, ELEMENTARY_QUARTER, ELEMENTARY_QUARTER_REST, elementary_bits(turned));
}

/* Cosine and sine of an angle in degrees, |angle| <= 2^49; exactly 0, 1, -1 at multiples of 90. No zero is negative. */
static inline struct circle_point elementary_circle_degrees(double angle)
{
  const double turned = angle / 90.0 + ELEMENTARY_ROUND, t = angle - 90.0 * (turned - ELEMENTARY_ROUND);
  return elementary_circle(t, ELEMENTARY_DEGREE, ELEMENTARY_DEGREE_REST, elementary_bits(turned));
}

/* Error function, 2/sqrt(pi) times the integral of exp(-t^2) from 0 to x. Not for hot loops. */
double elementary_erf(double x);

#endif
