/* Whole drifts of the rule `event-driven`, replayed from outside: the paths of all vertices are put together from the
 * places and velocities before, and from the contacts that were told; they must end where the vertices ended. Then
 * every pair of bonds, in every image, on every straight piece of its motion, is judged by exact arithmetic. */
#ifndef UNCROSS_TESTS_FLIGHT_REPLAY_H
#define UNCROSS_TESTS_FLIGHT_REPLAY_H

#include "contact/exact_flight.h"
#include "contact/reference.h"

enum { MOST_PIECES = 40000, MOST_BENDS = 4000 };

/* A straight piece of a path: from this tick on, the vertex is at `at` + T rate. */
struct piece {
  int32_t from;
  struct point at, rate;
  uint32_t next; /* 1 + number of the vertex's next piece, or 0 */
};

struct replay {
  const struct test_run *run;
  struct exact_flight exact;
  struct exact_distance distance;
  double dt;
  uint32_t pieces;
  struct piece piece[MOST_PIECES];
  uint32_t *first, *last; /* [vertices] pieces of a path */
  uint64_t drifts, contacts, invented, early, judged, touching, image_contacts, rigid_drifts, unknown_drifts;
  uint32_t most_of_vertex;
  uint32_t *contacts_of; /* [vertices] in this drift */
};

static inline struct replay *replay_open(const struct test_run *r)
{
  struct replay *p = calloc(1, sizeof *p);
  p->run = r;
  p->first = calloc(r->state.vertices, sizeof *p->first);
  p->last = calloc(r->state.vertices, sizeof *p->last);
  p->contacts_of = calloc(r->state.vertices, sizeof *p->contacts_of);
  exact_flight_open(&p->exact);
  exact_distance_open(&p->distance);
  return p;
}

static inline void replay_close(struct replay *p)
{
  exact_flight_close(&p->exact);
  exact_distance_close(&p->distance);
  free(p->first);
  free(p->last);
  free(p->contacts_of);
  free(p);
}

/* Displacement in a tick: the integers nearest to v dt 2^24. */
static inline struct point rate_by_hand(struct vec3 v, double dt)
{
  return (struct point){llrint(0x1p24 * (v.x * dt)), llrint(0x1p24 * (v.y * dt)), llrint(0x1p24 * (v.z * dt))};
}

static inline struct point after_ticks(struct point at, struct point rate, int64_t tick)
{
  return (struct point){at.x + rate.x * tick, at.y + rate.y * tick, at.z + rate.z * tick};
}

