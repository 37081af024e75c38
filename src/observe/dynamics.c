#include "observe/dynamics.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "observe/background.h"
#include "observe/dynamics_lags.h"

/* --- intervals --------------------------------------------------------------------------------------------------- */

/* What is compared when a lag has passed. middle: positions at half the lag, NULL: not sampled. The displacements of
 * the frame since the origin, and up to the middle. */
struct interval {
  const struct point *origin, *middle, *now;
  struct vec3 drift, drift_to_middle;
};

/* Displacements of the centres of mass of a kind's fibers over an interval, and over its first half. */
struct displacements {
  struct vec3 *whole, *first; /* [count] */
};

static struct vec3 center_moved(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                                struct vec3 drift)
{
  struct vec3 sum = {0, 0, 0};
  for (uint32_t j = 0; j < kind->vertices; j++)
    sum = vec3_add(sum, point_difference(now[j], origin[j]));
  return vec3_sub(vec3_scale(1.0 / kind->vertices, sum), drift);
}

static struct vec3 mean_of(const struct vec3 *of, uint32_t count)
{
  struct vec3 sum = {0, 0, 0};
  for (uint32_t i = 0; i < count; i++)
    sum = vec3_add(sum, of[i]);
  return vec3_scale(1.0 / count, sum);
}

/* |d|^2 - (|d_1|^2 + |d_2|^2)/2 of a displacement d and its two halves: on average g_cm(t) - g_cm(t/2). */
static double rise(struct vec3 whole, struct vec3 first)
{
  const struct vec3 second = vec3_sub(whole, first);
  return vec3_dot(whole, whole) - 0.5 * (vec3_dot(first, first) + vec3_dot(second, second));
}

/*
 * The drift of a kind is the mean displacement d of its n fibers. About it, sum |d_i - d|^2 / (n - 1) is the variance
 * of independent displacements without bias: the mean, which is estimated from the same fibers, takes 1/n of it away.
 * For one fiber there is no such number; 0 is kept, and NaN told (fill_row).
 */
static void add_drift(const struct fiber_kind *kind, const struct tallies *t, const struct displacements *d,
                      bool halves, double *sums)
{
  const uint32_t n = kind->count;
  const double unbiased = n > 1 ? n / (n - 1.0) : 0.0;
  const struct vec3 mean = mean_of(d->whole, n), first = halves ? mean_of(d->first, n) : mean;
  memset(sums, 0, tally_sums(&t->drift_shape) * sizeof *sums);
  for (uint32_t i = 0; i < n; i++) {
    const struct vec3 about = vec3_sub(d->whole[i], mean);
    double values[DRIFT_QUANTITIES][2] = {
        [DRIFT_XY] = {d->whole[i].x, d->whole[i].y},
        [DRIFT_Z_ABOUT] = {d->whole[i].z, unbiased * vec3_dot(about, about)},
    };
    tally_fiber(&t->drift_shape, sums, i, values);
  }
  tally_add(&t->drift_shape, t->drift, sums);
  if (!halves)
    return;
  memset(sums, 0, tally_sums(&t->rise_shape) * sizeof *sums);
  for (uint32_t i = 0; i < n; i++) {
    const double about = unbiased * rise(vec3_sub(d->whole[i], mean), vec3_sub(d->first[i], first));
    double values[RISE_QUANTITIES][2] = {[RISE_AND_ABOUT] = {rise(d->whole[i], d->first[i]), about}};
    tally_fiber(&t->rise_shape, sums, i, values);
  }
  tally_add(&t->rise_shape, t->rise, sums);
}

/* Adds what all fibers did since the origin to the tallies of a lag. */
static void compare(const struct observer *observer, const struct model *model, const struct lag *lag, uint32_t number,
                    const struct interval *interval)
{
  double *sums = observer->scratch;
  struct vec3 *contour = (struct vec3 *)(sums + dynamics_scratch_sums(model)),
              *whole = contour + dynamics_longest_fiber(model);
  const struct displacements d = {whole, whole + dynamics_most_fibers(model)};
  struct tallies t = dynamics_first_tallies(lag, &model->kind[0], number);
  size_t at = 0;
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct fiber_kind *kind = &model->kind[k];
    if (k > 0)
      dynamics_next_tallies(&t, kind, number);
    memset(sums, 0, tally_sums(&t.shape) * sizeof *sums);
    for (uint32_t fiber = 0; fiber < kind->count; fiber++, at += kind->vertices) {
      const struct point *origin = interval->origin + at;
      const struct fiber_motion m = fiber_motion(kind, origin, interval->now + at, interval->drift, contour);
      double values[QUANTITIES][2] = {[VERTICES_CENTER] = {m.vertices, m.center},
                                      [TUBE_CONTOUR] = {m.tube, m.tube_contour},
                                      [TURNED_SQUARE] = {m.turned, m.square},
                                      [MIDDLE_COSINE] = {m.middle, m.cosine},
                                      [THIRD_AXIS] = {m.tube_third, m.axis}};
      tally_fiber(&t.shape, sums, fiber, values);
      d.whole[fiber] = m.moved;
      if (interval->middle)
        d.first[fiber] = center_moved(kind, origin, interval->middle + at, interval->drift_to_middle);
    }
    if (kind->count) {
      tally_add(&t.shape, t.memory, sums);
      add_drift(kind, &t, &d, interval->middle != NULL, sums);
    }
  }
}

