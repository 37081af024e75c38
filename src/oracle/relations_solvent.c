/* Streaming and the collision, made with one thing changed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "base/normal.h"
#include "base/random.h"
#include "mpc/cell.h"
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
  bool one_step;
  rounding *round;  /* NULL: to the nearest */
  rounding *before; /* of the flight in a0 */
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
               a = pack_value(reals, 0, 3 + column);
  double flight = (1.0 + t->velocity) * pack_value(v, from, column) * time + ((0.5 + t->body) * a * time) * time;
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

/* --- cells -------------------------------------------------------------------------------------------------------- */

struct bin_twist {
  double shift[3]; /* times, less 1 */
  bool wrapped_first, clamped, nearest, toward_zero, upper_face, single, half, single_sum;
  int wrapped_by; /* 1 + axis whose edge all are wrapped by */
  const char *text;
};

/* Along one axis. */
static double bin_coordinate(const struct bin_twist *t, double at, double shift, const struct box *box, uint32_t axis)
{
  const double edge = (double)box->edge[t->wrapped_by ? t->wrapped_by - 1 : (int)axis];
  const double moved = (1.0 + t->shift[axis]) * shift;
  double x = at + moved;
  if (t->wrapped_first)
    return floor((at - edge * floor(at / edge) + moved) * LATTICE_UNIT);
  if (t->clamped)
    return fmin(fmax(floor(x * LATTICE_UNIT), 0.0), box->cells[axis] - 1.0);
  if (t->toward_zero) {
    const double cells = box->cells[axis], c = fmod(trunc(x * LATTICE_UNIT), cells);
    return c < 0.0 ? c + cells : c;
  }
  if (t->single_sum)
    x = single_of(single_of(at * LATTICE_UNIT) + single_of(moved * LATTICE_UNIT)) * LATTICE_PER_A0;
  x -= edge * floor(x / edge);
  if (t->upper_face)
    return ceil(x * LATTICE_UNIT) - 1.0;
  if (t->nearest)
    return fmod(rint(x * LATTICE_UNIT), box->cells[axis]);
  if (t->single)
    return fmod(floor(single_of(x * LATTICE_UNIT)), box->cells[axis]);
  return floor(x * LATTICE_UNIT);
}

