#include "theory/bead.h"

#include <math.h>

#include "theory/flow.h"
#include "theory/load.h"
#include "theory/theory.h"

static const double pi = 3.14159265358979323846;

double theory_bead_stokes(double viscosity, double radius)
{
  return 6.0 * pi * viscosity * radius;
}

double theory_bead_enskog(double gamma, double radius, double mass)
{
  return 16.0 / 3.0 * gamma * radius * radius * sqrt(2.0 * pi * mass / (1.0 + mass));
}

double theory_bead_radius(double radius, double slip)
{
  return radius * (radius + 2.0 * slip) / (radius + 3.0 * slip);
}

double theory_bead_box(double radius, double edge)
{
  const double x = radius / edge, cube = x * x * x;
  return 1.0 / (1.0 - 2.837297 * x + 4.0 * pi / 3.0 * cube - 27.4 * cube * cube);
}

double theory_bead_wall(double radius, double height)
{
  const double x = radius / height, cube = x * x * x;
  return 1.0 / (1.0 - 9.0 / 16.0 * x + cube / 8.0 - 45.0 / 256.0 * cube * x - cube * x * x / 16.0);
}

double theory_bead_middle(double radius, double distance)
{
  const double x = 2.0 * radius / distance, cube = x * x * x;
  return 1.0 / (1.0 - 1.004 * x + 0.418 * cube + 0.21 * cube * x - 0.169 * cube * x * x);
}

double theory_bead_quarter(double radius, double distance)
{
  const double x = 4.0 * radius / distance, cube = x * x * x;
  return 1.0 / (1.0 - 0.6526 * x + 0.1475 * cube - 0.131 * cube * x - 0.0644 * cube * x * x);
}

double theory_bead_slit(double radius, double height, double distance)
{
  return theory_bead_wall(radius, height) + theory_bead_wall(radius, distance - height) - 1.0;
}

double theory_model_bead_slip(const struct model *model)
{
  const struct solvent_model *s = &model->solvent;
  const double flat = theory_slip_length(collision_rule_of(model), model->dimensions, s->per_cell, s->cosine,
                                         model_collision_interval(model));
  return fmax(0.0, flat); /* beyond THEORY_MOST_SLIP_INTERVAL the formula falls below 0 */
}

double theory_model_bead_friction(const struct model *model)
{
  const double radius = theory_bead_radius(model->bead.radius, theory_model_bead_slip(model));
  return theory_bead_stokes(theory_loaded_viscosity(model), radius);
}
