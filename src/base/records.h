/*
 * Records in memory, as columns in registers (registers.h): LANES records of four or eight numbers of 64 bits become
 * four or eight registers, each with one number of every record, and back. Registers of two are exchanged where that is
 * cheap; so which lane has which record is in a table, slot_lane or lane_record.
 */
#ifndef UNCROSS_BASE_RECORDS_H
#define UNCROSS_BASE_RECORDS_H

#include "base/registers.h"

/* Of two rows: blocks of one lane, then of two, change places across the diagonal. */
#define EXCHANGE(a, b, low, high)                                                                                      \
  do {                                                                                                                 \
    const reals first = SHUFFLE(a, b, low), second = SHUFFLE(a, b, high);                                              \
    (a) = first;                                                                                                       \
    (b) = second;                                                                                                      \
  } while (0)
#if LANES == 8
#define LOW_1 0, 8, 2, 10, 4, 12, 6, 14
#define HIGH_1 1, 9, 3, 11, 5, 13, 7, 15
#define LOW_2 0, 1, 8, 9, 4, 5, 12, 13
#define HIGH_2 2, 3, 10, 11, 6, 7, 14, 15
#elif LANES == 4
#define LOW_1 0, 4, 2, 6
#define HIGH_1 1, 5, 3, 7
#define LOW_2 0, 1, 4, 5
#define HIGH_2 2, 3, 6, 7
#else
#define LOW_1 0, 2
#define HIGH_1 1, 3
#endif

/* Transposes squares of four, with AVX-512 in each half of the registers; without AVX squares of two. */
INLINE void exchange_rows(reals *r, int rows)
{
  UNROLL
  for (int k = 0; k < rows; k += 2)
    EXCHANGE(r[k], r[k + 1], LOW_1, HIGH_1);
#if LANES >= 4
  EXCHANGE(r[0], r[2], LOW_2, HIGH_2);
  EXCHANGE(r[1], r[3], LOW_2, HIGH_2);
#endif
}

/* Four columns become LANES records of four: that of lane slot_lane[k] is at place k. */
#if LANES == 8
static const uint32_t slot_lane[LANES] = {0, 4, 1, 5, 2, 6, 3, 7};
#elif LANES == 4
static const uint32_t slot_lane[LANES] = {0, 1, 2, 3};
#else
static const uint32_t slot_lane[LANES] = {0, 1};
#endif

INLINE void store_records(double *records, reals column[4])
{
  exchange_rows(column, 4);
  UNROLL
  for (int k = 0; k < 4; k++)
    store_reals(records + k * LANES, column[LANES == 2 ? k / 2 + 2 * (k % 2) : k]);
}

/* Adds a record of four words, or of four doubles, to another one, in one or two registers. */
typedef uint64_t part __attribute__((vector_size(LANES > 2 ? 32 : 16)));
typedef double real_part __attribute__((vector_size(LANES > 2 ? 32 : 16)));

INLINE void add_real_record(double *to, const double *record)
{
  UNROLL
  for (size_t k = 0; k < 32 / sizeof(real_part); k++) {
    real_part sum, addend;
    memcpy(&sum, (char *)to + k * sizeof sum, sizeof sum);
    memcpy(&addend, (const char *)record + k * sizeof addend, sizeof addend);
    sum += addend;
    memcpy((char *)to + k * sizeof sum, &sum, sizeof sum);
  }
}

INLINE void add_record(uint64_t *to, const double *record)
{
  UNROLL
  for (size_t k = 0; k < 32 / sizeof(part); k++) {
    part sum, addend;
    memcpy(&sum, (char *)to + k * sizeof sum, sizeof sum);
    memcpy(&addend, (const char *)record + k * sizeof addend, sizeof addend);
    sum += addend;
    memcpy((char *)to + k * sizeof sum, &sum, sizeof sum);
  }
}

/* Columns of LANES records of four, of which column lane k is from record lane_record[k]. */
#if LANES == 8
#define LANE_RECORD 0, 2, 4, 6, 1, 3, 5, 7
#elif LANES == 4
#define LANE_RECORD 0, 1, 2, 3
#else
#define LANE_RECORD 0, 1
#endif
static const uint32_t lane_record[LANES] = {LANE_RECORD};

/* Which record each lane has. */
INLINE words lane_records(void)
{
  words record;
  UNROLL
  for (int k = 0; k < LANES; k++)
    record[k] = lane_record[k];
  return record;
}

/* LANES numbers, in the order of the records of such columns. */
INLINE words load_as_records(const int64_t *p)
{
  const reals x = (reals)load_words(p);
  return (words)SHUFFLE(x, x, LANE_RECORD);
}

INLINE void load_records(const void *records, reals column[4])
{
  UNROLL
  for (int k = 0; k < 4; k++)
    memcpy(&column[LANES == 2 ? k / 2 + 2 * (k % 2) : k], (const double *)records + k * LANES, sizeof *column);
  exchange_rows(column, 4);
}

enum { PART = LANES == 8 ? 4 : LANES }; /* doubles of a record that are in one register */

/* Half of a record of eight doubles, from two records with AVX-512. */
INLINE reals load_parts(const double *low, const double *high)
{
#if defined HAS_512
  return (reals)_mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(low)), _mm256_loadu_pd(high), 1);
#else
  reals x;
  memcpy(&x, low, PART * sizeof *low);
  if (PART < LANES)
    memcpy((char *)&x + PART * sizeof *low, high, PART * sizeof *low);
  return x;
#endif
}

INLINE void store_parts(double *low, double *high, reals x)
{
#if defined HAS_512
  _mm256_storeu_pd(low, _mm512_castpd512_pd256((__m512d)x));
  _mm256_storeu_pd(high, _mm512_extractf64x4_pd((__m512d)x, 1));
#else
  memcpy(low, &x, PART * sizeof *low);
  if (PART < LANES)
    memcpy(high, (const char *)&x + PART * sizeof *low, PART * sizeof *low);
#endif
}

/* Stores columns as records of eight doubles; that of lane k has the number first + lane_record[k]. */
INLINE void store_columns(double *records, uint32_t first, reals column[8])
{
  UNROLL
  for (int c = 0; c < 8; c += PART) {
    exchange_rows(&column[c], PART);
    UNROLL
    for (int k = 0; k < PART; k++)
      store_parts(records + (size_t)8 * (first + lane_record[k]) + c,
                  records + (size_t)8 * (first + lane_record[k + LANES - PART]) + c, column[c + k]);
  }
}

/* Columns of records that begin at these addresses: column[c] holds entry c of each, c from 0 to 3, or to 7. */
INLINE void load_columns_at(const double *const record[LANES], reals *column, const int columns)
{
  UNROLL
  for (int c = 0; c < columns; c += PART) {
    UNROLL
    for (int k = 0; k < PART; k++)
      column[c + k] = load_parts(record[k] + c, record[k + LANES - PART] + c);
    exchange_rows(&column[c], PART);
  }
}

/* The same of records of eight doubles that have these numbers. */
INLINE void load_columns(const double *records, const uint32_t number[LANES], reals *column, const int columns)
{
  const double *record[LANES]; /* gcc makes an address for each half of a record, unless it is told that there is one */
  UNROLL
  for (int k = 0; k < LANES; k++)
    record[k] = (const double *)((const char *)records + ((size_t)number[k] << 6));
  load_columns_at(record, column, columns);
}

#endif
