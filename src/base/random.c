#include "base/random.h"

/* Philox 4x32-10 once more (random_at has Random123's): with its words in 64 bits each, compilers make vector code of
 * it, which they do not of the library's. Two of the counter's words are multiplied in each round; the high halves meet
 * the other two and the key, the low halves take their places. */
void random_columns(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, const uint32_t *entity,
                    uint32_t n, uint32_t *restrict column[4])
{
  uint32_t *restrict w0 = column[0], *restrict w1 = column[1], *restrict w2 = column[2], *restrict w3 = column[3];
  const uint64_t low = 0xffffffffu;
  for (uint32_t k = 0; k < n; k++) {
    uint64_t a = entity[k], b = (uint32_t)purpose + 256 * draw, c = step & low, d = step >> 32;
    uint32_t key0 = (uint32_t)seed, key1 = (uint32_t)(seed >> 32);
    for (int round = 0; round < PHILOX4x32_DEFAULT_ROUNDS; round++) {
      const uint64_t p = PHILOX_M4x32_0 * (a & low), q = PHILOX_M4x32_1 * (c & low);
      a = (q >> 32) ^ b ^ key0;
      b = q & low;
      c = (p >> 32) ^ d ^ key1;
      d = p & low;
      key0 += PHILOX_W32_0;
      key1 += PHILOX_W32_1;
    }
    w0[k] = (uint32_t)a, w1[k] = (uint32_t)b, w2[k] = (uint32_t)c, w3[k] = (uint32_t)d;
  }
}

/* random_axis_from_words with the second pair of words taken where the first is outside the unit disk. Where both are,
 * z < -1. */
static void axes_from_words(const uint32_t *restrict w0, const uint32_t *restrict w1, const uint32_t *restrict w2,
                            const uint32_t *restrict w3, uint32_t n, double *restrict x, double *restrict y,
                            double *restrict z)
{
  for (uint32_t k = 0; k < n; k++) {
    const double u0 = ((double)(int32_t)w0[k] + 0.5) * 0x1p-31, v0 = ((double)(int32_t)w1[k] + 0.5) * 0x1p-31;
    const double u1 = ((double)(int32_t)w2[k] + 0.5) * 0x1p-31, v1 = ((double)(int32_t)w3[k] + 0.5) * 0x1p-31;
    const double s0 = u0 * u0 + v0 * v0, s1 = u1 * u1 + v1 * v1;
    const double u = s0 < 1.0 ? u0 : u1, v = s0 < 1.0 ? v0 : v1, s = s0 < 1.0 ? s0 : s1;
    const double root = sqrt(1.0 - s);
    x[k] = 2.0 * u * root;
    y[k] = 2.0 * v * root;
    z[k] = 1.0 - 2.0 * s;
  }
}

void random_axes(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity, uint32_t n,
                 struct vec3 *axis)
{
  uint32_t w[4][RANDOM_AXES], *columns[4] = {w[0], w[1], w[2], w[3]};
  double x[RANDOM_AXES], y[RANDOM_AXES], z[RANDOM_AXES];
  random_columns(seed, purpose, 0, step, entity, n, columns);
  axes_from_words(w[0], w[1], w[2], w[3], n, x, y, z);
  for (uint32_t k = 0; k < n; k++)
    axis[k] = z[k] > -1.0 ? (struct vec3){x[k], y[k], z[k]} : random_axis_from(seed, purpose, 1, step, entity[k]);
}

/* floor(r n / 2^64) */
static uint32_t below(uint64_t r, uint32_t n)
{
  uint64_t high = (r >> 32) * n, low = (r & 0xffffffffu) * n;
  return (uint32_t)((high + (low >> 32)) >> 32);
}

#define BLOCK 64 /* entities of a permutation whose words are made at once; two elements each */

void random_permutation(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, uint32_t n,
                        uint32_t *order)
{
  uint32_t entity[BLOCK], w[4][BLOCK], *columns[4] = {w[0], w[1], w[2], w[3]};
  for (uint32_t k = 0; k < n; k++)
    order[k] = k;
  uint32_t first = UINT32_MAX; /* of the block at hand */
  for (uint32_t k = n; k-- > 1;) {
    if (k / 2 < first) {
      const uint32_t last = k / 2;
      first = last < BLOCK ? 0 : last - BLOCK + 1;
      for (uint32_t e = first; e <= last; e++)
        entity[e - first] = e;
      random_columns(seed, purpose, draw, step, entity, last - first + 1, columns);
    }
    const uint32_t e = k / 2 - first, low = 2 * (k % 2);
    const uint32_t j = below((uint64_t)w[low][e] | (uint64_t)w[low + 1][e] << 32, k + 1);
    const uint32_t swap = order[k];
    order[k] = order[j];
    order[j] = swap;
  }
}
