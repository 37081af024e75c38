/*
 * The grid of search cells, in which bonds find their partners (contact/neighbors.h). The periodic box is divided into
 * cells. A bond enters every cell that the box around its capsule touches, with the image of the bond that lies there,
 * and with a key: the part of the box that lies in the cell.
 */
#ifndef UNCROSS_CONTACT_SEARCH_CELLS_H
#define UNCROSS_CONTACT_SEARCH_CELLS_H

#include "base/registers.h"
#include "contact/contact.h"

/* Chooses the cells and allocates them, empty, with the arrays of reference positions. Does nothing if they are there.
 * False if memory is short. */
bool search_cells_alloc(const struct model *model, struct neighbors *nb);

/* Doubles the room of a row that is full. False if memory is short. */
bool search_row_grow(struct grid_row *row);

/* --- boxes and walks --------------------------------------------------------------------------------------------- */

/* The box around a capsule, in lattice units. reach_a0: with some slack. */
struct search_box {
  struct point low, high;
};

static inline struct search_box search_box_around(struct point a, struct point b, double reach_a0)
{
  const int64_t reach = lattice_from_a0(reach_a0);
  return (struct search_box){
      {(a.x < b.x ? a.x : b.x) - reach, (a.y < b.y ? a.y : b.y) - reach, (a.z < b.z ? a.z : b.z) - reach},
      {(a.x > b.x ? a.x : b.x) + reach, (a.y > b.y ? a.y : b.y) + reach, (a.z > b.z ? a.z : b.z) + reach}};
}

/* The image of the box in which a point lies. */
static inline struct image search_image(const struct neighbors *nb, struct point p, const struct box *box)
{
  return (struct image){{(int32_t)lattice_image_by(p.x, box->edge[0], nb->inverse[0].box_edge),
                         (int32_t)lattice_image_by(p.y, box->edge[1], nb->inverse[1].box_edge),
                         (int32_t)lattice_image_by(p.z, box->edge[2], nb->inverse[2].box_edge)}};
}

/* A walk along one axis through the search cells that an interval touches. */
struct search_walk {
  int64_t low, high;   /* the interval, from the lower side of the cell at hand */
  int32_t cell, image; /* the cell at hand, wrapped */
};

/* The walk begins in the cell of `low`. Images are counted from `home`. */
static inline struct search_walk search_walk_from(int64_t low, int64_t high, const struct neighbors *nb, int axis,
                                                  int32_t home)
{
  const int64_t edge = nb->cell_edge[axis], at = lattice_image_by(low, edge, nb->inverse[axis].cell_edge),
                image = lattice_image_by(at, nb->cells[axis], nb->inverse[axis].cells);
  return (struct search_walk){low - at * edge, high - at * edge, (int32_t)(at - image * nb->cells[axis]),
                              (int32_t)image - home};
}

/* To the next cell; false if the interval ends before it. */
static inline bool search_walk_on(struct search_walk *w, const struct neighbors *nb, int axis)
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
enum { SEARCH_FACE_MOST = 127, SEARCH_BEGINS_BELOW = 48 };

static inline uint64_t search_key_of_axis(const struct search_walk *w, const struct neighbors *nb, int axis)
{
  const uint64_t low = w->low < 0 ? 0 : (uint64_t)(w->low >> nb->cell_shift[axis]);
  const uint64_t high = w->high < nb->cell_edge[axis] ? (uint64_t)(w->high >> nb->cell_shift[axis]) : SEARCH_FACE_MOST;
  return low << 8 * axis | (SEARCH_FACE_MOST - high) << 8 * (axis + 3) |
         (uint64_t)(w->low < 0) << (SEARCH_BEGINS_BELOW + axis);
}

/* What a key is compared with, made of the key of one box: high in bytes 0 to 2, 127 - low in bytes 3 to 5. The highest
 * bit of each byte is set. below: the other box must not begin below the cell along the axes of these bits. */
struct search_probe {
  uint64_t faces, below;
};

#define SEARCH_EACH_BYTE 0x0101010101010101u

