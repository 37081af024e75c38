/* Is a step with contacts reversible? Shared by `reversal` and tests/physics/test_contacts.c.
 *
 * Fibers without solvent run N steps, their velocities are reversed, they run N steps back, and are compared with the
 * start. The leap-frog's velocities are those in the middle of a drift, so they are kicked by a whole dt before they
 * are reversed: v(t - dt/2) = v(t + dt/2) - dt F(t)/M.
 *
 * A contact is answered at the last tick at which the bonds are certainly apart, theta of a tick (0 <= theta < 1)
 * before they touch. Backwards, bonds that stand at the same place approach with a' = phi a, and touch theta/phi of a
 * tick later. If that is less than a tick, the contact is answered at the same place: positions, being integers, return
 * exactly. Else it is answered k <= 1/phi ticks later, and for so long a vertex flies with the wrong one of two
 * velocities: it misses its place by k dt/65536 |dv|, and by what the normal turns in this time. */
#ifndef UNCROSS_REVERSAL_H
#define UNCROSS_REVERSAL_H

#include "contact/flight.h"
#include "measure.h"

struct told {
  uint32_t bond, other;
  int32_t tick;
};

struct told_list {
  size_t count, room;
  struct told *at;
};

static inline void reversal_note(void *context, const struct contact_event *e)
{
  struct told_list *list = context;
  if (list->count == list->room)
    list->at = realloc(list->at, (list->room = list->room ? 2 * list->room : 1024) * sizeof *list->at);
  list->at[list->count++] =
      (struct told){e->moving_bond, e->standing_bond, (int32_t)(e->hit.time * FLIGHT_TICKS + 0.5)};
}

static inline void reversal_advance(struct run *run, struct told_list *told)
{
  const struct contact_log log = {reversal_note, told};
  stop_unless(step_advance(&run->state, &run->model, &run->work, &log), run);
}

/* Velocities of the drift before this moment, reversed: the run goes back. */
static inline void reversal_turn_back(struct run *run)
{
  stop_unless(fiber_forces(&run->state, &run->model, run->work.fiber.force, 0, &run->work.fault), run);
  for (uint32_t v = 0; v < run->state.vertices; v++)
    run->state.velocity[v] = vec3_scale(-1.0, run->state.velocity[v]);
  fiber_kick(&run->state, &run->model, run->work.fiber.force, 1.0);
}

static inline void reversal_copy_fibers(struct state *to, const struct state *from)
{
  memcpy(to->position, from->position, from->vertices * sizeof *from->position);
  memcpy(to->velocity, from->velocity, from->vertices * sizeof *from->velocity);
}

struct miss {
  double position, velocity; /* largest difference of a vertex, a0 and a0/t0 */
};

static inline struct miss reversal_compare(const struct state *a, const struct state *b)
{
  struct miss m = {0, 0};
  for (uint32_t v = 0; v < a->vertices; v++) {
    m.position = fmax(m.position, vec3_norm(point_difference(a->position[v], b->position[v])));
    m.velocity = fmax(m.velocity, vec3_norm(vec3_sub(a->velocity[v], b->velocity[v])));
  }
  return m;
}

/* Largest number of ticks by which a contact was answered later on the way back; -1 if the contacts are others. */
static inline int reversal_later(const struct told_list *there, size_t from, const struct told_list *back)
{
  const size_t n = there->count - from;
  int most = 0;
  if (back->count != n)
    return -1;
  for (size_t k = 0; k < n; k++) {
    const struct told *a = &there->at[from + k], *b = &back->at[n - 1 - k];
    if (a->bond != b->bond || a->other != b->other)
      return -1;
    const int ticks = abs(b->tick - (FLIGHT_TICKS - a->tick));
    most = ticks > most ? ticks : most;
  }
  return most;
}

struct reversal_setup {
  int cells;
  uint32_t fibers, vertices;
  double kappa, dt;
  uint64_t steps, seed;
};

struct reversal {
  size_t contacts, contacts_back;
  struct miss whole;              /* all steps, there and back */
  uint64_t drifts, same;          /* with contacts; reversed by itself: all contacts at the same ticks */
  uint64_t later_ones, different; /* some at later ticks; other contacts */
  struct miss of_same, of_others; /* of single drifts */
  uint64_t late[7];               /* drifts whose latest contact was so many ticks later; [0]: other contacts */
  uint64_t rigid, softened;
};

/* The drift before this moment, reversed by itself, and compared with `before`, the state that it started from. */
static inline void reversal_of_one(struct run *one, const struct state *now, const struct state *before,
                                   const struct told_list *there, size_t from, struct told_list *single,
                                   struct reversal *r)
{
  reversal_copy_fibers(&one->state, now);
  one->work.contact.neighbors.built = false;
  single->count = 0;
  reversal_turn_back(one);
  reversal_advance(one, single);
  reversal_turn_back(one);
  const struct miss miss = reversal_compare(&one->state, before);
  const int ticks = reversal_later(there, from, single);
  struct miss *m = ticks == 0 ? &r->of_same : &r->of_others;
  m->position = fmax(m->position, miss.position);
  m->velocity = fmax(m->velocity, miss.velocity);
  r->drifts++;
  r->same += ticks == 0;
  r->later_ones += ticks > 0;
  r->different += ticks < 0;
  r->late[ticks < 0 ? 0 : ticks > 6 ? 6 : ticks] += ticks != 0;
}

static inline struct model reversal_model(const struct reversal_setup *s)
{
  struct model m = standard_model(s->cells, s->cells, s->cells, 0, s->dt, 1);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  add_kind(&m, s->fibers, s->vertices)->bending = s->kappa;
  return m;
}

static inline struct reversal reversal_measure(const struct reversal_setup *s)
{
  struct reversal r = {.contacts = 0};
  struct run run, one;
  struct state start, before;
  run_start(&run, reversal_model(s), s->seed);
  run_start(&one, reversal_model(s), s->seed);
  stop_unless(state_alloc(&start, &run.model) && state_alloc(&before, &run.model), &run);
  run_steps(&run, 10);
  reversal_copy_fibers(&start, &run.state);
  struct told_list there = {.count = 0}, back = {.count = 0}, single = {.count = 0};
  for (uint64_t k = 0; k < s->steps; k++) {
    const size_t from = there.count;
    reversal_copy_fibers(&before, &run.state);
    reversal_advance(&run, &there);
    if (there.count > from)
      reversal_of_one(&one, &run.state, &before, &there, from, &single, &r);
  }
  reversal_turn_back(&run);
  for (uint64_t k = 0; k < s->steps; k++)
    reversal_advance(&run, &back);
  reversal_turn_back(&run);
  r.whole = reversal_compare(&run.state, &start);
  r.contacts = there.count;
  r.contacts_back = back.count;
  r.rigid = run.state.counts.rigid;
  r.softened = run.state.counts.softened;
  state_free(&start);
  state_free(&before);
  free(there.at);
  free(back.at);
  free(single.at);
  run_end(&run);
  run_end(&one);
  return r;
}

#endif
