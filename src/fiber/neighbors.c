#include "fiber/neighbors.h"

#include <stdlib.h>
#include <string.h>

#include "fiber/capsule.h"

#define MARGIN_A0 0.10     /* measured: see docs/accuracy.md; results do not depend on it */
#define SEARCH_CELL_A0 1.0 /* least edge of a search cell */
#define FIRST_ROOM 4       /* of a row */

/* --- capsules ---------------------------------------------------------------------------------------------------- */

/* Where a bond may be before an end of it takes a new anchor. */
static inline struct capsule capsule_of(const struct neighbors *nb, const struct model *model, uint32_t bond,
                                        struct point origin)
{
  const struct anchor *a = &nb->anchor[bond], *b = &nb->anchor[model->next[bond]];
  return (struct capsule){point_difference(a->at, origin), point_difference(b->at, origin),
                          capsule_most(a->reach, b->reach)};
}

/* --- lists ------------------------------------------------------------------------------------------------------- */

static bool add(struct neighbor_row *row, struct neighbor n)
{
  if (row->count == row->room) {
    const uint32_t room = row->room ? 2 * row->room : FIRST_ROOM;
    struct neighbor *bigger = realloc(row->at, room * sizeof *bigger);
    if (!bigger)
      return false;
    row->at = bigger;
    row->room = room;
  }
  row->at[row->count++] = n;
  return true;
}

static void take_out(struct neighbor_row *row, struct neighbor n)
{
  uint32_t k = 0;
  while (k < row->count && memcmp(&row->at[k], &n, sizeof n) != 0)
    k++;
  if (k < row->count)
    row->at[k] = row->at[--row->count];
}

static struct neighbor mirrored(uint32_t bond, const int32_t image[3])
{
  return (struct neighbor){(int32_t)bond, {-image[0], -image[1], -image[2]}};
}

/* Empties the list of a bond, and takes it off the lists of its partners. */
static void leave_partners(struct neighbors *nb, uint32_t bond)
{
  struct neighbor_row *row = &nb->partners[bond];
  while (row->count > 0) {
    const struct neighbor last = row->at[--row->count];
    take_out(&nb->partners[last.bond], mirrored(bond, last.image));
  }
}

/* --- grid -------------------------------------------------------------------------------------------------------- */

/* A search cell: its number, its unwrapped coordinates, and the image that these are of it. */
struct grid_place {
  uint32_t cell;
  int64_t at[3];
  int32_t image[3];
};

/* The search cells along one axis that an interval touches: the first, unwrapped and wrapped, its image, and how many.
 */
struct cell_span {
  int64_t at;
  int32_t first, image, count;
};

static struct cell_span span_of(int64_t low, int64_t high, int64_t edge, int32_t cells)
{
  const int64_t at = lattice_image(low, edge), image = lattice_image(at, cells);
  return (struct cell_span){at, (int32_t)(at - image * cells), (int32_t)image,
                            (int32_t)(lattice_image(high, edge) - at) + 1};
}

/* The box around a bond's capsule, in lattice units. */
struct capsule_box {
  struct point low, high;
};

static struct capsule_box box_of(const struct neighbors *nb, const struct model *model, uint32_t bond)
{
  const struct anchor *p = &nb->anchor[bond], *q = &nb->anchor[model->next[bond]];
  const struct point a = p->at, b = q->at;
  const int64_t reach = lattice_from_a0(capsule_most(p->reach, q->reach) + CAPSULE_SLACK);
  return (struct capsule_box){
      {(a.x < b.x ? a.x : b.x) - reach, (a.y < b.y ? a.y : b.y) - reach, (a.z < b.z ? a.z : b.z) - reach},
      {(a.x > b.x ? a.x : b.x) + reach, (a.y > b.y ? a.y : b.y) + reach, (a.z > b.z ? a.z : b.z) + reach}};
}

/* Something done with a bond in one cell. */
typedef bool visit(struct neighbors *, const struct model *, uint32_t bond, const struct capsule *,
                   const struct grid_place *);

