/* Thermostats: what the sums must be exactly, and the distribution that the canonical one draws from. */
#include "exact.h"
#include "fluid/fluid.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/rules/srd.h"
#include "mpc/thermostat_lanes.h"

/* Per cell: members, momentum, mass, twice the kinetic energy relative to v_cm; cells by floor division. */
struct cell_state {
  uint32_t n;
  double mass, relative;
  struct vec3 momentum;
};

static struct cell_state *cell_states(const struct test_run *r, uint64_t step)
{
  const struct point shift = grid_shift(&r->model, step);
  const uint32_t solvent = r->state.solvent.n, all = solvent + r->state.vertices;
  struct cell_state *cell = calloc((size_t)box_cell_count(&r->model.box), sizeof *cell);
  uint32_t *where = malloc(all * sizeof *where);
  for (int round = 0; round < 2; round++)
    for (uint32_t i = 0; i < all; i++) {
      const struct solvent *s = &r->state.solvent;
      const bool is_solvent = i < solvent;
      const double mass = is_solvent ? 1.0 : r->model.mass[i - solvent];
      const struct vec3 v = is_solvent ? solvent_v(&r->state, i) : r->state.velocity[i - solvent];
      struct point p = is_solvent ? (struct point){s->x[i], s->y[i], s->z[i]} : r->state.position[i - solvent];
      if (round == 0) {
        where[i] = cell_by_floor(&r->model.box, p, shift);
        cell[where[i]].n++;
        cell[where[i]].mass += mass;
        cell[where[i]].momentum = vec3_add_scaled(cell[where[i]].momentum, mass, v);
      } else {
        struct cell_state *c = &cell[where[i]];
        struct vec3 w = vec3_add_scaled(v, -1.0 / c->mass, c->momentum);
        c->relative += mass * vec3_dot(w, w);
      }
    }
  free(where);
  return cell;
}

static struct test_run thermostatted(enum thermostat_kind kind, double degrees, double per_cell, double temperature,
                                     struct dice *d)
{
  struct model m = test_model(8, 6, 7, per_cell, 0.01, 2);
  m.solvent.thermostat = kind;
  m.seed = dice_u64(d);
  m.solvent.rotation_angle = degrees;
  test_add_kind(&m, 70, 1);
  struct test_run r = dice_run(m, d);
  for (uint32_t i = 0; i < r.state.solvent.n; i++)
    set_solvent_v(&r.state, i,
                  vec3_add((struct vec3){0.3, 0, 0}, vec3_scale(sqrt(temperature), solvent_v(&r.state, i))));
  for (uint32_t v = 0; v < r.state.vertices; v++)
    r.state.velocity[v] = vec3_scale(sqrt(temperature), r.state.velocity[v]);
  return r;
}

/* After `rescale` the relative kinetic energies of all cells with two or more members add up to kT/2 for each of their
 * 3 (N-1) degrees of freedom, exactly; each cell was scaled by the same factor; momenta are kept. With 3 N the
 * temperature would be 1.248 at gamma = 5 (THEORY 1.9, 12). */
static void rescale_sets_the_sum(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 30; k++) {
    const uint64_t seed = dice_seed(501) + k;
    struct dice d = {seed};
    const double temperature[] = {0.01, 0.7, 1.0, 5.0};
    struct test_run r = thermostatted(THERMOSTAT_RESCALE, k % 2 ? 90 : 120, k % 3 ? 5 : 1, temperature[k % 4], &d);
    const int64_t cells = box_cell_count(&r.model.box);
    struct cell_state *before = cell_states(&r, 3);
    assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 3, &r.work.fault));
    struct cell_state *after = cell_states(&r, 3);
    double sum = 0.0, freedoms = 0.0, old = 0.0;
    for (int64_t c = 0; c < cells; c++)
      if (before[c].n > 1) {
        freedoms += 3.0 * (before[c].n - 1);
        sum += after[c].relative;
        old += before[c].relative;
      }
    assert_close(sum / freedoms, 1.0, 1e-9); /* energies are summed to 2^-33 kT each */
    for (int64_t c = 0; c < cells; c++) {
      assert_int_equal(before[c].n, after[c].n);
      assert_close(vec3_norm(vec3_sub(before[c].momentum, after[c].momentum)), 0.0,
                   1e-12 * (1.0 + before[c].mass) * (1.0 + sqrt(temperature[k % 4])));
      if (before[c].n > 1)
        assert_close(after[c].relative, before[c].relative * freedoms / old, 1e-8 * (1.0 + after[c].relative));
    }
    free(before);
    free(after);
    test_end(&r);
  }
}

