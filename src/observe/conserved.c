#include "observe/conserved.h"

#include <math.h>
#include <string.h>

#include "fiber/force.h"
#include "fluid/fluid.h"
#include "observe/observer.h"

/* A sum that does not depend on the order of its terms: each is split into a multiple of 2^-16 and a multiple of 2^-50
 * (rounded), and integers are summed. Terms below 2^34; 2^29 terms. */
struct exact_sum {
  int64_t coarse, fine;
};

#define COARSE_SCALE 0x1p16
#define COARSE_UNIT 0x1p-16
#define FINE_SCALE 0x1p50
#define FINE_UNIT 0x1p-50
#define LARGEST_VELOCITY 0x1p17

static inline void exact_add(struct exact_sum *sum, double x)
{
  const double coarse =
      (x * COARSE_SCALE + 0x1.8p52) - 0x1.8p52; /* the integer that lattice_round gives, as a double */
  sum->coarse += lattice_round(x * COARSE_SCALE);
  sum->fine += lattice_round((x - coarse * COARSE_UNIT) * FINE_SCALE);
}

static double exact_value(const struct exact_sum *sum)
{
  return (double)sum->coarse * COARSE_UNIT + (double)sum->fine * FINE_UNIT;
}

/* Sums of v and v^2 of one component, v = velocity + gain. */
static void solvent_component(const struct state *state, const double *velocity, double gain, double *sum,
                              double *squares)
{
  struct exact_sum s = {0, 0}, s2 = {0, 0};
  uint32_t bad = 0;
  for (uint32_t i = 0; i < state->solvent.n; i++) {
    const double v = velocity[i] + gain;
    const uint32_t wild = !(fabs(v) < LARGEST_VELOCITY);
    bad |= wild;
    exact_add(&s, wild ? 0.0 : v);
    exact_add(&s2, wild ? 0.0 : v * v);
  }
  *sum = bad ? NAN : exact_value(&s);
  *squares = bad ? NAN : exact_value(&s2);
}

/* Where velocities change in flight by more than the body force, they are those of now. */
static bool flies_freely(const struct model *model, const struct state *state)
{
  return state->solvent_lag == 0 || !(model_has_walls(model) || model_is_sheared(model) || model_has_dumbbells(model));
}

enum { SOME = 256 };

static void measure_solvent_now(const struct model *model, const struct state *state, struct motion *m)
{
  struct exact_sum s[3] = {{0, 0}}, s2[3] = {{0, 0}};
  bool bad = false;
  for (uint32_t first = 0; first < state->solvent.n; first += SOME) {
    struct vec3 now[SOME];
    const uint32_t n = state->solvent.n - first < SOME ? state->solvent.n - first : SOME;
    fluid_of(model)->now(state, model, first, n, NULL, now);
    for (uint32_t i = 0; i < n; i++) {
      const double v[3] = {now[i].x, now[i].y, now[i].z};
      for (int k = 0; k < 3; k++) {
        const bool wild = !(fabs(v[k]) < LARGEST_VELOCITY);
        bad |= wild;
        exact_add(&s[k], wild ? 0.0 : v[k]);
        exact_add(&s2[k], wild ? 0.0 : v[k] * v[k]);
      }
    }
  }
  m->solvent_sum =
      bad ? (struct vec3){NAN, NAN, NAN} : (struct vec3){exact_value(&s[0]), exact_value(&s[1]), exact_value(&s[2])};
  m->solvent_squares =
      bad ? (struct vec3){NAN, NAN, NAN} : (struct vec3){exact_value(&s2[0]), exact_value(&s2[1]), exact_value(&s2[2])};
}

static void measure_solvent(const struct model *model, const struct state *state, struct motion *m)
{
  if (!flies_freely(model, state)) {
    measure_solvent_now(model, state, m);
    return;
  }
  const struct vec3 gain = fluid_gain(state, model);
  solvent_component(state, state->solvent.vx, gain.x, &m->solvent_sum.x, &m->solvent_squares.x);
  solvent_component(state, state->solvent.vy, gain.y, &m->solvent_sum.y, &m->solvent_squares.y);
  solvent_component(state, state->solvent.vz, gain.z, &m->solvent_sum.z, &m->solvent_squares.z);
}

static void vertex_add(struct vertex_motion *sum, double mass, struct vec3 v)
{
  sum->kinetic += 0.5 * mass * vec3_dot(v, v);
  sum->momentum = vec3_add_scaled(sum->momentum, mass, v);
}

static void measure_vertices(const struct model *model, const struct state *state, struct vec3 *force, struct motion *m)
{
  struct fault ignored = {FAULT_NONE, 0, 0, 0.0,
                          0.0}; /* a bond too long for the box stops the run, not its observers */
  fiber_forces(state, model, force, state->step, &ignored);
  const double half = 0.5 * model->time_step;
  for (uint32_t i = 0; i < state->vertices; i++) {
    const struct vec3 ahead = state->velocity[i];
    vertex_add(&m->vertex_half, model->mass[i], ahead);
    vertex_add(&m->vertex, model->mass[i], vec3_add_scaled(ahead, -half * model->inverse_mass[i], force[i]));
  }
  const struct fiber_energy energy = fiber_energies(state, model);
  m->bond = energy.bond;
  m->bend = energy.bend;
}

