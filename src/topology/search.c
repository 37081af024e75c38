/*
 * Each bond is taken once into the box, where its first vertex is at the first frame; then all images of it are laid
 * out whose swept boxes reach into the space that the swept boxes of these bonds fill. So no image is left out,
 * whatever the size of box and moves, and no pair comes twice: of bonds i < j, i stands in the box; of a bond and its
 * own image, the image with the greater numbers. Cells find the overlaps: a pair is looked at in the cell where its
 * common part begins.
 */
#include "topology/search.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* What a bond sweeps, in the image with these numbers. */
struct swept {
  int64_t low[3], high[3]; /* the corners */
  int64_t image[3];
  uint32_t bond;
  bool own; /* in the box, not an image of it */
};

struct grid {
  int64_t low[3], cell[3];
  int cells[3];
};

static struct point shift(const struct interval *v, int frame, const int64_t n[3])
{
  return (struct point){n[0] * v->edge[frame][0] + n[1] * v->offset[frame], n[1] * v->edge[frame][1],
                        n[2] * v->edge[frame][2]};
}

static struct point sum(struct point a, struct point b)
{
  return (struct point){a.x + b.x, a.y + b.y, a.z + b.z};
}

static struct vec3 difference(struct point a, struct point b)
{
  return (struct vec3){(double)(a.x - b.x), (double)(a.y - b.y), (double)(a.z - b.z)};
}

static int64_t floored(int64_t value, int64_t edge)
{
  return value / edge - (value % edge < 0);
}

/* What the bond sweeps in the image; a margin of `near` is around it. */
static struct swept sweep(const struct interval *v, uint32_t bond, const int64_t image[3])
{
  const int64_t margin = (int64_t)v->near;
  struct swept s = {.low = {INT64_MAX, INT64_MAX, INT64_MAX}, .high = {INT64_MIN, INT64_MIN, INT64_MIN}, .bond = bond};
  memcpy(s.image, image, sizeof s.image);
  for (int k = 0; k < 4; k++) {
    const struct point x = sum(v->position[k & 1][v->bond[bond][k >> 1]], shift(v, k & 1, image));
    const int64_t at[3] = {x.x, x.y, x.z};
    for (int axis = 0; axis < 3; axis++) {
      s.low[axis] = at[axis] < s.low[axis] ? at[axis] : s.low[axis];
      s.high[axis] = at[axis] + margin > s.high[axis] ? at[axis] + margin : s.high[axis];
    }
  }
  return s;
}

static bool overlap(const struct swept *a, const struct swept *b)
{
  return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] && b->low[1] <= a->high[1] &&
         a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

static bool slides_within_reach(const struct interval *v, int64_t image)
{
  const double slide = fmax(fabs((double)v->offset[0]), fabs((double)v->offset[1]));
  return fabs((double)image) * slide < (double)SEARCH_REACH;
}

/* The image of a bond that has its first vertex in the box. False if the slide of the images would take it out of
 * reach. */
static bool home(const struct interval *v, uint32_t bond, int64_t image[3])
{
  struct point x = v->position[0][v->bond[bond][0]];
  image[2] = v->periodic[2] ? -floored(x.z, v->edge[0][2]) : 0;
  image[1] = v->periodic[1] ? -floored(x.y, v->edge[0][1]) : 0;
  if (!slides_within_reach(v, image[1]))
    return false;
  x.x += image[1] * v->offset[0];
  image[0] = v->periodic[0] ? -floored(x.x, v->edge[0][0]) : 0;
  return true;
}

/* --- images ------------------------------------------------------------------------------------------------------ */

/* Numbers of images along an axis, at least those with which what is from low to high reaches into the space. */
static void reach(const struct interval *v, int axis, int64_t low, int64_t high, const struct swept *space,
                  int64_t number[2])
{
  number[0] = number[1] = 0;
  if (!v->periodic[axis])
    return;
  const int64_t a = v->edge[0][axis], b = v->edge[1][axis], least = a < b ? a : b, most = a < b ? b : a;
  const int64_t below = high - space->low[axis], above = space->high[axis] - low;
  number[0] = -floored(below, below < 0 ? most : least);
  number[1] = floored(above, above < 0 ? most : least);
}

