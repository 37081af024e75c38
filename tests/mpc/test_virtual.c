/*
 * Virtual members of cells at walls: the one member that stands for them against particles drawn one by one, and what
 * thermostat and rules make of them. Expected numbers are those of simulations of single cells, written here.
 */
#include <gsl/gsl_cdf.h>

#include "base/elementary.h"
#include "base/random.h"
#include "exact.h"
#include "mpc/border.h"
#include "mpc/collide.h"
#include "mpc/rule.h"
#include "mpc/virtual.h"
#include "wall/account.h"

static struct model walls_model(int lx, int ly, int lz, double per_cell, enum rule rule, enum wall_fill fill)
{
  struct model m = test_model(lx, ly, lz, per_cell, 0.1, 1);
  m.solvent.rule = rule;
  m.walls.kind = WALL_NO_SLIP;
  m.walls.fill = fill;
  return m;
}

/* --- numbers ------------------------------------------------------------------------------------------------------ */

static const double means[] = {0.0, 1e-300, 1e-3, 0.7, 5.0, 100.0, 255.9, 256.0, 256.1, 700.0, 1000.0};

/* The chances of all parts are sums in their order, and are those of Poisson's law by GSL; those that are left out are
 * 1 to rounding. Sums of up to 400 terms, each of up to 400 products, and e^-mean: 1e-13. */
static void chances_are_poissons(void **unused)
{
  (void)unused;
  for (size_t k = 0; k < sizeof means / sizeof *means; k++) {
    struct virtual_law law;
    virtual_law_of(means[k], &law);
    assert_true(law.parts == ceil(means[k] / 256.0) && law.count < VIRTUAL_CHANCES);
    if (law.parts == 0)
      continue;
    const double each = means[k] / law.parts;
    double term = elementary_exp(-each), sum = term;
    uint32_t last = 0;
    for (; last < each || sum + term > sum; sum += term) { /* docs/conventions.md: bit by bit */
      assert_true(law.at_most[last] == sum);
      term *= each / ++last;
    }
    assert_int_equal(law.count, last);
    for (uint32_t n = 0; n < law.count; n++)
      assert_close(law.at_most[n], gsl_cdf_poisson_P(n, each), 1e-13);
    assert_true(gsl_cdf_poisson_Q(law.count, each) < 1e-13);
  }
}

/* Numbers of many cells at once are those of each; each is the first of which the chance exceeds the deviate, summed
 * over the parts, with the deviates of docs/conventions.md: two of a draw. */
static void numbers_are_those_of_their_deviates(void **unused)
{
  (void)unused;
  enum { CELLS = 150 };
  struct model m = test_model(4, 4, 4, 5.0, 0.1, 1);
  m.seed = dice_seed(1851);
  uint32_t cell[CELLS], together[CELLS];
  for (uint32_t k = 0; k < CELLS; k++)
    cell[k] = 7 * k + 3;
  for (size_t k = 0; k < sizeof means / sizeof *means; k++) {
    struct virtual_law law;
    virtual_law_of(means[k], &law);
    for (uint32_t cells = 1; cells <= CELLS; cells += cells < 3 ? 1 : 49) {
      virtual_numbers(&law, &m, 12, cell, cells, together);
      for (uint32_t i = 0; i < cells; i++)
        assert_int_equal(together[i], virtual_number(&law, &m, 12, cell[i]));
    }
    for (uint32_t i = 0; i < CELLS; i++) {
      uint32_t sum = 0;
      for (uint32_t part = 0; part < law.parts; part++) {
        const struct random_words r = random_at(m.seed, RANDOM_PHANTOM_NUMBER, part / 2, 12, cell[i]);
        const double u = random_uniform(r, (int)(part % 2));
        uint32_t n = 0;
        while (n < law.count && law.at_most[n] <= u)
          n++;
        sum += n;
      }
      assert_int_equal(together[i], sum);
    }
  }
  model_free(&m);
}

