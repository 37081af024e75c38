/* The library as a program sees it: include/uncross.h and the shared library, nothing else. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* after the above */
#include <cmocka.h>

#include <fcntl.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "uncross.h"

static const char first_text[] =
    "box: [6, 5, 7]\ntime_step: 0.01\nsteps: 40\nseed: 11\n"
    "solvent: {per_cell: 4, collision_interval: 0.03}\n"
    "fibers:\n"
    "  - {name: rod, count: 12, vertices: 6, mass: 5, bond_length: 0.5, spring: 100, bending: 8}\n"
    "  - {name: loop, count: 2, vertices: 5, mass: 5, bond_length: 0.4, spring: 100, bending: 0, ring: true}\n"
    "observe:\n  conserved: {every: 4}\n  statics: {every: 2}\n"
    "trajectory: {every: 20}\n";
static const char second_text[] =
    "box: [4, 8, 4]\ntime_step: 0.02\nsteps: 40\nseed: 3\norder: drift-split\n"
    "solvent: {per_cell: 7, collision_interval: 0.04, thermostat: rescale, rotation_angle: 130}\n"
    "fibers:\n  - {name: chain, count: 9, vertices: 10, mass: 3, bond_length: 0, spring: 12}\n";

/* A vertex that is pulled so hard that it soon moves too far in one step. */
static const char pulled_text[] =
    "box: [5, 5, 5]\ntime_step: 0.01\nsteps: 40\nseed: 3\n"
    "fibers:\n  - {name: pulled, count: 1, vertices: 1, mass: 1, bond_length: 0, spring: 1, "
    "force: [1000, 0, 0]}\n";

static uncross_scene *scene_of(const char *text)
{
  uncross_error error;
  uncross_scene *scene = uncross_scene_parse("test.yaml", text, NULL, 0, &error);
  if (!scene)
    fail_msg("%s", error.message);
  return scene;
}

static uncross_sim *start_of(const char *text)
{
  uncross_error error;
  uncross_scene *scene = scene_of(text);
  uncross_sim *sim = uncross_sim_start(scene, &error);
  if (!sim)
    fail_msg("%s", error.message);
  uncross_scene_free(scene);
  return sim;
}

static uint64_t hash_of(const uncross_sim *sim)
{
  uint64_t hash = 0;
  assert_int_equal(uncross_sim_hash(sim, &hash, NULL), UNCROSS_OK);
  return hash;
}

static uint64_t hash_after(const char *text, uint64_t steps)
{
  uncross_sim *sim = start_of(text);
  assert_int_equal(uncross_sim_advance(sim, steps, NULL), UNCROSS_OK);
  const uint64_t hash = hash_of(sim);
  uncross_sim_free(sim);
  return hash;
}

static void make_folder(char folder[64])
{
  snprintf(folder, 64, "/tmp/uncross-test-XXXXXX");
  assert_non_null(mkdtemp(folder));
}

static void remove_folder(const char *folder)
{
  char command[128];
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  assert_int_equal(system(command), 0);
}

#define in_folder(folder, name) in_folder_(folder, name, (char[128]){""})
static const char *in_folder_(const char *folder, const char *name, char *path)
{
  snprintf(path, 128, "%s/%s", folder, name);
  return path;
}

/* --- simulations ------------------------------------------------------------------------------------------------- */

static void test_two_at_once(void **unused)
{
  (void)unused;
  const uint64_t alone[2] = {hash_after(first_text, 25), hash_after(second_text, 25)};
  uncross_sim *a = start_of(first_text), *b = start_of(second_text);
  for (int k = 0; k < 25; k++) {
    assert_int_equal(uncross_sim_advance(a, 1, NULL), UNCROSS_OK);
    assert_int_equal(uncross_sim_advance(b, 1, NULL), UNCROSS_OK);
  }
  assert_int_equal(hash_of(a), alone[0]);
  assert_int_equal(hash_of(b), alone[1]);
  assert_int_not_equal(alone[0], alone[1]);
  uncross_sim_free(a);
  uncross_sim_free(b);
}

static void test_save_and_resume(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "c.h5");
  uncross_error error;
  uncross_sim *whole = start_of(first_text), *part = start_of(first_text);
  uncross_sim_advance(whole, 40, NULL);
  uncross_sim_advance(part, 17, NULL);
  assert_int_equal(uncross_sim_save(part, path, &error), UNCROSS_OK);
  uncross_sim_free(part);

  uncross_scene *scene = scene_of(first_text);
  part = uncross_sim_resume(scene, path, &error);
  assert_non_null(part);
  assert_int_equal(uncross_sim_step(part), 17);
  assert_int_equal(uncross_sim_view(part)->step, 17);
  uncross_sim_advance(part, 23, NULL);
  assert_int_equal(hash_of(part), hash_of(whole));

  /* averages go on: the last table, of statics, is that of a simulation without interruption */
  const uncross_table *const *tables, *ours;
  size_t count;
  assert_int_equal(uncross_sim_tables(part, &tables, &count, NULL), UNCROSS_OK);
  ours = tables[count - 1];
  double *values = malloc(ours->rows * ours->columns * sizeof *values);
  memcpy(values, ours->value, ours->rows * ours->columns * sizeof *values);
  assert_int_equal(uncross_sim_tables(whole, &tables, &count, NULL), UNCROSS_OK);
  assert_memory_equal(values, tables[count - 1]->value,
                      tables[count - 1]->rows * tables[count - 1]->columns * sizeof *values);
  free(values);
  uncross_sim_free(part);

  /* a scene with another spring, another scene, another seed, no checkpoint */
  uncross_scene_set(scene, "fibers.0.spring", "101", NULL);
  assert_null(uncross_sim_resume(scene, path, &error));
  assert_int_equal(error.code, UNCROSS_BAD_INPUT);
  assert_non_null(strstr(error.message, "fibers.0.spring is 101 there, 100 in the run so far"));
  uncross_scene_set(scene, "fibers.0.spring", "100", NULL);
  uncross_scene *other = scene_of(second_text);
  assert_null(uncross_sim_resume(other, path, &error));
  assert_int_equal(error.code, UNCROSS_BAD_INPUT);
  uncross_scene_set(scene, "seed", "12", NULL);
  assert_null(uncross_sim_resume(scene, path, &error));
  assert_non_null(strstr(error.message, "was run with seed 11"));
  uncross_scene_set_seed(scene, 12, NULL);
  assert_null(uncross_sim_resume(scene, path, &error));
  assert_non_null(strstr(error.message, "was run with seed 11"));
  assert_null(uncross_sim_resume(scene, in_folder(folder, "none.h5"), &error));
  assert_int_equal(uncross_sim_save(whole, in_folder(folder, "no/where.h5"), &error), UNCROSS_NOT_WRITTEN);
  assert_non_null(strstr(error.message, "where.h5"));
  uncross_scene_free(other);
  uncross_scene_free(scene);
  uncross_sim_free(whole);
  remove_folder(folder);
}

