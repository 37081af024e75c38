/* The option --units: which SI units a scene has. */
#ifndef UNCROSS_CLI_UNITS_H
#define UNCROSS_CLI_UNITS_H

#include "base/message.h"
#include "system/model.h"
#include "theory/si.h"

/* What was given, in SI units; 0: not given. */
struct units {
  double a0, temperature, viscosity, density, mass, time;
};

/* Reads the words of --units. At most one of eta, rho, mass, t0 may be among them. */
bool units_read(const char *text, struct units *units, struct message *message);

/* The units of this scene. False, with a message, if a0 or T is missing, or if the scene has no solvent whose viscosity
 * or density could fix the time. */
bool units_scale(const struct units *units, const struct model *model, struct si_scale *scale, struct message *message);

/* Prints the units, how far the solvent is from water, and what follows for a run. */
void units_report(const struct units *units, const struct model *model, const struct si_scale *scale);

/* The model's viscosity in m/(a0 t0), at low frequencies; it has a solvent. */
double units_viscosity(const struct model *model);

#endif