/* The real members of a cell: their number, and sums over their velocities. */
struct members {
  double n, squares;
  struct vec3 sum;
};

/* Of all cells, by the places of the collision that has taken place. To be freed. */
static struct members *members_of(const struct test_run *r)
{
  struct members *m = calloc(r->work.mpc.cells, sizeof *m);
  assert_non_null(m);
  for (uint32_t i = 0; i < r->state.solvent.n; i++) {
    struct members *cell = &m[r->work.mpc.solvent_cell[i]];
    const struct vec3 v = solvent_v(&r->state, i);
    cell->n += 1.0;
    cell->squares += vec3_dot(v, v);
    cell->sum = vec3_add(cell->sum, v);
  }
  return m;
}

/* A collision without a flight; particles stay where they are in memory. */
static void collide(struct test_run *r, uint64_t step)
{
  r->work.mpc.since_sort = 1;
  assert_true(mpc_collide(&r->state, &r->model, &r->work.mpc, step, &r->work.fault));
}

/* --- thermostats ------------------------------------------------------------------------------------------------- */

/* Tao, Goetze and Gompper 2008: in each row sum m (v - V)^2 over the real members is kT d sum N (1 - 1/(N + Nv)), V
 * with the virtual ones; the bulk has Nv = 0. Cells of one real member count if there are virtual ones, and not if
 * there are none. */
static void layers_with_virtual_members(void **unused)
{
  (void)unused;
  uint32_t lone = 0, parts = 0, rows_seen = 0;
  for (uint32_t d = 2; d <= 3; d++)
    for (int fill = 0; fill < FILLS; fill++)
      for (uint64_t seed = 1; seed <= 10; seed++) {
        struct dice dice = {dice_seed(2920) + seed};
        struct model m = walls_model(d == 3 ? 8 : 40, 3, d == 3 ? 7 : 1, 2.5, RULE_SRD, fill);
        m.dimensions = d;
        m.solvent.thermostat = THERMOSTAT_RESCALE_LAYERS;
        m.walls.lower.x = -0.4, m.walls.upper.x = 0.6;
        m.seed = dice_u64(&dice);
        struct test_run r = dice_run(m, &dice);
        const uint32_t lx = (uint32_t)r.model.box.rows[0], rows = (uint32_t)r.model.box.rows[1];
        for (uint32_t i = 0; i < r.state.solvent.n; i++) /* hotter higher up */
          set_solvent_v(&r.state, i,
                        vec3_scale(0.5 + 0.3 * (double)r.state.solvent.y[i] * LATTICE_UNIT, solvent_v(&r.state, i)));
        struct test_run old = dice_run(m, &(struct dice){1});
        memcpy(old.state.solvent.vx, r.state.solvent.vx, r.state.solvent.n * sizeof(double));
        memcpy(old.state.solvent.vy, r.state.solvent.vy, r.state.solvent.n * sizeof(double));
        memcpy(old.state.solvent.vz, r.state.solvent.vz, r.state.solvent.n * sizeof(double));
        collide(&r, 5);
        memcpy(old.work.mpc.solvent_cell, r.work.mpc.solvent_cell, r.state.solvent.n * sizeof(uint32_t));
        struct members *before = members_of(&old), *after = members_of(&r);
        for (uint32_t row = 0; row < rows; row++) {
          double energy = 0.0, freedoms = 0.0, cells = 0.0;
          for (uint32_t k = row * lx; k < r.work.mpc.cells; k += k % lx == lx - 1 ? (rows - 1) * lx + 1 : 1) {
            const double n = before[k].n, nv = border_virtual(&r.work.mpc, &r.model, k).n;
            if (n == 0.0 || n + (nv > 0.0) < 2.0)
              continue;
            const struct vec3 wall = border_virtual(&r.work.mpc, &r.model, k).velocity;
            const struct vec3 sum =
                vec3_add_scaled(before[k].sum, nv, (struct vec3){wall.x, wall.y, d == 3 ? wall.z : 0.0});
            const struct vec3 v = vec3_scale(1.0 / (n + nv), sum);
            energy += after[k].squares - 2.0 * vec3_dot(after[k].sum, v) + n * vec3_dot(v, v);
            freedoms += d * n * (1.0 - 1.0 / (n + nv));
            cells += 1.0;
            lone += n == 1.0;
            parts += nv != floor(nv);
          }
          rows_seen += freedoms > 0.0;
          if (freedoms == 0.0) /* a thin part of cells that are not filled up */
            continue;
          /* energies are summed in units of 2^-32 kT, one rounding for each member */
          assert_close(energy / freedoms, 1.0, 0x1p-32 * (freedoms + cells) / freedoms);
        }
        free(before);
        free(after);
        test_end(&old);
        test_end(&r);
      }
  assert_true(lone > 100 && parts > 100 && rows_seen > 220); /* of 240 */
}

