/* Frozen fibers (contact/held.h), under every crossing rule. */
#include "contact/impulse.h"
#include "contact/rings.h"
#include "contact/rule.h"

/* Rings of two kinds, the second frozen, so dense that some are linked. */
static struct model two_kinds(enum crossing_kind rule, double per_cell, uint64_t seed)
{
  struct model m = test_model(6, 6, 6, per_cell, 0.01, 2);
  m.seed = seed;
  m.crossing.forbidden = rule != CROSSING_FREE;
  m.crossing.rule = rule == CROSSING_FREE ? CROSSING_SEQUENTIAL : rule;
  m.solvent.thermostat = per_cell > 0.0 ? THERMOSTAT_RESCALE : THERMOSTAT_NONE;
  for (int k = 0; k < 2; k++) {
    struct fiber_kind *kind = test_add_kind(&m, 10, 20);
    kind->ring = true;
    kind->bending = 2.0;
    kind->start = START_CIRCLE;
    kind->frozen = k == 1;
    snprintf(kind->name, sizeof kind->name, k ? "net" : "ring");
  }
  return m;
}

static bool is_frozen(const struct model *m, uint32_t v)
{
  return m->kind[m->fiber_kind_of[m->fiber_of[v]]].frozen;
}

/* Links of a ring that moves with one that does not. */
static uint32_t mixed_links(const struct model *m, const struct links *links)
{
  uint32_t mixed = 0;
  for (uint32_t k = 0; k < links->n; k++)
    mixed +=
        m->kind[m->fiber_kind_of[links->link[k].ring]].frozen != m->kind[m->fiber_kind_of[links->link[k].other]].frozen;
  return mixed;
}

/* Frozen vertices stay, to the last bit; the others move; and what is linked stays linked. */
static void frozen_rings_stay_and_hold(void **unused)
{
  (void)unused;
  static const enum crossing_kind rules[] = {CROSSING_FREE, CROSSING_SEQUENTIAL, CROSSING_EVENT_DRIVEN};
  static struct links start, now;
  for (int k = 0; k < 3; k++) {
    struct test_run r = test_start(two_kinds(rules[k], 5.0, dice_seed(2207)));
    struct point *before = malloc(r.state.vertices * sizeof *before);
    memcpy(before, r.state.position, r.state.vertices * sizeof *before);
    find_links(&r, &start);
    test_steps(&r, 3000);
    uint32_t stood = 0;
    for (uint32_t v = 0; v < r.state.vertices; v++) {
      const bool same = memcmp(&before[v], &r.state.position[v], sizeof before[v]) == 0;
      assert_int_equal(same, is_frozen(&r.model, v));
      stood += same;
    }
    assert_int_equal(stood, 200);
    find_links(&r, &now);
    const bool kept = memcmp(&start, &now, sizeof start - sizeof start.link) == 0 || now.n == start.n;
    print_message("  %s: %u links, %u of both kinds, %lu contacts, kept: %d\n", crossing_rule_of(&r.model)->name,
                  start.n, mixed_links(&r.model, &start), (unsigned long)r.state.counts.executed, kept);
    assert_true(mixed_links(&r.model, &start) >= 2);
    if (rules[k] != CROSSING_FREE) {
      assert_true(r.state.counts.executed > 100);
      assert_int_equal(now.n, start.n);
      for (uint32_t i = 0; i < now.n; i++)
        assert_int_equal(now.link[i].lk, start.link[i].lk);
    } else
      assert_true(now.n != start.n || mixed_links(&r.model, &now) != mixed_links(&r.model, &start));
    free(before);
    test_end(&r);
  }
}

/* In the bath they are as the others: M <v^2>/3 kT of either kind, and each collision changes their velocities. 1600
 * samples of 200 vertices, which a collision decorrelates by c = 0.68, tell kT to 0.5 %. */
