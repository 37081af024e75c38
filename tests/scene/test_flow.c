/* What scenes of a flow may not say (system/flow.c), and what they are warned of. */
#include "scene/scene_keys.h"
#include "support.h"

/* A solvent, with further lines. */
static bool read_flow(const char *solvent, const char *more, struct scene *scene, struct message *message)
{
  char text[1024];
  snprintf(text, sizeof text,
           "box: [6, 8, 6]\ntime_step: 0.1\nsteps: 10\nsolvent:\n  per_cell: 5\n  collision_interval: 0.1\n%s\n%s\n",
           solvent, more);
  return scene_read_source(&(struct scene_source){.keys = &scene_keys,
                                                  .path = "flow.yaml",
                                                  .text = text,
                                                  .size = strlen(text),
                                                  .missing = MISSING_ABSENT,
                                                  .message = message},
                           scene);
}

static const struct refusal {
  const char *solvent, *more, *says;
} refusals[] = {
    {"", "walls: {kind: no-slip}\nshear: {rate: 0.1}", "walls and shear are both along y"},
    {"", "walls: {kind: no-slip}\nfibers: [{name: a, count: 1, vertices: 20, mass: 5, bond_length: 0.5, spring: 100}]",
     "flow.yaml:9:40: fibers.vertices: 20 of them span 10.2308 a0, and the walls are 8 a0 apart"},
    {"",
     "walls: {kind: no-slip}\nfibers: [{name: a, count: 1, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, "
     "start: straight, places: [{center: [1, 0.5, 1], direction: [0, 1, 0]}]}]",
     "this fiber reaches from y ="},
    {"", "shear: {rate: 0.1}\nfibers: [{name: a, count: 1, vertices: 4, mass: 5, bond_length: 0.5, spring: 100}]",
     "the edge along x is a whole multiple of that along y"},
    {"", "shear: {rate: 0.1}\nobserve: {dynamics: {every: 10}}", "so it has no displacement; allowed without shear"},
    {"  hydrodynamics: false", "walls: {kind: no-slip}", "velocities that are permuted have no profile"},
    {"  hydrodynamics: false", "shear: {rate: 0.1}", "velocities that are permuted have no profile"},
    {"", "walls: {kind: no-slip}\nflow: [0.1, 0.1, 0]", "a flow across walls or shear"},
    {"", "shear: {rate: 0.1}\nflow: [0, 0.1, 0]", "a flow across walls or shear"},
    {"", "walls: {kind: no-slip, lower: [0, 0.1, 0]}", "a wall that leaves its plane"},
    {"", "walls: {kind: no-slip, upper: [0, -0.1, 0]}", "a wall that leaves its plane"},
    {"", "walls: {kind: slip, fill: none}", "slip walls have no virtual particles"},
    {"  acceleration: [0, 0.1, 0]", "walls: {kind: no-slip}", "the solvent would be pressed against a wall"},
    {"  acceleration: [0, 0.1, 0]", "shear: {rate: 0.1}", "the solvent would be moved across the shear"},
    {"  acceleration: [0.1, 0, 0]\n  profile: sine", "walls: {kind: no-slip}", "the profile repeats with the box"},
    {"  acceleration: [0.1, 0, 0]\n  profile: sine", "shear: {rate: 0.1}", "the profile repeats with the box"},
    {"  acceleration: [0.1, 0, 0]\n  profile: sine\n  hydrodynamics: false", "",
     "velocities that are permuted have no profile"},
    {"  acceleration: [0.1, 0.1, 0]\n  profile: sine", "", "compresses the solvent"},
    {"", "walls: {kind: no-slip, lower: [1, 0, 0]}", "a wall at 1 a0/t0; allowed: below the speed of sound"},
    {"", "walls: {kind: no-slip, upper: [0, 0, -2]}", "a wall at 2 a0/t0; allowed: below the speed of sound"},
    {"", "walls: {kind: no-slip, shear_rate: 0.25}", "a wall at 1 a0/t0; allowed: below the speed of sound"},
    {"", "walls: {kind: no-slip, shear_rate: 0.1, upper: [0.1, 0, 0]}", "allowed: one of the two"},
    {"", "walls: {kind: no-slip, strain: 1, upper: [0.1, 0, 0], period: 10}", "allowed: one of the two"},
    {"", "walls: {kind: no-slip, strain: 1}", "a strain without a period"},
    {"", "walls: {kind: no-slip, shear_rate: 0.1, period: 0.25}", "is 2.5 collision intervals of 0.1"},
    {"", "walls: {kind: no-slip, shear_rate: 0.1, period: 0.3}", "is 3 collision intervals of 0.1"},
    {"", "shear: {rate: 2}", "shear.rate: 2 / t0; allowed: below 2 / t0"},
    {"", "shear: {strain: 1}", "a strain without a period"},
    {"", "shear: {period: 10}", "a period without a rate or strain"},
    {"", "shear: {rate: 0.1, period: 1.05}", "is 10.5 collision intervals of 0.1"},
};

