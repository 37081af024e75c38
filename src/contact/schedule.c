#include "contact/schedule.h"

#include <string.h>

#include "contact/candidates.h"
#include "contact/capsule.h"
#include "contact/drift.h"
#include "contact/renewals.h"
#include "contact/wall.h"

enum { BLOCK = 64 }; /* vertices worked on at a time */

static struct point end_of_step(const struct drift_frame *frame, struct vec3 velocity, struct point from)
{
  return point_move(from, drift_displacement(frame, velocity, from.y));
}

/* Ranges of all vertices, paths of bonds, and new reference positions for vertices that are about to leave theirs. */
static bool prepare(const struct state *state, const struct model *model, struct contact *contact, struct fault *fault)
{
  struct vec3 d[BLOCK];
  for (uint32_t first = 0; first < state->vertices; first += BLOCK) {
    const uint32_t n = state->vertices - first < BLOCK ? state->vertices - first : BLOCK;
    if (!drift_displacements(state, model, &contact->frame, first, n, d, fault))
      return false;
    uint32_t *restrict range = &contact->range[first];
    for (uint32_t k = 0; k < n; k++)
      range[k] = candidates_units(vec3_norm(d[k]));
  }
  candidates_lengthen(model, contact);
  return renewals_of_late(state, model, contact, end_of_step, fault);
}

/* --- the plan ---------------------------------------------------------------------------------------------------- */

static void let_wait(struct contact *contact, uint32_t i)
{
  const uint32_t rank = contact->rank[i];
  contact->waits[i] = 1;
  contact->turns[rank / 64] |= (uint64_t)1 << rank % 64;
}

/* Vertices of candidate contacts wait for their turns. Each candidate is listed with both of its bonds. */
static void let_candidates_wait(const struct model *model, struct contact *contact)
{
  for (uint32_t k = 0; k < contact->candidates.count; k++) {
    const uint32_t bond = contact->candidates.at[k].bond;
    let_wait(contact, bond);
    let_wait(contact, (uint32_t)model->next[bond]);
  }
}

/* Those that would be beyond a wall wait, too: what they do there is a matter of their turns. */
static void let_wait_at_walls(const struct state *state, const struct model *model, struct contact *contact)
{
  for (uint32_t i = 0; i < state->vertices; i++) {
    const struct point p = state->position[i];
    const struct vec3 d = drift_displacement(&contact->frame, state->velocity[i], p.y);
    if (wall_is_beyond(&model->box, point_move(p, d).y))
      let_wait(contact, i);
  }
}

/* The vertices that wait, in the order of their turns. */
static void queue_up(const struct state *state, struct contact *contact)
{
  contact->queued = 0;
  for (uint32_t first = 0; first < state->vertices; first += 64)
    for (uint64_t turns = contact->turns[first / 64]; turns; turns &= turns - 1) {
      const uint32_t k = first + (uint32_t)__builtin_ctzll(turns);
      contact->queue[contact->queued++] = contact->order[k];
    }
}

/* Inserts vertex i into the queue; its turn is later than the present one. */
static void join_queue(struct contact *contact, uint32_t i)
{
  uint32_t k = contact->queued++;
  for (; contact->rank[contact->queue[k - 1]] > contact->rank[i]; k--)
    contact->queue[k] = contact->queue[k - 1];
  contact->queue[k] = i;
}

/* Moves all vertices that need not wait. Components are in one row: x, y, z of the first vertex, then of the next. */
static void move_others(struct state *state, const struct contact *contact)
{
  enum { ROW = 3 * BLOCK };
  const double time = contact->frame.time;
  double frame[ROW];
  for (int k = 0; k < ROW; k += 3)
    frame[k] = contact->frame.velocity.x, frame[k + 1] = contact->frame.velocity.y,
    frame[k + 2] = contact->frame.velocity.z;
  for (uint32_t first = 0; first < state->vertices; first += BLOCK) {
    const uint32_t n = state->vertices - first < BLOCK ? state->vertices - first : BLOCK;
    const double *restrict v = &state->velocity[first].x;
    int64_t *restrict p = &state->position[first].x, move[ROW];
    for (uint32_t k = 0; k < 3 * n; k++)
      move[k] = lattice_from_a0(time * (v[k] - frame[k]));
    const uint8_t *waits = &contact->waits[first], *one = waits;
    for (; (one = memchr(one, 1, n - (size_t)(one - waits))); one++)
      memset(&move[3 * (one - waits)], 0, 3 * sizeof *move);
    for (uint32_t k = 0; k < 3 * n; k++)
      p[k] += move[k];
  }
}

static void move_others_sheared(struct state *state, const struct contact *contact)
{
  struct point *restrict p = state->position;
  for (uint32_t i = 0; i < state->vertices; i++)
    if (!contact->waits[i])
      p[i] = point_move(p[i], drift_displacement(&contact->frame, state->velocity[i], p[i].y));
}

