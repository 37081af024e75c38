/* The library when memory or files fail at the n-th call, for n = 1, 2, 3, ... until nothing fails: an error that says
 * so, a handle that can be freed, nothing left open. (What it leaks is for `make sanitize` to see.) */
#include "files/files.h"

#include "faults/inject.h"
#include "uncross.h"

static const char text[] =
    "box: [5, 4, 4]\ntime_step: 0.01\nsteps: 4\nseed: 1\n"
    "solvent: {per_cell: 2, collision_interval: 0.02, thermostat: rescale}\n"
    "fibers:\n  - {name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 4}\n"
    "observe: {conserved: {every: 1}, statics: {every: 1}}\ntrajectory: {every: 2}\n";

static const struct {
  const char *name;
  enum inject_kind kind;
} kinds[] = {{"memory", INJECT_MEMORY}, {"file", INJECT_FILE}, {"hdf5", INJECT_HDF5}};

/* What a try works with, made without failures. */
struct bench {
  char folder[64];
  uncross_scene *scene;
  uint64_t hash; /* after four steps */
  bool hit;      /* the failure was seen within a try */
};

/* Each returns whether all went well; an error that is not empty otherwise. */
typedef bool attempt(struct bench *b, uncross_error *error);

static bool try_scene(struct bench *b, uncross_error *error)
{
  static const char *const settings[] = {"solvent.per_cell=3",  "fibers.1.name=b",        "fibers.1.count=1",
                                         "fibers.1.vertices=1", "fibers.1.bond_length=0", "fibers.1.mass=1",
                                         "fibers.1.spring=1"};
  (void)b;
  uncross_scene *scene = uncross_scene_parse("t.yaml", text, settings, 7, error);
  char *effective = scene ? uncross_scene_text(scene, error) : NULL;
  char *one = effective ? uncross_scene_get(scene, "fibers.1.name", error) : NULL;
  const bool ok = one != NULL;
  uncross_free(effective);
  uncross_free(one);
  uncross_scene_free(scene);
  return ok;
}

static bool check_hash(const struct bench *b, const uncross_sim *sim, uncross_error *error)
{
  uint64_t hash;
  if (uncross_sim_hash(sim, &hash, error) != UNCROSS_OK)
    return false;
  assert_int_equal(hash, b->hash);
  return true;
}

static bool try_sim(struct bench *b, uncross_error *error)
{
  const uncross_table *const *tables;
  size_t count;
  uncross_sim *sim = uncross_sim_start(b->scene, error);
  const bool ok = sim && uncross_sim_advance(sim, 4, error) == UNCROSS_OK &&
                  uncross_sim_tables(sim, &tables, &count, error) == UNCROSS_OK && check_hash(b, sim, error);
  uncross_sim_free(sim);
  return ok;
}

/* A checkpoint that cannot be written leaves the simulation as it is, and the older file. */
static bool try_save(struct bench *b, uncross_error *error)
{
  const char *path = in_folder(b->folder, "c.h5");
  uncross_sim *sim = uncross_sim_start(b->scene, error);
  bool ok = sim && uncross_sim_advance(sim, 4, error) == UNCROSS_OK;
  if (ok)
    ok = uncross_sim_save(sim, path, error) == UNCROSS_OK;
  if (sim && !ok && uncross_sim_step(sim) == 4 && error->code == UNCROSS_NOT_WRITTEN) {
    b->hit = inject_disarm();
    assert_true(check_hash(b, sim, NULL));
  }
  uncross_sim_free(sim);
  return ok;
}

static bool try_resume(struct bench *b, uncross_error *error)
{
  uncross_sim *sim = uncross_sim_resume(b->scene, in_folder(b->folder, "half.h5"), error);
  const bool ok = sim && uncross_sim_advance(sim, 2, error) == UNCROSS_OK && check_hash(b, sim, error);
  uncross_sim_free(sim);
  return ok;
}

static bool try_run(struct bench *b, uncross_error *error)
{
  char remove[128];
  snprintf(remove, sizeof remove, "rm -rf %s/run", b->folder);
  uncross_run *run = uncross_run_open(b->scene, in_folder(b->folder, "run"), UNCROSS_NEW, error);
  const bool ok = run && uncross_run_advance(run, 3, NULL, NULL, error) == UNCROSS_OK &&
                  uncross_run_save(run, error) == UNCROSS_OK &&
                  uncross_run_advance(run, 3, NULL, NULL, error) == UNCROSS_OK &&
                  uncross_run_close(run, error) == UNCROSS_OK && check_hash(b, uncross_run_sim(run), error);
  uncross_run_free(run);
  assert_int_equal(system(remove), 0);
  return ok;
}

