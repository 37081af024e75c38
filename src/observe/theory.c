#include "observe/theory.h"

#include "fiber/start.h"

static const double pi = 3.14159265358979323846;

/* --- solvent ----------------------------------------------------------------------------------------------------- */

double theory_partners(double gamma)
{
  return gamma + expm1(-gamma);
}

/* 2 cos^2 - 1 */
static double cosine_of_twice(double cosine)
{
  return 2.0 * cosine * cosine - 1.0;
}

/* D or eta_kin of whatever keeps the share `retention` per collision: the Green-Kubo sum 1/2 + c + c^2 + ... */
static double green_kubo(double retention)
{
  return 1.0 / (1.0 - retention) - 0.5;
}

double theory_viscosity_kinetic(double gamma, double cosine, double interval)
{
  double angular = 4.0 - 2.0 * cosine - 2.0 * cosine_of_twice(cosine);
  return gamma * interval * (5.0 * gamma / (theory_partners(gamma) * angular) - 0.5);
}

double theory_viscosity_collisional(double gamma, double cosine, double interval)
{
  return (1.0 - cosine) / (18.0 * interval) * theory_partners(gamma);
}

double theory_viscosity(double gamma, double cosine, double interval)
{
  return theory_viscosity_kinetic(gamma, cosine, interval) + theory_viscosity_collisional(gamma, cosine, interval);
}

double theory_solvent_diffusion(double gamma, double cosine, double interval)
{
  return interval * green_kubo(1.0 - 2.0 / 3.0 * (1.0 - cosine) * theory_partners(gamma) / gamma);
}

double theory_schmidt(double gamma, double cosine, double interval)
{
  return theory_viscosity(gamma, cosine, interval) / gamma / theory_solvent_diffusion(gamma, cosine, interval);
}

double theory_sound_speed(bool isothermal)
{
  return isothermal ? 1.0 : sqrt(5.0 / 3.0);
}

double theory_mean_free_path(double interval)
{
  return interval;
}

/* --- a single vertex --------------------------------------------------------------------------------------------- */

double theory_vertex_retention(double mass, double gamma, double cosine)
{
  const int last = (int)(gamma + 40.0 * sqrt(gamma) + 40.0);
  double mean = 0.0;
  for (int n = 1; n <= last; n++)
    mean += exp(n * log(gamma) - gamma - lgamma(n + 1.0)) * n / (mass + n);
  return 1.0 - 2.0 / 3.0 * (1.0 - cosine) * mean;
}

double theory_vertex_diffusion(double mass, double gamma, double cosine, double interval)
{
  return interval / mass * green_kubo(theory_vertex_retention(mass, gamma, cosine));
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

double theory_bonds(const struct fiber_kind *kind)
{
  return kind->ring ? kind->vertices : kind->vertices - 1.0;
}

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
  return moment[4] / moment[2] / kind->spring;
}

double theory_bond_tail(const struct fiber_kind *kind, double limit)
{
  double all[5], beyond[5];
  bond_moments(kind, 0.0, all);
  bond_moments(kind, limit * sqrt(kind->spring), beyond);
  return beyond[2] / all[2];
}

double theory_bend_cosine(double bending)
{
  return bending < 1e-3 ? bending / 3.0 : 1.0 / tanh(bending) - 1.0 / bending;
}

double theory_contour(const struct fiber_kind *kind)
{
  return theory_bonds(kind) * fiber_mean_bond(kind);
}

double theory_length(const struct fiber_kind *kind)
{
  return kind->bond_length > 0.0 ? kind->vertices * kind->bond_length : theory_contour(kind);
}

double theory_persistence(const struct fiber_kind *kind)
{
  return kind->bond_length > 0.0 ? kind->bending * kind->bond_length : theory_effective_persistence(kind);
}

double theory_effective_persistence(const struct fiber_kind *kind)
{
  return kind->bending > 0.0 ? -fiber_mean_bond(kind) / log(theory_bend_cosine(kind->bending)) : 0.0;
}

/* sum_ij <R_i.R_j> over bonds, whose lengths and directions are independent: (n) <l^2> + 2 <l>^2 sum_d (n-d) <cos>^d.
 */
