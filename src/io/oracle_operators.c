#include "io/oracle_operators.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "fiber/force.h"
#include "fiber/sweep.h"
#include "io/oracle_columns.h"
#include "solvent/collide.h"
#include "solvent/solvent.h"

#define LONG_SWEEP 32.0 /* dt, or 16, 8, ... if no more fits into the box */

/* --- random numbers ---------------------------------------------------------------------------------------------- */

struct address {
  enum random_purpose purpose;
  uint32_t draw, entity;
  uint64_t step;
};

static const struct address addresses[] = {
    {RANDOM_GRID_SHIFT, 0, 0, 1},
    {RANDOM_GRID_SHIFT, 0, 0, 2},
    {RANDOM_GRID_SHIFT, 0, 0, 0x100000001},
    {RANDOM_ROTATION_AXIS, 0, 0, 2},
    {RANDOM_ROTATION_AXIS, 0, 1, 2},
    {RANDOM_ROTATION_AXIS, 1, 1, 2},
    {RANDOM_ROTATION_AXIS, 0, 59, 4},
    {RANDOM_ROTATION_AXIS, 0, 0x10005, 2},
    {RANDOM_VERTEX_ORDER, 0, 0, 1},
    {RANDOM_VERTEX_ORDER, 1, 0, 1},
    {RANDOM_VERTEX_ORDER, 0, 7, 1},
    {RANDOM_VELOCITY_SWAP, 0, 0, 2},
    {RANDOM_VELOCITY_SWAP, 0, 3, 2},
    {RANDOM_THERMOSTAT, 0, 5, 2},
    {RANDOM_THERMOSTAT, 1, 5, 2},
    {RANDOM_THERMOSTAT, 2, 5, 2},
    {RANDOM_SOLVENT_POSITION, 0, 11, 0},
    {RANDOM_SOLVENT_POSITION, 1, 11, 0},
    {RANDOM_SOLVENT_VELOCITY, 0, 11, 0},
    {RANDOM_SOLVENT_VELOCITY, 0, 0x3000007, 0},
    {RANDOM_VERTEX_VELOCITY, 0, 3, 0},
    {RANDOM_FIBER_POSITION, 0, 2, 0},
    {RANDOM_FIBER_DIRECTION, 0, 2, 0},
    {RANDOM_BOND_LENGTH, 0, 4, 0},
    {RANDOM_BEND, 0, 4, 0},
    {RANDOM_BEND_AZIMUTH, 0, 4, 0},
};
enum { ADDRESSES = sizeof addresses / sizeof *addresses };

static bool run_random(struct oracle_stage *g)
{
  int64_t *in = oracle_put_integers(g, "in.address", "purpose draw step entity", ADDRESSES);
  for (uint32_t k = 0; in && k < ADDRESSES; k++) {
    const struct address *a = &addresses[k];
    in[4 * k] = a->purpose, in[4 * k + 1] = a->draw, in[4 * k + 2] = (int64_t)a->step, in[4 * k + 3] = a->entity;
  }
  struct random_words words[ADDRESSES];
  for (uint32_t k = 0; k < ADDRESSES; k++) {
    const struct address *a = &addresses[k];
    words[k] = random_at(g->model->seed, a->purpose, a->draw, a->step, a->entity);
  }
  int64_t *word = oracle_put_integers(g, "out.word", "0 1 2 3", ADDRESSES);
  for (uint32_t k = 0; word && k < 4 * ADDRESSES; k++)
    word[k] = words[k / 4].w[k % 4];
  double *uniform = oracle_put_reals(g, "out.uniform", "0 1", ADDRESSES);
  for (uint32_t k = 0; uniform && k < 2 * ADDRESSES; k++)
    uniform[k] = random_uniform(words[k / 2], (int)(k % 2));
  double *normal = oracle_put_reals(g, "out.normal", "first second", ADDRESSES);
  for (uint32_t k = 0; normal && k < ADDRESSES; k++)
    random_normal_pair(words[k], &normal[2 * (size_t)k]);
  struct vec3 axis[ADDRESSES];
  for (uint32_t k = 0; k < ADDRESSES; k++)
    axis[k] = random_axis(g->model->seed, addresses[k].purpose, addresses[k].step, addresses[k].entity);
  oracle_put_vectors(g, "out.axis", axis, ADDRESSES);
  return true;
}

/* --- fibers ------------------------------------------------------------------------------------------------------ */

