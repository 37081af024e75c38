/* Searches and contacts of thick fibers, made with one thing changed. */
#include <math.h>
#include <string.h>

#include "contact/capsule.h"
#include "contact/shape.h"
#include "contact/tube.h"
#include "oracle/relations.h"
#include "oracle/tube_rows.h"

/* --- searches ----------------------------------------------------------------------------------------------------- */

enum search_twist {
  TICK_LATE,
  TICK_EARLY,
  REACH_HALF,
  REACH_TWICE,
  AS_LINES,
  FROM_ZERO,
  NONE_IS_LAST,
  AT_REST_TOO,
  LEAVES,
  SIDES_ONLY,
  ENDS_ONLY,
  SEARCH_TWISTS
};

static const char *const search_texts[SEARCH_TWISTS] = {
    [TICK_LATE] = "a contact of tubes is answered a tick late: the last tick at which they are apart counts",
    [TICK_EARLY] = "a contact of tubes is answered a tick early",
    [REACH_HALF] = "half of the reach: tubes touch at the sum of their radii",
    [REACH_TWICE] = "twice the reach: tubes touch at the sum of their radii, not of their diameters",
    [AS_LINES] = "tubes searched as thin lines",
    [FROM_ZERO] = "the search begins at tick 0, not at `from`",
    [NONE_IS_LAST] = "65535 for 65536 where there is no contact",
    [AT_REST_TOO] = "tubes at rest are searched: they have no contact",
    [LEAVES] = "the last tick in which the tubes touch: the first one counts",
    [SIDES_ONLY] = "sides of tubes only: their ends are half spheres",
    [ENDS_ONLY] = "tubes apart at both ends of the interval only: they may meet within, the middle product counts"};

static int32_t last_tick(const struct oracle_search *s)
{
  for (int32_t tick = FLIGHT_TICKS - 1; tick >= s->from; tick--)
    if (!tube_excluded(&s->pair, s->reach, tick, tick + 1))
      return tick;
  return FLIGHT_TICKS;
}

/* The first tick in which the axes' nearest points are within the bonds and the tubes may touch. */
static int32_t first_side(const struct oracle_search *s)
{
  for (int32_t tick = tube_contact(&s->pair, s->reach, s->from); tick < FLIGHT_TICKS; tick++) {
    double a, b;
    capsule_closest(point_in_a0(flight_place(s->pair.p, s->pair.p_rate, tick)),
                    point_in_a0(flight_place(s->pair.q, s->pair.q_rate, tick)),
                    point_in_a0(flight_place(s->pair.w, s->pair.w_rate, tick)), &a, &b);
    if (a > 0.0 && a < 1.0 && b > 0.0 && b < 1.0 && !tube_excluded(&s->pair, s->reach, tick, tick + 1))
      return tick;
  }
  return FLIGHT_TICKS;
}

static int32_t halve_by_ends(const struct oracle_search *s, int32_t from, int32_t to)
{
  if (tube_excluded(&s->pair, s->reach, from, from) && tube_excluded(&s->pair, s->reach, to, to))
    return FLIGHT_TICKS;
  if (to - from == 1)
    return from;
  const int32_t middle = from + (to - from) / 2, tick = halve_by_ends(s, from, middle);
  return tick < FLIGHT_TICKS ? tick : halve_by_ends(s, middle, to);
}

static int32_t twisted(const struct oracle_search *s, enum search_twist twist)
{
  const int32_t right = tube_contact(&s->pair, s->reach, s->from);
  switch (twist) {
  case TICK_LATE:
    return right < FLIGHT_TICKS ? right + 1 : right;
  case TICK_EARLY:
    return right < FLIGHT_TICKS ? right - 1 : right;
  case REACH_HALF:
    return tube_contact(&s->pair, s->reach / 2, s->from);
  case REACH_TWICE:
    return tube_contact(&s->pair, 2 * s->reach, s->from);
  case AS_LINES:
    return flight_contact(&s->pair, s->from);
  case FROM_ZERO:
    return tube_contact(&s->pair, s->reach, 0);
  case NONE_IS_LAST:
    return right < FLIGHT_TICKS || oracle_is_at_rest(&s->pair) ? right : FLIGHT_TICKS - 1;
  case AT_REST_TOO:
    return right < FLIGHT_TICKS || tube_excluded(&s->pair, s->reach, s->from, FLIGHT_TICKS) ? right : s->from;
  case LEAVES:
    return right < FLIGHT_TICKS ? last_tick(s) : right;
  case ENDS_ONLY:
    return oracle_is_at_rest(&s->pair) ? right : halve_by_ends(s, s->from, FLIGHT_TICKS);
  default:
    return first_side(s);
  }
}

