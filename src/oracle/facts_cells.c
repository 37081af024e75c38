/* Facts of cells, and of what is in them. */
#include <math.h>
#include <string.h>

#include "oracle/facts_make.h"
#include "oracle/patterns.h"

/* --- cells -------------------------------------------------------------------------------------------------------- */

/* The cell of a row: its number, or that of its member, or what comes out. -1: it has none. */
static double cell_of(const struct evidence_part *part, uint32_t row)
{
  char name[PACK_WORD];
  const struct pack_table *t = part->pair.ours;
  snprintf(name, sizeof name, "in.%.20s_cell", t->name + 4);
  const struct pack_table *cell = facts_sibling(part, name);
  if (cell)
    return pack_value(cell, row, 0);
  if (strcmp(t->component[0], "cell") == 0)
    return pack_value(t, row, 0);
  struct box box;
  return oracle_box(&part->pair, &box) && t->rows == (uint64_t)box_cell_count(&box) &&
                 (facts_sibling(part, "in.load") || facts_sibling(part, "in.solvent_cell"))
             ? row
             : -1.0;
}

static double cell_coordinate(const struct evidence_part *part, uint32_t row, uint32_t axis)
{
  struct box box;
  const double cell = cell_of(part, row);
  if (cell < 0.0 || !oracle_box(&part->pair, &box))
    return NAN;
  const int64_t at = (int64_t)cell, x = at % box.cells[0], y = at / box.cells[0] % box.cells[1];
  return (double)(axis == 0 ? x : axis == 1 ? y : at / box.cells[0] / box.cells[1]);
}

static double cell_of_row(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return cell_of(part, row);
}

static double cell_x(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return cell_coordinate(part, row, 0);
}

static double cell_y(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return cell_coordinate(part, row, 1);
}

static double cell_z(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return cell_coordinate(part, row, 2);
}

static double at_edge(const struct evidence_part *part, uint32_t row, bool upper, uint32_t axis)
{
  struct box box;
  const double x = cell_coordinate(part, row, axis);
  return isnan(x) || !oracle_box(&part->pair, &box) ? NAN : upper ? x == box.cells[axis] - 1 : x == 0.0;
}

static double at_upper_x(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return at_edge(part, row, true, 0);
}

static double at_upper_y(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return at_edge(part, row, true, 1);
}

static double at_upper_z(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return at_edge(part, row, true, 2);
}

static double at_upper(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return fmax(at_edge(part, row, true, 0), fmax(at_edge(part, row, true, 1), at_edge(part, row, true, 2)));
}

static double at_lower(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return fmax(at_edge(part, row, false, 0), fmax(at_edge(part, row, false, 1), at_edge(part, row, false, 2)));
}

/* Members of its cell that one of both tables of cells has. */
static double members(const struct evidence_part *part, uint32_t row, bool solvent, bool vertices)
{
  const double cell = cell_of(part, row);
  const struct pack_table *tables[2] = {solvent ? facts_sibling(part, "in.solvent_cell") : NULL,
                                        vertices ? facts_sibling(part, "in.vertex_cell") : NULL};
  double n = 0.0;
  if (cell < 0.0 || (!tables[0] && !tables[1]))
    return NAN;
  for (int k = 0; k < 2; k++)
    for (uint32_t j = 0; tables[k] && j < tables[k]->rows; j++)
      n += pack_value(tables[k], j, 0) == cell;
  return n;
}

static double solvent_members(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return members(part, row, true, false);
}

static double vertex_members(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return members(part, row, false, true);
}

static double all_members(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return members(part, row, true, true);
}

static double is_active(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *load = facts_sibling(part, "in.load");
  (void)column;
  return load ? pack_value(load, row, 0) >= 2.0 : members(part, row, true, true) >= 2.0;
}

/* Members of the same table before this one in its cell. */
static double rank_in_cell(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const double cell = cell_of(part, row);
  char name[PACK_WORD];
  (void)column;
  snprintf(name, sizeof name, "in.%.20s_cell", part->pair.ours->name + 4);
  const struct pack_table *t = facts_sibling(part, name);
  double n = t ? 0.0 : NAN;
  for (uint32_t k = 0; t && k < row; k++)
    n += pack_value(t, k, 0) == cell;
  return n;
}