/* Tao, Goetze and Gompper 2008: in each row of cells along y sum m (v - v_cm)^2 = kT d sum (N - 1), here with rows that
 * differ in temperature, with cells that are empty or have one member, in space and in a plane. */
static void layers_have_their_own_sums(void **unused)
{
  (void)unused;
  for (uint32_t d = 2; d <= 3; d++)
    for (uint64_t seed = 1; seed <= 20; seed++) {
      struct dice dice = {dice_seed(2820) + seed};
      struct model m = d == 3 ? test_model(8, 6, 7, 1.5, 0.01, 2) : test_model(40, 9, 1, 1.5, 0.01, 2);
      m.dimensions = d;
      m.solvent.thermostat = THERMOSTAT_RESCALE_LAYERS;
      m.seed = dice_u64(&dice);
      m.crossing.forbidden = false;
      test_add_kind(&m, 70, 1);
      struct test_run r = dice_run(m, &dice);
      struct solvent *s = &r.state.solvent;
      for (uint32_t i = 0; i < s->n; i++) /* hotter higher up, and sheared */
        set_solvent_v(&r.state, i,
                      vec3_add_scaled((struct vec3){0.2 * (double)s->y[i] * LATTICE_UNIT, 0, 0},
                                      0.5 + 0.3 * (double)s->y[i] * LATTICE_UNIT, solvent_v(&r.state, i)));
      assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 5, &r.work.fault));
      struct cell_state *cell = cell_states(&r, 5);
      const uint32_t lx = (uint32_t)m.box.cells[0], ly = (uint32_t)m.box.cells[1];
      for (uint32_t row = 0; row < ly; row++) {
        double energy = 0.0, freedoms = 0.0;
        for (uint32_t k = 0; k < box_cell_count(&m.box); k++)
          if (k / lx % ly == row && cell[k].n > 1) {
            energy += cell[k].relative;
            freedoms += d * (cell[k].n - 1.0);
          }
        assert_true(freedoms > 0.0);
        /* energies are summed in units of 2^-32 kT, one rounding for each member */
        assert_close(energy / freedoms, 1.0, 0x1p-32 * (freedoms + lx * ly) / freedoms);
      }
      free(cell);
      test_end(&r);
    }
}

/* The canonical thermostat draws each cell's relative kinetic energy from Gamma(3(N-1)/2), whatever it was before:
 * Kolmogorov-Smirnov over all cells of many collisions; momenta are kept, lone members are not touched. */
static void canonical_energies_are_gamma(void **unused)
{
  (void)unused;
  enum { ROUNDS = 60 };
  struct dice d = {dice_seed(502)};
  double *u = malloc(ROUNDS * 336 * sizeof *u), *pairs = malloc(ROUNDS * 336 * sizeof *pairs);
  size_t n = 0, n_pairs = 0;
  struct tally per_freedom = {0};
  for (int k = 0; k < ROUNDS; k++) {
    struct test_run r =
        thermostatted(THERMOSTAT_MAXWELL_BOLTZMANN, k % 2 ? 90 : 130, k % 3 == 0 ? 1 : 4, k % 4 ? 7.0 : 0.1, &d);
    struct cell_state *before = cell_states(&r, 9);
    assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 9, &r.work.fault));
    struct cell_state *after = cell_states(&r, 9);
    for (int64_t c = 0; c < box_cell_count(&r.model.box); c++) {
      assert_close(vec3_norm(vec3_sub(before[c].momentum, after[c].momentum)), 0.0, 1e-11 * (1.0 + before[c].mass));
      if (before[c].n < 2)
        continue;
      double shape = 1.5 * (before[c].n - 1);
      u[n++] = gsl_cdf_gamma_P(0.5 * after[c].relative, shape, 1.0);
      if (before[c].n == 2)
        pairs[n_pairs++] = u[n - 1];
      tally_add(&per_freedom, 0.5 * after[c].relative - shape);
    }
    free(before);
    free(after);
    test_end(&r);
  }
  assert_true(n > 10000 && n_pairs > 1000);
  assert_sigma(tally_mean(&per_freedom), tally_error(&per_freedom), 0.0, 5.0);
  assert_true(kolmogorov(u, n) < KOLMOGOROV_LIMIT);
  assert_true(kolmogorov(pairs, n_pairs) < KOLMOGOROV_LIMIT);
  free(u);
  free(pairs);
}

