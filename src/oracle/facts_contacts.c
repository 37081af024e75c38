/* Facts of events of a sweep, of single tests for a crossing, and of the making of axes. */
#include <math.h>
#include <string.h>

#include "base/random.h"
#include "contact/line.h"
#include "oracle/facts_make.h"
#include "oracle/patterns.h"

/* --- events ------------------------------------------------------------------------------------------------------- */

static double has_image(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *t = facts_sibling(part, "out.event");
  (void)column;
  return pack_value(t, row, 3) != 0.0 || pack_value(t, row, 4) != 0.0 || pack_value(t, row, 5) != 0.0;
}

static double moves_own_bond(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *t = facts_sibling(part, "out.event");
  (void)column;
  return pack_value(t, row, 0) == pack_value(t, row, 1);
}

static void collect_events(struct maker *m)
{
  const struct evidence_part *part = &m->u->e->part[0];
  const struct pack_table *t = facts_sibling(part, "out.event");
  if (!t || t->rows != part->pair.ours->rows || t->columns < 6)
    return;
  facts_make_of(m, FLAG, "the partner is an image|the partner is no image", has_image);
  facts_make_of(m, FLAG, "the moving bond is that to the next vertex|the moving bond is that to the vertex before",
                moves_own_bond);
}

/* --- single tests for a crossing ---------------------------------------------------------------------------------- */

/* The five determinants of a test: whether one is exactly zero, and their largest difference, a0. */
static bool test_points(const struct evidence_part *part, uint32_t row, struct point r[5])
{
  static const char *const names[5] = {"in.from", "in.to", "in.pivot", "in.a", "in.b"};
  for (int k = 0; k < 5; k++) {
    const struct pack_table *t = facts_sibling(part, names[k]);
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
  facts_make_of(m, FLAG, "a determinant is exactly zero|no determinant is zero", has_zero);
  facts_make_of(m, RANGE, "the largest difference of the points", test_size);
}

/* --- axes --------------------------------------------------------------------------------------------------------- */

/* Points of the square that are tried before one is in the disk. */
static double tries_of_axis(const struct evidence_part *part, uint32_t row, uint32_t column)
{
  const struct pack_table *address = facts_sibling(part, "in.address");
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
    facts_make_of(m, COUNT, "points tried before the one in the disk", tries_of_axis);
}

void facts_of_contacts(struct maker *m)
{
  collect_events(m);
  collect_axes(m);
  collect_tests(m);
}
