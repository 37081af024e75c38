/*
 * Integrators of dissipative particle dynamics that err, for validation/measure/dpd_integrators.c and its test. No
 * scene has them: a bath that is exact at any step costs no more (medium/bath.h). Between particles of mass 1
 *
 *   F = a (1 - r) e - gamma w^2 (e.v) e + sqrt(2 gamma kT/dt) w theta e,   w = 1 - r,
 *
 * with one normal number theta for each pair and evaluation. The first term is the program's own (medium/repulsion.h),
 * and so is the search for pairs.
 *
 *   euler            explicit: r += v dt, v += F(r, v) dt with the places of before
 *   groot-warren     Groot and Warren, J. Chem. Phys. 107, 4423 (1997), Eq. (21), with their lambda 1/2 or 0.65
 *   semi-implicit    v += F(r, v) dt, r += v dt: what Groot and Warren's is with lambda 1/2
 *   dpd-vv           friction once more after the second half kick (Besold, Vattulainen, Karttunen and Polson, Phys.
 * Rev. E 62, R7611 (2000)) sc-vv            the same until friction and velocities agree leap-frog        v' = v + F(r,
 * (v + v')/2) dt, solved for v' (Pagonabarraga, Hagen and Frenkel, Europhys. Lett. 42, 377 (1998))
 */
#ifndef UNCROSS_DPD_INTEGRATORS_H
#define UNCROSS_DPD_INTEGRATORS_H

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/normal.h"
#include "medium/near.h"
#include "medium/repulsion.h"
#include "step.h"

struct dpd_link {
  uint32_t i, j;     /* numbers */
  struct vec3 along; /* unit vector from j to i */
  double weight;     /* w = 1 - r */
};

/* Of a finished model of MEDIUM_PAIRS without vertices. All arrays are by number. */
struct dpd {
  struct model *model;
  struct state *state;
  struct work *work;
  double friction;     /* gamma, m/t0: half of the model's rate */
  double loudness;     /* factor on the noise; 1 but in tests */
  bool held;           /* particles stay where they are: for tests of one pair */
  uint64_t evaluation; /* address of the noise */
  struct dpd_link *link;
  uint32_t links, room;
  uint32_t close;     /* links below DPD_CLOSE */
  struct vec3 *v;     /* a0/t0 */
  struct vec3 *trial; /* the velocity that friction was last taken with */
  struct vec3 *push;  /* kT/a0: the repulsion */
  struct vec3 *given; /* and the noise */
  struct vec3 *pull;  /* friction */
  struct vec3 *force; /* all, of the evaluation that the next step begins with */
  struct vec3 *scratch;
  struct vec3 *along; /* of the search for velocities that agree */
};

#define DPD_CLOSE 0.1 /* a0 */

enum { DPD_ARRAYS = 8 };

static inline void dpd_arrays(struct dpd *d, struct memory_need need[DPD_ARRAYS])
{
  struct vec3 **array[DPD_ARRAYS] = {&d->v,    &d->trial, &d->push,    &d->given,
                                     &d->pull, &d->force, &d->scratch, &d->along};
  for (int k = 0; k < DPD_ARRAYS; k++)
    need[k] = (struct memory_need){(void **)array[k], d->state->solvent.n, sizeof(struct vec3)};
}

