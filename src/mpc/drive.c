#include "mpc/drive.h"

#include "base/elementary.h"
#include "mpc/cell.h"
#include "system/shear.h"

enum { BLOCK = 1024 }; /* particles worked on at a time */

bool drive_has_profile(const struct model *model)
{
  return model->solvent.profile != PROFILE_UNIFORM;
}

bool drive_has_affine_kick(const struct model *model)
{
  return model_is_sheared(model) && model->wave.intervals > 0;
}

static double uniform(double turns)
{
  (void)turns;
  return 1.0;
}

static double sine(double turns)
{
  return elementary_circle_turns(turns).sine;
}

static double reverse(double turns)
{
  return turns < 0.5 ? 1.0 : -1.0;
}

static double (*const profiles[PROFILES])(double turns) = {
    [PROFILE_UNIFORM] = uniform, [PROFILE_SINE] = sine, [PROFILE_REVERSE] = reverse};

double drive_profile(const struct model *model, int64_t y)
{
  return profiles[model->solvent.profile]((double)y / (double)model->box.edge[1]);
}

/* Adds w[i] k to the velocities of n particles. */
static void add_kick(struct solvent *s, uint32_t first, uint32_t n, const double *w, struct vec3 k)
{
  for (uint32_t i = 0; i < n; i++) {
    s->vx[first + i] += w[i] * k.x;
    s->vy[first + i] += w[i] * k.y;
    s->vz[first + i] += w[i] * k.z;
  }
}

typedef double weight_of(const struct model *, int64_t y);

/* Mean weight of all particles. The sum is one of integers, so that it does not depend on the order of particles.
 * Weights are at most 2^9, half the longest edge: n of them fit in units of 2^-(53 - bits of n). */
static double mean_weight(const struct solvent *s, const struct model *model, weight_of *weight)
{
  int bits = 0;
  while (s->n >> bits)
    bits++;
  const double unit = ldexp(1.0, bits - 53);
  int64_t sum = 0;
  for (uint32_t i = 0; i < s->n; i++)
    sum += llrint(weight(model, s->y[i]) / unit);
  return (double)sum * unit / s->n;
}

/* Kicks all particles by weight(y) k, less the mean. */
static void kick_by(struct state *state, const struct model *model, weight_of *weight, struct vec3 k)
{
  struct solvent *s = &state->solvent;
  double w[BLOCK];
  const double mean = mean_weight(s, model, weight);
  for (uint32_t first = 0; first < s->n; first += BLOCK) {
    const uint32_t n = s->n - first < BLOCK ? s->n - first : BLOCK;
    for (uint32_t i = 0; i < n; i++)
      w[i] = weight(model, s->y[first + i]) - mean;
    add_kick(s, first, n, w, k);
  }
}

void drive_kick(struct state *state, const struct model *model, double part)
{
  kick_by(state, model, drive_profile, vec3_scale(part * model_collision_interval(model), model->solvent.acceleration));
}

/* a0, from the middle */
static double height(const struct model *model, int64_t y)
{
  return (double)(y - model->box.edge[1] / 2) * LATTICE_UNIT;
}

void drive_affine_kick(struct state *state, const struct model *model)
{
  const uint64_t begins = shear_interval(model, state->solvent_time + state->solvent_lag);
  const double change = shear_rate(model, begins) - (begins > 0 ? shear_rate(model, begins - 1) : 0.0);
  kick_by(state, model, height, (struct vec3){change, 0, 0});
}