/* The deviate itself, for the shapes of 2, 3, 5, 10 and 100 members. */
static void gamma_deviates(void **unused)
{
  (void)unused;
  enum { N = 40000 };
  const double shape[] = {1.5, 3.0, 6.0, 13.5, 148.5};
  double *u = malloc(N * sizeof *u);
  for (int k = 0; k < 5; k++) {
    for (uint32_t i = 0; i < N; i++)
      u[i] = gsl_cdf_gamma_P(thermostat_gamma(dice_seed(503), (uint64_t)k, i, shape[k]), shape[k], 1.0);
    assert_true(kolmogorov(u, N) < KOLMOGOROV_LIMIT);
    for (uint32_t i = 0; i < N; i++) /* steps are as good as cells */
      u[i] = gsl_cdf_gamma_P(thermostat_gamma(dice_seed(503), i, 5, shape[k]), shape[k], 1.0);
    assert_true(kolmogorov(u, N) < KOLMOGOROV_LIMIT);
  }
  free(u);
}

/* Where its random numbers stand (docs/conventions.md): attempt k has the normal pair of draw 2k and uniform 0 of draw
 * 2k + 1. Made anew here from the words, by Marsaglia and Tsang's Fig. 1; most cells need one attempt, a few three. */
static void gamma_deviates_have_addresses(void **unused)
{
  (void)unused;
  uint32_t needed[3] = {0, 0, 0}; /* cells of 1, 2, 3 or more attempts */
  for (uint32_t cell = 0; cell < 50000; cell++) {
    const double shape = 1.5 * (1 + cell % 3), d = shape - 1.0 / 3.0;
    double expected = -1.0;
    uint32_t k = 0;
    for (; expected < 0.0; k++) {
      const struct random_words one = random_at(77, RANDOM_THERMOSTAT, 2 * k, 9, cell),
                                other = random_at(77, RANDOM_THERMOSTAT, 2 * k + 1, 9, cell);
      const double turn = 2.0 * 3.14159265358979323846 * random_uniform(one, 1);
      const double x = sqrt(-2.0 * log(random_uniform(one, 0))) * cos(turn), v = pow(1.0 + x / sqrt(9.0 * d), 3.0);
      if (v > 0.0 && log(random_uniform(other, 0)) < x * x / 2.0 + d - d * v + d * log(v))
        expected = d * v;
    }
    needed[k < 3 ? k - 1 : 2]++;
    assert_close(thermostat_gamma(77, 9, cell, shape) / expected, 1.0, 1e-12);
  }
  assert_true(needed[0] > 40000 && needed[1] > 100 && needed[2] > 0);
}

/* True if the first attempt is rejected: made as above. */
static bool needs_more_than_one(uint64_t seed, uint64_t step, uint32_t cell, double shape)
{
  const struct random_words one = random_at(seed, RANDOM_THERMOSTAT, 0, step, cell),
                            other = random_at(seed, RANDOM_THERMOSTAT, 1, step, cell);
  const double turn = 2.0 * 3.14159265358979323846 * random_uniform(one, 1), d = shape - 1.0 / 3.0;
  const double x = sqrt(-2.0 * log(random_uniform(one, 0))) * cos(turn), v = pow(1.0 + x / sqrt(9.0 * d), 3.0);
  return !(v > 0.0 && log(random_uniform(other, 0)) < x * x / 2.0 + d - d * v + d * log(v));
}