static void refused(void **unused)
{
  (void)unused;
  int wrong = 0;
  for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
    const struct refusal *r = &refusals[k];
    struct scene scene;
    struct message message = {.text = ""};
    if (read_flow(r->solvent, r->more, &scene, &message)) {
      scene_free(&scene);
      print_error("read, not refused: %s %s\n", r->solvent, r->more);
      wrong++;
    } else if (!strstr(message.text, r->says)) {
      print_error("%s %s: should say '%s', but is\n  %s\n", r->solvent, r->more, r->says, message.text);
      wrong++;
    }
  }
  assert_int_equal(wrong, 0);
}

/* What is allowed; and walls with nothing between them are refused. */
static void accepted(void **unused)
{
  (void)unused;
  static const char *const good[] = {"walls: {kind: no-slip, fill: none}",
                                     "walls: {kind: no-slip, fill: paper, lower: [-0.5, 0, 0.5], upper: [0.9, 0, 0]}",
                                     "walls: {kind: slip}\nflow: [0.1, 0, 0.2]",
                                     "walls: {kind: no-slip, shear_rate: 0.1, period: 0.4}",
                                     "walls: {kind: no-slip, strain: 0.25, period: 10}"};
  struct scene scene;
  struct message message = {.text = ""};
  for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
    if (!read_flow("  acceleration: [0.1, 0, -0.1]", good[k], &scene, &message))
      fail_msg("%s", message.text);
    assert_true(model_has_walls(&scene.model));
    scene_free(&scene);
  }
  static const char bare[] = "box: [6, 6, 6]\ntime_step: 0.1\nsteps: 1\nwalls: {kind: no-slip}\n%s";
  char text[512];
  snprintf(text, sizeof text, bare,
           "fibers: [{name: a, count: 1, vertices: 1, mass: 5, bond_length: 0.5, spring: 1}]\n");
  assert_true(scene_read_text("bare.yaml", text, strlen(text), &scene, &message));
  scene_free(&scene);
  snprintf(text, sizeof text, bare, "");
  assert_false(scene_read_text("bare.yaml", text, strlen(text), &scene, &message));
  assert_non_null(strstr(message.text, "there are none"));
}

/* The effective scene says the same flow: run.json has it, and fingerprints are made of it. */
static void written_and_read_again(void **unused)
{
  (void)unused;
  static const char *const flows[] = {"shear: {rate: 0.1}", "shear: {rate: -0.1, period: 20}",
                                      "shear: {strain: 0.5, period: 20}", "walls: {kind: slip}",
                                      "walls: {kind: no-slip, fill: paper, shear_rate: 0.1, period: 20}"};
  for (size_t k = 0; k < sizeof flows / sizeof *flows; k++) {
    struct scene scene, again;
    struct message message = {.text = ""};
    char *text = NULL;
    size_t size = 0;
    if (!read_flow("", flows[k], &scene, &message))
      fail_msg("%s", message.text);
    FILE *f = open_memstream(&text, &size);
    assert_true(f && scene_write(&scene, f, false));
    fclose(f);
    if (!scene_read_text("again.yaml", text, size, &again, &message))
      fail_msg("%s", message.text);
    assert_true(scene.model.shear.rate == again.model.shear.rate &&
                scene.model.shear.period == again.model.shear.period);
    assert_true(scene.model.walls.kind == again.model.walls.kind &&
                scene.model.walls.upper.x == again.model.walls.upper.x);
    assert_true(scene.model.wave.intervals == again.model.wave.intervals);
    free(text);
    scene_free(&scene);
    scene_free(&again);
  }
}

/* --- warnings ---------------------------------------------------------------------------------------------------- */

