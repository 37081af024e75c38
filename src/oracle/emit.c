/* Packs and traces of scenes. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "contact/flight.h"
#include "fiber/force.h"
#include "files/start.h"
#include "oracle/columns.h"
#include "oracle/company.h"
#include "oracle/edges.h"
#include "oracle/operators.h"
#include "oracle/oracle.h"
#include "oracle/stages.h"
#include "step.h"

/* --- packs ------------------------------------------------------------------------------------------------------- */

static bool advance_to(struct oracle_stage *g, uint64_t step, const struct contact_log *log, struct message *message)
{
  while (g->state->step < step)
    if (!step_advance(g->state, g->model, g->work, log))
      return message_fault(message, &g->work->fault);
  return true;
}

/* Ports know where images are by the time, which begins at 0. */
static bool start_for_ports(struct scene *scene, struct state *state, struct work *work, struct message *message)
{
  struct stream stream;
  return scene_start(scene, state, work, &stream, message) &&
         (scene->model.shear.slid == 0 ||
          message_set(message,
                      "%s: start.snapshot: the images of its sheared box have slid; packs and traces begin without a "
                      "slide; allowed: a snapshot of a box at rest, or none",
                      scene->path));
}

/* A scene's run of its own, for one part of a pack: what it leaves behind is no state of the scene's run. The model
 * comes first in a pack, with the stream of the run. */
typedef bool in_run(struct oracle_stage *stage, const struct scene *scene, uint64_t step, struct message *message);

static bool with_run(struct scene *scene, in_run *put, uint64_t step, struct pack *pack, struct message *message)
{
  const struct model *model = &scene->model;
  struct state state = {0};
  struct work work = {0};
  uint32_t *slot = malloc(((size_t)model->solvent.particles + 1) * sizeof *slot);
  bool ok = slot && state_alloc(&state, model) && work_alloc(&work, model) && work_add_everything(&work, model);
  message_set(message, "no memory for this scene");
  if (ok) {
    struct oracle_stage g = {model, &state, &work, pack, {"", 0}, slot, NULL};
    ok = start_for_ports(scene, &state, &work, message);
    if (ok && pack->count == 0)
      oracle_put_model(pack, model);
    ok = ok && put(&g, scene, step, message);
  }
  work_free(&work);
  state_free(&state);
  free(slot);
  return ok && !pack->failed;
}

/* All operators of step number `step`. */
static bool put_step(struct oracle_stage *g, const struct scene *scene, uint64_t step, struct message *message)
{
  (void)scene;
  struct oracle_company company = {.stage = g};
  const struct contact_log log = {oracle_company_take, &company};
  const bool beside = model_has_bead(g->model) && g->model->kinds > 0;
  g->company = &company;
  const bool ok = advance_to(g, step - 1, beside ? &log : NULL, message) &&
                  (oracle_run_operators(g, false) || g->pack->failed || message_fault(message, &g->work->fault));
  g->pack->failed |= company.failed;
  oracle_company_free(&company);
  g->company = NULL;
  return ok;
}

bool oracle_emit(struct scene *scene, struct pack *pack, struct message *message)
{
  const struct model *model = &scene->model;
  const uint64_t interval = model_has_solvent(model) ? model->solvent.interval_steps : 1;
  const uint64_t last = scene->steps / interval * interval;
  memset(pack, 0, sizeof *pack);
  if (model_has_phantoms(model))
    return message_set(message,
                       "%s: solvent.bath: it is phantoms; packs hold the operators of a solvent of particles only",
                       scene->path);
  if (model->dimensions != 3)
    return message_set(message, "%s: dimensions: they are 2; packs hold the operators of a box in space only",
                       scene->path);
  if (model->solvent.profile != PROFILE_UNIFORM)
    return message_set(message, "%s: solvent.profile: it is not uniform; packs hold uniform accelerations only",
                       scene->path);
  if (model_has_walls(model) && model->solvent.rule != RULE_SRD)
    return message_set(message,
                       "%s: solvent.rule: it is not srd; packs of walls hold the operators of the rule srd only",
                       scene->path);
  if ((model_has_walls(model) || model_is_sheared(model)) && model->kinds > 0)
    return message_set(message,
                       "%s: fibers: there are some; packs of walls and of shear hold the operators of a solvent only",
                       scene->path);
  if (model->crossing.rejection != REJECTION_STAY || model->crossing.frame != FRAME_LABORATORY)
    return message_set(
        message,
        "%s: crossing.refusal or crossing.frame: not the paper's; packs hold drifts with stay and laboratory only",
        scene->path);
  if (model->medium.inextensible)
    return message_set(message, "%s: medium.inextensible: it is true; packs hold moves with noise, and without tension",
                       scene->path);
  if (model->frozen > 0)
    return message_set(message, "%s: fibers.frozen: it is true; packs hold the operators of fibers that move",
                       scene->path);
  if (last == 0)
    return message_set(message, "%s: no collision within its %" PRIu64 " steps; a pack needs one", scene->path,
                       scene->steps);
  return with_run(scene, put_step, interval, pack, message) &&
         (last == interval || with_run(scene, put_step, last, pack, message));
}

