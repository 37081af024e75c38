#include "base/random.h"

#include <string.h>

#include "base/philox_lanes.h"

/* The words of LANES entities. */
INLINE void words_of(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step,
                     const uint32_t entity[LANES], words w[4])
{
  philox_words(seed, purpose, draw, step, load_low(entity), w);
}

enum { BLOCK = 64 }; /* entities worked on at a time */

/* n <= BLOCK entities, with others after the last one, so that groups of LANES are whole. */
static void take_block(const uint32_t *entity, uint32_t n, uint32_t some[BLOCK])
{
  memcpy(some, entity, n * sizeof *some);
  memset(&some[n], 0, (BLOCK - n) * sizeof *some);
}

static void keep_low(const uint64_t *restrict wide, uint32_t n, uint32_t *restrict word)
{
  for (uint32_t k = 0; k < n; k++)
    word[k] = (uint32_t)wide[k];
}

void random_columns(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, const uint32_t *entity,
                    uint32_t n, uint32_t *restrict column[4])
{
  uint32_t some[BLOCK];
  uint64_t wide[4][BLOCK];
  for (uint32_t first = 0; first < n; first += BLOCK) {
    const uint32_t m = n - first < BLOCK ? n - first : BLOCK;
    take_block(&entity[first], m, some);
    for (uint32_t k = 0; k < m; k += LANES) {
      words w[4];
      words_of(seed, purpose, draw, step, &some[k], w);
      for (int i = 0; i < 4; i++)
        memcpy(&wide[i][k], &w[i], sizeof w[i]);
    }
    for (int i = 0; i < 4; i++)
      keep_low(wide[i], m, &column[i][first]);
  }
}

void random_wide_pair_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                              const uint32_t *draw, uint32_t n, uint64_t word[4][RANDOM_UNIFORMS])
{
  uint32_t first[BLOCK], second[BLOCK];
  const words zero = {0};
  take_block(entity, n, first);
  take_block(draw, n, second);
  for (uint32_t k = 0; k < n; k += LANES) {
    words w[4] = {load_low(&first[k]), (load_low(&second[k]) << 8) + (uint32_t)purpose, zero + (uint32_t)step,
                  zero + (step >> 32)};
    philox_rounds(seed, w);
    for (int i = 0; i < 4; i++)
      memcpy(&word[i][k], &w[i], sizeof w[i]);
  }
}

void random_uniform_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                            uint32_t n, double u[4][RANDOM_UNIFORMS])
{
  uint32_t some[BLOCK];
  _Static_assert(RANDOM_UNIFORMS == BLOCK, "one block");
  take_block(entity, n, some);
  for (uint32_t first = 0; first < n; first += LANES) {
    words w[4], next[4];
    words_of(seed, purpose, 0, step, &some[first], w);
    words_of(seed, purpose, 1, step, &some[first], next);
    store_reals(&u[0][first], uniform_lanes(w[0], w[1]));
    store_reals(&u[1][first], uniform_lanes(w[2], w[3]));
    store_reals(&u[2][first], uniform_lanes(next[0], next[1]));
    store_reals(&u[3][first], uniform_lanes(next[2], next[3]));
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

__extension__ typedef unsigned __int128 wide;

/* floor(r n / 2^64) */
static uint32_t below(uint64_t r, uint32_t n)
{
  return (uint32_t)((wide)r * n >> 64);
}

/* Integers 0 and 1 of the LANES entities from `first` on. */
INLINE void shuffle_integers(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, uint32_t first,
                             uint64_t integer[2][LANES])
{
  words lane, w[4];
  for (uint32_t k = 0; k < LANES; k++)
    lane[k] = first + k;
  philox_words(seed, purpose, draw, step, lane, w);
  const words even = w[1] << 32 | (w[0] & 0xffffffff), odd = w[3] << 32 | (w[2] & 0xffffffff);
  memcpy(integer[0], &even, sizeof even);
  memcpy(integer[1], &odd, sizeof odd);
}

/* The partners of a block are known before its first exchange, and asked for: where entries are many, they are far. */
void random_shuffle(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, uint32_t n,
                    uint32_t *entry)
{
  uint32_t partner[2 * BLOCK];
  _Static_assert(BLOCK % LANES == 0, "a block's partners fill registers");
  for (uint32_t end = n / 2 + n % 2, first; end > 0; end = first) {
    first = end < BLOCK ? 0 : end - BLOCK;
    for (uint32_t e = 0; e < end - first; e += LANES) {
      uint64_t integer[2][LANES];
      shuffle_integers(seed, purpose, draw, step, first + e, integer);
      for (uint32_t k = 0; k < 2 * LANES; k++) {
        uint32_t *to = &partner[2 * e + k];
        *to = below(integer[k % 2][k / 2], 2 * (first + e) + k + 1);
        __builtin_prefetch(&entry[*to < n ? *to : 0]);
      }
    }
    for (uint32_t k = n < 2 * end ? n : 2 * end; k-- > 2 * first;) {
      const uint32_t j = partner[k - 2 * first], swap = entry[k];
      entry[k] = entry[j];
      entry[j] = swap;
    }
  }
}

void random_permutation(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, uint32_t n,
                        uint32_t *order)
{
  for (uint32_t k = 0; k < n; k++)
    order[k] = k;
  random_shuffle(seed, purpose, draw, step, n, order);
}
