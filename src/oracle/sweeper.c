#include "oracle/sweeper.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/single.h"

/* --- tables ------------------------------------------------------------------------------------------------------- */

bool sweeper_take(const struct oracle_pair *p, struct sweeper *s)
{
  *s =
      (struct sweeper){.pair = p,
                       .order = oracle_sibling(p, "in.order"),
                       .from = oracle_sibling(p, "in.position"),
                       .start = oracle_sibling(p, "in.velocity"),
                       .chain = oracle_model(p, "in.chain"),
                       .vertex = oracle_model(p, "in.vertex"),
                       .event = oracle_sibling_of_theirs(p, "out.event"),
                       .hit = oracle_sibling_of_theirs(p, "out.hit"),
                       .to = oracle_sibling_of_theirs(p, "out.position"),
                       .end = oracle_sibling_of_theirs(p, "out.velocity"),
                       .time = pack_value(oracle_sibling(p, "in.time") ? oracle_sibling(p, "in.time") : p->ours, 0, 0)};
  s->n = s->from ? s->from->rows : 0;
  s->forbidden = oracle_model_integer(p, "in.numbers", 0, 4) != 0;
  s->paper = oracle_model_integer(p, "in.numbers", 0, 5) != 0;
  return s->n > 0 && oracle_sibling(p, "in.time") && s->order && s->order->rows == s->n && s->chain && s->vertex &&
         s->chain->rows == s->n && s->vertex->rows == s->n && s->event && s->hit && s->event->columns == 7 &&
         s->hit->columns == 7 && s->event->rows == s->hit->rows && oracle_box(p, &s->box) &&
         oracle_is_vectors(s->from, false, s->n - 1) && oracle_is_vectors(s->start, true, s->n - 1) && s->to &&
         s->end && s->to->columns == 3 && s->end->columns == 3;
}

bool sweeper_begin(struct sweeper *s)
{
  s->cursor = 0;
  s->r = malloc(s->n * sizeof *s->r), s->v = malloc(s->n * sizeof *s->v);
  for (uint32_t k = 0; s->r && s->v && k < s->n; k++)
    s->r[k] = oracle_point(s->from, k), s->v[k] = oracle_vector(s->start, k);
  return s->r && s->v;
}

void sweeper_finish(struct sweeper *s)
{
  free(s->r);
  free(s->v);
}

int64_t sweeper_next(const struct sweeper *s, int64_t k)
{
  return k >= 0 && k < s->n ? s->chain->value.integer[3 * k] : -1;
}

static int64_t sweeper_prev(const struct sweeper *s, int64_t k)
{
  return k >= 0 && k < s->n ? s->chain->value.integer[3 * k + 1] : -1;
}

double sweeper_mass(const struct sweeper *s, uint32_t k)
{
  return pack_value(s->vertex, k, 0);
}

/* --- which bonds, which images ------------------------------------------------------------------------------------ */

bool sweeper_shares(const struct sweeper *s, int64_t bond, int64_t other)
{
  const int64_t a = bond, b = sweeper_next(s, bond), c = other, d = sweeper_next(s, other);
  return a == c || a == d || b == c || b == d;
}

static bool is_excluded(const struct sweeper *s, uint32_t vertex, int64_t moving, int64_t standing)
{
  const enum exclusion_rule rule = s->t->exclusion;
  const bool paper = rule == EXCLUSION_ALWAYS_PAPER || (s->paper && rule != EXCLUSION_NEVER_PAPER);
  if (rule == EXCLUSION_FIBER)
    return pack_value(s->chain, (uint32_t)standing, 2) == pack_value(s->chain, vertex, 2);
  if (rule == EXCLUSION_NONE)
    return standing == moving;
  if (rule == EXCLUSION_MOVER)
    return standing == vertex || sweeper_next(s, standing) == vertex;
  if (!paper)
    return sweeper_shares(s, moving, standing);
  const int64_t prev = sweeper_prev(s, vertex);
  return (prev >= 0 && sweeper_shares(s, prev, standing)) ||
         (sweeper_next(s, vertex) >= 0 && sweeper_shares(s, vertex, standing));
}

