/*
 * Averages of correlated series with error bars, computed during the run: the blocking hierarchy of Flyvbjerg and
 * Petersen, J. Chem. Phys. 91, 461 (1989).
 *
 * Level 0 sees every value of a series, level 1 the means of two successive values, level 2 of four, and so on. On each
 * level the standard error of the mean is computed as if its blocks were independent; it grows from level to level
 * until the blocks are longer than the correlation time, and is right from then on (the plateau).
 *
 * A value is a pair (x, y): so that errors of functions of two averages, a ratio say, are known by linearisation. The
 * memory is an array of levels, each eight doubles: flat, to be saved and restored as it is. Zeroed memory is empty.
 */
#ifndef UNCROSS_OBSERVE_BLOCK_H
#define UNCROSS_OBSERVE_BLOCK_H

#include <stddef.h>

struct block_level {
  double count;      /* blocks seen on this level */
  double mean[2];    /* of x, of y */
  double spread[3];  /* sums of (x - <x>)^2, (x - <x>)(y - <y>), (y - <y>)^2: Welford 1962 */
  double pending[2]; /* the first of two blocks, while it waits for the second (count is odd) */
};

enum {
  BLOCK_LEVEL_DOUBLES = sizeof(struct block_level) / sizeof(double),
  BLOCK_LEAST = 16 /* fewest blocks of a level whose error is used */
};

/* One more pair of the series. level: [levels]; blocks longer than 2^(levels-1) values are not made. */
void block_add(struct block_level *level, size_t levels, double x, double y);

/* Standard error of the mean of a x + b y: the largest over the levels with at least BLOCK_LEAST blocks. On a plateau
 * the largest of several estimates overestimates by some per cent (docs/observables.md has figures); below it, every
 * other choice underestimates by more. NaN with fewer than BLOCK_LEAST values. */
double block_error(const struct block_level *level, size_t levels, double a, double b);

/* The mean of x over that of y, and its error by linearisation; NaN where the mean of y is not above 0. */
void block_ratio(const struct block_level *level, size_t levels, double ratio[2]);

#endif
