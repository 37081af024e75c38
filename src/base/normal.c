#include "base/normal.h"

static inline double radius_from(double u)
{
  return sqrt(-2.0 * elementary_log(u));
}

void random_normal_pair(struct random_words r, double out[2])
{
  const double radius = radius_from(random_uniform(r, 0));
  const struct circle_point p = elementary_circle_turns(random_uniform(r, 1));
  out[0] = radius * p.cosine;
  out[1] = radius * p.sine;
}

static void radii(const double *restrict u, uint32_t n, double *restrict radius)
{
  for (uint32_t k = 0; k < n; k++)
    radius[k] = radius_from(u[k]);
}

static void pairs(const double *restrict radius, const double *restrict turns, uint32_t n, double *restrict x,
                  double *restrict y)
{
  for (uint32_t k = 0; k < n; k++) {
    const struct circle_point p = elementary_circle_turns(turns[k]);
    x[k] = radius[k] * p.cosine;
    y[k] = radius[k] * p.sine;
  }
}

static void firsts(const double *restrict radius, const double *restrict turns, uint32_t n, double *restrict z)
{
  for (uint32_t k = 0; k < n; k++)
    z[k] = radius[k] * elementary_circle_turns(turns[k]).cosine;
}

void random_normal_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                           uint32_t n, double *restrict x, double *restrict y, double *restrict z)
{
  double u[4][RANDOM_UNIFORMS], radius[RANDOM_UNIFORMS];
  for (uint32_t first = 0; first < n; first += RANDOM_UNIFORMS) {
    const uint32_t m = n - first < RANDOM_UNIFORMS ? n - first : RANDOM_UNIFORMS;
    random_uniform_columns(seed, purpose, step, entity + first, m, u);
    radii(u[0], m, radius);
    pairs(radius, u[1], m, x + first, y + first);
    radii(u[2], m, radius);
    firsts(radius, u[3], m, z + first);
  }
}
