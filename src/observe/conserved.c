#include "observe/conserved.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/exact_sum.h"
#include "base/memory.h"
#include "fiber/force.h"
#include "fluid/fluid.h"
#include "medium/repulsion.h"
#include "observe/background.h"
#include "observe/observer.h"
#include "system/bead.h"
#include "wall/motion.h"

#define LARGEST_VELOCITY 0x1p17

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

/* Walls, shear or a force make the mean velocity depend on y. */
static bool flows(const struct model *model)
{
  return model_has_walls(model) || model_is_sheared(model) || model->solvent.profile != PROFILE_UNIFORM;
}

/* Sums over particles, in one slab or in all. */
struct slab {
  uint32_t n;
  struct exact_sum v[3], squares[3];
};

static void slab_add(struct slab *slab, struct vec3 velocity)
{
  const double v[3] = {velocity.x, velocity.y, velocity.z};
  slab->n++;
  for (int k = 0; k < 3; k++) {
    exact_add(&slab->v[k], v[k]);
    exact_add(&slab->squares[k], v[k] * v[k]);
  }
}

/* Sum of the squares about the mean, of one component. */
static double slab_within(const struct slab *slab, int k)
{
  const double sum = exact_value(&slab->v[k]);
  return exact_value(&slab->squares[k]) - sum * sum / slab->n;
}

enum { SOME = 256 };

/* M w^2/2 of a vertex, w: relative to the mean velocity of the solvent in its slab. That mean has a variance itself, as
 * if the n particles were one of mass n, which is taken out. A vertex beyond a sheared box has the velocity of its
 * image in the box. Without solvent there: relative to the flow of the boundary. */
static double kinetic_in_slab(const struct model *model, const struct state *state, const struct slab *slab, uint32_t i,
                              struct vec3 v)
{
  const int64_t y = state->position[i].y, image = lattice_image(y, model->box.edge[1]),
                row = box_inside(&model->box, 1, y) >> LATTICE_BITS, cells = model->box.cells[1];
  const struct slab *s = &slab[row < cells ? row : cells - 1];
  if (s->n == 0) {
    const struct vec3 w = vec3_sub(v, background_flow(model, state, (double)y * LATTICE_UNIT));
    return 0.5 * model->mass[i] * vec3_dot(w, w);
  }
  if (model_is_sheared(model))
    v.x -= (double)image * shear_rate(model, shear_interval(model, state->solvent_time + state->solvent_lag)) *
           model->box.cells[1];
  const double n = 1.0 / s->n, mass = model->mass[i];
  const struct vec3 sum = {exact_value(&s->v[0]), exact_value(&s->v[1]), exact_value(&s->v[2])},
                    w = vec3_add_scaled(v, -n, sum);
  return 0.5 * mass * vec3_dot(w, w) / (1.0 + mass * n);
}

static void measure_vertices_in_slabs(const struct model *model, const struct state *state, const struct vec3 *force,
                                      const struct slab *slab, struct motion *m)
{
  const double half = 0.5 * model->time_step;
  for (uint32_t i = 0; i < state->vertices; i++) {
    const struct vec3 ahead = state->velocity[i],
                      now = vec3_add_scaled(ahead, -half * model->inverse_mass[i], force[i]);
    m->vertex.about_flow += kinetic_in_slab(model, state, slab, i, now);
    m->vertex_half.about_flow += kinetic_in_slab(model, state, slab, i, ahead);
  }
}

/* About the linear flow of a sheared box, of velocities taken back by this time; a mean that is kept is taken out. */
static double kinetic_in_shear(const struct model *model, const struct state *state, const struct vec3 *force,
                               double back)
{
  struct vec3 momentum = {0, 0, 0};
  double kinetic = 0.0, mass = 0.0;
  for (uint32_t i = 0; i < state->vertices; i++) {
    const struct vec3 v = vec3_add_scaled(state->velocity[i], -back * model->inverse_mass[i], force[i]);
    const double y = (double)state->position[i].y * LATTICE_UNIT + (0.5 * model->time_step - back) * v.y;
    const struct vec3 w = vec3_sub(v, background_flow(model, state, y));
    kinetic += 0.5 * model->mass[i] * vec3_dot(w, w);
    momentum = vec3_add_scaled(momentum, model->mass[i], w);
    mass += model->mass[i];
  }
  return kinetic - (model_keeps_momentum(model) ? 0.5 * vec3_dot(momentum, momentum) / mass : 0.0);
}