struct told {
  int all, rescale, mach, heat, net, strain, shear_heat, drive_mach, unstable, idle, early, narrow;
};

static void hear(void *context, const char *text)
{
  struct told *t = context;
  t->all++;
  t->rescale += strstr(text, "rescale has one factor") != NULL;
  t->mach += strstr(text, "the Mach number between the walls") != NULL;
  t->heat += strstr(text, "the walls heat the solvent") != NULL;
  t->net += strstr(text, "a net force") != NULL;
  t->strain += strstr(text, "the strain in a collision interval is") != NULL;
  t->shear_heat += strstr(text, "the shear heats the solvent by") != NULL;
  t->drive_mach += strstr(text, "the Mach number of the driven flow") != NULL;
  t->idle += strstr(text, "slip walls pull nothing") != NULL;
  t->narrow += strstr(text, "the bulk is what is 1 a0 and more from both walls") != NULL;
  t->early += strstr(text, "the flow starts at rest") != NULL;
  t->unstable += strstr(text, "the driven flow is expected to be unstable") != NULL;
}

static struct told warnings_of(const char *solvent, const char *more)
{
  struct scene scene;
  struct message message = {.text = ""};
  struct told told = {0};
  if (!read_flow(solvent, more, &scene, &message))
    fail_msg("%s", message.text);
  scene_warnings(&scene, hear, &told);
  scene_free(&scene);
  return told;
}

static void warned(void **unused)
{
  (void)unused;
  const char *at = "  rule: at-a";
  assert_int_equal(warnings_of(at, "walls: {kind: no-slip, shear_rate: 0.1}").all, 0);
  assert_int_equal(warnings_of("  rule: at-a\n  acceleration: [0.01, 0, 0]", "walls: {kind: no-slip}").all, 0);
  assert_int_equal(warnings_of("  rule: at-a\n  acceleration: [0.01, 0, 0]", "walls: {kind: slip}").net, 1);
  assert_int_equal(warnings_of("  thermostat: rescale", "walls: {kind: no-slip}").rescale, 1);
  assert_int_equal(warnings_of("  thermostat: maxwell-boltzmann", "walls: {kind: no-slip}").rescale, 0);
  assert_int_equal(warnings_of("", "walls: {kind: no-slip, shear_rate: 0.1}").heat, 1);
  assert_int_equal(warnings_of("", "walls: {kind: no-slip, lower: [0.1, 0, 0], upper: [0.1, 0, 0]}").heat, 0);
  assert_int_equal(warnings_of(at, "walls: {kind: no-slip, shear_rate: 0.1}").mach, 0);
  assert_int_equal(warnings_of(at, "walls: {kind: no-slip, shear_rate: 0.2}").mach, 1);
  assert_int_equal(warnings_of(at, "walls: {kind: slip, lower: [0.1, 0, 0]}").idle, 1);
  assert_int_equal(warnings_of(at, "walls: {kind: slip}").idle, 0);
  assert_int_equal(warnings_of("  rule: at-a\n  acceleration: [1, 0, 0]", "walls: {kind: no-slip}").mach, 1);
  assert_int_equal(warnings_of("", "shear: {rate: 0.1}").shear_heat, 1);
  assert_int_equal(
      warnings_of(
          "  hydrodynamics: false\n  bath: phantoms",
          "shear: {rate: 0.1}\nfibers: [{name: a, count: 1, vertices: 1, mass: 5}]\ncrossing: {forbidden: false}")
          .shear_heat,
      0); /* phantoms are a bath */
}

/* Is a run of this length warned that it observes the start of its flow? nu is 0.7426 and L 8, so that the start falls
 * to 1/e in 8.73 t0 where the flow is even about the middle, and in 2.18 t0 where it is odd. */
static int early(const char *flow, int steps, int from)
{
  char text[1024];
  struct scene scene;
  struct message message = {.text = ""};
  struct told told = {0};
  snprintf(text, sizeof text,
           "box: [6, 8, 6]\ntime_step: 0.1\nsteps: %d\nsolvent: {per_cell: 5, collision_interval: 0.1, rule: at-a%s\n"
           "observe: {from: %d, profile: {every: 1, slabs: 8}}\n",
           steps, flow, from);
  if (!scene_read_text("flow.yaml", text, strlen(text), &scene, &message))
    fail_msg("%s", message.text);
  scene_warnings(&scene, hear, &told);
  scene_free(&scene);
  return told.early;
}

