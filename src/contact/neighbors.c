#include "contact/neighbors.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "contact/capsule.h"
#include "contact/drift.h"
#include "contact/pairs.h"

#define OVERLAPS 256 /* collected before they are looked at */
#define COLUMNS 64   /* looked at together */
#define FIRST_NEAR 64
#define SEARCH_CELL_A0 1.0 /* least edge of a search cell */

/* --- lists ------------------------------------------------------------------------------------------------------- */

/* Doubles the capacity of a row. Its first entries stand in the grid itself; they are copied to new memory. NULL if
 * memory is short. */
static void *grow(void *at, uint32_t *room, uint32_t first, size_t size)
{
  const bool began_here = *room == first;
  if (*room > UINT32_MAX / 2)
    return NULL;
  void *bigger = began_here ? malloc(2 * first * size) : realloc(at, 2 * *room * size);
  if (!bigger)
    return NULL;
  *room *= 2;
  return began_here ? memcpy(bigger, at, first * size) : bigger;
}

static bool add_entry(struct grid_row *row, const struct grid_entry *e)
{
  if (row->count == row->room) {
    struct grid_entry *bigger = grow(row->at, &row->room, NEIGHBORS_FIRST_ENTRIES, sizeof *bigger);
    if (!bigger)
      return false;
    row->at = bigger;
  }
  row->at[row->count++] = *e;
  return true;
}

static bool add_near(struct neighbor_list *list, struct neighbor n)
{
  if (list->count == list->room && !memory_double((void **)&list->at, &list->room, FIRST_NEAR, sizeof *list->at))
    return false;
  list->at[list->count++] = n;
  return true;
}

/* --- grid -------------------------------------------------------------------------------------------------------- */

/* The box around a capsule, in lattice units. reach_a0: with some slack. */
struct capsule_box {
  struct point low, high;
};

static inline struct capsule_box box_around(struct point a, struct point b, double reach_a0)
{
  const int64_t reach = lattice_from_a0(reach_a0);
  return (struct capsule_box){
      {(a.x < b.x ? a.x : b.x) - reach, (a.y < b.y ? a.y : b.y) - reach, (a.z < b.z ? a.z : b.z) - reach},
      {(a.x > b.x ? a.x : b.x) + reach, (a.y > b.y ? a.y : b.y) + reach, (a.z > b.z ? a.z : b.z) + reach}};
}

static struct capsule_box box_of(const struct neighbors *nb, const struct model *model, uint32_t bond)
{
  const struct reference_position *p = &nb->reference[bond], *q = &nb->reference[model->next[bond]];
  return box_around(p->at, q->at, capsule_most(p->skin, q->skin) + nb->around);
}

/* The image of the box in which a point lies. */
static inline struct image image_of(const struct neighbors *nb, struct point p, const struct box *box)
{
  return (struct image){{(int32_t)lattice_image_by(p.x, box->edge[0], nb->inverse[0].box_edge),
                         (int32_t)lattice_image_by(p.y, box->edge[1], nb->inverse[1].box_edge),
                         (int32_t)lattice_image_by(p.z, box->edge[2], nb->inverse[2].box_edge)}};
}

/* A walk along one axis through the search cells that an interval touches. */
struct walk {
  int64_t low, high;   /* the interval, from the lower side of the cell at hand */
  int32_t cell, image; /* the cell at hand, wrapped */
};

/* The walk begins in the cell of `low`. Images are counted from `home`. */
static struct walk walk_from(int64_t low, int64_t high, const struct neighbors *nb, int axis, int32_t home)
{
  const int64_t edge = nb->cell_edge[axis], at = lattice_image_by(low, edge, nb->inverse[axis].cell_edge),
                image = lattice_image_by(at, nb->cells[axis], nb->inverse[axis].cells);
  return (struct walk){low - at * edge, high - at * edge, (int32_t)(at - image * nb->cells[axis]),
                       (int32_t)image - home};
}