static void test_the_physics_stops(void **unused)
{
  (void)unused;
  uncross_error error, again;
  uncross_sim *sim = start_of(pulled_text);
  assert_int_equal(uncross_sim_advance(sim, 1000, &error), UNCROSS_STOPPED);
  assert_int_equal(error.code, UNCROSS_STOPPED);
  assert_int_equal(error.cause, UNCROSS_CAUSE_VERTEX_MOVE);
  assert_int_equal(error.entity, 0);
  assert_int_equal(error.step, uncross_sim_step(sim));
  assert_true(error.value > error.limit);
  /* by hand: half a kick, then (step - 1) kicks of F dt/M = 10 a0/t0, so that steps move 0.1 (step - 1/2) a0; 2.5 a0 is
   * half the edge */
  assert_in_range(error.step, 24, 27);
  assert_non_null(strstr(error.message, "vertex 0 moves too far in one time step"));
  assert_int_equal(uncross_sim_advance(sim, 1, &again), UNCROSS_STOPPED);
  assert_memory_equal(&error, &again, sizeof error);
  assert_int_equal(uncross_sim_save(sim, "/nowhere", &again), UNCROSS_STOPPED);
  assert_int_equal(uncross_sim_advance(sim, 1, NULL), UNCROSS_STOPPED);
  uncross_sim_free(sim);
}

/* Steps are whole numbers below 2^63, as those of a scene; more are refused before the first is made. */
static void test_steps_that_no_run_has(void **unused)
{
  (void)unused;
  static const uint64_t many[] = {(uint64_t)1 << 63, UINT64_MAX, (uint64_t)INT64_MAX};
  uncross_error error;
  char folder[64];
  uncross_sim *sim = start_of(first_text);
  assert_int_equal(uncross_sim_advance(sim, 2, NULL), UNCROSS_OK);
  for (size_t k = 0; k < sizeof many / sizeof *many; k++) { /* the last: 2 + 2^63 - 1 */
    assert_int_equal(uncross_sim_advance(sim, many[k], &error), UNCROSS_BAD_INPUT);
    assert_non_null(strstr(error.message, "allowed: 0 .. 9223372036854775805"));
    assert_int_equal(uncross_sim_step(sim), 2);
  }
  uncross_sim_free(sim);
  uncross_scene *scene = uncross_scene_parse("first", first_text, NULL, 0, NULL);
  make_folder(folder);
  uncross_run *run = uncross_run_open(scene, in_folder(folder, "run"), UNCROSS_NEW, NULL);
  for (size_t k = 0; k < 2; k++) {
    assert_int_equal(uncross_run_advance(run, many[k], NULL, NULL, &error), UNCROSS_BAD_INPUT);
    assert_non_null(strstr(error.message, "allowed: 0 .. 9223372036854775807"));
    assert_int_equal(uncross_sim_step(uncross_run_sim(run)), 0);
  }
  assert_int_equal(uncross_scene_set_steps(scene, many[0], &error), UNCROSS_BAD_INPUT);
  uncross_run_free(run);
  uncross_scene_free(scene);
  remove_folder(folder);
}

/* --- looking ----------------------------------------------------------------------------------------------------- */

