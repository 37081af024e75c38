/* Streaming and cells, made with one thing changed. */
#include <math.h>
#include <string.h>

#include "oracle/patterns.h"
#include "oracle/relations.h"
#include "oracle/single.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

typedef double rounding(double x);

static double single_precision(double x)
{
  return single_of(x);
}

/* --- streaming ---------------------------------------------------------------------------------------------------- */

enum wrapping {
  WRAPPED,
  WRAPPED_ABOVE,
  WRAPPED_BELOW,
  WRAPPED_BY_X,
  WRAPPED_BY_Y,
  WRAPPED_BY_Z,
  REFLECTED,
  UNWRAPPED,
  CLAMPED
};

struct flight_twist {
  double velocity; /* times, less 1 */
  double body;     /* share of a t^2, more than a half */
  bool one_step, time_once;
  int acceleration_of; /* 1 + component, of all axes */
  rounding *round;     /* NULL: to the nearest */
  rounding *before;    /* of the flight in a0 */
  enum wrapping wrapping;
  int velocity_of;
  const char *text;
};

static double wrapped(double x, const struct box *box, uint32_t axis, enum wrapping how)
{
  const double edge = (double)box->edge[how >= WRAPPED_BY_X && how <= WRAPPED_BY_Z ? how - WRAPPED_BY_X : axis];
  if (how == UNWRAPPED || (how == WRAPPED_ABOVE && x < 0.0) || (how == WRAPPED_BELOW && x >= edge))
    return x;
  if (how == CLAMPED)
    return fmin(fmax(x, 0.0), edge - 1.0);
  if (how == REFLECTED)
    return x < 0.0 ? -x : x >= edge ? 2.0 * edge - x : x;
  return x - edge * floor(x / edge);
}

static double flight_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct flight_twist *t = twist;
  const struct pack_table *r = oracle_sibling(&part->pair, "in.position"),
                          *v = oracle_sibling(&part->pair, "in.velocity");
  const struct pack_table *in = oracle_sibling(&part->pair, "in.time"), *reals = oracle_model(&part->pair, "in.reals");
  struct box box;
  if (!r || !v || !in || !reals || v->rows == 0 || column > 2 || !oracle_box(&part->pair, &box))
    return NAN;
  const uint32_t from = (row + v->rows + (uint32_t)t->velocity_of) % v->rows;
  const double time = t->one_step ? pack_value(reals, 0, 0) : pack_value(in, 0, 0),
               a = pack_value(reals, 0, 3 + (t->acceleration_of ? (uint32_t)t->acceleration_of - 1 : column));
  double flight = (1.0 + t->velocity) * pack_value(v, from, column) * time +
                  ((0.5 + t->body) * a * time) * (t->time_once ? 1.0 : time);
  flight = (t->before ? t->before(flight) : flight) * LATTICE_PER_A0;
  return wrapped(pack_value(r, row, column) + (t->round ? t->round(flight) : rint(flight)), &box, column, t->wrapping);
}

