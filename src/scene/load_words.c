#include "scene/load_words.h"

#include <math.h>
#include <stdio.h>

#include "theory/dumbbell.h"
#include "theory/load.h"

#define LIGHTEST 0.5 /* of gamma: lighter vertices hardly feel the solvent (Padding 2009, Sec. IV A) */
#define MORE 4.0     /* times as much solvent */

bool load_words(const struct model *m, const char *mass, const char *per_cell, char *text, size_t size)
{
  const double gamma = model_solvent_density(m), factor = theory_load_factor(m, 1.0, gamma);
  double heaviest = 0.0;
  if (!(factor > THEORY_HEAVY_LOAD))
    return false;
  for (uint32_t k = 0; k < m->kinds; k++)
    heaviest = fmax(heaviest, m->kind[k].frozen ? 0.0 : m->kind[k].mass);
  const double eta = theory_model_viscosity(m), lighter = fmin(LIGHTEST * gamma / heaviest, 1.0);
  char light[128] = "";
  if (lighter < 0.99)
    snprintf(light, sizeof light, "lighter vertices, %s=%.6g (%.3g times), or ", mass, lighter * heaviest,
             theory_load_factor(m, lighter, gamma));
  snprintf(text, size,
           "vertices load the fluid: they add %.3g m per %s to the solvent's %.3g and make it %.3g times as viscous, "
           "bonds even more, so that diffusion, relaxation and drag are not those of the solvent alone; use %smore "
           "solvent, %s=%.6g (%.3g times)",
           theory_load(m), model_in_cells(m) ? "cell" : "a0^3", gamma, theory_loaded_viscosity(m) / eta, light,
           per_cell, MORE * gamma, theory_load_factor(m, 1.0, MORE * gamma));
  return true;
}
