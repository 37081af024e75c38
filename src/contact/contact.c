#include "contact/contact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "contact/drift.h"
#include "contact/held.h"
#include "contact/rule.h"
#include "system/plan.h"

/* --- scratch ----------------------------------------------------------------------------------------------------- */

enum { NEEDS = 10 };

/* The single list of the scratch that the drifts of a model use. Lists that grow are allocated where they grow. */
static void list_needs(struct contact *c, const struct model *m, bool everything, struct memory_need need[NEEDS])
{
  const struct crossing_rule *rule = crossing_rule_of(m);
  const size_t noncrossing = everything || rule->forbids ? m->vertices : 0;
  const size_t in_turns = everything || rule->in_turns ? m->vertices : 0;
  const size_t at_once = everything || (rule->forbids && !rule->in_turns) ? m->vertices : 0;
  const struct memory_need all[NEEDS] = {
      {(void **)&c->order, in_turns, sizeof *c->order},
      {(void **)&c->rank, in_turns, sizeof *c->rank},
      {(void **)&c->range, noncrossing, sizeof *c->range},
      {(void **)&c->queue, in_turns, sizeof *c->queue},
      {(void **)&c->waits, in_turns, sizeof *c->waits},
      {(void **)&c->turns, (in_turns + 63) / 64, sizeof *c->turns},
      {(void **)&c->candidates.first, noncrossing, sizeof *c->candidates.first},
      {(void **)&c->flights.version, at_once, sizeof *c->flights.version},
      {(void **)&c->flights.bend_of, at_once, sizeof *c->flights.bend_of},
      {(void **)&c->aside, m->held ? m->vertices : 0, sizeof *c->aside},
  };
  memcpy(need, all, sizeof all);
}

bool contact_alloc(struct contact *c, const struct model *m, contact_force *force, bool everything)
{
  struct memory_need need[NEEDS];
  memset(c, 0, sizeof *c);
  c->force = force;
  list_needs(c, m, everything, need);
  return memory_take(need, NEEDS);
}

static void free_neighbors(struct neighbors *nb)
{
  for (uint32_t c = 0; nb->entries && c < nb->cell_count; c++)
    if (nb->entries[c].room > SEARCH_FIRST_ENTRIES)
      free(nb->entries[c].at);
  free(nb->entries);
  free(nb->reference);
  free(nb->path);
  free(nb->generation);
  free(nb->hold);
  free(nb->pairs.bond);
  free(nb->pairs.other);
  free(nb->pairs.limit);
  free(nb->pairs.detail);
}

void contact_free(struct contact *c)
{
  struct memory_need need[NEEDS];
  const struct model nothing = {0};
  list_needs(c, &nothing, false, need);
  memory_release(need, NEEDS);
  free(c->candidates.at);
  free(c->near.at);
  free(c->flights.bends.at);
  free(c->bounces.at);
  free(c->flights.queue.at);
  free_neighbors(&c->neighbors);
  memset(c, 0, sizeof *c);
}

uint64_t contact_bytes(const struct model *m)
{
  struct contact c = {0};
  struct memory_need need[NEEDS];
  list_needs(&c, m, false, need);
  const uint64_t bonds = crossing_rule_of(m)->forbids ? m->bonds : 0;
  return memory_bytes(need, NEEDS) + memory_taken(bonds * sizeof(struct reference_position)) +
         3 * memory_taken(bonds * sizeof(uint32_t)) + memory_taken(bonds * sizeof(struct grid_row));
}

/* --- drift ------------------------------------------------------------------------------------------------------- */

/* Moves everything by the motion of the frame of the moves. A common displacement crosses nothing. */
static void follow_frame(struct state *state, const struct model *model, struct neighbors *nb, double dt)
{
  const struct point origin = {0, 0, 0}, shift = point_move(origin, vec3_scale(dt, model_frame_velocity(model)));
  if (shift.x == 0 && shift.y == 0 && shift.z == 0)
    return;
  for (uint32_t i = 0; i < state->vertices; i++)
    state->position[i] = point_plus(state->position[i], shift);
  nb->moved = point_plus(nb->moved, shift);
}

/* In one step a vertex moves less than 2 (512 + 100) a0: two drifts of at most half an edge each, and the motion of the
 * frame. So between two checks, vertices stay below 1.6 LATTICE_REACH. */
#define STEPS_PER_LOOK 1024

/* Records a fault if a vertex is so far out that differences of positions could overflow. If the frame has moved as
 * far, the neighbor search is rebuilt, which sets its displacement to zero. */
