#include "scene/synonyms.h"

#include <stdio.h>
#include <string.h>

#define KEY(path) "did you mean '" path "'?"
#define UNIT "there is no such key: kT is the unit of energy, so the temperature is always 1 (docs/units.md)"

static const struct {
  const char *name, *hint;
  const char *path; /* of the section where it is meant; NULL: anywhere */
} synonyms[] = {
    {"dt", KEY("time_step"), NULL},
    {"timestep", KEY("time_step"), NULL},
    {"delta_t", KEY("time_step"), NULL},
    {"n_steps", KEY("steps"), NULL},
    {"nsteps", KEY("steps"), NULL},
    {"random_seed", KEY("seed"), NULL},
    {"msd", KEY("observe.dynamics"), NULL},
    {"diffusion", KEY("observe.dynamics"), NULL},
    {"vacf", KEY("observe.memory"), NULL},
    {"density", KEY("solvent.per_cell"), NULL},
    {"gamma", KEY("solvent.per_cell"), NULL},
    {"alpha", KEY("solvent.rotation_angle"), NULL},
    {"angle", KEY("solvent.rotation_angle"), NULL},
    {"gravity", KEY("solvent.acceleration"), NULL},
    {"body_force", KEY("solvent.acceleration"), NULL},
    {"shear_rate", KEY("shear.rate"), NULL},
    {"polymers", KEY("fibers"), NULL},
    {"chains", KEY("fibers"), NULL},
    {"dump", KEY("trajectory"), NULL},
    {"restart", KEY("checkpoint"), NULL},
    {"viscosity",
     "there is no such key: it follows from the solvent, `uncross check` says it, and observe.stress measures it",
     NULL},
    {"temperature", UNIT, NULL},
    {"kT", UNIT, NULL},
    {"kt", UNIT, NULL},
    {"k", KEY("fibers.spring"), "fibers"},
    {"K", KEY("fibers.spring"), "fibers"},
    {"N", KEY("fibers.vertices"), "fibers"},
    {"n", KEY("fibers.count"), "fibers"},
    {"m", KEY("fibers.mass"), "fibers"},
    {"l0", KEY("fibers.bond_length"), "fibers"},
    {"lp", KEY("fibers.persistence_length"), "fibers"},
    {"kappa", KEY("fibers.bending"), "fibers"},
    {"k", KEY("dumbbells.spring"), "dumbbells"},
    {"K", KEY("dumbbells.spring"), "dumbbells"},
};

const char *synonym_hint(const char *name, const char *path)
{
  for (size_t k = 0; k < sizeof synonyms / sizeof *synonyms; k++)
    if (strcmp(synonyms[k].name, name) == 0 && (!synonyms[k].path || strcmp(synonyms[k].path, path) == 0))
      return synonyms[k].hint;
  return NULL;
}

enum { MOST_PLACES = 2, PLACE_SIZE = 80 };

/* Where below this table a key has this name; returns how many there are, of which the first MOST_PLACES are filled. */
static size_t find_places(const struct key_table *table, const char *name, char place[MOST_PLACES][PLACE_SIZE],
                          size_t places)
{
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    if (key->type != KEY_INCLUDE && *table->path && strcmp(key->name, name) == 0) {
      if (places < MOST_PLACES)
        snprintf(place[places], PLACE_SIZE, "%s.%s", table->path, name);
      places++;
    }
    if (key->keys)
      places = find_places(key->keys, name, place, places);
  }
  return places;
}

void synonym_places(const struct key_table *top, const char *name, char *hint, size_t size)
{
  char place[MOST_PLACES][PLACE_SIZE];
  const size_t places = find_places(top, name, place, 0);
  if (places == 1)
    snprintf(hint, size, "did you mean '%s'?", place[0]);
  else if (places == 2)
    snprintf(hint, size, "did you mean '%s' or '%s'?", place[0], place[1]);
}
