#include "observe/block.h"

#include <math.h>
#include <stdbool.h>

/* Means and sums of squared deviations without cancellation (Welford, Technometrics 4, 419 (1962)). */
static void level_add(struct block_level *b, const double value[2])
{
  b->count += 1.0;
  const double dx = value[0] - b->mean[0], dy = value[1] - b->mean[1];
  b->mean[0] += dx / b->count;
  b->mean[1] += dy / b->count;
  const double ex = value[0] - b->mean[0], ey = value[1] - b->mean[1];
  b->spread[0] += dx * ex;
  b->spread[1] += dx * ey;
  b->spread[2] += dy * ey;
}

static bool is_odd(double count)
{
  return fmod(count, 2.0) != 0.0;
}

void block_add(struct block_level *level, size_t levels, double x, double y)
{
  double value[2] = {x, y};
  for (size_t k = 0; k < levels; k++) {
    struct block_level *b = &level[k];
    level_add(b, value);
    if (is_odd(b->count)) {
      b->pending[0] = value[0];
      b->pending[1] = value[1];
      return;
    }
    value[0] = 0.5 * (b->pending[0] + value[0]);
    value[1] = 0.5 * (b->pending[1] + value[1]);
  }
}

double block_error(const struct block_level *level, size_t levels, double a, double b)
{
  double largest = NAN;
  for (size_t k = 0; k < levels && level[k].count >= BLOCK_LEAST; k++) {
    const struct block_level *l = &level[k];
    const double spread = a * a * l->spread[0] + 2.0 * a * b * l->spread[1] + b * b * l->spread[2];
    const double error = sqrt((spread < 0.0 ? 0.0 : spread) / (l->count * (l->count - 1.0)));
    largest = k == 0 ? error : fmax(largest, error);
  }
  return largest;
}

void block_ratio(const struct block_level *level, size_t levels, double ratio[2])
{
  const double x = level->mean[0], y = level->mean[1];
  ratio[0] = y > 0.0 ? x / y : NAN;
  ratio[1] = y > 0.0 ? block_error(level, levels, 1.0 / y, -x / (y * y)) : NAN;
}
