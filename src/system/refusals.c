#include "system/refusals.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "system/fiber_kind.h"

enum { MOST_COUPLED = 1000 }; /* vertices of a fiber with a tensor: a matrix of 72 MB */

#define LONGEST_BESIDE_BEAD 3.0 /* a0: of a bond, with 8 standard deviations of its length and its thickness */

/* --- words of the conditions -------------------------------------------------------------------------------------- */

static bool is_zero(struct vec3 v)
{
  return v.x == 0.0 && v.y == 0.0 && v.z == 0.0;
}

static bool is_private(const struct model *m)
{
  return m->medium.kind == MEDIUM_PRIVATE;
}

static bool has_pairs(const struct model *m)
{
  return m->medium.kind == MEDIUM_PAIRS;
}

static bool is_coupled(const struct model *m)
{
  return model_is_overdamped(m) && m->medium.tensor != TENSOR_NONE;
}

static uint32_t longest_fiber(const struct model *m)
{
  uint32_t most = 0;
  for (uint32_t k = 0; k < m->kinds; k++)
    most = m->kind[k].vertices > most ? m->kind[k].vertices : most;
  return most;
}

/* The shortest bond length of all kinds. */
static double shortest_bond(const struct model *m)
{
  double least = m->kinds > 0 ? m->kind[0].bond_length : 1.0;
  for (uint32_t k = 1; k < m->kinds; k++)
    least = fmin(least, m->kind[k].bond_length);
  return least;
}

/* As the keys say it: model_has_walls and model_is_sheared know it once the box is bounded. */
static bool has_walls(const struct model *m)
{
  return m->walls.kind != WALL_ABSENT;
}

static bool is_sheared(const struct model *m)
{
  return m->shear.rate != 0.0 || m->shear.strain != 0.0;
}

static bool has_boundary(const struct model *m)
{
  return has_walls(m) || is_sheared(m);
}

static bool has_profile(const struct model *m)
{
  return m->solvent.profile != PROFILE_UNIFORM;
}

static bool is_permuted(const struct model *m)
{
  return !m->solvent.hydrodynamics && !model_has_phantoms(m);
}

static bool has_trap(const struct model *m)
{
  return m->bead.drive.spring > 0.0;
}

static bool swings(const struct model *m)
{
  return vec3_norm(m->bead.drive.amplitude) > 0.0;
}

/* a0: a bond must not touch two images of the bead, and all must be answered in one timeline. */
static double longest_bond(const struct fiber_kind *k)
{
  return fiber_mean_bond(k) + 8.0 / sqrt(k->spring) + k->diameter;
}

static bool is_event_driven(const struct model *m)
{
  return m->crossing.rule == CROSSING_EVENT_DRIVEN;
}

/* --- the list ----------------------------------------------------------------------------------------------------- */

/* First each condition becomes a function that is named by its line. Then each row becomes one of the table. */

#define JOIN(a, b) a##b
#define NAMED(line) JOIN(refused_in_line_, line)

#define REFUSE(when, key, condition, why)                                                                              \
  static bool NAMED(__LINE__)(const struct model *m, const struct fiber_kind *k)                                       \
  {                                                                                                                    \
    (void)m, (void)k;                                                                                                  \
    return condition;                                                                                                  \
  }
#include "system/refusals_list.h"
#undef REFUSE

#define REFUSE(when, key, condition, why) {when, key, NAMED(__LINE__), why},
const struct refusal refusals[] = {
#include "system/refusals_list.h"
};
const size_t refusal_count = sizeof refusals / sizeof refusals[0];

bool refusals_check(enum refusal_moment when, const struct model *model, const struct fiber_kind *kind,
                    struct model_error *error)
{
  for (size_t i = 0; i < refusal_count; i++) {
    const struct refusal *row = &refusals[i];
    if (row->when != when || !row->is(model, kind))
      continue;
    if (!kind)
      return model_reject(error, row->key, "%s", row->why);
    model_reject(error, "fibers", "%s", row->why);
    snprintf(error->path, sizeof error->path, "fibers.%" PRIu32 "%s", (uint32_t)(kind - model->kind),
             row->key + strlen("fibers"));
    return false;
  }
  return true;
}
