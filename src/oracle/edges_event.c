/*
 * Constructed inputs for contacts at their own time: bonds that touch when they are parallel, on one line, end on end,
 * in one plane, in the first tick or the last; near misses by some lattice units; impulses about the bounds of the
 * rebound; drifts with many contacts in one tick. docs/port/packs.md says what is in each.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/determinant.h"
#include "oracle/dice.h"
#include "oracle/drift.h"
#include "oracle/edges.h"
#include "oracle/rows.h"
#include "oracle/stages.h"

/* --- searches ---------------------------------------------------------------------------------------------------- */

enum direction { ANY_DIRECTION, PARALLEL, PARALLEL_THEN, ON_ONE_LINE, IN_A_PLANE, NEARLY_PARALLEL };
enum place { ANY_PLACE, END_ON_BOND, END_ON_END };
enum motion { ANY_MOTION, NO_TURN, GRAZING };
enum when { ANY_TIME, FIRST_TICK, LAST_TICK, AT_THE_END };

/* A kind of contact: powers of two for the sizes of bonds and of motions in a tick; off: the bonds miss each other by
 * up to so many lattice units. doubtful: kept only if doubles alone give another tick. */
static const struct search_kind {
  uint32_t rows;
  int bond, rate;
  enum direction direction;
  enum place place;
  enum motion motion;
  enum when when;
  int64_t off;
  bool doubtful;
} search_kinds[] = {
    {24, 39, 20, .off = 0},
    {12, 39, 20, .direction = PARALLEL},
    {12, 39, 20, .direction = PARALLEL_THEN},
    {12, 39, 20, .direction = ON_ONE_LINE, .place = END_ON_END},
    {16, 39, 16, .direction = IN_A_PLANE},
    {12, 38, 19, .direction = NEARLY_PARALLEL},
    {12, 39, 20, .place = END_ON_BOND},
    {12, 39, 20, .place = END_ON_END},
    {12, 39, 20, .motion = GRAZING},
    {8, 39, 20, .when = FIRST_TICK},
    {8, 39, 20, .when = LAST_TICK},
    {8, 39, 20, .when = AT_THE_END, .motion = NO_TURN},
    {24, 39, 20, .place = END_ON_END, .off = 1 << 18},
    {24, 39, 12, .place = END_ON_END, .off = 1 << 10},
    {12, 39, 12, .place = END_ON_BOND, .off = 1 << 10},
    {24, 6, 4, .off = 4},
    {24, 10, 5, .place = END_ON_END, .off = 6},
    {12, 48, 8, .direction = NEARLY_PARALLEL, .doubtful = true},
    {12, 39, 4, .direction = NEARLY_PARALLEL, .doubtful = true},
    {12, 39, 16, .direction = IN_A_PLANE, .doubtful = true},
    {8, 45, 12, .motion = GRAZING, .doubtful = true},
};
enum { SEARCH_KINDS = sizeof search_kinds / sizeof *search_kinds, AT_REST = 8, TRIES = 20000 };

static struct point plus_times(struct point p, int64_t factor, struct point q)
{
  return (struct point){p.x + factor * q.x, p.y + factor * q.y, p.z + factor * q.z};
}

static struct point times(int64_t factor, struct point p)
{
  return plus_times((struct point){0, 0, 0}, factor, p);
}

/* Numbers are drawn one after the other: C does not say in which order arguments are evaluated. */
static struct point draw_in_plane(struct dice *d, int64_t most, struct point one, struct point other)
{
  const int64_t b = dice_integer(d, most), a = dice_integer(d, most);
  return plus_times(times(a, one), b, other);
}

static int64_t draw_tick(struct dice *d, enum when when)
{
  const int64_t half[] = {dice_u64(d) % (2 * FLIGHT_TICKS - 4) + 2, 1, 2 * FLIGHT_TICKS - 1, 2 * FLIGHT_TICKS};
  return half[when];
}

/* Bonds that touch at half / 2 ticks, at s = a/8 and t = b/8: w = s p - t q - time V, and its rate s p' - t q' + V. All
 * vectors are multiples of 8, and V is even, so all are integers. */
