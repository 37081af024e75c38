/* What went wrong in the grid, where no relation tells it. */
#include <math.h>

#include "oracle/patterns.h"

/* --- cells ------------------------------------------------------------------------------------------------------- */

/* Position plus so many shifts; false if the pack has none. */
static bool shifted(const struct oracle_pair *p, uint32_t row, int64_t sign, struct box *box, struct point *at)
{
  const struct pack_table *r = oracle_input(p), *shift = oracle_sibling(p, "in.shift");
  const int64_t reach = (int64_t)1 << 61;
  if (!oracle_is_vectors(r, false, row) || !oracle_is_vectors(shift, false, 0) || !oracle_box(p, box))
    return false;
  for (uint32_t k = 0; k < 3; k++)
    if (fabs(pack_value(r, row, k)) > (double)reach || fabs(pack_value(shift, 0, k)) > (double)reach)
      return false;
  const struct point s = oracle_point(shift, 0);
  *at = oracle_point(r, row);
  at->x += sign * s.x, at->y += sign * s.y, at->z += sign * s.z;
  return true;
}

/* True if cells are wrong nowhere but at such places, and somewhere. */
static bool wrong_only_where(const struct oracle_pair *p, bool (*such)(const struct box *, struct point))
{
  bool any = false;
  for (uint32_t row = 0; row < oracle_common_rows(p); row++) {
    struct box box;
    struct point at;
    if (oracle_agrees(p, row, 0))
      continue;
    if (!shifted(p, row, 1, &box, &at) || !such(&box, at))
      return false;
    any = true;
  }
  return any;
}

static bool on_face(const struct box *box, struct point at)
{
  (void)box;
  return at.x % LATTICE_CELL == 0 || at.y % LATTICE_CELL == 0 || at.z % LATTICE_CELL == 0;
}

/* More than one edge outside. */
static bool far_outside(const struct box *box, struct point at)
{
  const int64_t image[3] = {lattice_image(at.x, box->edge[0]), lattice_image(at.y, box->edge[1]),
                            lattice_image(at.z, box->edge[2])};
  bool far = false;
  for (int k = 0; k < 3; k++)
    far |= image[k] < -1 || image[k] > 1;
  return far;
}

static bool faces_wrong(const struct oracle_pair *p)
{
  return wrong_only_where(p, on_face);
}

static bool wrapped_once(const struct oracle_pair *p)
{
  return wrong_only_where(p, far_outside);
}

const struct oracle_pattern oracle_patterns_solvent[] = {
    {"bin", NULL, "cells are half-open: what lies on a face belongs to the cell above it", faces_wrong},
    {"bin", NULL, "wrapped by one edge at most: unwrapped vertices may be further away", wrapped_once},
    {.meaning = NULL},
};