static inline bool dpd_add_links(const struct near_search *s, struct near_pairs *p)
{
  struct dpd *d = s->context;
  uint32_t low[NEAR_BLOCK], high[NEAR_BLOCK];
  uint64_t word[4][NEAR_BLOCK];
  double normal[NEAR_BLOCK];
  while (d->room - d->links < p->n)
    if (!memory_double((void **)&d->link, &d->room, 4096, sizeof *d->link))
      return false;
  for (uint32_t k = 0; k < p->n; k++) {
    const uint32_t i = s->medium->number[p->a[k]], j = s->medium->number[p->b[k]];
    low[k] = i < j ? i : j;
    high[k] = i < j ? j : i;
  }
  random_wide_pair_columns(d->model->seed, RANDOM_BATH_PAIR, d->evaluation, low, high, p->n, word);
  random_normal_third_column(word[2], word[3], p->n, normal);
  const double sigma = d->loudness * sqrt(2.0 * d->friction / d->model->time_step);
  for (uint32_t k = 0; k < p->n; k++) {
    const uint32_t i = s->medium->number[p->a[k]], j = s->medium->number[p->b[k]];
    const struct dpd_link link = {i, j, vec3_scale(1.0 / p->r[k], (struct vec3){p->x[k], p->y[k], p->z[k]}),
                                  1.0 - p->r[k]};
    const double noise = sigma * link.weight * normal[k];
    d->given[i] = vec3_add_scaled(d->given[i], noise, link.along);
    d->given[j] = vec3_add_scaled(d->given[j], -noise, link.along);
    d->close += p->r[k] < DPD_CLOSE;
    d->link[d->links++] = link;
  }
  return true;
}

/* Streams particles that are late, and fills push, given and the list of links. False, with the fault recorded, if a
 * flight is too far, or if memory is short. */
static inline bool dpd_find(struct dpd *d)
{
  struct medium *m = &d->work->medium;
  struct solvent *s = &d->state->solvent;
  const size_t bytes = s->n * sizeof *d->push;
  memset(d->push, 0, bytes);
  if (model_repels(d->model)) {
    if (!repulsion_forces(d->state, d->model, m, &d->work->fault))
      return false;
    memcpy(d->push, m->force, bytes);
  } else {
    if (d->state->solvent_lag > 0 && !m->fluid->stream(d->state, d->model, 0, s->n, &d->work->fault))
      return false;
    state_streamed(d->state);
    members_gather(d->state, d->model, m);
  }
  memcpy(d->given, d->push, bytes);
  d->links = d->close = 0;
  d->evaluation++;
  const struct near_search search = {.model = d->model, .medium = m, .look = dpd_add_links, .context = d};
  return near_find(&search) || fault_no_memory(&d->work->fault, d->evaluation);
}

/* pull: the friction of velocities v. */
static inline void dpd_friction(struct dpd *d, const struct vec3 *v)
{
  memset(d->pull, 0, d->state->solvent.n * sizeof *d->pull);
  for (uint32_t k = 0; k < d->links; k++) {
    const struct dpd_link *l = &d->link[k];
    const double u = vec3_dot(l->along, vec3_sub(v[l->i], v[l->j])), drag = d->friction * l->weight * l->weight * u;
    d->pull[l->i] = vec3_add_scaled(d->pull[l->i], -drag, l->along);
    d->pull[l->j] = vec3_add_scaled(d->pull[l->j], drag, l->along);
  }
}

/* to = from + factor (given + pull) */
static inline void dpd_kick(const struct dpd *d, double factor, const struct vec3 *from, struct vec3 *to)
{
  for (uint32_t i = 0; i < d->state->solvent.n; i++)
    to[i] = vec3_add_scaled(from[i], factor, vec3_add(d->given[i], d->pull[i]));
}

/* Particles fly for a step with these velocities, and pairs are found where they are then. */
static inline bool dpd_move(struct dpd *d, const struct vec3 *velocity)
{
  struct solvent *s = &d->state->solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    const struct vec3 v = velocity[s->id[i]];
    s->vx[i] = v.x, s->vy[i] = v.y, s->vz[i] = v.z;
  }
  d->state->solvent_lag = d->held ? 0 : 2;
  return dpd_find(d);
}

/* force = given + pull */
static inline void dpd_keep_force(struct dpd *d)
{
  memset(d->force, 0, d->state->solvent.n * sizeof *d->force);
  dpd_kick(d, 1.0, d->force, d->force);
}

