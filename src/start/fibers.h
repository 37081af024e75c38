/* Where the fibers of a starting state lie. */
#ifndef UNCROSS_START_FIBERS_H
#define UNCROSS_START_FIBERS_H

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"
#include "work.h"

/* Lays all fibers, the thick ones without overlap, and all of them outside of a bead. False, with the fault recorded,
 * if one has no room, does not fit where the scene places it, or if the watch (NULL: nobody) gives the start up. */
bool start_fibers(struct state *state, const struct model *model, const struct start_watch *watch, struct fault *fault);

/* Does it matter where fibers are? True if some are thick, with a bead, and for lines at places where none may touch.
 */
bool start_is_crowded(const struct model *model);

#endif
