#include "theory/load.h"

#include <math.h>

#include "system/fiber_kind.h"
#include "theory/dumbbell.h"
#include "theory/medium.h"
#include "theory/theory.h"

bool theory_is_loaded(const struct model *m)
{
  return theory_load(m) > 0.0 && model_has_solvent(m) && m->solvent.hydrodynamics;
}

static double per_cell(const struct model *m, uint32_t kind)
{
  const struct fiber_kind *k = &m->kind[kind];
  return (double)k->count * (k->vertices - fiber_held(k)) / box_volume(&m->box);
}

double theory_load(const struct model *m)
{
  double mass = 0.0;
  for (uint32_t k = 0; k < m->kinds; k++)
    mass += per_cell(m, k) * m->kind[k].mass;
  return mass;
}

/* f''(s) exp(f(s) - f(0)) */
static double met(const struct model *m, double masses, double gamma, double s)
{
  double curvature = gamma * exp(-s), change = gamma * expm1(-s);
  for (uint32_t k = 0; k < m->kinds; k++) {
    const double n = per_cell(m, k), mass = masses * m->kind[k].mass;
    curvature += n * mass * mass * exp(-s * mass);
    change += n * expm1(-s * mass);
  }
  return curvature * exp(change);
}

#define STEP 0.05 /* of ln s: the trapezoidal rule is exact to 12 digits */

/* <m_cell - sum m^2/m_cell> */
static double handed_on(const struct model *m, double masses, double gamma)
{
  double least = 1.0, most = 1.0;
  for (uint32_t k = 0; k < m->kinds; k++) {
    least = fmin(least, masses * m->kind[k].mass);
    most = fmax(most, masses * m->kind[k].mass);
  }
  const double total = gamma + masses * theory_load(m);
  const double low = log(1e-13 / (most + total)), high = log(50.0 / least);
  double sum = 0.0;
  for (int i = 0; i < (int)((high - low) / STEP); i++) {
    const double s = exp(low + STEP * i);
    sum += s * met(m, masses, gamma, s);
  }
  return total - STEP * sum;
}

/* sum n_i n_j 2 mu_ij over kinds of members of pairs: a pair hands on momentum as its reduced mass, 1/2 of two
 * particles */
static double handed_on_by_pairs(const struct model *m, double masses, double gamma)
{
  double sum = gamma * gamma;
  for (uint32_t i = 0; i < m->kinds; i++) {
    const double mass = masses * m->kind[i].mass;
    sum += 4.0 * gamma * per_cell(m, i) * mass / (1.0 + mass);
    for (uint32_t j = 0; j < m->kinds; j++) {
      const double other = masses * m->kind[j].mass;
      sum += 2.0 * per_cell(m, i) * per_cell(m, j) * mass * other / (mass + other);
    }
  }
  return sum;
}

/* kinetic, collisional viscosity of the solvent alone at gamma particles per cell */
static void solvent_viscosity(const struct model *m, double gamma, double eta[2])
{
  if (!model_in_cells(m)) {
    struct model other = *m;
    other.medium.density = gamma;
    eta[0] = theory_medium_viscosity_kinetic(&other);
    eta[1] = theory_medium_viscosity_collisional(&other);
    return;
  }
  const struct collision_rule *rule = collision_rule_of(m);
  const double cosine = m->solvent.cosine, interval = model_collision_interval(m);
  eta[0] = theory_viscosity_kinetic(rule, m->dimensions, gamma, cosine, interval);
  eta[1] = theory_viscosity_collisional(rule, m->dimensions, gamma, cosine, interval);
}

double theory_load_factor(const struct model *m, double masses, double gamma)
{
  double eta[2];
  if (!theory_is_loaded(m))
    return 1.0;
  solvent_viscosity(m, gamma, eta);
  const double more = model_in_cells(m) ? handed_on(m, masses, gamma) / theory_partners(gamma)
                                        : handed_on_by_pairs(m, masses, gamma) / (gamma * gamma);
  return (eta[0] + eta[1] * more) / (eta[0] + eta[1]);
}

double theory_loaded_viscosity(const struct model *m)
{
  const double eta = theory_model_viscosity(m);
  if (!theory_is_loaded(m))
    return eta;
  const double own = model_in_cells(m) ? theory_model_viscosity_of_solvent(m) : eta;
  return eta + (theory_load_factor(m, 1.0, model_solvent_density(m)) - 1.0) * own;
}

double theory_loaded_density(const struct model *m)
{
  return model_solvent_density(m) + (theory_is_loaded(m) ? theory_load(m) : 0.0);
}

double theory_loaded_kinematic(const struct model *m)
{
  return theory_loaded_viscosity(m) / theory_loaded_density(m);
}