static bool run_order(struct oracle_stage *g)
{
  random_permutation(g->model->seed, RANDOM_VERTEX_ORDER, 0, g->place.step, g->state->vertices, g->work->fiber.order);
  oracle_put_counts(g, "out.order", "vertex", g->work->fiber.order, g->state->vertices);
  return true;
}

struct events {
  const struct state *state;
  const struct model *model;
  double time; /* of the moves */
  struct logged {
    struct sweep_event event;
    double condition;
  } * logged;
  uint32_t count;
  bool failed;
};

/* How much the data of a hit amplify rounding, from the state that its move found (docs/porting.md, Tolerances). */
static double condition_of(const struct events *e, const struct sweep_event *v)
{
  const struct model *m = e->model;
  const struct point *r = e->state->position;
  const bool first = v->moving_bond == v->vertex;
  const struct vec3 move = vec3_scale(e->time, e->state->velocity[v->vertex]);
  const struct vec3 ab = point_difference(r[m->next[v->standing_bond]], r[v->standing_bond]);
  const struct vec3 bond = point_difference(r[first ? (uint32_t)m->next[v->vertex] : v->moving_bond], r[v->vertex]);
  const struct vec3 p = vec3_add_scaled(bond, -v->hit.time, move);
  const double lengths = vec3_norm(ab) * (vec3_norm(bond) + vec3_norm(move));
  const double speed = fabs(vec3_dot(vec3_cross(ab, bond), move));
  const double cross = vec3_norm(vec3_cross(p, ab)), parallel = vec3_norm(p) * vec3_norm(ab) / cross;
  const double reach = vec3_norm(bond) + vec3_norm(ab) + vec3_norm(move);
  return (1.0 + lengths * reach / speed) * parallel * parallel * (1.0 + reach / fmin(vec3_norm(p), vec3_norm(ab)));
}

static void take_event(void *context, const struct sweep_event *event)
{
  struct events *e = context;
  struct logged *grown = realloc(e->logged, (e->count + 1) * sizeof *grown);
  e->failed |= !grown;
  if (grown) {
    e->logged = grown;
    e->logged[e->count++] = (struct logged){*event, condition_of(e, event)};
  }
}

/* The log tells an executed hit last of its move; sorted within a move as `earlier` does, the order is everybody's. */
static int by_time(const struct sweep_event *a, const struct sweep_event *b)
{
  if (a->hit.time != b->hit.time)
    return a->hit.time < b->hit.time ? -1 : 1;
  const int64_t mine[5] = {a->moving_bond, a->standing_bond, a->image[0], a->image[1], a->image[2]};
  const int64_t its[5] = {b->moving_bond, b->standing_bond, b->image[0], b->image[1], b->image[2]};
  for (int k = 0; k < 5; k++)
    if (mine[k] != its[k])
      return mine[k] < its[k] ? -1 : 1;
  return 0;
}

static void sort_moves(struct events *e)
{
  for (uint32_t k = 1; k < e->count; k++)
    for (uint32_t j = k; j > 0 && e->logged[j].event.vertex == e->logged[j - 1].event.vertex; j--) {
      if (by_time(&e->logged[j - 1].event, &e->logged[j].event) <= 0)
        break;
      struct logged swap = e->logged[j];
      e->logged[j] = e->logged[j - 1];
      e->logged[j - 1] = swap;
    }
}

static void put_events(struct oracle_stage *g, const struct events *e)
{
  int64_t *who =
      oracle_put_integers(g, "out.event", "vertex moving standing image_x image_y image_z executed", e->count);
  for (uint32_t k = 0; who && k < e->count; k++) {
    const struct sweep_event *v = &e->logged[k].event;
    const int64_t row[7] = {v->vertex,   v->moving_bond, v->standing_bond, v->image[0],
                            v->image[1], v->image[2],    v->executed};
    memcpy(&who[7 * (size_t)k], row, sizeof row);
  }
  double *how = oracle_put_reals(g, "out.hit", "time s s_standing normal_x normal_y normal_z momentum", e->count);
  for (uint32_t k = 0; how && k < e->count; k++) {
    const struct sweep_event *v = &e->logged[k].event;
    const struct vec3 n = v->hit.normal;
    const double row[7] = {v->hit.time, v->hit.s, v->hit.s_standing, n.x, n.y, n.z, v->momentum};
    memcpy(&how[7 * (size_t)k], row, sizeof row);
  }
  double *condition = oracle_put_reals(g, "bound.hit", "condition", e->count);
  for (uint32_t k = 0; condition && k < e->count; k++)
    condition[k] = e->logged[k].condition;
}

