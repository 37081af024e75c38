/* Frames hold the very numbers of the state; info knows each sort of file. */
#include "files/files.h"

#include <fcntl.h>

#include "files/frames.h"
#include "fluid/fluid.h"
#include "scene/yaml.h"

static const struct trajectory_options everything = {.solvent = true, .velocities = true, .seed = 42};

/* A trajectory of `frames` frames, two steps apart, and a checkpoint of the last. */
static void write_both(const char *frames_path, const char *checkpoint_path, struct test_run *r, int frames)
{
  struct message message = {.text = ""};
  struct trajectory *t = trajectory_open(frames_path, &r->model, &everything, false, 0, "a: 1\n", &message);
  bool ok = t != NULL;
  for (int k = 0; ok && k < frames; k++) {
    test_steps(r, k == 0 ? 1 : 2);
    ok = trajectory_append(t, &r->model, &r->state, &message);
  }
  struct checkpoint_head head = {.version = "0.1.0", .seed = 42};
  ok = ok && trajectory_close(t, &message) &&
       checkpoint_write(checkpoint_path, &head, &r->model, &r->state, NULL, 0, "a: 1\n", &message);
  if (!ok)
    fail_msg("%s", message.text);
}

static void assert_row_is_vertex(const struct frames *f, const struct test_run *r, uint32_t v)
{
  const double *row = f->picture.position + 3 * (size_t)v, *moves = f->picture.velocity + 3 * (size_t)v;
  const struct vec3 x = point_in_a0(r->state.position[v]), u = r->state.velocity[v];
  assert_true(row[0] == x.x && row[1] == x.y && row[2] == x.z);
  assert_true(moves[0] == u.x && moves[1] == u.y && moves[2] == u.z);
  assert_int_equal(f->structure.next[v], r->model.next[v]);
  assert_string_equal(structure_name(&f->structure, f->structure.species[v]), v < 40 ? "kind1" : "kind2");
}

