/*
 * Collisions between walls (Tao, Goetze and Gompper 2008). Expected numbers are those of a plain count, of Gaussian
 * integrals, and of a solvent in equilibrium; THEORY comes with each of them. False alarms: 5 standard errors unless
 * said otherwise, 6e-7 per number.
 */
#include "exact.h"
#include "fluid/fluid.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/rule.h"
#include "wall/account.h"

static struct model walls_model(int lx, int ly, int lz, double per_cell, enum rule rule, enum wall_fill fill)
{
  struct model m = test_model(lx, ly, lz, per_cell, 0.1, 1);
  m.solvent.rule = rule;
  m.walls.kind = WALL_NO_SLIP;
  m.walls.fill = fill;
  return m;
}

static void total_momentum(const struct state *state, long double p[3])
{
  p[0] = p[1] = p[2] = 0;
  for (uint32_t i = 0; i < state->solvent.n; i++) {
    p[0] += state->solvent.vx[i];
    p[1] += state->solvent.vy[i];
    p[2] += state->solvent.vz[i];
  }
}

/* What all walls gave between two accounts. */
static struct vec3 given(const struct point before[4], const struct point after[4], uint32_t first, uint32_t last)
{
  struct vec3 sum = {0, 0, 0};
  for (uint32_t k = first; k < last; k++)
    sum = vec3_add(sum, account_between(before[k], after[k]));
  return sum;
}

/* --- grid -------------------------------------------------------------------------------------------------------- */

/* Every y in [0, L] and every shift: row floor(y + s), 0 to L, without a wrap; x and z wrap. The member loop and the
 * function for single places agree. A vertex in another image of a particle's place is in its cell. */
static void rows_do_not_wrap(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2811)};
  uint64_t seen[2] = {0, 0};
  for (int round = 0; round < 300; round++) {
    struct model m = walls_model(1 + (int)(d.state % 3), 1 + round % 5, 2, 20.0, RULE_SRD, FILL_PLANAR);
    test_add_kind(&m, 6, 1);
    struct test_run r = dice_run(m, &d);
    struct solvent *s = &r.state.solvent;
    const int64_t *edge = r.model.box.edge, most = LATTICE_CELL - 1;
    const struct point shift = {dice_integer(&d, 0, most),
                                round % 3   ? dice_integer(&d, 0, most)
                                : round % 2 ? most
                                            : 0,
                                dice_integer(&d, 0, most)};
    s->y[0] = 0, s->y[1] = edge[1], s->y[2] = edge[1] - shift.y, s->y[3] = LATTICE_CELL - shift.y;
    for (int64_t v = 0; v < 6; v++)
      r.state.position[v] = (struct point){s->x[v] + (v - 2) * edge[0], s->y[v], s->z[v] - v * edge[2]};
    grid_bin(&r.state, &r.model, shift, &r.work.mpc);
    for (uint32_t v = 0; v < 6; v++)
      assert_int_equal(r.work.mpc.vertex_cell[v], r.work.mpc.solvent_cell[v]);
    for (uint32_t i = 0; i < s->n; i++) {
      const int64_t x = (s->x[i] + shift.x) % edge[0] >> 40, z = (s->z[i] + shift.z) % edge[2] >> 40;
      const int64_t y = (s->y[i] + shift.y) >> 40, rows = r.model.box.cells[1] + 1;
      assert_true(y >= 0 && y < rows);
      assert_int_equal(r.work.mpc.solvent_cell[i], (z * rows + y) * r.model.box.cells[0] + x);
      assert_int_equal(r.work.mpc.solvent_cell[i],
                       grid_cell_of(&r.model.box, (struct point){s->x[i], s->y[i], s->z[i]}, shift));
      seen[0] += y == 0;
      seen[1] += y == rows - 1;
    }
    test_end(&r);
  }
  assert_true(seen[0] > 1000 && seen[1] > 1000);
}

/* --- balance of momentum ----------------------------------------------------------------------------------------- */

/* In every step what the solvent gains is what walls and force give: every kind of wall, fill, rule and thermostat,
 * walls at rest, moving and oscillating. A cell of N members is off by 2^-44 sqrt(N) at most by rounding in each of
 * sum, account and turn; the bound is twice that for all cells, added up at random, and 2^-44 per hit. */