/* --- constructed inputs, and what a run starts from -------------------------------------------------------------- */

static bool put_edges(struct oracle_stage *g, const struct scene *scene, uint64_t step, struct message *message)
{
  (void)scene, (void)step;
  return oracle_run_operators(g, true) || g->pack->failed || message_fault(message, &g->work->fault);
}

bool oracle_edges(bool contacts, struct pack *pack, struct message *message)
{
  static const char *const in_turns[] = EDGES_SETTINGS, *const at_once[] = EDGES_EVENT_SETTINGS;
  const struct scene_settings settings = contacts
                                             ? (struct scene_settings){sizeof at_once / sizeof *at_once, at_once}
                                             : (struct scene_settings){sizeof in_turns / sizeof *in_turns, in_turns};
  struct scene scene;
  memset(pack, 0, sizeof *pack);
  if (!scene_make(&settings, &scene, message))
    return false;
  const bool ok = with_run(&scene, put_edges, 1, pack, message);
  scene_free(&scene);
  return ok;
}

static bool put_start(struct oracle_stage *g, const struct scene *scene, uint64_t step, struct message *message)
{
  const struct model *m = &scene->model;
  (void)message;
  g->place = (struct pack_place){"start", step};
  state_solvent_slots(g->state, g->slot);
  const int64_t run[4] = {(int64_t)scene->steps, m->scheme, m->solvent.thermostat, m->solvent.hydrodynamics};
  int64_t *to = oracle_put_integers(g, "in.run", "steps scheme thermostat hydrodynamics", 1);
  if (to)
    memcpy(to, run, sizeof run);
  to = oracle_put_integers(g, "in.counters", "step lag", 1);
  if (to)
    to[0] = (int64_t)g->state->step, to[1] = g->state->solvent_lag;
  to = oracle_has_events(m) ? oracle_put_integers(g, "in.rule", "event_driven", 1) : NULL;
  if (to)
    to[0] = 1;
  to = m->solvent.rule != RULE_SRD ? oracle_put_integers(g, "in.collision", "rule", 1) : NULL;
  if (to)
    to[0] = m->solvent.rule;
  oracle_put_solvent_positions(g, "in.solvent");
  oracle_put_solvent_velocities(g, "in.solvent_velocity");
  if (model_has_dumbbells(m))
    oracle_put_springs(g, "in.vector", g->state);
  oracle_put_points(g, "in.vertex", g->state->position, g->state->vertices);
  oracle_put_vectors(g, "in.vertex_velocity", g->state->velocity, g->state->vertices);
  return true;
}

bool oracle_start(struct scene *scene, struct pack *pack, struct message *message)
{
  memset(pack, 0, sizeof *pack);
  return with_run(scene, put_start, 0, pack, message);
}

static int by_place(const void *left, const void *right)
{
  const struct pack_table *a = left, *b = right;
  const int rank_a = oracle_operator_rank(a->place.operator_name),
            rank_b = oracle_operator_rank(b->place.operator_name);
  if (a->place.step != b->place.step)
    return a->place.step < b->place.step ? -1 : 1;
  return rank_a != rank_b ? rank_a - rank_b : strcmp(a->name, b->name);
}

void oracle_sort(struct pack *pack)
{
  if (pack->count > 0)
    qsort(pack->table, pack->count, sizeof *pack->table, by_place);
}

