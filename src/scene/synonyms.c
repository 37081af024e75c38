#include "scene/synonyms.h"

#include <stddef.h>
#include <string.h>

#define KEY(path) "did you mean '" path "'?"
#define UNIT "there is no such key: kT is the unit of energy, so the temperature is always 1 (docs/units.md)"

static const struct {
  const char *name, *hint;
} synonyms[] = {
    {"dt", KEY("time_step")},
    {"timestep", KEY("time_step")},
    {"delta_t", KEY("time_step")},
    {"n_steps", KEY("steps")},
    {"nsteps", KEY("steps")},
    {"random_seed", KEY("seed")},
    {"msd", KEY("observe.dynamics")},
    {"diffusion", KEY("observe.dynamics")},
    {"vacf", KEY("observe.memory")},
    {"density", KEY("solvent.per_cell")},
    {"gamma", KEY("solvent.per_cell")},
    {"alpha", KEY("solvent.rotation_angle")},
    {"angle", KEY("solvent.rotation_angle")},
    {"gravity", KEY("solvent.acceleration")},
    {"body_force", KEY("solvent.acceleration")},
    {"shear_rate", KEY("shear.rate")},
    {"polymers", KEY("fibers")},
    {"chains", KEY("fibers")},
    {"dump", KEY("trajectory")},
    {"restart", KEY("checkpoint")},
    {"viscosity",
     "there is no such key: it follows from the solvent, `uncross check` says it, and observe.stress measures it"},
    {"temperature", UNIT},
    {"kT", UNIT},
    {"kt", UNIT},
};

const char *synonym_hint(const char *name)
{
  for (size_t k = 0; k < sizeof synonyms / sizeof *synonyms; k++)
    if (strcmp(synonyms[k].name, name) == 0)
      return synonyms[k].hint;
  return NULL;
}
