/*
 * Where things are: positions on a lattice of 2^-40 a0, and the periodic box.
 *
 * A position is a whole number of lattice units, so every difference of two positions and every shift by a box edge is
 * exact: no point moves by an ulp between two looks at it, a trajectory may be run backwards, and the side on which a
 * point lies of a plane can be decided without rounding (contact/line.c). One lattice unit, 9.1e-13 a0, is far below
 * anything physical: rounding a displacement to it adds a random walk of about 1e-6 a0 in 10^12 steps.
 *
 * A difference below 2^53 units (8192 a0) is exact as a double. Boxes have edges of at most LATTICE_MAX_EDGE cells.
 */
#ifndef UNCROSS_BASE_LATTICE_H
#define UNCROSS_BASE_LATTICE_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/vec3.h"

#define LATTICE_BITS 40                           /* a0 = 2^40 lattice units */
#define LATTICE_UNIT 0x1p-40                      /* a0 per lattice unit */
#define LATTICE_PER_A0 0x1p40                     /* lattice units per a0 */
#define LATTICE_CELL ((int64_t)1 << LATTICE_BITS) /* edge of a collision cell, in lattice units */
#define LATTICE_MAX_EDGE 1024                     /* cells */
#define LATTICE_MAX_MOVE 2047.0                   /* a0; lattice_round is right below this */

/* Lattice units, 2.1 million a0: how far from the origin, along any axis, vertices may come. The difference of any two
 * places less than 1.9 times as far fits in 64 bits. */
#define LATTICE_REACH ((int64_t)1 << 61)

/* A point in lattice units. Vertices are unwrapped: a fiber keeps its shape when it leaves the box. */
struct point {
  int64_t x, y, z;
};

/* What is beyond the faces of the box along one axis: its own image; a wall; or an image that slides along x as fast as
 * the box is sheared (Lees and Edwards 1972). Only y may differ from periodic. */
enum boundary_kind { BOUNDARY_PERIODIC, BOUNDARY_WALL, BOUNDARY_SHEAR, BOUNDARIES };

/* The box: whole collision cells along each edge. */
struct box {
  int cells[3];                   /* edge lengths in cells, that is in a0 */
  int64_t edge[3];                /* the same in lattice units */
  enum boundary_kind boundary[3]; /* along each axis */
  int rows[3];                    /* rows of cells of the shifted grid: between walls one more than cells */
};

static inline struct box box_of_cells(int lx, int ly, int lz)
{
  return (struct box){
      .cells = {lx, ly, lz}, .edge = {lx * LATTICE_CELL, ly * LATTICE_CELL, lz * LATTICE_CELL}, .rows = {lx, ly, lz}};
}

/* Gives the box this boundary along an axis. */
static inline void box_bound(struct box *box, int axis, enum boundary_kind kind)
{
  box->boundary[axis] = kind;
  box->rows[axis] = box->cells[axis] + (kind == BOUNDARY_WALL);
}

static inline int box_shortest_edge(const struct box *box)
{
  int s = box->cells[0];
  s = box->cells[1] < s ? box->cells[1] : s;
  return box->cells[2] < s ? box->cells[2] : s;
}

/* Cells of the shifted grid: numbers of cells are below it. */
static inline int64_t box_cell_count(const struct box *box)
{
  return (int64_t)box->rows[0] * box->rows[1] * box->rows[2];
}

/* a0^3 */
static inline double box_volume(const struct box *box)
{
  return (double)((int64_t)box->cells[0] * box->cells[1] * box->cells[2]);
}

/* 1.5 * 2^52: adding it to x leaves the integer nearest to x in the low bits of the sum. */
#define LATTICE_ROUND_MAGIC 0x1.8p52

/* The integer nearest to x (ties to even), for |x| < 2^51. Unlike llrint this form vectorises on every x86-64. */
static inline int64_t lattice_round(double x)
{
  const double magic = LATTICE_ROUND_MAGIC;
  uint64_t bits, base;
  double sum = x + magic;
  memcpy(&bits, &sum, sizeof bits);
  memcpy(&base, &magic, sizeof base);
  return (int64_t)(bits - base);
}

