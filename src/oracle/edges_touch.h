/* Inside the oracle: constructed searches for a contact at a distance, of two tubes or of a bond and a bead. */
#ifndef UNCROSS_ORACLE_EDGES_TOUCH_H
#define UNCROSS_ORACLE_EDGES_TOUCH_H

#include "oracle/dice.h"
#include "oracle/rows.h"

/* What a drawn search has to be. */
struct edges_touch {
  struct oracle_search (*draw)(struct dice *d, const void *kind);
  const void *kind;
  int64_t least; /* reach at which the two pass by each other, if they can, lattice units */
  int graze;     /* they pass by in a depth of 2^graze units; 0: as they come */
  uint32_t rows;
};

static inline struct vec3 edges_vector(struct point p)
{
  return (struct vec3){(double)p.x, (double)p.y, (double)p.z};
}

/* Appends drawn searches to the n that there are, all with a contact within the drift. Returns their new number: `rows`
 * more, or fewer if the dice give none for long. */
uint32_t edges_add_touches(struct dice *d, const struct edges_touch *wanted, struct oracle_search *search, uint32_t n);

/* Appends searches at rest, without a contact: the first ones again, every other with one body in the other. */
enum { EDGES_AT_REST = 6 };
uint32_t edges_add_at_rest(struct oracle_search *search, uint32_t n);

#endif
