/*
 * START HERE. The algorithm of Padding 2009, Sec. III, as the paper lists it:
 *
 *   1  coordinates and velocities                       step_start, or a snapshot (files/)
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
#include <string.h>

#include "contact/event_bead.h"
#include "contact/laying.h"
#include "fiber/start.h"
#include "fluid/fluid.h"
#include "medium/plan.h"
#include "medium/repulsion.h"
#include "mpc/plan.h"
#include "system/bead.h"
#include "system/shear.h"

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

/* Vertices take up their share of what a drive gives to the bead, half of it before the drift and half of it after. */
static void take_counterforce(struct state *state, const struct model *model)
{
  const struct vec3 half = vec3_scale(0.5 * model->time_step, bead_counter(state, model));
  for (uint32_t v = 0; model->bead.driven && v < state->vertices; v++)
    state->velocity[v] = vec3_add(state->velocity[v], half);
}

/* The bead flies with the fibers. */
static bool act_beside(void *room, const struct moment *now, const struct stage *stage)
{
  struct work *w = room;
  (void)stage;
  w->contact.bead.steps = w->mpc.fluid->steps;
  w->contact.bead.visits = &w->mpc.bead.meetings;
  take_counterforce(now->state, now->model);
  return true;
}

static bool act_counter(void *room, const struct moment *now, const struct stage *stage)
{
  (void)room, (void)stage;
  take_counterforce(now->state, now->model);
  return true;
}

static void plan_drift(struct plan *plan, const struct model *m, double fraction, uint32_t drift)
{
  const bool beside = model_has_bead(m) && m->vertices > 0;
  if (beside)
    plan_append(plan, (struct stage){.act = act_beside});
  contact_plan_drift(plan, m, offsetof(struct work, contact), fraction, drift);
  if (beside)
    plan_append(plan, (struct stage){.act = act_counter});
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

/* The axes along which the total momentum is conserved. A random solvent and walls take up momentum, slip walls only
 * along y. */
static struct vec3 conserved_axes(const struct model *model)
{
  const double y = !model_has_walls(model), along = y != 0.0 || model->walls.kind == WALL_SLIP;
  return !model_keeps_momentum(model) || model->total_mass == 0.0 ? (struct vec3){0, 0, 0}
                                                                  : (struct vec3){along, y, along};
}

/* Replaces the total momentum of the state by that of the flow: all velocities change by the same amount. Where
 * momentum is not conserved, it stays as it was drawn about the flow. */
static void set_total_momentum(struct state *state, const struct model *model)
{
  struct solvent *s = &state->solvent;
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < s->n; i++)
    p = vec3_add(p, solvent_velocity(s, i));
  for (uint32_t v = 0; v < state->vertices; v++)
    p = vec3_add_scaled(p, model->mass[v], state->velocity[v]);

  if (state->beads > 0)
    p = vec3_add_scaled(p, model->bead.mass, state->bead->velocity);

  const struct vec3 axes = conserved_axes(model);
  const double mass = model->total_mass + model->bead.mass, each = mass > 0.0 ? -1.0 / mass : 0.0;
  const struct vec3 change =
      vec3_add_scaled(model->flow, each, (struct vec3){axes.x * p.x, axes.y * p.y, axes.z * p.z});
  for (uint32_t i = 0; i < s->n; i++) {
    s->vx[i] += change.x;
    s->vy[i] += change.y;
    s->vz[i] += change.z;
  }
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v] = vec3_add(state->velocity[v], change);
  if (state->beads > 0)
    state->bead->velocity = vec3_add(state->bead->velocity, change);
}

/* As between steps, the velocity of a driven bead is that of the half step ahead; that of all else is half a step
 * behind with the counterforce, which acts in flight. */
static void start_drive(struct state *state, const struct model *model)
{
  const double half = 0.5 * model->time_step;
  const struct vec3 behind = vec3_scale(-half, bead_counter(state, model));
  struct solvent *s = &state->solvent;
  if (!model->bead.driven)
    return;
  bead_kick(state->bead, model, state->solvent_time, half);
  for (uint32_t i = 0; i < s->n; i++)
    s->vx[i] += behind.x, s->vy[i] += behind.y, s->vz[i] += behind.z;
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v] = vec3_add(state->velocity[v], behind);
}

void step_begin_drive(struct state *state, const struct model *model)
{
  if (!model->bead.driven)
    return;
  set_total_momentum(state, model);
  start_drive(state, model);
}

/* A sheared box starts with its linear profile: velocities are thermal about it. */
static void add_shear(struct state *state, const struct model *model)
{
  const double rate = model_is_sheared(model) ? shear_rate(model, 0) : 0.0;
  const int64_t middle = model->box.edge[1] / 2;
  struct solvent *s = &state->solvent;
  if (rate == 0.0)
    return;
  for (uint32_t i = 0; i < s->n; i++)
    s->vx[i] += rate * (double)(s->y[i] - middle) * LATTICE_UNIT;
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v].x += rate * (double)(state->position[v].y - middle) * LATTICE_UNIT;
}