static bool sweep_for(struct oracle_stage *g, double fraction, uint32_t sweep)
{
  struct events events = {g->state, g->model, fraction * g->model->time_step, NULL, 0, false};
  const struct sweep_log log = {take_event, &events};
  random_permutation(g->model->seed, RANDOM_VERTEX_ORDER, sweep, g->place.step, g->state->vertices,
                     g->work->fiber.order);
  oracle_put_number(g, "in.time", "dt", events.time);
  oracle_put_counts(g, "in.order", "vertex", g->work->fiber.order, g->state->vertices);
  oracle_put_points(g, "in.position", g->state->position, g->state->vertices);
  oracle_put_vectors(g, "in.velocity", g->state->velocity, g->state->vertices);
  bool ok = fiber_sweep(g->state, g->model, g->work, fraction, g->place.step, sweep, &log);
  sort_moves(&events);
  put_events(g, &events);
  oracle_put_points(g, "out.position", g->state->position, g->state->vertices);
  oracle_put_vectors(g, "out.velocity", g->state->velocity, g->state->vertices);
  g->pack->failed |= events.failed;
  free(events.logged);
  return ok;
}

/* Positions and velocities of the vertices, to be put back. */
struct vertices {
  struct point *position;
  struct vec3 *velocity;
};

static void put_back(struct oracle_stage *g, const struct vertices *saved)
{
  const size_t n = g->state->vertices;
  memcpy(g->state->position, saved->position, n * sizeof *saved->position);
  memcpy(g->state->velocity, saved->velocity, n * sizeof *saved->velocity);
  g->work->fiber.neighbors.built = false;
}

/* True if no vertex of a sweep moves further than the box allows; exchanges can make one faster. All is put back. */
static bool moves_fit(struct oracle_stage *g, double fraction, const struct vertices *saved)
{
  const bool ok = fiber_sweep(g->state, g->model, g->work, fraction, g->place.step, 1, NULL);
  const bool fits = ok || g->work->fault.code != FAULT_VERTEX_MOVE;
  if (!fits)
    g->work->fault = (struct fault){0};
  put_back(g, saved);
  return fits;
}

/* Moves many times as long as the scene's, as long as the box allows: they cross often, several bonds at once. */
static bool run_long_sweep(struct oracle_stage *g)
{
  const size_t n = g->state->vertices;
  struct vertices saved = {malloc((n + 1) * sizeof *saved.position), malloc((n + 1) * sizeof *saved.velocity)};
  bool ok = saved.position && saved.velocity;
  g->pack->failed |= !ok;
  if (ok) {
    memcpy(saved.position, g->state->position, n * sizeof *saved.position);
    memcpy(saved.velocity, g->state->velocity, n * sizeof *saved.velocity);
    double fraction = LONG_SWEEP;
    while (fraction > 1.0 && !moves_fit(g, fraction, &saved))
      fraction *= 0.5;
    ok = sweep_for(g, fraction, 1);
    put_back(g, &saved);
  }
  free(saved.position);
  free(saved.velocity);
  return ok;
}

static bool run_sweep(struct oracle_stage *g)
{
  bool ok = sweep_for(g, 1.0, 0);
  g->state->solvent_lag += 2;
  return ok;
}

/* Forces of a model whose kinds keep only some of their constants. */
static bool put_forces(struct oracle_stage *g, bool springs, bool bends, bool body)
{
  struct model part = *g->model;
  part.kind = malloc((part.kinds + 1) * sizeof *part.kind);
  if (!part.kind)
    return false;
  for (uint32_t k = 0; k < part.kinds; k++) {
    part.kind[k] = g->model->kind[k];
    part.kind[k].spring *= springs;
    part.kind[k].bending *= bends;
    part.kind[k].force = vec3_scale(body, part.kind[k].force);
  }
  oracle_put_points(g, "in.position", g->state->position, g->state->vertices);
  bool ok = fiber_forces(g->state, &part, g->work, g->place.step);
  oracle_put_vectors(g, "out.force", g->work->fiber.force, g->state->vertices);
  free(part.kind);
  return ok;
}

static bool run_bond_force(struct oracle_stage *g)
{
  return put_forces(g, true, false, false);
}

static bool run_bend_force(struct oracle_stage *g)
{
  return put_forces(g, false, true, false);
}

static bool run_force(struct oracle_stage *g)
{
  return put_forces(g, true, true, true);
}