/* --- rules ------------------------------------------------------------------------------------------------------- */

/* What a cell makes of n real members of these velocities and of nv virtual ones, each drawn by itself about the flow:
 * the velocity V about which members get their new ones, and the sum of the new velocities of the real members. */
struct outcome {
  struct vec3 center, sum;
};

static struct vec3 normal_vector(struct dice *d)
{
  return (struct vec3){dice_normal(d), dice_normal(d), dice_normal(d)};
}

/* v_i' = V + R (v_i - V) adds up to N V + R (sum v - N V). */
static struct outcome srd_by_hand(struct dice *d, struct members real, double nv, struct vec3 flow, double angle)
{
  struct vec3 all = real.sum;
  for (double k = 0; k < nv; k++)
    all = vec3_add(all, vec3_add(flow, normal_vector(d)));
  const struct vec3 center = vec3_scale(1.0 / (real.n + nv), all), e = dice_direction(d);
  const struct vec3 w = vec3_add_scaled(real.sum, -real.n, center), along = vec3_scale(vec3_dot(e, w), e);
  const struct vec3 across = vec3_sub(w, along);
  const struct vec3 turned =
      vec3_add(along, vec3_add_scaled(vec3_scale(cos(angle), across), sin(angle), vec3_cross(e, w)));
  return (struct outcome){center, vec3_add_scaled(turned, real.n, center)};
}

/* v_i' = xi_i + sum (v - xi)/(N + Nv), the sum over all. */
static struct outcome at_a_by_hand(struct dice *d, struct members real, double nv, struct vec3 flow, double angle)
{
  (void)angle;
  struct vec3 change = real.sum, drawn = {0, 0, 0};
  for (double k = 0; k < real.n; k++)
    drawn = vec3_add(drawn, normal_vector(d));
  change = vec3_sub(change, drawn);
  for (double k = 0; k < nv; k++)
    change = vec3_add(change, vec3_sub(vec3_add(flow, normal_vector(d)), normal_vector(d)));
  const struct vec3 center = vec3_scale(1.0 / (real.n + nv), change);
  return (struct outcome){center, vec3_add_scaled(drawn, real.n, center)};
}

/* The differences of two samples, with the squares of each component. */
static void add_differences(struct tally t[6], struct vec3 a, struct vec3 b)
{
  const double x[3] = {a.x, a.y, a.z}, y[3] = {b.x, b.y, b.z};
  for (int k = 0; k < 3; k++) {
    tally_add(&t[k], x[k] - y[k]);
    tally_add(&t[3 + k], x[k] * x[k] - y[k] * y[k]);
  }
}

/* One member stands for all virtual particles of a cell: the first two moments of V and of sum v' are those of
 * particles drawn one by one, with the same real members, in 10^5 cells. 48 numbers at 5 standard errors: false alarm
 * 3e-5. */
