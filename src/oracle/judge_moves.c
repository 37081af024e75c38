/* Each move of a sweep alone, in the state that their own events before it have made: which crossings they miss, and
 * which they find that are none. */
#include <stdlib.h>
#include <string.h>

#include "contact/line.h"
#include "oracle/patterns.h"
#include "oracle/replay.h"
#include "oracle/rows.h"
#include "oracle/sweeper.h"

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
                                      sweeper_shares(s, h->moving, h->standing),
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
  const int64_t pivot = n[1] == (int64_t)vertex ? sweeper_next(s, n[1]) : n[1];
  if (n[1] < 0 || n[2] < 0 || n[1] >= s->n || n[2] >= s->n || pivot < 0 || sweeper_next(s, n[2]) < 0 || n[3] < -FAR ||
      n[3] > FAR || n[4] < -FAR || n[4] > FAR || n[5] < -FAR || n[5] > FAR)
    return false;
  *h = (struct swept_hit){.moving = (uint32_t)n[1],
                          .standing = (uint32_t)n[2],
                          .four = {vertex, (uint32_t)pivot, (uint32_t)n[2], (uint32_t)sweeper_next(s, n[2])},
                          .image = {n[3], n[4], n[5]},
                          .executed = pack_value(s->event, row, 6) != 0.0};
  h->points = (struct contact_points){s->r[vertex],
                                      end,
                                      s->r[pivot],
                                      sweeper_moved(s, s->r[h->four[2]], h->image),
                                      sweeper_moved(s, s->r[h->four[3]], h->image),
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
        vec3_add_scaled(s->v[h->four[k]], -lever[k] * h->impulse / sweeper_mass(s, h->four[k]), h->hit.normal);
}

static bool judge_move(struct sweeper *s, uint32_t vertex, struct judged *j)
{
  struct swept_hit hits[MOST_HITS], h;
  struct point end;
  if (vertex >= s->n || !sweeper_trial(s, vertex, &end))
    return false;
  const uint32_t count = sweeper_hits(s, vertex, end, hits), rows = sweeper_rows(s, vertex);
  bool known[MOST_HITS] = {false};
  for (uint32_t row = s->cursor; row < s->cursor + rows; row++) {
    if (!hit_of_row(s, row, vertex, end, &h))
      return false;
    uint32_t k = 0;
    while (k < count && !sweeper_is_row(s, row, vertex, &hits[k]))
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
static bool describe(const struct oracle_pair *p, const struct judged *j, char text[ORACLE_TEXT])
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
    const struct oracle_pair pair = {&ours, &theirs, &ours.table[2], &theirs.table[0], p->rounding, NULL};
    struct evidence e = {0};
    char rows[ROWS_TEXT];
    said = evidence_take(&pair, &e);
    /* Rows are judged hits, which nobody knows by number. */
    const bool exact = said && oracle_describe_rows(&e, rows) && strstr(rows, " where ");
    snprintf(text, ORACLE_TEXT, "%s%s%u crossings are missed, %u are found that are none: %s",
             exact ? "" : ORACLE_UNKNOWN, exact ? "" : "; ", missed, invented,
             exact ? rows : "no rule known, what follows may be consequence");
    evidence_free(&e);
  }
  pack_free(&ours);
  pack_free(&theirs);
  return said;
}

/* All moves of one step. False if they cannot be followed to the end. */
static bool judge_all(const struct oracle_pair *p, struct judged *j)
{
  static const struct sweep_twist right = {.text = NULL};
  struct sweeper s;
  if (!sweeper_take(p, &s))
    return false;
  s.t = &right;
  bool ok = sweeper_begin(&s);
  for (uint32_t turn = 0; ok && turn < s.n; turn++)
    ok = judge_move(&s, sweeper_vertex(&s, turn), j);
  ok = ok && s.cursor == s.event->rows && !j->failed;
  sweeper_finish(&s);
  return ok;
}

bool oracle_judge_moves(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  struct judged j = {0};
  const bool ok = judge_all(p, &j) && describe(p, &j, text);
  free(j.fact);
  free(j.found);
  return ok;
}

