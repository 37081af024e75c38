/* Drifts of the rule `event-driven`, replayed with one thing changed. All pairs of bonds are searched, without lists.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/capsule.h"
#include "contact/determinant.h"
#include "oracle/event_model.h"
#include "oracle/patterns.h"
#include "oracle/replay.h"

enum { MOST_EVENTS = 4096, MOST_CONTACTS = 1000, FAR = 64 }; /* of a drift; of a vertex; images */

struct found {
  int32_t tick;
  uint32_t bond, other;
  int64_t image[3];
};

/* A drift at work. At tick T vertex v is at r[v] + T rate[v]. */
struct flyer {
  const struct oracle_pair *pair;
  const struct event_twist *t;
  const struct pack_table *time, *from, *start, *chain, *vertex, *event, *hit, *to, *end;
  struct box box;
  double dt, begin, tolerance;
  uint32_t n;
  struct point *r, *rate, *origin;
  struct vec3 *v;
  uint32_t *contacts, *cluster, clusters;
  struct found *queue;
  uint32_t queued, row;
  bool failed;
};

/* --- tables --------------------------------------------------------------------------------------------------------
 */

static bool take(const struct oracle_pair *p, struct flyer *f)
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

static struct point rate_of(struct flyer *f, struct vec3 v)
{
  const struct vec3 d = vec3_scale(f->dt, v);
  if (!(fabs(d.x) < 512.0 && fabs(d.y) < 512.0 && fabs(d.z) < 512.0)) {
    f->failed = true;
    return (struct point){0, 0, 0};
  }
  return (struct point){rounded(f, d.x), rounded(f, d.y), rounded(f, d.z)};
}

static bool begin(struct flyer *f)
{
  f->r = malloc(f->n * sizeof *f->r), f->rate = malloc(f->n * sizeof *f->rate);
  f->origin = malloc(f->n * sizeof *f->origin), f->v = malloc(f->n * sizeof *f->v);
  f->contacts = calloc(f->n, sizeof *f->contacts), f->cluster = calloc(f->n, sizeof *f->cluster);
  f->queue = malloc(MOST_EVENTS * sizeof *f->queue);
  if (!f->r || !f->rate || !f->origin || !f->v || !f->contacts || !f->cluster || !f->queue)
    return false;
  for (uint32_t k = 0; k < f->n; k++) {
    f->r[k] = f->origin[k] = oracle_point(f->from, k), f->v[k] = oracle_vector(f->start, k);
    f->rate[k] = rate_of(f, f->v[k]);
    f->failed |= !point_within_reach(f->r[k]);
  }
  return !f->failed;
}

static void finish(struct flyer *f)
{
  free(f->r), free(f->rate), free(f->origin), free(f->v), free(f->contacts), free(f->cluster), free(f->queue);
}

static int64_t chain_of(const struct flyer *f, int64_t k, uint32_t column)
{
  const int64_t v = k >= 0 && k < f->n ? f->chain->value.integer[3 * k + column] : -1;
  return v < f->n ? v : -1;
}

static int64_t next_of(const struct flyer *f, int64_t k)
{
  return chain_of(f, k, 0);
}

static int64_t prev_of(const struct flyer *f, int64_t k)
{
  return chain_of(f, k, 1);
}

static struct point place_of(const struct flyer *f, int64_t k, int32_t tick)
{
  return flight_place(f->r[k], f->rate[k], tick);
}

static double constant(const struct flyer *f, int64_t k, uint32_t column)
{
  return pack_value(f->vertex, (uint32_t)k, column);
}

/* --- searches ------------------------------------------------------------------------------------------------------
 */

static struct point image_of(const struct flyer *f, struct point p, const int64_t image[3])
{
  const int64_t *e = f->box.edge;
  return (struct point){p.x + image[0] * e[0], p.y + image[1] * e[1], p.z + image[2] * e[2]};
}