static void one_member_stands_for_all(void **unused)
{
  (void)unused;
  typedef struct outcome by_hand(struct dice *, struct members, double, struct vec3, double);
  static by_hand *const hands[] = {[RULE_SRD] = srd_by_hand, [RULE_AT_A] = at_a_by_hand};
  for (int rule = 0; rule < RULE_AT_PLUS_A; rule++) {
    struct dice d = {dice_seed(2930) + (uint64_t)rule};
    struct tally center[6] = {{0}}, sum[6] = {{0}};
    struct model m = walls_model(16, 1, 16, 4.0, rule, FILL_PLANAR);
    m.solvent.rotation_angle = 130.0;
    m.walls.lower = (struct vec3){-0.5, 0, 0.3}, m.walls.upper = (struct vec3){0.5, 0, 0.7};
    m.seed = dice_u64(&d);
    struct test_run r = test_start(m), old = test_start(m);
    uint32_t cells = 0;
    for (uint64_t step = 1; cells < 100000; step++) {
      const size_t bytes = r.state.solvent.n * sizeof(double);
      memcpy(old.state.solvent.vx, r.state.solvent.vx, bytes);
      memcpy(old.state.solvent.vy, r.state.solvent.vy, bytes);
      memcpy(old.state.solvent.vz, r.state.solvent.vz, bytes);
      collide(&r, step);
      memcpy(old.work.mpc.solvent_cell, r.work.mpc.solvent_cell, r.state.solvent.n * sizeof(uint32_t));
      struct members *before = members_of(&old), *after = members_of(&r);
      for (uint32_t k = 0; k < r.work.mpc.cells; k++) {
        const struct virtual_members v = border_virtual(&r.work.mpc, &r.model, k);
        if (before[k].n == 0.0 || v.n == 0.0)
          continue;
        const struct outcome one =
            hands[rule](&d, before[k], v.n, k / 16 % 2 ? m.walls.upper : m.walls.lower, 130.0 * acos(-1.0) / 180.0);
        add_differences(center, r.work.mpc.turn[k].center, one.center);
        add_differences(sum, after[k].sum, one.sum);
        cells++;
      }
      free(before);
      free(after);
    }
    for (int k = 0; k < 6; k++) {
      assert_sigma(tally_mean(&center[k]), tally_error(&center[k]), 0.0, 5.0);
      assert_sigma(tally_mean(&sum[k]), tally_error(&sum[k]), 0.0, 5.0);
    }
    test_end(&old);
    test_end(&r);
  }
}

/* --- AT+a: the first collision of a uniform flow between walls at rest -------------------------------------------- */

enum { MOST = 64 }; /* members of a cell by hand */

/* A Poisson number by the times between events (not by inversion, as in mpc/virtual.c). */
static int poisson(struct dice *d, double mean)
{
  int n = 0;
  for (double t = -log(dice_uniform(d)); t < mean; t -= log(dice_uniform(d)))
    n++;
  return n;
}

/* x of a x = b, a symmetric and positive, by Cramer's rule. */
static struct vec3 solve(struct vec3 a[3], struct vec3 b)
{
  const double whole = vec3_dot(a[0], vec3_cross(a[1], a[2]));
  return (struct vec3){vec3_dot(b, vec3_cross(a[1], a[2])) / whole, vec3_dot(a[0], vec3_cross(b, a[2])) / whole,
                       vec3_dot(a[0], vec3_cross(a[1], b)) / whole};
}

/* The momentum along x that `real` of n members have lost after a collision in the mean over the drawn velocities,
 * which are of mean 0: velocities become those of the rigid motion with the same momentum and angular momentum. Real
 * members came with velocity 1 along x, the others with 0. Pi of two members gets a part along their line, where
 * nothing turns. */
