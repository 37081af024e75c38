/* Simulations in memory behind include/uncross.h. */
#include <stdlib.h>
#include <string.h>

#include "api/handle.h"
#include "files/start.h"
#include "fluid/fluid.h"

_Static_assert(sizeof(struct point) == 3 * sizeof(int64_t), "positions are shown as int64_t [n][3]");
_Static_assert(sizeof(struct vec3) == 3 * sizeof(double), "velocities are shown as double [n][3]");

/* --- making and freeing ------------------------------------------------------------------------------------------ */

struct run_parts sim_parts(struct uncross_sim *sim)
{
  return (struct run_parts){&sim->scene, &sim->state, &sim->work, sim->observers};
}

void sim_look(struct uncross_sim *sim)
{
  sim->view.step = sim->state.step;
  sim->view.lag = 0.5 * sim->state.solvent_lag;
}

/* What does not change as long as the simulation lives. */
static void set_view(struct uncross_sim *sim)
{
  const struct model *m = &sim->scene.model;
  const struct solvent *s = &sim->state.solvent;
  struct uncross_view *v = &sim->view;
  v->particles = s->n;
  v->vertices = m->vertices;
  v->fibers = m->fibers;
  v->kinds = m->kinds;
  for (int k = 0; k < 3; k++) {
    v->cells[k] = m->box.cells[k];
    v->edge[k] = m->box.edge[k];
  }
  v->position = &sim->state.position->x;
  v->velocity = &sim->state.velocity->x;
  v->mass = m->mass;
  v->next = m->next;
  v->fiber = m->fiber_of;
  v->first = m->fiber_first;
  v->kind = m->fiber_kind_of;
  v->x = s->x, v->y = s->y, v->z = s->z;
  v->vx = s->vx, v->vy = s->vy, v->vz = s->vz;
  v->id = s->id;
  sim_look(sim);
}

static bool keep_on(void *context)
{
  const struct uncross_scene *scene = context;
  return scene->watch(scene->context) != 0;
}

int sim_make(struct uncross_sim *sim, const struct uncross_scene *scene, const char *checkpoint, uncross_error *error)
{
  const int code = handle_read(scene, checkpoint, &sim->scene, error);
  if (code != UNCROSS_OK)
    return code;
  sim->observers = observers_create(&sim->scene.observe, &sim->scene.model);
  if (!sim->observers || !state_alloc(&sim->state, &sim->scene.model) || !work_alloc(&sim->work, &sim->scene.model))
    return fail(error, UNCROSS_NO_MEMORY, "no memory for this scene; `uncross check` says how much it needs", NULL);
  observers_watch(sim->observers, &sim->work);
  sim->work.watch = (struct start_watch){scene->watch ? keep_on : NULL, (void *)(uintptr_t)scene};
  set_view(sim);
  return UNCROSS_OK;
}

void sim_clear(struct uncross_sim *sim)
{
  tables_clear(sim);
  work_free(&sim->work);
  state_free(&sim->state);
  observers_free(sim->observers);
  scene_free(&sim->scene);
}

/* --- start, resume, advance, save -------------------------------------------------------------------------------- */

static int start(struct uncross_sim *sim, uncross_error *error)
{
  struct message message;
  const struct run_parts parts = sim_parts(sim);
  const enum run_code code = run_begin(&parts, &sim->head, &message);
  if (code != RUN_FINE)
    return fail(error, (int)code, message.text, &sim->work.fault);
  return tables_begin(sim) && tables_sample(sim) ? UNCROSS_OK
                                                 : fail(error, UNCROSS_NO_MEMORY, "no memory for tables", NULL);
}

static int resume(struct uncross_sim *sim, const struct uncross_scene *scene, const char *path, uncross_error *error)
{
  struct message message;
  const struct run_parts parts = sim_parts(sim);
  const enum run_code code = run_continue(&parts, path, scene->has_seed ? &scene->seed : NULL, &sim->head, &message);
  if (code != RUN_FINE)
    return fail(error, (int)code, message.text, NULL);
  return tables_begin(sim) ? UNCROSS_OK : fail(error, UNCROSS_NO_MEMORY, "no memory for tables", NULL);
}

/* path: of a checkpoint, or NULL. */
static uncross_sim *make(const uncross_scene *scene, const char *path, uncross_error *error)
{
  uncross_sim *sim = calloc(1, sizeof *sim);
  if (!sim) {
    fail(error, UNCROSS_NO_MEMORY, "out of memory", NULL);
    return NULL;
  }
  struct call call;
  call_begin(&call, path != NULL);
  int code = sim_make(sim, scene, path, error);
  call_end(&call);
  call_begin(&call, path || sim->scene.snapshot);
  if (code == UNCROSS_OK)
    code = path ? resume(sim, scene, path, error) : start(sim, error);
  call_end(&call);
  if (code == UNCROSS_OK) {
    sim_look(sim);
    return sim;
  }
  uncross_sim_free(sim);
  return NULL;
}

uncross_sim *uncross_sim_start(const uncross_scene *scene, uncross_error *error)
{
  if (!scene) {
    fail_null(error, "scene");
    return NULL;
  }
  struct call call;
  call_begin(&call, false);
  uncross_sim *sim = make(scene, NULL, error);
  call_end(&call);
  return sim;
}

uncross_sim *uncross_sim_resume(const uncross_scene *scene, const char *path, uncross_error *error)
{
  if (!scene || !path) {
    fail_null(error, "scene or path");
    return NULL;
  }
  struct call call;
  call_begin(&call, false);
  uncross_sim *sim = make(scene, path, error);
  call_end(&call);
  return sim;
}

