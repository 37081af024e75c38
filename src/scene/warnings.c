/* What a scene may do, but probably should not: where the paper's limits are left (Padding 2009, Sec. IV). */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "mpc/rule.h"
#include "observe/background.h"
#include "observe/meaning.h"
#include "scene/scene.h"
#include "scene/warnings.h"
#include "system/fiber_kind.h"
#include "theory/dumbbell.h"
#include "theory/flow.h"
#include "theory/load.h"
#include "theory/theory.h"

void warn(struct teller *t, const char *format, ...)
{
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  t->told++;
  if (t->tell)
    t->tell(t->context, text);
}

static void warn_solvent(struct teller *t, const struct model *m)
{
  const struct solvent_model *s = &m->solvent;
  if (model_has_solvent(m) && model_collision_interval(m) > 0.1 * (1.0 + 1e-9))
    warn(t,
         "collision_interval %.6g > 0.1 t0: the mean free path is no liquid's (paper, Sec. IV A); use "
         "solvent.collision_interval 0.1 "
         "or less",
         model_collision_interval(m));
  if (s->rule == RULE_SRD && s->rotation_angle < 90.0)
    warn(t,
         "rotation_angle %.6g < 90 degrees: weak coupling between fibers and solvent (paper, Sec. IV A); use 90 to 170",
         s->rotation_angle);
  if (s->rule == RULE_SRD && s->rotation_angle > 170.0)
    warn(t, "rotation_angle %.6g is close to 180 degrees, which the paper says to avoid (Sec. IV A); use 90 to 170",
         s->rotation_angle);
  if (!model_is_isothermal(m) && vec3_norm(s->acceleration) > 0.0)
    warn(t, "the acceleration does work on the solvent, and no thermostat takes the heat away; use solvent.thermostat: "
            "rescale");
}

/* A flow faster than a tenth of the speed of sound: Padding 2009, Sec. IV B. */
static void warn_flow(struct teller *t, const struct model *m)
{
  const double mach = theory_mach(vec3_norm(m->flow), theory_sound_speed(model_is_isothermal(m), m->dimensions));
  if (model_has_solvent(m) && mach > 0.1)
    warn(t, "the flow's Mach number is %.3g > 0.1 (harmless while it is uniform: paper, Sec. V B 1)", mach);
}

/* Vertices are unwrapped, and a run stops where their coordinates end. */
static void warn_reach(struct teller *t, const struct scene *scene)
{
  const struct vec3 v = scene->model.flow;
  const double way = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z))) * scene->model.time_step * (double)scene->steps;
  const double reach = (double)LATTICE_REACH * LATTICE_UNIT;
  if (scene->model.kinds > 0 && way > reach)
    warn(t, "the flow carries vertices %.3g a0 during the run, which stops at %.7g a0; use fewer steps", way, reach);
}

static void warn_force(struct teller *t, const struct model *m)
{
  double scale = m->solvent.particles * vec3_norm(m->solvent.acceleration);
  for (uint32_t k = 0; k < m->kinds; k++)
    scale += (double)m->kind[k].count * m->kind[k].vertices * vec3_norm(m->kind[k].force);
  const struct vec3 net = theory_net_force(m), a = m->solvent.acceleration;
  const double n = m->solvent.particles;
  char remedy[256] = "the forces have to balance each other";
  if (n > 0.0 && m->solvent.profile == PROFILE_UNIFORM)
    snprintf(remedy, sizeof remedy, "solvent.acceleration: [%.17g, %.17g, %.17g] balances it%s", a.x - net.x / n,
             a.y - net.y / n, a.z - net.z / n,
             model_is_isothermal(m) ? "" : ", with solvent.thermostat: rescale, since forces do work");
  const bool held = model_has_walls(m) && m->walls.kind == WALL_NO_SLIP;  /* walls take the momentum up */
  if (!held && model_keeps_momentum(m) && vec3_norm(net) > 1e-12 * scale) /* a bath takes the momentum up */
    warn(t,
         "a net force of (%.6g, %.6g, %.6g) kT/a0 acts on a periodic system, which accelerates without end by %.3g "
         "a0/t0^2; %s",
         net.x, net.y, net.z, vec3_norm(net) / m->total_mass, remedy);
}

