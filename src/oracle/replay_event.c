/* Drifts of the rule `event-driven`, replayed with one thing changed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/flyer.h"
#include "oracle/patterns.h"
#include "oracle/replay.h"

/* --- answers ------------------------------------------------------------------------------------------------------ */

static void steer(struct flyer *f, int64_t v, struct point rate, int32_t tick)
{
  const struct point here = flyer_place(f, v, tick);
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
    flyer_search_again(f, vertex, e, of_pairs ? AGAIN_RIGHT : rule);
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
  flyer_touch(f, e, &c);
  if (c.touching) {
    flyer_drop_pair(f, e);
    flyer_search_pair(f, e->bond, e->other, e->image, e->tick + 1);
    return true;
  }
  const double impulse = is_exhausted(f, &c) ? 0.0 : event_impulse(f->t, &c.e, &kind);
  if (kind == CONTACT_NONE) {
    if (f->t->no_clusters)
      flyer_drop_pair(f, e);
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
      steer(f, c.four[k], flyer_rate(f, c.e.velocity[k]), e->tick);
  }
  if (!f->failed)
    flyer_search_again(f, vertex, e, f->t->again);
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
  flyer_search(f, NULL, 0, 0);
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
      if (!(fabs(pack_value(f->to, k, c) - (double)flyer_axis(flyer_place(f, k, FLIGHT_TICKS), (int)c)) <= room) ||
          !is_near(f, pack_value(f->end, k, c), oracle_component(f->v[k], c)))
        return false;
  return f->to->rows == f->n && f->end->rows == f->n;
}

static bool makes_theirs(const struct oracle_pair *p, const void *twist, double tolerance)
{
  struct flyer f;
  if (!flyer_take(p, &f))
    return false;
  f.t = twist, f.tolerance = tolerance;
  const bool same = flyer_begin(&f) && fly(&f) && ends_there(&f);
  flyer_finish(&f);
  return same;
}

static bool name_guesses(const struct oracle_pair *p, double tolerance, char text[ORACLE_TEXT])
{
  const struct event_twist *const lists[] = {event_drift_twists, event_search_twists, event_impulse_twists};
  bool named = false;
  for (int list = 0; list < 3; list++)
    for (const struct event_twist *t = lists[list]; t->text; t++)
      if (oracle_makes_all(p, makes_theirs, t, tolerance))
        oracle_name(text, &named, t->text);
  return named;
}

bool oracle_replay_events(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  static const double tolerances[] = {0x1p-40, 0x1p-26};
  static const struct event_twist right = {.text = NULL};
  for (int pass = 0; pass < 2; pass++)
    if (oracle_makes_all(p, makes_theirs, &right, tolerances[pass]) || name_guesses(p, tolerances[pass], text))
      return !oracle_makes_all(p, makes_theirs, &right, tolerances[pass]);
  return false;
}
