#include <inttypes.h>
#include <stdio.h>

#include "base/text.h"
#include "cli/check_bead.h"
#include "cli/check_choice.h"
#include "cli/check_dumbbells.h"
#include "cli/check_fibers.h"
#include "cli/check_flow.h"
#include "cli/check_head.h"
#include "cli/check_medium.h"
#include "cli/check_observed.h"
#include "cli/check_start.h"
#include "cli/check_walls.h"
#include "cli/command.h"
#include "cli/sheet.h"
#include "files/start.h"
#include "mpc/drive.h"
#include "mpc/rule.h"
#include "scene/scene.h"
#include "system/fiber_kind.h"
#include "theory/dumbbell.h"
#include "theory/load.h"
#include "theory/theory.h"
#include "work.h"

/* --- Table I ----------------------------------------------------------------------------------------------------- */

static void report_kind_parameters(bool exact, const struct fiber_kind *k)
{
  printf("  fibers '%s'%s\n", text_shown(k->name), k->ring ? ", rings" : "");
  sheet_row(exact, "  number of fibers", "N_c", k->count, "", "");
  sheet_row(exact, "  vertices of each", "N_v", k->vertices, "", "");
  sheet_row(exact, "  mass of a vertex", "M", k->mass, "m", "");
  if (vec3_norm(k->force) > 0.0)
    sheet_row(exact, "  force on a vertex", "", vec3_norm(k->force), "kT/a0", "");
  if (k->vertices < 2)
    return;
  sheet_row(exact, "  rest length of a bond", "l0", k->bond_length, "a0", "");
  sheet_row(exact, "  spring constant", "K/l0", k->spring, "kT/a0^2", "Eq. (1)");
  sheet_row(exact, "  elastic modulus", "K", k->spring * k->bond_length, "kT/a0", "");
  sheet_row(exact, "  bending constant", "l_p/l0", k->bending, "kT", "Eq. (2)");
  sheet_row(exact, "  length", "L", theory_length(k), "a0", k->bond_length > 0.0 ? "N_v l0" : "contour");
  sheet_row(exact, "  persistence length", "l_p", theory_persistence(k), "a0", "");
}