/* The lag that is half of lag number n. */
static uint32_t half_of(uint32_t n)
{
  return n == 1 ? 0 : n - 2;
}

static bool has_half(uint32_t n)
{
  return n == 1 || n >= 3;
}

/* A lag of half the length has its origin in the middle of this one, unless a sample was missed. */
static struct interval interval_of(const struct observer *observer, const struct model *model, const struct lag *lag,
                                   const struct lag *half, const struct state *state)
{
  const uint64_t from = (uint64_t)*lag->mark - 1, middle = from + lag->samples / 2 * observer->every;
  const double start = (double)from * model->time_step;
  const bool halves = half && *half->mark == (int64_t)middle + 1;
  return (struct interval){lag->origin, halves ? half->origin : NULL, state->position,
                           background_displacement(model, start, (double)state->step * model->time_step),
                           background_displacement(model, start, (double)middle * model->time_step)};
}

/* A lag whose time has come is compared and begins anew; so does, without comparison, one that missed it: no sample was
 * shown then. The longest comes first: it looks at the origins of shorter ones before they begin anew. */
static void add_dynamics(struct observer *observer, struct view *view)
{
  const struct model *model = view->model;
  const uint64_t step = view->state->step;
  const uint32_t lags = dynamics_count_lags(observer);
  struct lag all[MAX_LAGS], lag = dynamics_first_lag(observer);
  for (uint32_t n = 0; n < lags; dynamics_next_lag(&lag, model, n++))
    all[n] = lag;
  for (uint32_t n = lags; n-- > 0;) {
    lag = all[n];
    const uint64_t due = (uint64_t)*lag.mark - 1 + lag.samples * observer->every;
    if (*lag.mark && step < due)
      continue;
    if (*lag.mark && step == due && model->kinds > 0) {
      const struct interval interval =
          interval_of(observer, model, &lag, has_half(n) ? &all[half_of(n)] : NULL, view->state);
      compare(observer, model, &lag, n, &interval);
    }
    *lag.mark = (int64_t)step + 1;
    memcpy(lag.origin, view->state->position, model->vertices * sizeof *lag.origin);
  }
}

/* --- the table --------------------------------------------------------------------------------------------------- */

static const char *const columns[] = {"time",
                                      "g",
                                      "g_error",
                                      "g_cm",
                                      "g_cm_error",
                                      "g_middle",
                                      "g_middle_error",
                                      "d2",
                                      "d2_error",
                                      "d2_contour",
                                      "d2_contour_error",
                                      "end_to_end",
                                      "end_to_end_error",
                                      "end_to_end_unit",
                                      "end_to_end_unit_error",
                                      "D",
                                      "D_error",
                                      "intervals",
                                      "g_cm_about_mean",
                                      "g_cm_about_mean_error",
                                      "D_about_mean",
                                      "D_about_mean_error",
                                      "D_cumulative",
                                      "D_cumulative_error",
                                      "D_cumulative_about_mean",
                                      "D_cumulative_about_mean_error",
                                      "drift_x",
                                      "drift_x_error",
                                      "drift_y",
                                      "drift_y_error",
                                      "drift_z",
                                      "drift_z_error",
                                      "d2_third",
                                      "d2_third_error",
                                      "axis_unit",
                                      "axis_unit_error"};

enum { COLUMNS = sizeof columns / sizeof *columns };

struct cells {
  const struct tally_shape *shape;
  const double *memory;
  double *next;
};

/* Writes a mean and its error, scaled; NaN twice if there is no such thing. */
static void put(struct cells *c, bool defined, uint32_t quantity, int part, double scale)
{
  *c->next++ = defined ? scale * tally_mean(c->shape, c->memory, quantity, part) : NAN;
  *c->next++ = defined ? scale * tally_error(c->shape, c->memory, quantity, part == 0, part == 1) : NAN;
}