/* Adds the images of a bond in the box. */
static enum search_verdict add_images(struct search *search, const struct interval *v, const struct swept *space,
                                      const struct swept *own, uint32_t *boxes)
{
  int64_t x[2], y[2], z[2];
  reach(v, 2, own->low[2], own->high[2], space, z);
  reach(v, 1, own->low[1], own->high[1], space, y);
  if (y[1] - y[0] >= (int64_t)SEARCH_MOST_BOXES(v->bonds) || !slides_within_reach(v, y[0]) ||
      !slides_within_reach(v, y[1]))
    return SEARCH_TOO_FAR;
  for (int64_t ny = y[0]; ny <= y[1]; ny++) {
    const int64_t first = ny * v->offset[0], last = ny * v->offset[1];
    reach(v, 0, own->low[0] + (first < last ? first : last), own->high[0] + (first < last ? last : first), space, x);
    if ((double)(x[1] - x[0] + 1) * (double)(z[1] - z[0] + 1) > (double)SEARCH_MOST_BOXES(v->bonds))
      return SEARCH_TOO_FAR;
    for (int64_t nz = z[0]; nz <= z[1]; nz++)
      for (int64_t nx = x[0]; nx <= x[1]; nx++) {
        if (nx == 0 && ny == 0 && nz == 0)
          continue;
        const int64_t image[3] = {own->image[0] + nx, own->image[1] + ny, own->image[2] + nz};
        const struct swept s = sweep(v, own->bond, image);
        if (!overlap(&s, space))
          continue;
        if (*boxes >= SEARCH_MOST_BOXES(v->bonds))
          return SEARCH_TOO_FAR;
        if (*boxes == search->room && !memory_double((void **)&search->box, &search->room, 1024, sizeof *search->box))
          return SEARCH_NO_MEMORY;
        search->box[(*boxes)++] = s;
      }
  }
  return SEARCH_DONE;
}

/* All bonds in the box, then their images. */
static enum search_verdict lay_out(struct search *search, const struct interval *v, struct swept *space,
                                   uint32_t *boxes)
{
  if (!memory_room((void **)&search->box, &search->room, v->bonds, sizeof *search->box))
    return SEARCH_NO_MEMORY;
  for (uint32_t k = 0; k < v->bonds; k++) {
    int64_t image[3];
    if (!home(v, k, image))
      return SEARCH_TOO_FAR;
    search->box[k] = sweep(v, k, image);
    search->box[k].own = true;
    for (int axis = 0; axis < 3; axis++) {
      const int64_t low = search->box[k].low[axis], high = search->box[k].high[axis];
      space->low[axis] = k == 0 || low < space->low[axis] ? low : space->low[axis];
      space->high[axis] = k == 0 || high > space->high[axis] ? high : space->high[axis];
    }
  }
  *boxes = v->bonds;
  for (uint32_t k = 0; k < v->bonds; k++) {
    const struct swept own = search->box[k];
    const enum search_verdict verdict = add_images(search, v, space, &own, boxes);
    if (verdict != SEARCH_DONE)
      return verdict;
  }
  return SEARCH_DONE;
}

/* --- cells ------------------------------------------------------------------------------------------------------- */

/* Cells of `wide` mean swept boxes, not many more than boxes. */
static struct grid make_grid(const struct search *search, const struct swept *space, uint32_t boxes, double wide)
{
  struct grid g;
  double size[3], cell[3], cells = 1.0;
  for (int axis = 0; axis < 3; axis++) {
    double mean = 0.0;
    for (uint32_t k = 0; k < boxes; k++)
      mean += (double)(search->box[k].high[axis] - search->box[k].low[axis]);
    g.low[axis] = space->low[axis];
    size[axis] = (double)(space->high[axis] - space->low[axis]) + 1.0;
    cell[axis] = wide * mean / boxes + 1.0;
    cells *= size[axis] / cell[axis] + 1.0;
  }
  const double larger = cells > 4.0 * boxes ? cbrt(cells / (4.0 * boxes)) : 1.0;
  for (int axis = 0; axis < 3; axis++) {
    const double many = fmin(size[axis] / (cell[axis] * larger), 4.0 * boxes / 8.0);
    g.cells[axis] = many < 1.0 ? 1 : many > 1000.0 ? 1000 : (int)many;
    g.cell[axis] = (int64_t)(size[axis] / g.cells[axis]) + 1;
  }
  return g;
}

