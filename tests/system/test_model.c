/* model_finish: each bound, by a model built by hand, with the path of the key that is to blame; and what is derived.
 */
#include "support.h"

#include "system/fiber_kind.h"

enum { PLACES = 3 };

/* A model that is all right: solvent, two kinds of open fibers and one of rings, places. */
static struct model sound_model(void)
{
  struct model m = test_model(16, 16, 16, 5, 0.01, 2);
  test_add_kind(&m, 2, 8);
  test_add_kind(&m, 3, 4)->start = START_STRAIGHT;
  test_add_kind(&m, 2, 8)->ring = true;
  m.kind[1].place = calloc(PLACES, sizeof *m.kind[1].place);
  m.kind[1].placed = PLACES;
  for (int i = 0; i < PLACES; i++)
    m.kind[1].place[i] = (struct fiber_place){{1, 2, 3}, {0, 0, 1}};
  return m;
}

struct bound {
  void (*change)(struct model *);
  const char *path, *says;
};

/* One function per change. */
#define CHANGE(name, statement)                                                                                        \
  static void name(struct model *m)                                                                                    \
  {                                                                                                                    \
    statement;                                                                                                         \
  }
CHANGE(no_cells, m->box.cells[1] = 0)
CHANGE(negative_cells, m->box.cells[0] = -4)
CHANGE(many_cells, m->box.cells[2] = LATTICE_MAX_EDGE + 1)
CHANGE(no_step, m->time_step = 0.0)
CHANGE(long_step, m->time_step = 1.0 + 1e-9)
CHANGE(nan_step, m->time_step = NAN)
CHANGE(no_scheme, m->scheme = (enum scheme)3)
CHANGE(negative_scheme, m->scheme = (enum scheme) - 1)
CHANGE(fast_flow, m->flow.z = -100.5)
CHANGE(nan_flow, m->flow.x = NAN)
CHANGE(negative_gamma, m->solvent.per_cell = -5.0)
CHANGE(nan_gamma, m->solvent.per_cell = NAN)
CHANGE(high_gamma, m->solvent.per_cell = 10001.0)
CHANGE(no_interval, m->solvent.collision_interval = 0.0)
CHANGE(long_interval, m->solvent.collision_interval = 10.01)
CHANGE(uneven_interval, m->solvent.collision_interval = 0.025)
CHANGE(short_interval, m->solvent.collision_interval = 0.005)
CHANGE(no_angle, m->solvent.rotation_angle = 0.0)
CHANGE(wide_angle, m->solvent.rotation_angle = 180.5)
CHANGE(no_thermostat, m->solvent.thermostat = THERMOSTATS)
CHANGE(no_bath, m->solvent.bath = (enum bath)2)
CHANGE(fast_acceleration, m->solvent.acceleration.y = 101.0)
CHANGE(few_particles, m->solvent.per_cell = 1e-5)
CHANGE(many_particles, m->solvent.per_cell = 10000.0; m->box.cells[0] = m->box.cells[1] = 1024)
CHANGE(bath_hydrodynamics, m->solvent.bath = BATH_PHANTOMS)
CHANGE(as_bath, m->solvent.bath = BATH_PHANTOMS; m->solvent.hydrodynamics = false)
CHANGE(thermal_thermostat, m->solvent.rule = RULE_AT_A; m->solvent.thermostat = THERMOSTAT_RESCALE)
CHANGE(no_rule, m->solvent.rule = RULES)
CHANGE(bath_thermostat, as_bath(m); m->solvent.thermostat = THERMOSTAT_RESCALE)
CHANGE(bath_acceleration, as_bath(m); m->solvent.acceleration.x = 0.1)
CHANGE(bath_gamma, as_bath(m); m->solvent.per_cell = 1001.0)
CHANGE(bath_nothing, as_bath(m); m->solvent.per_cell = 0.0)
CHANGE(no_exclusion, m->crossing.exclusion = (enum exclusion)2)
CHANGE(no_rejection, m->crossing.rejection = (enum rejection)2)
CHANGE(no_frame, m->crossing.frame = (enum frame)2)
CHANGE(no_name, m->kind[1].name[0] = '\0')
CHANGE(odd_name, m->kind[1].name[0] = '/')
CHANGE(endless_name, memset(m->kind[1].name, 'a', MODEL_NAME_SIZE))
CHANGE(same_name, strcpy(m->kind[2].name, m->kind[0].name))
CHANGE(same_names, strcpy(m->kind[1].name, m->kind[0].name); strcpy(m->kind[2].name, m->kind[0].name))
CHANGE(no_count, m->kind[0].count = 0)
CHANGE(high_count, m->kind[0].count = UINT32_MAX)
CHANGE(many_vertices, m->kind[1].count = 65536; m->kind[1].vertices = 32768)
CHANGE(no_vertices, m->kind[0].vertices = 0)
CHANGE(negative_mass, m->kind[1].mass = -1.0)
CHANGE(heavy, m->kind[1].mass = 65537.0)
CHANGE(light, m->kind[1].mass = 1e-6)
CHANGE(nan_mass, m->kind[1].mass = NAN)
CHANGE(negative_length, m->kind[0].bond_length = -0.5)
CHANGE(great_length, m->kind[0].bond_length = 513.0)
CHANGE(half_box, m->kind[0].bond_length = 8.0)
CHANGE(no_spring, m->kind[0].spring = 0.0)
CHANGE(hard_spring, m->kind[0].spring = 1e10)
CHANGE(negative_bending, m->kind[0].bending = -1.0)
CHANGE(great_bending, m->kind[0].bending = 2e9)
CHANGE(negative_persistence, m->kind[0].persistence_length = -1.0)
CHANGE(both_bendings, m->kind[0].persistence_length = 5.0)
CHANGE(bendless, m->kind[0].bending = 0.0; m->kind[0].bond_length = 0.0; m->kind[0].persistence_length = 5.0)
CHANGE(stiff, m->kind[0].bending = 0.0; m->kind[0].persistence_length = 1e9)
CHANGE(great_force, m->kind[2].force.x = -2e6)
CHANGE(nan_force, m->kind[2].force.y = NAN)
CHANGE(no_start, m->kind[0].start = (enum fiber_start)4)
CHANGE(open_circle, m->kind[0].start = START_CIRCLE)
CHANGE(straight_ring, m->kind[2].start = START_STRAIGHT)
CHANGE(equilibrium_ring, m->kind[2].start = START_EQUILIBRIUM)
CHANGE(small_ring, m->kind[2].vertices = 2)
CHANGE(placed_equilibrium, m->kind[1].start = START_EQUILIBRIUM)
CHANGE(more_places, m->kind[1].count = 2)
CHANGE(no_direction, m->kind[1].place[1].direction.z = 1e-7)
CHANGE(far_center, m->kind[1].place[2].center.y = 1025.0)
CHANGE(nan_direction, m->kind[1].place[0].direction.z = NAN)
CHANGE(long_rods, m->kind[1].vertices = 10000)
CHANGE(long_chains, m->kind[0].vertices = 2000000)
CHANGE(great_ring, m->kind[2].vertices = 30000)
CHANGE(fast_spring, m->kind[2].spring = 1e6)
CHANGE(fast_bending, m->kind[0].bending = 20000.0)
CHANGE(bounce_at_once, (m->crossing.rule = CROSSING_EVENT_DRIVEN, m->crossing.rejection = REJECTION_BOUNCE))
CHANGE(frame_at_once, (m->crossing.rule = CROSSING_EVENT_DRIVEN, m->crossing.frame = FRAME_FLOW))
CHANGE(linked_at_once, (m->crossing.rule = CROSSING_EVENT_DRIVEN, m->crossing.exclusion = EXCLUSION_PAPER))