static void walls_give_what_the_solvent_gains(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2812)};
  double largest = 0.0;
  for (int kind = WALL_NO_SLIP; kind < WALL_KINDS; kind++)
    for (int fill = 0; fill < (kind == WALL_SLIP ? 1 : FILLS); fill++)
      for (int rule = 0; rule < RULES; rule++)
        for (int thermostat = 0; thermostat < THERMOSTATS; thermostat++)
          for (int motion = 0; motion < 3; motion++) {
            const double per_cell = fill == FILL_PAPER && rule == RULE_AT_PLUS_A ? 4.0 : 4.5;
            struct model m = motion == 2 ? walls_model(9, 1, 9, per_cell, rule, fill) /* 81 cells at each wall */
                                         : walls_model(4, 3, 4, per_cell, rule, fill);
            if (model_rule_is_thermal(&m) && thermostat != THERMOSTAT_NONE)
              continue;
            m.seed = dice_u64(&d);
            m.scheme = (enum scheme)(motion % SCHEMES);
            m.solvent.thermostat = thermostat;
            m.solvent.rotation_angle = motion == 1 ? 130.0 : 90.0;
            m.solvent.acceleration = (struct vec3){0.3, 0.0, -0.2};
            m.walls.kind = kind;
            m.flow = (struct vec3){0.4, 0.0, 0.1};
            if (motion > 0)
              m.walls.lower = (struct vec3){-0.5, 0, 0.3}, m.walls.upper = (struct vec3){0.2, 0, 0.7};
            if (motion == 2)
              m.walls.period = 0.8;
            struct test_run r = test_start(m);
            for (int step = 0; step < 12; step++) {
              struct point before[4];
              long double p[3], q[3];
              memcpy(before, r.state.wall_momentum, sizeof before);
              const uint64_t time = r.state.solvent_time;
              total_momentum(&r.state, p);
              test_steps(&r, 1);
              total_momentum(&r.state, q);
              const struct vec3 walls = given(before, r.state.wall_momentum, 0, 4);
              const double n = r.state.solvent.n, force = 0.5 * (r.state.solvent_time - time) * m.time_step * n;
              const double bound = 0x1p-42 * sqrt(n);
              const double off[3] = {(double)(q[0] - p[0]) - walls.x - force * m.solvent.acceleration.x,
                                     (double)(q[1] - p[1]) - walls.y,
                                     (double)(q[2] - p[2]) - walls.z - force * m.solvent.acceleration.z};
              for (int k = 0; k < 3; k++) {
                largest = fmax(largest, fabs(off[k]) / bound);
                if (!(fabs(off[k]) <= bound))
                  fail_msg("kind %d fill %d rule %d thermostat %d motion %d step %d: component %d off by %.3g of %.3g",
                           kind, fill, rule, thermostat, motion, step, k, off[k], bound);
              }
            }
            test_end(&r);
          }
  print_message("  at most %.2f of the bound\n", largest);
}

/* Slip walls: no momentum along them, to rounding; a uniform flow stays. */
static void slip_walls_give_nothing_along_them(void **unused)
{
  (void)unused;
  struct model m = walls_model(4, 4, 4, 5.0, RULE_SRD, FILL_PLANAR);
  m.walls.kind = WALL_SLIP;
  m.flow = (struct vec3){0.25, 0.0, -0.5};
  struct test_run r = test_start(m);
  long double p[3];
  total_momentum(&r.state, p);
  assert_close((double)p[0], 0.25 * r.state.solvent.n, 1e-11);
  assert_close((double)p[2], -0.5 * r.state.solvent.n, 1e-11);
  test_steps(&r, 200);
  total_momentum(&r.state, p);
  assert_close((double)p[0], 0.25 * r.state.solvent.n, 1e-10);
  assert_close((double)p[2], -0.5 * r.state.solvent.n, 1e-10);
  for (int k = 0; k < 4; k++)
    assert_true(r.state.wall_momentum[k].x == 0 && r.state.wall_momentum[k].z == 0);
  assert_true(r.state.wall_momentum[account_row(ACCOUNT_HITS, WALL_LOWER)].y != 0);
  test_end(&r);
}

