/*
 * All pairs of members nearer than 1 a0, each once: those within a cell, and those between a cell and the half of its
 * 26 neighbors that come after it. Cells along x follow each other in memory, so that half is the cell to the right and
 * four rows of three. Differences of places are exact, so that distances do not depend on which member is the first.
 */
#include "medium/near.h"

#include <math.h>

#include "base/elementary.h"

enum { BLOCK = NEAR_BLOCK, MOST_RANGES = 10 };

/* Members side by side, with the image of theirs that is meant. */
struct range {
  uint32_t first, end;
  struct vec3 shift;
};

/* Pairs that are near and wait for a block to be full. */
struct near {
  uint32_t n;
  uint32_t a[2 * BLOCK], b[2 * BLOCK];
};

/* A difference of two coordinates of the box, to the nearest image: exact. */
static inline double nearest(double difference, double edge)
{
  const double turns = difference / edge + ELEMENTARY_ROUND;
  return difference - edge * (turns - ELEMENTARY_ROUND);
}

/* Shows up to BLOCK pairs to the visitor. */
static bool visit(const struct near_search *s, const uint32_t *a, const uint32_t *b, uint32_t n)
{
  const struct medium *m = s->medium;
  const int *edge = s->model->box.cells;
  struct near_pairs p = {.n = n};
  for (uint32_t k = 0; k < n; k++) {
    p.a[k] = a[k];
    p.b[k] = b[k];
    p.x[k] = nearest(m->x[a[k]] - m->x[b[k]], edge[0]);
    p.y[k] = nearest(m->y[a[k]] - m->y[b[k]], edge[1]);
    p.z[k] = nearest(m->z[a[k]] - m->z[b[k]], edge[2]);
  }
  for (uint32_t k = 0; k < n; k++)
    p.r[k] = sqrt(p.x[k] * p.x[k] + p.y[k] * p.y[k] + p.z[k] * p.z[k]);
  return s->look(s, &p);
}

/* Cells x - 1 to x + 1 of a row, or x + 1 alone; where the box ends, two ranges. */
static uint32_t add_row(const struct near_search *s, int low, int high, int y, int z, uint32_t ranges,
                        struct range *range)
{
  const int *edge = s->model->box.cells;
  const uint32_t *first = s->medium->first;
  const int row_y = y < 0 ? y + edge[1] : y < edge[1] ? y : y - edge[1], row_z = z < edge[2] ? z : z - edge[2];
  const uint32_t row = ((uint32_t)row_z * (uint32_t)edge[1] + (uint32_t)row_y) * (uint32_t)edge[0];
  const double along_y = y - row_y, along_z = z - row_z;
  const int inner_low = low < 0 ? 0 : low, inner_high = high < edge[0] ? high : edge[0] - 1;
  if (low < 0)
    range[ranges++] = (struct range){
        first[row + (uint32_t)edge[0] - 1], first[row + (uint32_t)edge[0]], {-(double)edge[0], along_y, along_z}};
  if (inner_low <= inner_high)
    range[ranges++] = (struct range){
        first[row + (uint32_t)inner_low], first[row + (uint32_t)inner_high + 1], {0.0, along_y, along_z}};
  if (high >= edge[0])
    range[ranges++] = (struct range){first[row], first[row + 1], {edge[0], along_y, along_z}};
  return ranges;
}

/* Adds the members of a part of a range that are near member i, and lists blocks that are full. */
static bool scan_block(const struct near_search *s, uint32_t i, struct vec3 shift, uint32_t first, uint32_t n,
                       struct near *near)
{
  const struct medium *m = s->medium;
  const double xi = m->x[i] - shift.x, yi = m->y[i] - shift.y, zi = m->z[i] - shift.z;
  double square[BLOCK];
  for (uint32_t k = 0; k < n; k++) {
    const double x = m->x[first + k] - xi, y = m->y[first + k] - yi, z = m->z[first + k] - zi;
    square[k] = x * x + y * y + z * z;
  }
  for (uint32_t k = 0; k < n; k++) {
    near->a[near->n] = i;
    near->b[near->n] = first + k;
    near->n += (square[k] < 1.0) & (square[k] > 0.0); /* no line joins two members at one place */
  }
  if (near->n < BLOCK)
    return true;
  near->n -= BLOCK;
  return visit(s, &near->a[near->n], &near->b[near->n], BLOCK);
}

static bool scan(const struct near_search *s, uint32_t i, const struct range *range, uint32_t first, struct near *near)
{
  for (; first < range->end; first += BLOCK) {
    const uint32_t n = range->end - first < BLOCK ? range->end - first : BLOCK;
    if (!scan_block(s, i, range->shift, first, n, near))
      return false;
  }
  return true;
}

static bool search_cell(const struct near_search *s, int x, int y, int z, struct near *near)
{
  const int *edge = s->model->box.cells;
  const uint32_t cell = (uint32_t)((z * edge[1] + y) * edge[0] + x);
  const struct range own = {s->medium->first[cell], s->medium->first[cell + 1], {0, 0, 0}};
  struct range range[MOST_RANGES];
  uint32_t ranges = add_row(s, x + 1, x + 1, y, z, 0, range);
  ranges = add_row(s, x - 1, x + 1, y + 1, z, ranges, range);
  for (int dy = -1; dy <= 1; dy++)
    ranges = add_row(s, x - 1, x + 1, y + dy, z + 1, ranges, range);
  bool ok = true;
  for (uint32_t i = own.first; ok && i < own.end; i++) {
    ok = scan(s, i, &own, i + 1, near);
    for (uint32_t k = 0; ok && k < ranges; k++)
      ok = scan(s, i, &range[k], range[k].first, near);
  }
  return ok;
}

bool near_find(const struct near_search *s)
{
  const int *edge = s->model->box.cells;
  struct near near;
  bool ok = true;
  near.n = 0;
  for (int z = 0; z < edge[2]; z++)
    for (int y = 0; y < edge[1]; y++)
      for (int x = 0; ok && x < edge[0]; x++)
        ok = search_cell(s, x, y, z, &near);
  return ok && visit(s, near.a, near.b, near.n);
}
