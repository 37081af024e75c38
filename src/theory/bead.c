#include "theory/bead.h"

#include <math.h>

#include "theory/dumbbell.h"
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

double theory_bead_friction(double stokes, double enskog)
{
  return stokes * enskog / (stokes + enskog);
}

double theory_bead_box(double radius, double edge)
{
  const double x = radius / edge, cube = x * x * x;
  return 1.0 / (1.0 - 2.837297 * x + 4.0 * pi / 3.0 * cube - 27.4 * cube * cube);
}

double theory_model_bead_friction(const struct model *model)
{
  const struct bead_model *b = &model->bead;
  return theory_bead_friction(theory_bead_stokes(theory_model_viscosity(model), b->radius),
                              theory_bead_enskog(model->solvent.per_cell, b->radius, b->mass));
}
