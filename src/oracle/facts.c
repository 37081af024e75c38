#include "oracle/facts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "contact/line.h"
#include "oracle/patterns.h"

/* --- sets --------------------------------------------------------------------------------------------------------- */

/* A fact; of two that are true of the same units, the cheaper is kept. */
static void add(struct facts *f, const struct units *u, double cost, const bool *true_of, const char *text)
{
  uint64_t *bits = calloc(f->words + 1, sizeof *bits);
  struct fact *same, *grown = bits ? realloc(f->fact, (f->count + 1) * sizeof *grown) : NULL;
  f->fact = grown ? grown : f->fact;
  f->failed |= !grown;
  if (!grown) {
    free(bits);
    return;
  }
  for (uint32_t k = 0; k < u->n; k++)
    bits[k / 64] |= (uint64_t)true_of[k] << (k % 64);
  for (same = f->fact; same < f->fact + f->count; same++)
    if (memcmp(same->bits, bits, f->words * sizeof *bits) == 0)
      break;
  const bool known = same < f->fact + f->count;
  if (known)
    free(bits);
  if (known && same->cost <= cost)
    return;
  same->cost = cost;
  snprintf(same->text, sizeof same->text, "%s", text);
  if (!known)
    same->bits = bits, f->count++;
}

void facts_free(struct facts *f)
{
  for (uint32_t k = 0; k < f->count; k++)
    free(f->fact[k].bits);
  free(f->fact);
  memset(f, 0, sizeof *f);
}

/* --- facts from a number for each unit ---------------------------------------------------------------------------- */

/* What a number is: how facts are made of it. */
enum sort {
  FLAG = 1, /* text: yes|no */
  SIGN = 2,
  EQUAL = 4,
  RANGE = 8,
  PARITY = 16,
  NUMBER = SIGN | RANGE,
  COUNT = EQUAL | RANGE,
};

struct maker {
  const struct units *u;
  struct facts *f;
  double *value; /* [n]; NaN: not known */
  bool *true_of; /* [n] */
};

typedef bool test(double value, double x);

static bool is_equal(double value, double x)
{
  return value == x;
}

static bool is_least(double value, double x)
{
  return value >= x;
}

static bool is_most(double value, double x)
{
  return value <= x;
}

static bool is_below(double value, double x)
{
  return value < x;
}

static bool is_above(double value, double x)
{
  return value > x;
}

static bool is_odd(double value, double x)
{
  return fmod(fabs(value), 2.0) == x;
}

/* A fact and its negation. */
static void add_test(struct maker *m, double cost, test *holds, double x, const char *yes, const char *no)
{
  for (uint32_t k = 0; k < m->u->n; k++)
    m->true_of[k] = !isnan(m->value[k]) && holds(m->value[k], x);
  add(m->f, m->u, cost, m->true_of, yes);
  for (uint32_t k = 0; no && k < m->u->n; k++)
    m->true_of[k] = !m->true_of[k];
  if (no)
    add(m->f, m->u, cost + 0.5, m->true_of, no);
}

static void add_flag(struct maker *m, const char *text)
{
  char yes[FACT_TEXT];
  const char *bar = strchr(text, '|');
  snprintf(yes, sizeof yes, "%.*s", bar ? (int)(bar - text) : (int)strlen(text), text);
  add_test(m, 3.0, is_equal, 1.0, yes, bar ? bar + 1 : NULL);
}

static void add_sign(struct maker *m, const char *name)
{
  char yes[FACT_TEXT], no[FACT_TEXT];
  snprintf(yes, sizeof yes, "%.60s is negative", name), snprintf(no, sizeof no, "%.60s is not negative", name);
  add_test(m, 5.0, is_below, 0.0, yes, no);
  snprintf(yes, sizeof yes, "%.60s is positive", name), snprintf(no, sizeof no, "%.60s is not positive", name);
  add_test(m, 5.0, is_above, 0.0, yes, no);
  snprintf(yes, sizeof yes, "%.60s is 0", name), snprintf(no, sizeof no, "%.60s is not 0", name);
  add_test(m, 4.5, is_equal, 0.0, yes, no);
}

