#include "bead/meet.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/registers.h"

/* Does a particle come within a distance of the bead, if both fly freely? apart: at the start, a0; go: by how much that
 * changes in the flight. */
static bool comes_within(struct vec3 apart, struct vec3 go, double distance)
{
  const double square = vec3_dot(go, go), along = -vec3_dot(apart, go);
  const double when = !(along > 0.0) ? 0.0 : along < square ? along / square : 1.0;
  const struct vec3 nearest = vec3_add_scaled(apart, when, go);
  return !(vec3_dot(nearest, nearest) > distance * distance);
}

/* The same of a particle that hits a wall: does its way, wherever it leads, get so far? way: its length along each
 * axis, a0. */
static bool gets_within(struct vec3 apart, struct vec3 way, double distance)
{
  return vec3_norm(apart) <= distance + vec3_norm(way) && fabs(apart.x) <= distance + fabs(way.x) &&
         fabs(apart.y) <= distance + fabs(way.y) && fabs(apart.z) <= distance + fabs(way.z);
}

/* Walls have given to this particle, in its flight without a bead, what is entered in the state. */
static void take_back(const struct state *state, const struct model *model, const struct span *span, uint32_t i,
                      struct bead_flight *all)
{
  const struct solvent *s = &state->solvent;
  struct point sums[WALLS] = {{0, 0, 0}};
  uint64_t turns[WALLS] = {0};
  boundary_enter_hits(model, span, (struct point){s->x[i], s->y[i], s->z[i]}, solvent_velocity(s, i),
                      (struct account){sums, turns});
  for (enum wall wall = 0; wall < WALLS; wall++)
    account_add_units(&all->given[wall], &all->turns[wall], point_minus((struct point){0, 0, 0}, sums[wall]));
}

static bool take(struct bead_flight *all, struct bead_visit m, uint64_t step, struct fault *fault)
{
  if (all->n == all->room && !memory_double((void **)&all->at, &all->room, 64, sizeof *all->at))
    return fault_no_memory(fault, step);
  all->at[all->n++] = m;
  return true;
}

#define ROUNDING 1e-6 /* a0: more than what ticks and doubles round */

/* The speed of the faster wall, a0/t0. */
static double wall_speed(const struct bead_flight *all)
{
  return all->walled ? fmax(vec3_norm(all->slit.wall[WALL_LOWER]), vec3_norm(all->slit.wall[WALL_UPPER])) : 0.0;
}

/* at, v: of a particle at the start, its velocity that of the middle of the flight. */
static bool may_meet(const struct bead_flight *all, struct point at, struct vec3 v, double distance)
{
  const double t = all->way.time;
  const struct vec3 apart = point_in_a0(at), way = vec3_scale(t, v);
  const int64_t end = at.y + lattice_from_a0(way.y);
  if (all->walled && (end < all->height[WALL_LOWER] || end > all->height[WALL_UPPER]))
    return gets_within(apart, way, distance + t * (vec3_norm(all->free) + 2.0 * wall_speed(all)));
  return comes_within(apart, vec3_scale(t, vec3_sub(v, all->free)), distance);
}

enum { BLOCK = 64 }; /* particles looked at together, registers of them at once */

/* What a sweep over all particles knows of the bead; lattice units. */
struct sweep {
  double at[3], edge[3];    /* its place in the box; the box */
  double most, time;        /* a particle of velocity v is looked at if along each axis it is nearer than
                             * most + time |v|, */
  double reach, per_square; /* and if the square of its distance is below reach + per_square v^2 */
};

/* (c + t v)^2 is at most 1.1 c^2 + 11 (t v)^2. */
static struct sweep sweep_of(const struct state *state, const struct model *model, const struct span *span,
                             double slack, const struct bead_flight *all)
{
  const int64_t *const edge = model->box.edge;
  const struct point c = state->bead->position;
  const double t = span->time, time = t * LATTICE_PER_A0,
               most = model->bead.radius + slack + ROUNDING + t * vec3_norm(state->bead->velocity) +
                      t * t * vec3_norm(span->acceleration) + 2.0 * t * wall_speed(all),
               units = most * LATTICE_PER_A0;
  const double beyond = all->walled ? 4.0 : 1.0; /* no image is near across walls */
  return (struct sweep){.at = {(double)lattice_fold(c.x, edge[0]),
                               (double)(all->walled ? c.y : lattice_fold(c.y, edge[1])),
                               (double)lattice_fold(c.z, edge[2])},
                        .edge = {(double)edge[0], beyond * (double)edge[1], (double)edge[2]},
                        .most = units,
                        .time = time,
                        .reach = 1.1 * units * units,
                        .per_square = 11.0 * time * time};
}

