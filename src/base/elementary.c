#include "base/elementary.h"

#define TWO_OVER_ROOT_PI 0x1.20dd750429b6dp+0

/* exp(-a^2), a >= 0, without the error that rounding a^2 would bring: a^2 = b^2 + (a - b)(a + b), b of 26 bits. */
static double bell(double a)
{
  const double b = elementary_from_bits(elementary_bits(a) & 0xfffffffff8000000);
  return elementary_exp(-(b * b)) * elementary_exp(-((a - b) * (a + b)));
}

/* Below 7/8, the Taylor series (Abramowitz and Stegun 7.1.5). Each term is the one before times -a^2 (2n-1)/(n (2n+1)).
 *
 *   erf a = p - p a^2/3 (1 - 3 a^2/10 (1 - 5 a^2/21 (...))),   p = 2/sqrt(pi) a */
static double erf_near(double a)
{
  const double y = a * a, p = TWO_OVER_ROOT_PI * a;
  double sum = 1.0;
  for (int n = 20; n >= 2; n--)
    sum = 1.0 - y * (2.0 * n - 1.0) / (n * (2.0 * n + 1.0)) * sum;
  return p - p * (y / 3.0 * sum);
}

/* From 7/8 on, the continued fraction of the complement (7.1.14), which is below 0.22.
 *
 *   erf a = 1 - exp(-a^2)/sqrt(pi) / (a + (1/2)/(a + (2/2)/(a + (3/2)/(a + ...)))) */
static double erf_far(double a)
{
  double fraction = a;
  for (int n = 280; n >= 1; n--)
    fraction = a + 0.5 * n / fraction;
  return 1.0 - 0.5 * TWO_OVER_ROOT_PI * bell(a) / fraction;
}

double elementary_erf(double x)
{
  const double a = fabs(x), result = a < 0.875 ? erf_near(a) : a < 6.0 ? erf_far(a) : 1.0;
  return x < 0.0 ? -result : result;
}
