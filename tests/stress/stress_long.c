/* Ten million steps of tiny suspensions: nothing drifts that should not, nothing becomes NaN or denormal, what is
 * conserved stays. Half a minute. */
#include "stress.h"

#include "../../validation/measure/energy.h"

struct long_run {
  const char *name;
  bool forbidden;
  enum thermostat_kind thermostat;
  double steps;
};

static struct test_run tiny(const struct long_run *l)
{
  struct model m = test_model(2, 2, 2, 5, 0.01, 2);
  m.seed = dice_seed(2701);
  m.crossing.forbidden = l->forbidden;
  m.solvent.thermostat = l->thermostat;
  test_add_kind(&m, 2, 2)->spring = 300.0; /* stiff enough never to reach half the box, 1 a0 */
  struct fiber_kind *bent = test_add_kind(&m, 1, 4);
  bent->spring = 300.0;
  bent->bending = 4.0;
  bent->bond_length = 0.4;
  return test_start(m);
}

static void assert_normal(double x)
{
  if (!isnormal(x))
    fail_msg("a velocity is %g", x);
}

static void assert_all_normal(const struct state *s)
{
  for (uint32_t i = 0; i < s->solvent.n; i++) {
    assert_normal(s->solvent.vx[i]);
    assert_normal(s->solvent.vy[i]);
    assert_normal(s->solvent.vz[i]);
  }
  for (uint32_t v = 0; v < s->vertices; v++) {
    assert_normal(s->velocity[v].x);
    assert_normal(s->velocity[v].y);
    assert_normal(s->velocity[v].z);
  }
}

static struct vec3 momentum(const struct test_run *r)
{
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < r->state.solvent.n; i++)
    p = vec3_add(p, solvent_v(&r->state, i));
  for (uint32_t v = 0; v < r->state.vertices; v++)
    p = vec3_add_scaled(p, r->model.mass[v], r->state.velocity[v]);
  return p;
}

/* Without a thermostat the energy walks at random: leap-frog keeps an energy that differs from E by some dt^2, a
 * collision keeps E, and changes that difference. So E is held against its own walk: the mean of nine differences of
 * tenths, by Student's t (8 degrees of freedom, 1 in 1000; means of neighboring tenths share a quarter of their walk).
 * And it is held against the largest drift of docs/accuracy.md, Stability, for the vertices' degrees of freedom. */
static void assert_no_drift(const struct tally energy[10], double time, uint32_t vertices)
{
  double squares = 0.0;
  const double change = tally_mean(&energy[9]) - tally_mean(&energy[0]);
  for (int k = 1; k < 10; k++)
    squares += pow(tally_mean(&energy[k]) - tally_mean(&energy[k - 1]) - change / 9.0, 2.0);
  const double walk = sqrt(squares / 8.0 * 9.0 * (1.0 + 2.0 * 8.0 / 9.0 / 4.0));
  print_message("  E changes by %.3f kT, and walks by %.3f\n", change, walk);
  assert_close(change, 0.0, 5.04 * walk);
  assert_close(change, 0.0, 1.4e-6 * time * 3.0 * vertices);
}

/* Momentum walks at random by about 2^-44 per cell and collision (docs/accuracy.md): 8 cells, 5e6 collisions, 6e-10.
 * kT per degree of freedom from the solvent: (40 + 8) * 3 - 3 share the kinetic energy. */
static void follow(const struct long_run *l)
{
  struct test_run r = tiny(l);
  const uint64_t steps = scaled_count(l->steps), look = 1000, parts = 10;
  struct tally energy[10] = {{0}}, solvent = {0};
  for (uint64_t done = 0; done < steps; done += look) {
    test_steps(&r, look);
    assert_all_normal(&r.state);
    const struct energy e = energy_on_step(&r.state, &r.model, &r.work);
    tally_add(&energy[done * parts / steps], energy_total(&e));
    tally_add(&solvent, e.solvent / (1.5 * 40.0 * (1.0 - 1.0 / r.model.total_mass)));
  }
  const struct vec3 p = momentum(&r);
  const double first = tally_mean(&energy[0]), last = tally_mean(&energy[parts - 1]);
  print_message(
      "  %-26s %.3g steps: E of the first tenth %.5f, of the last %.5f kT; kT of the solvent %.4f; |P| %.2g; %lu "
      "crossings prevented\n",
      l->name, (double)r.state.step, first, last, tally_mean(&solvent), vec3_norm(p),
      (unsigned long)r.state.counts.executed);
  assert_close(vec3_norm(p), 0.0, 1e-8);
  if (l->thermostat == THERMOSTAT_NONE)
    assert_no_drift(energy, (double)steps * r.model.time_step, r.state.vertices);
  else
    assert_close(tally_mean(&solvent), 1.0, 0.03);
  test_end(&r);
}

static void phantoms_conserve_energy(void **unused)
{
  (void)unused;
  const struct long_run l = {"phantom, no thermostat", false, THERMOSTAT_NONE, 1e7};
  follow(&l);
}

static void thermostats_hold(void **unused)
{
  (void)unused;
  const struct long_run runs[] = {{"uncrossable, rescale", true, THERMOSTAT_RESCALE, 1e7},
                                  {"uncrossable, maxwell", true, THERMOSTAT_MAXWELL_BOLTZMANN, 1e7}};
  for (int k = 0; k < 2; k++)
    follow(&runs[k]);
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(phantoms_conserve_energy),
      cmocka_unit_test(thermostats_hold),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