/* --- traces ------------------------------------------------------------------------------------------------------ */

struct tracer {
  const struct model *model;
  FILE *out;
  uint32_t *slot;
  uint64_t step;
  bool short_of_memory;    /* for a hash */
  uint64_t contacts;       /* since the last row, of a scene whose drifts have events */
  XXH64_state_t *together; /* of their numbers; NULL where there are none */
};

/* The order of these words is that of docs/porting.md. */
static void trace_contact(void *context, const struct contact_event *v)
{
  struct tracer *t = context;
  const int64_t word[6] = {v->moving_bond, v->standing_bond, v->image[0],
                           v->image[1],    v->image[2],      (int64_t)(v->hit.time * FLIGHT_TICKS)};
  t->contacts++;
  XXH64_update(t->together, word, sizeof word);
}

static void end_row(struct tracer *t)
{
  if (t->together) {
    fprintf(t->out, ",%" PRIu64 ",%016" PRIx64, t->contacts, (uint64_t)XXH64_digest(t->together));
    t->contacts = 0;
    XXH64_reset(t->together, 0);
  }
  fputc('\n', t->out);
}

/* Plain sums in the order of ids and vertices, of velocities as they stand, half steps and lag or not. */
static void trace_row(void *context, const char *stage, const struct state *state)
{
  struct tracer *t = context;
  const struct solvent *s = &state->solvent;
  const uint64_t hash = state_hash(state);
  t->short_of_memory |= hash == 0;
  struct vec3 momentum = {0, 0, 0};
  double solvent = 0.0, vertex = 0.0;
  state_solvent_slots(state, t->slot);
  for (uint32_t id = 0; id < s->n; id++) {
    const uint32_t i = t->slot[id];
    const struct vec3 v = solvent_velocity(s, i);
    momentum = vec3_add(momentum, v);
    solvent += 0.5 * vec3_dot(v, v);
  }
  for (uint32_t j = 0; j < state->vertices; j++) {
    momentum = vec3_add_scaled(momentum, t->model->mass[j], state->velocity[j]);
    vertex += 0.5 * t->model->mass[j] * vec3_dot(state->velocity[j], state->velocity[j]);
  }
  const struct fiber_energy e = fiber_energies(state, t->model);
  fprintf(t->out, "%" PRIu64 ",%s,%016" PRIx64 ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", t->step, stage, hash,
          momentum.x, momentum.y, momentum.z, solvent, vertex, e.bond, e.bend);
  end_row(t);
}

static bool trace_steps(const struct scene *scene, struct state *state, struct work *work, struct tracer *t,
                        struct message *message)
{
  const struct step_watch watch = {trace_row, t};
  const struct contact_log log = {trace_contact, t};
  fputs("step,stage,state_hash,momentum_x,momentum_y,momentum_z,solvent_kinetic,vertex_kinetic,bond,bend", t->out);
  fputs(t->together ? ",contacts,contacts_hash\n" : "\n", t->out);
  trace_row(t, "start", state);
  while (state->step < scene->steps) {
    t->step = state->step + 1;
    if (!step_advance_watched(state, &scene->model, work, t->together ? &log : NULL, &watch))
      return message_fault(message, &work->fault);
    trace_row(t, "end", state);
  }
  return !t->short_of_memory || message_set(message, "no memory for the hash of the state");
}

bool oracle_trace(struct scene *scene, FILE *out, struct message *message)
{
  struct state state = {0};
  struct work work = {0};
  struct tracer t = {.model = &scene->model, .out = out};
  t.slot = malloc(((size_t)scene->model.solvent.particles + 1) * sizeof *t.slot);
  const bool events = oracle_has_events(&scene->model);
  t.together = events ? XXH64_createState() : NULL;
  bool ok = t.slot && (t.together || !events) && state_alloc(&state, &scene->model) && work_alloc(&work, &scene->model);
  message_set(message, "no memory for this scene");
  if (ok && events)
    XXH64_reset(t.together, 0);
  ok = ok && start_for_ports(scene, &state, &work, message) && trace_steps(scene, &state, &work, &t, message);
  work_free(&work);
  state_free(&state);
  XXH64_freeState(t.together);
  free(t.slot);
  return ok;
}
