#include "topology/diagram.h"

#include <stdlib.h>

#include "base/memory.h"
#include "contact/determinant.h"

enum { CHUNK = 8 }; /* bonds whose shadows share a rectangle */

/* Odd numbers without a common pattern, drawn once. Below 2^15: see struct flat. */
static const int64_t directions[][3] = {
    {10427, -6389, 23557}, {-7411, 14783, 19213}, {4519, 9871, 30253},  {-15131, -2693, 21319},
    {3301, -17489, 15973}, {18713, 5227, 12659},  {-9337, 8111, 27697}, {613, 1429, 31873},
};
enum { DIRECTIONS = sizeof directions / sizeof directions[0] };

/* A vertex in the plane of the projection, below 2^62: areas are below 2^127. */
struct flat {
  int64_t u, v;
};

struct chunk {
  uint32_t member, first, end; /* bonds */
  struct flat low, high;
};

/* A bond of a crossing, where the curve passes it. */
struct passage {
  uint32_t bond, crossing;
  double place;
  bool below;
};

void diagram_free(struct diagram *d)
{
  free(d->crossing);
  free(d->flat);
  free(d->chunk);
  free(d->passage);
  *d = (struct diagram){0};
}

/* --- the projection ------------------------------------------------------------------------------------------------
 */

static bool project(struct diagram *d, const struct polygons *p, const int64_t n[3])
{
  const struct point origin = p->at[0];
  for (uint32_t k = 0; k < p->first[p->members]; k++) {
    const struct difference r = difference(p->at[k], origin);
    if (llabs(r.x) >= DIAGRAM_REACH || llabs(r.y) >= DIAGRAM_REACH || llabs(r.z) >= DIAGRAM_REACH)
      return false;
    d->flat[k] = (struct flat){n[2] * r.x - n[0] * r.z, n[2] * r.y - n[1] * r.z};
  }
  return true;
}

static uint32_t vertex_after(const struct polygons *p, uint32_t member, uint32_t vertex)
{
  return vertex + 1 < p->first[member + 1] ? vertex + 1 : p->first[member];
}

static void widen(struct chunk *c, struct flat f)
{
  c->low = (struct flat){f.u < c->low.u ? f.u : c->low.u, f.v < c->low.v ? f.v : c->low.v};
  c->high = (struct flat){f.u > c->high.u ? f.u : c->high.u, f.v > c->high.v ? f.v : c->high.v};
}

static uint32_t make_chunks(struct diagram *d, const struct polygons *p)
{
  uint32_t chunks = 0;
  for (uint32_t m = 0; m < p->members; m++)
    for (uint32_t first = p->first[m]; first < p->first[m + 1]; first += CHUNK) {
      const uint32_t rest = p->first[m + 1] - first, end = first + (rest < CHUNK ? rest : CHUNK);
      struct chunk c = {m, first, end, d->flat[first], d->flat[first]};
      for (uint32_t k = first; k < end; k++)
        widen(&c, d->flat[vertex_after(p, m, k)]);
      d->chunk[chunks++] = c;
    }
  return chunks;
}

static bool chunks_meet(const struct chunk *a, const struct chunk *b)
{
  return a->low.u <= b->high.u && b->low.u <= a->high.u && a->low.v <= b->high.v && b->low.v <= a->high.v;
}

/* --- crossings -----------------------------------------------------------------------------------------------------
 */

/* Twice the area of the triangle, counterclockwise. */
static int128 area(struct flat o, struct flat a, struct flat b)
{
  return (int128)(a.u - o.u) * (b.v - o.v) - (int128)(a.v - o.v) * (b.u - o.u);
}

static int sign_of(int128 value)
{
  return (value > 0) - (value < 0);
}

static bool intervals_meet(int64_t a, int64_t b, int64_t c, int64_t d)
{
  return (a < b ? a : b) <= (c > d ? c : d) && (c < d ? c : d) <= (a > b ? a : b);
}

