/* Tubes in flight and in contact, as scenes seldom have them: parallel, end on end, slow, grazing, at rest. */
#include <math.h>

#include "contact/capsule.h"
#include "oracle/edges_touch.h"
#include "oracle/rows.h"

/* --- places ------------------------------------------------------------------------------------------------------- */

enum direction { ANY_DIRECTION, PARALLEL, NEARLY_PARALLEL, ON_ONE_LINE };
enum place { ANY_PLACE, END_ON_SIDE, END_ON_END };

/* Tubes of a bond of 2^bond units along each axis at most, that touch at `tick`, or did if `direction` lets them; their
 * ends move by 2^rate units in a tick. graze: they pass by in a depth of 2^graze units; 0: they do as they come. */
static const struct tube_kind {
  int bond, rate;
  enum direction direction;
  enum place place;
  int graze;
  uint32_t rows;
} kinds[] = {
    {39, 20, ANY_DIRECTION, ANY_PLACE, 0, 30},    {39, 20, ANY_DIRECTION, END_ON_SIDE, 0, 20},
    {39, 20, ANY_DIRECTION, END_ON_END, 0, 20},   {39, 20, PARALLEL, ANY_PLACE, 0, 16},
    {39, 20, NEARLY_PARALLEL, ANY_PLACE, 0, 16},  {39, 20, ON_ONE_LINE, END_ON_END, 0, 12},
    {39, 6, ANY_DIRECTION, ANY_PLACE, 0, 20},     {36, 20, ANY_DIRECTION, END_ON_SIDE, 0, 12},
    {39, 21, ANY_DIRECTION, ANY_PLACE, 26, 16},   {39, 21, ANY_DIRECTION, END_ON_END, 26, 16},
    {39, 21, NEARLY_PARALLEL, ANY_PLACE, 30, 10},
};
enum { KINDS = sizeof kinds / sizeof *kinds };
_Static_assert(30 + 20 + 20 + 16 + 16 + 12 + 20 + 12 + 16 + 16 + 10 + EDGES_AT_REST <= ORACLE_TUBE_SEARCHES, "room");

static struct point plus_times(struct point p, int64_t factor, struct point q)
{
  return (struct point){p.x + factor * q.x, p.y + factor * q.y, p.z + factor * q.z};
}

static struct point units_of(struct vec3 r)
{
  return (struct point){llrint(r.x), llrint(r.y), llrint(r.z)};
}

static double draw_place(struct dice *d, enum place place, bool end)
{
  return place == END_ON_END || (place == END_ON_SIDE && end) ? (double)(dice_u64(d) % 2) : dice_between(d, 0.1, 0.9);
}

/* A unit vector, perpendicular to the bonds that are touched at their sides. */
static struct vec3 draw_gap(struct dice *d, struct vec3 p, struct vec3 q, double s, double t)
{
  struct vec3 n = dice_vector(d, 1.0);
  const bool side_p = s > 0.0 && s<1.0, side_q = t> 0.0 && t < 1.0;
  const struct vec3 both = vec3_cross(p, q);
  if (side_p && side_q && vec3_norm(both) > 1e-3 * vec3_norm(p) * vec3_norm(q))
    n = both;
  else if (side_p || side_q) {
    const struct vec3 along = side_p ? p : q;
    n = vec3_add_scaled(n, -vec3_dot(n, along) / vec3_dot(along, along), along);
  }
  return vec3_scale(1.0 / vec3_norm(n), n);
}

