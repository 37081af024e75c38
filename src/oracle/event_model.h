/*
 * Inside the oracle: searches, impulses and drifts of the rule `event-driven`, made from docs/porting.md with one thing
 * changed. Guesses of what a port does otherwise are made of them.
 */
#ifndef UNCROSS_ORACLE_EVENT_MODEL_H
#define UNCROSS_ORACLE_EVENT_MODEL_H

#include "oracle/event_rows.h"

/* Zeros: as it should be. */
enum search_rule {
  SEARCH_RIGHT,
  SEARCH_TICK_LATE,
  SEARCH_TICK_EARLY,
  SEARCH_VOLUME_ONLY,
  SEARCH_PLANE_ONLY,
  SEARCH_GAP_ONLY,
  SEARCH_DOUBLES,
  SEARCH_ENDS_ONLY,
  SEARCH_FROM_ZERO,
  SEARCH_NONE_IS_LAST,
  SEARCH_AT_REST
};
enum tau_rule { TAU_RIGHT, TAU_ZERO, TAU_OF_START, TAU_TURNED, TAU_OF_END, TAU_IN_TICKS };
enum force_rule { FORCE_RIGHT, FORCE_OF_START, FORCE_BONDS_ONLY, FORCE_BENDS_ONLY, FORCE_NOT_CONSTANT };
enum rebound_rule {
  REBOUND_RIGHT,
  REBOUND_NEVER_SOFT,
  REBOUND_SLOW_ONLY,
  REBOUND_FAST_ONLY,
  REBOUND_FULL_BEYOND,
  REBOUND_CLAMPED,
  REBOUND_SLOW_CLAMPED,
  REBOUND_HALF,
  REBOUND_TWICE,
  REBOUND_SOFT_ALWAYS
};
enum push_rule { PUSH_RIGHT, PUSH_UNTURNED, PUSH_GAP, PUSH_NO_GAP, PUSH_OF_START, PUSH_TURNED, PUSH_BY_APPROACH };
enum rate_rule { RATE_NEAREST, RATE_CUT, RATE_DOWN, RATE_STALE };
enum again_rule {
  AGAIN_RIGHT,
  AGAIN_TWO_BONDS,
  AGAIN_FIRST_BOND,
  AGAIN_NOT_THE_PAIR,
  AGAIN_NOTHING,
  AGAIN_FROM_START,
  AGAIN_TICK_LATER,
  AGAIN_OLD_STAY
};
enum turn_rule { TURN_RIGHT, TURN_BY_NUMBER, TURN_LARGER_FIRST, TURN_BY_IMAGE_FIRST };
enum image_rule { IMAGE_RIGHT, IMAGE_NONE, IMAGE_KEEPS_SIGN, IMAGE_REPORTED_TURNED, IMAGE_ONE_BOX };
enum lever_twist { LEVER_RIGHT, LEVER_SWAPPED_P, LEVER_SWAPPED_Q, LEVER_SWAPPED_BOTH, LEVER_HALF };
enum mass_twist {
  MASSES_RIGHT,
  MASSES_NONE,
  MASSES_OF_FIRST,
  MASSES_NOT_IN_PULL,
  MASSES_NOT_IN_CHANGE,
  MASSES_NOT_IN_SUM
};

struct event_twist {
  enum search_rule search;
  enum tau_rule tau;
  enum force_rule force;
  enum rebound_rule rebound;
  enum push_rule push;
  enum rate_rule rate;
  enum again_rule again;
  enum turn_rule turn;
  enum image_rule image;
  enum lever_twist lever;
  enum mass_twist mass;
  int no_force_of; /* 1 + the number of the end; 5: of the other bond; 6: of the first */
  bool unsquared, no_change, not_tied, touching_answered, no_clusters, mean_down, separating_too, first_bond_only;
  const char *text;
};

/* The tick that such a port answers. */
int32_t event_search(const struct event_twist *t, const struct flight_pair *pair, int32_t from);

/* Changes the velocities; returns the impulse, and the kind of answer. */
double event_impulse(const struct event_twist *t, struct oracle_impulse *e, enum contact_answer *answer);

/* Guesses of a search, of an impulse, of a drift alone; their texts. Each list ends with one without a text. */
extern const struct event_twist event_search_twists[], event_impulse_twists[], event_drift_twists[];

#endif
