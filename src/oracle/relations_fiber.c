/* Forces and kicks, made with one thing changed. The formulas are those of docs/porting.md, written anew so that each
 * of their parts can be changed. */
#include <math.h>
#include <string.h>

#include "oracle/patterns.h"
#include "oracle/relations.h"
#include "oracle/single.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

enum { MASS, REST, SPRING, BENDING, FORCE };

/* Constants and neighbors of all vertices of a pack. */
struct fibers {
  const struct pack_table *chain, *vertex, *position;
  struct box box;
  uint32_t n;
};

static bool take_fibers(const struct evidence_part *part, struct fibers *f)
{
  f->chain = oracle_model(&part->pair, "in.chain"), f->vertex = oracle_model(&part->pair, "in.vertex");
  f->position = oracle_sibling(&part->pair, "in.position");
  f->n = part->rows;
  return f->chain && f->vertex && f->n > 0 && f->chain->rows == f->n && f->vertex->rows == f->n &&
         f->vertex->columns == 7 && f->chain->columns == 3 && oracle_box(&part->pair, &f->box) &&
         part->pair.ours->columns == 3 && oracle_is_vectors(f->position, false, f->n - 1);
}

static double constant(const struct fibers *f, int64_t vertex, uint32_t column)
{
  return vertex >= 0 && vertex < f->n ? pack_value(f->vertex, (uint32_t)vertex, column) : NAN;
}

static int64_t neighbor(const struct fibers *f, int64_t vertex, uint32_t column)
{
  const int64_t v = vertex >= 0 && vertex < f->n ? f->chain->value.integer[3 * vertex + column] : -1;
  return v < f->n ? v : -1;
}

static int64_t next_of(const struct fibers *f, int64_t vertex)
{
  return neighbor(f, vertex, 0);
}

static int64_t prev_of(const struct fibers *f, int64_t vertex)
{
  return neighbor(f, vertex, 1);
}

static double smallest_image(double d, double edge)
{
  return d - edge * rint(d / edge);
}

static struct vec3 between(const struct fibers *f, int64_t from, int64_t to, bool image)
{
  struct vec3 d = point_difference(oracle_point(f->position, (uint32_t)to), oracle_point(f->position, (uint32_t)from));
  if (image)
    d = (struct vec3){smallest_image(d.x, f->box.cells[0]), smallest_image(d.y, f->box.cells[1]),
                      smallest_image(d.z, f->box.cells[2])};
  return d;
}

static void put(double *force, int64_t vertex, double factor, struct vec3 v)
{
  double *to = &force[3 * vertex];
  to[0] += factor * v.x, to[1] += factor * v.y, to[2] += factor * v.z;
}

/* --- bonds -------------------------------------------------------------------------------------------------------- */

/* What the tension is, for k (l - l0). */
enum stretch {
  STRETCH,
  STRETCH_BY_REST,
  STRETCH_BY_LENGTH,
  STRETCH_SIZE,
  STRETCH_SQUARED,
  STRETCH_CUBED,
  STRETCH_OF_SQUARES
};

/* Zeros: as it should be. */
struct bond_twist {
  enum stretch stretch;
  double rest;             /* times l0, less 1 */
  double action, reaction; /* times the force on j, and on the next one, less 1 */
  double spring;           /* times k, less 1 */
  const char *text;
  bool spring_of_next, rest_of_next; /* number, not of the fiber */
  bool spring_of_end, closing_turned, gaussian_of_rest;
  bool squared, undivided, pull_only, push_only, image, no_closing, always_gaussian, never_gaussian, flat;
  bool no_first, no_last, single;
};