static void test_the_view_shows_the_state_without_copies(void **unused)
{
  (void)unused;
  uncross_sim *sim = start_of(first_text);
  const uncross_view *v = uncross_sim_view(sim), before = *v;
  assert_int_equal(v->vertices, 12 * 6 + 2 * 5);
  assert_int_equal(v->particles, 4 * 6 * 5 * 7);
  assert_int_equal(v->fibers, 14);
  assert_int_equal(v->kinds, 2);
  assert_string_equal(uncross_sim_kind(sim, 1), "loop");
  assert_null(uncross_sim_kind(sim, 2));
  assert_int_equal(v->cells[2], 7);
  assert_int_equal(v->edge[1], 5 * (INT64_C(1) << 40));
  const int64_t was = v->position[0];
  assert_int_equal(uncross_sim_advance(sim, 31, NULL), UNCROSS_OK);
  assert_ptr_equal(uncross_sim_view(sim), v);
  assert_ptr_equal(v->position, before.position);
  assert_ptr_equal(v->velocity, before.velocity);
  assert_ptr_equal(v->x, before.x);
  assert_ptr_equal(v->vz, before.vz);
  assert_int_not_equal(v->position[0], was);
  assert_int_equal(v->step, 31);
  assert_true(v->lag == 1.0); /* collisions at every third step: the last one was at 30, its solvent streamed by then */

  /* topology: bonds lead along fibers; rings close */
  for (uint32_t i = 0; i < v->vertices; i++) {
    const uint32_t f = v->fiber[i], first = v->first[f], end = v->first[f + 1];
    assert_in_range(i, first, end - 1);
    assert_int_equal(v->next[i], i + 1 < end ? (int32_t)i + 1 : v->kind[f] == 1 ? (int32_t)first : -1);
    assert_true(v->mass[i] == 5.0);
  }
  assert_int_equal(v->first[v->fibers], v->vertices);

  /* momentum of the view: velocities are half a step ahead, and internal forces give none, so it is that of the step */
  double p[3] = {0, 0, 0}, *x = malloc(3 * v->vertices * sizeof *x);
  uint8_t *seen = calloc(v->particles, 1);
  for (uint32_t i = 0; i < v->particles; i++) {
    p[0] += v->vx[i], p[1] += v->vy[i], p[2] += v->vz[i];
    assert_int_equal(seen[v->id[i]]++, 0);
  }
  for (uint32_t i = 0; i < v->vertices; i++)
    for (int k = 0; k < 3; k++)
      p[k] += 5.0 * v->velocity[3 * i + (uint32_t)k];
  uncross_conserved c;
  assert_int_equal(uncross_sim_conserved(sim, &c, NULL), UNCROSS_OK);
  for (int k = 0; k < 3; k++)
    assert_true(fabs(p[k] - c.momentum[k]) < 1e-9 && fabs(p[k]) < 1e-9); /* the start takes all momentum out */
  assert_true(fabs(c.total - (c.solvent_kinetic + c.vertex_kinetic + c.bond + c.bend)) < 1e-9 * c.total);

  assert_int_equal(uncross_sim_positions(sim, x, NULL), UNCROSS_OK);
  for (uint32_t k = 0; k < 3 * v->vertices; k++)
    assert_true(x[k] == (double)v->position[k] * UNCROSS_LATTICE_UNIT);
  free(x);
  free(seen);
  uncross_sim_free(sim);
}

/* The solvent flies freely between collisions: x + v lag dt, folded into the box, in the order of ids. */
static void test_the_solvent_now(void **unused)
{
  (void)unused;
  uncross_sim *sim = start_of(first_text);
  uncross_sim_advance(sim, 32, NULL);
  const uncross_view *v = uncross_sim_view(sim);
  double(*x)[3] = malloc(v->particles * sizeof *x), (*u)[3] = malloc(v->particles * sizeof *u);
  assert_true(v->lag == 2.0);
  assert_int_equal(uncross_sim_solvent(sim, &x[0][0], &u[0][0], NULL), UNCROSS_OK);
  for (uint32_t i = 0; i < v->particles; i++) {
    const double free_flight = (double)v->x[i] * UNCROSS_LATTICE_UNIT + v->vx[i] * 2.0 * 0.01;
    const double off = free_flight - x[v->id[i]][0];
    assert_true(fabs(off - 6.0 * floor(off / 6.0 + 0.5)) < 1e-11);
    assert_true(x[v->id[i]][0] >= 0.0 && x[v->id[i]][0] < 6.0);
    assert_true(u[v->id[i]][2] == v->vz[i]);
  }
  assert_int_equal(uncross_sim_solvent(sim, NULL, &u[0][0], NULL), UNCROSS_OK);
  free(x);
  free(u);
  uncross_sim_free(sim);
}

static void test_tables(void **unused)
{
  (void)unused;
  uncross_sim *sim = start_of(first_text);
  uncross_sim_advance(sim, 40, NULL);
  const uncross_table *const *tables;
  size_t count;
  assert_int_equal(uncross_sim_tables(sim, &tables, &count, NULL), UNCROSS_OK);
  assert_int_equal(count, 3);
  assert_string_equal(tables[0]->name, "conserved");
  assert_string_equal(tables[1]->name, "statics-rod");
  assert_string_equal(tables[2]->name, "statics-loop");
  assert_int_equal(tables[0]->rows, 11); /* steps 0, 4, ..., 40 */
  assert_string_equal(tables[0]->column[0], "step");
  size_t total = 0;
  while (total < tables[0]->columns && strcmp(tables[0]->column[total], "total") != 0)
    total++;
  assert_true(total < tables[0]->columns);
  uncross_conserved now;
  uncross_sim_conserved(sim, &now, NULL);
  const double *last = &tables[0]->value[10 * tables[0]->columns];
  assert_true(last[0] == 40.0);
  assert_true(last[total] == now.total);
  uncross_sim_free(sim);
}

/* --- scenes ------------------------------------------------------------------------------------------------------ */

static void refused(const char *text, const char *setting, const char *message)
{
  uncross_error error;
  uncross_scene *scene = uncross_scene_parse("bad.yaml", text, &setting, setting ? 1 : 0, &error);
  assert_null(scene);
  assert_int_equal(error.code, UNCROSS_BAD_INPUT);
  assert_int_equal(error.cause, UNCROSS_CAUSE_NONE);
  if (!strstr(error.message, message))
    fail_msg("'%s' is not in '%s'", message, error.message);
  assert_null(uncross_scene_parse("bad.yaml", text, &setting, setting ? 1 : 0, NULL));
}

