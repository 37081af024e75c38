/* run.json: every number as it was, what JSON cannot hold, and nothing half written. */
#include "files/files.h"

#include <inttypes.h>
#include <jansson.h>
#include <sys/utsname.h>
#include <time.h>

#include "files/record.h"
#include "version.h"

static const char text[] = "box: [4, 4, 5] # \"quoted\", \\ and \xc3\xa5\n"
                           "time_step: 0.01\nsteps: 9223372036854775807\nseed: 18446744073709551615\n"
                           "solvent: {per_cell: 2, collision_interval: 0.02}\n"
                           "fibers: [{name: f, count: 2, vertices: 3, mass: 5, bond_length: 0.5, spring: 100}]\n";

static struct test_run read_and_start(struct scene *scene)
{
  struct message message;
  if (!scene_read_text("text", text, strlen(text), scene, &message))
    fail_msg("%s", message.text);
  struct test_run r = {.model = scene->model};
  assert_true(state_alloc(&r.state, &r.model) && work_alloc(&r.work, &r.model));
  assert_true(start_state(&r.state, &r.model, &r.work));
  test_steps(&r, 4);
  return r;
}

static void forget(struct scene *scene, struct test_run *r)
{
  work_free(&r->work);
  state_free(&r->state);
  scene_free(scene);
}

static json_t *load(const char *folder)
{
  json_error_t error;
  json_t *root = json_load_file(in_folder(folder, "run.json"), JSON_REJECT_DUPLICATES, &error);
  if (!root)
    fail_msg("run.json:%d: %s", error.line, error.text);
  return root;
}

static void assert_text(const json_t *root, const char *key, const char *expected)
{
  const char *found = json_string_value(json_object_get(root, key));
  if (!found || strcmp(found, expected) != 0)
    fail_msg("%s: %s instead of %s", key, found ? found : "no text", expected);
}

static void assert_number(const json_t *root, const char *key, double expected)
{
  const json_t *found = json_object_get(root, key);
  if (!json_is_number(found) || !(json_number_value(found) == expected))
    fail_msg("%s: %.17g instead of %.17g", key, json_number_value(found), expected);
}

static void assert_conserved(const json_t *root, const char *key, double energy, struct vec3 p)
{
  const json_t *part = json_object_get(root, key), *momentum = json_object_get(part, "momentum");
  assert_number(part, "energy", energy);
  assert_int_equal(json_array_size(momentum), 3);
  const double expected[3] = {p.x, p.y, p.z};
  for (size_t k = 0; k < 3; k++)
    if (!(json_number_value(json_array_get(momentum, k)) == expected[k]))
      fail_msg("%s, momentum %zu: %.17g instead of %.17g", key, k, json_number_value(json_array_get(momentum, k)),
               expected[k]);
}

static void utc_now(char said[32])
{
  struct tm parts;
  const time_t now = time(NULL);
  assert_non_null(gmtime_r(&now, &parts));
  assert_int_equal(strftime(said, 32, "%Y-%m-%dT%H:%M:%SZ", &parts), 20);
}

