#include "oracle/flyer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/patterns.h"

#define FAR 64 /* images */

/* --- tables ------------------------------------------------------------------------------------------------------- */

bool flyer_take(const struct oracle_pair *p, struct flyer *f)
{
  *f = (struct flyer){.pair = p,
                      .time = oracle_sibling(p, "in.time"),
                      .from = oracle_sibling(p, "in.position"),
                      .start = oracle_sibling(p, "in.velocity"),
                      .chain = oracle_model(p, "in.chain"),
                      .vertex = oracle_model(p, "in.vertex"),
                      .event = oracle_sibling_of_theirs(p, "out.event"),
                      .hit = oracle_sibling_of_theirs(p, "out.hit"),
                      .to = oracle_sibling_of_theirs(p, "out.position"),
                      .end = oracle_sibling_of_theirs(p, "out.velocity")};
  f->n = f->from ? f->from->rows : 0;
  if (oracle_model(p, "in.tubes")) /* drifts of lines only are made anew */
    return false;
  if (f->n == 0 || !f->time || f->time->columns != 2 || !f->chain || !f->vertex || f->chain->rows != f->n ||
      f->vertex->rows != f->n || f->vertex->columns != 7 || !f->event || !f->hit || f->event->columns != 6 ||
      f->hit->columns != 6 || f->event->rows != f->hit->rows || !oracle_box(p, &f->box) ||
      !oracle_is_vectors(f->from, false, f->n - 1) || !oracle_is_vectors(f->start, true, f->n - 1) || !f->to ||
      !f->end || f->to->columns != 3 || f->end->columns != 3)
    return false;
  f->dt = pack_value(f->time, 0, 0), f->begin = pack_value(f->time, 0, 1);
  return true;
}

static int64_t rounded(const struct flyer *f, double x)
{
  const double ticks = x * (LATTICE_PER_A0 / FLIGHT_TICKS);
  return (int64_t)(f->t->rate == RATE_CUT ? trunc(ticks) : f->t->rate == RATE_DOWN ? floor(ticks) : rint(ticks));
}

struct point flyer_rate(struct flyer *f, struct vec3 v)
{
  const struct vec3 d = vec3_scale(f->dt, v);
  if (!(fabs(d.x) < 512.0 && fabs(d.y) < 512.0 && fabs(d.z) < 512.0)) {
    f->failed = true;
    return (struct point){0, 0, 0};
  }
  return (struct point){rounded(f, d.x), rounded(f, d.y), rounded(f, d.z)};
}

bool flyer_begin(struct flyer *f)
{
  f->r = malloc(f->n * sizeof *f->r), f->rate = malloc(f->n * sizeof *f->rate);
  f->origin = malloc(f->n * sizeof *f->origin), f->v = malloc(f->n * sizeof *f->v);
  f->contacts = calloc(f->n, sizeof *f->contacts), f->cluster = calloc(f->n, sizeof *f->cluster);
  f->queue = malloc(MOST_EVENTS * sizeof *f->queue);
  if (!f->r || !f->rate || !f->origin || !f->v || !f->contacts || !f->cluster || !f->queue)
    return false;
  for (uint32_t k = 0; k < f->n; k++) {
    f->r[k] = f->origin[k] = oracle_point(f->from, k), f->v[k] = oracle_vector(f->start, k);
    f->rate[k] = flyer_rate(f, f->v[k]);
    f->failed |= !point_within_reach(f->r[k]);
  }
  return !f->failed;
}

void flyer_finish(struct flyer *f)
{
  free(f->r), free(f->rate), free(f->origin), free(f->v), free(f->contacts), free(f->cluster), free(f->queue);
}

static int64_t chain_of(const struct flyer *f, int64_t k, uint32_t column)
{
  const int64_t v = k >= 0 && k < f->n ? f->chain->value.integer[3 * k + column] : -1;
  return v < f->n ? v : -1;
}

int64_t flyer_next(const struct flyer *f, int64_t k)
{
  return chain_of(f, k, 0);
}

int64_t flyer_prev(const struct flyer *f, int64_t k)
{
  return chain_of(f, k, 1);
}

struct point flyer_place(const struct flyer *f, int64_t k, int32_t tick)
{
  return flight_place(f->r[k], f->rate[k], tick);
}

double flyer_constant(const struct flyer *f, int64_t k, uint32_t column)
{
  return pack_value(f->vertex, (uint32_t)k, column);
}

/* --- searches ----------------------------------------------------------------------------------------------------- */

static struct point image_of(const struct flyer *f, struct point p, const int64_t image[3])
{
  const int64_t *e = f->box.edge;
  return (struct point){p.x + image[0] * e[0], p.y + image[1] * e[1], p.z + image[2] * e[2]};
}

struct flight_pair flyer_pair(const struct flyer *f, const struct found *e)
{
  const int64_t i = e->bond, j = flyer_next(f, i), k = e->other, l = flyer_next(f, k);
  return (struct flight_pair){.p = point_minus(f->r[j], f->r[i]),
                              .q = point_minus(f->r[l], f->r[k]),
                              .w = point_minus(image_of(f, f->r[k], e->image), f->r[i]),
                              .p_rate = point_minus(f->rate[j], f->rate[i]),
                              .q_rate = point_minus(f->rate[l], f->rate[k]),
                              .w_rate = point_minus(f->rate[k], f->rate[i])};
}

