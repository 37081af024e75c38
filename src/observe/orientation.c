/*
 * How fibers lie in space, averaged over the run: second moments of the end-to-end vector R, and of the directions u of
 * bonds. A table "orientation-KIND" with one row for each kind of fiber with bonds. In a flow along x these moments
 * tell how fibers are stretched and turned into the flow.
 * The nematic order of all bonds of a kind in the box: S, the largest eigenvalue of Q = <3 u u - 1>/2 of one sample.
 * And how fast the end-to-end vector turns in the plane of x and y, from sample to sample: in shear a fiber tumbles,
 * and pi over this rate is the time of a half turn.
 */
#include <math.h>
#include <stdio.h>

#include "fiber/force.h"
#include "observe/block.h"
#include "observe/observer.h"

/* Quantities, each a pair (x, y). */
enum {
  ENDS_ALONG,  /* R_x R_x, R_y R_y */
  ENDS_ACROSS, /* R_x R_y, R_z R_z */
  BONDS_ALONG, /* u_x u_x, u_y u_y */
  BONDS_ACROSS,
  BONDS_ANGLE, /* u_x u_y, u_x u_x - u_y u_y: together they make the angle */
  ORDER,       /* S; 0 */
  TURNING,     /* change of the angle of R in the plane of x and y since the sample before, radians; 0 */
  QUANTITIES
};

enum { LEVELS = 24 };
enum { MARK, SEEN, INTEGERS }; /* SEEN: 1 after the first sample */

static void size_orientation(const struct observer *observer, const struct model *model, struct observer_size *size)
{
  (void)observer;
  size->reals = (size_t)model->kinds * QUANTITIES * LEVELS * BLOCK_LEVEL_DOUBLES + 2 * (size_t)model->fibers;
  size->integers = INTEGERS;
}

/* R_x and R_y of each fiber at the sample before. */
static double *before_of(const struct observer *o, const struct model *model)
{
  return o->real + (size_t)model->kinds * QUANTITIES * LEVELS * BLOCK_LEVEL_DOUBLES;
}

static struct block_level *blocks_of(const struct observer *o, uint32_t kind, int quantity)
{
  return (struct block_level *)o->real + ((size_t)kind * QUANTITIES + (size_t)quantity) * LEVELS;
}

struct moments {
  double xx, yy, zz, xy, xz, yz;
};

static void add_vector(struct moments *m, struct vec3 r, double weight)
{
  m->xx += weight * r.x * r.x;
  m->yy += weight * r.y * r.y;
  m->zz += weight * r.z * r.z;
  m->xy += weight * r.x * r.y;
  m->xz += weight * r.x * r.z;
  m->yz += weight * r.y * r.z;
}

/* The largest eigenvalue of Q = (3 m - trace m)/2: the largest root of x^3 - 3 a x - 2 b, a = tr Q^2/6, b = det Q/2. By
 * Newton's steps from 2 sqrt(a), which is not below it: from there they fall to it. */
static double largest_order(const struct moments *m)
{
  const double trace = (m->xx + m->yy + m->zz) / 3.0, xx = 1.5 * (m->xx - trace), yy = 1.5 * (m->yy - trace),
               zz = 1.5 * (m->zz - trace), xy = 1.5 * m->xy, xz = 1.5 * m->xz, yz = 1.5 * m->yz;
  const double a = (xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + xz * xz + yz * yz)) / 6.0,
               b = 0.5 * (xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz));
  double x = 2.0 * sqrt(a);
  for (int k = 0; k < 100; k++) {
    const double slope = 3.0 * (x * x - a), next = slope > 0.0 ? x - ((x * x - 3.0 * a) * x - 2.0 * b) / slope : x;
    if (!(next < x))
      break;
    x = next;
  }
  return x;
}

/* In a plane: the larger eigenvalue of 2 m - trace m. */
static double largest_order_in_plane(const struct moments *m)
{
  return sqrt((m->xx - m->yy) * (m->xx - m->yy) + 4.0 * m->xy * m->xy);
}

static bool is_bonded(const struct fiber_kind *kind)
{
  return kind->count > 0 && kind->vertices > 1;
}

/* By how much the projection of a vector has turned. before: of the same, replaced. */
static double turned(struct vec3 r, double before[2])
{
  const double angle = atan2(before[0] * r.y - before[1] * r.x, before[0] * r.x + before[1] * r.y);
  before[0] = r.x, before[1] = r.y;
  return angle;
}

/* One sample of a kind whose vertices begin at `first`, and its fibers at number `number`: means over its fibers, and
 * over its bonds. */
