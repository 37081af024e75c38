/*
 * Which bonds could a moving bond touch?
 *
 * Every vertex has an anchor: the place where it stood when its bonds last looked for partners. While it stays within a
 * margin of its anchor, its bonds stay in capsules around the lines between anchors, and bonds whose capsules are apart
 * cannot touch. All pairs of bonds (and images of bonds) whose capsules are not shown to be apart are in one list. A
 * vertex that is about to leave its anchor takes a new one, and its one or two bonds look for partners again; what the
 * list said of them before is out of date by their generation, and dropped when it is next read. One fast vertex costs
 * two bonds' work, not everybody's.
 *
 * Most pairs in the list cannot touch for a while either: fiber/meetings.h has those that may.
 *
 * Capsules are apart if a plane with a margin on either side goes between them: perpendicular to an edge of the box, or
 * to both bonds. Bonds that pass each other at right angles have wide boxes and a clear distance; the second kind of
 * plane spares most of the pairs that boxes alone would give.
 *
 * Partners are found in a grid whose cells list every bond whose capsule's box touches them, each with the image that
 * puts it there and, roughly, the part of the box that lies in the cell: most bonds of a cell are passed over without a
 * look at where they are. That holds for bonds of any length, in boxes of any size down to one cell. What a new anchor
 * costs is waiting for memory, so anchors are taken several at a time, and memory is asked ahead. Bonds that share a
 * vertex with this one, or an image of it, are never partners: no bond reaches half a box edge, so they cannot cross.
 * (A bond that does within a step, but not where forces are next computed, is not noticed.)
 */
#ifndef UNCROSS_NEIGHBORS_H
#define UNCROSS_NEIGHBORS_H

#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* a0: reach of an anchor, if the move for which it is taken is no longer. Measured: see docs/accuracy.md; results do
 * not depend on it. */
#define NEIGHBORS_MARGIN 0.17

/* Anchors, grid and pairs of all bonds from scratch. False, with the fault recorded, if memory is short. */
bool neighbors_build(const struct state *state, const struct model *model, struct work *work);

#define NEIGHBORS_AT_ONCE 8

/* New anchors for n vertices, 0 < n <= NEIGHBORS_AT_ONCE, that move, or try to move, to `to`, and new pairs for their
 * bonds. False, with the fault recorded, if memory is short. */
bool neighbors_renew(const struct state *state, const struct model *model, struct work *work, uint32_t n,
                     const uint32_t *vertex, const struct point *to);

/* All bonds that bond `bond` may touch, wherever these are within reach of their anchors, if its ends go no further
 * than `range` (a0) from end[0] and end[1]; and some more. False, with the fault recorded, if memory is short. */
bool neighbors_near(const struct state *state, const struct model *model, struct work *work, uint32_t bond,
                    const struct point end[2], double range, struct neighbor_list *near);

/* Is a vertex at p still where its anchor's pairs are good for? */
static inline bool neighbors_hold(const struct neighbors *nb, uint32_t vertex, struct point p)
{
  const struct vec3 d = point_difference(p, point_plus(nb->anchor[vertex].at, nb->moved));
  return vec3_dot(d, d) <= nb->anchor[vertex].reach * nb->anchor[vertex].reach;
}

#endif
