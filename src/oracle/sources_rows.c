/* What tables of rows that stand for themselves are read from, a line each. */
#include "oracle/source.h"

#include <stdlib.h>

#include "base/normal.h"
#include "oracle/rows.h"

COUNT(rows, g->rows)
COUNT(permuted, g->rows > 0 ? ((const struct oracle_permutation *)g->row)->address.entity : 0)

/* Points within 2048 a0 of one that is in reach. */
static bool are_near(struct point o, const struct point *p, int n)
{
  const int64_t most = (int64_t)1 << 51;
  bool near = point_within_reach(o);
  for (int k = 0; near && k < n; k++)
    near = point_within_reach(p[k]) && llabs(p[k].x - o.x) < most && llabs(p[k].y - o.y) < most &&
           llabs(p[k].z - o.z) < most;
  return near;
}

static bool test_is_legal(const void *row)
{
  const struct crossing_query *q = &((const struct oracle_test *)row)->query;
  return are_near(q->from, &q->from, 5);
}

static bool meeting_is_legal(const void *row)
{
  const struct oracle_meeting *m = row;
  const struct point zero = {0, 0, 0};
  return are_near(zero, m->p, 2) && are_near(zero, m->q, 2) && are_near(zero, m->w, 2);
}

static bool search_is_legal(const void *row)
{
  const struct oracle_search *s = row;
  return oracle_search_is_legal(&s->pair, s->from) && s->reach >= 0 && s->reach < (int64_t)1 << 50;
}

static bool tubes_are_legal(const void *row)
{
  return are_near((struct point){0, 0, 0}, &((const struct oracle_tubes *)row)->p, 3);
}

static const struct oracle_entity
    addresses = {.word = "address", .count = count_rows, .size = sizeof(struct oracle_address)},
    permuted = {.word = "entry", .count = count_permuted},
    permutations = {.word = "permutation", .count = count_rows, .size = sizeof(struct oracle_permutation)},
    tests = {.word = "test", .count = count_rows, .size = sizeof(struct oracle_test), .legal = test_is_legal},
    meetings = {.word = "pair", .count = count_rows, .size = sizeof(struct oracle_meeting), .legal = meeting_is_legal},
    exchanges = {.word = "exchange", .count = count_rows, .size = sizeof(struct oracle_exchange)},
    searches = {.word = "search", .count = count_rows, .size = sizeof(struct oracle_search), .legal = search_is_legal},
    contacts = {.word = "contact", .count = count_rows, .size = sizeof(struct oracle_tubes), .legal = tubes_are_legal},
    impulses = {.word = "impulse", .count = count_rows, .size = sizeof(struct oracle_impulse)},
    events = {.word = "event", .count = count_rows};

static bool is_word(int64_t n)
{
  return n >= 0 && n < UINT32_MAX;
}

static bool take_address(struct oracle_address *a, const int64_t n[4])
{
  *a = (struct oracle_address){(enum random_purpose)n[0], (uint32_t)n[1], (uint32_t)n[3], (uint64_t)n[2]};
  return is_word(n[1]) && is_word(n[3]);
}

/* --- random numbers ---------------------------------------------------------------------------------------------- */

static const struct oracle_address *address(const struct oracle_stage *g, uint32_t k)
{
  return &((const struct oracle_address *)g->row)[k];
}

static struct random_words words(const struct oracle_stage *g, uint32_t k)
{
  const struct oracle_address *a = address(g, k);
  return random_at(M->seed, a->purpose, a->draw, a->step, a->entity);
}

TAKEN_INTEGERS(addresses, addresses, "purpose draw step entity", take_address(&((struct oracle_address *)g->row)[k], n),
               address(g, k)->purpose, address(g, k)->draw, (int64_t)address(g, k)->step, address(g, k)->entity)
INTEGERS(words, addresses, "0 1 2 3", words(g, k).w[0], words(g, k).w[1], words(g, k).w[2], words(g, k).w[3])
REALS(uniforms, addresses, "0 1", random_uniform(words(g, k), 0), random_uniform(words(g, k), 1))
FILL(normals, double, random_normal_pair(words(g, k), row);)
const struct oracle_source from_normals = {.columns = "first second", .of = &addresses, .reals = fill_normals};
VECTOR(random_axes, addresses, random_axis(M->seed, address(g, k)->purpose, address(g, k)->step, address(g, k)->entity))