static struct flight_pair pair_of(const struct flyer *f, const struct found *e)
{
  const int64_t i = e->bond, j = next_of(f, i), k = e->other, l = next_of(f, k);
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

static void drop_pair(struct flyer *f, const struct found *e)
{
  uint32_t kept = 0;
  for (uint32_t k = 0; k < f->queued; k++)
    if (f->queue[k].bond != e->bond || f->queue[k].other != e->other ||
        memcmp(f->queue[k].image, e->image, sizeof e->image) != 0)
      f->queue[kept++] = f->queue[k];
  f->queued = kept;
}

static void search_pair(struct flyer *f, int64_t bond, int64_t other, const int64_t image[3], int32_t from)
{
  const bool exchange = other < bond;
  const int64_t sign = exchange && f->t->image != IMAGE_KEEPS_SIGN ? -1 : 1;
  struct found e = {0,
                    (uint32_t)(exchange ? other : bond),
                    (uint32_t)(exchange ? bond : other),
                    {sign * image[0], sign * image[1], sign * image[2]}};
  const struct flight_pair pair = pair_of(f, &e);
  e.tick = from < FLIGHT_TICKS ? event_search(f->t, &pair, from) : FLIGHT_TICKS;
  if (e.tick >= FLIGHT_TICKS)
    return;
  if (f->t->again == AGAIN_OLD_STAY)
    drop_pair(f, &e);
  f->failed |= f->queued == MOST_EVENTS;
  if (!f->failed)
    f->queue[f->queued++] = e;
}

static int64_t axis_of(struct point p, int axis)
{
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/* Of the path of a bond from a tick on, along an axis. */
static void range_of(const struct flyer *f, int64_t bond, int32_t tick, int axis, int64_t range[2])
{
  range[0] = INT64_MAX, range[1] = INT64_MIN;
  const int64_t end[2] = {bond, next_of(f, bond)};
  for (int k = 0; k < 4; k++) {
    const int64_t at = axis_of(place_of(f, end[k / 2], k % 2 ? FLIGHT_TICKS : tick), axis);
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
          search_pair(f, bond, other, image, from);
      }
}

static bool shares(const struct flyer *f, int64_t bond, int64_t other)
{
  const int64_t b = next_of(f, bond), d = next_of(f, other);
  return bond == other || bond == d || b == other || b == d;
}

/* Searches bonds that are marked against all others; `marked`: NULL for all. */
static void search(struct flyer *f, const bool *marked, int32_t near, int32_t from)
{
  for (int64_t bond = 0; bond < f->n && !f->failed; bond++)
    for (int64_t other = 0; other < f->n && (!marked || marked[bond]); other++)
      if (next_of(f, bond) >= 0 && next_of(f, other) >= 0 && !shares(f, bond, other) &&
          (other > bond || (marked && !marked[other])))
        search_images(f, bond, other, near, from);
}

static void search_again(struct flyer *f, const bool *vertex, const struct found *e, enum again_rule rule)
{
  bool *dropped = calloc(f->n, sizeof *dropped);
  f->failed |= !dropped;
  for (int64_t k = 0; !f->failed && k < f->n; k++) {
    dropped[k] = vertex[k] || (next_of(f, k) >= 0 && vertex[next_of(f, k)]);
    if (rule == AGAIN_TWO_BONDS)
      dropped[k] = k == e->bond || k == e->other;
    if (rule == AGAIN_FIRST_BOND)
      dropped[k] = k == e->bond || k == prev_of(f, e->bond) || k == next_of(f, e->bond);
  }
  if (!f->failed) {
    if (rule != AGAIN_OLD_STAY)
      drop(f, dropped);
    const int32_t from = rule == AGAIN_FROM_START ? 0 : rule == AGAIN_TICK_LATER ? e->tick + 1 : e->tick;
    if (rule != AGAIN_NOTHING)
      search(f, dropped, from < e->tick ? from : e->tick, from);
    if (rule == AGAIN_NOT_THE_PAIR)
      drop_pair(f, e);
  }
  free(dropped);
}

/* --- a contact -----------------------------------------------------------------------------------------------------
 */

struct bond_there {
  bool there;
  struct vec3 unit, pull;
  double inverse;
};

static struct bond_there bond_at(const struct flyer *f, int64_t first, int64_t last, int32_t tick)
{
  struct bond_there b = {first >= 0 && last >= 0, {0, 0, 0}, {0, 0, 0}, 0.0};
  if (!b.there)
    return b;
  const bool stale = f->t->force == FORCE_OF_START;
  const struct vec3 r = point_difference(stale ? f->origin[last] : place_of(f, last, tick),
                                         stale ? f->origin[first] : place_of(f, first, tick));
  const double length = sqrt(vec3_dot(r, r)), k = constant(f, first, 2), rest = constant(f, first, 1);
  b.inverse = 1.0 / length, b.unit = vec3_scale(b.inverse, r);
  b.pull = rest == 0.0 ? vec3_scale(k, r) : vec3_scale(k * (length - rest), b.unit);
  return b;
}

static void bend_of(double kappa, const struct bond_there *a, const struct bond_there *b, struct vec3 *before,
                    struct vec3 *after)
{
  const double c = vec3_dot(a->unit, b->unit);
  *before = vec3_scale(-kappa * a->inverse, vec3_add_scaled(b->unit, -c, a->unit));
  *after = vec3_scale(kappa * b->inverse, vec3_add_scaled(a->unit, -c, b->unit));
}

static struct vec3 force_on(const struct flyer *f, int64_t v, int32_t tick)
{
  const int64_t prev = prev_of(f, v), next = next_of(f, v);
  const double kappa = constant(f, v, 3);
  const struct bond_there before = bond_at(f, prev, v, tick), after = bond_at(f, v, next, tick);
  struct vec3 force = {constant(f, v, 4), constant(f, v, 5), constant(f, v, 6)}, a, b;
  if (f->t->force == FORCE_NOT_CONSTANT)
    force = (struct vec3){0, 0, 0};
  if (f->t->force != FORCE_BENDS_ONLY)
    force = vec3_add(vec3_sub(force, before.pull), after.pull);
  if (kappa == 0.0 || f->t->force == FORCE_BONDS_ONLY)
    return force;
  const struct bond_there far = bond_at(f, prev < 0 ? -1 : prev_of(f, prev), prev, tick),
                          beyond = bond_at(f, next, next < 0 ? -1 : next_of(f, next), tick);
  if (before.there && far.there) {
    bend_of(kappa, &far, &before, &a, &b);
    force = vec3_add(force, b);
  }
  if (before.there && after.there) {
    bend_of(kappa, &before, &after, &a, &b);
    force = vec3_sub(force, vec3_add(a, b));
  }
  if (after.there && beyond.there) {
    bend_of(kappa, &after, &beyond, &a, &b);
    force = vec3_add(force, a);
  }
  return force;
}

static double volume_at(const struct flight_pair *f, int32_t tick)
{
  const struct point p = flight_place(f->p, f->p_rate, tick), q = flight_place(f->q, f->q_rate, tick),
                     w = flight_place(f->w, f->w_rate, tick);
  return determinant((struct difference){p.x, p.y, p.z}, (struct difference){q.x, q.y, q.z},
                     (struct difference){w.x, w.y, w.z});
}

static struct vec3 normal_of(const struct flyer *f, double volume, struct vec3 p, struct vec3 q, struct vec3 gap,
                             struct vec3 velocity)
{
  const enum push_rule rule = f->t->push;
  struct vec3 n = vec3_cross(p, q);
  bool parallel = !(vec3_dot(n, n) > 1e-24 * vec3_dot(p, p) * vec3_dot(q, q)) || rule == PUSH_GAP;
  double approach = vec3_dot(n, velocity);
  if (rule == PUSH_UNTURNED      ? false
      : rule == PUSH_BY_APPROACH ? approach < 0.0
                                 : volume < 0.0 || (volume == 0.0 && approach < 0.0))
    n = vec3_scale(-1.0, n), approach = -approach;
  if ((parallel || (volume == 0.0 && !(approach > 0.0))) && rule != PUSH_NO_GAP) {
    n = gap;
    if (!(vec3_dot(n, n) > 0.0))
      n = vec3_add_scaled(velocity, -vec3_dot(velocity, q) / vec3_dot(q, q), q);
  }
  return vec3_scale((rule == PUSH_TURNED ? -1.0 : 1.0) / vec3_norm(n), n);
}

struct touch {
  int64_t four[4];
  struct oracle_impulse e;
  bool touching;
};

static void describe(const struct flyer *f, const struct found *e, struct touch *c)
{
  const struct flight_pair pair = pair_of(f, e);
  const int32_t tick = f->t->push == PUSH_OF_START ? 0 : e->tick;
  const struct point origin = {0, 0, 0};
  const struct vec3 p = point_difference(flight_place(pair.p, pair.p_rate, tick), origin),
                    q = point_difference(flight_place(pair.q, pair.q_rate, tick), origin),
                    w = point_difference(flight_place(pair.w, pair.w_rate, tick), origin);
  *c = (struct touch){.four = {e->bond, next_of(f, e->bond), e->other, next_of(f, e->other)}};
  capsule_closest(p, q, w, &c->e.s, &c->e.t);
  const double lever[4] = {1.0 - c->e.s, c->e.s, c->e.t - 1.0, -c->e.t}, volume = volume_at(&pair, tick);
  struct vec3 velocity = {0, 0, 0};
  for (int k = 0; k < 4; k++) {
    c->e.velocity[k] = f->v[c->four[k]];
    c->e.force[k] = force_on(f, c->four[k], e->tick);
    c->e.mass[k] = constant(f, c->four[k], 0);
    velocity = vec3_add_scaled(velocity, lever[k], c->e.velocity[k]);
  }
  const struct vec3 gap = capsule_between(p, q, w, c->e.s, c->e.t);
  c->touching = volume == 0.0 && vec3_norm(gap) < 0.25 * LATTICE_UNIT && !f->t->touching_answered;
  c->e.normal = normal_of(f, volume, p, q, gap, velocity);
  const double share = (double)e->tick / FLIGHT_TICKS;
  c->e.tau = f->t->tau == TAU_OF_START ? f->dt * share
             : f->t->tau == TAU_OF_END ? f->dt * share - f->dt
                                       : f->begin + f->dt * share;
}

/* --- answers -------------------------------------------------------------------------------------------------------
 */

static void steer(struct flyer *f, int64_t v, struct point rate, int32_t tick)
{
  const struct point here = place_of(f, v, tick);
  f->rate[v] = rate;
  if (!f->t->not_tied)
    f->r[v] = flight_place(here, rate, -(int64_t)tick);
}

static int64_t quarter(const struct flyer *f, int64_t sum)
{
  return f->t->mean_down && sum % 4 < 0 ? sum / 4 - 1 : sum / 4;
}

static void make_rigid(struct flyer *f, const struct touch *c, const struct found *e)
{
  bool *vertex = calloc(f->n, sizeof *vertex);
  struct point sum = {0, 0, 0}, rate = {0, 0, 0};
  uint32_t of = 0;
  f->failed |= !vertex;
  for (int k = 0; k < 4; k++) {
    sum = point_plus(sum, f->rate[c->four[k]]);
    if (f->cluster[c->four[k]] && !of)
      of = f->cluster[c->four[k]], rate = f->rate[c->four[k]];
  }
  if (!of)
    of = ++f->clusters, rate = (struct point){quarter(f, sum.x), quarter(f, sum.y), quarter(f, sum.z)};
  for (int k = 0; !f->failed && k < 4; k++) {
    const uint32_t old = f->cluster[c->four[k]];
    for (uint32_t v = 0; v < f->n; v++)
      if (v == c->four[k] || (old && f->cluster[v] == old))
        f->cluster[v] = of, vertex[v] = true;
  }
  for (uint32_t v = 0; !f->failed && v < f->n; v++)
    if (vertex[v])
      steer(f, v, rate, e->tick);
  const enum again_rule rule = f->t->again;
  const bool of_pairs = rule == AGAIN_TWO_BONDS || rule == AGAIN_FIRST_BOND || rule == AGAIN_NOT_THE_PAIR;
  if (!f->failed)
    search_again(f, vertex, e, of_pairs ? AGAIN_RIGHT : rule);
  free(vertex);
}

static bool is_near(const struct flyer *f, double theirs, double guess)
{
  return fabs(theirs - guess) <= f->tolerance * fmax(1.0, fabs(guess));
}

/* Their next row is this contact. */
static bool is_row(struct flyer *f, const struct found *e, const struct touch *c, double impulse)
{
  const double sign = f->t->image == IMAGE_REPORTED_TURNED ? -1.0 : 1.0;
  const double event[6] = {
      e->bond, e->other, sign * (double)e->image[0], sign * (double)e->image[1], sign * (double)e->image[2], e->tick};
  const double hit[6] = {c->e.s, c->e.t, c->e.normal.x, c->e.normal.y, c->e.normal.z, impulse};
  bool same = f->row < f->event->rows;
  for (uint32_t k = 0; same && k < 6; k++)
    same = pack_value(f->event, f->row, k) == event[k] && is_near(f, pack_value(f->hit, f->row, k), hit[k]);
  f->row++;
  return same;
}

static bool is_exhausted(const struct flyer *f, const struct touch *c)
{
  for (int k = 0; k < 4; k++)
    if (f->cluster[c->four[k]] || f->contacts[c->four[k]] >= MOST_CONTACTS)
      return true;
  return false;
}

/* False if theirs is not this one. */
static bool answer(struct flyer *f, const struct found *e)
{
  struct touch c;
  enum contact_answer kind = CONTACT_NONE;
  describe(f, e, &c);
  if (c.touching) {
    drop_pair(f, e);
    search_pair(f, e->bond, e->other, e->image, e->tick + 1);
    return true;
  }
  const double impulse = is_exhausted(f, &c) ? 0.0 : event_impulse(f->t, &c.e, &kind);
  if (kind == CONTACT_NONE) {
    if (f->t->no_clusters)
      drop_pair(f, e);
    else
      make_rigid(f, &c, e);
    return true;
  }
  if (!is_row(f, e, &c, impulse))
    return false;
  bool *vertex = calloc(f->n, sizeof *vertex);
  f->failed |= !vertex;
  for (int k = 0; vertex && k < 4; k++) {
    f->v[c.four[k]] = c.e.velocity[k];
    f->contacts[c.four[k]]++, vertex[c.four[k]] = true;
    if (f->t->rate != RATE_STALE)
      steer(f, c.four[k], rate_of(f, c.e.velocity[k]), e->tick);
  }
  if (!f->failed)
    search_again(f, vertex, e, f->t->again);
  free(vertex);
  return true;
}

static bool comes_before(const struct event_twist *t, const struct found *a, const struct found *b)
{
  const int64_t sign = t->turn == TURN_LARGER_FIRST ? -1 : 1;
  int64_t key[2][6];
  const struct found *const both[2] = {a, b};
  for (int k = 0; k < 2; k++) {
    const struct found *e = both[k];
    const int64_t right[6] = {
        e->tick, sign * e->bond, sign * e->other, sign * e->image[0], sign * e->image[1], sign * e->image[2]};
    const int64_t number[6] = {e->bond, e->other, e->image[0], e->image[1], e->image[2], e->tick};
    const int64_t image[6] = {e->tick, e->image[0], e->image[1], e->image[2], e->bond, e->other};
    memcpy(key[k], t->turn == TURN_BY_NUMBER ? number : t->turn == TURN_BY_IMAGE_FIRST ? image : right, sizeof right);
  }
  for (int k = 0; k < 6; k++)
    if (key[0][k] != key[1][k])
      return key[0][k] < key[1][k];
  return false;
}

static bool take_first(struct flyer *f, struct found *e)
{
  uint32_t best = 0;
  if (f->queued == 0)
    return false;
  for (uint32_t k = 1; k < f->queued; k++)
    if (comes_before(f->t, &f->queue[k], &f->queue[best]))
      best = k;
  *e = f->queue[best];
  f->queue[best] = f->queue[--f->queued];
  return true;
}

static bool fly(struct flyer *f)
{
  struct found e;
  search(f, NULL, 0, 0);
  for (uint32_t k = 0; !f->failed && take_first(f, &e); k++)
    if (k >= MOST_EVENTS || !answer(f, &e))
      return false;
  return !f->failed && f->row == f->event->rows;
}

static bool ends_there(const struct flyer *f)
{
  const double room = f->tolerance > 0x1p-30 ? f->tolerance * LATTICE_PER_A0 : 0.0;
  for (uint32_t k = 0; k < f->n; k++)
    for (uint32_t c = 0; c < 3; c++)
      if (!(fabs(pack_value(f->to, k, c) - (double)axis_of(place_of(f, k, FLIGHT_TICKS), (int)c)) <= room) ||
          !is_near(f, pack_value(f->end, k, c), oracle_component(f->v[k], c)))
        return false;
  return f->to->rows == f->n && f->end->rows == f->n;
}

static bool makes_theirs(const struct oracle_pair *p, const struct event_twist *t, double tolerance)
{
  struct flyer f;
  if (!take(p, &f))
    return false;
  f.t = t, f.tolerance = tolerance;
  const bool same = begin(&f) && fly(&f) && ends_there(&f);
  finish(&f);
  return same;
}

/* All steps that both have. */
static bool makes_all(const struct oracle_pair *p, const struct event_twist *t, double tolerance)
{
  bool any = false;
  for (size_t k = 0; k < p->pack->count; k++) {
    const struct pack_table *ours = &p->pack->table[k];
    const struct pack_table *theirs = pack_find(p->pack_theirs, &ours->place, ours->name);
    if (strcmp(ours->place.operator_name, p->ours->place.operator_name) != 0 || strcmp(ours->name, "out.event") != 0 ||
        !theirs)
      continue;
    const struct oracle_pair pair = {p->pack, p->pack_theirs, ours, theirs, p->rounding};
    if (!makes_theirs(&pair, t, tolerance))
      return false;
    any = true;
  }
  return any;
}

static bool name_guesses(const struct oracle_pair *p, double tolerance, char text[ORACLE_TEXT])
{
  const struct event_twist *const lists[] = {event_drift_twists, event_search_twists, event_impulse_twists};
  bool named = false;
  for (int list = 0; list < 3; list++)
    for (const struct event_twist *t = lists[list]; t->text; t++)
      if (makes_all(p, t, tolerance))
        oracle_name(text, &named, t->text);
  return named;
}

bool oracle_replay_events(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  static const double tolerances[] = {0x1p-40, 0x1p-26};
  static const struct event_twist right = {.text = NULL};
  for (int pass = 0; pass < 2; pass++)
    if (makes_all(p, &right, tolerances[pass]) || name_guesses(p, tolerances[pass], text))
      return !makes_all(p, &right, tolerances[pass]);
  return false;
}
