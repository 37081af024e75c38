#include "base/normal.h"

/* random_uniform of two words (low, high), through bits: before AVX-512 there is no vector conversion of 64-bit
 * integers. Bits 0x3ff before 52 bits k are the number 1 + k 2^-52; the difference is exact. */
static inline double uniform_from(uint32_t low, uint32_t high)
{
  const uint64_t k = (uint64_t)high << 20 | low >> 12;
  return elementary_from_bits(k | 0x3ff0000000000000) - (1.0 - 0x1p-53);
}

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

#define BLOCK 64 /* entities whose deviates are made at once */

static void radii(const uint32_t *restrict w0, const uint32_t *restrict w1, uint32_t n, double *restrict radius)
{
  for (uint32_t k = 0; k < n; k++)
    radius[k] = radius_from(uniform_from(w0[k], w1[k]));
}

static void pairs(const double *restrict radius, const uint32_t *restrict w2, const uint32_t *restrict w3, uint32_t n,
                  double *restrict x, double *restrict y)
{
  for (uint32_t k = 0; k < n; k++) {
    const struct circle_point p = elementary_circle_turns(uniform_from(w2[k], w3[k]));
    x[k] = radius[k] * p.cosine;
    y[k] = radius[k] * p.sine;
  }
}

static void firsts(const double *restrict radius, const uint32_t *restrict w2, const uint32_t *restrict w3, uint32_t n,
                   double *restrict z)
{
  for (uint32_t k = 0; k < n; k++)
    z[k] = radius[k] * elementary_circle_turns(uniform_from(w2[k], w3[k])).cosine;
}

void random_normal_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                           uint32_t n, double *restrict x, double *restrict y, double *restrict z)
{
  uint32_t w[4][BLOCK], *columns[4] = {w[0], w[1], w[2], w[3]};
  double radius[BLOCK];
  for (uint32_t first = 0; first < n; first += BLOCK) {
    const uint32_t m = n - first < BLOCK ? n - first : BLOCK;
    random_columns(seed, purpose, 0, step, entity + first, m, columns);
    radii(w[0], w[1], m, radius);
    pairs(radius, w[2], w[3], m, x + first, y + first);
    random_columns(seed, purpose, 1, step, entity + first, m, columns);
    radii(w[0], w[1], m, radius);
    firsts(radius, w[2], w[3], m, z + first);
  }
}
