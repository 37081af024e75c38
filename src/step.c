/*
 * START HERE. The algorithm of Padding 2009, Sec. III, as the paper lists it:
 *
 *   1  coordinates and velocities                       start/start.c, or a snapshot (files/)
 *   2  stream the solvent                 Eq. (3)       fluid/points.c
 *   3  move the vertices                  Eq. (4)       one by one as the paper does: contact/sequential.c, line.c;
 *      so that no bonds cross                           all at once: contact/event_driven.c; exchanges: impulse.h
 *   4  SRD collision                      Eqs. (5, 6)   mpc/collide.c, rules/srd.h
 *   5  forces                             Eqs. (1, 2)   fiber/force.c
 *   6  kick                               Eqs. (7, 8)   fiber/force.c
 *   7  again                                            the caller of step_advance
 *   8  save                                             files/
 *
 * A step is a short list of actions. On most steps it is the leap-frog's: drift, force, kick. On a step with a
 * collision, the collision stands where the scene's scheme (its key `order`) puts it; docs/accuracy.md measures what
 * the choice costs:
 *
 *   paper        after the drift, before the kick: velocities of half a step ago collide at positions of now
 *   kick-split   between two half kicks: velocities and positions of the same time
 *   drift-split  between two half drifts: the same, half a step earlier
 *
 * Overdamped vertices (medium: {kind: overdamped}) have no velocities: a step is forces and one move.
 *
 * Each action becomes stages: each room that has a part in it (fiber/, contact/, mpc/) appends its own. The list of
 * stages is the plan (system/plan.h). It is made once for a run, and holds only what the scene needs.
 *
 * Solvent particles fly freely between collisions. So they are streamed when a collision needs them, over the whole
 * interval at once. Until then a drift only adds to their lag. A random solvent (bath: phantoms) has no particles to
 * stream.
 */
#include "step.h"

#include <stddef.h>

#include "medium/plan.h"
#include "mpc/plan.h"
#include "system/bead.h"

enum action { END, DRIFT, COLLIDE, FORCE, KICK, MOVE };

struct part {
  enum action action;
  double fraction; /* of dt, for DRIFT and KICK */
};

static const struct part without_collision[] = {{DRIFT, 1.0}, {FORCE, 0}, {KICK, 1.0}, {END, 0}};

/* Vertices without velocities move at once. */
static const struct part overdamped[] = {{FORCE, 0}, {MOVE, 1.0}, {END, 0}};

static const struct part with_collision[SCHEMES][6] = {
    [SCHEME_PAPER] = {{DRIFT, 1.0}, {COLLIDE, 0}, {FORCE, 0}, {KICK, 1.0}, {END, 0}},
    [SCHEME_KICK_SPLIT] = {{DRIFT, 1.0}, {FORCE, 0}, {KICK, 0.5}, {COLLIDE, 0}, {KICK, 0.5}, {END, 0}},
    [SCHEME_DRIFT_SPLIT] = {{DRIFT, 0.5}, {COLLIDE, 0}, {DRIFT, 0.5}, {FORCE, 0}, {KICK, 1.0}, {END, 0}},
};

/* The solvent's part in a drift: its lag grows, by one half step or two. */
static bool act_lag(void *room, const struct moment *now, const struct stage *stage)
{
  (void)room;
  now->state->solvent_lag += stage->fraction == 0.5 ? 1 : 2;
  return true;
}

static void plan_drift(struct plan *plan, const struct model *m, double fraction, uint32_t drift)
{
  bead_plan_drift(plan, m, offsetof(struct work, bead));
  bead_plan_counter(plan, m);
  contact_plan_drift(plan, m, offsetof(struct work, contact), fraction, drift);
  bead_plan_counter(plan, m);
  plan_append(plan, (struct stage){.name = "drift", .act = act_lag, .fraction = fraction});
}

static void plan_actions(struct plan *plan, const struct part *part, const struct model *m)
{
  uint32_t drift = 0;
  for (plan->stages = 0; part->action != END; part++) {
    switch (part->action) {
    case DRIFT:
      plan_drift(plan, m, part->fraction, drift++);
      break;
    case COLLIDE:
      mpc_plan_collision(plan, m, offsetof(struct work, mpc), "collide");
      medium_plan_collision(plan, m, offsetof(struct work, medium), "collide");
      break;
    case FORCE:
      medium_plan_forces(plan, m, offsetof(struct work, medium), m->vertices > 0 ? NULL : "force");
      fiber_plan_forces(plan, m, offsetof(struct work, fiber), "force");
      break;
    case KICK:
      medium_plan_kick(plan, m, offsetof(struct work, medium), part->fraction, m->vertices > 0 ? NULL : "kick");
      fiber_plan_kick(plan, m, offsetof(struct work, fiber), part->fraction, "kick");
      break;
    case MOVE:
      fiber_plan_move(plan, m, offsetof(struct work, fiber), "move");
      break;
    case END:
      break;
    }
  }
}

void step_plan(struct work *work, const struct model *model)
{
  const bool moves = model_is_overdamped(model);
  plan_actions(&work->plan[false], moves ? overdamped : without_collision, model);
  plan_actions(&work->plan[true], moves ? overdamped : with_collision[model->scheme], model);
}

bool step_advance_watched(struct state *state, const struct model *model, struct work *work,
                          const struct contact_log *log, const struct step_watch *watch)
{
  const struct moment now = {state, model, &work->fault, log, state->step + 1};
  const struct plan *plan = &work->plan[step_collides(model, now.step)];
  bool ok = true;
  for (const struct stage *stage = plan->stage; ok && stage < plan->stage + plan->stages; stage++) {
    ok = stage->act((char *)work + stage->room, &now, stage);
    if (watch && stage->name)
      watch->look(watch->context, stage->name, state);
  }
  state->step = now.step;
  return ok;
}

bool step_advance(struct state *state, const struct model *model, struct work *work, const struct contact_log *log)
{
  return step_advance_watched(state, model, work, log, NULL);
}