/* To the next cell; false if the interval ends before it. */
static bool walk_on(struct walk *w, const struct neighbors *nb, int axis)
{
  if (w->high < nb->cell_edge[axis])
    return false;
  w->low -= nb->cell_edge[axis];
  w->high -= nb->cell_edge[axis];
  if (++w->cell == nb->cells[axis])
    w->cell = 0, w->image++;
  return true;
}

/* --- keys -------------------------------------------------------------------------------------------------------- */

/* The part of a box that lies in a cell, in one integer. Along axis k, the faces are at `low` and `high`, in about
 * 1/128 of the cell's edge, rounded down. The rounding is safe: intervals that overlap in the cell still overlap. Byte
 * k of the key is low, byte 3 + k is 127 - high; bit 48 + k says that the box begins below the cell. */
enum { FACE_MOST = 127, BEGINS_BELOW = 48 };

static inline uint64_t key_of_axis(const struct walk *w, const struct neighbors *nb, int axis)
{
  const uint64_t low = w->low < 0 ? 0 : (uint64_t)(w->low >> nb->cell_shift[axis]);
  const uint64_t high = w->high < nb->cell_edge[axis] ? (uint64_t)(w->high >> nb->cell_shift[axis]) : FACE_MOST;
  return low << 8 * axis | (FACE_MOST - high) << 8 * (axis + 3) | (uint64_t)(w->low < 0) << (BEGINS_BELOW + axis);
}

/* What a key is compared with, made of the key of one box: high in bytes 0 to 2, 127 - low in bytes 3 to 5. The highest
 * bit of each byte is set. below: the other box must not begin below the cell along the axes of these bits. */
struct probe {
  uint64_t faces, below;
};

#define EACH_BYTE 0x0101010101010101u

static inline struct probe probe_of(uint64_t key)
{
  const uint64_t swapped = (key & 0xffffff) << 24 | (key >> 24 & 0xffffff);
  return (struct probe){EACH_BYTE * 0xff - swapped, key & (uint64_t)7 << BEGINS_BELOW};
}

/* True if the boxes of two entries of one cell overlap, and the lower corner of the overlap lies in this cell: so a
 * pair that overlaps in several cells is taken once. Along every axis one of the two boxes begins in the cell; each
 * face `low` is at most the other's `high`, that is, no byte of the key is greater than that of the probe. In the
 * difference the highest bit of a byte stays set if its byte is not greater; no byte borrows from the next. */
static inline bool overlap(struct probe mine, uint64_t its)
{
  return ((~(mine.faces - its) & EACH_BYTE * 0x80) | (mine.below & its)) == 0;
}

/* --- visits to cells --------------------------------------------------------------------------------------------- */

/* Pairs of bonds whose boxes overlap, before the distance is tested. near: if not NULL, the other bonds are listed
 * there; if NULL, pairs whose capsules are not apart enter the pair list. */
struct search {
  struct neighbor_list *near;
  uint32_t count;
  struct overlap {
    struct grid_bond mine, its; /* in the same cell */
  } at[OVERLAPS + 1];           /* one that is written, and not taken */
};

/* A function that handles the entry of a bond in one cell; visit_cells calls it for each cell. */
typedef bool visit(struct neighbors *, const struct model *, uint32_t cell, const struct grid_entry *, struct search *);

/* Calls `what` for each cell that the box around a bond touches. */
static inline bool visit_cells(struct neighbors *nb, const struct model *model, uint32_t bond, struct capsule_box box,
                               visit *what, struct search *found)
{
  struct grid_entry e = {.is = {.bond = (int32_t)bond}};
  const struct image home = image_of(nb, nb->reference[bond].at, &model->box);
  struct walk z = walk_from(box.low.z, box.high.z, nb, 2, home.k[2]);
  const struct walk y_start = walk_from(box.low.y, box.high.y, nb, 1, home.k[1]),
                    x_start = walk_from(box.low.x, box.high.x, nb, 0, home.k[0]);
  do {
    struct walk y = y_start;
    const uint64_t key_z = key_of_axis(&z, nb, 2);
    e.is.image[2] = (int8_t)z.image;
    do {
      struct walk x = x_start;
      const uint64_t key_yz = key_z | key_of_axis(&y, nb, 1);
      e.is.image[1] = (int8_t)y.image;
      do {
        e.key = key_yz | key_of_axis(&x, nb, 0);
        e.is.image[0] = (int8_t)x.image;
        if (!what(nb, model, (uint32_t)((z.cell * nb->cells[1] + y.cell) * nb->cells[0] + x.cell), &e, found))
          return false;
      } while (walk_on(&x, nb, 0));
    } while (walk_on(&y, nb, 1));
  } while (walk_on(&z, nb, 2));
  return true;
}