static void drop(struct flyer *f, const bool *marked)
{
  uint32_t kept = 0;
  for (uint32_t k = 0; k < f->queued; k++)
    if (!marked[f->queue[k].bond] && !marked[f->queue[k].other])
      f->queue[kept++] = f->queue[k];
  f->queued = kept;
}

void flyer_drop_pair(struct flyer *f, const struct found *e)
{
  uint32_t kept = 0;
  for (uint32_t k = 0; k < f->queued; k++)
    if (f->queue[k].bond != e->bond || f->queue[k].other != e->other ||
        memcmp(f->queue[k].image, e->image, sizeof e->image) != 0)
      f->queue[kept++] = f->queue[k];
  f->queued = kept;
}

void flyer_search_pair(struct flyer *f, int64_t bond, int64_t other, const int64_t image[3], int32_t from)
{
  const bool exchange = other < bond;
  const int64_t sign = exchange && f->t->image != IMAGE_KEEPS_SIGN ? -1 : 1;
  struct found e = {0,
                    (uint32_t)(exchange ? other : bond),
                    (uint32_t)(exchange ? bond : other),
                    {sign * image[0], sign * image[1], sign * image[2]}};
  const struct flight_pair pair = flyer_pair(f, &e);
  e.tick = from < FLIGHT_TICKS ? event_search(f->t, &pair, from) : FLIGHT_TICKS;
  if (e.tick >= FLIGHT_TICKS)
    return;
  if (f->t->again == AGAIN_OLD_STAY)
    flyer_drop_pair(f, &e);
  f->failed |= f->queued == MOST_EVENTS;
  if (!f->failed)
    f->queue[f->queued++] = e;
}

int64_t flyer_axis(struct point p, int axis)
{
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/* Of the path of a bond from a tick on, along an axis. */
static void range_of(const struct flyer *f, int64_t bond, int32_t tick, int axis, int64_t range[2])
{
  range[0] = INT64_MAX, range[1] = INT64_MIN;
  const int64_t end[2] = {bond, flyer_next(f, bond)};
  for (int k = 0; k < 4; k++) {
    const int64_t at = flyer_axis(flyer_place(f, end[k / 2], k % 2 ? FLIGHT_TICKS : tick), axis);
    range[0] = at < range[0] ? at : range[0], range[1] = at > range[1] ? at : range[1];
  }
}

static bool takes_image(const struct flyer *f, const int64_t image[3])
{
  int64_t most = 0;
  for (int k = 0; k < 3; k++)
    most = llabs(image[k]) > most ? llabs(image[k]) : most;
  return f->t->image == IMAGE_NONE ? most == 0 : f->t->image == IMAGE_ONE_BOX ? most <= 1 : true;
}

static void search_images(struct flyer *f, int64_t bond, int64_t other, int32_t near, int32_t from)
{
  int64_t low[3], high[3];
  for (int k = 0; k < 3; k++) {
    int64_t mine[2], its[2];
    range_of(f, bond, near, k, mine), range_of(f, other, near, k, its);
    low[k] = -lattice_image(its[1] - mine[0], f->box.edge[k]),
    high[k] = lattice_image(mine[1] - its[0], f->box.edge[k]);
    if (low[k] > high[k])
      return;
    f->failed |= low[k] < -FAR || high[k] > FAR;
  }
  for (int64_t i = low[0]; i <= high[0] && !f->failed; i++)
    for (int64_t j = low[1]; j <= high[1]; j++)
      for (int64_t k = low[2]; k <= high[2]; k++) {
        const int64_t image[3] = {i, j, k};
        if (takes_image(f, image))
          flyer_search_pair(f, bond, other, image, from);
      }
}

static bool shares(const struct flyer *f, int64_t bond, int64_t other)
{
  const int64_t b = flyer_next(f, bond), d = flyer_next(f, other);
  return bond == other || bond == d || b == other || b == d;
}

/* Searches bonds that are marked against all others; `marked`: NULL for all. */
void flyer_search(struct flyer *f, const bool *marked, int32_t near, int32_t from)
{
  for (int64_t bond = 0; bond < f->n && !f->failed; bond++)
    for (int64_t other = 0; other < f->n && (!marked || marked[bond]); other++)
      if (flyer_next(f, bond) >= 0 && flyer_next(f, other) >= 0 && !shares(f, bond, other) &&
          (other > bond || (marked && !marked[other])))
        search_images(f, bond, other, near, from);
}

void flyer_search_again(struct flyer *f, const bool *vertex, const struct found *e, enum again_rule rule)
{
  bool *dropped = calloc(f->n, sizeof *dropped);
  f->failed |= !dropped;
  for (int64_t k = 0; !f->failed && k < f->n; k++) {
    dropped[k] = vertex[k] || (flyer_next(f, k) >= 0 && vertex[flyer_next(f, k)]);
    if (rule == AGAIN_TWO_BONDS)
      dropped[k] = k == e->bond || k == e->other;
    if (rule == AGAIN_FIRST_BOND)
      dropped[k] = k == e->bond || k == flyer_prev(f, e->bond) || k == flyer_next(f, e->bond);
  }
  if (!f->failed) {
    if (rule != AGAIN_OLD_STAY)
      drop(f, dropped);
    const int32_t from = rule == AGAIN_FROM_START ? 0 : rule == AGAIN_TICK_LATER ? e->tick + 1 : e->tick;
    if (rule != AGAIN_NOTHING)
      flyer_search(f, dropped, from < e->tick ? from : e->tick, from);
    if (rule == AGAIN_NOT_THE_PAIR)
      flyer_drop_pair(f, e);
  }
  free(dropped);
}