bool schedule_plan(struct state *state, const struct model *model, struct contact *contact, struct fault *fault)
{
  if (!prepare(state, model, contact, fault) || !candidates_find(state, model, contact, fault))
    return false;
  memset(contact->waits, 0, state->vertices);
  memset(contact->turns, 0, (state->vertices + 63) / 64 * sizeof *contact->turns);
  let_candidates_wait(model, contact);
  if (model_has_walls(model))
    let_wait_at_walls(state, model, contact);
  queue_up(state, contact);
  if (contact->frame.sheared)
    move_others_sheared(state, contact);
  else
    move_others(state, contact);
  return true;
}

/* True if the vertex has moved early, and its own turn comes after that of rank `now`. */
static bool moved_early(const struct contact *contact, uint32_t i, uint32_t now)
{
  return !contact->waits[i] && contact->rank[i] > now;
}

/* The place of the vertex before it moved early; its present place, if it has not. Its velocity is still that of the
 * early move: only bonds in a candidate contact are hit, and their ends wait or have been called back. */
static struct point standing_place(const struct state *state, const struct contact *contact, uint32_t i, uint32_t now)
{
  const struct drift_frame *f = &contact->frame;
  const struct point here = state->position[i];
  const bool early = moved_early(contact, i, now);
  if (!early)
    return here;
  const int64_t y = here.y - lattice_from_a0(f->time * (state->velocity[i].y - f->velocity.y));
  return point_move(here, vec3_scale(-1.0, drift_displacement(f, state->velocity[i], y)));
}

/* Calls back a vertex that has moved early: it returns to its former place and waits for its turn. */
static void call_back(struct state *state, struct contact *contact, uint32_t i, uint32_t now)
{
  if (!moved_early(contact, i, now))
    return;
  state->position[i] = standing_place(state, contact, i, now);
  contact->waits[i] = 1;
  join_queue(contact, i);
  contact->called_back++;
}

/* The place of a bond for the rest of this drift. Its ends may move by candidates_range from there. */
struct standing_bond {
  struct point end[2];
  double range;
};

static struct standing_bond standing_bond(const struct state *state, const struct model *model,
                                          const struct contact *contact, uint32_t bond, uint32_t now)
{
  const uint32_t end = (uint32_t)model->next[bond];
  return (struct standing_bond){{standing_place(state, contact, bond, now), standing_place(state, contact, end, now)},
                                candidates_range(model, contact, bond)};
}

static bool may_touch(const struct standing_bond *mine, const struct standing_bond *its, const int32_t image[3],
                      const struct box *box)
{
  const struct point origin = mine->end[0];
  const struct capsule c = {{0, 0, 0}, point_difference(mine->end[1], origin), mine->range};
  const struct capsule d = {point_difference(point_image(its->end[0], image, box), origin),
                            point_difference(point_image(its->end[1], image, box), origin), its->range};
  return !capsules_apart(&c, &d);
}

/* Adds the bonds that bond `bond` may touch now to its candidates. The ends of all of them are called back if they have
 * moved early. */
static bool look_around_bond(struct state *state, const struct model *model, struct contact *contact, uint32_t bond,
                             uint32_t now, struct fault *fault)
{
  struct neighbor_list *near = &contact->near;
  const struct standing_bond mine = standing_bond(state, model, contact, bond, now);
  if (!neighbors_near(state, model, contact, bond, mine.end, mine.range, near, fault))
    return false;
  for (uint32_t k = 0; k < near->count; k++) {
    const struct neighbor *n = &near->at[k];
    const struct standing_bond its = standing_bond(state, model, contact, (uint32_t)n->bond, now);
    if (!may_touch(&mine, &its, n->image, &model->box))
      continue;
    if (!candidates_add(state, contact, bond, n, fault))
      return false;
    const int32_t ends[4] = {(int32_t)bond, model->next[bond], n->bond, model->next[n->bond]};
    for (int e = 0; e < 4; e++)
      call_back(state, contact, (uint32_t)ends[e], now);
  }
  return true;
}

bool schedule_look_around(struct state *state, const struct model *model, struct contact *contact, uint32_t i,
                          uint32_t now, struct fault *fault)
{
  uint32_t bond[2];
  const int bonds = model_bonds_of(model, i, bond);
  for (int b = 0; b < bonds; b++)
    if (!look_around_bond(state, model, contact, bond[b], now, fault))
      return false;
  return true;
}

bool schedule_reconsider(struct state *state, const struct model *model, struct contact *contact, uint32_t i,
                         uint32_t now, struct fault *fault)
{
  const double furthest = box_shortest_edge(&model->box); /* a longer move is a fault */
  const int64_t y = standing_place(state, contact, i, now).y;
  const uint32_t range =
      candidates_units(fmin(vec3_norm(drift_displacement(&contact->frame, state->velocity[i], y)), furthest));
  renewals_look_again(&contact->neighbors, i);
  if (contact->rank[i] < now || range <= contact->range[i])
    return true;
  candidates_widen(model, contact, i, range);
  return schedule_look_around(state, model, contact, i, now, fault);
}