/* Where the solvent flows, or is not free between collisions: positions and velocities of now, and slabs along y:
 * [cells], all zero. back: by which time velocities are taken back under the forces of pairs, t0. */
static void measure_slabs(const struct model *model, const struct state *state, const struct vec3 *force,
                          const struct vec3 *pair, double back, struct slab *slab, struct motion *m,
                          struct solvent_motion *of)
{
  const int64_t cells = model->box.cells[1];
  struct slab all = {0};
  bool bad = false;
  for (uint32_t first = 0; first < state->solvent.n; first += SOME) {
    const uint32_t n = state->solvent.n - first < SOME ? state->solvent.n - first : SOME;
    struct point at[SOME];
    struct vec3 v[SOME];
    fluid_of(model)->now(state, model, first, n, at, v);
    for (uint32_t i = 0; pair && i < n; i++)
      v[i] = vec3_add_scaled(v[i], -back, pair[state->solvent.id[first + i]]);
    for (uint32_t i = 0; i < n; i++) {
      const int64_t row = at[i].y >> LATTICE_BITS;
      const bool wild =
          !(fabs(v[i].x) < LARGEST_VELOCITY && fabs(v[i].y) < LARGEST_VELOCITY && fabs(v[i].z) < LARGEST_VELOCITY);
      const struct vec3 tame = wild ? (struct vec3){0, 0, 0} : v[i];
      bad |= wild;
      slab_add(&slab[row < cells ? row : cells - 1], tame); /* on the upper wall */
      slab_add(&all, tame);
    }
  }
  double sum[3], squares[3], within[3] = {0};
  for (int k = 0; k < 3; k++) {
    sum[k] = bad ? NAN : exact_value(&all.v[k]);
    squares[k] = bad ? NAN : exact_value(&all.squares[k]);
    for (int64_t row = 0; row < cells; row++)
      within[k] += bad ? NAN : slab[row].n > 0 ? slab_within(&slab[row], k) : 0.0;
  }
  m->slabs = 0;
  for (int64_t row = 0; row < cells && flows(model); row++)
    m->slabs += slab[row].n > 0;
  m->vertex.about_flow = m->vertex_half.about_flow = 0.0;
  if (m->slabs > 0)
    measure_vertices_in_slabs(model, state, force, slab, m);
  *of = (struct solvent_motion){.sum = {sum[0], sum[1], sum[2]},
                                .squares = {squares[0], squares[1], squares[2]},
                                .slab_squares = {within[0], within[1], within[2]}};
}

/* All is NAN if memory is short. */
static void measure_now(const struct model *model, const struct state *state, const struct vec3 *force,
                        const struct vec3 *pair, double back, struct motion *m, struct solvent_motion *of)
{
  const struct vec3 unknown = {NAN, NAN, NAN};
  struct slab *slab = calloc((size_t)model->box.cells[1], sizeof *slab);
  if (slab)
    measure_slabs(model, state, force, pair, back, slab, m, of);
  else
    *of = (struct solvent_motion){unknown, unknown, unknown};
  free(slab);
}

/* The bead's velocity is that of the half step ahead; solvent and vertices have half of the counterforce of a step to
 * come (system/bead.h). */
static struct vec3 counter_gain(const struct model *model, const struct state *state)
{
  return vec3_scale(0.5 * model->time_step, bead_counter(state, model));
}

