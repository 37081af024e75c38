/* One time step of a suspension: the paper's main loop. */
#ifndef UNCROSS_STEP_H
#define UNCROSS_STEP_H

#include "fiber/sweep.h"
#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* Advances the state by one time step dt. log: told of every hit of the crossing test, or NULL.
 * False, with work->fault saying why, if the step cannot be made; the state is then not to be used any more. */
bool step_advance(struct state *state, const struct model *model, struct work *work, const struct sweep_log *log);

/* Who looks at the state after each stage of a step (drift, collide, force, kick), while state->step is still the one
 * before; NULL in runs. */
struct step_watch {
  void (*look)(void *context, const char *stage, const struct state *state);
  void *context;
};

/* The same step, watched. */
bool step_advance_watched(struct state *state, const struct model *model, struct work *work,
                          const struct sweep_log *log, const struct step_watch *watch);

/* True if a collision belongs to step number `step` (the first step is number 1). */
static inline bool step_collides(const struct model *model, uint64_t step)
{
  return model_collides(model) && step % model->solvent.interval_steps == 0;
}

/* The starting state (Padding 2009, Sec. III, step 1): solvent, fibers, no total momentum but the flow's (in a bath of
 * phantoms, a thermal one), and velocities half a step ahead. False, with the fault recorded, if a bond does not fit
 * the box. */
bool step_start(struct state *state, const struct model *model, struct work *work);

#endif