static double lost(const struct vec3 *y, int n, int real)
{
  struct vec3 x = {0, 0, 0}, l = {0, 0, 0}, pi[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  if (n < 2)
    return 0.0;
  for (int i = 0; i < n; i++)
    x = vec3_add_scaled(x, 1.0 / n, y[i]);
  for (int i = 0; i < n; i++) {
    const struct vec3 r = vec3_sub(y[i], x);
    const double s = vec3_dot(r, r);
    pi[0] = vec3_add(pi[0], (struct vec3){s - r.x * r.x, -r.x * r.y, -r.x * r.z});
    pi[1] = vec3_add(pi[1], (struct vec3){-r.y * r.x, s - r.y * r.y, -r.y * r.z});
    pi[2] = vec3_add(pi[2], (struct vec3){-r.z * r.x, -r.z * r.y, s - r.z * r.z});
    if (i < real)
      l = vec3_add(l, vec3_cross(r, (struct vec3){1, 0, 0}));
  }
  if (n == 2) {
    const struct vec3 r = vec3_sub(y[1], y[0]);
    pi[0] = vec3_add_scaled(pi[0], r.x, r), pi[1] = vec3_add_scaled(pi[1], r.y, r),
    pi[2] = vec3_add_scaled(pi[2], r.z, r);
  }
  const struct vec3 rate = solve(pi, l);
  double sum = 0.0;
  for (int i = 0; i < real; i++)
    sum += 1.0 - (double)real / n - vec3_cross(rate, vec3_sub(y[i], x)).x;
  return sum;
}

/* The mean of so many cells of which this part is beyond a wall; n per volume on both sides. */
static double lost_by_hand(struct dice *d, double n, double beyond, int cells)
{
  double sum = 0.0;
  for (int k = 0; k < cells; k++) {
    const int real = poisson(d, n * (1.0 - beyond)), all = real + poisson(d, n * beyond);
    struct vec3 y[MOST];
    assert_true(all <= MOST);
    for (int i = 0; i < all; i++)
      y[i] = (struct vec3){dice_uniform(d), i < real ? dice_between(d, beyond, 1.0) : dice_between(d, 0.0, beyond),
                           dice_uniform(d)};
    sum += lost(y, all, real);
  }
  return sum / cells;
}

/* As a_uniform_flow_is_stopped in test_walls.c, for AT+a: per area, virtual particles take from the flow what a
 * simulation of single cells with the same part beyond the wall says. There is no formula: the simulation's value is
 * 0.57 of AT-a's P_n u/6. */
static void at_plus_a_stops_a_uniform_flow(void **unused)
{
  (void)unused;
  const double n = 6.0, u = 3.0;
  struct dice d = {dice_seed(2940)};
  struct tally off = {0}, expected = {0};
  for (uint64_t k = 0; k < 400; k++) {
    struct model m = walls_model(16, 2, 16, n, RULE_AT_PLUS_A, FILL_PLANAR);
    m.seed = dice_seed(29400) + k;
    m.flow = (struct vec3){u, 0, 0};
    struct test_run r = test_start(m);
    collide(&r, 1);
    const double s = ldexp((double)r.work.mpc.shift.y, -40);
    for (uint32_t wall = 0; wall < WALLS; wall++) {
      const double taken = -ldexp((double)r.state.wall_momentum[WALLS * ACCOUNT_COLLISIONS + wall].x, -44) / 256.0;
      const double hand = u * lost_by_hand(&d, n, wall == WALL_LOWER ? s : 1.0 - s, 512);
      tally_add(&off, taken - hand);
      tally_add(&expected, hand);
    }
    test_end(&r);
  }
  assert_sigma(tally_mean(&off), tally_error(&off), 0.0, 5.0);
  assert_true(tally_error(&off) < 0.005 * tally_mean(&expected));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(chances_are_poissons),           cmocka_unit_test(numbers_are_those_of_their_deviates),
      cmocka_unit_test(layers_with_virtual_members),    cmocka_unit_test(one_member_stands_for_all),
      cmocka_unit_test(at_plus_a_stops_a_uniform_flow),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
