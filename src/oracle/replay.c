#include "oracle/replay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "contact/line.h"
#include "oracle/contact_model.h"
#include "oracle/patterns.h"
#include "oracle/rows.h"
#include "oracle/single.h"

#define MOST_HITS 64
#define FAR 64 /* images */

enum order_rule { ORDER_GIVEN, ORDER_NUMBERS, ORDER_BACKWARDS, ORDER_INVERSE };
enum trial_rule { TRIAL_NEAREST, TRIAL_CUT, TRIAL_DOWN, TRIAL_UP, TRIAL_SINGLE };
enum exclusion_rule {
  EXCLUSION_RIGHT,
  EXCLUSION_ALWAYS_PAPER,
  EXCLUSION_NEVER_PAPER,
  EXCLUSION_NONE,
  EXCLUSION_FIBER,
  EXCLUSION_MOVER
};
enum partner_rule {
  PARTNERS_ALL,
  PARTNERS_LARGER,
  PARTNERS_SMALLER,
  PARTNERS_NO_LAST,
  PARTNERS_NO_FIRST,
  PARTNERS_NO_CLOSING,
  PARTNERS_VERTEX_LARGER,
  PARTNERS_VERTEX_SMALLER
};
enum bond_rule { BONDS_BOTH, BONDS_NEXT, BONDS_BEFORE };
enum choice_rule {
  CHOICE_FIRST,
  CHOICE_LAST,
  CHOICE_NEAREST,
  CHOICE_FARTHEST,
  CHOICE_NUMBER,
  CHOICE_TIE_LARGER,
  CHOICE_TIE_STANDING,
  CHOICE_TIE_IMAGE,
  CHOICE_END,
  CHOICE_ALL,
  CHOICE_NONE
};
enum pivot_rule { PIVOT_RIGHT, PIVOT_NEXT, PIVOT_BEFORE };

/* Zeros: as it should be. */
struct sweep_twist {
  enum order_rule order;
  enum trial_rule trial;
  double time; /* times, less 1 */
  bool rejected_moves, to_contact, stale_velocities, stale_positions;
  bool moves_after, stops, turns_back, last_stays, first_stays, unmarked, short_images, skips_first;
  enum pivot_rule pivot;
  int images; /* 1: none; 2: one box around; else any */
  bool above_only, below_only, one_axis, negated, report_negated;
  int no_axis, edge_of; /* 1 + axis */
  enum exclusion_rule exclusion;
  enum partner_rule partners;
  enum bond_rule bonds;
  enum choice_rule choice;
  struct contact_twist contact;
  const char *text;
};

struct swept_hit {
  uint32_t moving, standing, four[4];
  int64_t image[3];
  struct contact_hit hit;
  struct contact_points points;
  bool executed;
  double impulse;
};

struct sweeper {
  const struct oracle_pair *pair;
  const struct sweep_twist *t;
  const struct pack_table *order, *from, *start, *chain, *vertex, *event, *hit, *to, *end;
  struct box box;
  double time;
  bool forbidden, paper;
  uint32_t n;
  struct point *r;
  struct vec3 *v;
  uint32_t cursor; /* of their events */
  double tolerance;
};

/* --- tables ------------------------------------------------------------------------------------------------------- */

static bool take(const struct oracle_pair *p, struct sweeper *s)
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

static bool begin(struct sweeper *s)
{
  s->cursor = 0;
  s->r = malloc(s->n * sizeof *s->r), s->v = malloc(s->n * sizeof *s->v);
  for (uint32_t k = 0; s->r && s->v && k < s->n; k++)
    s->r[k] = oracle_point(s->from, k), s->v[k] = oracle_vector(s->start, k);
  return s->r && s->v;
}

static void finish(struct sweeper *s)
{
  free(s->r);
  free(s->v);
}

static int64_t next_of(const struct sweeper *s, int64_t k)
{
  return k >= 0 && k < s->n ? s->chain->value.integer[3 * k] : -1;
}

static int64_t prev_of(const struct sweeper *s, int64_t k)
{
  return k >= 0 && k < s->n ? s->chain->value.integer[3 * k + 1] : -1;
}

static double mass_of(const struct sweeper *s, uint32_t k)
{
  return pack_value(s->vertex, k, 0);
}

/* --- which bonds, which images ------------------------------------------------------------------------------------ */

