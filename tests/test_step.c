/* A time step: its stages in each order, against public functions called by hand and against a plain implementation in
 * doubles written here; the leap-frog; starts; momentum; faults. */
#include "base/random.h"
#include "contact/contact.h"
#include "exact.h"
#include "fiber/force.h"
#include "fiber/start.h"
#include "fluid/fluid.h"
#include "mpc/collide.h"
#include "mpc/grid.h"

static struct model suspension(enum scheme order, uint32_t interval, bool forbidden)
{
  struct model m = test_model(4, 5, 4, 5, 0.01, interval);
  m.scheme = order;
  m.crossing.forbidden = forbidden;
  test_add_kind(&m, 16, 8);
  struct fiber_kind *ring = test_add_kind(&m, 3, 6);
  ring->ring = true;
  ring->mass = 2.5;
  ring->start = START_CIRCLE;
  return m;
}

/* --- a plain implementation --------------------------------------------------------------------------------------- */

/* Everything in doubles, particle by particle, solvent streamed in every drift. Index: solvent by id, then vertices. */
struct plain {
  const struct model *m;
  uint32_t n, solvent;
  double (*x)[3], (*v)[3], (*f)[3], *mass;
};

static struct plain plain_from(const struct test_run *r)
{
  struct plain p = {.m = &r->model, .solvent = r->state.solvent.n};
  p.n = p.solvent + r->state.vertices;
  p.x = calloc(p.n, sizeof *p.x), p.v = calloc(p.n, sizeof *p.v), p.f = calloc(p.n, sizeof *p.f);
  p.mass = calloc(p.n, sizeof *p.mass);
  for (uint32_t i = 0; i < p.solvent; i++) {
    const struct solvent *s = &r->state.solvent;
    const uint32_t id = s->id[i];
    const double x[3] = {(double)s->x[i] * 0x1p-40, (double)s->y[i] * 0x1p-40, (double)s->z[i] * 0x1p-40};
    const double v[3] = {s->vx[i], s->vy[i], s->vz[i]};
    memcpy(p.x[id], x, sizeof x), memcpy(p.v[id], v, sizeof v);
    p.mass[id] = 1.0;
  }
  for (uint32_t i = 0; i < r->state.vertices; i++) {
    const struct vec3 x = point_in_a0(r->state.position[i]), v = r->state.velocity[i];
    memcpy(p.x[p.solvent + i], &x, sizeof x), memcpy(p.v[p.solvent + i], &v, sizeof v);
    p.mass[p.solvent + i] = r->model.mass[i];
  }
  return p;
}

static void plain_free(struct plain *p)
{
  free(p->x), free(p->v), free(p->f), free(p->mass);
}

static void plain_drift(struct plain *p, double t)
{
  const double a[3] = {p->m->solvent.acceleration.x, p->m->solvent.acceleration.y, p->m->solvent.acceleration.z};
  for (uint32_t i = 0; i < p->n; i++)
    for (int c = 0; c < 3; c++) {
      const double g = i < p->solvent ? a[c] : 0.0;
      p->x[i][c] += p->v[i][c] * t + 0.5 * g * t * t;
      p->v[i][c] += g * t;
    }
}

static void plain_bond(struct plain *p, uint32_t i, uint32_t j, double u[3], double *length)
{
  *length = 0.0;
  for (int c = 0; c < 3; c++) {
    u[c] = p->x[p->solvent + j][c] - p->x[p->solvent + i][c];
    *length += u[c] * u[c];
  }
  *length = sqrt(*length);
  for (int c = 0; c < 3; c++)
    u[c] /= *length;
}

static void plain_force(struct plain *p)
{
  const struct model *m = p->m;
  memset(p->f, 0, p->n * sizeof *p->f);
  for (uint32_t i = 0; i < m->vertices; i++) {
    const struct fiber_kind *k = &m->kind[m->fiber_kind_of[m->fiber_of[i]]];
    double(*f)[3] = p->f + p->solvent, u[3], w[3], l, lw;
    f[i][0] += k->force.x, f[i][1] += k->force.y, f[i][2] += k->force.z;
    if (m->next[i] < 0)
      continue;
    plain_bond(p, i, (uint32_t)m->next[i], u, &l);
    for (int c = 0; c < 3; c++) {
      f[i][c] += k->spring * (l - k->bond_length) * u[c];
      f[m->next[i]][c] -= k->spring * (l - k->bond_length) * u[c];
    }
    if (m->prev[i] < 0)
      continue;
    plain_bond(p, (uint32_t)m->prev[i], i, w, &lw);
    const double cosine = u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
    for (int c = 0; c < 3; c++) { /* F = kappa dcos/dR: THEORY 1.1 */
      const double front = k->bending * (w[c] - cosine * u[c]) / l, back = -k->bending * (u[c] - cosine * w[c]) / lw;
      f[m->next[i]][c] += front;
      f[m->prev[i]][c] += back;
      f[i][c] -= front + back;
    }
  }
}

