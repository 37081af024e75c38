#include "theory/chaos.h"

#include <math.h>

double chaos_partners(double n)
{
  return n + expm1(-n);
}

/* --- SRD --------------------------------------------------------------------------------------------------------- */

/* In space a third of a velocity is along the axis, and is not turned; in a plane nothing is. */
static double srd_velocity_loss(double cosine, uint32_t d, double mass, uint32_t others)
{
  return (d == 2 ? 1.0 : 2.0 / 3.0) * (1.0 - cosine) * others / (mass + others);
}

/* cos 2 alpha = 2 cos^2 alpha - 1. Of theory_viscosity_kinetic; in a plane the stress is turned by 2 alpha. */
static double srd_stress_loss(double cosine, uint32_t d, double n)
{
  const double twice = 2.0 * cosine * cosine - 1.0;
  return (d == 2 ? 1.0 - twice : (4.0 - 2.0 * cosine - 2.0 * twice) / 5.0) * chaos_partners(n) / n;
}

/* Of theory_viscosity_collisional. */
static double srd_handed_on(double cosine, uint32_t d, double n)
{
  return (1.0 - cosine) / (d == 2 ? 12.0 : 18.0) * chaos_partners(n);
}

/* --- AT-a -------------------------------------------------------------------------------------------------------- */

/* A member keeps its share of V only. */
static double at_a_velocity_loss(double cosine, uint32_t d, double mass, uint32_t others)
{
  (void)cosine, (void)d;
  return others / (mass + others);
}

static double at_a_stress_loss(double cosine, uint32_t d, double n)
{
  (void)cosine, (void)d;
  return chaos_partners(n) / n;
}

static double at_a_handed_on(double cosine, uint32_t d, double n)
{
  (void)cosine, (void)d;
  return chaos_partners(n) / 12.0;
}

/* --- the table --------------------------------------------------------------------------------------------------- */

static const struct chaos chaos_srd = {srd_velocity_loss, srd_stress_loss, srd_handed_on};
static const struct chaos chaos_at_a = {at_a_velocity_loss, at_a_stress_loss, at_a_handed_on};

static const struct {
  const struct collision_rule *rule;
  const struct chaos *chaos;
} rows[RULES] = {{&srd_rule, &chaos_srd}, {&at_a_rule, &chaos_at_a}, {&at_plus_a_rule, &chaos_at_plus_a}};

const struct chaos *chaos_of(const struct collision_rule *rule)
{
  int k = 0;
  while (k + 1 < RULES && rows[k].rule != rule)
    k++;
  return rows[k].chaos;
}
