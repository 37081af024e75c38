/*
 * SI units of a scene. a0 and T give the units of length and energy (kT). One more number is needed for the unit of
 * time t0, or, which is the same, for the unit of mass m = kT t0^2/a0^2: the mass of a solvent particle, the density of
 * the solvent, or its viscosity. The solvent is no liquid, so only one of these can be right: docs/units.md.
 */
#ifndef UNCROSS_THEORY_SI_H
#define UNCROSS_THEORY_SI_H

#include "system/model.h"

/* J/K: exact, Resolution 1 of the 26th CGPM (2018). */
#define SI_BOLTZMANN 1.380649e-23

struct si_scale {
  double length; /* a0, m */
  double energy; /* kT, J */
  double time;   /* t0, s; 0: not known */
};

/* Powers of the three units. */
struct si_dimension {
  int length, energy, time;
};

/* A number of this dimension in SI units. NaN if it takes the unit of time, and that is not known. */
double si_convert(const struct si_scale *scale, struct si_dimension dimension, double reduced);

/* m, kg: kT t0^2/a0^2. */
double si_mass(const struct si_scale *scale);

/* t0, s, from the mass of a solvent particle, kg: a0 sqrt(m/kT). */
double si_time_of_mass(const struct si_scale *scale, double mass);

/* t0, s, from the density of the solvent, kg/m^3: m = rho a0^3/gamma. */
double si_time_of_density(const struct si_scale *scale, double density, double gamma);

/* t0, s, from the viscosity of the solvent, Pa s; reduced: the same, m/(a0 t0) = kT t0/a0^3. */
double si_time_of_viscosity(const struct si_scale *scale, double viscosity, double reduced);

/* Liquid water at 25 C and 0.1 MPa: density and speed of sound (IAPWS-95), viscosity (IAPWS 2008), self-diffusion
 * coefficient (Holz, Heil, Sacco, Phys. Chem. Chem. Phys. 2, 4740 (2000)). */
#define SI_WATER_DENSITY 997.05     /* kg/m^3 */
#define SI_WATER_VISCOSITY 8.900e-4 /* Pa s */
#define SI_WATER_SOUND 1496.7       /* m/s */
#define SI_WATER_DIFFUSION 2.299e-9 /* m^2/s */

/* <R^2> between the ends of a wormlike chain of this length, in any unit: 2 l_p L [1 - (l_p/L)(1 - exp(-L/l_p))]
 * (Kratky and Porod, Rec. Trav. Chim. 68, 1106 (1949)). */
double si_wormlike_square(double length, double persistence);

/* kappa for which the decay length of tangent correlations of this kind, theory_effective_persistence, is this one, a0;
 * its other numbers are given. The paper's l_p = kappa l0 is its limit for stiff fibers. MODEL_MOST_BENDING at most. */
double si_bending(const struct fiber_kind *kind, double persistence);

#endif