static double searched(const struct evidence_part *part, uint32_t row, uint32_t column, const void *twist)
{
  struct oracle_search s;
  (void)column;
  return oracle_tube_search_of(&part->pair, row, &s) ? twisted(&s, *(const enum search_twist *)twist) : NAN;
}

static bool searches(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  if (k >= SEARCH_TWISTS)
    return false;
  const enum search_twist twist = (enum search_twist)k;
  relation_fill(e, searched, &twist);
  return relation_say(text, "%s", search_texts[k]);
}

/* --- contacts ----------------------------------------------------------------------------------------------------- */

enum contact_twist {
  NOT_THE_MIDDLE,
  FROM_OTHER_ENDS,
  EXCHANGED,
  UNCLAMPED,
  HALF_WAY,
  NORMAL_TURNED,
  NORMAL_CROSS,
  NORMAL_NOT_UNIT,
  CONTACT_TWISTS
};

static const char *const contact_texts[CONTACT_TWISTS] = {
    [NOT_THE_MIDDLE] = "parallel tubes touch in the middle of where they are side by side",
    [FROM_OTHER_ENDS] = "s and t from the other ends: 1 - s, 1 - t",
    [EXCHANGED] = "s and t exchanged",
    [UNCLAMPED] = "nearest points of the lines: s and t are not held within the bonds",
    [HALF_WAY] = "s and t are 0.5 always",
    [NORMAL_TURNED] = "the normal of tubes points from the other to the first",
    [NORMAL_CROSS] = "the normal of tubes is p x q: it is the direction of the gap",
    [NORMAL_NOT_UNIT] = "the normal of tubes is the gap itself, without its length 1"};

static void lines_closest(struct vec3 p, struct vec3 q, struct vec3 w, double *s, double *t)
{
  const struct vec3 n = vec3_cross(p, q);
  const double qq = vec3_dot(q, q), pq = vec3_dot(p, q), pw = vec3_dot(p, w), qw = vec3_dot(q, w), nn = vec3_dot(n, n);
  *s = (pw * qq - pq * qw) / nn;
  *t = (*s * pq - qw) / qq;
}

static void twist_points(enum contact_twist twist, struct vec3 p, struct vec3 q, struct vec3 w, double *s, double *t)
{
  double a, b;
  tube_shape.points(p, q, w, &a, &b);
  *s = twist == FROM_OTHER_ENDS ? 1.0 - a : twist == EXCHANGED ? b : twist == HALF_WAY ? 0.5 : a;
  *t = twist == FROM_OTHER_ENDS ? 1.0 - b : twist == EXCHANGED ? a : twist == HALF_WAY ? 0.5 : b;
  if (twist == NOT_THE_MIDDLE)
    capsule_closest(p, q, w, s, t);
  if (twist == UNCLAMPED)
    lines_closest(p, q, w, s, t);
}

static double touched(const struct evidence_part *part, uint32_t row, uint32_t column, const void *of)
{
  const enum contact_twist twist = *(const enum contact_twist *)of;
  struct vec3 p, q, w;
  double s, t;
  if (!oracle_tubes_of(&part->pair, row, &p, &q, &w))
    return NAN;
  twist_points(twist, p, q, w, &s, &t);
  if (strcmp(part->pair.ours->name, "out.contact") == 0)
    return column == 0 ? s : t;
  struct vec3 n = capsule_between(p, q, w, s, t);
  if (twist == NORMAL_CROSS)
    n = vec3_scale(vec3_dot(vec3_cross(p, q), n) < 0.0 ? -1.0 : 1.0, vec3_cross(p, q));
  if (twist == NORMAL_TURNED)
    n = vec3_scale(-1.0, n);
  const double size = twist == NORMAL_NOT_UNIT ? 1.0 : vec3_norm(n);
  return (column == 0 ? n.x : column == 1 ? n.y : n.z) * (1.0 / size);
}

static bool contacts(struct evidence *e, uint32_t k, char text[RELATION_TEXT])
{
  if (k >= CONTACT_TWISTS)
    return false;
  const enum contact_twist twist = (enum contact_twist)k;
  relation_fill(e, touched, &twist);
  return relation_say(text, "%s", contact_texts[k]);
}

const struct relation oracle_relations_tube[] = {
    {"tube_search", "out.tick", searches, .together = false},
    {"tube_contact", NULL, contacts, .together = true},
    {"bead_search", "out.tick", searches, .together = false},
    {"bead_contact", NULL, contacts, .together = true},
    {.make = NULL},
};
