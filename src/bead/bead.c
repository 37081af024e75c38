#include "bead/bead.h"

#include <stdlib.h>

#include "base/memory.h"
#include "base/normal.h"
#include "bead/collide.h"
#include "bead/company.h"
#include "fluid/fluid.h"
#include "system/plan.h"

/* --- scratch ------------------------------------------------------------------------------------------------------ */

bool bead_alloc(struct bead_work **work, const struct model *m)
{
  *work = NULL;
  if (!model_has_bead(m))
    return true;
  struct bead_work *w = calloc(1, sizeof *w);
  if (!w)
    return false;
  w->company.limit = memory_alloc(m->vertices, sizeof *w->company.limit);
  w->company.listed = memory_alloc(m->vertices, sizeof *w->company.listed);
  w->obstacle = (struct obstacle){w, bead_rebound, bead_fill, bead_settle};
  w->timeline = bead_timeline;
  w->timeline.body = w;
  if (w->company.limit && w->company.listed) {
    *work = w;
    return true;
  }
  bead_free(w);
  return false;
}

void bead_free(struct bead_work *w)
{
  if (!w)
    return;
  free(w->flight.at);
  free(w->company.limit);
  free(w->company.listed);
  free(w->company.at);
  free(w->cuts.cut);
  free(w->cuts.number);
  free(w->cuts.normal);
  free(w);
}

uint64_t bead_bytes(const struct model *m)
{
  const struct bead_work *w = NULL;
  return model_has_bead(m) ? (uint64_t)m->vertices * (sizeof *w->company.limit + sizeof *w->company.listed) : 0;
}

void bead_join(struct bead_work *w, struct mpc *mpc, struct contact *contact)
{
  mpc->obstacle = w ? &w->obstacle : NULL;
  contact->beside = w ? &w->timeline : NULL;
}

/* --- a step ------------------------------------------------------------------------------------------------------- */

static bool act_alone(void *room, const struct moment *now, const struct stage *stage)
{
  struct bead_work *const *work = room;
  (void)stage;
  return bead_flight_alone(now->state, now->model, &(*work)->flight, now->fault);
}

void bead_plan_drift(struct plan *plan, const struct model *m, size_t room)
{
  if (model_has_bead(m) && m->vertices == 0)
    plan_append(plan, (struct stage){.act = act_alone, .room = room});
}

/* --- start -------------------------------------------------------------------------------------------------------- */

static struct point place_of(const struct solvent *s, uint32_t i)
{
  return (struct point){s->x[i], s->y[i], s->z[i]};
}

void bead_start(struct state *state, const struct model *model)
{
  const struct vec3 c = model->bead.center;
  struct solvent *s = &state->solvent;
  double v[3];
  random_normal_three(random_at(model->seed, RANDOM_BEAD_REST, 0, 0, 0), v);
  *state->bead = (struct bead){.position = {lattice_from_a0(c.x), lattice_from_a0(c.y), lattice_from_a0(c.z)},
                               .velocity = vec3_scale(1.0 / sqrt(model->bead.mass), (struct vec3){v[0], v[1], v[2]})};
  for (uint32_t i = 0; i < s->n; i++)
    for (uint32_t attempt = 1; !bead_is_outside(model, state->bead->position, place_of(s, i)); attempt++) {
      const struct point x = fluid_start_place(model, s->id[i], attempt);
      s->x[i] = x.x, s->y[i] = x.y, s->z[i] = x.z;
    }
}