#define MOST_WALL_MACH 0.5
#define MOST_HEATING 1e-3 /* kT/t0 */

/* Flow between walls: the profile of the temperature, compressibility, heat (Tao, Goetze and Gompper 2008). */
static void warn_walls(struct teller *t, const struct model *m)
{
  const double height = m->box.cells[1], eta = theory_loaded_viscosity(m);
  const struct vec3 slide = vec3_sub(m->walls.upper, m->walls.lower);
  const double rate = m->walls.kind == WALL_NO_SLIP ? vec3_norm(slide) / height : 0.0;
  const double driven =
      m->walls.kind == WALL_NO_SLIP
          ? theory_poiseuille_speed(m->solvent.per_cell, vec3_norm(m->solvent.acceleration), height, eta, 0.0)
          : 0.0;
  const double speed = fmax(driven, fmax(vec3_norm(m->walls.lower), vec3_norm(m->walls.upper)));
  const double mach = theory_mach(speed, theory_sound_speed(model_is_isothermal(m), m->dimensions));
  const double heating = theory_flow_heating(eta, rate, m->solvent.per_cell, m->dimensions);
  if (m->solvent.thermostat == THERMOSTAT_RESCALE)
    warn(t,
         "thermostat rescale has one factor for the whole box, but flow between walls heats unevenly, and walls hold "
         "their own temperature; use solvent.thermostat: rescale-layers or maxwell-boltzmann");
  if (m->walls.kind == WALL_SLIP && vec3_norm(m->walls.lower) + vec3_norm(m->walls.upper) > 0.0)
    warn(t, "slip walls pull nothing along: their motion has no effect; use walls.kind: no-slip");
  if (mach > MOST_WALL_MACH)
    warn(
        t,
        "the Mach number between the walls is expected to be %.3g > %g: the solvent is compressed; use slower walls or "
        "a smaller acceleration",
        mach, MOST_WALL_MACH);
  if (!model_is_isothermal(m) && heating > MOST_HEATING)
    warn(t,
         "the walls heat the solvent by %.3g kT per t0 until as much heat leaves through them, and no thermostat takes "
         "it away; use solvent.thermostat: maxwell-boltzmann, or rule: at-a",
         heating);
}

#define MOST_STRAIN 0.1 /* in a collision interval */

/* Velocities change by the rate within a cell and an interval. A sheared box may be faster than sound at its boundary,
 * where nothing is special. */
static void warn_shear(struct teller *t, const struct model *m)
{
  const double rate = fabs(m->shear.rate), strain = rate * model_collision_interval(m);
  const double heating =
      theory_flow_heating(theory_loaded_viscosity(m), theory_mean_shear_rate(m), m->solvent.per_cell, m->dimensions);
  if (strain > MOST_STRAIN)
    warn(t,
         "shear: the strain in a collision interval is %.3g > %g, so that the viscosity depends on the rate; use a "
         "lower rate or a shorter collision interval",
         strain, MOST_STRAIN);
  if (!model_is_isothermal(m) && heating > MOST_HEATING)
    warn(t,
         "the shear heats the solvent by %.3g kT per t0, and no thermostat takes it away; use solvent.thermostat: "
         "maxwell-boltzmann, or rule: at-a",
         heating);
}

