#include "observe/statics.h"

#include <stdio.h>
#include <string.h>

#include "observe/observer.h"
#include "observe/tally.h"

/* Quantities of the tally, each a pair (x, y). */
enum {
  LENGTH_COSINE, /* <l>, <cos theta>: together they make the persistence length */
  SQUARE_LENGTH, /* <l^2>, <l>: together they make the energy of a bond */
  SIZES,         /* R_ee^2, R_g^2 */
  QUANTITIES
};

enum { LEVELS = 24 };

static uint32_t bonds_of(const struct fiber_kind *kind)
{
  return kind->vertices < 2 ? 0 : kind->vertices - !kind->ring;
}

static uint32_t bends_of(const struct fiber_kind *kind)
{
  return kind->vertices < 3 ? 0 : kind->vertices - (kind->ring ? 0 : 2);
}

static double mean(double sum, uint32_t n)
{
  return n ? sum / n : 0.0;
}

/* Bond lengths and bend angles, along the fiber; around it for a ring, whose first bend is the closing bond's with the
 * first. */
static void measure_bonds(const struct fiber_kind *kind, const struct point *position, struct fiber_shape *shape)
{
  const uint32_t n = kind->vertices, bonds = bonds_of(kind);
  struct vec3 before = {0, 0, 0};
  if (kind->ring) {
    before = point_difference(position[0], position[n - 1]);
    before = vec3_scale(1.0 / vec3_norm(before), before);
  }
  for (uint32_t j = 0; j < bonds; j++) {
    const struct vec3 r = point_difference(position[j + 1 < n ? j + 1 : 0], position[j]);
    const double squared = vec3_dot(r, r), length = sqrt(squared);
    const struct vec3 u = vec3_scale(1.0 / length, r);
    shape->length += length;
    shape->length_squared += squared;
    shape->cosine += vec3_dot(before, u);
    before = u;
  }
  shape->length = mean(shape->length, bonds);
  shape->length_squared = mean(shape->length_squared, bonds);
  shape->cosine = mean(shape->cosine, bends_of(kind));
}

struct fiber_shape fiber_shape(const struct fiber_kind *kind, const struct point *position)
{
  struct fiber_shape shape = {.length = 0.0};
  measure_bonds(kind, position, &shape);
  struct vec3 sum = {0, 0, 0};
  double squares = 0.0;
  for (uint32_t j = 0; j < kind->vertices; j++) {
    const struct vec3 r = point_difference(position[j], position[0]);
    sum = vec3_add(sum, r);
    squares += vec3_dot(r, r);
    if (j + 1 == kind->vertices && !kind->ring)
      shape.end_to_end = vec3_dot(r, r);
  }
  const struct vec3 center = vec3_scale(1.0 / kind->vertices, sum);
  shape.gyration = squares / kind->vertices - vec3_dot(center, center);
  return shape;
}

static struct tally_shape tally_of(const struct fiber_kind *kind)
{
  return (struct tally_shape){kind->count, QUANTITIES, LEVELS};
}

static void size_statics(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  (void)observer;
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct tally_shape shape = tally_of(&model->kind[k]);
    const size_t sums = tally_sums(&shape);
    size->reals += tally_size(&shape);
    size->scratch = size->scratch < sums ? sums : size->scratch;
  }
}

static void add_statics(struct observer *observer, struct view *view)
{
  double *memory = observer->real, *sums = observer->scratch;
  const struct point *position = view->state->position;
  for (uint32_t k = 0; k < view->model->kinds; k++) {
    const struct fiber_kind *kind = &view->model->kind[k];
    const struct tally_shape shape = tally_of(kind);
    memset(sums, 0, tally_sums(&shape) * sizeof *sums);
    for (uint32_t fiber = 0; fiber < kind->count; fiber++, position += kind->vertices) {
      const struct fiber_shape s = fiber_shape(kind, position);
      double values[QUANTITIES][2] = {[LENGTH_COSINE] = {s.length, s.cosine},
                                      [SQUARE_LENGTH] = {s.length_squared, s.length},
                                      [SIZES] = {s.end_to_end, s.gyration}};
      tally_fiber(&shape, sums, fiber, values);
    }
    if (kind->count)
      tally_add(&shape, memory, sums);
    memory += tally_size(&shape);
  }
}

