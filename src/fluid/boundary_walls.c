/*
 * Flights between walls at y = 0 and y = L, which move in their own planes. No force acts along y.
 *
 * A particle that hits a wall of velocity w leaves it with the velocity 2 w - v; at a slip wall only v_y is reversed.
 * It goes on for the rest of the time, and may hit the other wall. Along y that is a reflection of the place where it
 * would be without walls, which is exact in lattice units. The times of hits follow from the same whole numbers: of a
 * flight of length |d| along y, the part y/|d| is before a hit of the lower wall.
 *
 * Without force, and with walls at rest, a particle that is turned around at the end of its flight comes back to the
 * bit: the displacement along x is then v_x t (y' - y)/d, since all components are reversed at the same times.
 */
#include <stdlib.h>

#include "fluid/boundary.h"
#include "wall/wall.h"

/* What flights between walls have in common. */
struct flight {
  const struct box *box;
  const struct span *span;
  struct slit slit;
  struct account account; /* of hits */
};

static struct flight flight_of(const struct model *model, const struct span *span, struct account account)
{
  return (struct flight){&model->box, span, slit_during(model, span->interval), account};
}

/* A particle on its way: between two hits its velocity is sign v + change, v that at the start of the flight. */
struct way {
  double sign;        /* -1 after an odd number of hits */
  struct vec3 change; /* what force and walls have added, a0/t0 */
  struct vec3 moved;  /* displacement by it, a0 */
};

/* A time without hits. */
static void go_on(struct way *way, const struct flight *f, double time)
{
  const struct vec3 a = f->span->acceleration;
  way->moved = vec3_add_scaled(vec3_add_scaled(way->moved, time, way->change), 0.5 * time * time, a);
  way->change = vec3_add_scaled(way->change, time, a);
}

static void hit(struct way *way, const struct flight *f, enum wall wall, struct vec3 v)
{
  const struct vec3 before = vec3_add_scaled(way->change, way->sign, v);
  const struct vec3 half =
      f->slit.kind == WALL_SLIP ? (struct vec3){0.0, -before.y, 0.0} : vec3_sub(f->slit.wall[wall], before);
  account_enter(f->account, wall, vec3_scale(2.0, half));
  way->change = wall_reflect(&f->slit, wall, way->change);
  way->sign = -way->sign;
}

/* Flies from wall to wall for a displacement of d lattice units along y, not 0. Returns y at the end. */
static int64_t follow(struct way *way, const struct flight *f, int64_t y, int64_t d, struct vec3 v)
{
  const int64_t edge = f->box->edge[1];
  const double per_unit = f->span->time / (double)llabs(d);
  bool down = d < 0;
  int64_t left = llabs(d);
  for (int64_t reach = down ? y : edge - y; left > reach; reach = edge) {
    const enum wall wall = down ? WALL_LOWER : WALL_UPPER;
    go_on(way, f, per_unit * (double)reach);
    hit(way, f, wall, v);
    left -= reach;
    y = wall_height(f->box, wall);
    down = !down;
  }
  go_on(way, f, per_unit * (double)left);
  return down ? y - left : y + left;
}

/* The first component that is beyond the range of lattice_round, or not a number; 0 if none is. */
static double beyond_range(struct vec3 move)
{
  const double component[3] = {move.x, move.y, move.z};
  for (int k = 0; k < 3; k++)
    if (!(fabs(component[k]) < LATTICE_MAX_MOVE))
      return component[k];
  return 0.0;
}

/* A flight along an axis without walls. */
static void fly_along(const struct flight *f, int axis, double a, int64_t *x, double *v)
{
  *x = lattice_fold(*x + boundary_flight(*v, a, f->span->time), f->box->edge[axis]);
  *v += a * f->span->time;
}

static void fly_freely(const struct flight *f, struct point *x, struct vec3 *v)
{
  fly_along(f, 0, f->span->acceleration.x, &x->x, &v->x);
  fly_along(f, 2, f->span->acceleration.z, &x->z, &v->z);
}

/* The flight of a particle that hits a wall; d: as for follow. Returns beyond_range of its displacement, and leaves it
 * where it is if that is not 0. */
static double rebound(const struct flight *f, int64_t d, struct point *x, struct vec3 *v)
{
  const double t = f->span->time;
  const int64_t *edge = f->box->edge;
  struct way way = {.sign = 1.0};
  double beyond = beyond_range(vec3_scale(t, *v));
  if (beyond != 0.0)
    return beyond;
  const int64_t y = follow(&way, f, x->y, d, *v);
  const double ahead = t * ((double)(y - x->y) / (double)d); /* the time in which it goes ahead, less that back */
  const struct vec3 move = {v->x * ahead + way.moved.x, 0.0, v->z * ahead + way.moved.z};
  beyond = beyond_range(move);
  if (beyond != 0.0)
    return beyond;
  x->y = y;
  if (f->slit.kind == WALL_SLIP) {
    fly_freely(f, x, v);
    v->y *= way.sign;
    return 0.0;
  }
  x->x = lattice_fold(x->x + lattice_from_a0(move.x), edge[0]);
  x->z = lattice_fold(x->z + lattice_from_a0(move.z), edge[2]);
  *v = vec3_add_scaled(way.change, way.sign, *v);
  return 0.0;
}