#define PERMUTATION ((struct oracle_permutation *)g->row)
TAKEN_INTEGERS(permutation, permutations, "purpose draw step size",
               take_address(&PERMUTATION[k].address, n) && n[3] <= ORACLE_PERMUTED, PERMUTATION[k].address.purpose,
               PERMUTATION[k].address.draw, (int64_t)PERMUTATION[k].address.step, PERMUTATION[k].address.entity)
INTEGERS(permuted, permuted, "entry", PERMUTATION->order[k])

#define TEST ((struct oracle_test *)g->row)[k]
TAKEN_POINT(test_from, tests, TEST.query.from)
TAKEN_POINT(test_to, tests, TEST.query.to)
TAKEN_POINT(test_pivot, tests, TEST.query.pivot)
TAKEN_POINT(test_a, tests, TEST.query.a)
TAKEN_POINT(test_b, tests, TEST.query.b)
TAKEN_INTEGERS(flip, tests, "flip", (TEST.query.flip = n[0] != 0, true), TEST.query.flip)
INTEGERS(crosses, tests, "crosses", TEST.crosses)
#define HIT(h) (h).time, (h).s, (h).s_standing, (h).normal.x, (h).normal.y, (h).normal.z
REALS(hit, tests, "time s s_standing normal_x normal_y normal_z", HIT(TEST.hit))
REALS(test_condition, tests, "condition", TEST.condition)

#define MEETING ((struct oracle_meeting *)g->row)[k]
TAKEN_POINT(meeting_p, meetings, MEETING.p[0])
TAKEN_POINT(meeting_q, meetings, MEETING.q[0])
TAKEN_POINT(meeting_w, meetings, MEETING.w[0])
TAKEN_POINT(meeting_p_last, meetings, MEETING.p[1])
TAKEN_POINT(meeting_q_last, meetings, MEETING.q[1])
TAKEN_POINT(meeting_w_last, meetings, MEETING.w[1])
INTEGERS(meeting_class, meetings, "class", MEETING.class)
INTEGERS(meeting_signs, meetings, "first second third", MEETING.sign[0], MEETING.sign[1], MEETING.sign[2])

#define EXCHANGE ((struct oracle_exchange *)g->row)[k]
#define FOUR(x) (x)[0], (x)[1], (x)[2], (x)[3]
TAKEN_VECTOR(exchange_moving, exchanges, EXCHANGE.velocity[0])
TAKEN_VECTOR(exchange_pivot, exchanges, EXCHANGE.velocity[1])
TAKEN_VECTOR(exchange_a, exchanges, EXCHANGE.velocity[2])
TAKEN_VECTOR(exchange_b, exchanges, EXCHANGE.velocity[3])
TAKEN_REALS(exchange_masses, exchanges, "moving pivot a b", memcpy(EXCHANGE.mass, n, sizeof EXCHANGE.mass) != NULL,
            FOUR(EXCHANGE.mass))
TAKEN_REALS(exchange_contact, exchanges, "s s_standing", (EXCHANGE.s = n[0], EXCHANGE.s_standing = n[1], true),
            EXCHANGE.s, EXCHANGE.s_standing)
TAKEN_VECTOR(exchange_normal, exchanges, EXCHANGE.normal)
REALS(exchange_momentum, exchanges, "momentum", EXCHANGE.momentum)
VECTOR(after_moving, exchanges, EXCHANGE.after[0])
VECTOR(after_pivot, exchanges, EXCHANGE.after[1])
VECTOR(after_a, exchanges, EXCHANGE.after[2])
VECTOR(after_b, exchanges, EXCHANGE.after[3])