static bool is_partner(const struct sweeper *s, uint32_t vertex, int64_t moving, int64_t standing)
{
  const enum partner_rule rule = s->t->partners;
  bool last = true, first = true;
  for (int64_t k = standing + 1; k < s->n && last; k++)
    last = sweeper_next(s, k) < 0;
  for (int64_t k = standing - 1; k >= 0 && first; k--)
    first = sweeper_next(s, k) < 0;
  return sweeper_next(s, standing) >= 0 && !is_excluded(s, vertex, moving, standing) &&
         !(rule == PARTNERS_LARGER && standing <= moving) && !(rule == PARTNERS_SMALLER && standing >= moving) &&
         !(rule == PARTNERS_VERTEX_LARGER && standing <= (int64_t)vertex) &&
         !(rule == PARTNERS_VERTEX_SMALLER && standing >= (int64_t)vertex) && !(rule == PARTNERS_NO_LAST && last) &&
         !(rule == PARTNERS_NO_FIRST && first) &&
         !(rule == PARTNERS_NO_CLOSING && sweeper_next(s, standing) < standing);
}

static int64_t least(int64_t a, int64_t b)
{
  return a < b ? a : b;
}

static int64_t most(int64_t a, int64_t b)
{
  return a > b ? a : b;
}

/* Images of a bond that may reach the triangle. False if there is none, or too many to be true. */
static bool image_range(const struct sweeper *s, const struct contact_points *r, int64_t low[3], int64_t high[3])
{
  for (int k = 0; k < 3; k++) {
    const int64_t from = sweeper_coordinate(r->from, k), to = sweeper_coordinate(r->to, k),
                  pivot = sweeper_coordinate(r->pivot, k);
    const int64_t a = sweeper_coordinate(r->a, k), b = sweeper_coordinate(r->b, k), edge = s->box.edge[k];
    low[k] = -lattice_image(most(a, b) - least(least(from, to), pivot), edge);
    high[k] = lattice_image(most(most(from, to), pivot) - (s->t->short_images ? most(a, b) : least(a, b)), edge);
    if (low[k] > high[k] || low[k] < -FAR || high[k] > FAR)
      return false;
  }
  return true;
}

static bool takes_image(const struct sweep_twist *t, const int64_t image[3])
{
  int64_t size = 0, farthest = 0;
  for (int k = 0; k < 3; k++) {
    const int64_t away = image[k] < 0 ? -image[k] : image[k];
    size += away;
    farthest = most(farthest, away);
    if ((t->above_only && image[k] < 0) || (t->below_only && image[k] > 0) || (t->no_axis == k + 1 && image[k] != 0) ||
        (t->near_axis == k + 1 && away > 1))
      return false;
  }
  return !(t->images == 1 && size > 0) && !(t->images == 2 && farthest > 1) && !(t->one_axis && size > 1);
}

struct point sweeper_moved(const struct sweeper *s, struct point p, const int64_t image[3])
{
  const int64_t sign = s->t->negated ? -1 : 1;
  const int64_t *e = s->box.edge;
  const int by = s->t->edge_of;
  return (struct point){p.x + sign * image[0] * e[by ? by - 1 : 0], p.y + sign * image[1] * e[by ? by - 1 : 1],
                        p.z + sign * image[2] * e[by ? by - 1 : 2]};
}

/* --- the hits of a move ------------------------------------------------------------------------------------------- */