static inline struct point difference_of(struct point a, struct point b)
{
  return (struct point){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline void bend_path(struct replay *p, uint32_t v, int32_t tick, struct point rate)
{
  struct piece *last = &p->piece[p->last[v]];
  const struct point here = after_ticks(last->at, last->rate, tick);
  assert_true(tick >= last->from);
  if (tick > last->from) {
    assert_true(p->pieces < MOST_PIECES);
    last->next = p->pieces + 1;
    p->last[v] = p->pieces++;
    last = &p->piece[p->last[v]];
  }
  *last = (struct piece){tick, after_ticks(here, rate, -(int64_t)tick), rate, 0};
}

/* Two bonds, the other in an image, as they fly on these pieces. */
static inline struct flight_pair pair_on(const struct replay *p, const uint32_t piece[4], const int64_t image[3])
{
  const int64_t *edge = p->run->model.box.edge;
  const struct point shift = {image[0] * edge[0], image[1] * edge[1], image[2] * edge[2]};
  const struct piece *i = &p->piece[piece[0]], *j = &p->piece[piece[1]], *l = &p->piece[piece[2]],
                     *m = &p->piece[piece[3]];
  struct flight_pair pair = {difference_of(j->at, i->at),     difference_of(m->at, l->at),
                             difference_of(l->at, i->at),     difference_of(j->rate, i->rate),
                             difference_of(m->rate, l->rate), difference_of(l->rate, i->rate)};
  pair.w = (struct point){pair.w.x + shift.x, pair.w.y + shift.y, pair.w.z + shift.z};
  return pair;
}

static inline void replay_contact(void *context, const struct contact_event *e)
{
  struct replay *p = context;
  const struct model *m = &p->run->model;
  const uint32_t vertex[4] = {e->moving_bond, (uint32_t)m->next[e->moving_bond], e->standing_bond,
                              (uint32_t)m->next[e->standing_bond]};
  const int32_t tick = (int32_t)(e->hit.time * FLIGHT_TICKS);
  assert_true((double)tick == e->hit.time * FLIGHT_TICKS && tick >= 0 && tick < FLIGHT_TICKS);
  const int64_t image[3] = {e->image[0], e->image[1], e->image[2]};
  const uint32_t piece[4] = {p->last[vertex[0]], p->last[vertex[1]], p->last[vertex[2]], p->last[vertex[3]]};
  const struct flight_pair pair = pair_on(p, piece, image);
  p->contacts++;
  p->image_contacts += image[0] || image[1] || image[2];
  p->invented += !exact_touch(&p->exact, &pair, tick, tick + 1);
  p->early += !exact_near(&p->distance, &pair, tick, 1);
  for (int k = 0; k < 4; k++) {
    const uint32_t times = ++p->contacts_of[vertex[k]];
    p->most_of_vertex = times > p->most_of_vertex ? times : p->most_of_vertex;
    bend_path(p, vertex[k], tick, rate_by_hand(p->run->state.velocity[vertex[k]], p->dt));
  }
}

/* --- where paths end ---------------------------------------------------------------------------------------------- */

/* Rigid clusters are not told. A vertex that joined one after its last contact has one more bend, to the rate that it
 * has at the end: (rate before - rate after) T = what is left over. False if its path cannot be told so. */
static inline bool find_rigid_bend(struct replay *p, uint32_t v, struct point end, struct point rate)
{
  const struct piece *last = &p->piece[p->last[v]];
  const struct point turn = difference_of(last->rate, rate),
                     rest = difference_of(difference_of(end, last->at),
                                          after_ticks((struct point){0, 0, 0}, rate, FLIGHT_TICKS));
  const int64_t t[3] = {turn.x, turn.y, turn.z}, r[3] = {rest.x, rest.y, rest.z};
  int64_t tick = -1;
  for (int k = 0; k < 3; k++)
    if (t[k] != 0)
      tick = r[k] / t[k];
  if (tick < last->from || tick > FLIGHT_TICKS)
    return false;
  for (int k = 0; k < 3; k++)
    if (t[k] * tick != r[k])
      return false;
  bend_path(p, v, (int32_t)tick, rate);
  return true;
}

/* The rate of a vertex at the end of a drift in which its flight has bent. */
static inline struct point rate_at_end(const struct bend_list *bends, uint32_t v)
{
  uint32_t k = 0;
  while (k < bends->count && bends->at[k].vertex != v)
    k++;
  assert_true(k < bends->count);
  return bends->at[k].rate;
}

/* The paths end where the vertices are. False if a rigid cluster makes them unknown. */
static inline bool paths_end(struct replay *p, uint64_t rigid_before, uint64_t seed)
{
  const struct state *state = &p->run->state;
  const struct bend_list *bends = &p->run->work.contact.flights.bends;
  bool known = true;
  for (uint32_t v = 0; v < state->vertices; v++) {
    const struct piece *last = &p->piece[p->last[v]];
    const struct point end = after_ticks(last->at, last->rate, FLIGHT_TICKS), is = state->position[v];
    if (end.x == is.x && end.y == is.y && end.z == is.z)
      continue;
    if (state->counts.rigid == rigid_before)
      fail_msg("seed %lu: vertex %u does not end where its path ends", (unsigned long)seed, v);
    known = known && find_rigid_bend(p, v, is, rate_at_end(bends, v));
  }
  return known;
}

/* --- all pairs ---------------------------------------------------------------------------------------------------- */

struct swept_box {
  int64_t low[3], high[3];
};

static inline void sweep_vertex(const struct replay *p, uint32_t v, struct swept_box *b)
{
  for (uint32_t k = p->first[v] + 1; k; k = p->piece[k - 1].next) {
    const struct piece *piece = &p->piece[k - 1];
    const int32_t to = piece->next ? p->piece[piece->next - 1].from : FLIGHT_TICKS;
    for (int end = 0; end < 2; end++) {
      const struct point at = after_ticks(piece->at, piece->rate, end ? to : piece->from);
      const int64_t x[3] = {at.x, at.y, at.z};
      for (int c = 0; c < 3; c++) {
        b->low[c] = least(b->low[c], x[c]);
        b->high[c] = most(b->high[c], x[c]);
      }
    }
  }
}

/* Judges all straight pieces of a pair's motion. Returns how many touch. */
static inline uint32_t judge_pair(struct replay *p, uint32_t bond, uint32_t other, const int64_t image[3])
{
  const struct model *m = &p->run->model;
  const uint32_t vertex[4] = {bond, (uint32_t)m->next[bond], other, (uint32_t)m->next[other]};
  uint32_t piece[4], touching = 0;
  for (int k = 0; k < 4; k++)
    piece[k] = p->first[vertex[k]];
  for (int32_t from = 0; from < FLIGHT_TICKS;) {
    int32_t to = FLIGHT_TICKS;
    for (int k = 0; k < 4; k++) {
      const uint32_t next = p->piece[piece[k]].next;
      if (next && p->piece[next - 1].from < to)
        to = p->piece[next - 1].from;
    }
    const struct flight_pair pair = pair_on(p, piece, image);
    if (to > from) {
      touching += exact_touch(&p->exact, &pair, from, to);
      p->judged++;
    }
    for (int k = 0; k < 4; k++) {
      const uint32_t next = p->piece[piece[k]].next;
      if (next && p->piece[next - 1].from == to)
        piece[k] = next - 1;
    }
    from = to;
  }
  return touching;
}

static inline void judge_images(struct replay *p, uint32_t bond, uint32_t other, const struct swept_box *a,
                                const struct swept_box *b)
{
  const struct model *m = &p->run->model;
  int64_t range[3][2];
  for (int c = 0; c < 3; c++) {
    images_between(a->low[c], a->high[c], b->low[c], b->high[c], m->box.edge[c], range[c]);
    if (range[c][0] > range[c][1])
      return;
  }
  for (int64_t i = range[0][0]; i <= range[0][1]; i++)
    for (int64_t j = range[1][0]; j <= range[1][1]; j++)
      for (int64_t k = range[2][0]; k <= range[2][1]; k++) {
        const int64_t image[3] = {i, j, k};
        if (i == 0 && j == 0 && k == 0 && meets(m, bond, other))
          continue; /* they share a vertex */
        p->touching += judge_pair(p, bond, other, image);
      }
}

static inline void judge_all(struct replay *p)
{
  const struct model *m = &p->run->model;
  struct swept_box *box = malloc(m->vertices * sizeof *box);
  for (uint32_t v = 0; v < m->vertices; v++) {
    if (m->next[v] < 0)
      continue;
    box[v] = (struct swept_box){{INT64_MAX, INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN, INT64_MIN}};
    sweep_vertex(p, v, &box[v]);
    sweep_vertex(p, (uint32_t)m->next[v], &box[v]);
  }
  for (uint32_t v = 0; v < m->vertices; v++)
    for (uint32_t w = v; w < m->vertices; w++)
      if (m->next[v] >= 0 && m->next[w] >= 0)
        judge_images(p, v, w, &box[v], &box[w]);
  free(box);
}

/* One drift, replayed. False, after a message, if a crossing was found. */
static inline bool replay_drift(struct replay *p, struct test_run *r, double fraction, uint64_t step, uint32_t drift,
                                uint64_t seed)
{
  const struct contact_log log = {replay_contact, p};
  const uint64_t rigid = r->state.counts.rigid, touching = p->touching;
  p->dt = fraction * r->model.time_step;
  p->pieces = r->state.vertices;
  for (uint32_t v = 0; v < r->state.vertices; v++) {
    p->first[v] = p->last[v] = v;
    p->contacts_of[v] = 0;
    p->piece[v] = (struct piece){0, r->state.position[v], rate_by_hand(r->state.velocity[v], p->dt), 0};
  }
  if (!contact_drift(&r->state, &r->model, &r->work.contact, fraction, step, drift, &log, &r->work.fault)) {
    char text[512];
    fault_describe(&r->work.fault, text, sizeof text);
    fail_msg("seed %lu: %s", (unsigned long)seed, text);
  }
  p->drifts++;
  p->rigid_drifts += r->state.counts.rigid != rigid;
  if (!paths_end(p, rigid, seed)) {
    p->unknown_drifts++;
    return true;
  }
  judge_all(p);
  if (p->touching != touching)
    print_message("  seed %lu, drift %lu: bonds touch\n", (unsigned long)seed, (unsigned long)p->drifts);
  return p->touching == touching;
}

static inline void replay_add(struct replay *sum, const struct replay *p)
{
  sum->drifts += p->drifts, sum->contacts += p->contacts, sum->invented += p->invented, sum->early += p->early;
  sum->judged += p->judged, sum->touching += p->touching, sum->image_contacts += p->image_contacts;
  sum->rigid_drifts += p->rigid_drifts, sum->unknown_drifts += p->unknown_drifts;
  sum->most_of_vertex = p->most_of_vertex > sum->most_of_vertex ? p->most_of_vertex : sum->most_of_vertex;
}

static inline void replay_tell(const char *name, const struct replay *p)
{
  print_message("  %-14s %6lu drifts %8lu contacts (%lu in images) %9lu pieces of pairs; %lu touch, %lu early, "
                "%lu invented; %u contacts of a vertex; %lu drifts with a rigid cluster, %lu not replayed\n",
                name, (unsigned long)p->drifts, (unsigned long)p->contacts, (unsigned long)p->image_contacts,
                (unsigned long)p->judged, (unsigned long)p->touching, (unsigned long)p->early,
                (unsigned long)p->invented, p->most_of_vertex, (unsigned long)p->rigid_drifts,
                (unsigned long)p->unknown_drifts);
}

/* --- dense suspensions -------------------------------------------------------------------------------------------- */

/* The pair list in another order. */
static inline void shuffle_pairs(struct pair_list *list, struct dice *d)
{
  for (uint32_t k = list->count; k-- > 1;) {
    const uint32_t j = (uint32_t)dice_integer(d, 0, k);
    uint32_t *columns[] = {list->bond, list->other, list->limit};
    for (int c = 0; c < 3; c++) {
      const uint32_t swap = columns[c][k];
      columns[c][k] = columns[c][j];
      columns[c][j] = swap;
    }
    const struct pair_detail swap = list->detail[k];
    list->detail[k] = list->detail[j];
    list->detail[j] = swap;
  }
}

static const struct replayed {
  const char *name;
  int edge[3];
  uint32_t fibers, vertices;
  double bond, move; /* a0: length, and typical displacement in a drift */
  double fast;       /* part of the vertices that are 30 times as fast */
  int drifts;
} replayed[] = {
    {"slow", {5, 4, 4}, 80, 8, 0.54, 0.005, 0.0, 8},    {"usual", {5, 4, 4}, 80, 8, 0.54, 0.02, 0.0, 8},
    {"fast", {5, 4, 4}, 80, 8, 0.54, 0.1, 0.0, 4},      {"a few fast", {5, 4, 4}, 80, 8, 0.54, 0.005, 0.05, 8},
    {"very fast", {6, 6, 6}, 60, 8, 0.54, 0.4, 0.0, 2}, {"small box", {2, 1, 2}, 20, 8, 0.25, 0.03, 0.0, 8},
    {"one cell", {1, 1, 1}, 8, 12, 0.25, 0.03, 0.0, 8}, {"crowded", {3, 3, 3}, 80, 8, 0.54, 0.01, 0.0, 4},
};
enum { REPLAYED = sizeof replayed / sizeof replayed[0] };

/* From now on the run has this crossing rule, which needs scratch of its own. */
static inline void follow_rule(struct test_run *r, enum crossing_kind rule)
{
  contact_force *force = r->work.contact.force;
  r->model.crossing.rule = rule;
  contact_free(&r->work.contact);
  assert_true(contact_alloc(&r->work.contact, &r->model, force, false));
}

/* Suspensions of fibers and lighter rings, thrown anew for every drift; drifts of whole and half steps; pair lists in
 * any order, which changes no bit. */
static inline void replay_suspensions(uint64_t seed, const struct replayed *kind, uint64_t suspensions)
{
  struct replay sum = {0};
  for (uint64_t k = 0; k < suspensions; k++) {
    struct dice d = {seed + 10 * k}, same = d;
    struct test_run twin = /* which keeps the order of its lists */
        dense(kind->edge[0], kind->edge[1], kind->edge[2], kind->fibers, kind->vertices, kind->bond, &same);
    follow_rule(&twin, CROSSING_EVENT_DRIVEN);
    struct test_run r =
        dense(kind->edge[0], kind->edge[1], kind->edge[2], kind->fibers, kind->vertices, kind->bond, &d);
    follow_rule(&r, CROSSING_EVENT_DRIVEN);
    struct replay *p = replay_open(&r);
    for (int drift = 0; drift < kind->drifts; drift++) {
      const double fraction = drift % 3 == 2 ? 0.5 : 1.0;
      for (uint32_t v = 0; v < r.state.vertices; v++)
        r.state.velocity[v] =
            dice_vector(&d, (dice_uniform(&d) < kind->fast ? 30.0 : 1.0) * kind->move / r.model.time_step);
      memcpy(twin.state.velocity, r.state.velocity, r.state.vertices * sizeof *r.state.velocity);
      shuffle_pairs(&r.work.contact.neighbors.pairs, &d);
      if (!replay_drift(p, &r, fraction, 100 + (uint64_t)drift, (uint32_t)drift % 2, seed + 10 * k))
        fail_msg("seed %lu, %s: bonds pass through each other", (unsigned long)(seed + 10 * k), kind->name);
      assert_true(contact_drift(&twin.state, &twin.model, &twin.work.contact, fraction, 100 + (uint64_t)drift,
                                (uint32_t)drift % 2, NULL, &twin.work.fault));
      assert_memory_equal(twin.state.position, r.state.position, r.state.vertices * sizeof *r.state.position);
      assert_memory_equal(twin.state.velocity, r.state.velocity, r.state.vertices * sizeof *r.state.velocity);
    }
    replay_add(&sum, p);
    replay_close(p);
    test_end(&r);
    test_end(&twin);
  }
  replay_tell(kind->name, &sum);
  assert_true(sum.early == 0 && sum.contacts > 0);
}

#endif