static void plain_kick(struct plain *p, double t)
{
  for (uint32_t i = p->solvent; i < p->n; i++)
    for (int c = 0; c < 3; c++)
      p->v[i][c] += p->f[i][c] * t / p->mass[i];
}

static void plain_collide(struct plain *p, uint64_t step)
{
  const struct model *m = p->m;
  const int *l = m->box.cells;
  const struct random_words shift = random_at(m->seed, RANDOM_GRID_SHIFT, 0, step, 0);
  uint32_t *cell = malloc(p->n * sizeof *cell);
  for (uint32_t i = 0; i < p->n; i++) {
    int at[3];
    for (int c = 0; c < 3; c++) {
      double y = p->x[i][c] + shift.w[c] * 0x1p-32;
      at[c] = (int)floor(y - l[c] * floor(y / l[c]));
    }
    cell[i] = (uint32_t)((at[2] * l[1] + at[1]) * l[0] + at[0]);
  }
  for (uint32_t k = 0; k < (uint32_t)box_cell_count(&m->box); k++) {
    double momentum[3] = {0, 0, 0}, mass = 0.0;
    for (uint32_t i = 0; i < p->n; i++)
      if (cell[i] == k) {
        mass += p->mass[i];
        for (int c = 0; c < 3; c++)
          momentum[c] += p->mass[i] * p->v[i][c];
      }
    const struct vec3 a = random_axis(m->seed, RANDOM_ROTATION_AXIS, step, k);
    const double n[3] = {a.x, a.y, a.z}, cosine = m->solvent.cosine, sine = m->solvent.sine;
    for (uint32_t i = 0; i < p->n; i++)
      if (cell[i] == k) {
        double w[3], along = 0.0;
        for (int c = 0; c < 3; c++) {
          w[c] = p->v[i][c] - momentum[c] / mass;
          along += w[c] * n[c];
        }
        for (int c = 0; c < 3; c++) {
          const int d = (c + 1) % 3, e = (c + 2) % 3;
          p->v[i][c] =
              momentum[c] / mass + along * n[c] + cosine * (w[c] - along * n[c]) + sine * (n[d] * w[e] - n[e] * w[d]);
        }
      }
  }
  free(cell);
}

/* The three orders as THEORY finding 1 and step.c's head describe them. */
static void plain_step(struct plain *p, uint64_t step)
{
  const double dt = p->m->time_step;
  const bool collides = step % p->m->solvent.interval_steps == 0;
  if (collides && p->m->scheme == SCHEME_DRIFT_SPLIT) {
    plain_drift(p, dt / 2);
    plain_collide(p, step);
    plain_drift(p, dt / 2);
  } else {
    plain_drift(p, dt);
  }
  if (collides && p->m->scheme == SCHEME_PAPER)
    plain_collide(p, step);
  plain_force(p);
  if (collides && p->m->scheme == SCHEME_KICK_SPLIT) {
    plain_kick(p, dt / 2);
    plain_collide(p, step);
    plain_kick(p, dt / 2);
  } else {
    plain_kick(p, dt);
  }
}

static void compare_with_plain(const struct test_run *r, const struct plain *p)
{
  for (uint32_t i = 0; i < p->solvent; i++) {
    const uint32_t id = r->state.solvent.id[i];
    const double lag = 0.5 * r->state.solvent_lag * r->model.time_step;
    const struct point at = fluid_position_now(&r->state, &r->model, i);
    const struct vec3 x = point_in_a0(at),
                      v = vec3_add_scaled(solvent_v(&r->state, i), lag, r->model.solvent.acceleration);
    const double *expected = p->x[id], here[3] = {x.x, x.y, x.z};
    for (int c = 0; c < 3; c++) {
      double off = (here[c] - expected[c]) / r->model.box.cells[c];
      assert_close(off - rint(off), 0.0, 1e-9);
    }
    assert_close(v.x, p->v[id][0], 1e-9);
    assert_close(v.y, p->v[id][1], 1e-9);
    assert_close(v.z, p->v[id][2], 1e-9);
  }
  for (uint32_t i = 0; i < r->state.vertices; i++) {
    const struct vec3 x = point_in_a0(r->state.position[i]), v = r->state.velocity[i];
    const double *px = p->x[p->solvent + i], *pv = p->v[p->solvent + i];
    assert_close(vec3_norm(vec3_sub(x, (struct vec3){px[0], px[1], px[2]})), 0.0, 1e-9);
    assert_close(vec3_norm(vec3_sub(v, (struct vec3){pv[0], pv[1], pv[2]})), 0.0, 1e-8);
  }
}