static void measure_solvent(const struct model *model, const struct state *state, const struct vec3 *force,
                            const struct vec3 *pair, struct motion *m)
{
  if (flows(model) || model_has_dumbbells(model) || pair) {
    measure_now(model, state, force, pair, 0.5 * model->time_step, m, &m->solvent);
    m->colliding = m->solvent;
    if (pair && background_ahead(model) == 0.0)
      measure_now(model, state, force, pair, 0.0, m, &m->colliding);
    return;
  }
  const struct vec3 gain = vec3_add(fluid_gain(state, model), counter_gain(model, state));
  solvent_component(state, state->solvent.vx, gain.x, &m->solvent.sum.x, &m->solvent.squares.x);
  solvent_component(state, state->solvent.vy, gain.y, &m->solvent.sum.y, &m->solvent.squares.y);
  solvent_component(state, state->solvent.vz, gain.z, &m->solvent.sum.z, &m->solvent.squares.z);
  m->colliding = m->solvent;
}

static void vertex_add(struct vertex_motion *sum, double mass, struct vec3 v)
{
  sum->kinetic += 0.5 * mass * vec3_dot(v, v);
  sum->momentum = vec3_add_scaled(sum->momentum, mass, v);
}

static struct vertex_motion measure_bead(const struct model *model, const struct state *state)
{
  struct vertex_motion m = {.kinetic = 0.0};
  const struct vec3 velocity = bead_velocity_now(state, model);
  vertex_add(&m, model->bead.mass, velocity);
  return m;
}

