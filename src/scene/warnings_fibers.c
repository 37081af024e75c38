/* What fibers may be, but probably should not: their bonds, their time step, their images, their inertia in a flow. */
#include "scene/scene.h"
#include "scene/warnings.h"
#include "system/fiber_kind.h"
#include "theory/medium.h"
#include "theory/theory.h"

#define MOST_TIME_STEPS 1e9 /* in a collision interval, as the scene reader allows */

double warnings_time_step(const struct model *m, double most)
{
  const double interval = model_collides(m) ? model_collision_interval(m) : m->time_step;
  const double wanted = fmin(fmax(interval / most * (1.0 - 1e-9), 1.0), MOST_TIME_STEPS);
  double best = INFINITY, fives = 1.0;
  while (fives < 5.0 * wanted) {
    double n = fives;
    while (n < wanted)
      n *= 2.0;
    best = fmin(best, n);
    fives *= 5.0;
  }
  return interval / best;
}

/* Bonds of this kind that are expected to become longer than `limit` in the run. A bond forgets its length in about
 * 1/omega, omega^2 = 2k/M. */
static double bonds_beyond(const struct scene *scene, const struct fiber_kind *k, double limit)
{
  const double forgets = sqrt(0.5 * k->mass / k->spring);
  const double samples = 1.0 + (double)scene->steps * scene->model.time_step / forgets;
  return theory_bond_tail(k, limit) * k->count * fiber_bonds(k) * samples;
}

/* The paper's boxes are as long as its fibers, and eight times as long as R_e of its chains (Sec. V). */
static void warn_images(struct teller *t, const struct model *m, const struct fiber_kind *k)
{
  const double edge = 2.0 * model_longest_bond(m), reach = theory_reach(k);
  if (reach <= edge * (1.0 + 1e-9) || !(m->crossing.forbidden || model_has_solvent(m)))
    return;
  if (reach > LATTICE_MAX_EDGE)
    warn(
        t,
        "fibers '%s': a fiber can meet its own image: it reaches %.6g a0, and the shortest edge is %.6g a0; no box can "
        "be so long, use shorter fibers",
        k->name, reach, edge);
  else
    warn(t,
         "fibers '%s': a fiber can meet its own image: it reaches %.6g a0 (its length, or 2 R_e if that is shorter), "
         "and the shortest edge is %.6g a0; use edges of %.6g or more",
         k->name, reach, edge, ceil(reach * (1.0 - 1e-9)));
}

#define MOST_LONG_BONDS 1e-3

/* A bond that reaches half the shortest edge stops a run. */
static void warn_long_bonds(struct teller *t, const struct scene *scene, const struct fiber_kind *k)
{
  const struct model *m = &scene->model;
  const double limit = model_longest_bond(m);
  const double expected = bonds_beyond(scene, k, limit);
  if (!(expected > MOST_LONG_BONDS))
    return;
  double edge = 2.0 * limit;
  while (bonds_beyond(scene, k, 0.5 * edge) > MOST_LONG_BONDS && edge < LATTICE_MAX_EDGE)
    edge = ceil(edge + 1.0);
  warn(t,
       "fibers '%s': about %.2g bonds are expected to reach half the shortest edge, %.6g a0, which stops the run; "
       "use edges of %.6g or more, or stiffer springs",
       k->name, expected, limit, edge);
}

#define MOST_EXCESS 0.02 /* of a mean square, or of an energy */

/* What the time step does to the fastest mode of a leap-frog. */
static void warn_leap_frog(struct teller *t, const struct model *m, const struct fiber_kind *k)
{
  const double phase = fiber_highest_frequency(k) * m->time_step;
  if (phase > 0.5)
    warn(t,
         "fibers '%s': omega dt = %.3g: stable below 2, but its energies are off by %.0f %%; with time_step %.6g they "
         "are off by 2 %% at most",
         k->name, phase, 25.0 * phase * phase, warnings_time_step(m, m->time_step * sqrt(MOST_EXCESS / 0.25) / phase));
}

/* And of motion without velocities. Filaments have no noise, and so no mean squares. */
static void warn_overdamped(struct teller *t, const struct model *m, const struct fiber_kind *k)
{
  const double step = fmax(theory_medium_spring_step(m, k), theory_medium_bend_step(m, k));
  const double excess = 0.5 * step / (1.0 - 0.5 * step), wanted = 2.0 * MOST_EXCESS / (1.0 + MOST_EXCESS);
  if (step >= 2.0)
    warn(t, "fibers '%s': the step is unstable: %.3g of the fastest relaxation, and 2 is too much; use time_step %.6g",
         k->name, step, warnings_time_step(m, m->time_step * (m->medium.inextensible ? 0.5 : wanted) / step));
  else if (excess > MOST_EXCESS && !m->medium.inextensible)
    warn(t,
         "fibers '%s': a time step is %.3g of the fastest relaxation, so that mean squares of the fastest modes are "
         "%.0f %% too large, and pressure and stress are off, too (docs/media.md); with time_step %.6g they are off by "
         "2 %% at most",
         k->name, step, 100.0 * excess, warnings_time_step(m, m->time_step * wanted / step));
}

#define MOST_INERTIA 0.1 /* Padding 2009, Table II */

/* Sheared fibers that have inertia, or compress the solvent. */
static void warn_inertia(struct teller *t, const struct theory_shear *shear, const struct fiber_kind *k)
{
  const double length = theory_length(k), speed = theory_shear_speed(shear, length);
  if (!(speed > 0.0))
    return;
  const double mach = theory_mach(speed, shear->sound), reynolds = theory_reynolds(speed, length, shear->kinematic);
  if (mach > MOST_INERTIA || reynolds > MOST_INERTIA)
    warn(t,
         "fibers '%s': over their length the shear has a Mach number of %.3g and a Reynolds number of %.3g; above %g "
         "what they do is partly inertia (paper, Table II); use a flow that is at least %.3g times slower",
         k->name, mach, reynolds, MOST_INERTIA, fmax(mach, reynolds) / MOST_INERTIA);
}

void warn_fibers(struct teller *t, const struct scene *scene, const struct theory_shear *shear,
                 const struct fiber_kind *k)
{
  const struct model *m = &scene->model;
  const double gamma = m->solvent.per_cell;
  if (model_has_cells(m) && (k->mass > 2.0 * gamma || k->mass < 0.5 * gamma))
    warn(t,
         "fibers '%s': mass %.6g is far from gamma = %.6g, the mass of the solvent in a cell (paper, Sec. IV A); use "
         "%.6g to %.6g",
         k->name, k->mass, gamma, 0.5 * gamma, 2.0 * gamma);
  if (k->vertices < 2)
    return;
  if (k->bond_length > 1.0)
    warn(
        t,
        "fibers '%s': bond_length %.6g > 1 a0: the solvent passes between vertices, so that a fiber is dragged like "
        "separate beads and not like a thread; the paper's is 0.5, twice the hydrodynamic radius (Sec. IV A); use 1 or "
        "less",
        k->name, k->bond_length);
  if (!fiber_stands(k))
    (model_is_overdamped(m) ? warn_overdamped : warn_leap_frog)(t, m, k);
  if (model_has_solvent(m) && m->scheme == SCHEME_PAPER && !model_is_isothermal(m))
    warn(t,
         "fibers '%s': the order 'paper' heats springs at every collision (docs/accuracy.md), and there is no "
         "thermostat; kick-split does not",
         k->name);
  if (!m->medium.inextensible)
    warn_long_bonds(t, scene, k);
  warn_images(t, m, k);
  warn_inertia(t, shear, k);
}