static bool is_before(const struct sweep_twist *t, const struct swept_hit *a, const struct swept_hit *b)
{
  const enum choice_rule c = t->choice;
  double key[2][6];
  const struct swept_hit *const h[2] = {a, b};
  for (int k = 0; k < 2; k++) {
    const double sign = c == CHOICE_TIE_LARGER ? -1.0 : 1.0;
    const double row[6] = {c == CHOICE_LAST       ? -h[k]->hit.time
                           : c == CHOICE_NEAREST  ? h[k]->hit.s
                           : c == CHOICE_FARTHEST ? -h[k]->hit.s
                           : c == CHOICE_NUMBER   ? 0.0
                                                  : h[k]->hit.time,
                           c == CHOICE_TIE_STANDING ? h[k]->standing : sign * h[k]->moving,
                           c == CHOICE_TIE_STANDING ? h[k]->moving : sign * h[k]->standing,
                           (c == CHOICE_TIE_IMAGE ? -1.0 : 1.0) * (double)h[k]->image[0],
                           (c == CHOICE_TIE_IMAGE ? -1.0 : 1.0) * (double)h[k]->image[1],
                           (c == CHOICE_TIE_IMAGE ? -1.0 : 1.0) * (double)h[k]->image[2]};
    memcpy(key[k], row, sizeof row);
  }
  for (int k = 0; k < 6; k++)
    if (key[0][k] != key[1][k])
      return key[0][k] < key[1][k];
  return false;
}

static void insert(const struct sweep_twist *t, struct swept_hit *hits, uint32_t count)
{
  for (uint32_t k = count - 1; k > 0 && is_before(t, &hits[k], &hits[k - 1]); k--) {
    const struct swept_hit kept = hits[k];
    hits[k] = hits[k - 1];
    hits[k - 1] = kept;
  }
}

static void test_images(const struct sweeper *s, struct swept_hit *blank, struct swept_hit *hits, uint32_t *count)
{
  const struct contact_points seen = blank->points;
  int64_t low[3], high[3];
  if (!image_range(s, &seen, low, high))
    return;
  for (int64_t i = low[0]; i <= high[0]; i++)
    for (int64_t j = low[1]; j <= high[1]; j++)
      for (int64_t k = low[2]; k <= high[2]; k++) {
        const int64_t image[3] = {i, j, k};
        struct swept_hit h = *blank;
        if (!takes_image(s->t, image) || *count == MOST_HITS)
          continue;
        h.points.a = sweeper_moved(s, seen.a, image), h.points.b = sweeper_moved(s, seen.b, image);
        if (!contact_crosses(&s->t->contact, &h.points))
          continue;
        memcpy(h.image, image, sizeof image);
        h.hit = contact_describe(&s->t->contact, &h.points);
        hits[(*count)++] = h;
        insert(s->t, hits, *count);
      }
}

uint32_t sweeper_hits(const struct sweeper *s, uint32_t vertex, struct point end, struct swept_hit *hits)
{
  uint32_t count = 0;
  for (int side = 0; s->forbidden && side < 2; side++) {
    const int64_t moving = side == 0 ? sweeper_prev(s, vertex) : vertex;
    const int64_t pivot = side == 0 ? moving : sweeper_next(s, vertex);
    if (pivot < 0 || (s->t->bonds == BONDS_NEXT && side == 0) || (s->t->bonds == BONDS_BEFORE && side == 1))
      continue;
    bool skipped = false;
    for (int64_t j = 0; j < s->n; j++) {
      if (sweeper_next(s, j) < 0 || !is_partner(s, vertex, moving, j))
        continue;
      const struct point *r = s->r;
      int64_t low[3], high[3];
      const struct contact_points near = {r[vertex], end, r[pivot], r[j], r[sweeper_next(s, j)], false};
      if (s->t->skips_first && !skipped && image_range(s, &near, low, high)) {
        skipped = true;
        continue;
      }
      struct point a = r[j], b = r[sweeper_next(s, j)];
      if (s->t->stale_positions)
        a = oracle_point(s->from, (uint32_t)j), b = oracle_point(s->from, (uint32_t)sweeper_next(s, j));
      struct swept_hit blank = {.moving = (uint32_t)moving,
                                .standing = (uint32_t)j,
                                .four = {vertex, (uint32_t)pivot, (uint32_t)j, (uint32_t)sweeper_next(s, j)},
                                .points = {r[vertex], end, r[pivot], a, b, side == 1}};
      test_images(s, &blank, hits, &count);
    }
  }
  return count;
}

