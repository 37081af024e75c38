#include "fiber/meetings.h"

#include <string.h>

#include "base/memory.h"
#include "fiber/capsule.h"
#include "fiber/neighbors.h"
#include "fiber/pairs.h"

enum { PAIRS = 256, FIRST_MEETINGS = 1024 }; /* pairs worked on at a time; room at first */

/* --- paths ------------------------------------------------------------------------------------------------------- */

/* A way in units of a path, rounded up. What is beyond 64 a0 does not matter, for no pair waits for more than 32; so
 * between two sweeps two paths grow by less than 2^31 units, 2048 a0, where the sign of a difference would turn. */
static inline uint32_t path_units(double way)
{
  return (uint32_t)(int32_t)(capsule_least(way, 64.0) * 0x1p20) + 1;
}

/* All paths, longer by this sweep. */
static void lengthen_paths(const struct model *model, struct fiber_work *f)
{
  const double *restrict range = f->range;
  const int32_t *restrict next = model->next;
  struct bond_clock *restrict clock = f->neighbors.clock;
  for (uint32_t j = 0; j < model->vertices; j++)
    clock[j].path += path_units(capsule_most(range[j], range[next[j] < 0 ? (int32_t)j : next[j]]));
}

void meetings_widen(const struct model *model, struct fiber_work *f, uint32_t i, double range)
{
  uint32_t bond[2];
  const int bonds = model_bonds_of(model, i, bond);
  for (int b = 0; b < bonds; b++)
    f->neighbors.clock[bond[b]].path -= path_units(meetings_range(model, f, bond[b]));
  f->range[i] = range;
  for (int b = 0; b < bonds; b++)
    f->neighbors.clock[bond[b]].path += path_units(meetings_range(model, f, bond[b]));
}

/* --- pairs that are due ------------------------------------------------------------------------------------------ */

/* Pairs first .. first + n - 1 whose paths are longer than their limits; how many. */
static uint32_t list_due(const struct neighbors *nb, uint32_t first, uint32_t n, uint32_t *restrict due)
{
  if (n == 0) /* there may be no list yet */
    return 0;
  const uint32_t *restrict bond = &nb->pairs.bond[first], *restrict other = &nb->pairs.other[first],
                           *restrict limit = &nb->pairs.limit[first];
  const struct bond_clock *restrict clock = nb->clock;
  uint32_t left[PAIRS], count = 0;
  for (uint32_t k = 0; k < n; k++)
    left[k] = limit[k] - clock[bond[k]].path - clock[other[k]].path;
  for (uint32_t k = 0; k < n; k++) {
    due[count] = first + k;
    count += left[k] >> 31; /* less than 0 */
  }
  return count;
}

/* Pairs that are due. Their columns, in a0: both bond vectors, from the first end of the one to that of the other; and
 * their paths before this sweep. */
struct columns {
  uint32_t count;
  uint32_t pair[PAIRS];
  uint32_t path[PAIRS];
  double p[3][PAIRS], q[3][PAIRS], w[3][PAIRS];
};

static void fill_column(const struct state *state, const struct model *model, const struct fiber_work *f, uint32_t pair,
                        struct columns *s)
{
  const struct pair_list *list = &f->neighbors.pairs;
  const struct bond_clock *clock = f->neighbors.clock;
  const uint32_t k = s->count++, i = list->bond[pair], j = (uint32_t)model->next[i], l = list->other[pair],
                 m = (uint32_t)model->next[l];
  const struct point *at = state->position;
  const struct vec3 p = point_difference(at[j], at[i]), q = point_difference(at[m], at[l]),
                    w = point_difference(point_image(at[l], list->image[pair].k, &model->box), at[i]);
  s->pair[k] = pair;
  s->path[k] =
      clock[i].path - path_units(meetings_range(model, f, i)) + clock[l].path - path_units(meetings_range(model, f, l));
  s->p[0][k] = p.x, s->p[1][k] = p.y, s->p[2][k] = p.z;
  s->q[0][k] = q.x, s->q[1][k] = q.y, s->q[2][k] = q.z;
  s->w[0][k] = w.x, s->w[1][k] = w.y, s->w[2][k] = w.z;
}

/* How long the two paths of each pair may get until the bonds touch: what they were before this sweep, and the distance
 * of the bonds. */
static void limit_columns(const struct columns *restrict s, uint32_t *restrict limit)
{
  for (uint32_t k = 0; k < s->count; k++) {
    const struct vec3 p = {s->p[0][k], s->p[1][k], s->p[2][k]}, q = {s->q[0][k], s->q[1][k], s->q[2][k]},
                      w = {s->w[0][k], s->w[1][k], s->w[2][k]};
    const double apart = capsule_most(capsule_distance(p, q, w) - CAPSULE_SLACK, 0.0);
    limit[k] = s->path[k] + (uint32_t)(int32_t)(capsule_least(apart, 32.0) * 0x1p20);
  }
}

/* --- the list of meetings ---------------------------------------------------------------------------------------- */