/* Walls take up momentum, and so the total momentum at the start is a Maxwell variable of variance N about the flow;
 * between slip walls along y only. */
static void momentum_starts_as_drawn(void **unused)
{
  (void)unused;
  for (int kind = WALL_NO_SLIP; kind < WALL_KINDS; kind++) {
    struct tally squares[3] = {{0}};
    for (uint64_t k = 0; k < 100; k++) {
      struct model m = walls_model(3, 3, 3, 5.0, RULE_SRD, FILL_PLANAR);
      m.walls.kind = kind;
      m.seed = dice_seed(28140) + k;
      struct test_run r = test_start(m);
      long double p[3];
      total_momentum(&r.state, p);
      for (int j = 0; j < 3; j++)
        tally_add(&squares[j], (double)(p[j] * p[j]) / r.state.solvent.n);
      test_end(&r);
    }
    for (int j = 0; j < 3; j++)
      if (kind == WALL_NO_SLIP || j == 1)
        assert_sigma(tally_mean(&squares[j]), sqrt(2.0 / 100.0), 1.0, 5.0);
      else
        assert_close(tally_mean(&squares[j]), 0.0, 1e-24);
  }
}

/* --- bits -------------------------------------------------------------------------------------------------------- */

/* The same future for any order in memory, sorted or not. */
static void memory_does_not_matter(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2813)};
  for (int rule = 0; rule < RULES; rule++)
    for (int fill = 0; fill < FILLS; fill++) {
      struct model m = walls_model(4, 5, 4, 4.0, rule, fill);
      m.walls.shear_rate = 0.2;
      m.walls.period = 1.2;
      m.solvent.thermostat = rule == RULE_SRD ? THERMOSTAT_MAXWELL_BOLTZMANN : THERMOSTAT_NONE;
      struct test_run a = test_start(m), b = test_start(m);
      const uint64_t start = state_hash(&a.state);
      for (int k = 0; k < 12; k++) {
        shuffle_memory(&b.state, &d);
        b.work.mpc.since_sort = 1; /* never sorted */
        test_steps(&a, 1);
        test_steps(&b, 1);
        assert_true(state_hash(&a.state) == state_hash(&b.state));
      }
      assert_true(state_hash(&a.state) != start);
      const uint64_t hash = state_hash(&a.state);
      a.state.wall_momentum[3].z ^= 1;
      assert_true(state_hash(&a.state) != hash);
      test_end(&a);
      test_end(&b);
    }
}

/* --- virtual particles ------------------------------------------------------------------------------------------- */

/* Numbers and mean velocities in both cut rows, over all shifts: planar fill has Poisson numbers of mean gamma times
 * the part beyond, the paper's gamma - N. sqrt(n) (v - w) is normal. Inner cells have none. */
