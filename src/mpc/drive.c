#include "mpc/drive.h"

#include "base/elementary.h"
#include "mpc/cell.h"
#include "wall/motion.h"

enum { BLOCK = 1024 }; /* particles worked on at a time */

bool drive_has_profile(const struct model *model)
{
  return model->solvent.profile != PROFILE_UNIFORM;
}

bool drive_has_affine_kick(const struct model *model)
{
  return model_is_sheared(model) && model->wave.intervals > 0;
}

/* Weights of n particles at heights y. */
typedef void profile_weights(const struct model *model, const int64_t *y, uint32_t n, double *weight);

static void weigh_uniform(const struct model *model, const int64_t *y, uint32_t n, double *weight)
{
  (void)model, (void)y;
  for (uint32_t i = 0; i < n; i++)
    weight[i] = 1.0;
}

/* A whole number in [0, 2^52) as a double. Unlike a conversion this form vectorises on every x86-64. */
static inline double real_of(int64_t y)
{
  const double base = 0x1p52;
  return elementary_from_bits((uint64_t)y + elementary_bits(base)) - base;
}

static void weigh_sine(const struct model *model, const int64_t *y, uint32_t n, double *weight)
{
  const double edge = (double)model->box.edge[1];
  for (uint32_t i = 0; i < n; i++)
    weight[i] = elementary_circle_turns(real_of(y[i]) / edge).sine;
}

static void weigh_reverse(const struct model *model, const int64_t *y, uint32_t n, double *weight)
{
  for (uint32_t i = 0; i < n; i++)
    weight[i] = 2 * y[i] < model->box.edge[1] ? 1.0 : -1.0;
}

/* a0, from the middle */
static void weigh_height(const struct model *model, const int64_t *y, uint32_t n, double *weight)
{
  const int64_t middle = model->box.edge[1] / 2;
  for (uint32_t i = 0; i < n; i++)
    weight[i] = (double)(y[i] - middle) * LATTICE_UNIT;
}

static profile_weights *const profiles[PROFILES] = {
    [PROFILE_UNIFORM] = weigh_uniform, [PROFILE_SINE] = weigh_sine, [PROFILE_REVERSE] = weigh_reverse};

/* Adds w[i] k to the velocities of n particles. */
static void add_kick(struct solvent *s, uint32_t first, uint32_t n, const double *w, struct vec3 k)
{
  for (uint32_t i = 0; i < n; i++) {
    s->vx[first + i] += w[i] * k.x;
    s->vy[first + i] += w[i] * k.y;
    s->vz[first + i] += w[i] * k.z;
  }
}

static uint32_t block_size(uint32_t n, uint32_t first)
{
  return n - first < BLOCK ? n - first : BLOCK;
}

/* Mean weight of all particles, where weights are at most 1. The sum is one of integers, so that it does not depend on
 * the order of particles: n of them fit in units of 2^-(62 - bits of n), and each is in the range of lattice_round. */
static double mean_weight(const struct solvent *s, const struct model *model, profile_weights *weigh)
{
  double w[BLOCK];
  int bits = 12;
  while (s->n >> bits)
    bits++;
  const double scale = ldexp(1.0, 62 - bits);
  int64_t sum = 0;
  for (uint32_t first = 0; first < s->n; first += BLOCK) {
    const uint32_t n = block_size(s->n, first);
    weigh(model, &s->y[first], n, w);
    for (uint32_t i = 0; i < n; i++)
      sum += lattice_round(w[i] * scale);
  }
  return (double)sum / scale / s->n;
}

/* Kicks all particles by (weight - less) k. */
static void kick_by(struct solvent *s, const struct model *model, profile_weights *weigh, double less, struct vec3 k)
{
  double w[BLOCK];
  for (uint32_t first = 0; first < s->n; first += BLOCK) {
    const uint32_t n = block_size(s->n, first);
    weigh(model, &s->y[first], n, w);
    for (uint32_t i = 0; i < n; i++)
      w[i] -= less;
    add_kick(s, first, n, w, k);
  }
}

void drive_kick(struct state *state, const struct model *model, double part)
{
  struct solvent *s = &state->solvent;
  profile_weights *const weigh = profiles[model->solvent.profile];
  kick_by(s, model, weigh, mean_weight(s, model, weigh),
          vec3_scale(part * model_collision_interval(model), model->solvent.acceleration));
}

void drive_affine_kick(struct state *state, const struct model *model)
{
  const uint64_t begins = shear_interval(model, state->solvent_time + state->solvent_lag);
  const double change = shear_rate(model, begins) - (begins > 0 ? shear_rate(model, begins - 1) : 0.0);
  const int64_t middle = model->box.edge[1] / 2;
  kick_by(&state->solvent, model, weigh_height, 0.0, (struct vec3){change, 0, 0});
  for (uint32_t v = 0; v < state->vertices; v++)
    state->velocity[v].x += change * ((double)(state->position[v].y - middle) * LATTICE_UNIT);
}
