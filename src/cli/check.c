#include <inttypes.h>
#include <stdio.h>

#include "base/text.h"
#include "cli/check_bead.h"
#include "cli/check_dumbbells.h"
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
#include "theory/load.h"
#include "theory/theory.h"
#include "work.h"

/* --- Table I ----------------------------------------------------------------------------------------------------- */

static void report_kind_parameters(const struct si_scale *si, const struct fiber_kind *k)
{
  printf("  fibers '%s'%s\n", text_shown(k->name), k->ring ? ", rings" : "");
  sheet_row(si, "  number of fibers", "N_c", k->count, "", "");
  sheet_row(si, "  vertices of each", "N_v", k->vertices, "", "");
  sheet_row(si, "  mass of a vertex", "M", k->mass, "m", "");
  if (vec3_norm(k->force) > 0.0)
    sheet_row(si, "  force on a vertex", "", vec3_norm(k->force), "kT/a0", "");
  if (k->vertices < 2)
    return;
  sheet_row(si, "  rest length of a bond", "l0", k->bond_length, "a0", "");
  sheet_row(si, "  spring constant", "K/l0", k->spring, "kT/a0^2", "Eq. (1)");
  sheet_row(si, "  elastic modulus", "K", k->spring * k->bond_length, "kT/a0", "");
  sheet_row(si, "  bending constant", "l_p/l0", k->bending, "kT", "Eq. (2)");
  sheet_row(si, "  length", "L", theory_length(k), "a0", k->bond_length > 0.0 ? "N_v l0" : "contour");
  sheet_row(si, "  persistence length", "l_p", theory_persistence(k), "a0", "");
}

