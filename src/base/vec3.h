/* Three doubles, and the few operations on them that the physics needs. */
#ifndef UNCROSS_BASE_VEC3_H
#define UNCROSS_BASE_VEC3_H

#include "base/machine.h"

#include <math.h>

struct vec3 {
  double x, y, z;
};

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
  return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
  return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec3 vec3_scale(double s, struct vec3 a)
{
  return (struct vec3){s * a.x, s * a.y, s * a.z};
}

/* a + s b */
static inline struct vec3 vec3_add_scaled(struct vec3 a, double s, struct vec3 b)
{
  return (struct vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline double vec3_dot(struct vec3 a, struct vec3 b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
  return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double vec3_norm(struct vec3 a)
{
  return sqrt(vec3_dot(a, a));
}

#endif