static bool look_how_far(const struct state *state, struct contact *contact, uint64_t step, struct fault *fault)
{
  struct neighbors *nb = &contact->neighbors;
  const uint32_t lost = state_lost_vertex(state);
  if (!point_within_reach(nb->moved))
    contact_forget_places(contact);
  if (lost == state->vertices)
    return true;
  const struct vec3 r = point_in_a0(state->position[lost]);
  return fault_record(fault, FAULT_VERTEX_PLACE, step, lost, fmax(fabs(r.x), fmax(fabs(r.y), fabs(r.z))),
                      (double)LATTICE_REACH * LATTICE_UNIT);
}

/* Fibers of a sheared box whose middle is so far outside of it along y are taken back into it. */
#define FURTHEST_OUT 0.25

static int64_t image_of_fiber(const struct state *state, const struct model *model, uint32_t fiber)
{
  const uint32_t first = model->fiber_first[fiber], last = model->fiber_first[fiber + 1] - 1;
  const double edge = (double)model->box.edge[1];
  const double middle = 0.5 * ((double)state->position[first].y + (double)state->position[last].y) / edge;
  return middle < -FURTHEST_OUT || middle > 1.0 + FURTHEST_OUT ? (int64_t)floor(middle) : 0;
}

/* A fiber beyond the box is replaced by its image in the box, which is at rest relative to the sheared box: else its
 * velocity would grow with its height. */
static void take_back_fibers(struct state *state, const struct model *model, struct contact *contact)
{
  const struct drift_frame *f = &contact->frame;
  for (uint32_t fiber = 0; fiber < model->fibers; fiber++) {
    const int64_t image = image_of_fiber(state, model, fiber);
    if (image == 0)
      continue;
    for (uint32_t i = model->fiber_first[fiber]; i < model->fiber_first[fiber + 1]; i++) {
      state->position[i].x -= image * f->slides;
      state->position[i].y -= image * f->edge;
      state->velocity[i].x -= (double)image * f->image_speed;
    }
    contact_forget_places(contact);
  }
}

/* Vertices are in sheared coordinates until leave_sheared. If the strain does not go on from where it was, which image
 * of a bond is which has changed. */
static void enter_sheared(struct state *state, struct contact *contact, int64_t slid_before)
{
  if (contact->frame.slid != slid_before)
    contact_forget_places(contact);
  for (uint32_t i = 0; i < state->vertices; i++)
    state->position[i] = drift_enter(&contact->frame, state->position[i]);
}

static void leave_sheared(struct state *state, const struct contact *contact)
{
  for (uint32_t i = 0; i < state->vertices; i++)
    state->position[i] = drift_leave(&contact->frame, state->position[i]);
}

bool contact_drift_in(const struct drift_frame *frame, struct state *state, const struct model *model,
                      struct contact *contact, uint64_t step, uint32_t drift, const struct contact_log *log,
                      struct fault *fault)
{
  const int64_t slid_before = contact->frame.slides;
  if (step % STEPS_PER_LOOK == 0 && !look_how_far(state, contact, step, fault))
    return false;
  contact->frame = *frame;
  if (contact->frame.sheared)
    enter_sheared(state, contact, slid_before);
  const bool ok = crossing_rule_of(model)->drift(state, model, contact, step, drift, log, fault);
  if (ok)
    follow_frame(state, model, &contact->neighbors, contact->frame.time);
  if (contact->frame.sheared)
    leave_sheared(state, contact);
  if (model_is_sheared(model))
    take_back_fibers(state, model, contact);
  return ok;
}

bool contact_drift(struct state *state, const struct model *model, struct contact *contact, double fraction,
                   uint64_t step, uint32_t drift, const struct contact_log *log, struct fault *fault)
{
  const struct drift_frame frame = drift_frame_now(state, model, fraction, drift, crossing_rule_of(model)->forbids);
  return contact_drift_in(&frame, state, model, contact, step, drift, log, fault);
}

static bool act_drift(void *room, const struct moment *now, const struct stage *stage)
{
  return contact_drift(now->state, now->model, room, stage->fraction, now->step, stage->drift, now->log, now->fault);
}

/* The same where vertices are held. */
static bool act_drift_about_held(void *room, const struct moment *now, const struct stage *stage)
{
  struct contact *contact = room;
  held_set_aside(now->state, now->model, contact->aside);
  const bool ok = act_drift(room, now, stage);
  held_give_back(now->state, now->model, contact->aside);
  return ok;
}

void contact_plan_drift(struct plan *plan, const struct model *model, size_t room, double fraction, uint32_t drift)
{
  if (model->vertices > 0)
    plan_append(plan, (struct stage){.act = model->held ? act_drift_about_held : act_drift,
                                     .room = room,
                                     .fraction = fraction,
                                     .drift = drift});
}