/* All cells that the box around a bond's capsule touches. */
static bool visit_cells(struct neighbors *nb, const struct model *model, uint32_t bond, visit *what)
{
  const struct capsule mine = capsule_of(nb, model, bond, nb->anchor[bond].at);
  const struct capsule_box box = box_of(nb, model, bond);
  const struct cell_span x = span_of(box.low.x, box.high.x, nb->cell_edge[0], nb->cells[0]),
                         y = span_of(box.low.y, box.high.y, nb->cell_edge[1], nb->cells[1]),
                         z = span_of(box.low.z, box.high.z, nb->cell_edge[2], nb->cells[2]);
  for (int32_t k = z.first, iz = z.image, nz = z.count; nz > 0; nz--) {
    for (int32_t j = y.first, iy = y.image, ny = y.count; ny > 0; ny--) {
      for (int32_t i = x.first, ix = x.image, nx = x.count; nx > 0; nx--) {
        const struct grid_place place = {(uint32_t)((k * nb->cells[1] + j) * nb->cells[0] + i),
                                         {x.at + x.count - nx, y.at + y.count - ny, z.at + z.count - nz},
                                         {ix, iy, iz}};
        if (!what(nb, model, bond, &mine, &place))
          return false;
        if (++i == nb->cells[0])
          i = 0, ix++;
      }
      if (++j == nb->cells[1])
        j = 0, iy++;
    }
    if (++k == nb->cells[2])
      k = 0, iz++;
  }
  return true;
}

static bool enter_cell(struct neighbors *nb, const struct model *model, uint32_t bond, const struct capsule *mine,
                       const struct grid_place *place)
{
  (void)model, (void)mine;
  return add(&nb->entries[place->cell],
             (struct neighbor){(int32_t)bond, {place->image[0], place->image[1], place->image[2]}});
}

static bool leave_cell(struct neighbors *nb, const struct model *model, uint32_t bond, const struct capsule *mine,
                       const struct grid_place *place)
{
  (void)model, (void)mine;
  take_out(&nb->entries[place->cell],
           (struct neighbor){(int32_t)bond, {place->image[0], place->image[1], place->image[2]}});
  return true;
}

static bool share_vertex(const struct model *model, uint32_t a, uint32_t b)
{
  return a == b || model->next[a] == (int32_t)b || model->next[b] == (int32_t)a;
}

/* Is this the cell that holds the lower corner of the overlap of two boxes, the second in an image? */
static bool corner_is_here(const struct neighbors *nb, const struct grid_place *place, struct point low,
                           struct point other)
{
  return lattice_image(low.x > other.x ? low.x : other.x, nb->cell_edge[0]) == place->at[0] &&
         lattice_image(low.y > other.y ? low.y : other.y, nb->cell_edge[1]) == place->at[1] &&
         lattice_image(low.z > other.z ? low.z : other.z, nb->cell_edge[2]) == place->at[2];
}

/* Adds to the lists all partners of a bond that are entered in this cell. A pair that meets in several cells is taken
 * in the one that holds the lower corner of the overlap of their boxes. */
static bool search_cell(struct neighbors *nb, const struct model *model, uint32_t bond, const struct capsule *mine,
                        const struct grid_place *place)
{
  const struct neighbor_row *row = &nb->entries[place->cell];
  for (uint32_t k = 0; k < row->count; k++) {
    const struct neighbor *e = &row->at[k];
    const uint32_t other = (uint32_t)e->bond;
    if (share_vertex(model, bond, other))
      continue;
    const struct neighbor found = {
        e->bond, {place->image[0] - e->image[0], place->image[1] - e->image[1], place->image[2] - e->image[2]}};
    const int32_t back[3] = {-found.image[0], -found.image[1], -found.image[2]};
    const struct capsule its = capsule_of(nb, model, other, point_image(nb->anchor[bond].at, back, &model->box));
    if (capsules_apart(mine, &its) ||
        !corner_is_here(nb, place, box_of(nb, model, bond).low,
                        point_image(box_of(nb, model, other).low, found.image, &model->box)))
      continue;
    if (!add(&nb->partners[bond], found) || !add(&nb->partners[other], mirrored(bond, found.image)))
      return false;
  }
  return true;
}

