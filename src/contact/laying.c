#include "contact/laying.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "contact/capsule.h"
#include "contact/tube.h"

enum { MOST_CELLS = 64, FIRST_ENTRIES = 1024 }; /* along an edge; room at first */

bool laying_begin(struct laying *l, const struct model *m)
{
  size_t cells = 1;
  *l = (struct laying){.model = m};
  for (int k = 0; k < 3; k++) {
    l->cells[k] = 1; /* a power of two divides every edge */
    while (2 * l->cells[k] <= m->box.cells[k] && l->cells[k] < MOST_CELLS)
      l->cells[k] *= 2;
    l->edge[k] = m->box.edge[k] / l->cells[k];
    cells *= (size_t)l->cells[k];
  }
  l->first = memory_alloc(cells, sizeof *l->first);
  return l->first;
}

void laying_end(struct laying *l)
{
  free(l->first);
  free(l->at);
  memset(l, 0, sizeof *l);
}

/* --- cells -------------------------------------------------------------------------------------------------------- */

/* The cells that a tube's box touches along each axis, from the first to the last, not wrapped. */
struct cells {
  int64_t from[3], to[3];
};

static struct cells cells_of(const struct laying *l, const struct point *position, uint32_t bond)
{
  const struct point a = position[bond], b = position[l->model->next[bond]];
  const int64_t reach = l->model->thickness / 2 + 1,
                low[3] = {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z},
                high[3] = {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
  struct cells c;
  for (int k = 0; k < 3; k++) {
    c.from[k] = lattice_image(low[k] - reach, l->edge[k]);
    c.to[k] = lattice_image(high[k] + reach, l->edge[k]);
  }
  return c;
}

/* Wraps a cell. image: how many box edges it is away. */
static uint32_t wrap(const struct laying *l, const int64_t cell[3], int32_t image[3])
{
  int64_t number = 0;
  for (int k = 2; k >= 0; k--) {
    image[k] = (int32_t)lattice_image(cell[k], l->cells[k]);
    number = number * l->cells[k] + (cell[k] - (int64_t)image[k] * l->cells[k]);
  }
  return (uint32_t)number;
}

/* The next cell; false after the last. */
static bool step_on(const struct cells *c, int64_t cell[3])
{
  for (int k = 0; k < 3; k++) {
    if (cell[k]++ < c->to[k])
      return true;
    cell[k] = c->from[k];
  }
  return false;
}

/* --- bonds -------------------------------------------------------------------------------------------------------- */

/* Thin bonds that stand do not touch, exactly. */
static bool lines_apart(const struct flight_pair *standing)
{
  return flight_excluded(standing, 0, 1);
}

/* Bonds that never meet each other, whether or not they touch. image: of another image of the box. */
static bool never_meet(const struct model *m, uint32_t bond, uint32_t other, bool image)
{
  if (model_reach(m, bond, other) > 0)
    return bond == other || (!image && model_tube_is_blind(m, bond, other));
  return !laying_minds_lines(m) || model_is_flat(m) || model_share_vertex(m, bond, other) ||
         (model_bond_stands(m, bond) && model_bond_stands(m, other));
}

/* A bond against an entry of a cell of its own, in which it is this image of itself. */
static bool overlaps(struct laying *l, const struct point *position, uint32_t bond, const int32_t image[3],
                     const struct laying_entry *e)
{
  const struct model *m = l->model;
  const int32_t its[3] = {image[0] - e->image[0], image[1] - e->image[1], image[2] - e->image[2]};
  const int64_t reach = model_reach(m, bond, e->bond);
  if (never_meet(m, bond, e->bond, its[0] || its[1] || its[2]))
    return false;
  const struct point at = position[bond], other = position[e->bond];
  const struct flight_pair pair = {.p = point_minus(position[m->next[bond]], at),
                                   .q = point_minus(position[m->next[e->bond]], other),
                                   .w = point_minus(point_image(other, its, &m->box), at)};
  if (reach > 0 ? tube_excluded(&pair, reach, 0, 0) : (its[1] && model_has_walls(m)) || lines_apart(&pair))
    return false;
  l->bond = bond, l->other = e->bond;
  l->distance = capsule_distance(point_in_a0(pair.p), point_in_a0(pair.q), point_in_a0(pair.w));
  return true;
}

static bool enter(struct laying *l, uint32_t bond, uint32_t cell, const int32_t image[3])
{
  if (l->count == l->room && !memory_double((void **)&l->at, &l->room, FIRST_ENTRIES, sizeof *l->at))
    return false;
  l->at[l->count] = (struct laying_entry){bond, cell, {image[0], image[1], image[2]}, l->first[cell]};
  l->first[cell] = ++l->count;
  return true;
}

static enum laying_answer add_bond(struct laying *l, const struct point *position, uint32_t bond)
{
  const struct cells c = cells_of(l, position, bond);
  int64_t cell[3] = {c.from[0], c.from[1], c.from[2]};
  do {
    int32_t image[3];
    const uint32_t at = wrap(l, cell, image);
    for (uint32_t e = l->first[at]; e; e = l->at[e - 1].next)
      if (overlaps(l, position, bond, image, &l->at[e - 1]))
        return LAYING_OVERLAPS;
    if (!enter(l, bond, at, image))
      return LAYING_NO_MEMORY;
  } while (step_on(&c, cell));
  return LAYING_FITS;
}

enum laying_answer laying_add(struct laying *l, const struct point *position, uint32_t fiber)
{
  const struct model *m = l->model;
  const uint32_t mark = l->count;
  enum laying_answer answer = LAYING_FITS;
  for (uint32_t j = m->fiber_first[fiber]; answer == LAYING_FITS && j < m->fiber_first[fiber + 1]; j++)
    if (m->next[j] >= 0)
      answer = add_bond(l, position, j);
  while (answer != LAYING_FITS && l->count > mark) { /* the last entry of a cell is its first */
    const struct laying_entry *e = &l->at[--l->count];
    l->first[e->cell] = e->next;
  }
  return answer;
}
