// As many numbers of 64 bits as a register of the processor holds, in the vectors of g++ and clang: 8 with AVX-512, 4
// with AVX2, else 2. + - * / & | ^ << >> act on each; a comparison gives all ones for true, 0 for false. -DLANES=8 makes
// vectors of 8 for any processor: for tests.
#pragma once

#include <cstring>

#include "arithmetic.h"

#ifdef __SSE2__
#include <immintrin.h>
#endif

#ifndef LANES
#if defined __AVX512F__
#define LANES 8
#elif defined __AVX2__
#define LANES 4
#else
#define LANES 2
#endif
#endif
constexpr int lanes = LANES;

typedef double reals __attribute__((vector_size(8 * lanes)));
typedef int64_t wholes __attribute__((vector_size(8 * lanes)));
typedef uint64_t words __attribute__((vector_size(8 * lanes)));
typedef int32_t halves __attribute__((vector_size(4 * lanes)));
typedef double quad __attribute__((vector_size(32)));
typedef int64_t whole_quad __attribute__((vector_size(32)));

#define INLINE inline __attribute__((always_inline))

// Loops over lanes and rows are written out at any level of optimization: else registers are stored to be counted.
#ifdef __clang__
#define UNROLL _Pragma("unroll")
#else
#define UNROLL _Pragma("GCC unroll 8")
#endif