/* A force with a profile: compressibility, and the instability of Kolmogorov flow. */
static void warn_profile(struct teller *t, const struct model *m)
{
  const double height = m->box.cells[1], gamma = m->solvent.per_cell, eta = theory_loaded_viscosity(m);
  const double speed = theory_profile_speed(m->solvent.profile, gamma, vec3_norm(m->solvent.acceleration), height, eta);
  const double mach = theory_mach(speed, theory_sound_speed(model_is_isothermal(m), m->dimensions));
  const double reynolds = theory_profile_reynolds(speed, height, theory_loaded_kinematic(m));
  if (mach > MOST_WALL_MACH)
    warn(t, "the Mach number of the driven flow is expected to be %.3g > %g: use a smaller acceleration", mach,
         MOST_WALL_MACH);
  if (reynolds > THEORY_STABLE_REYNOLDS)
    warn(
        t,
        "the driven flow is expected to be unstable: its Reynolds number v_max/(nu k) is %.3g > sqrt(2); use a smaller "
        "acceleration",
        reynolds);
}

#define MOST_RISE 0.01

/* Heat left by rejected moves, as measured once: about 0.7 (omega dt)^2 kT per executed collision, of which there are
 * 1.15 times as many as theory_collision_rate says (docs/accuracy.md). */
static void warn_heating(struct teller *t, const struct scene *scene)
{
  const struct model *m = &scene->model;
  if (!m->crossing.forbidden || model_is_isothermal(m) || !model_keeps_momentum(m) || m->bonds == 0)
    return;
  double phase = 0.0;
  for (uint32_t k = 0; k < m->kinds; k++)
    phase = fmax(phase, fiber_stands(&m->kind[k]) ? 0.0 : fiber_highest_frequency(&m->kind[k]) * m->time_step);
  const double time = (double)scene->steps * m->time_step;
  const double each =
      m->crossing.rule == CROSSING_SEQUENTIAL ? 0.7 * phase * phase : 0.09 * phase * phase * phase * phase;
  const double heat = each * theory_executed_rate(m) * time;
  const double rise = heat / (m->dimensions * (0.5 * m->solvent.particles + m->vertices));
  const double order = m->crossing.rule == CROSSING_SEQUENTIAL ? 2.0 : 4.0; /* of the heat, in the time step */
  if (rise > MOST_RISE)
    warn(t,
         "contacts of bonds are expected to heat the system by some %.0f %% during the run (docs/accuracy.md); use %s"
         "a thermostat, or time_step %.6g for less than 1 %%",
         100.0 * rise, m->crossing.rule == CROSSING_SEQUENTIAL ? "crossing.rule: event-driven, " : "",
         warnings_time_step(m, m->time_step * pow(MOST_RISE / rise, 1.0 / order)));
}

/* Forces that pull some particles more than others make kinds drift. One warning is for all of them. */
static void warn_drift(struct teller *t, const struct scene *scene)
{
  const struct model *m = &scene->model;
  const bool carries = background_differs(m) || (model_has_solvent(m) && vec3_norm(m->solvent.acceleration) > 0.0);
  uint32_t drifting = 0, first = 0, most = 0;
  for (uint32_t k = 0; k < m->kinds; k++)
    if (fiber_held(&m->kind[k]) == 0 && (carries || vec3_norm(m->kind[k].force) > 0.0)) {
      first = drifting++ ? first : k;
      most = m->kind[k].count > most ? m->kind[k].count : most;
    }
  if (scene->observe.every[OBSERVE_DYNAMICS] == 0 || drifting == 0)
    return;
  char others[48] = "";
  if (drifting > 1)
    snprintf(others, sizeof others, " and %" PRIu32 " more kind%s", drifting - 1, drifting > 2 ? "s" : "");
  char squares[48] = "g and g_cm";
  if (meaning_has_column(m, OBSERVE_DYNAMICS, "D"))
    snprintf(squares, sizeof squares, "g_cm and D = g_cm/%" PRIu32 "t", 2 * m->dimensions);
  warn(t, "observe.dynamics: %s, so fibers drift, and %s of '%s'%s contain (v t)^2; use %s (docs/observables.md)",
       background_differs(m) ? "a flow carries fibers" : "a force acts", squares, m->kind[first].name, others,
       most <= 1 ? "the columns drift_x, drift_y, drift_z, or two fibers or more"
       : meaning_has_column(m, OBSERVE_DYNAMICS, "D_about_mean")
           ? "the columns g_cm_about_mean, D_about_mean and drift_x, drift_y, drift_z"
           : "the columns g_cm_about_mean and drift_x, drift_y, drift_z; a diffusion coefficient is none of them");
}

