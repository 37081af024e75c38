#include "cli/check_walls.h"

#include <stdio.h>

#include "cli/quantity.h"
#include "cli/units.h"
#include "theory/flow.h"
#include "theory/theory.h"

/* Is the slip length that of theory_slip_length? */
static bool slip_is_known(const struct model *m)
{
  return m->walls.kind == WALL_NO_SLIP && m->walls.fill != FILL_NONE &&
         model_collision_interval(m) < THEORY_MOST_SLIP_INTERVAL;
}

static double fastest_wall(const struct model *m)
{
  return fmax(vec3_norm(m->walls.lower), vec3_norm(m->walls.upper));
}

/* Of walls that slide past each other, at the amplitude of an oscillation; and of a force along them. */
static void report_flows(const struct si_scale *si, const struct model *m, double slip)
{
  const double height = m->box.cells[1], gamma = m->solvent.per_cell, eta = units_viscosity(m);
  const double rate = vec3_norm(vec3_sub(m->walls.upper, m->walls.lower)) / height;
  const double g = vec3_norm(m->solvent.acceleration);
  const double driven = g > 0.0 ? theory_poiseuille_speed(gamma, g, height, eta, slip) : 0.0;
  if (rate > 0.0) {
    sheet_row(si, "shear rate of the walls", "", rate, "1/t0", "");
    sheet_row(si, "effective shear rate", "", theory_couette_rate(rate, height, slip), "1/t0", "over 1 + 2b/L");
  }
  if (g > 0.0)
    sheet_row(si, "largest velocity by the force", "v_max", driven, "a0/t0", "rho g L^2/(8 eta) (1 + 4b/L)");
  const double speed = fmax(fastest_wall(m), driven);
  sheet_row(si, "Mach number", "Ma", theory_mach(speed, theory_sound_speed(model_is_isothermal(m), m->dimensions)), "",
            "");
  sheet_row(si, "Reynolds number", "Re", theory_reynolds(speed, height, eta / gamma), "", "R = L");
}

void check_walls(const struct si_scale *si, const struct model *m)
{
  const double height = m->box.cells[1], gamma = m->solvent.per_cell, eta = units_viscosity(m);
  const bool known = slip_is_known(m);
  const double slip = known ? theory_slip_length(collision_rule_of(m), m->dimensions, gamma, m->solvent.cosine,
                                                 model_collision_interval(m))
                            : 0.0;
  sheet_heading("Walls (flow of the solvent between them)");
  sheet_row(si, "distance of the walls", "L", height, "a0", "");
  if (known) {
    sheet_row(si, "slip length", "b", slip, "a0", m->walls.fill == FILL_PLANAR ? "" : "planar fill: 1 % less");
    sheet_row(si, "effective distance", "L + 2b", height + 2.0 * slip, "a0", "");
  } else if (m->walls.kind == WALL_NO_SLIP)
    printf("  %-38s %-9s not known: to be measured; taken as 0 below\n", "slip length", "b");
  if (m->walls.kind == WALL_NO_SLIP)
    report_flows(si, m, slip);
  sheet_row(si, "time to become steady", "", theory_flow_relaxation(height, eta / gamma), "t0", "L^2/(pi^2 nu)");
  if (m->walls.period > 0.0)
    sheet_row(si, "inertia number", "", theory_inertia_number(6.283185307179586 / m->walls.period, gamma, height, eta),
              "", "omega rho L^2/(8 eta)");
}
