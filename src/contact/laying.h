/*
 * Fibers laid one after another: does a new one overlap with those that lie there? For starting states. Thin ones
 * overlap where they touch, by the rule `event-driven`: then neither is on a side of the other, and each tick of a
 * drift is one of a contact. (`sequential` takes a volume of 0 for positive, so each bond has a side.)
 *
 * A grid of cells lists every bond in each cell that the box around its tube touches, with the image of the bond that
 * lies there. A new bond is compared with those of its cells.
 */
#ifndef UNCROSS_CONTACT_LAYING_H
#define UNCROSS_CONTACT_LAYING_H

#include "system/model.h"

/* A bond in a cell. */
struct laying_entry {
  uint32_t bond, cell;
  int32_t image[3]; /* of the bond that lies there */
  uint32_t next;    /* 1 + the number of the cell's next entry, or 0 */
};

struct laying {
  const struct model *model;
  int32_t cells[3];
  int64_t edge[3]; /* of a cell, lattice units */
  uint32_t *first; /* [cells] as `next` */
  uint32_t count, room;
  struct laying_entry *at;
  uint32_t bond, other; /* the last two that were found to overlap */
  double distance;      /* of their axes, a0 */
};

/* Whether thin bonds that touch count as an overlap. */
static inline bool laying_minds_lines(const struct model *model)
{
  return model->crossing.forbidden && model->crossing.rule == CROSSING_EVENT_DRIVEN;
}

/* An empty box. False if memory is short. laying_end frees it in any case. */
bool laying_begin(struct laying *laying, const struct model *model);
void laying_end(struct laying *laying);

enum laying_answer { LAYING_FITS, LAYING_OVERLAPS, LAYING_NO_MEMORY };

/* Adds a fiber, position[vertices of the model], if it overlaps neither with itself nor with those added before. */
enum laying_answer laying_add(struct laying *laying, const struct point *position, uint32_t fiber);

#endif
