/* Molecular chaos of MPC-AT+a: three functions of its row (mpc/rule.h). */
#ifndef UNCROSS_MPC_RULES_AT_PLUS_A_THEORY_H
#define UNCROSS_MPC_RULES_AT_PLUS_A_THEORY_H

#include <stdint.h>

/* The angle has no meaning to the rule; cosine is not used. With members of equal mass the loss of velocity is exact.
 * For another mass it is an estimate, within 0.015 for a mass of 5. */
double at_plus_a_velocity_loss(double cosine, uint32_t d, double mass, uint32_t others);
double at_plus_a_stress_loss(double cosine, uint32_t d, double n);
double at_plus_a_handed_on(double cosine, uint32_t d, double n);

#endif