static bool leave_cell(struct neighbors *nb, const struct model *model, uint32_t cell, const struct grid_entry *e,
                       struct search *found)
{
  (void)model, (void)found;
  struct grid_row *row = &nb->entries[cell];
  uint32_t k = 0;
  while (k < row->count && memcmp(&row->at[k].is, &e->is, sizeof e->is) != 0)
    k++;
  if (k < row->count)
    row->at[k] = row->at[--row->count];
  return true;
}

static bool share_vertex(const struct model *model, uint32_t a, uint32_t b)
{
  return a == b || model->next[a] == (int32_t)b || model->next[b] == (int32_t)a;
}

/* Bonds that are never partners: a bond and its image; those that share a vertex, and their images, which thin lines
 * cannot cross; of thick fibers, those that are near along the contour. */
static bool never_touch(const struct model *model, uint32_t bond, const struct neighbor *n)
{
  const uint32_t other = (uint32_t)n->bond;
  if (model->thickness == 0)
    return share_vertex(model, bond, other);
  const bool image = n->image[0] != 0 || n->image[1] != 0 || n->image[2] != 0;
  return bond == other || (!image && (share_vertex(model, bond, other) || model_tube_is_blind(model, bond, other)));
}

/* Between walls there are no images along y. */
static bool is_beyond_wall(const struct model *model, const struct neighbor *n)
{
  return n->image[1] != 0 && model_has_walls(model);
}

/* Pairs whose distances are computed together, in columns. p, q: both bond vectors between reference positions; w:
 * from the first end of p to that of q; reach: of both; all in a0. */
struct columns {
  uint32_t count;
  uint32_t bond[COLUMNS];
  struct neighbor other[COLUMNS];
  double p[3][COLUMNS], q[3][COLUMNS], w[3][COLUMNS], reach[COLUMNS];
};

/* Which image of the other bond overlaps. home: image of the box in which the first end of `mine` lies. */
static struct neighbor neighbor_of(const struct neighbors *nb, const struct model *model, const struct overlap *c,
                                   const struct image *home)
{
  const struct image its_home = image_of(nb, nb->reference[c->its.bond].at, &model->box);
  struct neighbor n = {.bond = c->its.bond};
  for (int axis = 0; axis < 3; axis++)
    n.image[axis] = home->k[axis] - its_home.k[axis] + c->mine.image[axis] - c->its.image[axis];
  return n;
}

static void fill_column(const struct neighbors *nb, const struct model *model, uint32_t bond, struct neighbor n,
                        struct columns *s)
{
  const uint32_t k = s->count;
  const struct reference_position *a = &nb->reference[bond], *b = &nb->reference[model->next[bond]],
                                  *c = &nb->reference[n.bond], *d = &nb->reference[model->next[n.bond]];
  const struct vec3 p = point_difference(b->at, a->at), q = point_difference(d->at, c->at),
                    w = point_difference(point_image(c->at, n.image, &model->box), a->at);
  s->bond[k] = bond, s->other[k] = n;
  s->p[0][k] = p.x, s->p[1][k] = p.y, s->p[2][k] = p.z;
  s->q[0][k] = q.x, s->q[1][k] = q.y, s->q[2][k] = q.z;
  s->w[0][k] = w.x, s->w[1][k] = w.y, s->w[2][k] = w.z;
  s->reach[k] = capsule_most(a->skin, b->skin) + capsule_most(c->skin, d->skin) + nb->apart;
}