static void cut_cells_are_filled(void **unused)
{
  (void)unused;
  for (int fill = 0; fill < FILL_NONE; fill++) {
    struct model m = walls_model(8, 2, 8, 6.5, RULE_SRD, fill);
    m.walls.lower = (struct vec3){-0.5, 0, 0.25}, m.walls.upper = (struct vec3){0.5, 0, 0};
    m.seed = 2814;
    struct test_run r = test_start(m);
    struct mpc *c = &r.work.mpc;
    struct tally number[WALLS] = {{0}}, spread[WALLS] = {{0}}, moment[WALLS][6] = {{{0}}};
    for (uint64_t step = 1; step <= 150; step++) {
      c->since_sort = 1; /* else cells are those of the sorting */
      test_steps(&r, 1);
      const double s = ldexp((double)c->shift.y, -40);
      for (uint32_t place = 0; place < c->cells; place++) {
        const uint32_t row = place / 8 % 3;
        const struct virtual_members v = border_virtual(c, &r.model, place);
        if (row == 1) {
          assert_true(v.n == 0.0);
          continue;
        }
        const enum wall w = row == 0 ? WALL_LOWER : WALL_UPPER;
        const double beyond = w == WALL_LOWER ? s : 1.0 - s, mean = 6.5 * beyond;
        assert_close(v.high - v.low, beyond, 1e-15);
        assert_true(w == WALL_LOWER ? v.low == 0.0 : v.high == 1.0);
        uint32_t real = 0;
        for (uint32_t i = 0; i < r.state.solvent.n; i++)
          real += c->solvent_cell[i] == place;
        if (fill == FILL_PAPER)
          assert_true(v.n == (real < 6.5 ? 6.5 - real : 0.0));
        tally_add(&number[w], fill == FILL_PLANAR ? (v.n - mean) : 0.0);
        tally_add(&spread[w], fill == FILL_PLANAR ? (v.n - mean) * (v.n - mean) - mean : 0.0);
        if (v.n == 0.0)
          continue;
        const struct vec3 u =
            vec3_scale(sqrt(v.n), vec3_sub(v.velocity, w == WALL_LOWER ? m.walls.lower : m.walls.upper));
        const double x[3] = {u.x, u.y, u.z};
        for (int k = 0; k < 3; k++) {
          tally_add(&moment[w][k], x[k]);
          tally_add(&moment[w][3 + k], x[k] * x[k] - 1.0);
        }
      }
    }
    for (int w = 0; w < WALLS; w++) {
      if (fill == FILL_PLANAR) {
        assert_sigma(tally_mean(&number[w]), tally_error(&number[w]), 0.0, 5.0);
        assert_sigma(tally_mean(&spread[w]), tally_error(&spread[w]), 0.0, 5.0);
      }
      for (int k = 0; k < 6; k++)
        assert_sigma(tally_mean(&moment[w][k]), tally_error(&moment[w][k]), 0.0, 5.0);
    }
    test_end(&r);
  }
}

/* --- statistics -------------------------------------------------------------------------------------------------- */

/* The first collision of a uniform flow u between walls at rest, per area of a wall: virtual particles give
 * -(1 - c) P_n u/6, P_n = n - 1 + exp(-n), c = (1 + 2 cos a)/3 for SRD, 0 for AT-a: the mean over the part f of a cell
 * and over N real and Nv virtual ones, Poisson of n f and n (1 - f), of (1 - c) N Nv/(N + Nv) u. The first flight: hits
 * give -2 n u dt/sqrt(2 pi). Between walls that move with the flow both give nothing. */
static void a_uniform_flow_is_stopped(void **unused)
{
  (void)unused;
  const double n = 6.0, u = 0.5, pi = 3.14159265358979323846;
  for (int rule = 0; rule < RULE_AT_PLUS_A; rule++)
    for (int moving = 0; moving < 2; moving++) {
      struct tally hits = {0}, collisions = {0};
      for (uint64_t k = 0; k < 400; k++) {
        struct model m = walls_model(16, 2, 16, n, rule, FILL_PLANAR);
        m.seed = dice_seed(28150) + k;
        m.flow = (struct vec3){u, 0, 0};
        m.solvent.rotation_angle = 130.0;
        m.walls.lower.x = m.walls.upper.x = moving ? u : 0.0;
        struct test_run r = test_start(m);
        const struct point none[4] = {{0, 0, 0}};
        assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 1, &r.work.fault)); /* without a flight */
        tally_add(&collisions, given(none, r.state.wall_momentum, 2, 4).x / 512.0);
        test_end(&r);
        r = test_start(m);
        r.state.solvent_lag = 2;
        assert_true(fluid_stream(&r.state, &r.model, &r.work.fault));
        tally_add(&hits, given(none, r.state.wall_momentum, 0, 2).x / 512.0);
        test_end(&r);
      }
      const double c = rule == RULE_SRD ? (1.0 + 2.0 * cos(130.0 * pi / 180.0)) / 3.0 : 0.0, slip = moving ? 0.0 : u;
      assert_sigma(tally_mean(&hits), tally_error(&hits), -2.0 * n * slip * 0.1 / sqrt(2.0 * pi), 5.0);
      assert_sigma(tally_mean(&collisions), tally_error(&collisions), -(1.0 - c) * (n - 1.0 + exp(-n)) * slip / 6.0,
                   5.0);
    }
}