static bool enter(struct neighbors *nb, const struct model *model, uint32_t bond)
{
  return visit_cells(nb, model, bond, search_cell) && visit_cells(nb, model, bond, enter_cell);
}

static void leave(struct neighbors *nb, const struct model *model, uint32_t bond)
{
  leave_partners(nb, bond);
  visit_cells(nb, model, bond, leave_cell);
}

/* --- the two entrances ------------------------------------------------------------------------------------------- */

static bool short_of_memory(const struct state *state, struct work *work, uint32_t bond)
{
  return work_fault(work, FAULT_NO_MEMORY, state->step + 1, bond, 0.0, 0.0);
}

/* Both ends of a move are within reach of its anchor, whether it is made or refused. */
static struct anchor anchor_of_move(const struct neighbors *nb, struct point from, struct point to)
{
  const struct point d = {to.x - from.x, to.y - from.y, to.z - from.z}, moved = nb->moved;
  const double length = vec3_norm(point_difference(to, from));
  struct point at = {to.x - moved.x, to.y - moved.y, to.z - moved.z};
  if (length > nb->margin) /* from its middle */
    at = (struct point){at.x - d.x / 2, at.y - d.y / 2, at.z - d.z / 2};
  return (struct anchor){at, fmax(nb->margin, 0.5 * length + LATTICE_UNIT)};
}

bool neighbors_renew(const struct state *state, const struct model *model, struct work *work, uint32_t vertex,
                     struct point to)
{
  struct neighbors *nb = &work->fiber.neighbors;
  const int32_t before = model->prev[vertex], after = model->next[vertex] >= 0 ? (int32_t)vertex : -1;
  if (before >= 0)
    leave(nb, model, (uint32_t)before);
  if (after >= 0)
    leave(nb, model, (uint32_t)after);
  nb->anchor[vertex] = anchor_of_move(nb, state->position[vertex], to);
  nb->renewed++;
  return ((before < 0 || enter(nb, model, (uint32_t)before)) && (after < 0 || enter(nb, model, (uint32_t)after))) ||
         short_of_memory(state, work, vertex);
}

/* Search cells divide the box edges exactly; there are no more than bonds to put in, or so. */
static void choose_grid(const struct model *model, struct neighbors *nb)
{
  const double edge = fmax(SEARCH_CELL_A0, cbrt(box_volume(&model->box) / (double)model->bonds));
  for (int k = 0; k < 3; k++) {
    int cells = (int)fmax(1.0, model->box.cells[k] / edge);
    while (model->box.cells[k] % cells != 0)
      cells--;
    nb->cells[k] = cells;
    nb->cell_edge[k] = model->box.edge[k] / cells;
  }
  nb->cell_count = (uint32_t)(nb->cells[0] * nb->cells[1] * nb->cells[2]);
}

static bool allocate(const struct model *model, struct neighbors *nb)
{
  if (nb->anchor)
    return true;
  choose_grid(model, nb);
  nb->margin = MARGIN_A0;
  nb->bonds = model->vertices;
  nb->anchor = aligned_alloc(64, (model->vertices * sizeof *nb->anchor + 63) / 64 * 64);
  nb->partners = calloc(nb->bonds, sizeof *nb->partners);
  nb->entries = calloc(nb->cell_count, sizeof *nb->entries);
  return nb->anchor && nb->partners && nb->entries;
}

bool neighbors_build(const struct state *state, const struct model *model, struct work *work)
{
  struct neighbors *nb = &work->fiber.neighbors;
  if (!allocate(model, nb))
    return short_of_memory(state, work, 0);
  for (uint32_t j = 0; j < nb->bonds; j++)
    nb->partners[j].count = 0;
  for (uint32_t c = 0; c < nb->cell_count; c++)
    nb->entries[c].count = 0;
  for (uint32_t j = 0; j < model->vertices; j++)
    nb->anchor[j] = (struct anchor){state->position[j], nb->margin};
  for (uint32_t j = 0; j < model->vertices; j++)
    if (model->next[j] >= 0 && !enter(nb, model, j))
      return short_of_memory(state, work, j);
  nb->moved = (struct point){0, 0, 0};
  nb->built = true;
  return true;
}
