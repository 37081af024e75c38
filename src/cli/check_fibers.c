#include "cli/check_fibers.h"

#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "cli/check_flow.h"
#include "cli/check_medium.h"
#include "cli/command.h"
#include "mpc/rule.h"
#include "system/fiber_kind.h"
#include "theory/dumbbell.h"
#include "theory/load.h"
#include "theory/theory.h"

/* --- one kind -------------------------------------------------------------------------------------------------------
 */

static void report_vertex(bool exact, const struct model *m, const struct fiber_kind *k)
{
  const double gamma = m->solvent.per_cell, cosine = m->solvent.cosine;
  const double d0 =
      theory_vertex_diffusion(collision_rule_of(m), m->dimensions, k->mass, gamma, cosine, model_collision_interval(m));
  sheet_row(exact, "  velocity kept per collision", "c",
            theory_vertex_retention(collision_rule_of(m), m->dimensions, k->mass, gamma, cosine), "", "");
  sheet_row(exact, "  vertex diffusion, without HI", "D_0", d0, "a0^2/t0", "");
  sheet_row(exact, "  vertex friction, without HI", "kT/D_0", 1.0 / d0, "m/t0", "");
  if (model_has_solvent(m) && !model_is_flat(m))
    sheet_row(exact, "  hydrodynamic radius, from D_0 alone", "a_h",
              theory_hydrodynamic_radius(theory_model_viscosity(m), d0), "a0", "with HI: 0.25 to 0.3");
  if (model_has_solvent(m) && k->vertices > 1)
    check_times(exact, m, sqrt(theory_bond_square(k)), d0);
  if (k->bending == 0.0 && k->bond_length == 0.0 && !k->ring && k->vertices > 1)
    sheet_row(exact, "  slowest Rouse mode, without HI", "tau_1", theory_rouse_time(k, 1.0 / d0), "t0", "");
}

static void report_statics(bool exact, const struct model *m, const struct fiber_kind *k)
{
  const double mean = fiber_mean_bond(k);
  sheet_row(exact, "  mean bond length", "<l>", mean, "a0", "");
  sheet_row(exact, "  contour length", "", fiber_contour(k), "a0", "bonds <l>");
  if (k->bending > 0.0) {
    sheet_row(exact, "  mean cosine of a bend", "<cos>", theory_bend_cosine(k->bending, m->dimensions), "", "");
    sheet_row(exact, "  effective persistence length", "", theory_effective_persistence(k), "a0", "-<l>/ln<cos>");
  }
  if (!k->ring)
    sheet_row(exact, "  end-to-end distance, rms", "R_e", sqrt(theory_end_to_end_square(k)), "a0", "");
  if (k->stands_for == 0)
    return;
  const double n = k->stands_for;
  sheet_row(exact, "  stands for a chain of", "N", n, "", "vertices; what is lost:");
  sheet_row(exact, "  ... its end-to-end distance, squared", "", fiber_coarse_ratio(k, SIZE_ENDS), "", "times its own");
  sheet_row(exact, "  ... its radius of gyration, squared", "", fiber_coarse_ratio(k, SIZE_GYRATION), "",
            "times its own");
  sheet_row(exact, "  ... modes of N - 1", "", k->vertices - 1.0, "", "slowest ones; faster ones are not there");
  sheet_row(exact, "  ... its mass and its friction", "", k->vertices / n, "",
            "times its own if vertices are the same");
}

static void report_frequencies(bool exact, const struct model *m, const struct fiber_kind *k)
{
  const double omega = fiber_highest_frequency(k);
  sheet_row(exact, "  highest frequency, stretching", "", fiber_stretch_frequency(k), "1/t0", "");
  sheet_row(exact, "  highest frequency, bending", "", fiber_bend_frequency(k), "1/t0", "straight, at <l>");
  sheet_row(exact, "  highest frequency", "omega", omega, "1/t0", "");
  sheet_row(exact, "  ... in time steps", "omega dt", omega * m->time_step, "", "unstable from 2 on");
  sheet_row(exact, "  energy error of the fastest mode", "", 0.25 * omega * omega * m->time_step * m->time_step, "",
            "(omega dt)^2/4");
}

/* Diffusion of single fibers, far from others and from images. */
static void report_dilute(bool exact, const struct model *m, const struct fiber_kind *k)
{
  const double length = theory_length(k), p = theory_aspect_ratio(length, THEORY_RADIUS);
  if (k->ring)
    return;
  if (k->bending == 0.0)
    sheet_row(exact, "  dilute diffusion coefficient", "D",
              theory_chain_diffusion(theory_model_viscosity(m), sqrt(theory_end_to_end_square(k))), "a0^2/t0",
              "Eq. (39)");
  if (k->bending > 0.0 && p > 2.0) {
    sheet_row(exact, "  dilute diffusion coefficient, stiff", "D",
              theory_rod_diffusion(theory_model_viscosity(m), length, 0.6), "a0^2/t0", "Eq. (40), b = 0.6");
    sheet_row(exact, "  rotational relaxation, stiff", "tau_r",
              theory_rod_relaxation(theory_model_viscosity(m), length, p), "t0", "Tirado 1980");
  }
}

