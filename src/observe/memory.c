/*
 * How long velocities and the stress of fibers are remembered, per kind of fiber: a table "memory-KIND" with a row per
 * lag, 0 and those of dynamics.h up to LONGEST samples.
 *
 *   vertices   <v(0).v(t)>/d of vertices          center  the same of centres of mass
 *   stress     <s(0) s(t)> of one fiber, kT^2: s_ab = sum of r_a F_b, F the forces of bonds and bends, averaged over
 * xy, xz, yz, in a plane of xy alone. Over kT and the volume per fiber it is the relaxation modulus G(t) (Green and
 * Kubo).
 *
 * Velocities are relative to the motion of everything (background.h) and half a step ahead, at both ends of a lag. Each
 * lag has an origin of its own: when the lag has passed, the present becomes the origin.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fiber/force.h"
#include "observe/background.h"
#include "observe/dynamics.h"
#include "observe/observer.h"
#include "observe/tally.h"
#include "system/fiber_kind.h"

enum { VERTICES_CENTER, STRESS, QUANTITIES };
enum { LONGEST = 4096, LAGS = 26, LEVELS = 20, STRESSES = 3 };

static uint64_t lag_of(uint32_t n)
{
  return n == 0 ? 0 : dynamics_lag(n - 1);
}

static struct tally_shape shape_of(const struct fiber_kind *kind)
{
  return (struct tally_shape){kind->count, QUANTITIES, LEVELS};
}

/* Doubles of the velocities of all vertices and the stresses of all fibers. */
static size_t sample_size(const struct model *m)
{
  return 3 * (size_t)m->vertices + STRESSES * (size_t)m->fibers;
}

static size_t tallies_size(const struct model *m)
{
  size_t sum = 0;
  for (uint32_t k = 0; k < m->kinds; k++) {
    const struct tally_shape shape = shape_of(&m->kind[k]);
    sum += tally_size(&shape);
  }
  return sum;
}

static void size_memory(const struct observer *o, const struct model *m, struct observer_size *size)
{
  size_t most = 0;
  (void)o;
  for (uint32_t k = 0; k < m->kinds; k++) {
    const struct tally_shape shape = shape_of(&m->kind[k]);
    most = tally_sums(&shape) > most ? tally_sums(&shape) : most;
  }
  size->reals = LAGS * (tallies_size(m) + sample_size(m));
  size->integers += LAGS;
  size->scratch = sample_size(m) + most;
}

static double *tallies_of(const struct observer *o, const struct model *m, uint32_t lag)
{
  return o->real + lag * (tallies_size(m) + sample_size(m));
}

static double *origin_of(const struct observer *o, const struct model *m, uint32_t lag)
{
  return tallies_of(o, m, lag) + tallies_size(m);
}

/* --- a sample ------------------------------------------------------------------------------------------------------
 */

static void take_stress(const struct view *view, uint32_t fiber, double *stress)
{
  const struct model *m = view->model;
  const struct point *at = view->state->position;
  const uint32_t first = m->fiber_first[fiber];
  const struct vec3 outer = m->kind[m->fiber_kind_of[fiber]].force;
  memset(stress, 0, STRESSES * sizeof *stress);
  for (uint32_t v = first; v < m->fiber_first[fiber + 1]; v++) {
    const struct vec3 r = point_difference(at[v], at[first]), f = vec3_sub(view->force[v], outer);
    stress[0] += r.x * f.y;
    stress[1] += r.x * f.z;
    stress[2] += r.y * f.z;
  }
}

static void take(const struct view *view, double *sample)
{
  const struct model *m = view->model;
  struct fault ignored = {.code = FAULT_NONE}; /* a bond too long for the box stops the run, not its observers */
  const struct vec3 background = background_velocity(m, ((double)view->state->step + 0.5) * m->time_step);
  fiber_forces(view->state, m, view->force, view->state->step, &ignored);
  for (uint32_t v = 0; v < m->vertices; v++) {
    const struct vec3 w = vec3_sub(view->state->velocity[v], background);
    memcpy(&sample[3 * v], (const double[]){w.x, w.y, w.z}, 3 * sizeof *sample);
  }
  for (uint32_t f = 0; f < m->fibers; f++)
    take_stress(view, f, &sample[3 * (size_t)m->vertices + STRESSES * (size_t)f]);
}