void oracle_count_hits(const struct oracle_pair *p, uint32_t *hits, uint32_t *wrong)
{
  *hits = *wrong = 0;
  for (size_t k = 0; k < p->pack->count; k++) {
    const struct pack_table *ours = &p->pack->table[k];
    const struct pack_table *theirs = pack_find(p->pack_theirs, &ours->place, ours->name);
    if (strcmp(ours->place.operator_name, p->ours->place.operator_name) != 0 || strcmp(ours->name, "out.event") != 0 ||
        !theirs)
      continue;
    struct judged j = {0};
    judge_all(&(struct oracle_pair){p->pack, p->pack_theirs, ours, theirs, p->rounding, NULL}, &j);
    for (uint32_t n = 0; n < j.count; n++)
      *wrong += j.found[n][0] != j.found[n][1];
    *hits += j.count;
    free(j.fact);
    free(j.found);
  }
}

/* --- events that are right, and not reported ---------------------------------------------------------------------- */

enum { REPORT_FACTS = 9 };
static const char *const report_names = "vertex moving standing image_x image_y image_z executed image rank";

static bool same_event(const struct pack_table *a, uint32_t row, const struct pack_table *b, uint32_t other)
{
  for (uint32_t k = 0; k < 6; k++)
    if (pack_value(a, row, k) != pack_value(b, other, k))
      return false;
  return true;
}

static uint32_t count_alike(const struct pack_table *t, const struct pack_table *of, uint32_t row)
{
  uint32_t n = 0;
  for (uint32_t k = 0; k < t->rows; k++)
    n += same_event(of, row, t, k);
  return n;
}

static void put_report(const struct pack_table *t, uint32_t row, int64_t facts[REPORT_FACTS])
{
  for (uint32_t k = 0; k < 7; k++)
    facts[k] = (int64_t)pack_value(t, row, k);
  facts[7] = facts[3] != 0 || facts[4] != 0 || facts[5] != 0;
  facts[8] = 0;
  for (uint32_t k = row; k > 0 && pack_value(t, k - 1, 0) == pack_value(t, row, 0); k--)
    facts[8]++;
}

bool oracle_judge_reports(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  const struct pack_table *mine = oracle_sibling(p, "out.event"), *its = oracle_sibling_of_theirs(p, "out.event");
  struct pack ours = {0}, theirs = {0};
  struct pack_place place = p->ours->place;
  uint32_t missed = 0, invented = 0;
  if (!mine || !its || mine->columns != 7 || its->columns != 7)
    return false;
  snprintf(place.operator_name, sizeof place.operator_name, "reports");
  int64_t *facts = pack_put_integers(&ours, &place, "in.event", report_names, mine->rows);
  int64_t *all = pack_put_integers(&ours, &place, "out.reported", "reported", mine->rows);
  int64_t *found = pack_put_integers(&theirs, &place, "out.reported", "reported", mine->rows);
  for (uint32_t k = 0; facts && all && found && k < mine->rows; k++) {
    put_report(mine, k, &facts[(size_t)REPORT_FACTS * k]);
    all[k] = 1, found[k] = count_alike(its, mine, k) > 0;
    missed += !found[k];
  }
  for (uint32_t k = 0; k < its->rows; k++)
    invented += count_alike(mine, its, k) == 0;
  char rows[ROWS_TEXT] = "";
  if (!ours.failed && !theirs.failed && missed > 0) {
    const struct oracle_pair pair = {&ours, &theirs, &ours.table[1], &theirs.table[0], p->rounding, NULL};
    struct evidence e = {0};
    if (evidence_take(&pair, &e))
      oracle_describe_rows(&e, rows);
    evidence_free(&e);
  }
  snprintf(text, ORACLE_TEXT,
           "%s; all vertices end where they should, but %u events are not reported, %u that are none are%s%s",
           ORACLE_UNKNOWN, missed, invented, *rows ? ": " : "", rows);
  pack_free(&ours);
  pack_free(&theirs);
  return missed + invented > 0;
}