/* In columns they are the same, to the bit: any number of cells, in any order, of any numbers of members. */
static void gamma_deviates_in_columns(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1931)};
  uint32_t again = 0; /* cells that needed more than one attempt */
  for (uint64_t step = 0; step < 2000; step++) {
    uint32_t cell[RANDOM_UNIFORMS];
    double shape[RANDOM_UNIFORMS], gamma[RANDOM_UNIFORMS];
    const uint32_t n = (uint32_t)(step % (RANDOM_UNIFORMS + 1));
    for (uint32_t k = 0; k < n; k++) {
      cell[k] = (uint32_t)dice_u64(&d);
      shape[k] = (dice_u64(&d) & 1 ? 1.5 : 1.0) * (1.0 + (double)(dice_u64(&d) % (dice_u64(&d) & 1 ? 4 : 1000)));
    }
    thermostat_gammas(91, step << 20, cell, shape, n, gamma);
    for (uint32_t k = 0; k < n; k++) {
      const double expected = thermostat_gamma(91, step << 20, cell[k], shape[k]);
      assert_memory_equal(&gamma[k], &expected, sizeof expected);
      again += needs_more_than_one(91, step << 20, cell[k], shape[k]);
    }
  }
  assert_true(again > 100);
}

/* The fast kernel takes an attempt without its logarithms only if they would take it: nowhere above the largest uniform
 * deviate that is taken, exp(x^2/2 + d - d v + d ln v), but most of all attempts below it. */
static void certain_attempts_are_taken(void **unused)
{
  (void)unused;
  uint32_t certain = 0, all = 0;
  for (uint32_t others = 1; others < 3000; others = others < 8 ? others + 1 : 3 * others)
    for (int k = -6000; k <= 6000; k++) {
      const double shape = (k & 1 ? 1.5 : 1.0) * others, d = shape - 1.0 / 3.0, x = 1e-3 * k;
      const long double v = powl(1.0L + x / sqrtl(9.0L * d), 3.0L), last = 1.0L - 0x1p-53L;
      const long double least = v > 0.0L ? expl(0.5L * x * x + d - d * v + d * logl(v)) : 0.0L; /* above it, rejected */
      const long double above = least + 1e-13L * d, u[] = {above < last ? above : last, 0.5L};
      for (int i = 0; i < 2; i++) {
        const reals zero = {0}, gamma = thermostat_attempt_lanes(zero + shape, zero + x, zero + (double)u[i]);
        if (i == 0 || u[i] >= least)
          assert_true(gamma[0] == -1.0);
        else if (gamma[0] != -1.0)
          assert_close(gamma[0] / (double)(d * v), 1.0, 1e-9);
        certain += i == 1 && gamma[0] > 0.0;
        all += i;
      }
    }
  assert_true(certain > 0.6 * all);
}

/* Everything at rest in its own cell's frame: nothing to scale, and nothing becomes NaN. */
static void cold_cells_stay_finite(void **unused)
{
  (void)unused;
  for (int kind = THERMOSTAT_RESCALE; kind <= THERMOSTAT_MAXWELL_BOLTZMANN; kind++) {
    struct dice d = {5};
    struct test_run r = thermostatted((enum thermostat_kind)kind, 90, 5, 0.0, &d);
    for (uint32_t v = 0; v < r.state.vertices; v++)
      r.state.velocity[v] = (struct vec3){0.3, 0, 0};
    assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 3, &r.work.fault));
    for (uint32_t i = 0; i < r.state.solvent.n; i++) {
      assert_close(r.state.solvent.vx[i], 0.3, 1e-12);
      assert_close(r.state.solvent.vy[i], 0.0, 1e-12);
    }
    test_end(&r);
  }
}

