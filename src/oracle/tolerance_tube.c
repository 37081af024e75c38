/* Tolerances of contacts of thick fibers: docs/port/tolerances.md derives them. */
#include <math.h>

#include "contact/tube.h"
#include "oracle/rows.h"
#include "oracle/tolerance.h"

/* A search, a contact of a pack, in a0. False if there is none in this row, or none that is legal. */
static bool point_of(const struct oracle_pair *p, const char *name, uint32_t row, struct point *to)
{
  const struct pack_table *t = oracle_sibling(p, name);
  const bool ok = t && !t->real && t->columns == 3 && row < t->rows;
  if (ok)
    *to = (struct point){t->value.integer[3 * (size_t)row], t->value.integer[3 * (size_t)row + 1],
                         t->value.integer[3 * (size_t)row + 2]};
  return ok;
}

static bool search_of(const struct oracle_pair *pair, uint32_t row, struct oracle_search *s)
{
  const struct pack_table *from = oracle_sibling(pair, "in.from"), *reach = oracle_sibling(pair, "in.reach");
  struct flight_pair *f = &s->pair;
  if (!from || !reach || reach->real || reach->columns != 1 || row >= reach->rows ||
      !point_of(pair, "in.p", row, &f->p) || !point_of(pair, "in.q", row, &f->q) ||
      !point_of(pair, "in.w", row, &f->w) || !point_of(pair, "in.p_rate", row, &f->p_rate) ||
      !point_of(pair, "in.q_rate", row, &f->q_rate) || !point_of(pair, "in.w_rate", row, &f->w_rate))
    return false;
  s->reach = reach->value.integer[row];
  const double first = pack_value(from, row, 0);
  const bool legal = oracle_search_is_legal(f, first) && s->reach > 0 && s->reach < (int64_t)1 << 50;
  s->from = legal ? (int32_t)first : 0;
  return legal;
}

static bool tubes_of(const struct oracle_pair *pair, uint32_t row, struct vec3 *p, struct vec3 *q, struct vec3 *w)
{
  struct point a, b, c;
  const bool ok = point_of(pair, "in.p", row, &a) && point_of(pair, "in.q", row, &b) && point_of(pair, "in.w", row, &c);
  if (ok)
    *p = point_in_a0(a), *q = point_in_a0(b), *w = point_in_a0(c);
  return ok;
}

static double length(struct point p)
{
  return sqrt((double)p.x * (double)p.x + (double)p.y * (double)p.y + (double)p.z * (double)p.z);
}

/* Lattice units: what the proof of a search leaves open within a tick, and rounding. */
static int64_t doubt(const struct oracle_pair *p, const struct oracle_search *s)
{
  const double way = length(s->pair.p_rate) + length(s->pair.q_rate) + length(s->pair.w_rate),
               size = length(s->pair.p) + length(s->pair.q) + length(s->pair.w) + FLIGHT_TICKS * way;
  return (int64_t)(2.0 + 2.0 * way * way / (double)s->reach + 64.0 * size * p->rounding);
}

/* A port may answer as if the tubes were a little thicker, or thinner. */
double tolerance_tube_tick(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct oracle_search s;
  if (!search_of(p, row, &s))
    return 0.0;
  const int64_t off = doubt(p, &s);
  const double ours = pack_value(p->ours, row, column), least = tube_contact(&s.pair, s.reach + off, s.from),
               most = s.reach > off ? tube_contact(&s.pair, s.reach - off, s.from) : FLIGHT_TICKS;
  return fmax(fmax(ours - least, most - ours), 0.0);
}

/* Of two bonds, of which the other may be a point. */
static double shorter(struct vec3 p, struct vec3 q)
{
  return vec3_norm(q) > 0.0 ? fmin(vec3_norm(p), vec3_norm(q)) : vec3_norm(p);
}

/* How much s and t amplify rounding. Tubes that are parallel beyond doubt touch in the middle of where they are side by
 * side: that is well conditioned, and so is a bond beside a point. */
static double condition(struct vec3 p, struct vec3 q)
{
  const double a = vec3_norm(p), b = vec3_norm(q), n = b > 0.0 ? vec3_norm(vec3_cross(p, q)) / (a * b) : 0.0,
               unlike = 1.0 + (a + b) / shorter(p, q);
  return n < 0.5e-12 ? unlike : unlike / (n * n);
}

double tolerance_tube_points(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  struct vec3 a, b, w;
  (void)column;
  if (!tubes_of(p, row, &a, &b, &w))
    return 0.0;
  return 64.0 * condition(a, b) * (1.0 + vec3_norm(w) / shorter(a, b)) * p->rounding;
}

double tolerance_tube_normal(const struct oracle_pair *p, uint32_t row, uint32_t column)
{
  const struct pack_table *contact = oracle_sibling(p, "out.contact");
  struct vec3 a, b, w;
  if (!contact || !tubes_of(p, row, &a, &b, &w))
    return 0.0;
  const double s = pack_value(contact, row, 0), t = pack_value(contact, row, 1),
               size = vec3_norm(a) + vec3_norm(b) + vec3_norm(w);
  const struct vec3 gap = vec3_add_scaled(vec3_add_scaled(w, t, b), -s, a);
  return size / vec3_norm(gap) * (tolerance_tube_points(p, row, column) + 32.0 * p->rounding);
}
