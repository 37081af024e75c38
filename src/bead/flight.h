/* The flight of the bead among solvent particles. */
#ifndef UNCROSS_BEAD_FLIGHT_H
#define UNCROSS_BEAD_FLIGHT_H

#include "contact/flight.h"
#include "system/bead.h"
#include "wall/wall.h"

/* Two points that move: from one to the other, and by how much that grows in a tick; lattice units. */
struct approach {
  struct point apart, rate;
};

/* The last whole tick, 0 to most, at which the distance is not below the radius while the next one is below; exact.
 * If it is below already, 0 where they approach each other. -1 if there is no such tick. Components of `apart` are
 * below 2^51 and of `rate` below 2^40; the radius is below 2^50. */
int64_t bead_touch(const struct approach *approach, int64_t radius, int64_t most);

/* A particle that may meet the bead. */
struct bead_visit {
  uint32_t place;        /* in memory */
  bool at_wall;          /* its next hit is one of a wall */
  bool rigid;            /* it goes with the bead for the rest of the flight, at this place relative to it */
  uint32_t again;        /* hits at the tick of its last one, less 1 */
  int64_t clock, due;    /* ticks: where it was last turned; its next hit */
  struct point at, rate; /* from the bead's center at the start, lattice units, at that tick; the same per tick */
  struct vec3 velocity;  /* a0/t0 */
};

/* The bead on its way; `at` and clock as in struct bead_visit. */
struct bead_way {
  double time, mass; /* of the flight, t0; of the bead, m */
  int64_t radius, clock;
  struct point at, rate;
  struct vec3 velocity;
  bool held; /* it stands until the flight ends, whatever its velocity: contact/event_rigid.h */
};

/* The flight of a drift, hit by hit. It begins while the solvent still stands where the drift begins. */
struct bead_flight {
  struct bead_visit *at;
  uint32_t n, room;
  struct bead bead; /* after the flight */
  struct bead_way way;
  struct vec3 free;         /* the bead's velocity at the start, a0/t0 */
  double slack;             /* a0: how far it may be off its free flight before others may be met */
  struct bead_visit *first; /* of all, the next with a hit; NULL: the bead hits a wall before */
  bool walled;
  struct slit slit;
  int64_t height[WALLS];     /* of the walls above the bead's center at the start, lattice units */
  struct point given[WALLS]; /* by walls, beyond what they give in flights without a bead: units of the account */
  uint64_t turns[WALLS];     /* of `given`: 0, as a flight is short */
};

/* Who may meet the bead. False, with the fault recorded, if memory is short; so do answer, turn and alone. */
bool bead_flight_begin(const struct state *state, const struct model *model, struct bead_flight *all,
                       struct fault *fault);

/* The tick of the next hit; FLIGHT_TICKS if there is none. */
int64_t bead_flight_next(const struct state *state, struct bead_flight *all);

/* Answers this hit. */
bool bead_flight_answer(const struct state *state, const struct model *model, struct bead_flight *all,
                        struct fault *fault);

/* From this tick on the bead has another velocity. */
bool bead_flight_turn(const struct state *state, const struct model *model, struct bead_flight *all, int64_t tick,
                      struct vec3 velocity, struct fault *fault);

/* Where all are at the end: `at` is then the position of a particle in the box, `velocity` its velocity there. The
 * state is left as it is. */
void bead_flight_end(const struct state *state, const struct model *model, struct bead_flight *all);

/* All of this, where there are no bonds. */
bool bead_flight_alone(const struct state *state, const struct model *model, struct bead_flight *all,
                       struct fault *fault);

#endif
