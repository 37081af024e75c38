/*
 * A plan: the list of the functions that a step calls, in order. It is made once for a run (step_plan in step.c). Each
 * room appends its own stages, and only those that the scene needs.
 *
 * A stage does not hold a pointer to its room's scratch but the offset of the scratch in struct work. So a work may be
 * moved.
 */
#ifndef UNCROSS_SYSTEM_PLAN_H
#define UNCROSS_SYSTEM_PLAN_H

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"

/* The step that is being made: what every stage is given. */
struct moment {
  struct state *state;
  const struct model *model;
  struct fault *fault;
  const struct contact_log *log; /* receives contacts; NULL in runs */
  uint64_t step;                 /* number of the step: 1, 2, ... */
};

struct stage {
  const char *name; /* of the action, in its last stage; as in traces. NULL: more stages of the action follow */
  bool (*act)(void *room, const struct moment *now,
              const struct stage *stage); /* `room`: its scratch. False, with the fault recorded, on failure */
  size_t room;                            /* offset of the room's scratch in struct work, bytes */
  double fraction;                        /* of dt, for drifts and kicks */
  uint32_t drift;                         /* number of the drift within the step: 0, 1 */
};

enum { PLAN_MOST_STAGES = 16 };

struct plan {
  uint32_t stages;
  struct stage stage[PLAN_MOST_STAGES];
};

static inline void plan_append(struct plan *plan, struct stage stage)
{
  plan->stage[plan->stages++] = stage;
}

#endif
