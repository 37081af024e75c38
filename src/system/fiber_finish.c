/* The fibers of a model: what is checked of each kind, and what is derived. */
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "system/fiber_kind.h"
#include "system/model.h"
#include "system/model_keys.h"
#include "system/refusals.h"
#include "system/topology.h"

/* A kind of fiber that is being checked. */
struct look {
  struct model *model;
  struct fiber_kind *kind;
  uint32_t number; /* of the kind */
  struct model_error *error;
};

/* Records an error of one key of the kind, or of one of its places. Always returns false. */
static bool reject_kind(const struct look *look, const char *key, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool reject_kind(const struct look *look, const char *key, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  snprintf(look->error->path, sizeof look->error->path, "fibers.%" PRIu32 ".%s", look->number, key);
  vsnprintf(look->error->text, sizeof look->error->text, format, arguments);
  va_end(arguments);
  return false;
}

static bool refuses_none(const struct look *look, enum refusal_moment when)
{
  return refusals_check(when, look->model, look->kind, look->error);
}

/* Masses are summed exactly, in multiples of MODEL_MASS_UNIT. */
static bool round_mass(const struct look *look)
{
  const double rounded = nearbyint(look->kind->mass / MODEL_MASS_UNIT) * MODEL_MASS_UNIT;
  if (rounded <= 0.0)
    return reject_kind(look, "mass",
                       "%.15g is rounded to a multiple of 2^-16 = 1.52587890625e-05, which is 0; allowed: "
                       "1.52587890625e-05 to 65536",
                       look->kind->mass);
  look->kind->mass = rounded;
  return true;
}

/* kappa = l_p/l0, Eq. (2) */
static bool derive_bending(const struct look *look)
{
  struct fiber_kind *k = look->kind;
  if (!refuses_none(look, AT_BENDING))
    return false;
  if (k->persistence_length == 0.0)
    return true;
  k->bending = k->persistence_length / k->bond_length;
  return k->bending <= MODEL_MOST_BENDING ||
         reject_kind(look, "persistence_length",
                     "bending = persistence_length/bond_length is %.6g kT; allowed: at most %g", k->bending,
                     MODEL_MOST_BENDING);
}

/* A chain that stands for a finer one gets its spring from that of the other. */
static bool derive_spring(const struct look *look)
{
  struct fiber_kind *k = look->kind;
  if (!refuses_none(look, AT_SPRING))
    return false;
  if (k->stands_for == 0)
    return true;
  if (k->stands_for < k->vertices)
    return reject_kind(look, "stands_for", "%u vertices for a finer chain of %u; allowed: %u and more", k->vertices,
                       k->stands_for, k->vertices);
  k->spring /= fiber_coarse_softening(k);
  return true;
}

static bool check_shape(const struct look *look)
{
  struct fiber_kind *k = look->kind;
  if (k->ring && k->vertices < 3)
    return reject_kind(look, "vertices", "a ring of %" PRIu32 "; allowed: 3 or more", k->vertices);
  if (k->start == START_BY_SHAPE)
    k->start = k->ring ? START_CIRCLE : START_EQUILIBRIUM;
  if (k->ring != (k->start == START_CIRCLE))
    return reject_kind(look, "start", "%s for %s; allowed: %s", model_start_word(k->start),
                       k->ring ? "a ring" : "an open fiber", k->ring ? "circle" : "equilibrium | straight");
  return true;
}

static bool check_count(const struct look *look, uint64_t *vertices)
{
  *vertices += (uint64_t)look->kind->count * look->kind->vertices;
  return *vertices <= INT32_MAX ||
         reject_kind(look, "count", "%" PRIu64 " vertices up to here; allowed: 2147483647 in all", *vertices);
}

/* Bonds must stay below half the shortest edge, where another image of a vertex is as near; and everything must be
 * within reach of lattice_from_a0 when it is laid, and of 64-bit positions for a long run after that. */
static bool check_extent(const struct look *look)
{
  const struct fiber_kind *k = look->kind;
  const double bond = fiber_mean_bond(k), limit = model_longest_bond(look->model);
  if (k->vertices < 2)
    return true;
  if (!(bond < limit))
    return reject_kind(look, "bond_length",
                       "the mean length of a bond is %.6g a0; allowed: below half the shortest edge of the box, %.6g "
                       "a0",
                       bond, limit);
  const double contour = fiber_contour(k), half = k->ring ? contour / 6.283185307179586 : 0.5 * contour;
  const double longest = k->start == START_EQUILIBRIUM ? 1e6 : LATTICE_MAX_MOVE - 1.0;
  const double extent = k->start == START_EQUILIBRIUM ? contour : half;
  if (!(extent < longest))
    return reject_kind(look, "vertices", "%" PRIu32 " of them make %s of %.6g a0; allowed: below %.6g a0", k->vertices,
                       k->start == START_EQUILIBRIUM ? "a contour"
                       : k->ring                     ? "a radius"
                                                     : "a half length",
                       extent, longest);
  return true;
}

static bool check_places(const struct look *look)
{
  const struct fiber_kind *k = look->kind;
  char key[64];
  if (!refuses_none(look, AT_PLACES))
    return false;
  if (k->placed > k->count) {
    snprintf(key, sizeof key, "places.%" PRIu32, k->count);
    return reject_kind(look, key, "%" PRIu32 " places; allowed: at most as many as fibers, %" PRIu32, k->placed,
                       k->count);
  }
  for (uint32_t i = 0; i < k->placed; i++)
    if (!(vec3_norm(k->place[i].direction) > 1e-6)) {
      snprintf(key, sizeof key, "places.%" PRIu32 ".direction", i);
      return reject_kind(look, key, "no direction; allowed: any vector longer than 1e-6");
    }
  return true;
}

/* The leap-frog of the fastest vibration: Eqs. (4) and (8), is stable below omega dt = 2. A filament without
 * velocities, whose bonds are held, has none. */
static bool check_stability(const struct look *look)
{
  const double dt = look->model->time_step, omega = fiber_highest_frequency(look->kind);
  return omega * dt < 2.0 || look->model->medium.inextensible ||
         model_reject(
             look->error, "time_step",
             "%.15g is unstable for the fibers '%s', whose highest frequency is %.6g / t0; allowed: below %.6g, and "
             "a tenth of that for accuracy",
             dt, look->kind->name, omega, 2.0 / omega);
}

static int compare_names(const void *a, const void *b)
{
  const struct fiber_kind *const *ka = a, *const *kb = b;
  const int order = strcmp((*ka)->name, (*kb)->name);
  return order ? order : (*ka > *kb) - (*ka < *kb);
}

/* The number of the first kind whose name an earlier one has; the number of kinds if there is none. */
static bool find_namesake(const struct model *m, uint32_t *number)
{
  const struct fiber_kind **sorted = malloc((m->kinds + (size_t)1) * sizeof(struct fiber_kind *));
  if (!sorted)
    return false;
  for (uint32_t k = 0; k < m->kinds; k++)
    sorted[k] = &m->kind[k];
  qsort(sorted, m->kinds, sizeof(struct fiber_kind *), compare_names);
  *number = m->kinds;
  for (uint32_t k = 1; k < m->kinds; k++) {
    const uint32_t later = (uint32_t)(sorted[k] - m->kind);
    if (strcmp(sorted[k]->name, sorted[k - 1]->name) == 0 && later < *number)
      *number = later;
  }
  free(sorted);
  return true;
}

/* In a plane nothing moves along z. */
static bool check_plane(const struct look *look)
{
  const struct fiber_kind *k = look->kind;
  char key[64];
  if (!refuses_none(look, AT_PLANE))
    return false;
  for (uint32_t i = 0; i < k->placed && model_is_flat(look->model); i++) {
    const struct fiber_place *p = &k->place[i];
    snprintf(key, sizeof key, "places.%" PRIu32 ".%s", i, p->center.z != 0.0 ? "center" : "direction");
    if (p->center.z != 0.0)
      return reject_kind(look, key, "with dimensions: 2 everything is at z = 0; allowed: a z component of 0");
    if (k->ring ? p->direction.x != 0.0 || p->direction.y != 0.0 : p->direction.z != 0.0)
      return reject_kind(look, key, "out of the plane; allowed with dimensions: 2: %s",
                         k->ring ? "[0, 0, 1], normal to the plane" : "a z component of 0");
  }
  return true;
}

/* Between walls a fiber must have room in any direction, and a place that is given must be between them. */
static bool check_gap(const struct look *look)
{
  const struct fiber_kind *k = look->kind;
  const double gap = look->model->box.cells[1], contour = k->vertices > 1 ? fiber_contour(k) : 0.0;
  const double most = k->ring ? contour / 3.141592653589793 : contour;
  char key[64];
  if (look->model->walls.kind == WALL_ABSENT)
    return true;
  if (!(most < gap))
    return reject_kind(look, "vertices",
                       "%" PRIu32 " of them span %.6g a0, and the walls are %.6g a0 apart; allowed: "
                       "less than that",
                       k->vertices, most, gap);
  for (uint32_t i = 0; i < k->placed; i++) {
    const struct fiber_place *p = &k->place[i];
    const double along = fabs(p->direction.y) / vec3_norm(p->direction);
    const double half = 0.5 * most * (k->ring ? sqrt(fmax(0.0, 1.0 - along * along)) : along);
    snprintf(key, sizeof key, "places.%" PRIu32 ".center", i);
    if (!(p->center.y - half >= 0.0 && p->center.y + half <= gap))
      return reject_kind(look, key, "this fiber reaches from y = %.6g to %.6g a0, beyond a wall; allowed: 0 to %.6g a0",
                         p->center.y - half, p->center.y + half, gap);
  }
  return true;
}

/* a0: far above the motion in a tick, which turns the normal by its part of the diameter. */
#define THINNEST_TUBE 1e-4

/* How many bonds away a tube sees others of its fiber. With n bonds between them, two may touch at any bend if n bonds
 * are shorter than pi D/2, and without a bend if they are shorter than D. Lengths scatter by the width of a bond's
 * spring: three times that leaves their distribution as it is (docs/thick.md). */
static uint32_t bonds_between_seen(const struct fiber_kind *k, double bond)
{
  const double width = 1.0 / sqrt(k->spring);
  uint32_t n = 1;
  while (n * bond < 1.5707963267948966 * k->diameter || n * bond - 3.0 * width * sqrt(n) < k->diameter)
    n++;
  return n;
}

/* A tube as thick as the bonds are long would be blind to three bonds and more, and overlap with them. */
static bool derive_tube(const struct look *look)
{
  struct fiber_kind *k = look->kind;
  const double bond = fiber_mean_bond(k);
  k->radius = 0, k->blind = 0;
  if (!refuses_none(look, AT_TUBE))
    return false;
  if (k->diameter == 0.0)
    return true;
  if (!(k->diameter >= THINNEST_TUBE && k->diameter <= bond))
    return reject_kind(look, "diameter",
                       "%.6g for bonds of a mean length of %.6g a0; allowed: 0, a thin line, or from %g to the length "
                       "of a bond",
                       k->diameter, bond, THINNEST_TUBE);
  k->radius = lattice_round(0.5 * k->diameter * LATTICE_PER_A0);
  k->blind = 1 + bonds_between_seen(k, bond);
  return true;
}

static bool finish_kind(const struct look *look, uint64_t *vertices)
{
  return round_mass(look) && derive_bending(look) && derive_spring(look) && check_shape(look) &&
         check_count(look, vertices) && refuses_none(look, AT_FROZEN) && check_extent(look) && check_places(look) &&
         check_plane(look) && check_gap(look) && check_stability(look) && derive_tube(look);
}

bool fibers_finish(struct model *m, struct model_error *error)
{
  uint64_t vertices = 0;
  uint32_t namesake;
  if (m->kinds > MODEL_MOST_KINDS)
    return model_reject(error, "fibers", "%" PRIu32 " kinds; allowed: at most %d", m->kinds, MODEL_MOST_KINDS);
  if (!find_namesake(m, &namesake))
    return model_reject(error, "", "out of memory");
  for (uint32_t k = 0; k < m->kinds; k++) {
    const struct look look = {m, &m->kind[k], k, error};
    if (k == namesake)
      return reject_kind(&look, "name", "'%s' is the name of an earlier kind; allowed: a name of its own",
                         look.kind->name);
    m->kind[k].dimensions = m->dimensions;
    if (!finish_kind(&look, &vertices))
      return false;
  }
  return true;
}