INLINE reals size_of(reals x)
{
  const words zero = {0};
  return (reals)((words)x & (zero - 1) >> 1);
}

/* Is one of a block's particles within reach along an axis? Of most blocks none is, for particles stand in memory by
 * cells, more or less. A distance d within the box is half - |d - half| to the nearest image. */
static bool any_near(const struct sweep *w, int axis, const int64_t *x, const double *v, uint32_t n)
{
  const double half = 0.5 * w->edge[axis], at = w->at[axis], inner = half - w->most, time = w->time;
  words near = {0};
  for (uint32_t k = 0; k < n; k += LANES) {
    const reals d = size_of(reals_from_small_less(load_words(&x[k]), at));
    near |= (words)(size_of(d - half) >= inner - time * size_of(load_reals(&v[k])));
  }
  return any(near) != 0;
}

static void add_squares(const struct sweep *w, int axis, const int64_t *x, const double *v, uint32_t n, double *square)
{
  const double edge = w->edge[axis], at = w->at[axis], per_square = w->per_square;
  for (uint32_t k = 0; k < n; k += LANES) {
    const reals d = size_of(reals_from_small(load_words(&x[k])) - at), speed = load_reals(&v[k]),
                apart = choose(d + d < edge, d, edge - d);
    store_reals(&square[k], load_reals(&square[k]) + (apart * apart - per_square * (speed * speed)));
  }
}

/* The squares of n particles' distances, from the first on; false if no one may meet the bead. If they do not fill
 * their registers the squares are 0: all are looked at. */
static bool squares_of(const struct sweep *w, const struct solvent *s, uint32_t first, uint32_t n, double square[BLOCK])
{
  const bool whole = n % LANES == 0;
  if (whole && (!any_near(w, 2, &s->z[first], &s->vz[first], n) || !any_near(w, 1, &s->y[first], &s->vy[first], n)))
    return false;
  memset(square, 0, BLOCK * sizeof *square);
  if (!whole)
    return true;
  add_squares(w, 0, &s->x[first], &s->vx[first], n, square);
  add_squares(w, 1, &s->y[first], &s->vy[first], n, square);
  add_squares(w, 2, &s->z[first], &s->vz[first], n, square);
  return true;
}

bool bead_meet(const struct state *state, const struct model *model, double known, double slack,
               struct bead_flight *all, struct fault *fault)
{
  const struct solvent *s = &state->solvent;
  const struct span span = bead_span(state, model);
  const struct sweep w = sweep_of(state, model, &span, slack, all);
  const double t = span.time, radius = model->bead.radius + ROUNDING;
  for (uint32_t first = 0; first < s->n; first += BLOCK) {
    const uint32_t n = s->n - first < BLOCK ? s->n - first : BLOCK;
    double square[BLOCK];
    if (!squares_of(&w, s, first, n, square))
      continue;
    for (uint32_t i = first; i < first + n; i++) {
      if (square[i - first] > w.reach)
        continue;
      const struct vec3 v = vec3_add_scaled(solvent_velocity(s, i), 0.5 * t, span.acceleration);
      const struct point at =
          bead_to_image(&model->box, state->bead->position, (struct point){s->x[i], s->y[i], s->z[i]});
      if (!may_meet(all, at, v, radius + slack) || (known >= 0.0 && may_meet(all, at, v, radius + known)))
        continue;
      if (all->walled)
        take_back(state, model, &span, i, all);
      if (!take(all, (struct bead_visit){.place = i, .at = at, .rate = bead_rate(v, t), .velocity = v}, state->step + 1,
                fault))
        return false;
    }
  }
  return true;
}