static void everything_reads_back(void **unused)
{
  (void)unused;
  char folder[64], hash[32];
  make_folder(folder);
  struct scene scene;
  struct test_run r = read_and_start(&scene);
  scene.fingerprint = 0x12ab;
  r.state.counts = (struct collision_counts){9007199254740993u, 30, 20, 10, 5, 2}; /* 2^53 + 1: no double holds it */
  const struct conserved now = observe_conserved(&r.model, &r.state);
  const struct record record = {
      .status = "finished",
      .stream = {0xfedcba9876543210u, STREAM_SNAPSHOT, 0, UINT64_MAX, 9007199254740993u, 0xabcu},
      .step = r.state.step,
      .counts = r.state.counts,
      .wall_seconds = 1.0 / 3.0,
      .steps_per_second = 5e-324,
      .start_energy = -1e300,
      .start_momentum = {0.1, -0.2, 0.3},
      .now = now,
      .state_hash = state_hash(&r.state),
      .state_digest = 0xfeedu};
  struct message message;
  char before[32];
  utc_now(before);
  if (!record_write(by_name(folder), &scene, &record, &message))
    fail_msg("%s", message.text);
  snprintf(hash, sizeof hash, "%016" PRIx64, state_hash(&r.state));

  json_t *root = load(folder);
  assert_text(root, "status", "finished");
  assert_true(json_is_null(json_object_get(root, "reason")));
  assert_text(root, "program", "uncross");
  assert_text(root, "version", UNCROSS_VERSION);
  assert_text(root, "seed", "18446744073709551615"); /* a text: readers of JSON would round the number */
  assert_text(root, "stream", "18364758544493064720");
  const json_t *from = json_object_get(root, "stream_from");
  assert_text(from, "stream", "18446744073709551615");
  assert_text(from, "state", "0000000000000abc");
  assert_true(json_integer_value(json_object_get(from, "step")) == 9007199254740993);
  assert_text(root, "scene_fingerprint", "00000000000012ab");
  assert_text(root, "state_hash", hash);
  assert_text(root, "state_digest", "000000000000feed");
  struct utsname name;
  assert_int_equal(uname(&name), 0);
  assert_text(root, "host", name.nodename);
  char after[32];
  utc_now(after);
  const char *date = json_string_value(json_object_get(root, "date")); /* such texts stand in the order of time */
  assert_true(date && strcmp(before, date) <= 0 && strcmp(date, after) <= 0);
  assert_non_null(json_object_get(root, "processor"));
  assert_text(root, "scene", text);
  assert_int_equal(json_integer_value(json_object_get(root, "steps")), 4);
  assert_true(json_integer_value(json_object_get(root, "steps_wanted")) == INT64_MAX);
  assert_number(root, "time", 0.04);
  assert_number(root, "wall_seconds", 1.0 / 3.0);
  assert_number(root, "steps_per_second", 5e-324);
  assert_conserved(root, "start", -1e300, record.start_momentum);
  assert_conserved(root, "end", now.total, now.momentum);
  const json_t *counts = json_object_get(root, "collisions");
  assert_true(json_integer_value(json_object_get(counts, "moves")) == 9007199254740993);
  assert_int_equal(json_integer_value(json_object_get(counts, "possible")), 30);
  assert_int_equal(json_integer_value(json_object_get(counts, "executed")), 20);
  assert_int_equal(json_integer_value(json_object_get(counts, "negative")), 10);
  assert_int_equal(json_integer_value(json_object_get(counts, "softened")), 5);
  assert_int_equal(json_integer_value(json_object_get(counts, "rigid")), 2);
  const json_t *warnings = json_object_get(root, "warnings");
  const size_t of_scene = (size_t)scene_warnings(&scene, NULL, NULL);
  assert_int_equal(json_array_size(warnings), of_scene + 1);
  assert_int_equal(strncmp(json_string_value(json_array_get(warnings, of_scene)), "2 contacts found no impulse", 27),
                   0);
  static const char *const build[] = {"commit", "compiler", "flags"};
  for (int k = 0; k < 3; k++)
    assert_true(json_string_length(json_object_get(root, build[k])) > 0);
  assert_int_equal(json_object_size(root), 27);
  json_decref(root);
  forget(&scene, &r);
  remove_folder(folder);
}

static void what_json_cannot_hold_is_null(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct scene scene;
  struct test_run r = read_and_start(&scene);
  const struct record record = {
      .status = "stopped", .reason = "too hot", .start_energy = NAN, .start_momentum = {INFINITY, 0.0, -INFINITY}};
  struct message message;
  assert_true(record_write(by_name(folder), &scene, &record, &message));
  json_t *root = load(folder);
  const json_t *start = json_object_get(root, "start"), *momentum = json_object_get(start, "momentum");
  assert_text(root, "reason", "too hot");
  assert_true(json_is_null(json_object_get(root, "stream_from")));
  assert_true(json_is_null(json_object_get(start, "energy")));
  assert_true(json_is_null(json_array_get(momentum, 0)) && json_is_null(json_array_get(momentum, 2)));
  assert_true(json_number_value(json_array_get(momentum, 1)) == 0.0 && json_is_real(json_array_get(momentum, 1)));
  json_decref(root);
  forget(&scene, &r);
  remove_folder(folder);
}

/* A record that cannot be written leaves the one that is there, and nothing beside it. */
static void the_old_record_stays(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct scene scene;
  struct test_run r = read_and_start(&scene);
  struct record record = {.status = "running"};
  struct message message;
  assert_true(record_write(by_name(folder), &scene, &record, &message));
  size_t bytes, again;
  char *before = slurp(in_folder(folder, "run.json"), &bytes);

  record.status = "finished";
  limit_files(100);
  const bool written = record_write(by_name(folder), &scene, &record, &message);
  limit_files(RLIM_INFINITY);
  assert_false(written);
  assert_non_null(strstr(message.text, "/run.json: cannot write"));
  record.status = "\xff"; /* not UTF-8 */
  assert_false(record_write(by_name(folder), &scene, &record, &message));
  assert_non_null(strstr(message.text, "/run.json: no memory"));
  assert_false(record_write(by_name(in_folder(folder, "none")), &scene, &record, &message));

  char *after = slurp(in_folder(folder, "run.json"), &again);
  assert_int_equal(again, bytes);
  assert_memory_equal(after, before, bytes);
  assert_false(is_there(in_folder(folder, "run.json.part")));
  free(before);
  free(after);
  remove(in_folder(folder, "run.json"));
  assert_int_equal(mkdir(in_folder(folder, "run.json"), 0700), 0); /* nothing can be renamed to it */
  record.status = "running";
  assert_false(record_write(by_name(folder), &scene, &record, &message));
  assert_false(is_there(in_folder(folder, "run.json.part")));
  forget(&scene, &r);
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(everything_reads_back),
      cmocka_unit_test(what_json_cannot_hold_is_null),
      cmocka_unit_test(the_old_record_stays),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