static const struct bound bounds[] = {
    {no_cells, "box", "0 is out of range; allowed: [x, y, z], each a whole number 1 .. 1024"},
    {negative_cells, "box", "-4 is out of range"},
    {many_cells, "box", "1025 is out of range"},
    {no_step, "time_step", "0 is out of range; allowed: number > 0, <= 1"},
    {long_step, "time_step", "1.000000001 is out of range"},
    {nan_step, "time_step", "nan is out of range"},
    {no_scheme, "order", "3 is out of range; allowed: paper | kick-split | drift-split"},
    {negative_scheme, "order", "-1 is out of range"},
    {fast_flow, "flow", "-100.5 is out of range; allowed: [x, y, z], each a number >= -100, <= 100"},
    {nan_flow, "flow", "nan is out of range"},
    {negative_gamma, "solvent.per_cell", "-5 is out of range; allowed: number > 0, <= 10000"},
    {nan_gamma, "solvent.per_cell", "nan is out of range"},
    {high_gamma, "solvent.per_cell", "10001 is out of range"},
    {no_interval, "solvent.collision_interval", "0 is out of range"},
    {long_interval, "solvent.collision_interval", "10.01 is out of range"},
    {uneven_interval, "solvent.collision_interval", "0.025 is 2.5 time steps of 0.01; allowed: a whole multiple"},
    {short_interval, "solvent.collision_interval", "0.005 is 0.5 time steps"},
    {no_angle, "solvent.rotation_angle", "0 is out of range; allowed: number > 0, <= 180"},
    {wide_angle, "solvent.rotation_angle", "180.5 is out of range"},
    {thermal_thermostat, "solvent.thermostat", "holds the temperature by itself"},
    {no_rule, "solvent.rule", "3 is out of range"},
    {no_thermostat, "solvent.thermostat", "4 is out of range"},
    {no_bath, "solvent.bath", "2 is out of range"},
    {fast_acceleration, "solvent.acceleration", "101 is out of range"},
    {few_particles, "solvent.per_cell", "makes 0 particles; allowed: 1 to 2147483647"},
    {many_particles, "solvent.per_cell", "makes 167772160000 particles"},
    {bath_hydrodynamics, "solvent.bath", "phantoms carry no hydrodynamic interactions"},
    {bath_thermostat, "solvent.bath", "phantoms are a thermostat"},
    {bath_acceleration, "solvent.bath", "phantoms are not accelerated"},
    {bath_gamma, "solvent.bath", "allowed with a per_cell of at most 1000"},
    {bath_nothing, "solvent.bath", "phantoms without a per_cell"},
    {no_exclusion, "crossing.exclusion", "2 is out of range"},
    {no_rejection, "crossing.refusal", "2 is out of range"},
    {no_frame, "crossing.frame", "2 is out of range"},
    {no_name, "fibers.1.name", "allowed: 1 to 63 letters"},
    {odd_name, "fibers.1.name", "allowed: 1 to 63 letters"},
    {endless_name, "fibers.1.name", "allowed: 1 to 63 letters"},
    {same_name, "fibers.2.name", "'kind1' is the name of an earlier kind"},
    {same_names, "fibers.1.name", "'kind1' is the name of an earlier kind"},
    {no_count, "fibers.0.count", "0 is out of range; allowed: whole number 1 .. 2147483647"},
    {high_count, "fibers.0.count", "4294967295 is out of range"},
    {many_vertices, "fibers.1.count", "2147483664 vertices up to here; allowed: 2147483647 in all"},
    {no_vertices, "fibers.0.vertices", "0 is out of range"},
    {negative_mass, "fibers.1.mass", "-1 is out of range; allowed: number > 0, <= 65536"},
    {heavy, "fibers.1.mass", "65537 is out of range"},
    {light, "fibers.1.mass", "1e-06 is rounded to a multiple of 2^-16"},
    {nan_mass, "fibers.1.mass", "nan is out of range"},
    {negative_length, "fibers.0.bond_length", "-0.5 is out of range"},
    {great_length, "fibers.0.bond_length", "513 is out of range"},
    {half_box, "fibers.0.bond_length", "8.0025 a0; allowed: below half the shortest edge of the box, 8 a0"},
    {no_spring, "fibers.0.spring", "0 is out of range"},
    {hard_spring, "fibers.0.spring", "10000000000 is out of range"},
    {negative_bending, "fibers.0.bending", "-1 is out of range"},
    {great_bending, "fibers.0.bending", "2000000000 is out of range"},
    {negative_persistence, "fibers.0.persistence_length", "-1 is out of range"},
    {both_bendings, "fibers.0.persistence_length", "bending is given too; allowed: one of the two"},
    {bendless, "fibers.0.persistence_length", "needs a bond_length above 0"},
    {stiff, "fibers.0.persistence_length", "is 2e+09 kT; allowed: at most 1e+09"},
    {great_force, "fibers.2.force", "-2000000 is out of range"},
    {nan_force, "fibers.2.force", "nan is out of range"},
    {no_start, "fibers.0.start", "4 is out of range; allowed: equilibrium | straight | circle"},
    {open_circle, "fibers.0.start", "circle for an open fiber; allowed: equilibrium | straight"},
    {straight_ring, "fibers.2.start", "straight for a ring; allowed: circle"},
    {equilibrium_ring, "fibers.2.start", "equilibrium for a ring"},
    {small_ring, "fibers.2.vertices", "a ring of 2; allowed: 3 or more"},
    {placed_equilibrium, "fibers.1.places", "in equilibrium are placed at random"},
    {more_places, "fibers.1.places.2", "3 places; allowed: at most as many as fibers, 2"},
    {no_direction, "fibers.1.places.1.direction", "no direction; allowed: any vector longer than 1e-6"},
    {far_center, "fibers.1.places.2.center", "1025 is out of range"},
    {nan_direction, "fibers.1.places.0.direction", "nan is out of range"},
    {long_rods, "fibers.1.vertices", "10000 of them make a half length of 2692.04 a0; allowed: below 2046 a0"},
    {long_chains, "fibers.0.vertices", "make a contour of"},
    {great_ring, "fibers.2.vertices", "make a radius of"},
    {bounce_at_once, "crossing.refusal", "no move is refused"},
    {frame_at_once, "crossing.frame", "there is no frame of the moves"},
    {linked_at_once, "crossing.exclusion", "no bond moves alone"},
    {fast_spring, "time_step", "0.01 is unstable for the fibers 'kind3', whose highest frequency is"},
    {fast_bending, "time_step", "0.01 is unstable for the fibers 'kind1'"},
};

