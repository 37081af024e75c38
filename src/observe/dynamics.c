#include "observe/dynamics.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "observe/observer.h"
#include "observe/tally.h"
#include "theory/theory.h"

/* --- one fiber, two times ---------------------------------------------------------------------------------------- */

/* Mean square displacements of vertices, centre of mass and middle vertex: Padding 2009, Eqs. (41) and (42). */
static void displacements(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                          struct vec3 drift, struct fiber_motion *motion)
{
  const uint32_t middle = dynamics_middle(kind);
  struct vec3 sum = {0, 0, 0};
  double squares = 0.0;
  for (uint32_t j = 0; j < kind->vertices; j++) {
    const struct vec3 d = vec3_sub(point_difference(now[j], origin[j]), drift);
    const double squared = vec3_dot(d, d);
    sum = vec3_add(sum, d);
    squares += squared;
    if (j == middle)
      motion->middle = squared;
  }
  const struct vec3 center = vec3_scale(1.0 / kind->vertices, sum);
  motion->vertices = squares / kind->vertices;
  motion->center = vec3_dot(center, center);
}

/* Squared distance of 0 from the segment (a, b); a and b may coincide. */
static double squared_distance_to_segment(struct vec3 a, struct vec3 b)
{
  const struct vec3 e = vec3_sub(b, a);
  const double along = -vec3_dot(a, e), squared = vec3_dot(e, e);
  if (along <= 0.0)
    return vec3_dot(a, a);
  if (along >= squared)
    return vec3_dot(b, b);
  const struct vec3 nearest = vec3_add_scaled(a, along / squared, e);
  return vec3_dot(nearest, nearest);
}

/* d^2 of Padding 2009, Eq. (43): from the middle vertex, now, to the nearest vertex, then; and to the nearest point of
 * the contour, then, which knows no finite distance between vertices. relative: [vertices] scratch. */
static void tube(const struct fiber_kind *kind, const struct point *origin, struct point middle, struct vec3 drift,
                 struct vec3 *relative, struct fiber_motion *motion)
{
  const uint32_t n = kind->vertices;
  double nearest = INFINITY, contour;
  for (uint32_t j = 0; j < n; j++) {
    relative[j] = vec3_add(point_difference(origin[j], middle), drift);
    nearest = fmin(nearest, vec3_dot(relative[j], relative[j]));
  }
  contour = nearest;
  for (uint32_t j = 0; j + 1 < n; j++)
    contour = fmin(contour, squared_distance_to_segment(relative[j], relative[j + 1]));
  if (kind->ring)
    contour = fmin(contour, squared_distance_to_segment(relative[n - 1], relative[0]));
  motion->tube = nearest;
  motion->tube_contour = contour;
}

static void end_to_end(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                       struct fiber_motion *motion)
{
  const uint32_t last = kind->vertices - 1;
  const struct vec3 then = point_difference(origin[last], origin[0]), here = point_difference(now[last], now[0]);
  const struct vec3 change = vec3_sub(here, then);
  const double squares = vec3_dot(then, then) * vec3_dot(here, here);
  motion->turned = 0.5 * vec3_dot(change, change);
  motion->square = 0.5 * (vec3_dot(then, then) + vec3_dot(here, here));
  motion->cosine = squares > 0.0 ? vec3_dot(then, here) / sqrt(squares) : 0.0;
}

struct fiber_motion fiber_motion(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                                 struct vec3 drift, struct vec3 *scratch)
{
  struct fiber_motion motion = {.vertices = 0.0};
  displacements(kind, origin, now, drift, &motion);
  tube(kind, origin, now[dynamics_middle(kind)], drift, scratch, &motion);
  if (!kind->ring)
    end_to_end(kind, origin, now, &motion);
  return motion;
}

struct vec3 dynamics_drift(const struct model *model, double from, double to)
{
  if (model_has_phantoms(model))
    return vec3_scale(to - from, model->flow);
  const double half_squares = 0.5 * (to - from) * (to + from) / model->total_mass;
  return vec3_add_scaled(vec3_scale(to - from, model->flow), half_squares, theory_net_force(model));
}

/* --- all lags ---------------------------------------------------------------------------------------------------- */

/* Quantities of the tally, each a pair (x, y). */
enum {
  VERTICES_CENTER,
  TUBE_CONTOUR,
  TURNED_SQUARE, /* their ratio makes the end-to-end correlation */
  MIDDLE_COSINE,
  QUANTITIES
};

enum {
  LEVELS = 24,               /* of blocks at lag 1; longer lags need fewer to reach as far in time */
  DEFAULT_SAMPLES = 1 << 20, /* longest lag where the plan knows none */
  MAX_LAGS = 80
};

/* Memory of a lag: for each kind a tally; and 1 + the origin's step (0: none), then the origin's positions. */
struct lag {
  uint64_t samples;
  double *real;
  int64_t *mark;
  struct point *origin;
};

static uint32_t count_lags(const struct observer *observer)
{
  const uint64_t longest = observer->longest_lag ? observer->longest_lag / observer->every : DEFAULT_SAMPLES;
  uint32_t n = 0;
  while (n < MAX_LAGS && dynamics_lag(n) <= longest)
    n++;
  return n;
}