/* Two tubes at some time, their axes `reach` apart at the points s and t, or nearer where that is no nearest line. */
static struct oracle_tubes draw_tubes(struct dice *d, const struct tube_kind *k, int64_t reach)
{
  const int64_t bond = (int64_t)1 << k->bond;
  struct oracle_tubes c = {.p = dice_point(d, bond)};
  c.q = dice_point(d, bond);
  const double s = draw_place(d, k->place, true), t = draw_place(d, k->place, false);
  if (k->direction != ANY_DIRECTION)
    c.q = plus_times((struct point){0, 0, 0}, dice_u64(d) % 2 ? 2 : -1, c.p);
  if (k->direction == NEARLY_PARALLEL)
    c.q = plus_times(c.q, 1, dice_point(d, bond >> 12));
  struct vec3 gap = draw_gap(d, edges_vector(c.p), edges_vector(c.q), s, t);
  if (k->direction == ON_ONE_LINE)
    gap = vec3_scale((s > 0.5 ? 1.0 : -1.0) / vec3_norm(edges_vector(c.p)), edges_vector(c.p));
  const struct vec3 w = vec3_add_scaled(vec3_scale(s, edges_vector(c.p)), -t, edges_vector(c.q));
  c.w = units_of(vec3_add_scaled(w, (double)reach, gap));
  return c;
}

/* --- searches ----------------------------------------------------------------------------------------------------- */

static struct oracle_search draw_search(struct dice *d, const void *kind)
{
  const struct tube_kind *k = kind;
  const int64_t reach = ((int64_t)1 << 36) + dice_integer(d, (int64_t)1 << 35), rate = (int64_t)1 << k->rate,
                tick = (int64_t)(dice_u64(d) % FLIGHT_TICKS);
  const struct oracle_tubes c = draw_tubes(d, k, reach);
  struct flight_pair f = {.p_rate = dice_point(d, rate), .q_rate = dice_point(d, rate), .w_rate = dice_point(d, rate)};
  if (k->direction == PARALLEL || k->direction == ON_ONE_LINE)
    f.p_rate = f.q_rate = (struct point){0, 0, 0};
  f.p = plus_times(c.p, -tick, f.p_rate), f.q = plus_times(c.q, -tick, f.q_rate);
  f.w = plus_times(c.w, -tick, f.w_rate);
  return (struct oracle_search){.pair = f, .reach = reach};
}

bool oracle_edges_tube_searches(struct oracle_stage *g)
{
  struct oracle_search search[ORACLE_TUBE_SEARCHES];
  struct dice d = {79};
  uint32_t n = 0;
  for (int k = 0; k < KINDS; k++) {
    const struct edges_touch wanted = {draw_search, &kinds[k], (int64_t)1 << 20, kinds[k].graze, kinds[k].rows};
    n = edges_add_touches(&d, &wanted, search, n);
  }
  n = edges_add_at_rest(search, n);
  return oracle_add_rows(g, search, n, sizeof *search);
}

/* --- contacts ----------------------------------------------------------------------------------------------------- */

bool oracle_edges_tube_contacts(struct oracle_stage *g)
{
  struct oracle_tubes tubes[ORACLE_TUBE_CONTACTS];
  static const struct tube_kind of[] = {
      {39, 0, ANY_DIRECTION, ANY_PLACE, 0, 20},  {39, 0, ANY_DIRECTION, END_ON_SIDE, 0, 20},
      {39, 0, ANY_DIRECTION, END_ON_END, 0, 20}, {39, 0, PARALLEL, ANY_PLACE, 0, 20},
      {39, 0, ON_ONE_LINE, END_ON_END, 0, 10},   {36, 0, ANY_DIRECTION, END_ON_SIDE, 0, 10},
  };
  struct dice d = {83};
  uint32_t n = 0;
  for (size_t k = 0; k < sizeof of / sizeof *of; k++)
    for (const uint32_t end = n + of[k].rows; n < end;) {
      tubes[n] = draw_tubes(&d, &of[k], ((int64_t)1 << 36) + dice_integer(&d, (int64_t)1 << 35));
      const struct oracle_tubes *c = &tubes[n];
      n += capsule_distance(point_in_a0(c->p), point_in_a0(c->q), point_in_a0(c->w)) > 0x1p-6; /* not in each other */
    }
  return oracle_add_rows(g, tubes, n, sizeof *tubes);
}
