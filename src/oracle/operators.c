#include "oracle/operators.h"

#include <string.h>

#include "base/normal.h"
#include "contact/rule.h"
#include "oracle/columns.h"
#include "oracle/stages.h"
#include "oracle/tube_rows.h"

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

/* --- all of them ------------------------------------------------------------------------------------------------- */

/* OF_TURNS, OF_EVENTS: of one kind of crossing rule; OF_TUBES: of thick fibers; OF_COMPANY: of fibers around
 * a bead; OF_SRD, OF_ANDERSEN, OF_SPIN: of one
 * collision rule, OF_ANDERSENS: of at-a and at+a; OF_PERIODIC_POINTS, OF_WALLS, OF_SHEAR: of one boundary along y;
 * OF_WAVE: of an oscillating shear; POINTS, DUMBBELLS: of one fluid; OF_MOVING: of vertices with velocities; OF_PRIVATE
 * and what follows: of media */
enum of {
  OF_ALL,
  OF_FIBERS,
  OF_TURNS,
  OF_EVENTS,
  OF_TUBES,
  OF_COMPANY,
  OF_SOLVENT,
  OF_SRD,
  OF_ANDERSENS,
  OF_ANDERSEN,
  OF_SPIN,
  OF_PERIODIC_POINTS,
  OF_CELLS,
  OF_WALLS,
  OF_SHEAR,
  OF_WAVE,
  OF_FLOW,
  OF_HOMOGENEOUS,
  OF_WALL_POINTS,
  OF_SHEAR_POINTS,
  OF_DUMBBELLS,
  OF_PERIODIC_DUMBBELLS,
  OF_WALL_DUMBBELLS,
  OF_SHEAR_DUMBBELLS,
  OF_MOVING,
  OF_STREAM,
  OF_PRIVATE,
  OF_PAIRS,
  OF_REPULSION,
  OF_CROWD,
  OF_OVERDAMPED,
  OF_TENSOR
};