#define MOST_SWING 3.14159265358979324 /* radians: half a period */

/* Dumbbells: their images, and how far they swing between collisions. */
static void warn_dumbbells(struct teller *t, const struct model *m)
{
  const double size = theory_dumbbell_size(m->dumbbells.spring, 1),
               angle = m->dumbbells.frequency * model_collision_interval(m);
  const double edge = model_is_flat(m) ? fmin(m->box.cells[0], m->box.cells[1])
                                       : fmin(m->box.cells[0], fmin(m->box.cells[1], m->box.cells[2]));
  if (4.0 * size > edge)
    warn(t,
         "dumbbells.spring: a dumbbell of %.3g a0 along each axis meets its own image, or fills the gap, in a box with "
         "an edge of %.6g "
         "a0; use edges of %.6g or more",
         size, edge, ceil(4.0 * size));
  if (angle > 0.5 * MOST_SWING)
    warn(t,
         "dumbbells.spring: springs swing by %.3g radians between two collisions, so that collisions meet them in "
         "phase; "
         "use spring: %.3g or less, or a shorter collision interval",
         angle, m->dumbbells.spring * 0.25 * MOST_SWING * MOST_SWING / (angle * angle));
}

static void warn_observables(struct teller *t, const struct scene *scene)
{
  const struct observe_plan *plan = &scene->observe;
  const uint64_t observed = plan->from < scene->steps ? scene->steps - plan->from : 0;
  if (plan->longest_lag > observed / 4)
    warn(t,
         "observe.dynamics.longest_lag %" PRIu64 " is more than a quarter of the %s%" PRIu64
         " steps: the longest lags will have few samples; use steps: %" PRIu64 " or more",
         plan->longest_lag, plan->from ? "observed " : "run's ", observed, plan->from + 4 * plan->longest_lag);
  for (int i = 0; i < OBSERVABLES; i++)
    if (plan->every[i] > scene->steps)
      warn(t, "observe.%s: sampled every %" PRIu64 " steps, but the run has %" PRIu64, observable_names[i],
           plan->every[i], scene->steps);
  if (plan->every[OBSERVE_COLLISIONS] > 0 && (!scene->model.crossing.forbidden || scene->model.bonds == 0))
    warn(t, "observe.collisions: nothing is tested for crossings here, so all counts stay 0");
  if (plan->every[OBSERVE_DYNAMICS] > 0 && scene->model.vertices == 0)
    warn(t, "observe.dynamics: there are no fibers to observe");
  if (plan->every[OBSERVE_STATICS] > 0 && scene->model.vertices == 0)
    warn(t, "observe.statics: there are no fibers to observe");
  if (plan->every[OBSERVE_STRESS] > 0 && !model_has_solvent(&scene->model) && scene->model.vertices == 0)
    warn(t, "observe.stress: there are neither solvent particles nor fibers to observe");
  if (plan->every[OBSERVE_STRESS] > 0 && model_has_walls(&scene->model) && scene->model.box.cells[1] < 3)
    warn(t, "observe.stress: the bulk is what is 1 a0 and more from both walls, and nothing is here; use a distance of "
            "3 or more");
}

#define MOST_START 0.01 /* of a mean over the observed time */

/* A flow between walls or by a force starts at rest. The share of the start in means of the observed time is that of an
 * exponential. */