static struct flight_pair make_pair(struct dice *d, const struct search_kind *k)
{
  const int64_t half = draw_tick(d, k->when), bond = (int64_t)1 << (k->bond > 3 ? k->bond - 3 : 0),
                rate = (int64_t)1 << (k->rate > 3 ? k->rate - 3 : 0);
  const bool first = dice_u64(d) % 2;
  const int64_t a = k->place == ANY_PLACE || (k->place == END_ON_BOND && first) ? 1 + (int64_t)(dice_u64(d) % 7)
                                                                                : (int64_t)(dice_u64(d) % 2) * 8;
  const int64_t b = k->place == ANY_PLACE || (k->place == END_ON_BOND && !first) ? 1 + (int64_t)(dice_u64(d) % 7)
                                                                                 : (int64_t)(dice_u64(d) % 2) * 8;
  struct point p = dice_point(d, bond), q = dice_point(d, bond), p_rate = dice_point(d, rate),
               q_rate = dice_point(d, rate), v = dice_point(d, rate);
  const int64_t factor = dice_u64(d) % 2 ? 2 : -1;
  if (k->motion != ANY_MOTION || k->direction == ON_ONE_LINE)
    p_rate = q_rate = (struct point){0, 0, 0};
  if (k->direction == PARALLEL || k->direction == ON_ONE_LINE)
    q = times(factor, p), q_rate = times(factor, p_rate);
  if (k->direction == ON_ONE_LINE)
    v = (struct point){p.x >> (k->bond - k->rate), p.y >> (k->bond - k->rate), p.z >> (k->bond - k->rate)},
    p = times((int64_t)1 << (k->bond - k->rate), v), q = times(factor, p);
  if (k->direction == PARALLEL_THEN) { /* at the time of contact; times 2, since the time is a half */
    const struct point turn = dice_point(d, rate);
    q = plus_times(times(2 * factor, p), -half, turn), q_rate = plus_times(times(2 * factor, p_rate), 2, turn);
    p = times(2, p), p_rate = times(2, p_rate);
  }
  if (k->direction == NEARLY_PARALLEL)
    q = plus_times(times(factor, p), 1, dice_point(d, 2)),
    q_rate = plus_times(times(factor, p_rate), 1, dice_point(d, 1));
  if (k->direction == IN_A_PLANE) {
    const struct point one = dice_point(d, 1 << 9), other = dice_point(d, 1 << 9);
    const int64_t size = 1 << 26, slow = 1 << 4;
    p = draw_in_plane(d, size, one, other);
    q = draw_in_plane(d, size, one, other);
    p_rate = draw_in_plane(d, slow, one, other);
    q_rate = draw_in_plane(d, slow, one, other);
    v = draw_in_plane(d, slow, one, other);
  }
  if (k->motion == GRAZING) { /* V in the plane of p and q: f = 0 twice */
    const int shift = k->bond - k->rate;
    v = (struct point){(3 * p.x - q.x) >> shift, (3 * p.y - q.y) >> shift, (3 * p.z - q.z) >> shift};
  }
  v = times(2, v);
  struct flight_pair pair = {times(8, p), times(8, q), {0, 0, 0}, times(8, p_rate), times(8, q_rate), {0, 0, 0}};
  pair.w = plus_times(plus_times(times(a, p), -b, q), -half, (struct point){v.x / 2, v.y / 2, v.z / 2});
  pair.w = plus_times(pair.w, 1, dice_point(d, k->off));
  pair.w_rate = plus_times(plus_times(times(a, p_rate), -b, q_rate), 1, v);
  return pair;
}

/* --- what doubles say --------------------------------------------------------------------------------------------- */

static struct vec3 real_at(struct point at, struct point rate, int32_t tick)
{
  const struct point p = flight_place(at, rate, tick);
  return (struct vec3){(double)p.x, (double)p.y, (double)p.z};
}

static double volume(struct vec3 p, struct vec3 q, struct vec3 w)
{
  return vec3_dot(vec3_cross(p, q), w);
}

