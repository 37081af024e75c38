/* One time step of a suspension: the paper's main loop. */
#ifndef UNCROSS_STEP_H
#define UNCROSS_STEP_H

#include "work.h"

/* Advances the state by one time step dt. log: receives every contact; or NULL.
 * False, with the reason in work->fault, if the step cannot be made; the state must not be used any more then. */
bool step_advance(struct state *state, const struct model *model, struct work *work, const struct contact_log *log);

/* A function that is called after each action of a step (drift, collide, force, kick). state->step is still the number
 * of the step before. NULL in runs. */
struct step_watch {
  void (*look)(void *context, const char *stage, const struct state *state);
  void *context;
};

/* The same step; `watch` is called after each action. NULL: as step_advance. */
bool step_advance_watched(struct state *state, const struct model *model, struct work *work,
                          const struct contact_log *log, const struct step_watch *watch);

/* True if a collision belongs to step number `step` (the first step is number 1). */
static inline bool step_collides(const struct model *model, uint64_t step)
{
  return model_collides(model) && step % model->solvent.interval_steps == 0;
}

/* Makes the plans of this model's steps in its work; work_alloc calls it. */
void step_plan(struct work *work, const struct model *model);

#endif
