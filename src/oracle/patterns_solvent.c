/* What went wrong in streaming and in the collision. */
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "oracle/patterns.h"
#include "solvent/solvent.h"
#include "solvent/srd.h"

/* --- streaming --------------------------------------------------------------------------------------------------- */

/* Where a particle is after part of its flight, the body force entering as share a t^2. */
static double flown(const struct oracle_pair *p, uint32_t row, uint32_t column, double part, double share)
{
  const struct pack_table *r = oracle_sibling(p, "in.position"), *v = oracle_sibling(p, "in.velocity");
  const struct pack_table *time = oracle_sibling(p, "in.time"), *reals = oracle_model(p, "in.reals");
  struct box box;
  if (!oracle_is_vectors(r, false, row) || !oracle_is_vectors(v, true, row) || !time || !reals || !oracle_box(p, &box))
    return NAN;
  const double t = pack_value(time, 0, 0), a = pack_value(reals, 0, 3 + column);
  const double flight = part * pack_value(v, row, column) * t + share * a * t * t;
  const int64_t at = r->value.integer[3 * (size_t)row + column];
  if (!(fabs(flight) < LATTICE_MAX_MOVE) || at < 0 || at >= box.edge[column])
    return NAN;
  return (double)lattice_fold(at + lattice_from_a0(flight), box.edge[column]);
}

static double half_flight(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return flown(p, row, column, 0.5, 0.5);
}

static double double_flight(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return flown(p, row, column, 2.0, 0.5);
}

static double force_without_half(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return flown(p, row, column, 1.0, 1.0);
}

static double force_without_flight(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return flown(p, row, column, 1.0, 0.0);
}

/* Differ by whole box edges. */
static bool not_wrapped(const struct oracle_pair *p)
{
  struct box box;
  if (!oracle_box(p, &box))
    return false;
  for (uint32_t row = 0; row < oracle_common_rows(p); row++)
    for (uint32_t k = 0; k < 3; k++)
      if (!(fabs(remainder(pack_value(p->theirs, row, k) - pack_value(p->ours, row, k), (double)box.edge[k])) <= 1.0))
        return false;
  return true;
}

/* --- cells ------------------------------------------------------------------------------------------------------- */

/* Position plus so many shifts; false if the pack has none. */
static bool shifted(const struct oracle_pair *p, uint32_t row, int64_t sign, struct box *box, struct point *at)
{
  const struct pack_table *r = oracle_input(p), *shift = oracle_sibling(p, "in.shift");
  const int64_t reach = (int64_t)1 << 61;
  if (!oracle_is_vectors(r, false, row) || !oracle_is_vectors(shift, false, 0) || !oracle_box(p, box))
    return false;
  for (uint32_t k = 0; k < 3; k++)
    if (fabs(pack_value(r, row, k)) > (double)reach || fabs(pack_value(shift, 0, k)) > (double)reach)
      return false;
  const struct point s = oracle_point(shift, 0);
  *at = oracle_point(r, row);
  at->x += sign * s.x, at->y += sign * s.y, at->z += sign * s.z;
  return true;
}

static double cell_for(const struct oracle_pair *p, uint32_t row, int64_t sign)
{
  struct box box;
  struct point at;
  const struct point none = {0, 0, 0};
  return shifted(p, row, sign, &box, &at) ? solvent_cell_of(&box, at, none) : NAN;
}

static double subtracted(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return cell_for(p, row, -1);
}

static double unshifted(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  (void)column;
  return cell_for(p, row, 0);
}

static double x_slowest(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct box box;
  if (!oracle_box(p, &box) || p->ours->columns != 1)
    return NAN;
  const int64_t lx = box.cells[0], ly = box.cells[1], lz = box.cells[2];
  const int64_t cell = p->ours->real ? 0 : p->ours->value.integer[row];
  (void)column;
  const int64_t x = cell % lx, y = cell / lx % ly, z = cell / (lx * ly);
  const int64_t number = (x * ly + y) * lz + z;
  return (double)number;
}

/* True if cells are wrong nowhere but at such places, and somewhere. */
static bool wrong_only_where(const struct oracle_pair *p, bool (*such)(const struct box *, struct point))
{
  bool any = false;
  for (uint32_t row = 0; row < oracle_common_rows(p); row++) {
    struct box box;
    struct point at;
    if (oracle_agrees(p, row, 0))
      continue;
    if (!shifted(p, row, 1, &box, &at) || !such(&box, at))
      return false;
    any = true;
  }
  return any;
}

static bool on_face(const struct box *box, struct point at)
{
  (void)box;
  return at.x % LATTICE_CELL == 0 || at.y % LATTICE_CELL == 0 || at.z % LATTICE_CELL == 0;
}

/* More than one edge outside. */
static bool far_outside(const struct box *box, struct point at)
{
  const int64_t image[3] = {lattice_image(at.x, box->edge[0]), lattice_image(at.y, box->edge[1]),
                            lattice_image(at.z, box->edge[2])};
  bool far = false;
  for (int k = 0; k < 3; k++)
    far |= image[k] < -1 || image[k] > 1;
  return far;
}

static bool faces_wrong(const struct oracle_pair *p)
{
  return wrong_only_where(p, on_face);
}

static bool wrapped_once(const struct oracle_pair *p)
{
  return wrong_only_where(p, far_outside);
}

/* --- sums and solutions ------------------------------------------------------------------------------------------ */

