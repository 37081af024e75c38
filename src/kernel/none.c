/* In place of rows.c, built with PLAIN=1 or for other processors: no fast kernel. */
#include "kernel/choose.h"

const struct kernel_row kernel_rows[] = {{&kernel_plain, NULL}};
const size_t kernel_row_count = 0;