static bool shares(const struct sweeper *s, int64_t bond, int64_t other)
{
  const int64_t a = bond, b = next_of(s, bond), c = other, d = next_of(s, other);
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
    return standing == vertex || next_of(s, standing) == vertex;
  if (!paper)
    return shares(s, moving, standing);
  const int64_t prev = prev_of(s, vertex);
  return (prev >= 0 && shares(s, prev, standing)) || (next_of(s, vertex) >= 0 && shares(s, vertex, standing));
}

static bool is_partner(const struct sweeper *s, uint32_t vertex, int64_t moving, int64_t standing)
{
  const enum partner_rule rule = s->t->partners;
  bool last = true, first = true;
  for (int64_t k = standing + 1; k < s->n && last; k++)
    last = next_of(s, k) < 0;
  for (int64_t k = standing - 1; k >= 0 && first; k--)
    first = next_of(s, k) < 0;
  return next_of(s, standing) >= 0 && !is_excluded(s, vertex, moving, standing) &&
         !(rule == PARTNERS_LARGER && standing <= moving) && !(rule == PARTNERS_SMALLER && standing >= moving) &&
         !(rule == PARTNERS_VERTEX_LARGER && standing <= (int64_t)vertex) &&
         !(rule == PARTNERS_VERTEX_SMALLER && standing >= (int64_t)vertex) &&
         !(rule == PARTNERS_NO_LAST && last) && !(rule == PARTNERS_NO_FIRST && first) &&
         !(rule == PARTNERS_NO_CLOSING && next_of(s, standing) < standing);
}

static int64_t coordinate(struct point p, int axis)
{
  return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
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
    const int64_t from = coordinate(r->from, k), to = coordinate(r->to, k), pivot = coordinate(r->pivot, k);
    const int64_t a = coordinate(r->a, k), b = coordinate(r->b, k), edge = s->box.edge[k];
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
    if ((t->above_only && image[k] < 0) || (t->below_only && image[k] > 0) || (t->no_axis == k + 1 && image[k] != 0))
      return false;
  }
  return !(t->images == 1 && size > 0) && !(t->images == 2 && farthest > 1) && !(t->one_axis && size > 1);
}

static struct point moved_by(const struct sweeper *s, struct point p, const int64_t image[3])
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
                           : c == CHOICE_END      ? h[k]->hit.time
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
        h.points.a = moved_by(s, seen.a, image), h.points.b = moved_by(s, seen.b, image);
        if (!contact_crosses(&s->t->contact, &h.points))
          continue;
        memcpy(h.image, image, sizeof image);
        h.hit = contact_describe(&s->t->contact, &h.points);
        hits[(*count)++] = h;
        insert(s->t, hits, *count);
      }
}

