/* Facts of vertices: their places in fibers, and their constants. */
#include <math.h>
#include <string.h>

#include "oracle/facts_make.h"
#include "oracle/patterns.h"

/* --- vertices ----------------------------------------------------------------------------------------------------- */

/* The vertex of a row; -1: rows are no vertices. */
static int64_t vertex_of(const struct evidence_part *part, uint32_t row)
{
  static const char *const of_solvent[] = {"random",  "stream",           "swap", "shift", "sum", "solve", "mean",
                                           "rescale", "maxwell_boltzmann"};
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

void facts_of_fibers(struct maker *m)
{
  static const char *const constants[] = {"mass", "bond_length", "spring", "bending", "force_x", "force_y", "force_z"};
  if (m->u->e->part[0].rows == 0 || vertex_of(&m->u->e->part[0], 0) < 0)
    return;
  facts_make_of(m, FLAG, "the vertex has a next one|the vertex is the last of its fiber", has_next);
  facts_make_of(m, FLAG, "the vertex has one before|the vertex is the first of its fiber", has_prev);
  facts_make_of(m, FLAG, "the vertex is an end of its fiber|the vertex is no end of a fiber", is_end);
  facts_make_of(m, FLAG, "the vertex's bond closes a ring|the vertex's bond closes no ring", closes_ring);
  facts_make_of(m, FLAG, "the vertex begins a ring|the vertex begins no ring", begins_ring);
  facts_make_of(m, FLAG,
                "the vertex is an end of the bond that closes a ring|the vertex is no end of a bond that closes a ring",
                touches_closing);
  facts_make_of(m, FLAG, "the vertex is of a ring|the vertex is of no ring", is_of_ring);
  facts_make_of(m, COUNT, "the number of its fiber", fiber_of);
  facts_make_of(m, PARITY, "the number of its fiber", fiber_of);
  facts_make_of(m, COUNT, "vertices of its fiber before it", from_first);
  facts_make_of(m, COUNT, "vertices of its fiber after it", from_last);
  facts_make_of(m, FLAG, "the next number's mass is another|the next number's mass is the same", mass_differs);
  const struct pack_table *t = oracle_model(&m->u->e->part[0].pair, "in.vertex");
  for (uint32_t column = 0; t && column < t->columns && column < 7; column++) {
    for (uint32_t k = 0; k < m->u->n; k++) {
      uint32_t own;
      evidence_part_of(m->u->e, unit_row(m->u, k), &own);
      m->value[k] = pack_value(t, own, column);
    }
    facts_make(m, SIGN | EQUAL | RANGE, constants[column]);
  }
}
