/* What is summed over the members of a cell, and centers, made with one thing changed. */
#include <math.h>
#include <string.h>

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
  double center;       /* times, less 1 */
  double solvent;      /* its mass, 0: 1 */
  bool of_squares;     /* v.v - c.c */
  uint32_t no_first_solvent, no_last_solvent, no_first_vertices, no_last_vertices; /* so many */
  rounding *round, *before;
  const char *text;
  int without; /* 1 + component */
  bool whole_masses, vertices_twice, no_solvent, no_vertices, from_next, no_center, all_cells, by_mass, by_number;
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
  return out ? 0.0 : (!vertices && t->solvent != 0.0 ? t->solvent : 1.0) * pow(mass, 1.0 + t->power);
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
      {.solvent = 2.0, .text = "momentum with 2 for the mass of solvent: it is 1"},
      {.solvent = 0.5, .text = "momentum with 1/2 for the mass of solvent: it is 1"},
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
      guess[2 * (size_t)cell] += t->by_mass ? w : t->vertices_twice && vertices ? 2.0 : 1.0;
      guess[2 * (size_t)cell + 1] += (t->by_number ? 1.0 : w) * (t->scale != 0.0 ? t->scale : 1.0) / CELL_MASS_UNIT;
    }
  return true;
}

static bool loads(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct member_twist known[] = {
      {.by_mass = true, .text = "members by their mass: each counts as one"},
      {.by_number = true, .text = "mass by number: vertices count as solvent"},
      {.vertices_twice = true, .text = "members: vertices count twice"},
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

enum divisor {
  BY_MASS,
  BY_NUMBER,
  BY_NOTHING,
  BY_INVERSE,
  BY_MASS_UNITS,
  BY_OTHERS,
  BY_ONE_MORE,
  BY_WHOLE_MASS,
  BY_MASS_SQUARED,
  BY_ROOT,
  BY_MASS_AND_ONE,
  BY_MASS_LESS_ONE,
  BY_MASS_AND_NUMBER,
  BY_MEAN_MASS,
  BY_MASS_TWICE
};

struct center_twist {
  enum divisor by;
  bool all_cells;
  double least;
  int momentum_of, load_of; /* cells further on */
  const char *text;
};

static uint32_t further(const struct pack_table *t, uint32_t row, int by)
{
  return (row + t->rows + (uint32_t)by) % t->rows;
}

static double center_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct center_twist *t = twist;
  const struct pack_table *p = oracle_sibling(&part->pair, "in.momentum"),
                          *load = oracle_sibling(&part->pair, "in.load");
  const double n = load ? pack_value(load, row, 0) : NAN,
               mass = load ? pack_value(load, further(load, row, t->load_of), 1) * CELL_MASS_UNIT : NAN;
  if (!p || isnan(n))
    return NAN;
  if (n < (t->all_cells ? 1.0 : t->least > 0.0 ? t->least : 2.0))
    return 0.0;
  const double by = t->by == BY_MASS              ? mass
                    : t->by == BY_NUMBER          ? n
                    : t->by == BY_NOTHING         ? 1.0
                    : t->by == BY_INVERSE         ? 1.0 / mass
                    : t->by == BY_OTHERS          ? n - 1.0
                    : t->by == BY_ONE_MORE        ? n + 1.0
                    : t->by == BY_MASS_SQUARED    ? mass * mass
                    : t->by == BY_ROOT            ? sqrt(mass)
                    : t->by == BY_MASS_AND_ONE    ? mass + 1.0
                    : t->by == BY_MASS_LESS_ONE   ? mass - 1.0
                    : t->by == BY_MASS_AND_NUMBER ? mass * n
                    : t->by == BY_MEAN_MASS       ? mass / n
                    : t->by == BY_MASS_TWICE      ? 2.0 * mass
                    : t->by == BY_WHOLE_MASS      ? floor(mass)
                                                  : mass / CELL_MASS_UNIT;
  return pack_value(p, further(p, row, t->momentum_of), column) / CELL_MOMENTUM_SCALE / by;
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
      {.by = BY_ONE_MORE, .text = "center by the number of members and 1"},
      {.by = BY_MASS_SQUARED, .text = "center by the mass squared: divided twice"},
      {.by = BY_ROOT, .text = "center by the root of the mass"},
      {.by = BY_MASS_AND_ONE, .text = "center by the mass and 1"},
      {.by = BY_MASS_LESS_ONE, .text = "center by the mass less 1"},
      {.by = BY_MASS_AND_NUMBER, .text = "center by the mass times the number of members"},
      {.by = BY_MEAN_MASS, .text = "center by the mean mass of members"},
      {.by = BY_MASS_TWICE, .text = "center by twice the mass"},
      {.momentum_of = 1, .text = "center with the momentum of the next cell"},
      {.momentum_of = -1, .text = "center with the momentum of the cell before"},
      {.load_of = 1, .text = "center with the mass of the next cell"},
      {.load_of = -1, .text = "center with the mass of the cell before"},
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

/* --- relative energies --- */

static double center_squared(const struct members *m, uint32_t cell)
{
  const double x = pack_value(m->center, cell, 0), y = pack_value(m->center, cell, 1),
               z = pack_value(m->center, cell, 2);
  return x * x + y * y + z * z;
}

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
        w[c] = pack_value(m.velocity[vertices], k, c) -
               (t->no_center || t->of_squares ? 0.0 : (1.0 + t->center) * pack_value(m.center, cell, c));
      if (cell >= m.cells || (!t->all_cells && pack_value(m.load, cell, 0) < 2.0))
        continue;
      const double one = 0x1p32 * (t->scale != 0.0 ? t->scale : 1.0) * weight(&m, t, vertices, k) *
                         ((t->without != 1) * w[0] * w[0] + (t->without != 2) * w[1] * w[1] +
                          (t->without != 3) * w[2] * w[2] - (t->of_squares ? center_squared(&m, cell) : 0.0));
      guess[cell] += t->round ? t->round(one) : rint(one);
    }
  return true;
}

static bool relatives(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct member_twist known[] = {
      {.no_center = true, .text = "energies in the frame at rest: the center is not subtracted"},
      {.no_center = true, .all_cells = true, .text = "energies in the frame at rest: the center is not subtracted"},
      {.center = 1.0, .text = "energies with twice the center subtracted"},
      {.center = -2.0, .text = "sign: energies with the center added, not subtracted"},
      {.center = -0.5, .text = "energies with half the center subtracted"},
      {.of_squares = true, .text = "relative energies from the totals: v.v - c.c for (v - c).(v - c)"},
      {.power = -1.0, .text = "relative energies without the mass"},
      {.power = -0.5, .text = "relative energies with the root of the mass"},
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

const struct relation oracle_relations_sum[] = {
    {"sum", "out.momentum", momenta, false},
    {"sum", "out.momentum", member_missing, false},
    {"sum", "out.load", loads, false},
    {"solve", "out.active", actives, false},
    {"solve", "out.center", centers, false},
    {"mean", "out.active", actives, false},
    {"mean", "out.center", centers, false},
    {"rescale", "out.relative", relatives, false},
    {"maxwell_boltzmann", "out.relative", relatives, false},
    {.make = NULL},
};
