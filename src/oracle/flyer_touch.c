/* A contact of a drift: where it is, its normal, and the forces on its vertices. */
#include <math.h>

#include "contact/capsule.h"
#include "contact/determinant.h"
#include "oracle/flyer.h"

struct bond_there {
  bool there;
  struct vec3 unit, pull;
  double inverse;
};

static struct bond_there bond_at(const struct flyer *f, int64_t first, int64_t last, int32_t tick)
{
  struct bond_there b = {first >= 0 && last >= 0, {0, 0, 0}, {0, 0, 0}, 0.0};
  if (!b.there)
    return b;
  const bool stale = f->t->force == FORCE_OF_START;
  const struct vec3 r = point_difference(stale ? f->origin[last] : flyer_place(f, last, tick),
                                         stale ? f->origin[first] : flyer_place(f, first, tick));
  const double length = sqrt(vec3_dot(r, r)), k = flyer_constant(f, first, 2), rest = flyer_constant(f, first, 1);
  b.inverse = 1.0 / length, b.unit = vec3_scale(b.inverse, r);
  b.pull = rest == 0.0 ? vec3_scale(k, r) : vec3_scale(k * (length - rest), b.unit);
  return b;
}

static void bend_of(double kappa, const struct bond_there *a, const struct bond_there *b, struct vec3 *before,
                    struct vec3 *after)
{
  const double c = vec3_dot(a->unit, b->unit);
  *before = vec3_scale(-kappa * a->inverse, vec3_add_scaled(b->unit, -c, a->unit));
  *after = vec3_scale(kappa * b->inverse, vec3_add_scaled(a->unit, -c, b->unit));
}

static struct vec3 force_on(const struct flyer *f, int64_t v, int32_t tick)
{
  const int64_t prev = flyer_prev(f, v), next = flyer_next(f, v);
  const double kappa = flyer_constant(f, v, 3);
  const struct bond_there before = bond_at(f, prev, v, tick), after = bond_at(f, v, next, tick);
  struct vec3 force = {flyer_constant(f, v, 4), flyer_constant(f, v, 5), flyer_constant(f, v, 6)}, a, b;
  if (f->t->force == FORCE_NOT_CONSTANT)
    force = (struct vec3){0, 0, 0};
  if (f->t->force != FORCE_BENDS_ONLY)
    force = vec3_add(vec3_sub(force, before.pull), after.pull);
  if (kappa == 0.0 || f->t->force == FORCE_BONDS_ONLY)
    return force;
  const struct bond_there far = bond_at(f, prev < 0 ? -1 : flyer_prev(f, prev), prev, tick),
                          beyond = bond_at(f, next, next < 0 ? -1 : flyer_next(f, next), tick);
  if (before.there && far.there) {
    bend_of(kappa, &far, &before, &a, &b);
    force = vec3_add(force, b);
  }
  if (before.there && after.there) {
    bend_of(kappa, &before, &after, &a, &b);
    force = vec3_sub(force, vec3_add(a, b));
  }
  if (after.there && beyond.there) {
    bend_of(kappa, &after, &beyond, &a, &b);
    force = vec3_add(force, a);
  }
  return force;
}

static double volume_at(const struct flight_pair *f, int32_t tick)
{
  const struct point p = flight_place(f->p, f->p_rate, tick), q = flight_place(f->q, f->q_rate, tick),
                     w = flight_place(f->w, f->w_rate, tick);
  return determinant((struct difference){p.x, p.y, p.z}, (struct difference){q.x, q.y, q.z},
                     (struct difference){w.x, w.y, w.z});
}

static struct vec3 normal_of(const struct flyer *f, double volume, struct vec3 p, struct vec3 q, struct vec3 gap,
                             struct vec3 velocity)
{
  const enum push_rule rule = f->t->push;
  struct vec3 n = vec3_cross(p, q);
  bool parallel = !(vec3_dot(n, n) > 1e-24 * vec3_dot(p, p) * vec3_dot(q, q)) || rule == PUSH_GAP;
  double approach = vec3_dot(n, velocity);
  if (rule == PUSH_UNTURNED      ? false
      : rule == PUSH_BY_APPROACH ? approach < 0.0
                                 : volume < 0.0 || (volume == 0.0 && approach < 0.0))
    n = vec3_scale(-1.0, n), approach = -approach;
  if ((parallel || (volume == 0.0 && !(approach > 0.0))) && rule != PUSH_NO_GAP) {
    n = gap;
    if (!(vec3_dot(n, n) > 0.0))
      n = vec3_add_scaled(velocity, -vec3_dot(velocity, q) / vec3_dot(q, q), q);
  }
  return vec3_scale((rule == PUSH_TURNED ? -1.0 : 1.0) / vec3_norm(n), n);
}

void flyer_touch(const struct flyer *f, const struct found *e, struct touch *c)
{
  const struct flight_pair pair = flyer_pair(f, e);
  const int32_t tick = f->t->push == PUSH_OF_START ? 0 : e->tick;
  const struct point origin = {0, 0, 0};
  const struct vec3 p = point_difference(flight_place(pair.p, pair.p_rate, tick), origin),
                    q = point_difference(flight_place(pair.q, pair.q_rate, tick), origin),
                    w = point_difference(flight_place(pair.w, pair.w_rate, tick), origin);
  *c = (struct touch){.four = {e->bond, flyer_next(f, e->bond), e->other, flyer_next(f, e->other)}};
  capsule_closest(p, q, w, &c->e.s, &c->e.t);
  const double lever[4] = {1.0 - c->e.s, c->e.s, c->e.t - 1.0, -c->e.t}, volume = volume_at(&pair, tick);
  struct vec3 velocity = {0, 0, 0};
  for (int k = 0; k < 4; k++) {
    c->e.velocity[k] = f->v[c->four[k]];
    c->e.force[k] = force_on(f, c->four[k], e->tick);
    c->e.mass[k] = flyer_constant(f, c->four[k], 0);
    velocity = vec3_add_scaled(velocity, lever[k], c->e.velocity[k]);
  }
  const struct vec3 gap = capsule_between(p, q, w, c->e.s, c->e.t);
  c->touching = volume == 0.0 && vec3_norm(gap) < 0.25 * LATTICE_UNIT && !f->t->touching_answered;
  c->e.normal = normal_of(f, volume, p, q, gap, velocity);
  const double share = (double)e->tick / FLIGHT_TICKS;
  c->e.tau = f->t->tau == TAU_OF_START ? f->dt * share
             : f->t->tau == TAU_OF_END ? f->dt * share - f->dt
                                       : f->begin + f->dt * share;
}
