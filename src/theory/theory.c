#include "theory/theory.h"

#include <stdlib.h>

#include "system/fiber_kind.h"
#include "theory/chaos.h"

static const double pi = 3.14159265358979323846;

/* --- solvent ----------------------------------------------------------------------------------------------------- */

double theory_partners(double gamma)
{
  return chaos_partners(gamma);
}

/* D or eta_kin of whatever keeps the share `retention` per collision: the Green-Kubo sum 1/2 + c + c^2 + ... */
static double green_kubo(double retention)
{
  return 1.0 / (1.0 - retention) - 0.5;
}

double theory_viscosity_kinetic(const struct collision_rule *rule, uint32_t d, double gamma, double cosine,
                                double interval)
{
  return gamma * interval * green_kubo(1.0 - chaos_of(rule)->stress_loss(cosine, d, gamma));
}

double theory_viscosity_collisional(const struct collision_rule *rule, uint32_t d, double gamma, double cosine,
                                    double interval)
{
  return chaos_of(rule)->handed_on(cosine, d, gamma) / interval;
}

double theory_viscosity(const struct collision_rule *rule, uint32_t d, double gamma, double cosine, double interval)
{
  return theory_viscosity_kinetic(rule, d, gamma, cosine, interval) +
         theory_viscosity_collisional(rule, d, gamma, cosine, interval);
}

double theory_solvent_diffusion(const struct collision_rule *rule, uint32_t d, double gamma, double cosine,
                                double interval)
{
  return theory_vertex_diffusion(rule, d, 1.0, gamma, cosine, interval);
}

double theory_schmidt(const struct collision_rule *rule, uint32_t d, double gamma, double cosine, double interval)
{
  return theory_viscosity(rule, d, gamma, cosine, interval) / gamma /
         theory_solvent_diffusion(rule, d, gamma, cosine, interval);
}

double theory_sound_speed(bool isothermal, uint32_t d)
{
  return isothermal ? 1.0 : sqrt((d + 2.0) / d);
}

double theory_mean_free_path(double interval)
{
  return interval;
}

/* --- a single vertex --------------------------------------------------------------------------------------------- */

double theory_vertex_retention(const struct collision_rule *rule, uint32_t d, double mass, double gamma, double cosine)
{
  const int last = (int)(gamma + 40.0 * sqrt(gamma) + 40.0);
  double loss = 0.0;
  for (int n = 1; n <= last; n++)
    loss += exp(n * log(gamma) - gamma - lgamma(n + 1.0)) * chaos_of(rule)->velocity_loss(cosine, d, mass, (uint32_t)n);
  return 1.0 - loss;
}

double theory_vertex_diffusion(const struct collision_rule *rule, uint32_t d, double mass, double gamma, double cosine,
                               double interval)
{
  return interval / mass * green_kubo(theory_vertex_retention(rule, d, mass, gamma, cosine));
}

double theory_hydrodynamic_radius(double viscosity, double diffusion)
{
  return 1.0 / (6.0 * pi * viscosity * diffusion);
}

/* --- dimensionless numbers --------------------------------------------------------------------------------------- */

double theory_relative_persistence(double persistence, double length)
{
  return persistence / length;
}

double theory_aspect_ratio(double length, double radius)
{
  return length / (2.0 * radius);
}

double theory_mesh_size(double line_density)
{
  return sqrt(3.0 / line_density);
}

double theory_tube_diameter(double length, double persistence, double mesh)
{
  double m = mesh / length, lp = theory_relative_persistence(persistence, length);
  return length * (0.31 * pow(m, 1.2) / pow(lp, 0.2) + 0.56 * m * m);
}

double theory_deflection_length(double length, double persistence, double mesh)
{
  double m = mesh / length, lp = theory_relative_persistence(persistence, length);
  return length * (0.64 * pow(m, 0.8) * pow(lp, 0.2) + 0.39 * pow(m, 1.6) * pow(lp, 0.4));
}

double theory_mach(double speed, double sound)
{
  return speed / sound;
}

double theory_reynolds(double speed, double size, double kinematic_viscosity)
{
  return speed * size / kinematic_viscosity;
}

double theory_peclet(double speed, double size, double diffusion)
{
  return speed * size / diffusion;
}

/* --- dilute chains and rods -------------------------------------------------------------------------------------- */

double theory_chain_diffusion(double viscosity, double end_to_end)
{
  return 0.196 / (viscosity * end_to_end);
}

double theory_rod_diffusion(double viscosity, double length, double diameter)
{
  return (log(length / diameter) + 0.312) / (3.0 * pi * viscosity * length);
}

double theory_rod_relaxation(double viscosity, double length, double aspect_ratio)
{
  double p = aspect_ratio, shape = log(p) - 0.662 + 0.917 / p - 0.050 / (p * p);
  return pi * viscosity * length * length * length / (6.0 * shape);
}

