#include "oracle/tube_rows.h"

#include <stdlib.h>
#include <string.h>

#include "contact/capsule.h"
#include "contact/shape.h"
#include "oracle/columns.h"

/* --- tables ------------------------------------------------------------------------------------------------------- */

void oracle_put_radii(struct oracle_stage *g)
{
  const struct model *m = g->model;
  int64_t *to = oracle_put_integers(g, "in.tubes", "radius blind", m->vertices);
  for (uint32_t v = 0; to && v < m->vertices; v++) {
    const struct fiber_kind *k = &m->kind[m->fiber_kind_of[m->fiber_of[v]]];
    to[2 * v] = k->radius, to[2 * v + 1] = k->blind;
  }
}

typedef uint32_t constructed_searches(struct oracle_search search[ORACLE_TUBE_SEARCHES]);
typedef uint32_t constructed_contacts(struct oracle_tubes tubes[ORACLE_TUBE_CONTACTS]);

static void put_searches(struct oracle_stage *g, const struct oracle_search *search, uint32_t n,
                         constructed_searches *edges)
{
  struct oracle_search *s = malloc(((size_t)n + ORACLE_TUBE_SEARCHES) * sizeof *s);
  g->pack->failed |= !s;
  if (!s)
    return;
  if (n > 0) /* there may be no array at all */
    memcpy(s, search, n * sizeof *s);
  n += edges(&s[n]);
  oracle_put_flight_pairs(g, s, n);
  int64_t *reach = oracle_put_integers(g, "in.reach", "reach", n);
  for (uint32_t k = 0; reach && k < n; k++)
    reach[k] = s[k].reach;
  int64_t *tick = oracle_put_integers(g, "out.tick", "tick", n);
  for (uint32_t k = 0; tick && k < n; k++)
    tick[k] = tube_shape.contact(&s[k].pair, s[k].reach, s[k].from);
  free(s);
}

static void put_contacts(struct oracle_stage *g, const struct oracle_tubes *tubes, uint32_t n,
                         constructed_contacts *edges)
{
  struct oracle_tubes *c = malloc(((size_t)n + ORACLE_TUBE_CONTACTS) * sizeof *c);
  g->pack->failed |= !c;
  if (!c)
    return;
  if (n > 0)
    memcpy(c, tubes, n * sizeof *c);
  n += edges(&c[n]);
  oracle_put_points_of(g, "in.p", c, sizeof *c, offsetof(struct oracle_tubes, p), n);
  oracle_put_points_of(g, "in.q", c, sizeof *c, offsetof(struct oracle_tubes, q), n);
  oracle_put_points_of(g, "in.w", c, sizeof *c, offsetof(struct oracle_tubes, w), n);
  struct vec3 *normal = malloc(((size_t)n + 1) * sizeof *normal);
  double *contact = oracle_put_reals(g, "out.contact", "s t", n);
  g->pack->failed |= !normal;
  for (uint32_t k = 0; normal && contact && k < n; k++) {
    const struct flight_pair still = {.p = c[k].p, .q = c[k].q, .w = c[k].w};
    const struct vec3 p = point_in_a0(c[k].p), q = point_in_a0(c[k].q), w = point_in_a0(c[k].w);
    double s, t;
    tube_shape.points(p, q, w, &s, &t);
    const struct shape_contact at = {p, q, capsule_between(p, q, w, s, t), {0, 0, 0}};
    tube_shape.normal(&still, 0, &at, &normal[k]);
    contact[2 * (size_t)k] = s, contact[2 * (size_t)k + 1] = t;
  }
  if (normal)
    oracle_put_vectors(g, "out.normal", normal, n);
  free(normal);
  free(c);
}

void oracle_put_tube_searches(struct oracle_stage *g, const struct oracle_search *search, uint32_t n)
{
  put_searches(g, search, n, oracle_edges_tube_searches);
}

void oracle_put_tube_contacts(struct oracle_stage *g, const struct oracle_tubes *tubes, uint32_t n)
{
  put_contacts(g, tubes, n, oracle_edges_tube_contacts);
}

void oracle_put_bead_searches(struct oracle_stage *g, const struct oracle_search *search, uint32_t n)
{
  put_searches(g, search, n, oracle_edges_bead_searches);
}

void oracle_put_bead_contacts(struct oracle_stage *g, const struct oracle_tubes *tubes, uint32_t n)
{
  put_contacts(g, tubes, n, oracle_edges_bead_contacts);
}

/* --- rows of a pack ----------------------------------------------------------------------------------------------- */

static bool point_of(const struct oracle_pair *p, const char *name, uint32_t row, struct point *to)
{
  const struct pack_table *t = oracle_sibling(p, name);
  const bool ok = t && !t->real && t->columns == 3 && row < t->rows;
  if (ok)
    *to = (struct point){t->value.integer[3 * (size_t)row], t->value.integer[3 * (size_t)row + 1],
                         t->value.integer[3 * (size_t)row + 2]};
  return ok;
}

bool oracle_tube_search_of(const struct oracle_pair *pair, uint32_t row, struct oracle_search *s)
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

bool oracle_tubes_of(const struct oracle_pair *pair, uint32_t row, struct vec3 *p, struct vec3 *q, struct vec3 *w)
{
  struct point a, b, c;
  const bool ok = point_of(pair, "in.p", row, &a) && point_of(pair, "in.q", row, &b) && point_of(pair, "in.w", row, &c);
  if (ok)
    *p = point_in_a0(a), *q = point_in_a0(b), *w = point_in_a0(c);
  return ok;
}
