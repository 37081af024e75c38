/*
 * As many 64-bit numbers as a register holds, in the vectors of gcc and clang: 8 with AVX-512, 4 with AVX2, else 2.
 * Which of them is known when a file is compiled. + - * / & | ^ ~ << >> act on each number; a comparison gives all ones
 * for true, 0 for false. What they have no operator for is here. For the fast kernels (kernel/), which are
 * compiled for each, and for random numbers, contacts and forces, which have the lanes that the program is built for.
 * Tests ask for 8 lanes of any processor: the compiler then makes a vector of several registers.
 */
#ifndef UNCROSS_BASE_REGISTERS_H
#define UNCROSS_BASE_REGISTERS_H

#include <math.h>
#include <stdint.h>
#include <string.h>

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

/* The processor's own instructions for LANES numbers. Without them, tests run the same source on any processor. */
#if LANES == 8 && defined __AVX512F__ && defined __AVX512DQ__
#define HAS_512
#elif LANES == 4 && defined __AVX2__
#define HAS_256
#endif

typedef double reals __attribute__((vector_size(LANES * 8)));
typedef int64_t wholes __attribute__((vector_size(LANES * 8)));
typedef uint64_t words __attribute__((vector_size(LANES * 8)));
typedef uint32_t halves __attribute__((vector_size(LANES * 8)));
typedef uint32_t narrow __attribute__((vector_size(LANES * 4)));

#define INLINE static inline __attribute__((always_inline))

/* Loops over lanes are written out, at any level of optimisation: their vectors are then registers, not memory. */
#ifdef __clang__
#define UNROLL _Pragma("unroll")
#define SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define UNROLL _Pragma("GCC unroll 8")
#define SHUFFLE(a, b, ...) __builtin_shuffle(a, b, (wholes){__VA_ARGS__})
#endif

INLINE reals load_reals(const double *p)
{
  reals x;
  memcpy(&x, p, sizeof x);
  return x;
}

INLINE words load_words(const int64_t *p)
{
  words x;
  memcpy(&x, p, sizeof x);
  return x;
}

/* The first, and the second, words of LANES pairs of words. */
INLINE void load_pairs(const void *pairs, words *first, words *second)
{
  words a, b;
  memcpy(&a, pairs, sizeof a);
  memcpy(&b, (const char *)pairs + sizeof a, sizeof b);
#if LANES == 8
  *first = SHUFFLE(a, b, 0, 2, 4, 6, 8, 10, 12, 14);
  *second = SHUFFLE(a, b, 1, 3, 5, 7, 9, 11, 13, 15);
#elif LANES == 4
  *first = SHUFFLE(a, b, 0, 2, 4, 6);
  *second = SHUFFLE(a, b, 1, 3, 5, 7);
#else
  *first = SHUFFLE(a, b, 0, 2);
  *second = SHUFFLE(a, b, 1, 3);
#endif
}

INLINE void store_reals(double *p, reals x)
{
  memcpy(p, &x, sizeof x);
}

INLINE void store_words(int64_t *p, words x)
{
  memcpy(p, &x, sizeof x);
}

INLINE words load_low(const uint32_t *p)
{
  narrow low;
  memcpy(&low, p, sizeof low);
  return __builtin_convertvector(low, words);
}

/* The low half of each word. */
INLINE void store_narrow(uint32_t *p, words x)
{
  const narrow low = __builtin_convertvector(x, narrow);
  memcpy(p, &low, sizeof low);
}

/* All ones where the sign bit is set, 0 elsewhere: by what each set has instructions for. */
INLINE words negative(words x)
{
#if LANES == 2
  typedef int32_t quarters __attribute__((vector_size(16)));
  const quarters sign = (quarters)x >> 31;
#ifdef __clang__
  return (words)__builtin_shufflevector(sign, sign, 1, 1, 3, 3);
#else
  return (words)__builtin_shuffle(sign, (quarters){1, 1, 3, 3});
#endif
#elif LANES == 4
  return (words)((wholes)x < 0);
#else
  return (words)((wholes)x >> 63);
#endif
}

/* The integer nearest to each number, if its size is below 2^51; otherwise any integer of 2^51 or more. */
INLINE words round_to_words(reals x)
{
#if defined HAS_512
  return (words)_mm512_cvtpd_epi64((__m512d)x);
#else
  const reals magic = (reals){0} + 0x1.8p52;
  return (words)(x + magic) - (words)magic;
#endif
}

