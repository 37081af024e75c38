/* The fast kernels for x86-64. The Makefile compiles solvent.c for each; with PLAIN=1, and on other processors, none.c
 * takes the place of this file. */
#include "kernel/choose.h"

static bool has_sse2(void)
{
  return true; /* all x86-64 have it */
}

static bool has_avx2(void)
{
  return __builtin_cpu_supports("avx2");
}

static bool has_avx512(void)
{
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

const struct kernel_row kernel_rows[] = {
    {&kernel_sse2, has_sse2}, {&kernel_avx2, has_avx2}, {&kernel_avx512, has_avx512}};
const size_t kernel_row_count = sizeof kernel_rows / sizeof *kernel_rows;
