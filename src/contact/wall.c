#include "contact/wall.h"

#include "base/memory.h"
#include "contact/drift.h"
#include "contact/impulse.h"

struct wall_meeting wall_meet(const struct box *box, struct point from, struct point to)
{
  const enum wall wall = to.y < 0 ? WALL_LOWER : WALL_UPPER;
  const int64_t height = wall_height(box, wall);
  const double part = (double)(height - from.y) / (double)(to.y - from.y);
  const struct vec3 d = vec3_scale(part, point_difference(to, from));
  struct point at = point_move(from, d);
  at.y = height;
  return (struct wall_meeting){wall, part, at};
}

struct point wall_inside(const struct box *box, struct point p)
{
  p.y = box_inside(box, 1, p.y);
  return p;
}

/* The velocity after a hit. acceleration: F/M, a0/t0^2. Along y it rebounds as a contact does. */
static struct vec3 after_hit(const struct slit *slit, enum wall wall, struct vec3 v, struct vec3 acceleration,
                             double tau)
{
  const double into = wall == WALL_LOWER ? -1.0 : 1.0;
  struct slit ahead = *slit; /* as the leap-frog's velocity sees it */
  ahead.wall[wall] = vec3_sub(slit->wall[wall], vec3_scale(tau, acceleration));
  struct vec3 after = wall_reflect(&ahead, wall, v);
  after.y = -into * contact_rebound(into * v.y, into * tau * acceleration.y);
  return after;
}

/* Vertex i has this velocity after a hit. */
static void rebound(struct state *state, const struct model *model, enum wall wall, uint32_t i, struct vec3 after)
{
  wall_gives(account_of(state, ACCOUNT_HITS), wall, model->mass[i], state->velocity[i], after);
  state->velocity[i] = after;
}

void wall_hit(struct state *state, const struct model *model, const struct drift_frame *frame, enum wall wall,
              uint32_t i, struct vec3 force, double tau)
{
  const struct vec3 acceleration = vec3_scale(model->inverse_mass[i], force);
  rebound(state, model, wall, i, after_hit(&frame->slit, wall, state->velocity[i], acceleration, tau));
}

/* --- free moves -------------------------------------------------------------------------------------------------- */

struct straight {
  const struct state *state;
  const struct drift_frame *frame;
  double part;
};

static struct point place_on_way(const void *context, uint32_t vertex)
{
  const struct straight *s = context;
  const struct vec3 d = drift_displacement(s->frame, s->state->velocity[vertex], 0);
  return point_move(s->state->position[vertex], vec3_scale(s->part, d));
}

static struct wall_bounce bounce_of(const struct state *state, const struct model *model, const struct contact *contact,
                                    uint32_t i, struct point to)
{
  const struct drift_frame *f = &contact->frame;
  const struct wall_meeting m = wall_meet(&model->box, state->position[i], to);
  const struct straight way = {state, f, m.part};
  const struct vec3 force = contact->force(model, i, place_on_way, &way);
  const struct vec3 v = after_hit(&f->slit, m.wall, state->velocity[i], vec3_scale(model->inverse_mass[i], force),
                                  f->start + m.part * f->time);
  const struct vec3 rest = vec3_scale((1.0 - m.part) * f->time, vec3_sub(v, f->velocity));
  return (struct wall_bounce){i, m.wall, wall_inside(&model->box, point_move(m.at, rest)), v};
}

bool wall_find_hits(struct state *state, const struct model *model, struct contact *contact, struct fault *fault)
{
  struct wall_bounces *list = &contact->bounces;
  list->count = 0;
  for (uint32_t i = 0; i < state->vertices; i++) {
    struct point to;
    if (!drift_trial(state, model, &contact->frame, i, &to, fault))
      return false;
    if (!wall_is_beyond(&model->box, to.y))
      continue;
    if (list->count == list->room && !memory_double((void **)&list->at, &list->room, 64, sizeof *list->at))
      return fault_no_memory(fault, state->step + 1);
    list->at[list->count++] = bounce_of(state, model, contact, i, to);
  }
  return true;
}

void wall_answer_hits(struct state *state, const struct model *model, struct contact *contact)
{
  for (uint32_t k = 0; k < contact->bounces.count; k++) {
    const struct wall_bounce *h = &contact->bounces.at[k];
    rebound(state, model, h->wall, h->vertex, h->velocity);
    state->position[h->vertex] = h->end;
  }
}
