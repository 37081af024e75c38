/*
 * Which bonds could a moving bond touch?
 *
 * Every bond has a margin box: the smallest box around it when the box was drawn, widened by a margin. A bond may move
 * freely inside its margin box; two bonds whose margin boxes do not overlap cannot touch. So the partners of a bond are
 * the bonds (and the images of bonds) whose margin boxes overlap its own, and a bond that is about to leave its margin
 * box renews its own list and tells its old and new partners: one fast vertex costs one bond's work, not everybody's.
 *
 * Partners are found in a grid whose cells list every margin box that touches them, each with the image that puts it
 * there. That holds for bonds of any length, in boxes of any size down to one cell. Bonds that share a vertex with this
 * one, or an image of it, are never partners: no bond reaches half a box edge, so they cannot cross.
 */
#ifndef UNCROSS_NEIGHBORS_H
#define UNCROSS_NEIGHBORS_H

#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* Margin boxes, grid and lists of all bonds from scratch. False, with the fault recorded, if memory is short. */
bool neighbors_build(const struct state *state, const struct model *model, struct work *work);

/* Makes sure that bond j stays inside its margin box while one of its ends moves to `to`, redrawing the box if need be.
 * False, with the fault recorded, if memory is short. */
bool neighbors_cover(const struct state *state, const struct model *model, struct work *work, uint32_t bond,
                     struct point to);

static inline bool margin_box_holds(const struct margin_box *box, struct point p)
{
  return p.x >= box->low.x && p.y >= box->low.y && p.z >= box->low.z && p.x <= box->high.x && p.y <= box->high.y &&
         p.z <= box->high.z;
}

/* The image of a point, so many box edges away. */
static inline struct point point_image(struct point p, const int32_t image[3], const struct box *box)
{
  return (struct point){p.x + image[0] * box->edge[0], p.y + image[1] * box->edge[1], p.z + image[2] * box->edge[2]};
}

#endif