static struct tally_shape tally_of(const struct fiber_kind *kind, uint32_t lag)
{
  const uint32_t doublings = (lag + 1) / 2;
  return (struct tally_shape){kind->count, QUANTITIES, doublings < LEVELS ? LEVELS - doublings : 1};
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

static size_t lag_integers(const struct model *model)
{
  return 1 + (size_t)model->vertices * sizeof(struct point) / sizeof(int64_t);
}

static struct lag first_lag(const struct observer *observer)
{
  int64_t *mark = observer->integer + 1;
  return (struct lag){dynamics_lag(0), observer->real, mark, (struct point *)(mark + 1)};
}

static void next_lag(struct lag *lag, const struct model *model, uint32_t number)
{
  lag->samples = dynamics_lag(number + 1);
  lag->real += lag_reals(model, number);
  lag->mark += lag_integers(model);
  lag->origin = (struct point *)(lag->mark + 1);
}

/* Scratch: the sums of a sample, then the contour of a fiber. */
static size_t scratch_sums(const struct model *model)
{
  size_t most = 0;
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct tally_shape shape = tally_of(&model->kind[k], 0);
    const size_t sums = tally_sums(&shape);
    most = sums > most ? sums : most;
  }
  return most;
}

static void size_dynamics(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  const uint32_t lags = count_lags(observer);
  uint32_t longest = 0;
  for (uint32_t n = 0; n < lags; n++)
    size->reals += lag_reals(model, n);
  for (uint32_t k = 0; k < model->kinds; k++)
    longest = model->kind[k].vertices > longest ? model->kind[k].vertices : longest;
  size->integers += lags * lag_integers(model);
  size->scratch = scratch_sums(model) + (size_t)longest * sizeof(struct vec3) / sizeof(double);
}

/* Adds what all fibers did since the origin to the tallies of a lag. */
static void compare(const struct observer *observer, const struct model *model, const struct lag *lag, uint32_t number,
                    const struct point *now, struct vec3 drift)
{
  double *memory = lag->real, *sums = observer->scratch;
  struct vec3 *contour = (struct vec3 *)(sums + scratch_sums(model));
  const struct point *origin = lag->origin;
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct fiber_kind *kind = &model->kind[k];
    const struct tally_shape shape = tally_of(kind, number);
    memset(sums, 0, tally_sums(&shape) * sizeof *sums);
    for (uint32_t fiber = 0; fiber < kind->count; fiber++, origin += kind->vertices, now += kind->vertices) {
      const struct fiber_motion m = fiber_motion(kind, origin, now, drift, contour);
      double values[QUANTITIES][2] = {[VERTICES_CENTER] = {m.vertices, m.center},
                                      [TUBE_CONTOUR] = {m.tube, m.tube_contour},
                                      [TURNED_SQUARE] = {m.turned, m.square},
                                      [MIDDLE_COSINE] = {m.middle, m.cosine}};
      tally_fiber(&shape, sums, fiber, values);
    }
    if (kind->count)
      tally_add(&shape, memory, sums);
    memory += tally_size(&shape);
  }
}

/* A lag whose time has come is compared and begins anew; so does, without comparison, one that missed it: no sample was
 * shown then. */
static void add_dynamics(struct observer *observer, struct view *view)
{
  const struct model *model = view->model;
  const uint64_t step = view->state->step;
  const uint32_t lags = count_lags(observer);
  struct lag lag = first_lag(observer);
  for (uint32_t n = 0; n < lags; next_lag(&lag, model, n++)) {
    const uint64_t from = (uint64_t)*lag.mark - 1, due = from + lag.samples * observer->every;
    if (*lag.mark && step < due)
      continue;
    if (*lag.mark && step == due) {
      const struct vec3 drift = dynamics_drift(model, (double)from * model->time_step, (double)step * model->time_step);
      compare(observer, model, &lag, n, view->state->position, drift);
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
                                      "intervals"};

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

static void fill_row(const struct fiber_kind *kind, struct cells c, double time)
{
  const bool ends = !kind->ring && kind->vertices > 1;
  *c.next++ = time;
  put(&c, true, VERTICES_CENTER, 0, 1.0);
  put(&c, true, VERTICES_CENTER, 1, 1.0);
  put(&c, true, MIDDLE_COSINE, 0, 1.0);
  put(&c, true, TUBE_CONTOUR, 0, 1.0);
  put(&c, true, TUBE_CONTOUR, 1, 1.0);
  put_end_to_end(&c, ends);
  put(&c, ends, MIDDLE_COSINE, 1, 1.0);
  put(&c, true, VERTICES_CENTER, 1, 1.0 / (6.0 * time)); /* D(t) = g_cm(t) / 6t */
  *c.next = tally_count(c.shape, c.memory);
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
  const uint32_t lags = count_lags(observer);
  struct lag lag = first_lag(observer);
  for (uint32_t n = 0; n < lags; next_lag(&lag, model, n++)) {
    const double *memory = lag.real;
    for (uint32_t k = 0; k < kind; k++) {
      const struct tally_shape before = tally_of(&model->kind[k], n);
      memory += tally_size(&before);
    }
    const struct tally_shape shape = tally_of(&model->kind[kind], n);
    const struct cells cells = {&shape, memory, &value[table.rows * COLUMNS]};
    if (tally_count(&shape, memory) == 0.0)
      continue;
    fill_row(&model->kind[kind], cells, (double)(lag.samples * observer->every) * model->time_step);
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
    .size = size_dynamics,
    .add = add_dynamics,
    .summarise = summarise_dynamics,
};
