/* Which random numbers a run draws: system/stream.h. tests/files/test_streams.py compares the noise itself. */
#include "files/files.h"

#include <xxhash.h>

#include "files/run.h"
#include "scene/made.h"

static const char *const settings[] = {"box=[8, 8, 8]",
                                       "time_step=0.01",
                                       "steps=100",
                                       "seed=77",
                                       "crossing.forbidden=false",
                                       "medium.kind=overdamped",
                                       "medium.rate=1",
                                       "fibers.0.name=p",
                                       "fibers.0.count=5",
                                       "fibers.0.vertices=1",
                                       "fibers.0.mass=1",
                                       ""};
enum { SETTINGS = sizeof settings / sizeof *settings };

struct begun {
  struct scene scene;
  struct state state;
  struct work work;
  struct observers *observers;
  struct checkpoint_head head;
};

static struct run_parts parts_of(struct begun *b)
{
  return (struct run_parts){&b->scene, &b->state, &b->work, b->observers};
}

/* A run of the scene, which starts from this snapshot; NULL: from nothing. */
static void prepare(struct begun *b, const char *snapshot)
{
  const char *option[SETTINGS];
  char start[200];
  struct message message;
  memset(b, 0, sizeof *b);
  memcpy(option, settings, sizeof option);
  snprintf(start, sizeof start, "start.snapshot=%s", snapshot ? snapshot : "");
  option[SETTINGS - 1] = start;
  if (!scene_make(&(struct scene_settings){SETTINGS - !snapshot, option, 0}, &b->scene, &message))
    fail_msg("%s", message.text);
  b->observers = observers_create(&b->scene.observe, &b->scene.model);
  assert_true(state_alloc(&b->state, &b->scene.model) && work_alloc(&b->work, &b->scene.model) && b->observers);
}

static void begin(struct begun *b, const char *snapshot)
{
  struct message message;
  prepare(b, snapshot);
  const struct run_parts parts = parts_of(b);
  if (run_begin(&parts, &b->head, &message) != RUN_FINE)
    fail_msg("%s", message.text);
  assert_true(b->scene.model.seed == b->head.stream.key && b->head.seed == 77);
}

static void advance(struct begun *b, int steps)
{
  for (int k = 0; k < steps; k++)
    assert_true(step_advance(&b->state, &b->scene.model, &b->work, NULL));
}

static void save(struct begun *b, const char *path)
{
  struct message message;
  if (!checkpoint_write(path, &b->head, &b->scene.model, &b->state, NULL, 0, b->scene.text, &message))
    fail_msg("%s", message.text);
}

static void end(struct begun *b)
{
  observers_free(b->observers);
  work_free(&b->work);
  state_free(&b->state);
  scene_free(&b->scene);
}

static void a_snapshot_makes_a_stream(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct begun own, from, again;
  begin(&own, NULL);
  assert_true(own.head.stream.key == 77 && own.head.stream.from == STREAM_SEED);
  advance(&own, 30);
  const char *first = in_folder(folder, "first.h5"), *second = in_folder(folder, "second.h5");
  save(&own, first);
  begin(&from, first);
  own.state.step = 0;
  const uint64_t word[4] = {77, 77, 30, state_hash(&own.state)};
  assert_true(from.head.stream.key == XXH64(word, sizeof word, 0));
  assert_true(from.head.stream.parent == 77 && from.head.stream.parent_step == 30);
  advance(&from, 4);
  save(&from, second);
  begin(&again, second);
  from.state.step = 0;
  const uint64_t next[4] = {77, from.head.stream.key, 4, state_hash(&from.state)};
  assert_true(again.head.stream.key == XXH64(next, sizeof next, 0));
  end(&own), end(&from), end(&again);
  remove_folder(folder);
}

/* start.stream: seed. Traces of reference-data have it by their scenes. */
static void a_scene_may_ask_for_the_stream_of_its_seed(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct begun own, asked;
  struct message message;
  const char *first = in_folder(folder, "first.h5");
  begin(&own, NULL);
  advance(&own, 3);
  save(&own, first);
  prepare(&asked, first);
  assert_int_equal(asked.scene.stream, SCENE_STREAM_OWN);
  asked.scene.stream = SCENE_STREAM_SEED;
  const struct run_parts of = parts_of(&asked);
  if (run_begin(&of, &asked.head, &message) != RUN_FINE)
    fail_msg("%s", message.text);
  assert_true(asked.head.stream.key == 77 && asked.head.stream.from == STREAM_ASKED && asked.scene.model.seed == 77);
  assert_true(asked.head.stream.parent == 77 && asked.head.stream.parent_step == 3);
  end(&own), end(&asked);
  remove_folder(folder);
}

static void a_resume_keeps_its_stream(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct begun own, whole, parts;
  struct message message;
  const char *first = in_folder(folder, "first.h5"), *half = in_folder(folder, "half.h5");
  begin(&own, NULL);
  advance(&own, 3);
  save(&own, first);
  begin(&whole, first);
  advance(&whole, 3);
  save(&whole, half);
  advance(&whole, 3);
  prepare(&parts, first);
  const struct run_parts of = parts_of(&parts);
  if (run_continue(&of, half, NULL, &parts.head, &message) != RUN_FINE)
    fail_msg("%s", message.text);
  assert_memory_equal(&parts.head.stream, &whole.head.stream, sizeof whole.head.stream);
  assert_true(parts.scene.seed == 77 && parts.scene.model.seed == whole.head.stream.key);
  advance(&parts, 3);
  assert_true(state_hash(&parts.state) == state_hash(&whole.state));
  end(&own), end(&whole), end(&parts);
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_snapshot_makes_a_stream),
      cmocka_unit_test(a_scene_may_ask_for_the_stream_of_its_seed),
      cmocka_unit_test(a_resume_keeps_its_stream),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
