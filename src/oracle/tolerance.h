/* Inside the oracle: sizes of what a pack's tables hold, from which tolerances are made (docs/port/tolerances.md). */
#ifndef UNCROSS_ORACLE_TOLERANCE_H
#define UNCROSS_ORACLE_TOLERANCE_H

#include "oracle/pair.h"

/* What is known of one table of a pair (oracle_pair.known): nothing at first. */
enum { TOLERANCE_SIZES = 8 };
struct tolerance_known {
  const struct oracle_table *table; /* its row of schema.c; NULL: not yet looked for */
  double bound;                     /* of all its values, if they have one */
  size_t sizes;
  struct tolerance_size {
    double (*of)(const struct oracle_pair *);
    double is;
  } size[TOLERANCE_SIZES];
  double *of_vertex; /* [vertices] what a rule has made of the pair's events */
};
void tolerance_forget(struct tolerance_known *known);

/* of(pair), computed once where the pair has a place to keep it. */
double tolerance_once(const struct oracle_pair *pair, double (*of)(const struct oracle_pair *));

/* of(pair)[vertex], kept in the same way; 0 from `most` on, and where `of` finds none (NULL). A rule has one such `of`.
 */
double tolerance_of_vertex(const struct oracle_pair *pair, double *(*of)(const struct oracle_pair *), uint32_t vertex,
                           uint32_t most);

/* Columns of the model's in.vertex. */
enum vertex_column { MASS, BOND_LENGTH, SPRING, BENDING, FORCE };

/* The largest size in columns from .. to - 1; 0 for no table. */
double tolerance_largest(const struct pack_table *table, uint32_t from, uint32_t to);

/* The same of all of a table beside the pair's. */
double tolerance_size_of(const struct oracle_pair *pair, const char *name);

/* A table of the model; NULL if the pack has none of this name. */
const struct pack_table *tolerance_of_model(const struct oracle_pair *pair, const char *name);

/* Largest and smallest mass; the largest force on a vertex where vertices stand as `in.position` has them. */
double tolerance_heaviest(const struct oracle_pair *pair);
double tolerance_lightest(const struct oracle_pair *pair);
double tolerance_strongest(const struct oracle_pair *pair);

/* The largest component of the velocities that went in; that of the acceleration. */
double tolerance_velocities(const struct oracle_pair *pair);
double tolerance_acceleration(const struct oracle_pair *pair);

/* Ours is of doubles in any case, so in single precision only one side rounds to 24 bits, inputs included. */
static inline bool tolerance_single(const struct oracle_pair *p)
{
  return p->rounding > 0x1p-30;
}

/* Bounds of tables (schema.c): one for all values, or one for each. */
typedef double tolerance_of_all(const struct oracle_pair *pair);
typedef double tolerance_of_each(const struct oracle_pair *pair, uint32_t row, uint32_t column);
tolerance_of_all tolerance_account_given, tolerance_affine, tolerance_bend_force, tolerance_bond_force,
    tolerance_center, tolerance_copied_velocity, tolerance_crowd, tolerance_drawn_place, tolerance_force,
    tolerance_give, tolerance_kick, tolerance_mobility, tolerance_momentum, tolerance_motion, tolerance_move,
    tolerance_pair_along, tolerance_pair_bath, tolerance_private_bath, tolerance_relative, tolerance_repulsion,
    tolerance_repulsion_kick, tolerance_rotate, tolerance_slid, tolerance_spin_center, tolerance_stream_position,
    tolerance_stream_velocity, tolerance_swing_given, tolerance_swing_position, tolerance_swing_velocity,
    tolerance_uniform, tolerance_wall_given, tolerance_wall_position, tolerance_wall_velocity;
tolerance_of_each tolerance_axis, tolerance_boltzmann, tolerance_crossing_hit, tolerance_drawn, tolerance_event_hit,
    tolerance_event_position, tolerance_event_velocity, tolerance_exchange_momentum, tolerance_exchange_velocity,
    tolerance_filled, tolerance_filled_momentum, tolerance_give_spin, tolerance_impulse_answer,
    tolerance_impulse_momentum, tolerance_impulse_velocity, tolerance_normal_pair, tolerance_pair_draw,
    tolerance_rescale, tolerance_root, tolerance_spin_angular, tolerance_spin_beyond, tolerance_spin_middle,
    tolerance_spin_rate, tolerance_spin_second, tolerance_sweep_hit, tolerance_sweep_position, tolerance_sweep_velocity,
    tolerance_tube_normal, tolerance_tube_points, tolerance_tube_tick;

#endif