/* Adds those pairs to the pair list whose capsules are not apart. */
static bool add_pairs(struct neighbors *nb, const struct columns *restrict s)
{
  int64_t apart[COLUMNS];
  for (uint32_t k = 0; k < s->count; k++) {
    const struct vec3 p = {s->p[0][k], s->p[1][k], s->p[2][k]}, q = {s->q[0][k], s->q[1][k], s->q[2][k]},
                      w = {s->w[0][k], s->w[1][k], s->w[2][k]};
    apart[k] = capsule_distance(p, q, w) > s->reach[k];
  }
  for (uint32_t k = 0; k < s->count; k++)
    if (!apart[k] && !pairs_add(nb, s->bond[k], s->other[k]))
      return false;
  return true;
}

/* Empties the list of overlaps: into `near` or the pair list, see struct search. */
static bool settle(struct neighbors *nb, const struct model *model, struct search *found)
{
  struct image home = {{0, 0, 0}};
  struct columns s;
  s.count = 0;
  for (uint32_t k = 0; k < found->count; k++) {
    const struct overlap *c = &found->at[k];
    const uint32_t bond = (uint32_t)c->mine.bond;
    if (k == 0 || c->mine.bond != c[-1].mine.bond)
      home = image_of(nb, nb->reference[bond].at, &model->box);
    const struct neighbor n = neighbor_of(nb, model, c, &home);
    const bool apart = never_touch(model, bond, &n) || is_beyond_wall(model, &n);
    if (found->near) {
      if (!apart && !add_near(found->near, n))
        return false;
      continue;
    }
    fill_column(nb, model, bond, n, &s);
    s.count += !apart;
    if (s.count == COLUMNS) {
      if (!add_pairs(nb, &s))
        return false;
      s.count = 0;
    }
  }
  found->count = 0;
  return add_pairs(nb, &s);
}

/* Collects the bonds of a cell whose boxes overlap with this one's. Each entry is written to the list, and stays there
 * if it overlaps: a branch would be mispredicted too often. */
static bool look_into_cell(struct neighbors *nb, const struct model *model, uint32_t cell,
                           const struct grid_entry *mine, struct search *found)
{
  const struct grid_row *row = &nb->entries[cell];
  const struct probe probe = probe_of(mine->key);
  for (uint32_t first = 0; first < row->count; first += COLUMNS) {
    const uint32_t left = row->count - first, n = left < COLUMNS ? left : COLUMNS;
    if (found->count + n > OVERLAPS && !settle(nb, model, found))
      return false;
    uint32_t count = found->count;
    for (const struct grid_entry *e = &row->at[first]; e < &row->at[first + n]; e++) {
      found->at[count] = (struct overlap){mine->is, e->is};
      count += overlap(probe, e->key);
    }
    for (uint32_t k = found->count; k < count; k++) {
      __builtin_prefetch(&nb->reference[found->at[k].its.bond]);
      __builtin_prefetch(&nb->reference[found->at[k].its.bond + 1]);
      __builtin_prefetch(&model->next[found->at[k].its.bond]);
    }
    found->count = count;
  }
  return true;
}

static bool enter_cell(struct neighbors *nb, const struct model *model, uint32_t cell, const struct grid_entry *mine,
                       struct search *found)
{
  return look_into_cell(nb, model, cell, mine, found) && add_entry(&nb->entries[cell], mine);
}

/* --- the entrances ----------------------------------------------------------------------------------------------- */

/* Without a solvent vertices keep going, and a reference position serves longer if it stands ahead of its vertex. The
 * velocity that lasts is the mean over a few neighbors, in which the vibrations of bonds cancel. With a solvent there
 * is no lead: velocities change before the vertex gets there. */