static uint32_t find_hits(const struct sweeper *s, uint32_t vertex, struct point end, struct swept_hit *hits)
{
  uint32_t count = 0;
  for (int side = 0; s->forbidden && side < 2; side++) {
    const int64_t moving = side == 0 ? prev_of(s, vertex) : vertex;
    const int64_t pivot = side == 0 ? moving : next_of(s, vertex);
    if (pivot < 0 || (s->t->bonds == BONDS_NEXT && side == 0) || (s->t->bonds == BONDS_BEFORE && side == 1))
      continue;
    bool skipped = false;
    for (int64_t j = 0; j < s->n; j++) {
      if (next_of(s, j) < 0 || !is_partner(s, vertex, moving, j))
        continue;
      const struct point *r = s->r;
      int64_t low[3], high[3];
      const struct contact_points near = {r[vertex], end, r[pivot], r[j], r[next_of(s, j)], false};
      if (s->t->skips_first && !skipped && image_range(s, &near, low, high)) {
        skipped = true;
        continue;
      }
      struct point a = r[j], b = r[next_of(s, j)];
      if (s->t->stale_positions)
        a = oracle_point(s->from, (uint32_t)j), b = oracle_point(s->from, (uint32_t)next_of(s, j));
      struct swept_hit blank = {.moving = (uint32_t)moving,
                                .standing = (uint32_t)j,
                                .four = {vertex, (uint32_t)pivot, (uint32_t)j, (uint32_t)next_of(s, j)},
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
static bool trial_point(const struct sweeper *s, uint32_t vertex, struct point *end)
{
  const struct vec3 v = s->t->stale_velocities ? oracle_vector(s->start, vertex) : s->v[vertex];
  const struct vec3 d = vec3_scale((1.0 + s->t->time) * s->time, v);
  if (!(fabs(d.x) < 1024.0 && fabs(d.y) < 1024.0 && fabs(d.z) < 1024.0) || !point_within_reach(s->r[vertex]))
    return false;
  *end = (struct point){s->r[vertex].x + rounded(s->t->trial, d.x), s->r[vertex].y + rounded(s->t->trial, d.y),
                        s->r[vertex].z + rounded(s->t->trial, d.z)};
  return true;
}

static void exchange(struct sweeper *s, struct swept_hit *h)
{
  double mass[4];
  struct vec3 v[4];
  const int64_t after = next_of(s, h->four[0]), before = prev_of(s, h->four[0]);
  if (s->t->pivot != PIVOT_RIGHT && after >= 0 && before >= 0)
    h->four[1] = (uint32_t)(s->t->pivot == PIVOT_NEXT ? after : before);
  for (int k = 0; k < 4; k++)
    mass[k] = mass_of(s, h->four[k]), v[k] = s->v[h->four[k]];
  h->impulse = contact_exchange(&s->t->contact, &h->hit, mass, v);
  for (int k = 0; k < 4; k++)
    s->v[h->four[k]] = v[k];
}

static bool is_near(const struct sweeper *s, double theirs, double guess)
{
  return fabs(theirs - guess) <= s->tolerance * fmax(1.0, fabs(guess));
}

static bool is_row(const struct sweeper *s, uint32_t row, uint32_t vertex, const struct swept_hit *h)
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

static bool row_is_near(const struct sweeper *s, uint32_t row, const struct swept_hit *h)
{
  const double value[7] = {h->hit.time,     h->hit.s,        h->hit.s_standing, h->hit.normal.x,
                           h->hit.normal.y, h->hit.normal.z, h->impulse};
  for (uint32_t k = 0; k < 7; k++)
    if (!is_near(s, pack_value(s->hit, row, k), value[k]))
      return false;
  return (pack_value(s->event, row, 6) != 0.0) == h->executed;
}

/* Their rows of this vertex from the cursor on. */
static uint32_t rows_of(const struct sweeper *s, uint32_t vertex)
{
  uint32_t n = 0;
  while (s->cursor + n < s->event->rows && pack_value(s->event, s->cursor + n, 0) == vertex)
    n++;
  return n;
}

static bool same_hits(struct sweeper *s, uint32_t vertex, const struct swept_hit *hits, uint32_t count)
{
  if (rows_of(s, vertex) != count)
    return false;
  for (uint32_t k = 0; k < count; k++) {
    uint32_t row = s->cursor;
    while (row < s->cursor + count && !(is_row(s, row, vertex, &hits[k]) && row_is_near(s, row, &hits[k])))
      row++;
    if (row == s->cursor + count)
      return false;
  }
  s->cursor += count;
  return true;
}

static uint32_t vertex_at(const struct sweeper *s, uint32_t turn)
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

static struct point part_of_way(struct point from, struct point to, double part)
{
  return (struct point){from.x + (int64_t)rint(part * (double)(to.x - from.x)),
                        from.y + (int64_t)rint(part * (double)(to.y - from.y)),
                        from.z + (int64_t)rint(part * (double)(to.z - from.z))};
}

static bool stays(const struct sweeper *s, uint32_t turn)
{
  return (s->t->last_stays && turn + 1 == s->n) || (s->t->first_stays && turn == 0);
}

/* What may be done wrong with a vertex whose move is rejected. */
static bool after_rejection(struct sweeper *s, uint32_t vertex)
{
  struct point end;
  if (s->t->stops)
    s->v[vertex] = (struct vec3){0.0, 0.0, 0.0};
  if (s->t->turns_back)
    s->v[vertex] = vec3_scale(-1.0, s->v[vertex]);
  if (!s->t->moves_after)
    return true;
  if (!trial_point(s, vertex, &end))
    return false;
  s->r[vertex] = end;
  return true;
}

static bool replay_moves(struct sweeper *s)
{
  struct swept_hit hits[MOST_HITS];
  for (uint32_t turn = 0; turn < s->n; turn++) {
    const uint32_t vertex = vertex_at(s, turn);
    struct point end;
    if (vertex >= s->n || !trial_point(s, vertex, &end))
      return false;
    const uint32_t count = stays(s, turn) ? 0 : find_hits(s, vertex, end, hits);
    if ((count == 0 || s->t->rejected_moves) && !stays(s, turn))
      s->r[vertex] = end;
    if (count > 0 && s->t->to_contact)
      s->r[vertex] = part_of_way(s->r[vertex], end, hits[0].hit.time);
    for (uint32_t k = 0; k < count; k++) {
      const uint32_t chosen = s->t->choice == CHOICE_END ? count - 1 : 0;
      hits[k].executed = s->t->choice == CHOICE_ALL || (k == chosen && s->t->choice != CHOICE_NONE);
      if (hits[k].executed)
        exchange(s, &hits[k]);
      hits[k].executed &= !s->t->unmarked;
    }
    if (count > 0 && !after_rejection(s, vertex))
      return false;
    if (!same_hits(s, vertex, hits, count))
      return false;
  }
  return s->cursor == s->event->rows;
}

static bool ends_there(const struct sweeper *s)
{
  for (uint32_t k = 0; k < s->n; k++)
    for (uint32_t c = 0; c < 3; c++) {
      const double at = (double)coordinate(s->r[k], (int)c);
      if (!(fabs(pack_value(s->to, k, c) - at) <=
            0.5 + (s->tolerance > 0x1p-30 ? s->tolerance * LATTICE_PER_A0 : 0.0)) ||
          !is_near(s, pack_value(s->end, k, c), oracle_component(s->v[k], c)))
        return false;
    }
  return true;
}

/* True if the guess makes their sweep of one step. */
static bool makes_theirs(const struct oracle_pair *p, const struct sweep_twist *t, double tolerance)
{
  struct sweeper s;
  if (!take(p, &s))
    return false;
  s.t = t, s.tolerance = tolerance;
  const bool same = begin(&s) && replay_moves(&s) && ends_there(&s);
  finish(&s);
  return same;
}

/* All steps that both have. */
static bool makes_all(const struct oracle_pair *p, const struct sweep_twist *t, double tolerance)
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

static const struct sweep_twist twists[] = {
    {.order = ORDER_NUMBERS, .text = "vertices move in the order of their numbers, not in that of in.order"},
    {.order = ORDER_BACKWARDS, .text = "vertices move in the order of in.order backwards"},
    {.order = ORDER_INVERSE, .text = "vertices move by the inverse of in.order"},
    {.trial = TRIAL_CUT, .text = "trial point cut toward zero, not rounded to the nearest lattice unit"},
    {.trial = TRIAL_DOWN, .text = "trial point rounded down, not to the nearest lattice unit"},
    {.trial = TRIAL_UP, .text = "trial point rounded up, not to the nearest lattice unit"},
    {.trial = TRIAL_SINGLE, .text = "single precision: the move, before it is rounded to the lattice"},
    {.time = -0.5, .text = "vertices move for half the time"},
    {.time = 1.0, .text = "vertices move for twice the time"},
    {.time = -2.0, .text = "sign: vertices move backwards"},
    {.rejected_moves = true, .text = "a rejected vertex moves all the same: it stays where a bond would be crossed"},
    {.moves_after = true, .text = "a rejected vertex moves after the exchange, with its new velocity: it stays where it was"},
    {.stops = true, .text = "a rejected vertex loses its velocity after the exchange"},
    {.turns_back = true, .text = "a rejected vertex has its velocity turned round after the exchange"},
    {.last_stays = true, .text = "the last vertex of in.order does not move"},
    {.first_stays = true, .text = "the first vertex of in.order does not move"},
    {.unmarked = true, .text = "executed is never set: it is 1 for the hit whose momentum is exchanged"},
    {.pivot = PIVOT_NEXT, .text = "the exchange takes the next vertex for the pivot, whatever bond moves"},
    {.pivot = PIVOT_BEFORE, .text = "the exchange takes the vertex before for the pivot, whatever bond moves"},
    {.short_images = true, .text = "missing image: partners that begin or end within the box of the triangle only"},
    {.skips_first = true, .text = "the first near partner of each moving bond is left out"},
    {.to_contact = true, .text = "a rejected vertex moves to the contact: it stays where it was"},
    {.stale_velocities = true, .text = "vertices move with the velocities of the start: exchanges before count"},
    {.stale_positions = true, .text = "standing bonds where they were at the start: moves before count"},
    {.images = 1, .text = "missing image: a partner across the face of the box is not found (no images at all)"},
    {.images = 2, .text = "missing image: a partner across the face of the box is not found (more than one box away)"},
    {.no_axis = 1, .text = "missing image: none along x"},
    {.no_axis = 2, .text = "missing image: none along y"},
    {.no_axis = 3, .text = "missing image: none along z"},
    {.above_only = true, .text = "missing image: none with a negative number"},
    {.below_only = true, .text = "missing image: none with a positive number"},
    {.one_axis = true, .text = "missing image: along one axis at a time, one box away, only"},
    {.negated = true, .text = "the image of the negative number: partner at r - image times edge"},
    {.report_negated = true, .text = "the image of an event is the negative of what is wanted"},
    {.negated = true,
     .report_negated = true,
     .text = "images are counted the other way: the negative of what is wanted"},
    {.edge_of = 1, .text = "images by the edge of x along all axes"},
    {.edge_of = 2, .text = "images by the edge of y along all axes"},
    {.edge_of = 3, .text = "images by the edge of z along all axes"},
    {.exclusion = EXCLUSION_ALWAYS_PAPER,
     .text = "exclusion: the paper's, bonds that share a vertex with either moving bond"},
    {.exclusion = EXCLUSION_NEVER_PAPER,
     .text = "exclusion: of the tested bond's vertices only, where the pack says the paper's"},
    {.exclusion = EXCLUSION_NONE, .text = "exclusion: a bond that shares a vertex is tested"},
    {.exclusion = EXCLUSION_FIBER, .text = "exclusion: a bond of the vertex' own fiber is left out"},
    {.exclusion = EXCLUSION_MOVER, .text = "exclusion: a bond that shares the pivot is tested"},
    {.partners = PARTNERS_LARGER,
     .text = "partners of a smaller number than the moving bond's are left out: each pair once"},
    {.partners = PARTNERS_SMALLER,
     .text = "partners of a larger number than the moving bond's are left out: each pair once"},
    {.partners = PARTNERS_VERTEX_LARGER,
     .text = "partners of a smaller number than the moving vertex are left out: each pair once"},
    {.partners = PARTNERS_VERTEX_SMALLER,
     .text = "partners of a larger number than the moving vertex are left out: each pair once"},
    {.partners = PARTNERS_NO_LAST, .text = "the last bond of all is no partner"},
    {.partners = PARTNERS_NO_FIRST, .text = "the first bond of all is no partner"},
    {.partners = PARTNERS_NO_CLOSING, .text = "the bond that closes a ring is no partner"},
    {.bonds = BONDS_NEXT, .text = "the bond to the next vertex only is tested"},
    {.bonds = BONDS_BEFORE, .text = "the bond to the vertex before only is tested"},
    {.choice = CHOICE_LAST, .text = "the last hit in time executed instead of first"},
    {.choice = CHOICE_END, .text = "the last hit of the order executed instead of first"},
    {.choice = CHOICE_NEAREST, .text = "the hit closest to the moving vertex executed instead of first"},
    {.choice = CHOICE_FARTHEST, .text = "the hit farthest from the moving vertex executed instead of first"},
    {.choice = CHOICE_NUMBER, .text = "the hit of the smallest number executed instead of first in time"},
    {.choice = CHOICE_TIE_LARGER,
     .text = "ties: hits at the same time go by moving bond, standing bond, image; the smaller first"},
    {.choice = CHOICE_TIE_STANDING,
     .text = "ties: hits at the same time go by moving bond first, then by standing bond"},
    {.choice = CHOICE_TIE_IMAGE, .text = "ties: hits at the same time of one bond go by image, ascending"},
    {.choice = CHOICE_ALL, .text = "more than the first hit of a move executed"},
    {.choice = CHOICE_NONE, .text = "no hit of a move executed"},
};

static bool name_guesses(const struct oracle_pair *p, double tolerance, char text[ORACLE_TEXT])
{
  const struct contact_twist *const lists[] = {contact_test_twists, contact_exchange_twists};
  bool named = false;
  for (size_t k = 0; k < sizeof twists / sizeof *twists; k++)
    if (makes_all(p, &twists[k], tolerance))
      oracle_name(text, &named, twists[k].text);
  for (int list = 0; list < 2; list++)
    for (const struct contact_twist *c = lists[list]; c->text; c++)
      if (makes_all(p, &(struct sweep_twist){.contact = *c}, tolerance))
        oracle_name(text, &named, c->text);
  return named;
}

/* What is right but for rounding is no bug of a sweep. */
bool oracle_replay(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  static const double tolerances[] = {0x1p-40, 0x1p-26};
  static const struct sweep_twist right = {.text = NULL};
  for (int pass = 0; pass < 2; pass++)
    if (makes_all(p, &right, tolerances[pass]) || name_guesses(p, tolerances[pass], text))
      return !makes_all(p, &right, tolerances[pass]);
  return false;
}

/* --- each move alone ---------------------------------------------------------------------------------------------- */

enum { FACTS = 11, PLACES = 3 };
static const char *const fact_names = "zero shared own_fiber image image_x image_y image_z flip moving standing rank";

/* Hits that are right or theirs, in the order of the moves: facts of each, and whether we and they have it. */
struct judged {
  double (*fact)[FACTS + PLACES];
  bool (*found)[2];
  uint32_t count;
  bool failed;
};

static bool has_zero(const struct contact_points *r)
{
  return !crossing_orientation(r->a, r->b, r->pivot, r->from) || !crossing_orientation(r->a, r->b, r->pivot, r->to) ||
         !crossing_orientation(r->a, r->b, r->from, r->to) || !crossing_orientation(r->from, r->to, r->pivot, r->a) ||
         !crossing_orientation(r->from, r->to, r->pivot, r->b);
}

static void judge_hit(const struct sweeper *s, const struct swept_hit *h, double rank, bool ours, bool theirs,
                      struct judged *j)
{
  double(*facts)[FACTS + PLACES] = realloc(j->fact, (j->count + 1) * sizeof *facts);
  j->fact = facts ? facts : j->fact;
  bool(*found)[2] = realloc(j->found, (j->count + 1) * sizeof *found);
  j->found = found ? found : j->found;
  j->failed |= !facts || !found;
  if (!facts || !found)
    return;
  const double row[FACTS + PLACES] = {has_zero(&h->points),
                                      shares(s, h->moving, h->standing),
                                      pack_value(s->chain, h->four[0], 2) == pack_value(s->chain, h->four[2], 2),
                                      h->image[0] != 0 || h->image[1] != 0 || h->image[2] != 0,
                                      (double)h->image[0],
                                      (double)h->image[1],
                                      (double)h->image[2],
                                      h->points.flip,
                                      h->moving,
                                      h->standing,
                                      rank,
                                      h->hit.time,
                                      h->hit.s,
                                      h->hit.s_standing};
  memcpy(facts[j->count], row, sizeof row);
  found[j->count][0] = ours, found[j->count][1] = theirs;
  j->count++;
}

/* A hit from a row of theirs, in the state that the move found. False if there are no such bonds. */
static bool hit_of_row(const struct sweeper *s, uint32_t row, uint32_t vertex, struct point end, struct swept_hit *h)
{
  int64_t n[6];
  for (uint32_t k = 0; k < 6; k++) {
    const double x = pack_value(s->event, row, k);
    if (!(fabs(x) < 1e6))
      return false;
    n[k] = (int64_t)x;
  }
  const int64_t pivot = n[1] == (int64_t)vertex ? next_of(s, n[1]) : n[1];
  if (n[1] < 0 || n[2] < 0 || n[1] >= s->n || n[2] >= s->n || pivot < 0 || next_of(s, n[2]) < 0 || n[3] < -FAR ||
      n[3] > FAR || n[4] < -FAR || n[4] > FAR || n[5] < -FAR || n[5] > FAR)
    return false;
  *h = (struct swept_hit){.moving = (uint32_t)n[1],
                          .standing = (uint32_t)n[2],
                          .four = {vertex, (uint32_t)pivot, (uint32_t)n[2], (uint32_t)next_of(s, n[2])},
                          .image = {n[3], n[4], n[5]},
                          .executed = pack_value(s->event, row, 6) != 0.0};
  h->points = (struct contact_points){s->r[vertex],
                                      end,
                                      s->r[pivot],
                                      moved_by(s, s->r[h->four[2]], h->image),
                                      moved_by(s, s->r[h->four[3]], h->image),
                                      n[1] == (int64_t)vertex};
  h->hit = (struct contact_hit){pack_value(s->hit, row, 0),
                                pack_value(s->hit, row, 1),
                                pack_value(s->hit, row, 2),
                                {pack_value(s->hit, row, 3), pack_value(s->hit, row, 4), pack_value(s->hit, row, 5)}};
  h->impulse = pack_value(s->hit, row, 6);
  return true;
}

/* What their exchange does, by their own numbers. */
static void follow(struct sweeper *s, const struct swept_hit *h)
{
  const double lever[4] = {1.0 - h->hit.s, h->hit.s, h->hit.s_standing - 1.0, -h->hit.s_standing};
  for (int k = 0; k < 4; k++)
    s->v[h->four[k]] =
        vec3_add_scaled(s->v[h->four[k]], -lever[k] * h->impulse / mass_of(s, h->four[k]), h->hit.normal);
}

static bool judge_move(struct sweeper *s, uint32_t vertex, struct judged *j)
{
  struct swept_hit hits[MOST_HITS], h;
  struct point end;
  if (vertex >= s->n || !trial_point(s, vertex, &end))
    return false;
  const uint32_t count = find_hits(s, vertex, end, hits), rows = rows_of(s, vertex);
  bool known[MOST_HITS] = {false};
  for (uint32_t row = s->cursor; row < s->cursor + rows; row++) {
    if (!hit_of_row(s, row, vertex, end, &h))
      return false;
    uint32_t k = 0;
    while (k < count && !is_row(s, row, vertex, &hits[k]))
      k++;
    if (k < count)
      known[k] = true;
    else
      judge_hit(s, &h, -1.0, false, true, j);
  }
  for (uint32_t k = 0; k < count; k++)
    judge_hit(s, &hits[k], k, true, known[k], j);
  for (uint32_t row = s->cursor; row < s->cursor + rows; row++)
    if (hit_of_row(s, row, vertex, end, &h) && h.executed)
      follow(s, &h);
  if (rows == 0)
    s->r[vertex] = end;
  s->cursor += rows;
  return true;
}

/* A pack of what was judged, to be described as any other table. */
static bool describe(const struct oracle_pair *p, const struct judged *j, const char *unknown, char text[ORACLE_TEXT])
{
  struct pack ours = {0}, theirs = {0};
  struct pack_place place = p->ours->place;
  snprintf(place.operator_name, sizeof place.operator_name, "crossings");
  int64_t *facts = pack_put_integers(&ours, &place, "in.hit", fact_names, j->count);
  for (uint32_t k = 0; facts && k < FACTS * j->count; k++)
    facts[k] = (int64_t)j->fact[k / FACTS][k % FACTS];
  double *contact = pack_put_reals(&ours, &place, "in.contact", "time s s_standing", j->count);
  for (uint32_t k = 0; contact && k < PLACES * j->count; k++)
    contact[k] = j->fact[k / PLACES][FACTS + k % PLACES];
  int64_t *mine = pack_put_integers(&ours, &place, "out.found", "found", j->count);
  int64_t *its = pack_put_integers(&theirs, &place, "out.found", "found", j->count);
  uint32_t missed = 0, invented = 0;
  for (uint32_t k = 0; mine && its && k < j->count; k++) {
    mine[k] = j->found[k][0], its[k] = j->found[k][1];
    missed += mine[k] && !its[k], invented += its[k] && !mine[k];
  }
  bool said = false;
  if (!ours.failed && !theirs.failed && missed + invented > 0) {
    const struct oracle_pair pair = {&ours, &theirs, &ours.table[2], &theirs.table[0], p->rounding};
    struct evidence e = {0};
    char rows[ROWS_TEXT];
    said = evidence_take(&pair, &e);
    /* Rows are judged hits, which nobody knows by number. */
    const bool exact = said && oracle_describe_rows(&e, rows) && strstr(rows, " where ");
    snprintf(text, ORACLE_TEXT, "%s%s%u crossings are missed, %u are found that are none: %s", exact ? "" : unknown,
             exact ? "" : "; ", missed, invented, exact ? rows : "no rule known, what follows may be consequence");
    evidence_free(&e);
  }
  pack_free(&ours);
  pack_free(&theirs);
  return said;
}

bool oracle_judge_moves(const struct oracle_pair *p, const char *unknown, char text[ORACLE_TEXT])
{
  static const struct sweep_twist right = {.text = NULL};
  struct sweeper s;
  struct judged j = {0};
  if (!take(p, &s))
    return false;
  s.t = &right;
  bool ok = begin(&s);
  for (uint32_t turn = 0; ok && turn < s.n; turn++)
    ok = judge_move(&s, vertex_at(&s, turn), &j);
  ok = ok && s.cursor == s.event->rows && !j.failed && describe(p, &j, unknown, text);
  free(j.fact);
  free(j.found);
  finish(&s);
  return ok;
}
