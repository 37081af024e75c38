/* Two dimensions: what is drawn at the start has the distributions of the plane, and SRD turns to both sides. */
#include "base/random.h"
#include "exact.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "observe/statics.h"
#include "statistics.h"
#include "system/fiber_kind.h"
#include "theory/theory.h"

static struct model fibers(double bending, double bond_length, double spring)
{
  struct model m = test_model(40, 40, 1, 5, 0.01, 2);
  m.dimensions = 2;
  m.crossing.forbidden = false;
  struct fiber_kind *k = test_add_kind(&m, 400, 32);
  k->bending = bending;
  k->bond_length = bond_length;
  k->spring = spring;
  return m;
}

/* Means over fibers that start in equilibrium, against theory (tests/theory): bond lengths, bends, end to end.
 * Velocities: one degree of freedom along x and along y. */
static void fibers_start_in_equilibrium(void **unused)
{
  (void)unused;
  const double rows[][3] = {
      {0.0, 0.5, 100.0}, {0.5, 0.5, 100.0}, {4.0, 0.5, 100.0}, {64.0, 0.5, 100.0}, {0.0, 0.0, 3.0}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    struct test_run r = test_start(fibers(rows[i][0], rows[i][1], rows[i][2]));
    const struct fiber_kind *kind = &r.model.kind[0];
    struct sample length = {0}, square = {0}, cosine = {0}, ends = {0}, energy = {0}, left = {0};
    for (uint32_t f = 0; f < r.model.fibers; f++) {
      const uint32_t first = r.model.fiber_first[f];
      const struct fiber_shape s = fiber_shape(kind, &r.state.position[first]);
      sample_add(&length, s.length);
      sample_add(&square, s.length_squared);
      sample_add(&cosine, s.cosine);
      sample_add(&ends, s.end_to_end);
      for (uint32_t v = first; v < first + kind->vertices; v++) {
        assert_true(r.state.position[v].z == 0 && r.state.velocity[v].z == 0.0);
        sample_add(&energy, kind->mass * vec3_dot(r.state.velocity[v], r.state.velocity[v]));
        if (v < first + 2)
          continue;
        const struct vec3 a = point_difference(r.state.position[v - 1], r.state.position[v - 2]),
                          b = point_difference(r.state.position[v], r.state.position[v - 1]);
        sample_add(&left, a.x * b.y > a.y * b.x);
      }
    }
    assert_sigma(length.mean, sample_error(&length), fiber_mean_bond(kind), 4.5);
    assert_sigma(square.mean, sample_error(&square), theory_bond_square(kind), 4.5);
    assert_sigma(cosine.mean, sample_error(&cosine), theory_bend_cosine(kind->bending, 2), 4.5);
    assert_sigma(ends.mean, sample_error(&ends), theory_end_to_end_square(kind), 4.5);
    assert_sigma(energy.mean, sample_error(&energy), 2.0, 4.5);
    assert_sigma(left.mean, sample_error(&left), 0.5, 4.5);
    test_end(&r);
  }
}

/* Straight fibers and rings are laid in the plane, in all directions. */
static void shapes_are_in_the_plane(void **unused)
{
  (void)unused;
  struct model m = fibers(4.0, 0.5, 100.0);
  m.kind[0].start = START_STRAIGHT;
  test_add_kind(&m, 10, 12)->ring = true;
  struct test_run r = test_start(m);
  struct sample along = {0};
  for (uint32_t f = 0; f < r.model.fibers; f++) {
    const uint32_t first = r.model.fiber_first[f];
    const struct fiber_kind *kind = &r.model.kind[r.model.fiber_kind_of[f]];
    const struct vec3 d = point_difference(r.state.position[first + 1], r.state.position[first]);
    assert_close(vec3_norm(d), fiber_mean_bond(kind), 1e-9);
    if (!kind->ring)
      sample_add(&along, d.x * d.x / vec3_dot(d, d));
  }
  for (uint32_t v = 0; v < r.model.vertices; v++)
    assert_true(r.state.position[v].z == 0);
  assert_sigma(along.mean, sample_error(&along), 0.5, 4.5);
  test_end(&r);
}

/* A lone pair of particles in a cell: SRD turns it by +alpha or -alpha about z, each with the chance 1/2, and the word
 * of the cell says which. */
static void srd_turns_to_both_sides(void **unused)
{
  (void)unused;
  struct model m = test_model(32, 32, 1, 5, 0.02, 1);
  m.dimensions = 2;
  struct test_run r = test_start(m);
  struct mpc *c = &r.work.mpc;
  struct sample side = {0};
  for (uint64_t step = 1; step <= 10; step++) {
    grid_bin(&r.state, &r.model, grid_shift(&r.model, step), c);
    assert_true(collide_sum(&r.state, &r.model, c, step, &r.work.fault));
    collide_solve(&r.model, c, step);
    for (uint32_t k = 0; k < c->cells; k++) {
      if (c->turn[k].active == 0.0)
        continue;
      const struct vec3 axis = c->turn[k].axis;
      assert_true(axis.x == 0.0 && axis.y == 0.0 && fabs(axis.z) == 1.0);
      assert_true((axis.z > 0.0) == (random_at(r.model.seed, 15, 0, step, k).w[0] % 2 == 1));
      sample_add(&side, axis.z);
    }
  }
  assert_sigma(side.mean, sample_error(&side), 0.0, 4.5);
  test_end(&r);
}

static void assert_refused(struct model m, const char *path)
{
  struct model_error error;
  assert_false(model_finish(&m, &error));
  assert_string_equal(error.path, path);
  model_free(&m);
}

static void what_leaves_the_plane_is_refused(void **unused)
{
  (void)unused;
  struct model m = fibers(4.0, 0.5, 100.0);
  m.kind[0].force.z = 1.0;
  assert_refused(m, "fibers.0.force");
  static const struct fiber_place above = {{1, 1, 0.5}, {1, 0, 0}}, steep = {{1, 1, 0}, {1, 0, 1}},
                                  lying = {{1, 1, 0}, {1, 0, 0}};
  const struct fiber_place *const places[] = {&above, &steep, &lying};
  const char *const paths[] = {"fibers.0.places.0.center", "fibers.0.places.0.direction",
                               "fibers.0.places.0.direction"};
  for (int k = 0; k < 3; k++) {
    m = fibers(4.0, 0.5, 100.0);
    m.kind[0].start = k == 2 ? START_CIRCLE : START_STRAIGHT;
    m.kind[0].ring = k == 2;
    m.kind[0].placed = 1;
    m.kind[0].place = malloc(sizeof above);
    memcpy(m.kind[0].place, places[k], sizeof above);
    assert_refused(m, paths[k]);
  }
  m = fibers(4.0, 0.5, 100.0);
  m.crossing.forbidden = true;
  assert_refused(m, "crossing.forbidden");
  m = test_model(8, 8, 2, 5, 0.02, 1);
  m.dimensions = 2;
  assert_refused(m, "box");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fibers_start_in_equilibrium),
      cmocka_unit_test(shapes_are_in_the_plane),
      cmocka_unit_test(srd_turns_to_both_sides),
      cmocka_unit_test(what_leaves_the_plane_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
