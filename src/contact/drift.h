/*
 * Displacements of vertices in a drift (Padding 2009, Eq. (4)), before any test for crossings.
 *
 * In a sheared box, bonds that must not cross drift in sheared coordinates x' = x - strain (y - L/2), where strain is
 * that of the box at the time: its image beyond y = L has slid by strain L. In these coordinates images stand still, a
 * linear flow moves nothing, and whether two bonds cross is the same question, since the map is affine. Distances and
 * directions are not the same: normals of contacts are taken back (drift_normal, drift_true).
 *
 * Places are whole numbers of lattice units in both coordinates, and the map between them has an inverse: contacts
 * found on one side of it are contacts on the other. At the end of a drift a vertex is at the end of its straight path
 * in the laboratory. Between, a path that is straight in sheared coordinates is off the laboratory's by
 * at most a quarter of rate |v_y| dt^2, 1e-6 a0.
 */
#ifndef UNCROSS_CONTACT_DRIFT_H
#define UNCROSS_CONTACT_DRIFT_H

#include "contact/contact.h"
#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"

/* The frame of a drift that begins now and takes this part of a time step. drift: its number within the step, 0 or 1.
 * forbids: bonds must not cross. */
struct drift_frame drift_frame_now(const struct state *state, const struct model *model, double fraction,
                                   uint32_t drift, bool forbids);

/* The displacement along x of a vertex at height y because the box is sheared; d: what it moves without that. */
static inline double drift_sheared(const struct drift_frame *f, struct vec3 d, int64_t y)
{
  return d.x - f->strain * d.y - f->growth * ((double)(y - f->middle) * LATTICE_UNIT);
}

/* Displacement (a0), in a drift, of a vertex of this velocity that stands at height y at its start (lattice units). */
static inline struct vec3 drift_displacement(const struct drift_frame *f, struct vec3 velocity, int64_t y)
{
  struct vec3 d = vec3_scale(f->time, vec3_sub(velocity, f->velocity));
  if (f->sheared)
    d.x = drift_sheared(f, d, y);
  return d;
}

/* A vector of sheared coordinates, of a place in this part of the drift, as it is in space. */
static inline struct vec3 drift_true(const struct drift_frame *f, struct vec3 r, double part)
{
  if (f->sheared)
    r.x += (f->strain - (1.0 - part) * f->growth) * r.y;
  return r;
}

/* The unit normal, in space, of a plane whose normal is n in sheared coordinates, at the end of the drift. */
static inline struct vec3 drift_normal(const struct drift_frame *f, struct vec3 n)
{
  if (!f->sheared || f->strain == 0.0) /* the same bits as in a periodic box */
    return n;
  n.y -= f->strain * n.x;
  return vec3_scale(1.0 / vec3_norm(n), n);
}

/* A place in space -> its place in sheared coordinates, with the strain of the start of the drift; and back, with that
 * of its end. */
struct point drift_enter(const struct drift_frame *f, struct point p);
struct point drift_leave(const struct drift_frame *f, struct point p);

/* A place in sheared coordinates after this part of the drift, in space; rounded. */
struct point drift_place(const struct drift_frame *f, struct point p, double part);

/* True if vertex i may move by d in one drift. False, with the fault recorded, if a component of d is half the shortest
 * edge or more, or not a number. */
bool drift_legal(const struct state *state, const struct model *model, uint32_t i, struct vec3 d, struct fault *fault);

/* The trial position of vertex i. False as drift_legal. */
bool drift_trial(const struct state *state, const struct model *model, const struct drift_frame *frame, uint32_t i,
                 struct point *to, struct fault *fault);

/* Displacements of vertices first .. first + n - 1: d[n], a0. False as drift_legal. */
bool drift_displacements(const struct state *state, const struct model *model, const struct drift_frame *frame,
                         uint32_t first, uint32_t n, struct vec3 *restrict d, struct fault *fault);

#endif
