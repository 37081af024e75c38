/* A key that comes to a table later: what it means in old files and in new scenes, in the fingerprint and in a resume.
 */
#include "support.h"

#include "scene/scene_keys.h"

/* The table of scenes, and one key more. It is stored where scenes without a trajectory have no use for the place. */
static const struct key with_novel[] = {
    {.type = KEY_INCLUDE, .keys = &scene_keys},
    {.name = "novel",
     .text = "A key that was added, and whose default has changed since.",
     .type = KEY_SWITCH,
     .absent = "false",
     .fallback = "true",
     .offset = offsetof(struct scene, trajectory_solvent)},
};
static const struct key_table novel_keys = {"", NULL, 2, with_novel};

/* The same key before its default changed. */
static const struct key with_young[] = {
    {.type = KEY_INCLUDE, .keys = &scene_keys},
    {.name = "novel",
     .text = "A key that was added.",
     .type = KEY_SWITCH,
     .absent = "false",
     .offset = offsetof(struct scene, trajectory_solvent)},
};
static const struct key_table young_keys = {"", NULL, 2, with_young};

/* It gives each key whose default has changed. */
static const char text[] = "# a comment\nbox: [4, 4, 4]\ntime_step: 0.01\nsteps: 1\n"
                           "solvent: {per_cell: 3, collision_interval: 0.01}\ncrossing: {rule: sequential}\n";

static struct scene read_by(const struct key_table *keys, const char *said, enum key_missing missing,
                            const uint64_t *fingerprint)
{
  struct scene scene;
  struct message message;
  const struct scene_source source = {.keys = keys,
                                      .path = "test.yaml",
                                      .text = said,
                                      .size = strlen(said),
                                      .missing = missing,
                                      .fingerprint = fingerprint,
                                      .message = &message};
  if (!scene_read_source(&source, &scene))
    fail_msg("%s", message.text);
  return scene;
}

/* Fingerprint of this text, and what the key is; the scene is freed. */
static uint64_t look(const struct key_table *keys, const char *said, enum key_missing missing,
                     const uint64_t *fingerprint, bool *novel)
{
  struct scene scene = read_by(keys, said, missing, fingerprint);
  const uint64_t found = scene.fingerprint;
  *novel = scene.trajectory_solvent;
  scene_free(&scene);
  return found;
}

static void a_new_key_changes_no_fingerprint(void **unused)
{
  (void)unused;
  char said[512];
  bool novel;
  const uint64_t old = look(&scene_keys, text, MISSING_DEFAULT, NULL, &novel);
  assert_true(look(&young_keys, text, MISSING_DEFAULT, NULL, &novel) == old && !novel);
  snprintf(said, sizeof said, "%snovel: false\n", text);
  assert_true(look(&young_keys, said, MISSING_DEFAULT, NULL, &novel) == old && !novel);
  snprintf(said, sizeof said, "%snovel: true\n", text);
  const uint64_t set = look(&young_keys, said, MISSING_DEFAULT, NULL, &novel);
  assert_true(set != old && novel);
  assert_true(look(&young_keys, said, MISSING_ABSENT, NULL, &novel) == set && novel);
}

static void a_new_default_is_for_new_scenes(void **unused)
{
  (void)unused;
  bool novel;
  const uint64_t old = look(&scene_keys, text, MISSING_DEFAULT, NULL, &novel);
  assert_true(look(&novel_keys, text, MISSING_ABSENT, NULL, &novel) == old && !novel);
  assert_true(look(&novel_keys, text, MISSING_DEFAULT, NULL, &novel) != old && novel);
}

/* A run that was begun when the default was another goes on as it was begun; one that was begun since, as well. */
static void a_run_keeps_what_it_was_begun_with(void **unused)
{
  (void)unused;
  char said[512];
  bool novel;
  const uint64_t begun_before = look(&young_keys, text, MISSING_DEFAULT, NULL, &novel);
  const uint64_t begun_since = look(&novel_keys, text, MISSING_DEFAULT, NULL, &novel);
  assert_true(look(&novel_keys, text, MISSING_DEFAULT, &begun_before, &novel) == begun_before && !novel);
  assert_true(look(&novel_keys, text, MISSING_DEFAULT, &begun_since, &novel) == begun_since && novel);
  /* what the file says holds, and a fingerprint that neither reading has is left for the caller to find */
  const uint64_t other = 12345;
  assert_true(look(&novel_keys, text, MISSING_DEFAULT, &other, &novel) == begun_since && novel);
  snprintf(said, sizeof said, "%snovel: true\n", text);
  assert_true(look(&novel_keys, said, MISSING_DEFAULT, &begun_before, &novel) == begun_since && novel);
  snprintf(said, sizeof said, "%snovel: false\n", text);
  assert_true(look(&novel_keys, said, MISSING_DEFAULT, &begun_since, &novel) == begun_before && !novel);
}

