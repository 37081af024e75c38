/*
 * Walls at y = 0 and y = L, which move in their own planes: where they are, and what a hit does. Streaming, dumbbells
 * and contacts find out when someone meets a wall, each in its own way.
 */
#ifndef UNCROSS_WALL_WALL_H
#define UNCROSS_WALL_WALL_H

#include "wall/account.h"
#include "wall/motion.h"

/* Both walls during a collision interval. */
struct slit {
  enum wall_kind kind;
  struct vec3 wall[WALLS]; /* velocities, a0/t0 */
};

static inline struct slit slit_during(const struct model *model, uint64_t interval)
{
  return (struct slit){
      model->walls.kind,
      {shear_wall_velocity(model, WALL_LOWER, interval), shear_wall_velocity(model, WALL_UPPER, interval)}};
}

/* y of a wall, lattice units. */
static inline int64_t wall_height(const struct box *box, enum wall wall)
{
  return wall == WALL_LOWER ? 0 : box->edge[1];
}

/* True if a height is beyond a wall. A place on a wall is not. */
static inline bool wall_is_beyond(const struct box *box, int64_t y)
{
  return box->boundary[1] == BOUNDARY_WALL && (y < 0) | (y > box->edge[1]);
}

/* The velocity after a hit: 2 w - v, or at a slip wall v with v_y reversed. */
static inline struct vec3 wall_reflect(const struct slit *slit, enum wall wall, struct vec3 v)
{
  return slit->kind == WALL_SLIP ? (struct vec3){v.x, -v.y, v.z} : vec3_sub(vec3_scale(2.0, slit->wall[wall]), v);
}

/* Enters what a wall has given to a mass (m) whose velocity was `before` the hit. */
static inline void wall_gives(struct account account, enum wall wall, double mass, struct vec3 before,
                              struct vec3 after)
{
  account_enter(account, wall, vec3_scale(mass, vec3_sub(after, before)));
}

#endif