/* --- moves -------------------------------------------------------------------------------------------------------- */

static int64_t rounded(enum trial_rule rule, double a0)
{
  const double x = (rule == TRIAL_SINGLE ? single_of(a0) : a0) * LATTICE_PER_A0;
  return (int64_t)(rule == TRIAL_CUT ? trunc(x) : rule == TRIAL_DOWN ? floor(x) : rule == TRIAL_UP ? ceil(x) : rint(x));
}

/* False if it is further than anything that a port would move. */
bool sweeper_trial(const struct sweeper *s, uint32_t vertex, struct point *end)
{
  const struct vec3 v = s->t->stale_velocities ? oracle_vector(s->start, vertex) : s->v[vertex];
  const struct vec3 d = vec3_scale((1.0 + s->t->time) * s->time, v);
  if (!(fabs(d.x) < 1024.0 && fabs(d.y) < 1024.0 && fabs(d.z) < 1024.0) || !point_within_reach(s->r[vertex]))
    return false;
  *end = (struct point){s->r[vertex].x + rounded(s->t->trial, d.x), s->r[vertex].y + rounded(s->t->trial, d.y),
                        s->r[vertex].z + rounded(s->t->trial, d.z)};
  return true;
}

void sweeper_exchange(struct sweeper *s, struct swept_hit *h)
{
  double mass[4];
  struct vec3 v[4];
  const int64_t after = sweeper_next(s, h->four[0]), before = sweeper_prev(s, h->four[0]);
  if (s->t->pivot != PIVOT_RIGHT && after >= 0 && before >= 0)
    h->four[1] = (uint32_t)(s->t->pivot == PIVOT_NEXT ? after : before);
  for (int k = 0; k < 4; k++)
    mass[k] = sweeper_mass(s, h->four[k]), v[k] = s->v[h->four[k]];
  h->impulse = contact_exchange(&s->t->contact, &h->hit, mass, v);
  for (int k = 0; k < 4; k++)
    s->v[h->four[k]] = v[k];
}

bool sweeper_is_near(const struct sweeper *s, double theirs, double guess)
{
  return fabs(theirs - guess) <= s->tolerance * fmax(1.0, fabs(guess));
}

bool sweeper_is_row(const struct sweeper *s, uint32_t row, uint32_t vertex, const struct swept_hit *h)
{
  const double sign = s->t->report_negated ? -1.0 : 1.0;
  const double event[6] = {vertex,
                           h->moving,
                           h->standing,
                           sign * (double)h->image[0],
                           sign * (double)h->image[1],
                           sign * (double)h->image[2]};
  for (uint32_t k = 0; k < 6; k++)
    if (pack_value(s->event, row, k) != event[k])
      return false;
  return true;
}

uint32_t sweeper_rows(const struct sweeper *s, uint32_t vertex)
{
  uint32_t n = 0;
  while (s->cursor + n < s->event->rows && pack_value(s->event, s->cursor + n, 0) == vertex)
    n++;
  return n;
}

uint32_t sweeper_vertex(const struct sweeper *s, uint32_t turn)
{
  uint32_t k = 0;
  switch (s->t->order) {
  case ORDER_NUMBERS:
    return turn;
  case ORDER_BACKWARDS:
    return (uint32_t)pack_value(s->order, s->n - 1 - turn, 0);
  case ORDER_INVERSE:
    while (k < s->n && pack_value(s->order, k, 0) != turn)
      k++;
    return k;
  default:
    return (uint32_t)pack_value(s->order, turn, 0);
  }
}
