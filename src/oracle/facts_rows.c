/* Facts of rows of any table: their numbers, and the columns of tables with the same rows. */
#include <math.h>
#include <string.h>

#include "oracle/facts_make.h"
#include "oracle/patterns.h"

/* --- numbers of rows ---------------------------------------------------------------------------------------------- */

static double row_number(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)part, (void)column;
  return row;
}

static double is_last(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return row + 1 == part->pair.ours->rows;
}

static double is_first(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)part, (void)column;
  return row == 0;
}

static double remainder_of_4(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)part, (void)column;
  return row % 4;
}

static double remainder_of_3(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)part, (void)column;
  return row % 3;
}

static double step_number(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)row, (void)column;
  return (double)part->pair.ours->place.step;
}

static double right_value(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  return pack_value(part->pair.ours, row, column);
}

static double is_large_word(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  return part->pair.ours->real ? NAN : pack_value(part->pair.ours, row, column) >= 0x1p31;
}

void facts_of_places(struct maker *m)
{
  facts_make_of(m, FLAG, "it is the last row|it is not the last row", is_last);
  facts_make_of(m, FLAG, "it is row 0|it is not row 0", is_first);
  facts_make_of(m, PARITY, "the row's number", row_number);
  facts_make_of(m, RANGE, "the row's number", row_number);
  facts_make_of(m, EQUAL, "the row's number modulo 4", remainder_of_4);
  facts_make_of(m, EQUAL, "the row's number modulo 3", remainder_of_3);
  if (m->u->e->parts > 1)
    facts_make_of(m, EQUAL, "the step", step_number);
  if ((m->u->values || m->u->e->columns == 1) && strcmp(m->u->e->part[0].pair.ours->name, "out.found") != 0) {
    facts_make_of(m, NUMBER, "the right value", right_value);
    facts_make_of(m, FLAG, "the right value is 2^31 or more|the right value is below 2^31", is_large_word);
  }
}

/* --- columns of tables with the same rows ------------------------------------------------------------------------- */

const struct pack_table *facts_sibling(const struct evidence_part *part, const char *name)
{
  return oracle_sibling(&part->pair, name);
}

/* Values of a column; of the unit's own one if column is PACK_COLUMNS; at row, or at the row that cells[row] names. */
static void take_column(struct maker *m, const char *name, uint32_t column, const char *cells)
{
  for (uint32_t k = 0; k < m->u->n; k++) {
    uint32_t own;
    const struct evidence_part *part = evidence_part_of(m->u->e, unit_row(m->u, k), &own);
    const struct pack_table *t = facts_sibling(part, name), *cell = cells ? facts_sibling(part, cells) : NULL;
    const double at = cell ? pack_value(cell, own, 0) : own;
    const uint32_t c = column < PACK_COLUMNS ? column : m->u->column[k % m->u->columns];
    m->value[k] = t && at >= 0.0 && at < t->rows ? pack_value(t, (uint32_t)at, c) : NAN;
  }
}

static bool is_position(const struct pack_table *t)
{
  return !t->real && t->columns == 3 &&
         (strstr(t->name, "position") ||
          (strcmp(t->place.operator_name, "bin") == 0 && strcmp(t->name, "in.shift") != 0));
}

static void replace(struct maker *m, double (*f)(double))
{
  for (uint32_t k = 0; k < m->u->n; k++)
    m->value[k] = f(m->value[k]);
}

static double cell_along(double position)
{
  return floor(position * LATTICE_UNIT);
}

static double is_whole(double number)
{
  return isnan(number) ? NAN : number == floor(number);
}

static double largest(const struct pack_table *t, uint32_t column)
{
  double most = 0.0;
  for (uint32_t row = 0; row < t->rows; row++)
    most = fmax(most, fabs(pack_value(t, row, column)));
  return most;
}

/* What facts are made of a column of integers: those of 0 and 1 are no numbers. */
static enum sort sort_of(const struct pack_table *t, uint32_t column)
{
  const double most = largest(t, column);
  return t->real || most >= 1e6 ? NUMBER : most <= 1.0 ? EQUAL : SIGN | COUNT | PARITY;
}