/* --- a kind of fiber --------------------------------------------------------------------------------------------- */

/* Moments of the bond length in units of 1/sqrt(k), beyond z: J_n = int_z^inf t^n exp(-(t-c)^2/2) dt, c = l0 sqrt(k),
 * by J_{n+1} = c J_n + n J_{n-1} + z^n exp(-(z-c)^2/2). */
static void bond_moments(const struct fiber_kind *kind, double z, double moment[5])
{
  const double c = kind->bond_length * sqrt(kind->spring), edge = exp(-0.5 * (z - c) * (z - c));
  moment[0] = sqrt(0.5 * pi) * erfc((z - c) / sqrt(2.0));
  double power = 1.0;
  for (int n = 0; n < 4; n++) {
    moment[n + 1] = c * moment[n] + (n > 0 ? n * moment[n - 1] : 0.0) + power * edge;
    power *= z;
  }
}

double theory_bond_square(const struct fiber_kind *kind)
{
  double moment[5];
  bond_moments(kind, 0.0, moment);
  const int weight = kind->dimensions == 2 ? 1 : 2; /* p(l) ~ l^weight exp(-k (l-l0)^2/2) */
  return moment[weight + 2] / moment[weight] / kind->spring;
}

double theory_bond_tail(const struct fiber_kind *kind, double limit)
{
  double all[5], beyond[5];
  bond_moments(kind, 0.0, all);
  bond_moments(kind, limit * sqrt(kind->spring), beyond);
  const int weight = kind->dimensions == 2 ? 1 : 2;
  return beyond[weight] / all[weight];
}

/* I_1/I_0 by its continued fraction, x/(2 + x^2/(4 + x^2/(6 + ...))), from far enough on that the rest is lost. */
static double bessel_ratio(double x)
{
  double ratio = 0.0;
  if (x > 1e4)
    return 1.0 - 0.5 / x - 0.125 / (x * x) - 0.125 / (x * x * x);
  for (int k = 40 + 2 * (int)ceil(x); k >= 1; k--)
    ratio = x / (2.0 * k + x * ratio);
  return ratio;
}

double theory_bend_cosine(double bending, uint32_t d)
{
  if (d == 2)
    return bessel_ratio(bending);
  return bending < 1e-3 ? bending / 3.0 : 1.0 / tanh(bending) - 1.0 / bending;
}

double theory_length(const struct fiber_kind *kind)
{
  return kind->bond_length > 0.0 ? kind->vertices * kind->bond_length : fiber_contour(kind);
}

double theory_persistence(const struct fiber_kind *kind)
{
  return kind->bond_length > 0.0 ? kind->bending * kind->bond_length : theory_effective_persistence(kind);
}

double theory_effective_persistence(const struct fiber_kind *kind)
{
  return kind->bending > 0.0 ? -fiber_mean_bond(kind) / log(theory_bend_cosine(kind->bending, kind->dimensions)) : 0.0;
}

/* sum_ij <R_i.R_j> over bonds, whose lengths and directions are independent: (n) <l^2> + 2 <l>^2 sum_d (n-d) <cos>^d.
 */
double theory_end_to_end_square(const struct fiber_kind *kind)
{
  const double mean = fiber_mean_bond(kind), cosine = theory_bend_cosine(kind->bending, kind->dimensions);
  const uint32_t n = kind->ring ? kind->vertices : kind->vertices - 1;
  double sum = 0.0, power = cosine;
  for (uint32_t d = 1; d < n && power > 1e-17; d++) {
    sum += (n - d) * power;
    power *= cosine;
  }
  return n * theory_bond_square(kind) + 2.0 * mean * mean * sum;
}

double theory_reach(const struct fiber_kind *kind)
{
  const double open = fmin(theory_length(kind), 2.0 * sqrt(theory_end_to_end_square(kind)));
  return kind->ring ? 0.5 * open : open;
}

double theory_rouse_time(const struct fiber_kind *kind, double friction)
{
  double sine = sin(0.5 * pi / kind->vertices);
  return friction / (4.0 * kind->spring * sine * sine);
}

/* --- a suspension ------------------------------------------------------------------------------------------------ */

double theory_line_density(const struct model *model)
{
  double length = 0.0;
  for (uint32_t k = 0; k < model->kinds; k++)
    length += model->kind[k].count * theory_length(&model->kind[k]);
  return length / box_volume(&model->box);
}

/* Bond length per volume of all vertices of one mass. */
struct density {
  double mass, length;
};

static int compare_masses(const void *a, const void *b)
{
  const double x = ((const struct density *)a)->mass, y = ((const struct density *)b)->mass;
  return (x > y) - (x < y);
}

/* int ds ds' sqrt(w(s) a + w(s') b) over the unit square, w(s) = (1-s)^2 + s^2. It is sqrt(a + b) times an even
 * function of (a - b)/(a + b): a polynomial fitted at Chebyshev nodes to Gauss-Legendre sums of 60 x 60 points, right
 * to 1e-9. */
