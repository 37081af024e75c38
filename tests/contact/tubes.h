/*
 * Pairs of tubes in straight flight, made to be hard to judge, and the audit of the search for their contacts
 * (contact/tube.h). The reference shares nothing with it: distances of axes are the least of nine (line and line, end
 * and line, end and end) in long doubles, and a march in continuous time. Two axes approach by at most the fastest
 * corner of the parallelogram between them, so steps over wide gaps are safe; narrow gaps are sampled, and the least of
 * each dip is searched. It tells overlaps from 1e-15 a0 on; a lattice unit is 9e-13 a0.
 */
#ifndef UNCROSS_TESTS_TUBES_H
#define UNCROSS_TESTS_TUBES_H

#include <float.h>

#include "contact/tube.h"
#include "exact.h"

_Static_assert(LDBL_MANT_DIG >= 64, "the reference needs a long double of 64 bits");

/* --- the reference ------------------------------------------------------------------------------------------------ */

struct axis3 {
  long double x, y, z;
};

static inline struct axis3 axis_at(struct point at, struct point rate, long double tick)
{
  return (struct axis3){((long double)at.x + tick * (long double)rate.x) * 0x1p-40L,
                        ((long double)at.y + tick * (long double)rate.y) * 0x1p-40L,
                        ((long double)at.z + tick * (long double)rate.z) * 0x1p-40L};
}

static inline struct axis3 axis_sum(struct axis3 a, long double f, struct axis3 b)
{
  return (struct axis3){a.x + f * b.x, a.y + f * b.y, a.z + f * b.z};
}

