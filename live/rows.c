/* In place of kernel/rows.c: the fast kernel by the 128-bit vectors of WebAssembly. An engine that lacks them cannot
 * even load it, so worker.js looks first, and loads the build with kernel/none.c. */
#include "kernel/choose.h"

extern const struct kernel kernel_simd128;

static bool everywhere(void)
{
  return true;
}

const struct kernel_row kernel_rows[] = {{&kernel_simd128, everywhere}};
const size_t kernel_row_count = 1;
