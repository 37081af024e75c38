/*
 * Philox 4x32-10: four words that are a bijection of a counter of four words, another one for each key of two (Salmon,
 * Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC11). philox_lanes.h has the same of many
 * counters at once.
 */
#ifndef UNCROSS_BASE_PHILOX_H
#define UNCROSS_BASE_PHILOX_H

#include "base/machine.h"

#include <stdint.h>

enum { PHILOX_ROUNDS = 10 };
#define PHILOX_MULTIPLIER_0 0xd2511f53u
#define PHILOX_MULTIPLIER_1 0xcd9e8d57u
#define PHILOX_KEY_STEP_0 0x9e3779b9u /* the golden ratio */
#define PHILOX_KEY_STEP_1 0xbb67ae85u /* sqrt(3) - 1 */

/* Words 0 and 2 are multiplied: the high halves meet the other two words and the key, the low halves take their places.
 */
static inline __attribute__((always_inline)) void philox_round(uint32_t key0, uint32_t key1, uint32_t w[4])
{
  const uint64_t p = (uint64_t)PHILOX_MULTIPLIER_0 * w[0], q = (uint64_t)PHILOX_MULTIPLIER_1 * w[2];
  w[0] = (uint32_t)(q >> 32) ^ w[1] ^ key0;
  w[1] = (uint32_t)q;
  w[2] = (uint32_t)(p >> 32) ^ w[3] ^ key1;
  w[3] = (uint32_t)p;
}

/* The counter becomes the words. The key is raised between rounds. */
static inline __attribute__((always_inline)) void philox(uint32_t key0, uint32_t key1, uint32_t w[4])
{
  for (uint32_t round = 0; round < PHILOX_ROUNDS; round++)
    philox_round(key0 + round * PHILOX_KEY_STEP_0, key1 + round * PHILOX_KEY_STEP_1, w);
}

#endif