static double contact_speed(double a, double b)
{
  const double x = (a - b) / (a + b), z = x * x;
  return sqrt(a + b) * (0.8139898469 - z * (0.0023367305 + z * (3.8942257e-5 + z * 1.5534e-6)));
}

/* Densities of bond length, one for each mass that occurs, at most one for each kind; returns the number of masses. */
static uint32_t densities_by_mass(const struct model *model, struct density *density)
{
  const double volume = box_volume(&model->box);
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct fiber_kind *kind = &model->kind[k];
    density[k] = (struct density){kind->mass, kind->count * fiber_contour(kind) / volume};
  }
  qsort(density, model->kinds, sizeof *density, compare_masses);
  uint32_t masses = 0;
  for (uint32_t k = 0; k < model->kinds; k++)
    if (masses > 0 && density[masses - 1].mass == density[k].mass)
      density[masses - 1].length += density[k].length;
    else
      density[masses++] = density[k];
  return masses;
}

double theory_collision_rate(const struct model *model)
{
  struct density *density = model->kinds > 0 ? calloc(model->kinds, sizeof *density) : NULL;
  if (!density)
    return model->kinds > 0 ? NAN : 0.0;
  const uint32_t masses = densities_by_mass(model, density);
  double sum = 0.0;
  for (uint32_t a = 0; a < masses; a++)
    for (uint32_t b = 0; b < masses; b++)
      sum += density[a].length * density[b].length * contact_speed(1.0 / density[a].mass, 1.0 / density[b].mass);
  free(density);
  return 0.5 * box_volume(&model->box) * sum * 0.25 * pi * sqrt(2.0 / pi);
}

/* Of two bonds with n bonds between them; other: 1/n' of those on the other side of a ring. By the midpoint rule. */
static double self_contact(double n, double other, double variance, double mass)
{
  enum { POINTS = 24 };
  double sum = 0.0;
  for (int i = 0; i < POINTS; i++)
    for (int j = 0; j < POINTS; j++) {
      const double s = (i + 0.5) / POINTS, t = (j + 0.5) / POINTS, g[2] = {1.0 - s, t}, h[2] = {s, 1.0 - t};
      const double a = 1.0 + g[0] * g[0] / n + h[0] * h[0] * other, b = 1.0 + g[1] * g[1] / n + h[1] * h[1] * other;
      const double c = g[0] * g[1] / n + h[0] * h[1] * other, determinant = a * b - c * c;
      sum += sqrt((1.0 - s) * (1.0 - s) + s * s + (1.0 - t) * (1.0 - t) + t * t) / (determinant * determinant);
    }
  const double spread = 2.0 * pi * variance * n / (1.0 + (n + 2.0) * other);
  return 2.0 * variance * sqrt(2.0 / (pi * mass)) * sum / (POINTS * POINTS) / (spread * sqrt(spread));
}

double theory_self_collision_rate(const struct fiber_kind *kind)
{
  if (kind->bending > 0.0)
    return 0.0;
  enum { ALONE = 64 }; /* from here on, neighboring n are summed in one term, which changes the sum by less than 1e-4 */
  const double bonds = fiber_bonds(kind), variance = theory_bond_square(kind) / 3.0;
  const uint32_t end = kind->vertices < 2 ? 0 : kind->vertices - 2; /* n below it, in chains and in rings */
  double rate = 0.0;
  uint32_t width = 1;
  for (uint32_t n = 1; n < end; n += width) {
    width = n < ALONE ? 1 : n / ALONE;
    const double last = fmin((double)n + width, end), middle = 0.5 * (n + last - 1.0);
    const double other = kind->ring ? 1.0 / (bonds - 2.0 - middle) : 0.0;
    const double pairs = kind->ring ? 0.5 * bonds : bonds - 1.0 - middle;
    rate += (last - n) * pairs * self_contact(middle, other, variance, kind->mass);
  }
  return kind->count * rate;
}

double theory_contact_rate(const struct model *model)
{
  double rate = theory_collision_rate(model);
  for (uint32_t k = 0; k < model->kinds; k++)
    rate += theory_self_collision_rate(&model->kind[k]);
  return rate;
}

double theory_executed_rate(const struct model *model)
{
  return (model->crossing.rule == CROSSING_SEQUENTIAL ? 1.15 : 1.0) * theory_contact_rate(model);
}

struct vec3 theory_net_force(const struct model *model)
{
  const bool uniform = model->solvent.profile == PROFILE_UNIFORM; /* that of a profile has the mean 0 */
  struct vec3 force = vec3_scale(uniform ? model->solvent.particles : 0.0, model->solvent.acceleration);
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct fiber_kind *kind = &model->kind[k];
    force = vec3_add_scaled(force, (double)kind->count * kind->vertices, kind->force);
  }
  return force;
}