/* What is stored in files is read back with `absent` values, and must be the same scene: the file's own text where that
 * is so, the effective one where not. */
static void what_is_stored_reads_back(void **unused)
{
  (void)unused;
  static const struct key_table *const keys[] = {&scene_keys, &young_keys, &novel_keys};
  for (int k = 0; k < 3; k++) {
    struct scene scene = read_by(keys[k], text, MISSING_DEFAULT, NULL), again;
    again = read_by(keys[k], scene.text, MISSING_ABSENT, NULL);
    assert_true(again.fingerprint == scene.fingerprint);
    assert_true(again.trajectory_solvent == scene.trajectory_solvent && scene.trajectory_solvent == (k == 2));
    assert_true((strcmp(scene.text, text) == 0) == (k < 2));
    scene_free(&again);
    scene_free(&scene);
  }
}

/* What a file without a key of the first format means, as of commit af01d53. These rows never change; a new default
 * goes into `fallback`. */
static void absent_values_stay(void **unused)
{
  (void)unused;
  static const char bare[] =
      "box: [9, 9, 9]\ntime_step: 0.01\nsteps: 0\nsolvent: {per_cell: 3, collision_interval: 0.01}\n"
      "trajectory: {every: 1}\nobserve: {dynamics: {every: 1}}\n"
      "fibers: [{name: a, count: 1, vertices: 8, mass: 5, bond_length: 0.5, spring: 100}]\n";
  struct scene s = read_by(&scene_keys, bare, MISSING_ABSENT, NULL);
  char *said = NULL;
  size_t size;
  FILE *stream = open_memstream(&said, &size);
  assert_true(scene_write(&s, stream, false));
  fclose(stream);
  assert_string_equal(
      said,
      "box: [9, 9, 9]\ntime_step: 0.01\nseed: 1\norder: kick-split\nflow: [0, 0, 0]\ndimensions: 3\nsolvent:\n"
      "  per_cell: 3\n  collision_interval: 0.01\n  rotation_angle: 90\n  rule: srd\n  thermostat: none\n"
      "  hydrodynamics: true\n  bath: particles\n  acceleration: [0, 0, 0]\n  profile: uniform\nfibers:\n  - name: a\n"
      "    count: 1\n    vertices: 8\n    ring: false\n    frozen: false\n    held: none\n    mass: 5\n    "
      "bond_length: 0.5\n"
      "    spring: 100\n    bending: 0\n    diameter: 0\n    force: [0, 0, 0]\n    start: equilibrium\ncrossing:\n"
      "  forbidden: true\n  rule: sequential\n  exclusion: shared-vertex\n  refusal: stay\n  frame: laboratory\n"
      "steps: 0\nobserve:\n  dynamics: {every: 1, longest_lag: 0}\n"
      "trajectory: {every: 1, solvent: false, velocities: true}\ncheckpoint:\n  seconds: 300\n");
  free(said);
  scene_free(&s);
}

/* Every row says what it means, and its `absent` value and default are values that the key takes. */
static void check_rows(const struct key_table *table)
{
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    union {
      double number[3];
      char name[MODEL_NAME_SIZE];
    } value;
    if (key->keys)
      check_rows(key->keys);
    if (key->type == KEY_INCLUDE)
      continue;
    assert_true(key->text && *key->text);
    assert_true(strlen(key->text) < 1800);
    assert_false(key_is_required(key) && key->fallback);
    assert_true(!key->idle_with == !key->idle && (!key->idle || key_is_required(key)));
    const char *const texts[] = {key->absent, key->fallback, key->idle};
    for (int i = 0; i < 3; i++)
      if (texts[i] && !key_read_text(key, texts[i], &value))
        fail_msg("%s: '%s' is no value", key->name, texts[i]);
  }
}

static void rows_are_sound(void **unused)
{
  (void)unused;
  check_rows(&scene_keys);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_new_key_changes_no_fingerprint),
      cmocka_unit_test(a_new_default_is_for_new_scenes),
      cmocka_unit_test(a_run_keeps_what_it_was_begun_with),
      cmocka_unit_test(what_is_stored_reads_back),
      cmocka_unit_test(absent_values_stay),
      cmocka_unit_test(rows_are_sound),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
