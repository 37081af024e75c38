#include "cli/check_walls.h"

#include <stdio.h>

#include "theory/flow.h"
#include "theory/load.h"
#include "theory/theory.h"

/* Is the slip length that of theory_slip_length? */
static bool slip_is_known(const struct model *m)
{
  return m->walls.kind == WALL_NO_SLIP && !model_has_dumbbells(m) && m->walls.fill != FILL_NONE &&
         model_collision_interval(m) < THEORY_MOST_SLIP_INTERVAL;
}

static double fastest_wall(const struct model *m)
{
  return fmax(vec3_norm(m->walls.lower), vec3_norm(m->walls.upper));
}

/* Of walls that slide past each other, at the amplitude of an oscillation; and of a force along them. */
static void report_flows(bool exact, const struct model *m, double slip)
{
  const double height = m->box.cells[1], gamma = m->solvent.per_cell, eta = theory_loaded_viscosity(m);
  const double rate = vec3_norm(vec3_sub(m->walls.upper, m->walls.lower)) / height;
  const double g = vec3_norm(m->solvent.acceleration);
  const double bulk = theory_couette_rate(rate, height, slip);
  const double driven = g > 0.0 ? theory_poiseuille_speed(gamma, g, height, eta, slip) : 0.0;
  if (rate > 0.0) {
    sheet_row(exact, "shear rate of the walls", "", rate, "1/t0", m->walls.period > 0.0 ? "largest" : "");
    sheet_row(exact, "effective shear rate", "", bulk, "1/t0", "over 1 + 2b/L");
    sheet_row(exact, "shear stress", "", eta * bulk, "kT/a0^3",
              theory_is_loaded(m) ? "eta_l times effective rate" : "eta times effective rate");
  }
  if (g > 0.0) {
    sheet_row(exact, "largest velocity by the force", "v_max", driven, "a0/t0", "rho g L^2/(8 eta) (1 + 4b/L)");
    sheet_row(exact, "velocity at the walls by the force", "", 0.5 * gamma * g * height * slip / eta, "a0/t0",
              "slip: rho g L b/(2 eta)");
    sheet_row(exact, "stress on each wall by the force", "", 0.5 * gamma * g * height, "kT/a0^3", "rho g L/2, exact");
  }
  const double speed = fmax(fastest_wall(m), driven);
  sheet_row(exact, "Mach number", "Ma", theory_mach(speed, theory_sound_speed(model_is_isothermal(m), m->dimensions)),
            "", "largest velocity/c_s; keep below 0.5");
  sheet_row(exact, "Reynolds number", "Re", theory_reynolds(speed, height, theory_loaded_kinematic(m)), "",
            "largest velocity L/nu");
}

/* Of walls that oscillate. */
static void report_wave(bool exact, const struct model *m)
{
  const double height = m->box.cells[1], nu = theory_loaded_kinematic(m);
  const double frequency = 6.283185307179586 / m->walls.period;
  sheet_row(exact, "period", "", m->walls.period, "t0", "");
  sheet_row(exact, "penetration depth", "delta", theory_penetration_depth(frequency, nu), "a0", "sqrt(2 nu/omega)");
  sheet_row(exact, "inertia number", "", theory_inertia_number(frequency, 1.0, height, nu), "",
            "omega rho L^2/(8 eta); below 0.05 the shear is uniform");
}

void check_walls(bool exact, const struct model *m)
{
  const double height = m->box.cells[1], gamma = m->solvent.per_cell;
  const bool known = slip_is_known(m);
  const double slip = known ? theory_slip_length(collision_rule_of(m), m->dimensions, gamma, m->solvent.cosine,
                                                 model_collision_interval(m))
                            : 0.0;
  sheet_heading("Walls (flow of the solvent between them)");
  sheet_row(exact, "distance of the walls", "L", height, "a0", "");
  if (known) {
    sheet_row(exact, "slip length", "b", slip, "a0",
              m->walls.fill != FILL_PLANAR ? "planar fill: 1 % less"
              : theory_is_loaded(m)        ? "of the solvent alone; larger under load"
                                           : "");
    sheet_row(exact, "effective distance", "L + 2b", height + 2.0 * slip, "a0", "");
  } else if (m->walls.kind == WALL_NO_SLIP)
    printf("  %-38s %-9s not known: to be measured; taken as 0 below\n", "slip length", "b");
  if (m->walls.kind == WALL_NO_SLIP)
    report_flows(exact, m, slip);
  const double transient = theory_flow_transient(m, theory_loaded_kinematic(m));
  if (transient > 0.0)
    sheet_row(exact, "time to become steady", "", transient, "t0",
              "the start falls to 1/e; observe from 5 of these on");
  if (m->walls.kind == WALL_SLIP)
    printf("  %-38s %-9s the solvent slides along: walls do not drag it\n", "slip walls", "");
  if (m->walls.period > 0.0)
    report_wave(exact, m);
}
