/* The solvent with heavy vertices in it, left alone: Maxwell, Poisson, equipartition; and the thermostats. */
#include "fluid/fluid.h"
#include "statistics.h"
#include "support.h"

/* False alarms: every gate is 4 sigma of its own block-averaged error, 1 in 16 000 with other seeds. */
#define SIGMAS 4.0

/* One look at a state: mean square velocity per component, fourth moments, and cell occupancies. */
struct look {
  double solvent, vertices; /* kT: mean of v_x^2, and of M V_x^2, over components */
  double fourth;            /* mean of v_x^4 */
  double occupancy;         /* variance over mean of the members of unshifted cells */
};

static double occupancy_ratio(const struct test_run *r)
{
  const struct solvent *s = &r->state.solvent;
  const size_t cells = (size_t)box_cell_count(&r->model.box);
  uint32_t *members = calloc(cells, sizeof *members);
  for (uint32_t i = 0; i < s->n; i++) {
    struct point p = fluid_position_now(&r->state, &r->model, i);
    members[((size_t)(p.z >> LATTICE_BITS) * (size_t)r->model.box.cells[1] + (size_t)(p.y >> LATTICE_BITS)) *
                (size_t)r->model.box.cells[0] +
            (size_t)(p.x >> LATTICE_BITS)]++;
  }
  double mean = (double)s->n / (double)cells, sum = 0.0;
  for (size_t c = 0; c < cells; c++)
    sum += (members[c] - mean) * (members[c] - mean);
  free(members);
  return sum / (double)cells / mean;
}

static struct look look_at(const struct test_run *r)
{
  const struct solvent *s = &r->state.solvent;
  struct look l = {.occupancy = occupancy_ratio(r)};
  for (uint32_t i = 0; i < s->n; i++) {
    double x = s->vx[i] * s->vx[i], y = s->vy[i] * s->vy[i], z = s->vz[i] * s->vz[i];
    l.solvent += (x + y + z) / 3.0 / s->n;
    l.fourth += (x * x + y * y + z * z) / 3.0 / s->n;
  }
  for (uint32_t v = 0; v < r->model.vertices; v++)
    l.vertices += r->model.mass[v] * vec3_dot(r->state.velocity[v], r->state.velocity[v]) / 3.0 / r->model.vertices;
  return l;
}

/* 64 loose vertices of mass 5 among 2560 solvent particles. In a closed system at rest the mean kinetic energy of a
 * member of mass M is (3/2) kT (1 - M/M_total). */
static void solvent_and_vertices_share_energy(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 5, 0.02, 1);
  test_add_kind(&m, 64, 1);
  struct test_run r = test_start(m);
  struct blocks kurtosis = {.length = 50}, occupancy = {.length = 50};
  struct blocks solvent = {.length = 50}, vertices = {.length = 50};
  for (int n = 0; n < 2500; n++) {
    test_steps(&r, 10);
    struct look l = look_at(&r);
    blocks_add(&kurtosis, l.fourth / (l.solvent * l.solvent));
    blocks_add(&occupancy, l.occupancy);
    blocks_add(&solvent, l.solvent / (1.0 - 1.0 / r.model.total_mass));
    blocks_add(&vertices, l.vertices / (1.0 - 5.0 / r.model.total_mass));
  }
  const double n = r.model.solvent.particles, cells = (double)box_cell_count(&r.model.box);
  const double solvent_kt = solvent.of_blocks.mean;
  assert_sigma(vertices.of_blocks.mean, sample_error(&vertices.of_blocks), solvent_kt, SIGMAS);
  assert_true(sample_error(&vertices.of_blocks) < 0.004);
  /* velocities on a sphere in 3N dimensions: 3 (1 - 2/(3N + 2)) */
  assert_sigma(kurtosis.of_blocks.mean, sample_error(&kurtosis.of_blocks), 3.0 * (1.0 - 2.0 / (3.0 * n + 2.0)), SIGMAS);
  assert_true(sample_error(&kurtosis.of_blocks) < 0.01);
  /* n particles thrown into so many cells: variance/mean = 1 - 1/cells */
  assert_sigma(occupancy.of_blocks.mean, sample_error(&occupancy.of_blocks), 1.0 - 1.0 / cells, SIGMAS);
  assert_true(sample_error(&occupancy.of_blocks) < 0.005);
  test_end(&r);
}

/* From twice the temperature, the vertices among the solvent, to kT = 1 and a Maxwell distribution. Counting 3N instead
 * of 3(N-1) degrees of freedom per cell would end at 1.25 (gamma 5); one factor per cell without the Gamma
 * distribution, at a kurtosis below 3. */
static void thermostat_holds(enum thermostat_kind thermostat)
{
  struct model m = test_model(8, 8, 8, 5, 0.02, 1);
  m.solvent.thermostat = thermostat;
  test_add_kind(&m, 64, 1);
  struct test_run r = test_start(m);
  for (uint32_t i = 0; i < r.state.solvent.n; i++) {
    r.state.solvent.vx[i] *= sqrt(2.0);
    r.state.solvent.vy[i] *= sqrt(2.0);
    r.state.solvent.vz[i] *= sqrt(2.0);
  }
  test_steps(&r, 200);
  struct blocks solvent = {.length = 20}, vertices = {.length = 20}, kurtosis = {.length = 20};
  for (int n = 0; n < 1000; n++) {
    test_steps(&r, 10);
    struct look l = look_at(&r);
    blocks_add(&solvent, l.solvent / (1.0 - 1.0 / r.model.total_mass));
    blocks_add(&vertices, l.vertices / (1.0 - 5.0 / r.model.total_mass));
    blocks_add(&kurtosis, l.fourth / (l.solvent * l.solvent));
  }
  assert_close(solvent.of_blocks.mean, 1.0, 0.003);
  assert_true(sample_error(&solvent.of_blocks) < 0.001);
  assert_sigma(vertices.of_blocks.mean, sample_error(&vertices.of_blocks), 1.0, SIGMAS);
  assert_true(sample_error(&vertices.of_blocks) < 0.008);
  assert_sigma(kurtosis.of_blocks.mean, sample_error(&kurtosis.of_blocks), 3.0, SIGMAS);
  assert_true(sample_error(&kurtosis.of_blocks) < 0.012);
  print_message("  T = %.5f +- %.5f\n", solvent.of_blocks.mean, sample_error(&solvent.of_blocks));
  test_end(&r);
}

static void rescaling_holds_the_temperature(void **unused)
{
  (void)unused;
  thermostat_holds(THERMOSTAT_RESCALE);
}

static void maxwell_boltzmann_holds_the_temperature(void **unused)
{
  (void)unused;
  thermostat_holds(THERMOSTAT_MAXWELL_BOLTZMANN);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(solvent_and_vertices_share_energy),
                                     cmocka_unit_test(rescaling_holds_the_temperature),
                                     cmocka_unit_test(maxwell_boltzmann_holds_the_temperature)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