static bool run_kick(struct oracle_stage *g)
{
  oracle_put_number(g, "in.time", "dt", 0.5 * g->model->time_step);
  oracle_put_vectors(g, "in.velocity", g->state->velocity, g->state->vertices);
  oracle_put_vectors(g, "in.force", g->work->fiber.force, g->state->vertices);
  fiber_kick(g->state, g->model, g->work, 0.5);
  oracle_put_vectors(g, "out.velocity", g->state->velocity, g->state->vertices);
  return true;
}

/* --- solvent ----------------------------------------------------------------------------------------------------- */

static bool run_stream(struct oracle_stage *g)
{
  state_solvent_slots(g->state, g->slot);
  oracle_put_number(g, "in.time", "dt", 0.5 * g->state->solvent_lag * g->model->time_step);
  oracle_put_solvent_positions(g, "in.position");
  oracle_put_solvent_velocities(g, "in.velocity");
  bool ok = solvent_stream(g->state, g->model, g->work);
  oracle_put_solvent_positions(g, "out.position");
  oracle_put_solvent_velocities(g, "out.velocity");
  return ok;
}

static bool run_shift(struct oracle_stage *g)
{
  const struct point shift = solvent_grid_shift(g->model, g->place.step);
  oracle_put_points(g, "out.shift", &shift, 1);
  return true;
}

static bool run_bin(struct oracle_stage *g)
{
  const struct point shift = solvent_grid_shift(g->model, g->place.step);
  oracle_put_points(g, "in.shift", &shift, 1);
  oracle_put_solvent_positions(g, "in.solvent");
  oracle_put_points(g, "in.vertex", g->state->position, g->state->vertices);
  solvent_bin(g->state, g->model, g->work, shift);
  oracle_put_cells(g, "out.solvent", "out.vertex");
  return true;
}

static bool run_sum(struct oracle_stage *g)
{
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  bool ok = collide_sum(g->state, g->model, g->work, g->place.step);
  oracle_put_sums(g, "out.momentum", "out.load");
  return ok;
}

static bool run_solve(struct oracle_stage *g)
{
  oracle_put_sums(g, "in.momentum", "in.load");
  collide_solve(g->model, g->work, g->place.step);
  oracle_put_active(g, "out.active");
  oracle_put_centers(g, "out.center");
  oracle_put_axes(g, "out.axis");
  return true;
}

/* Both thermostats are run on the same input; their factors are not used further on. */
static bool run_thermostat(struct oracle_stage *g, enum thermostat thermostat)
{
  const uint32_t cells = oracle_cells(g);
  struct collision_work *c = &g->work->collision;
  const enum thermostat scenes = g->model->solvent.thermostat;
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  oracle_put_sums(g, "in.momentum", "in.load");
  oracle_put_centers(g, "in.center");
  g->model->solvent.thermostat = thermostat;
  bool ok = collide_thermostat(g->state, g->model, g->work, g->place.step);
  g->model->solvent.thermostat = scenes;
  int64_t *relative = oracle_put_integers(g, "out.relative", "energy", cells);
  for (uint32_t k = 0; relative && k < cells; k++)
    relative[k] = c->turn[k].active != 0.0 ? c->relative[k] : 0;
  double *factor = oracle_put_reals(g, "out.factor", "factor", cells);
  for (uint32_t k = 0; factor && k < cells; k++)
    factor[k] = c->turn[k].active != 0.0 ? c->turn[k].factor : 1.0;
  return ok;
}

static bool run_rescale(struct oracle_stage *g)
{
  return run_thermostat(g, THERMOSTAT_RESCALE);
}

static bool run_maxwell_boltzmann(struct oracle_stage *g)
{
  return run_thermostat(g, THERMOSTAT_MAXWELL_BOLTZMANN);
}

/* Factors of its own, so that a port that forgets them is found: 1, 1 + 1/64, ... exact in binary. */
static bool run_rotate(struct oracle_stage *g)
{
  const uint32_t cells = oracle_cells(g);
  double *factor = oracle_put_reals(g, "in.factor", "factor", cells);
  for (uint32_t k = 0; factor && k < cells; k++)
    factor[k] = g->work->collision.turn[k].factor = 1.0 + 0x1p-6 * (k % 8);
  oracle_put_cells(g, "in.solvent_cell", "in.vertex_cell");
  oracle_put_active(g, "in.active");
  oracle_put_centers(g, "in.center");
  oracle_put_axes(g, "in.axis");
  oracle_put_velocities(g, "in.solvent", "in.vertex");
  const enum thermostat scenes = g->model->solvent.thermostat;
  g->model->solvent.thermostat = THERMOSTAT_RESCALE; /* without a thermostat, factors have no say */
  collide_turn(g->state, g->model, g->work);
  g->model->solvent.thermostat = scenes;
  oracle_put_velocities(g, "out.solvent", "out.vertex");
  return true;
}