/* --- many particles ---------------------------------------------------------------------------------------------- */

/* Particles looked at together: only few hit a wall, and so there is none among most. */
enum { GROUP = 32 };

/* Moves along y, walls or not. The sign bit of the result is set if one ends outside. */
static int64_t move_across(uint32_t n, int64_t *restrict y, const double *restrict v, double t, int64_t edge)
{
  int64_t outside = 0;
  for (uint32_t i = 0; i < n; i++) {
    y[i] = (int64_t)((uint64_t)y[i] + (uint64_t)boundary_flight(v[i], 0.0, t));
    outside |= y[i] | (int64_t)((uint64_t)edge - (uint64_t)y[i]);
  }
  return outside;
}

/* The same for a block. Returns the number of those that end outside, and their places in `outside`. */
static uint32_t fly_across(uint32_t n, int64_t *y, const double *v, double t, int64_t edge,
                           uint32_t outside[BOUNDARY_BLOCK])
{
  uint32_t count = 0;
  for (uint32_t first = 0; first < n; first += GROUP) {
    const uint32_t m = n - first < GROUP ? n - first : GROUP;
    if (move_across(m, &y[first], &v[first], t, edge) >= 0)
      continue;
    for (uint32_t i = first; i < first + m; i++)
      if (y[i] < 0 || y[i] > edge)
        outside[count++] = i;
  }
  return count;
}

/* Of the flight of a particle that has hit a wall. */
struct end {
  struct point x;
  struct vec3 v;
};

/* Those that have hit a wall fly on their own, from where they were before the block flies along x and z. */
static bool fly_block(struct state *state, const struct model *model, const struct flight *f, uint32_t first,
                      uint32_t n, struct fault *fault)
{
  struct solvent *s = &state->solvent;
  const double t = f->span->time;
  const struct vec3 a = f->span->acceleration;
  const int64_t *edge = f->box->edge;
  uint32_t outside[BOUNDARY_BLOCK];
  struct end end[BOUNDARY_BLOCK];
  const uint32_t hits = fly_across(n, &s->y[first], &s->vy[first], t, edge[1], outside);
  for (uint32_t k = 0; k < hits; k++) {
    const uint32_t i = first + outside[k];
    const int64_t back = (int64_t)((uint64_t)s->y[i] - (uint64_t)boundary_flight(s->vy[i], 0.0, t));
    end[k] = (struct end){{s->x[i], back, s->z[i]}, solvent_velocity(s, i)};
    const double beyond = rebound(f, s->y[i] - back, &end[k].x, &end[k].v);
    if (beyond != 0.0)
      return fault_record(fault, FAULT_SOLVENT_MOVE, state->step + 1, s->id[i], beyond, LATTICE_MAX_MOVE);
  }
  int64_t far = boundary_fly_periodic(n, &s->x[first], &s->vx[first], t, a.x, edge[0]);
  far |= boundary_fly_periodic(n, &s->z[first], &s->vz[first], t, a.z, edge[2]);
  if (far < 0 &&
      !(boundary_fold(state, model, 0, t, first, n, fault) && boundary_fold(state, model, 2, t, first, n, fault)))
    return false;
  for (uint32_t k = 0; k < hits; k++) {
    const uint32_t i = first + outside[k];
    const struct end *r = &end[k];
    s->x[i] = r->x.x, s->y[i] = r->x.y, s->z[i] = r->x.z;
    s->vx[i] = r->v.x, s->vy[i] = r->v.y, s->vz[i] = r->v.z;
  }
  return true;
}

static bool fly_walls(struct state *state, const struct model *model, const struct span *span, uint32_t first,
                      uint32_t n, struct fault *fault)
{
  const struct flight f = flight_of(model, span, account_of(state, ACCOUNT_HITS));
  bool ok = true;
  for (uint32_t i = 0; ok && i < n; i += BOUNDARY_BLOCK)
    ok = fly_block(state, model, &f, first + i, boundary_block(n, i), fault);
  return ok;
}

static void fly_one(const struct model *model, const struct span *span, struct account account, struct point *x,
                    struct vec3 *v)
{
  const struct flight f = flight_of(model, span, account);
  const int64_t d = boundary_flight(v->y, 0.0, span->time), y = (int64_t)((uint64_t)x->y + (uint64_t)d);
  if (wall_is_beyond(&model->box, y)) {
    rebound(&f, d, x, v);
    return;
  }
  x->y = y;
  fly_freely(&f, x, v);
}

static void now_walls(const struct model *model, const struct span *span, struct point *x, struct vec3 *v)
{
  fly_one(model, span, (struct account){NULL, NULL}, x, v);
}

void boundary_enter_hits(const struct model *model, const struct span *span, struct point position,
                         struct vec3 velocity, struct account account)
{
  fly_one(model, span, account, &position, &velocity);
}

const struct boundary boundary_walls = {"walls", fly_walls, now_walls};
