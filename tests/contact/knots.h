/* Knotted rings, and an invariant of knots that is computed exactly: the determinant |Delta(-1)|, Delta being the
 * polynomial of Alexander. 1 of the unknot, 3 of the trefoil, 5 of the figure eight, n of the torus knot (2, n).
 *
 * A projection of a knot with c crossings has c arcs, each from one passage below to the next. Every crossing gives a
 * row of a matrix: 2 in the column of the arc above, -1 in those of the two arcs that end there. The determinant
 * without the last row and column is that of the knot, up to its sign (R. H. Crowell and R. H. Fox, Introduction to
 * Knot Theory, Springer 1977). The projection is along (3, 2, 7), in exact rationals. */
#ifndef UNCROSS_TESTS_KNOTS_H
#define UNCROSS_TESTS_KNOTS_H

#include "contact/rings.h"

/* --- the determinant of a knot ------------------------------------------------------------------------------------ */

enum { MOST_CROSSINGS = 512, MOST_KNOT_VERTICES = 128 };

/* One passage: an edge, and the place along it. */
struct passage {
  uint32_t edge;
  mpq_t place;
};

struct knot_crossing {
  struct passage over, under;
};

struct flat {
  int128 x, y, height;
};

static inline struct flat flat_of(struct point p, struct point origin)
{
  const int128 x = p.x - origin.x, y = p.y - origin.y, z = p.z - origin.z;
  return (struct flat){7 * x - 3 * z, 7 * y - 2 * z, 3 * x + 2 * y + 7 * z};
}

