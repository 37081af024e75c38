/* Chains that stand for finer ones: exact sizes, samples of them, and scenes. */
#include "scene/scene.h"
#include "statistics.h"
#include "support.h"
#include "system/fiber_kind.h"

static struct model coarse(uint32_t count, uint32_t vertices, uint32_t finer, enum fiber_size keeps)
{
  struct model m = test_model(60, 60, 60, 0, 0.01, 0);
  m.crossing.forbidden = false;
  struct fiber_kind *k = test_add_kind(&m, count, vertices);
  k->bond_length = k->bending = 0.0;
  k->spring = 3.0;
  k->stands_for = finer;
  k->keeps = keeps;
  return m;
}

/* R_g^2 of m beads with the end-to-end distance of 101, over that of 101: 1.4853, 1.3203, 1.1552, 1.0802; and k'/k = (m
 * - 1)/100. With the radius of gyration kept, R_e^2 is the inverse of it. */
static void one_cannot_have_both(void **unused)
{
  (void)unused;
  static const struct {
    uint32_t m;
    double ratio;
  } rows[] = {{2, 1.4853}, {3, 1.3203}, {6, 1.1552}, {11, 1.0802}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int keeps = 0; keeps < FIBER_SIZES; keeps++) {
      struct model m = coarse(1, rows[i].m, 101, (enum fiber_size)keeps);
      struct model_error error;
      assert_true(model_finish(&m, &error));
      const double ends = fiber_coarse_ratio(&m.kind[0], SIZE_ENDS),
                   gyration = fiber_coarse_ratio(&m.kind[0], SIZE_GYRATION);
      assert_close(keeps == SIZE_ENDS ? ends : gyration, 1.0, 1e-15);
      assert_close(keeps == SIZE_ENDS ? gyration : 1.0 / ends, rows[i].ratio, 5e-5);
      if (keeps == SIZE_ENDS)
        assert_close(m.kind[0].spring, 0.03 * (rows[i].m - 1.0), 1e-15);
      model_free(&m);
    }
}

/* Samples of 6 vertices that stand for 101: R_e^2 = 100, R_g^2 = (101^2 - 1)/606, the one that is kept. 4 standard
 * errors. */
static void samples(void **unused)
{
  (void)unused;
  enum { CHAINS = 20000, M = 6 };
  for (int keeps = 0; keeps < FIBER_SIZES; keeps++) {
    struct test_run r = test_start(coarse(CHAINS, M, 101, (enum fiber_size)keeps));
    struct sample ends = {0}, gyration = {0};
    for (uint32_t c = 0; c < CHAINS; c++) {
      const struct point *p = &r.state.position[M * c];
      double sum = 0.0;
      for (int i = 0; i < M; i++)
        for (int j = 0; j < i; j++) {
          const struct vec3 d = point_difference(p[i], p[j]);
          sum += vec3_dot(d, d) / (M * M);
          if (i == M - 1 && j == 0)
            sample_add(&ends, vec3_dot(d, d));
        }
      sample_add(&gyration, sum);
    }
    const struct sample *kept = keeps == SIZE_ENDS ? &ends : &gyration, *other = keeps == SIZE_ENDS ? &gyration : &ends;
    assert_sigma(kept->mean, sample_error(kept), keeps == SIZE_ENDS ? 100.0 : 10200.0 / 606.0, 4.0);
    assert_sigma(other->mean, sample_error(other), keeps == SIZE_ENDS ? 1.15523 * 10200.0 / 606.0 : 100.0 / 1.15523,
                 4.0);
    test_end(&r);
  }
}

static bool read_with(const char *keys, struct scene *scene, struct message *message)
{
  char text[512];
  snprintf(text, sizeof text,
           "box: [40, 40, 40]\ntime_step: 0.01\nsteps: 10\norder: drift-split\nmedium: {kind: overdamped, rate: 1}\n"
           "crossing: {forbidden: false}\nfibers: [{name: a, count: 1, vertices: 6, mass: 1, %s}]\n",
           keys);
  return scene_read_text("m.yaml", text, strlen(text), scene, message);
}

/* The effective scene has the spring, and not where it comes from: so it can be read again. */
static void scenes(void **unused)
{
  (void)unused;
  static const char *const wrong[][2] = {
      {"bond_length: 0.5, spring: 3, stands_for: 101", "open Gaussian chain"},
      {"bond_length: 0, spring: 3, bending: 1, stands_for: 101", "open Gaussian chain"},
      {"bond_length: 0, spring: 3, ring: true, stands_for: 101", "open Gaussian chain"},
      {"bond_length: 0, spring: 3, stands_for: 5", "allowed: 6 and more"},
      {"bond_length: 0, spring: 3, stands_for: 101, keeps: mass", "end-to-end | gyration"},
      {"bond_length: 0, spring: 3, keeps: gyration", "allowed with stands_for"}};
  struct scene scene, same;
  struct message message;
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    message.text[0] = '\0';
    assert_false(read_with(wrong[k][0], &scene, &message));
    assert_non_null(strstr(message.text, wrong[k][1]));
    assert_int_equal(strncmp(message.text, "m.yaml:7:", 9), 0);
  }
  assert_true(read_with("bond_length: 0, spring: 3, stands_for: 101", &scene, &message));
  assert_true(read_with("bond_length: 0, spring: 0.15", &same, &message));
  assert_true(scene.fingerprint == same.fingerprint);
  char *text = NULL;
  size_t size = 0;
  FILE *f = open_memstream(&text, &size);
  assert_true(scene_write(&scene, f, false));
  fclose(f);
  assert_null(strstr(text, "stands_for"));
  assert_non_null(strstr(text, "spring: 0.15"));
  free(text);
  scene_free(&scene);
  scene_free(&same);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_cannot_have_both), cmocka_unit_test(samples),
                                     cmocka_unit_test(scenes)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
