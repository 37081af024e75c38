#include "base/student.h"

#include <math.h>

#define MOST_FREEDOMS 10000.0

/* Abramowitz and Stegun, Handbook of Mathematical Functions (1964), 26.7.3 and 26.7.4: a finite sum in cos^2. */
double student_tail(double t, double freedoms)
{
  const int n = (int)fmin(floor(freedoms), MOST_FREEDOMS);
  const double angle = atan(t / sqrt(n)), square = n / (n + t * t); /* cos^2(angle) */
  const int odd = n % 2;
  double term = odd ? sqrt(square) : 1.0, sum = 0.0;
  for (int k = 2 + odd; k <= n; k += 2) {
    sum += term;
    term *= square * (k - 1) / k;
  }
  const double within = odd ? 2.0 / 3.141592653589793 * (angle + sin(angle) * sum) : sin(angle) * sum;
  return fmax(1.0 - within, 0.0);
}

double student_quantile(double p, double freedoms)
{
  double low = 0.0, high = 1.0;
  while (student_tail(high, freedoms) > p)
    high *= 2.0;
  for (int k = 0; k < 60; k++) {
    const double middle = 0.5 * (low + high);
    if (student_tail(middle, freedoms) > p)
      low = middle;
    else
      high = middle;
  }
  return high;
}

double student_welch(double error_a, double blocks_a, double error_b, double blocks_b)
{
  const double both = hypot(error_a, error_b), a = error_a / both, b = error_b / both;
  return fmax(floor(1.0 / (a * a * a * a / (blocks_a - 1.0) + b * b * b * b / (blocks_b - 1.0))), 1.0);
}
