/* The collision by the rule at+a, made with one thing changed: moments of a cell, the rate at which it turns, and the
 * velocities that its members get. */
#include <math.h>
#include <string.h>

#include "mpc/rules/spin.h"
#include "oracle/patterns.h"
#include "oracle/relations.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

static struct vec3 row_of(const struct pack_table *t, uint32_t row)
{
  return (struct vec3){pack_value(t, row, 0), pack_value(t, row, 1), pack_value(t, row, 2)};
}

/* --- moments ------------------------------------------------------------------------------------------------------ */

struct moment_twist {
  bool no_products, about_middle, light;
  const char *text;
};

static const int first_of[6] = {0, 1, 2, 1, 2, 0}, second_of[6] = {0, 1, 2, 2, 0, 1};

/* Sum of m y y of a cell about its centre of mass, all masses 1. */
static double light_moment(const struct oracle_pair *p, uint32_t cell, int a, int b)
{
  static const char *const cells[2] = {"in.solvent_cell", "in.vertex_cell"}, *const places[2] = {"in.solvent_place",
                                                                                                 "in.vertex_place"};
  double n = 0.0, y_a = 0.0, y_b = 0.0, both = 0.0;
  for (int kind = 0; kind < 2; kind++) {
    const struct pack_table *in = oracle_sibling(p, cells[kind]), *at = oracle_sibling(p, places[kind]);
    for (uint32_t k = 0; in && at && k < in->rows && k < at->rows; k++) {
      if (pack_value(in, k, 0) != cell)
        continue;
      const double ya = LATTICE_UNIT * pack_value(at, k, (uint32_t)a),
                   yb = LATTICE_UNIT * pack_value(at, k, (uint32_t)b);
      n++, y_a += ya, y_b += yb, both += ya * yb;
    }
  }
  return both - y_a * y_b / fmax(n, 1.0);
}

static double moment_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct moment_twist *t = twist;
  const struct oracle_pair *p = &part->pair;
  const struct pack_table *load = oracle_sibling(p, "in.load"), *middle = oracle_sibling(p, "out.middle"),
                          *beyond = oracle_sibling(p, "out.beyond");
  if (!load || !middle || !beyond || column > 5 || row >= load->rows || row >= middle->rows || row >= beyond->rows)
    return NAN;
  const int a = first_of[column], b = second_of[column];
  const double ours = pack_value(p->ours, row, column), mass = pack_value(load, row, 1) / CELL_MASS_SCALE;
  if (pack_value(load, row, 0) < 2.0)
    return ours;
  if (t->light)
    return light_moment(p, row, a, b);
  const double x_a = LATTICE_UNIT * pack_value(middle, row, (uint32_t)a) + pack_value(beyond, row, (uint32_t)a);
  const double x_b = LATTICE_UNIT * pack_value(middle, row, (uint32_t)b) + pack_value(beyond, row, (uint32_t)b);
  return t->no_products && column > 2 ? 0.0 : ours + (t->about_middle ? mass * x_a * x_b : 0.0);
}