static void orders_against_a_plain_implementation(void **unused)
{
  (void)unused;
  const enum scheme orders[] = {SCHEME_PAPER, SCHEME_KICK_SPLIT, SCHEME_DRIFT_SPLIT};
  for (int k = 0; k < 18; k++) {
    struct model m = suspension(orders[k % 3], k < 9 ? 1 : 3, false);
    m.seed = dice_seed(1301) + (uint64_t)k;
    if (k % 2) {
      m.solvent.acceleration = (struct vec3){0.3, -0.2, 0.1};
      m.kind[0].force = (struct vec3){-1, 0.5, 0};
      m.solvent.rotation_angle = 115.0;
    }
    struct test_run r = test_start(m);
    struct plain p = plain_from(&r);
    for (uint64_t step = 1; step <= 25; step++) {
      test_steps(&r, 1);
      plain_step(&p, step);
      compare_with_plain(&r, &p);
    }
    plain_free(&p);
    test_end(&r);
  }
}

/* --- the stages by hand
 * ----------------------------------------------------------------------------------------------- */

/* The same bits from the public functions called one by one, crossings forbidden: the second half drift of drift-split
 * is a sweep of its own, in an order of its own. */
static void stages_by_hand(void **unused)
{
  (void)unused;
  for (int k = 0; k < 3; k++) {
    const enum scheme order = (enum scheme)k;
    struct test_run r = test_start(suspension(order, 2, true)), h = test_start(suspension(order, 2, true));
    assert_true(state_hash(&r.state) == state_hash(&h.state));
    for (uint64_t step = 1; step <= 240; step++) {
      const bool collides = step % 2 == 0;
      test_steps(&r, 1);
      const bool half = collides && order == SCHEME_DRIFT_SPLIT, halves = collides && order == SCHEME_KICK_SPLIT;
      assert_true(contact_drift(&h.state, &h.model, &h.work.contact, half ? 0.5 : 1.0, step, 0, NULL, &h.work.fault));
      h.state.solvent_lag += half ? 1 : 2;
      if (collides && !halves)
        assert_true(fluid_stream(&h.state, &h.model, &h.work.fault) &&
                    mpc_collide(&h.state, &h.model, &h.work.mpc, step, &h.work.fault));
      if (half) {
        assert_true(contact_drift(&h.state, &h.model, &h.work.contact, 0.5, step, 1, NULL, &h.work.fault));
        h.state.solvent_lag += 1;
      }
      assert_true(fiber_forces(&h.state, &h.model, h.work.fiber.force, step, &h.work.fault));
      fiber_kick(&h.state, &h.model, h.work.fiber.force, halves ? 0.5 : 1.0);
      if (halves) {
        assert_true(fluid_stream(&h.state, &h.model, &h.work.fault) &&
                    mpc_collide(&h.state, &h.model, &h.work.mpc, step, &h.work.fault));
        fiber_kick(&h.state, &h.model, h.work.fiber.force, 0.5);
      }
      h.state.step = step;
      assert_true(state_hash(&r.state) == state_hash(&h.state));
    }
    print_message("  order %d: %lu crossings prevented\n", k, (unsigned long)r.state.counts.executed);
    assert_true(r.state.counts.executed > 0);
    assert_memory_equal(&r.state.counts, &h.state.counts, sizeof h.state.counts);
    test_end(&r);
    test_end(&h);
  }
}

static void collisions_come_every_interval(void **unused)
{
  (void)unused;
  struct model m = test_model(2, 2, 2, 5, 0.01, 3);
  test_finish(&m);
  for (uint64_t step = 1; step < 20; step++)
    assert_true(step_collides(&m, step) == (step % 3 == 0));
  model_free(&m);
  m = test_model(2, 2, 2, 0, 0.01, 3);
  test_add_kind(&m, 1, 1);
  test_finish(&m);
  assert_false(step_collides(&m, 3));
  model_free(&m);
}

/* --- the leap-frog
 * ----------------------------------------------------------------------------------------------------- */

/* Two vertices on a spring without rest length: x_n = A cos(n theta) + B sin(n theta), sin(theta/2) = omega dt / 2
 * exactly (THEORY 2.5), and (mu/2) v_+^2 + (mu/2) omega^2 x^2 + (mu/2) omega^2 dt x v_+ is conserved. */
