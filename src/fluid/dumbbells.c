/* A fluid of dumbbells, and of independent particles among them (Tao, Goetze and Gompper 2008). */
#include <math.h>

#include "base/exact_sum.h"
#include "base/normal.h"
#include "fluid/dumbbell.h"
#include "fluid/fluid.h"
#include "wall/account.h"

/* --- start ------------------------------------------------------------------------------------------------------- */

/* Center and spring of a dumbbell: uniform in the box, each component of the spring of variance kT/K. Between walls,
 * where both particles must be inside, and with the weight exp(-U/kT) of the walls' potential, by rejection. */
static void draw_dumbbell(const struct model *model, uint32_t id, struct point *center, struct vec3 *apart)
{
  const struct box *box = &model->box;
  const double length = 1.0 / sqrt(model->dumbbells.spring), high = box->cells[1];
  for (uint32_t attempt = 0;; attempt++) {
    const struct random_words xy = random_at(model->seed, RANDOM_DUMBBELL_CENTER, 2 * attempt, 0, id);
    const struct random_words z = random_at(model->seed, RANDOM_DUMBBELL_CENTER, 2 * attempt + 1, 0, id);
    double a[2], b[2];
    random_normal_pair(random_at(model->seed, RANDOM_DUMBBELL_VECTOR, 2 * attempt, 0, id), a);
    random_normal_pair(random_at(model->seed, RANDOM_DUMBBELL_VECTOR, 2 * attempt + 1, 0, id), b);
    *center = (struct point){lattice_uniform(random_u64(xy, 0), box->cells[0]),
                             lattice_uniform(random_u64(xy, 1), box->cells[1]),
                             model_is_flat(model) ? 0 : lattice_uniform(random_u64(z, 0), box->cells[2])};
    *apart = (struct vec3){length * a[0], length * a[1], model_is_flat(model) ? 0.0 : length * b[0]};
    if (!model_has_walls(model))
      return;
    const double y = (double)center->y * LATTICE_UNIT, half = 0.5 * fabs(apart->y) + 2.0 * LATTICE_UNIT;
    const double energy = dumbbell_wall_energy(model, y) + fmax(model->dumbbells.depth, 0.0);
    if (y - half >= 0.0 && y + half <= high && random_uniform(z, 1) < elementary_exp(-energy))
      return;
  }
}

static void start_dumbbells(struct state *state, const struct model *model)
{
  struct solvent *s = &state->solvent;
  struct dumbbells *d = &state->dumbbells;
  const struct box *box = &model->box;
  fluid_points.start(state, model); /* velocities, and places of independent particles */
  for (uint32_t p = 0; p < d->n; p++) {
    struct point center;
    struct vec3 apart;
    draw_dumbbell(model, d->id[p], &center, &apart);
    const struct point first = point_move(center, vec3_scale(0.5, apart)),
                       second = point_move(center, vec3_scale(-0.5, apart));
    d->x[p] = first.x - second.x, d->y[p] = first.y - second.y, d->z[p] = first.z - second.z;
    const struct point at[2] = {first, second};
    for (int i = 0; i < 2; i++) {
      s->x[2 * p + i] = box_inside(box, 0, at[i].x);
      s->y[2 * p + i] = box_inside(box, 1, at[i].y);
      s->z[2 * p + i] = box_inside(box, 2, at[i].z);
    }
  }
}

/* --- flight ------------------------------------------------------------------------------------------------------ */

/* Not 0 if a velocity is too large for a flight, whatever the spring does, or is no number. */
static int64_t any_fast(const double *v, uint32_t n, double most)
{
  int64_t fast = 0;
  for (uint32_t i = 0; i < n; i++)
    fast |= !(fabs(v[i]) < most);
  return fast;
}

/* With |v t| below half of LATTICE_MAX_MOVE only a spring of about that length makes a flight too long. */
static bool speeds_fit(const struct state *state, const struct span *span, uint32_t first, uint32_t n,
                       struct fault *fault)
{
  const struct solvent *s = &state->solvent;
  const double *v[3] = {s->vx, s->vy, s->vz}, limit = 0.5 * LATTICE_MAX_MOVE, most = limit / span->time;
  for (int k = 0; k < 3; k++)
    for (uint32_t i = first; any_fast(&v[k][first], n, most) && i < first + n; i++)
      if (!(fabs(v[k][i]) < most))
        return fault_record(fault, FAULT_SOLVENT_MOVE, state->step + 1, s->id[i], v[k][i] * span->time, limit);
  return true;
}

/* The dumbbell whose spring is longest, as far as it can be told afterwards. */
static bool too_long(const struct state *state, uint32_t first, uint32_t n, struct fault *fault)
{
  const struct dumbbells *d = &state->dumbbells;
  double most = -1.0;
  uint32_t who = first;
  for (uint32_t p = first; p < first + n; p++) {
    const double r = vec3_norm(point_in_a0((struct point){d->x[p], d->y[p], d->z[p]}));
    if (r > most)
      most = r, who = p;
  }
  return fault_record(fault, FAULT_DUMBBELL, state->step + 1, d->id[who], most, LATTICE_MAX_MOVE);
}