/* Oscillating walls: virtual particles have the velocity of the time of the collision. AT-a, gas at rest: they give
 * P_n/6 of it per area. */
static void virtual_particles_follow_the_time(void **unused)
{
  (void)unused;
  const double n = 6.0, pi = 3.14159265358979323846;
  for (uint64_t step = 1; step <= 4; step++) {
    struct tally collisions = {0};
    for (uint64_t k = 0; k < 200; k++) {
      struct model m = walls_model(16, 2, 16, n, RULE_AT_A, FILL_PLANAR);
      m.seed = dice_seed(28250) + k;
      m.walls.lower.x = m.walls.upper.x = 0.8;
      m.walls.period = 0.5;
      struct test_run r = test_start(m);
      const struct point none[4] = {{0, 0, 0}};
      assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, step, &r.work.fault));
      tally_add(&collisions, given(none, r.state.wall_momentum, 2, 4).x / 512.0);
      test_end(&r);
    }
    assert_sigma(tally_mean(&collisions), tally_error(&collisions),
                 0.8 * cos(2.0 * pi * step / 5.0) * (n - 1.0 + exp(-n)) / 6.0, 5.0);
  }
}

/* How often the particles hit walls in their next flight of a time t: the number of walls, L apart, that a straight
 * flight along y crosses. */
static double hits_ahead(const struct test_run *r, double t)
{
  const struct solvent *s = &r->state.solvent;
  double hits = 0.0;
  for (uint32_t i = 0; i < s->n; i++)
    hits += fabs(floor((ldexp((double)s->y[i], -40) + s->vy[i] * t) / r->model.box.cells[1]));
  return hits;
}

/* Equilibrium between walls: everywhere T = 1, Gaussian velocities and a flat density; n/sqrt(2 pi) hits per area and
 * time, which press with n kT; virtual particles do not press. Replicas of 40 t0, 10 t0 apart from their start, which
 * is in equilibrium as well. */