/* to = from + factor force */
static inline void dpd_add_force(const struct dpd *d, double factor, const struct vec3 *from, struct vec3 *to)
{
  for (uint32_t i = 0; i < d->state->solvent.n; i++)
    to[i] = vec3_add_scaled(from[i], factor, d->force[i]);
}

/* --- steps ----------------------------------------------------------------------------------------------------------
 */

static inline bool dpd_euler(struct dpd *d)
{
  const size_t bytes = d->state->solvent.n * sizeof *d->v;
  memcpy(d->trial, d->v, bytes);
  dpd_friction(d, d->v);
  dpd_kick(d, d->model->time_step, d->v, d->v);
  return dpd_move(d, d->trial);
}

static inline bool dpd_semi_implicit(struct dpd *d)
{
  memcpy(d->trial, d->v, d->state->solvent.n * sizeof *d->v);
  dpd_friction(d, d->v);
  dpd_kick(d, d->model->time_step, d->v, d->v);
  return dpd_move(d, d->v);
}

static inline bool dpd_groot_warren(struct dpd *d, double lambda)
{
  const double dt = d->model->time_step;
  dpd_add_force(d, lambda * dt, d->v, d->trial);
  dpd_add_force(d, 0.5 * dt, d->v, d->v);
  if (!dpd_move(d, d->v))
    return false;
  dpd_friction(d, d->trial);
  dpd_keep_force(d);
  dpd_add_force(d, 0.5 * dt, d->v, d->v);
  return true;
}

static inline bool dpd_groot_warren_half(struct dpd *d)
{
  return dpd_groot_warren(d, 0.5);
}

static inline bool dpd_groot_warren_65(struct dpd *d)
{
  return dpd_groot_warren(d, 0.65);
}

static inline bool dpd_verlet(struct dpd *d)
{
  const double half = 0.5 * d->model->time_step;
  dpd_add_force(d, half, d->v, d->trial);
  if (!dpd_move(d, d->trial))
    return false;
  dpd_friction(d, d->trial);
  dpd_kick(d, half, d->trial, d->v);
  dpd_friction(d, d->v);
  dpd_keep_force(d);
  return true;
}

static inline double dpd_product(const struct dpd *d, const struct vec3 *a, const struct vec3 *b)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < d->state->solvent.n; i++)
    sum += vec3_dot(a[i], b[i]);
  return sum;
}

/* Solves to = from + factor (given + friction of (share to + (1 - share) from)), a symmetric positive problem, by
 * conjugate gradients (Hestenes and Stiefel, J. Res. Natl. Bur. Stand. 49, 409 (1952)), until what is left is 1e-12
 * a0/t0. */
static inline void dpd_solve(struct dpd *d, double factor, double share, const struct vec3 *from, struct vec3 *to)
{
  const uint32_t n = d->state->solvent.n;
  struct vec3 *left = d->scratch, *along = d->along;
  memcpy(to, from, n * sizeof *to);
  dpd_friction(d, from);
  for (uint32_t i = 0; i < n; i++)
    along[i] = left[i] = vec3_scale(factor, vec3_add(d->given[i], d->pull[i]));
  double square = dpd_product(d, left, left);
  for (int round = 0; round < 200 && square > 1e-24; round++) {
    dpd_friction(d, along);
    for (uint32_t i = 0; i < n; i++)
      d->pull[i] = vec3_add_scaled(along[i], -factor * share, d->pull[i]);
    const double far = square / dpd_product(d, along, d->pull), before = square;
    for (uint32_t i = 0; i < n; i++) {
      to[i] = vec3_add_scaled(to[i], far, along[i]);
      left[i] = vec3_add_scaled(left[i], -far, d->pull[i]);
    }
    square = dpd_product(d, left, left);
    for (uint32_t i = 0; i < n; i++)
      along[i] = vec3_add_scaled(left[i], square / before, along[i]);
  }
}