static void harmonic_bond(void **unused)
{
  (void)unused;
  const double dts[] = {0.001, 0.05, 0.3};
  for (int k = 0; k < 3; k++) {
    struct model m = test_model(12, 12, 12, 0, dts[k], 1);
    struct fiber_kind *kind = test_add_kind(&m, 1, 2);
    kind->spring = 20.0;
    kind->bond_length = kind->bending = 0.0;
    m.flow = (struct vec3){0.1, 0, -0.2};
    m.seed = dice_seed(1302);
    struct test_run r = test_start(m);
    const double omega2 = 2.0 * 20.0 / 5.0, theta = 2.0 * asin(0.5 * sqrt(omega2) * dts[k]);
    const struct vec3 x0 = fiber_bond(&r.state, &r.model, 0), v0 = vec3_sub(r.state.velocity[1], r.state.velocity[0]);
    const struct vec3 x1 = vec3_add_scaled(x0, dts[k], v0);
    const struct vec3 b = vec3_scale(1.0 / sin(theta), vec3_add_scaled(x1, -cos(theta), x0));
    const double energy = vec3_dot(v0, v0) + omega2 * vec3_dot(x0, x0) + omega2 * dts[k] * vec3_dot(x0, v0);
    const struct vec3 middle = vec3_add(point_in_a0(r.state.position[0]), point_in_a0(r.state.position[1]));
    for (int n = 1; n <= 3000; n++) {
      test_steps(&r, 1);
      const struct vec3 x = fiber_bond(&r.state, &r.model, 0), v = vec3_sub(r.state.velocity[1], r.state.velocity[0]);
      const struct vec3 expected = vec3_add(vec3_scale(cos(n * theta), x0), vec3_scale(sin(n * theta), b));
      assert_close(vec3_norm(vec3_sub(x, expected)), 0.0, 1e-8);
      assert_close(vec3_dot(v, v) + omega2 * vec3_dot(x, x) + omega2 * dts[k] * vec3_dot(x, v), energy, 1e-8);
    }
    const struct vec3 moved =
        vec3_sub(vec3_add(point_in_a0(r.state.position[0]), point_in_a0(r.state.position[1])), middle);
    assert_close(moved.x / 2.0, 0.1 * 3000 * dts[k], 1e-7);
    assert_close(moved.y / 2.0, 0.0, 1e-7);
    assert_close(moved.z / 2.0, -0.2 * 3000 * dts[k], 1e-7);
    test_end(&r);
  }
}

/* --- starts, momentum, faults
 * ------------------------------------------------------------------------------------------ */

static struct vec3 total_momentum(const struct test_run *r)
{
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < r->state.solvent.n; i++)
    p = vec3_add(p, solvent_v(&r->state, i));
  for (uint32_t v = 0; v < r->state.vertices; v++)
    p = vec3_add_scaled(p, r->model.mass[v], r->state.velocity[v]);
  return p;
}

/* The start is solvent_start and fiber_start, one change of velocity for all that sets the momentum to M_total flow,
 * and half a kick. */
static void start_sets_momentum_and_half_kick(void **unused)
{
  (void)unused;
  struct model m = suspension(SCHEME_KICK_SPLIT, 2, true);
  m.flow = (struct vec3){0.5, -0.25, 0.125};
  struct test_run r = test_start(m), h = {.model = suspension(SCHEME_KICK_SPLIT, 2, true)};
  test_finish(&h.model);
  assert_true(state_alloc(&h.state, &h.model) && work_alloc(&h.work, &h.model));
  const double mass = 400 + 16 * 8 * 5.0 + 3 * 6 * 2.5;
  assert_close(r.model.total_mass, mass, 0.0);
  const struct vec3 p = total_momentum(&r);
  assert_close(vec3_norm(vec3_sub(p, vec3_scale(mass, m.flow))), 0.0, 1e-9);
  fluid_points.start(&h.state, &h.model);
  fiber_start(&h.state, &h.model, NULL, &(uint32_t){0});
  assert_true(fiber_forces(&h.state, &h.model, h.work.fiber.force, 0, &h.work.fault));
  const struct vec3 change = vec3_sub(solvent_v(&r.state, 0), solvent_v(&h.state, 0));
  for (uint32_t i = 0; i < h.state.solvent.n; i++)
    assert_close(vec3_norm(vec3_sub(vec3_sub(solvent_v(&r.state, i), solvent_v(&h.state, i)), change)), 0.0, 1e-14);
  for (uint32_t v = 0; v < h.state.vertices; v++) {
    struct vec3 expected = vec3_add(h.state.velocity[v], change);
    expected = vec3_add_scaled(expected, 0.005 / h.model.mass[v], h.work.fiber.force[v]);
    assert_close(vec3_norm(vec3_sub(r.state.velocity[v], expected)), 0.0, 1e-13);
    assert_memory_equal(&r.state.position[v], &h.state.position[v], sizeof *h.state.position);
  }
  assert_true(r.state.step == 0 && r.state.solvent_lag == 0);
  test_end(&r);
  test_end(&h);
}