struct motion motion_measure(const struct model *model, const struct state *state, struct vec3 *force)
{
  struct motion m = {.bond = 0.0};
  measure_solvent(model, state, &m);
  measure_vertices(model, state, force, &m);
  if (model_has_dumbbells(model))
    m.bond += fluid_dumbbell_energy(state, model);
  return m;
}

static struct conserved conserved_of(const struct motion *m)
{
  const double solvent = 0.5 * (m->solvent_squares.x + m->solvent_squares.y + m->solvent_squares.z);
  const double kinetic = solvent + m->vertex.kinetic;
  return (struct conserved){solvent, m->vertex.kinetic,           m->bond,
                            m->bend, kinetic + m->bond + m->bend, vec3_add(m->solvent_sum, m->vertex.momentum)};
}

struct conserved observe_conserved(const struct model *model, const struct state *state)
{
  struct fiber scratch;
  if (!fiber_alloc(&scratch, model))
    return (struct conserved){NAN, NAN, NAN, NAN, NAN, {NAN, NAN, NAN}};
  const struct motion motion = motion_measure(model, state, scratch.force);
  fiber_free(&scratch);
  return conserved_of(&motion);
}

/* Sum of (v - u)^2 over n particles, from the sums of v^2 and v. */
static double squares_about(double squares, double sum, double n, double u)
{
  return squares - 2.0 * u * sum + n * u * u;
}

/* Temperature of vertices whose total mass is m, of n degrees of freedom, about u. */
static double vertex_temperature(const struct vertex_motion *v, double mass, double freedom, struct vec3 u)
{
  return 2.0 * (v->kinetic - vec3_dot(u, v->momentum) + 0.5 * mass * vec3_dot(u, u)) / freedom;
}

struct temperatures motion_temperatures(const struct model *model, const struct motion *m)
{
  const double n = model->solvent.particles, total = model->total_mass, vertices = total - n;
  /* A box by itself keeps its velocity, which takes a degree of freedom along each axis; a bath of phantoms has the
   * flow's. */
  const bool kept = !model_has_phantoms(model);
  const struct vec3 u = kept ? vec3_scale(1.0 / total, vec3_add(m->solvent_sum, m->vertex.momentum)) : model->flow;
  const double solvent_freedom = n * (1.0 - 1.0 / total);
  const double vertex_freedom = model->dimensions * (model->vertices - (kept ? vertices / total : 0.0));
  const struct vec3 squares = {squares_about(m->solvent_squares.x, m->solvent_sum.x, n, u.x),
                               squares_about(m->solvent_squares.y, m->solvent_sum.y, n, u.y),
                               squares_about(m->solvent_squares.z, m->solvent_sum.z, n, u.z)};
  return (struct temperatures){vec3_scale(1.0 / solvent_freedom, squares),
                               vertex_temperature(&m->vertex, vertices, vertex_freedom, u),
                               vertex_temperature(&m->vertex_half, vertices, vertex_freedom, u)};
}

/* --- the observers ----------------------------------------------------------------------------------------------- */

const struct motion *view_motion(struct view *view)
{
  if (!view->motion_known)
    view->motion = motion_measure(view->model, view->state, view->force);
  view->motion_known = true;
  return &view->motion;
}

static void conserved_row(struct observer *observer, struct view *view, double *row)
{
  (void)observer;
  const struct conserved c = conserved_of(view_motion(view));
  const double values[] = {view_time(view), c.solvent_kinetic, c.vertex_kinetic, c.bond,      c.bend,
                           c.total,         c.momentum.x,      c.momentum.y,     c.momentum.z};
  memcpy(row, values, sizeof values);
}

static const char *const conserved_columns[] = {
    "time", "solvent_kinetic", "vertex_kinetic", "bond", "bend", "total", "px", "py", "pz"};

const struct observer_type conserved_observer = {
    .column = conserved_columns,
    .columns = sizeof conserved_columns / sizeof *conserved_columns,
    .row = conserved_row,
};

static void temperature_row(struct observer *observer, struct view *view, double *row)
{
  (void)observer;
  const struct temperatures t = motion_temperatures(view->model, view_motion(view));
  const double mean = (t.solvent.x + t.solvent.y + t.solvent.z) / view->model->dimensions;
  const double values[] = {view_time(view), mean, t.solvent.x, t.solvent.y, t.solvent.z, t.vertex, t.vertex_half};
  memcpy(row, values, sizeof values);
}

static const char *const temperature_columns[] = {"time",      "solvent", "solvent_x",       "solvent_y",
                                                  "solvent_z", "vertex",  "vertex_half_step"};

const struct observer_type temperature_observer = {
    .column = temperature_columns,
    .columns = sizeof temperature_columns / sizeof *temperature_columns,
    .row = temperature_row,
};