static struct vec3 lead_of(const struct state *state, const struct model *model, const struct drift_frame *frame,
                           uint32_t vertex, double most)
{
  const int on_each_side = 2;
  const double time = 0.3; /* t0 */
  struct vec3 sum = state->velocity[vertex];
  int32_t before = (int32_t)vertex, after = before;
  double n = 1.0;
  if (model->solvent.per_cell > 0.0)
    return (struct vec3){0, 0, 0};
  for (int k = 0; k < on_each_side; k++) {
    before = model->prev[before] < 0 ? before : model->prev[before];
    after = model->next[after] < 0 ? after : model->next[after];
    sum = vec3_add_scaled(vec3_add_scaled(sum, 1.0, state->velocity[before]), 1.0, state->velocity[after]);
    n += 2.0;
  }
  const struct vec3 mean = vec3_scale(1.0 / n, sum);
  const struct vec3 lead =
      frame->sheared ? vec3_scale(time / frame->time, drift_displacement(frame, mean, state->position[vertex].y))
                     : vec3_scale(time, vec3_sub(mean, frame->velocity));
  const double length = vec3_norm(lead);
  return length > most ? vec3_scale(most / length, lead) : lead;
}

/* A reference position and a skin that contain both ends of a move, whether it is made or rejected. */
static struct reference_position reference_of_move(const struct state *state, const struct model *model,
                                                   const struct contact *contact, uint32_t vertex, struct point from,
                                                   struct point to)
{
  const struct point d = point_minus(to, from);
  const double length = vec3_norm(point_difference(to, from));
  struct point at = point_minus(to, contact->neighbors.moved);
  if (length > NEIGHBORS_SKIN) /* from its middle */
    at = (struct point){at.x - d.x / 2, at.y - d.y / 2, at.z - d.z / 2};
  else
    at = point_move(at, lead_of(state, model, &contact->frame, vertex, 0.7 * (NEIGHBORS_SKIN - length)));
  return (struct reference_position){at, fmax(NEIGHBORS_SKIN, 0.5 * length + LATTICE_UNIT)};
}

/* Enters bonds into the grid and finds their pairs, after they got new reference positions. */
static bool enter(struct neighbors *nb, const struct model *model, uint32_t bonds, const uint32_t *bond)
{
  struct search found;
  found.near = NULL, found.count = 0;
  for (uint32_t k = 0; k < bonds; k++)
    if (!visit_cells(nb, model, bond[k], box_of(nb, model, bond[k]), enter_cell, &found))
      return false;
  return settle(nb, model, &found);
}

/* Prefetches a row of the grid. */
static bool fetch_cell(struct neighbors *nb, const struct model *model, uint32_t cell, const struct grid_entry *e,
                       struct search *found)
{
  (void)model, (void)e, (void)found;
  const char *row = (const char *)&nb->entries[cell];
  for (size_t line = 0; line < sizeof nb->entries[cell]; line += 64)
    __builtin_prefetch(row + line, 1);
  return true;
}

void neighbors_fetch(struct neighbors *nb, const struct model *model, uint32_t vertex)
{
  uint32_t bond[2];
  const int bonds = model_bonds_of(model, vertex, bond);
  for (int b = 0; b < bonds; b++)
    visit_cells(nb, model, bond[b], box_of(nb, model, bond[b]), fetch_cell, NULL);
}

bool neighbors_renew(const struct state *state, const struct model *model, struct contact *contact, uint32_t n,
                     const uint32_t *vertex, const struct point *from, const struct point *to, struct fault *fault)
{
  struct neighbors *nb = &contact->neighbors;
  uint32_t bond[2 * NEIGHBORS_AT_ONCE] = {0};
  const uint32_t bonds = model_bonds_at(model, n, vertex, bond);
  for (uint32_t k = 0; k < bonds; k++) {
    visit_cells(nb, model, bond[k], box_of(nb, model, bond[k]), leave_cell, NULL);
    nb->generation[bond[k]]++;
  }
  for (uint32_t k = 0; k < n; k++) {
    nb->reference[vertex[k]] = reference_of_move(state, model, contact, vertex[k], from[k], to[k]);
    nb->hold[vertex[k]] = nb->path[vertex[k]];
  }
  nb->renewed += n;
  return enter(nb, model, bonds, bond) || fault_no_memory(fault, state->step + 1);
}