static int cell_along(const struct grid *g, int axis, int64_t at)
{
  const int64_t cell = at <= g->low[axis] ? 0 : (at - g->low[axis]) / g->cell[axis];
  return cell < g->cells[axis] ? (int)cell : g->cells[axis] - 1;
}

static uint32_t cell_number(const struct grid *g, int x, int y, int z)
{
  return (uint32_t)((z * g->cells[1] + y) * g->cells[0] + x);
}

struct span {
  int low[3], high[3];
};

static struct span cells_of(const struct grid *g, const struct swept *s)
{
  struct span span;
  for (int axis = 0; axis < 3; axis++) {
    span.low[axis] = cell_along(g, axis, s->low[axis]);
    span.high[axis] = cell_along(g, axis, s->high[axis]);
  }
  return span;
}

/* Counts the boxes of each cell into first[cell + 2]; or, with `entry`, enters them from first[cell + 1] on. */
static uint64_t enter(const struct search *search, const struct grid *g, uint32_t boxes, uint32_t *entry)
{
  uint64_t entries = 0;
  for (uint32_t k = 0; k < boxes; k++) {
    const struct span c = cells_of(g, &search->box[k]);
    for (int z = c.low[2]; z <= c.high[2]; z++)
      for (int y = c.low[1]; y <= c.high[1]; y++)
        for (int x = c.low[0]; x <= c.high[0]; x++, entries++) {
          uint32_t *const first = &search->first[cell_number(g, x, y, z)];
          if (entry)
            entry[first[1]++] = k;
          else
            first[2]++;
        }
  }
  return entries;
}

/* Entries of cell c are then from first[c] to first[c + 1]. */
static bool fill(struct search *search, const struct swept *space, uint32_t boxes, struct grid *g)
{
  uint64_t entries;
  double wide = 1.5;
  do {
    *g = make_grid(search, space, boxes, wide);
    const uint32_t cells = cell_number(g, g->cells[0] - 1, g->cells[1] - 1, g->cells[2] - 1) + 1;
    if (!memory_room((void **)&search->first, &search->cells_room, cells + 2, sizeof *search->first))
      return false;
    memset(search->first, 0, (cells + 2) * sizeof *search->first);
    entries = enter(search, g, boxes, NULL);
    wide *= 2.0;
  } while (entries > 64 * (uint64_t)boxes && g->cells[0] * g->cells[1] * g->cells[2] > 1);
  if (entries > UINT32_MAX ||
      !memory_room((void **)&search->entry, &search->entry_room, (uint32_t)entries, sizeof *search->entry))
    return false;
  const uint32_t cells = cell_number(g, g->cells[0] - 1, g->cells[1] - 1, g->cells[2] - 1) + 1;
  for (uint32_t k = 0; k < cells; k++)
    search->first[k + 2] += search->first[k + 1];
  enter(search, g, boxes, search->entry);
  return true;
}

/* --- pairs ------------------------------------------------------------------------------------------------------- */

/* Which of a pair's two appearances counts: see above. */
static bool counts(const struct swept *a, const struct swept *b)
{
  if (a->bond != b->bond)
    return b->own || a->bond < b->bond;
  for (int axis = 0; axis < 3; axis++)
    if (a->image[axis] != b->image[axis])
      return a->image[axis] < b->image[axis];
  return false;
}

