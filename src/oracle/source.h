/* Inside the oracle: how a source is written, in a line (sources.c, sources_rows.c). A stage is g, its model M; k is a
 * place in memory. */
#ifndef UNCROSS_ORACLE_SOURCE_H
#define UNCROSS_ORACLE_SOURCE_H

#include <string.h>

#include "oracle/sources.h"

#define M g->model

/* How many rows there are; the number of the row at place k. */
#define COUNT(name, ...)                                                                                               \
  static uint32_t count_##name(const struct oracle_stage *g)                                                           \
  {                                                                                                                    \
    (void)g;                                                                                                           \
    return (uint32_t)(__VA_ARGS__);                                                                                    \
  }
#define NUMBER(name, ...)                                                                                              \
  static uint32_t number_##name(const struct oracle_stage *g, uint32_t k)                                              \
  {                                                                                                                    \
    return __VA_ARGS__;                                                                                                \
  }

/* What is at place k of a stage g: numbers, a point of the lattice, a vector. */
#define FILL(name, type, ...)                                                                                          \
  static void fill_##name(const struct oracle_stage *g, uint32_t k, type *row)                                         \
  {                                                                                                                    \
    (void)g, (void)k;                                                                                                  \
    __VA_ARGS__                                                                                                        \
  }
#define INTEGERS(name, entity, words, ...)                                                                             \
  FILL(name, int64_t, const int64_t numbers[] = {__VA_ARGS__}; memcpy(row, numbers, sizeof numbers);)                  \
  const struct oracle_source from_##name = {.columns = words, .of = &(entity), .integers = fill_##name};
#define REALS(name, entity, words, ...)                                                                                \
  FILL(name, double, const double numbers[] = {__VA_ARGS__}; memcpy(row, numbers, sizeof numbers);)                    \
  const struct oracle_source from_##name = {.columns = words, .of = &(entity), .reals = fill_##name};
#define POINT(name, entity, ...)                                                                                       \
  FILL(name, int64_t, const struct point at = __VA_ARGS__; row[0] = at.x, row[1] = at.y, row[2] = at.z;)               \
  const struct oracle_source from_##name = {.columns = "x y z", .of = &(entity), .integers = fill_##name};
#define VECTOR(name, entity, ...)                                                                                      \
  FILL(name, double, const struct vec3 v = __VA_ARGS__; row[0] = v.x, row[1] = v.y, row[2] = v.z;)                     \
  const struct oracle_source from_##name = {.columns = "x y z", .of = &(entity), .reals = fill_##name};

/* The same of what can be taken from a pack: how a row of numbers n is taken, true if that may be asked. */
#define TAKE(name, type, ...)                                                                                          \
  static bool take_##name(struct oracle_stage *g, uint32_t k, const void *row)                                         \
  {                                                                                                                    \
    (void)k;                                                                                                           \
    const type *n = row;                                                                                               \
    return __VA_ARGS__;                                                                                                \
  }
#define TAKEN_INTEGERS(name, entity, words, take, ...)                                                                 \
  FILL(name, int64_t, const int64_t numbers[] = {__VA_ARGS__}; memcpy(row, numbers, sizeof numbers);)                  \
  TAKE(name, int64_t, take)                                                                                            \
  const struct oracle_source from_##name = {words, &(entity), fill_##name, NULL, take_##name};
#define TAKEN_REALS(name, entity, words, take, ...)                                                                    \
  FILL(name, double, const double numbers[] = {__VA_ARGS__}; memcpy(row, numbers, sizeof numbers);)                    \
  TAKE(name, double, take)                                                                                             \
  const struct oracle_source from_##name = {words, &(entity), NULL, fill_##name, take_##name};
#define TAKEN_POINT(name, entity, at)                                                                                  \
  TAKEN_INTEGERS(name, entity, "x y z", ((at) = (struct point){n[0], n[1], n[2]}, true), (at).x, (at).y, (at).z)
#define TAKEN_VECTOR(name, entity, v)                                                                                  \
  TAKEN_REALS(name, entity, "x y z", ((v) = (struct vec3){n[0], n[1], n[2]}, true), (v).x, (v).y, (v).z)

#endif