static inline struct search_probe search_probe_of(uint64_t key)
{
  const uint64_t swapped = (key & 0xffffff) << 24 | (key >> 24 & 0xffffff);
  return (struct search_probe){SEARCH_EACH_BYTE * 0xff - swapped, key & (uint64_t)7 << SEARCH_BEGINS_BELOW};
}

/* Of n entries of a row, 1 <= n <= 64: bit k is set if the box of entry k overlaps with that of the probe, and the
 * lower corner of the overlap lies in this cell: so a pair that overlaps in several cells is taken once. Along every
 * axis one of the two boxes begins in the cell; each face `low` is at most the other's `high`, that is, no byte of the
 * key is greater than that of the probe. In the difference the highest bit of a byte stays set if its byte is not
 * greater; no byte borrows from the next. Up to LANES - 1 entries behind the n are read, and do not count. */
static inline uint64_t search_overlaps(struct search_probe mine, const struct grid_entry *its, uint32_t n)
{
  uint64_t overlap = 0;
  for (uint32_t k = 0; k < n; k += LANES) {
    words key, is;
    load_pairs(&its[k], &key, &is);
    overlap |= (uint64_t)zeros((~(mine.faces - key) & SEARCH_EACH_BYTE * 0x80) | (mine.below & key)) << k;
  }
  return overlap & UINT64_MAX >> (64 - n);
}

/* Which of n entries of a row, 1 <= n <= 64, is that of this bond, in the same way; 0 if none is. */
static inline uint64_t search_entry_of(struct grid_bond bond, const struct grid_entry *its, uint32_t n)
{
  uint64_t found = 0, mine;
  memcpy(&mine, &bond, sizeof mine);
  for (uint32_t k = 0; k < n; k += LANES) {
    words key, is;
    load_pairs(&its[k], &key, &is);
    found |= (uint64_t)zeros(is ^ mine) << k;
  }
  return found & UINT64_MAX >> (64 - n);
}

/* --- visits ------------------------------------------------------------------------------------------------------ */

struct search; /* what the caller collects on the way */

/* A function that handles the entry of a bond in one cell; search_visit calls it for each cell. */
typedef bool search_visitor(struct neighbors *, const struct model *, uint32_t cell, const struct grid_entry *,
                            struct search *);

/* Calls `what` for each cell that the box around a bond touches. */
static inline bool search_visit(struct neighbors *nb, const struct model *model, uint32_t bond, struct search_box box,
                                search_visitor *what, struct search *found)
{
  struct grid_entry e = {.is = {.bond = (int32_t)bond}};
  const struct image home = search_image(nb, nb->reference[bond].at, &model->box);
  struct search_walk z = search_walk_from(box.low.z, box.high.z, nb, 2, home.k[2]);
  const struct search_walk y_start = search_walk_from(box.low.y, box.high.y, nb, 1, home.k[1]),
                           x_start = search_walk_from(box.low.x, box.high.x, nb, 0, home.k[0]);
  do {
    struct search_walk y = y_start;
    const uint64_t key_z = search_key_of_axis(&z, nb, 2);
    e.is.image[2] = (int8_t)z.image;
    do {
      struct search_walk x = x_start;
      const uint64_t key_yz = key_z | search_key_of_axis(&y, nb, 1);
      e.is.image[1] = (int8_t)y.image;
      do {
        e.key = key_yz | search_key_of_axis(&x, nb, 0);
        e.is.image[0] = (int8_t)x.image;
        if (!what(nb, model, (uint32_t)((z.cell * nb->cells[1] + y.cell) * nb->cells[0] + x.cell), &e, found))
          return false;
      } while (search_walk_on(&x, nb, 0));
    } while (search_walk_on(&y, nb, 1));
  } while (search_walk_on(&z, nb, 2));
  return true;
}

/* Enters a bond into a cell. False if memory is short. */
static inline bool search_enter_cell(struct grid_row *row, const struct grid_entry *e)
{
  if (row->count == row->room && !search_row_grow(row))
    return false;
  row->at[row->count++] = *e;
  return true;
}

#endif
