#include "theory/flow.h"

#include "theory/theory.h"

static const double pi = 3.14159265358979323846;

double theory_slip_length(const struct collision_rule *rule, uint32_t d, double gamma, double cosine, double interval)
{
  const double loss = 1.0 - theory_vertex_retention(rule, d, 1.0, gamma, cosine);
  return THEORY_MILNE_SLIP - sqrt(2.0 / pi) * interval / loss;
}

double theory_couette_rate(double wall_rate, double height, double slip)
{
  return wall_rate / (1.0 + 2.0 * slip / height);
}

double theory_poiseuille_speed(double mass_density, double acceleration, double height, double viscosity, double slip)
{
  return mass_density * acceleration * height * height / (8.0 * viscosity) * (1.0 + 4.0 * slip / height);
}

double theory_flow_relaxation(double height, double kinematic_viscosity)
{
  return height * height / (pi * pi * kinematic_viscosity);
}

double theory_inertia_number(double frequency, double mass_density, double height, double viscosity)
{
  return frequency * mass_density * height * height / (8.0 * viscosity);
}

double theory_flow_heating(double viscosity, double rate, double mass_density, uint32_t dimensions)
{
  return 2.0 * viscosity * rate * rate / (dimensions * mass_density);
}
