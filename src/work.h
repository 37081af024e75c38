/*
 * work: the scratch of all rooms that take part in a step, and the plans of a step. It can be rebuilt from model and
 * state at any time. It does not change results: a run whose work is thrown away and rebuilt after every step ends in
 * the same bits.
 */
#ifndef UNCROSS_WORK_H
#define UNCROSS_WORK_H

#include "bead/bead.h"
#include "contact/contact.h"
#include "fiber/force.h"
#include "medium/medium.h"
#include "mpc/mpc.h"
#include "system/plan.h"

/* Asked while fibers are laid, which may take long: false gives the start up. keep_on: NULL if nobody asks. */
struct start_watch {
  bool (*keep_on)(void *context);
  void *context;
};

struct work {
  struct mpc mpc;
  struct contact contact;
  struct fiber fiber;
  struct medium medium;
  struct bead_work *bead; /* NULL: there is none */
  struct plan plan[2];    /* [0]: of a step without a collision, [1]: with one */
  struct start_watch watch;
  struct fault fault; /* code FAULT_NONE while all is well */
};

/* Allocates the scratch that this model uses, and makes the plans of its steps. False if memory is short; nothing needs
 * freeing then. */
bool work_alloc(struct work *work, const struct model *model);

/* Adds the scratch that other scenes of the same size need: for callers of single parts of a step (oracle, tests).
 * False, with the work as it was, if memory is short. */
bool work_add_everything(struct work *work, const struct model *model);
void work_free(struct work *work);

/* Bytes of state and work of this model. Lists of pairs of a medium are as long as is expected, others as they begin.
 */
uint64_t work_bytes(const struct model *model);

#endif
