/* Alexander's polynomial of a diagram, at one place and modulo a prime. */
#ifndef UNCROSS_TOPOLOGY_ALEXANDER_H
#define UNCROSS_TOPOLOGY_ALEXANDER_H

#include "topology/diagram.h"

#define ALEXANDER_ABOVE ((uint64_t)1 << 61) /* primes are between this less 2^16 and this */

/* Of a sparse matrix: scratch that begins as zeros, to be freed with alexander_free. */
struct alexander {
  uint32_t room;
  struct sparse_row *row;       /* [room] */
  struct sparse_column *column; /* [room] */
  uint32_t *open;               /* [room] rows without a pivot */
  struct entry *sum;            /* [room] */
};

/* The minor of Alexander's matrix without its last row and column, modulo a prime (above), at t in 1 .. prime - 1: the
 * polynomial Delta(t) up to a factor +-t^m. For several curves it is that of one variable, 0 if they are split. From
 * the rows of each crossing (J. W. Alexander, Trans. Am. Math. Soc. 30, 275 (1928)): (1 - t) over + t in - out of
 * positive crossings, (1 - t) over - in + t out of negative ones. m is the same for all t, and so is the sign for t and
 * 1/t, neither of them -1: pivots are taken in an order that zeros alone decide. False if memory is short. */
bool alexander_value(struct alexander *a, const struct diagram *d, uint64_t t, uint64_t prime, uint64_t *value);
void alexander_free(struct alexander *a);

#endif
