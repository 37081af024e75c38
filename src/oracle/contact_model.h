/*
 * Inside the oracle: a test for a crossing, and an exchange of momentum, made from docs/porting.md with one thing
 * changed. Guesses of single tests and exchanges, and of whole sweeps, are made of them.
 */
#ifndef UNCROSS_ORACLE_CONTACT_MODEL_H
#define UNCROSS_ORACLE_CONTACT_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"

/* What a determinant of exactly zero counts as. As it should be: condition 1 flips, 2 and 3 have it positive. */
enum zero_rule { ZERO_RIGHT, ZERO_POSITIVE, ZERO_NEGATIVE, ZERO_FLIPS, ZERO_FLIPS_OTHERWISE, ZERO_MISSES };
enum change_rule { CHANGE, CHANGE_ANY, CHANGE_NONE, CHANGE_UP, CHANGE_DOWN };
enum path_rule { PATH, PATH_ANY, PATH_TURNED, PATH_POSITIVE, PATH_NEGATIVE };
enum side_rule {
  SIDES,
  SIDES_ANY,
  SIDES_ALIKE,
  SIDE_A_POSITIVE,
  SIDE_A_NEGATIVE,
  SIDE_B_POSITIVE,
  SIDE_B_NEGATIVE,
  SIDE_A_OTHER,
  SIDE_A_SAME,
  SIDE_B_OTHER,
  SIDE_B_SAME
};
/* How a determinant's sign is found where doubles may err; and always, if it is unfiltered. */
enum exact_rule { EXACT, IN_DOUBLES, IN_SINGLES, DOUBT_IS_ZERO, MINORS_OF_64, ALL_OF_64, ALL_OF_128, WITHOUT_CARRY };
enum contact_place { AT_TIME, AT_END, AT_START, AT_MIDDLE };
enum normal_rule { NORMAL_RIGHT, NORMAL_TURNED, NORMAL_PLAIN, NORMAL_UNSCALED, NORMAL_SQUARED, NORMAL_PLAIN_TURNED };
enum lever_rule {
  LEVERS,
  LEVERS_SWAPPED,
  LEVERS_HALF,
  LEVERS_STANDING_SWAPPED,
  LEVERS_MOVING_SWAPPED,
  LEVERS_OF_VERTEX,
  LEVERS_BY_S,
  LEVERS_BY_S_STANDING,
  LEVERS_EXCHANGED,
  LEVERS_ALL_POSITIVE
};
enum mass_rule {
  MASS_OVER,
  MASS_NONE,
  MASS_TIMES,
  MASS_OF_MOVER,
  MASS_OF_PIVOT,
  MASS_OF_A,
  MASS_OF_B,
  MASS_OF_BOND,
  MASS_MEAN,
  MASS_SUM,
  MASS_SQUARED,
  MASS_ROOT
};
/* Sets of the four vertices. */
enum { END_MOVING = 1, END_PIVOT = 2, END_A = 4, END_B = 8, END_ALL = 15 };

/* Zeros: as it should be. */
struct contact_twist {
  double factor; /* of dP, 0: 2 */
  double change; /* of velocities: times, less 1 */
  const char *text;
  enum zero_rule zero[3]; /* of conditions 1, 2, 3 */
  enum change_rule change_of_sign;
  enum path_rule path;
  enum side_rule side;
  enum exact_rule exact;
  enum contact_place place;
  enum normal_rule normal;
  enum lever_rule levers;
  enum mass_rule mass, mass_after;             /* in dP, in the velocities */
  int s_term, standing_term, denominator_term; /* 1: sign of its first term, 2: of its second; 3, 4: left out */
  enum contact_place normal_place;
  bool bond_turned; /* b - a for a - b in the volumes */
  bool unfiltered, time_from_end, time_of_sum, s_from_pivot, standing_from_b, s_half, standing_half, unclamped;
  bool clipped, clipped_above, absolute, unsquared, unlevered, approach_without_normal;
  unsigned no_approach, no_compliance, no_change; /* sets of vertices left out */
};

struct contact_points {
  struct point from, to, pivot, a, b;
  bool flip;
};

struct contact_hit {
  double time, s, s_standing;
  struct vec3 normal;
};

bool contact_crosses(const struct contact_twist *t, const struct contact_points *r);
struct contact_hit contact_describe(const struct contact_twist *t, const struct contact_points *r);

/* Velocities and masses of moving vertex, pivot, a, b. Returns dP; changes the velocities. */
double contact_exchange(const struct contact_twist *t, const struct contact_hit *hit, const double mass[4],
                        struct vec3 v[4]);

/* Guesses that one test, or one exchange, can show; their texts. Each list ends with one without a text. */
extern const struct contact_twist contact_test_twists[], contact_exchange_twists[];

#endif
