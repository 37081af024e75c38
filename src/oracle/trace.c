/* Traces of scenes: what the state of a run is after every stage of its steps. */
#include <inttypes.h>
#include <stdlib.h>
#include <xxhash.h>

#include "contact/flight.h"
#include "fiber/force.h"
#include "oracle/contract.h"
#include "oracle/oracle.h"
#include "step.h"

struct tracer {
  const struct model *model;
  FILE *out;
  uint32_t *slot;
  uint64_t step;
  bool started, short_of_memory; /* for a hash */
  uint64_t contacts, digests;    /* since the last row, of a scene whose drifts have events: number, sum of hashes */
  XXH64_state_t *together;       /* of their numbers; NULL where there are none */
};

/* The order of these words is that of docs/port/formats.md. */
static void trace_contact(void *context, const struct contact_event *v)
{
  struct tracer *t = context;
  const int64_t word[6] = {v->moving_bond, v->standing_bond, v->image[0],
                           v->image[1],    v->image[2],      (int64_t)(v->hit.time * FLIGHT_TICKS)};
  t->contacts++;
  t->digests += XXH64(word, sizeof word, 0);
  XXH64_update(t->together, word, sizeof word);
}

static void end_row(struct tracer *t)
{
  if (t->together) {
    fprintf(t->out, ",%" PRIu64 ",%016" PRIx64 ",%016" PRIx64, t->contacts, (uint64_t)XXH64_digest(t->together),
            t->digests);
    t->contacts = t->digests = 0;
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
  fprintf(t->out, "%" PRIu64 ",%s,%016" PRIx64 ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%016" PRIx64, t->step, stage,
          hash, momentum.x, momentum.y, momentum.z, solvent, vertex, e.bond, e.bend, state_digest(state));
  end_row(t);
}

static bool trace_steps(const struct scene *scene, uint64_t every, struct state *state, struct work *work,
                        struct tracer *t, struct message *message)
{
  const struct step_watch watch = {trace_row, t};
  const struct contact_log log = {trace_contact, t};
  fputs("step,stage,state_hash,momentum_x,momentum_y,momentum_z,solvent_kinetic,vertex_kinetic,bond,bend,digest",
        t->out);
  fputs(t->together ? ",contacts,contacts_hash,contacts_digest\n" : "\n", t->out);
  trace_row(t, "start", state);
  t->started = true;
  while (state->step < scene->steps) {
    t->step = state->step + 1;
    if (!step_advance_watched(state, &scene->model, work, t->together ? &log : NULL, every ? NULL : &watch))
      return message_fault(message, &work->fault);
    if (every == 0 || state->step % every == 0 || state->step == scene->steps)
      trace_row(t, "end", state);
  }
  return !t->short_of_memory || message_set(message, "no memory for the hash of the state");
}

bool oracle_trace(struct scene *scene, uint64_t every, FILE *out, bool *stopped, struct message *message)
{
  *stopped = false;
  if (!contract_covers(scene, false, message))
    return false;
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
  ok = ok && contract_start(scene, &state, &work, message) && trace_steps(scene, every, &state, &work, &t, message);
  *stopped = t.started && work.fault.code != FAULT_NONE && work.fault.code != FAULT_NO_MEMORY;
  work_free(&work);
  state_free(&state);
  XXH64_freeState(t.together);
  free(t.slot);
  return ok;
}
