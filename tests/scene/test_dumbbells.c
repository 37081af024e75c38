/* What scenes may not say of dumbbells, where it stands, and what they are warned of. */
#include "scene/scene.h"
#include "support.h"

static const struct refusal {
  const char *line; /* the eighth of the scene */
  int column;
  const char *says;
} refusals[] = {
    {"dumbbells: {spring: 0}", 21, "dumbbells.spring: '0' is out of range"},
    {"dumbbells: {spring: -1}", 21, "dumbbells.spring: '-1' is out of range"},
    {"dumbbells: {fraction: 0.5}", 12, "dumbbells: key 'spring' is missing"},
    {"dumbbells: {spring: 1, fraction: 1.5}", 34, "dumbbells.fraction: '1.5' is out of range"},
    {"dumbbells: {spring: 1, fraction: 0}", 34, "dumbbells.fraction: '0' is out of range"},
    {"dumbbells: {spring: 1, fraction: 1e-4}", 34, "of 1440 particles are less than two"},
    {"dumbbells: {spring: 1e-5}", 21, "too long for a flight; allowed: 0.0001 and more"},
    {"dumbbells: {sprong: 1}", 13, "did you mean 'spring'?"},
    {"dumbbells: {spring: 1, depth: 0.95}", 31, "a potential of walls, and there are none"},
    {"dumbbells: {spring: 0.06}\nwalls: {kind: no-slip}", 21, "longer than half of the gap"},
    {"dumbbells: {spring: 1, depth: 1, range: 4.1}\nwalls: {kind: no-slip}", 41, "potentials of the two walls overlap"},
};

static bool read_scene(const char *line, struct scene *scene, struct message *message)
{
  char text[1024];
  snprintf(text, sizeof text,
           "box: [6, 8, 6]\ntime_step: 0.1\nsteps: 10\nsolvent:\n  per_cell: 5\n  collision_interval: 0.1\n"
           "  rule: at-a\n%s\n",
           line);
  return scene_read_text("d.yaml", text, strlen(text), scene, message);
}

static void refused_with_their_place(void **unused)
{
  (void)unused;
  for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
    struct scene scene;
    struct message message = {.text = ""};
    char place[32];
    if (read_scene(refusals[k].line, &scene, &message))
      fail_msg("accepted: %s", refusals[k].line);
    snprintf(place, sizeof place, "d.yaml:8:%d: ", refusals[k].column);
    if (!strstr(message.text, refusals[k].says) || strncmp(message.text, place, strlen(place)) != 0)
      fail_msg("%s\nsays: %s", refusals[k].line, message.text);
  }
}

struct told {
  int all, image, phase;
};

static void hear(void *context, const char *text)
{
  struct told *t = context;
  t->all++;
  t->image += strstr(text, "meets its own image") != NULL;
  t->phase += strstr(text, "meet them in phase") != NULL;
}

static struct told warnings_of(const char *line)
{
  struct scene scene;
  struct message message = {.text = ""};
  struct told told = {0};
  if (!read_scene(line, &scene, &message))
    fail_msg("%s", message.text);
  scene_warnings(&scene, hear, &told);
  scene_free(&scene);
  return told;
}

static void warned(void **unused)
{
  (void)unused;
  assert_int_equal(warnings_of("dumbbells: {spring: 1}").all, 0);
  assert_int_equal(warnings_of("dumbbells: {spring: 0.45}").image, 0); /* 4 sqrt(kT/K) is 5.96 */
  assert_int_equal(warnings_of("dumbbells: {spring: 0.44}").image, 1);
  assert_int_equal(warnings_of("dumbbells: {spring: 123}").phase, 0); /* w dt_c is 1.568 */
  assert_int_equal(warnings_of("dumbbells: {spring: 124}").phase, 1);
  assert_int_equal(warnings_of("dumbbells: {spring: 1}\nobserve: {dumbbells: {every: 5}}").all, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(refused_with_their_place), cmocka_unit_test(warned)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