/* The size of signed integers, or one less if they are negative. */
INLINE words sizes(words x)
{
#if defined HAS_512
  return (words)_mm512_abs_epi64((__m512i)x);
#else
  return x ^ negative(x);
#endif
}

/* Signed integers x, and x + edge where x is negative, x - edge where x is edge or more. Within [-edge, 2 edge) this is
 * the remainder; outside of it, something outside of [0, edge). */
INLINE words wrap(words x, uint64_t edge)
{
#if defined HAS_512 /* without a sign, the one in the box is the smallest */
  x = (words)_mm512_min_epu64((__m512i)x, (__m512i)(x + edge));
  return (words)_mm512_min_epu64((__m512i)x, (__m512i)(x - edge));
#elif defined HAS_256 /* the sign chooses */
  x = (words)_mm256_blendv_pd((__m256d)x, (__m256d)(x + edge), (__m256d)x);
  const words less = x - edge;
  return (words)_mm256_blendv_pd((__m256d)less, (__m256d)x, (__m256d)less);
#else
  x += negative(x) & edge;
  return x - (negative(edge - 1 - x) & edge);
#endif
}

/* Remembers whether an x was outside of [0, edge); was_outside: one was. `seen` begins as 0. */
INLINE words see(words seen, words x, uint64_t edge)
{
#if defined HAS_512
  (void)edge;
  return (words)_mm512_max_epu64((__m512i)seen, (__m512i)x);
#else
  return seen | x | (edge - 1 - x);
#endif
}

INLINE words was_outside(words seen, uint64_t edge)
{
#if defined HAS_512
  return seen | (edge - 1 - seen);
#else
  (void)edge;
  return seen;
#endif
}

/* x, but 0 where it is n: numbers from 0 to n, n below 2^31. */
INLINE words but_not(words x, uint32_t n)
{
  const halves less = (halves)x - (halves)((words){0} + n);
#if defined HAS_512
  return (words)_mm512_min_epu32((__m512i)x, (__m512i)less);
#elif defined HAS_256
  return (words)_mm256_min_epu32((__m256i)x, (__m256i)less);
#else
  typedef int32_t quarters __attribute__((vector_size(LANES * 8)));
  return x & (words)((quarters)less >> 31);
#endif
}

/* Each word times m, both below 2^32 with a product below 2^32. */
INLINE words multiply(words x, uint32_t m)
{
  return (words)((halves)x * m);
}

/* The low half of each word times m: all 64 bits. One instruction, but gcc does not find it: it multiplies 64 bits by
 * 64, or adds shifted words, at more than twice the cost of a whole Philox. */
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
  for (int k = 0; k < LANES; k++)
    x[k] = sqrt(x[k]);
  return x;
#endif
}

/* The double nearest to each word, taken as a signed integer. Without an instruction: bits 0x433 before 52 bits k are
 * the number 2^52 + k; the high halves come as 2^84 + 2^32 (k + 2^31). Only the last sum rounds. */
INLINE reals reals_from_signed(words x)
{
#if defined HAS_512
  return (reals)_mm512_cvtepi64_pd((__m512i)x);
#else
  const reals high = (reals)(x >> 32 ^ 0x4530000080000000), low = (reals)((x & 0xffffffff) | 0x4330000000000000);
  return (high - 0x1.00000801p84) + low;
#endif
}

/* The same for words below 2^52, without a sign. */
INLINE reals reals_from_small(words x)
{
  return (reals)(x | 0x4330000000000000) - 0x1p52;
}

/* The same less a whole number, of less than 2^52 too. */
INLINE reals reals_from_small_less(words x, double number)
{
  return (reals)(x | 0x4330000000000000) - (0x1p52 + number);
}

/* (k + 0.5) 2^-31 of low halves k, taken as signed integers of 32 bits: bits 0x413 before 52 bits 2 k' + 1 are the
 * number 2^20 + (2 k' + 1) 2^-32, and k' = k + 2^31. */
INLINE reals reals_in_square(words x)
{
  return (reals)((x << 1 & 0x1fffffffe) ^ 0x4130000100000001) - (0x1p20 + 1.0);
}