/* Pairs that fly together: few enough for their velocities to stay in the cache between the look and the flight. */
enum { FLOCK = 512 };

static bool fly_flock(struct state *state, const struct model *model, const struct span *span,
                      const struct swing *swing, uint32_t first, uint32_t n, struct fault *fault)
{
  const struct pairs pairs = pairs_of(state, first, n);
  return speeds_fit(state, span, 2 * first, 2 * n, fault) &&
         (!dumbbell_boundary_of(&model->box)->fly(&pairs, model, span, swing, account_of(state, ACCOUNT_HITS)) ||
          too_long(state, first, n, fault));
}

static bool stream_dumbbells(struct state *state, const struct model *model, uint32_t first, uint32_t n,
                             struct fault *fault)
{
  const struct span span = boundary_lag(state, model);
  const uint32_t paired = 2 * state->dumbbells.n, last = first + n, end = last < paired ? last : paired;
  const struct swing swing = swing_for(model->dumbbells.frequency, span.time);
  for (uint32_t p = first / 2; p < end / 2; p += FLOCK)
    if (!fly_flock(state, model, &span, &swing, p, end / 2 - p < FLOCK ? end / 2 - p : FLOCK, fault))
      return false;
  const uint32_t alone = first > paired ? first : paired;
  return last <= alone || boundary_of(&model->box)->fly(state, model, &span, alone, last - alone, fault);
}

/* Position and velocity of the particle at place i, and the vector of its dumbbell, after the flight. */
static void fly_one(const struct state *state, const struct model *model, const struct span *span,
                    const struct swing *swing, uint32_t i, struct point *at, struct vec3 *v, struct vec3 *apart)
{
  const uint32_t p = i / 2;
  const struct pairs all = pairs_of(state, p, 1);
  int64_t x[3][2], r[3];
  double w[3][2];
  for (int k = 0; k < 3; k++) {
    x[k][0] = all.at[k][0], x[k][1] = all.at[k][1];
    w[k][0] = all.v[k][0], w[k][1] = all.v[k][1];
    r[k] = all.apart[k][0];
  }
  const struct pairs one = {1, {x[0], x[1], x[2]}, {w[0], w[1], w[2]}, {&r[0], &r[1], &r[2]}};
  dumbbell_boundary_of(&model->box)->fly(&one, model, span, swing, (struct account){NULL, NULL});
  *at = (struct point){x[0][i % 2], x[1][i % 2], x[2][i % 2]};
  *v = (struct vec3){w[0][i % 2], w[1][i % 2], w[2][i % 2]};
  *apart = point_in_a0((struct point){r[0], r[1], r[2]});
}

static void dumbbells_now(const struct state *state, const struct model *model, uint32_t first, uint32_t n,
                          struct point *position, struct vec3 *velocity)
{
  const struct span span = boundary_lag(state, model);
  const struct swing swing = swing_for(model->dumbbells.frequency, span.time);
  const uint32_t paired = 2 * state->dumbbells.n;
  for (uint32_t k = 0, i = first; k < n; k++, i++) {
    struct point x;
    struct vec3 v, apart;
    if (i >= paired) {
      fluid_points.now(state, model, i, 1, position ? &position[k] : NULL, velocity ? &velocity[k] : NULL);
      continue;
    }
    fly_one(state, model, &span, &swing, i, &x, &v, &apart);
    if (position)
      position[k] = x;
    if (velocity)
      velocity[k] = v;
  }
}

struct vec3 fluid_dumbbell_now(const struct state *state, const struct model *model, uint32_t p)
{
  const struct span span = boundary_lag(state, model);
  const struct swing swing = swing_for(model->dumbbells.frequency, span.time);
  struct point x;
  struct vec3 v, apart;
  fly_one(state, model, &span, &swing, 2 * p, &x, &v, &apart);
  return apart;
}

double fluid_dumbbell_energy(const struct state *state, const struct model *model)
{
  struct exact_sum sum = {0, 0};
  bool large = false;
  const bool potential = model_has_walls(model) && model->dumbbells.depth != 0.0;
  const struct span span = boundary_lag(state, model);
  const struct swing swing = swing_for(model->dumbbells.frequency, span.time);
  for (uint32_t p = 0; p < state->dumbbells.n; p++) {
    struct point x;
    struct vec3 v, apart;
    fly_one(state, model, &span, &swing, 2 * p, &x, &v, &apart);
    double energy = 0.5 * model->dumbbells.spring * vec3_dot(apart, apart);
    if (potential)
      energy += dumbbell_wall_energy(model, (double)x.y * LATTICE_UNIT - 0.5 * apart.y);
    large |= !(energy < EXACT_LARGEST);
    exact_add(&sum, energy < EXACT_LARGEST ? energy : 0.0);
  }
  return large ? INFINITY : exact_value(&sum);
}

const struct fluid fluid_dumbbells = {
    .name = "dumbbells",
    .together = 2,
    .start = start_dumbbells,
    .stream = stream_dumbbells,
    .now = dumbbells_now,
    .flux = dumbbells_flux,
};