static void add_kind(struct observer *o, const struct view *view, uint32_t k, uint32_t first, uint32_t number)
{
  const struct model *model = view->model;
  const struct fiber_kind *kind = &model->kind[k];
  const uint32_t bonds = kind->vertices - !kind->ring;
  struct moments ends = {0, 0, 0, 0, 0, 0}, directions = {0, 0, 0, 0, 0, 0};
  double *before = before_of(o, model) + 2 * (size_t)number, turning = 0.0;
  for (uint32_t fiber = 0; fiber < kind->count; fiber++, first += kind->vertices) {
    for (uint32_t j = first; j < first + bonds; j++) {
      const struct vec3 r = fiber_bond(view->state, model, j);
      const double square = vec3_dot(r, r);
      add_vector(&directions, r, square > 0.0 ? 1.0 / (square * bonds * kind->count) : 0.0);
    }
    const struct point last = view->state->position[first + kind->vertices - 1];
    const struct vec3 r = point_difference(last, view->state->position[first]);
    add_vector(&ends, r, 1.0 / kind->count);
    turning += turned(r, &before[2 * (size_t)fiber]) / kind->count;
  }
  block_add(blocks_of(o, k, ENDS_ALONG), LEVELS, ends.xx, ends.yy);
  block_add(blocks_of(o, k, ENDS_ACROSS), LEVELS, ends.xy, ends.zz);
  block_add(blocks_of(o, k, BONDS_ALONG), LEVELS, directions.xx, directions.yy);
  block_add(blocks_of(o, k, BONDS_ACROSS), LEVELS, directions.xy, directions.zz);
  block_add(blocks_of(o, k, BONDS_ANGLE), LEVELS, directions.xy, directions.xx - directions.yy);
  block_add(blocks_of(o, k, ORDER), LEVELS,
            model_is_flat(model) ? largest_order_in_plane(&directions) : largest_order(&directions), 0.0);
  if (o->integer[SEEN])
    block_add(blocks_of(o, k, TURNING), LEVELS, turning, 0.0);
}

static void add_orientation(struct observer *o, struct view *view)
{
  uint32_t first = 0, number = 0;
  for (uint32_t k = 0; k < view->model->kinds; k++) {
    const struct fiber_kind *kind = &view->model->kind[k];
    if (is_bonded(kind))
      add_kind(o, view, k, first, number);
    first += kind->count * kind->vertices;
    number += kind->count;
  }
  o->integer[SEEN] = 1;
}

/* --- the table --------------------------------------------------------------------------------------------------- */

static const char *const columns[] = {
    "RxRx", "RxRx_error", "RyRy",    "RyRy_error",    "RzRz", "RzRz_error", "RxRy",    "RxRy_error",
    "uxux", "uxux_error", "uyuy",    "uyuy_error",    "uzuz", "uzuz_error", "uxuy",    "uxuy_error",
    "chi",  "chi_error",  "turning", "turning_error", "S",    "S_error",    "samples",
};

enum { COLUMNS = sizeof columns / sizeof *columns };

static double *put_mean(double *cell, const struct block_level *level, int part, bool there)
{
  cell[0] = there && level->count > 0.0 ? level->mean[part] : NAN;
  cell[1] = there ? block_error(level, LEVELS, part == 0 ? 1.0 : 0.0, part == 0 ? 0.0 : 1.0) : NAN;
  return cell + 2;
}

static void fill_row(const struct observer *o, const struct model *model, uint32_t k, double *cell)
{
  const bool open = !model->kind[k].ring;
  const double degrees = 57.29577951308232;
  const struct block_level *angle = blocks_of(o, k, BONDS_ANGLE);
  cell = put_mean(cell, blocks_of(o, k, ENDS_ALONG), 0, open);
  cell = put_mean(cell, blocks_of(o, k, ENDS_ALONG), 1, open);
  cell = put_mean(cell, blocks_of(o, k, ENDS_ACROSS), 1, open);
  cell = put_mean(cell, blocks_of(o, k, ENDS_ACROSS), 0, open);
  cell = put_mean(cell, blocks_of(o, k, BONDS_ALONG), 0, true);
  cell = put_mean(cell, blocks_of(o, k, BONDS_ALONG), 1, true);
  cell = put_mean(cell, blocks_of(o, k, BONDS_ACROSS), 1, true);
  cell = put_mean(cell, blocks_of(o, k, BONDS_ACROSS), 0, true);
  /* tan 2 chi = 2 <xy>/<xx - yy> */
  const double xy = angle->mean[0], difference = angle->mean[1], square = difference * difference + 4.0 * xy * xy;
  const bool any = angle->count > 0.0;
  *cell++ = any ? 0.5 * degrees * atan2(2.0 * xy, difference) : NAN;
  *cell++ = any ? block_error(angle, LEVELS, degrees * difference / square, -degrees * xy / square) : NAN;
  const struct block_level *turning = blocks_of(o, k, TURNING);
  const double each = 1.0 / ((double)o->every * model->time_step); /* 1/t0 */
  *cell++ = open && turning->count > 0.0 ? each * turning->mean[0] : NAN;
  *cell++ = open ? block_error(turning, LEVELS, each, 0.0) : NAN;
  *put_mean(cell, blocks_of(o, k, ORDER), 0, true) = angle->count;
}

static bool summarise_orientation(const struct observer *o, const struct model *model, const struct observer_take *to)
{
  bool ok = true;
  for (uint32_t k = 0; ok && k < model->kinds; k++) {
    double row[COLUMNS];
    char name[OBSERVER_NAME_SIZE];
    if (!is_bonded(&model->kind[k]))
      continue;
    snprintf(name, sizeof name, "orientation-%s", model->kind[k].name);
    const struct observe_table table = {name, columns, COLUMNS, 1, row};
    fill_row(o, model, k, row);
    ok = to->take(to->context, &table);
  }
  return ok;
}

const struct observer_type orientation_observer = {
    .size = size_orientation,
    .add = add_orientation,
    .summarise = summarise_orientation,
    .each_kind = true,
};