static void walls_keep_equilibrium(void **unused)
{
  (void)unused;
  struct setting {
    enum wall_kind kind;
    enum wall_fill fill;
    enum rule rule;
    enum thermostat_kind thermostat;
  };
  static const struct setting settings[] = {
      {WALL_NO_SLIP, FILL_PLANAR, RULE_SRD, THERMOSTAT_NONE},
      {WALL_NO_SLIP, FILL_PAPER, RULE_SRD, THERMOSTAT_NONE},
      {WALL_NO_SLIP, FILL_NONE, RULE_SRD, THERMOSTAT_RESCALE},
      {WALL_NO_SLIP, FILL_PLANAR, RULE_SRD, THERMOSTAT_RESCALE},
      {WALL_NO_SLIP, FILL_PAPER, RULE_SRD, THERMOSTAT_MAXWELL_BOLTZMANN},
      {WALL_NO_SLIP, FILL_PLANAR, RULE_SRD, THERMOSTAT_MAXWELL_BOLTZMANN},
      {WALL_NO_SLIP, FILL_PLANAR, RULE_AT_A, THERMOSTAT_NONE},
      {WALL_NO_SLIP, FILL_PAPER, RULE_AT_A, THERMOSTAT_NONE},
      {WALL_NO_SLIP, FILL_PLANAR, RULE_AT_PLUS_A, THERMOSTAT_NONE},
      {WALL_SLIP, FILL_PLANAR, RULE_SRD, THERMOSTAT_NONE},
  };
  enum { REPLICAS = 24, STEPS = 500, BEFORE = 100 };
  for (size_t c = 0; c < sizeof settings / sizeof *settings; c++) {
    const struct setting *g = &settings[c];
    struct tally near = {0}, heat[3] = {{0}}, fourth[3] = {{0}}, pressure = {0}, virtual_pressure = {0}, rate = {0};
    print_message("  kind %d, fill %d, rule %d, thermostat %d\n", g->kind, g->fill, g->rule, g->thermostat);
    for (uint64_t k = 0; k < REPLICAS; k++) {
      struct model m = walls_model(6, 4, 6, 3.0, g->rule, g->fill);
      m.walls.kind = g->kind;
      m.solvent.thermostat = g->thermostat;
      m.seed = dice_seed(28300) + k;
      struct test_run r = test_start(m);
      const struct solvent *s = &r.state.solvent;
      struct point before[4];
      double count = 0.0, hits = 0.0, squares[3] = {0}, fourths[3] = {0};
      test_steps(&r, BEFORE);
      memcpy(before, r.state.wall_momentum, sizeof before);
      for (int step = BEFORE; step < STEPS; step++) {
        hits += hits_ahead(&r, 0.1);
        test_steps(&r, 1);
        for (uint32_t i = 0; i < s->n; i++) {
          if (s->y[i] > LATTICE_CELL / 2 && s->y[i] < r.model.box.edge[1] - LATTICE_CELL / 2)
            continue;
          const double v[3] = {s->vx[i], s->vy[i], s->vz[i]};
          count += 1.0;
          for (int j = 0; j < 3; j++)
            squares[j] += v[j] * v[j], fourths[j] += v[j] * v[j] * v[j] * v[j];
        }
      }
      const double steps = STEPS - BEFORE, time = 0.1 * steps, area = 36.0;
      const struct point *now = r.state.wall_momentum;
      tally_add(&near, count / steps / s->n);
      tally_add(&rate, hits / (2.0 * area * time));
      for (int j = 0; j < 3; j++) {
        tally_add(&heat[j], squares[j] / count);
        tally_add(&fourth[j], fourths[j] / count);
      }
      tally_add(&pressure,
                0.5 * (account_between(before[0], now[0]).y - account_between(before[1], now[1]).y) / (area * time));
      tally_add(&virtual_pressure,
                0.5 * (account_between(before[2], now[2]).y - account_between(before[3], now[3]).y) / (area * time));
      test_end(&r);
    }
    assert_sigma(tally_mean(&near), tally_error(&near), 0.25, 5.5);
    for (int j = 0; j < 3; j++) {
      assert_sigma(tally_mean(&heat[j]), tally_error(&heat[j]), 1.0, 5.5);
      assert_sigma(tally_mean(&fourth[j]), tally_error(&fourth[j]), 3.0, 5.5);
    }
    assert_sigma(tally_mean(&pressure), tally_error(&pressure), 3.0, 5.5);
    assert_sigma(tally_mean(&rate), tally_error(&rate), 3.0 / sqrt(2.0 * acos(-1.0)), 5.5);
    if (g->kind == WALL_NO_SLIP && g->fill != FILL_NONE)
      assert_sigma(tally_mean(&virtual_pressure), tally_error(&virtual_pressure), 0.0, 5.5);
  }
}

/* A body force g along walls at rest: the walls take up n g per volume, whatever the viscosity. */
static void walls_hold_the_force(void **unused)
{
  (void)unused;
  struct tally force = {0};
  for (uint64_t k = 0; k < 16; k++) {
    struct model m = walls_model(6, 4, 6, 5.0, RULE_AT_A, FILL_PLANAR);
    m.solvent.acceleration.x = 0.1;
    m.seed = dice_seed(28400) + k;
    struct test_run r = test_start(m);
    struct point before[4];
    test_steps(&r, 300); /* 13 relaxation times L^2/(pi^2 nu), nu = 0.74 */
    memcpy(before, r.state.wall_momentum, sizeof before);
    test_steps(&r, 500);
    tally_add(&force, given(before, r.state.wall_momentum, 0, 4).x / 50.0 / 144.0);
    test_end(&r);
  }
  assert_sigma(tally_mean(&force), tally_error(&force), -5.0 * 0.1, 5.5);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_do_not_wrap),
      cmocka_unit_test(walls_give_what_the_solvent_gains),
      cmocka_unit_test(slip_walls_give_nothing_along_them),
      cmocka_unit_test(momentum_starts_as_drawn),
      cmocka_unit_test(memory_does_not_matter),
      cmocka_unit_test(cut_cells_are_filled),
      cmocka_unit_test(a_uniform_flow_is_stopped),
      cmocka_unit_test(virtual_particles_follow_the_time),
      cmocka_unit_test(walls_keep_equilibrium),
      cmocka_unit_test(walls_hold_the_force),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