static const struct operation {
  const char *name;
  bool (*run)(struct oracle_stage *);   /* of the scene's state; NULL: none */
  bool (*edges)(struct oracle_stage *); /* of constructed inputs; NULL: none */
  enum of of;
} operations[] = {
    {"random", run_random, NULL, OF_ALL},
    {"permutation", NULL, oracle_edges_permutation, OF_TURNS},
    {"order", oracle_run_order, NULL, OF_TURNS},
    {"crossing", oracle_run_crossing, oracle_edges_crossing, OF_TURNS},
    {"exchange", oracle_run_exchange, oracle_edges_exchange, OF_TURNS},
    {"long_sweep", oracle_run_long_sweep, NULL, OF_TURNS},
    {"sweep", oracle_run_sweep, oracle_edges_sweep, OF_TURNS},
    {"contact_search", oracle_run_contact_search, oracle_edges_contact_search, OF_EVENTS},
    {"tube_search", oracle_run_tube_search, NULL, OF_TUBES},
    {"tube_contact", oracle_run_tube_contact, NULL, OF_TUBES},
    {"bead_search", oracle_run_bead_search, NULL, OF_COMPANY},
    {"bead_contact", oracle_run_bead_contact, NULL, OF_COMPANY},
    {"impulse", oracle_run_impulse, oracle_edges_impulse, OF_EVENTS},
    {"impulse", oracle_run_bead_impulse, NULL, OF_COMPANY},
    {"long_event_drift", oracle_run_long_event_drift, NULL, OF_EVENTS},
    {"event_drift", oracle_run_event_drift, oracle_edges_event_drift, OF_EVENTS},
    {"bond_force", oracle_run_bond_force, NULL, OF_FIBERS},
    {"bend_force", oracle_run_bend_force, NULL, OF_FIBERS},
    {"force", oracle_run_force, NULL, OF_FIBERS},
    {"mobility", oracle_run_mobility, NULL, OF_TENSOR},
    {"root", oracle_run_root, NULL, OF_TENSOR},
    {"move", oracle_run_move, NULL, OF_OVERDAMPED},
    {"kick", oracle_run_kick, NULL, OF_MOVING},
    {"private_bath", oracle_run_private_bath, NULL, OF_PRIVATE},
    {"wall_motion", oracle_run_wall_motion, NULL, OF_WALLS},
    {"shear_motion", oracle_run_shear_motion, NULL, OF_SHEAR},
    {"dumbbell_start", oracle_run_dumbbell_start, NULL, OF_DUMBBELLS},
    {"stream", oracle_run_stream, NULL, OF_STREAM},
    {"crowd", oracle_run_crowd, NULL, OF_CROWD},
    {"repulsion", oracle_run_repulsion, NULL, OF_REPULSION},
    {"repulsion_kick", oracle_run_repulsion_kick, NULL, OF_REPULSION},
    {"pairs", oracle_run_pairs, NULL, OF_PAIRS},
    {"pair_bath", oracle_run_pair_bath, NULL, OF_PAIRS},
    {"wall_stream", oracle_run_wall_stream, NULL, OF_WALL_POINTS},
    {"shear_stream", oracle_run_shear_stream, NULL, OF_SHEAR_POINTS},
    {"dumbbell_stream", oracle_run_dumbbell_stream, NULL, OF_PERIODIC_DUMBBELLS},
    {"dumbbell_wall_stream", oracle_run_dumbbell_wall_stream, NULL, OF_WALL_DUMBBELLS},
    {"dumbbell_shear_stream", oracle_run_dumbbell_shear_stream, NULL, OF_SHEAR_DUMBBELLS},
    {"shift", oracle_run_shift, NULL, OF_SOLVENT},
    {"enter", oracle_run_enter, NULL, OF_SHEAR},
    {"bin", oracle_run_bin, oracle_edges_bin, OF_CELLS},
    {"wall_bin", oracle_run_wall_bin, NULL, OF_WALLS},
    {"draw", oracle_run_draw, NULL, OF_ANDERSENS},
    {"sum", oracle_run_sum, NULL, OF_SRD},
    {"sum", oracle_run_andersen_sum, NULL, OF_ANDERSENS},
    {"fill", oracle_run_fill, NULL, OF_WALLS},
    {"solve", oracle_run_solve, NULL, OF_SRD},
    {"mean", oracle_run_mean, NULL, OF_ANDERSEN},
    {"moments", oracle_run_moments, NULL, OF_SPIN},
    {"spin", oracle_run_spin, NULL, OF_SPIN},
    {"rescale", oracle_run_rescale, NULL, OF_HOMOGENEOUS},
    {"maxwell_boltzmann", oracle_run_maxwell_boltzmann, NULL, OF_HOMOGENEOUS},
    {"rescale_layers", oracle_run_rescale_layers, NULL, OF_FLOW},
    {"rotate", oracle_run_rotate, NULL, OF_SRD},
    {"give", oracle_run_give, NULL, OF_ANDERSEN},
    {"give_spin", oracle_run_give_spin, NULL, OF_SPIN},
    {"account", oracle_run_account, NULL, OF_WALLS},
    {"leave", oracle_run_leave, NULL, OF_SHEAR},
    {"affine_kick", oracle_run_affine_kick, NULL, OF_WAVE},
    {"swap", oracle_run_swap, NULL, OF_PERIODIC_POINTS},
};

