#include "theory/medium.h"

#include <math.h>

#include "medium/bath.h"
#include "system/fiber_kind.h"

static const double pi = 3.14159265358979323846;

/* <(1 - c)^n> of a step, of a pair at this distance or of a vertex. */
static double mean_loss(const struct model *m, double r, int n)
{
  const struct bath_draw *draw = bath_draw_of(m->medium.draw);
  double weight, x, loss;
  bath_weight_of(m->medium.weight)(&r, 1, &weight);
  x = weight * m->medium.rate * m->time_step;
  draw->lose(&x, 1, &loss);
  return draw->chooses ? x : pow(loss, n);
}

enum { INTERVALS = 200 }; /* even */

/* int_0^1 r^power <(1 - c)^n> dr, by Simpson's rule. */
static double integrate(const struct model *m, int power, int n)
{
  double sum = 0.0;
  for (int k = 0; k <= INTERVALS; k++) {
    const double r = (double)k / INTERVALS, weight = k == 0 || k == INTERVALS ? 1.0 : k % 2 ? 4.0 : 2.0;
    sum += weight * pow(r, power) * mean_loss(m, r, n);
  }
  return sum / (3.0 * INTERVALS);
}

double theory_medium_loss(const struct model *m, double mass)
{
  if (m->medium.kind == MEDIUM_PRIVATE)
    return mean_loss(m, 0.0, 1);
  return 4.0 / 3.0 * pi * m->medium.density / (1.0 + mass) * integrate(m, 2, 1);
}

double theory_medium_diffusion(const struct model *m, double mass)
{
  if (model_is_overdamped(m))
    return 1.0 / (mass * m->medium.rate);
  return m->time_step / mass * (1.0 / theory_medium_loss(m, mass) - 0.5);
}

double theory_medium_spring_step(const struct model *m, const struct fiber_kind *k)
{
  const double step = 4.0 * k->spring * theory_medium_diffusion(m, k->mass) * m->time_step;
  return k->vertices < 2 || m->medium.inextensible ? 0.0 : step;
}

double theory_medium_bend_step(const struct model *m, const struct fiber_kind *k)
{
  const double bond = m->medium.inextensible ? k->bond_length : fiber_mean_bond(k);
  return k->vertices < 3 ? 0.0 : 16.0 * k->bending * theory_medium_diffusion(m, k->mass) * m->time_step / (bond * bond);
}

double theory_medium_viscosity_kinetic(const struct model *m)
{
  const double rho = m->medium.density;
  const double loss = 4.0 * pi * rho * (integrate(m, 2, 1) / 3.0 - integrate(m, 2, 2) / 15.0);
  return rho > 0.0 ? rho * m->time_step * (1.0 / loss - 0.5) : 0.0;
}

double theory_medium_viscosity_collisional(const struct model *m)
{
  const double rho = m->medium.density;
  return pi / 15.0 * rho * rho * integrate(m, 4, 1) / m->time_step;
}

/* (1/3) tr D_ij/D0 of two spheres whose distance vector is Gaussian, of variance `spread` along each axis: a/r, with
 * overlaps 1 - r/4a below 2a. */
static double mean_coupling(enum medium_tensor tensor, double a, double spread)
{
  const double s = sqrt(spread), root = sqrt(2.0 / pi), cut = tensor == TENSOR_RPY ? 2.0 * a / s : 0.0;
  const double tail = exp(-0.5 * cut * cut);
  const double within = erf(cut / sqrt(2.0)) - root * cut * tail,
               distance = s * root * (2.0 - (cut * cut + 2.0) * tail);
  return a * root * tail / s + within - distance / (4.0 * a);
}

double theory_kirkwood(enum medium_tensor tensor, uint32_t n, double ratio)
{
  double sum = 0.0;
  for (uint32_t k = 1; k < n && tensor != TENSOR_NONE; k++)
    sum += 2.0 * (n - k) * mean_coupling(tensor, ratio, k / 3.0);
  return (1.0 + sum / n) / n;
}