static inline bool dpd_self_consistent(struct dpd *d)
{
  const double half = 0.5 * d->model->time_step;
  dpd_add_force(d, half, d->v, d->trial);
  if (!dpd_move(d, d->trial))
    return false;
  dpd_solve(d, half, 1.0, d->trial, d->v);
  dpd_friction(d, d->v);
  dpd_keep_force(d);
  return true;
}

static inline bool dpd_leap_frog(struct dpd *d)
{
  const uint32_t n = d->state->solvent.n;
  memcpy(d->trial, d->v, n * sizeof *d->v);
  dpd_solve(d, d->model->time_step, 0.5, d->trial, d->v);
  for (uint32_t i = 0; i < n; i++)
    d->trial[i] = vec3_scale(0.5, vec3_add(d->trial[i], d->v[i]));
  return dpd_move(d, d->v);
}

/* The program's own step. */
static inline bool dpd_own(struct dpd *d)
{
  return step_advance(d->state, d->model, d->work, NULL);
}

struct dpd_scheme {
  const char *name;
  bool (*step)(struct dpd *d);
  bool predicts;         /* trial is a velocity of its own, with a temperature */
  double behind;         /* steps by which velocities are behind the places; the repulsion takes them there */
  bool own;              /* velocities are the state's, half a step ahead */
  enum medium_draw draw; /* of own */
  enum medium_weight weight;
};

static const struct dpd_scheme dpd_schemes[] = {
    {"euler", dpd_euler, false, 0.0, false, DRAW_RELAX, WEIGHT_QUADRATIC},
    {"groot-warren", dpd_groot_warren_half, true, 0.0, false, DRAW_RELAX, WEIGHT_QUADRATIC},
    {"groot-warren-65", dpd_groot_warren_65, true, 0.0, false, DRAW_RELAX, WEIGHT_QUADRATIC},
    {"semi-implicit", dpd_semi_implicit, true, 0.5, false, DRAW_RELAX, WEIGHT_QUADRATIC},
    {"dpd-vv", dpd_verlet, true, 0.0, false, DRAW_RELAX, WEIGHT_QUADRATIC},
    {"sc-vv", dpd_self_consistent, true, 0.0, false, DRAW_RELAX, WEIGHT_QUADRATIC},
    {"leap-frog", dpd_leap_frog, true, 0.5, false, DRAW_RELAX, WEIGHT_QUADRATIC},
    {"peters", dpd_own, false, -0.5, true, DRAW_RELAX, WEIGHT_QUADRATIC},
    {"shardlow", dpd_own, false, -0.5, true, DRAW_CAYLEY, WEIGHT_QUADRATIC},
    {"lowe", dpd_own, false, -0.5, true, DRAW_REPLACE, WEIGHT_HAT},
};

enum { DPD_SCHEMES = sizeof dpd_schemes / sizeof *dpd_schemes };

/* Starts from the state as it is. False if memory is short. */
static inline bool dpd_begin(struct dpd *d, struct model *model, struct state *state, struct work *work)
{
  struct memory_need need[DPD_ARRAYS];
  *d =
      (struct dpd){.model = model, .state = state, .work = work, .friction = 0.5 * model->medium.rate, .loudness = 1.0};
  dpd_arrays(d, need);
  if (!memory_take(need, DPD_ARRAYS))
    return false;
  for (uint32_t i = 0; i < state->solvent.n; i++)
    d->v[state->solvent.id[i]] = solvent_velocity(&state->solvent, i);
  memcpy(d->trial, d->v, state->solvent.n * sizeof *d->v);
  if (!dpd_find(d))
    return false;
  dpd_friction(d, d->v);
  dpd_keep_force(d);
  return true;
}

static inline void dpd_end(struct dpd *d)
{
  struct memory_need need[DPD_ARRAYS];
  dpd_arrays(d, need);
  memory_release(need, DPD_ARRAYS);
  free(d->link);
}

#endif