void facts_make_of_column(struct maker *m, const struct pack_table *t, uint32_t column, const char *cells)
{
  char name[FACT_TEXT];
  const bool own = column == PACK_COLUMNS;
  snprintf(name, sizeof name, "%.30s%s%.20s%s", t->name, own ? "" : ".", own ? "" : t->component[column],
           cells ? " of its cell"
           : own ? " along the same axis"
                 : "");
  take_column(m, t->name, column, cells);
  facts_make(m, own ? NUMBER : sort_of(t, column), name);
  if (is_position(t)) {
    replace(m, cell_along);
    snprintf(name, sizeof name, "cell of %.30s%s%.20s", t->name, own ? " along the same axis" : ".",
             own ? "" : t->component[column]);
    facts_make(m, COUNT, name);
  } else if (t->real && own) {
    replace(m, fabs);
    snprintf(name, sizeof name, "the size of %.30s along the same axis", t->name);
    facts_make(m, RANGE, name);
  } else if (t->real && t->columns == 1) {
    replace(m, is_whole);
    snprintf(name, sizeof name, "%.40s is whole|%.40s is not whole", t->name, t->name);
    facts_make(m, FLAG, name);
  }
}

/* Any component negative; outside of the box on either side. */
static void collect_outside(struct maker *m, const struct pack_table *t)
{
  struct box box;
  char name[2 * FACT_TEXT];
  const bool boxed = is_position(t) && oracle_box(&m->u->e->part[0].pair, &box);
  for (int side = 0; side < (boxed ? 3 : 1); side++) {
    for (uint32_t k = 0; k < m->u->n; k++) {
      uint32_t own;
      const struct pack_table *at = facts_sibling(evidence_part_of(m->u->e, unit_row(m->u, k), &own), t->name);
      bool any = false;
      for (uint32_t c = 0; at && c < 3; c++) {
        const double x = pack_value(at, own, c);
        any |= side == 0 ? x < 0.0 : side == 1 ? x >= (double)box.edge[c] : x < 0.0 || x >= (double)box.edge[c];
      }
      m->value[k] = any;
    }
    const char *what = side == 0   ? "a negative component"
                       : side == 1 ? "a component beyond the upper edge"
                                   : "a component outside of the box";
    snprintf(name, sizeof name, "%.12s has %s|%.12s has not %s", t->name, what, t->name, what);
    facts_make(m, FLAG, name);
  }
}

static void collect_length(struct maker *m, const struct pack_table *t)
{
  char name[FACT_TEXT];
  for (uint32_t k = 0; k < m->u->n; k++) {
    uint32_t own;
    const struct pack_table *at = facts_sibling(evidence_part_of(m->u->e, unit_row(m->u, k), &own), t->name);
    m->value[k] = 0.0;
    for (uint32_t c = 0; at && c < 3; c++)
      m->value[k] += pack_value(at, own, c) * pack_value(at, own, c);
    m->value[k] = sqrt(m->value[k]);
  }
  snprintf(name, sizeof name, "the length of %.30s", t->name);
  facts_make(m, RANGE, name);
}

static bool told_before(const struct pack_table *t)
{
  return strncmp(t->name, "bound.", 6) == 0;
}

void facts_of_tables(struct maker *m)
{
  const struct evidence *e = m->u->e;
  const struct oracle_pair *p = &e->part[0].pair;
  for (size_t k = 0; k < p->pack->count; k++) {
    const struct pack_table *t = &p->pack->table[k];
    if (memcmp(&t->place, &p->ours->place, sizeof t->place) != 0 || t->rows != p->ours->rows || told_before(t))
      continue;
    for (uint32_t column = 0; column < t->columns; column++)
      if (t != p->ours || !m->u->values)
        facts_make_of_column(m, t, column, NULL);
    if (m->u->values && t->columns == e->columns && t != p->ours)
      facts_make_of_column(m, t, PACK_COLUMNS, NULL);
    if (t->columns == 3)
      collect_outside(m, t);
    if (t->columns == 3 && t->real)
      collect_length(m, t);
  }
}
