#include "cli/check_choice.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/warnings.h"
#include "system/fiber_kind.h"
#include "system/refusals.h"

#define FAR 4.0 /* times the time of the better choice, by an estimate; three times, as measured */

/* omega dt at which the energies of the leap-frog's fastest mode are off by 2 %: the bound of the warnings. */
#define PHASE 0.283
#define BATH 0.2        /* rate dt of a private bath */
#define PAIRS_STEP 0.04 /* t0, of pairs that repel each other with this strength or less, at this density or less: */
#define REPULSION 25.0
#define DENSITY 3.0
#define RATE 9.0        /* 1/t0, of pairs that relax, or less */
#define DRIFT_SPLIT 1.4 /* a step of pairs, over one of kick-split */

enum { WORDS = 64 };

/* A step of few digits, at most this one; a part of the collision interval where there is one. */
static double rounded(const struct model *m, double most)
{
  const double power = pow(10.0, floor(log10(most) + 1e-9)), digit = most / power * (1.0 + 1e-9);
  return model_has_cells(m) ? warnings_time_step(m, most) : power * (digit >= 4.0 ? 4.0 : digit >= 2.0 ? 2.0 : 1.0);
}

static double with_step(struct model *m, double most, char words[WORDS])
{
  const double step = rounded(m, most);
  if (model_has_cells(m))
    m->solvent.interval_steps = (uint32_t)lround(model_collision_interval(m) / step);
  m->time_step = step;
  snprintf(words, WORDS, "time_step: %.6g", step);
  return 1.0;
}

static double highest_frequency(const struct model *m)
{
  double fastest = 0.0;
  for (uint32_t k = 0; k < m->kinds; k++)
    fastest = fmax(fastest, fiber_stands(&m->kind[k]) ? 0.0 : fiber_highest_frequency(&m->kind[k]));
  return fastest;
}

/* Thin free fibers that may cross in a periodic box, and nothing else: other scenes were not measured. Contacts cost by
 * the t0, and without a bath they heat, and may need a short step. */
static bool was_measured(const struct model *m)
{
  for (uint32_t k = 0; k < m->kinds; k++)
    if (vec3_norm(m->kind[k].force) > 0.0)
      return false;
  return m->dimensions == 3 && m->held == 0 && !(m->crossing.forbidden && m->bonds > 0) && m->thickness == 0 &&
         !model_has_bead(m) && !model_has_dumbbells(m) && m->box.boundary[1] == BOUNDARY_PERIODIC &&
         !(vec3_norm(m->solvent.acceleration) > 0.0);
}

static double longer_step(struct model *m, char words[WORDS])
{
  const double fastest = highest_frequency(m);
  if (!was_measured(m) || !model_is_isothermal(m) || !(fastest > 0.0) || model_is_overdamped(m) ||
      m->medium.kind == MEDIUM_PAIRS)
    return 0.0;
  const double bath = m->medium.kind == MEDIUM_PRIVATE ? BATH / m->medium.rate : INFINITY;
  return with_step(m, fmin(PHASE / fastest, bath), words);
}

/* Of a fluid alone: a light vertex among its particles would move too far. */
static double longer_step_of_pairs(struct model *m, char words[WORDS])
{
  const struct medium_model *b = &m->medium;
  const double dearer = m->scheme == SCHEME_DRIFT_SPLIT ? 1.0 : DRIFT_SPLIT;
  if (!was_measured(m) || m->vertices > 0 || b->kind != MEDIUM_PAIRS || b->draw != DRAW_RELAX ||
      b->weight != WEIGHT_QUADRATIC || b->rate > RATE || !(b->repulsion > 0.0) || b->repulsion > REPULSION ||
      b->density > DENSITY || b->many.repulsion != 0.0 || b->second.share != 0.0)
    return 0.0;
  with_step(m, PAIRS_STEP, words);
  const size_t used = dearer > 1.0 ? strlen(words) : WORDS;
  if (used < WORDS)
    snprintf(words + used, WORDS - used, " and order: drift-split");
  return dearer;
}

static double phantoms(struct model *m, char words[WORDS])
{
  if (!was_measured(m) || m->vertices == 0 || !model_has_cells(m) || model_has_phantoms(m) ||
      m->solvent.hydrodynamics || m->solvent.rule != RULE_SRD || m->solvent.per_cell > MOST_PHANTOMS)
    return 0.0;
  m->solvent.bath = BATH_PHANTOMS;
  m->solvent.particles = 0;
  snprintf(words, WORDS, "solvent.bath: phantoms%s",
           m->solvent.thermostat != THERMOSTAT_NONE ? ", thermostat: none" : "");
  return 1.0;
}

/* Changes a copy of the scene's model to the better choice, and names it. Returns what a step gets dearer by that the
 * estimate does not know; 0 where nothing was measured. */
static const struct choice {
  double (*make)(struct model *model, char words[WORDS]);
  const char *right;
} choices[] = {
    {longer_step, "D of chains comes out the same"},
    {longer_step_of_pairs, "pressure and both temperatures are right to 1 %"},
    {phantoms, "D of vertices and chains of mass 5 was measured to be the same to 2 %"},
};

void check_choice(const struct model *m, double (*cost)(const struct model *model))
{
  double most = FAR;
  char best[2 * WORDS + 128] = "";
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
    struct model other = *m;
    char words[WORDS];
    const double dearer = choices[k].make(&other, words);
    const double times = dearer > 0.0 ? cost(m) / m->time_step / (dearer * cost(&other) / other.time_step) : 0.0;
    if (times >= most) {
      most = times;
      snprintf(best, sizeof best, "%.*f times as long as with %s, where %s", times < 9.95, times, words,
               choices[k].right);
    }
  }
  if (best[0] != '\0')
    printf("  this scene takes %s (docs/claims/settings.md)\n", best);
}
