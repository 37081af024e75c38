/*
 * Tests for a crossing that hang on one sign. The triangle that a bond sweeps and a bond that pierces it are drawn at
 * random. Then one point is moved so that one of the five determinants is nearly or exactly zero, and all others are
 * far from it. Only such tests are kept for which the determinants in doubles, with zero as positive, say something
 * else than the exact ones: whoever leaves the exact integers out is wrong in each of them.
 */
#include <stdlib.h>

#include "oracle/dice.h"
#include "oracle/rows.h"
#include "oracle/stages.h"

/* The determinants in the order of docs/conventions.md: first volume at `from` and `to`, path, sides of a and b. */
enum determinant { BEFORE, AFTER, PATH, SIDE_OF_A, SIDE_OF_B, DETERMINANTS };

enum {
  SEED = 15,
  NEARLY = 12,    /* tests of each kind, for each determinant and flip */
  EXACTLY = 6,    /* zeros where doubles say something else */
  SYMMETRIC = 4,  /* zeros where they may not */
  GRID = 100,     /* tests on a coarse grid, with several zeros each */
  PLAIN = 40,     /* tests without any */
  TRIES = 1 << 24 /* for one test; a few thousand are usual */
};
#define MOST_ROWS ((uint32_t)(2 * DETERMINANTS * (2 * NEARLY + 2 * EXACTLY + SYMMETRIC) + GRID + PLAIN))

/* Sizes of differences: a bond as usual, and one in the largest box (2^49 units: 512 a0). */
static const int64_t usual = (int64_t)1 << 39, wide = (int64_t)1 << 49;

/* --- the test in doubles only ------------------------------------------------------------------------------------ */

/* (u - o) x (v - o) . (w - o), as docs/conventions.md writes it, rounded. */
static double rounded(struct point o, struct point u, struct point v, struct point w)
{
  const struct vec3 p = point_difference(u, o), q = point_difference(v, o), r = point_difference(w, o);
  return r.x * (p.y * q.z - p.z * q.y) + r.y * (p.z * q.x - p.x * q.z) + r.z * (p.x * q.y - p.y * q.x);
}

static bool positive(double det, bool flip)
{
  return flip ? det > 0.0 : det >= 0.0;
}

/* The sides of a and b may be seen from the pivot or from `from`. */
static bool crosses_in_doubles(const struct crossing_query *k, bool from_pivot)
{
  const bool side = positive(rounded(k->a, k->b, k->pivot, k->from), k->flip);
  const struct point o = from_pivot ? k->pivot : k->from, u = from_pivot ? k->from : k->to,
                     v = from_pivot ? k->to : k->pivot;
  return positive(rounded(k->a, k->b, k->pivot, k->to), k->flip) != side &&
         positive(rounded(k->a, k->b, k->from, k->to), false) == side &&
         positive(rounded(o, u, v, k->a), false) != positive(rounded(o, u, v, k->b), false);
}

static bool doubles_are_wrong(const struct crossing_query *k)
{
  struct crossing_hit hit;
  const bool right = crossing_find(k, &hit);
  return crosses_in_doubles(k, true) != right && crosses_in_doubles(k, false) != right;
}

/* --- geometry ---------------------------------------------------------------------------------------------------- */

/* o + s (u - o) + t (v - o), rounded. */
static struct point blend(struct point o, double s, struct point u, double t, struct point v)
{
  const struct point p = point_minus(u, o), q = point_minus(v, o);
  return (struct point){o.x + lattice_round(s * (double)p.x + t * (double)q.x),
                        o.y + lattice_round(s * (double)p.y + t * (double)q.y),
                        o.z + lattice_round(s * (double)p.z + t * (double)q.z)};
}

static struct crossing_query draw_points(struct dice *d, int64_t size, int64_t grid)
{
  struct crossing_query q = {.flip = false};
  struct point *const all[5] = {&q.from, &q.to, &q.pivot, &q.a, &q.b};
  for (int k = 0; k < 5; k++) {
    const struct point p = dice_point(d, size / grid);
    *all[k] = (struct point){grid * p.x, grid * p.y, grid * p.z};
  }
  return q;
}

/* The bond meets the other at a share w of the way to the pivot, or of the standing bond. */
static struct crossing_query nearly_zero(struct dice *d, enum determinant which, int64_t size)
{
  struct crossing_query q = draw_points(d, size, 1);
  const double share = dice_between(d, 0.2, 0.8), further = dice_between(d, 1.2, 2.0);
  const double corner = dice_between(d, 0.1, 0.45), other = dice_between(d, 0.1, 0.45);
  switch (which) {
  case BEFORE: /* from, pivot, and a point of the standing bond between them are on a line */
    q.from = blend(q.pivot, further * (1.0 - share), q.a, further * share, q.b);
    break;
  case AFTER:
    q.to = blend(q.pivot, further * (1.0 - share), q.a, further * share, q.b);
    break;
  case PATH: /* a, b, and a point of the way between them */
    q.b = blend(q.a, further * (1.0 - share), q.from, further * share, q.to);
    break;
  case SIDE_OF_A: /* a in the triangle */
    q.a = blend(q.pivot, corner, q.from, other, q.to);
    break;
  default:
    q.b = blend(q.pivot, corner, q.from, other, q.to);
  }
  return q;
}

static struct point minus_from_sum(struct point p, struct point q, struct point r)
{
  return point_minus(point_plus(p, q), r);
}