static struct vec3 bond_pull(const struct fibers *f, const struct bond_twist *t, int64_t j, int64_t next)
{
  struct vec3 r = between(f, j, next, t->image);
  if (t->flat)
    r.z = 0.0;
  if (t->single)
    r = (struct vec3){single_of(r.x), single_of(r.y), single_of(r.z)};
  const double squared = vec3_dot(r, r), length = t->squared ? squared : sqrt(squared);
  const int64_t by_number = j + 1 < f->n ? j + 1 : 0;
  const int64_t spring_of = t->spring_of_next ? by_number : t->spring_of_end ? next : j;
  const double k = (1.0 + t->spring) * constant(f, spring_of, SPRING);
  const double l0 = constant(f, t->rest_of_next ? by_number : j, REST), rest = (1.0 + t->rest) * l0;
  const bool gaussian = constant(f, j, REST) == 0.0 && (t->gaussian_of_rest || constant(f, j, BENDING) == 0.0);
  if ((gaussian && !t->never_gaussian) || t->always_gaussian)
    return vec3_scale(k, r);
  double stretch = length - rest;
  if ((t->pull_only && stretch < 0.0) || (t->push_only && stretch > 0.0))
    stretch = 0.0;
  stretch = t->stretch == STRETCH_BY_REST      ? stretch / rest
            : t->stretch == STRETCH_BY_LENGTH  ? stretch / length
            : t->stretch == STRETCH_SIZE       ? fabs(stretch)
            : t->stretch == STRETCH_SQUARED    ? stretch * stretch
            : t->stretch == STRETCH_CUBED      ? stretch * stretch * stretch
            : t->stretch == STRETCH_OF_SQUARES ? length * length - rest * rest
                                               : stretch;
  return vec3_scale(k * stretch, vec3_scale(t->undivided ? 1.0 : 1.0 / length, r));
}

static void add_bonds(const struct fibers *f, const struct bond_twist *t, double *force)
{
  int64_t first = -1, last = -1;
  for (int64_t j = 0; j < f->n; j++)
    if (next_of(f, j) >= 0)
      first = first < 0 ? j : first, last = j;
  for (int64_t j = 0; j < f->n; j++) {
    const int64_t next = next_of(f, j);
    if (next < 0 || (t->no_closing && next < j) || (t->no_first && j == first) || (t->no_last && j == last))
      continue;
    struct vec3 pull = bond_pull(f, t, j, next);
    if (t->closing_turned && next < j)
      pull = vec3_scale(-1.0, pull);
    put(force, j, 1.0 + t->action, pull);
    put(force, next, -1.0 - t->reaction, pull);
  }
}

static bool make_bonds(const struct evidence_part *part, const void *twist, double *force)
{
  struct fibers f;
  if (!take_fibers(part, &f))
    return false;
  memset(force, 0, 3 * sizeof *force * f.n);
  add_bonds(&f, twist, force);
  return true;
}