/* Condition (i) for one tick in doubles, without doubt about their signs. */
static bool doubles_exclude(const struct flight_pair *f, int32_t tick)
{
  const struct vec3 p0 = real_at(f->p, f->p_rate, tick), p1 = real_at(f->p, f->p_rate, tick + 1),
                    q0 = real_at(f->q, f->q_rate, tick), q1 = real_at(f->q, f->q_rate, tick + 1),
                    w0 = real_at(f->w, f->w_rate, tick), w1 = real_at(f->w, f->w_rate, tick + 1);
  const double c[4] = {volume(p0, q0, w0), volume(p1, q0, w0) + volume(p0, q1, w0) + volume(p0, q0, w1),
                       volume(p1, q1, w0) + volume(p1, q0, w1) + volume(p0, q1, w1), volume(p1, q1, w1)};
  return (c[0] > 0.0 && c[1] > 0.0 && c[2] > 0.0 && c[3] > 0.0) ||
         (c[0] < 0.0 && c[1] < 0.0 && c[2] < 0.0 && c[3] < 0.0);
}

static bool fits(const struct flight_pair *pair)
{
  const int64_t *at = &pair->p.x, *rate = &pair->p_rate.x, limit = (int64_t)1 << 51;
  for (int k = 0; k < 9; k++)
    if (llabs(at[k]) > limit || llabs(at[k] + rate[k] * FLIGHT_TICKS) > limit)
      return false;
  return true;
}

static bool is_wanted(const struct search_kind *k, const struct oracle_search *s)
{
  const int32_t tick = flight_contact(&s->pair, s->from);
  if (k->doubtful) /* a contact that doubles alone would miss */
    return tick < FLIGHT_TICKS && tick > s->from && doubles_exclude(&s->pair, tick);
  return k->off != 0 || (tick < FLIGHT_TICKS && (tick > s->from || k->when == FIRST_TICK));
}

static uint32_t add_searches(struct dice *d, const struct search_kind *k, struct oracle_search *s)
{
  uint32_t n = 0;
  for (int tries = 0; n < k->rows && tries < TRIES; tries++) {
    s[n] = (struct oracle_search){.pair = make_pair(d, k)};
    s[n].from = n % 4 == 3 && k->when == ANY_TIME ? (int32_t)(dice_u64(d) % (FLIGHT_TICKS / 4)) : 0;
    n += fits(&s[n].pair) && is_wanted(k, &s[n]);
  }
  return n;
}

/* No contact, even of bonds that touch; a motion of both together is not in p, q, w. */
static uint32_t add_at_rest(struct dice *d, struct oracle_search *s)
{
  const struct search_kind any = {.bond = 39, .rate = 20};
  for (uint32_t k = 0; k < AT_REST; k++) {
    struct flight_pair pair = make_pair(d, &any);
    pair.p_rate = pair.q_rate = pair.w_rate = (struct point){0, 0, 0};
    if (k % 2)
      pair.w = (struct point){pair.p.x / 8 * 3, pair.p.y / 8 * 3, pair.p.z / 8 * 3};
    s[k] = (struct oracle_search){.pair = pair};
  }
  return AT_REST;
}

bool oracle_edges_contact_search(struct oracle_stage *g)
{
  struct dice d = {53};
  uint32_t rows = AT_REST, n = 0;
  for (int k = 0; k < SEARCH_KINDS; k++)
    rows += search_kinds[k].rows;
  struct oracle_search *s = malloc((rows + 1) * sizeof *s);
  g->pack->failed |= !s;
  if (!s)
    return false;
  for (int k = 0; k < SEARCH_KINDS; k++)
    n += add_searches(&d, &search_kinds[k], &s[n]);
  n += add_at_rest(&d, &s[n]);
  const bool ok = oracle_add_rows(g, s, n, sizeof *s);
  free(s);
  return ok;
}

/* --- impulses ---------------------------------------------------------------------------------------------------- */

enum { IMPULSES = 140 };

/* The approach is a and what F adds to it in tau is h, exactly: two single vertices, head on. */
static struct oracle_impulse head_on(double a, double h)
{
  return (struct oracle_impulse){.velocity = {{a, 0.25, 0}, {1, 1, 1}, {0, -0.5, 0}, {2, 0, 1}},
                                 .force = {{h, 3, 0}, {9, 9, 9}, {0, 1, 0}, {7, 0, 0}},
                                 .mass = {1, 2, 4, 8},
                                 .normal = {1, 0, 0},
                                 .tau = 1.0};
}

