/* Thermostats act on velocities relative to the centre of mass of their collision cell, so momentum is untouched. */
#ifndef UNCROSS_THERMOSTAT_H
#define UNCROSS_THERMOSTAT_H

#include "state/model.h"
#include "state/work.h"

/* Sets the factor of every cell from the relative kinetic energies (work->collision.relative). */
void thermostat_factors(struct work *work, const struct model *model, uint64_t step);

/* A Gamma(shape, 1) deviate for this cell and step, shape >= 1 (Marsaglia and Tsang, ACM TOMS 26, 363 (2000)). */
double thermostat_gamma(uint64_t seed, uint64_t step, uint32_t cell, double shape);

#endif
