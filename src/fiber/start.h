/* Starting positions and velocities of fibers. */
#ifndef UNCROSS_FIBER_START_H
#define UNCROSS_FIBER_START_H

#include "system/model.h"
#include "system/state.h"

/* Where thick fibers are laid: whether this one, which has just been laid, may stay. */
enum fiber_verdict { FIBER_STAYS, FIBER_OVERLAPS, FIBER_NO_MEMORY, FIBER_GIVEN_UP };
struct fiber_room {
  enum fiber_verdict (*judge)(void *context, const struct point *position, uint32_t fiber);
  void *context;
};

#define FIBER_MOST_ATTEMPTS 100000 /* to lay one fiber at random */

/* What became of a start; fiber: the one that overlaps, or has no room. */
enum fiber_start_end { FIBERS_LAID, FIBERS_OVERLAP, FIBERS_NO_ROOM, FIBERS_NO_MEMORY, FIBERS_GIVEN_UP };

/* Sets positions by each kind's `start`, and velocities from the Maxwell distribution (kT = 1).
 *
 * - equilibrium: the first vertex uniform in the box, then bond by bond: lengths from p(l) ~ l^2 exp(-k (l-l0)^2 / 2),
 *   bends from p(cos) ~ exp(kappa cos), azimuths uniform. This is the exact equilibrium distribution of the open
 *   phantom chain, and of the noncrossing one: thin lines exclude no volume.
 * - straight: vertices spaced by the mean bond length.
 * - circle: the same, on a circle.
 *
 * Straight fibers and circles without a place of their own get a uniform centre and a uniform direction.
 *
 * With a room (NULL: none), fibers that have places are laid first, then the others. One that overlaps is laid anew,
 * shape and place, FIBER_MOST_ATTEMPTS times at most. fiber: set to the one that could not be laid. */
enum fiber_start_end fiber_start(struct state *state, const struct model *model, const struct fiber_room *room,
                                 uint32_t *fiber);

#endif