static struct oracle_impulse draw_impulse(struct dice *d, uint32_t k)
{
  static const double masses[6] = {1.0, 2.0, 5.0, 7.5, 100.25, 0x1p-4}, taus[5] = {0.0, 0.005, -0.005, 0.08, -0.08};
  static const double forces[4] = {0.0, 10.0, 200.0, 3000.0};
  struct oracle_impulse e = {.tau = taus[k % 5], .s = edges_place(d), .t = edges_place(d), .normal = edges_normal(d)};
  for (int end = 0; end < 4; end++) {
    e.velocity[end] = edges_velocity(d, k % 16);
    e.force[end] = vec3_scale(1.0, dice_vector(d, forces[k % 4]));
    e.mass[end] = k % 3 == 0 ? 5.0 : masses[dice_u64(d) % 6];
  }
  return e;
}

bool oracle_edges_impulse(struct oracle_stage *g)
{
  static const double bounds[][2] = {{5, -2},
                                     {5, -2.0000000001},
                                     {5, -1.9999999999},
                                     {1, 2},
                                     {1, 2.0000000001},
                                     {1, 1.9999999999},
                                     {1, 0},
                                     {1, -0.5},
                                     {1, -1e6},
                                     {1, 1e6},
                                     {1e-9, 1},
                                     {1e-9, -1},
                                     {0, 1},
                                     {-1, 3},
                                     {1e-30, 1e-20}};
  enum { BOUNDS = sizeof bounds / sizeof *bounds };
  struct dice d = {61};
  struct oracle_impulse e[IMPULSES];
  for (uint32_t k = 0; k < IMPULSES; k++) {
    e[k] = k < BOUNDS ? head_on(bounds[k][0], bounds[k][1]) : draw_impulse(&d, k);
    double approach = 0.0;
    const double lever[4] = {1.0 - e[k].s, e[k].s, e[k].t - 1.0, -e[k].t};
    for (int end = 0; end < 4; end++)
      approach += lever[end] * vec3_dot(e[k].velocity[end], e[k].normal);
    if (k >= BOUNDS && approach < 0.0 && k % 8) /* most of them approach */
      e[k].normal = vec3_scale(-1.0, e[k].normal);
  }
  return oracle_add_rows(g, e, IMPULSES, sizeof *e);
}

/* --- a drift ----------------------------------------------------------------------------------------------------- */

#define PART EDGES_PART
#define DRIFT 0.25 /* t0 */

/* A needle: its ends in parts of a slot, how far both move in the drift (parts), and lattice units to be added to y. */
static const struct needle {
  int slot, from[3], to[3], move[3];
  int64_t units;
} needles[] = {
    /* parallel; on one line; an end against a bond, in one plane */
    {16, {0, 4, -4}, {0, 4, 4}, {0, 8, 0}, 0},
    {16, {0, 8, -3}, {0, 8, 5}, {0, 0, 0}, 0},
    {17, {-7, 8, 0}, {-3, 8, 0}, {6, 0, 0}, 0},
    {17, {0, 8, 0}, {5, 8, 0}, {0, 0, 0}, 0},
    {18, {2, 1, 0}, {2, 5, 0}, {0, 8, 0}, 0},
    {18, {0, 8, 0}, {6, 8, 0}, {0, 0, 0}, 0},
    /* in the first tick; in the middle of the last; at the very end; at the very beginning: they only part */
    {19, {-4, 8, 0}, {4, 8, 0}, {0, 8, 0}, -3},
    {19, {0, 8, -4}, {0, 8, 4}, {0, 0, 0}, 0},
    {20, {-4, 0, 0}, {4, 0, 0}, {0, 8, 0}, 1 << 22},
    {20, {0, 8, -4}, {0, 8, 4}, {0, 0, 0}, 0},
    {21, {-4, 0, 0}, {4, 0, 0}, {0, 8, 0}, 0},
    {21, {0, 8, -4}, {0, 8, 4}, {0, 0, 0}, 0},
    {22, {-4, 8, 0}, {4, 8, 0}, {0, 6, 0}, 0},
    {22, {0, 8, -4}, {0, 8, 4}, {0, 0, 0}, 0},
    /* between two others */
    {23, {0, 7, -4}, {0, 7, 4}, {2, 18, 0}, 0},
    {23, {-4, 6, 1}, {4, 6, 1}, {0, 0, 0}, 0},
    {23, {-4, 8, 1}, {4, 9, 0}, {0, 0, 0}, 0},
};
enum { NEEDLES = sizeof needles / sizeof *needles };
_Static_assert(NEEDLES + 3 == EDGES_NEEDLES, "three make a cluster");

