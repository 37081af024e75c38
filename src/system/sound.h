/* Whether a run can go on from a state that comes from a file. */
#ifndef UNCROSS_SYSTEM_SOUND_H
#define UNCROSS_SYSTEM_SOUND_H

#include <stdbool.h>

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"

/* True if vertices are within LATTICE_REACH, bonds shorter than half the shortest edge, solvent particles in the box,
 * springs of dumbbells between their particles, all velocities finite, and no solvent particle has flown
 * LATTICE_MAX_MOVE or further in the time by which it lags. Otherwise the fault says what is wrong first. Every state
 * that step_advance leaves passes, unless its next step would find the same fault. Of the model: box, time step,
 * acceleration, and bonds if `next` is not NULL. */
bool state_sound(const struct state *state, const struct model *model, struct fault *fault);

#endif
