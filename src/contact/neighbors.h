/*
 * The broad phase: the pairs of bonds that are near enough to touch soon.
 *
 * Every vertex has a reference position: the place where it stood when its bonds last searched for partners. While it
 * stays within a distance of that place, the skin, its bonds stay in capsules around the lines between reference
 * positions. Bonds whose capsules are apart cannot touch. All pairs of bonds (and images of bonds) whose capsules are
 * not shown to be apart are in one list, the pair list (contact/pairs.h). A vertex that is about to leave its skin
 * takes a new reference position, and its one or two bonds search for partners again. Their older pairs are then out of
 * date. So one fast vertex costs the search of two bonds, not a rebuild of the whole list.
 *
 * Most pairs of the list cannot touch in the next step; contact/candidates.h finds those that may.
 *
 * Capsules are apart if the boxes around them are apart, or if the distance of the two bonds is larger than both
 * reaches (contact/capsule.h). Bonds that pass each other at an angle often have boxes that overlap and a clear
 * distance; so the second test removes most of the pairs that the first would give.
 *
 * Partners are found in a grid of search cells. A cell lists every bond whose capsule's box touches it, with the image
 * of the bond that lies there and, roughly, the part of the box that lies in the cell. So most bonds of a cell are
 * skipped without reading their positions. The grid works for bonds of any length, in boxes of any size down to one
 * cell. A search mostly waits for memory; contact/renewals.h prefetches it.
 *
 * Two bonds that share a vertex are never partners, and neither are a bond and its own image: every bond is shorter
 * than half a box edge, so they cannot cross. The length of bonds is checked where forces are computed, once in a step.
 * A bond that is too long only between two checks is not noticed.
 */
#ifndef UNCROSS_CONTACT_NEIGHBORS_H
#define UNCROSS_CONTACT_NEIGHBORS_H

#include "contact/contact.h"

/* a0: the skin of a reference position; larger only if the move for which the position is taken is longer. The value
 * gave the shortest run time (docs/accuracy.md). Results do not depend on it. */
#define NEIGHBORS_SKIN 0.17

/* Makes reference positions, grid and pairs of all bonds anew. False, with the fault recorded, if memory is short
 * or a bond is so long that the grid cannot hold it (two edges of the box, far longer than forces allow). */
bool neighbors_build(const struct state *state, const struct model *model, struct contact *contact,
                     struct fault *fault);

#define NEIGHBORS_AT_ONCE 8

/* Takes new reference positions for n vertices, 0 < n <= NEIGHBORS_AT_ONCE, and finds new pairs for their bonds. from,
 * to: both ends of the straight moves that the vertices are about to make; the new skins contain them. False, with the
 * fault recorded, if memory is short. */
bool neighbors_renew(const struct state *state, const struct model *model, struct contact *contact, uint32_t n,
                     const uint32_t *vertex, const struct point *from, const struct point *to, struct fault *fault);

/* Prefetches the search cells that neighbors_renew will visit for this vertex. Without it, most of the time there is
 * spent waiting for memory. */
void neighbors_fetch(struct neighbors *nb, const struct model *model, uint32_t vertex);

/* Lists in `near` all bonds that bond `bond` may touch if its ends stay within `range` (a0) of end[0] and end[1], while
 * the vertices of the others stay within their skins. The list may hold a few bonds more. False, with the fault
 * recorded, if memory is short.
 */
bool neighbors_near(const struct state *state, const struct model *model, struct contact *contact, uint32_t bond,
                    const struct point end[2], double range, struct neighbor_list *near, struct fault *fault);

/* True if a vertex at p is within the skin of its reference position. Then the pairs of its bonds are complete. */
static inline bool neighbors_hold(const struct neighbors *nb, uint32_t vertex, struct point p)
{
  const struct vec3 d = point_difference(p, point_plus(nb->reference[vertex].at, nb->moved));
  return vec3_dot(d, d) <= nb->reference[vertex].skin * nb->reference[vertex].skin;
}

#endif
