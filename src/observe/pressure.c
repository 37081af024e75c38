/*
 * The pressure tensor and the configurational temperature, at the step of the row:
 *
 *   p_ab = (1/V) [sum of m w_a w_b + sum of r_a F_b + what contacts hand on],
 *   T = <sum of |grad U|^2>/<laplacian of U>
 *
 * (Rugh 1997; Butler, Ayton, Jepps and Evans, J. Chem. Phys. 109, 6519 (1998)). U is the energy of bonds, bends,
 * springs of dumbbells, and of the medium's pairs; w velocities relative to the flow of the place, of the time at which
 * collisions act (background.h). Means are what to compare: T of one row has a bias of the order of 1 over the number
 * of members. Fibers that stand still have no part in the second. What a scene must not be is in meaning.c.
 */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "fiber/force.h"
#include "fluid/fluid.h"
#include "medium/repulsion.h"
#include "observe/background.h"
#include "observe/handed_on.h"
#include "observe/observer.h"
#include "system/fiber_kind.h"

struct sums {
  double flow[STRESS_COMPONENTS]; /* kT: of m w_a w_b + r_a F_b */
  double potential, square, laplacian;
};

static void add_products(double sum[STRESS_COMPONENTS], double factor, struct vec3 a, struct vec3 b)
{
  sum[STRESS_XY] += factor * a.x * b.y;
  sum[STRESS_XX] += factor * a.x * b.x;
  sum[STRESS_YY] += factor * a.y * b.y;
  sum[STRESS_ZZ] += factor * a.z * b.z;
}

/* Of the energy of a bond, in the coordinates of one end: U'' + (d - 1) U'/r. */
static double bond_laplacian(const struct fiber_kind *k, int dimensions, double length)
{
  const double slope = k->bond_length == 0.0 ? k->spring : k->spring * (1.0 - k->bond_length / length);
  return k->spring + (dimensions - 1) * slope;
}

/* Of kappa (1 - cos), in the coordinates of those of the three vertices that are not held; a, b: the bonds. */
static double bend_laplacian(const struct fiber_kind *k, int dimensions, struct vec3 a, struct vec3 b,
                             const bool held[3])
{
  const double aa = vec3_dot(a, a), bb = vec3_dot(b, b), product = sqrt(aa * bb), cosine = vec3_dot(a, b) / product;
  const double turn = (dimensions - 1) * cosine, both = (dimensions - 2 + cosine * cosine) / product;
  const double of[3] = {turn / aa, turn * (1.0 / aa + 1.0 / bb) + 2.0 * both, turn / bb};
  double all = 2.0 * k->bending * (turn * (1.0 / aa + 1.0 / bb) + both);
  for (int i = 0; i < 3; i++)
    all -= held[i] ? k->bending * of[i] : 0.0;
  return all;
}

static void add_bonded(const struct model *model, const struct state *state, uint32_t v, struct sums *s)
{
  const struct fiber_kind *k = &model->kind[model->fiber_kind_of[model->fiber_of[v]]];
  if (model->next[v] < 0 || fiber_stands(k))
    return;
  const struct vec3 bond = fiber_bond(state, model, v);
  const bool here = model_is_held(model, v), there = model_is_held(model, (uint32_t)model->next[v]);
  s->laplacian += (2.0 - here - there) * bond_laplacian(k, (int)model->dimensions, vec3_norm(bond));
  if (k->bending == 0.0 || model->prev[v] < 0)
    return;
  const uint32_t prev = (uint32_t)model->prev[v];
  const bool held[3] = {model_is_held(model, prev), here, there};
  s->laplacian += bend_laplacian(k, (int)model->dimensions, fiber_bond(state, model, prev), bond, held);
}

/* bonded: forces of bonds and bends, and the constant one; pair: those of the medium's pairs, NULL without. */
static void add_vertices(const struct view *view, const struct vec3 *bonded, const struct vec3 *pair, struct sums *s)
{
  const struct model *model = view->model;
  const struct state *state = view->state;
  for (uint32_t v = 0; v < state->vertices; v++) {
    const uint32_t fiber = model->fiber_of[v];
    const struct vec3 outer = model->kind[model->fiber_kind_of[fiber]].force, inner = vec3_sub(bonded[v], outer),
                      more = pair ? pair[state->solvent.n + v] : (struct vec3){0, 0, 0},
                      all = vec3_add(bonded[v], more), grad = vec3_add(inner, more),
                      w = background_peculiar(model, state, v, all, background_flow);
    const struct point origin = state->position[model->fiber_first[fiber]];
    if (!model_is_overdamped(model))
      add_products(s->flow, model->mass[v], w, w);
    add_products(s->flow, 1.0, point_difference(state->position[v], origin), inner);
    s->square += model_is_held(model, v) ? 0.0 : vec3_dot(grad, grad);
    add_bonded(model, state, v, s);
  }
}