/* In a plane all components that leave it are 0. */
static double product(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Products of a fiber's values at both ends of a lag. */
static void correlate(const struct model *m, uint32_t fiber, const double *then, const double *now, double (*values)[2])
{
  const uint32_t first = m->fiber_first[fiber], n = m->fiber_first[fiber + 1] - first;
  const size_t stress = 3 * (size_t)m->vertices + STRESSES * (size_t)fiber;
  const double d = m->dimensions, shears = 0.5 * d * (d - 1.0);
  double sum[2][3] = {{0.0}}, vertices = 0.0;
  for (uint32_t v = first; v < first + n; v++) {
    vertices += product(&then[3 * v], &now[3 * v]) / (d * n);
    for (int k = 0; k < 3; k++) {
      sum[0][k] += then[3 * v + (uint32_t)k] / n;
      sum[1][k] += now[3 * v + (uint32_t)k] / n;
    }
  }
  values[VERTICES_CENTER][0] = vertices;
  values[VERTICES_CENTER][1] = product(sum[0], sum[1]) / d;
  values[STRESS][0] = product(&then[stress], &now[stress]) / shears;
  values[STRESS][1] = 0.0;
}

static void compare(const struct observer *o, const struct model *m, uint32_t lag, const double *now, double *sums)
{
  double *tally = tallies_of(o, m, lag);
  const double *then = origin_of(o, m, lag);
  uint32_t fiber = 0;
  for (uint32_t k = 0; k < m->kinds; k++) {
    const struct tally_shape shape = shape_of(&m->kind[k]);
    memset(sums, 0, tally_sums(&shape) * sizeof *sums);
    for (uint32_t i = 0; i < m->kind[k].count; i++) {
      double values[QUANTITIES][2];
      correlate(m, fiber++, then, now, values);
      tally_fiber(&shape, sums, i, values);
    }
    if (m->kind[k].count > 0)
      tally_add(&shape, tally, sums);
    tally += tally_size(&shape);
  }
}

/* integer[0] is the mark of the observer; integer[1 + n]: 1 + the step of the origin of lag n, 0: none. */
static void add_memory(struct observer *o, struct view *view)
{
  const struct model *m = view->model;
  const uint64_t step = view->state->step;
  double *now = o->scratch, *sums = now + sample_size(m);
  take(view, now);
  for (uint32_t n = 0; n < LAGS && lag_of(n) <= LONGEST; n++) {
    int64_t *mark = &o->integer[1 + n];
    const uint64_t due = (uint64_t)*mark - 1 + lag_of(n) * o->every;
    if (*mark && n > 0 && step < due)
      continue;
    if (n == 0)
      memcpy(origin_of(o, m, n), now, sample_size(m) * sizeof *now);
    if (n == 0 || (*mark && step == due))
      compare(o, m, n, now, sums);
    *mark = (int64_t)step + 1;
    memcpy(origin_of(o, m, n), now, sample_size(m) * sizeof *now);
  }
}

/* --- the table -----------------------------------------------------------------------------------------------------
 */

static const char *const columns[] = {"time",         "vertices",      "vertices_error",      "center",
                                      "center_error", "stress_memory", "stress_memory_error", "intervals"};

enum { COLUMNS = sizeof columns / sizeof *columns };

static void fill_row(const struct tally_shape *shape, const double *tally, double *row)
{
  row[1] = tally_mean(shape, tally, VERTICES_CENTER, 0);
  row[2] = tally_error(shape, tally, VERTICES_CENTER, 1.0, 0.0);
  row[3] = tally_mean(shape, tally, VERTICES_CENTER, 1);
  row[4] = tally_error(shape, tally, VERTICES_CENTER, 0.0, 1.0);
  row[5] = tally_mean(shape, tally, STRESS, 0);
  row[6] = tally_error(shape, tally, STRESS, 1.0, 0.0);
  row[7] = tally_count(shape, tally);
}

static bool summarise_memory(const struct observer *o, const struct model *m, const struct observer_take *to)
{
  bool ok = true;
  size_t offset = 0;
  for (uint32_t k = 0; ok && k < m->kinds; k++) {
    const struct tally_shape shape = shape_of(&m->kind[k]);
    double rows[LAGS][COLUMNS];
    char name[OBSERVER_NAME_SIZE];
    size_t n = 0;
    for (uint32_t lag = 0; lag < LAGS && lag_of(lag) <= LONGEST; lag++) {
      const double *tally = tallies_of(o, m, lag) + offset;
      if (!(tally_count(&shape, tally) > 0.0))
        continue;
      rows[n][0] = (double)(lag_of(lag) * o->every) * m->time_step;
      fill_row(&shape, tally, rows[n++]);
    }
    snprintf(name, sizeof name, "memory-%s", m->kind[k].name);
    const struct observe_table table = {name, columns, COLUMNS, n, rows[0]};
    ok = fiber_stands(&m->kind[k]) || to->take(to->context, &table); /* its vertices do not move */
    offset += tally_size(&shape);
  }
  return ok;
}

const struct observer_type memory_observer = {
    .size = size_memory, .add = add_memory, .summarise = summarise_memory, .each_kind = true};
