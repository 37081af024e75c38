/*
 * The diagram of closed polygons: their crossings in a projection, as arcs above and below.
 *
 * Every sign is that of an integer. Where a projection is special (a vertex on a bond's shadow, two crossings that lie
 * at one place of a bond), another direction is taken: no invariant depends on it. Polygons that touch have no
 * invariants.
 */
#ifndef UNCROSS_TOPOLOGY_DIAGRAM_H
#define UNCROSS_TOPOLOGY_DIAGRAM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"

#define DIAGRAM_REACH ((int64_t)1 << 46) /* differences of the coordinates of one diagram are below */

/* Closed polygons: those of member k are first[k] .. first[k + 1] - 1, and a bond goes on from the last to the first.
 */
struct polygons {
  uint32_t members;
  const uint32_t *first;  /* [members + 1] */
  const struct point *at; /* [first[members]], in units of any lattice */
};

/* sign: +1 if the bond above is turned counterclockwise into the one below, as seen from above; else -1. */
struct crossing {
  uint32_t bond[2];       /* above, below */
  uint32_t member[2];     /* whose these are */
  double place[2];        /* along them, 0 .. 1 */
  uint32_t over, in, out; /* arcs: above, ending here, beginning here */
  int sign;
};

enum diagram_status {
  DIAGRAM_FINE,
  DIAGRAM_TOUCHED,  /* two polygons, or two parts of one, touch */
  DIAGRAM_SPECIAL,  /* the projection is, along all directions: some touch, or are not told from it */
  DIAGRAM_TOO_FAR,  /* coordinates differ by DIAGRAM_REACH or more */
  DIAGRAM_TOO_MANY, /* crossings: more than are allowed */
  DIAGRAM_NO_MEMORY
};

/* Begins as zeros; to be freed with diagram_free. */
struct diagram {
  uint32_t crossings;
  struct crossing *crossing; /* [crossings] */
  bool split;                /* a member of several passes below nowhere: it can be lifted off, and has no arc */
  /* scratch */
  uint32_t crossing_room, vertex_room, chunk_room, passage_room;
  struct flat *flat;
  struct chunk *chunk;
  struct passage *passage;
};

/* Finds the crossings, at most `most` of them; of two members only, or, with `own`, all of them and the arcs. */
enum diagram_status diagram_make(struct diagram *d, const struct polygons *p, bool own, uint32_t most);
void diagram_free(struct diagram *d);

#endif