/* Numbers of Table II that are of one kind of fiber; mesh: mesh size of all kinds together. */
static void report_table_2(bool exact, const struct model *m, const struct fiber_kind *k, double mesh)
{
  const double length = theory_length(k), lp = theory_persistence(k);
  sheet_row(exact, "  relative persistence length", "l_p*", theory_relative_persistence(lp, length), "", "Eq. (32)");
  sheet_row(exact, "  aspect ratio", "p", theory_aspect_ratio(length, THEORY_RADIUS), "", "Eq. (33), 2 a_h = 0.5 a0");
  sheet_row(exact, "  density", "c L^3", k->count * length * length * length / box_volume(&m->box), "", "");
  sheet_row(exact, "  mesh size", "xi", mesh, "a0", "Eq. (34), all kinds");
  sheet_row(exact, "  relative mesh size", "xi*", mesh / length, "", "xi/L");
  if (lp <= 0.0 || k->ring || mesh > length)
    return; /* no tube */
  const double tube = theory_tube_diameter(length, lp, mesh);
  sheet_row(exact, "  tube diameter", "L_perp", tube, "a0", "Eq. (35)");
  sheet_row(exact, "  tube plateau of d^2(t)", "2L_perp^2", 2.0 * tube * tube, "a0^2", "");
  sheet_row(exact, "  deflection length", "L_d", theory_deflection_length(length, lp, mesh), "a0", "");
}

static void report_flow(bool exact, const struct model *m, const struct fiber_kind *k)
{
  const double speed = vec3_norm(m->flow), length = theory_length(k), size = fmax(theory_persistence(k), 0.0);
  if (!(speed > 0.0) || !model_has_solvent(m) || size == 0.0)
    return;
  sheet_row(exact, "  Reynolds number of the flow", "Re",
            theory_reynolds(speed, size, theory_model_viscosity(m) / model_solvent_density(m)), "",
            "Eq. (37), R = l_p");
  sheet_row(exact, "  Peclet number of the flow", "Pe",
            theory_peclet(speed, size, theory_rod_diffusion(theory_model_viscosity(m), length, 0.6)), "",
            "Eq. (38), R = l_p");
}

static void report_kind(bool exact, const struct model *m, const struct theory_shear *shear, const struct fiber_kind *k,
                        double mesh)
{
  printf("\nFibers '%s'\n", text_shown(k->name));
  if (model_has_cells(m))
    report_vertex(exact, m, k);
  else if (model_collides(m))
    check_medium_vertex(exact, m, k);
  if (k->vertices < 2)
    return;
  report_statics(exact, m, k);
  if (!model_is_overdamped(m) && !fiber_stands(k))
    report_frequencies(exact, m, k);
  if (model_is_flat(m))
    return; /* what follows is of fibers in space */
  if (model_has_solvent(m) && fiber_held(k) == 0)
    report_dilute(exact, m, k);
  report_table_2(exact, m, k, mesh);
  report_flow(exact, m, k);
  check_kind_in_shear(exact, m, shear, k);
}

/* --- all of them ----------------------------------------------------------------------------------------------------
 */

/* What the flow meets: vertices that go with it, and the diameter that fibers have in it. */
static void report_load(bool exact, const struct model *m)
{
  const double filled = theory_line_density(m) * 0.25 * 3.14159265358979323846 * 0.6 * 0.6;
  if (!theory_is_loaded(m))
    return;
  sheet_row(exact, "mass per cell", "rho", theory_loaded_density(m), "m/a0^3", "solvent and vertices");
  sheet_row(exact, "viscosity of the loaded fluid", "eta_l", theory_loaded_viscosity(m), "m/a0 t0",
            "loose vertices; bonds add to it");
  sheet_row(exact, "... over that of the solvent", "", theory_loaded_viscosity(m) / theory_model_viscosity(m), "", "");
  if (m->bonds > 0 && !model_is_flat(m))
    sheet_row(exact, "volume that the flow finds filled", "", filled, "", "c L pi b^2/4, b = 0.6 a0");
}

static void report_suspension(bool exact, const struct model *m)
{
  sheet_heading("Suspension");
  const double cells = box_volume(&m->box);
  if (model_has_solvent(m) && vec3_norm(m->flow) > 0.0)
    sheet_row(exact, "Mach number of the flow", "Ma",
              theory_mach(vec3_norm(m->flow), theory_sound_speed(model_is_isothermal(m), m->dimensions)), "",
              "Eq. (36)");
  sheet_row(exact, "vertices", "", m->vertices, "", "");
  sheet_row(exact, "bonds", "", m->bonds, "", "");
  sheet_row(exact, "vertices per cell", "", m->vertices / cells, "1/a0^3", "");
  sheet_row(exact, "mass of vertices per cell", "", (m->total_mass - m->solvent.particles) / cells, "m/a0^3", "");
  report_load(exact, m);
  sheet_row(exact, "fiber length per volume", "c L", theory_line_density(m), "1/a0^2", "");
  if (!m->crossing.forbidden)
    return;
  double self = 0.0;
  for (uint32_t k = 0; k < m->kinds; k++)
    self += theory_self_collision_rate(&m->kind[k]);
  sheet_row(exact, "collisions of bonds", "", theory_collision_rate(m), "1/t0",
            m->thickness > 0 ? "ideal gas of lines; thick fibers meet more often" : "ideal gas of bonds");
  sheet_row(exact, "... of flexible fibers with themselves", "", self, "1/t0", "Gaussian chains; 0 with bending");
  sheet_row(exact, "... that the rule answers", "", theory_executed_rate(m), "1/t0",
            m->crossing.rule == CROSSING_SEQUENTIAL ? "sequential: 1.15 of them" : "");
}

void check_fibers(bool exact, const struct model *m)
{
  const double mesh = theory_mesh_size(theory_line_density(m));
  const struct theory_shear shear = theory_shear_of(m);
  for (uint32_t k = 0; k < m->kinds; k++)
    report_kind(exact, m, &shear, &m->kind[k], mesh);
  if (m->vertices > 0)
    report_suspension(exact, m);
}