static void test_bad_scenes(void **unused)
{
  (void)unused;
  refused("box: [4, 4, 4]\ntime_step: 0.01\nsteps: 1\nsolvent: {per_cell: 3, collision_interva: 0.02}\n", NULL,
          "bad.yaml:4:24: ");
  refused("box: [4, 4", NULL, "bad.yaml:2:1: not YAML");
  refused("", NULL, "bad.yaml:1:1: ");
  refused(first_text, "solvent.per_cell=-1", "per_cell");
  refused(first_text, "solvent.per_cel=1", "per_cel");
  refused(first_text, "fibers.3.count=1", "--set fibers.3.count=1: ");
  refused(first_text, "steps.more=1", "steps.more");
  refused(first_text, "steps", "steps");
  refused(first_text, "=1", "=1");
  refused(first_text, "steps=", "steps=");
  refused(first_text, "box=[4, 4", "box=[4, 4");
  const char *const twice[] = {"fibers.0.mass=2", "fibers.rod.mass=3"};
  uncross_error error;
  assert_null(uncross_scene_parse("bad.yaml", first_text, twice, 2, &error));
  assert_non_null(strstr(error.message, "'mass' is set already, by '--set fibers.0.mass=2'; allowed: one of them"));
  assert_null(uncross_scene_read("/nowhere.yaml", NULL, 0, &error));
  assert_int_equal(error.code, UNCROSS_BAD_INPUT);
  assert_non_null(strstr(error.message, "/nowhere.yaml"));
}

