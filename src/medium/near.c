/*
 * All pairs of members nearer than 1 a0, each once: those within a cell, and those between a cell and the half of its
 * 26 neighbors that come after it. Cells along x follow each other in memory, so that half is the cell to the right and
 * four rows of three. Differences of places are exact, so that distances do not depend on which member is the first.
 */
#include "medium/near.h"

#include <math.h>
#include <string.h>

#include "base/registers.h"

enum { BLOCK = NEAR_BLOCK, MOST_RANGES = 10, AROUND = 512 };

/* Members side by side, with the image of theirs that is meant. */
struct range {
  uint32_t first, end;
  struct vec3 shift;
};

/* Pairs that are near and wait for a block to be full. */
struct near {
  uint32_t n;
  uint32_t a[2 * BLOCK], b[2 * BLOCK];
  double x[2 * BLOCK], y[2 * BLOCK], z[2 * BLOCK];
};

/* A cell's own members, and then those of the ranges, each where its image stands: exact. */
struct around {
  uint32_t n, ranges, end[MOST_RANGES]; /* end of each range here */
  double x[AROUND + LANES], y[AROUND + LANES], z[AROUND + LANES];
  uint32_t place[AROUND + LANES];
};

/* Shows the last n pairs to the visitor. */
static bool visit(const struct near_search *s, struct near *near, uint32_t n)
{
  struct near_pairs p;
  const uint32_t first = near->n -= n;
  p.n = n;
  memcpy(p.a, &near->a[first], n * sizeof *p.a);
  memcpy(p.b, &near->b[first], n * sizeof *p.b);
  memcpy(p.x, &near->x[first], n * sizeof *p.x);
  memcpy(p.y, &near->y[first], n * sizeof *p.y);
  memcpy(p.z, &near->z[first], n * sizeof *p.z);
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

/* --- a neighborhood ------------------------------------------------------------------------------------------------
 */

static void copy_range(const struct medium *m, const struct range *range, struct around *around)
{
  const uint32_t n = range->end - range->first, at = around->n;
  const double *x = &m->x[range->first], *y = &m->y[range->first], *z = &m->z[range->first];
  for (uint32_t k = 0; k < n; k++) {
    around->x[at + k] = x[k] + range->shift.x;
    around->y[at + k] = y[k] + range->shift.y;
    around->z[at + k] = z[k] + range->shift.z;
    around->place[at + k] = range->first + k;
  }
  around->n = at + n;
}

/* Lists those of around[first .. n) that are near the point. There is room for LANES more. */
static uint32_t list_near(const struct around *around, struct vec3 at, uint32_t first, uint32_t list[])
{
  const words number = lane_numbers();
  uint32_t near = 0;
  for (uint32_t k = first; k < around->n; k += LANES) {
    const reals x = load_reals(&around->x[k]) - at.x, y = load_reals(&around->y[k]) - at.y,
                z = load_reals(&around->z[k]) - at.z;
    const reals square = x * x + y * y + z * z;
    const wholes is_near = (square < 1.0) & (square > 0.0); /* no line joins two members at one place */
    near = append(list, near, number + k, (words)is_near);
  }
  while (near > 0 && list[near - 1] >= around->n) /* what stands after the last one */
    near--;
  return near;
}

static void add_pairs(const struct around *around, uint32_t i, const uint32_t *list, uint32_t n, struct near *near)
{
  const double x = around->x[i], y = around->y[i], z = around->z[i];
  for (uint32_t k = 0; k < n; k++) {
    const uint32_t other = list[k];
    near->a[near->n + k] = around->place[i];
    near->b[near->n + k] = around->place[other];
    near->x[near->n + k] = x - around->x[other];
    near->y[near->n + k] = y - around->y[other];
    near->z[near->n + k] = z - around->z[other];
  }
  near->n += n;
}

/* Pieces of at most BLOCK of each range end blocks, so that sums over pairs have one order: for member i of a cell. */
static bool append_pieces(const struct near_search *s, const struct around *around, uint32_t i, const uint32_t *list,
                          uint32_t n, struct near *near)
{
  uint32_t first = i + 1;
  for (uint32_t k = 0; k < around->ranges; k++)
    while (first < around->end[k]) {
      const uint32_t end = around->end[k] - first < BLOCK ? around->end[k] : first + BLOCK;
      uint32_t some = 0;
      while (some < n && list[some] < end)
        some++;
      add_pairs(around, i, list, some, near);
      if (near->n >= BLOCK && !visit(s, near, BLOCK))
        return false;
      list += some;
      n -= some;
      first = end;
    }
  return true;
}

static bool search_around(const struct near_search *s, const struct around *around, struct near *near)
{
  uint32_t list[AROUND + LANES];
  for (uint32_t i = 0; i < around->end[0]; i++) {
    const uint32_t n = list_near(around, (struct vec3){around->x[i], around->y[i], around->z[i]}, i + 1, list);
    if (near->n + n < BLOCK)
      add_pairs(around, i, list, n, near);
    else if (!append_pieces(s, around, i, list, n, near))
      return false;
  }
  return true;
}

/* --- the same for a neighborhood of any size -----------------------------------------------------------------------
 */

/* Lists the members of a part of a range that are near member i, and shows blocks that are full. */
static bool scan_piece(const struct near_search *s, uint32_t i, struct vec3 shift, uint32_t first, uint32_t n,
                       struct near *near)
{
  const struct medium *m = s->medium;
  const double xi = m->x[i] - shift.x, yi = m->y[i] - shift.y, zi = m->z[i] - shift.z;
  for (uint32_t k = first; k < first + n; k++) {
    const double x = xi - m->x[k], y = yi - m->y[k], z = zi - m->z[k], square = x * x + y * y + z * z;
    near->a[near->n] = i;
    near->b[near->n] = k;
    near->x[near->n] = x;
    near->y[near->n] = y;
    near->z[near->n] = z;
    near->n += (square < 1.0) & (square > 0.0);
  }
  return near->n < BLOCK || visit(s, near, BLOCK);
}

static bool scan(const struct near_search *s, uint32_t i, const struct range *range, uint32_t first, struct near *near)
{
  for (; first < range->end; first += BLOCK) {
    const uint32_t n = range->end - first < BLOCK ? range->end - first : BLOCK;
    if (!scan_piece(s, i, range->shift, first, n, near))
      return false;
  }
  return true;
}

static bool search_ranges(const struct near_search *s, const struct range *range, uint32_t ranges, struct near *near)
{
  bool ok = true;
  for (uint32_t i = range->first; ok && i < range->end; i++)
    for (uint32_t k = 0; ok && k < ranges; k++)
      ok = scan(s, i, &range[k], k == 0 ? i + 1 : range[k].first, near);
  return ok;
}

/* --- all cells ----------------------------------------------------------------------------------------------------
 */

static bool search_cell(const struct near_search *s, int x, int y, int z, struct around *around, struct near *near)
{
  const int *edge = s->model->box.cells;
  const uint32_t cell = (uint32_t)((z * edge[1] + y) * edge[0] + x);
  struct range range[MOST_RANGES] = {{s->medium->first[cell], s->medium->first[cell + 1], {0, 0, 0}}};
  uint32_t ranges = add_row(s, x + 1, x + 1, y, z, 1, range), n = 0;
  if (range[0].first == range[0].end)
    return true;
  ranges = add_row(s, x - 1, x + 1, y + 1, z, ranges, range);
  for (int dy = -1; dy <= 1; dy++)
    ranges = add_row(s, x - 1, x + 1, y + dy, z + 1, ranges, range);
  for (uint32_t k = 0; k < ranges; k++)
    n += range[k].end - range[k].first;
  if (s->plain || n > AROUND)
    return search_ranges(s, range, ranges, near);
  around->n = 0;
  around->ranges = ranges;
  for (uint32_t k = 0; k < ranges; k++) {
    copy_range(s->medium, &range[k], around);
    around->end[k] = around->n;
  }
  return search_around(s, around, near);
}

bool near_find(const struct near_search *s)
{
  const int *edge = s->model->box.cells;
  struct around around = {.n = 0};
  struct near near;
  bool ok = true;
  near.n = 0;
  for (int z = 0; z < edge[2]; z++)
    for (int y = 0; y < edge[1]; y++)
      for (int x = 0; ok && x < edge[0]; x++)
        ok = search_cell(s, x, y, z, &around, &near);
  return ok && visit(s, &near, near.n);
}