static inline long double axis_dot(struct axis3 a, struct axis3 b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline long double within_one(long double s)
{
  return s > 0.0L ? (s < 1.0L ? s : 1.0L) : 0.0L;
}

/* Square of the distance of a point from the segment o + s v. */
static inline long double end_to_segment(struct axis3 point, struct axis3 o, struct axis3 v)
{
  const struct axis3 r = axis_sum(point, -1.0L, o);
  const long double vv = axis_dot(v, v), s = vv > 0.0L ? within_one(axis_dot(r, v) / vv) : 0.0L;
  const struct axis3 left = axis_sum(r, -s, v);
  return axis_dot(left, left);
}

/* Distance of the axes at a time in ticks, a0. */
static inline long double axes_distance(const struct flight_pair *pair, long double tick)
{
  const struct axis3 o = {0, 0, 0}, p = axis_at(pair->p, pair->p_rate, tick), q = axis_at(pair->q, pair->q_rate, tick),
                     w = axis_at(pair->w, pair->w_rate, tick);
  const long double ends[4] = {end_to_segment(o, w, q), end_to_segment(p, w, q), end_to_segment(w, o, p),
                               end_to_segment(axis_sum(w, 1.0L, q), o, p)};
  long double least = ends[0];
  for (int k = 1; k < 4; k++)
    least = ends[k] < least ? ends[k] : least;
  const long double pp = axis_dot(p, p), qq = axis_dot(q, q), pq = axis_dot(p, q), pw = axis_dot(p, w),
                    qw = axis_dot(q, w), det = pp * qq - pq * pq;
  if (det > 0.0L) {
    const long double s = (pw * qq - pq * qw) / det, t = (pq * pw - pp * qw) / det;
    if (s > 0.0L && s < 1.0L && t > 0.0L && t < 1.0L) {
      const struct axis3 gap = axis_sum(axis_sum(w, t, q), -s, p);
      const long double squared = axis_dot(gap, gap);
      least = squared < least ? squared : least;
    }
  }
  return sqrtl(least);
}

/* a0: the most by which the axes may approach each other in a tick. */
static inline long double fastest_corner(const struct flight_pair *pair)
{
  const struct point none = {0, 0, 0};
  const struct axis3 w = axis_at(pair->w_rate, none, 0.0L), p = axis_at(pair->p_rate, none, 0.0L),
                     q = axis_at(pair->q_rate, none, 0.0L);
  long double most = 0.0L;
  for (int k = 0; k < 4; k++) {
    const struct axis3 c = axis_sum(axis_sum(w, (k & 1) ? 1.0L : 0.0L, q), (k & 2) ? -1.0L : 0.0L, p);
    const long double size = axis_dot(c, c);
    most = size > most ? size : most;
  }
  return sqrtl(most);
}

enum { LEAST_STEPS = 256, NARROWINGS = 48 };

/* The least of distance - reach (a0) near a time that is as near or nearer than those `step` before and after. */
static inline long double least_gap_around(const struct flight_pair *pair, long double reach, long double from,
                                           long double to)
{
  long double least = LDBL_MAX;
  for (int k = 0; k < NARROWINGS; k++) {
    const long double a = from + 0.382L * (to - from), b = to - 0.382L * (to - from),
                      at_a = axes_distance(pair, a) - reach, at_b = axes_distance(pair, b) - reach;
    *(at_a < at_b ? &to : &from) = at_a < at_b ? b : a;
    least = fminl(least, fminl(at_a, at_b));
  }
  return least;
}

/* The least of distance - reach (a0) between two times, in ticks. Ends early where it is below `enough`. Where the gap
 * is wide, a step is as long as the gap allows. Where it is narrow, a step is a part of the interval, and the least
 * between two steps is searched where it is less than on both sides. */
static inline long double least_gap(const struct flight_pair *pair, long double reach, long double from, long double to,
                                    long double enough)
{
  const long double speed = fastest_corner(pair), fine = speed * (to - from) / LEAST_STEPS;
  long double before = from, last = from, gap_before = LDBL_MAX, gap_last = axes_distance(pair, from) - reach,
              least = gap_last;
  while (last < to && least >= enough) {
    const long double step = speed > 0.0L ? (gap_last > fine ? gap_last : fine) / speed : to - last,
                      now = last + step < to ? last + step : to, gap = axes_distance(pair, now) - reach;
    if (gap_last <= gap_before && gap_last <= gap)
      least = fminl(least, least_gap_around(pair, reach, before, now));
    least = fminl(least, gap);
    before = last, gap_before = gap_last, last = now, gap_last = gap;
  }
  return gap_last <= gap_before && least >= enough ? fminl(least, least_gap_around(pair, reach, before, to)) : least;
}

/* --- pairs -------------------------------------------------------------------------------------------------------- */

struct tube_query {
  struct flight_pair pair;
  int64_t reach;
  int32_t from;
};

enum tube_kind {
  TUBE_ANY,       /* side to side, end to side, end to end, as it comes */
  TUBE_SIDES,     /* side to side */
  TUBE_END_SIDE,  /* end to side */
  TUBE_END_END,   /* end to end */
  TUBE_PARALLEL,  /* parallel at all times */
  TUBE_NEARLY,    /* at a tiny angle when they meet */
  TUBE_COLLINEAR, /* along one line, end on end */
  TUBE_GRAZING,   /* they do not approach when they meet: two roots, one, or none */
  TUBE_ROLLING,   /* the same, while they turn about the line between them and slide */
  TUBE_DEEP,      /* so fast that they pass each other in a few ticks, or end deep inside */
  TUBE_SLOW,      /* a few lattice units in a tick */
  TUBE_RESTING,   /* a few lattice units from contact at the start, with any motion */
  TUBE_SHORT,     /* bonds shorter than the tube is thick */
  TUBE_FAR,       /* long bonds, thin tubes */
  TUBE_AT_REST,   /* one or both do not move */
  TUBE_KINDS
};

static const char *const tube_kinds[] = {"any",    "sides",     "end on side", "end on end", "parallel",
                                         "nearly", "collinear", "grazing",     "rolling",    "deep",
                                         "slow",   "resting",   "short",       "far",        "at rest"};

static inline struct vec3 any_unit(struct dice *d)
{
  for (;;) {
    const struct vec3 v = {dice_between(d, -1, 1), dice_between(d, -1, 1), dice_between(d, -1, 1)};
    const double size = vec3_norm(v);
    if (size > 0.1 && size < 1.0)
      return vec3_scale(1.0 / size, v);
  }
}

static inline struct vec3 unit_across(struct dice *d, struct vec3 u)
{
  for (;;) {
    const struct vec3 v = vec3_cross(u, any_unit(d));
    const double size = vec3_norm(v);
    if (size > 0.1)
      return vec3_scale(1.0 / size, v);
  }
}

static inline double dice_log(struct dice *d, double low, double high)
{
  return low * exp(dice_uniform(d) * log(high / low));
}

static inline struct point lattice_of(struct vec3 r)
{
  return (struct point){llrint(r.x * 0x1p40), llrint(r.y * 0x1p40), llrint(r.z * 0x1p40)};
}

static inline struct point minus_ticks(struct point at, struct point rate, int64_t ticks)
{
  return (struct point){at.x - ticks * rate.x, at.y - ticks * rate.y, at.z - ticks * rate.z};
}

/* Axes that are a reach and `gap` apart at this tick: directions, places and motions by kind. */
static inline struct tube_query draw_tubes(struct dice *d, enum tube_kind kind)
{
  struct tube_query query = {.from = 0};
  const double thick = kind == TUBE_FAR ? dice_log(d, 1e-4, 1e-2) : dice_log(d, 1e-4, 1.0);
  double length = kind == TUBE_FAR ? dice_log(d, 1.0, 100.0) : dice_log(d, 0.05, 2.0), other = dice_log(d, 0.05, 2.0);
  if (kind == TUBE_SHORT)
    length = thick * dice_uniform(d), other = thick * dice_uniform(d);
  double motion = kind == TUBE_DEEP ? dice_log(d, 0.1, 2.0) * (1.0 + 30.0 * thick) : dice_log(d, 1e-5, 0.3);
  if (kind == TUBE_SLOW)
    motion = 0x1p-24 * dice_integer(d, 0, 3);
  const int32_t tick = (int32_t)dice_integer(d, 0, FLIGHT_TICKS);
  const struct vec3 n = any_unit(d);
  const bool end_one = kind == TUBE_END_END || kind == TUBE_COLLINEAR || (kind == TUBE_END_SIDE && dice_u64(d) % 2),
             end_other = kind == TUBE_END_END || kind == TUBE_COLLINEAR || (kind == TUBE_END_SIDE && !end_one);
  double s = dice_uniform(d), t = dice_uniform(d);
  struct vec3 p = unit_across(d, n), q = unit_across(d, n);
  if (end_one)
    s = (double)(dice_u64(d) % 2), p = vec3_add_scaled(p, (s == 0.0 ? -1 : 1) * -dice_uniform(d), n);
  if (end_other)
    t = (double)(dice_u64(d) % 2), q = vec3_add_scaled(q, (t == 0.0 ? 1 : -1) * dice_uniform(d), n);
  if (kind == TUBE_ANY)
    p = any_unit(d), q = any_unit(d);
  if (kind == TUBE_COLLINEAR)
    p = vec3_scale(s == 0.0 ? -1.0 : 1.0, n), q = vec3_scale(t == 0.0 ? 1.0 : -1.0, n);
  if (kind == TUBE_PARALLEL)
    q = vec3_scale(dice_u64(d) % 2 ? 1.0 : -1.0, p);
  if (kind == TUBE_NEARLY)
    q = vec3_add_scaled(p, dice_log(d, 1e-12, 1e-2), q);
  p = vec3_scale(length / vec3_norm(p), p), q = vec3_scale(other / vec3_norm(q), q);

  struct vec3 vp = vec3_scale(motion * dice_uniform(d), any_unit(d)), vq = vec3_scale(motion, any_unit(d)),
              vw = vec3_scale(motion, any_unit(d));
  if (kind == TUBE_PARALLEL)
    vp = vec3_scale(motion * dice_between(d, -1, 1), p), vq = vec3_scale(dice_between(d, -1, 1), vp);
  if (kind == TUBE_COLLINEAR && dice_u64(d) % 2)
    vp = vq = (struct vec3){0, 0, 0}, vw = vec3_scale(dice_between(d, -motion, motion), n);
  if (kind == TUBE_AT_REST) {
    vp = vq = (struct vec3){0, 0, 0};
    if (dice_u64(d) % 2)
      vw = vp;
  }
  if (kind == TUBE_GRAZING || kind == TUBE_ROLLING) { /* no approach of the points that meet */
    if (kind == TUBE_ROLLING)
      vp = vec3_scale(motion, unit_across(d, n)), vq = vec3_scale(motion, unit_across(d, n));
    const struct vec3 v = vec3_add_scaled(vec3_add_scaled(vw, t, vq), -s, vp);
    vw = vec3_add_scaled(vw, -vec3_dot(v, n), n);
  }
  struct flight_pair *pair = &query.pair;
  pair->p_rate = lattice_of(vec3_scale(0x1p-16, vp)), pair->q_rate = lattice_of(vec3_scale(0x1p-16, vq));
  pair->w_rate = lattice_of(vec3_scale(0x1p-16, vw));
  if (kind == TUBE_SLOW) {
    struct point *all[] = {&pair->p_rate, &pair->q_rate, &pair->w_rate};
    for (int k = 0; k < 3; k++)
      *all[k] = (struct point){dice_integer(d, -2, 2), dice_integer(d, -2, 2), dice_integer(d, -2, 2)};
  }
  query.reach = 2 * llrint(0.5 * thick * 0x1p40);
  const double units = (double[]){0.0, 4.0, 1e3, 0x1p24 * motion, 0x1p36 * motion}[dice_u64(d) % 5];
  const double gap = thick + 0x1p-40 * units * dice_between(d, -1, 1);
  const struct vec3 w = vec3_add_scaled(vec3_add_scaled(vec3_scale(s, p), -t, q), gap, n);
  const int64_t when = kind == TUBE_RESTING || kind == TUBE_AT_REST ? 0 : tick;
  pair->p = minus_ticks(lattice_of(p), pair->p_rate, when);
  pair->q = minus_ticks(lattice_of(q), pair->q_rate, when);
  pair->w = minus_ticks(lattice_of(w), pair->w_rate, when);
  if (dice_u64(d) % 4 == 0)
    query.from = (int32_t)dice_integer(d, 0, tick < FLIGHT_TICKS ? tick : FLIGHT_TICKS - 1);
  return query;
}

/* --- the audit ---------------------------------------------------------------------------------------------------- */

typedef int32_t tube_search(const struct flight_pair *pair, int64_t reach, int32_t from);

struct tube_tally {
  uint64_t queries, answers, missed, invented;
  double overlap, early; /* a0: the deepest overlap before an answer; the widest gap at one, beyond a tick's motion */
};

/* By how much the axes may stay apart, beyond the reach, in a tick that is answered: contact/tube.h, and its rounding.
 */
static inline double tube_doubt(const struct tube_query *k)
{
  const double reach = (double)k->reach * 0x1p-40, motion = (double)fastest_corner(&k->pair);
  const struct axis3 p = axis_at(k->pair.p, k->pair.p_rate, k->from), q = axis_at(k->pair.q, k->pair.q_rate, k->from);
  const double size = (double)(sqrtl(axis_dot(p, p)) + sqrtl(axis_dot(q, q))) + reach + 65536.0 * motion;
  return 2.0 * motion * motion / reach + 0x1p-46 * size * (1.0 + size / reach);
}

static inline void audit_tubes(const struct tube_query *k, tube_search *search, struct tube_tally *t)
{
  const long double reach = (long double)k->reach * 0x1p-40L, rounding = 0x1p-50L * (1.0L + reach);
  if (axes_distance(&k->pair, k->from) - reach < 0x1p-44L) /* they overlap, or nearly: no question */
    return;
  const int32_t tick = search(&k->pair, k->reach, k->from);
  t->queries++;
  const double left = (double)least_gap(&k->pair, reach, k->from, tick, -rounding);
  t->missed += left < -(double)rounding;
  t->overlap = fmax(t->overlap, -left);
  if (tick == FLIGHT_TICKS)
    return;
  t->answers++;
  const double doubt = tube_doubt(k);
  const double apart = (double)least_gap(&k->pair, reach, tick, (long double)tick + 1.0L, 0.0L);
  t->invented += apart > doubt;
  t->early = fmax(t->early, apart / doubt);
}

static inline struct tube_tally audit_tube_kind(struct dice *d, enum tube_kind kind, uint64_t queries,
                                                tube_search *search)
{
  struct tube_tally t = {0};
  while (t.queries < queries) {
    const struct tube_query k = draw_tubes(d, kind);
    audit_tubes(&k, search, &t);
  }
  return t;
}

static inline void tell_tubes(const char *name, const struct tube_tally *t)
{
  print_message("  %-12s %9lu queries %9lu answers %3lu missed %3lu invented  overlap %8.1e a0  early %.3f\n", name,
                (unsigned long)t->queries, (unsigned long)t->answers, (unsigned long)t->missed,
                (unsigned long)t->invented, t->overlap, t->early);
}

/* So many queries of each kind. */
static inline struct tube_tally audit_all_tubes(uint64_t seed, uint64_t queries)
{
  struct dice d = {seed};
  struct tube_tally sum = {0};
  for (int kind = 0; kind < TUBE_KINDS; kind++) {
    const struct tube_tally t = audit_tube_kind(&d, (enum tube_kind)kind, queries, tube_contact);
    tell_tubes(tube_kinds[kind], &t);
    sum.queries += t.queries, sum.answers += t.answers, sum.missed += t.missed, sum.invented += t.invented;
    sum.overlap = fmax(sum.overlap, t.overlap), sum.early = fmax(sum.early, t.early);
  }
  tell_tubes("all", &sum);
  return sum;
}

#endif