static void collect_cells(struct maker *m)
{
  const struct evidence_part *part = &m->u->e->part[0];
  if (part->rows == 0 || cell_of(part, 0) < 0.0)
    return;
  facts_make_of(m, FLAG, "x is in the last cell|x is not in the last cell", at_upper_x);
  facts_make_of(m, FLAG, "y is in the last cell|y is not in the last cell", at_upper_y);
  facts_make_of(m, FLAG, "z is in the last cell|z is not in the last cell", at_upper_z);
  facts_make_of(m, FLAG, "its cell is at an upper edge|its cell is at no upper edge", at_upper);
  facts_make_of(m, FLAG, "its cell is at a lower edge|its cell is at no lower edge", at_lower);
  facts_make_of(m, COUNT, "x of its cell", cell_x);
  facts_make_of(m, COUNT, "y of its cell", cell_y);
  facts_make_of(m, COUNT, "z of its cell", cell_z);
  facts_make_of(m, EQUAL, "the number of its cell", cell_of_row);
  if (!isnan(all_members(part, 0, 0))) {
    facts_make_of(m, FLAG, "its cell is active|its cell is not active", is_active);
    facts_make_of(m, COUNT, "members of its cell", all_members);
    facts_make_of(m, COUNT, "solvent in its cell", solvent_members);
    facts_make_of(m, COUNT, "vertices in its cell", vertex_members);
    facts_make_of(m, COUNT, "its rank in its cell", rank_in_cell);
  }
  char cells[PACK_WORD];
  snprintf(cells, sizeof cells, "in.%.20s_cell", part->pair.ours->name + 4);
  if (!facts_sibling(part, cells))
    return;
  for (size_t k = 0; k < part->pair.pack->count; k++) {
    const struct pack_table *t = &part->pair.pack->table[k];
    struct box box;
    if (memcmp(&t->place, &part->pair.ours->place, sizeof t->place) == 0 && oracle_box(&part->pair, &box) &&
        t->rows == (uint64_t)box_cell_count(&box) && strncmp(t->name, "in.", 3) == 0)
      for (uint32_t column = 0; column < t->columns; column++)
        facts_make_of_column(m, t, column, cells);
  }
}

/* --- faces of cells ----------------------------------------------------------------------------------------------- */

/* Position plus shift lies on a face of a cell; is more than one edge away from the box. */
static double place_after_shift(const struct evidence_part *part, uint32_t row, bool far)
{
  const struct pack_table *r = oracle_input(&part->pair), *shift = facts_sibling(part, "in.shift");
  struct box box;
  double found = 0.0;
  if (!oracle_is_vectors(r, false, row) || !oracle_is_vectors(shift, false, 0) || !oracle_box(&part->pair, &box))
    return NAN;
  for (uint32_t k = 0; k < 3; k++) {
    const uint64_t at = (uint64_t)r->value.integer[3 * (size_t)row + k] + (uint64_t)shift->value.integer[k];
    const int64_t image = lattice_image((int64_t)at, box.edge[k]);
    found = far ? fmax(found, image < -1 || image > 1) : fmax(found, (int64_t)at % LATTICE_CELL == 0);
  }
  return found;
}

static double is_on_face(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return place_after_shift(part, row, false);
}

static double is_far(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return place_after_shift(part, row, true);
}

static void collect_faces(struct maker *m)
{
  if (strcmp(m->u->e->part[0].pair.ours->place.operator_name, "bin") != 0)
    return;
  facts_make_of(m, FLAG, "it lies on a face of a cell|it lies on no face of a cell", is_on_face);
  facts_make_of(m, FLAG, "it is more than one edge away|it is one edge away at most", is_far);
}

void facts_of_cells(struct maker *m)
{
  collect_cells(m);
  collect_faces(m);
}
