#include "cli/check_dumbbells.h"

#include <stdio.h>

#include "theory/dumbbell.h"
#include "theory/flow.h"

/* Of a steady flow at this rate. */
static void report_stretch(bool exact, const struct model *m, double shear, double rate, double number)
{
  const double wi = shear / rate;
  sheet_row(exact, "Weissenberg number", "Wi", wi, "", "shear rate/omega_H");
  sheet_row(exact, "extension", "R/R_0", sqrt(theory_dumbbell_stretch(wi, m->dimensions)), "", "sqrt(1 + (2/d) Wi^2)");
  sheet_row(exact, "angle with the flow", "chi", 57.29577951308232 * theory_dumbbell_angle(wi), "",
            "degrees; tan 2 chi = 1/Wi");
  sheet_row(exact, "first normal stress difference", "N1", theory_dumbbell_normal_stress(number, wi), "kT/a0^3",
            "2 n_d kT Wi^2");
}

/* Of an oscillation. */
static void report_moduli(bool exact, const struct model *m, double period, double rate, double number)
{
  const double omega = 6.283185307179586 / period, height = m->box.cells[1];
  const double complex modulus = theory_dumbbell_modulus(theory_model_viscosity_of_solvent(m), number, rate, omega);
  sheet_row(exact, "frequency over rate of relaxation", "", omega / rate, "", "omega/omega_H");
  sheet_row(exact, "storage modulus", "G'", creal(modulus), "kT/a0^3", "n_d kT x^2/(1 + x^2)");
  sheet_row(exact, "loss modulus", "G''", cimag(modulus), "kT/a0^3", "eta_0 omega + n_d kT x/(1 + x^2)");
  if (!model_has_walls(m))
    return;
  const double complex inertia = theory_dumbbell_inertia(modulus, omega, m->solvent.per_cell, height);
  sheet_row(exact, "stress on walls over that in the middle", "", cabs(inertia), "",
            "|cosh(k L/2)|: inertia of the fluid");
  sheet_row(exact, "its phase", "", 57.29577951308232 * carg(inertia), "",
            "degrees; divide by both to measure G', G''");
}

void check_dumbbells(bool exact, const struct model *m)
{
  const double spring = m->dumbbells.spring, number = theory_model_dumbbells(m), rate = theory_model_dumbbell_rate(m);
  const double own = theory_model_viscosity_of_solvent(m),
               period = m->wave.intervals ? m->wave.intervals * model_collision_interval(m) : 0.0;
  const double slide = vec3_norm(vec3_sub(m->walls.upper, m->walls.lower)) / m->box.cells[1];
  const double shear = model_is_sheared(m) ? fabs(m->shear.rate) : model_has_walls(m) ? slide : 0.0;
  sheet_heading("Dumbbells (molecular chaos: at a short mean free path omega_H is some 10 % higher)");
  sheet_row(exact, "dumbbells", "", m->dumbbells.pairs, "", "");
  sheet_row(exact, "size at rest", "R_0", theory_dumbbell_size(spring, m->dimensions), "a0", "sqrt(d kT/K)");
  sheet_row(exact, "rate of relaxation", "omega_H", rate, "1/t0", "4 K D_s/kT");
  sheet_row(exact, "time of relaxation", "", 1.0 / rate, "t0", "1/omega_H; observe from 5 of these on");
  sheet_row(exact, "modulus of the springs", "G", number, "kT/a0^3", "n_d kT");
  sheet_row(exact, "viscosity without springs", "eta_0", own, "m/a0 t0", "");
  sheet_row(exact, "viscosity of the springs", "eta_p", number / rate, "m/a0 t0", "n_d kT/omega_H");
  sheet_row(exact, "viscosity with springs", "eta", own + number / rate, "m/a0 t0", "eta_0 + eta_p");
  if (period > 0.0)
    report_moduli(exact, m, period, rate, number);
  else if (shear > 0.0)
    report_stretch(exact, m, shear, rate, number);
  if (model_has_walls(m))
    sheet_row(exact, "density far from the walls", "rho_b", theory_dumbbell_bulk_density(m), "m/a0^3",
              "particles that miss near the walls are there");
}
