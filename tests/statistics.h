/* Means with error bars for statistical tests. Entries must be independent of each other: means over blocks longer than
 * any correlation, or over separate runs. */
#ifndef UNCROSS_STATISTICS_H
#define UNCROSS_STATISTICS_H

#include <math.h>
#include <stddef.h>

/* Mean and its standard error (Welford 1962). Starts as {0}. */
struct sample {
  double n, mean, squares; /* squares: sum of squared deviations from the mean */
};

static inline void sample_add(struct sample *s, double x)
{
  s->n += 1.0;
  double before = x - s->mean;
  s->mean += before / s->n;
  s->squares += before * (x - s->mean);
}

static inline double sample_error(const struct sample *s)
{
  return s->n > 1.0 ? sqrt(s->squares / (s->n - 1.0) / s->n) : INFINITY;
}

/* Entries that are correlated, averaged over blocks of `length` of them first. Starts as {.length = ...}. */
struct blocks {
  size_t length, filled;
  double sum;
  struct sample of_blocks;
};

static inline void blocks_add(struct blocks *b, double x)
{
  b->sum += x;
  if (++b->filled < b->length)
    return;
  sample_add(&b->of_blocks, b->sum / (double)b->length);
  b->filled = 0;
  b->sum = 0.0;
}

/* Ratio of the means of x and y, which may be correlated, and its standard error to first order in the fluctuations
 * (Cochran, Sampling Techniques, Sec. 6.4). Starts as {0}. */
struct ratio {
  double n, x, y, xx, xy, yy;
};

static inline void ratio_add(struct ratio *r, double x, double y)
{
  r->n += 1.0;
  r->x += x;
  r->y += y;
  r->xx += x * x;
  r->xy += x * y;
  r->yy += y * y;
}

static inline double ratio_value(const struct ratio *r)
{
  return r->x / r->y;
}

static inline double ratio_error(const struct ratio *r)
{
  double q = ratio_value(r), scatter = r->xx - 2.0 * q * r->xy + q * q * r->yy;
  return r->n > 1.0 ? sqrt(fmax(scatter, 0.0) * r->n / (r->n - 1.0)) / fabs(r->y) : INFINITY;
}

/* Least-squares slope of y against x, all points alike. Starts as {0}; its error assumes independent scatter. */
struct line {
  double n, x, y, xx, xy, yy;
};

static inline void line_add(struct line *l, double x, double y)
{
  l->n += 1.0;
  l->x += x;
  l->y += y;
  l->xx += x * x;
  l->xy += x * y;
  l->yy += y * y;
}

static inline double line_slope(const struct line *l)
{
  return (l->n * l->xy - l->x * l->y) / (l->n * l->xx - l->x * l->x);
}

#endif
