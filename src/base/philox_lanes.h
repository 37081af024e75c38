/* Philox 4x32-10 of LANES counters at once. */
#ifndef UNCROSS_BASE_PHILOX_LANES_H
#define UNCROSS_BASE_PHILOX_LANES_H

#include "base/random.h"
#include "base/registers.h"

/* The rounds of philox. A word is the low half of its lane; what is in the high half does not matter. */
INLINE void philox_rounds(uint64_t seed, words w[4])
{
  uint32_t key0 = (uint32_t)seed, key1 = (uint32_t)(seed >> 32);
  for (int round = 0; round < PHILOX_ROUNDS; round++) {
    const words p = multiply_low(w[0], PHILOX_MULTIPLIER_0), q = multiply_low(w[2], PHILOX_MULTIPLIER_1);
    w[0] = (q >> 32) ^ (w[1] ^ key0);
    w[1] = q;
    w[2] = (p >> 32) ^ (w[3] ^ key1);
    w[3] = p;
    key0 += PHILOX_KEY_STEP_0;
    key1 += PHILOX_KEY_STEP_1;
  }
}

/* The words of LANES entities, as random_at. */
INLINE void philox_words(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, words entity,
                         words w[4])
{
  const words zero = {0};
  w[0] = entity;
  w[1] = zero + ((uint32_t)purpose + 256 * draw);
  w[2] = zero + (uint32_t)step;
  w[3] = zero + (step >> 32);
  philox_rounds(seed, w);
}

/* random_uniform of words (low, high), through bits: before AVX-512 there is no vector conversion of 64-bit integers.
 * Bits 0x3ff before 52 bits k are the number 1 + k 2^-52; the difference is exact. */
INLINE reals uniform_lanes(words low, words high)
{
  const words fraction = (high << 20 & 0x000fffffffffffff) | (low & 0xffffffff) >> 12;
  return (reals)(fraction | 0x3ff0000000000000) - (1.0 - 0x1p-53);
}

#endif
