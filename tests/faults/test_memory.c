/* Memory that runs out at the n-th call, for n = 1, 2, 3, ... until nothing fails: each function says so, leaves
 * nothing open and nothing behind. (What it leaks is for `make sanitize` to see.) */
#include "files/files.h"

#include "contact/contact.h"
#include "faults/inject.h"
#include "scene/scene.h"

static const char text[] =
    "box: [5, 4, 4]\ntime_step: 0.01\nsteps: 2\nseed: 1\nsolvent: {per_cell: 2, "
    "collision_interval: 0.02, thermostat: rescale}\nfibers:\n  - {name: a, count: 2, vertices: 4, "
    "mass: 5, bond_length: 0.5, spring: 100, bending: 4}\n  - {name: b, count: 1, vertices: 3, "
    "mass: 5, bond_length: 0.5, spring: 100, bending: 4, start: straight, "
    "places: [{center: [1, 1, 1], direction: [1, 0, 0]}]}\n";

/* What a function under test works with, made without failures. */
struct bench {
  struct test_run run, crowd;
  struct scene scene;
  char folder[64];
};

static void write_checkpoint(const struct bench *b, const char *path)
{
  struct message m;
  struct checkpoint_head head = {.seed = 1, .version = "test"};
  assert_true(checkpoint_write(path, &head, &b->run.model, &b->run.state, NULL, 0, text, &m));
}

/* Each makes something and frees it again; false if that failed. */
static bool try_model(struct bench *b)
{
  (void)b;
  struct model m = test_model(4, 4, 4, 5, 0.01, 2);
  struct model_error error;
  bool ok = model_finish(&m, &error);
  assert_true(ok || strncmp(error.text, "out of memory", 13) == 0);
  model_free(&m);
  return ok;
}

static bool try_state(struct bench *b)
{
  struct state s;
  if (!state_alloc(&s, &b->run.model))
    return false;
  state_free(&s);
  return true;
}

static bool try_work(struct bench *b)
{
  struct work w;
  if (!work_alloc(&w, &b->scene.model))
    return false;
  work_free(&w);
  return true;
}

static bool alloc_both(struct state *s, struct work *w, const struct model *m)
{
  if (!state_alloc(s, m))
    return false;
  if (work_alloc(w, m))
    return true;
  state_free(s);
  return false;
}

static bool try_start(struct bench *b)
{
  struct state s;
  struct work w;
  if (!alloc_both(&s, &w, &b->run.model))
    return false;
  bool ok = start_state(&s, &b->run.model, &w) && step_advance(&s, &b->run.model, &w, NULL);
  assert_true(ok || w.fault.code == FAULT_NO_MEMORY);
  work_free(&w);
  state_free(&s);
  return ok;
}

/* Fibers so fast and dense that lists grow in the middle of a sweep, and in every part of it. */
static bool try_crowd(struct bench *b)
{
  const struct state *from = &b->crowd.state;
  struct state s;
  struct work w;
  if (!alloc_both(&s, &w, &b->crowd.model))
    return false;
  memcpy(s.position, from->position, s.vertices * sizeof *s.position);
  for (uint32_t i = 0; i < s.vertices; i++)
    s.velocity[i] = vec3_scale(i % 5 ? 2.0 : 40.0, from->velocity[i]);
  bool ok = true;
  for (uint64_t step = 1; step <= 3; step++)
    ok = ok && contact_drift(&s, &b->crowd.model, &w.contact, 1.0, step, 0, NULL, &w.fault);
  assert_true(ok || w.fault.code == FAULT_NO_MEMORY);
  assert_true(!ok || s.counts.executed > 100);
  work_free(&w);
  state_free(&s);
  return ok;
}

static struct test_run crowd(void)
{
  struct model m = test_model(2, 2, 2, 0, 0.01, 2);
  m.crossing.rejection = REJECTION_BOUNCE;
  struct fiber_kind *k = test_add_kind(&m, 60, 8);
  k->spring = 100.0, k->bond_length = 0.5;
  return test_start(m);
}

static bool try_observers(struct bench *b)
{
  const struct observe_plan plan = {.every = {1, 1, 1, 1, 1}};
  struct observers *o = observers_create(&plan, &b->run.model);
  observers_free(o);
  return o != NULL;
}

