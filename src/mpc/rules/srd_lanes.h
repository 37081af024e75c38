/* srd_apply once more (srd.h), of LANES particles at once: the same operations in the same order. */
#ifndef UNCROSS_MPC_RULES_SRD_LANES_H
#define UNCROSS_MPC_RULES_SRD_LANES_H

#include "mpc/cell_lanes.h"

/* New velocities of the particles from place i on. turn: columns of the turns of their cells. A member that is alone
 * keeps its velocity. */
INLINE void srd_turn_lanes(const struct solvent *s, uint32_t i, const reals turn[8], const double cosine,
                           const double sine, const bool quarter, const bool scaled)
{
  const reals vx = load_reals(&s->vx[i]), vy = load_reals(&s->vy[i]), vz = load_reals(&s->vz[i]);
  const reals nx = turn[4], ny = turn[5], nz = turn[6];
  const reals wx = vx - turn[0], wy = vy - turn[1], wz = vz - turn[2];
  const reals dot = nx * wx + ny * wy + nz * wz, along = quarter ? dot : (1.0 - cosine) * dot;
  reals x = along * nx, y = along * ny, z = along * nz;
  reals cx = ny * wz - nz * wy, cy = nz * wx - nx * wz, cz = nx * wy - ny * wx;
  if (!quarter) {
    x = cosine * wx + x, y = cosine * wy + y, z = cosine * wz + z;
    cx = sine * cx, cy = sine * cy, cz = sine * cz;
  }
  x += cx, y += cy, z += cz;
  if (scaled)
    x *= turn[7], y *= turn[7], z *= turn[7];
  const wholes active = turn[3] != 0.0;
  store_reals(&s->vx[i], choose(active, turn[0] + x, vx));
  store_reals(&s->vy[i], choose(active, turn[1] + y, vy));
  store_reals(&s->vz[i], choose(active, turn[2] + z, vz));
}

#endif
