/* The impulse that two bonds exchange instead of crossing (Padding 2009, Sec. III B). */
#ifndef UNCROSS_CONTACT_IMPULSE_H
#define UNCROSS_CONTACT_IMPULSE_H

#include <math.h>
#include <stdbool.h>

#include "base/vec3.h"

/* The ends of the moving bond (i, pivot) and of the standing bond (j, j+1): velocities, changed in place, and 1/M. */
struct impulse_end {
  struct vec3 *velocity;
  double inverse_mass;
};

/* An impulse dP along n passes from the moving bond to the standing one. The lever rule shares it among the four ends.
 * The relative velocity of the two contact points reverses along n; kinetic energy and momentum are conserved. Returns
 * dP, which is negative where the points were separating (footnote 61).
 *
 * Padding 2009, Eqs. (22)-(25) and (28), here for vertices of any mass: with equal masses
 * dP = 2M [(1-s) V_i + s V_{i+1} - (1-s') V_j - s' V_{j+1}].n / [(1-s)^2 + s^2 + (1-s')^2 + s'^2]. */
static inline double impulse_exchange(const struct impulse_end moving[2], const struct impulse_end standing[2],
                                      double s, double s_standing, struct vec3 n)
{
  const double lever[4] = {1.0 - s, s, s_standing - 1.0, -s_standing};
  const struct impulse_end end[4] = {moving[0], moving[1], standing[0], standing[1]};
  double approach = 0.0, compliance = 0.0;
  for (int k = 0; k < 4; k++) {
    approach += lever[k] * vec3_dot(*end[k].velocity, n);
    compliance += lever[k] * lever[k] * end[k].inverse_mass;
  }
  const double impulse = compliance > 0.0 ? 2.0 * approach / compliance : 0.0; /* 0: they touch where both are held */
  for (int k = 0; k < 4; k++)
    *end[k].velocity = vec3_add_scaled(*end[k].velocity, -lever[k] * impulse * end[k].inverse_mass, n);
  return impulse;
}

/* --- at its own time ---------------------------------------------------------------------------------------------- */

/* Where two bonds touch: s along the first, t along the other, and the unit normal from the first to the other. */
struct contact_geometry {
  double s, t;
  struct vec3 normal;
  double impulse; /* the answer: m a0/t0 */
};

/* An end of one of the two bonds: its velocity, changed in place, 1/M, and the force on it at the contact. */
struct contact_end {
  struct vec3 *velocity;
  double inverse_mass;
  struct vec3 force;
};

enum contact_answer {
  CONTACT_NONE,      /* the bonds do not approach: nothing is changed */
  CONTACT_CORRECTED, /* the velocity of the present is reversed */
  CONTACT_SOFTENED   /* the same, but not slower than a fifth of the approach, nor faster than five times */
};

/* The rebound of the corrected impulse is at least this part of the approach, and at most the approach over it. Beyond,
 * it is softened. A slower one would meet the other bond again and again. */
#define CONTACT_SLOWEST_REBOUND 0.2

/* The speed a' of the rebound for an approach speed a > 0, and h, tau times the approach speed that F/M gives:
 *   a + 2 h                    from a/5 to 5 a
 *   1/a' = 1/a + 1.6/|h|       slower than a/5: here h < 0
 *   1/a' = 1/a - 1.6/|h|       faster than 5 a
 * It is continuous: 1.6 = 4 * 2/5 = 4/5 * 2. Backwards in time a and a' exchange their places, and h its sign; each
 * line is then its own inverse, or the other's. For h = 0 and for large |h|/a the rebound is a. Where bonds are driven
 * together again and again within a drift, rebounds that were a fixed part of the approach would come ever faster. */
static inline double contact_rebound(double a, double h)
{
  const double straight = a + 2.0 * h, size = fabs(h);
  if (straight < CONTACT_SLOWEST_REBOUND * a)
    return a * size / (size + 1.6 * a);
  if (straight * CONTACT_SLOWEST_REBOUND > a)
    return a * size / (size - 1.6 * a);
  return straight;
}

/* The impulse of a contact at a time tau (t0) from the middle of the step. It reverses, along the normal, the relative
 * velocity of the contact points that belongs to u = v + tau F/M: the approach speed a of v becomes the rebound a + 2
 * h, in bounds (contact_rebound). Ends: (i, i+1) of the first bond, then of the other. */
static inline enum contact_answer impulse_at_own_time(const struct contact_end end[4], struct contact_geometry *at,
                                                      double tau)
{
  const double lever[4] = {1.0 - at->s, at->s, at->t - 1.0, -at->t};
  double approach = 0.0, pull = 0.0, compliance = 0.0;
  for (int k = 0; k < 4; k++) {
    approach += lever[k] * vec3_dot(*end[k].velocity, at->normal);
    pull += lever[k] * (vec3_dot(end[k].force, at->normal) * end[k].inverse_mass);
    compliance += (lever[k] * lever[k]) * end[k].inverse_mass;
  }
  at->impulse = 0.0;
  if (!(approach > 0.0))
    return CONTACT_NONE;
  const double h = tau * pull, rebound = contact_rebound(approach, h);
  at->impulse = (approach + rebound) / compliance;
  for (int k = 0; k < 4; k++)
    *end[k].velocity = vec3_add_scaled(*end[k].velocity, -lever[k] * at->impulse * end[k].inverse_mass, at->normal);
  return rebound == approach + 2.0 * h ? CONTACT_CORRECTED : CONTACT_SOFTENED;
}

#endif
