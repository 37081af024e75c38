/* Student's t distribution, for means whose errors were estimated from few blocks. */
#ifndef UNCROSS_BASE_STUDENT_H
#define UNCROSS_BASE_STUDENT_H

/* P(|T| > t) for this many degrees of freedom, at least 1; t >= 0. Its own error is below 1e-14, so smaller results
 * mean no more than "less than that"; 0 is possible. From 10^4 degrees of freedom on it is that of 10^4. */
double student_tail(double t, double freedoms);

/* The t for which P(|T| > t) = p; 1e-12 <= p < 1. */
double student_quantile(double p, double freedoms);

/* Degrees of freedom of the difference of two means with these standard errors, from so many blocks each, 2 or more:
 * Welch, Biometrika 34, 28 (1947), rounded down. */
double student_welch(double error_a, double blocks_a, double error_b, double blocks_b);

#endif
