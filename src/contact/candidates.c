#include "contact/candidates.h"

#include <string.h>

#include "base/memory.h"
#include "base/registers.h"
#include "contact/capsule.h"
#include "contact/neighbors.h"
#include "contact/pairs.h"

enum { PAIRS = 256, FIRST_CANDIDATES = 1024 }; /* pairs worked on at a time; room at first */

/* --- paths ------------------------------------------------------------------------------------------------------- */

/* By how much a bond's path grows in a drift in which its ends go so far. Ways beyond 64 a0 are cut to 64: no limit is
 * more than 32 a0 away. So between two drifts the sum of two paths grows by far less than 2^31 units (2048 a0), where
 * the sign of a difference modulo 2^32 would be wrong. */
static inline uint32_t way(uint32_t one, uint32_t other)
{
  const uint32_t longest = 64u << CANDIDATES_UNITS, further = one > other ? one : other;
  return further < longest ? further : longest;
}

static inline uint32_t way_of(const struct model *model, const struct contact *contact, uint32_t j)
{
  return way(contact->range[j], contact->range[model->next[j] < 0 ? (int32_t)j : model->next[j]]);
}

uint32_t candidates_way(const struct model *model, const struct contact *contact, uint32_t j)
{
  return way_of(model, contact, j);
}

void candidates_lengthen(const struct model *model, struct contact *contact)
{
  const uint32_t *restrict range = contact->range;
  uint32_t *restrict path = contact->neighbors.path;
  for (uint32_t f = 0; f < model->fibers; f++) {
    const uint32_t last = model->fiber_first[f + 1] - 1;
    for (uint32_t j = model->fiber_first[f]; j < last; j++)
      path[j] += way(range[j], range[j + 1]);
    path[last] += way_of(model, contact, last);
  }
}

void candidates_widen(const struct model *model, struct contact *contact, uint32_t i, uint32_t range)
{
  uint32_t bond[2];
  const int bonds = model_bonds_of(model, i, bond);
  for (int b = 0; b < bonds; b++)
    contact->neighbors.path[bond[b]] -= way_of(model, contact, bond[b]);
  contact->range[i] = range;
  for (int b = 0; b < bonds; b++)
    contact->neighbors.path[bond[b]] += way_of(model, contact, bond[b]);
}

/* --- pairs that are due ------------------------------------------------------------------------------------------ */

/* Lists the pairs among first .. first + n - 1 whose paths exceed their limits. Returns their number. */
static uint32_t list_due(const struct neighbors *nb, uint32_t first, uint32_t n, uint32_t *restrict due)
{
  if (n == 0) /* there may be no list yet */
    return 0;
  const uint32_t *restrict bond = &nb->pairs.bond[first], *restrict other = &nb->pairs.other[first],
                           *restrict limit = &nb->pairs.limit[first];
  const uint32_t *restrict path = nb->path;
  uint32_t left[PAIRS] = {0}, count = 0;
  for (uint32_t k = 0; k < n; k++)
    left[k] = limit[k] - path[bond[k]] - path[other[k]];
  for (uint32_t from = 0; from < PAIRS; from += 64)
    for (uint64_t late = negatives_of_64(&left[from]); late; late &= late - 1)
      due[count++] = first + from + (uint32_t)__builtin_ctzll(late);
  return count;
}

/* Pairs that are due, in columns. p, q: both bond vectors; w: from the first end of p to that of q; all in a0. path:
 * sum of both paths before this drift. */
struct columns {
  uint32_t count;
  uint32_t pair[PAIRS];
  uint32_t path[PAIRS];
  double p[3][PAIRS], q[3][PAIRS], w[3][PAIRS];
};

static void fill_column(const struct state *state, const struct model *model, const struct contact *contact,
                        uint32_t pair, struct columns *s)
{
  const struct pair_list *list = &contact->neighbors.pairs;
  const uint32_t *path = contact->neighbors.path;
  const uint32_t k = s->count++, i = list->bond[pair], j = (uint32_t)model->next[i], l = list->other[pair],
                 m = (uint32_t)model->next[l];
  const struct point *at = state->position;
  const struct vec3 p = point_difference(at[j], at[i]), q = point_difference(at[m], at[l]),
                    w = point_difference(point_image(at[l], list->detail[pair].image.k, &model->box), at[i]);
  s->pair[k] = pair;
  s->path[k] = path[i] - way_of(model, contact, i) + path[l] - way_of(model, contact, l);
  s->p[0][k] = p.x, s->p[1][k] = p.y, s->p[2][k] = p.z;
  s->q[0][k] = q.x, s->q[1][k] = q.y, s->q[2][k] = q.z;
  s->w[0][k] = w.x, s->w[1][k] = w.y, s->w[2][k] = w.z;
}

/* The limit of each pair: the sum of the two paths before this drift, plus the distance of the bonds less the thickness
 * of the thickest fiber, a0. */
static void limit_columns(const struct columns *restrict s, double thickness, uint32_t *restrict limit)
{
  const double slack = thickness + CAPSULE_SLACK;
  for (uint32_t k = 0; k < s->count; k++) {
    const struct vec3 p = {s->p[0][k], s->p[1][k], s->p[2][k]}, q = {s->q[0][k], s->q[1][k], s->q[2][k]},
                      w = {s->w[0][k], s->w[1][k], s->w[2][k]};
    const double apart = capsule_most(capsule_distance(p, q, w) - slack, 0.0);
    limit[k] = s->path[k] + (uint32_t)(int32_t)(capsule_least(apart, 32.0) * (1 << CANDIDATES_UNITS));
  }
}

