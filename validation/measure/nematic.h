/* Nematic order of fibers: S, the largest eigenvalue of the mean of (3 u u - 1)/2 over the box, u along the line from
 * the first vertex of a fiber to its last one. 1: all parallel. Of n directions at random it is some 1/sqrt(n). */
#ifndef UNCROSS_NEMATIC_H
#define UNCROSS_NEMATIC_H

#include <gsl/gsl_eigen.h>

#include "system/model.h"
#include "system/state.h"

static inline double nematic_order(const struct state *state, const struct model *model)
{
  double q[9] = {0};
  for (uint32_t f = 0; f < model->fibers; f++) {
    const struct vec3 r =
        point_difference(state->position[model->fiber_first[f + 1] - 1], state->position[model->fiber_first[f]]);
    const double length = vec3_norm(r), u[3] = {r.x / length, r.y / length, r.z / length};
    for (int k = 0; k < 9; k++)
      q[k] += (1.5 * u[k / 3] * u[k % 3] - 0.5 * (k / 3 == k % 3)) / model->fibers;
  }
  gsl_matrix_view view = gsl_matrix_view_array(q, 3, 3);
  gsl_vector *value = gsl_vector_alloc(3);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(3);
  gsl_eigen_symm(&view.matrix, value, work);
  const double most = gsl_vector_max(value);
  gsl_eigen_symm_free(work);
  gsl_vector_free(value);
  return most;
}

#endif