static const struct {
  const char *name;
  attempt *act;
  unsigned least[3]; /* calls of each kind that can fail, at least */
} tries[] = {
    {"scene", try_scene, {30, 0, 0}},
    {"start, advance, tables", try_sim, {30, 0, 0}},
    {"save", try_save, {30, 3, 20}},
    {"resume", try_resume, {30, 2, 20}},
    {"run in a folder", try_run, {40, 20, 100}},
};

/* Every failure of one kind, up to 150 of them at even distances. */
static void fail_each(struct bench *b, size_t t, size_t k)
{
  unsigned n = 0, borne = 0, stride = kinds[k].kind == INJECT_HDF5 ? 7 : 1;
  for (bool hit = true; hit && n < 3000;) {
    uncross_error error = {.code = -1};
    n = borne ? n + stride : 1;
    inject_arm(kinds[k].kind, n, false);
    const bool ok = tries[t].act(b, &error);
    hit = inject_disarm() || b->hit;
    b->hit = false;
    borne++;
    if (!ok && (error.code <= 0 || error.message[0] == '\0'))
      fail_msg("%s: %s call %u failed, without an error (code %d)", tries[t].name, kinds[k].name, n, error.code);
    if (!ok && !hit)
      fail_msg("%s: nothing failed, but: %s", tries[t].name, error.message);
    /* run.json says null for an energy that could not be measured; all else is an error */
    if (ok && hit && kinds[k].kind == INJECT_MEMORY && tries[t].act != try_run)
      fail_msg("%s: allocation %u failed, and nobody saw it", tries[t].name, n);
    assert_int_equal(H5Fget_obj_count((hid_t)H5F_OBJ_ALL, H5F_OBJ_ALL), 0);
  }
  print_message("  %s: about %u calls of %s\n", tries[t].name, n - 1, kinds[k].name);
  if (n - 1 < tries[t].least[k])
    fail_msg("%s: only %u calls of %s were seen", tries[t].name, n - 1, kinds[k].name);
}

static void test_failures_are_values(void **unused)
{
  (void)unused;
  struct bench b = {.hit = false};
  uncross_error error;
  make_folder(b.folder);
  b.scene = uncross_scene_parse("t.yaml", text, NULL, 0, &error);
  assert_non_null(b.scene);
  uncross_sim *sim = uncross_sim_start(b.scene, &error);
  uncross_sim_advance(sim, 2, &error);
  assert_int_equal(uncross_sim_save(sim, in_folder(b.folder, "half.h5"), &error), UNCROSS_OK);
  uncross_sim_advance(sim, 2, &error);
  assert_int_equal(uncross_sim_hash(sim, &b.hash, &error), UNCROSS_OK);
  uncross_sim_free(sim);
  for (size_t t = 0; t < sizeof tries / sizeof *tries; t++)
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
      fail_each(&b, t, k);
  uncross_scene_free(b.scene);
  remove_folder(b.folder);
}

static herr_t print_loudly(hid_t stack, void *context)
{
  (void)stack;
  ++*(int *)context;
  return 0;
}

/* HDF5's error printing is the host's: not called within calls of the library, and there again after them. */
static void test_the_host_keeps_its_error_printing(void **unused)
{
  (void)unused;
  int printed = 0;
  H5E_auto2_t print;
  void *context;
  uncross_error error;
  char folder[64];
  make_folder(folder);
  uncross_scene *scene = uncross_scene_parse("t.yaml", text, NULL, 0, &error);
  uncross_sim *sim = uncross_sim_start(scene, &error);
  assert_int_equal(uncross_sim_save(sim, in_folder(folder, "c.h5"), &error), UNCROSS_OK);
  assert_int_equal(truncate(in_folder(folder, "c.h5"), 3000), 0);
  H5Eset_auto2(H5E_DEFAULT, print_loudly, &printed);
  assert_null(uncross_sim_resume(scene, in_folder(folder, "c.h5"), &error));
  assert_null(uncross_run_open(scene, in_folder(folder, "none"), UNCROSS_RESUME, &error));
  assert_int_equal(printed, 0);
  H5Eget_auto2(H5E_DEFAULT, &print, &context);
  assert_true(print == print_loudly);
  assert_ptr_equal(context, &printed);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  uncross_sim_free(sim);
  uncross_scene_free(scene);
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_failures_are_values),
                                     cmocka_unit_test(test_the_host_keeps_its_error_printing)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
