#include "cli/check_bead.h"

#include <math.h>
#include <stdio.h>

#include "system/bead.h"
#include "theory/bead.h"
#include "theory/load.h"
#include "theory/theory.h"

static void report_drive(bool exact, const struct model *m, double friction)
{
  const struct bead_drive *d = &m->bead.drive;
  const double force = vec3_norm(d->force), speed = force / friction, nu = theory_loaded_kinematic(m);
  if (force > 0.0) {
    sheet_row(exact, "speed under the force", "", speed, "a0/t0",
              model_has_walls(m) ? "F/xi along the walls, relative to the flow there"
                                 : "F/xi, relative to the mean of everything");
    sheet_row(exact, "Reynolds number", "Re", speed * m->bead.radius / nu, "",
              "V R/nu; keep below 0.1 to compare with Stokes");
  }
  if (d->spring == 0.0)
    return;
  sheet_row(exact, "relaxation in the trap", "", friction / d->spring, "t0", "xi/k");
  sheet_row(exact, "width of places in the trap", "", sqrt(1.0 / d->spring), "a0", "sqrt(kT/k), per component");
  if (d->period > 0.0)
    sheet_row(exact, "frequency of the trap", "omega", 6.283185307179586 / d->period, "1/t0", "");
}

void check_bead(bool exact, const struct model *m)
{
  const struct bead_model *b = &m->bead;
  const double edge = box_shortest_edge(&m->box), slip = theory_model_bead_slip(m),
               size = theory_bead_radius(b->radius, slip), free = theory_model_bead_friction(m);
  const bool walled = model_has_walls(m), small = size / edge < 0.25;
  const double around = walled  ? theory_bead_slit(size, b->center.y, m->box.cells[1])
                        : small ? theory_bead_box(size, edge)
                                : 1.0;
  sheet_heading("Bead (in the fluid, with the viscosity above; without contacts)");
  sheet_row(exact, "mass", "M", b->mass, "m", "");
  sheet_row(exact, "slip length", "b", slip, "a0", "of a flat wall");
  sheet_row(exact, "hydrodynamic radius", "R_h", size, "a0", "R (1 + 2b/R)/(1 + 3b/R)");
  sheet_row(exact, "friction", "xi", free, "m/t0", "6 pi eta R_h");
  sheet_row(exact, walled ? "along the walls, at its center" : "in a cubic box of the shortest edge", "", free * around,
            "m/t0",
            walled  ? "Faxen's series for one wall, both added"
            : small ? "Hasimoto"
                    : "without the box's factor: R/L is above 0.25");
  sheet_row(exact, "diffusion coefficient", "D", 1.0 / (free * around), "a0^2/t0",
            walled ? "kT/xi along the walls" : "kT/xi in the box");
  sheet_row(exact, "friction of single hits alone", "xi_E", theory_bead_enskog(m->solvent.per_cell, b->radius, b->mass),
            "m/t0", "(16/3) gamma R^2 sqrt(2 pi kT)");
  sheet_row(exact, "momentum is kept for", "", b->mass / free, "t0", "M/xi");
  report_drive(exact, m, free * around);
}