/* A whole number as a double, for |x| < LATTICE_NEAR; unlike a cast this form vectorises on every x86-64. */
#define LATTICE_NEAR ((int64_t)1 << 51)
static inline double lattice_near(int64_t x)
{
  const double magic = LATTICE_ROUND_MAGIC;
  uint64_t bits;
  double sum;
  memcpy(&bits, &magic, sizeof bits);
  bits += (uint64_t)x;
  memcpy(&sum, &bits, sizeof sum);
  return sum - magic;
}

/* Not 0 if x is outside of [-LATTICE_NEAR, LATTICE_NEAR). */
static inline uint64_t lattice_beyond(int64_t x)
{
  return ((uint64_t)x + (uint64_t)LATTICE_NEAR) >> 52;
}

/* a0 -> lattice units, for |x| < LATTICE_MAX_MOVE. */
static inline int64_t lattice_from_a0(double x)
{
  return lattice_round(x * LATTICE_PER_A0);
}

/* A uniform coordinate along an edge of `cells` cells, from 64 random bits. */
static inline int64_t lattice_uniform(uint64_t r, int cells)
{
  int64_t within = (int64_t)(r & (uint64_t)(LATTICE_CELL - 1));
  return (int64_t)(((r >> LATTICE_BITS) * (uint64_t)cells) >> (64 - LATTICE_BITS)) * LATTICE_CELL + within;
}

/* x folded into [0, edge), all in lattice units. */
static inline int64_t lattice_fold(int64_t x, int64_t edge)
{
  int64_t r = x % edge;
  return r < 0 ? r + edge : r;
}

/* A coordinate brought into the box: folded along a periodic axis; set onto the wall if it is beyond one. */
static inline int64_t box_inside(const struct box *box, int axis, int64_t x)
{
  const int64_t edge = box->edge[axis];
  if (box->boundary[axis] != BOUNDARY_WALL)
    return lattice_fold(x, edge);
  return x < 0 ? 0 : x > edge ? edge : x;
}

/* How often edge goes into x, rounded down: the image in which x lies. */
static inline int64_t lattice_image(int64_t x, int64_t edge)
{
  int64_t q = x / edge;
  return q * edge > x ? q - 1 : q;
}

/* The same without a division, with inverse = 1.0 / edge at hand. For |x| < 2^62 and images below 2^40: the product is
 * then less than 1 from the quotient, so its whole part is the image, or next to it. */
static inline int64_t lattice_image_by(int64_t x, int64_t edge, double inverse)
{
  int64_t q = (int64_t)((double)x * inverse);
  q -= q * edge > x;
  return q + (x - q * edge >= edge);
}

/* a - b in a0, exact below 8192 a0. */
static inline struct vec3 point_difference(struct point a, struct point b)
{
  return (struct vec3){(double)(a.x - b.x) * LATTICE_UNIT, (double)(a.y - b.y) * LATTICE_UNIT,
                       (double)(a.z - b.z) * LATTICE_UNIT};
}

/* a + b and a - b, exact. */
static inline struct point point_plus(struct point a, struct point b)
{
  return (struct point){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct point point_minus(struct point a, struct point b)
{
  return (struct point){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline bool point_within_reach(struct point p)
{
  return p.x >= -LATTICE_REACH && p.x <= LATTICE_REACH && p.y >= -LATTICE_REACH && p.y <= LATTICE_REACH &&
         p.z >= -LATTICE_REACH && p.z <= LATTICE_REACH;
}

/* The image of a point, so many box edges away. */
static inline struct point point_image(struct point p, const int32_t image[3], const struct box *box)
{
  return (struct point){p.x + image[0] * box->edge[0], p.y + image[1] * box->edge[1], p.z + image[2] * box->edge[2]};
}

/* a + d with d in a0, rounded to the lattice; a step and the same step back end where they began. */
static inline struct point point_move(struct point a, struct vec3 d)
{
  return (struct point){a.x + lattice_from_a0(d.x), a.y + lattice_from_a0(d.y), a.z + lattice_from_a0(d.z)};
}

/* The position in a0 as doubles (exact below 8192 a0 from the origin). */
static inline struct vec3 point_in_a0(struct point a)
{
  return (struct vec3){(double)a.x * LATTICE_UNIT, (double)a.y * LATTICE_UNIT, (double)a.z * LATTICE_UNIT};
}

#endif
