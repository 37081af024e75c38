/*
 * Molecular chaos: what a collision rule (mpc/rule.h) does on average to members that have never met. In d dimensions
 * (2 or 3); cosine is that of the rotation angle, which only SRD has.
 */
#ifndef UNCROSS_THEORY_CHAOS_H
#define UNCROSS_THEORY_CHAOS_H

#include "mpc/rule.h"

struct chaos {
  /* The fraction of its velocity that a member of this mass loses in a collision with so many others of mass 1. */
  double (*velocity_loss)(double cosine, uint32_t d, double mass, uint32_t others);

  /* Averages over cells of Poisson occupation with a mean of n members of mass 1, weighted by the members.
   * stress_loss: the fraction of the kinetic stress that a collision removes. handed_on: the momentum that passes
   * through a cell, m a0^2. Of SRD and AT-a both have the factor P_n = n - 1 + exp(-n). */
  double (*stress_loss)(double cosine, uint32_t d, double n);
  double (*handed_on)(double cosine, uint32_t d, double n);
};

/* That of a rule, one of the table of mpc/rule.c. */
const struct chaos *chaos_of(const struct collision_rule *rule);

/* P_n = n - 1 + exp(-n): mean of the members but one over the cells that have any, their number Poisson of mean n. */
double chaos_partners(double n);

/* Of AT+a. With members of equal mass the loss of velocity is exact. For another mass it is an estimate, within 0.015
 * for a mass of 5. */
extern const struct chaos chaos_at_plus_a;

#endif
