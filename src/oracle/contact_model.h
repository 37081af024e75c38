/*
 * Inside the oracle: a test for a crossing, and an exchange of momentum, made from docs/porting.md with one thing
 * changed. Guesses of single tests and exchanges, and of whole sweeps, are made of them.
 */
#ifndef UNCROSS_ORACLE_CONTACT_MODEL_H
#define UNCROSS_ORACLE_CONTACT_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"

enum zero_rule { ZERO_FLIPS, ZERO_POSITIVE, ZERO_NEGATIVE, ZERO_FLIPS_OTHERWISE, ZERO_FLIPS_EVERYWHERE, ZERO_MISSES };
enum contact_place { AT_TIME, AT_END, AT_START, AT_MIDDLE };
enum normal_rule { NORMAL_RIGHT, NORMAL_TURNED, NORMAL_PLAIN, NORMAL_UNSCALED, NORMAL_SQUARED, NORMAL_PLAIN_TURNED };
enum lever_rule {
  LEVERS,
  LEVERS_SWAPPED,
  LEVERS_HALF,
  LEVERS_STANDING_SWAPPED,
  LEVERS_MOVING_SWAPPED,
  LEVERS_OF_VERTEX
};
enum mass_rule { MASS_OVER, MASS_NONE, MASS_TIMES, MASS_OF_MOVER, MASS_SQUARED };

/* Zeros: as it should be. */
struct contact_twist {
  double factor; /* of dP, 0: 2 */
  double change; /* of velocities: times, less 1 */
  const char *text;
  enum zero_rule zero;
  enum contact_place place;
  enum normal_rule normal;
  enum lever_rule levers;
  enum mass_rule mass, mass_after; /* in dP, in the velocities */
  bool doubles, no_change, no_path, path_turned, no_sides, one_side, path_of_sides;
  bool time_from_end, s_from_pivot, standing_from_b, s_half, standing_half, unclamped;
  bool clipped, absolute, unsquared, approach_of_moving, compliance_of_moving, moving_only, standing_only;
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
