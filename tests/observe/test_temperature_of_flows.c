/* Temperatures of a solvent that flows: relative to the mean velocity of each cell-high slab. */
#include "exact.h"
#include "fluid/fluid.h"
#include "observe/conserved.h"
#include "statistics.h"

static struct model flow(int kind)
{
  struct model m = test_model(5, 6, 4, 8.0, 0.1, 2);
  m.seed = dice_seed(2931);
  m.solvent.rule = RULE_AT_A;
  if (kind == 0)
    m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .shear_rate = 0.3};
  if (kind == 1)
    m.shear.rate = 0.3;
  if (kind == 2) {
    m.solvent.acceleration.x = 0.5;
    m.solvent.profile = PROFILE_SINE;
  }
  return m;
}

static struct temperatures temperatures_of(struct test_run *r)
{
  const struct motion motion = motion_measure(&r->model, &r->state, r->work.fiber.force);
  return motion_temperatures(&r->model, &motion);
}

/* Sums by plain loops, of where the solvent is now; also between collisions. */
static void by_hand(void **unused)
{
  (void)unused;
  for (int kind = 0; kind < 3; kind++) {
    struct test_run r = test_start(flow(kind));
    bool lagged = false;
    for (int step = 0; step < 7; step++) {
      test_steps(&r, 1);
      lagged = lagged || r.state.solvent_lag > 0;
      long double mean[6][3] = {{0}}, sum[3] = {0};
      uint32_t n[6] = {0}, slabs = 0;
      for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < r.state.solvent.n; i++) {
          const struct vec3 v = fluid_velocity_now(&r.state, &r.model, i);
          const int64_t y = fluid_position_now(&r.state, &r.model, i).y;
          const int row = y == r.model.box.edge[1] ? 5 : (int)floor((double)y * LATTICE_UNIT);
          const double part[3] = {v.x, v.y, v.z};
          n[row] += pass == 0;
          for (int k = 0; k < 3; k++)
            if (pass == 0)
              mean[row][k] += part[k];
            else
              sum[k] += (part[k] - mean[row][k] / n[row]) * (part[k] - mean[row][k] / n[row]);
        }
      for (int row = 0; row < 6; row++)
        slabs += n[row] > 0;
      const struct temperatures t = temperatures_of(&r);
      assert_close(t.solvent.x, (double)sum[0] / (r.state.solvent.n - slabs), 1e-11);
      assert_close(t.solvent.y, (double)sum[1] / (r.state.solvent.n - slabs), 1e-11);
      assert_close(t.solvent.z, (double)sum[2] / (r.state.solvent.n - slabs), 1e-11);
    }
    assert_true(lagged);
    test_end(&r);
  }
}

/* AT-a holds kT = 1, whatever flows. On top of it comes the shear within a slab, along x. After a collision the mean
 * velocity is constant in each cell of the shifted grid. A slab holds the parts f and 1 - f of two cells, whose
 * velocities differ by the rate: that is f (1 - f) rate^2, and on average over the shift rate^2/6. */
static void a_flow_is_no_heat(void **unused)
{
  (void)unused;
  struct model m = flow(1);
  m.solvent.collision_interval = m.time_step;
  struct test_run r = test_start(m);
  struct sample x = {0}, y = {0};
  for (int k = 0; k < 400; k++) {
    test_steps(&r, 3);
    const struct temperatures t = temperatures_of(&r);
    sample_add(&x, t.solvent.x), sample_add(&y, t.solvent.y);
  }
  /* without the slabs it would be the flow's 0.3^2 (36 - 1)/12 = 0.26 more */
  assert_sigma(x.mean, sample_error(&x), 1.0 + 0.09 / 6.0, 4.5);
  assert_sigma(y.mean, sample_error(&y), 1.0, 4.5);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(by_hand), cmocka_unit_test(a_flow_is_no_heat)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
