#include "observe/dynamics_lags.h"

#include "observe/dynamics.h"

enum {
  LEVELS = 24,              /* of blocks at lag 1; longer lags need fewer to reach as far in time */
  DEFAULT_SAMPLES = 1 << 20 /* longest lag where the plan knows none */
};

uint32_t dynamics_count_lags(const struct observer *observer)
{
  const uint64_t longest = observer->longest_lag ? observer->longest_lag / observer->every : DEFAULT_SAMPLES;
  uint32_t n = 0;
  while (n < MAX_LAGS && dynamics_lag(n) <= longest)
    n++;
  return n;
}

static struct tally_shape shape_of(const struct fiber_kind *kind, uint32_t lag, uint32_t quantities)
{
  const uint32_t doublings = (lag + 1) / 2;
  return (struct tally_shape){kind->count, quantities, doublings < LEVELS ? LEVELS - doublings : 1};
}

static struct tally_shape tally_of(const struct fiber_kind *kind, uint32_t lag)
{
  return shape_of(kind, lag, QUANTITIES);
}

struct tallies dynamics_first_tallies(const struct lag *lag, const struct fiber_kind *kind, uint32_t number)
{
  struct tallies t = {.shape = tally_of(kind, number),
                      .drift_shape = shape_of(kind, number, DRIFT_QUANTITIES),
                      .rise_shape = shape_of(kind, number, RISE_QUANTITIES),
                      .memory = lag->real,
                      .drift = lag->later};
  t.rise = t.drift + tally_size(&t.drift_shape);
  return t;
}

void dynamics_next_tallies(struct tallies *t, const struct fiber_kind *kind, uint32_t number)
{
  const struct lag next = {.real = t->memory + tally_size(&t->shape), .later = t->rise + tally_size(&t->rise_shape)};
  *t = dynamics_first_tallies(&next, kind, number);
}

static size_t lag_reals(const struct model *model, uint32_t lag)
{
  size_t reals = 0;
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct tally_shape shape = tally_of(&model->kind[k], lag);
    reals += tally_size(&shape);
  }
  return reals;
}

static size_t lag_later(const struct model *model, uint32_t lag)
{
  size_t reals = 0;
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct tally_shape drift = shape_of(&model->kind[k], lag, DRIFT_QUANTITIES);
    const struct tally_shape rise = shape_of(&model->kind[k], lag, RISE_QUANTITIES);
    reals += tally_size(&drift) + tally_size(&rise);
  }
  return reals;
}

static size_t lag_integers(const struct model *model)
{
  return 1 + (size_t)model->vertices * sizeof(struct point) / sizeof(int64_t);
}

struct lag dynamics_first_lag(const struct observer *observer)
{
  int64_t *mark = observer->integer + 1;
  return (struct lag){dynamics_lag(0), observer->real, observer->later, mark, (struct point *)(mark + 1)};
}

void dynamics_next_lag(struct lag *lag, const struct model *model, uint32_t number)
{
  lag->samples = dynamics_lag(number + 1);
  lag->real += lag_reals(model, number);
  lag->later += lag_later(model, number);
  lag->mark += lag_integers(model);
  lag->origin = (struct point *)(lag->mark + 1);
}

size_t dynamics_scratch_sums(const struct model *model)
{
  size_t most = 0;
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct tally_shape shape = tally_of(&model->kind[k], 0);
    const size_t sums = tally_sums(&shape);
    most = sums > most ? sums : most;
  }
  return most;
}

uint32_t dynamics_longest_fiber(const struct model *model)
{
  uint32_t longest = 0;
  for (uint32_t k = 0; k < model->kinds; k++)
    longest = model->kind[k].vertices > longest ? model->kind[k].vertices : longest;
  return longest;
}

uint32_t dynamics_most_fibers(const struct model *model)
{
  uint32_t most = 0;
  for (uint32_t k = 0; k < model->kinds; k++)
    most = model->kind[k].count > most ? model->kind[k].count : most;
  return most;
}

void dynamics_size(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  const uint32_t lags = dynamics_count_lags(observer);
  for (uint32_t n = 0; n < lags; n++) {
    size->reals += lag_reals(model, n);
    size->later += lag_later(model, n);
  }
  size->integers += lags * lag_integers(model);
  size->scratch =
      dynamics_scratch_sums(model) + (dynamics_longest_fiber(model) + 2 * (size_t)dynamics_most_fibers(model)) *
                                         (sizeof(struct vec3) / sizeof(double));
}
