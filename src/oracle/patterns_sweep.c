/* What went wrong in a sweep that no replay makes. A wrong exchange changes the moves that follow, so only the first
 * row that differs is judged. */
#include <math.h>
#include <string.h>

#include "oracle/patterns.h"
#include "oracle/swept.h"

/* --- hits that they have not ------------------------------------------------------------------------------------- */

static double boxes_away(const struct pack_table *t, uint32_t row)
{
  return fmax(fabs(pack_value(t, row, IMAGE_X)),
              fmax(fabs(pack_value(t, row, IMAGE_Y)), fabs(pack_value(t, row, IMAGE_Z))));
}

/* An image is missed, and nowhere do they find any as far away. */
static bool image_missing(const struct oracle_pair *p)
{
  struct swept w;
  uint32_t row;
  if (!oracle_swept_take(p, &w) || !swept_missed(&w, &row) || boxes_away(w.event.ours, row) == 0.0)
    return false;
  for (uint32_t k = 0; k < w.event.theirs->rows; k++)
    if (boxes_away(w.event.theirs, k) >= boxes_away(w.event.ours, row))
      return false;
  return true;
}

/* --- the same hits, another choice ------------------------------------------------------------------------------- */

/* Our rows of the move in which they choose another of the same hits: first, the one they execute, last, nearest. */
struct choice {
  uint32_t first, theirs, last, nearest, executed; /* executed: how many of theirs */
};

static bool choose(const struct oracle_pair *p, struct swept *w, struct choice *c)
{
  uint32_t row;
  if (!oracle_swept_take(p, w) || swept_missed(w, &row) || swept_invented(w, &row))
    return false;
  const double mover = swept_first_mover(w);
  *c = (struct choice){UINT32_MAX, UINT32_MAX, 0, UINT32_MAX, 0};
  for (uint32_t k = 0; k < w->event.ours->rows; k++) {
    if (pack_value(w->event.ours, k, VERTEX) != mover)
      continue;
    c->first = c->first == UINT32_MAX ? k : c->first;
    c->last = k;
    if (c->nearest == UINT32_MAX || pack_value(w->hit.ours, k, S) < pack_value(w->hit.ours, c->nearest, S))
      c->nearest = k;
    for (uint32_t j = 0; j < w->event.theirs->rows; j++)
      if (swept_same_event(w->event.ours, k, w->event.theirs, j) && pack_value(w->event.theirs, j, EXECUTED) != 0.0)
        c->theirs = k, c->executed++;
  }
  return c->first != UINT32_MAX;
}

static bool several_executed(const struct oracle_pair *p)
{
  struct swept w;
  struct choice c;
  return choose(p, &w, &c) && c.executed > 1;
}

static bool none_executed(const struct oracle_pair *p)
{
  struct swept w;
  struct choice c;
  return choose(p, &w, &c) && c.executed == 0;
}

static bool tie_executed(const struct oracle_pair *p)
{
  struct swept w;
  struct choice c;
  return choose(p, &w, &c) && c.executed == 1 && c.theirs != c.first &&
         pack_value(w.hit.ours, c.theirs, TIME) == pack_value(w.hit.ours, c.first, TIME);
}

static bool last_executed(const struct oracle_pair *p)
{
  struct swept w;
  struct choice c;
  return choose(p, &w, &c) && c.executed == 1 && c.theirs != c.first && c.theirs == c.last && c.theirs != c.nearest;
}

static bool nearest_executed(const struct oracle_pair *p)
{
  struct swept w;
  struct choice c;
  return choose(p, &w, &c) && c.executed == 1 && c.theirs != c.first && c.theirs == c.nearest && c.theirs != c.last;
}

static bool other_executed(const struct oracle_pair *p)
{
  struct swept w;
  struct choice c;
  return choose(p, &w, &c) && c.executed == 1 && c.theirs != c.first;
}

/* --- moves ------------------------------------------------------------------------------------------------------- */

/* The vertex of the first hit, which both have, stands at its trial point. Nobody has changed its velocity before. */
static bool rejected_moves(const struct oracle_pair *p)
{
  struct swept w;
  uint32_t four[4];
  const struct pack_table *theirs = oracle_sibling_of_theirs(p, "out.position"), *time = oracle_sibling(p, "in.time");
  if (!oracle_swept_take(p, &w) || !theirs || !time || swept_first_other(&w) == 0 ||
      !swept_vertices(&w, w.event.ours, 0, four))
    return false;
  const struct point from = oracle_point(w.from, four[0]);
  const struct vec3 move = vec3_scale(pack_value(time, 0, 0), oracle_vector(w.start, four[0]));
  const double at[3] = {(double)from.x, (double)from.y, (double)from.z};
  for (uint32_t k = 0; k < 3; k++) {
    const double part = oracle_component(move, k) * LATTICE_PER_A0;
    if (fabs(pack_value(theirs, four[0], k) - (at[k] + part)) > 1.0 + 0x1p-20 * fabs(part))
      return false;
  }
  return vec3_norm(move) > 0.0;
}

/* Hits are found, but at the end all velocities are what they were. */
static bool no_exchange(const struct oracle_pair *p)
{
  struct swept w;
  const struct pack_table *out = oracle_sibling_of_theirs(p, "out.velocity");
  if (!oracle_swept_take(p, &w) || swept_first_other(&w) == 0 || !out || out->rows != w.start->rows)
    return false;
  for (uint32_t row = 0; row < out->rows; row++)
    for (uint32_t k = 0; k < 3; k++)
      if (pack_value(w.start, row, k) != pack_value(out, row, k))
        return false;
  return true;
}

/* --- hits: the first row that differs ---------------------------------------------------------------------------- */