#define SEARCH ((struct oracle_search *)g->row)[k]
TAKEN_POINT(search_p, searches, SEARCH.pair.p)
TAKEN_POINT(search_q, searches, SEARCH.pair.q)
TAKEN_POINT(search_w, searches, SEARCH.pair.w)
TAKEN_POINT(search_p_rate, searches, SEARCH.pair.p_rate)
TAKEN_POINT(search_q_rate, searches, SEARCH.pair.q_rate)
TAKEN_POINT(search_w_rate, searches, SEARCH.pair.w_rate)
TAKEN_INTEGERS(search_from, searches, "tick", (SEARCH.from = (int32_t)n[0], n[0] >= 0 && n[0] < FLIGHT_TICKS),
               SEARCH.from)
TAKEN_INTEGERS(search_reach, searches, "reach", (SEARCH.reach = n[0], true), SEARCH.reach)
INTEGERS(search_tick, searches, "tick", SEARCH.tick)

#define TUBES_ROW ((struct oracle_tubes *)g->row)[k]
TAKEN_POINT(tubes_p, contacts, TUBES_ROW.p)
TAKEN_POINT(tubes_q, contacts, TUBES_ROW.q)
TAKEN_POINT(tubes_w, contacts, TUBES_ROW.w)
REALS(tubes_contact, contacts, "s t", TUBES_ROW.s, TUBES_ROW.t)
VECTOR(tubes_normal, contacts, TUBES_ROW.normal)

#define IMPULSE ((struct oracle_impulse *)g->row)[k]
TAKEN_VECTOR(impulse_p0, impulses, IMPULSE.velocity[0])
TAKEN_VECTOR(impulse_p1, impulses, IMPULSE.velocity[1])
TAKEN_VECTOR(impulse_q0, impulses, IMPULSE.velocity[2])
TAKEN_VECTOR(impulse_q1, impulses, IMPULSE.velocity[3])
TAKEN_VECTOR(impulse_force_p0, impulses, IMPULSE.force[0])
TAKEN_VECTOR(impulse_force_p1, impulses, IMPULSE.force[1])
TAKEN_VECTOR(impulse_force_q0, impulses, IMPULSE.force[2])
TAKEN_VECTOR(impulse_force_q1, impulses, IMPULSE.force[3])
TAKEN_REALS(impulse_masses, impulses, "p0 p1 q0 q1", memcpy(IMPULSE.mass, n, sizeof IMPULSE.mass) != NULL,
            FOUR(IMPULSE.mass))
TAKEN_REALS(impulse_contact, impulses, "s t", (IMPULSE.s = n[0], IMPULSE.t = n[1], true), IMPULSE.s, IMPULSE.t)
TAKEN_VECTOR(impulse_normal, impulses, IMPULSE.normal)
TAKEN_REALS(impulse_tau, impulses, "tau", (IMPULSE.tau = n[0], true), IMPULSE.tau)
INTEGERS(impulse_answer, impulses, "answer", IMPULSE.answer)
REALS(impulse_momentum, impulses, "momentum", IMPULSE.momentum)
VECTOR(after_p0, impulses, IMPULSE.after[0])
VECTOR(after_p1, impulses, IMPULSE.after[1])
VECTOR(after_q0, impulses, IMPULSE.after[2])
VECTOR(after_q1, impulses, IMPULSE.after[3])

#define EVENT ((const struct oracle_event *)g->row)[k].event
#define IMAGE EVENT.image[0], EVENT.image[1], EVENT.image[2]
#define NORMAL EVENT.hit.normal.x, EVENT.hit.normal.y, EVENT.hit.normal.z
INTEGERS(sweep_events, events, "vertex moving standing image_x image_y image_z executed", EVENT.vertex,
         EVENT.moving_bond, EVENT.standing_bond, IMAGE, EVENT.executed)
REALS(sweep_hits, events, "time s s_standing normal_x normal_y normal_z momentum", HIT(EVENT.hit), EVENT.impulse)
INTEGERS(drift_events, events, "bond other image_x image_y image_z tick", EVENT.moving_bond, EVENT.standing_bond, IMAGE,
         ((const struct oracle_event *)g->row)[k].tick)
REALS(drift_hits, events, "s t normal_x normal_y normal_z momentum", EVENT.hit.s, EVENT.hit.s_standing, NORMAL,
      EVENT.impulse)
REALS(event_condition, events, "condition", ((const struct oracle_event *)g->row)[k].condition)