static bool bonds(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct bond_twist known[] = {
      {.action = -2.0, .reaction = -2.0, .text = "sign: the negative of what is wanted; bonds pull when stretched"},
      {.rest = -1.0, .text = "the rest length l0 is left out: k R for k (l - l0) R/l"},
      {.stretch = STRETCH_BY_REST, .text = "the stretch relative to l0: k (l - l0)/l0 for k (l - l0)"},
      {.stretch = STRETCH_BY_LENGTH, .text = "the stretch relative to the length: k (l - l0)/l for k (l - l0)"},
      {.stretch = STRETCH_SIZE, .text = "the stretch without its sign: k |l - l0|"},
      {.stretch = STRETCH_SQUARED, .text = "the stretch squared: k (l - l0)^2"},
      {.stretch = STRETCH_CUBED, .text = "the stretch cubed: k (l - l0)^3"},
      {.stretch = STRETCH_OF_SQUARES, .text = "the stretch of squares: k (l^2 - l0^2)"},
      {.reaction = 1.0, .text = "the force on the next vertex twice"},
      {.action = 1.0, .text = "the force on the bond's first vertex twice"},
      {.reaction = -0.5, .text = "the force on the next vertex halved"},
      {.action = -0.5, .text = "the force on the bond's first vertex halved"},
      {.rest_of_next = true, .text = "the rest length of the next number's vertex"},
      {.spring_of_end = true, .text = "the spring constant of the bond's second vertex"},
      {.closing_turned = true, .text = "sign: the bond that closes a ring the other way round"},
      {.gaussian_of_rest = true, .text = "bonds of l0 = 0 and a bending constant, too, without their root"},
      {.always_gaussian = true, .text = "the rest length l0 is left out: k R for k (l - l0) R/l"},
      {.squared = true, .text = "bond lengths without their root: R.R for its root"},
      {.undivided = true, .text = "the bond vector is not divided by its length: k (l - l0) R"},
      {.pull_only = true, .text = "no force of bonds shorter than l0: springs pull, and push"},
      {.push_only = true, .text = "no force of bonds longer than l0: springs push, and pull"},
      {.image = true, .text = "bonds as minimum images: vertices are unwrapped"},
      {.no_closing = true, .text = "the bond that closes a ring is left out"},
      {.reaction = -1.0, .text = "the force on the next vertex is left out"},
      {.action = -1.0, .text = "the force on the bond's first vertex is left out"},
      {.reaction = -2.0, .text = "sign: the force on the next vertex is -F"},
      {.action = -2.0, .text = "sign: the force on the bond's first vertex is +F"},
      {.never_gaussian = true, .text = "bonds of l0 = 0 divided by their length"},
      {.flat = true, .text = "z left out of bond vectors"},
      {.spring = 1.0, .text = "a constant factor: k is twice what is wanted (energy is k/2 (l - l0)^2)"},
      {.spring = -0.5, .text = "a constant factor: k is half of what is wanted"},
      {.spring_of_next = true, .text = "the spring constant of the next number's vertex"},
      {.no_first = true, .text = "the first bond of all is left out"},
      {.no_last = true, .text = "the last bond of all is left out"},
      {.rest = 1.0, .text = "twice the rest length l0"},
      {.rest = -2.0, .text = "sign: k (l + l0) for k (l - l0)"},
      {.single = true, .text = "bond vectors in single precision"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill_tables(e, make_bonds, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- bends -------------------------------------------------------------------------------------------------------- */

struct bend_twist {
  double before, middle, after; /* times, less 1 */
  bool exchanged, undivided_before, undivided_after, squared, no_projection, cosine_turned, image;
  bool no_closing, no_ends_of_closing, no_first, no_last, before_only_projected, roots_left_out;
  int kappa_of; /* -1, 1: of the neighbor */
  bool cosine_squared, projection_squared_before, projection_squared_after, lengths_before, lengths_after;
  bool middle_of_before, middle_of_after, unprojected_before, unprojected_after, of_both;
  bool squared_before, squared_after, turned_before, turned_after;
  double kappa;
  const char *text;
};

static void add_bend(const struct fibers *f, const struct bend_twist *t, int64_t v, double *force)
{
  const int64_t prev = prev_of(f, v), next = next_of(f, v);
  const struct vec3 r0 = between(f, prev, v, t->image), r1 = between(f, v, next, t->image);
  const double d0 = vec3_dot(r0, r0), d1 = vec3_dot(r1, r1);
  const double i0 = 1.0 / (t->roots_left_out ? d0 : sqrt(d0)), i1 = 1.0 / (t->roots_left_out ? d1 : sqrt(d1));
  const struct vec3 u0 = vec3_scale(t->exchanged ? i1 : i0, r0), u1 = vec3_scale(t->exchanged ? i0 : i1, r1);
  const double kappa = (1.0 + t->kappa) * constant(f, t->kappa_of < 0 ? prev : t->kappa_of > 0 ? next : v, BENDING);
  const double dot = vec3_dot(u0, u1);
  const double c = t->no_projection ? 0.0 : t->cosine_turned ? -dot : t->cosine_squared ? dot * dot : dot;
  const double c0 = t->turned_before               ? -dot
                    : t->projection_squared_before ? dot * dot
                    : t->unprojected_before        ? 0.0
                                                   : c;
  const double c1 = t->turned_after ? -dot : t->projection_squared_after ? dot * dot : t->unprojected_after ? 0.0 : c;
  const double p0 = t->undivided_before               ? 1.0
                    : t->lengths_after                ? i1
                    : t->of_both                      ? i0 * i1
                    : t->squared || t->squared_before ? i0 * i0
                    : t->exchanged                    ? i1
                                                      : i0;
  const double p1 = t->undivided_after               ? 1.0
                    : t->lengths_before              ? i0
                    : t->of_both                     ? i0 * i1
                    : t->squared || t->squared_after ? i1 * i1
                    : t->exchanged                   ? i0
                                                     : i1;
  const struct vec3 a = vec3_scale((1.0 + t->before) * -kappa * p0, vec3_add_scaled(u1, -c0, u0));
  const struct vec3 b = vec3_scale((1.0 + t->after) * kappa * p1, vec3_add_scaled(u0, -c1, u1));
  put(force, prev, 1.0, a);
  put(force, next, 1.0, b);
  put(force, v, -1.0 - t->middle, t->middle_of_before ? a : t->middle_of_after ? b : vec3_add(a, b));
}

static bool has_bend(const struct fibers *f, int64_t v)
{
  return next_of(f, v) >= 0 && prev_of(f, v) >= 0 && constant(f, v, BENDING) != 0.0;
}

static void add_bends(const struct fibers *f, const struct bend_twist *t, double *force)
{
  int64_t first = -1, last = -1;
  for (int64_t v = 0; v < f->n; v++)
    if (has_bend(f, v))
      first = first < 0 ? v : first, last = v;
  for (int64_t v = 0; v < f->n; v++) {
    const bool closing = next_of(f, v) >= 0 && next_of(f, v)<v, beginning = prev_of(f, v)> v;
    if (has_bend(f, v) && !(t->no_closing && closing) && !(t->no_ends_of_closing && (closing || beginning)) &&
        !(t->no_first && v == first) && !(t->no_last && v == last))
      add_bend(f, t, v, force);
  }
}

static bool make_bends(const struct evidence_part *part, const void *twist, double *force)
{
  struct fibers f;
  if (!take_fibers(part, &f))
    return false;
  memset(force, 0, 3 * sizeof *force * f.n);
  add_bends(&f, twist, force);
  return true;
}

static bool bends(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct bend_twist known[] = {
      {.before = -2.0, .after = -2.0, .text = "sign: the negative of what is wanted; bends straighten"},
      {.middle = -1.0, .text = "the bend's force on the middle vertex is left out: -(A + B)"},
      {.middle = -2.0, .text = "sign: the bend's force on the middle vertex is -(A + B)"},
      {.before = -1.0, .text = "the bend's force on the vertex before is left out"},
      {.after = -1.0, .text = "the bend's force on the vertex after is left out"},
      {.before = -2.0,
       .text = "sign: the bend's force A on the vertex before, or the bond after it taken the other way round"},
      {.after = -2.0,
       .text = "sign: the bend's force B on the vertex after, or the bond before it taken the other way round"},
      {.middle_of_before = true, .text = "the bend's force on the middle vertex is -A: it is -(A + B)"},
      {.middle_of_after = true, .text = "the bend's force on the middle vertex is -B: it is -(A + B)"},
      {.cosine_squared = true, .text = "the cosine squared in the projection: u1 - c^2 u0 for u1 - c u0"},
      {.projection_squared_before = true, .text = "the cosine squared in A: u1 - c^2 u0 for u1 - c u0"},
      {.projection_squared_after = true, .text = "the cosine squared in B: u0 - c^2 u1 for u0 - c u1"},
      {.unprojected_before = true, .text = "A without its projection: u1 for u1 - c u0"},
      {.unprojected_after = true, .text = "B without its projection: u0 for u0 - c u1"},
      {.lengths_before = true, .text = "the bend's force on the vertex after by the length of the bond before"},
      {.lengths_after = true, .text = "the bend's force on the vertex before by the length of the bond after"},
      {.lengths_before = true, .lengths_after = true, .text = "the bend's forces by the length of the other bond"},
      {.of_both = true, .text = "the bend's forces by both lengths"},
      {.before = 1.0, .text = "the bend's force on the vertex before twice"},
      {.after = 1.0, .text = "the bend's force on the vertex after twice"},
      {.middle = 1.0, .text = "the bend's force on the middle vertex twice"},
      {.exchanged = true, .text = "the bend's two lengths exchanged"},
      {.undivided_before = true, .undivided_after = true, .text = "bends without 1/length: kappa/l (u - c u)"},
      {.undivided_before = true, .text = "the bend's force on the vertex before without 1/length"},
      {.undivided_after = true, .text = "the bend's force on the vertex after without 1/length"},
      {.squared = true, .text = "bends with 1/length squared"},
      {.squared_before = true, .text = "A with 1/length squared"},
      {.squared_after = true, .text = "B with 1/length squared"},
      {.turned_before = true, .text = "sign of the projection in A: u1 + c u0"},
      {.turned_after = true, .text = "sign of the projection in B: u0 + c u1"},
      {.roots_left_out = true, .text = "lengths of bends without their root"},
      {.no_projection = true, .text = "bends without their projection: u1 for u1 - c u0"},
      {.cosine_turned = true, .text = "sign of the projection: u1 + c u0 for u1 - c u0"},
      {.image = true, .text = "bonds as minimum images: vertices are unwrapped"},
      {.no_closing = true, .text = "the bend at the end of a ring, whose bond closes it, is left out"},
      {.no_ends_of_closing = true, .text = "the two bends of the bond that closes a ring are left out"},
      {.kappa_of = -1, .text = "the bending constant of the vertex before"},
      {.kappa_of = 1, .text = "the bending constant of the next vertex"},
      {.kappa = 1.0, .text = "a constant factor: kappa is twice what is wanted"},
      {.kappa = -0.5, .text = "a constant factor: kappa is half of what is wanted"},
      {.no_first = true, .text = "the first bend of all is left out: wrong exactly in the 3 vertices of it"},
      {.no_last = true, .text = "the last bend of all is left out: wrong exactly in the 3 vertices of it"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill_tables(e, make_bends, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- all forces --------------------------------------------------------------------------------------------------- */

enum body_mass { BODY_PLAIN, BODY_TIMES_MASS, BODY_OVER_MASS };

struct force_twist {
  double body, bonds, bends; /* times, less 1 */
  int body_of;               /* vertices further on */
  bool body_of_first;        /* vertex 0 */
  int without, axis_of;      /* 1 + component */
  enum body_mass mass;
  const char *text;
};

static bool make_force(const struct evidence_part *part, const void *twist, double *force)
{
  const struct force_twist *t = twist;

  struct pack_place at = part->pair.ours->place;
  snprintf(at.operator_name, sizeof at.operator_name, "bond_force");
  const struct pack_table *bond = pack_find(part->pair.pack, &at, "out.force");
  snprintf(at.operator_name, sizeof at.operator_name, "bend_force");
  const struct pack_table *bend = pack_find(part->pair.pack, &at, "out.force");
  struct fibers f;
  if (!bond || !bend || !take_fibers(part, &f) || bond->rows != f.n || bend->rows != f.n)
    return false;
  for (uint32_t v = 0; v < f.n; v++)
    for (uint32_t c = 0; c < 3; c++) {
      const double m = constant(&f, v, MASS);
      const uint32_t of = t->body_of_first ? 0 : (v + f.n + (uint32_t)t->body_of) % f.n;
      const uint32_t axis = t->axis_of ? (uint32_t)t->axis_of - 1 : c;
      const double body =
          (t->without == (int)c + 1 ? 0.0 : constant(&f, of, FORCE + axis)) * (t->mass == BODY_TIMES_MASS  ? m
                                                                               : t->mass == BODY_OVER_MASS ? 1.0 / m
                                                                                                           : 1.0);
      force[3 * (size_t)v + c] = (1.0 + t->body) * body + (1.0 + t->bonds) * pack_value(bond, v, c) +
                                 (1.0 + t->bends) * pack_value(bend, v, c);
    }
  return true;
}

static bool forces(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const struct force_twist known[] = {
      {.body = -1.0, .text = "constant force left out"},
      {.body = 1.0, .text = "constant force twice"},
      {.body = -2.0, .text = "sign of the constant force"},
      {.mass = BODY_TIMES_MASS, .text = "constant force times the mass: it is no acceleration"},
      {.mass = BODY_OVER_MASS, .text = "constant force over the mass: the kick divides by it"},
      {.body_of = 1, .text = "constant force of the next vertex"},
      {.body_of_first = true, .text = "constant force of vertex 0 on all"},
      {.without = 1, .text = "constant force without its x"},
      {.without = 2, .text = "constant force without its y"},
      {.without = 3, .text = "constant force without its z"},
      {.axis_of = 1, .text = "constant force: its x along all axes"},
      {.axis_of = 2, .text = "constant force: its y along all axes"},
      {.axis_of = 3, .text = "constant force: its z along all axes"},
      {.bonds = -2.0, .text = "sign of bonds in the total"},
      {.body = -0.5, .text = "constant force halved"},
      {.bonds = -0.5, .text = "bonds halved in the total"},
      {.bends = -0.5, .text = "bends halved in the total"},
      {.body_of = -1, .text = "constant force of the vertex before"},
      {.bonds = -1.0, .text = "bonds left out of the total"},
      {.bends = -1.0, .text = "bends left out of the total"},
      {.bonds = 1.0, .text = "bonds twice in the total"},
      {.bends = 1.0, .text = "bends twice in the total"},
      {.bends = -2.0, .text = "sign of bends in the total"},
      {.bonds = -1.0, .bends = -1.0, .text = "constant force only: bonds and bends left out of the total"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill_tables(e, make_force, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

/* --- kick --------------------------------------------------------------------------------------------------------- */

struct kick_twist {
  double power;          /* of the mass, more than -1 */
  int mass_of, force_of; /* rows further on */
  double time;           /* times, less 1 */
  const uint8_t *axes;
  bool whole_masses, mass_of_first, time_squared;
  const char *text;
};

static double kick_value(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  const struct kick_twist *t = twist;
  const struct pack_table *v = oracle_sibling(&part->pair, "in.velocity"), *f = oracle_sibling(&part->pair, "in.force");
  const struct pack_table *time = oracle_sibling(&part->pair, "in.time"), *m = oracle_model(&part->pair, "in.vertex");
  if (!v || !f || !time || !m || m->rows == 0 || column > 2)
    return NAN;
  const uint32_t n = m->rows;
  const double mass = pack_value(m, t->mass_of_first ? 0 : (uint32_t)(row + n + (uint32_t)t->mass_of) % n, 0);
  const double force =
      pack_value(f, (uint32_t)(row + n + (uint32_t)t->force_of) % n, t->axes ? t->axes[column] : column);
  return pack_value(v, row, column) + (1.0 + t->time) * pack_value(time, 0, 0) *
                                          (t->time_squared ? pack_value(time, 0, 0) : 1.0) *
                                          pow(t->whole_masses ? floor(mass) : mass, t->power - 1.0) * force;
}

static bool kicks(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  static const uint8_t axes[][3] = {{1, 0, 2}, {0, 2, 1}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}};
  static const struct kick_twist known[] = {
      {.power = 1.0, .text = "kick without the mass: v + t F for v + t F/M"},
      {.power = 2.0, .text = "kick times the mass: v + t F M for v + t F/M"},
      {.power = -1.0, .text = "kick by the mass squared: v + t F/M^2 for v + t F/M"},
      {.power = 0.5, .text = "kick by the root of the mass"},
      {.mass_of = 1, .text = "kick by the mass of the next vertex"},
      {.mass_of_first = true, .text = "kick by the mass of vertex 0 for all"},
      {.time = -0.5, .text = "half a step: changed by half of what is wanted"},
      {.time = -2.0, .text = "sign: changed by the negative of what is wanted"},
      {.time_squared = true, .text = "kick by the time squared"},
      {.mass_of = -1, .text = "kick by the mass of the vertex before"},
      {.force_of = 1, .text = "kick by the force on the next vertex"},
      {.force_of = -1, .text = "kick by the force on the vertex before"},
      {.whole_masses = true, .text = "kick by masses cut to integers"},
      {.time = 1.0, .text = "a step instead of half a step: changed by twice what is wanted"},
      {.axes = axes[0], .text = "kick with components of the force exchanged: y, x, z"},
      {.axes = axes[1], .text = "kick with components of the force exchanged: x, z, y"},
      {.axes = axes[2], .text = "kick with components of the force exchanged: z, y, x"},
      {.axes = axes[3], .text = "kick with components of the force exchanged: y, z, x"},
      {.axes = axes[4], .text = "kick with components of the force exchanged: z, x, y"},
  };
  if (k >= COUNT_OF(known))
    return false;
  relation_fill(e, kick_value, &known[k]);
  return relation_say(text, "%s", known[k].text);
}

const struct relation oracle_relations_fiber[] = {
    {"bond_force", "out.force", bonds, false},
    {"bend_force", "out.force", bends, false},
    {"force", "out.force", forces, false},
    {"kick", "out.velocity", kicks, false},
    {.make = NULL},
};
