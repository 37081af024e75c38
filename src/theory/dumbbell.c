#include "theory/dumbbell.h"

#include <math.h>

#include "theory/medium.h"
#include "theory/theory.h"

double theory_dumbbell_size(double spring, uint32_t d)
{
  return sqrt(d / spring);
}

double theory_dumbbell_rate(double spring, double diffusion)
{
  return 4.0 * spring * diffusion;
}

double theory_model_dumbbell_rate(const struct model *m)
{
  return theory_dumbbell_rate(m->dumbbells.spring,
                              theory_solvent_diffusion(collision_rule_of(m), m->dimensions, m->solvent.per_cell,
                                                       m->solvent.cosine, model_collision_interval(m)));
}

double theory_model_dumbbells(const struct model *m)
{
  return m->dumbbells.pairs / box_volume(&m->box);
}

double theory_model_viscosity_of_solvent(const struct model *m)
{
  return theory_viscosity(collision_rule_of(m), m->dimensions, m->solvent.per_cell, m->solvent.cosine,
                          model_collision_interval(m));
}

double theory_model_viscosity(const struct model *m)
{
  if (!model_in_cells(m))
    return theory_medium_viscosity_kinetic(m) + theory_medium_viscosity_collisional(m);
  const double springs = model_has_dumbbells(m) ? theory_model_dumbbells(m) / theory_model_dumbbell_rate(m) : 0.0;
  return theory_model_viscosity_of_solvent(m) + springs;
}

double theory_model_schmidt(const struct model *m)
{
  if (!model_in_cells(m))
    return theory_model_viscosity(m) / (m->medium.density * theory_medium_diffusion(m, 1.0));
  return theory_schmidt(collision_rule_of(m), m->dimensions, m->solvent.per_cell, m->solvent.cosine,
                        model_collision_interval(m));
}

double complex theory_dumbbell_modulus(double viscosity_of_solvent, double number, double rate, double frequency)
{
  const double x = frequency / rate, share = number / (1.0 + x * x);
  return share * x * x + (viscosity_of_solvent * frequency + share * x) * I;
}

double complex theory_dumbbell_inertia(double complex modulus, double frequency, double mass_density, double height)
{
  return ccosh(0.5 * height * frequency * csqrt(-mass_density / modulus));
}

double theory_dumbbell_normal_stress(double number, double weissenberg)
{
  return 2.0 * number * weissenberg * weissenberg;
}

double theory_dumbbell_stretch(double weissenberg, uint32_t d)
{
  return 1.0 + 2.0 / d * weissenberg * weissenberg;
}

double theory_dumbbell_angle(double weissenberg)
{
  return 0.5 * atan2(1.0, weissenberg);
}

/* A particle at y has its partner at y - r, with r Gaussian of variance kT/K, and its center at y - r/2: the mean of
 * exp(-U/kT) of the center over all r with the partner inside. Closed form: with s = 1/2 (units of sqrt(kT/K)), t = Y -
 * y of variance s^2, and the centers Y > y/2. */
double theory_dumbbell_density(double spring, double depth, double range, double y)
{
  const double s = 0.5, x = y * sqrt(spring), root = s * sqrt(2.0), low = 0.5 * x;
  const double beyond = 0.5 * erfc((fmax(low, range) - x) / root); /* centers out of reach */
  if (low >= range || depth == 0.0)
    return depth == 0.0 ? 0.5 * (1.0 + erf(x * sqrt(0.5))) : beyond;
  const double e = depth * s * s / range;
  const double within = exp(depth * (1.0 - x / range) + 0.5 * e * depth / range) * 0.5 *
                        (erf((range - x + e) / root) - erf((low - x + e) / root));
  return within + beyond;
}

/* Of pairs: the weight of a center at Y, and both particles inside, |r_y| < 2 Y. By Simpson's rule on both sides of the
 * reach. */
double theory_dumbbell_excess(double spring, double depth, double range)
{
  enum { PIECES = 2000 };
  const double border = depth == 0.0 ? 6.0 : range, ends[3] = {0.0, border, border + 12.0};
  double sum = 0.0;
  for (int part = 0; part < 2; part++) {
    const double h = (ends[part + 1] - ends[part]) / PIECES;
    for (int k = 0; k <= PIECES; k++) {
      const double share = k == 0 || k == PIECES ? 1.0 : k % 2 ? 4.0 : 2.0, height = ends[part] + k * h;
      const double weight = part == 0 && depth != 0.0 ? exp(depth * (1.0 - height / range)) : 1.0;
      sum += share * h / 3.0 * (weight * erf(height * sqrt(2.0)) - 1.0);
    }
  }
  return sum / sqrt(spring);
}

double theory_dumbbell_bulk_density(const struct model *m)
{
  const double height = m->box.cells[1], pairs = 2.0 * theory_model_dumbbells(m), alone = m->solvent.per_cell - pairs;
  const double excess = theory_dumbbell_excess(m->dumbbells.spring, m->dumbbells.depth, m->dumbbells.range);
  return alone + pairs * height / (height + 2.0 * excess);
}