template <class Register, class Number> INLINE Register load(const Number *from)
{
  Register x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

template <class Register, class Number> INLINE void store(const Register &x, Number *to)
{
  std::memcpy(to, &x, sizeof x);
}

INLINE reals each(double x)
{
  return reals{} + x;
}

// `nearest`, if the size of x is below 2^51; otherwise any number of that size or more.
INLINE wholes nearest_of(reals x)
{
  constexpr double magic = 0x1.8p52;
  return (wholes)(x + magic) - (wholes)each(magic);
}

// Signed numbers as doubles, rounded once. Bits 0x433 before 52 bits k are the number 2^52 + k; high halves come as
// 2^84 + 2^32 (k + 2^31).
INLINE reals as_reals(wholes x)
{
  const reals high = (reals)(((words)x >> 32) ^ 0x4530000080000000),
              low = (reals)(((words)x & 0xffffffff) | 0x4330000000000000);
  return (high - 0x1.00000801p84) + low;
}

INLINE wholes choose(wholes mask, wholes a, wholes b)
{
  return (a & mask) | (b & ~mask);
}
INLINE reals choose(wholes mask, reals a, reals b)
{
  return (reals)choose(mask, (wholes)a, (wholes)b);
}

// x, and x + edge where x is negative, x - edge where it is edge or more: within one edge of the box, `fold`.
INLINE wholes fold_once(wholes x, int64_t edge)
{
#if LANES == 4 && defined __AVX2__ // the sign chooses
  x = (wholes)_mm256_blendv_pd((__m256d)x, (__m256d)(x + edge), (__m256d)x);
  const wholes less = x - edge;
  return (wholes)_mm256_blendv_pd((__m256d)less, (__m256d)x, (__m256d)less);
#else
  x += edge & (wholes)(x < 0);
  return x - (edge & (wholes)(x >= edge));
#endif
}

// Negative where x is not from 0 to `most`.
INLINE wholes outside(wholes x, int64_t most)
{
  return x | (most - x);
}

INLINE bool any_negative(wholes x)
{
#if LANES == 4 && defined __AVX2__
  return _mm256_movemask_pd((__m256d)x) != 0;
#else
  int64_t all = 0;
  for (int k = 0; k < lanes; k++)
    all |= x[k];
  return all < 0;
#endif
}

// The low half of each word times m.
INLINE words multiply_low(words x, uint32_t m)
{
#if LANES == 8 && defined __AVX512F__
  return (words)_mm512_mul_epu32((__m512i)x, _mm512_set1_epi64(m));
#elif LANES == 4 && defined __AVX2__
  return (words)_mm256_mul_epu32((__m256i)x, _mm256_set1_epi64x(m));
#elif LANES == 2 && defined __SSE2__
  return (words)_mm_mul_epu32((__m128i)x, _mm_set1_epi64x(m));
#else
  return (x & 0xffffffff) * m;
#endif
}

INLINE reals square_root(reals x)
{
#if LANES == 8 && defined __AVX512F__
  return (reals)_mm512_sqrt_pd((__m512d)x);
#elif LANES == 4 && defined __AVX2__
  return (reals)_mm256_sqrt_pd((__m256d)x);
#elif LANES == 2 && defined __SSE2__
  return (reals)_mm_sqrt_pd((__m128d)x);
#else
  for (int k = 0; k < lanes; k++)
    x[k] = std::sqrt(x[k]);
  return x;
#endif
}

/* --- rows of four numbers as columns, and back ------------------------------------------------------------------ */

// Register k of rows has row k; of 8 lanes, the other half has row k + 4; of 2 lanes, rows are halves of two.
struct Square {
  reals at[4];
};

INLINE Square turned_over(const Square &s)
{
#if LANES == 8
#define SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
  const reals a = SHUFFLE(s.at[0], s.at[1], 0, 8, 2, 10, 4, 12, 6, 14),
              b = SHUFFLE(s.at[0], s.at[1], 1, 9, 3, 11, 5, 13, 7, 15),
              c = SHUFFLE(s.at[2], s.at[3], 0, 8, 2, 10, 4, 12, 6, 14),
              d = SHUFFLE(s.at[2], s.at[3], 1, 9, 3, 11, 5, 13, 7, 15);
  return {{SHUFFLE(a, c, 0, 1, 8, 9, 4, 5, 12, 13), SHUFFLE(b, d, 0, 1, 8, 9, 4, 5, 12, 13),
           SHUFFLE(a, c, 2, 3, 10, 11, 6, 7, 14, 15), SHUFFLE(b, d, 2, 3, 10, 11, 6, 7, 14, 15)}};
#elif LANES == 4
#define SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
  const reals a = SHUFFLE(s.at[0], s.at[1], 0, 4, 2, 6), b = SHUFFLE(s.at[0], s.at[1], 1, 5, 3, 7),
              c = SHUFFLE(s.at[2], s.at[3], 0, 4, 2, 6), d = SHUFFLE(s.at[2], s.at[3], 1, 5, 3, 7);
  return {{SHUFFLE(a, c, 0, 1, 4, 5), SHUFFLE(b, d, 0, 1, 4, 5), SHUFFLE(a, c, 2, 3, 6, 7),
           SHUFFLE(b, d, 2, 3, 6, 7)}};
#else
  return s;
#endif
}

// Number k of the rows is column k. `row` gives the address of row n.
template <class Row> INLINE Square load_rows(const Row &row)
{
  Square s;
#if LANES == 8
  UNROLL
  for (int k = 0; k < 4; k++) {
    const quad low = load<quad>(row(k)), high = load<quad>(row(k + 4));
    s.at[k] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  }
#elif LANES == 4
  UNROLL
  for (int k = 0; k < 4; k++)
    s.at[k] = load<reals>(row(k));
#else
  UNROLL
  for (int k = 0; k < 4; k++)
    s.at[k] = reals{row(0)[k], row(1)[k]};
#endif
  return turned_over(s);
}

template <class Row> INLINE void store_rows(const Square &columns, const Row &row)
{
  const Square s = turned_over(columns);
#if LANES == 8
  UNROLL
  for (int k = 0; k < 4; k++) {
    store(__builtin_shufflevector(s.at[k], s.at[k], 0, 1, 2, 3), row(k));
    store(__builtin_shufflevector(s.at[k], s.at[k], 4, 5, 6, 7), row(k + 4));
  }
#elif LANES == 4
  UNROLL
  for (int k = 0; k < 4; k++)
    store(s.at[k], row(k));
#else
  UNROLL
  for (int k = 0; k < 4; k++)
    row(0)[k] = s.at[k][0], row(1)[k] = s.at[k][1];
#endif
}
