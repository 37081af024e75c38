#include "medium/bath.h"

#include "base/elementary.h"

static void lose_all(const double *restrict x, uint32_t n, double *restrict loss)
{
  (void)x;
  for (uint32_t k = 0; k < n; k++)
    loss[k] = 1.0;
}

static void lose_by_relaxing(const double *restrict x, uint32_t n, double *restrict loss)
{
  for (uint32_t k = 0; k < n; k++)
    loss[k] = 1.0 - elementary_exp(-x[k]);
}

/* 1 - (1 - e)/(1 + e) = 2 e/(1 + e), e = x/2 */
static void lose_by_cayley(const double *restrict x, uint32_t n, double *restrict loss)
{
  for (uint32_t k = 0; k < n; k++)
    loss[k] = x[k] / (1.0 + 0.5 * x[k]);
}

const struct bath_draw *bath_draw_of(enum medium_draw draw)
{
  static const struct bath_draw draws[MEDIUM_DRAWS] = {[DRAW_REPLACE] = {"replace", true, lose_all},
                                                       [DRAW_RELAX] = {"relax", false, lose_by_relaxing},
                                                       [DRAW_CAYLEY] = {"cayley", false, lose_by_cayley}};
  return &draws[draw];
}

static void weigh_hat(const double *restrict r, uint32_t n, double *restrict weight)
{
  (void)r;
  for (uint32_t k = 0; k < n; k++)
    weight[k] = 1.0;
}

static void weigh_quadratic(const double *restrict r, uint32_t n, double *restrict weight)
{
  for (uint32_t k = 0; k < n; k++)
    weight[k] = (1.0 - r[k]) * (1.0 - r[k]);
}

bath_weight *bath_weight_of(enum medium_weight weight)
{
  static bath_weight *const weights[MEDIUM_WEIGHTS] = {[WEIGHT_HAT] = weigh_hat, [WEIGHT_QUADRATIC] = weigh_quadratic};
  return weights[weight];
}