double theory_end_to_end_square(const struct fiber_kind *kind)
{
  const double mean = fiber_mean_bond(kind), cosine = theory_bend_cosine(kind->bending);
  const uint32_t n = kind->ring ? kind->vertices : kind->vertices - 1;
  double sum = 0.0, power = cosine;
  for (uint32_t d = 1; d < n && power > 1e-17; d++) {
    sum += (n - d) * power;
    power *= cosine;
  }
  return n * theory_bond_square(kind) + 2.0 * mean * mean * sum;
}

double theory_stretch_frequency(const struct fiber_kind *kind)
{
  if (kind->vertices < 2)
    return 0.0;
  double end = kind->ring ? 1.0 : cos(0.5 * pi / kind->vertices);
  return 2.0 * sqrt(kind->spring / kind->mass) * end;
}

/* True if lambda exceeds every eigenvalue of the n x n matrix with rows ... 1 -4 6 -4 1 ...: all pivots of lambda - A
 * are positive then (its Cholesky factor exists). */
static bool exceeds_fourth_difference(double lambda, uint32_t n)
{
  double pivot[2] = {1.0, 1.0}, first = 0.0, second = 0.0; /* two pivots back; l(i,i-1) d(i-1) of last row */
  double carried = 0.0;                                    /* l(i-1,i-2) */
  for (uint32_t i = 0; i < n; i++) {
    second = i >= 2 ? -1.0 / pivot[0] : 0.0;
    first = i >= 1 ? (4.0 - second * pivot[0] * carried) / pivot[1] : 0.0;
    double d = lambda - 6.0 - second * second * pivot[0] - first * first * pivot[1];
    if (!(d > 0.0))
      return false;
    pivot[0] = pivot[1];
    pivot[1] = d;
    carried = first;
  }
  return true;
}

/* Largest eigenvalue of D D^T, D the second differences of n + 2 points of a free chain. Beyond a thousand points it is
 * 16 to five digits. */
static double largest_fourth_difference(uint32_t n)
{
  double low = 0.0, high = 16.0;
  for (int halving = 0; halving < 60 && n < 1000; halving++) {
    double middle = 0.5 * (low + high);
    if (exceeds_fourth_difference(middle, n))
      high = middle;
    else
      low = middle;
  }
  return high;
}

double theory_bend_frequency(const struct fiber_kind *kind)
{
  if (kind->vertices < 3)
    return 0.0;
  double lambda = kind->ring ? 16.0 : largest_fourth_difference(kind->vertices - 2);
  return sqrt(kind->bending * lambda / kind->mass) / fiber_mean_bond(kind);
}

double theory_highest_frequency(const struct fiber_kind *kind)
{
  const double stretch = theory_stretch_frequency(kind), bend = theory_bend_frequency(kind);
  const double tension = fmax(0.0, 1.0 - kind->bond_length / fiber_mean_bond(kind));
  return fmax(stretch, sqrt(bend * bend + tension * stretch * stretch));
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

/* int ds ds' sqrt(w(s) a + w(s') b) over the unit square, w(s) = (1-s)^2 + s^2, by the midpoint rule (error 1e-4). */
static double contact_speed(double a, double b)
{
  enum { POINTS = 32 };
  double sum = 0.0;
  for (int i = 0; i < POINTS; i++)
    for (int j = 0; j < POINTS; j++) {
      double s = (i + 0.5) / POINTS, t = (j + 0.5) / POINTS;
      sum += sqrt(((1.0 - s) * (1.0 - s) + s * s) * a + ((1.0 - t) * (1.0 - t) + t * t) * b);
    }
  return sum / (POINTS * POINTS);
}

double theory_collision_rate(const struct model *model)
{
  const double volume = box_volume(&model->box);
  double sum = 0.0;
  for (uint32_t a = 0; a < model->kinds; a++)
    for (uint32_t b = 0; b < model->kinds; b++) {
      const struct fiber_kind *ka = &model->kind[a], *kb = &model->kind[b];
      sum += ka->count * theory_contour(ka) / volume * kb->count * theory_contour(kb) / volume *
             contact_speed(1.0 / ka->mass, 1.0 / kb->mass);
    }
  return 0.5 * volume * sum * 0.25 * pi * sqrt(2.0 / pi);
}

struct vec3 theory_net_force(const struct model *model)
{
  struct vec3 force = vec3_scale(model->solvent.particles, model->solvent.acceleration);
  for (uint32_t k = 0; k < model->kinds; k++) {
    const struct fiber_kind *kind = &model->kind[k];
    force = vec3_add_scaled(force, (double)kind->count * kind->vertices, kind->force);
  }
  return force;
}