static bool add_meeting(const struct state *state, struct work *work, uint32_t bond, struct neighbor n)
{
  struct meeting_list *list = &work->fiber.meetings;
  if (list->count == list->room && !memory_double((void **)&list->at, &list->room, FIRST_MEETINGS, sizeof *list->at))
    return work_no_memory(work, state->step + 1);
  list->at[list->count] = (struct meeting){bond, n, list->first[bond]};
  list->first[bond] = ++list->count;
  return true;
}

static bool meets(const struct meeting_list *list, uint32_t bond, const struct neighbor *n)
{
  for (uint32_t m = list->first[bond]; m; m = list->at[m - 1].next)
    if (memcmp(&list->at[m - 1].with, n, sizeof *n) == 0)
      return true;
  return false;
}

bool meetings_add(const struct state *state, struct work *work, uint32_t bond, const struct neighbor *n)
{
  const struct neighbor back = {(int32_t)bond, {-n->image[0], -n->image[1], -n->image[2]}};
  return meets(&work->fiber.meetings, bond, n) ||
         (add_meeting(state, work, bond, *n) && add_meeting(state, work, (uint32_t)n->bond, back));
}

static void forget_meetings(struct meeting_list *list)
{
  for (uint32_t m = 0; m < list->count; m++)
    list->first[list->at[m].bond] = 0;
  list->count = 0;
}

/* --- who may meet whom ------------------------------------------------------------------------------------------- */

/* Pairs that may touch in this sweep meet; the others say when they are next due. */
static bool settle_columns(const struct state *state, const struct model *model, struct work *work,
                           const struct columns *s)
{
  struct fiber_work *f = &work->fiber;
  struct pair_list *list = &f->neighbors.pairs;
  uint32_t limit[PAIRS];
  limit_columns(s, limit);
  for (uint32_t k = 0; k < s->count; k++) {
    const uint32_t pair = s->pair[k], i = list->bond[pair], l = list->other[pair];
    list->limit[pair] = limit[k];
    if ((limit[k] - f->neighbors.clock[i].path - f->neighbors.clock[l].path) >> 31 == 0)
      continue;
    const int32_t *image = list->image[pair].k;
    const struct neighbor n = {(int32_t)l, {image[0], image[1], image[2]}};
    if (!meetings_add(state, work, i, &n))
      return false;
    f->waits[i] = f->waits[model->next[i]] = f->waits[l] = f->waits[model->next[l]] = 1;
  }
  return true;
}

static void fetch_due(const struct state *state, const struct model *model, const struct fiber_work *f, uint32_t pair)
{
  const uint32_t bonds[2] = {f->neighbors.pairs.bond[pair], f->neighbors.pairs.other[pair]};
  for (int b = 0; b < 2; b++) {
    __builtin_prefetch(&state->position[bonds[b]]);
    __builtin_prefetch(&state->position[bonds[b] + 1].z);
    __builtin_prefetch(&f->range[bonds[b]]);
    __builtin_prefetch(&model->next[bonds[b]]);
  }
  __builtin_prefetch(&f->neighbors.pairs.image[pair]);
}

/* One of the pairs that are due. One that is out of date goes, and what takes its place is looked at now, due or not:
 * under its old number, which is then beyond the end, a list made before passes it over. */
static void look_at_pair(const struct state *state, const struct model *model, struct fiber_work *f, uint32_t pair,
                         struct columns *s)
{
  struct neighbors *nb = &f->neighbors;
  while (pair < nb->pairs.count && pairs_out_of_date(nb, pair))
    pairs_drop(nb, pair);
  if (pair < nb->pairs.count)
    fill_column(state, model, f, pair, s);
}

/* The next pairs that are due, from number `first` on; memory is asked for what they will need. */
static uint32_t next_due(const struct state *state, const struct model *model, const struct fiber_work *f,
                         uint32_t first, uint32_t *due)
{
  const uint32_t end = f->neighbors.pairs.count, left = first < end ? end - first : 0;
  const uint32_t count = list_due(&f->neighbors, first, left < PAIRS ? left : PAIRS, due);
  for (uint32_t k = 0; k < count; k++)
    fetch_due(state, model, f, due[k]);
  return count;
}

bool meetings_find(const struct state *state, const struct model *model, struct work *work)
{
  struct fiber_work *f = &work->fiber;
  uint32_t due[2][PAIRS] = {{0}}, count[2], now = 0;
  struct columns s;
  forget_meetings(&f->meetings);
  lengthen_paths(model, f);
  count[0] = next_due(state, model, f, 0, due[0]);
  for (uint32_t first = 0; first < f->neighbors.pairs.count; first += PAIRS, now = !now) {
    count[!now] = next_due(state, model, f, first + PAIRS, due[!now]);
    s.count = 0;
    for (uint32_t k = 0; k < count[now]; k++)
      look_at_pair(state, model, f, due[now][k], &s);
    if (!settle_columns(state, model, work, &s))
      return false;
  }
  return true;
}