static void frozen_vertices_take_part_in_the_bath(void **unused)
{
  (void)unused;
  struct test_run r = test_start(two_kinds(CROSSING_SEQUENTIAL, 5.0, dice_seed(2208)));
  double square[2] = {0.0, 0.0};
  uint32_t changed = 0;
  enum { SAMPLES = 800 };
  for (uint32_t v = 200; v < 400; v++) /* thermal from the start: 600 squares, so 6 % */
    square[1] += 5.0 * vec3_dot(r.state.velocity[v], r.state.velocity[v]) / 3.0;
  assert_true(fabs(square[1] / 200.0 - 1.0) < 0.3);
  square[1] = 0.0;
  for (int n = 0; n < SAMPLES; n++) {
    const struct vec3 last = r.state.velocity[399];
    test_steps(&r, 2);
    changed += memcmp(&last, &r.state.velocity[399], sizeof last) != 0;
    for (uint32_t v = 0; v < r.state.vertices; v++)
      square[is_frozen(&r.model, v)] += r.model.mass[v] * vec3_dot(r.state.velocity[v], r.state.velocity[v]) / 3.0;
  }
  assert_true(is_frozen(&r.model, 399));
  assert_true(changed > SAMPLES * 97 / 100); /* now and then it is alone in its cell */
  for (int k = 0; k < 2; k++) {
    print_message("  kT of %s vertices: %.4f\n", k ? "frozen" : "moving", square[k] / (200.0 * SAMPLES));
    assert_true(fabs(square[k] / (200.0 * SAMPLES) - 1.0) < 0.025);
  }
  test_end(&r);
}

/* A bond that meets a frozen one: its point of contact turns back, its kinetic energy stays, the other's velocities
 * too. */
static void a_frozen_bond_is_a_wall(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2209)};
  for (int n = 0; n < 1000; n++) {
    struct vec3 v[4] = {dice_vector(&d, 0.4), dice_vector(&d, 0.4), {0, 0, 0}, {0, 0, 0}}, before[2] = {v[0], v[1]};
    const struct impulse_end moving[2] = {{&v[0], 0.2}, {&v[1], 0.25}}, standing[2] = {{&v[2], 0.0}, {&v[3], 0.0}};
    const double s = dice_uniform(&d);
    struct vec3 normal = dice_vector(&d, 1.0);
    normal = vec3_scale(1.0 / vec3_norm(normal), normal);
    impulse_exchange(moving, standing, s, dice_uniform(&d), normal);
    double approach[2], energy[2];
    for (int k = 0; k < 2; k++) {
      const struct vec3 *w = k ? v : before;
      approach[k] = (1.0 - s) * vec3_dot(w[0], normal) + s * vec3_dot(w[1], normal);
      energy[k] = 0.5 * (vec3_dot(w[0], w[0]) / 0.2 + vec3_dot(w[1], w[1]) / 0.25);
    }
    assert_true(fabs(approach[0] + approach[1]) < 1e-13);
    assert_true(fabs(energy[1] - energy[0]) < 1e-13);
    assert_true(v[2].x == 0.0 && v[3].x == 0.0);
  }
}

static void what_would_move_them_is_refused(void **unused)
{
  (void)unused;
  for (int k = 0; k < 4; k++) {
    struct model m = two_kinds(CROSSING_SEQUENTIAL, 5.0, 1);
    struct model_error error;
    m.flow.x = k == 0 ? 0.1 : 0.0;
    m.kind[1].force.x = k == 1 ? 0.1 : 0.0;
    m.shear.rate = k == 2 ? 0.1 : 0.0;
    m.walls.kind = k == 3 ? WALL_SLIP : WALL_ABSENT;
    assert_false(model_finish(&m, &error));
    assert_non_null(strstr(error.path, "frozen"));
    model_free(&m);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frozen_rings_stay_and_hold), cmocka_unit_test(frozen_vertices_take_part_in_the_bath),
      cmocka_unit_test(a_frozen_bond_is_a_wall), cmocka_unit_test(what_would_move_them_is_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
