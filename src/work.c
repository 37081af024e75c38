#include "work.h"

#include <string.h>

#include "fluid/fluid.h"
#include "kernel/choose.h"
#include "step.h"

bool work_alloc(struct work *w, const struct model *m)
{
  memset(w, 0, sizeof *w);
  if (!mpc_alloc(&w->mpc, m, fluid_of(m), false) || !contact_alloc(&w->contact, m, fiber_force_at, false) ||
      !fiber_alloc(&w->fiber, m) || !medium_alloc(&w->medium, m, fluid_of(m)) || !bead_alloc(&w->bead, m)) {
    work_free(w);
    return false;
  }
  bead_join(w->bead, &w->mpc, &w->contact);
  w->mpc.kernel = kernel_choose(m);
  step_plan(w, m);
  return true;
}

bool work_add_everything(struct work *w, const struct model *m)
{
  struct mpc mpc;
  struct contact contact;
  if (!mpc_alloc(&mpc, m, fluid_of(m), true))
    return false;
  if (!contact_alloc(&contact, m, fiber_force_at, true)) {
    mpc_free(&mpc);
    return false;
  }
  mpc.kernel = w->mpc.kernel;
  mpc_free(&w->mpc);
  contact_free(&w->contact);
  w->mpc = mpc;
  w->contact = contact;
  bead_join(w->bead, &w->mpc, &w->contact);
  return true;
}

void work_free(struct work *w)
{
  mpc_free(&w->mpc);
  contact_free(&w->contact);
  fiber_free(&w->fiber);
  medium_free(&w->medium);
  bead_free(w->bead);
  memset(w, 0, sizeof *w);
}

uint64_t work_bytes(const struct model *m)
{
  return state_memory(m) + mpc_bytes(m) + contact_bytes(m) + fiber_bytes(m) + medium_bytes(m) + medium_bytes_later(m) +
         bead_bytes(m);
}
