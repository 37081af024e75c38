/*
 * Four words of 64 bits at a time, in the vectors of gcc and clang: + - ^ & | << >> act on each word. What they have no
 * operator for is here. Vectors go through pointers: passing them by value depends on the instruction set.
 */
#ifndef UNCROSS_BASE_LANES_H
#define UNCROSS_BASE_LANES_H

#include <stdint.h>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#define LANES 4

typedef uint64_t lanes __attribute__((vector_size(LANES * sizeof(uint64_t))));
typedef double double_lanes __attribute__((vector_size(LANES * sizeof(double))));

/* The low 32 bits of each lane times m. One instruction where there is AVX2, but gcc does not find it: it multiplies 64
 * bits by 64, or adds shifted words, at more than twice the cost of a whole Philox. */
static inline void lanes_multiply(lanes *product, const lanes *a, uint32_t m)
{
#ifdef __AVX2__
  *product = (lanes)_mm256_mul_epu32((__m256i)*a, _mm256_set1_epi64x(m));
#else
  *product = (*a & 0xffffffff) * m;
#endif
}

#endif
