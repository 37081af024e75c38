/* What two bonds exchange instead of crossing (Padding 2009, Sec. III B). */
#ifndef UNCROSS_EXCHANGE_H
#define UNCROSS_EXCHANGE_H

#include "base/vec3.h"

/* The ends of the moving bond (i, pivot) and of the standing bond (j, j+1): velocities, changed in place, and 1/M. */
struct exchange_end {
  struct vec3 *velocity;
  double inverse_mass;
};

/* Momentum dP along n passes from the moving bond to the standing one, shared by the lever rule, so that the relative
 * velocity of the two contact points reverses along n: kinetic energy and momentum are kept. Returns dP, with its sign
 * (negative where the points were separating, footnote 61).
 *
 * Padding 2009, Eqs. (22)-(25) and (28), here for vertices of any mass: with equal masses
 * dP = 2M [(1-s) V_i + s V_{i+1} - (1-s') V_j - s' V_{j+1}].n / [(1-s)^2 + s^2 + (1-s')^2 + s'^2]. */
static inline double exchange_momentum(const struct exchange_end moving[2], const struct exchange_end standing[2],
                                       double s, double s_standing, struct vec3 n)
{
  const double lever[4] = {1.0 - s, s, s_standing - 1.0, -s_standing};
  const struct exchange_end end[4] = {moving[0], moving[1], standing[0], standing[1]};
  double approach = 0.0, compliance = 0.0;
  for (int k = 0; k < 4; k++) {
    approach += lever[k] * vec3_dot(*end[k].velocity, n);
    compliance += lever[k] * lever[k] * end[k].inverse_mass;
  }
  const double dp = 2.0 * approach / compliance;
  for (int k = 0; k < 4; k++)
    *end[k].velocity = vec3_add_scaled(*end[k].velocity, -lever[k] * dp * end[k].inverse_mass, n);
  return dp;
}

#endif