/* Momentum is kept through 400 steps of everything; under body forces it grows as it must. */
static void momentum_is_kept(void **unused)
{
  (void)unused;
  for (int k = 0; k < 6; k++) {
    struct model m = suspension((enum scheme)(k % 3), 2, true);
    if (k >= 3) {
      m.solvent.acceleration = (struct vec3){0.01, 0, 0};
      m.kind[0].force = (struct vec3){0, 0.02, 0};
    }
    m.solvent.thermostat = (enum thermostat_kind)(k % 3);
    m.solvent.hydrodynamics = k % 2;
    struct test_run r = test_start(m);
    test_steps(&r, 400);
    const struct vec3 p = total_momentum(&r);
    const double solvent_time = 400 * 0.01 - 0.5 * r.state.solvent_lag * 0.01, vertex_time = 400.5 * 0.01;
    assert_close(p.x, k < 3 ? 0.0 : 400 * 0.01 * solvent_time, 1e-9);
    assert_close(p.y, k < 3 ? 0.0 : 128 * 0.02 * vertex_time, 1e-9);
    assert_close(p.z, 0.0, 1e-9);
    assert_true(r.state.counts.executed > 0);
    test_end(&r);
  }
}

static void faults_stop_the_step(void **unused)
{
  (void)unused;
  for (int k = 0; k < 4; k++) {
    struct test_run r = test_start(suspension(SCHEME_KICK_SPLIT, 1, true));
    test_steps(&r, 3);
    const enum fault_code expected[] = {FAULT_SOLVENT_MOVE, FAULT_VERTEX_MOVE, FAULT_BOND_TOO_LONG,
                                        FAULT_SOLVENT_SPEED};
    if (k == 0)
      r.state.solvent.vx[7] = NAN;
    if (k == 1)
      r.state.velocity[5].y = 1e4;
    if (k == 2)
      r.state.velocity[5].y = 199.0; /* 1.99 a0 in a step, and the bond is then longer than 2 */
    if (k == 3)
      r.state.solvent.vy[9] = 9e4; /* flies 900 a0, which is allowed, but no sum of 10 members holds it safely */
    bool ok = true;
    for (int n = 0; n < 3 && ok; n++) {
      ok = step_advance(&r.state, &r.model, &r.work, NULL);
      if (k == 2)
        r.state.velocity[5].y = 199.0;
    }
    assert_false(ok);
    assert_int_equal(r.work.fault.code, expected[k]);
    assert_true(r.work.fault.step >= 4 && r.work.fault.step <= 6);
    test_end(&r);
  }
  struct model m = test_model(6, 4, 6, 0, 0.01, 1); /* many bonds of 1.95 +- 0.22 a0 do not fit an edge of 4 */
  struct fiber_kind *kind = test_add_kind(&m, 20, 3);
  kind->bond_length = 1.9, kind->spring = 20.0;
  struct test_run r = {.model = m};
  test_finish(&r.model);
  assert_true(state_alloc(&r.state, &r.model) && work_alloc(&r.work, &r.model));
  assert_false(start_state(&r.state, &r.model, &r.work));
  assert_int_equal(r.work.fault.code, FAULT_BOND_TOO_LONG);
  assert_true(r.work.fault.step == 0);
  test_end(&r);
}

/* Models without solvent, without fibers, without bonds step as well. */
static void partial_models_step(void **unused)
{
  (void)unused;
  for (int k = 1; k < 8; k++) {
    struct model m = test_model(3, 3, 3, k & 1 ? 5 : 0, 0.01, 2);
    if (k & 2)
      test_add_kind(&m, 4, 1);
    if (k & 4)
      test_add_kind(&m, 1, 2);
    struct test_run r = test_start(m);
    test_steps(&r, 10);
    assert_true(r.state.step == 10);
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(orders_against_a_plain_implementation),
      cmocka_unit_test(stages_by_hand),
      cmocka_unit_test(collisions_come_every_interval),
      cmocka_unit_test(harmonic_bond),
      cmocka_unit_test(start_sets_momentum_and_half_kick),
      cmocka_unit_test(momentum_is_kept),
      cmocka_unit_test(faults_stop_the_step),
      cmocka_unit_test(partial_models_step),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
