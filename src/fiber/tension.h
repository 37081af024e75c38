/*
 * Bonds that keep their length: the tension T of each, of overdamped motion without noise. Velocities are
 *
 *   v = (D/kT) (F + G^T T),   G v = -excess,   so   (G D G^T) T = -G D F - excess:
 *
 * row j of G takes the velocity of one end of bond j along the bond, less that of the other. The excess is the length
 * that the bond has too much, over the time step: what the curvature of the last step's path has left.
 */
#ifndef UNCROSS_FIBER_TENSION_H
#define UNCROSS_FIBER_TENSION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec3.h"

#define TENSION_LEAST_PIVOT 1e-12 /* D0: of G D G^T; below, a bond has no direction or the tensor is not positive */

struct tension_bond {
  struct vec3 along; /* unit vector from one end to the other; 0: none */
  double excess;     /* kT/a0: over D0 dt */
  uint32_t from, to; /* vertices of the fiber, from 0 */
};

/* Adds G^T T to force[n], n components. d: the lower triangle of D/D0 of order n by columns, NULL: the unit matrix;
 * pull = D F. matrix[bonds^2] and t[bonds] are scratch. False if the tensions cannot be found: *pivot of the matrix G D
 * G^T is not above TENSION_LEAST_PIVOT then. */
bool tension_add(uint32_t n, const double *d, const double *pull, uint32_t bonds, const struct tension_bond *bond,
                 double *matrix, double *t, double *force, double *pivot);

#endif
