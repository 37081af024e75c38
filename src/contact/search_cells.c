#include "contact/search_cells.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define LEAST_EDGE_A0 1.0

/* Chooses search cells that divide the box edges exactly (in lattice units). There are about as many cells as bonds, or
 * fewer.
 */
static void choose_cells(const struct model *model, struct neighbors *nb)
{
  const double edge = fmax(LEAST_EDGE_A0, cbrt(box_volume(&model->box) / (double)model->bonds));
  for (int k = 0; k < 3; k++) {
    int cells = (int)fmax(1.0, model->box.cells[k] / edge);
    while (model->box.edge[k] % cells != 0)
      cells--;
    nb->cells[k] = cells;
    nb->cell_edge[k] = model->box.edge[k] / cells;
    while ((nb->cell_edge[k] - 1) >> nb->cell_shift[k] > SEARCH_FACE_MOST)
      nb->cell_shift[k]++;
    nb->inverse[k].cells = 1.0 / cells;
    nb->inverse[k].cell_edge = 1.0 / (double)nb->cell_edge[k];
    nb->inverse[k].box_edge = 1.0 / (double)model->box.edge[k];
  }
  nb->cell_count = (uint32_t)(nb->cells[0] * nb->cells[1] * nb->cells[2]);
}

bool search_cells_alloc(const struct model *model, struct neighbors *nb)
{
  if (nb->entries)
    return true;
  choose_cells(model, nb);
  nb->reference = memory_alloc(model->vertices, sizeof *nb->reference);
  nb->path = memory_alloc(model->vertices, sizeof *nb->path);
  nb->generation = memory_alloc(model->vertices, sizeof *nb->generation);
  nb->hold = memory_alloc(model->vertices, sizeof *nb->hold);
  nb->entries = memory_alloc((size_t)nb->cell_count + 1, sizeof *nb->entries); /* search_overlaps may read into it */
  if (!nb->reference || !nb->path || !nb->generation || !nb->hold || !nb->entries)
    return false;
  for (uint32_t c = 0; c < nb->cell_count; c++) {
    struct grid_row *row = &nb->entries[c];
    row->at = row->first, row->count = 0, row->room = SEARCH_FIRST_ENTRIES;
  }
  return true;
}

/* The first entries of a row stand in the grid itself; they are copied to new memory. */
bool search_row_grow(struct grid_row *row)
{
  const bool began_here = row->room == SEARCH_FIRST_ENTRIES;
  struct grid_entry *bigger = NULL;
  if (row->room <= UINT32_MAX / 2)
    bigger = realloc(began_here ? NULL : row->at, (2 * (size_t)row->room + LANES) * sizeof *bigger);
  if (!bigger)
    return false;
  row->at = began_here ? memcpy(bigger, row->at, row->room * sizeof *bigger) : bigger;
  row->room *= 2;
  return true;
}