enum meeting { NO_CROSSING, CROSSING, SPECIAL, TOUCH };

/* Bonds from `from` to `to`. With w from the start of the first to the start of the second and h the height of the
 * second over the first, w.(p x q) = h n.(p x q), n being the direction of sight. */
static enum meeting meet(const struct diagram *d, const struct polygons *p, const uint32_t from[2],
                         const uint32_t to[2], struct crossing *c)
{
  const struct flat a = d->flat[from[0]], b = d->flat[to[0]], e = d->flat[from[1]], f = d->flat[to[1]];
  if (!intervals_meet(a.u, b.u, e.u, f.u) || !intervals_meet(a.v, b.v, e.v, f.v))
    return NO_CROSSING;
  const int128 of_a = area(e, f, a), of_b = area(e, f, b);
  if (sign_of(of_a) * sign_of(of_b) > 0)
    return NO_CROSSING;
  const int128 of_e = area(a, b, e), of_f = area(a, b, f);
  if (sign_of(of_e) * sign_of(of_f) > 0)
    return NO_CROSSING;
  if (of_a == 0 || of_b == 0 || of_e == 0 || of_f == 0)
    return SPECIAL;
  const double volume = determinant(difference(p->at[to[0]], p->at[from[0]]), difference(p->at[to[1]], p->at[from[1]]),
                                    difference(p->at[from[1]], p->at[from[0]]));
  if (volume == 0.0)
    return TOUCH;
  const double place[2] = {(double)of_a / (double)(of_a - of_b), (double)of_e / (double)(of_e - of_f)};
  const int above = (volume > 0.0) == (of_f > of_e); /* n.(p x q) has the sign of of_f - of_e */
  for (int k = 0; k < 2; k++) {
    c->bond[k] = from[above ^ k];
    c->place[k] = place[above ^ k];
  }
  c->sign = volume > 0.0 ? -1 : 1;
  return CROSSING;
}

static enum diagram_status add_crossing(struct diagram *d, const struct crossing *c, uint32_t most)
{
  if (d->crossings == most)
    return DIAGRAM_TOO_MANY;
  if (d->crossings == d->crossing_room &&
      !memory_double((void **)&d->crossing, &d->crossing_room, 256, sizeof *d->crossing))
    return DIAGRAM_NO_MEMORY;
  d->crossing[d->crossings++] = *c;
  return DIAGRAM_FINE;
}

/* Bonds that follow each other share their vertex alone, or else the bonds next to them touch. */
static enum diagram_status cross_bonds(struct diagram *d, const struct polygons *p, const struct chunk *one,
                                       const struct chunk *other, uint32_t i, uint32_t j, uint32_t most)
{
  const uint32_t from[2] = {i, j}, to[2] = {vertex_after(p, one->member, i), vertex_after(p, other->member, j)};
  if (to[0] == j || to[1] == i)
    return DIAGRAM_FINE;
  struct crossing c = {0};
  switch (meet(d, p, from, to, &c)) {
  case NO_CROSSING:
    return DIAGRAM_FINE;
  case SPECIAL:
    return DIAGRAM_SPECIAL;
  case TOUCH:
    return DIAGRAM_TOUCHED;
  case CROSSING:
    break;
  }
  const bool first_above = c.bond[0] == i;
  c.member[0] = (first_above ? one : other)->member;
  c.member[1] = (first_above ? other : one)->member;
  return add_crossing(d, &c, most);
}

static enum diagram_status cross_chunks(struct diagram *d, const struct polygons *p, const struct chunk *a,
                                        const struct chunk *b, uint32_t most)
{
  enum diagram_status status = DIAGRAM_FINE;
  for (uint32_t i = a->first; i < a->end; i++)
    for (uint32_t j = a == b ? i + 1 : b->first; status == DIAGRAM_FINE && j < b->end; j++)
      status = cross_bonds(d, p, a, b, i, j, most);
  return status;
}

