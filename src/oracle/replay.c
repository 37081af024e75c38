#include "oracle/replay.h"

#include <math.h>
#include <string.h>

#include "oracle/evidence.h"
#include "oracle/sweeper.h"

/* --- moves -------------------------------------------------------------------------------------------------------- */

static bool row_is_near(const struct sweeper *s, uint32_t row, const struct swept_hit *h)
{
  const double value[7] = {h->hit.time,     h->hit.s,        h->hit.s_standing, h->hit.normal.x,
                           h->hit.normal.y, h->hit.normal.z, h->impulse};
  for (uint32_t k = 0; k < 7; k++)
    if (!sweeper_is_near(s, pack_value(s->hit, row, k), value[k]))
      return false;
  return (pack_value(s->event, row, 6) != 0.0) == h->executed;
}

static bool same_hits(struct sweeper *s, uint32_t vertex, const struct swept_hit *hits, uint32_t count)
{
  if (sweeper_rows(s, vertex) != count)
    return false;
  for (uint32_t k = 0; k < count; k++) {
    uint32_t row = s->cursor;
    while (row < s->cursor + count && !(sweeper_is_row(s, row, vertex, &hits[k]) && row_is_near(s, row, &hits[k])))
      row++;
    if (row == s->cursor + count)
      return false;
  }
  s->cursor += count;
  return true;
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
  if (!sweeper_trial(s, vertex, &end))
    return false;
  s->r[vertex] = end;
  return true;
}

static bool replay_moves(struct sweeper *s)
{
  struct swept_hit hits[MOST_HITS];
  for (uint32_t turn = 0; turn < s->n; turn++) {
    const uint32_t vertex = sweeper_vertex(s, turn);
    struct point end;
    if (vertex >= s->n || !sweeper_trial(s, vertex, &end))
      return false;
    const uint32_t count = stays(s, turn) ? 0 : sweeper_hits(s, vertex, end, hits);
    if ((count == 0 || s->t->rejected_moves) && !stays(s, turn))
      s->r[vertex] = end;
    if (count > 0 && s->t->to_contact)
      s->r[vertex] = part_of_way(s->r[vertex], end, hits[0].hit.time);
    for (uint32_t k = 0; k < count; k++) {
      const uint32_t chosen = s->t->choice == CHOICE_END ? count - 1 : 0;
      hits[k].executed = s->t->choice == CHOICE_ALL || (k == chosen && s->t->choice != CHOICE_NONE);
      if (hits[k].executed)
        sweeper_exchange(s, &hits[k]);
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
      const double at = (double)sweeper_coordinate(s->r[k], (int)c);
      if (!(fabs(pack_value(s->to, k, c) - at) <=
            0.5 + (s->tolerance > 0x1p-30 ? s->tolerance * LATTICE_PER_A0 : 0.0)) ||
          !sweeper_is_near(s, pack_value(s->end, k, c), oracle_component(s->v[k], c)))
        return false;
    }
  return true;
}

/* True if the guess makes their sweep of one step. */
static bool makes_theirs(const struct oracle_pair *p, const void *twist, double tolerance)
{
  struct sweeper s;
  if (!sweeper_take(p, &s))
    return false;
  s.t = twist, s.tolerance = tolerance;
  const bool same = sweeper_begin(&s) && replay_moves(&s) && ends_there(&s);
  sweeper_finish(&s);
  return same;
}

bool oracle_makes_all(const struct oracle_pair *p,
                      bool (*makes)(const struct oracle_pair *step, const void *twist, double tolerance),
                      const void *twist, double tolerance)
{
  bool any = false;
  for (size_t k = 0; k < p->pack->count; k++) {
    const struct pack_table *ours = &p->pack->table[k];
    const struct pack_table *theirs = pack_find(p->pack_theirs, &ours->place, ours->name);
    if (strcmp(ours->place.operator_name, p->ours->place.operator_name) != 0 || strcmp(ours->name, "out.event") != 0 ||
        !theirs)
      continue;
    const struct oracle_pair pair = {p->pack, p->pack_theirs, ours, theirs, p->rounding, NULL};
    if (!makes(&pair, twist, tolerance))
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
    {.moves_after = true,
     .text = "a rejected vertex moves after the exchange, with its new velocity: it stays where it was"},
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
    {.near_axis = 1, .text = "missing image: none more than one box away along x"},
    {.near_axis = 2, .text = "missing image: none more than one box away along y"},
    {.near_axis = 3, .text = "missing image: none more than one box away along z"},
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

/* A change of which hits are found says nothing if chance may choose the same ones: few hits, or nearly all. */
static bool enough_hits(const struct oracle_pair *p)
{
  const size_t changes = sizeof twists / sizeof *twists;
  const double tried = (double)changes + 64.0;
  uint32_t hits, wrong;
  oracle_count_hits(p, &hits, &wrong);
  return wrong == 0 || evidence_ways(hits, wrong) >= EVIDENCE_SURE + log2(tried);
}

static bool finds_other_hits(const struct sweep_twist *t)
{
  return t->images || t->above_only || t->below_only || t->one_axis || t->negated || t->no_axis || t->near_axis ||
         t->edge_of || t->short_images || t->skips_first || t->exclusion || t->partners || t->bonds;
}

/* Changes that make theirs; of those that find other hits only, or of the others only. */
static bool name_kind(const struct oracle_pair *p, double tolerance, bool finders, char text[ORACLE_TEXT], bool *named)
{
  const struct contact_twist *const list = finders ? contact_test_twists : contact_exchange_twists;
  for (size_t k = 0; k < sizeof twists / sizeof *twists; k++)
    if (finds_other_hits(&twists[k]) == finders && oracle_makes_all(p, makes_theirs, &twists[k], tolerance))
      oracle_name(text, named, twists[k].text);
  for (const struct contact_twist *c = list; c->text; c++)
    if (oracle_makes_all(p, makes_theirs, &(struct sweep_twist){.contact = *c}, tolerance))
      oracle_name(text, named, c->text);
  return *named;
}

static bool name_guesses(const struct oracle_pair *p, double tolerance, char text[ORACLE_TEXT])
{
  bool named = false;
  if (enough_hits(p)) {
    name_kind(p, tolerance, true, text, &named);
    return name_kind(p, tolerance, false, text, &named);
  }
  if (name_kind(p, tolerance, false, text, &named))
    return true;
  char hits[ORACLE_TEXT] = "";
  if (name_kind(p, tolerance, true, hits, &named))
    snprintf(text, ORACLE_TEXT, "too few hits to tell; among what would make them: %.580s", hits);
  return named;
}

/* What is right but for rounding is no bug of a sweep. */
bool oracle_replay(const struct oracle_pair *p, char text[ORACLE_TEXT])
{
  static const double tolerances[] = {0x1p-40, 0x1p-26};
  static const struct sweep_twist right = {.text = NULL};
  for (int pass = 0; pass < 2; pass++)
    if (oracle_makes_all(p, makes_theirs, &right, tolerances[pass]) || name_guesses(p, tolerances[pass], text))
      return !oracle_makes_all(p, makes_theirs, &right, tolerances[pass]);
  return false;
}
