#include "fluid/boundary.h"

static int64_t fly_periodic(uint32_t n, int64_t *restrict x, double *restrict v, double t, double a, int64_t edge)
{
  const double gain = a * t;
  int64_t outside = 0;
  for (uint32_t i = 0; i < n; i++) {
    int64_t p = (int64_t)((uint64_t)x[i] + (uint64_t)boundary_flight(v[i], a, t)); /* wraps; a sum of int64 may not */
    p += p < 0 ? edge : 0;
    p -= p >= edge ? edge : 0;
    outside |= p | (int64_t)((uint64_t)(edge - 1) - (uint64_t)p);
    x[i] = p;
  }
  if (gain != 0.0)
    for (uint32_t i = 0; i < n; i++)
      v[i] += gain;
  return outside;
}

static const struct boundary boundaries[BOUNDARIES] = {
    [BOUNDARY_PERIODIC] = {"periodic", fly_periodic, lattice_fold},
};

const struct boundary *boundary_of(const struct box *box, int axis)
{
  return &boundaries[box->boundary[axis]];
}
