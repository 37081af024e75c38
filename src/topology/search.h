/* Pairs of bonds whose swept boxes overlap between two frames, with all periodic images that they reach. */
#ifndef UNCROSS_TOPOLOGY_SEARCH_H
#define UNCROSS_TOPOLOGY_SEARCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/lattice.h"
#include "topology/pair.h"

/* Of positions, edges and offsets: with them sums of images stay below 2^62, if an edge does not double in an interval.
 */
#define SEARCH_REACH ((int64_t)1 << 58)
#define SEARCH_MOST_BOXES(bonds) (64 * (size_t)(bonds) + 4096) /* swept boxes, with images */

/* At [0] the first frame, at [1] the second. An image with whole numbers n is shifted by n edge, and by n.y offset
 * along x; all between the frames even in time. Lattice units, of any size. */
struct interval {
  uint32_t vertices, bonds;
  const uint32_t (*bond)[2];
  const struct point *position[2]; /* [vertices], unwrapped, within SEARCH_REACH */
  int64_t edge[2][3];              /* above 0 where the axis is periodic */
  bool periodic[3];
  int64_t offset[2]; /* of the image beyond y = Ly along x, unreduced */
  double near;       /* below it pairs are counted */
};

/* The second bond in the image with these numbers against the first, both unwrapped. */
struct meeting {
  uint32_t bond[2];
  int64_t image[3];
};

typedef void search_found(void *sink, const struct meeting *meeting, enum pair_verdict verdict,
                          const struct crossing *crossing, int crossings);

/* What is searched with, of any number of intervals one after the other. Begins as zeros. */
struct search {
  struct swept *box;
  uint32_t *first, *entry;
  uint32_t room, cells_room, entry_room;
};

enum search_verdict { SEARCH_DONE, SEARCH_NO_MEMORY, SEARCH_TOO_FAR };

/* Calls `found` for each pair that is not apart. SEARCH_TOO_FAR: moves or bonds reach too many images. Counts the pairs
 * that are looked at, and those that are nearer than `near` at the first frame. */
enum search_verdict search_pairs(struct search *search, const struct interval *v, search_found *found, void *sink,
                                 uint64_t *looked_at, uint64_t *near);
void search_free(struct search *search);

/* Bytes that a search of so many bonds takes, if moves are short and the box is some bonds long. */
uint64_t search_bytes(uint32_t bonds);

#endif
