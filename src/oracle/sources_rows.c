/* What tables of rows that stand for themselves are read from, a line each. */
#include "oracle/source.h"

#include "base/normal.h"
#include "oracle/rows.h"

COUNT(rows, g->rows)
COUNT(permuted, g->rows > 0 ? ((const struct oracle_permutation *)g->row)->address.entity : 0)

static const struct oracle_entity addresses = {"address", count_rows, NULL}, permuted = {"entry", count_permuted, NULL},
                                  entries = {"entry", count_rows, NULL}, tests = {"test", count_rows, NULL},
                                  exchanges = {"exchange", count_rows, NULL}, searches = {"search", count_rows, NULL},
                                  contacts = {"contact", count_rows, NULL}, impulses = {"impulse", count_rows, NULL},
                                  events = {"event", count_rows, NULL};

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

INTEGERS(addresses, addresses, "purpose draw step entity", address(g, k)->purpose, address(g, k)->draw,
         (int64_t)address(g, k)->step, address(g, k)->entity)
INTEGERS(words, addresses, "0 1 2 3", words(g, k).w[0], words(g, k).w[1], words(g, k).w[2], words(g, k).w[3])
REALS(uniforms, addresses, "0 1", random_uniform(words(g, k), 0), random_uniform(words(g, k), 1))
FILL(normals, double, random_normal_pair(words(g, k), row);)
const struct oracle_source from_normals = {"first second", &addresses, NULL, fill_normals};
VECTOR(random_axes, addresses, random_axis(M->seed, address(g, k)->purpose, address(g, k)->step, address(g, k)->entity))

#define PERMUTATION ((const struct oracle_permutation *)g->row)
INTEGERS(permutation, entries, "purpose draw step size", PERMUTATION[k].address.purpose, PERMUTATION[k].address.draw,
         (int64_t)PERMUTATION[k].address.step, PERMUTATION[k].address.entity)
INTEGERS(permuted, permuted, "entry", PERMUTATION->order[k])

#define TEST ((const struct oracle_test *)g->row)[k]
POINT(test_from, tests, TEST.query.from)
POINT(test_to, tests, TEST.query.to)
POINT(test_pivot, tests, TEST.query.pivot)
POINT(test_a, tests, TEST.query.a)
POINT(test_b, tests, TEST.query.b)
INTEGERS(flip, tests, "flip", TEST.query.flip)
INTEGERS(crosses, tests, "crosses", TEST.crosses)
#define HIT(h) (h).time, (h).s, (h).s_standing, (h).normal.x, (h).normal.y, (h).normal.z
REALS(hit, tests, "time s s_standing normal_x normal_y normal_z", HIT(TEST.hit))
REALS(test_condition, tests, "condition", TEST.condition)

#define EXCHANGE ((const struct oracle_exchange *)g->row)[k]
#define FOUR(x) (x)[0], (x)[1], (x)[2], (x)[3]
VECTOR(exchange_moving, exchanges, EXCHANGE.velocity[0])
VECTOR(exchange_pivot, exchanges, EXCHANGE.velocity[1])
VECTOR(exchange_a, exchanges, EXCHANGE.velocity[2])
VECTOR(exchange_b, exchanges, EXCHANGE.velocity[3])
REALS(exchange_masses, exchanges, "moving pivot a b", FOUR(EXCHANGE.mass))
REALS(exchange_contact, exchanges, "s s_standing", EXCHANGE.s, EXCHANGE.s_standing)
VECTOR(exchange_normal, exchanges, EXCHANGE.normal)
REALS(exchange_momentum, exchanges, "momentum", EXCHANGE.momentum)
VECTOR(after_moving, exchanges, EXCHANGE.after[0])
VECTOR(after_pivot, exchanges, EXCHANGE.after[1])
VECTOR(after_a, exchanges, EXCHANGE.after[2])
VECTOR(after_b, exchanges, EXCHANGE.after[3])

#define SEARCH ((const struct oracle_search *)g->row)[k]
POINT(search_p, searches, SEARCH.pair.p)
POINT(search_q, searches, SEARCH.pair.q)
POINT(search_w, searches, SEARCH.pair.w)
POINT(search_p_rate, searches, SEARCH.pair.p_rate)
POINT(search_q_rate, searches, SEARCH.pair.q_rate)
POINT(search_w_rate, searches, SEARCH.pair.w_rate)
INTEGERS(search_from, searches, "tick", SEARCH.from)
INTEGERS(search_reach, searches, "reach", SEARCH.reach)
INTEGERS(search_tick, searches, "tick", SEARCH.tick)

#define TUBES_ROW ((const struct oracle_tubes *)g->row)[k]
POINT(tubes_p, contacts, TUBES_ROW.p)
POINT(tubes_q, contacts, TUBES_ROW.q)
POINT(tubes_w, contacts, TUBES_ROW.w)
REALS(tubes_contact, contacts, "s t", TUBES_ROW.s, TUBES_ROW.t)
VECTOR(tubes_normal, contacts, TUBES_ROW.normal)

#define IMPULSE ((const struct oracle_impulse *)g->row)[k]
VECTOR(impulse_p0, impulses, IMPULSE.velocity[0])
VECTOR(impulse_p1, impulses, IMPULSE.velocity[1])
VECTOR(impulse_q0, impulses, IMPULSE.velocity[2])
VECTOR(impulse_q1, impulses, IMPULSE.velocity[3])
VECTOR(impulse_force_p0, impulses, IMPULSE.force[0])
VECTOR(impulse_force_p1, impulses, IMPULSE.force[1])
VECTOR(impulse_force_q0, impulses, IMPULSE.force[2])
VECTOR(impulse_force_q1, impulses, IMPULSE.force[3])
REALS(impulse_masses, impulses, "p0 p1 q0 q1", FOUR(IMPULSE.mass))
REALS(impulse_contact, impulses, "s t", IMPULSE.s, IMPULSE.t)
VECTOR(impulse_normal, impulses, IMPULSE.normal)
REALS(impulse_tau, impulses, "tau", IMPULSE.tau)
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
