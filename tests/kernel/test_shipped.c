/* The shipped scenes, a few steps of each by the plain kernel and by every fast one: the same state hashes. They are
 * printed, so that builds by different compilers can be compared. There is no tolerance. */
#include <glob.h>

#include "kernel/choose.h"
#include "scene/scene.h"
#include "support.h"

enum { STEPS = 8 };

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

static void compare(const char *path)
{
  const uint64_t plain = hash_after(path, &kernel_plain);
  uint32_t kernels = 0;
  for (size_t k = 0; k < kernel_row_count; k++)
    if (kernel_rows[k].runs()) {
      if (hash_after(path, kernel_rows[k].kernel) != plain)
        fail_msg("%s: another hash by the kernel %s", path, kernel_rows[k].kernel->name);
      kernels++;
    }
  print_message("  %s %016llx, %u kernels\n", path, (unsigned long long)plain, kernels);
}

static void shipped_scenes_have_one_hash(void **unused)
{
  (void)unused;
  glob_t found;
  assert_int_equal(glob("scenes/*.yaml", 0, NULL, &found), 0);
  for (size_t k = 0; k < found.gl_pathc; k++)
    compare(found.gl_pathv[k]);
  assert_true(found.gl_pathc >= 15);
  globfree(&found);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(shipped_scenes_have_one_hash)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
