#include "contact/neighbors.h"

#include <string.h>

#include "base/memory.h"
#include "contact/capsule.h"
#include "contact/drift.h"
#include "contact/pairs.h"
#include "contact/search_cells.h"

#define OVERLAPS 256 /* collected before they are looked at */
#define COLUMNS 64   /* looked at together: bits of a word */
#define FIRST_NEAR 64

static bool add_near(struct neighbor_list *list, struct neighbor n)
{
  if (list->count == list->room && !memory_double((void **)&list->at, &list->room, FIRST_NEAR, sizeof *list->at))
    return false;
  list->at[list->count++] = n;
  return true;
}

static struct search_box box_of(const struct neighbors *nb, const struct model *model, uint32_t bond)
{
  const struct reference_position *p = &nb->reference[bond], *q = &nb->reference[model->next[bond]];
  return search_box_around(p->at, q->at, capsule_most(p->skin, q->skin) + nb->around);
}

/* Pairs of bonds whose boxes overlap, before the distance is tested. near: if not NULL, the other bonds are listed
 * there; if NULL, pairs whose capsules are not apart enter the pair list. */
struct search {
  struct neighbor_list *near;
  uint32_t count;
  struct overlap {
    struct grid_bond mine, its; /* in the same cell */
  } at[OVERLAPS];
};

static bool leave_cell(struct neighbors *nb, const struct model *model, uint32_t cell, const struct grid_entry *e,
                       struct search *found)
{
  (void)model, (void)found;
  struct grid_row *row = &nb->entries[cell];
  uint64_t mine = 0;
  for (uint32_t first = 0; first < row->count && !mine; first += COLUMNS) {
    const uint32_t left = row->count - first;
    mine = search_entry_of(e->is, &row->at[first], left < COLUMNS ? left : COLUMNS);
    if (mine)
      row->at[first + (uint32_t)__builtin_ctzll(mine)] = row->at[--row->count];
  }
  return true;
}

/* Thick fibers that are never partners: a bond and its image; those that share a vertex; those that are near along the
 * contour. */
static bool never_touch(const struct model *model, uint32_t bond, const struct neighbor *n)
{
  const uint32_t other = (uint32_t)n->bond;
  const bool image = n->image[0] != 0 || n->image[1] != 0 || n->image[2] != 0;
  return bond == other ||
         (!image && (model_share_vertex(model, bond, other) || model_tube_is_blind(model, bond, other)));
}

/* Between walls there are no images along y. */
static bool is_beyond_wall(const struct model *model, const struct neighbor *n)
{
  return n->image[1] != 0 && model_has_walls(model);
}

/* Pairs whose distances are computed together, in columns. p, q: both bond vectors between reference positions; w:
 * from the first end of p to that of q; reach: of both; all in a0. */
struct columns {
  uint32_t count;
  uint32_t bond[COLUMNS];
  struct neighbor other[COLUMNS];
  double p[3][COLUMNS], q[3][COLUMNS], w[3][COLUMNS], reach[COLUMNS];
};

/* Which image of the other bond overlaps. home: image of the box in which the first end of `mine` lies. */
static struct neighbor neighbor_of(const struct neighbors *nb, const struct model *model, const struct overlap *c,
                                   const struct image *home)
{
  const struct image its_home = search_image(nb, nb->reference[c->its.bond].at, &model->box);
  struct neighbor n = {.bond = c->its.bond};
  for (int axis = 0; axis < 3; axis++)
    n.image[axis] = home->k[axis] - its_home.k[axis] + c->mine.image[axis] - c->its.image[axis];
  return n;
}

static void fill_column(const struct neighbors *nb, const struct model *model, uint32_t bond, struct neighbor n,
                        struct columns *s)
{
  const uint32_t k = s->count;
  const struct reference_position *a = &nb->reference[bond], *b = &nb->reference[model->next[bond]],
                                  *c = &nb->reference[n.bond], *d = &nb->reference[model->next[n.bond]];
  const struct vec3 p = point_difference(b->at, a->at), q = point_difference(d->at, c->at),
                    w = point_difference(point_image(c->at, n.image, &model->box), a->at);
  s->bond[k] = bond, s->other[k] = n;
  s->p[0][k] = p.x, s->p[1][k] = p.y, s->p[2][k] = p.z;
  s->q[0][k] = q.x, s->q[1][k] = q.y, s->q[2][k] = q.z;
  s->w[0][k] = w.x, s->w[1][k] = w.y, s->w[2][k] = w.z;
  s->reach[k] = capsule_most(a->skin, b->skin) + capsule_most(c->skin, d->skin) + nb->apart;
}

/* Adds those pairs to the pair list whose capsules are not apart. */
static bool add_pairs(struct neighbors *nb, const struct columns *restrict s)
{
  int64_t apart[COLUMNS];
  for (uint32_t k = 0; k < s->count; k++) {
    const struct vec3 p = {s->p[0][k], s->p[1][k], s->p[2][k]}, q = {s->q[0][k], s->q[1][k], s->q[2][k]},
                      w = {s->w[0][k], s->w[1][k], s->w[2][k]};
    apart[k] = capsule_distance(p, q, w) > s->reach[k];
  }
  for (uint32_t k = 0; k < s->count; k++)
    if (!apart[k] && !pairs_add(nb, s->bond[k], s->other[k]))
      return false;
  return true;
}