static enum diagram_status cross_all(struct diagram *d, const struct polygons *p, bool own, uint32_t most)
{
  enum diagram_status status = DIAGRAM_FINE;
  const uint32_t chunks = make_chunks(d, p);
  d->crossings = 0;
  for (uint32_t a = 0; a < chunks; a++)
    for (uint32_t b = a; status == DIAGRAM_FINE && b < chunks; b++)
      if ((own || d->chunk[a].member != d->chunk[b].member) && chunks_meet(&d->chunk[a], &d->chunk[b]))
        status = cross_chunks(d, p, &d->chunk[a], &d->chunk[b], most);
  return status;
}

/* --- arcs ----------------------------------------------------------------------------------------------------------
 */

/* Nearer places of one bond are not told apart: they are known to some 1e-15. */
#define LEAST_APART 0x1p-44

static int compare_passages(const void *one, const void *other)
{
  const struct passage *a = one, *b = other;
  return a->bond != b->bond ? (a->bond > b->bond) - (a->bond < b->bond) : (a->place > b->place) - (a->place < b->place);
}

static enum diagram_status sort_passages(struct diagram *d)
{
  const uint32_t passages = 2 * d->crossings;
  for (uint32_t k = 0; k < passages; k++) {
    const struct crossing *c = &d->crossing[k / 2];
    d->passage[k] = (struct passage){c->bond[k % 2], k / 2, c->place[k % 2], k % 2};
  }
  if (passages > 0)
    qsort(d->passage, passages, sizeof *d->passage, compare_passages);
  for (uint32_t k = 1; k < passages; k++)
    if (d->passage[k].bond == d->passage[k - 1].bond && d->passage[k].place - d->passage[k - 1].place < LEAST_APART)
      return DIAGRAM_SPECIAL;
  return DIAGRAM_FINE;
}

/* An arc goes from one passage below to the next one. A member that passes below nowhere has none. */
static void make_arcs(struct diagram *d, const struct polygons *p)
{
  uint32_t k = 0, arcs = 0;
  d->split = false;
  for (uint32_t m = 0; m < p->members; m++) {
    const uint32_t begin = k, first = arcs;
    for (; k < 2 * d->crossings && d->passage[k].bond < p->first[m + 1]; k++)
      arcs += d->passage[k].below;
    d->split = d->split || (p->members > 1 && arcs == first);
    uint32_t now = arcs - 1, next = first;
    for (uint32_t j = begin; j < k; j++) {
      struct crossing *c = &d->crossing[d->passage[j].crossing];
      if (d->passage[j].below) {
        c->in = now;
        c->out = now = next++;
      } else {
        c->over = now;
      }
    }
  }
}

/* --- all of it -----------------------------------------------------------------------------------------------------
 */

static enum diagram_status look_along(struct diagram *d, const struct polygons *p, const int64_t n[3], bool own,
                                      uint32_t most)
{
  if (!project(d, p, n))
    return DIAGRAM_TOO_FAR;
  enum diagram_status status = cross_all(d, p, own, most);
  if (status != DIAGRAM_FINE || !own)
    return status;
  if (!memory_room((void **)&d->passage, &d->passage_room, 2 * d->crossings, sizeof *d->passage))
    return DIAGRAM_NO_MEMORY;
  status = sort_passages(d);
  if (status == DIAGRAM_FINE)
    make_arcs(d, p);
  return status;
}

enum diagram_status diagram_make(struct diagram *d, const struct polygons *p, bool own, uint32_t most)
{
  const uint32_t vertices = p->first[p->members];
  if (!memory_room((void **)&d->flat, &d->vertex_room, vertices, sizeof *d->flat) ||
      !memory_room((void **)&d->chunk, &d->chunk_room, vertices / CHUNK + p->members, sizeof *d->chunk))
    return DIAGRAM_NO_MEMORY;
  enum diagram_status status = DIAGRAM_SPECIAL;
  for (int k = 0; k < DIRECTIONS && status == DIAGRAM_SPECIAL; k++)
    status = look_along(d, p, directions[k], own, most);
  return status;
}