/* The middle of pivot and the middle of the way; coordinates are multiples of 4. */
static struct point middle(const struct crossing_query *q)
{
  const struct point way = point_plus(q->from, q->to);
  return (struct point){way.x / 4 + q->pivot.x / 2, way.y / 4 + q->pivot.y / 2, way.z / 4 + q->pivot.z / 2};
}

static struct crossing_query exactly_zero(struct dice *d, enum determinant which, int64_t size)
{
  struct crossing_query q = draw_points(d, size, 8);
  switch (which) {
  case BEFORE: /* the middle of a and b is the middle of from and pivot */
    q.from = minus_from_sum(q.a, q.b, q.pivot);
    break;
  case AFTER:
    q.to = minus_from_sum(q.a, q.b, q.pivot);
    break;
  case PATH:
    q.b = minus_from_sum(q.from, q.to, q.a);
    break;
  case SIDE_OF_A:
    q.a = middle(&q);
    break;
  default:
    q.b = middle(&q);
  }
  return q;
}

static void move_all(struct crossing_query *q, struct point by)
{
  struct point *const all[5] = {&q->from, &q->to, &q->pivot, &q->a, &q->b};
  for (int k = 0; k < 5; k++)
    *all[k] = point_plus(*all[k], by);
}

/* Bonds that are parallel when they meet have a normal of their own; no test of a pack is of them. */
static bool has_normal(const struct crossing_query *q, double time)
{
  const struct vec3 p = vec3_add_scaled(point_difference(q->pivot, q->from), -time, point_difference(q->to, q->from));
  const struct vec3 ab = point_difference(q->b, q->a);
  return vec3_norm(vec3_cross(p, ab)) > 1e-3 * vec3_norm(p) * vec3_norm(ab);
}

static int zeros(const struct crossing_query *k)
{
  return (crossing_orientation(k->a, k->b, k->pivot, k->from) == 0) +
         (crossing_orientation(k->a, k->b, k->pivot, k->to) == 0) +
         (crossing_orientation(k->a, k->b, k->from, k->to) == 0) +
         (crossing_orientation(k->pivot, k->from, k->to, k->a) == 0) +
         (crossing_orientation(k->pivot, k->from, k->to, k->b) == 0);
}

/* --- rows -------------------------------------------------------------------------------------------------------- */

struct rows {
  struct dice dice;
  struct crossing_query *query;
  uint32_t count;
};

/* What a test must be, to be kept. */
struct wish {
  bool exact;            /* zeros, else nearly */
  bool wrong_in_doubles; /* else whatever they say */
  enum determinant which;
  bool flip;
  int64_t size;
};

static bool keep(struct rows *r, struct crossing_query q, int64_t size)
{
  struct crossing_hit hit;
  if (crossing_find(&q, &hit) && !has_normal(&q, hit.time))
    return false;
  move_all(&q, dice_point(&r->dice, 2 * size));
  r->query[r->count++] = q;
  return true;
}

static void add(struct rows *r, const struct wish *w)
{
  for (uint32_t k = 0; k < TRIES; k++) {
    struct crossing_query q =
        w->exact ? exactly_zero(&r->dice, w->which, w->size) : nearly_zero(&r->dice, w->which, w->size);
    q.flip = w->flip;
    if ((!w->wrong_in_doubles || doubles_are_wrong(&q)) && keep(r, q, w->size))
      return;
  }
}

static void add_of(struct rows *r, enum determinant which, bool flip)
{
  for (int k = 0; k < 2 * NEARLY; k++)
    add(r, &(struct wish){false, true, which, flip, k % 2 ? usual : wide});
  for (int k = 0; k < 2 * EXACTLY; k++)
    add(r, &(struct wish){true, true, which, flip, k % 2 ? usual : wide});
  for (int k = 0; k < SYMMETRIC; k++)
    add(r, &(struct wish){true, false, which, flip, usual});
}

/* Points on a grid of a quarter of a0, with zeros; every other one crosses. */
static void add_on_grid(struct rows *r, uint32_t n)
{
  struct crossing_hit hit;
  for (uint32_t k = 0, tries = 0; k < n && tries < TRIES; tries++) {
    struct crossing_query q = draw_points(&r->dice, usual, usual / 2);
    q.flip = dice_u64(&r->dice) % 2;
    if (crossing_find(&q, &hit) == (k % 2 == 0) && zeros(&q) > 0)
      k += keep(r, q, usual);
  }
}

static void add_plain(struct rows *r, uint32_t n)
{
  struct crossing_hit hit;
  for (uint32_t k = 0, tries = 0; k < n && tries < TRIES; tries++) {
    struct crossing_query q = draw_points(&r->dice, usual, 1);
    q.flip = dice_u64(&r->dice) % 2;
    if (crossing_find(&q, &hit) == (k % 2 == 0))
      k += keep(r, q, usual);
  }
}

bool oracle_edges_crossing(struct oracle_stage *g)
{
  struct rows r = {{SEED}, malloc(MOST_ROWS * sizeof *r.query), 0};
  g->pack->failed |= !r.query;
  if (!r.query)
    return false;
  for (int which = 0; which < 2 * DETERMINANTS; which++)
    add_of(&r, (enum determinant)(which / 2), which % 2);
  add_on_grid(&r, GRID);
  add_plain(&r, PLAIN);
  bool ok = true;
  for (uint32_t k = 0; k < r.count; k++) {
    const struct oracle_test t = {.query = r.query[k]};
    ok = ok && oracle_add_rows(g, &t, 1, sizeof t);
  }
  free(r.query);
  return ok;
}