static void warn_transient(struct teller *t, const struct scene *scene)
{
  const struct model *m = &scene->model;
  const struct observe_plan *plan = &scene->observe;
  const double tau = theory_flow_transient(m, theory_loaded_kinematic(m));
  const double from = (double)plan->from * m->time_step, end = (double)scene->steps * m->time_step;
  if (tau == 0.0 || end <= from || (plan->every[OBSERVE_PROFILE] == 0 && plan->every[OBSERVE_STRESS] == 0))
    return;
  const double share = tau / (end - from) * (exp(-from / tau) - exp(-end / tau));
  const double steps = ceil(5.0 * tau / m->time_step);
  char longer[64] = "";
  if (2.0 * steps > (double)scene->steps)
    snprintf(longer, sizeof longer, " and steps: %.0f or more", 2.0 * steps);
  if (share > MOST_START)
    warn(t,
         "observe.from %" PRIu64 ": the flow starts at rest and needs %.3g t0 for each factor of e, so that the means "
         "of the observed time hold %.2g %% of the start; use observe.from: %.0f%s",
         plan->from, tau, 100.0 * share, steps, longer);
}

#define LIGHTEST 0.5 /* of gamma: lighter vertices hardly feel the solvent (Padding 2009, Sec. IV A) */
#define MORE 4.0     /* times as much solvent */

/* Vertices load the fluid: theory/load.h. */
static void warn_load(struct teller *t, const struct model *m)
{
  const double gamma = model_solvent_density(m), factor = theory_load_factor(m, 1.0, gamma);
  const bool cells = model_in_cells(m);
  double heaviest = 0.0;
  if (!(factor > THEORY_HEAVY_LOAD))
    return;
  for (uint32_t k = 0; k < m->kinds; k++)
    heaviest = fmax(heaviest, fiber_stands(&m->kind[k]) ? 0.0 : m->kind[k].mass);
  const double eta = theory_model_viscosity(m), lighter = fmin(LIGHTEST * gamma / heaviest, 1.0);
  char light[128] = "";
  if (lighter < 0.99)
    snprintf(light, sizeof light, "lighter vertices, mass=%.6g (%.3g times), or ", lighter * heaviest,
             theory_load_factor(m, lighter, gamma));
  warn(t,
       "vertices load the fluid: they add %.3g m per %s to the solvent's %.3g and make it %.3g times as viscous, "
       "bonds even more, so that diffusion, relaxation and drag are not those of the solvent alone; use %smore "
       "solvent, %s=%.6g (%.3g times)",
       theory_load(m), cells ? "cell" : "a0^3", gamma, theory_loaded_viscosity(m) / eta, light,
       cells ? "solvent.per_cell" : "medium.density", MORE * gamma, theory_load_factor(m, 1.0, MORE * gamma));
}

int scene_warnings(const struct scene *scene, void (*tell)(void *context, const char *text), void *context)
{
  struct teller t = {tell, context, 0};
  const struct model *m = &scene->model;
  if (model_has_cells(m))
    warn_solvent(&t, m);
  warn_flow(&t, m);
  warn_force(&t, m);
  if (model_has_walls(m))
    warn_walls(&t, m);
  if (model_is_sheared(m) && model_collides(m))
    warn_shear(&t, m);
  warn_reach(&t, scene);
  if (m->solvent.profile != PROFILE_UNIFORM && model_collides(m))
    warn_profile(&t, m);
  const struct theory_shear shear = theory_shear_of(m);
  for (uint32_t k = 0; k < m->kinds; k++)
    warn_fibers(&t, scene, &shear, &m->kind[k]);
  warn_load(&t, m);
  if (model_has_dumbbells(m) && model_collides(m))
    warn_dumbbells(&t, m);
  warn_heating(&t, scene);
  warn_observables(&t, scene);
  if (model_has_solvent(m) && model_in_cells(m) && scene->snapshot == NULL)
    warn_transient(&t, scene);
  warn_drift(&t, scene);
  return t.told;
}
