/*
 * Averages over the fibers of a kind and over time, of several quantities at once, with error bars from two sources:
 *
 * - time: blocking of the series of averages over all fibers (block.h). Valid if the run is many correlation times
 *   long.
 * - fibers: the spread among groups of fibers, each averaged over all times. Valid if many fibers move independently,
 *   for a run of any length.
 *
 * The error of a mean is the larger of the two. One of them may be unknown: a run may be too short for the first,
 * fibers too few for the second. Each quantity is a pair (x, y), see block.h. Memory is flat and zeroed when empty.
 */
#ifndef UNCROSS_OBSERVE_TALLY_H
#define UNCROSS_OBSERVE_TALLY_H

#include <stddef.h>
#include <stdint.h>

#include "observe/block.h"

enum {
  TALLY_GROUPS = 64,     /* most groups into which fibers are divided */
  TALLY_LEAST_GROUPS = 8 /* fewest groups whose spread gives an error */
};

struct tally_shape {
  uint32_t fibers, quantities, levels;
};

/* Doubles of a tally's memory; and of the sums of one sample. */
size_t tally_size(const struct tally_shape *shape);
size_t tally_sums(const struct tally_shape *shape);

/* Adds the values of one fiber to the sums of a sample. values: [quantities][2]; sums: zeroed for a new sample. */
void tally_fiber(const struct tally_shape *shape, double *sums, uint32_t fiber, double (*values)[2]);

/* Adds a sample, once all fibers are in its sums. */
void tally_add(const struct tally_shape *shape, double *memory, const double *sums);

/* Samples so far. */
double tally_count(const struct tally_shape *shape, const double *memory);

/* Mean of x (part 0) or y (part 1) of a quantity; NaN without samples. */
double tally_mean(const struct tally_shape *shape, const double *memory, uint32_t quantity, int part);

/* Standard error of the mean of a x + b y; NaN if both are unknown. */
double tally_error(const struct tally_shape *shape, const double *memory, uint32_t quantity, double a, double b);

#endif