static void numbers_survive(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path[] = {in_folder(folder, "trajectory.h5"), in_folder(folder, "checkpoint.h5")};
  struct test_run r = small_run(0);
  write_both(path[0], path[1], &r, 4);
  assert_true(r.state.solvent_lag > 0);
  uint32_t *slot = malloc(r.state.solvent.n * sizeof *slot);
  state_solvent_slots(&r.state, slot);
  for (int k = 0; k < 2; k++) {
    enum h5_trouble trouble;
    struct message message;
    struct frames *f = frames_open(path[k], &trouble, &message);
    assert_non_null(f);
    assert_int_equal(f->about.frames, k == 0 ? 4 : 1);
    assert_int_equal(f->about.rows, r.state.vertices + r.state.solvent.n);
    assert_int_equal(frames_read(f, f->about.frames - 1, &message), FRAME_FINE);
    const struct picture *p = &f->picture;
    assert_true(p->step == 7 && p->time == 0.07 && p->edge[0] == 6.0 && p->edge[1] == 5.0 && p->edge[2] == 7.0);
    for (uint32_t v = 0; v < r.state.vertices; v++)
      assert_row_is_vertex(f, &r, v);
    for (uint32_t id = 0; id < r.state.solvent.n; id++) {
      const double *row = p->position + 3 * (size_t)(r.state.vertices + id);
      const struct vec3 x = point_in_a0(fluid_position_now(&r.state, &r.model, slot[id]));
      assert_true(row[0] == x.x && row[1] == x.y && row[2] == x.z);
    }
    assert_int_equal(frames_read(f, f->about.frames, &message), FRAME_LOST);
    assert_non_null(strstr(message.text, k == 0 ? "frame 4 asked for; it has 4" : "frame 1 asked for; it has 1"));
    frames_close(f);
  }
  free(slot);
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

/* What file_info prints, in `text`; false with its message there. */
static bool told(const char *folder, const char *path, char text[4096])
{
  struct message message = {.text = ""};
  const char *capture = in_folder(folder, "stdout");
  fflush(stdout);
  int keep = dup(1), fd = open(capture, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(fd, 1);
  bool ok = file_info(path, &message);
  fflush(stdout);
  dup2(keep, 1);
  close(keep);
  close(fd);
  size_t bytes;
  char *printed = slurp(capture, &bytes);
  snprintf(text, 4096, "%s", ok ? printed : message.text);
  free(printed);
  return ok;
}

static void info_knows_files(void **unused)
{
  (void)unused;
  char folder[64], text[4096];
  make_folder(folder);
  const char *frames = in_folder(folder, "a.h5"), *checkpoint = in_folder(folder, "b.h5");
  struct test_run r = small_run(0);
  write_both(frames, checkpoint, &r, 3);
  assert_true(told(folder, frames, text));
  assert_non_null(strstr(text, "H5MD trajectory"));
  assert_non_null(strstr(text, "3 frames of 1108 particles, with velocities")); /* 40 + 18 + 5 * 6 * 5 * 7 */
  assert_non_null(strstr(text, "18 particles of 'kind2'"));
  assert_non_null(strstr(text, "53 bonds")); /* 5 * 7 + 3 * 6 */
  assert_true(told(folder, checkpoint, text));
  assert_non_null(strstr(text, "checkpoint of uncross 0.1.0"));
  assert_non_null(strstr(text, "step 5, time 0.05 t0"));

  char comment[6000] = "box: [4, 4, 4]\nsteps: 10\n"; /* behind more than 4096 bytes of comment */
  const size_t scene = strlen(comment), leading = sizeof comment - scene - 1;
  memmove(comment + leading, comment, scene);
  memset(comment, '#', leading);
  comment[leading - 1] = '\n';
  const struct {
    const char *name, *content, *word; /* word: NULL if it must be refused */
  } files[] = {
      {"run.json", "{\"state_hash\": \"0123\", \"steps\": 12, \"nested\": {\"a\": 1}}", "steps: 12"},
      {"broken.json", "{\"steps\": 12", NULL},
      {"energy.csv", "step,time,total\n1,0.01,2\n2,0.02,3\n", "3 columns and 2 rows"},
      {"scene.yaml", "# a scene\nbox: [8, 8, 8]\nsteps: 10\n", "box, steps"},
      {"a.xyz", "1\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=species:S:1:pos:R:3\nC 0 0 0\n", "extended XYZ, 1 "},
      {"braces", "{\"steps\": 12}", "steps: 12"},
      {"flow.yaml", "{box: [4, 4, 4], steps: 10}\n", "box, steps"},
      {"long.yaml", comment, "box, steps"},
      {"anchor.yaml", "box: &b [4, 4, 4]\n", NULL},
      {"list.yaml", "- box\n", NULL},
      {"empty", "", NULL},
      {"prose", "Once upon a time\n", NULL},
  };
  for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
    const char *path = in_folder(folder, files[k].name);
    spill(path, files[k].content, strlen(files[k].content));
    bool ok = told(folder, path, text);
    if (ok != (files[k].word != NULL) || !strstr(text, files[k].word ? files[k].word : path))
      fail_msg("%s: %s", files[k].name, text);
  }
  assert_false(told(folder, in_folder(folder, "none"), text));
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

/* Where the YAML is wrong is of use only if the text is meant as YAML. */
static void info_of_text_that_is_no_yaml(void **unused)
{
  (void)unused;
  char folder[64], text[4096], prose[4097];
  make_folder(folder);
  memset(prose, 'a', sizeof prose - 1);
  prose[sizeof prose - 1] = '\0';
  const struct {
    const char *name, *content, *why;
    off_t size; /* of a file that is longer than its content */
  } files[] = {
      {"Makefile", "all:\n\techo it\n", "neither a scene, ", 0},
      {"run.log", "12:30: begins: here\n", "neither a scene, ", 0},
      {"anchor", "box: &b [4, 4, 4]\n", "neither a scene, ", 0},
      {"large.txt", prose, "neither a scene, ", (off_t)YAML_MOST_BYTES + 1},
      {"tab.yaml", "box:\n\t4\n", "tab.yaml:2:1: ", 0},
      {"tab.yml", "box:\n\t4\n", "tab.yml:2:1: ", 0},
      {"large.yaml", prose, "at most 64 MiB", (off_t)YAML_MOST_BYTES + 1},
  };
  for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
    const char *path = in_folder(folder, files[k].name);
    spill(path, files[k].content, strlen(files[k].content));
    if (files[k].size > 0)
      assert_int_equal(truncate(path, files[k].size), 0);
    if (told(folder, path, text) || !strstr(text, files[k].why))
      fail_msg("%s: %s", files[k].name, text);
  }
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_survive), cmocka_unit_test(info_knows_files),
                                     cmocka_unit_test(info_of_text_that_is_no_yaml)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