static bool run_swap(struct oracle_stage *g)
{
  oracle_put_solvent_velocities(g, "in.velocity");
  solvent_swap_velocities(g->state, g->model, g->work, g->place.step);
  oracle_put_counts(g, "out.order", "particle", g->work->collision.order, g->state->solvent.n);
  oracle_put_solvent_velocities(g, "out.velocity");
  return true;
}

/* --- all of them ------------------------------------------------------------------------------------------------- */

static const struct operation {
  const char *name;
  bool (*run)(struct oracle_stage *);
  bool of_solvent; /* else of fibers */
} operations[] = {
    {"random", run_random, false},
    {"order", run_order, false},
    {"long_sweep", run_long_sweep, false},
    {"sweep", run_sweep, false},
    {"bond_force", run_bond_force, false},
    {"bend_force", run_bend_force, false},
    {"force", run_force, false},
    {"kick", run_kick, false},
    {"stream", run_stream, true},
    {"shift", run_shift, true},
    {"bin", run_bin, true},
    {"sum", run_sum, true},
    {"solve", run_solve, true},
    {"rescale", run_rescale, true},
    {"maxwell_boltzmann", run_maxwell_boltzmann, true},
    {"rotate", run_rotate, true},
    {"swap", run_swap, true},
};

bool oracle_run_operators(struct oracle_stage *g)
{
  bool ok = true;
  g->place.step = g->state->step + 1;
  for (size_t k = 0; ok && k < sizeof operations / sizeof *operations; k++) {
    snprintf(g->place.operator_name, sizeof g->place.operator_name, "%s", operations[k].name);
    if (!operations[k].of_solvent || model_has_solvent(g->model))
      ok = operations[k].run(g);
  }
  return ok && !g->pack->failed;
}

int oracle_operator_rank(const char *name)
{
  for (size_t k = 0; k < sizeof operations / sizeof *operations; k++)
    if (strcmp(operations[k].name, name) == 0)
      return (int)k + 1;
  return 0;
}

/* --- the model --------------------------------------------------------------------------------------------------- */

static void put_vertices(struct oracle_stage *g, const struct model *m)
{
  int64_t *who = oracle_put_integers(g, "in.chain", "next prev fiber", m->vertices);
  for (uint32_t v = 0; who && v < m->vertices; v++)
    who[3 * v] = m->next[v], who[3 * v + 1] = m->prev[v], who[3 * v + 2] = m->fiber_of[v];
  double *what =
      oracle_put_reals(g, "in.vertex", "mass bond_length spring bending force_x force_y force_z", m->vertices);
  for (uint32_t v = 0; what && v < m->vertices; v++) {
    const struct fiber_kind *k = &m->kind[m->fiber_kind_of[m->fiber_of[v]]];
    const double row[7] = {m->mass[v], k->bond_length, k->spring, k->bending, k->force.x, k->force.y, k->force.z};
    memcpy(&what[7 * (size_t)v], row, sizeof row);
  }
}

void oracle_put_model(struct pack *pack, const struct model *m)
{
  struct oracle_stage g = {.pack = pack, .place = {"model", 0}};
  int64_t *box = oracle_put_integers(&g, "in.box", "x y z", 1);
  for (int k = 0; box && k < 3; k++)
    box[k] = m->box.cells[k];
  int64_t *numbers =
      oracle_put_integers(&g, "in.numbers", "seed_low seed_high particles interval forbidden exclusion_paper", 1);
  const int64_t n[6] = {(uint32_t)m->seed,         (int64_t)(m->seed >> 32), m->solvent.particles,
                        m->solvent.interval_steps, m->crossing.forbidden,    m->crossing.exclusion == EXCLUSION_PAPER};
  if (numbers)
    memcpy(numbers, n, sizeof n);
  const struct vec3 a = m->solvent.acceleration;
  const double r[6] = {m->time_step, m->solvent.cosine, m->solvent.sine, a.x, a.y, a.z};
  double *reals =
      oracle_put_reals(&g, "in.reals", "time_step cosine sine acceleration_x acceleration_y acceleration_z", 1);
  if (reals)
    memcpy(reals, r, sizeof r);
  put_vertices(&g, m);
}