/* A velocity that a momentum sum still holds but an energy sum does not, and NaN, stop the run. */
static void energy_range_faults(void **unused)
{
  (void)unused;
  const double bad[] = {100000.0, NAN};
  for (int k = 0; k < 2; k++) {
    struct dice d = {6};
    struct test_run r = thermostatted(THERMOSTAT_RESCALE, 90, 0.05, 1.0, &d);
    struct solvent *s = &r.state.solvent;
    for (uint32_t i = 1; i <= 2; i++) /* company, and slower than it: its own energy is the largest */
      s->x[i] = s->x[0], s->y[i] = s->y[0], s->z[i] = s->z[0];
    struct cell_state *cell = cell_states(&r, 4);
    const struct point shift = grid_shift(&r.model, 4), place = {s->x[0], s->y[0], s->z[0]};
    const double share = 1.0 - 1.0 / cell[cell_by_floor(&r.model.box, place, shift)].mass; /* of v, relative to v_cm */
    free(cell);
    s->vy[0] = bad[k];
    assert_false(mpc_collide(&r.state, &r.model, &r.work.mpc, 4, &r.work.fault));
    assert_int_equal(r.work.fault.code, k == 0 ? FAULT_SOLVENT_ENERGY : FAULT_SOLVENT_SPEED);
    assert_true(r.work.fault.entity == r.state.solvent.id[0]);
    assert_true(r.work.fault.value > r.work.fault.limit);
    if (k == 0)
      assert_close(r.work.fault.value / (share * share * bad[k] * bad[k]), 1.0, 1e-3);
    test_end(&r);
  }
  struct dice d = {7};
  struct test_run r = thermostatted(THERMOSTAT_RESCALE, 90, 5, 1.0, &d);
  r.model.mass[3] = r.model.inverse_mass[3] = 1.0;
  r.state.velocity[3].x = 30000.0;
  assert_false(mpc_collide(&r.state, &r.model, &r.work.mpc, 4, &r.work.fault));
  assert_int_equal(r.work.fault.code, FAULT_VERTEX_ENERGY);
  assert_true(r.work.fault.entity == 3 && r.work.fault.value > r.work.fault.limit);
  test_end(&r);
}

/* Who is alone in a cell has no energy there: not relative to a center that an earlier collision left behind, which a
 * resumed run would not have. */
static void lone_members_have_no_energy(void **unused)
{
  (void)unused;
  struct dice d = {8};
  struct test_run r = thermostatted(THERMOSTAT_RESCALE, 90, 0.5, 1.0, &d);
  struct mpc *c = &r.work.mpc;
  for (uint32_t k = 0; k < c->cells; k++)
    c->turn[k].center = (struct vec3){1e6, 0, 0};
  grid_bin(&r.state, &r.model, grid_shift(&r.model, 4), &r.work.mpc);
  assert_true(collide_sum(&r.state, &r.model, &r.work.mpc, 4, &r.work.fault));
  collide_solve(&r.model, &r.work.mpc, 4);
  assert_true(
      collide_thermostat(&r.state, &r.model, &r.work.mpc, thermostat_of(r.model.solvent.thermostat), 4, &r.work.fault));
  uint32_t alone = 0;
  for (uint32_t k = 0; k < c->cells; k++)
    if (cell_members(&c->sum[k]) == 1) {
      assert_true(c->relative[k] == 0);
      alone++;
    }
  assert_true(alone > 30);
  test_end(&r);
}

/* Each cell has a range of its own: what all members have together may be more than one sum holds. */
static void hot_boxes_are_cooled(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(505)};
  struct test_run r = thermostatted(THERMOSTAT_RESCALE, 90, 5, 1e6, &d);
  const int64_t cells = box_cell_count(&r.model.box);
  double sum = 0.0, freedoms = 0.0, before = 0.0;
  struct cell_state *cell = cell_states(&r, 3);
  for (int64_t c = 0; c < cells; c++)
    before += cell[c].relative;
  free(cell);
  assert_true(before > 0x1p31);
  assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 3, &r.work.fault));
  cell = cell_states(&r, 3);
  for (int64_t c = 0; c < cells; c++)
    if (cell[c].n > 1) {
      freedoms += 3.0 * (cell[c].n - 1);
      sum += cell[c].relative;
    }
  free(cell);
  assert_close(sum / freedoms, 1.0, 1e-9);
  test_end(&r);
}

/* The energy that `rescale` brings to its value is summed in integers, so it does not depend on the order of cells:
 * with everything moved by one cell, the factor has the same bits, even where the sum has more than the 53 of a double.
 * keeps_sums: cell by cell, or all members at once. */