static int stopped(const struct uncross_sim *sim, uncross_error *error)
{
  struct message message;
  message_fault(&message, &sim->work.fault);
  return fail(error, UNCROSS_STOPPED, message.text, &sim->work.fault);
}

static int advance(struct uncross_sim *sim, uint64_t steps, uncross_error *error)
{
  for (uint64_t k = 0; k < steps; k++) {
    if (!step_advance(&sim->state, &sim->scene.model, &sim->work, observers_contacts(sim->observers))) {
      sim->stopped = true;
      return stopped(sim, error);
    }
    if (!tables_sample(sim))
      return fail(error, UNCROSS_NO_MEMORY, "no memory for tables", NULL);
  }
  return UNCROSS_OK;
}

static int fail_of_run(uncross_error *error)
{
  return fail(error, UNCROSS_BAD_INPUT, "sim: it belongs to a run, which advances and saves it", NULL);
}

int uncross_sim_advance(uncross_sim *sim, uint64_t steps, uncross_error *error)
{
  if (!sim)
    return fail_null(error, "sim");
  if (sim->of_run)
    return fail_of_run(error);
  if (steps > MOST_STEPS - sim->state.step)
    return fail_steps(error, MOST_STEPS - sim->state.step);
  if (sim->stopped)
    return stopped(sim, error);
  struct call call;
  call_begin(&call, false);
  const int code = advance(sim, steps, error);
  sim_look(sim);
  call_end(&call);
  return code;
}

int uncross_sim_save(uncross_sim *sim, const char *path, uncross_error *error)
{
  if (!sim || !path)
    return fail_null(error, "sim or path");
  if (sim->of_run)
    return fail_of_run(error);
  if (sim->stopped)
    return stopped(sim, error);
  struct call call;
  struct message message;
  const struct observe_block *blocks;
  call_begin(&call, true);
  const size_t count = observers_blocks(sim->observers, &blocks);
  const bool ok =
      checkpoint_write(path, &sim->head, &sim->scene.model, &sim->state, blocks, count, sim->scene.text, &message);
  call_end(&call);
  return ok ? UNCROSS_OK : fail(error, UNCROSS_NOT_WRITTEN, message.text, NULL);
}

void uncross_sim_free(uncross_sim *sim)
{
  if (!sim || sim->of_run)
    return;
  sim_clear(sim);
  free(sim);
}

/* --- looking ----------------------------------------------------------------------------------------------------- */

uint64_t uncross_sim_step(const uncross_sim *sim)
{
  return sim ? sim->state.step : 0;
}

double uncross_sim_time(const uncross_sim *sim)
{
  return sim ? (double)sim->state.step * sim->scene.model.time_step : 0.0;
}

int uncross_sim_hash(const uncross_sim *sim, uint64_t *hash, uncross_error *error)
{
  if (!sim || !hash)
    return fail_null(error, "sim or hash");
  *hash = state_hash(&sim->state);
  return *hash ? UNCROSS_OK : fail(error, UNCROSS_NO_MEMORY, "no memory for the hash", NULL);
}

int uncross_sim_warnings(const uncross_sim *sim, void (*tell)(void *context, const char *text), void *context,
                         uncross_error *error)
{
  if (!sim || !tell)
    return fail_null(error, "sim or tell");
  struct call call;
  call_begin(&call, false);
  scene_warnings(&sim->scene, tell, context);
  start_warnings(&sim->scene, &sim->head.stream, tell, context);
  call_end(&call);
  return UNCROSS_OK;
}

int uncross_sim_counts(const uncross_sim *sim, uncross_counts *counts, uncross_error *error)
{
  if (!sim || !counts)
    return fail_null(error, "sim or counts");
  const struct collision_counts *c = &sim->state.counts;
  *counts = (uncross_counts){c->moves, c->possible, c->executed, c->negative};
  return UNCROSS_OK;
}

const uncross_view *uncross_sim_view(const uncross_sim *sim)
{
  return sim ? &sim->view : NULL;
}

const char *uncross_sim_kind(const uncross_sim *sim, uint32_t kind)
{
  return sim && kind < sim->scene.model.kinds ? sim->scene.model.kind[kind].name : NULL;
}

static void put(double *to, struct vec3 v)
{
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

int uncross_sim_positions(const uncross_sim *sim, double *position, uncross_error *error)
{
  if (!sim || !position)
    return fail_null(error, "sim or position");
  for (uint32_t v = 0; v < sim->state.vertices; v++)
    put(&position[3 * (size_t)v], point_in_a0(sim->state.position[v]));
  return UNCROSS_OK;
}

int uncross_sim_solvent(const uncross_sim *sim, double *position, double *velocity, uncross_error *error)
{
  if (!sim)
    return fail_null(error, "sim");
  const struct model *m = &sim->scene.model;
  const struct solvent *s = &sim->state.solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    const size_t at = 3 * (size_t)s->id[i];
    if (position)
      put(&position[at], point_in_a0(fluid_position_now(&sim->state, m, i)));
    if (velocity)
      put(&velocity[at], fluid_velocity_now(&sim->state, m, i));
  }
  return UNCROSS_OK;
}

int uncross_sim_conserved(const uncross_sim *sim, uncross_conserved *conserved, uncross_error *error)
{
  if (!sim || !conserved)
    return fail_null(error, "sim or conserved");
  const struct conserved c = observe_conserved(&sim->scene.model, &sim->state);
  *conserved = (uncross_conserved){
      c.solvent_kinetic, c.vertex_kinetic, c.bond, c.bend, c.total, {c.momentum.x, c.momentum.y, c.momentum.z}};
  return isfinite(c.total)
             ? UNCROSS_OK
             : fail(error, UNCROSS_NO_MEMORY, "no memory for forces, or a velocity is out of range", NULL);
}
