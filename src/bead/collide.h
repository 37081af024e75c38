/* Collisions around the bead: what flights (collide.c) and virtual particles (matter.c) share. */
#ifndef UNCROSS_BEAD_COLLIDE_H
#define UNCROSS_BEAD_COLLIDE_H

#include <math.h>

#include "bead/bead.h"

/* Cells of the shifted grid around a point: numbers along each axis, not folded; and the point in these numbers. */
struct surround {
  int64_t low[3], high[3]; /* both included */
  double center[3];        /* cell i reaches from i to i + 1 */
};

/* All cells with a part within a distance of the bead. */
struct surround bead_surround(const struct bead *bead, const struct model *model, const struct mpc *c, double distance);

/* A number of a row of cells, folded into the box. */
static inline uint32_t surround_folded(int64_t i, int cells)
{
  return (uint32_t)(i < 0 ? i + cells : i >= cells ? i - cells : i);
}

/* Number of a cell. */
static inline uint32_t surround_cell(const struct box *box, int64_t x, int64_t y, int64_t z)
{
  return (surround_folded(z, box->rows[2]) * (uint32_t)box->rows[1] + surround_folded(y, box->rows[1])) *
             (uint32_t)box->rows[0] +
         surround_folded(x, box->rows[0]);
}

/* Of the interval of a cell along an axis, from the center: square of the least and of the largest distance. */
static inline double surround_least(const struct surround *s, int k, int64_t i)
{
  const double below = (double)i - s->center[k], above = s->center[k] - (double)(i + 1);
  const double d = fmax(0.0, fmax(below, above));
  return d * d;
}

static inline double surround_largest(const struct surround *s, int k, int64_t i)
{
  const double d = fmax(fabs((double)i - s->center[k]), fabs((double)(i + 1) - s->center[k]));
  return d * d;
}

/* Functions of struct obstacle; room: struct bead_work. */
bool bead_rebound(void *room, struct state *state, const struct model *model, struct mpc *c, uint64_t step,
                  uint64_t *span, struct fault *fault);
bool bead_fill(void *room, const struct state *state, const struct model *model, struct mpc *c, uint64_t step,
               struct fault *fault);
void bead_settle(void *room, struct state *state, const struct model *model, struct mpc *c, uint64_t step);

/* The bead takes what its virtual particles have gained. */
void bead_take_gain(const struct bead_cuts *cuts, struct state *state, const struct model *model, struct mpc *c,
                    uint64_t step);

#endif