static bool flights(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct flight_twist known[] = {
      {.wrapping = UNWRAPPED, .text = "positions are not wrapped into the box"},
      {.wrapping = WRAPPED_ABOVE, .text = "positions below 0 are not wrapped into the box"},
      {.wrapping = WRAPPED_BELOW, .text = "positions beyond the upper edge are not wrapped into the box"},
      {.wrapping = WRAPPED_BY_X, .text = "wrapped by the edge of x along all axes"},
      {.wrapping = WRAPPED_BY_Y, .text = "wrapped by the edge of y along all axes"},
      {.wrapping = WRAPPED_BY_Z, .text = "wrapped by the edge of z along all axes"},
      {.wrapping = REFLECTED, .text = "reflected at the faces of the box, not wrapped"},
      {.wrapping = CLAMPED, .text = "stopped at the faces of the box, not wrapped"},
      {.velocity = -0.5, .text = "half step: particles fly for half the time"},
      {.velocity = 1.0, .text = "particles fly for twice the time"},
      {.velocity = -2.0, .text = "sign: particles fly backwards"},
      {.velocity = -1.0, .text = "particles do not fly: no velocity in the flight"},
      {.one_step = true, .text = "stale lag: particles fly for one step, not for the time since the last collision"},
      {.body = 0.5, .text = "body force without its half: a t^2 for (a/2) t^2"},
      {.body = 1.0, .text = "flight with the velocity after the push: (3/2) a t^2 for (1/2) a t^2"},
      {.body = -0.25, .text = "body force halved in the flight: (a/4) t^2 for (a/2) t^2"},
      {.time_once = true, .text = "body force with the time once: (a/2) t for (a/2) t^2"},
      {.acceleration_of = 1, .text = "body force: its x along all axes"},
      {.acceleration_of = 2, .text = "body force: its y along all axes"},
      {.acceleration_of = 3, .text = "body force: its z along all axes"},
      {.body = -0.5, .text = "body force left out of the flight: (a/2) t^2 is missing"},
      {.body = -1.0, .text = "sign of the body force in the flight"},
      {.round = trunc, .text = "flight cut toward zero, not rounded to the nearest lattice unit"},
      {.round = floor, .text = "flight rounded down, not to the nearest lattice unit"},
      {.round = ceil, .text = "flight rounded up, not to the nearest lattice unit"},
      {.round = round, .text = "flight rounded with ties away from zero, not to even"},
      {.before = single_precision, .text = "single precision: the flight, before it is rounded to the lattice"},
      {.velocity_of = 1, .text = "velocity of the next particle"},
      {.velocity_of = -1, .text = "velocity of the particle before"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, flight_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* Velocities after the flight: v + a t. */
struct push_twist {
  double push; /* times, less 1 */
  int acceleration_of, turned;
  bool one_step, time_squared, untimed, only;
  const char *text;
};

static double push_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct push_twist *t = twist;
  const struct pack_table *v = oracle_sibling(&part->pair, "in.velocity"), *in = oracle_sibling(&part->pair, "in.time");
  const struct pack_table *reals = oracle_model(&part->pair, "in.reals");
  if (!v || !in || !reals || column > 2)
    return NAN;
  const double time = pack_value(t->one_step ? reals : in, 0, 0);
  const uint32_t axis = t->acceleration_of ? (uint32_t)t->acceleration_of - 1 : (column + (uint32_t)t->turned) % 3;
  const double push = (1.0 + t->push) * pack_value(reals, 0, 3 + axis) *
                      (t->untimed        ? 1.0
                       : t->time_squared ? time * time
                                         : time);
  return (t->only ? 0.0 : pack_value(v, row, column)) + push;
}

static bool pushes(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct push_twist known[] = {
      {.push = -1.0, .text = "velocities without the body force: v + a t"},
      {.push = -0.5, .text = "half of the body force in velocities: v + a t"},
      {.push = 1.0, .text = "twice the body force in velocities: v + a t"},
      {.push = -2.0, .text = "sign of the body force in velocities: v + a t"},
      {.acceleration_of = 1, .text = "body force in velocities: its x along all axes"},
      {.acceleration_of = 2, .text = "body force in velocities: its y along all axes"},
      {.acceleration_of = 3, .text = "body force in velocities: its z along all axes"},
      {.turned = 1, .text = "body force in velocities: y, z, x for x, y, z"},
      {.turned = 2, .text = "body force in velocities: z, x, y for x, y, z"},
      {.one_step = true, .text = "body force in velocities of one step, not of the time since the last collision"},
      {.time_squared = true, .text = "body force in velocities with the time squared: v + a t"},
      {.untimed = true, .text = "body force in velocities without the time: v + a t"},
      {.only = true, .text = "velocities replaced by a t: it is added to them"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, push_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- cells -------------------------------------------------------------------------------------------------------- */

/* Cells from coordinates in double precision: how they are wrapped, and whether the sum is of integers. */
enum doubles { NO_DOUBLES, CELL_OF_DOUBLES, REMAINDER_OF_DOUBLES, CELL_OF_SUM, REMAINDER_OF_SUM };

/* Where a coordinate is that is not wrapped as often as it takes. */
enum outside { OUTSIDE_WRAPPED, OUTSIDE_KEPT, OUTSIDE_CLAMPED };

struct bin_twist {
  double shift[3];   /* times, less 1 */
  enum outside once; /* wrapped by one edge at most */
  int64_t units;     /* lattice units further on */
  int shift_of;      /* 1 + component, of all axes */
  int turned;        /* components of the shift further on */
  enum doubles doubles;
  bool size; /* |x| */
  bool wrapped_first, clamped, nearest, toward_zero, upper_face, single, half, single_sum;
  int wrapped_by; /* 1 + axis whose edge all are wrapped by */
  const char *text;
};

static int64_t wrapped_once(int64_t x, int64_t edge, enum outside how)
{
  const int64_t y = x < 0 ? x + edge : x >= edge ? x - edge : x;
  return how == OUTSIDE_CLAMPED ? (y < 0 ? 0 : y >= edge ? edge - 1 : y) : y;
}

/* In numbers of double precision, a0. */
static double bin_in_doubles(const struct bin_twist *t, int64_t at, int64_t shift, double cells)
{
  const bool of_sum = t->doubles == CELL_OF_SUM || t->doubles == REMAINDER_OF_SUM;
  const double x =
      of_sum ? (double)(at + shift) * LATTICE_UNIT : (double)at * LATTICE_UNIT + (double)shift * LATTICE_UNIT;
  const bool remainder = t->doubles == REMAINDER_OF_DOUBLES || t->doubles == REMAINDER_OF_SUM;
  const double rest = fmod(remainder ? x : floor(x), cells);
  return floor(rest < 0.0 ? rest + cells : rest);
}

static int64_t cell_of_units(int64_t x)
{
  return lattice_image(x, LATTICE_CELL);
}

/* Along one axis, in lattice units. */
static double bin_coordinate(const struct bin_twist *t, int64_t at, int64_t shift, const struct box *box, uint32_t axis)
{
  const int64_t edge = box->edge[t->wrapped_by ? t->wrapped_by - 1 : (int)axis];
  const double cells = box->cells[axis], factor = 1.0 + t->shift[axis];
  const int64_t moved = factor == 1.0 ? shift : (int64_t)rint(factor * (double)shift);
  int64_t x = at + moved + t->units;
  if (t->doubles)
    return bin_in_doubles(t, at, moved, cells);
  if (t->wrapped_first)
    return (double)cell_of_units(at - edge * lattice_image(at, edge) + moved);
  if (t->clamped)
    return fmin(fmax((double)cell_of_units(x), 0.0), cells - 1.0);
  if (t->toward_zero) {
    const int64_t cut = x / LATTICE_CELL;
    const double c = fmod((double)cut, cells);
    return c < 0.0 ? c + cells : c;
  }
  if (t->size)
    return (double)cell_of_units((x < 0 ? -x : x) % edge);
  if (t->single_sum)
    x = (int64_t)(single_of(single_of((double)at * LATTICE_UNIT) + single_of((double)moved * LATTICE_UNIT)) *
                  LATTICE_PER_A0);
  if (t->once)
    return (double)cell_of_units(wrapped_once(x, edge, t->once));
  x -= edge * lattice_image(x, edge);
  if (t->upper_face)
    return (double)(cell_of_units(x - 1));
  if (t->nearest)
    return fmod(rint((double)x * LATTICE_UNIT), cells);
  if (t->single)
    return fmod(floor(single_of((double)x * LATTICE_UNIT)), cells);
  return (double)cell_of_units(x);
}

#define REACH ((int64_t)1 << 61) /* of positions and shifts, so that sums fit */

static bool bin_point(const struct evidence_part *part, uint32_t row, const struct bin_twist *t, struct box *box,
                      double c[3])
{
  const struct pack_table *r = oracle_input(&part->pair), *shift = oracle_sibling(&part->pair, "in.shift");
  if (!oracle_box(&part->pair, box) || !oracle_is_vectors(r, false, row) || !oracle_is_vectors(shift, false, 0))
    return false;
  for (uint32_t k = 0; k < 3; k++) {
    const uint32_t of = t->shift_of ? (uint32_t)t->shift_of - 1 : (k + (uint32_t)t->turned) % 3;
    const int64_t at = r->value.integer[3 * (size_t)row + k], by = shift->value.integer[of];
    if (at > REACH || at < -REACH || by > REACH || by < -REACH)
      return false;
    c[k] = bin_coordinate(t, at, by, box, k);
  }
  return true;
}

static double bin_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  struct box box;
  double c[3];
  (void)column;
  return bin_point(part, row, twist, &box, c) ? (c[2] * box.cells[1] + c[1]) * box.cells[0] + c[0] : NAN;
}

static bool bins(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct bin_twist known[] = {
      {.shift = {-2.0, -2.0, -2.0}, .text = "grid shift sign: the shift is subtracted from positions, not added"},
      {.shift = {-1.0, -1.0, -1.0}, .text = "no grid shift"},
      {.shift = {1.0, 1.0, 1.0}, .text = "twice the grid shift"},
      {.shift = {-0.5, -0.5, -0.5}, .text = "half the grid shift"},
      {.shift = {-1.0, 0.0, 0.0}, .text = "no grid shift along x"},
      {.shift = {0.0, -1.0, 0.0}, .text = "no grid shift along y"},
      {.shift = {0.0, 0.0, -1.0}, .text = "no grid shift along z"},
      {.shift = {0.0, -1.0, -1.0}, .text = "no grid shift along y and z"},
      {.shift = {-1.0, 0.0, -1.0}, .text = "no grid shift along x and z"},
      {.shift = {-1.0, -1.0, 0.0}, .text = "no grid shift along x and y"},
      {.wrapped_first = true, .text = "index = L: wrapped before the shift is added, not after"},
      {.clamped = true, .text = "stopped at the first and last cell, not wrapped"},
      {.toward_zero = true, .text = "cells cut toward zero, not rounded down: negative coordinates"},
      {.nearest = true, .text = "the nearest face's cell: coordinates are rounded, not rounded down"},
      {.upper_face = true, .text = "cells are half-open: what lies on a face belongs to the cell above it"},
      {.single = true, .text = "single precision: cells from positions rounded to 24 bits"},
      {.single_sum = true, .text = "single precision: cells from a sum of position and shift in 24 bits"},
      {.wrapped_by = 1, .text = "wrapped by the edge of x along all axes"},
      {.wrapped_by = 2, .text = "wrapped by the edge of y along all axes"},
      {.wrapped_by = 3, .text = "wrapped by the edge of z along all axes"},
      {.once = OUTSIDE_KEPT, .text = "wrapped by one edge at most: unwrapped vertices may be further away"},
      {.once = OUTSIDE_CLAMPED,
       .text = "wrapped by one edge at most, then stopped at the faces: vertices may be further"},
      {.units = -1, .text = "cells are half-open: what lies on a face belongs to the cell above it (1 unit too low)"},
      {.units = 1, .text = "cells of coordinates that are 1 unit too high"},
      {.doubles = CELL_OF_DOUBLES, .text = "cells from position and shift in doubles: they are integers of 64 bits"},
      {.doubles = REMAINDER_OF_DOUBLES,
       .text = "cells from position and shift added and wrapped in doubles: they are integers of 64 bits"},
      {.doubles = CELL_OF_SUM, .text = "cells from coordinates in doubles: they are integers of 64 bits"},
      {.doubles = REMAINDER_OF_SUM, .text = "cells from coordinates wrapped in doubles: they are integers of 64 bits"},
      {.size = true, .text = "cells of |x|: negative coordinates are wrapped, not reflected"},
      {.shift_of = 1, .text = "the grid shift's x along all axes"},
      {.shift_of = 2, .text = "the grid shift's y along all axes"},
      {.shift_of = 3, .text = "the grid shift's z along all axes"},
      {.turned = 1, .text = "the grid shift's y, z, x for x, y, z"},
      {.turned = 2, .text = "the grid shift's z, x, y for x, y, z"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, bin_value, &known[k]);
  const bool none = known[k].shift[0] == -1.0 && known[k].shift[1] == -1.0 && known[k].shift[2] == -1.0;
  const bool solvent = none && strcmp(e->part[0].pair.ours->name, "out.vertex") == 0;
  return relation_say(text, "%s", solvent ? "grid shift applied to the solvent only, or no grid shift" : known[k].text);
}

struct number_twist {
  uint32_t axis[3];   /* slowest first */
  uint32_t stride[2]; /* whose cells the first and the second are multiplied by */
  double moved[3];
  const char *text;
  int mirrored; /* 1 + axis; 4: all */
  bool wraps;
};

static double number_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  static const struct bin_twist none = {.text = NULL};
  const struct number_twist *t = twist;
  struct box box;
  double c[3];
  (void)column;
  if (!bin_point(part, row, &none, &box, c))
    return NAN;
  for (int k = 0; k < 3; k++) {
    c[k] = t->mirrored == k + 1 || t->mirrored == 4 ? box.cells[k] - 1.0 - c[k] : c[k];
    c[k] += t->moved[k];
    c[k] -= t->wraps ? box.cells[k] * floor(c[k] / box.cells[k]) : 0.0;
  }
  return (c[t->axis[0]] * box.cells[t->stride[0]] + c[t->axis[1]]) * box.cells[t->stride[1]] + c[t->axis[2]];
}

static bool numbers(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct number_twist known[] = {
      {{0, 1, 2}, {1, 2}, {0}, "cell numbers with x slowest instead of fastest", 0, false},
      {{0, 2, 1}, {2, 1}, {0}, "cell numbers with x slowest and y fastest", 0, false},
      {{1, 2, 0}, {2, 0}, {0}, "cell numbers with y slowest: axes y and z exchanged", 0, false},
      {{1, 0, 2}, {0, 2}, {0}, "cell numbers with y slowest and z fastest", 0, false},
      {{2, 0, 1}, {0, 1}, {0}, "cell numbers with y fastest: axes x and y exchanged", 0, false},
      {{1, 2, 0}, {1, 0}, {0}, "coordinates y and z exchanged in cell numbers", 0, false},
      {{2, 0, 1}, {1, 0}, {0}, "coordinates x and y exchanged in cell numbers", 0, false},
      {{0, 1, 2}, {1, 0}, {0}, "coordinates x and z exchanged in cell numbers", 0, false},
      {{2, 1, 0}, {0, 0}, {0}, "stride of cell numbers: (z Lx + y) Lx + x", 0, false},
      {{2, 1, 0}, {0, 1}, {0}, "stride of cell numbers: (z Lx + y) Ly + x", 0, false},
      {{2, 1, 0}, {1, 1}, {0}, "stride of cell numbers: (z Ly + y) Ly + x", 0, false},
      {{2, 1, 0}, {2, 0}, {0}, "stride of cell numbers: (z Lz + y) Lx + x", 0, false},
      {{2, 1, 0}, {2, 1}, {0}, "stride of cell numbers: (z Lz + y) Ly + x", 0, false},
      {{2, 1, 0}, {1, 2}, {0}, "stride of cell numbers: (z Ly + y) Lz + x", 0, false},
      {{2, 1, 0}, {2, 2}, {0}, "stride of cell numbers: (z Lz + y) Lz + x", 0, false},
      {{2, 1, 0}, {0, 2}, {0}, "stride of cell numbers: (z Lx + y) Lz + x", 0, false},
      {{2, 1, 0}, {1, 0}, {1, 0, 0}, "one cell further along x", 0, true},
      {{2, 1, 0}, {1, 0}, {0, 1, 0}, "one cell further along y", 0, true},
      {{2, 1, 0}, {1, 0}, {0, 0, 1}, "one cell further along z", 0, true},
      {{2, 1, 0}, {1, 0}, {1, 1, 1}, "one cell further along all axes", 0, true},
      {{2, 1, 0}, {1, 0}, {-1, 0, 0}, "one cell back along x", 0, true},
      {{2, 1, 0}, {1, 0}, {0, -1, 0}, "one cell back along y", 0, true},
      {{2, 1, 0}, {1, 0}, {0, 0, -1}, "one cell back along z", 0, true},
      {{2, 1, 0}, {1, 0}, {-1, -1, -1}, "one cell back along all axes", 0, true},
      {{2, 1, 0}, {1, 0}, {1, 1, 1}, "coordinates of cells from 1, not 0", 0, false},
      {{2, 1, 0}, {1, 0}, {0}, "cells along x in reverse order", 1, false},
      {{2, 1, 0}, {1, 0}, {0}, "cells along y in reverse order", 2, false},
      {{2, 1, 0}, {1, 0}, {0}, "cells along z in reverse order", 3, false},
      {{2, 1, 0}, {1, 0}, {0}, "cells in reverse order along all axes", 4, false},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, number_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

const struct relation oracle_relations_grid[] = {
    {"stream", "out.position", flights, false},
    {"stream", "out.velocity", pushes, false},
    {"bin", NULL, bins, false},
    {"bin", NULL, numbers, false},
    {.make = NULL},
};