/* Each of a few values, in the order in which they come. */
static void add_equal(struct maker *m, const char *name)
{
  double seen[17];
  uint32_t count = 0;
  for (uint32_t k = 0; k < m->u->n; k++) {
    bool known = isnan(m->value[k]);
    for (uint32_t j = 0; j < count; j++)
      known |= seen[j] == m->value[k];
    if (!known && count == 16)
      return;
    if (!known)
      seen[count++] = m->value[k];
  }
  for (uint32_t j = 0; j < count; j++) {
    char yes[FACT_TEXT], no[FACT_TEXT];
    snprintf(yes, sizeof yes, "%.60s is %.10g", name, seen[j]);
    snprintf(no, sizeof no, "%.60s is not %.10g", name, seen[j]);
    add_test(m, 4.0 + log2(count), is_equal, seen[j], yes, no);
  }
}

/* From the least that is wrong on, and up to the most: the only two ranges that can help. */
static void add_range(struct maker *m, const char *name)
{
  double least = INFINITY, most = -INFINITY;
  char text[FACT_TEXT];
  for (uint32_t k = 0; k < m->u->n; k++)
    if (m->u->wrong[k])
      least = fmin(least, m->value[k]), most = fmax(most, m->value[k]);
  const double cost = 5.0 + log2(m->u->n);
  snprintf(text, sizeof text, "%.60s is %.10g or more", name, least);
  add_test(m, cost, is_least, least, text, NULL);
  snprintf(text, sizeof text, "%.60s is %.10g or less", name, most);
  add_test(m, cost, is_most, most, text, NULL);
}

static void add_parity(struct maker *m, const char *name)
{
  char yes[FACT_TEXT], no[FACT_TEXT];
  snprintf(yes, sizeof yes, "%.60s is odd", name), snprintf(no, sizeof no, "%.60s is even", name);
  add_test(m, 4.0, is_odd, 1.0, yes, no);
}

static void make(struct maker *m, enum sort sort, const char *name)
{
  if (sort & FLAG)
    add_flag(m, name);
  if (sort & SIGN)
    add_sign(m, name);
  if (sort & EQUAL)
    add_equal(m, name);
  if (sort & PARITY)
    add_parity(m, name);
  if (sort & RANGE)
    add_range(m, name);
}

/* --- where numbers come from -------------------------------------------------------------------------------------- */

typedef double number_of(const struct evidence_part *part, uint32_t row, uint32_t column);

static void make_of(struct maker *m, enum sort sort, const char *name, number_of *f)
{
  for (uint32_t k = 0; k < m->u->n; k++) {
    uint32_t own;
    const struct evidence_part *part = evidence_part_of(m->u->e, unit_row(m->u, k), &own);
    m->value[k] = f(part, own, m->u->values ? m->u->column[k % m->u->columns] : 0);
  }
  make(m, sort, name);
}

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

static void collect_places(struct maker *m)
{
  make_of(m, FLAG, "it is the last row|it is not the last row", is_last);
  make_of(m, FLAG, "it is row 0|it is not row 0", is_first);
  make_of(m, PARITY, "the row's number", row_number);
  make_of(m, RANGE, "the row's number", row_number);
  make_of(m, EQUAL, "the row's number modulo 4", remainder_of_4);
  make_of(m, EQUAL, "the row's number modulo 3", remainder_of_3);
  if (m->u->e->parts > 1)
    make_of(m, EQUAL, "the step", step_number);
  if (m->u->values || m->u->e->columns == 1) {
    make_of(m, NUMBER, "the right value", right_value);
    make_of(m, FLAG, "the right value is 2^31 or more|the right value is below 2^31", is_large_word);
  }
}

/* --- columns of tables with the same rows ------------------------------------------------------------------------- */

static const struct pack_table *sibling(const struct evidence_part *part, const char *name)
{
  return oracle_sibling(&part->pair, name);
}

