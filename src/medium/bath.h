/*
 * The one operator of all baths. A velocity component u whose conjugate mass is mu becomes
 *
 *   u' = c u + sqrt(1 - c^2) sqrt(kT/mu) xi,      xi standard normal,
 *
 * which keeps the Maxwell distribution for any c from -1 to 1. Baths differ in what u is (a component of a vertex's
 * velocity; the relative velocity of a pair along the line between them) and in c:
 *
 *   replace   0 with the probability x, else 1     Andersen, J. Chem. Phys. 72, 2384 (1980); Lowe, Europhys. Lett. 47,
 *                                                  145 (1999)
 *   relax     exp(-x)                              exact Langevin; Peters, Europhys. Lett. 66, 311 (2004)
 *   cayley    (1 - x/2)/(1 + x/2)                  Shardlow, SIAM J. Sci. Comput. 24, 1267 (2003): his two half steps
 *
 * with x = rate * weight * dt. The loss 1 - c is what is stored: the noise is sqrt(loss (2 - loss)) then, exactly
 * matched whatever the rounding of the loss.
 */
#ifndef UNCROSS_MEDIUM_BATH_H
#define UNCROSS_MEDIUM_BATH_H

#include <math.h>

#include "base/random.h"
#include "system/model.h"

struct bath_draw {
  const char *name; /* as in scenes */
  bool chooses;     /* acts on a share x of all, chosen at random; else on all */

  /* loss[n] = 1 - c of those that it acts on, for x[n] >= 0. In loops that vectorise. */
  void (*lose)(const double *restrict x, uint32_t n, double *restrict loss);
};

const struct bath_draw *bath_draw_of(enum medium_draw draw);

/* weight[n] of pairs at the distances r[n], a0, all below 1; 1 at r = 0. */
typedef void bath_weight(const double *restrict r, uint32_t n, double *restrict weight);

bath_weight *bath_weight_of(enum medium_weight weight);

/* A random word chooses with the probability x; all of 0 <= x <= 1 to 2^-33. */
static inline bool bath_chooses(uint32_t word, double x)
{
  return ((double)word + 0.5) * 0x1p-32 < x;
}

/* The amplitude of the noise, a0/t0. inverse: 1/mu. */
static inline double bath_noise(double loss, double inverse)
{
  return sqrt(loss * (2.0 - loss) * inverse);
}

/* u' - u; noise: amplitude times a normal number. */
static inline double bath_change(double u, double loss, double noise)
{
  return noise - loss * u;
}

#endif