static struct point corner_of(int slot)
{
  return (struct point){(int64_t)(2 * (slot % 2) + 1) * LATTICE_CELL, (int64_t)(slot / 2 % 5) * LATTICE_CELL,
                        (int64_t)(slot / 10) * LATTICE_CELL + 8 * PART};
}

static struct point in_slot(int slot, const int parts[3])
{
  return point_plus(corner_of(slot), (struct point){parts[0] * PART, parts[1] * PART, parts[2] * PART});
}

static void stand_needles(struct oracle_stage *g, uint32_t first)
{
  for (uint32_t k = 0; k < NEEDLES; k++) {
    const struct needle *n = &needles[k];
    const struct vec3 v = {n->move[0] / (16.0 * DRIFT), n->move[1] / (16.0 * DRIFT), n->move[2] / (16.0 * DRIFT)};
    const int *const end[2] = {n->from, n->to};
    for (uint32_t e = 0; e < 2; e++) {
      g->state->position[first + 2 * k + e] = point_plus(in_slot(n->slot, end[e]), (struct point){0, n->units, 0});
      g->state->velocity[first + 2 * k + e] = v;
    }
  }
}

/* A pair that no impulse separates, and a third needle that meets both later. */
static void stand_cluster(struct oracle_stage *g, uint32_t first)
{
  const int slot = 25, low[3] = {0, 4, -4}, high[3] = {0, 4, 4}, middle[3] = {0, 8, 0};
  edges_tiny_pair(g, first, in_slot(slot, middle), (struct vec3){0, 0, 0}, DRIFT);
  for (uint32_t k = 4; k < 6; k++) {
    g->state->position[first + k] = in_slot(slot, k == 4 ? low : high);
    g->state->velocity[first + k] = (struct vec3){0, 0.5 / DRIFT, 0};
  }
}

/* The other fibers in a tangle, each some boxes away. */
static void tangle(struct oracle_stage *g, uint32_t first, uint32_t fibers, double speed)
{
  struct dice d = {71};
  for (uint32_t f = 0; f < fibers; f++) {
    const int32_t image[3] = {(int32_t)dice_integer(&d, 2), (int32_t)dice_integer(&d, 1), (int32_t)dice_integer(&d, 3)};
    const struct point middle = in_slot(26 + (int)(f % 3), (const int[3]){0, 8, 0});
    struct point at = point_plus(point_image(middle, image, &g->model->box), dice_point(&d, 5 * PART));
    for (uint32_t k = 0; k < 4; k++) {
      g->state->position[first + 4 * f + k] = at;
      g->state->velocity[first + 4 * f + k] = dice_vector(&d, speed);
      at = point_plus(at, dice_point(&d, 5 * PART));
    }
  }
}

bool oracle_edges_event_drift(struct oracle_stage *g)
{
  const uint32_t first = 2 * EDGES_PAIRS + 3 * EDGES_CHAINS;
  edges_at_the_same_time(g);
  stand_needles(g, first);
  stand_cluster(g, first + 2 * NEEDLES);
  tangle(g, first + 2 * EDGES_NEEDLES, EDGES_STIFF + EDGES_RINGS, 1.5);
  const uint32_t far = g->state->vertices - 2 * EDGES_FAR;
  edges_long_needles(g, far, DRIFT);
  edges_joining_clusters(g, far + 4, corner_of(29), DRIFT);
  return oracle_begin_drift_of(g, DRIFT, 0);
}