/* Values of a column; of the unit's own one if column is PACK_COLUMNS; at row, or at the row that cells[row] names. */
static void take_column(struct maker *m, const char *name, uint32_t column, const char *cells)
{
  for (uint32_t k = 0; k < m->u->n; k++) {
    uint32_t own;
    const struct evidence_part *part = evidence_part_of(m->u->e, unit_row(m->u, k), &own);
    const struct pack_table *t = sibling(part, name), *cell = cells ? sibling(part, cells) : NULL;
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

static void collect_column(struct maker *m, const struct pack_table *t, uint32_t column, const char *cells)
{
  char name[FACT_TEXT];
  const bool own = column == PACK_COLUMNS;
  snprintf(name, sizeof name, "%.30s%s%.20s%s", t->name, own ? "" : ".", own ? "" : t->component[column],
           cells ? " of its cell"
           : own ? " along the same axis"
                 : "");
  take_column(m, t->name, column, cells);
  make(m, own ? NUMBER : sort_of(t, column), name);
  if (is_position(t)) {
    replace(m, cell_along);
    snprintf(name, sizeof name, "cell of %.30s%s%.20s", t->name, own ? " along the same axis" : ".",
             own ? "" : t->component[column]);
    make(m, COUNT, name);
  } else if (t->real && own) {
    replace(m, fabs);
    snprintf(name, sizeof name, "the size of %.30s along the same axis", t->name);
    make(m, RANGE, name);
  } else if (t->real && t->columns == 1) {
    replace(m, is_whole);
    snprintf(name, sizeof name, "%.40s is whole|%.40s is not whole", t->name, t->name);
    make(m, FLAG, name);
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
      const struct pack_table *at = sibling(evidence_part_of(m->u->e, unit_row(m->u, k), &own), t->name);
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
    make(m, FLAG, name);
  }
}

static void collect_length(struct maker *m, const struct pack_table *t)
{
  char name[FACT_TEXT];
  for (uint32_t k = 0; k < m->u->n; k++) {
    uint32_t own;
    const struct pack_table *at = sibling(evidence_part_of(m->u->e, unit_row(m->u, k), &own), t->name);
    m->value[k] = 0.0;
    for (uint32_t c = 0; at && c < 3; c++)
      m->value[k] += pack_value(at, own, c) * pack_value(at, own, c);
    m->value[k] = sqrt(m->value[k]);
  }
  snprintf(name, sizeof name, "the length of %.30s", t->name);
  make(m, RANGE, name);
}

static bool told_before(const struct pack_table *t)
{
  return strncmp(t->name, "bound.", 6) == 0;
}

static void collect_siblings(struct maker *m)
{
  const struct evidence *e = m->u->e;
  const struct oracle_pair *p = &e->part[0].pair;
  for (size_t k = 0; k < p->pack->count; k++) {
    const struct pack_table *t = &p->pack->table[k];
    if (memcmp(&t->place, &p->ours->place, sizeof t->place) != 0 || t->rows != p->ours->rows || told_before(t))
      continue;
    for (uint32_t column = 0; column < t->columns; column++)
      if (t != p->ours || !m->u->values)
        collect_column(m, t, column, NULL);
    if (m->u->values && t->columns == e->columns && t != p->ours)
      collect_column(m, t, PACK_COLUMNS, NULL);
    if (t->columns == 3)
      collect_outside(m, t);
    if (t->columns == 3 && t->real)
      collect_length(m, t);
  }
}

/* --- cells -------------------------------------------------------------------------------------------------------- */

/* The cell of a row: its number, or that of its member, or what comes out. -1: it has none. */
static double cell_of(const struct evidence_part *part, uint32_t row)
{
  char name[PACK_WORD];
  const struct pack_table *t = part->pair.ours;
  snprintf(name, sizeof name, "in.%.20s_cell", t->name + 4);
  const struct pack_table *cell = sibling(part, name);
  if (cell)
    return pack_value(cell, row, 0);
  if (strcmp(t->component[0], "cell") == 0)
    return pack_value(t, row, 0);
  struct box box;
  return oracle_box(&part->pair, &box) && t->rows == (uint64_t)box_cell_count(&box) &&
                 (sibling(part, "in.load") || sibling(part, "in.solvent_cell"))
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
  const struct pack_table *tables[2] = {solvent ? sibling(part, "in.solvent_cell") : NULL,
                                        vertices ? sibling(part, "in.vertex_cell") : NULL};
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
  const struct pack_table *load = sibling(part, "in.load");
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
  const struct pack_table *t = sibling(part, name);
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
  make_of(m, FLAG, "x is in the last cell|x is not in the last cell", at_upper_x);
  make_of(m, FLAG, "y is in the last cell|y is not in the last cell", at_upper_y);
  make_of(m, FLAG, "z is in the last cell|z is not in the last cell", at_upper_z);
  make_of(m, FLAG, "its cell is at an upper edge|its cell is at no upper edge", at_upper);
  make_of(m, FLAG, "its cell is at a lower edge|its cell is at no lower edge", at_lower);
  make_of(m, COUNT, "x of its cell", cell_x);
  make_of(m, COUNT, "y of its cell", cell_y);
  make_of(m, COUNT, "z of its cell", cell_z);
  make_of(m, EQUAL, "the number of its cell", cell_of_row);
  if (!isnan(all_members(part, 0, 0))) {
    make_of(m, FLAG, "its cell is active|its cell is not active", is_active);
    make_of(m, COUNT, "members of its cell", all_members);
    make_of(m, COUNT, "solvent in its cell", solvent_members);
    make_of(m, COUNT, "vertices in its cell", vertex_members);
    make_of(m, COUNT, "its rank in its cell", rank_in_cell);
  }
  char cells[PACK_WORD];
  snprintf(cells, sizeof cells, "in.%.20s_cell", part->pair.ours->name + 4);
  if (!sibling(part, cells))
    return;
  for (size_t k = 0; k < part->pair.pack->count; k++) {
    const struct pack_table *t = &part->pair.pack->table[k];
    struct box box;
    if (memcmp(&t->place, &part->pair.ours->place, sizeof t->place) == 0 && oracle_box(&part->pair, &box) &&
        t->rows == (uint64_t)box_cell_count(&box) && strncmp(t->name, "in.", 3) == 0)
      for (uint32_t column = 0; column < t->columns; column++)
        collect_column(m, t, column, cells);
  }
}

/* --- vertices ----------------------------------------------------------------------------------------------------- */

/* The vertex of a row; -1: rows are no vertices. */
static int64_t vertex_of(const struct evidence_part *part, uint32_t row)
{
  static const char *const of_solvent[] = {"random", "stream", "swap",    "shift",
                                           "sum",    "solve",  "rescale", "maxwell_boltzmann"};
  const struct pack_table *t = part->pair.ours, *chain = oracle_model(&part->pair, "in.chain");
  for (size_t k = 0; k < sizeof of_solvent / sizeof *of_solvent; k++)
    if (strcmp(t->place.operator_name, of_solvent[k]) == 0)
      return -1;
  return chain && chain->rows == t->rows && strcmp(t->name, "out.solvent") != 0 && strcmp(t->name, "out.order") != 0
             ? (int64_t)row
             : -1;
}

static double chain_of(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *chain = oracle_model(&part->pair, "in.chain");
  const int64_t vertex = vertex_of(part, row);
  return vertex >= 0 && chain ? pack_value(chain, (uint32_t)vertex, column) : NAN;
}

static double has_next(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return chain_of(part, row, 0) >= 0.0;
}

static double has_prev(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return chain_of(part, row, 1) >= 0.0;
}

static double is_end(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return chain_of(part, row, 0) < 0.0 || chain_of(part, row, 1) < 0.0;
}

static double closes_ring(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const double next = chain_of(part, row, 0);
  (void)column;
  return next >= 0.0 && next < row;
}

static double begins_ring(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return chain_of(part, row, 1) > row;
}

static double touches_closing(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  return fmax(closes_ring(part, row, column), begins_ring(part, row, column));
}

static double is_of_ring(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *chain = oracle_model(&part->pair, "in.chain");
  const double fiber = chain_of(part, row, 2);
  (void)column;
  for (uint32_t k = 0; chain && k < chain->rows; k++)
    if (pack_value(chain, k, 2) == fiber && (pack_value(chain, k, 0) < 0.0 || pack_value(chain, k, 1) < 0.0))
      return 0.0;
  return 1.0;
}

static double fiber_of(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return chain_of(part, row, 2);
}

/* Place along the fiber, from its first vertex, and from its last. */
static double along_fiber(const struct evidence_part *part, uint32_t row, int step)
{
  const double fiber = chain_of(part, row, 2);
  double n = 0.0;
  for (int64_t k = (int64_t)row + step; k >= 0 && k < part->rows && chain_of(part, (uint32_t)k, 2) == fiber; k += step)
    n++;
  return n;
}

static double from_first(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return along_fiber(part, row, -1);
}

static double from_last(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  (void)column;
  return along_fiber(part, row, 1);
}

static double mass_differs(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *t = oracle_model(&part->pair, "in.vertex");
  (void)column;
  return t && row + 1 < t->rows ? pack_value(t, row, 0) != pack_value(t, row + 1, 0) : 0.0;
}

static void collect_vertices(struct maker *m)
{
  static const char *const constants[] = {"mass", "bond_length", "spring", "bending", "force_x", "force_y", "force_z"};
  if (m->u->e->part[0].rows == 0 || vertex_of(&m->u->e->part[0], 0) < 0)
    return;
  make_of(m, FLAG, "the vertex has a next one|the vertex is the last of its fiber", has_next);
  make_of(m, FLAG, "the vertex has one before|the vertex is the first of its fiber", has_prev);
  make_of(m, FLAG, "the vertex is an end of its fiber|the vertex is no end of a fiber", is_end);
  make_of(m, FLAG, "the vertex's bond closes a ring|the vertex's bond closes no ring", closes_ring);
  make_of(m, FLAG, "the vertex begins a ring|the vertex begins no ring", begins_ring);
  make_of(m, FLAG,
          "the vertex is an end of the bond that closes a ring|the vertex is no end of a bond that closes a ring",
          touches_closing);
  make_of(m, FLAG, "the vertex is of a ring|the vertex is of no ring", is_of_ring);
  make_of(m, COUNT, "the number of its fiber", fiber_of);
  make_of(m, PARITY, "the number of its fiber", fiber_of);
  make_of(m, COUNT, "vertices of its fiber before it", from_first);
  make_of(m, COUNT, "vertices of its fiber after it", from_last);
  make_of(m, FLAG, "the next number's mass is another|the next number's mass is the same", mass_differs);
  const struct pack_table *t = oracle_model(&m->u->e->part[0].pair, "in.vertex");
  for (uint32_t column = 0; t && column < t->columns && column < 7; column++) {
    for (uint32_t k = 0; k < m->u->n; k++) {
      uint32_t own;
      evidence_part_of(m->u->e, unit_row(m->u, k), &own);
      m->value[k] = pack_value(t, own, column);
    }
    make(m, SIGN | EQUAL | RANGE, constants[column]);
  }
}

/* --- events ------------------------------------------------------------------------------------------------------- */

static double has_image(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *t = sibling(part, "out.event");
  (void)column;
  return pack_value(t, row, 3) != 0.0 || pack_value(t, row, 4) != 0.0 || pack_value(t, row, 5) != 0.0;
}

static double moves_own_bond(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *t = sibling(part, "out.event");
  (void)column;
  return pack_value(t, row, 0) == pack_value(t, row, 1);
}

static void collect_events(struct maker *m)
{
  const struct evidence_part *part = &m->u->e->part[0];
  const struct pack_table *t = sibling(part, "out.event");
  if (!t || t->rows != part->pair.ours->rows || t->columns < 6)
    return;
  make_of(m, FLAG, "the partner is an image|the partner is no image", has_image);
  make_of(m, FLAG, "the moving bond is that to the next vertex|the moving bond is that to the vertex before",
          moves_own_bond);
}

/* --- single tests for a crossing ---------------------------------------------------------------------------------- */

/* The five determinants of a test: whether one is exactly zero, and their largest difference, a0. */
static bool test_points(const struct evidence_part *part, uint32_t row, struct point r[5])
{
  static const char *const names[5] = {"in.from", "in.to", "in.pivot", "in.a", "in.b"};
  for (int k = 0; k < 5; k++) {
    const struct pack_table *t = sibling(part, names[k]);
    if (!oracle_is_vectors(t, false, row))
      return false;
    r[k] = oracle_point(t, row);
  }
  return true;
}

static double has_zero(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  struct point r[5];
  (void)column;
  if (!test_points(part, row, r))
    return NAN;
  return !crossing_orientation(r[3], r[4], r[2], r[0]) || !crossing_orientation(r[3], r[4], r[2], r[1]) ||
         !crossing_orientation(r[3], r[4], r[0], r[1]) || !crossing_orientation(r[0], r[1], r[2], r[3]) ||
         !crossing_orientation(r[0], r[1], r[2], r[4]);
}

static double test_size(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  struct point r[5];
  double size = 0.0;
  (void)column;
  if (!test_points(part, row, r))
    return NAN;
  for (int k = 0; k < 5; k++)
    size = fmax(size, vec3_norm(point_difference(r[k], r[(k + 1) % 5])));
  return size;
}

static void collect_tests(struct maker *m)
{
  if (strcmp(m->u->e->part[0].pair.ours->place.operator_name, "crossing") != 0)
    return;
  make_of(m, FLAG, "a determinant is exactly zero|no determinant is zero", has_zero);
  make_of(m, RANGE, "the largest difference of the points", test_size);
}

/* --- faces of cells ----------------------------------------------------------------------------------------------- */

/* Position plus shift lies on a face of a cell; is more than one edge away from the box. */
static double place_after_shift(const struct evidence_part *part, uint32_t row, bool far)
{
  const struct pack_table *r = oracle_input(&part->pair), *shift = sibling(part, "in.shift");
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
  make_of(m, FLAG, "it lies on a face of a cell|it lies on no face of a cell", is_on_face);
  make_of(m, FLAG, "it is more than one edge away|it is one edge away at most", is_far);
}

/* --- axes --------------------------------------------------------------------------------------------------------- */

/* Points of the square that are tried before one is in the disk. */
static double tries_of_axis(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *address = sibling(part, "in.address");
  const uint32_t purpose = address ? (uint32_t)pack_value(address, row, 0) : RANDOM_ROTATION_AXIS;
  const uint64_t step = address ? (uint64_t)pack_value(address, row, 2) : part->pair.ours->place.step;
  const uint32_t entity = address ? (uint32_t)pack_value(address, row, 3) : row;
  struct vec3 n;
  (void)column;
  for (uint32_t k = 0; k < 64; k++)
    if (random_axis_from_words(random_at(oracle_seed(&part->pair), (enum random_purpose)purpose, k / 2, step, entity),
                               (int)(k % 2), &n))
      return k;
  return NAN;
}

static void collect_axes(struct maker *m)
{
  if (strcmp(m->u->e->part[0].pair.ours->name, "out.axis") == 0)
    make_of(m, COUNT, "points tried before the one in the disk", tries_of_axis);
}

void facts_collect(const struct units *u, struct facts *f)
{
  *f = (struct facts){.words = (u->n + 63) / 64};
  struct maker m = {u, f, calloc((size_t)u->n + 1, sizeof *m.value), calloc((size_t)u->n + 1, sizeof *m.true_of)};
  f->failed = !m.value || !m.true_of;
  if (!f->failed) {
    collect_places(&m);
    collect_vertices(&m);
    collect_cells(&m);
    collect_events(&m);
    collect_axes(&m);
    collect_tests(&m);
    collect_faces(&m);
    collect_siblings(&m);
  }
  free(m.value);
  free(m.true_of);
}
