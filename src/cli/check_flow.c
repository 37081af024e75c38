#include "cli/check_flow.h"

#include <stdio.h>

#include "theory/dumbbell.h"
#include "theory/flow.h"
#include "theory/load.h"
#include "theory/theory.h"

static void report_period(bool exact, const struct model *m)
{
  if (m->wave.intervals == 0)
    return;
  sheet_row(exact, "period", "", m->shear.period, "t0", "");
  printf("  %-38s %-9s %u collision intervals\n", "", "", m->wave.intervals);
  sheet_row(exact, "amplitude of the strain", "", m->shear.rate * m->shear.period / 6.283185307179586, "", "");
}

void check_shear(bool exact, const struct model *m)
{
  const double height = m->box.cells[1], gamma = m->solvent.per_cell, rate = m->shear.rate;
  const double eta = theory_loaded_viscosity(m);
  const double speed = 0.5 * fabs(rate) * height;
  sheet_heading("Shear (of the box; linear from the start)");
  sheet_row(exact, "shear rate", "", rate, "1/t0", m->wave.intervals ? "largest" : "");
  report_period(exact, m);
  sheet_row(exact, "rate times collision interval", "", rate * model_collision_interval(m), "", "");
  sheet_row(exact, "velocity at the boundary", "", speed, "a0/t0", "rate L/2");
  sheet_row(exact, "Mach number", "Ma", theory_mach(speed, theory_sound_speed(model_is_isothermal(m), m->dimensions)),
            "", "of this velocity; harmless, since nothing is there");
  sheet_row(exact, "shear stress", "", eta * rate, "kT/a0^3",
            theory_is_loaded(m) ? "eta_l times rate" : "eta times rate");
  sheet_row(exact, "heat", "", theory_flow_heating(eta, theory_mean_shear_rate(m), gamma, m->dimensions), "kT/t0",
            model_is_isothermal(m) ? "the thermostat takes it away" : "2 eta rate^2/(d rho)");
}

void check_drive(bool exact, const struct model *m)
{
  const double height = m->box.cells[1], gamma = m->solvent.per_cell, eta = theory_loaded_viscosity(m);
  const double speed = theory_profile_speed(m->solvent.profile, gamma, vec3_norm(m->solvent.acceleration), height, eta);
  const bool isothermal = model_is_isothermal(m);
  sheet_heading("Flow by a force with a profile");
  sheet_row(exact, "largest velocity", "v_max", speed, "a0/t0",
            m->solvent.profile == PROFILE_SINE ? "rho g/(eta k^2), k = 2 pi/L" : "rho g L^2/(32 eta)");
  sheet_row(exact, "Mach number", "Ma", theory_mach(speed, theory_sound_speed(isothermal, m->dimensions)), "",
            "v_max/c_s; keep below 0.5");
  sheet_row(exact, "Reynolds number", "Re", theory_profile_reynolds(speed, height, theory_loaded_kinematic(m)), "",
            "v_max/(nu k); stable below sqrt(2)");
  sheet_row(exact, "time to become steady", "", theory_flow_transient(m, theory_loaded_kinematic(m)), "t0",
            "1/(nu k^2): the start falls to 1/e; observe from 5 of these on");
}

/* The paper's Table II with R = L and R = l_p. */
void check_kind_in_shear(bool exact, const struct model *m, const struct theory_shear *shear,
                         const struct fiber_kind *k)
{
  const double length = theory_length(k), p = theory_aspect_ratio(length, THEORY_RADIUS);
  const double within = shear->bead > 0.0 ? shear->radius : length, rate = theory_shear_speed(shear, within) / within;
  const struct {
    const char *mach, *reynolds, *note;
    double size;
  } row[] = {{"Ma(L)", "Re(L)", "keep below 0.1: Eqs. (36), (37), R = L", length},
             {"Ma(l_p)", "Re(l_p)", "as in Table II, R = l_p", theory_persistence(k)}};
  if (!(rate > 0.0))
    return;
  sheet_row(exact, "  largest shear rate", "", rate, "1/t0", "");
  for (size_t i = 0; i < sizeof row / sizeof *row; i++)
    if (row[i].size > 0.0) {
      const double speed = theory_shear_speed(shear, row[i].size);
      sheet_row(exact, "  Mach number of the shear", row[i].mach, theory_mach(speed, shear->sound), "", row[i].note);
      sheet_row(exact, "  Reynolds number of the shear", row[i].reynolds,
                theory_reynolds(speed, row[i].size, shear->kinematic), "", row[i].note);
    }
  if (k->bending > 0.0 && p > 2.0)
    sheet_row(exact, "  Peclet number of the shear, stiff", "Pe",
              rate * theory_rod_relaxation(theory_model_viscosity(m), length, p), "", "rate tau_r");
}
