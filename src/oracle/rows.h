/* Rows that stand for themselves, and need no state: what each is computed from, then what comes out (rows.c). */
#ifndef UNCROSS_ORACLE_ROWS_H
#define UNCROSS_ORACLE_ROWS_H

#include "base/random.h"
#include "contact/contact.h"
#include "contact/flight.h"
#include "contact/line.h"
#include "oracle/operators.h"

/* An address of random numbers. */
struct oracle_address {
  enum random_purpose purpose;
  uint32_t draw, entity;
  uint64_t step;
};

/* A permutation; entity: of so many. */
enum { ORACLE_PERMUTED = 4096 };
struct oracle_permutation {
  struct oracle_address address;
  uint32_t order[ORACLE_PERMUTED];
};

/* One test for a crossing. */
struct oracle_test {
  struct crossing_query query;
  bool crosses;
  struct crossing_hit hit; /* zeros if not */
  double condition;        /* how much its data amplify rounding (docs/port/tolerances.md) */
};

/* Two bonds between two frames (topology/pair.h), in lattice units. */
struct oracle_meeting {
  struct point p[2], q[2], w[2];
  int64_t class; /* 0 apart, 1 crossed, 2 touched, or what doubles cannot tell from it */
  int64_t sign[3];
};

/* An exchange of momentum; the four vertices are moving vertex, pivot, and the standing bond's first and second end. */
struct oracle_exchange {
  struct vec3 velocity[4]; /* a0/t0 */
  double mass[4];
  double s, s_standing;
  struct vec3 normal;
  struct vec3 after[4];
  double momentum;
};

/* A search for the first contact of two bonds, from a tick on. */
struct oracle_search {
  struct flight_pair pair;
  int64_t reach; /* distance of the axes at a contact, lattice units; 0: of thin lines */
  int32_t from;
  int32_t tick;
};

/* Two tubes at the tick of their contact, lattice units. A bead is one without length, q = 0. */
struct oracle_tubes {
  struct point p, q, w;
  double s, t;
  struct vec3 normal;
};

/* An impulse at its own time: the ends of the first bond, then of the other. */
struct oracle_impulse {
  struct vec3 velocity[4], force[4]; /* a0/t0, kT/a0 */
  double mass[4];
  double s, t;
  struct vec3 normal;
  double tau; /* from the middle between two kicks, t0 */
  struct vec3 after[4];
  int answer;
  double momentum;
};

/* A contact of a drift, as it was answered. */
struct oracle_event {
  struct contact_event event;
  int32_t tick;
  double condition;
};

/* An entry of the lower triangle of a fiber's diffusion tensor, of its root, and the condition of the root. */
struct oracle_entry {
  double tensor, root, condition;
};

/* Operators on the rows of a stage. */
bool oracle_run_permutations(struct oracle_stage *g);
bool oracle_run_tests(struct oracle_stage *g);
bool oracle_run_meetings(struct oracle_stage *g);
bool oracle_run_exchanges(struct oracle_stage *g);
bool oracle_run_searches(struct oracle_stage *g);
bool oracle_run_tubes(struct oracle_stage *g);
bool oracle_run_impulses(struct oracle_stage *g);

/* The condition of a hit: the moving vertex's way, the vectors of its bond before it and of the standing bond (a0), and
 * the time of the hit. */
double oracle_condition(struct vec3 way, struct vec3 bond, struct vec3 standing, double time);

/* True if a search is made for it: packs may come from anywhere. */
bool oracle_search_is_legal(const struct flight_pair *pair, double from);

#endif