static bool row_agrees(const struct oracle_pair *p, uint32_t row, uint32_t from, uint32_t to)
{
  for (uint32_t k = from; k < to; k++)
    if (!oracle_agrees(p, row, k))
      return false;
  return true;
}

static bool take_hit(const struct oracle_pair *p, struct swept *w, uint32_t *row)
{
  if (!oracle_swept_take(p, w))
    return false;
  for (*row = 0; *row < oracle_common_rows(&w->hit); ++*row)
    if (!row_agrees(&w->hit, *row, TIME, HIT_COLUMNS))
      return true;
  return false;
}

static bool lever_mirrored(const struct oracle_pair *p)
{
  struct swept w;
  uint32_t row;
  if (!take_hit(p, &w, &row) || row_agrees(&w.hit, row, S, NORMAL_X) || !row_agrees(&w.hit, row, TIME, S))
    return false;
  for (uint32_t k = S; k <= S_STANDING; k++)
    if (!oracle_agrees(&w.hit, row, k) && !oracle_guessed(&w.hit, row, k, 1.0 - pack_value(w.hit.ours, row, k)))
      return false;
  return true;
}

static bool normal_turned(const struct oracle_pair *p)
{
  struct swept w;
  uint32_t row;
  if (!take_hit(p, &w, &row) || !row_agrees(&w.hit, row, TIME, NORMAL_X))
    return false;
  for (uint32_t k = NORMAL_X; k <= NORMAL_Z; k++)
    if (!oracle_guessed(&w.hit, row, k, -pack_value(w.hit.ours, row, k)))
      return false;
  return true;
}

/* True if all of the row is right but dP, and that is this guess. */
static bool momentum_is(const struct oracle_pair *p, double (*guess)(const struct swept *, uint32_t row))
{
  struct swept w;
  uint32_t row;
  return take_hit(p, &w, &row) && row_agrees(&w.hit, row, TIME, MOMENTUM) &&
         oracle_guessed(&w.hit, row, MOMENTUM, guess(&w, row));
}

static double clipped(const struct swept *w, uint32_t row)
{
  return fmax(pack_value(w->hit.ours, row, MOMENTUM), 0.0);
}

static double halved(const struct swept *w, uint32_t row)
{
  return 0.5 * pack_value(w->hit.ours, row, MOMENTUM);
}

/* Our dP with the lever rule swapped, or with the mass of the moving vertex for all four. */
static double exchanged(const struct swept *w, uint32_t row, bool swapped, bool one_mass)
{
  uint32_t four[4];
  double lever[4], approach = 0.0, compliance = 0.0;
  if (!swept_vertices(w, w->event.ours, row, four))
    return NAN;
  swept_levers(w, row, swapped, lever);
  for (int k = 0; k < 4; k++) {
    approach += lever[k] * vec3_dot(swept_velocity(w, four[k], row, -1.0), swept_normal(w, row));
    compliance += lever[k] * lever[k] / swept_mass(w, four[one_mass ? 0 : k]);
  }
  return 2.0 * approach / compliance;
}

static double lever_exchanged(const struct swept *w, uint32_t row)
{
  return exchanged(w, row, true, false);
}

static double one_mass(const struct swept *w, uint32_t row)
{
  return exchanged(w, row, false, true);
}

static bool momentum_clipped(const struct oracle_pair *p)
{
  return momentum_is(p, clipped);
}

static bool momentum_halved(const struct oracle_pair *p)
{
  return momentum_is(p, halved);
}

static bool lever_swapped(const struct oracle_pair *p)
{
  return momentum_is(p, lever_exchanged);
}

static bool masses_alike(const struct oracle_pair *p)
{
  return momentum_is(p, one_mass);
}

/* Before the first event that differs; what follows may be anything. */
static bool hits_single(const struct oracle_pair *p)
{
  struct swept w;
  return oracle_swept_take(p, &w) && oracle_is_single(&w.hit, swept_first_other(&w));
}

const struct oracle_pattern oracle_patterns_sweep[] = {
    {"sweep", NULL, "no exchange of momentum", .fits = no_exchange},
    {"sweep", NULL, "a rejected vertex moves all the same: it stays where a bond would be crossed",
     .fits = rejected_moves},
    {"sweep", "out.event", "more than the first hit of a move executed", .fits = several_executed},
    {"sweep", "out.event", "no hit of a move executed", .fits = none_executed},
    {"sweep", "out.event", "ties: hits at the same time go by moving bond, standing bond, image", .fits = tie_executed},
    {"sweep", "out.event", "the last hit in time executed instead of first", .fits = last_executed},
    {"sweep", "out.event", "the hit closest to the moving vertex executed instead of first", .fits = nearest_executed},
    {"sweep", "out.event", "another hit executed instead of first in time (last, or closest?)", .fits = other_executed},
    {"sweep", "out.event", "missing image: a partner across the face of the box is not found", .fits = image_missing},
    {"sweep", "out.hit", "dP clipped at 0: it is used with its sign (footnote 61)", .fits = momentum_clipped},
    {"sweep", "out.hit", "lever rule: s counts from the moving vertex, s' from the bond's first",
     .fits = lever_mirrored},
    {"sweep", "out.hit", "lever rule swapped: 1 - s goes to the moving vertex, 1 - s' to bond's first",
     .fits = lever_swapped},
    {"sweep", "out.hit", "normal turned round: it points the way the vertex moves", .fits = normal_turned},
    {"sweep", "out.hit", "dP without its factor 2", .fits = momentum_halved},
    {"sweep", "out.hit", "dP with the mass of one vertex for all four", .fits = masses_alike},
    {"sweep", "out.hit", "single precision somewhere: right to 5 to 8 digits (--single has its tolerances)",
     .fits = hits_single},
    {.meaning = NULL},
};