/* Our sum, with every vertex of mass 1. */
static double massless(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *cell = oracle_sibling(p, "in.vertex_cell"), *v = oracle_sibling(p, "in.vertex");
  const struct pack_table *vertex = oracle_model(p, "in.vertex");
  double sum = pack_value(p->ours, row, column);
  for (uint32_t k = 0; cell && v && vertex && k < cell->rows && k < v->rows; k++)
    if (pack_value(cell, k, 0) == row) {
      const double one = SRD_MOMENTUM_SCALE * pack_value(v, k, column);
      sum += rint(one) - rint(pack_value(vertex, k, 0) * one);
    }
  return sum;
}

static double by_number(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *load = oracle_sibling(p, "in.load");
  return load && row < load->rows
             ? pack_value(p->ours, row, column) * pack_value(load, row, 1) * SRD_MASS_UNIT / pack_value(load, row, 0)
             : NAN;
}

/* Axis of a cell, another entity or step in its address. */
static double axis_at(const struct oracle_pair *p, uint64_t step, uint32_t entity, uint32_t column)
{
  return oracle_component(random_axis(oracle_seed(p), RANDOM_ROTATION_AXIS, step, entity), column);
}

static double step_before(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return axis_at(p, p->ours->place.step - 1, row, column);
}

static double step_after(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return axis_at(p, p->ours->place.step + 1, row, column);
}

static double by_rank(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *load = oracle_sibling(p, "in.load");
  uint32_t rank = 0;
  for (uint32_t k = 0; load && k < row && k < load->rows; k++)
    rank += pack_value(load, k, 0) >= 2.0;
  return axis_at(p, p->ours->place.step, rank, column);
}

/* --- rotation ---------------------------------------------------------------------------------------------------- */

/* What is wrong with a rotation: the axis turned round, the factor, the center before or after left out. */
struct rotation {
  double sense;
  bool factor, subtract, add;
};

static double rotated(const struct oracle_pair *p, uint32_t row, uint32_t column, struct rotation r)
{
  const bool solvent = strcmp(p->ours->name, "out.solvent") == 0;
  const struct pack_table *cell = oracle_sibling(p, solvent ? "in.solvent_cell" : "in.vertex_cell");
  const struct pack_table *center = oracle_sibling(p, "in.center"), *axis = oracle_sibling(p, "in.axis");
  const struct pack_table *factor = oracle_sibling(p, "in.factor"), *in = oracle_before(p);
  const struct pack_table *reals = oracle_model(p, "in.reals");
  if (!cell || !factor || !reals || !oracle_is_vectors(in, true, row))
    return NAN;
  const double number = pack_value(cell, row, 0);
  const uint32_t at = number >= 0.0 && number < factor->rows ? (uint32_t)number : factor->rows;
  if (!oracle_is_vectors(center, true, at) || !oracle_is_vectors(axis, true, at))
    return NAN;
  const struct vec3 none = {0, 0, 0}, c = oracle_vector(center, at);
  const struct cell_turn turn = {.axis = vec3_scale(r.sense, oracle_vector(axis, at)),
                                 .factor = r.factor ? pack_value(factor, at, 0) : 1.0};
  const struct vec3 w = vec3_sub(oracle_vector(in, row), r.subtract ? c : none);
  const struct vec3 v = srd_apply(&turn, w, false, pack_value(reals, 0, 1), pack_value(reals, 0, 2), true);
  return oracle_component(vec3_add(r.add ? c : none, v), column);
}

static double transposed(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return rotated(p, row, column, (struct rotation){-1.0, true, true, true});
}

static double without_factor(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return rotated(p, row, column, (struct rotation){1.0, false, true, true});
}

static double at_rest(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return rotated(p, row, column, (struct rotation){1.0, true, false, false});
}

static double not_returned(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  return rotated(p, row, column, (struct rotation){1.0, true, true, false});
}

const struct oracle_pattern oracle_patterns_solvent[] = {
    {"stream", "out.position", "positions are not wrapped into the box", .fits = not_wrapped},
    {"stream", "out.position", "half step: particles fly for half the time", .guess = half_flight},
    {"stream", "out.position", "particles fly for twice the time", .guess = double_flight},
    {"stream", "out.position", "body force without its half: a t^2 for (a/2) t^2", .guess = force_without_half},
    {"stream", "out.position", "body force left out of the flight: (a/2) t^2 is missing",
     .guess = force_without_flight},
    {"bin", NULL, "grid shift sign: the shift is subtracted from positions, not added", .guess = subtracted},
    {"bin", "out.vertex", "grid shift applied to the solvent only", .guess = unshifted},
    {"bin", NULL, "no grid shift", .guess = unshifted},
    {"bin", NULL, "cell numbers with x slowest instead of fastest", .guess = x_slowest},
    {"bin", NULL, "cells are half-open: what lies on a face belongs to the cell above it", .fits = faces_wrong},
    {"bin", NULL, "wrapped by one edge at most: unwrapped vertices may be further away", .fits = wrapped_once},
    {"sum", "out.momentum", "momentum without the mass: vertices count as solvent", .guess = massless},
    {"solve", "out.center", "center by the number of members: it is momentum by mass", .guess = by_number},
    {"solve", "out.axis", "random address: axes of the step before or after", .guess = step_before},
    {"solve", "out.axis", "random address: axes of the step before or after", .guess = step_after},
    {"solve", "out.axis", "random address: axes by the rank of the active cell, not by its number", .guess = by_rank},
    {"rotate", NULL, "rotation transposed: turned by -alpha", .guess = transposed},
    {"rotate", NULL, "the thermostat's factor is left out", .guess = without_factor},
    {"rotate", NULL, "turned in the frame at rest: the center is not subtracted and added again", .guess = at_rest},
    {"rotate", NULL, "the center is not added again after the turn", .guess = not_returned},
    {.meaning = NULL},
};
