/*
 * Inside the oracle: a sweep made from the inputs of a pack with one thing changed, move by move (replay.h).
 */
#ifndef UNCROSS_ORACLE_SWEEPER_H
#define UNCROSS_ORACLE_SWEEPER_H

#include "oracle/contact_model.h"
#include "oracle/pair.h"
#include "oracle/patterns.h"

#define MOST_HITS 64
#define FAR 64 /* images */

enum order_rule { ORDER_GIVEN, ORDER_NUMBERS, ORDER_BACKWARDS, ORDER_INVERSE };
enum trial_rule { TRIAL_NEAREST, TRIAL_CUT, TRIAL_DOWN, TRIAL_UP, TRIAL_SINGLE };
enum exclusion_rule {
  EXCLUSION_RIGHT,
  EXCLUSION_ALWAYS_PAPER,
  EXCLUSION_NEVER_PAPER,
  EXCLUSION_NONE,
  EXCLUSION_FIBER,
  EXCLUSION_MOVER
};
enum partner_rule {
  PARTNERS_ALL,
  PARTNERS_LARGER,
  PARTNERS_SMALLER,
  PARTNERS_NO_LAST,
  PARTNERS_NO_FIRST,
  PARTNERS_NO_CLOSING,
  PARTNERS_VERTEX_LARGER,
  PARTNERS_VERTEX_SMALLER
};
enum bond_rule { BONDS_BOTH, BONDS_NEXT, BONDS_BEFORE };
enum choice_rule {
  CHOICE_FIRST,
  CHOICE_LAST,
  CHOICE_NEAREST,
  CHOICE_FARTHEST,
  CHOICE_NUMBER,
  CHOICE_TIE_LARGER,
  CHOICE_TIE_STANDING,
  CHOICE_TIE_IMAGE,
  CHOICE_END,
  CHOICE_ALL,
  CHOICE_NONE
};
enum pivot_rule { PIVOT_RIGHT, PIVOT_NEXT, PIVOT_BEFORE };

/* Zeros: as it should be. */
struct sweep_twist {
  enum order_rule order;
  enum trial_rule trial;
  double time; /* times, less 1 */
  bool rejected_moves, to_contact, stale_velocities, stale_positions;
  bool moves_after, stops, turns_back, last_stays, first_stays, unmarked, short_images, skips_first;
  enum pivot_rule pivot;
  int images; /* 1: none; 2: one box around; else any */
  bool above_only, below_only, one_axis, negated, report_negated;
  int no_axis, near_axis, edge_of; /* 1 + axis; near: one box away at most */
  enum exclusion_rule exclusion;
  enum partner_rule partners;
  enum bond_rule bonds;
  enum choice_rule choice;
  struct contact_twist contact;
  const char *text;
};

struct swept_hit {
  uint32_t moving, standing, four[4];
  int64_t image[3];
  struct contact_hit hit;
  struct contact_points points;
  bool executed;
  double impulse;
};

struct sweeper {
  const struct oracle_pair *pair;
  const struct sweep_twist *t;
  const struct pack_table *order, *from, *start, *chain, *vertex, *event, *hit, *to, *end;
  struct box box;
  double time;
  bool forbidden, paper;
  uint32_t n;
  struct point *r;
  struct vec3 *v;
  uint32_t cursor; /* of their events */
  double tolerance;
};

/* The tables of the pair's sweep; false if one is missing, or is not of its shape. */
bool sweeper_take(const struct oracle_pair *p, struct sweeper *s);

/* Positions and velocities as they go in. False if memory is short; sweeper_finish in any case. */
bool sweeper_begin(struct sweeper *s);
void sweeper_finish(struct sweeper *s);

/* The next vertex of the fiber, and the one before; -1: none. */
int64_t sweeper_next(const struct sweeper *s, int64_t k);
double sweeper_mass(const struct sweeper *s, uint32_t k);

/* True if two bonds share a vertex. */
bool sweeper_shares(const struct sweeper *s, int64_t bond, int64_t other);

/* A point of a standing bond in an image. */
struct point sweeper_moved(const struct sweeper *s, struct point p, const int64_t image[3]);

/* All hits of a move, the first one first. Returns how many. */
uint32_t sweeper_hits(const struct sweeper *s, uint32_t vertex, struct point end, struct swept_hit *hits);

/* Where a vertex would go. False if that is further than anything that a port would move. */
bool sweeper_trial(const struct sweeper *s, uint32_t vertex, struct point *end);

/* Executes a hit. */
void sweeper_exchange(struct sweeper *s, struct swept_hit *h);

/* True if theirs is this guess, within s->tolerance. */
bool sweeper_is_near(const struct sweeper *s, double theirs, double guess);

/* True if their row of events is this hit. */
bool sweeper_is_row(const struct sweeper *s, uint32_t row, uint32_t vertex, const struct swept_hit *h);

/* Their rows of events of this vertex, from s->cursor on. */
uint32_t sweeper_rows(const struct sweeper *s, uint32_t vertex);

/* The vertex that moves at this turn. */
uint32_t sweeper_vertex(const struct sweeper *s, uint32_t turn);

static inline int64_t sweeper_coordinate(struct point p, int axis)
{
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

#endif
