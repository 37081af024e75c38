/*
 * Thick rods (fibers of one bond, a spherocylinder each) against kinetic theory: how often they touch, and with what
 * pressure.
 *
 * Where the first of two rods p, q lies, the other one's first end w may not be in the body |w + t q - s p| < D. Its
 * surface has faces (side on side) of the area 2 |p x q| in all, half cylinders along four edges (end on side), 2 pi D
 * (|p| + |q|), and parts of a sphere at four corners (end on end), 4 pi D^2. At low density all places on it are alike,
 * and the rods approach there with a normal velocity that is a Gaussian of variance kT c, c the sum of lever^2/M of the
 * four ends. So they touch at the rate
 *
 *     integral over the surface of sqrt(kT c/(2 pi))
 *
 * per pair and volume. The mean over equilibrium is a sum over random pairs here.
 *
 * A contact hands on the momentum J along the normal n, from the first rod to the other, whose center is at r from that
 * of the first. The pressure is P V = N kT + sum of J n.r/(3 t) (virial theorem), that is Z = 1 + B2 N/V + ... with
 *
 *     B2 = (2/3) pi D^3 + pi <l> D^2 + (pi/4) <l>^2 D.
 *
 * At a finite density both are larger by about G = (1 - phi/2)/(1 - phi)^3, phi the volume fraction (Parsons 1979, with
 * the contact value of hard spheres of Carnahan and Starling).
 */
#ifndef UNCROSS_RODS_H
#define UNCROSS_RODS_H

#include "../../tests/exact.h"
#include "step.h"

#define ROD_PI 3.14159265358979323846

/* <l^power> of the bond length: weight l^2 exp(-k (l - l0)^2/2). */
static inline double rod_length_moment(const struct fiber_kind *k, int power)
{
  const double width = 1.0 / sqrt(k->spring);
  double sum = 0.0, all = 0.0;
  for (int j = 0; j < 2000; j++) {
    const double l = k->bond_length + (j - 999.5) / 125.0 * width, x = (l - k->bond_length) / width;
    const double weight = l > 0.0 ? l * l * exp(-0.5 * x * x) : 0.0;
    sum += weight * pow(l, power), all += weight;
  }
  return sum / all;
}

static inline double rod_b2(double length, double diameter)
{
  return 2.0 / 3.0 * ROD_PI * pow(diameter, 3) + ROD_PI * length * diameter * diameter +
         ROD_PI / 4.0 * length * length * diameter;
}

static inline double rod_volume(double length, double diameter)
{
  return ROD_PI / 4.0 * diameter * diameter * length + ROD_PI / 6.0 * pow(diameter, 3);
}

static inline double rod_contact_value(double phi)
{
  return (1.0 - 0.5 * phi) / pow(1.0 - phi, 3);
}

/* Rates per pair, times the volume, of contacts with no end, one, two. Area and speed are independent: areas depend on
 * lengths and angle, speeds on the levers alone. */
struct rod_rates {
  double by_ends[3];
};

static inline double rod_root(double s, double t)
{
  return sqrt((1.0 - s) * (1.0 - s) + s * s + (1.0 - t) * (1.0 - t) + t * t);
}

static inline struct rod_rates rod_rates_expected(const struct fiber_kind *k)
{
  const int n = 400; /* midpoint rule: error below 1e-6 */
  const double length = rod_length_moment(k, 1), speed = sqrt(1.0 / (2.0 * ROD_PI * k->mass)), d = k->diameter;
  double face = 0.0, edge = 0.0;
  for (int i = 0; i < n; i++) {
    edge += rod_root((i + 0.5) / n, 1.0) / n;
    for (int j = 0; j < n; j++)
      face += rod_root((i + 0.5) / n, (j + 0.5) / n) / n / n;
  }
  return (struct rod_rates){{2.0 * ROD_PI / 4.0 * length * length * face * speed,
                             4.0 * ROD_PI * d * length * edge * speed, 4.0 * ROD_PI * d * d * rod_root(1, 1) * speed}};
}

/* --- a run that is watched ---------------------------------------------------------------------------------------- */

struct rod_watch {
  const struct model *model;
  const struct state *state;
  double contacts[3]; /* by the number of ends */
  double virial;      /* sum of J n.r, m a0^2/t0 */
};

static inline bool rod_end(double s)
{
  return s == 0.0 || s == 1.0;
}

/* The projection of bond `b` on the normal at the contact: its ends flew with the velocities before the impulse. */
static inline double rod_along(const struct rod_watch *w, const struct contact_event *e, uint32_t b,
                               const double lever[2])
{
  const uint32_t end[2] = {b, (uint32_t)w->model->next[b]};
  const double time = e->hit.time * w->model->time_step;
  double along[2];
  for (int k = 0; k < 2; k++) {
    const uint32_t i = end[k];
    const struct vec3 before =
        vec3_add_scaled(w->state->velocity[i], lever[k] * e->impulse * w->model->inverse_mass[i], e->hit.normal);
    along[k] = vec3_dot(vec3_add_scaled(point_in_a0(w->state->position[i]), time, before), e->hit.normal);
  }
  return along[1] - along[0];
}

static inline void rod_record(void *context, const struct contact_event *e)
{
  struct rod_watch *w = context;
  const double s = e->hit.s, t = e->hit.s_standing, mine[2] = {1.0 - s, s}, its[2] = {t - 1.0, -t};
  const double reach = (double)model_reach(w->model, e->moving_bond, e->standing_bond) * LATTICE_UNIT;
  w->contacts[rod_end(s) + rod_end(t)] += 1.0;
  w->virial += e->impulse * (reach + (s - 0.5) * rod_along(w, e, e->moving_bond, mine) -
                             (t - 0.5) * rod_along(w, e, e->standing_bond, its));
}

/* <v^2> M/3 of all vertices, kT. */
static inline double rod_temperature(const struct state *state, const struct model *model)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < state->vertices; i++)
    sum += model->mass[i] * vec3_dot(state->velocity[i], state->velocity[i]);
  return sum / 3.0 / state->vertices;
}

#endif
