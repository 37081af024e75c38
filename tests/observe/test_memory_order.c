/* Tables do not depend on where particles stand in memory: all observables of all shipped scenes, to the bit. In one
 * run memory is shuffled before each sample; a checkpoint, which sorts particles by number, does the same to it. */
#include <glob.h>

#include "exact.h"
#include "observe/meaning.h"
#include "scene/scene.h"

enum { STEPS = 12, EVERY = 3 };

/* Rows of series, then the memory of all observers. */
struct bytes {
  size_t size, room;
  unsigned char *data;
};

static void append(struct bytes *b, const void *data, size_t size)
{
  if (b->size + size > b->room) {
    b->room = 2 * (b->size + size);
    b->data = realloc(b->data, b->room);
    assert_non_null(b->data);
  }
  if (size > 0)
    memcpy(b->data + b->size, data, size);
  b->size += size;
}

static bool take_row(void *context, enum observable which, size_t columns, const double *values)
{
  append(context, &which, sizeof which);
  append(context, values, columns * sizeof *values);
  return true;
}

static struct observe_plan all_of(const struct model *m)
{
  struct observe_plan plan = {.slabs = 4, .longest_lag = 4 * EVERY};
  for (int k = 0; k < OBSERVABLES; k++)
    plan.every[k] = meaning_refusal(m, (enum observable)k) ? 0 : EVERY;
  return plan;
}

static struct bytes run(const struct scene *scene, struct dice *dice)
{
  const struct model *m = &scene->model;
  const struct observe_plan plan = all_of(m);
  struct bytes found = {0, 0, NULL};
  const struct observe_sink sink = {take_row, &found};
  struct observers *o = observers_create(&plan, m);
  struct state state;
  struct work work;
  const struct observe_block *block;
  assert_true(o && state_alloc(&state, m) && work_alloc(&work, m) && start_state(&state, m, &work));
  observers_watch(o, &work);
  for (int step = 0; step <= STEPS; step++) {
    if (dice)
      shuffle_memory(&state, dice);
    assert_true(observers_sample(o, m, &state, &sink));
    assert_true(step == STEPS || step_advance(&state, m, &work, observers_contacts(o)));
  }
  const struct conserved end = observe_conserved(m, &state); /* as run.json has it */
  append(&found, &end, sizeof end);
  const size_t blocks = observers_blocks(o, &block);
  for (size_t k = 0; k < blocks; k++)
    append(&found, block[k].data, block[k].count * sizeof(double));
  observers_free(o);
  work_free(&work);
  state_free(&state);
  return found;
}

static void compare(const char *path)
{
  struct scene scene;
  struct message message;
  struct dice dice = {dice_seed(3801)};
  if (!scene_read(path, &scene, &message))
    fail_msg("%s: %s", path, message.text);
  struct bytes as_it_is = run(&scene, NULL), shuffled = run(&scene, &dice);
  print_message("  %s: %zu bytes\n", path, as_it_is.size);
  assert_int_equal(as_it_is.size, shuffled.size);
  if (memcmp(as_it_is.data, shuffled.data, as_it_is.size) != 0)
    fail_msg("%s: tables depend on the order in memory", path);
  free(as_it_is.data);
  free(shuffled.data);
  scene_free(&scene);
}

static void shipped_scenes(void **unused)
{
  (void)unused;
  glob_t found;
  assert_int_equal(glob("scenes/*.yaml", 0, NULL, &found), 0);
  assert_true(found.gl_pathc >= 15);
  for (size_t k = 0; k < found.gl_pathc; k++)
    compare(found.gl_pathv[k]);
  globfree(&found);
}

/* What no shipped scene has: a medium with forces of pairs; walls that attract dumbbells. */
static void others(void **unused)
{
  (void)unused;
  compare("tests/observe/dpd.yaml");
  compare("tests/observe/attracted.yaml");
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(shipped_scenes), cmocka_unit_test(others)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
