/*
 * START HERE. The algorithm of Padding 2009, Sec. III, as the paper lists it:
 *
 *   1  coordinates and velocities                       step_start, or a snapshot (io/)
 *   2  stream the solvent                 Eq. (3)       solvent/stream.c
 *   3  move the vertices, one by one      Eq. (4)       fiber/sweep.c; crossings: crossing.c, exchange.h
 *   4  SRD collision                      Eqs. (5, 6)   solvent/collide.c, srd.h
 *   5  forces                             Eqs. (1, 2)   fiber/force.c
 *   6  kick                               Eqs. (7, 8)   fiber/force.c
 *   7  again                                            whoever calls step_advance
 *   8  save                                             io/
 *
 * A step is a short list of stages. On most steps it is the leap-frog's: drift, force, kick. On a step with a
 * collision, the collision stands where the scene's `order` puts it (docs/accuracy.md measures what the choice costs):
 *
 *   paper        after the drift, before the kick: velocities of half a step ago collide at positions of now
 *   kick-split   between two half kicks: velocities and positions of the same time
 *   drift-split  between two half drifts: the same, half a step earlier
 *
 * Solvent particles fly freely between collisions, so they are streamed when a collision needs them, over the whole
 * interval at once; until then a drift only adds to their lag. A bath of phantoms has no particles to stream.
 */
#include "step.h"

#include "fiber/force.h"
#include "fiber/start.h"
#include "solvent/bath.h"
#include "solvent/solvent.h"

enum action { END, DRIFT, COLLIDE, FORCE, KICK };

struct stage {
  enum action action;
  double fraction; /* of dt, for DRIFT and KICK */
};

static const struct stage without_collision[] = {{DRIFT, 1.0}, {FORCE, 0}, {KICK, 1.0}, {END, 0}};

static const struct stage with_collision[][6] = {
    [ORDER_PAPER] = {{DRIFT, 1.0}, {COLLIDE, 0}, {FORCE, 0}, {KICK, 1.0}, {END, 0}},
    [ORDER_KICK_SPLIT] = {{DRIFT, 1.0}, {FORCE, 0}, {KICK, 0.5}, {COLLIDE, 0}, {KICK, 0.5}, {END, 0}},
    [ORDER_DRIFT_SPLIT] = {{DRIFT, 0.5}, {COLLIDE, 0}, {DRIFT, 0.5}, {FORCE, 0}, {KICK, 1.0}, {END, 0}},
};

typedef bool collision(struct state *, const struct model *, struct work *, uint64_t step);

static collision *const collide[] = {[BATH_PARTICLES] = solvent_collide, [BATH_PHANTOMS] = bath_collide};

static const char *const action_names[] = {
    [END] = "end", [DRIFT] = "drift", [COLLIDE] = "collide", [FORCE] = "force", [KICK] = "kick"};

bool step_advance_watched(struct state *state, const struct model *model, struct work *work,
                          const struct sweep_log *log, const struct step_watch *watch)
{
  const uint64_t step = state->step + 1;
  const struct stage *stage = step_collides(model, step) ? with_collision[model->order] : without_collision;
  uint32_t sweep = 0;
  bool ok = true;
  for (; ok && stage->action != END; stage++) {
    switch (stage->action) {
    case DRIFT:
      ok = fiber_sweep(state, model, work, stage->fraction, step, sweep++, log);
      state->solvent_lag += stage->fraction == 0.5 ? 1 : 2;
      break;
    case COLLIDE:
      ok = collide[model->solvent.bath](state, model, work, step);
      break;
    case FORCE:
      ok = fiber_forces(state, model, work, step);
      break;
    case KICK:
      fiber_kick(state, model, work, stage->fraction);
      break;
    case END:
      break;
    }
    if (watch)
      watch->look(watch->context, action_names[stage->action], state);
  }
  state->step = step;
  return ok;
}

bool step_advance(struct state *state, const struct model *model, struct work *work, const struct sweep_log *log)
{
  return step_advance_watched(state, model, work, log, NULL);
}

/* Takes the total momentum out of the state and gives it the flow's: the same change of velocity for everybody. A bath
 * exchanges momentum with the fibers, so there it is no constant, and left as it was drawn. */
static void set_total_momentum(struct state *state, const struct model *model)
{
  struct solvent *s = &state->solvent;
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < s->n; i++)
    p = vec3_add(p, solvent_velocity(s, i));
  for (uint32_t v = 0; v < state->vertices; v++)
    p = vec3_add_scaled(p, model->mass[v], state->velocity[v]);

  const bool conserved = !model_has_phantoms(model) && model->total_mass > 0.0;
  struct vec3 change = conserved ? vec3_add_scaled(model->flow, -1.0 / model->total_mass, p) : model->flow;
  for (uint32_t i = 0; i < s->n; i++) {
    s->vx[i] += change.x;
    s->vy[i] += change.y;
    s->vz[i] += change.z;
  }
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v] = vec3_add(state->velocity[v], change);
}

bool step_start(struct state *state, const struct model *model, struct work *work)
{
  state->step = 0;
  state->solvent_lag = 0;
  solvent_start(state, model);
  fiber_start(state, model);
  set_total_momentum(state, model);
  if (!fiber_forces(state, model, work, 0))
    return false;
  fiber_kick(state, model, work, 0.5);
  return true;
}