/* a where the mask is all ones, b where it is 0. */
INLINE reals choose(wholes mask, reals a, reals b)
{
#if defined HAS_512
  return (reals)_mm512_mask_blend_pd(_mm512_movepi64_mask((__m512i)mask), (__m512d)b, (__m512d)a);
#else
  return (reals)(((wholes)a & mask) | ((wholes)b & ~mask));
#endif
}

/* The bitwise or of all lanes. */
INLINE uint64_t any(words x)
{
  uint64_t all = 0;
  for (int k = 0; k < LANES; k++)
    all |= x[k];
  return all;
}

/* The sum of all lanes. */
INLINE uint64_t sum_of(words x)
{
  uint64_t sum = 0;
  for (int k = 0; k < LANES; k++)
    sum += x[k];
  return sum;
}

/* True if all words are 0. */
INLINE int none(words x)
{
#if defined HAS_512
  return _mm512_test_epi64_mask((__m512i)x, (__m512i)x) == 0;
#elif defined HAS_256
  return _mm256_testz_si256((__m256i)x, (__m256i)x);
#else
  return any(x) == 0;
#endif
}

/* Bit k is set where word k is 0. */
INLINE uint32_t zeros(words x)
{
#if defined HAS_512
  return _mm512_testn_epi64_mask((__m512i)x, (__m512i)x);
#elif defined HAS_256
  return (uint32_t)_mm256_movemask_pd((__m256d)(x == 0));
#else
  uint32_t bits = 0;
  for (int k = 0; k < LANES; k++)
    bits |= (uint32_t)(x[k] == 0) << k;
  return bits;
#endif
}

/* Bit k is set where number k of 64, taken as a signed one of 32 bits, is negative. */
INLINE uint64_t negatives_of_64(const uint32_t *x)
{
  uint64_t all = 0;
  for (int k = 0; k < 64; k += 8) {
#if defined __AVX__
    const uint64_t some = (uint32_t)_mm256_movemask_ps(_mm256_loadu_ps((const float *)&x[k]));
#elif defined __SSE2__
    const uint64_t some = (uint32_t)_mm_movemask_ps(_mm_loadu_ps((const float *)&x[k])) |
                          (uint32_t)_mm_movemask_ps(_mm_loadu_ps((const float *)&x[k + 4])) << 4;
#else
    uint64_t some = 0;
    for (int i = 0; i < 8; i++)
      some |= (uint64_t)(x[k + i] >> 31) << i;
#endif
    all |= some << k;
  }
  return all;
}

/* 0, 1, ... LANES - 1 */
INLINE words lane_numbers(void)
{
  words x;
  UNROLL
  for (int k = 0; k < LANES; k++)
    x[k] = (uint64_t)k;
  return x;
}

/* Writes the low halves of those x whose mask is all ones from list[n] on, in the order of lanes, and returns the
 * length that the list has then. There is room for LANES of them. */
INLINE uint32_t append(uint32_t *list, uint32_t n, words x, words mask)
{
#if defined HAS_512
  const __mmask8 taken = _mm512_movepi64_mask((__m512i)mask);
  store_narrow(&list[n], (words)_mm512_maskz_compress_epi64(taken, (__m512i)x));
  return n + (uint32_t)__builtin_popcount(taken);
#elif defined HAS_256 /* a row has the places of the low halves that are taken */
  static const uint32_t places[16][4] = {{0}, {0},    {2},    {0, 2},    {4},    {0, 4},    {2, 4},    {0, 2, 4},
                                         {6}, {0, 6}, {2, 6}, {0, 2, 6}, {4, 6}, {0, 4, 6}, {2, 4, 6}, {0, 2, 4, 6}};
  const uint32_t taken = (uint32_t)_mm256_movemask_pd((__m256d)mask);
  const __m256i row = _mm256_castsi128_si256(_mm_loadu_si128((const __m128i *)places[taken]));
  _mm_storeu_si128((__m128i *)&list[n], _mm256_castsi256_si128(_mm256_permutevar8x32_epi32((__m256i)x, row)));
  return n + (uint32_t)__builtin_popcount(taken);
#else
  UNROLL
  for (int k = 0; k < LANES; k++) {
    list[n] = (uint32_t)x[k];
    n += (uint32_t)mask[k] & 1;
  }
  return n;
#endif
}

#endif