/* What is set is as if the text said it. */
static void test_settings(void **unused)
{
  (void)unused;
  const char *const settings[] = {"seed=12", "fibers.0.count=10", "solvent.per_cell=5", "flow=[0.1, 0, 0]"};
  char text[1024];
  uncross_error error;
  snprintf(text, sizeof text,
           "box: [6, 5, 7]\ntime_step: 0.01\nsteps: 40\nseed: 12\nflow: [0.1, 0, 0]\n"
           "solvent: {per_cell: 5, collision_interval: 0.03}\n%s",
           strstr(first_text, "fibers:"));
  memcpy(strstr(text, "count: 12"), "count: 10", 9);
  uncross_scene *scene = uncross_scene_parse("test.yaml", first_text, settings, 4, &error);
  if (!scene)
    fail_msg("%s", error.message);
  uncross_sim *sim = uncross_sim_start(scene, NULL);
  uncross_sim_advance(sim, 10, NULL);
  assert_int_equal(hash_of(sim), hash_after(text, 10));
  uncross_sim_free(sim);

  double value;
  assert_int_equal(uncross_scene_number(scene, "solvent.per_cell", &value, NULL), UNCROSS_OK);
  assert_true(value == 5.0);
  assert_int_equal(uncross_scene_number(scene, "solvent.rotation_angle", &value, NULL), UNCROSS_OK); /* its default */
  assert_true(value == 90.0);
  assert_int_equal(uncross_scene_number(scene, "box", &value, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_number(scene, "bo", &value, &error), UNCROSS_BAD_INPUT);
  char *name = uncross_scene_get(scene, "fibers.1.name", NULL);
  assert_non_null(strstr(name, "loop"));
  char by_name[128];
  snprintf(by_name, sizeof by_name, "fibers.%s.count", name); /* as keys are set */
  uncross_free(name);
  double by_number;
  assert_int_equal(uncross_scene_number(scene, "fibers.1.count", &by_number, NULL), UNCROSS_OK);
  assert_int_equal(uncross_scene_number(scene, by_name, &value, NULL), UNCROSS_OK);
  assert_true(value == by_number);
  assert_int_equal(uncross_scene_number(scene, "fibers.nobody.count", &value, NULL), UNCROSS_BAD_INPUT);

  /* what was set is replaced by what is set later */
  assert_int_equal(uncross_scene_set(scene, "solvent.per_cell", "6", &error), UNCROSS_OK);
  assert_int_equal(uncross_scene_number(scene, "solvent.per_cell", &value, NULL), UNCROSS_OK);
  assert_true(value == 6.0);

  /* a refused value leaves the scene as it was */
  assert_int_equal(uncross_scene_set(scene, "fibers.9.count", "1", &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_check(scene, &error), UNCROSS_OK);
  assert_int_equal(uncross_scene_set(scene, "time_step", "7", &error), UNCROSS_OK);
  assert_int_equal(uncross_scene_check(scene, &error), UNCROSS_BAD_INPUT);
  assert_null(uncross_sim_start(scene, &error));
  assert_null(uncross_scene_text(scene, &error));
  uncross_scene_free(scene);
}

/* A scene by hand is the scene of its text. */
static void test_a_scene_by_hand(void **unused)
{
  (void)unused;
  static const char *const keys[][2] = {{"fibers.0.name", "chain"},
                                        {"fibers.0.count", "9"},
                                        {"fibers.0.vertices", "10"},
                                        {"fibers.0.mass", "3"},
                                        {"fibers.0.bond_length", "0"},
                                        {"fibers.0.spring", "12"},
                                        {"box", "[4, 8, 4]"},
                                        {"time_step", "0.02"},
                                        {"steps", "40"},
                                        {"seed", "3"},
                                        {"order", "drift-split"},
                                        {"solvent.per_cell", "7"},
                                        {"solvent.collision_interval", "0.04"},
                                        {"solvent.thermostat", "rescale"},
                                        {"solvent.rotation_angle", "130"}};
  uncross_error error;
  uncross_scene *scene = uncross_scene_new(&error);
  assert_int_equal(uncross_scene_check(scene, &error), UNCROSS_BAD_INPUT);
  for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
    if (uncross_scene_set(scene, keys[k][0], keys[k][1], &error) != UNCROSS_OK)
      fail_msg("%s", error.message);
  uncross_sim *sim = uncross_sim_start(scene, &error);
  if (!sim)
    fail_msg("%s", error.message);
  uncross_sim_advance(sim, 12, NULL);
  assert_int_equal(hash_of(sim), hash_after(second_text, 12));
  uncross_sim_free(sim);

  /* and its effective text reads back to the same */
  char *text = uncross_scene_text(scene, NULL);
  assert_int_equal(hash_after(text, 12), hash_after(second_text, 12));
  uncross_free(text);
  uncross_scene_free(scene);
}

/* --- runs in a folder -------------------------------------------------------------------------------------------- */

struct watched {
  uint64_t calls, stop_at;
};

static int count_steps(void *context, const uncross_run *run)
{
  struct watched *w = context;
  w->calls++;
  assert_int_equal(uncross_sim_view(uncross_run_sim(run))->step, uncross_sim_step(uncross_run_sim(run)));
  return uncross_sim_step(uncross_run_sim(run)) != w->stop_at;
}

static void test_a_run_in_a_folder(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *where = in_folder(folder, "run");
  uncross_error error;
  struct watched watched = {0, 15};
  uncross_scene *scene = scene_of(first_text);
  uncross_run *run = uncross_run_open(scene, where, UNCROSS_NEW, &error);
  if (!run)
    fail_msg("%s", error.message);
  assert_string_equal(uncross_run_note(run), "");
  assert_int_equal(uncross_run_wanted(run), 40);
  assert_null(uncross_run_open(scene, where, UNCROSS_NEW, &error)); /* it is taken */
  assert_int_equal(error.code, UNCROSS_NOT_WRITTEN);
  assert_int_equal(uncross_run_advance(run, 1000, count_steps, &watched, &error), UNCROSS_OK);
  assert_int_equal(watched.calls, 15);
  assert_int_equal(uncross_run_save(run, &error), UNCROSS_OK);
  assert_int_equal(uncross_run_advance(run, 2, NULL, NULL, &error), UNCROSS_OK);
  uncross_run_free(run); /* not closed: two steps are lost */

  assert_null(uncross_run_open(scene, where, UNCROSS_NEW, &error));
  assert_non_null(strstr(error.message, "holds a run already"));
  run = uncross_run_open(scene, where, UNCROSS_RESUME, &error);
  assert_int_equal(uncross_sim_step(uncross_run_sim(run)), 15);
  assert_int_equal(uncross_run_advance(run, 1000, NULL, NULL, &error), UNCROSS_OK);
  assert_int_equal(uncross_sim_step(uncross_run_sim(run)), 40); /* the run's end */
  assert_int_equal(uncross_run_close(run, &error), UNCROSS_OK);
  assert_int_equal(hash_of(uncross_run_sim(run)), hash_after(first_text, 40));
  assert_int_equal(uncross_run_advance(run, 1, NULL, NULL, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_run_save(run, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(access(in_folder(where, "conserved.csv"), F_OK), 0);

  /* closed, the folder is free, while the handle still lives; past its end a run is left alone */
  uncross_scene_set_steps(scene, 39, NULL);
  uncross_run *past = uncross_run_open(scene, where, UNCROSS_RESUME, &error);
  assert_int_equal(uncross_sim_step(uncross_run_sim(past)), 40);
  assert_int_equal(uncross_run_advance(past, 1, NULL, NULL, &error), UNCROSS_OK);
  assert_int_equal(uncross_sim_step(uncross_run_sim(past)), 40);
  assert_int_equal(uncross_run_close(past, &error), UNCROSS_OK);
  uncross_run_free(past);
  uncross_run_free(run);
  uncross_scene_free(scene);

  assert_null(uncross_run_open(NULL, where, UNCROSS_NEW, &error));
  scene = scene_of(pulled_text);
  assert_null(uncross_run_open(scene, in_folder(folder, "none"), 7, &error));
  assert_null(uncross_run_open(scene, in_folder(folder, "none"), UNCROSS_RESUME, &error));
  assert_int_equal(error.code, UNCROSS_BAD_INPUT);
  assert_int_not_equal(access(in_folder(folder, "none"), F_OK), 0);
  run = uncross_run_open(scene, in_folder(folder, "pulled"), UNCROSS_NEW, &error);
  assert_int_equal(uncross_run_advance(run, 40, NULL, NULL, &error), UNCROSS_STOPPED);
  assert_int_equal(error.cause, UNCROSS_CAUSE_VERTEX_MOVE);
  assert_int_equal(uncross_run_close(run, &error), UNCROSS_OK);
  uncross_run_free(run);
  uncross_scene_free(scene);
  remove_folder(folder);
}

/* What a watch does to its own run at the third step. */
enum deed { SAVE, CLOSE, CLOSE_TWICE, FREE, ADVANCE, FREE_THE_SIM, DEEDS };

struct doer {
  uncross_run *run;
  enum deed deed;
  int calls, code;
};

static int do_it(void *context, const uncross_run *run)
{
  struct doer *d = context;
  uncross_sim *sim = (uncross_sim *)uncross_run_sim(run);
  if (++d->calls != 3)
    return 1;
  if (d->deed == SAVE)
    d->code = uncross_run_save(d->run, NULL);
  if (d->deed == CLOSE || d->deed == CLOSE_TWICE)
    d->code = uncross_run_close(d->run, NULL);
  if (d->deed == CLOSE_TWICE)
    d->code += uncross_run_close(d->run, NULL);
  if (d->deed == FREE)
    uncross_run_free(d->run);
  if (d->deed == ADVANCE)
    d->code = uncross_run_advance(d->run, 1, NULL, NULL, NULL);
  if (d->deed == FREE_THE_SIM) {
    uncross_sim_free(sim);
    d->code = uncross_sim_advance(sim, 1, NULL);
  }
  return 1;
}

/* In a watch a run may be saved, closed and freed: the step that was made is the last one if it was closed or freed. It
 * may not be advanced, and nobody else frees or advances the simulation of a run. */
static void test_a_watch_that_uses_its_run(void **unused)
{
  (void)unused;
  static const int code[DEEDS] = {[ADVANCE] = UNCROSS_BAD_INPUT, [FREE_THE_SIM] = UNCROSS_BAD_INPUT};
  static const int calls[DEEDS] = {
      [SAVE] = 10, [CLOSE] = 3, [CLOSE_TWICE] = 3, [FREE] = 3, [ADVANCE] = 10, [FREE_THE_SIM] = 10};
  char folder[64];
  make_folder(folder);
  uncross_error error;
  uncross_scene *scene = scene_of(first_text);
  for (int deed = 0; deed < DEEDS; deed++) {
    char name[16];
    snprintf(name, sizeof name, "run%d", deed);
    const char *where = in_folder(folder, name);
    struct doer doer = {uncross_run_open(scene, where, UNCROSS_NEW, &error), (enum deed)deed, 0, 0};
    assert_int_equal(uncross_run_advance(doer.run, 10, do_it, &doer, &error), UNCROSS_OK);
    assert_int_equal(doer.calls, calls[deed]);
    assert_int_equal(doer.code, code[deed]);
    if (deed == FREE)
      continue;
    assert_int_equal(uncross_sim_step(uncross_run_sim(doer.run)), calls[deed]);
    if (deed == CLOSE || deed == CLOSE_TWICE)
      assert_int_equal(uncross_run_advance(doer.run, 1, NULL, NULL, &error), UNCROSS_BAD_INPUT);
    assert_int_equal(uncross_run_close(doer.run, &error), UNCROSS_OK);
    assert_int_equal(uncross_run_close(doer.run, &error), UNCROSS_OK);
    uncross_run_free(doer.run);
    uncross_run *again = uncross_run_open(scene, where, UNCROSS_RESUME, &error); /* the folder is free, and whole */
    assert_int_equal(uncross_sim_step(uncross_run_sim(again)), calls[deed]);
    assert_int_equal(uncross_run_advance(again, 100, NULL, NULL, &error), UNCROSS_OK);
    assert_int_equal(hash_of(uncross_run_sim(again)), hash_after(first_text, 40));
    uncross_run_free(again);
  }
  uncross_scene_free(scene);
  remove_folder(folder);
}

/* Everything that the library may be asked for, by a thread whose stack is as small as that of a thread of musl. */
static const char wide_text[] =
    "box: [4, 64, 4]\ntime_step: 0.01\nsteps: 8\nseed: 5\n"
    "solvent: {per_cell: 4, collision_interval: 0.02, rule: at+a, acceleration: [0.01, 0, 0]}\nwalls: {kind: no-slip}\n"
    "fibers:\n  - {name: rod, count: 6, vertices: 6, mass: 5, bond_length: 0.5, spring: 100, bending: 8}\n"
    "observe:\n  conserved: {every: 2}\n  temperature: {every: 2}\n  profile: {every: 2, slabs: 8}\n"
    "  dynamics: {every: 2}\n  stress: {every: 2}\n  statics: {every: 2}\ntrajectory: {every: 4, solvent: true}\n";
static const char dumbbells_text[] =
    "box: [4, 32, 4]\ntime_step: 0.01\nsteps: 8\nseed: 5\nwalls: {kind: no-slip, shear_rate: 0.01}\n"
    "solvent: {per_cell: 4, collision_interval: 0.02, rule: at-a}\ndumbbells: {spring: 20}\n"
    "observe: {conserved: {every: 2}, stress: {every: 2}}\n";
static const char pairs_text[] =
    "box: [8, 8, 8]\ntime_step: 0.01\nsteps: 8\nseed: 5\n"
    "medium: {kind: pairs, density: 5, rate: 9, draw: relax, weight: quadratic, repulsion: 25}\n"
    "observe: {conserved: {every: 2}, pressure: {every: 2}, memory: {every: 2}}\n";

struct quest {
  const char *folder, *text;
  uncross_error error;
};

static void *ask_for_everything(void *context)
{
  struct quest *q = context;
  uncross_error *e = &q->error;
  const char *run_folder = in_folder(q->folder, "run"), *path = in_folder(q->folder, "c.h5");
  uncross_scene *scene = uncross_scene_parse("test.yaml", q->text, NULL, 0, e);
  uncross_run *run = scene ? uncross_run_open(scene, run_folder, UNCROSS_NEW, e) : NULL;
  const uncross_table *const *tables;
  size_t count;
  if (run && uncross_run_advance(run, 4, NULL, NULL, e) == UNCROSS_OK && uncross_run_save(run, e) == UNCROSS_OK &&
      uncross_sim_tables(uncross_run_sim(run), &tables, &count, e) == UNCROSS_OK &&
      uncross_run_close(run, e) == UNCROSS_OK) {
    uncross_sim *sim = uncross_sim_start(scene, e);
    if (uncross_sim_save(sim, path, e) == UNCROSS_OK) {
      uncross_sim_free(sim);
      sim = uncross_sim_resume(scene, path, e);
    }
    uncross_sim_free(sim);
  }
  uncross_run_free(run);
  run = scene ? uncross_run_open(scene, run_folder, UNCROSS_RESUME, e) : NULL;
  uncross_run_free(run);
  uncross_free(uncross_scene_text(scene, NULL));
  uncross_scene_free(scene);
  return NULL;
}

static void test_a_small_stack(void **unused)
{
  (void)unused;
  static const char *const texts[] = {first_text, second_text, wide_text, dumbbells_text, pairs_text};
  for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
    char folder[64];
    make_folder(folder);
    struct quest quest = {folder, texts[k], {.code = UNCROSS_OK}};
    fflush(stdout);
    const pid_t child = fork(); /* a stack that overflows ends the process */
    if (child == 0) {
      pthread_attr_t small;
      pthread_t thread;
      pthread_attr_init(&small);
      pthread_attr_setstacksize(&small, (size_t)128 * 1024);
      const int ran =
          pthread_create(&thread, &small, ask_for_everything, &quest) == 0 && pthread_join(thread, NULL) == 0;
      if (quest.error.code != UNCROSS_OK)
        fprintf(stderr, "%s\n", quest.error.message);
      _exit(ran ? quest.error.code : 9);
    }
    int status = -1;
    assert_int_equal(waitpid(child, &status, 0), child);
    if (status != 0)
      fail_msg("scene %zu: status %d", k, status);
    remove_folder(folder);
  }
}

/* --- manners ----------------------------------------------------------------------------------------------------- */

static void test_null(void **unused)
{
  (void)unused;
  uncross_error error;
  uint64_t hash;
  double x;
  size_t count;
  uncross_counts counts;
  uncross_conserved conserved;
  const uncross_table *const *tables;
  assert_null(uncross_scene_read(NULL, NULL, 0, &error));
  assert_int_equal(error.code, UNCROSS_BAD_INPUT);
  assert_null(uncross_scene_parse(NULL, NULL, NULL, 0, &error));
  assert_null(uncross_scene_parse("a", "b", NULL, 1, &error));
  const char *const settings[] = {"seed=1", NULL};
  assert_null(uncross_scene_parse("a", first_text, settings, 2, &error));
  assert_int_equal(error.code, UNCROSS_BAD_INPUT);
  assert_string_equal(error.message, "settings[1] is NULL");
  assert_null(uncross_scene_read("nowhere.yaml", settings, 2, &error));
  assert_string_equal(error.message, "settings[1] is NULL");
  assert_int_equal(uncross_scene_set(NULL, "a", "b", &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_set_steps(NULL, 1, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_set_seed(NULL, 1, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_watch_start(NULL, NULL, NULL, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_check(NULL, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_warnings(NULL, NULL, NULL, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_number(NULL, "a", &x, NULL), UNCROSS_BAD_INPUT);
  assert_null(uncross_scene_get(NULL, "a", NULL));
  assert_null(uncross_scene_text(NULL, NULL));
  assert_null(uncross_sim_start(NULL, &error));
  assert_null(uncross_sim_resume(NULL, "a", &error));
  assert_int_equal(uncross_sim_advance(NULL, 1, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_save(NULL, "a", &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_hash(NULL, &hash, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_warnings(NULL, NULL, NULL, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_counts(NULL, &counts, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_conserved(NULL, &conserved, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_tables(NULL, &tables, &count, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_positions(NULL, &x, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_solvent(NULL, &x, &x, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_step(NULL), 0);
  assert_true(uncross_sim_time(NULL) == 0.0);
  assert_null(uncross_sim_view(NULL));
  assert_null(uncross_sim_kind(NULL, 0));
  assert_null(uncross_run_open(NULL, NULL, UNCROSS_NEW, &error));
  assert_int_equal(uncross_run_advance(NULL, 1, NULL, NULL, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_run_save(NULL, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_run_close(NULL, &error), UNCROSS_BAD_INPUT);
  assert_null(uncross_run_sim(NULL));
  assert_null(uncross_run_note(NULL));
  assert_int_equal(uncross_run_wanted(NULL), 0);
  uncross_scene_free(NULL);
  uncross_sim_free(NULL);
  uncross_run_free(NULL);
  uncross_free(NULL);
  assert_int_equal(uncross_interface(), UNCROSS_INTERFACE);
  assert_int_equal(uncross_interface_age(), UNCROSS_INTERFACE_AGE);
  assert_true(strlen(uncross_version()) > 0);
}

/* Every pointer of every function in turn, with a scene, a simulation and a run that are good. */
static void test_null_everywhere(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  uncross_error error;
  uncross_scene *scene = scene_of(first_text);
  uncross_sim *sim = start_of(first_text);
  const uncross_table *const *tables;
  size_t count;
  assert_null(uncross_scene_parse("a", NULL, NULL, 0, &error));
  assert_null(uncross_scene_parse(NULL, "steps: 1\n", NULL, 0, NULL));
  assert_null(uncross_scene_read("a", NULL, 1, NULL));
  assert_int_equal(uncross_scene_set(scene, NULL, "1", &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_set(scene, "seed", NULL, NULL), UNCROSS_BAD_INPUT);
  assert_null(uncross_scene_get(scene, NULL, &error));
  assert_int_equal(uncross_scene_number(scene, NULL, NULL, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_number(scene, "seed", NULL, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_scene_warnings(scene, NULL, NULL, &error), UNCROSS_BAD_INPUT);
  assert_null(uncross_sim_resume(scene, NULL, &error));
  assert_int_equal(uncross_sim_save(sim, NULL, &error), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_hash(sim, NULL, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_counts(sim, NULL, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_positions(sim, NULL, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_solvent(sim, NULL, NULL, NULL), UNCROSS_OK);
  assert_int_equal(uncross_sim_conserved(sim, NULL, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_tables(sim, NULL, &count, NULL), UNCROSS_BAD_INPUT);
  assert_int_equal(uncross_sim_tables(sim, &tables, NULL, NULL), UNCROSS_BAD_INPUT);
  assert_null(uncross_run_open(scene, NULL, UNCROSS_NEW, &error));
  /* an error that nobody wants to see */
  assert_null(uncross_scene_read("/nowhere/scene.yaml", NULL, 0, NULL));
  assert_null(uncross_scene_parse("a", "steps: [", NULL, 0, NULL));
  assert_int_equal(uncross_scene_set(scene, "none", "1", NULL), UNCROSS_BAD_INPUT);
  assert_null(uncross_scene_get(scene, "none", NULL));
  assert_null(uncross_sim_resume(scene, "/nowhere/c.h5", NULL));
  assert_int_equal(uncross_sim_save(sim, in_folder(folder, "none/c.h5"), NULL), UNCROSS_NOT_WRITTEN);
  assert_null(uncross_run_open(scene, "/dev/null", UNCROSS_NEW, NULL));
  uncross_scene_free(scene);
  uncross_sim_free(sim);
  remove_folder(folder);
}

static void take_warning(void *context, const char *text)
{
  assert_true(strlen(text) > 10);
  ++*(int *)context;
}

/* Good and bad calls write nothing to standard output and standard error, and leave signals and locale alone. */
static void test_silence(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *said = in_folder(folder, "said");
  fflush(stdout);
  fflush(stderr);
  const int out = dup(STDOUT_FILENO), err = dup(STDERR_FILENO), file = open(said, O_RDWR | O_CREAT, 0600);
  dup2(file, STDOUT_FILENO);
  dup2(file, STDERR_FILENO);
  struct sigaction before[SIGSYS], after[SIGSYS];
  for (int k = 1; k < SIGSYS; k++)
    sigaction(k, NULL, &before[k]);
  const char *locale = setlocale(LC_ALL, NULL);

  uncross_error error;
  int warnings = 0;
  uncross_scene *scene = scene_of(first_text), *pulled = scene_of(pulled_text);
  uncross_run *run = uncross_run_open(scene, in_folder(folder, "run"), UNCROSS_NEW, &error);
  const int ran = uncross_run_advance(run, 40, NULL, NULL, &error) + uncross_run_close(run, &error);
  uncross_run_free(run);
  assert_int_equal(truncate(in_folder(folder, "run/checkpoint.h5"), 3000), 0); /* HDF5 has much to say about this */
  const void *damaged = uncross_sim_resume(scene, in_folder(folder, "run/checkpoint.h5"), &error);
  uncross_sim *sim = uncross_sim_start(pulled, &error);
  const int stopped = uncross_sim_advance(sim, 1000, &error);
  uncross_scene_warnings(pulled, take_warning, &warnings, &error);
  uncross_sim_free(sim);
  uncross_scene_free(scene);
  uncross_scene_free(pulled);

  fflush(stdout);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  assert_int_equal(ran, UNCROSS_OK);
  assert_null(damaged);
  assert_int_equal(stopped, UNCROSS_STOPPED);
  assert_true(warnings > 0); /* a net force */
  assert_int_equal(lseek(file, 0, SEEK_END), 0);
  for (int k = 1; k < SIGSYS; k++) {
    sigaction(k, NULL, &after[k]);
    assert_ptr_equal(before[k].sa_handler, after[k].sa_handler);
  }
  assert_string_equal(setlocale(LC_ALL, NULL), locale);
  close(out);
  close(err);
  close(file);
  remove_folder(folder);
}

/* A program that writes 0,5 for a half: its locale is made here, from the sources in Debian's package `locales`. */
static void test_a_locale_with_commas(void **unused)
{
  (void)unused;
  char folder[64], command[256];
  make_folder(folder);
  snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8", folder);
  if (system("test -e /usr/share/i18n/locales/de_DE") != 0) {
    print_message("no sources of locales here: not tried\n");
    remove_folder(folder);
    skip();
  }
  assert_int_equal(system(command), 0);
  setenv("LOCPATH", folder, 1);
  const uint64_t wanted = hash_after(first_text, 5);
  assert_non_null(setlocale(LC_ALL, "de_DE.UTF-8"));
  unsetenv("LOCPATH");
  assert_true(strtod("0,5", NULL) == 0.5);
  const uint64_t found = hash_after(first_text, 5);
  uncross_scene *scene = scene_of(first_text);
  char *text = uncross_scene_text(scene, NULL);
  assert_non_null(strstr(text, "0.01"));
  assert_true(strtod("0,5", NULL) == 0.5);
  setlocale(LC_ALL, "C");
  assert_int_equal(found, wanted);
  uncross_free(text);
  uncross_scene_free(scene);
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_two_at_once),
      cmocka_unit_test(test_save_and_resume),
      cmocka_unit_test(test_the_physics_stops),
      cmocka_unit_test(test_steps_that_no_run_has),
      cmocka_unit_test(test_the_view_shows_the_state_without_copies),
      cmocka_unit_test(test_the_solvent_now),
      cmocka_unit_test(test_tables),
      cmocka_unit_test(test_bad_scenes),
      cmocka_unit_test(test_settings),
      cmocka_unit_test(test_a_scene_by_hand),
      cmocka_unit_test(test_a_run_in_a_folder),
      cmocka_unit_test(test_a_watch_that_uses_its_run),
      cmocka_unit_test(test_a_small_stack),
      cmocka_unit_test(test_null),
      cmocka_unit_test(test_null_everywhere),
      cmocka_unit_test(test_silence),
      cmocka_unit_test(test_a_locale_with_commas),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