/* Empties the list of overlaps: into `near` or the pair list, see struct search. */
static bool settle(struct neighbors *nb, const struct model *model, struct search *found)
{
  const bool thin = model->thickness == 0;
  struct image home = {{0, 0, 0}};
  int32_t home_of = -1;
  struct columns s;
  s.count = 0;
  for (uint32_t k = 0; k < found->count; k++) {
    const struct overlap *c = &found->at[k];
    const uint32_t bond = (uint32_t)c->mine.bond;
    /* thin lines cannot cross these, or their images */
    if (thin && model_share_vertex(model, bond, (uint32_t)c->its.bond))
      continue;
    if (c->mine.bond != home_of)
      home = search_image(nb, nb->reference[bond].at, &model->box), home_of = c->mine.bond;
    const struct neighbor n = neighbor_of(nb, model, c, &home);
    const bool apart = (!thin && never_touch(model, bond, &n)) || is_beyond_wall(model, &n);
    if (found->near) {
      if (!apart && !add_near(found->near, n))
        return false;
      continue;
    }
    fill_column(nb, model, bond, n, &s);
    s.count += !apart;
    if (s.count == COLUMNS) {
      if (!add_pairs(nb, &s))
        return false;
      s.count = 0;
    }
  }
  found->count = 0;
  return add_pairs(nb, &s);
}

/* Collects the bonds of a cell whose boxes overlap with this one's. */
static bool look_into_cell(struct neighbors *nb, const struct model *model, uint32_t cell,
                           const struct grid_entry *mine, struct search *found)
{
  const struct grid_row *row = &nb->entries[cell];
  const struct search_probe probe = search_probe_of(mine->key);
  for (uint32_t first = 0; first < row->count; first += COLUMNS) {
    const uint32_t left = row->count - first, n = left < COLUMNS ? left : COLUMNS;
    if (found->count + n > OVERLAPS && !settle(nb, model, found))
      return false;
    for (uint64_t hits = search_overlaps(probe, &row->at[first], n); hits; hits &= hits - 1) {
      const struct grid_bond its = row->at[first + (uint32_t)__builtin_ctzll(hits)].is;
      found->at[found->count++] = (struct overlap){mine->is, its};
      __builtin_prefetch(&nb->reference[its.bond]);
      __builtin_prefetch(&nb->reference[its.bond + 1]);
      __builtin_prefetch(&model->next[its.bond]);
    }
  }
  return true;
}

static bool enter_cell(struct neighbors *nb, const struct model *model, uint32_t cell, const struct grid_entry *mine,
                       struct search *found)
{
  return look_into_cell(nb, model, cell, mine, found) && search_enter_cell(&nb->entries[cell], mine);
}

/* --- the entrances ----------------------------------------------------------------------------------------------- */

/* Without a solvent vertices keep going, and a reference position serves longer if it stands ahead of its vertex. The
 * velocity that lasts is the mean over a few neighbors, in which the vibrations of bonds cancel. With a solvent there
 * is no lead: velocities change before the vertex gets there. */
static struct vec3 lead_of(const struct state *state, const struct model *model, const struct drift_frame *frame,
                           uint32_t vertex, double most)
{
  const int on_each_side = 2;
  const double time = 0.3; /* t0 */
  struct vec3 sum = state->velocity[vertex];
  int32_t before = (int32_t)vertex, after = before;
  double n = 1.0;
  if (model->solvent.per_cell > 0.0)
    return (struct vec3){0, 0, 0};
  for (int k = 0; k < on_each_side; k++) {
    before = model->prev[before] < 0 ? before : model->prev[before];
    after = model->next[after] < 0 ? after : model->next[after];
    sum = vec3_add_scaled(vec3_add_scaled(sum, 1.0, state->velocity[before]), 1.0, state->velocity[after]);
    n += 2.0;
  }
  const struct vec3 mean = vec3_scale(1.0 / n, sum);
  const struct vec3 lead =
      frame->sheared ? vec3_scale(time / frame->time, drift_displacement(frame, mean, state->position[vertex].y))
                     : vec3_scale(time, vec3_sub(mean, frame->velocity));
  const double length = vec3_norm(lead);
  return length > most ? vec3_scale(most / length, lead) : lead;
}