static void each_bound_is_held(void **unused)
{
  (void)unused;
  int wrong = 0;
  struct model m = sound_model();
  test_finish(&m);
  model_free(&m);
  for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
    struct model_error error = {"", ""};
    m = sound_model();
    bounds[i].change(&m);
    const bool finished = model_finish(&m, &error);
    if (finished || strcmp(error.path, bounds[i].path) != 0 || !strstr(error.text, bounds[i].says)) {
      print_error("should be '%s: ... %s', but is %s'%s: %s'\n", bounds[i].path, bounds[i].says,
                  finished ? "finished " : "", error.path, error.text);
      wrong++;
    }
    model_free(&m);
  }
  assert_int_equal(wrong, 0);
  print_message("  %zu bounds\n", sizeof bounds / sizeof *bounds);
}

static void expect_whole(struct model m, const char *path, const char *says)
{
  struct model_error error;
  assert_false(model_finish(&m, &error));
  assert_string_equal(error.path, path);
  if (!strstr(error.text, says))
    fail_msg("should say '%s', but says '%s'", says, error.text);
  model_free(&m);
}

static void nothing_is_no_model(void **unused)
{
  (void)unused;
  expect_whole(test_model(4, 4, 4, 0, 0.01, 2), "", "there is nothing to simulate");
  struct model bath = test_model(4, 4, 4, 5, 0.01, 2);
  as_bath(&bath);
  expect_whole(bath, "solvent.bath", "phantoms are drawn for fibers only");
  expect_whole((struct model){.seed = 1}, "box", "0 is out of range");
}