/* --- the list of candidates -------------------------------------------------------------------------------------- */

static bool add_candidate(const struct state *state, struct contact *contact, uint32_t bond, struct neighbor n,
                          struct fault *fault)
{
  struct candidate_list *list = &contact->candidates;
  if (list->count == list->room && !memory_double((void **)&list->at, &list->room, FIRST_CANDIDATES, sizeof *list->at))
    return fault_no_memory(fault, state->step + 1);
  list->at[list->count] = (struct candidate){bond, n, list->first[bond]};
  list->first[bond] = ++list->count;
  return true;
}

static bool is_listed(const struct candidate_list *list, uint32_t bond, const struct neighbor *n)
{
  for (uint32_t m = list->first[bond]; m; m = list->at[m - 1].next)
    if (memcmp(&list->at[m - 1].with, n, sizeof *n) == 0)
      return true;
  return false;
}

bool candidates_add(const struct state *state, struct contact *contact, uint32_t bond, const struct neighbor *n,
                    struct fault *fault)
{
  const struct neighbor back = {(int32_t)bond, {-n->image[0], -n->image[1], -n->image[2]}};
  return is_listed(&contact->candidates, bond, n) || (add_candidate(state, contact, bond, *n, fault) &&
                                                      add_candidate(state, contact, (uint32_t)n->bond, back, fault));
}

static void forget_candidates(struct candidate_list *list)
{
  for (uint32_t m = 0; m < list->count; m++)
    list->first[list->at[m].bond] = 0;
  list->count = 0;
}

/* --- which pairs are candidates ---------------------------------------------------------------------------------- */

/* Pairs that may touch in this drift become candidates; the others get the limit at which they are next due. */
static bool settle_columns(const struct state *state, const struct model *model, struct contact *contact,
                           const struct columns *s, struct fault *fault)
{
  struct pair_list *list = &contact->neighbors.pairs;
  uint32_t limit[PAIRS];
  limit_columns(s, model_thickness(model), limit);
  for (uint32_t k = 0; k < s->count; k++) {
    const uint32_t pair = s->pair[k], i = list->bond[pair], l = list->other[pair];
    list->limit[pair] = limit[k];
    if ((limit[k] - contact->neighbors.path[i] - contact->neighbors.path[l]) >> 31 == 0)
      continue;
    const int32_t *image = list->detail[pair].image.k;
    const struct neighbor n = {(int32_t)l, {image[0], image[1], image[2]}};
    if (!candidates_add(state, contact, i, &n, fault))
      return false;
  }
  return true;
}

static void fetch_due(const struct state *state, const struct model *model, const struct contact *contact,
                      uint32_t pair)
{
  const uint32_t bonds[2] = {contact->neighbors.pairs.bond[pair], contact->neighbors.pairs.other[pair]};
  for (int b = 0; b < 2; b++) {
    __builtin_prefetch(&state->position[bonds[b]]);
    __builtin_prefetch(&state->position[bonds[b] + 1].z);
    __builtin_prefetch(&contact->range[bonds[b]]);
    __builtin_prefetch(&contact->neighbors.generation[bonds[b]]);
    __builtin_prefetch(&model->next[bonds[b]]);
  }
  __builtin_prefetch(&contact->neighbors.pairs.detail[pair]);
}

/* Measures one of the pairs that are due. A pair that is out of date is dropped. The last pair of the list takes its
 * place and is measured now, whether it is due or not. Its old number is then beyond the end of the list, so it is
 * skipped if an earlier list of due pairs contains it. */
static void look_at_pair(const struct state *state, const struct model *model, struct contact *contact, uint32_t pair,
                         struct columns *s)
{
  struct neighbors *nb = &contact->neighbors;
  while (pair < nb->pairs.count && pairs_out_of_date(nb, pair))
    pairs_drop(nb, pair);
  if (pair < nb->pairs.count)
    fill_column(state, model, contact, pair, s);
}

/* Lists the next pairs that are due, from number `first` on, and prefetches their data. Returns their number. */
static uint32_t next_due(const struct state *state, const struct model *model, const struct contact *contact,
                         uint32_t first, uint32_t *due)
{
  const uint32_t end = contact->neighbors.pairs.count, left = first < end ? end - first : 0;
  const uint32_t count = list_due(&contact->neighbors, first, left < PAIRS ? left : PAIRS, due);
  for (uint32_t k = 0; k < count; k++)
    fetch_due(state, model, contact, due[k]);
  return count;
}

bool candidates_find(const struct state *state, const struct model *model, struct contact *contact, struct fault *fault)
{
  uint32_t due[2][PAIRS] = {{0}}, count[2], now = 0;
  struct columns s;
  forget_candidates(&contact->candidates);
  count[0] = next_due(state, model, contact, 0, due[0]);
  for (uint32_t first = 0; first < contact->neighbors.pairs.count; first += PAIRS, now = !now) {
    count[!now] = next_due(state, model, contact, first + PAIRS, due[!now]);
    s.count = 0;
    for (uint32_t k = 0; k < count[now]; k++)
      look_at_pair(state, model, contact, due[now][k], &s);
    if (!settle_columns(state, model, contact, &s, fault))
      return false;
  }
  return true;
}
