/* Checks and completes a model. Every bound is checked here, so that it holds for scenes and for models built by hand.
 * Then the derived part is filled. */
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "system/bead.h"
#include "system/fiber_kind.h"
#include "system/flow.h"
#include "system/medium.h"
#include "system/model.h"
#include "system/model_keys.h"
#include "system/shear.h"
#include "system/topology.h"

/* --- solvent ----------------------------------------------------------------------------------------------------- */

static void derive_rotation(struct solvent_model *solvent)
{
  const struct circle_point p = elementary_circle_degrees(solvent->rotation_angle);
  solvent->cosine = p.cosine;
  solvent->sine = p.sine;
}

static bool derive_interval(struct model *m, struct model_error *error)
{
  const double interval = m->solvent.collision_interval, ratio = interval / m->time_step, whole = nearbyint(ratio);
  if (!(whole >= 1.0 && whole <= 1e9 && fabs(ratio - whole) <= 1e-9 * whole))
    return model_reject(
        error, "solvent.collision_interval",
        "%.15g is %.10g time steps of %.15g; allowed: a whole multiple of the time step, 1 to 1e9 of them", interval,
        ratio, m->time_step);
  m->solvent.interval_steps = (uint32_t)whole;
  m->solvent.collision_interval = model_collision_interval(m);
  return true;
}

/* Per cell: keeps their momentum within a part of its sum's range, see mpc/random_solvent.c. */
enum { MOST_PHANTOMS = 1000 };

