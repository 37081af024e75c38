#include "cli/check_medium.h"

#include <math.h>
#include <stdio.h>

#include "medium/bath.h"
#include "system/fiber_kind.h"
#include "theory/dumbbell.h"
#include "theory/medium.h"
#include "theory/theory.h"

static const double pi = 3.14159265358979323846;

static double pairs_per_particle(const struct model *m)
{
  return 2.0 / 3.0 * pi * m->medium.density;
}

static void report_pairs(bool exact, const struct model *m)
{
  const double rho = m->medium.density, eta = theory_model_viscosity(m);
  sheet_row(exact, "particles", "N_s", m->solvent.particles, "", "");
  sheet_row(exact, "density", "rho", rho, "1/a0^3", "");
  sheet_row(exact, "pairs per particle", "", pairs_per_particle(m), "", "2 pi rho/3");
  sheet_row(exact, "mean free path", "Lambda", 1.0 / m->medium.rate, "a0", "sqrt(kT/m)/Gamma; below 1 a liquid");
  sheet_row(exact, "kinetic viscosity", "eta_kin", theory_medium_viscosity_kinetic(m), "m/a0 t0", "molecular chaos");
  sheet_row(exact, "collisional viscosity", "eta_col", theory_medium_viscosity_collisional(m), "m/a0 t0",
            "molecular chaos");
  sheet_row(exact, "viscosity", "eta", eta, "m/a0 t0", "too high where Lambda < 1");
  sheet_row(exact, "kinematic viscosity", "nu", eta / rho, "a0^2/t0", "");
  sheet_row(exact, "self-diffusion coefficient", "D_s", theory_medium_diffusion(m, 1.0), "a0^2/t0",
            "molecular chaos; too low where Lambda < 1");
  sheet_row(exact, "Schmidt number", "Sc", theory_model_schmidt(m), "", "nu/D_s");
  sheet_row(exact, "speed of sound", "c_s", theory_sound_speed(true, 3), "a0/t0", "ideal gas, isothermal");
  if (m->medium.repulsion > 0.0 && m->medium.many.repulsion == 0.0)
    sheet_row(exact, "pressure, mean field", "p", rho + pi / 30.0 * m->medium.repulsion * rho * rho, "kT/a0^3",
              "rho kT + pi/30 a rho^2; 10 % too high at rho = 3");
}

void check_medium(bool exact, const struct model *m)
{
  const bool pairs = m->medium.kind == MEDIUM_PAIRS;
  static const char *const headings[MEDIA] = {
      [MEDIUM_PRIVATE] = "Medium: a private bath of each vertex, no hydrodynamics",
      [MEDIUM_PAIRS] = "Medium: a bath of pairs",
      [MEDIUM_OVERDAMPED] = "Medium: overdamped motion, each fiber alone in an unbounded fluid"};
  sheet_heading(headings[m->medium.kind]);
  sheet_row(exact, "rate", "Gamma", m->medium.rate, "1/t0", "");
  sheet_row(exact, "... in a time step", "Gamma dt", m->medium.rate * m->time_step, "", "");
  if (pairs)
    report_pairs(exact, m);
}

void check_times(bool exact, const struct model *m, double l, double diffusion)
{
  const double nu = theory_model_viscosity(m) / model_solvent_density(m);
  const double sound = theory_sound_speed(model_is_isothermal(m), (int)m->dimensions);
  sheet_row(exact, "  time of sound, over a bond", "t_s", l / sound, "t0", "l/c_s");
  sheet_row(exact, "  time of momentum", "t_H", l * l / nu, "t0", "l^2/nu");
  sheet_row(exact, "  time of diffusion", "t_D", l * l / diffusion, "t0", "l^2/D_0; wanted: t_s < t_H << t_D");
}