static void report_table_1(const struct si_scale *si, const struct model *m)
{
  sheet_heading("Parameters (paper, Table I)");
  if (model_has_cells(m)) {
    sheet_row(si, "particles per cell", "gamma", m->solvent.per_cell, "1/a0^3", "");
    if (model_has_solvent(m))
      sheet_row(si, "particles", "N_s", m->solvent.particles, "", "");
    sheet_row(si, "collision interval", "dt_c", model_collision_interval(m), "t0", "");
    if (m->solvent.rule == RULE_SRD)
      sheet_row(si, "rotation angle", "alpha", m->solvent.rotation_angle, "degrees", "");
  }
  printf("  %-38s %-9s %d x %d x %d a0\n", "box", "L_b", m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  for (int k = 0; si && k < 3; k++)
    sheet_row(si, (const char *const[]){"  edge along x", "  edge along y", "  edge along z"}[k], "", m->box.cells[k],
              "a0", "");
  sheet_row(si, "time step", "dt", m->time_step, "t0", "");
  if (vec3_norm(m->flow) > 0.0)
    sheet_row(si, "flow", "v", vec3_norm(m->flow), "a0/t0", "");
  if (vec3_norm(m->solvent.acceleration) > 0.0)
    sheet_row(si, "acceleration of the solvent", "", vec3_norm(m->solvent.acceleration), "a0/t0^2", "");
  for (uint32_t k = 0; k < m->kinds; k++)
    report_kind_parameters(si, &m->kind[k]);
}

/* --- what follows from them -------------------------------------------------------------------------------------- */

static bool is_isothermal(const struct model *m)
{
  return model_is_isothermal(m);
}

static void report_solvent(const struct si_scale *si, const struct model *m)
{
  const double gamma = m->solvent.per_cell, cosine = m->solvent.cosine, interval = model_collision_interval(m);
  const bool srd = m->solvent.rule == RULE_SRD;
  sheet_heading("Solvent (molecular chaos: some per cent off at a short mean free path)");
  sheet_row(si, "kinetic viscosity", "eta_kin",
            theory_viscosity_kinetic(collision_rule_of(m), m->dimensions, gamma, cosine, interval), "m/a0 t0",
            srd ? "Eq. (30)" : "");
  sheet_row(si, "collisional viscosity", "eta_col",
            theory_viscosity_collisional(collision_rule_of(m), m->dimensions, gamma, cosine, interval), "m/a0 t0",
            srd ? "Eq. (31)" : "");
  sheet_row(si, "viscosity", "eta", units_viscosity(m), "m/a0 t0",
            model_has_dumbbells(m) ? "with that of springs" : "");
  sheet_row(si, "kinematic viscosity", "nu", units_viscosity(m) / gamma, "a0^2/t0", "");
  sheet_row(si, "self-diffusion coefficient", "D_s",
            theory_solvent_diffusion(collision_rule_of(m), m->dimensions, gamma, cosine, interval), "a0^2/t0", "");
  sheet_row(si, "Schmidt number", "Sc", theory_schmidt(collision_rule_of(m), m->dimensions, gamma, cosine, interval),
            "", "nu/D_s");
  sheet_row(si, "speed of sound", "c_s", theory_sound_speed(is_isothermal(m), m->dimensions), "a0/t0",
            is_isothermal(m) ? "isothermal" : "");
  sheet_row(si, "mean free path", "", theory_mean_free_path(interval), "a0", "");
}

static void report_vertex(const struct si_scale *si, const struct model *m, const struct fiber_kind *k)
{
  const double gamma = m->solvent.per_cell, cosine = m->solvent.cosine;
  const double d0 =
      theory_vertex_diffusion(collision_rule_of(m), m->dimensions, k->mass, gamma, cosine, model_collision_interval(m));
  sheet_row(si, "  velocity kept per collision", "c",
            theory_vertex_retention(collision_rule_of(m), m->dimensions, k->mass, gamma, cosine), "", "");
  sheet_row(si, "  vertex diffusion, without HI", "D_0", d0, "a0^2/t0", "");
  sheet_row(si, "  vertex friction, without HI", "kT/D_0", 1.0 / d0, "m/t0", "");
  if (model_has_solvent(m) && !model_is_flat(m))
    sheet_row(si, "  hydrodynamic radius, from D_0 alone", "a_h", theory_hydrodynamic_radius(units_viscosity(m), d0),
              "a0", "with HI: 0.25 to 0.3");
  if (model_has_solvent(m) && k->vertices > 1)
    check_times(si, m, sqrt(theory_bond_square(k)), d0);
  if (k->bending == 0.0 && k->bond_length == 0.0 && !k->ring && k->vertices > 1)
    sheet_row(si, "  slowest Rouse mode, without HI", "tau_1", theory_rouse_time(k, 1.0 / d0), "t0", "");
}

static void report_statics(const struct si_scale *si, const struct model *m, const struct fiber_kind *k)
{
  const double mean = fiber_mean_bond(k);
  sheet_row(si, "  mean bond length", "<l>", mean, "a0", "");
  sheet_row(si, "  contour length", "", fiber_contour(k), "a0", "bonds <l>");
  if (k->bending > 0.0) {
    sheet_row(si, "  mean cosine of a bend", "<cos>", theory_bend_cosine(k->bending, m->dimensions), "", "");
    sheet_row(si, "  effective persistence length", "", theory_effective_persistence(k), "a0", "-<l>/ln<cos>");
  }
  if (!k->ring)
    sheet_row(si, "  end-to-end distance, rms", "R_e", sqrt(theory_end_to_end_square(k)), "a0", "");
  if (k->stands_for == 0)
    return;
  const double n = k->stands_for;
  sheet_row(si, "  stands for a chain of", "N", n, "", "vertices; what is lost:");
  sheet_row(si, "  ... its end-to-end distance, squared", "", fiber_coarse_ratio(k, SIZE_ENDS), "", "times its own");
  sheet_row(si, "  ... its radius of gyration, squared", "", fiber_coarse_ratio(k, SIZE_GYRATION), "", "times its own");
  sheet_row(si, "  ... modes of N - 1", "", k->vertices - 1.0, "", "slowest ones; faster ones are not there");
  sheet_row(si, "  ... its mass and its friction", "", k->vertices / n, "", "times its own if vertices are the same");
}

static void report_frequencies(const struct si_scale *si, const struct model *m, const struct fiber_kind *k)
{
  const double omega = fiber_highest_frequency(k);
  sheet_row(si, "  highest frequency, stretching", "", fiber_stretch_frequency(k), "1/t0", "");
  sheet_row(si, "  highest frequency, bending", "", fiber_bend_frequency(k), "1/t0", "straight, at <l>");
  sheet_row(si, "  highest frequency", "omega", omega, "1/t0", "");
  sheet_row(si, "  ... in time steps", "omega dt", omega * m->time_step, "", "unstable from 2 on");
  sheet_row(si, "  energy error of the fastest mode", "", 0.25 * omega * omega * m->time_step * m->time_step, "",
            "(omega dt)^2/4");
}

/* Diffusion of single fibers, far from others and from images. */
static void report_dilute(const struct si_scale *si, const struct model *m, const struct fiber_kind *k)
{
  const double length = theory_length(k), p = theory_aspect_ratio(length, THEORY_RADIUS);
  if (k->ring)
    return;
  if (k->bending == 0.0)
    sheet_row(si, "  dilute diffusion coefficient", "D",
              theory_chain_diffusion(units_viscosity(m), sqrt(theory_end_to_end_square(k))), "a0^2/t0", "Eq. (39)");
  if (k->bending > 0.0 && p > 2.0) {
    sheet_row(si, "  dilute diffusion coefficient, stiff", "D", theory_rod_diffusion(units_viscosity(m), length, 0.6),
              "a0^2/t0", "Eq. (40), b = 0.6");
    sheet_row(si, "  rotational relaxation, stiff", "tau_r", theory_rod_relaxation(units_viscosity(m), length, p), "t0",
              "Tirado 1980");
  }
}

/* Numbers of Table II that are of one kind of fiber; mesh: mesh size of all kinds together. */
static void report_table_2(const struct si_scale *si, const struct model *m, const struct fiber_kind *k, double mesh)
{
  const double length = theory_length(k), lp = theory_persistence(k);
  sheet_row(si, "  relative persistence length", "l_p*", theory_relative_persistence(lp, length), "", "Eq. (32)");
  sheet_row(si, "  aspect ratio", "p", theory_aspect_ratio(length, THEORY_RADIUS), "", "Eq. (33), 2 a_h = 0.5 a0");
  sheet_row(si, "  density", "c L^3", k->count * length * length * length / box_volume(&m->box), "", "");
  sheet_row(si, "  mesh size", "xi", mesh, "a0", "Eq. (34), all kinds");
  sheet_row(si, "  relative mesh size", "xi*", mesh / length, "", "xi/L");
  if (lp <= 0.0 || k->ring || mesh > length)
    return; /* no tube */
  const double tube = theory_tube_diameter(length, lp, mesh);
  sheet_row(si, "  tube diameter", "L_perp", tube, "a0", "Eq. (35)");
  sheet_row(si, "  tube plateau of d^2(t)", "2L_perp^2", 2.0 * tube * tube, "a0^2", "");
  sheet_row(si, "  deflection length", "L_d", theory_deflection_length(length, lp, mesh), "a0", "");
}

static void report_flow(const struct si_scale *si, const struct model *m, const struct fiber_kind *k)
{
  const double speed = vec3_norm(m->flow), length = theory_length(k), size = fmax(theory_persistence(k), 0.0);
  if (!(speed > 0.0) || !model_has_solvent(m) || size == 0.0)
    return;
  sheet_row(si, "  Reynolds number of the flow", "Re",
            theory_reynolds(speed, size, units_viscosity(m) / model_solvent_density(m)), "", "Eq. (37), R = l_p");
  sheet_row(si, "  Peclet number of the flow", "Pe",
            theory_peclet(speed, size, theory_rod_diffusion(units_viscosity(m), length, 0.6)), "", "Eq. (38), R = l_p");
}

static void report_kind(const struct si_scale *si, const struct model *m, const struct theory_shear *shear,
                        const struct fiber_kind *k, double mesh)
{
  printf("\nFibers '%s'\n", text_shown(k->name));
  if (model_has_cells(m))
    report_vertex(si, m, k);
  else if (model_collides(m))
    check_medium_vertex(si, m, k);
  if (k->vertices < 2)
    return;
  report_statics(si, m, k);
  if (!model_is_overdamped(m) && !k->frozen)
    report_frequencies(si, m, k);
  if (model_is_flat(m))
    return; /* what follows is of fibers in space */
  if (model_has_solvent(m))
    report_dilute(si, m, k);
  report_table_2(si, m, k, mesh);
  report_flow(si, m, k);
  check_kind_in_shear(si, m, shear, k);
}

/* What the flow meets: vertices that go with it, and the diameter that fibers have in it. */
static void report_load(const struct si_scale *si, const struct model *m)
{
  const double filled = theory_line_density(m) * 0.25 * 3.14159265358979323846 * 0.6 * 0.6;
  if (!theory_is_loaded(m))
    return;
  sheet_row(si, "mass per cell", "rho", theory_loaded_density(m), "m/a0^3", "solvent and vertices");
  sheet_row(si, "viscosity of the loaded fluid", "eta_l", theory_loaded_viscosity(m), "m/a0 t0",
            "loose vertices; bonds add to it");
  sheet_row(si, "... over that of the solvent", "", theory_loaded_viscosity(m) / units_viscosity(m), "", "");
  if (m->bonds > 0 && !model_is_flat(m))
    sheet_row(si, "volume that the flow finds filled", "", filled, "", "c L pi b^2/4, b = 0.6 a0");
}

static void report_suspension(const struct si_scale *si, const struct model *m)
{
  sheet_heading("Suspension");
  const double cells = box_volume(&m->box);
  if (model_has_solvent(m) && vec3_norm(m->flow) > 0.0)
    sheet_row(si, "Mach number of the flow", "Ma",
              theory_mach(vec3_norm(m->flow), theory_sound_speed(is_isothermal(m), m->dimensions)), "", "Eq. (36)");
  sheet_row(si, "vertices", "", m->vertices, "", "");
  sheet_row(si, "bonds", "", m->bonds, "", "");
  sheet_row(si, "vertices per cell", "", m->vertices / cells, "1/a0^3", "");
  sheet_row(si, "mass of vertices per cell", "", (m->total_mass - m->solvent.particles) / cells, "m/a0^3", "");
  report_load(si, m);
  sheet_row(si, "fiber length per volume", "c L", theory_line_density(m), "1/a0^2", "");
  if (!m->crossing.forbidden)
    return;
  double self = 0.0;
  for (uint32_t k = 0; k < m->kinds; k++)
    self += theory_self_collision_rate(&m->kind[k]);
  sheet_row(si, "collisions of bonds", "", theory_collision_rate(m), "1/t0",
            m->thickness > 0 ? "ideal gas of lines; thick fibers meet more often" : "ideal gas of bonds");
  sheet_row(si, "... of flexible fibers with themselves", "", self, "1/t0", "Gaussian chains; 0 with bending");
  sheet_row(si, "... that the rule answers", "", theory_executed_rate(m), "1/t0",
            m->crossing.rule == CROSSING_SEQUENTIAL ? "sequential: 1.15 of them" : "");
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

/* Times that rate: docs/speed.md, *Collision rules and boundaries*. */
static const double rule_cost[] = {[RULE_SRD] = 1.0, [RULE_AT_A] = 2.0, [RULE_AT_PLUS_A] = 5.0};
static const double boundary_cost[] = {[BOUNDARY_PERIODIC] = 1.0, [BOUNDARY_WALL] = 1.2, [BOUNDARY_SHEAR] = 1.1};

static void report_cost(const struct scene *scene)
{
  const struct model *m = &scene->model;
  const bool search = m->crossing.forbidden && m->bonds > 0;
  const double vertex = check_medium_vertex_cost(m) +
                        (search ? crossing_rate + crossing_density_rate * theory_line_density(m) : vertex_rate);
  const double collisions = model_collides(m) ? 1.0 / m->solvent.interval_steps : 0.0;
  const double phantoms = model_has_phantoms(m) ? phantom_rate * collisions : 0.0;
  const double cells = solvent_rate * rule_cost[m->solvent.rule] * boundary_cost[m->box.boundary[1]];
  const double solvent = model_in_cells(m) ? cells : check_medium_cost(m);
  const double step = 1e-9 * (solvent * m->solvent.particles * collisions + (vertex + phantoms) * m->vertices);
  sheet_heading("Cost (an estimate; of time without observables and files)");
  check_memory(scene);
  sheet_row(NULL, "steps per second", "", 1.0 / step, "1/s", "");
  sheet_row(NULL, "time", "", step * (double)scene->steps, "s", "");
  printf("  from %.0f ns per solvent particle and collision, %.0f ns per vertex and step\n", solvent, vertex);
}

static void tell_warning(void *context, const char *text)
{
  (void)context;
  printf("  warning: %s\n", text_shown(text));
}

void scene_report(const struct scene *scene, const struct stream *stream, const struct units *units,
                  const struct si_scale *si)
{
  const struct model *m = &scene->model;
  printf("# The effective scene of %s, every default filled in (fingerprint %016" PRIx64 ")\n", text_shown(scene->path),
         scene->fingerprint);
  check_head(scene);
  scene_write(scene, stdout, false);
  report_table_1(si, m);
  if (model_has_solvent(m) && model_in_cells(m))
    report_solvent(si, m);
  if (!model_in_cells(m))
    check_medium(si, m);
  if (model_has_dumbbells(m))
    check_dumbbells(si, m);
  if (model_has_bead(m))
    check_bead(si, m);
  if (model_has_walls(m))
    check_walls(si, m);
  if (model_is_sheared(m))
    check_shear(si, m);
  if (m->solvent.profile != PROFILE_UNIFORM)
    check_drive(si, m);
  const double mesh = theory_mesh_size(theory_line_density(m));
  const struct theory_shear shear = theory_shear_of(m);
  for (uint32_t k = 0; k < m->kinds; k++)
    report_kind(si, m, &shear, &m->kind[k], mesh);
  if (m->vertices > 0)
    report_suspension(si, m);
  sheet_row(si, "simulated time", "", m->time_step * (double)scene->steps, "t0", "");
  if (si)
    units_report(units, m, si);
  check_stream(scene->seed, stream);
  check_observed(scene);
  report_parts(scene);
  report_cost(scene);
  sheet_heading("Warnings");
  if (scene_warnings(scene, tell_warning, NULL) + start_warnings(scene, stream, tell_warning, NULL) == 0)
    printf("  none: within the paper's limits\n");
}