static inline int128 flat_area(struct flat o, struct flat a, struct flat b)
{
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

static inline void set_wide(mpz_t z, int128 value)
{
  __extension__ unsigned __int128 size = value < 0 ? -(unsigned __int128)value : (unsigned __int128)value;
  mpz_set_ui(z, (unsigned long)(size >> 64));
  mpz_mul_2exp(z, z, 64);
  mpz_add_ui(z, z, (unsigned long)size);
  if (value < 0)
    mpz_neg(z, z);
}

static inline void set_fraction(mpq_t q, int128 numerator, int128 denominator)
{
  set_wide(mpq_numref(q), numerator);
  set_wide(mpq_denref(q), denominator);
  mpq_canonicalize(q);
}

/* height of a + place (b - a) */
static inline void height_at(mpq_t height, struct flat a, struct flat b, const mpq_t place)
{
  mpq_t base;
  mpq_init(base);
  set_fraction(base, a.height, 1);
  set_fraction(height, b.height - a.height, 1);
  mpq_mul(height, height, place);
  mpq_add(height, height, base);
  mpq_clear(base);
}

/* True if edges p q and a b cross in the projection; their crossing. */
static inline bool edges_cross(uint32_t edge, uint32_t other, struct flat p, struct flat q, struct flat a,
                               struct flat b, struct knot_crossing *c)
{
  const int128 pa = flat_area(p, q, a), pb = flat_area(p, q, b), ap = flat_area(a, b, p), aq = flat_area(a, b, q);
  assert_true(pa != 0 && pb != 0 && ap != 0 && aq != 0); /* not by chance */
  if ((pa > 0) == (pb > 0) || (ap > 0) == (aq > 0))
    return false;
  mpq_t h[2];
  mpq_inits(h[0], h[1], c->over.place, c->under.place, NULL);
  c->over.edge = edge, c->under.edge = other;
  set_fraction(c->over.place, ap, ap - aq);
  set_fraction(c->under.place, pa, pa - pb);
  height_at(h[0], p, q, c->over.place);
  height_at(h[1], a, b, c->under.place);
  const int above = mpq_cmp(h[0], h[1]);
  assert_true(above != 0); /* else the two edges touch */
  if (above < 0) {
    c->over.edge = other, c->under.edge = edge;
    mpq_swap(c->over.place, c->under.place);
  }
  mpq_clears(h[0], h[1], NULL);
  return true;
}

static inline int compare_passages(const struct passage *a, const struct passage *b)
{
  return a->edge != b->edge ? (a->edge > b->edge) - (a->edge < b->edge) : mpq_cmp(a->place, b->place);
}

static inline int compare_crossings(const void *a, const void *b)
{
  return compare_passages(&((const struct knot_crossing *)a)->under, &((const struct knot_crossing *)b)->under);
}

/* |det| of an n x n matrix, which is destroyed: without fractions (Bareiss 1968). */
static inline double integer_determinant(mpz_t *m, uint32_t n)
{
  mpz_t last;
  mpz_init_set_ui(last, 1);
  bool singular = false;
  for (uint32_t k = 0; k < n && !singular; k++) {
    uint32_t pivot = k;
    while (pivot < n && mpz_sgn(m[pivot * n + k]) == 0)
      pivot++;
    singular = pivot == n;
    if (singular)
      break;
    for (uint32_t j = k; j < n && pivot != k; j++)
      mpz_swap(m[k * n + j], m[pivot * n + j]);
    for (uint32_t i = k + 1; i < n; i++) {
      for (uint32_t j = k + 1; j < n; j++) {
        mpz_mul(m[i * n + j], m[i * n + j], m[k * n + k]);
        mpz_submul(m[i * n + j], m[i * n + k], m[k * n + j]);
        mpz_divexact(m[i * n + j], m[i * n + j], last);
      }
    }
    mpz_set(last, m[k * n + k]);
  }
  const double value = singular ? 0.0 : fabs(mpz_get_d(last));
  mpz_clear(last);
  return value;
}

static inline double determinant_of_crossings(const struct knot_crossing *c, uint32_t n)
{
  if (n < 2)
    return 1.0;
  const uint32_t size = n - 1;
  mpz_t *m = malloc(size * size * sizeof *m);
  for (uint32_t k = 0; k < size * size; k++)
    mpz_init(m[k]);
  for (uint32_t k = 0; k < size; k++) {
    uint32_t below = 0; /* passages below before the passage above */
    while (below < n && compare_passages(&c[below].under, &c[k].over) < 0)
      below++;
    const uint32_t column[3] = {(below + n - 1) % n, (k + n - 1) % n, k};
    for (int part = 0; part < 3; part++) {
      if (column[part] == size)
        continue;
      mpz_t *entry = &m[k * size + column[part]];
      part == 0 ? mpz_add_ui(*entry, *entry, 2) : mpz_sub_ui(*entry, *entry, 1);
    }
  }
  const double determinant_value = integer_determinant(m, size);
  for (uint32_t k = 0; k < size * size; k++)
    mpz_clear(m[k]);
  free(m);
  return determinant_value;
}

/* Of a closed polygon. */
static inline double knot_determinant(const struct point *vertex, uint32_t vertices)
{
  static struct knot_crossing crossing[MOST_CROSSINGS];
  struct flat flat[MOST_KNOT_VERTICES];
  uint32_t n = 0;
  assert_true(vertices <= MOST_KNOT_VERTICES);
  for (uint32_t v = 0; v < vertices; v++)
    flat[v] = flat_of(vertex[v], vertex[0]);
  for (uint32_t i = 0; i < vertices; i++)
    for (uint32_t j = i + 2; j < vertices; j++) {
      if (i == 0 && j == vertices - 1)
        continue;
      assert_true(n < MOST_CROSSINGS);
      n += edges_cross(i, j, flat[i], flat[i + 1], flat[j], flat[(j + 1) % vertices], &crossing[n]);
    }
  qsort(crossing, n, sizeof *crossing, compare_crossings);
  const double value = determinant_of_crossings(crossing, n);
  for (uint32_t k = 0; k < n; k++)
    mpq_clears(crossing[k].over.place, crossing[k].under.place, NULL);
  return value;
}

/* --- knots -------------------------------------------------------------------------------------------------------- */

enum knot_kind { UNKNOT, TREFOIL, FIGURE_EIGHT, TORUS_2_5, KNOT_KINDS };

static inline struct vec3 knot_curve(enum knot_kind kind, double t)
{
  const double r = 2.0 + cos(kind == FIGURE_EIGHT ? 2.0 * t : 5.0 * t);
  switch (kind) {
  case TREFOIL:
    return (struct vec3){sin(t) + 2.0 * sin(2.0 * t), cos(t) - 2.0 * cos(2.0 * t), -sin(3.0 * t)};
  case FIGURE_EIGHT:
    return (struct vec3){r * cos(3.0 * t), r * sin(3.0 * t), sin(4.0 * t)};
  case TORUS_2_5: /* twice around */
    return (struct vec3){r * cos(2.0 * t), r * sin(2.0 * t), sin(5.0 * t)};
  default:
    return (struct vec3){cos(t), sin(t), 0.3 * sin(2.0 * t)};
  }
}

static inline double knot_determinant_of_kind(enum knot_kind kind)
{
  return kind == TREFOIL ? 3.0 : kind == UNKNOT ? 1.0 : 5.0;
}

/* n points of the curve, all `bond` apart along it, about a center, turned by an angle about (1, 2, 3). */
static inline void lay_knot(struct point *at, uint32_t n, enum knot_kind kind, double bond, struct vec3 center,
                            double angle)
{
  enum { FINE = 4096 };
  static double length[FINE + 1];
  const double step = 6.283185307179586477 / FINE;
  for (int k = 0; k < FINE; k++)
    length[k + 1] = length[k] + vec3_norm(vec3_sub(knot_curve(kind, (k + 1) * step), knot_curve(kind, k * step)));
  const double size = bond * n / length[FINE];
  const struct vec3 axis = vec3_scale(1.0 / sqrt(14.0), (struct vec3){1, 2, 3});
  for (uint32_t v = 0, k = 0; v < n; v++) {
    while (length[k + 1] < length[FINE] * v / n)
      k++;
    const struct vec3 r = vec3_scale(size, knot_curve(kind, k * step));
    const struct vec3 turned =
        vec3_add(vec3_add(vec3_scale(cos(angle), r), vec3_scale(sin(angle), vec3_cross(axis, r))),
                 vec3_scale((1.0 - cos(angle)) * vec3_dot(axis, r), axis));
    at[v] = point_move((struct point){0, 0, 0}, vec3_add(center, turned));
  }
}

/* Rings in a cubic box, each a knot of this kind, in turn. */
static inline struct test_run start_knots(struct model m, uint32_t rings, uint32_t vertices,
                                          const enum knot_kind *kinds, uint32_t different)
{
  struct fiber_kind *k = test_add_kind(&m, rings, vertices);
  k->ring = true;
  k->bending = 2.0;
  struct test_run r = test_start(m);
  const double edge = box_shortest_edge(&r.model.box);
  for (uint32_t ring = 0; ring < rings; ring++) {
    const struct vec3 center = {edge * ((ring * 5) % 8) / 8.0 + 0.013 * ring, edge * ((ring * 3) % 8) / 8.0,
                                edge * (ring % 8) / 8.0};
    lay_knot(&r.state.position[r.model.fiber_first[ring]], vertices, kinds[ring % different], 0.5, center,
             0.7 + 1.3 * ring);
  }
  r.work.contact.neighbors.built = false; /* they were laid by hand */
  return r;
}

struct knots_followed {
  uint64_t steps, executed;
  uint32_t looked, changed;
};

/* Steps, and looks at all knots every `every` steps. */
static inline struct knots_followed follow_knots(struct test_run *r, uint64_t steps, uint64_t every,
                                                 const enum knot_kind *kinds, uint32_t different)
{
  struct knots_followed f = {0};
  for (; f.steps < steps; f.steps += every) {
    test_steps(r, every);
    for (uint32_t ring = 0; ring < r->model.fibers; ring++) {
      const uint32_t first = r->model.fiber_first[ring], n = r->model.fiber_first[ring + 1] - first;
      const double now = knot_determinant(&r->state.position[first], n);
      f.looked++;
      f.changed += now != knot_determinant_of_kind(kinds[ring % different]);
    }
  }
  f.executed = r->state.counts.executed;
  return f;
}

#endif