/* True if this cell is where the common part of both begins. */
static bool begins_here(const struct grid *g, const struct swept *a, const struct swept *b, const int cell[3])
{
  for (int axis = 0; axis < 3; axis++)
    if (cell_along(g, axis, a->low[axis] > b->low[axis] ? a->low[axis] : b->low[axis]) != cell[axis])
      return false;
  return true;
}

struct told {
  const struct interval *v;
  search_found *found;
  void *sink;
  uint64_t looked_at, near;
};

/* a: in the box. */
static void look_at(struct told *told, const struct swept *a, const struct swept *b)
{
  const struct interval *v = told->v;
  const uint32_t *i = v->bond[a->bond], *j = v->bond[b->bond];
  struct meeting c = {.bond = {a->bond, b->bond}};
  struct pair pair;
  struct crossing crossing[3];
  int crossings = 0;
  for (int axis = 0; axis < 3; axis++)
    c.image[axis] = b->image[axis] - a->image[axis];
  const bool same_image = c.image[0] == 0 && c.image[1] == 0 && c.image[2] == 0;
  /* Which ends they share: p and q begin there. */
  const int p = same_image && (i[1] == j[0] || i[1] == j[1]), q = same_image && (j[1] == i[0] || j[1] == i[1]);
  for (int t = 0; t < 2; t++) {
    const struct point *x = v->position[t], from = x[i[p]], moved = sum(x[j[q]], shift(v, t, c.image));
    pair.p[t] = difference(x[i[!p]], from);
    pair.q[t] = difference(x[j[!q]], x[j[q]]);
    pair.w[t] = difference(moved, from);
  }
  told->looked_at++;
  const bool shared = same_image && i[p] == j[q];
  told->near += !shared && told->v->near > 0.0 && pair_is_near(&pair, told->v->near);
  const enum pair_verdict verdict = shared ? pair_folds(&pair) : pair_decide(&pair, crossing, &crossings);
  if (verdict != PAIR_APART)
    told->found(told->sink, &c, verdict, crossing, crossings);
}

static void look_at_cell(struct told *told, const struct search *search, const struct grid *g, const int cell[3])
{
  const uint32_t number = cell_number(g, cell[0], cell[1], cell[2]);
  const uint32_t *first = &search->entry[search->first[number]], *end = &search->entry[search->first[number + 1]];
  for (const uint32_t *a = first; a < end && search->box[*a].own;
       a++) /* in the order of boxes: those in the box first */
    for (const uint32_t *b = a + 1; b < end; b++)
      if (overlap(&search->box[*a], &search->box[*b]) && counts(&search->box[*a], &search->box[*b]) &&
          begins_here(g, &search->box[*a], &search->box[*b], cell))
        look_at(told, &search->box[*a], &search->box[*b]);
}

enum search_verdict search_pairs(struct search *search, const struct interval *v, search_found *found, void *sink,
                                 uint64_t *looked_at, uint64_t *near)
{
  struct told told = {v, found, sink, 0, 0};
  struct swept space;
  struct grid g;
  uint32_t boxes;
  *looked_at = *near = 0;
  if (v->bonds == 0)
    return SEARCH_DONE;
  const enum search_verdict verdict = lay_out(search, v, &space, &boxes);
  if (verdict != SEARCH_DONE)
    return verdict;
  if (!fill(search, &space, boxes, &g))
    return SEARCH_NO_MEMORY;
  for (int z = 0; z < g.cells[2]; z++)
    for (int y = 0; y < g.cells[1]; y++)
      for (int x = 0; x < g.cells[0]; x++)
        look_at_cell(&told, search, &g, (int[]){x, y, z});
  *looked_at = told.looked_at;
  *near = told.near;
  return SEARCH_DONE;
}

void search_free(struct search *search)
{
  free(search->box);
  free(search->first);
  free(search->entry);
  *search = (struct search){0};
}

uint64_t search_bytes(uint32_t bonds)
{
  const uint64_t boxes = 2 * (uint64_t)bonds; /* bonds near the faces have images */
  return memory_taken(boxes * sizeof(struct swept)) + memory_taken(4 * boxes * sizeof(uint32_t)) +
         memory_taken(8 * boxes * sizeof(uint32_t));
}