/* <R(t).R(0)>/<R^2> = 1 - X/Y with X = <turned>, Y = <square>; its error is that of (x - (X/Y) y)/Y. */
static void put_end_to_end(struct cells *c, bool defined)
{
  const double x = tally_mean(c->shape, c->memory, TURNED_SQUARE, 0);
  const double y = tally_mean(c->shape, c->memory, TURNED_SQUARE, 1);
  *c->next++ = defined ? 1.0 - x / y : NAN;
  *c->next++ = defined ? tally_error(c->shape, c->memory, TURNED_SQUARE, 1.0 / y, -x / (y * y)) : NAN;
}

static void fill_row(const struct fiber_kind *kind, const struct tallies *t, double *row, double time)
{
  const bool ends = !kind->ring && kind->vertices > 1, several = kind->count > 1;
  const double d = kind->dimensions;
  struct cells c = {&t->shape, t->memory, row + 1};
  row[0] = time;
  put(&c, true, VERTICES_CENTER, 0, 1.0);
  put(&c, true, VERTICES_CENTER, 1, 1.0);
  put(&c, true, MIDDLE_COSINE, 0, 1.0);
  put(&c, true, TUBE_CONTOUR, 0, 1.0);
  put(&c, true, TUBE_CONTOUR, 1, 1.0);
  put_end_to_end(&c, ends);
  put(&c, ends, MIDDLE_COSINE, 1, 1.0);
  put(&c, true, VERTICES_CENTER, 1, 1.0 / (2.0 * d * time)); /* D(t) = g_cm(t) / 2 d t */
  *c.next++ = tally_count(c.shape, c.memory);
  c = (struct cells){&t->drift_shape, t->drift, c.next};
  put(&c, several, DRIFT_Z_ABOUT, 1, 1.0);
  put(&c, several, DRIFT_Z_ABOUT, 1, 1.0 / (2.0 * d * time));
  c = (struct cells){&t->rise_shape, t->rise, c.next};
  put(&c, true, RISE_AND_ABOUT, 0, 1.0 / (d * time)); /* (g_cm(t) - g_cm(t/2)) / 2d(t/2) */
  put(&c, several, RISE_AND_ABOUT, 1, 1.0 / (d * time));
  c = (struct cells){&t->drift_shape, t->drift, c.next};
  put(&c, true, DRIFT_XY, 0, 1.0 / time);
  put(&c, true, DRIFT_XY, 1, 1.0 / time);
  put(&c, true, DRIFT_Z_ABOUT, 0, 1.0 / time);
  c = (struct cells){&t->shape, t->memory, c.next};
  put(&c, true, THIRD_AXIS, 0, 1.0);
  put(&c, ends, THIRD_AXIS, 1, 1.0);
}

/* The table of one kind; its tally follows those of the kinds before it, in each lag. Lags without an interval yet are
 * left out. */
static bool summarise_kind(const struct observer *observer, const struct model *model, uint32_t kind,
                           const struct observer_take *to)
{
  double value[MAX_LAGS * COLUMNS];
  char name[OBSERVER_NAME_SIZE];
  snprintf(name, sizeof name, "dynamics-%s", model->kind[kind].name);
  struct observe_table table = {name, columns, COLUMNS, 0, value};
  const uint32_t lags = dynamics_count_lags(observer);
  struct lag lag = dynamics_first_lag(observer);
  for (uint32_t n = 0; n < lags; dynamics_next_lag(&lag, model, n++)) {
    struct tallies t = dynamics_first_tallies(&lag, &model->kind[0], n);
    for (uint32_t k = 1; k <= kind; k++)
      dynamics_next_tallies(&t, &model->kind[k], n);
    if (tally_count(&t.shape, t.memory) == 0.0)
      continue;
    fill_row(&model->kind[kind], &t, &value[table.rows * COLUMNS],
             (double)(lag.samples * observer->every) * model->time_step);
    table.rows++;
  }
  return to->take(to->context, &table);
}

static bool summarise_dynamics(const struct observer *observer, const struct model *model,
                               const struct observer_take *to)
{
  bool ok = true;
  for (uint32_t k = 0; ok && k < model->kinds; k++)
    ok = model->kind[k].count == 0 || summarise_kind(observer, model, k, to);
  return ok;
}

const struct observer_type dynamics_observer = {
    .size = dynamics_size,
    .add = add_dynamics,
    .summarise = summarise_dynamics,
    .each_kind = true,
};