bool neighbors_near(const struct state *state, const struct model *model, struct contact *contact, uint32_t bond,
                    const struct point end[2], double range, struct neighbor_list *near, struct fault *fault)
{
  struct neighbors *nb = &contact->neighbors;
  const struct capsule_box box =
      box_around(point_minus(end[0], nb->moved), point_minus(end[1], nb->moved), range + CAPSULE_SLACK);
  struct search found;
  found.near = near, found.count = 0;
  near->count = 0;
  return (visit_cells(nb, model, bond, box, look_into_cell, &found) && settle(nb, model, &found)) ||
         fault_no_memory(fault, state->step + 1);
}

/* Chooses search cells that divide the box edges exactly (in lattice units). There are about as many cells as bonds, or
 * fewer.
 */
static void choose_grid(const struct model *model, struct neighbors *nb)
{
  const double edge = fmax(SEARCH_CELL_A0, cbrt(box_volume(&model->box) / (double)model->bonds));
  for (int k = 0; k < 3; k++) {
    int cells = (int)fmax(1.0, model->box.cells[k] / edge);
    while (model->box.edge[k] % cells != 0)
      cells--;
    nb->cells[k] = cells;
    nb->cell_edge[k] = model->box.edge[k] / cells;
    while ((nb->cell_edge[k] - 1) >> nb->cell_shift[k] > FACE_MOST)
      nb->cell_shift[k]++;
    nb->inverse[k].cells = 1.0 / cells;
    nb->inverse[k].cell_edge = 1.0 / (double)nb->cell_edge[k];
    nb->inverse[k].box_edge = 1.0 / (double)model->box.edge[k];
  }
  nb->cell_count = (uint32_t)(nb->cells[0] * nb->cells[1] * nb->cells[2]);
}

static bool allocate(const struct model *model, struct neighbors *nb)
{
  if (nb->entries)
    return true;
  choose_grid(model, nb);
  nb->reference = memory_alloc(model->vertices, sizeof *nb->reference);
  nb->path = memory_alloc(model->vertices, sizeof *nb->path);
  nb->generation = memory_alloc(model->vertices, sizeof *nb->generation);
  nb->hold = memory_alloc(model->vertices, sizeof *nb->hold);
  nb->entries = memory_alloc(nb->cell_count, sizeof *nb->entries);
  if (!nb->reference || !nb->path || !nb->generation || !nb->hold || !nb->entries)
    return false;
  for (uint32_t c = 0; c < nb->cell_count; c++) {
    struct grid_row *row = &nb->entries[c];
    row->at = row->first, row->count = 0, row->room = NEIGHBORS_FIRST_ENTRIES;
  }
  return true;
}

/* A bond visits all search cells around it, of which there must not be 10^18. Forces find every bond that is half an
 * edge long before the next drift; half a drift adds less than one edge. */
static bool spans_few_cells(const struct state *state, const struct model *model, uint32_t bond, struct fault *fault)
{
  const double length = vec3_norm(point_difference(state->position[model->next[bond]], state->position[bond]));
  return length <= 2.0 * box_shortest_edge(&model->box) ||
         fault_record(fault, FAULT_BOND_TOO_LONG, state->step + 1, bond, length, model_longest_bond(model));
}

bool neighbors_build(const struct state *state, const struct model *model, struct contact *contact, struct fault *fault)
{
  struct neighbors *nb = &contact->neighbors;
  if (!allocate(model, nb))
    return fault_no_memory(fault, state->step + 1);
  nb->pairs.count = 0;
  nb->around = 0.5 * model_thickness(model) + CAPSULE_SLACK;
  nb->apart = model_thickness(model) + CAPSULE_SLACK;
  for (uint32_t c = 0; c < nb->cell_count; c++)
    nb->entries[c].count = 0;
  for (uint32_t j = 0; j < model->vertices; j++) {
    nb->reference[j] = (struct reference_position){state->position[j], NEIGHBORS_SKIN};
    nb->hold[j] = nb->path[j];
  }
  for (uint32_t j = 0; j < model->vertices; j++)
    if (model->next[j] >= 0 && (!spans_few_cells(state, model, j, fault) || !enter(nb, model, 1, &j)))
      return fault_no_memory(fault, state->step + 1); /* or the fault that is there already */
  nb->moved = (struct point){0, 0, 0};
  nb->built = true;
  return true;
}
