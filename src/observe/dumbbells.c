/*
 * The shape of dumbbells, averaged over the run: second moments of the vector r between their particles (Tao, Goetze
 * and Gompper 2008). One table "dumbbells" with one row. Sums over dumbbells are in fixed point (system/fluid.h), so
 * that they do not depend on memory order.
 */
#include <math.h>

#include "fluid/fluid.h"
#include "observe/block.h"
#include "observe/observer.h"

/* Quantities, each a pair (x, y), in units of kT/K. */
enum {
  ALONG,      /* r_x r_x, r_y r_y */
  ACROSS,     /* r_x r_y, r_x r_x - r_y r_y: together they make the angle */
  ALTOGETHER, /* r r, r_z r_z */
  QUANTITIES
};

enum { LEVELS = 24 };

static void size_dumbbells(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  (void)observer;
  (void)model;
  size->reals = QUANTITIES * LEVELS * BLOCK_LEVEL_DOUBLES;
}

static struct block_level *blocks_of(const struct observer *o, int quantity)
{
  return (struct block_level *)o->real + quantity * LEVELS;
}

static void add_dumbbells(struct observer *o, struct view *view)
{
  const uint32_t n = view->state->dumbbells.n;
  const double spring = view->model->dumbbells.spring, scale = n > 0 ? FLUX_UNIT / n : 0.0;
  int64_t sum[STRESS_COMPONENTS] = {0};
  for (uint32_t p = 0; p < n; p++) {
    const struct vec3 r = fluid_dumbbell_now(view->state, view->model, p);
    sum[STRESS_XY] += flux_fixed(spring * r.x * r.y);
    sum[STRESS_XX] += flux_fixed(spring * r.x * r.x);
    sum[STRESS_YY] += flux_fixed(spring * r.y * r.y);
    sum[STRESS_ZZ] += flux_fixed(spring * r.z * r.z);
  }
  const double xx = scale * (double)sum[STRESS_XX], yy = scale * (double)sum[STRESS_YY];
  const double zz = scale * (double)sum[STRESS_ZZ];
  if (n == 0)
    return;
  block_add(blocks_of(o, ALONG), LEVELS, xx, yy);
  block_add(blocks_of(o, ACROSS), LEVELS, scale * (double)sum[STRESS_XY], xx - yy);
  block_add(blocks_of(o, ALTOGETHER), LEVELS, xx + yy + zz, zz);
}

/* --- the table --------------------------------------------------------------------------------------------------- */

static const char *const columns[] = {
    "r2",   "r2_error",   "rxrx",      "rxrx_error",      "ryry", "ryry_error", "rzrz",    "rzrz_error",
    "rxry", "rxry_error", "extension", "extension_error", "chi",  "chi_error",  "samples",
};

enum { COLUMNS = sizeof columns / sizeof *columns };

static double *put_mean(double *cell, const struct block_level *level, int part, double scale)
{
  cell[0] = level->count > 0.0 ? scale * level->mean[part] : NAN;
  cell[1] = block_error(level, LEVELS, part == 0 ? scale : 0.0, part == 0 ? 0.0 : scale);
  return cell + 2;
}

static void fill_row(const struct observer *o, const struct model *model, double *cell)
{
  const double unit = 1.0 / model->dumbbells.spring, degrees = 57.29577951308232;
  const struct block_level *across = blocks_of(o, ACROSS), *all = blocks_of(o, ALTOGETHER);
  cell = put_mean(cell, all, 0, unit);
  cell = put_mean(cell, blocks_of(o, ALONG), 0, unit);
  cell = put_mean(cell, blocks_of(o, ALONG), 1, unit);
  cell = put_mean(cell, all, 1, unit);
  cell = put_mean(cell, across, 0, unit);
  const bool any = all->count > 0.0;
  const double extension = sqrt(all->mean[0] / model->dimensions);
  *cell++ = any ? extension : NAN;
  *cell++ = any ? block_error(all, LEVELS, 0.5 * extension / all->mean[0], 0.0) : NAN;
  /* tan 2 chi = 2 <xy>/<xx - yy> */
  const double xy = across->mean[0], difference = across->mean[1], square = difference * difference + 4.0 * xy * xy;
  *cell++ = any ? 0.5 * degrees * atan2(2.0 * xy, difference) : NAN;
  *cell++ = any ? block_error(across, LEVELS, degrees * difference / square, -degrees * xy / square) : NAN;
  *cell = all->count;
}

static bool summarise_dumbbells(const struct observer *o, const struct model *model, const struct observer_take *to)
{
  double row[COLUMNS];
  const struct observe_table table = {"dumbbells", columns, COLUMNS, 1, row};
  if (!model_has_dumbbells(model))
    return true;
  fill_row(o, model, row);
  return to->take(to->context, &table);
}

const struct observer_type dumbbells_observer = {
    .size = size_dumbbells,
    .add = add_dumbbells,
    .summarise = summarise_dumbbells,
};