/* Sums are made in the order of numbers, so that they do not depend on the order in memory. by_number: [particles]. */
static void add_particles(const struct view *view, const struct vec3 *pair, struct vec3 *by_number, struct sums *s)
{
  const struct state *state = view->state;
  const struct model *model = view->model;
  const double back = background_ahead(model);
  for (uint32_t i = 0; i < state->solvent.n; i++) {
    struct point at;
    struct vec3 v;
    fluid_of(model)->now(state, model, i, 1, &at, &v);
    by_number[state->solvent.id[i]] = vec3_sub(v, background_flow(model, state, (double)at.y * LATTICE_UNIT));
  }
  for (uint32_t i = 0; i < state->solvent.n; i++) {
    const struct vec3 force = pair ? pair[i] : (struct vec3){0, 0, 0}, w = vec3_add_scaled(by_number[i], -back, force);
    add_products(s->flow, 1.0, w, w);
    s->square += vec3_dot(force, force);
  }
}

/* The same of springs, U = K r^2/2. by_number: [dumbbells] at least. */
static void add_springs(const struct view *view, struct vec3 *by_number, struct sums *s)
{
  const struct dumbbells *d = &view->state->dumbbells;
  const double spring = view->model->dumbbells.spring;
  for (uint32_t p = 0; p < d->n; p++)
    by_number[d->id[p]] = fluid_dumbbell_now(view->state, view->model, p);
  for (uint32_t p = 0; p < d->n; p++) {
    add_products(s->flow, -spring, by_number[p], by_number[p]);
    s->square += 2.0 * spring * spring * vec3_dot(by_number[p], by_number[p]);
    s->laplacian += 2.0 * view->model->dimensions * spring;
  }
}

static void add_pairs(const struct repulsion_sums *pairs, struct sums *s)
{
  for (int k = 0; k < STRESS_COMPONENTS; k++)
    s->flow[k] += pairs->virial[k];
  s->potential += pairs->energy;
  s->laplacian += pairs->laplacian;
}

static bool measure(struct view *view, struct sums *s)
{
  const struct model *model = view->model;
  const struct state *state = view->state;
  struct fault ignored = {.code = FAULT_NONE}; /* a bond too long for the box stops the run, not its observers */
  struct repulsion_sums pairs;
  struct vec3 *pair, *by_number;
  const size_t n = state->solvent.n, members = model_repels(model) ? n + state->vertices : 0;
  const struct memory_need need[] = {{(void **)&pair, members, sizeof *pair},
                                     {(void **)&by_number, n, sizeof *by_number}};
  if (!memory_take(need, 2))
    return false;
  const bool ok = repulsion_measure(state, model, pair, &pairs);
  if (state->vertices > 0)
    fiber_forces(state, model, view->force, state->step, &ignored);
  const struct fiber_energy energy = fiber_energies(state, model);
  s->potential = energy.bond + energy.bend + (state->dumbbells.n > 0 ? fluid_dumbbell_energy(state, model) : 0.0);
  add_vertices(view, view->force, pair, s);
  for (int k = STRESS_XX; k <= STRESS_ZZ && model_is_overdamped(model); k++)
    s->flow[k] += state->vertices; /* kT of each: velocities have been averaged over */
  add_particles(view, pair, by_number, s);
  add_springs(view, by_number, s);
  add_pairs(&pairs, s);
  memory_release(need, 2);
  return ok;
}

static double trace(const double p[STRESS_COMPONENTS], double dimensions)
{
  return p[STRESS_XX] + p[STRESS_YY] + (dimensions > 2 ? p[STRESS_ZZ] : 0.0);
}

/* With thick fibers the first row has no time to average over, and is left out. */
static bool pressure_row(struct observer *o, struct view *view, double *row)
{
  const struct model *model = view->model;
  const double volume = box_volume(&model->box), d = model->dimensions;
  struct sums s = {.potential = 0.0};
  double contacts[STRESS_COMPONENTS];
  if (!handed_on_mean(o, view, contacts))
    return false;
  const double unknown = measure(view, &s) ? 0.0 : NAN;
  double *p = s.flow;
  for (int k = 0; k < STRESS_COMPONENTS; k++)
    p[k] += contacts[k];
  const double values[] = {view_time(view),
                           unknown + trace(p, d) / (d * volume),
                           unknown + p[STRESS_XX] / volume,
                           unknown + p[STRESS_YY] / volume,
                           unknown + p[STRESS_ZZ] / volume,
                           unknown + p[STRESS_XY] / volume,
                           unknown + s.potential,
                           unknown + s.square,
                           unknown + s.laplacian,
                           unknown + s.square / s.laplacian,
                           trace(contacts, d) / (d * volume)};
  memcpy(row, values, sizeof values);
  return true;
}

static const char *const columns[] = {"time",
                                      "pressure",
                                      "p_xx",
                                      "p_yy",
                                      "p_zz",
                                      "p_xy",
                                      "potential",
                                      "force_square",
                                      "laplacian",
                                      "configurational",
                                      "pressure_contacts"};

const struct observer_type pressure_observer = {
    .column = columns,
    .columns = sizeof columns / sizeof *columns,
    .size = handed_on_size,
    .row = pressure_row,
    .contact = handed_on_add,
};
