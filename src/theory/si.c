#include "theory/si.h"

#include <math.h>

#include "theory/theory.h"

double si_convert(const struct si_scale *scale, struct si_dimension d, double reduced)
{
  const double time = d.time == 0 ? 1.0 : scale->time > 0.0 ? pow(scale->time, d.time) : NAN;
  return reduced * pow(scale->length, d.length) * pow(scale->energy, d.energy) * time;
}

double si_mass(const struct si_scale *scale)
{
  return si_convert(scale, (struct si_dimension){.length = -2, .energy = 1, .time = 2}, 1.0);
}

double si_time_of_mass(const struct si_scale *scale, double mass)
{
  return scale->length * sqrt(mass / scale->energy);
}

double si_time_of_density(const struct si_scale *scale, double density, double gamma)
{
  const double cell = scale->length * scale->length * scale->length;
  return si_time_of_mass(scale, density * cell / gamma);
}

double si_time_of_viscosity(const struct si_scale *scale, double viscosity, double reduced)
{
  const double cell = scale->length * scale->length * scale->length;
  return viscosity * cell / (scale->energy * reduced);
}

double si_wormlike_square(double length, double persistence)
{
  const double x = length / persistence;
  /* The bracket for stiff chains is x/2 - x^2/6 ..., of which doubles lose all digits. */
  const double bracket = x < 1e-3 ? x * (0.5 - x * (1.0 / 6.0 - x / 24.0)) : 1.0 + expm1(-x) / x;
  return 2.0 * persistence * length * bracket;
}

double si_bending(const struct fiber_kind *kind, double persistence)
{
  struct fiber_kind k = *kind;
  double low = 0.0, high = MODEL_MOST_BENDING;
  for (int i = 0; i < 200; i++) {
    k.bending = 0.5 * (low + high);
    if (theory_effective_persistence(&k) < persistence)
      low = k.bending;
    else
      high = k.bending;
  }
  return high;
}
