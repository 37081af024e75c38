#include "fiber/neighbors.h"

#include <stdlib.h>
#include <string.h>

#define MARGIN_A0 0.06     /* measured: see docs/accuracy.md; results do not depend on it */
#define SEARCH_CELL_A0 1.0 /* least edge of a search cell */
#define FIRST_STRIDE 8     /* partners per bond before the lists grow */

/* --- margin boxes ------------------------------------------------------------------------------------------------ */

static struct point lower(struct point a, struct point b)
{
  return (struct point){a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

static struct point upper(struct point a, struct point b)
{
  return (struct point){a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

/* The box around a bond and the point `to`, with the margin. */
static struct margin_box draw_box(const struct state *state, const struct model *model, const struct neighbors *nb,
                                  uint32_t bond, struct point to)
{
  struct point a = state->position[bond], b = state->position[model->next[bond]];
  struct margin_box box = {lower(lower(a, b), to), upper(upper(a, b), to)};
  const int64_t m = nb->margin;
  box.low = (struct point){box.low.x - m, box.low.y - m, box.low.z - m};
  box.high = (struct point){box.high.x + m, box.high.y + m, box.high.z + m};
  return box;
}

/* --- lists ------------------------------------------------------------------------------------------------------- */

static bool grow_lists(struct neighbors *nb, uint32_t bonds)
{
  uint32_t stride = 2 * nb->stride;
  struct neighbor *list = malloc((size_t)bonds * stride * sizeof *list);
  if (!list)
    return false;
  for (uint32_t j = 0; j < bonds; j++)
    memcpy(&list[(size_t)j * stride], &nb->list[(size_t)j * nb->stride], nb->count[j] * sizeof *list);
  free(nb->list);
  nb->list = list;
  nb->stride = stride;
  return true;
}

static bool add_partner(struct neighbors *nb, uint32_t bonds, uint32_t bond, struct neighbor partner)
{
  if (nb->count[bond] == nb->stride && !grow_lists(nb, bonds))
    return false;
  nb->list[(size_t)bond * nb->stride + nb->count[bond]++] = partner;
  return true;
}

static void remove_partner(struct neighbors *nb, uint32_t bond, struct neighbor partner)
{
  struct neighbor *list = &nb->list[(size_t)bond * nb->stride];
  for (uint32_t k = 0; k < nb->count[bond]; k++)
    if (memcmp(&list[k], &partner, sizeof partner) == 0) {
      list[k] = list[--nb->count[bond]];
      return;
    }
}

static struct neighbor mirrored(uint32_t bond, const int32_t image[3])
{
  return (struct neighbor){(int32_t)bond, {-image[0], -image[1], -image[2]}};
}

/* --- grid -------------------------------------------------------------------------------------------------------- */

/* The range of search cells that a margin box touches, in unwrapped cell coordinates. */
struct cell_range {
  int64_t low[3], high[3];
};

static struct cell_range range_of(const struct neighbors *nb, const struct margin_box *box)
{
  const int64_t low[3] = {box->low.x, box->low.y, box->low.z}, high[3] = {box->high.x, box->high.y, box->high.z};
  struct cell_range r;
  for (int k = 0; k < 3; k++) {
    r.low[k] = lattice_image(low[k], nb->cell_edge[k]);
    r.high[k] = lattice_image(high[k], nb->cell_edge[k]);
  }
  return r;
}

/* Cell number of an unwrapped cell coordinate, and the image that this coordinate is of it. */
static int32_t wrap_cell(const struct neighbors *nb, const int64_t at[3], int32_t image[3])
{
  int64_t c[3];
  for (int k = 0; k < 3; k++) {
    image[k] = (int32_t)lattice_image(at[k], nb->cells[k]);
    c[k] = at[k] - (int64_t)image[k] * nb->cells[k];
  }
  return (int32_t)((c[2] * nb->cells[1] + c[1]) * nb->cells[0] + c[0]);
}

static bool take_entry(struct neighbors *nb, int32_t *taken)
{
  if (nb->free_entry < 0) {
    int32_t more = nb->entries > 0 ? 2 * nb->entries : 64;
    struct grid_entry *entry = realloc(nb->entry, (size_t)more * sizeof *entry);
    if (!entry)
      return false;
    nb->entry = entry;
    for (int32_t k = nb->entries; k < more; k++)
      entry[k].next = k + 1 < more ? k + 1 : -1;
    nb->free_entry = nb->entries;
    nb->entries = more;
  }
  *taken = nb->free_entry;
  nb->free_entry = nb->entry[*taken].next;
  return true;
}

static bool enter_cell(struct neighbors *nb, uint32_t bond, const int64_t at[3])
{
  int32_t k, image[3], cell = wrap_cell(nb, at, image);
  if (!take_entry(nb, &k))
    return false;
  nb->entry[k] = (struct grid_entry){(int32_t)bond, nb->head[cell], {image[0], image[1], image[2]}};
  nb->head[cell] = k;
  return true;
}

static void leave_cell(struct neighbors *nb, uint32_t bond, const int64_t at[3])
{
  int32_t image[3];
  int32_t *link = &nb->head[wrap_cell(nb, at, image)];
  while (*link >= 0) {
    struct grid_entry *e = &nb->entry[*link];
    if (e->bond == (int32_t)bond && memcmp(e->image, image, sizeof image) == 0) {
      int32_t freed = *link;
      *link = e->next;
      e->next = nb->free_entry;
      nb->free_entry = freed;
      return;
    }
    link = &e->next;
  }
}

/* --- search ------------------------------------------------------------------------------------------------------ */

static bool share_vertex(const struct model *model, uint32_t a, uint32_t b)
{
  return a == b || model->next[a] == (int32_t)b || model->next[b] == (int32_t)a;
}

/* The lower corner of the overlap of a box with another one shifted by an image; false if they do not overlap. */
static bool overlap_corner(const struct margin_box *box, const struct margin_box *other, const int32_t image[3],
                           const struct box *periodic, struct point *corner)
{
  struct point low = point_image(other->low, image, periodic), high = point_image(other->high, image, periodic);
  *corner = upper(box->low, low);
  return low.x <= box->high.x && low.y <= box->high.y && low.z <= box->high.z && high.x >= box->low.x &&
         high.y >= box->low.y && high.z >= box->low.z;
}

/* Adds to the lists all partners of a bond that are entered in this cell. A pair that meets in several cells is taken
 * in the one that holds the lower corner of the overlap. */
static bool search_cell(struct neighbors *nb, const struct model *model, uint32_t bond, const int64_t at[3])
{
  int32_t here[3];
  for (int32_t k = nb->head[wrap_cell(nb, at, here)]; k >= 0; k = nb->entry[k].next) {
    const struct grid_entry *e = &nb->entry[k];
    uint32_t other = (uint32_t)e->bond; // NOLINT(clang-analyzer-core.NullDereference): no entries, no heads
    if (share_vertex(model, bond, other))
      continue;
    const int32_t image[3] = {here[0] - e->image[0], here[1] - e->image[1], here[2] - e->image[2]};
    struct point corner;
    if (!overlap_corner(&nb->box[bond], &nb->box[other], image, &model->box, &corner))
      continue;
    if (lattice_image(corner.x, nb->cell_edge[0]) != at[0] || lattice_image(corner.y, nb->cell_edge[1]) != at[1] ||
        lattice_image(corner.z, nb->cell_edge[2]) != at[2])
      continue;
    if (!add_partner(nb, model->vertices, bond, (struct neighbor){e->bond, {image[0], image[1], image[2]}}) ||
        !add_partner(nb, model->vertices, other, mirrored(bond, image)))
      return false;
  }
  return true;
}

typedef bool visit(struct neighbors *, const struct model *, uint32_t, const int64_t[3]);

static bool visit_enter(struct neighbors *nb, const struct model *model, uint32_t bond, const int64_t at[3])
{
  (void)model;
  return enter_cell(nb, bond, at);
}

static bool visit_leave(struct neighbors *nb, const struct model *model, uint32_t bond, const int64_t at[3])
{
  (void)model;
  leave_cell(nb, bond, at);
  return true;
}

static bool visit_cells(struct neighbors *nb, const struct model *model, uint32_t bond, visit *what)
{
  const struct cell_range r = range_of(nb, &nb->box[bond]);
  int64_t at[3];
  for (at[2] = r.low[2]; at[2] <= r.high[2]; at[2]++)
    for (at[1] = r.low[1]; at[1] <= r.high[1]; at[1]++)
      for (at[0] = r.low[0]; at[0] <= r.high[0]; at[0]++)
        if (!what(nb, model, bond, at))
          return false;
  return true;
}

/* --- the two entrances ------------------------------------------------------------------------------------------- */

static bool short_of_memory(const struct state *state, struct work *work, uint32_t bond)
{
  const struct neighbors *nb = &work->fiber.neighbors;
  return work_fault(work, FAULT_NO_MEMORY, state->step + 1, bond, nb->stride, nb->stride);
}

bool neighbors_cover(const struct state *state, const struct model *model, struct work *work, uint32_t bond,
                     struct point to)
{
  struct neighbors *nb = &work->fiber.neighbors;
  if (margin_box_holds(&nb->box[bond], to))
    return true;
  visit_cells(nb, model, bond, visit_leave);
  while (nb->count[bond] > 0) {
    struct neighbor last = nb->list[(size_t)bond * nb->stride + --nb->count[bond]];
    remove_partner(nb, (uint32_t)last.bond, mirrored(bond, last.image));
  }
  nb->box[bond] = draw_box(state, model, nb, bond, to);
  nb->redrawn++;
  return (visit_cells(nb, model, bond, search_cell) && visit_cells(nb, model, bond, visit_enter)) ||
         short_of_memory(state, work, bond);
}

/* Search cells divide the box edges exactly: both are whole numbers of collision cells. */
static void choose_grid(const struct model *model, struct neighbors *nb)
{
  for (int k = 0; k < 3; k++) {
    nb->cells[k] = (int32_t)(model->box.cells[k] / SEARCH_CELL_A0);
    nb->cell_edge[k] = model->box.edge[k] / nb->cells[k];
  }
}

static bool allocate(const struct model *model, struct neighbors *nb)
{
  if (nb->box)
    return true;
  choose_grid(model, nb);
  nb->margin = lattice_from_a0(MARGIN_A0);
  nb->stride = FIRST_STRIDE;
  nb->box = malloc(model->vertices * sizeof *nb->box);
  nb->count = malloc(model->vertices * sizeof *nb->count);
  nb->list = malloc((size_t)model->vertices * nb->stride * sizeof *nb->list);
  nb->head = malloc((size_t)nb->cells[0] * nb->cells[1] * nb->cells[2] * sizeof *nb->head);
  return nb->box && nb->count && nb->list && nb->head;
}

bool neighbors_build(const struct state *state, const struct model *model, struct work *work)
{
  struct neighbors *nb = &work->fiber.neighbors;
  if (!allocate(model, nb))
    return short_of_memory(state, work, 0);
  memset(nb->count, 0, model->vertices * sizeof *nb->count);
  memset(nb->head, 0xff, (size_t)nb->cells[0] * nb->cells[1] * nb->cells[2] * sizeof *nb->head);
  free(nb->entry);
  nb->entry = NULL;
  nb->entries = 0;
  nb->free_entry = -1;
  for (uint32_t j = 0; j < model->vertices; j++) {
    if (model->next[j] < 0)
      continue;
    nb->box[j] = draw_box(state, model, nb, j, state->position[j]);
    if (!visit_cells(nb, model, j, search_cell) || !visit_cells(nb, model, j, visit_enter))
      return short_of_memory(state, work, j);
  }
  nb->built = true;
  return true;
}