static bool bin_point(const struct evidence_part *part, uint32_t row, const struct bin_twist *t, struct box *box,
                      double c[3])
{
  const struct pack_table *r = oracle_input(&part->pair), *shift = oracle_sibling(&part->pair, "in.shift");
  if (!oracle_box(&part->pair, box) || !oracle_is_vectors(r, false, row) || !oracle_is_vectors(shift, false, 0))
    return false;
  for (uint32_t k = 0; k < 3; k++)
    c[k] = bin_coordinate(t, pack_value(r, row, k), pack_value(shift, 0, k), box, k);
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

/* --- members of cells --------------------------------------------------------------------------------------------- */

/* All members of a pack's cells: solvent, then vertices. */
struct members {
  const struct pack_table *cell[2], *velocity[2], *vertex, *load, *center;
  uint32_t n[2], cells;
};

static bool take_members(const struct evidence_part *part, struct members *m)
{
  struct box box;
  *m = (struct members){
      .cell = {oracle_sibling(&part->pair, "in.solvent_cell"), oracle_sibling(&part->pair, "in.vertex_cell")},
      .velocity = {oracle_sibling(&part->pair, "in.solvent"), oracle_sibling(&part->pair, "in.vertex")},
      .vertex = oracle_model(&part->pair, "in.vertex"),
      .load = oracle_sibling(&part->pair, "in.load"),
      .center = oracle_sibling(&part->pair, "in.center")};
  for (int k = 0; k < 2; k++) {
    if (!m->cell[k] || !m->velocity[k] || m->velocity[k]->rows != m->cell[k]->rows)
      return false;
    m->n[k] = m->cell[k]->rows;
  }
  if (!oracle_box(&part->pair, &box) || (m->n[1] > 0 && (!m->vertex || m->vertex->rows < m->n[1])))
    return false;
  m->cells = (uint32_t)box_cell_count(&box);
  return m->cells == part->rows;
}

static double mass_of(const struct members *m, int vertices, uint32_t k)
{
  return vertices ? pack_value(m->vertex, k, 0) : 1.0;
}

/* The member's cell; UINT32_MAX if it is none. */
static uint32_t cell_of(const struct members *m, int vertices, uint32_t k)
{
  const double cell = pack_value(m->cell[vertices], k, 0);
  return cell >= 0.0 && cell < m->cells ? (uint32_t)cell : UINT32_MAX;
}

struct member_twist {
  double power, scale; /* power of the mass, more than 1; scale, 0: 1 */
  uint32_t no_first_solvent, no_last_solvent, no_first_vertices, no_last_vertices; /* so many */
  rounding *round, *before;
  const char *text;
  int without; /* 1 + component */
  bool whole_masses, no_solvent, no_vertices, from_next, no_center, all_cells, by_mass, by_number;
  bool last_only, first_only; /* of a cell */
  bool once;                  /* rounded once, the sum */
};

static double weight(const struct members *m, const struct member_twist *t, int vertices, uint32_t k)
{
  double mass = mass_of(m, vertices, t->from_next && vertices ? (k + 1) % m->n[1] : k);
  mass = t->whole_masses ? floor(mass) : mass;
  const bool out = (t->no_solvent && !vertices) || (t->no_vertices && vertices) ||
                   (!vertices && (k < t->no_first_solvent || k + t->no_last_solvent >= m->n[0])) ||
                   (vertices && (k < t->no_first_vertices || k + t->no_last_vertices >= m->n[1]));
  return out ? 0.0 : pow(mass, 1.0 + t->power);
}

/* Number k of members left out at either end of a list: 0 .. 4 MOST_LEFT_OUT - 1. */
#define MOST_LEFT_OUT 64
static bool left_out(uint32_t k, struct member_twist *t, const char *where, char text[RELATION_TEXT])
{
  static const char *const which[] = {"first", "last"}, *const what[] = {"particles", "vertices"};
  const uint32_t count = k / 4 + 1;
  uint32_t *const field[4] = {&t->no_first_solvent, &t->no_last_solvent, &t->no_first_vertices, &t->no_last_vertices};
  if (count > MOST_LEFT_OUT)
    return false;
  *t = (struct member_twist){.text = NULL};
  *field[k % 4] = count;
  if (count == 1)
    return relation_say(text, "the %s of the %s is missing in the %s%s", which[k % 2], what[k % 4 / 2], where,
                        k % 4 == 0   ? " (particle 0)"
                        : k % 4 == 2 ? " (vertex 0)"
                                     : "");
  return relation_say(text, "the %s %u %s are missing in the %s", which[k % 2], count, what[k % 4 / 2], where);
}

static bool make_momentum(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct member_twist *t = twist;
  struct members m;
  if (!take_members(part, &m) || part->pair.ours->columns != 3)
    return false;
  memset(guess, 0, 3 * sizeof *guess * m.cells);
  for (int vertices = 0; vertices < 2; vertices++)
    for (uint32_t k = 0; k < m.n[vertices]; k++)
      for (uint32_t c = 0; c < 3 && cell_of(&m, vertices, k) < m.cells; c++) {
        const double v = pack_value(m.velocity[vertices], k, c), w = weight(&m, t, vertices, k);
        const double one = CELL_MOMENTUM_SCALE * w * (t->before ? t->before(v) : v);
        double *const sum = &guess[3 * (size_t)cell_of(&m, vertices, k) + c];
        if (!t->first_only || *sum == 0.0)
          *sum = (t->last_only ? 0.0 : *sum) + (t->once ? one : t->round ? t->round(one) : rint(one));
      }
  for (size_t k = 0; t->once && k < 3 * (size_t)m.cells; k++)
    guess[k] = t->round ? t->round(guess[k]) : rint(guess[k]);
  return true;
}

static bool momenta(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct member_twist known[] = {
      {.power = -1.0, .text = "momentum without the mass: vertices count as solvent"},
      {.power = 1.0, .text = "momentum with the mass squared"},
      {.power = -2.0, .text = "momentum with the mass inverted: v/M for M v"},
      {.power = -0.5, .text = "momentum with the root of the mass"},
      {.whole_masses = true, .text = "momentum with masses cut to integers"},
      {.from_next = true, .text = "momentum with the mass of the next vertex"},
      {.last_only = true, .text = "momentum of the last member of each cell only: it is their sum"},
      {.first_only = true, .text = "momentum of the first member of each cell only: it is their sum"},
      {.no_vertices = true, .text = "vertices left out of the momentum"},
      {.no_solvent = true, .text = "solvent left out of the momentum"},
      {.round = trunc, .text = "momentum of each member cut toward zero, not rounded to the nearest unit"},
      {.round = floor, .text = "momentum of each member rounded down, not to the nearest unit"},
      {.round = ceil, .text = "momentum of each member rounded up, not to the nearest unit"},
      {.once = true, .text = "momentum rounded once, the sum, not each member's"},
      {.once = true,
       .round = trunc,
       .text = "momentum cut toward zero once, the sum; it is each member's that is rounded"},
      {.before = single_precision, .text = "single precision: momentum of velocities of 24 bits"},
  };
  struct member_twist other;
  if (k >= COUNT_OF(known) && !left_out(k - COUNT_OF(known), &other, "momentum", text))
    return false;
  if (k >= COUNT_OF(known)) {
    relation_fill_tables(e, make_momentum, &other);
    return true;
  }
  relation_fill_tables(e, make_momentum, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

static bool make_load(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct member_twist *t = twist;
  struct members m;
  if (!take_members(part, &m) || part->pair.ours->columns != 2)
    return false;
  memset(guess, 0, 2 * sizeof *guess * m.cells);
  for (int vertices = 0; vertices < 2; vertices++)
    for (uint32_t k = 0; k < m.n[vertices]; k++) {
      const uint32_t cell = cell_of(&m, vertices, k);
      const double w = weight(&m, t, vertices, k);
      if (cell >= m.cells || w == 0.0)
        continue;
      guess[2 * (size_t)cell] += t->by_mass ? w : 1.0;
      guess[2 * (size_t)cell + 1] += (t->by_number ? 1.0 : w) * (t->scale != 0.0 ? t->scale : 1.0) / CELL_MASS_UNIT;
    }
  return true;
}

static bool loads(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct member_twist known[] = {
      {.by_mass = true, .text = "members by their mass: each counts as one"},
      {.by_number = true, .text = "mass by number: vertices count as solvent"},
      {.power = 1.0, .text = "mass squared in the load"},
      {.whole_masses = true, .text = "masses cut to integers in the load: they are multiples of 2^-16"},
      {.scale = 0.5, .text = "a constant factor of 0.5 in the mass: its unit is 2^-16"},
      {.scale = 2.0, .text = "a constant factor of 2 in the mass: its unit is 2^-16"},
      {.scale = 0x1p-16, .text = "the mass in m: its unit is 2^-16"},
      {.from_next = true, .text = "load with the mass of the next vertex"},
      {.no_vertices = true, .text = "vertices left out of the load"},
      {.no_solvent = true, .text = "solvent left out of the load"},
  };
  struct member_twist other;
  if (k >= COUNT_OF(known) && !left_out(k - COUNT_OF(known), &other, "load", text))
    return false;
  if (k >= COUNT_OF(known)) {
    relation_fill_tables(e, make_load, &other);
    return true;
  }
  relation_fill_tables(e, make_load, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- which member is missing -------------------------------------------------------------------------------------- */

/* The member whose part of the momentum this difference is; false if none. */
static bool find_member(const struct members *m, uint32_t cell, const double off[3], int *vertices, uint32_t *which)
{
  for (*vertices = 0; *vertices < 2; ++*vertices)
    for (*which = 0; *which < m->n[*vertices]; ++*which) {
      bool same = cell_of(m, *vertices, *which) == cell;
      double size = 0.0;
      for (uint32_t c = 0; same && c < 3; c++) {
        const double part =
            rint(CELL_MOMENTUM_SCALE * mass_of(m, *vertices, *which) * pack_value(m->velocity[*vertices], *which, c));
        same = fabs(off[c] - part) <= 2.0;
        size += fabs(part);
      }
      if (same && size > 64.0)
        return true;
    }
  return false;
}

/* Differences are one member each: missing (k = 0), or counted twice (1). */
static bool member_missing(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  uint32_t found = 0;
  if (k > 1 || e->columns != 3)
    return false;
  memcpy(e->guess, e->ours, (size_t)e->rows * e->columns * sizeof *e->guess);
  relation_say(text, k == 0 ? "missing in the sums:" : "counted twice in the sums:");
  for (uint32_t j = 0; j < e->parts; j++) {
    struct members m;
    if (!take_members(&e->part[j], &m))
      return false;
    for (uint32_t row = 0; row < e->part[j].rows; row++) {
      const size_t at = 3 * (size_t)(e->part[j].first + row);
      const double sign = k == 0 ? 1.0 : -1.0;
      const double off[3] = {sign * (e->ours[at] - e->theirs[at]), sign * (e->ours[at + 1] - e->theirs[at + 1]),
                             sign * (e->ours[at + 2] - e->theirs[at + 2])};
      int vertices;
      uint32_t which;
      if ((off[0] == 0.0 && off[1] == 0.0 && off[2] == 0.0) || !find_member(&m, row, off, &vertices, &which))
        continue;
      memcpy(&e->guess[at], &e->theirs[at], 3 * sizeof *e->guess);
      if (found++ < 4)
        snprintf(text + strlen(text), RELATION_TEXT - strlen(text), "%s %s %u", found > 1 ? "," : "",
                 vertices ? "vertex" : "particle", which);
    }
  }
  if (found > 4)
    snprintf(text + strlen(text), RELATION_TEXT - strlen(text), ", ...: %u members, one of a cell", found);
  for (size_t k2 = 0; found == 0 && k2 < (size_t)e->rows * e->columns; k2++)
    e->guess[k2] = NAN;
  return true;
}

/* --- centers ------------------------------------------------------------------------------------------------------ */

enum divisor { BY_MASS, BY_NUMBER, BY_NOTHING, BY_INVERSE, BY_MASS_UNITS, BY_OTHERS, BY_WHOLE_MASS };

struct center_twist {
  enum divisor by;
  bool all_cells;
  double least;
  const char *text;
};

static double center_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct center_twist *t = twist;
  const struct pack_table *p = oracle_sibling(&part->pair, "in.momentum"),
                          *load = oracle_sibling(&part->pair, "in.load");
  const double n = load ? pack_value(load, row, 0) : NAN, mass = load ? pack_value(load, row, 1) * CELL_MASS_UNIT : NAN;
  if (!p || isnan(n))
    return NAN;
  if (n < (t->all_cells ? 1.0 : t->least > 0.0 ? t->least : 2.0))
    return 0.0;
  const double by = t->by == BY_MASS         ? mass
                    : t->by == BY_NUMBER     ? n
                    : t->by == BY_NOTHING    ? 1.0
                    : t->by == BY_INVERSE    ? 1.0 / mass
                    : t->by == BY_OTHERS     ? n - 1.0
                    : t->by == BY_WHOLE_MASS ? floor(mass)
                                             : mass / CELL_MASS_UNIT;
  return pack_value(p, row, column) / CELL_MOMENTUM_SCALE / by;
}

static bool centers(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct center_twist known[] = {
      {.by = BY_NUMBER, .text = "center by the number of members: it is momentum by mass"},
      {.by = BY_NOTHING, .text = "center not divided by the mass: it is momentum by mass"},
      {.by = BY_INVERSE, .text = "center times the mass, wrong by its square (squared): it is momentum by mass"},
      {.by = BY_MASS_UNITS, .text = "center by the mass in units of 2^-16"},
      {.by = BY_WHOLE_MASS, .text = "center by the mass cut to an integer"},
      {.by = BY_OTHERS, .text = "center by the number of members less 1"},
      {.all_cells = true, .text = "centers of cells of one member, too: they are not active"},
      {.least = 3.0, .text = "cells of two members are not active: from 2 members on they are"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, center_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

static double active_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct pack_table *load = oracle_sibling(&part->pair, "in.load");
  (void)column;
  return load ? pack_value(load, row, 0) >= *(const double *)twist : NAN;
}

static bool actives(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct {
    double least;
    const char *text;
  } known[] = {{1.0, "cells of one member are active: from 2 members on they are"},
               {0.0, "all cells are active: from 2 members on they are"},
               {3.0, "cells of two members are not active: from 2 members on they are"},
               {4.0, "cells of three members are not active: from 2 members on they are"}};
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, active_value, &known[k].least);
  return relation_say(text, "%s", known[k].text);
}

/* --- thermostats -------------------------------------------------------------------------------------------------- */

static bool make_relative(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct member_twist *t = twist;
  struct members m;
  if (!take_members(part, &m) || !m.load || !m.center)
    return false;
  memset(guess, 0, sizeof *guess * m.cells);
  for (int vertices = 0; vertices < 2; vertices++)
    for (uint32_t k = 0; k < m.n[vertices]; k++) {
      const uint32_t cell = cell_of(&m, vertices, k);
      double w[3];
      for (uint32_t c = 0; c < 3 && cell < m.cells; c++)
        w[c] = pack_value(m.velocity[vertices], k, c) - (t->no_center ? 0.0 : pack_value(m.center, cell, c));
      if (cell >= m.cells || (!t->all_cells && pack_value(m.load, cell, 0) < 2.0))
        continue;
      const double one =
          0x1p32 * (t->scale != 0.0 ? t->scale : 1.0) * weight(&m, t, vertices, k) *
          ((t->without != 1) * w[0] * w[0] + (t->without != 2) * w[1] * w[1] + (t->without != 3) * w[2] * w[2]);
      guess[cell] += t->round ? t->round(one) : rint(one);
    }
  return true;
}

static bool relatives(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct member_twist known[] = {
      {.no_center = true, .text = "energies in the frame at rest: the center is not subtracted"},
      {.no_center = true, .all_cells = true, .text = "energies in the frame at rest: the center is not subtracted"},
      {.power = -1.0, .text = "relative energies without the mass"},
      {.power = 1.0, .text = "relative energies with the mass squared"},
      {.power = -2.0, .text = "relative energies with the mass inverted"},
      {.scale = 0.5, .text = "a constant factor of 0.5: relative is twice the energy"},
      {.scale = 2.0, .text = "a constant factor of 2: relative is M (w.w), twice the energy"},
      {.all_cells = true, .text = "cells of one member have relative 0, and factor 1"},
      {.round = trunc, .text = "relative energies cut toward zero, not rounded to the nearest unit"},
      {.round = ceil, .text = "relative energies rounded up, not to the nearest unit"},
      {.without = 1, .text = "x left out of the relative energies"},
      {.without = 2, .text = "y left out of the relative energies"},
      {.without = 3, .text = "z left out of the relative energies"},
      {.no_vertices = true, .text = "vertices left out of the relative energies"},
      {.no_solvent = true, .text = "solvent left out of the relative energies"},
      {.from_next = true, .text = "relative energies with the mass of the next vertex"},
  };
  struct member_twist other;
  if (k >= COUNT_OF(known) && !left_out(k - COUNT_OF(known), &other, "relative energies", text))
    return false;
  if (k >= COUNT_OF(known)) {
    relation_fill_tables(e, make_relative, &other);
    return true;
  }
  relation_fill_tables(e, make_relative, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

struct rescale_twist {
  double per_member, per_cell; /* degrees of freedom, more than 3 and -3 */
  bool inverted, no_root, all_factors, all_cells, per_cell_factor, double_energy;
  const char *text;
};

static bool make_rescale(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct rescale_twist *t = twist;
  const struct pack_table *load = oracle_sibling(&part->pair, "in.load"),
                          *energy = oracle_sibling(&part->pair, "out.relative");
  double wanted = 0.0, present = 0.0;
  if (!load || !energy || load->rows != part->rows || energy->rows != part->rows || part->pair.ours->columns != 1)
    return false;
  for (int pass = 0; pass < 2; pass++)
    for (uint32_t cell = 0; cell < part->rows; cell++) {
      const double n = pack_value(load, cell, 0),
                   has = pack_value(energy, cell, 0) * 0x1p-32 * (t->double_energy ? 0.5 : 1.0);
      const bool active = n >= 2.0;
      const double degrees = (3.0 + t->per_member) * n + (-3.0 + t->per_cell);
      if (pass == 0 && (active || (t->all_cells && n > 0.0)))
        wanted += degrees, present += has;
      const double ratio = t->per_cell_factor ? degrees / has : wanted / present;
      const double right = t->inverted ? 1.0 / ratio : ratio;
      guess[cell] = active || t->all_factors ? (t->no_root ? right : sqrt(right)) : 1.0;
    }
  return true;
}

static bool rescales(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct rescale_twist known[] = {
      {.per_cell = 3.0, .text = "3 N degrees of freedom for 3 (N - 1)"},
      {.per_cell = 3.0, .all_cells = true, .text = "3 N degrees of freedom of all cells for 3 (N - 1) of active ones"},
      {.per_cell = 2.0, .text = "3 N - 1 degrees of freedom for 3 (N - 1)"},
      {.per_member = -2.0, .per_cell = 2.0, .text = "N - 1 degrees of freedom for 3 (N - 1)"},
      {.per_member = -1.0, .per_cell = 1.0, .text = "2 (N - 1) degrees of freedom for 3 (N - 1)"},
      {.per_member = -2.0, .per_cell = 3.0, .text = "N degrees of freedom for 3 (N - 1)"},
      {.per_cell = -3.0, .text = "3 (N - 2) degrees of freedom for 3 (N - 1)"},
      {.inverted = true, .text = "the factor inverted: root of present over wanted"},
      {.no_root = true, .text = "the factor without its root"},
      {.inverted = true, .no_root = true, .text = "the factor inverted and without its root"},
      {.all_factors = true, .text = "the factor in cells that are not active, too: it is 1 there"},
      {.per_cell_factor = true, .text = "a factor of each cell: rescale has one for all"},
      {.per_member = -1.5, .per_cell = 1.5, .text = "a constant factor of 0.707107: relative is twice the energy"},
      {.double_energy = true, .text = "a constant factor of 1.41421: relative is twice the energy"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill_tables(e, make_rescale, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

struct gamma_twist {
  double shape; /* more than 1.5 (N - 1), in units of 1.5; per_degree: half of it */
  double third; /* d = a - 1/3 + this */
  double scale; /* of the energy, 0: 1 */
  int later, entity, purpose, draw;
  int stride; /* draws per attempt, 0: 2 */
  bool second, untested, other_uniform, inverted, no_root, without_d, rank, test_turned, one_member_less, squared;
  const char *text;
};

static double gamma_deviate(const struct gamma_twist *t, uint64_t seed, uint64_t step, uint32_t cell, double shape)
{
  const double d = shape - 1.0 / 3.0 + t->third, c = 1.0 / sqrt(9.0 * d);
  const enum random_purpose purpose = t->purpose ? (enum random_purpose)t->purpose : RANDOM_THERMOSTAT;
  for (uint32_t attempt = 0; attempt < 256; attempt++) {
    const uint32_t draw = attempt * (uint32_t)(t->stride ? t->stride : 2) + (uint32_t)t->draw;
    double pair[2];
    random_normal_pair(random_at(seed, purpose, draw, step, cell), pair);
    const double x = pair[t->second],
                 w = random_uniform(random_at(seed, purpose, draw + 1, step, cell), t->other_uniform);
    const double root = 1.0 + c * x, v = t->squared ? root * root : root * root * root;
    if (v > 0.0 &&
        (t->untested || (elementary_log(w) < 0.5 * x * x + d - d * v + d * elementary_log(v)) != t->test_turned))
      return t->without_d ? v : d * v;
  }
  return NAN;
}

static bool make_boltzmann(const struct evidence_part *part, const void *twist, double *guess)
{
  const struct gamma_twist *t = twist;
  const struct pack_table *load = oracle_sibling(&part->pair, "in.load"),
                          *energy = oracle_sibling(&part->pair, "out.relative");
  uint32_t rank = 0;
  if (!load || !energy || load->rows != part->rows || energy->rows != part->rows || part->pair.ours->columns != 1)
    return false;
  for (uint32_t cell = 0; cell < part->rows; cell++) {
    const double n = pack_value(load, cell, 0), has = 0.5 * pack_value(energy, cell, 0) * 0x1p-32;
    guess[cell] = 1.0;
    if (n < 2.0 || has == 0.0)
      continue;
    const double g =
        gamma_deviate(t, oracle_seed(&part->pair), part->pair.ours->place.step + (uint64_t)(int64_t)t->later,
                      (t->rank ? rank : cell) + (uint32_t)t->entity, 1.5 * (n - 1.0 + t->shape));
    const double ratio = g / has * (t->scale != 0.0 ? t->scale : 1.0), right = t->inverted ? 1.0 / ratio : ratio;
    guess[cell] = t->no_root ? right : sqrt(right);
    rank++;
  }
  return true;
}

static bool boltzmanns(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct gamma_twist known[] = {
      {.shape = 1.0, .text = "Gamma of 3 N degrees of freedom for 3 (N - 1)"},
      {.shape = 2.0 / 3.0, .text = "Gamma of 3 N - 1 degrees of freedom for 3 (N - 1)"},
      {.shape = -1.0 / 3.0, .text = "Gamma of 3 N - 4 degrees of freedom for 3 (N - 1)"},
      {.shape = 1.0 / 3.0, .text = "Gamma of 3 N - 2 degrees of freedom for 3 (N - 1)"},
      {.shape = -1.0, .text = "Gamma of 3 (N - 2) degrees of freedom for 3 (N - 1)"},
      {.third = 1.0 / 3.0 - 0.33, .text = "Gamma with 0.33 for 1/3"},
      {.third = 1.0 / 3.0 - 0.333, .text = "Gamma with 0.333 for 1/3"},
      {.third = 1.0 / 3.0 - 0.3333, .text = "Gamma with 0.3333 for 1/3"},
      {.second = true, .text = "Gamma of the normal pair's second: it takes the first"},
      {.other_uniform = true, .text = "Gamma with uniform 1 of the test's draw: it takes uniform 0"},
      {.untested = true, .text = "Gamma without its test: the first attempt is always taken"},
      {.test_turned = true, .text = "Gamma with its test turned round"},
      {.without_d = true, .text = "Gamma without its factor d: it is d v"},
      {.third = 1.0 / 3.0, .text = "Gamma with d = a: it is a - 1/3"},
      {.squared = true, .text = "Gamma with (1 + c x)^2 for (1 + c x)^3"},
      {.stride = 1, .text = "random address: attempts one draw apart: the normal has draw 2k, the uniform 2k + 1"},
      {.draw = 1, .text = "random address: Gamma begins with draw 1"},
      {.later = -1, .text = "random address: Gamma of the step before"},
      {.later = 1, .text = "random address: Gamma of the step after"},
      {.entity = 1, .text = "random address: Gamma of cell + 1"},
      {.rank = true, .text = "random address: Gamma by the rank of the active cell"},
      {.purpose = 2, .text = "random address: Gamma with purpose 2"},
      {.purpose = 4, .text = "random address: Gamma with purpose 4"},
      {.inverted = true, .text = "the factor inverted"},
      {.no_root = true, .text = "the factor without its root"},
      {.inverted = true, .no_root = true, .text = "the factor inverted and without its root"},
      {.scale = 0.5, .text = "a constant factor of 0.707107: relative is twice the energy"},
      {.scale = 2.0, .text = "a constant factor of 1.41421: g is not doubled"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill_tables(e, make_boltzmann, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- rotation ----------------------------------------------------------------------------------------------------- */

struct rotation_twist {
  double sense, cosine, sine, along; /* less 1; of the terms cos w, sin n x w, (1 - cos) n (n.w) */
  double power;                      /* of the factor, less 1 */
  double subtract, add;              /* times the center, less 1 */
  int axis_of, center_of, factor_of; /* cells further on */
  int flipped;                       /* 1 + component of the axis */
  const char *text;
  bool quarter, no_versine, center_scaled, inactive, axis_of_first;
};

static double of_cell(const struct pack_table *t, uint32_t cell, int further, uint32_t column)
{
  return pack_value(t, (cell + t->rows + (uint32_t)further) % t->rows, column);
}

static double rotation_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct rotation_twist *t = twist;
  char name[PACK_WORD];
  snprintf(name, sizeof name, "in.%.20s_cell", part->pair.ours->name + 4);
  const struct pack_table *cells = oracle_sibling(&part->pair, name), *in = oracle_before(&part->pair);
  const struct pack_table *active = oracle_sibling(&part->pair, "in.active"),
                          *center = oracle_sibling(&part->pair, "in.center");
  const struct pack_table *axis = oracle_sibling(&part->pair, "in.axis"),
                          *factor = oracle_sibling(&part->pair, "in.factor");
  const struct pack_table *reals = oracle_model(&part->pair, "in.reals");
  if (!cells || !in || !active || !center || !axis || !factor || !reals || in->columns != 3 || axis->rows == 0 ||
      center->rows == 0 || factor->rows == 0)
    return NAN;
  const double number = pack_value(cells, row, 0);
  if (!(number >= 0.0 && number < active->rows))
    return NAN;
  const uint32_t cell = (uint32_t)number;
  if (pack_value(active, cell, 0) == 0.0 && !t->inactive)
    return pack_value(in, row, column);
  double w[3], n[3], c[3];
  for (uint32_t k = 0; k < 3; k++) {
    c[k] = of_cell(center, cell, t->center_of, k);
    n[k] = (1.0 + t->sense) * (t->axis_of_first ? pack_value(axis, 0, k) : of_cell(axis, cell, t->axis_of, k));
    n[k] = t->flipped == (int)k + 1 ? -n[k] : n[k];
    w[k] = pack_value(in, row, k) - (1.0 + t->subtract) * c[k];
  }
  const double cosine = t->quarter ? 0.0 : pack_value(reals, 0, 1), sine = t->quarter ? 1.0 : pack_value(reals, 0, 2);
  const double dot = n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
  const uint32_t i = (column + 1) % 3, j = (column + 2) % 3;
  const double turned = (t->cosine < 0.0 ? 1.0 : cosine) * w[column] * (t->cosine > 0.0 ? 0.0 : 1.0) +
                        (1.0 + t->along) * (t->no_versine ? 1.0 : 1.0 - cosine) * dot * n[column] +
                        (1.0 + t->sine) * sine * (n[i] * w[j] - n[j] * w[i]);
  const double f = pow(of_cell(factor, cell, t->factor_of, 0), 1.0 + t->power);
  return (1.0 + t->add) * (t->center_scaled ? f : 1.0) * c[column] + f * turned;
}

static bool rotations(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct rotation_twist known[] = {
      {.sense = -2.0, .text = "rotation transposed: turned by -alpha"},
      {.inactive = true, .text = "cells that are not active are turned, too"},
      {.power = -1.0, .text = "the thermostat's factor is left out"},
      {.power = 1.0, .text = "the thermostat's factor squared"},
      {.power = -2.0, .text = "the thermostat's factor inverted"},
      {.power = -0.5, .text = "the root of the thermostat's factor"},
      {.center_scaled = true, .text = "the factor of the center too: it is of the relative velocity"},
      {.subtract = -1.0,
       .add = -1.0,
       .text = "turned in the frame at rest: the center is not subtracted and added again"},
      {.add = -1.0, .text = "the center is not added again after the turn"},
      {.subtract = -1.0, .text = "the center is not subtracted before the turn"},
      {.subtract = -2.0, .text = "sign: the center is added before the turn, not subtracted"},
      {.add = -2.0, .text = "sign: the center is subtracted after the turn, not added"},
      {.add = 1.0, .text = "the center is added twice after the turn"},
      {.quarter = true, .text = "turned by 90 degrees always"},
      {.cosine = -1.0, .text = "cosine left out: w for cos w"},
      {.cosine = 1.0, .text = "the term with the cosine left out: cos w"},
      {.no_versine = true, .text = "1 - cosine left out of the part along the axis"},
      {.along = -1.0, .text = "the part along the axis is left out"},
      {.along = -2.0, .text = "sign of the part along the axis"},
      {.sine = -1.0, .text = "the term with the sine is left out"},
      {.axis_of = 1, .text = "the axis of another cell: the next one"},
      {.axis_of = -1, .text = "the axis of another cell: the one before"},
      {.axis_of_first = true, .text = "the axis of one cell, number 0, for all"},
      {.flipped = 1, .text = "sign of the axis' x"},
      {.flipped = 2, .text = "sign of the axis' y"},
      {.flipped = 3, .text = "sign of the axis' z"},
      {.center_of = 1, .text = "the center of another cell: the next one"},
      {.center_of = -1, .text = "the center of another cell: the one before"},
      {.factor_of = 1, .text = "the factor of another cell: the next one"},
      {.factor_of = -1, .text = "the factor of another cell: the one before"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, rotation_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

const struct relation oracle_relations_solvent[] = {
    {"stream", "out.position", flights, false},
    {"bin", NULL, bins, false},
    {"bin", NULL, numbers, false},
    {"sum", "out.momentum", momenta, false},
    {"sum", "out.momentum", member_missing, false},
    {"sum", "out.load", loads, false},
    {"solve", "out.active", actives, false},
    {"solve", "out.center", centers, false},
    {"rescale", "out.relative", relatives, false},
    {"maxwell_boltzmann", "out.relative", relatives, false},
    {"rescale", "out.factor", rescales, false},
    {"maxwell_boltzmann", "out.factor", boltzmanns, false},
    {"rotate", NULL, rotations, false},
    {.make = NULL},
};
