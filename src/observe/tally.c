#include "observe/tally.h"

#include <math.h>

/* Memory: levels of quantity 0, of quantity 1, ..., then the sums of all samples: [groups][quantities][2]. */
static uint32_t groups_of(const struct tally_shape *shape)
{
  return shape->fibers < TALLY_GROUPS ? shape->fibers : TALLY_GROUPS;
}

static const struct block_level *levels_of(const struct tally_shape *shape, const double *memory, uint32_t quantity)
{
  return (const struct block_level *)memory + (size_t)quantity * shape->levels;
}

static size_t level_doubles(const struct tally_shape *shape)
{
  return (size_t)shape->quantities * shape->levels * BLOCK_LEVEL_DOUBLES;
}

/* First fiber of a group; groups differ by at most one fiber. */
static uint32_t group_first(const struct tally_shape *shape, uint32_t group)
{
  const uint32_t groups = groups_of(shape);
  return (uint32_t)(((uint64_t)group * shape->fibers + groups - 1) / groups);
}

size_t tally_sums(const struct tally_shape *shape)
{
  return (size_t)groups_of(shape) * shape->quantities * 2;
}

size_t tally_size(const struct tally_shape *shape)
{
  return level_doubles(shape) + tally_sums(shape);
}

void tally_fiber(const struct tally_shape *shape, double *sums, uint32_t fiber, double (*values)[2])
{
  const uint32_t group = (uint32_t)((uint64_t)fiber * groups_of(shape) / shape->fibers);
  double *sum = sums + (size_t)group * shape->quantities * 2;
  for (uint32_t q = 0; q < shape->quantities; q++) {
    sum[2 * q] += values[q][0];
    sum[2 * q + 1] += values[q][1];
  }
}

void tally_add(const struct tally_shape *shape, double *memory, const double *sums)
{
  struct block_level *level = (struct block_level *)memory;
  const uint32_t groups = groups_of(shape), width = shape->quantities * 2;
  for (uint32_t q = 0; q < shape->quantities; q++, level += shape->levels) {
    double x = 0.0, y = 0.0;
    for (uint32_t g = 0; g < groups; g++) {
      x += sums[(size_t)g * width + 2 * q];
      y += sums[(size_t)g * width + 2 * q + 1];
    }
    block_add(level, shape->levels, x / shape->fibers, y / shape->fibers);
  }
  double *total = memory + level_doubles(shape);
  for (size_t i = 0; i < (size_t)groups * width; i++)
    total[i] += sums[i];
}

double tally_count(const struct tally_shape *shape, const double *memory)
{
  return levels_of(shape, memory, 0)->count;
}

double tally_mean(const struct tally_shape *shape, const double *memory, uint32_t quantity, int part)
{
  const struct block_level *level = levels_of(shape, memory, quantity);
  return level->count > 0.0 ? level->mean[part] : NAN;
}

/* Standard error from G groups of n_g fibers each, of N in all: the mean is sum (n_g/N) mean_g, so its variance is
 * G/(G-1) sum (n_g/N)^2 (mean_g - mean)^2. */
static double group_error(const struct tally_shape *shape, const double *memory, uint32_t quantity, double a, double b)
{
  const uint32_t groups = groups_of(shape);
  const double count = tally_count(shape, memory);
  if (groups < TALLY_LEAST_GROUPS || count == 0.0)
    return NAN;
  const double *total = memory + level_doubles(shape) + 2 * quantity;
  const double mean = a * tally_mean(shape, memory, quantity, 0) + b * tally_mean(shape, memory, quantity, 1);
  double variance = 0.0;
  for (uint32_t g = 0; g < groups; g++, total += 2 * shape->quantities) {
    const uint32_t fibers = group_first(shape, g + 1) - group_first(shape, g);
    const double sum = (a * total[0] + b * total[1]) / count, deviation = (sum - fibers * mean) / shape->fibers;
    variance += deviation * deviation;
  }
  return sqrt(variance * groups / (groups - 1.0));
}

double tally_error(const struct tally_shape *shape, const double *memory, uint32_t quantity, double a, double b)
{
  const double time = block_error(levels_of(shape, memory, quantity), shape->levels, a, b);
  return fmax(time, group_error(shape, memory, quantity, a, b)); /* of a number and a NaN: the number */
}