/* A reference position and a skin that contain both ends of a move, whether it is made or rejected. */
static struct reference_position reference_of_move(const struct state *state, const struct model *model,
                                                   const struct contact *contact, uint32_t vertex, struct point from,
                                                   struct point to)
{
  const struct point d = point_minus(to, from);
  const double length = vec3_norm(point_difference(to, from));
  struct point at = point_minus(to, contact->neighbors.moved);
  if (length > NEIGHBORS_SKIN) /* from its middle */
    at = (struct point){at.x - d.x / 2, at.y - d.y / 2, at.z - d.z / 2};
  else
    at = point_move(at, lead_of(state, model, &contact->frame, vertex, 0.7 * (NEIGHBORS_SKIN - length)));
  return (struct reference_position){at, fmax(NEIGHBORS_SKIN, 0.5 * length + LATTICE_UNIT)};
}

/* Enters bonds into the grid and finds their pairs, after they got new reference positions. */
static bool enter(struct neighbors *nb, const struct model *model, uint32_t bonds, const uint32_t *bond)
{
  struct search found;
  found.near = NULL, found.count = 0;
  for (uint32_t k = 0; k < bonds; k++)
    if (!search_visit(nb, model, bond[k], box_of(nb, model, bond[k]), enter_cell, &found))
      return false;
  return settle(nb, model, &found);
}

/* Prefetches a row of the grid. */
static bool fetch_cell(struct neighbors *nb, const struct model *model, uint32_t cell, const struct grid_entry *e,
                       struct search *found)
{
  (void)model, (void)e, (void)found;
  const char *row = (const char *)&nb->entries[cell];
  for (size_t line = 0; line < sizeof nb->entries[cell]; line += 64)
    __builtin_prefetch(row + line, 1);
  return true;
}

void neighbors_fetch(struct neighbors *nb, const struct model *model, uint32_t vertex)
{
  uint32_t bond[2];
  const int bonds = model_bonds_of(model, vertex, bond);
  for (int b = 0; b < bonds; b++)
    search_visit(nb, model, bond[b], box_of(nb, model, bond[b]), fetch_cell, NULL);
}

bool neighbors_renew(const struct state *state, const struct model *model, struct contact *contact, uint32_t n,
                     const uint32_t *vertex, const struct point *from, const struct point *to, struct fault *fault)
{
  struct neighbors *nb = &contact->neighbors;
  uint32_t bond[2 * NEIGHBORS_AT_ONCE] = {0};
  const uint32_t bonds = model_bonds_at(model, n, vertex, bond);
  for (uint32_t k = 0; k < bonds; k++) {
    search_visit(nb, model, bond[k], box_of(nb, model, bond[k]), leave_cell, NULL);
    nb->generation[bond[k]]++;
  }
  for (uint32_t k = 0; k < n; k++) {
    nb->reference[vertex[k]] = reference_of_move(state, model, contact, vertex[k], from[k], to[k]);
    nb->hold[vertex[k]] = 0;
  }
  nb->renewed += n;
  return enter(nb, model, bonds, bond) || fault_no_memory(fault, state->step + 1);
}

bool neighbors_near(const struct state *state, const struct model *model, struct contact *contact, uint32_t bond,
                    const struct point end[2], double range, struct neighbor_list *near, struct fault *fault)
{
  struct neighbors *nb = &contact->neighbors;
  const struct search_box box =
      search_box_around(point_minus(end[0], nb->moved), point_minus(end[1], nb->moved), range + CAPSULE_SLACK);
  struct search found;
  found.near = near, found.count = 0;
  near->count = 0;
  return (search_visit(nb, model, bond, box, look_into_cell, &found) && settle(nb, model, &found)) ||
         fault_no_memory(fault, state->step + 1);
}

/* A bond visits all search cells around it, of which there must not be 10^18. Forces find every bond that is half an
 * edge long before the next drift; half a drift adds less than one edge. */
static bool spans_few_cells(const struct state *state, const struct model *model, uint32_t bond, struct fault *fault)
{
  const double length = vec3_norm(point_difference(state->position[model->next[bond]], state->position[bond]));
  return length <= 2.0 * box_shortest_edge(&model->box) ||
         fault_record(fault, FAULT_BOND_TOO_LONG, state->step + 1, bond, length, model_longest_bond(model));
}

bool neighbors_build(const struct state *state, const struct model *model, struct contact *contact, struct fault *fault)
{
  struct neighbors *nb = &contact->neighbors;
  if (!search_cells_alloc(model, nb))
    return fault_no_memory(fault, state->step + 1);
  nb->pairs.count = 0;
  nb->around = 0.5 * model_thickness(model) + CAPSULE_SLACK;
  nb->apart = model_thickness(model) + CAPSULE_SLACK;
  for (uint32_t c = 0; c < nb->cell_count; c++)
    nb->entries[c].count = 0;
  for (uint32_t j = 0; j < model->vertices; j++) {
    nb->reference[j] = (struct reference_position){state->position[j], NEIGHBORS_SKIN};
    nb->hold[j] = 0;
  }
  for (uint32_t j = 0; j < model->vertices; j++)
    if (model->next[j] >= 0 && (!spans_few_cells(state, model, j, fault) || !enter(nb, model, 1, &j)))
      return fault_no_memory(fault, state->step + 1); /* or the fault that is there already */
  nb->moved = (struct point){0, 0, 0};
  nb->built = true;
  return true;
}
