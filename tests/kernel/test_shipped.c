/*
 * The shipped scenes, a few steps of each by the plain kernel and by every fast one: the state hashes of
 * shipped.txt, which all compilers and processors give. There is no tolerance.
 *
 * A change of physics that is meant writes them anew: the lines of its output that begin with scenes/, without what
 * follows the comma.
 */
#include <glob.h>
#include <inttypes.h>
#include <stdio.h>

#include "kernel/choose.h"
#include "scene/scene.h"
#include "support.h"

enum { STEPS = 8 };
#define WRITTEN "tests/kernel/shipped.txt"

static uint64_t hash_after(const char *path, const struct kernel *kernel)
{
  struct scene scene;
  struct message message = {0};
  struct state state;
  struct work work;
  if (!scene_read(path, &scene, &message))
    fail_msg("%s: %s", path, message.text);
  const struct model *m = &scene.model;
  assert_true(state_alloc(&state, m));
  assert_true(work_alloc(&work, m));
  work.mpc.kernel = kernel_mix(kernel, m);
  assert_true(start_state(&state, m, &work));
  for (int k = 0; k < STEPS; k++)
    assert_true(step_advance(&state, m, &work, NULL));
  const uint64_t hash = state_hash(&state);
  work_free(&work);
  state_free(&state);
  scene_free(&scene);
  return hash;
}

/* The hash that shipped.txt has for a scene; 0: none. */
static uint64_t hash_written(const char *path)
{
  char name[256];
  uint64_t hash, found = 0;
  FILE *file = fopen(WRITTEN, "r");
  assert_non_null(file);
  while (!found && fscanf(file, "%255s %" SCNx64, name, &hash) == 2)
    found = strcmp(name, path) == 0 ? hash : 0;
  fclose(file);
  return found;
}

/* Whether the scene has the hash that is written. */
static bool compare(const char *path)
{
  const uint64_t plain = hash_after(path, &kernel_plain);
  uint32_t kernels = 0;
  for (size_t k = 0; k < kernel_row_count; k++)
    if (kernel_rows[k].runs()) {
      if (hash_after(path, kernel_rows[k].kernel) != plain)
        fail_msg("%s: another hash by the kernel %s", path, kernel_rows[k].kernel->name);
      kernels++;
    }
  print_message("  %s %016" PRIx64 ", %u kernels\n", path, plain, kernels);
  return plain == hash_written(path);
}

static void shipped_scenes_have_one_hash(void **unused)
{
  (void)unused;
  glob_t found;
  assert_int_equal(glob("scenes/*.yaml", 0, NULL, &found), 0);
  size_t same = 0;
  for (size_t k = 0; k < found.gl_pathc; k++)
    same += compare(found.gl_pathv[k]);
  assert_true(found.gl_pathc >= 15);
  if (same < found.gl_pathc)
    fail_msg("%zu of %zu scenes have another hash than in " WRITTEN, found.gl_pathc - same, found.gl_pathc);
  globfree(&found);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(shipped_scenes_have_one_hash)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