static void report_overdamped(bool exact, const struct model *m, const struct fiber_kind *k)
{
  const struct medium_model *b = &m->medium;
  const double d0 = theory_medium_diffusion(m, k->mass), bond = k->vertices > 1 ? sqrt(theory_bond_square(k)) : 1.0;
  sheet_row(exact, "  vertex diffusion", "D_0", d0, "a0^2/t0", "kT/(M rate)");
  if (b->tensor != TENSOR_NONE)
    sheet_row(exact, "  viscosity", "eta", k->mass * b->rate / (6.0 * pi * b->radius), "m/a0 t0", "M rate/(6 pi a_h)");
  if (k->vertices < 2)
    return;
  if (b->inextensible) {
    const double length = k->bond_length * (k->vertices - 1.0), force = k->vertices * vec3_norm(k->force);
    sheet_row(exact, "  no noise; bonds keep their length", "b", k->bond_length, "a0", "medium.inextensible");
    sheet_row(exact, "  force over bending", "B", force * length * length / (k->bending * k->bond_length), "",
              "F L^2/(kappa b)");
    sheet_row(exact, "  time of bending", "", pow(length, 4) / (d0 * k->bending * k->bond_length), "t0",
              "L^4/(D_0 kappa b)");
    sheet_row(exact, "  fastest bending in a time step", "", theory_medium_bend_step(m, k), "",
              "16 kappa D_0 dt/b^2, without HI; unstable from 2 on");
    return;
  }
  sheet_row(exact, "  hydrodynamic radius over the rms bond", "a/b", b->radius / bond, "",
            "1/4: D of a chain scales from few vertices on");
  sheet_row(exact, "  fastest relaxation in a time step", "", theory_medium_spring_step(m, k), "",
            "4 k D_0 dt, without HI; unstable from 2 on");
  if (k->bending > 0.0)
    sheet_row(exact, "  fastest bending in a time step", "", theory_medium_bend_step(m, k), "",
              "16 kappa D_0 dt/<l>^2, without HI; unstable from 2 on");
  if (k->bending == 0.0 && k->bond_length == 0.0 && !k->ring)
    sheet_row(exact, "  diffusion of the chain, Kirkwood", "D_K",
              d0 * theory_kirkwood(b->tensor, k->vertices, b->radius / bond), "a0^2/t0",
              "1 to 3 % above the limit of long times");
}

void check_medium_vertex(bool exact, const struct model *m, const struct fiber_kind *k)
{
  if (model_is_overdamped(m)) {
    report_overdamped(exact, m, k);
    return;
  }
  const double loss = theory_medium_loss(m, k->mass), d0 = theory_medium_diffusion(m, k->mass);
  const double bond = sqrt(theory_bond_square(k));
  sheet_row(exact, "  velocity kept per step", "c", 1.0 - loss, "", "");
  sheet_row(exact, "  memory of the velocity", "", m->time_step / loss, "t0", "");
  sheet_row(exact, "  vertex diffusion, without HI", "D_0", d0, "a0^2/t0", "");
  sheet_row(exact, "  vertex friction, without HI", "kT/D_0", 1.0 / d0, "m/t0", "");
  if (k->bending == 0.0 && k->bond_length == 0.0 && !k->ring && k->vertices > 1)
    sheet_row(exact, "  slowest Rouse mode, without HI", "tau_1", theory_rouse_time(k, 1.0 / d0), "t0", "");
  if (m->medium.kind != MEDIUM_PAIRS)
    return;
  const double radius = theory_hydrodynamic_radius(theory_model_viscosity(m), d0);
  sheet_row(exact, "  hydrodynamic radius, from D_0 alone", "a_h", radius, "a0", "");
  if (k->vertices < 2)
    return;
  sheet_row(exact, "  ... over the rms bond", "a/b", radius / bond, "",
            "1/4: D of a chain scales from few vertices on");
  check_times(exact, m, bond, d0);
}

/* Rates in ns, for rows of matrices: of a tensor three for each vertex, of tensions one for each bond. Measured with 2
 * to 256 vertices. */
static const double root_rate = 0.36 / 6.0; /* per cube of the rows: the root (fiber/mobility.c) */
static const double tensor_rate = 2.0;      /* per square: the tensor, and products with it */
static const double tension_rate = 10.0;    /* per square: the matrix of tensions (fiber/tension.c) */
static const double brownian_rate = 20.0;   /* per vertex: three normal numbers, and the move */

static double fiber_cost(const struct medium_model *b, const struct fiber_kind *k)
{
  const double rows = 3.0 * k->vertices, bonds = b->inextensible ? k->vertices - 1.0 : 0.0;
  const bool coupled = b->tensor != TENSOR_NONE;
  return brownian_rate * k->vertices + (coupled ? tensor_rate * rows * rows : 0.0) +
         (coupled && !b->inextensible ? root_rate * pow(rows, 3) : 0.0) + tension_rate * bonds * bonds +
         root_rate * pow(bonds, 3);
}

double check_medium_vertex_cost(const struct model *m)
{
  double sum = 0.0;
  for (uint32_t k = 0; model_is_overdamped(m) && k < m->kinds; k++)
    sum += fiber_stands(&m->kind[k]) ? 0.0 : m->kind[k].count * fiber_cost(&m->medium, &m->kind[k]);
  return m->vertices > 0 ? sum / m->vertices : 0.0;
}

/* Per pair: the search, the bath's action on those that are chosen, and forces (with many bodies two searches). */
double check_medium_cost(const struct model *m)
{
  const double pairs = pairs_per_particle(m);
  const double chosen = bath_draw_of(m->medium.draw)->chooses ? m->medium.rate * m->time_step : 1.0;
  const double forces = !model_repels(m) ? 0.0 : m->medium.many.repulsion != 0.0 ? 40.0 : 20.0;
  return m->medium.kind == MEDIUM_PAIRS ? 100.0 + pairs * (20.0 + 40.0 * chosen + forces) : 0.0;
}
