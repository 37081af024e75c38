/* Extended XYZ brings every number through text; info knows each sort of file. */
#include "files/files.h"

#include <fcntl.h>

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

/* The text that an export gives, to be freed. */
static char *exported(const char *path, const struct export_options *options)
{
  struct message message;
  FILE *out = tmpfile();
  assert_non_null(out);
  if (!trajectory_export(path, options, out, &message))
    fail_msg("%s", message.text);
  size_t bytes = (size_t)ftell(out);
  char *text = calloc(bytes + 1, 1);
  rewind(out);
  assert_int_equal(fread(text, 1, bytes, out), bytes);
  fclose(out);
  return text;
}

/* Start of the line after this one. */
static const char *next_line(const char *line)
{
  const char *end = strchr(line, '\n');
  assert_non_null(end);
  return end + 1;
}

struct row {
  char symbol[8];
  double x[3], v[3];
  int id, next, fiber, place;
};

static struct row parse_row(const char *line)
{
  struct row r;
  assert_int_equal(sscanf(line, "%7s %lf %lf %lf %lf %lf %lf %d %d %d %d\n", r.symbol, &r.x[0], &r.x[1], &r.x[2],
                          &r.v[0], &r.v[1], &r.v[2], &r.id, &r.next, &r.fiber, &r.place),
                   11);
  return r;
}

static void assert_row_is_vertex(const struct row *row, const struct test_run *r, uint32_t v)
{
  struct vec3 x = point_in_a0(r->state.position[v]), u = r->state.velocity[v];
  assert_true(row->x[0] == x.x && row->x[1] == x.y && row->x[2] == x.z);
  assert_true(row->v[0] == u.x && row->v[1] == u.y && row->v[2] == u.z);
  assert_int_equal(row->id, v);
  assert_int_equal(row->next, r->model.next[v]);
  assert_string_equal(row->symbol, v < 40 ? "C" : "N"); /* 5 fibers of 8, then 3 rings of 6 */
  assert_int_equal(row->fiber, v < 40 ? v / 8 : 5 + (v - 40) / 6);
  assert_int_equal(row->place, v < 40 ? v % 8 : (v - 40) % 6);
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
  for (int k = 0; k < 2; k++) {
    const struct export_options last = {.first = k == 0 ? 3 : 0, .last = UINT64_MAX, .solvent = true};
    char *text = exported(path[k], &last);
    const char *line = text;
    assert_int_equal(atoi(line), r.state.vertices + r.state.solvent.n);
    line = next_line(line);
    const char comment[] =
        "Lattice=\"6 0 0 0 5 0 0 0 7\" Properties=species:S:1:pos:R:3:velo:R:3:id:I:1:next:I:1:fiber:I:1:place:I:1 "
        "pbc=\"T T T\" Step=7 Time=0.07 kinds=\"C:kind1 N:kind2 H:solvent\"\n";
    assert_memory_equal(line, comment, strlen(comment));
    for (uint32_t v = 0; v < r.state.vertices; v++) {
      struct row row = parse_row(line = next_line(line));
      assert_row_is_vertex(&row, &r, v);
    }
    uint32_t *slot = malloc(r.state.solvent.n * sizeof *slot);
    state_solvent_slots(&r.state, slot);
    for (uint32_t id = 0; id < r.state.solvent.n; id++) {
      struct row row = parse_row(line = next_line(line));
      struct vec3 x = point_in_a0(fluid_position_now(&r.state, &r.model, slot[id]));
      assert_true(row.x[0] == x.x && row.x[1] == x.y && row.x[2] == x.z && row.next == -1 && row.symbol[0] == 'H');
      assert_true(row.fiber == -1 && row.place == -1);
    }
    assert_string_equal(next_line(line), "");
    free(slot);
    free(text);
  }
  test_end(&r);
  assert_all_closed();
  remove_folder(folder);
}

static void frames_are_chosen(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "trajectory.h5");
  struct message message;
  struct test_run r = small_run(0);
  write_both(path, in_folder(folder, "checkpoint.h5"), &r, 8);
  const struct export_options some = {.first = 1, .last = 6, .stride = 3, .wrapped = true};
  char *text = exported(path, &some);
  const char *line = text;
  static const char *const steps[] = {" Step=3 ", " Step=9 "}; /* frames 1 and 4 */
  for (int k = 0; k < 2; k++) {
    assert_int_equal(atoi(line), r.state.vertices);
    line = next_line(line);
    const char *step = strstr(line, steps[k]);
    assert_true(step && step < next_line(line));
    for (uint32_t v = 0; v < r.state.vertices; v++) {
      struct row row = parse_row(line = next_line(line));
      for (int c = 0; c < 3; c++)
        assert_true(row.x[c] >= 0.0 && row.x[c] < r.model.box.cells[c]);
    }
    line = next_line(line);
  }
  assert_string_equal(line, "");
  free(text);
  FILE *full = fopen("/dev/full", "w");
  assert_false(trajectory_export(path, &some, full, &message));
  fclose(full);
  const struct export_options late = {.first = 8, .last = UINT64_MAX};
  assert_false(trajectory_export(path, &late, stderr, &message));
  assert_non_null(strstr(message.text, "frames 0 to 7"));
  assert_false(trajectory_export(in_folder(folder, "none"), &late, stderr, &message));
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
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_survive), cmocka_unit_test(frames_are_chosen),
                                     cmocka_unit_test(info_knows_files),
                                     cmocka_unit_test(info_of_text_that_is_no_yaml)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