/* --- the table --------------------------------------------------------------------------------------------------- */

static const char *const columns[] = {
    "l",           "l_error",           "l2",          "l2_error",          "cos",    "cos_error",
    "bond_energy", "bond_energy_error", "bend_energy", "bend_energy_error", "Ree2",   "Ree2_error",
    "Rg2",         "Rg2_error",         "lp",          "lp_error",          "samples"};

enum { COLUMNS = sizeof columns / sizeof *columns };

/* The means of a kind, and where their errors come from. */
struct averages {
  const struct tally_shape *shape;
  const double *memory;
};

static double average(const struct averages *a, uint32_t quantity, int part)
{
  return tally_mean(a->shape, a->memory, quantity, part);
}

/* Writes value and error, or NaN twice where the kind has no such thing; returns where to go on. */
static double *put(double *cell, bool defined, double value, double error)
{
  cell[0] = defined ? value : NAN;
  cell[1] = defined ? error : NAN;
  return cell + 2;
}

static double error_of(const struct averages *a, uint32_t quantity, double x, double y)
{
  return tally_error(a->shape, a->memory, quantity, x, y);
}

/* Fills a row. The bond's energy is k/2 <(l - l0)^2>, the bend's kappa (1 - <cos>); bonds that are independent but for
 * their bends have <u_i.u_j> = <cos>^|i-j|, which decays over lp = -<l>/ln<cos>. */
static void fill_row(const struct fiber_kind *kind, const struct averages *a, double *cell)
{
  const bool bonds = bonds_of(kind) > 0, bends = bends_of(kind) > 0, ends = bonds && !kind->ring;
  const double l = average(a, LENGTH_COSINE, 0), l2 = average(a, SQUARE_LENGTH, 0), c = average(a, LENGTH_COSINE, 1);
  const double k = kind->spring, l0 = kind->bond_length, kappa = kind->bending, decay = -log(c);
  const double bond_energy = 0.5 * k * (l2 - 2.0 * l0 * l + l0 * l0);
  cell = put(cell, bonds, l, error_of(a, LENGTH_COSINE, 1, 0));
  cell = put(cell, bonds, l2, error_of(a, SQUARE_LENGTH, 1, 0));
  cell = put(cell, bends, c, error_of(a, LENGTH_COSINE, 0, 1));
  cell = put(cell, bonds, bond_energy, error_of(a, SQUARE_LENGTH, 0.5 * k, -k * l0));
  cell = put(cell, bends, kappa * (1.0 - c), error_of(a, LENGTH_COSINE, 0, kappa));
  cell = put(cell, ends, average(a, SIZES, 0), error_of(a, SIZES, 1, 0));
  cell = put(cell, true, average(a, SIZES, 1), error_of(a, SIZES, 0, 1));
  cell = put(cell, bends && c > 0.0, l / decay, error_of(a, LENGTH_COSINE, 1.0 / decay, l / (decay * decay * c)));
  *cell = tally_count(a->shape, a->memory);
}

static bool summarise_statics(const struct observer *observer, const struct model *model,
                              const struct observer_take *to)
{
  const double *memory = observer->real;
  bool ok = true;
  for (uint32_t k = 0; ok && k < model->kinds; k++) {
    const struct fiber_kind *kind = &model->kind[k];
    const struct tally_shape shape = tally_of(kind);
    const struct averages averages = {&shape, memory};
    double row[COLUMNS];
    char name[OBSERVER_NAME_SIZE];
    snprintf(name, sizeof name, "statics-%s", kind->name);
    const struct observe_table table = {name, columns, COLUMNS, 1, row};
    if (kind->count) {
      fill_row(kind, &averages, row);
      ok = to->take(to->context, &table);
    }
    memory += tally_size(&shape);
  }
  return ok;
}

const struct observer_type statics_observer = {
    .size = size_statics,
    .add = add_statics,
    .summarise = summarise_statics,
    .each_kind = true,
};