static void report_table_1(bool exact, const struct model *m)
{
  sheet_heading("Parameters (paper, Table I)");
  if (model_has_cells(m)) {
    sheet_row(exact, "particles per cell", "gamma", m->solvent.per_cell, "1/a0^3", "");
    if (model_has_solvent(m))
      sheet_row(exact, "particles", "N_s", m->solvent.particles, "", "");
    sheet_row(exact, "collision interval", "dt_c", model_collision_interval(m), "t0", "");
    if (m->solvent.rule == RULE_SRD)
      sheet_row(exact, "rotation angle", "alpha", m->solvent.rotation_angle, "degrees", "");
  }
  printf("  %-38s %-9s %d x %d x %d a0\n", "box", "L_b", m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  for (int k = 0; exact && k < 3; k++)
    sheet_row(exact, (const char *const[]){"  edge along x", "  edge along y", "  edge along z"}[k], "",
              m->box.cells[k], "a0", "");
  sheet_row(exact, "time step", "dt", m->time_step, "t0", "");
  if (vec3_norm(m->flow) > 0.0)
    sheet_row(exact, "flow", "v", vec3_norm(m->flow), "a0/t0", "");
  if (vec3_norm(m->solvent.acceleration) > 0.0)
    sheet_row(exact, "acceleration of the solvent", "", vec3_norm(m->solvent.acceleration), "a0/t0^2", "");
  for (uint32_t k = 0; k < m->kinds; k++)
    report_kind_parameters(exact, &m->kind[k]);
}

/* --- what follows from them -------------------------------------------------------------------------------------- */

static void report_solvent(bool exact, const struct model *m)
{
  const double gamma = m->solvent.per_cell, cosine = m->solvent.cosine, interval = model_collision_interval(m);
  const bool srd = m->solvent.rule == RULE_SRD;
  sheet_heading("Solvent (molecular chaos: some per cent off at a short mean free path)");
  sheet_row(exact, "kinetic viscosity", "eta_kin",
            theory_viscosity_kinetic(collision_rule_of(m), m->dimensions, gamma, cosine, interval), "m/a0 t0",
            srd ? "Eq. (30)" : "");
  sheet_row(exact, "collisional viscosity", "eta_col",
            theory_viscosity_collisional(collision_rule_of(m), m->dimensions, gamma, cosine, interval), "m/a0 t0",
            srd ? "Eq. (31)" : "");
  sheet_row(exact, "viscosity", "eta", theory_model_viscosity(m), "m/a0 t0",
            model_has_dumbbells(m) ? "with that of springs" : "");
  sheet_row(exact, "kinematic viscosity", "nu", theory_model_viscosity(m) / gamma, "a0^2/t0", "");
  sheet_row(exact, "self-diffusion coefficient", "D_s",
            theory_solvent_diffusion(collision_rule_of(m), m->dimensions, gamma, cosine, interval), "a0^2/t0", "");
  sheet_row(exact, "Schmidt number", "Sc", theory_schmidt(collision_rule_of(m), m->dimensions, gamma, cosine, interval),
            "", "nu/D_s");
  sheet_row(exact, "speed of sound", "c_s", theory_sound_speed(model_is_isothermal(m), m->dimensions), "a0/t0",
            model_is_isothermal(m) ? "isothermal" : "");
  sheet_row(exact, "mean free path", "", theory_mean_free_path(interval), "a0", "");
}

/* --- parts, cost ------------------------------------------------------------------------------------------------- */

struct part {
  const char *name, *file;
  bool used;
};

static bool any_kind(const struct model *m, bool (*is)(const struct fiber_kind *))
{
  for (uint32_t k = 0; k < m->kinds; k++)
    if (is(&m->kind[k]))
      return true;
  return false;
}

static bool is_bonded(const struct fiber_kind *k)
{
  return k->vertices > 1;
}

static bool is_bent(const struct fiber_kind *k)
{
  return k->vertices > 2 && k->bending != 0.0;
}

/* Springs of zero length pull along the bond vector: fiber/force.c takes no root for them. */
static bool needs_root(const struct fiber_kind *k)
{
  return is_bonded(k) && (k->bond_length != 0.0 || k->bending != 0.0);
}

static void report_parts(const struct scene *scene)
{
  const struct model *m = &scene->model;
  const struct solvent_model *s = &m->solvent;
  const bool solvent = model_has_solvent(m), collides = model_has_cells(m), quarter = s->cosine == 0.0;
  const bool rotates = s->rule == RULE_SRD;
  const struct part parts[] = {
      {"streaming of the solvent", "fluid/points.c", solvent},
      {"... of dumbbells", "fluid/dumbbells.c", model_has_dumbbells(m)},
      {"... between walls", "fluid/boundary_walls.c", model_has_walls(m)},
      {"... in a sheared box", "fluid/boundary_shear.c", model_is_sheared(m)},
      {"collisions", "mpc/collide.c", collides},
      {"... in cells that walls cut", "mpc/border_walls.c", model_has_walls(m)},
      {"... with images that slide", "mpc/border_shear.c", model_is_sheared(m)},
      {"kicks that depend on y", "mpc/drive.c", collides && (drive_has_profile(m) || drive_has_affine_kick(m))},
      {"... with phantoms for a solvent", "mpc/random_solvent.c", model_has_phantoms(m)},
      {"... rotation by 90 degrees", "mpc/rules/srd.h", collides && rotates && quarter},
      {"... rotation by any angle", "mpc/rules/srd.h", collides && rotates && !quarter},
      {"... velocities drawn anew", "mpc/rules/at_a.c", collides && s->rule == RULE_AT_A},
      {"private baths of vertices", "medium/private.c", m->medium.kind == MEDIUM_PRIVATE},
      {"baths of pairs", "medium/pairs.c", m->medium.kind == MEDIUM_PAIRS},
      {"forces of pairs", "medium/repulsion.c", model_repels(m)},
      {"overdamped motion", "fiber/overdamped.c", model_is_overdamped(m)},
      {"... with a tensor", "fiber/mobility.c", m->medium.tensor != TENSOR_NONE},
      {"thermostat's sums and factors", "mpc/thermostat.c", solvent && s->thermostat != THERMOSTAT_NONE},
      {"permuted velocities", "mpc/sort.c", solvent && collides && !s->hydrodynamics},
      {"moves of vertices", "contact/rule.c", m->vertices > 0},
      {"search for crossings",
       m->crossing.rule == CROSSING_SEQUENTIAL ? "contact/neighbors.c, line.c" : "contact/neighbors.c, flight.c",
       m->crossing.forbidden && m->bonds > 0},
      {"springs", "fiber/force.c", any_kind(m, is_bonded)},
      {"... with a square root per bond", "fiber/force.c", any_kind(m, needs_root)},
      {"bends", "fiber/force.c", any_kind(m, is_bent)},
      {"start from a file", "files/snapshot.c", scene->snapshot != NULL},
      {"trajectory", "files/trajectory.c", scene->trajectory_every > 0},
  };
  sheet_heading("Parts of the program");
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
    printf("  %-7s %-38s %s\n", parts[i].used ? "used" : "skipped", parts[i].name, parts[i].file);
  for (int i = 0; i < OBSERVABLES; i++)
    printf("  %-7s observable: %-26s observe/\n", scene->observe.every[i] ? "used" : "skipped", observable_names[i]);
}

/* Rates measured on one core of an x86-64 of the 2020s, in ns: good for a guess within a factor of 2. */
static const double solvent_rate = 15.0;           /* per particle and collision, by SRD in a periodic box */
static const double phantom_rate = 170.0;          /* per vertex and collision, phantoms for a solvent */
static const double vertex_rate = 25.0;            /* per vertex and step, crossable fibers */
static const double crossing_rate = 140.0;         /* per vertex and step, with the search for crossings ... */
static const double crossing_density_rate = 135.0; /* ... and more for each unit of fiber length per volume */
static const double topology_rate = 700.0;         /* per bond and sample of observe.topology ... */
static const double topology_density_rate = 100.0; /* ... and more for each unit of fiber length per volume */

/* Times that rate: docs/speed.md, *Collision rules and boundaries*. */
static const double rule_cost[] = {[RULE_SRD] = 1.0, [RULE_AT_A] = 2.0, [RULE_AT_PLUS_A] = 3.5};
static const double boundary_cost[] = {[BOUNDARY_PERIODIC] = 1.0, [BOUNDARY_WALL] = 1.2, [BOUNDARY_SHEAR] = 1.1};

/* observe.topology, the only observable that may take longer than the steps. */
static void report_topology(const struct scene *scene)
{
  const uint64_t every = scene->observe.every[OBSERVE_TOPOLOGY], samples = every > 0 ? scene->steps / every : 0;
  const double bond = topology_rate + topology_density_rate * theory_line_density(&scene->model);
  if (every > 0)
    sheet_row(false, "time of observe.topology", "", 1e-9 * bond * scene->model.bonds * (double)samples, "s", "more");
}

/* ns per solvent particle and collision, and per vertex and step. */
static double solvent_cost(const struct model *m)
{
  const double cells = solvent_rate * rule_cost[m->solvent.rule] * boundary_cost[m->box.boundary[1]];
  return model_in_cells(m) ? cells : check_medium_cost(m);
}

static double vertex_cost(const struct model *m)
{
  const bool search = m->crossing.forbidden && m->bonds > 0;
  return check_medium_vertex_cost(m) +
         (search ? crossing_rate + crossing_density_rate * theory_line_density(m) : vertex_rate);
}

/* Seconds of a step. */
static double step_cost(const struct model *m)
{
  const double collisions = model_collides(m) ? 1.0 / m->solvent.interval_steps : 0.0;
  const double phantoms = model_has_phantoms(m) ? phantom_rate * collisions : 0.0;
  return 1e-9 * (solvent_cost(m) * m->solvent.particles * collisions + (vertex_cost(m) + phantoms) * m->vertices);
}

static void report_cost(const struct scene *scene)
{
  const struct model *m = &scene->model;
  const double step = step_cost(m);
  sheet_heading("Cost (an estimate; of time without observables and files)");
  check_memory(scene);
  sheet_row(false, "steps per second", "", 1.0 / step, "1/s", "");
  sheet_row(false, "time", "", step * (double)scene->steps, "s", "");
  report_topology(scene);
  printf("  from %.0f ns per solvent particle and collision, %.0f ns per vertex and step\n", solvent_cost(m),
         vertex_cost(m));
  check_choice(m, step_cost);
}

static void tell_warning(void *context, const char *text)
{
  (void)context;
  printf("  warning: %s\n", text_shown(text));
}

/* What SI units take besides: numbers of the solvent, if there is one. */
static void report_units(const struct model *m)
{
  printf("\x1funits");
  if (model_has_solvent(m))
    printf("\x1f%.17g\x1f%.17g\x1f%.17g\x1f%.17g\x1f%.17g\x1f%.17g\x1f%.17g", theory_model_viscosity(m),
           model_solvent_density(m), theory_sound_speed(model_is_isothermal(m), m->dimensions), theory_model_schmidt(m),
           theory_loaded_viscosity(m), theory_loaded_density(m), THEORY_HEAVY_LOAD);
  putchar('\n');
}

void scene_report(const struct scene *scene, const struct stream *stream, bool exact)
{
  const struct model *m = &scene->model;
  printf("# The effective scene of %s, every default filled in (fingerprint %016" PRIx64 ")\n", text_shown(scene->path),
         scene->fingerprint);
  check_head(scene);
  scene_write(scene, stdout, false);
  report_table_1(exact, m);
  if (model_has_solvent(m) && model_in_cells(m))
    report_solvent(exact, m);
  if (!model_in_cells(m))
    check_medium(exact, m);
  if (model_has_dumbbells(m))
    check_dumbbells(exact, m);
  if (model_has_bead(m))
    check_bead(exact, m);
  if (model_has_walls(m))
    check_walls(exact, m);
  if (model_is_sheared(m))
    check_shear(exact, m);
  if (m->solvent.profile != PROFILE_UNIFORM)
    check_drive(exact, m);
  check_fibers(exact, m);
  sheet_row(exact, "simulated time", "", m->time_step * (double)scene->steps, "t0", "");
  if (exact)
    report_units(m);
  check_stream(scene->seed, stream);
  check_observed(scene);
  report_parts(scene);
  report_cost(scene);
  sheet_heading("Warnings");
  if (scene_warnings(scene, tell_warning, NULL) + start_warnings(scene, stream, tell_warning, NULL) == 0)
    printf("  none: within the paper's limits\n");
}