/* Where fibers are laid: among thick ones, and beside a bead. */
struct ground {
  const struct state *state;
  const struct model *model;
  struct laying laying; /* empty if all are thin */
  bool in_bead;         /* the last fiber that overlaps does so with the bead: */
  uint32_t bond;        /* this bond of it, */
  double distance;      /* whose axis is so far from the center, a0 */
};

static enum fiber_verdict judge_fiber(void *context, const struct point *position, uint32_t fiber)
{
  static const enum fiber_verdict verdicts[] = {
      [LAYING_FITS] = FIBER_STAYS, [LAYING_OVERLAPS] = FIBER_OVERLAPS, [LAYING_NO_MEMORY] = FIBER_NO_MEMORY};
  struct ground *g = context;
  const struct state *s = g->state;
  g->in_bead = s->beads > 0 && !event_bead_clear(g->model, s->bead->position, position, fiber, &g->bond, &g->distance);
  if (g->in_bead)
    return FIBER_OVERLAPS;
  return g->model->thickness > 0 ? verdicts[laying_add(&g->laying, position, fiber)] : FIBER_STAYS;
}

/* Does it matter where fibers are? */
static bool is_crowded(const struct model *model)
{
  return model->thickness > 0 || model_has_bead(model);
}

static bool record_overlap(const struct ground *g, struct fault *fault)
{
  const struct model *m = g->model;
  const struct laying *l = &g->laying;
  if (!g->in_bead)
    return fault_record(fault, FAULT_OVERLAP, 0, l->bond, l->distance,
                        (double)model_reach(m, l->bond, l->other) * LATTICE_UNIT);
  const struct fiber_kind *kind = &m->kind[m->fiber_kind_of[m->fiber_of[g->bond]]];
  return fault_record(fault, FAULT_BEAD_OVERLAP, 0, g->bond, g->distance,
                      (double)(bead_radius(m) + kind->radius) * LATTICE_UNIT);
}

static bool record_start(const struct ground *g, enum fiber_start_end end, uint32_t fiber, struct fault *fault)
{
  if (end == FIBERS_OVERLAP)
    return record_overlap(g, fault);
  if (end == FIBERS_NO_ROOM)
    return fault_record(fault, FAULT_NO_ROOM, 0, fiber, FIBER_MOST_ATTEMPTS, FIBER_MOST_ATTEMPTS);
  return end == FIBERS_LAID || fault_no_memory(fault, 0);
}

/* Lays all fibers, the thick ones without overlap, and all of them outside of a bead. */
static bool start_fibers(struct state *state, const struct model *model, struct fault *fault)
{
  struct ground ground = {.state = state, .model = model};
  const struct fiber_room room = {judge_fiber, &ground};
  uint32_t fiber = 0;
  enum fiber_start_end end = FIBERS_NO_MEMORY;
  if (!is_crowded(model))
    end = fiber_start(state, model, NULL, &fiber);
  else if (model->thickness == 0 || laying_begin(&ground.laying, model))
    end = fiber_start(state, model, &room, &fiber);
  const bool ok = record_start(&ground, end, fiber, fault);
  laying_end(&ground.laying);
  return ok;
}

bool step_sound(const struct state *state, const struct model *model, struct fault *fault)
{
  static const enum fiber_start_end ends[] = {
      [FIBER_STAYS] = FIBERS_LAID, [FIBER_OVERLAPS] = FIBERS_OVERLAP, [FIBER_NO_MEMORY] = FIBERS_NO_MEMORY};
  struct ground ground = {.state = state, .model = model};
  enum fiber_start_end end = FIBERS_LAID;
  if (!is_crowded(model))
    return true;
  if (model->thickness > 0 && !laying_begin(&ground.laying, model))
    end = FIBERS_NO_MEMORY;
  for (uint32_t fiber = 0; end == FIBERS_LAID && fiber < model->fibers; fiber++)
    end = ends[judge_fiber(&ground, state->position, fiber)];
  const bool ok = record_start(&ground, end, 0, fault);
  laying_end(&ground.laying);
  return ok;
}

bool step_start(struct state *state, const struct model *model, struct work *work)
{
  state->step = 0;
  state->solvent_lag = 0;
  state->solvent_time = 0;
  fluid_of(model)->start(state, model);
  if (!start_fibers(state, model, &work->fault))
    return false;
  if (model_is_overdamped(model)) {
    memset(state->velocity, 0, state->vertices * sizeof *state->velocity);
    return true;
  }
  set_total_momentum(state, model);
  start_drive(state, model);
  add_shear(state, model);
  if (!fiber_forces(state, model, work->fiber.force, 0, &work->fault))
    return false;
  fiber_kick(state, model, work->fiber.force, 0.5);
  if (!model_repels(model))
    return true;
  if (!repulsion_forces(state, model, &work->medium, &work->fault))
    return false;
  repulsion_kick(state, model, &work->medium, 0.5);
  return true;
}
