/*
 * Crossings of bonds: from sample to sample all vertices are taken to move straight and evenly, and pairs of bonds are
 * decided by topology/pair.h. One table "topology" with one row; docs/topology.md says what such a number proves.
 *
 * Bonds that share a vertex cannot cross, and two bonds whose vertices are all held do not move: neither is counted. A
 * pair that doubles cannot decide is counted as `unsure`; so is each bond of an interval that cannot be searched, since
 * a vertex is too far from the origin or too many images are within reach, or memory is short.
 */
#include <math.h>
#include <string.h>

#include "observe/block.h"
#include "observe/observer.h"
#include "topology/search.h"

/* Integers; the vertices' places at the sample before are behind them. LAST: 1 + its step, 0 before the first. */
enum { MARK, LAST, INTERVALS, LOOKED_AT, CROSSED, NET, ODD, UNSURE, PLACES };

/* Reals: times of the first and the last crossing, in steps; then the blocks of crossings of an interval. */
enum { FIRST_AT, LAST_AT, BLOCKS, LEVELS = 24 };

static size_t bonds_room(const struct model *m)
{
  return ((size_t)m->bonds * sizeof(uint32_t[2]) + sizeof(double) - 1) / sizeof(double);
}

static void size_topology(const struct observer *observer, const struct model *m, struct observer_size *size)
{
  (void)observer;
  size->reals = BLOCKS + LEVELS * BLOCK_LEVEL_DOUBLES;
  size->integers = PLACES + 3 * (size_t)m->vertices;
  size->scratch = bonds_room(m);
  size->passing = search_bytes(m->bonds);
}

static void list_bonds(const struct model *m, uint32_t (*bond)[2])
{
  for (uint32_t v = 0; v < m->vertices; v++)
    if (m->next[v] >= 0) {
      (*bond)[0] = v;
      (*bond++)[1] = (uint32_t)m->next[v];
    }
}

struct counting {
  struct observer *o;
  const struct model *model;
  const struct interval *interval;
};

static bool stands(const struct counting *c, uint32_t bond)
{
  return model_bond_stands(c->model, c->interval->bond[bond][0]);
}

/* Of one image of the box, the other bond a neighbor along the fiber. */
static bool share_vertex(const struct counting *c, const struct meeting *m)
{
  const uint32_t *i = c->interval->bond[m->bond[0]], *j = c->interval->bond[m->bond[1]];
  return m->image[0] == 0 && m->image[1] == 0 && m->image[2] == 0 && (i[0] == j[1] || i[1] == j[0]);
}

static void note_time(struct observer *o, double t)
{
  const double at = (double)(o->integer[LAST] - 1) + t * (double)o->every;
  o->real[FIRST_AT] = o->integer[CROSSED] == 0 ? at : fmin(at, o->real[FIRST_AT]);
  o->real[LAST_AT] = fmax(at, o->real[LAST_AT]);
}

static void count(void *sink, const struct meeting *m, enum pair_verdict verdict, const struct crossing *crossing,
                  int crossings)
{
  const struct counting *c = sink;
  int64_t *n = c->o->integer;
  if (share_vertex(c, m) || (stands(c, m->bond[0]) && stands(c, m->bond[1])))
    return;
  n[UNSURE] += verdict == PAIR_UNSURE;
  for (int k = 0; verdict == PAIR_CROSSED && k < crossings; k++) {
    note_time(c->o, crossing[k].t);
    n[CROSSED]++;
    n[NET] += crossing[k].sign;
  }
  n[ODD] += verdict == PAIR_CROSSED && crossings % 2 == 1;
}

static bool in_reach(const struct point *place, uint32_t vertices)
{
  int64_t most = 0;
  for (uint32_t v = 0; v < vertices; v++) {
    const int64_t x[] = {place[v].x, place[v].y, place[v].z};
    for (int axis = 0; axis < 3; axis++)
      most = x[axis] > most ? x[axis] : -x[axis] > most ? -x[axis] : most;
  }
  return most <= SEARCH_REACH;
}

static void look(struct observer *o, const struct model *m, const struct point *now)
{
  struct search search = {0};
  struct interval v = {.vertices = m->vertices,
                       .bonds = m->bonds,
                       .bond = (const uint32_t(*)[2])o->scratch,
                       .position = {(const struct point *)&o->integer[PLACES], now}};
  struct counting counting = {o, m, &v};
  const int64_t before = o->integer[CROSSED];
  uint64_t looked_at = 0, near;
  for (int axis = 0; axis < 3; axis++) {
    v.edge[0][axis] = v.edge[1][axis] = m->box.edge[axis];
    v.periodic[axis] = m->box.boundary[axis] == BOUNDARY_PERIODIC;
  }
  list_bonds(m, (uint32_t(*)[2])o->scratch);
  if (!in_reach(v.position[0], m->vertices) || !in_reach(now, m->vertices) ||
      search_pairs(&search, &v, count, &counting, &looked_at, &near) != SEARCH_DONE)
    o->integer[UNSURE] += m->bonds;
  search_free(&search);
  o->integer[INTERVALS]++;
  o->integer[LOOKED_AT] += (int64_t)looked_at;
  block_add((struct block_level *)&o->real[BLOCKS], LEVELS, (double)(o->integer[CROSSED] - before), 0.0);
}

static void add_topology(struct observer *o, struct view *view)
{
  const struct model *m = view->model;
  const int64_t mark = (int64_t)view->state->step + 1;
  if (o->integer[LAST] > 0 && mark - o->integer[LAST] == (int64_t)o->every) /* not after a frame that was left out */
    look(o, m, view->state->position);
  memcpy(&o->integer[PLACES], view->state->position, m->vertices * sizeof(struct point));
  o->integer[LAST] = mark;
}

/* --- the table --------------------------------------------------------------------------------------------------- */

static const char *const columns[] = {"intervals", "looked_at", "crossed",    "net",        "odd_pairs",
                                      "unsure",    "rate",      "rate_error", "first_time", "last_time"};

enum { COLUMNS = sizeof columns / sizeof *columns };

static bool summarise_topology(const struct observer *o, const struct model *m, const struct observer_take *to)
{
  const int64_t *n = o->integer;
  const struct block_level *blocks = (const struct block_level *)&o->real[BLOCKS];
  const double each = 1.0 / (m->bonds * (double)o->every * m->time_step);
  const bool any = n[CROSSED] > 0;
  double row[COLUMNS] = {(double)n[INTERVALS],
                         (double)n[LOOKED_AT],
                         (double)n[CROSSED],
                         (double)n[NET],
                         (double)n[ODD],
                         (double)n[UNSURE],
                         n[INTERVALS] > 0 ? each * blocks->mean[0] : NAN,
                         block_error(blocks, LEVELS, each, 0.0),
                         any ? o->real[FIRST_AT] * m->time_step : NAN,
                         any ? o->real[LAST_AT] * m->time_step : NAN};
  const struct observe_table table = {"topology", columns, COLUMNS, 1, row};
  return to->take(to->context, &table);
}

const struct observer_type topology_observer = {
    .size = size_topology,
    .add = add_topology,
    .summarise = summarise_topology,
};