static void rescale_is_the_same_in_any_order(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 20; k++) {
    double factor[2][2];
    for (int moved = 0; moved < 2; moved++)
      for (int whole = 0; whole < 2; whole++) {
        struct dice d = {dice_seed(506) + k};
        struct test_run r = thermostatted(THERMOSTAT_RESCALE, 90, 5, 1e5, &d);
        struct mpc *c = &r.work.mpc;
        const int64_t edge = r.model.box.edge[0], one = moved * LATTICE_CELL;
        for (uint32_t i = 0; i < r.state.solvent.n; i++)
          r.state.solvent.x[i] = (r.state.solvent.x[i] + one) % edge;
        for (uint32_t v = 0; v < r.state.vertices; v++)
          r.state.position[v].x += one;
        c->keeps_sums = !whole;
        assert_true(mpc_collide(&r.state, &r.model, c, 3, &r.work.fault));
        uint32_t active = 0;
        while (c->turn[active].active == 0.0)
          active++;
        factor[moved][whole] = c->turn[active].factor;
        test_end(&r);
      }
    assert_true(factor[0][0] > 0.0 && factor[0][0] < 0.01);
    assert_true(factor[0][1] == factor[0][0] && factor[1][0] == factor[0][0] && factor[1][1] == factor[0][0]);
  }
}

/* A hot start comes to T = 1 and Maxwell velocities under either thermostat: kurtosis 3, equipartition between masses.
 */
static void equilibrium_is_maxwellian(void **unused)
{
  (void)unused;
  for (int kind = THERMOSTAT_RESCALE; kind <= THERMOSTAT_MAXWELL_BOLTZMANN; kind++) {
    struct dice d = {dice_seed(504)};
    struct test_run r = thermostatted((enum thermostat_kind)kind, 90, 5, 3.0, &d);
    for (uint32_t i = 0; i < r.state.solvent.n; i++)
      r.state.solvent.vx[i] -= 0.3;
    struct tally two = {0}, four = {0}, heavy = {0};
    for (uint64_t step = 0; step < 400; step++) {
      r.state.solvent_lag = 40; /* far flights: new partners each time */
      assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
      assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, step, &r.work.fault));
      for (uint32_t v = 0; v < r.state.vertices; v++)
        r.state.position[v] = point_move(r.state.position[v], vec3_scale(0.4, r.state.velocity[v]));
      if (step < 50 || step % 5 != 0)
        continue;
      for (uint32_t i = 0; i < r.state.solvent.n; i++) {
        double vz = r.state.solvent.vz[i];
        tally_add(&two, vz * vz);
        tally_add(&four, vz * vz * vz * vz);
      }
      for (uint32_t v = 0; v < r.state.vertices; v++)
        tally_add(&heavy, 5.0 * r.state.velocity[v].z * r.state.velocity[v].z);
    }
    /* samples 5 collisions apart are hardly correlated (0.47^5); total momentum fixed costs 1/N = 5e-4 */
    assert_sigma(tally_mean(&two), 1.5 * tally_error(&two) + 6e-4, 1.0, 5.0);
    assert_sigma(tally_mean(&four) / (tally_mean(&two) * tally_mean(&two)), 2.0 * tally_error(&four), 3.0, 5.0);
    assert_sigma(tally_mean(&heavy), 2.0 * tally_error(&heavy) + 2.5e-3, 1.0, 5.0);
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rescale_sets_the_sum),          cmocka_unit_test(layers_have_their_own_sums),
      cmocka_unit_test(canonical_energies_are_gamma),  cmocka_unit_test(gamma_deviates),
      cmocka_unit_test(gamma_deviates_have_addresses), cmocka_unit_test(gamma_deviates_in_columns),
      cmocka_unit_test(certain_attempts_are_taken),    cmocka_unit_test(cold_cells_stay_finite),
      cmocka_unit_test(energy_range_faults),           cmocka_unit_test(lone_members_have_no_energy),
      cmocka_unit_test(hot_boxes_are_cooled),          cmocka_unit_test(rescale_is_the_same_in_any_order),
      cmocka_unit_test(equilibrium_is_maxwellian),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