/* The kinetic stress is that of particles 1 a0 and more from both walls. */
static void narrow_gap_warned(void **unused)
{
  (void)unused;
  for (int height = 1; height < 5; height++) {
    char text[512];
    struct scene scene;
    struct message message = {.text = ""};
    struct told told = {0};
    snprintf(text, sizeof text,
             "box: [4, %d, 4]\ntime_step: 0.1\nsteps: 10\nsolvent: {per_cell: 5, collision_interval: 0.1}\n"
             "walls: {kind: no-slip}\nobserve: {stress: {every: 5}}\n",
             height);
    if (!scene_read_text("flow.yaml", text, strlen(text), &scene, &message))
      fail_msg("%s", message.text);
    scene_warnings(&scene, hear, &told);
    scene_free(&scene);
    assert_int_equal(told.narrow, height < 3);
  }
}

static void start_warned(void **unused)
{
  (void)unused;
  const char *odd[] = {"}\nwalls: {kind: no-slip, shear_rate: 0.1}", ", acceleration: [0.1, 0, 0], profile: sine}"};
  const char *even[] = {", acceleration: [0.01, 0, 0]}\nwalls: {kind: no-slip}",
                        "}\nwalls: {kind: no-slip, lower: [0.1, 0, 0], upper: [0.1, 0, 0]}"};
  const char *still[] = {"}", "}\nwalls: {kind: no-slip}", "}\nwalls: {kind: slip}", "}\nshear: {rate: 0.1}"};
  for (size_t k = 0; k < 2; k++) {
    assert_int_equal(early(odd[k], 2200, 0), 0);
    assert_int_equal(early(odd[k], 2100, 0), 1);
    assert_int_equal(early(even[k], 8800, 0), 0);
    assert_int_equal(early(even[k], 8600, 0), 1);
    assert_int_equal(early(even[k], 600, 200), 1); /* 8.73/40 exp(-20/8.73) = 0.022 */
    assert_int_equal(early(even[k], 600, 280), 1); /* 0.0108 */
    assert_int_equal(early(even[k], 600, 300), 0); /* 0.0091 */
  }
  for (size_t k = 0; k < 4; k++)
    assert_int_equal(early(still[k], 100, 0), 0);
}

static struct told driven(const char *profile, double g)
{
  char text[128];
  snprintf(text, sizeof text, "  rule: at-a\n  acceleration: [%g, 0, 0]\n  profile: %s", g, profile);
  return warnings_of(text, "");
}

/* Each warning above its limit, and none below it. eta is 3.713 and 2 pi/L 0.785, so that v_max is 2.18 g for a sine
 * and 2.69 g for a force that changes sign, and v_max/(nu k) 3.74 g and 4.62 g; heat is 2 eta rate^2/15. */
static void shear_and_drives_warned(void **unused)
{
  (void)unused;
  const char *at = "  rule: at-a";
  assert_int_equal(warnings_of(at, "shear: {rate: 0.99}").all, 0);
  assert_int_equal(warnings_of(at, "shear: {rate: 1.01}").strain, 1);
  assert_int_equal(warnings_of(at, "shear: {rate: -1.01}").strain, 1);
  assert_int_equal(warnings_of("", "shear: {rate: 0.04}").shear_heat, 0);
  assert_int_equal(warnings_of("", "shear: {rate: 0.1}").shear_heat, 1);
  assert_int_equal(warnings_of("  thermostat: maxwell-boltzmann", "shear: {rate: 0.1}").all, 0);
  static const struct {
    const char *name;
    double slow, fast, unstable;
  } rows[] = {{"sine", 0.22, 0.24, 0.39}, {"reverse", 0.18, 0.19, 0.31}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    assert_int_equal(driven(rows[k].name, rows[k].slow).all, 0);
    assert_int_equal(driven(rows[k].name, rows[k].fast).drive_mach, 1);
    assert_int_equal(driven(rows[k].name, rows[k].fast).unstable, 0);
    assert_int_equal(driven(rows[k].name, rows[k].unstable).unstable, 1);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(refused),
      cmocka_unit_test(accepted),
      cmocka_unit_test(written_and_read_again),
      cmocka_unit_test(warned),
      cmocka_unit_test(start_warned),
      cmocka_unit_test(narrow_gap_warned),
      cmocka_unit_test(shear_and_drives_warned),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