/* True if a step of this model has the operation. */
static bool is_of(enum of of, const struct model *m)
{
  const bool company = model_has_bead(m) && m->kinds > 0; /* drifts and collisions with a bead are no operators yet */
  const bool events = oracle_has_events(m) && !company, solvent = model_has_solvent(m) && model_in_cells(m) && !company;
  const bool moving = !model_is_overdamped(m), pairs = m->medium.kind == MEDIUM_PAIRS;
  const bool walls = model_has_walls(m), shear = model_is_sheared(m), periodic = !walls && !shear;
  const bool dumbbells = model_has_dumbbells(m);
  const bool holds[] = {[OF_ALL] = true,
                        [OF_FIBERS] = periodic,
                        [OF_TURNS] = periodic && !oracle_has_events(m) && moving,
                        [OF_EVENTS] = events,
                        [OF_TUBES] = events && m->thickness > 0,
                        [OF_COMPANY] = company,
                        [OF_SOLVENT] = solvent,
                        [OF_PERIODIC_POINTS] = solvent && periodic && !dumbbells,
                        [OF_WALL_POINTS] = solvent && walls && !dumbbells,
                        [OF_SHEAR_POINTS] = solvent && shear && !dumbbells,
                        [OF_DUMBBELLS] = dumbbells,
                        [OF_PERIODIC_DUMBBELLS] = dumbbells && periodic,
                        [OF_WALL_DUMBBELLS] = dumbbells && walls,
                        [OF_SHEAR_DUMBBELLS] = dumbbells && shear,
                        [OF_CELLS] = solvent && !walls,
                        [OF_WALLS] = solvent && walls,
                        [OF_SHEAR] = solvent && shear,
                        [OF_WAVE] = solvent && shear && m->wave.intervals > 0,
                        [OF_FLOW] = solvent && !periodic && m->solvent.rule == RULE_SRD,
                        [OF_HOMOGENEOUS] = solvent && periodic && m->solvent.rule == RULE_SRD,
                        [OF_SRD] = solvent && m->solvent.rule == RULE_SRD,
                        [OF_ANDERSENS] = solvent && m->solvent.rule != RULE_SRD,
                        [OF_ANDERSEN] = solvent && m->solvent.rule == RULE_AT_A,
                        [OF_SPIN] = solvent && m->solvent.rule == RULE_AT_PLUS_A,
                        [OF_MOVING] = periodic && moving,
                        [OF_STREAM] = (solvent && periodic && !dumbbells) || pairs,
                        [OF_PRIVATE] = m->medium.kind == MEDIUM_PRIVATE,
                        [OF_PAIRS] = pairs,
                        [OF_REPULSION] = model_repels(m),
                        [OF_CROWD] = m->medium.many.repulsion != 0.0,
                        [OF_OVERDAMPED] = !moving,
                        [OF_TENSOR] = !moving && m->medium.tensor != TENSOR_NONE};
  return holds[of];
}

bool oracle_has_events(const struct model *m)
{
  const struct crossing_rule *rule = crossing_rule_of(m);
  return rule->forbids && !rule->in_turns;
}

bool oracle_run_operators(struct oracle_stage *g, bool edges)
{
  bool ok = true;
  g->place.step = g->state->step + 1;
  for (size_t k = 0; ok && k < sizeof operations / sizeof *operations; k++) {
    const struct operation *o = &operations[k];
    bool (*run)(struct oracle_stage *) = edges ? o->edges : o->run;
    snprintf(g->place.operator_name, sizeof g->place.operator_name, "%s", o->name);
    if (run && is_of(o->of, g->model))
      ok = run(g);
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

/* Tables of one operator, each made of those before it; what is not here comes last. */
static int table_rank(const char *name)
{
  static const char *const names[] = {
      "out.word",    "out.uniform",  "out.normal", "out.filled",   "out.active", "out.second",   "out.angular",
      "out.middle",  "out.beyond",   "out.omega",  "out.center",   "out.axis",   "out.crosses",  "out.tick",
      "out.contact", "out.answer",   "out.pair",   "out.along",    "out.bath",   "out.event",    "out.hit",
      "out.order",   "out.position", "out.vector", "out.momentum", "out.load",   "out.relative", "out.factor",
      "out.solvent", "out.vertex",   "out.force",  "out.velocity"};
  int rank = 0;
  while (rank < (int)(sizeof names / sizeof *names) && strcmp(names[rank], name) != 0)
    rank++;
  return rank;
}

int oracle_flow(const struct pack_table *a, const struct pack_table *b)
{
  const int operators = oracle_operator_rank(a->place.operator_name) - oracle_operator_rank(b->place.operator_name);
  const int tables = table_rank(a->name) - table_rank(b->name);
  return operators != 0                  ? operators
         : tables != 0                   ? tables
         : a->place.step < b->place.step ? -1
                                         : a->place.step > b->place.step;
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
  struct oracle_stage g = {.model = m, .pack = pack, .place = {"model", 0}};
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
  if (m->thickness > 0)
    oracle_put_radii(&g);
  if (model_has_walls(m) || model_is_sheared(m))
    oracle_put_flow(&g);
  if (model_has_dumbbells(m))
    oracle_put_dumbbells(&g);
  if (!model_in_cells(m))
    oracle_put_medium(&g);
}
