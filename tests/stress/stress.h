/* Programs of `make stress`: an optional argument scales their length (0.1 for a look), a second names the tests to run
 * (with * and ?). */
#ifndef UNCROSS_STRESS_H
#define UNCROSS_STRESS_H

#include "exact.h"

/* CMocka passes nothing to its tests but this. */
static double stress_scale = 1.0;

static inline void stress_arguments(int argc, char **argv)
{
  stress_scale = argc > 1 ? atof(argv[1]) : 1.0;
  if (argc > 2)
    cmocka_set_test_filter(argv[2]);
}

static inline uint64_t scaled_count(double usual)
{
  return (uint64_t)fmax(1.0, usual * stress_scale);
}

#endif