static bool try_scene(struct bench *b)
{
  (void)b;
  struct scene s;
  struct message m = {.text = ""};
  if (!scene_read_text("t.yaml", text, strlen(text), &s, &m)) {
    assert_non_null(strstr(m.text, "t.yaml: out of memory"));
    return false;
  }
  scene_free(&s);
  return true;
}

/* The checkpoint that is there stays, byte for byte, and no part of a new one. */
static bool try_checkpoint_write(struct bench *b)
{
  struct checkpoint_head head = {.seed = 2, .version = "new"};
  const char *path = in_folder(b->folder, "c.h5");
  struct message m = {.text = ""};
  size_t before, after;
  char *old = slurp(path, &before);
  bool ok = checkpoint_write(path, &head, &b->run.model, &b->run.state, NULL, 0, text, &m);
  if (!ok) {
    char *found = slurp(path, &after);
    assert_int_equal(after, before);
    assert_memory_equal(found, old, before);
    assert_true(m.text[0] != '\0');
    assert_false(is_there(in_folder(b->folder, "c.h5.part")));
    free(found);
  }
  free(old);
  return ok;
}

static bool try_checkpoint_read(struct bench *b)
{
  struct checkpoint_head head;
  struct message m = {.text = ""};
  const char *path = in_folder(b->folder, "r.h5");
  bool ok = checkpoint_read(path, &b->run.model, &head, &b->run.state, NULL, 0, &m);
  assert_true(ok || m.text[0] != '\0');
  return ok;
}

static bool try_trajectory(struct bench *b)
{
  const struct trajectory_options options = {.solvent = true, .velocities = true, .seed = 1};
  const char *path = in_folder(b->folder, "t.h5");
  struct message m = {.text = ""};
  remove(path);
  struct trajectory *t = trajectory_open(path, &b->run.model, &options, false, 0, text, &m);
  if (!t) {
    assert_true(m.text[0] != '\0');
    assert_false(is_there(path));
    return false;
  }
  bool ok = trajectory_append(t, &b->run.model, &b->run.state, &m);
  assert_true(ok || m.text[0] != '\0');
  return trajectory_close(t, &m) && ok;
}

static const struct {
  const char *name;
  bool (*act)(struct bench *b);
  unsigned least; /* calls that can fail, at least */
} tries[] = {
    {"model_finish", try_model, 8},
    {"state_alloc", try_state, 9},
    {"work_alloc", try_work, 8},
    {"start_state, step_advance", try_start, 3},
    {"fiber_sweep", try_crowd, 25},
    {"observers_create", try_observers, 10},
    {"scene_read", try_scene, 10},
    {"checkpoint_write", try_checkpoint_write, 5},
    {"checkpoint_read", try_checkpoint_read, 4},
    {"trajectory_open", try_trajectory, 6},
};

static void test_memory_runs_out_at_every_call(void **unused)
{
  (void)unused;
  struct bench b = {.run = small_run(3), .crowd = crowd()};
  struct message m;
  make_folder(b.folder);
  assert_true(scene_read_text("t.yaml", text, strlen(text), &b.scene, &m));
  write_checkpoint(&b, in_folder(b.folder, "c.h5"));
  write_checkpoint(&b, in_folder(b.folder, "r.h5"));
  for (size_t k = 0; k < sizeof tries / sizeof *tries; k++) {
    unsigned n = 0;
    for (bool hit = true; hit;) {
      /* The test's own slurp counts too; it comes first, so its calls are left out. */
      inject_arm(INJECT_MEMORY, ++n + (tries[k].act == try_checkpoint_write), false);
      bool ok = tries[k].act(&b);
      hit = inject_disarm();
      if (ok == hit)
        fail_msg("%s: allocation %u %s, and it returned %s", tries[k].name, n, hit ? "failed" : "went well",
                 ok ? "true" : "false");
      assert_all_closed();
      assert_true(n < 1000);
    }
    print_message("  %s: %u allocations\n", tries[k].name, n - 1);
    if (n - 1 < tries[k].least)
      fail_msg("%s: only %u allocations were seen", tries[k].name, n - 1);
  }
  scene_free(&b.scene);
  test_end(&b.run);
  test_end(&b.crowd);
  remove_folder(b.folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_memory_runs_out_at_every_call)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