/* Just inside of a bound a model is finished. */
static void limits_themselves_are_allowed(void **unused)
{
  (void)unused;
  struct model m = test_model(1, 1, 1, 1, 1.0, 10);
  m.flow = (struct vec3){100, -100, 100};
  m.solvent.rotation_angle = 180.0;
  struct fiber_kind *k = test_add_kind(&m, 1, 1);
  k->mass = 65536.0;
  memset(k->name, 'a', MODEL_NAME_SIZE - 1);
  test_finish(&m);
  assert_true(m.solvent.cosine == -1.0 && m.solvent.sine == 0.0 && m.solvent.interval_steps == 10);
  assert_true(m.solvent.particles == 1 && m.max_mass == 65536.0 && m.total_mass == 65537.0);
  model_free(&m);
  /* two masses 5 on a spring of 100: omega = sqrt(40) */
  for (int side = -1; side <= 1; side += 2) {
    struct model_error error;
    m = test_model(9, 9, 9, 0, 2.0 / sqrt(40.0) * (1.0 + side * 1e-9), 1);
    test_add_kind(&m, 1, 2);
    assert_true(model_finish(&m, &error) == (side < 0));
    model_free(&m);
  }
}

static void what_follows_is_derived(void **unused)
{
  (void)unused;
  struct model m = sound_model();
  m.solvent.collision_interval = 0.03 * (1.0 + 5e-10); /* as near as three steps need be */
  m.solvent.rotation_angle = 130.0;
  m.kind[0].mass = 0.3; /* 19660.8 units of 2^-16 */
  m.kind[0].bending = 0.0;
  m.kind[0].spring = 10.0;
  m.kind[0].persistence_length = 2.0;
  test_finish(&m);
  assert_true(m.box.edge[1] == 16 * LATTICE_CELL);
  assert_true(m.solvent.particles == 20480 && m.solvent.interval_steps == 3);
  assert_true(m.solvent.collision_interval == 0.01 * 3);
  assert_close(m.solvent.cosine, -0.64278760968653932632, 1e-15); /* bc -l: c(130*a(1)/45) */
  assert_close(m.solvent.sine, 0.76604444311897803520, 1e-15);
  assert_true(m.kind[0].mass == 19661.0 / 65536.0 && m.mass[15] == 19661.0 / 65536.0 && m.mass[16] == 5.0);
  assert_true(m.kind[0].bending == 4.0);
  assert_true(m.kind[0].start == START_EQUILIBRIUM && m.kind[2].start == START_CIRCLE);
  assert_true(m.fibers == 7 && m.vertices == 2 * 8 + 3 * 4 + 2 * 8 && m.bonds == 2 * 7 + 3 * 3 + 2 * 8);
  assert_true(m.next[7] == -1 && m.prev[8] == -1 && m.next[35] == 28 && m.prev[28] == 35);
  assert_close(m.total_mass, 20480 + 16 * 19661.0 / 65536.0 + 12 * 5.0 + 16 * 5.0, 1e-9);
  model_free(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_bound_is_held),
      cmocka_unit_test(nothing_is_no_model),
      cmocka_unit_test(limits_themselves_are_allowed),
      cmocka_unit_test(what_follows_is_derived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