/* Phantoms are a heat bath by themselves: they have no memory, and nothing can act on them. */
static bool check_phantoms(const struct model *m, struct model_error *error)
{
  const struct solvent_model *s = &m->solvent;
  const struct {
    bool ok;
    const char *why;
  } rows[] = {
      {!s->hydrodynamics, "phantoms carry no hydrodynamic interactions; allowed with hydrodynamics: false"},
      {s->thermostat == THERMOSTAT_NONE, "phantoms are a thermostat; allowed with thermostat: none"},
      {vec3_norm(s->acceleration) == 0.0, "phantoms are not accelerated; allowed with acceleration: [0, 0, 0]"},
      {s->per_cell <= MOST_PHANTOMS, "too many phantoms; allowed with a per_cell of at most 1000"},
      {m->kinds > 0, "phantoms are drawn for fibers only, and there are none; allowed: particles"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!rows[i].ok)
      return model_reject(error, "solvent.bath", "%s", rows[i].why);
  return true;
}

static bool derive_particles(struct model *m, struct model_error *error)
{
  m->solvent.particles = 0;
  if (model_has_phantoms(m))
    return check_phantoms(m, error);
  const double particles = nearbyint(m->solvent.per_cell * (box_volume(&m->box) - bead_volume(m)));
  if (!(particles >= 1.0 && particles < 2147483648.0))
    return model_reject(error, "solvent.per_cell",
                        "%.15g in a box of %.0f cells makes %.0f particles; allowed: 1 to 2147483647",
                        m->solvent.per_cell, box_volume(&m->box), particles);
  m->solvent.particles = (uint32_t)particles;
  return true;
}

#define LOOSEST 1e-4 /* kT/a0^2: twenty standard deviations are below LATTICE_MAX_MOVE */

/* Dumbbells are as many as there are pairs among their share of the particles. */
static bool finish_dumbbells(struct model *m, struct model_error *error)
{
  struct dumbbell_model *d = &m->dumbbells;
  if (d->spring == 0.0)
    return true;
  if (!model_has_solvent(m))
    return model_reject(error, "dumbbells",
                        "they are pairs of solvent particles, and there are none; allowed with a "
                        "solvent of particles");
  if (!m->solvent.hydrodynamics)
    return model_reject(error, "solvent.hydrodynamics",
                        "velocities that are permuted are not those of springs; allowed with dumbbells: true");
  if (d->spring < LOOSEST)
    return model_reject(error, "dumbbells.spring",
                        "%.6g makes dumbbells of %.3g a0 along each axis, too long for a flight; allowed: %g and more",
                        d->spring, 1.0 / sqrt(d->spring), LOOSEST);
  d->pairs = (uint32_t)(0.5 * d->fraction * m->solvent.particles);
  d->frequency = sqrt(2.0 * d->spring);
  if (d->pairs == 0)
    return model_reject(error, "dumbbells.fraction", "%.6g of %" PRIu32 " particles are less than two; allowed: more",
                        d->fraction, m->solvent.particles);
  return true;
}

static bool finish_solvent(struct model *m, struct model_error *error)
{
  derive_rotation(&m->solvent);
  if (m->solvent.collision_interval != 0.0 && !derive_interval(m, error))
    return false;
  if (model_rule_is_thermal(m) && m->solvent.thermostat != THERMOSTAT_NONE)
    return model_reject(error, "solvent.thermostat",
                        "the collision rule holds the temperature by itself; allowed with it: none");
  if (m->solvent.per_cell != 0.0)
    return derive_particles(m, error);
  return !model_has_phantoms(m) ||
         model_reject(error, "solvent.bath", "phantoms without a per_cell; allowed with a per_cell above 0");
}

/* --- fibers ------------------------------------------------------------------------------------------------------ */

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
  if (k->persistence_length == 0.0)
    return true;
  if (k->bending != 0.0)
    return reject_kind(look, "persistence_length", "bending is given too; allowed: one of the two");
  if (k->bond_length == 0.0)
    return reject_kind(look, "persistence_length",
                       "bending = persistence_length/bond_length needs a bond_length above 0; allowed: give bending "
                       "instead");
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
  if (k->stands_for == 0)
    return k->keeps == SIZE_ENDS || reject_kind(look, "keeps", "there is no finer chain; allowed with stands_for");
  if (k->bond_length != 0.0 || k->bending != 0.0 || k->ring || k->vertices < 2)
    return reject_kind(look, "stands_for",
                       "only an open Gaussian chain of 2 vertices or more stands for another one; allowed: bond_length "
                       "0, no bending, no ring");
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

/* What would move a frozen fiber, or what it would stand still in. */
static bool check_frozen(const struct look *look)
{
  const struct model *m = look->model;
  const struct fiber_kind *k = look->kind;
  const struct {
    bool is;
    const char *what;
  } rows[] = {{k->force.x != 0.0 || k->force.y != 0.0 || k->force.z != 0.0, "a force"},
              {m->flow.x != 0.0 || m->flow.y != 0.0 || m->flow.z != 0.0, "a flow"},
              {m->walls.kind != WALL_ABSENT, "walls"},
              {model_is_sheared(m), "shear"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows && k->frozen; i++)
    if (rows[i].is)
      return reject_kind(look, "frozen", "frozen fibers together with %s; allowed: false, or a periodic box at rest",
                         rows[i].what);
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
  if (k->placed == 0)
    return true;
  if (k->start == START_EQUILIBRIUM)
    return reject_kind(look, "places",
                       "fibers that start in equilibrium are placed at random; allowed with start: straight, or for "
                       "rings");
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

/* The leap-frog of the fastest vibration: Eqs. (4) and (8), is stable below omega dt = 2. */
static bool check_stability(const struct look *look)
{
  const double dt = look->model->time_step, omega = fiber_highest_frequency(look->kind);
  return omega * dt < 2.0 ||
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
  if (!model_is_flat(look->model))
    return true;
  if (k->force.z != 0.0)
    return reject_kind(look, "force", "with dimensions: 2 nothing moves along z; allowed: a z component of 0");
  for (uint32_t i = 0; i < k->placed; i++) {
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

/* What a scene with tubes must be. */
static bool check_tube_scene(const struct look *look)
{
  const struct model *m = look->model;
  const struct {
    bool ok;
    const char *why;
  } rows[] = {
      {look->kind->vertices > 1, "a free point has no bond, and so no tube; allowed: 0"},
      {m->crossing.forbidden, "with crossing: {forbidden: false} fibers pass through each other; allowed: 0"},
      {m->crossing.rule == CROSSING_EVENT_DRIVEN,
       "the rule sequential knows thin lines only; allowed: 0, or crossing: {rule: event-driven}"},
      {m->walls.kind == WALL_ABSENT, "walls know the axes of fibers only; allowed between walls: 0"},
      {m->box.boundary[1] != BOUNDARY_SHEAR,
       "in a sheared box bonds move in sheared coordinates, where tubes are not round; allowed there: 0"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    if (!rows[i].ok)
      return reject_kind(look, "diameter", "%s", rows[i].why);
  return true;
}

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
  if (k->diameter == 0.0)
    return true;
  if (!check_tube_scene(look))
    return false;
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
         check_count(look, vertices) && check_frozen(look) && check_extent(look) && check_places(look) &&
         check_plane(look) && check_gap(look) && check_stability(look) && derive_tube(look);
}

static bool finish_fibers(struct model *m, struct model_error *error)
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

/* --- crossing ---------------------------------------------------------------------------------------------------- */

/* What only a rule knows that moves one vertex at a time. */
static bool check_crossing(const struct model *m, struct model_error *error)
{
  const struct crossing_model *c = &m->crossing;
  const struct {
    bool ok;
    const char *path, *why;
  } rows[] = {
      {c->rejection == REJECTION_STAY, "crossing.refusal",
       "with rule: event-driven no move is refused: bonds bounce at the time of contact; allowed: stay, which has no "
       "effect there"},
      {c->frame == FRAME_LABORATORY, "crossing.frame",
       "with rule: event-driven no vertex stands still, so there is no frame of the moves; allowed: laboratory, which "
       "has "
       "no effect there"},
      {c->exclusion == EXCLUSION_SHARED_VERTEX, "crossing.exclusion",
       "with rule: event-driven no bond moves alone, so none is linked to it; allowed: shared-vertex"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows && c->rule == CROSSING_EVENT_DRIVEN; i++)
    if (!rows[i].ok)
      return model_reject(error, rows[i].path, "%s", rows[i].why);
  return true;
}

/* --- the whole --------------------------------------------------------------------------------------------------- */

bool model_finish_numbers(struct model *m, struct model_error *error)
{
  if (m->crossing.rule == CROSSING_FREE) /* a model built by hand that leaves it open */
    m->crossing.rule = CROSSING_SEQUENTIAL;
  if (m->dimensions == 0) /* the same */
    m->dimensions = 3;
  if (m->dumbbells.spring != 0.0) {
    m->dumbbells.fraction = m->dumbbells.fraction == 0.0 ? 1.0 : m->dumbbells.fraction;
    m->dumbbells.range = m->dumbbells.range == 0.0 ? 1.2 : m->dumbbells.range;
  }
  if (!keys_check(&model_keys, m, error))
    return false;
  m->box = box_of_cells(m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  if (!medium_finish(m, error) || !bead_fits(m, error) || !finish_solvent(m, error) || !finish_dumbbells(m, error) ||
      !flow_finish(m, error) || !finish_fibers(m, error) || !bead_finish(m, error) || !check_crossing(m, error))
    return false;
  if (!model_collides(m) && m->kinds == 0)
    return model_reject(error, "", "there is nothing to simulate; a scene has a 'solvent', 'fibers', or both");
  model_count(m);
  return true;
}

bool model_finish(struct model *m, struct model_error *error)
{
  return model_finish_numbers(m, error) &&
         ((model_lay(m) && shear_finish(m)) || model_reject(error, "", "out of memory for this many vertices"));
}