static bool moments(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct moment_twist known[] = {
      {.no_products = true, .text = "the products yz, zx and xy are left out"},
      {.about_middle = true, .text = "moments about the middle of the cell: they are about the centre of mass"},
      {.light = true, .text = "moments without the mass of vertices"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, moment_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- the rate ----------------------------------------------------------------------------------------------------- */

struct rate_twist {
  bool of_moments, no_products, over_trace, line_still;
  double sense, least; /* least: share of the trace below which an eigenvalue is taken as 0 */
  const char *text;
};

/* All members on a line along the largest column of C. */
static struct vec3 rate_of_line(const double c[6], struct vec3 l)
{
  const struct vec3 column[3] = {{c[0], c[5], c[4]}, {c[5], c[1], c[3]}, {c[4], c[3], c[2]}};
  int k = 0;
  for (int j = 1; j < 3; j++)
    k = c[j] > c[k] ? j : k;
  const struct vec3 e = vec3_scale(1.0 / vec3_norm(column[k]), column[k]);
  return vec3_scale(1.0 / (c[0] + c[1] + c[2]), vec3_add_scaled(l, -vec3_dot(e, l), e));
}

/* As spin_rate, with one thing changed. */
static struct vec3 changed_rate(const double c[6], struct vec3 l, const struct rate_twist *t)
{
  const double trace = c[0] + c[1] + c[2], xx = t->of_moments ? c[0] : c[1] + c[2],
               yy = t->of_moments ? c[1] : c[2] + c[0], zz = t->of_moments ? c[2] : c[0] + c[1];
  const double yz = -c[3], zx = -c[4], xy = -c[5];
  const double minor_x = yy * zz - yz * yz, minor_y = zz * xx - zx * zx, minor_z = xx * yy - xy * xy;
  const double determinant = xx * minor_x + xy * (yz * zx - xy * zz) + zx * (xy * yz - yy * zx);
  if (!(determinant > t->least * 2.0 * trace * (minor_x + minor_y + minor_z)))
    return t->line_still ? (struct vec3){0, 0, 0} : rate_of_line(c, l);
  const double t21 = xy / xx, t31 = zx / xx, d2 = yy - t21 * xy, below = yz - t21 * zx, t32 = below / d2;
  const double d3 = zz - t31 * zx - t32 * below;
  const double b2 = l.y - t21 * l.x, b3 = l.z - t31 * l.x - t32 * b2;
  const double z = b3 / d3, y = b2 / d2 - t32 * z;
  return (struct vec3){l.x / xx - t21 * y - t31 * z, y, z};
}

static double rate_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct rate_twist *t = twist;
  const struct oracle_pair *p = &part->pair;
  const struct pack_table *second = oracle_sibling(p, "in.second"), *angular = oracle_sibling(p, "in.angular");
  if (!second || !angular || row >= second->rows || row >= angular->rows || second->columns < 6)
    return NAN;
  double c[6];
  for (uint32_t k = 0; k < 6; k++)
    c[k] = k > 2 && t->no_products ? 0.0 : pack_value(second, row, k);
  const double trace = c[0] + c[1] + c[2];
  const struct vec3 l = row_of(angular, row);
  if (!(trace > 0.0))
    return 0.0;
  return t->sense * oracle_component(t->over_trace ? vec3_scale(1.0 / trace, l) : changed_rate(c, l, t), column);
}

static bool rates(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct rate_twist known[] = {
      {.sense = 1, .least = 1e-12, .of_moments = true, .text = "the moments C in place of the inertia tensor tr C - C"},
      {.sense = 1, .least = 1e-12, .no_products = true, .text = "the products of inertia are left out"},
      {.sense = 1, .over_trace = true, .text = "angular momentum over the trace: it is over the tensor"},
      {.sense = 1, .least = 1e-12, .line_still = true, .text = "cells whose members are on a line do not turn"},
      {.sense = 1, .text = "cells whose members are on a line are solved as others"},
      {.sense = -1, .least = 1e-12, .text = "sign: turned the other way"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, rate_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- velocities that members are given ---------------------------------------------------------------------------- */

struct turn_twist {
  double sense, drawn;
  bool of_cell;
  const char *text;
};

static double turn_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct turn_twist *t = twist;
  const struct oracle_pair *p = &part->pair;
  const bool vertex = strcmp(p->ours->name, "out.vertex") == 0;
  const struct pack_table *cells = oracle_sibling(p, vertex ? "in.vertex_cell" : "in.solvent_cell"),
                          *place = oracle_sibling(p, vertex ? "in.vertex_place" : "in.solvent_place"),
                          *drawn = oracle_sibling(p, vertex ? "in.vertex_drawn" : "in.solvent_drawn"),
                          *active = oracle_sibling(p, "in.active"), *center = oracle_sibling(p, "in.center"),
                          *omega = oracle_sibling(p, "in.omega"), *middle = oracle_sibling(p, "in.middle"),
                          *before = oracle_before(p);
  const double number = cells && row < cells->rows ? pack_value(cells, row, 0) : -1.0;
  if (!place || !drawn || !active || !center || !omega || !middle || !before || !(number >= 0.0) ||
      number >= active->rows || number >= center->rows || number >= omega->rows || number >= middle->rows)
    return NAN;
  const uint32_t cell = (uint32_t)number;
  if (pack_value(active, cell, 0) == 0.0)
    return pack_value(before, row, column);
  const struct vec3 from = t->of_cell ? (struct vec3){0, 0, 0} : row_of(middle, cell);
  const struct vec3 r = vec3_scale(LATTICE_UNIT, vec3_sub(row_of(place, row), from));
  const struct vec3 turned = vec3_add_scaled(row_of(center, cell), t->sense, vec3_cross(row_of(omega, cell), r));
  return oracle_component(vec3_add_scaled(turned, t->drawn, row_of(drawn, row)), column);
}

static bool turns(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct turn_twist known[] = {
      {.sense = 1,
       .drawn = 1,
       .of_cell = true,
       .text = "turned about the middle of the cell: it is about the centre of mass"},
      {.sense = -1, .drawn = 1, .text = "sign: turned the other way"},
      {.sense = 0, .drawn = 1, .text = "members do not turn: angular momentum is lost"},
      {.sense = 1, .drawn = -1, .text = "sign: the drawn velocity is subtracted"},
      {.sense = 1, .drawn = 0, .text = "the drawn velocity is left out"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, turn_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

const struct relation oracle_relations_spin[] = {
    {"moments", "out.second", moments, false},
    {"spin", "out.omega", rates, false},
    {"give_spin", NULL, turns, false},
    {.make = NULL},
};