static void measure_vertices(const struct model *model, const struct state *state, struct vec3 *force,
                             const struct vec3 *pair, struct motion *m)
{
  struct fault ignored = {FAULT_NONE, 0, 0, 0.0,
                          0.0}; /* a bond too long for the box stops the run, not its observers */
  fiber_forces(state, model, force, state->step, &ignored);
  const double half = 0.5 * model->time_step;
  const struct vec3 gain = counter_gain(model, state);
  for (uint32_t i = 0; pair && i < state->vertices; i++)
    force[i] = vec3_add(force[i], pair[state->solvent.n + i]);
  for (uint32_t i = 0; i < state->vertices; i++) {
    const struct vec3 ahead = vec3_add(state->velocity[i], gain);
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
  struct repulsion_sums pairs;
  struct vec3 *pair;
  const struct memory_need need = {(void **)&pair, model_repels(model) ? (size_t)state->solvent.n + state->vertices : 0,
                                   sizeof *pair};
  const bool known = memory_take(&need, 1) && repulsion_measure(state, model, pair, &pairs);
  measure_vertices(model, state, force, pair, &m);
  measure_solvent(model, state, force, pair, &m);
  m.linear = model_is_sheared(model) && m.slabs == 0;
  if (m.linear) {
    m.vertex.about_flow = kinetic_in_shear(model, state, force, 0.5 * model->time_step);
    m.vertex_half.about_flow = kinetic_in_shear(model, state, force, 0.0);
  }
  memory_release(&need, 1);
  m.pairs = known ? pairs.energy : NAN;
  if (model_has_dumbbells(model))
    m.bond += fluid_dumbbell_energy(state, model);
  if (state->beads > 0)
    m.bead = measure_bead(model, state);
  return m;
}

static struct conserved conserved_of(const struct motion *m)
{
  const double solvent = 0.5 * (m->solvent.squares.x + m->solvent.squares.y + m->solvent.squares.z);
  const double kinetic = solvent + m->vertex.kinetic;
  struct conserved c = {solvent,
                        m->vertex.kinetic,
                        m->bond,
                        m->bend,
                        m->pairs,
                        kinetic + m->bond + m->bend + m->pairs,
                        vec3_add(m->solvent.sum, m->vertex.momentum)};
  if (m->bead.kinetic > 0.0) {
    c.total += m->bead.kinetic;
    c.momentum = vec3_add(c.momentum, m->bead.momentum);
  }
  return c;
}

struct conserved observe_conserved(const struct model *model, const struct state *state)
{
  struct fiber scratch;
  if (!fiber_alloc(&scratch, model))
    return (struct conserved){NAN, NAN, NAN, NAN, NAN, NAN, {NAN, NAN, NAN}};
  const struct motion motion = motion_measure(model, state, scratch.force);
  fiber_free(&scratch);
  return conserved_of(&motion);
}

/* Sum of (v - u)^2 over n particles, from the sums of v^2 and v. */
static double squares_about(double squares, double sum, double n, double u)
{
  return squares - 2.0 * u * sum + n * u * u;
}

/* Temperature of vertices whose total mass is m, of n degrees of freedom, about u; where the solvent flows, about the
 * mean of its slabs, or the linear flow. */
static double vertex_temperature(const struct motion *m, const struct vertex_motion *v, double mass, double freedom,
                                 struct vec3 u)
{
  if (m->slabs > 0 || m->linear)
    return 2.0 * v->about_flow / freedom;
  return 2.0 * (v->kinetic - vec3_dot(u, v->momentum) + 0.5 * mass * vec3_dot(u, u)) / freedom;
}

struct temperatures motion_temperatures(const struct model *model, const struct motion *m)
{
  const double n = model->solvent.particles, total = model->total_mass, vertices = total - n;
  /* A box by itself keeps its velocity, which takes a degree of freedom along each axis; a bath that takes momentum
   * up has the flow's. */
  const bool kept = model_keeps_momentum(model);
  const double moving = total + model->bead.mass; /* with a bead */
  const struct vec3 u = kept ? vec3_scale(1.0 / moving, conserved_of(m).momentum) : model->flow;
  const double solvent_freedom = n * (1.0 - 1.0 / moving);
  const double vertex_freedom =
      model->dimensions * (model->vertices - (kept && m->slabs == 0 ? vertices / total : 0.0));
  const struct solvent_motion *s = &m->colliding;
  const struct vec3 squares = {squares_about(s->squares.x, s->sum.x, n, u.x),
                               squares_about(s->squares.y, s->sum.y, n, u.y),
                               squares_about(s->squares.z, s->sum.z, n, u.z)};
  const struct vec3 solvent =
      m->slabs > 0 ? vec3_scale(1.0 / (n - m->slabs), s->slab_squares) : vec3_scale(1.0 / solvent_freedom, squares);
  if (model_is_overdamped(model)) /* there are no velocities */
    return (struct temperatures){solvent, NAN, NAN};
  return (struct temperatures){solvent, vertex_temperature(m, &m->vertex, vertices, vertex_freedom, u),
                               vertex_temperature(m, &m->vertex_half, vertices, vertex_freedom, u)};
}

/* --- the observers ----------------------------------------------------------------------------------------------- */

const struct motion *view_motion(struct view *view)
{
  if (!view->motion_known)
    view->motion = motion_measure(view->model, view->state, view->force);
  view->motion_known = true;
  return &view->motion;
}

static bool conserved_row(struct observer *observer, struct view *view, double *row)
{
  (void)observer;
  const struct conserved c = conserved_of(view_motion(view));
  const double values[] = {view_time(view), c.solvent_kinetic, c.vertex_kinetic, c.bond,       c.bend,
                           c.pairs,         c.total,           c.momentum.x,     c.momentum.y, c.momentum.z};
  memcpy(row, values, sizeof values);
  return true;
}

static const char *const conserved_columns[] = {
    "time", "solvent_kinetic", "vertex_kinetic", "bond", "bend", "pairs", "total", "px", "py", "pz"};

const struct observer_type conserved_observer = {
    .column = conserved_columns,
    .columns = sizeof conserved_columns / sizeof *conserved_columns,
    .row = conserved_row,
};

static bool temperature_row(struct observer *observer, struct view *view, double *row)
{
  (void)observer;
  const struct temperatures t = motion_temperatures(view->model, view_motion(view));
  const double mean = (t.solvent.x + t.solvent.y + t.solvent.z) / view->model->dimensions;
  const double values[] = {view_time(view), mean, t.solvent.x, t.solvent.y, t.solvent.z, t.vertex, t.vertex_half};
  memcpy(row, values, sizeof values);
  return true;
}

static const char *const temperature_columns[] = {"time",      "solvent", "solvent_x",       "solvent_y",
                                                  "solvent_z", "vertex",  "vertex_half_step"};

const struct observer_type temperature_observer = {
    .column = temperature_columns,
    .columns = sizeof temperature_columns / sizeof *temperature_columns,
    .row = temperature_row,
};
