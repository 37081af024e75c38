#include "cli/units.h"

#include <stdio.h>

#include "cli/quantity.h"
#include "cli/sheet.h"
#include "mpc/rule.h"
#include "theory/dumbbell.h"
#include "theory/load.h"
#include "theory/theory.h"

#define AT(member) offsetof(struct units, member)

static const struct quantity_row rows[] = {
    {"a0", QUANTITY_LENGTH, AT(a0)},
    {"T", QUANTITY_TEMPERATURE, AT(temperature)},
    {"eta", QUANTITY_VISCOSITY, AT(viscosity)},
    {"rho", QUANTITY_DENSITY, AT(density)},
    {"mass", QUANTITY_MASS, AT(mass)},
    {"t0", QUANTITY_TIME, AT(time)},
};

double units_viscosity(const struct model *m)
{
  return theory_model_viscosity(m);
}

/* --- what fixes the unit of time ---------------------------------------------------------------------------------- */

static double time_of_viscosity(const struct units *u, const struct model *m, const struct si_scale *scale)
{
  return si_time_of_viscosity(scale, u->viscosity, units_viscosity(m));
}

static double time_of_density(const struct units *u, const struct model *m, const struct si_scale *scale)
{
  return si_time_of_density(scale, u->density, model_solvent_density(m));
}

static double time_of_mass(const struct units *u, const struct model *m, const struct si_scale *scale)
{
  (void)m;
  return si_time_of_mass(scale, u->mass);
}

static double time_given(const struct units *u, const struct model *m, const struct si_scale *scale)
{
  (void)m, (void)scale;
  return u->time;
}

static const struct choice {
  const char *key;
  size_t at;    /* in struct units */
  bool solvent; /* the scene must have one */
  double (*time)(const struct units *units, const struct model *model, const struct si_scale *scale);
  const char *right, *wrong;
  const char *loaded; /* what is right where vertices load the fluid */
} choices[] = {
    {"eta", AT(viscosity), true, time_of_viscosity,
     "lengths, energies, forces, and the times of all that viscosity governs (diffusion, relaxation, drag)",
     "the density, so inertia and Reynolds numbers are too large by its ratio; sound; the Schmidt number",
     "lengths, energies, forces, and the viscosity of the solvent alone"},
    {"rho", AT(density), true, time_of_density,
     "lengths, energies, forces, and inertia: masses, thermal velocities of vertices",
     "the viscosity, so whatever it governs (diffusion, relaxation) is faster by 1 over its ratio; sound; the Schmidt "
     "number",
     "lengths, energies, forces, masses, and the density of the solvent alone"},
    {"mass", AT(mass), false, time_of_mass, "lengths, energies, forces, and masses",
     "the solvent's density and viscosity, as listed; sound; the Schmidt number",
     "lengths, energies, forces, and masses"},
    {"t0", AT(time), false, time_given, "lengths, energies, forces",
     "the solvent's density and viscosity, as listed; sound; the Schmidt number", "lengths, energies, forces"},
};
enum { CHOICES = sizeof choices / sizeof *choices };

static double given(const struct units *u, const struct choice *c)
{
  return *(const double *)(const void *)((const char *)u + c->at);
}

/* NULL if none is given. */
static const struct choice *choice_of(const struct units *u)
{
  for (size_t k = 0; k < CHOICES; k++)
    if (given(u, &choices[k]) > 0.0)
      return &choices[k];
  return NULL;
}

bool units_read(const char *text, struct units *u, struct message *message)
{
  int found = 0;
  *u = (struct units){0};
  if (!quantities_read("--units", text, rows, sizeof rows / sizeof *rows, u, message))
    return false;
  for (size_t k = 0; k < CHOICES; k++)
    found += given(u, &choices[k]) > 0.0;
  return found <= 1 ||
         message_set(message, "--units: eta, rho, mass, t0: one of them fixes the unit of time; %d are given", found);
}

bool units_scale(const struct units *u, const struct model *m, struct si_scale *scale, struct message *message)
{
  const struct choice *c = choice_of(u);
  if (!(u->a0 > 0.0) || !(u->temperature > 0.0))
    return message_set(message, "--units: %s is missing, as in --units a0=50nm,T=300K", u->a0 > 0.0 ? "T" : "a0");
  if (c && c->solvent && !model_has_solvent(m))
    return message_set(message, "--units: %s: the scene has no solvent; use mass or t0", c->key);
  *scale = (struct si_scale){.length = u->a0, .energy = SI_BOLTZMANN * u->temperature};
  scale->time = c ? c->time(u, m, scale) : 0.0;
  return true;
}

/* --- beside water --------------------------------------------------------------------------------------------------
 */

static void beside(const char *name, double ours, double water, const char *unit, bool prefix)
{
  char text[2][64];
  printf("  %-38s %-18s water %-18s ratio %.3g\n", name, quantity_text(ours, unit, prefix, text[0], sizeof text[0]),
         quantity_text(water, unit, prefix, text[1], sizeof text[1]), ours / water);
}

static void report_solvent(const struct model *m, const struct si_scale *s)
{
  const double gamma = model_solvent_density(m);
  const double eta = si_convert(s, (struct si_dimension){-3, 1, 1}, units_viscosity(m));
  const double density = si_convert(s, (struct si_dimension){-5, 1, 2}, gamma);
  const double sound =
      si_convert(s, (struct si_dimension){1, 0, -1}, theory_sound_speed(model_is_isothermal(m), m->dimensions));
  const double nu_water = SI_WATER_VISCOSITY / SI_WATER_DENSITY;
  sheet_heading("The solvent beside water at 25 C");
  beside("density", density, SI_WATER_DENSITY, "kg/m^3", false);
  beside("viscosity", eta, SI_WATER_VISCOSITY, "Pa s", true);
  beside("kinematic viscosity", eta / density, nu_water, "m^2/s", false);
  beside("speed of sound", sound, SI_WATER_SOUND, "m/s", true);
  beside("Schmidt number", theory_model_schmidt(m), nu_water / SI_WATER_DIFFUSION, "", false);
}

static void report_right(const struct model *m, const struct choice *c)
{
  const double factor = theory_loaded_viscosity(m) / units_viscosity(m), gamma = model_solvent_density(m);
  if (factor > THEORY_HEAVY_LOAD)
    printf("  right:  %s\n  wrong:  viscosity and density of the fluid with its vertices, %.3g and %.3g times the "
           "solvent's, and so the times of diffusion, relaxation and drag; %s\n",
           c->loaded, factor, theory_loaded_density(m) / gamma, c->wrong);
  else
    printf("  right:  %s\n  wrong:  %s\n", c->right, c->wrong);
}

void units_report(const struct units *u, const struct model *m, const struct si_scale *s)
{
  const struct choice *c = choice_of(u);
  sheet_heading("SI units");
  sheet_row(s, "unit of length", "a0", 1.0, "a0", "given");
  sheet_row(s, "unit of energy", "kT", 1.0, "kT", "k_B T, T given");
  if (!c) {
    puts("  The unit of time is not fixed: one of eta=, rho=, mass=, t0= does that (docs/units.md).");
    return;
  }
  sheet_row(s, "unit of time", "t0", 1.0, "t0", c->key);
  sheet_row(s, "unit of mass, a solvent particle", "m", 1.0, "m", "kT t0^2/a0^2");
  if (model_has_solvent(m)) {
    report_solvent(m, s);
    report_right(m, c);
  }
}
