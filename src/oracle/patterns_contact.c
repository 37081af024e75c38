/* What went wrong in one test for a crossing, or in one exchange: each wrong formula is tried on the inputs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/line.h"
#include "oracle/patterns.h"

/* --- verdicts ---------------------------------------------------------------------------------------------------- */

/* The first volume at `from` and `to`, the path's, those of a's and b's sides (docs/conventions.md). */
enum determinant { BEFORE, AFTER, PATH, SIDE_OF_A, SIDE_OF_B, DETERMINANTS };

struct test {
  int sign[DETERMINANTS];      /* exact: -1, 0, 1 */
  bool doubtful[DETERMINANTS]; /* doubles cannot tell it, and it is not 0 */
  double size;                 /* largest difference, a0 */
  bool flip;
};

static bool doubtful(struct point o, struct point u, struct point v, struct point w)
{
  const struct vec3 p = point_difference(u, o), q = point_difference(v, o), r = point_difference(w, o);
  const double det = r.x * (p.y * q.z - p.z * q.y) + r.y * (p.z * q.x - p.x * q.z) + r.z * (p.x * q.y - p.y * q.x);
  const double size = fabs(r.x) * (fabs(p.y * q.z) + fabs(p.z * q.y)) +
                      fabs(r.y) * (fabs(p.z * q.x) + fabs(p.x * q.z)) + fabs(r.z) * (fabs(p.x * q.y) + fabs(p.y * q.x));
  return fabs(det) <= 16.0 * 0x1p-53 * size;
}

/* False if the pack has not all inputs of this row. */
static bool take_test(const struct oracle_pair *p, uint32_t row, struct test *t)
{
  static const char *const names[5] = {"in.from", "in.to", "in.pivot", "in.a", "in.b"};
  const struct pack_table *flip = oracle_sibling(p, "in.flip");
  struct point r[5];
  for (int k = 0; k < 5; k++) {
    const struct pack_table *points = oracle_sibling(p, names[k]);
    if (!oracle_is_vectors(points, false, row))
      return false;
    r[k] = oracle_point(points, row);
  }
  const struct point at[DETERMINANTS][4] = {{r[3], r[4], r[2], r[0]},
                                            {r[3], r[4], r[2], r[1]},
                                            {r[3], r[4], r[0], r[1]},
                                            {r[2], r[0], r[1], r[3]},
                                            {r[2], r[0], r[1], r[4]}};
  *t = (struct test){.flip = flip && pack_value(flip, row, 0) != 0.0};
  for (int k = 0; k < DETERMINANTS; k++) {
    t->sign[k] = crossing_orientation(at[k][0], at[k][1], at[k][2], at[k][3]);
    t->doubtful[k] = t->sign[k] != 0 && doubtful(at[k][0], at[k][1], at[k][2], at[k][3]);
    t->size = fmax(t->size, vec3_norm(point_difference(r[k], r[(k + 1) % 5])));
  }
  return true;
}

/* True if all tests whose verdicts differ are of this kind. */
static bool only(const struct oracle_pair *p, bool (*kind)(const struct test *))
{
  bool any = false;
  for (uint32_t row = 0; row < oracle_common_rows(p); row++) {
    struct test t;
    if (oracle_agrees(p, row, 0))
      continue;
    if (!take_test(p, row, &t) || !kind(&t))
      return false;
    any = true;
  }
  return any;
}

static bool has_zero(const struct test *t)
{
  return !t->sign[0] || !t->sign[1] || !t->sign[2] || !t->sign[3] || !t->sign[4];
}

static bool has_doubt(const struct test *t)
{
  return has_zero(t) || t->doubtful[0] || t->doubtful[1] || t->doubtful[2] || t->doubtful[3] || t->doubtful[4];
}

static bool is_wide(const struct test *t)
{
  return t->size > 4.0;
}

static bool only_zeros(const struct oracle_pair *p)
{
  return only(p, has_zero);
}

static bool only_doubts(const struct oracle_pair *p)
{
  return only(p, has_doubt);
}

static bool only_wide(const struct oracle_pair *p)
{
  return only(p, is_wide);
}

/* --- permutations ---- */

/* Each number once, and nearly all where they are in ours. seen: [rows] of zeros. */
static bool nearly_ours(const struct oracle_pair *p, uint8_t *seen)
{
  uint32_t wrong = 0;
  for (uint32_t row = 0; row < p->theirs->rows; row++) {
    const double entry = pack_value(p->theirs, row, 0);
    if (!(entry >= 0.0 && entry < p->theirs->rows) || seen[(uint32_t)entry]++)
      return false;
    wrong += !oracle_agrees(p, row, 0);
  }
  return wrong < p->theirs->rows / 64;
}

static bool few_exchanged(const struct oracle_pair *p)
{
  uint8_t *seen = calloc((size_t)p->theirs->rows + 1, 1);
  const bool few = seen && p->ours->rows == p->theirs->rows && nearly_ours(p, seen);
  free(seen);
  return few;
}

const struct oracle_pattern oracle_patterns_contact[] = {
    {"permutation", "out.order", "permutation: few entries are exchanged; its index needs all 64 bits of the integer",
     few_exchanged},
    {"crossing", "out.crosses", "a determinant that is exactly zero: it counts as positive, but for `flip`",
     only_zeros},
    {"crossing", "out.crosses", "integers of 128 bits or fewer: a determinant of a large box does not fit", only_wide},
    {"crossing", "out.crosses", "determinants in doubles only: near zero their sign needs exact integers", only_doubts},
    {.meaning = NULL},
};
