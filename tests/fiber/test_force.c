/* Forces against derivatives of energies written here anew in long double; net force and torque; limits. */
#include "exact.h"
#include "fiber/force.h"

enum { MOST = 16 };
typedef long double real;

/* Energy of one fiber of n vertices at x: (k/2) (R - l0)^2 per bond, kappa (1 - cos) per bend, as the paper's Eqs. (1)
 * and (2) say; the angle by atan2, not by the product of unit vectors. */
static real energy(const struct fiber_kind *kind, real x[][3])
{
  const int n = (int)kind->vertices, bonds = kind->ring ? n : n - 1;
  real e = 0, b[MOST][3], length[MOST];
  for (int j = 0; j < bonds; j++) {
    real squared = 0;
    for (int c = 0; c < 3; c++) {
      b[j][c] = x[(j + 1) % n][c] - x[j][c];
      squared += b[j][c] * b[j][c];
    }
    length[j] = sqrtl(squared);
    e += 0.5L * kind->spring * (length[j] - kind->bond_length) * (length[j] - kind->bond_length);
  }
  for (int j = 0; j < bonds && kind->bending != 0.0; j++) {
    if (!kind->ring && j + 1 == bonds)
      break;
    const real *p = b[j], *q = b[(j + 1) % bonds];
    real dot = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    real cx = p[1] * q[2] - p[2] * q[1], cy = p[2] * q[0] - p[0] * q[2], cz = p[0] * q[1] - p[1] * q[0];
    e += kind->bending * (1.0L - cosl(atan2l(sqrtl(cx * cx + cy * cy + cz * cz), dot)));
  }
  return e;
}

/* -dE/dx by the six-point central difference, error of order h^6. */
static real slope(const struct fiber_kind *kind, real x[][3], int vertex, int c)
{
  const real h = 1e-3L, at = x[vertex][c], weight[3] = {45, -9, 1};
  real sum = 0;
  for (int k = 1; k <= 3; k++) {
    x[vertex][c] = at + k * h;
    sum += weight[k - 1] * energy(kind, x);
    x[vertex][c] = at - k * h;
    sum -= weight[k - 1] * energy(kind, x);
  }
  x[vertex][c] = at;
  return -sum / (60 * h);
}

struct shape {
  uint32_t vertices;
  bool ring;
  double spring, l0, kappa;
};

/* Open and closed, stiff and flexible, with and without rest length, from one vertex on. */
static const struct shape shapes[] = {
    {1, false, 100, 0.5, 64}, {2, false, 100, 0.5, 64}, {3, false, 100, 0.5, 64}, {9, false, 100, 0.5, 64},
    {9, false, 3, 0, 0},      {9, false, 3, 0, 2},      {9, false, 100, 0.5, 0},  {3, true, 100, 0.5, 64},
    {4, true, 3, 0, 0},       {9, true, 100, 0.5, 64},  {9, true, 3, 0, 2},       {16, false, 100, 0.5, 120},
};

/* Two fibers of this shape, the second after one of another kind so that numbers do not start at 0; some fiber shapes
 * straddle the box or lie images away. */
static struct test_run shaped(const struct shape *s, struct dice *d)
{
  struct model m = test_model(6, 7, 8, 0, 0.01, 2);
  test_add_kind(&m, 1, 5)->bond_length = 0.4;
  struct fiber_kind *kind = test_add_kind(&m, 2, s->vertices);
  kind->ring = s->ring;
  kind->spring = s->spring;
  kind->bond_length = s->l0;
  kind->bending = s->kappa;
  kind->force = (struct vec3){0.25, -1.5, 2};
  struct test_run r = dice_run(m, d);
  for (uint32_t v = 0; v < r.state.vertices; v++)
    if (v != r.model.fiber_first[r.model.fiber_of[v]])
      r.state.position[v] = point_move(r.state.position[v - 1], dice_rod(d, 0.2, 0.9));
  if (s->ring) /* bring the closing bond to a decent length */
    for (uint32_t f = 1; f < 3; f++)
      for (uint32_t i = 0, first = r.model.fiber_first[f]; i < s->vertices; i++) {
        double turn = 6.283185307 * i / s->vertices, radius = 0.12 * s->vertices;
        struct vec3 at = vec3_add((struct vec3){radius * cos(turn), radius * sin(turn), 0}, dice_vector(d, 0.1));
        r.state.position[first + i] = point_move(r.state.position[first], at);
      }
  return r;
}

static void forces_are_slopes_of_energies(void **unused)
{
  (void)unused;
  for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++)
    for (uint64_t again = 0; again < 20; again++) {
      const uint64_t seed = dice_seed(701) + 100 * k + again;
      struct dice d = {seed};
      struct test_run r = shaped(&shapes[k], &d);
      const struct fiber_kind *kind = &r.model.kind[1];
      assert_true(fiber_forces(&r.state, &r.model, r.work.fiber.force, 1, &r.work.fault));
      real total = 0;
      for (uint32_t f = 1; f < 3; f++) {
        const uint32_t first = r.model.fiber_first[f];
        real x[MOST][3];
        struct vec3 net = {0, 0, 0}, torque = {0, 0, 0};
        for (uint32_t i = 0; i < kind->vertices; i++) {
          x[i][0] = r.state.position[first + i].x * 0x1p-40L;
          x[i][1] = r.state.position[first + i].y * 0x1p-40L;
          x[i][2] = r.state.position[first + i].z * 0x1p-40L;
        }
        total += energy(kind, x);
        for (uint32_t i = 0; i < kind->vertices; i++) {
          const struct vec3 force = vec3_sub(r.work.fiber.force[first + i], kind->force);
          const double f3[3] = {force.x, force.y, force.z};
          for (int c = 0; c < 3; c++) {
            real expected = slope(kind, x, (int)i, c);
            if (!(fabsl(f3[c] - expected) <= 1e-7L * (1 + fabsl(expected))))
              fail_msg("seed %lu shape %zu vertex %u: force %.12g, slope %.12Lg", (unsigned long)seed, k, i, f3[c],
                       expected);
          }
          net = vec3_add(net, force);
          torque = vec3_add(torque,
                            vec3_cross(point_difference(r.state.position[first + i], r.state.position[first]), force));
        }
        assert_close(vec3_norm(net), 0.0, 1e-11);
        assert_close(vec3_norm(torque), 0.0, 1e-11);
      }
      struct fiber_energy e = fiber_energies(&r.state, &r.model);
      real other[MOST][3];
      for (uint32_t i = 0; i < 5; i++) {
        other[i][0] = r.state.position[i].x * 0x1p-40L;
        other[i][1] = r.state.position[i].y * 0x1p-40L;
        other[i][2] = r.state.position[i].z * 0x1p-40L;
      }
      total += energy(&r.model.kind[0], other);
      assert_close(e.bond + e.bend, (double)total, 1e-10 * (1.0 + (double)total));
      test_end(&r);
    }
}

/* By hand: k (R - l0) pulls the ends together; a right angle is straightened with kappa / R, across each bond. */
static void forces_by_hand(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.01, 2);
  test_add_kind(&m, 1, 3);
  struct dice d = {1};
  struct test_run r = dice_run(m, &d);
  const int64_t a0 = LATTICE_CELL, far = 17 * 8 * LATTICE_CELL; /* images away */
  r.state.position[0] = (struct point){far, 0, 0};
  r.state.position[1] = (struct point){far + a0, 0, 0};
  r.state.position[2] = (struct point){far + a0, 2 * a0, 0};
  assert_true(fiber_forces(&r.state, &r.model, r.work.fiber.force, 1, &r.work.fault));
  const double expected[3][3] = {{50, -64, 0}, {-50 - 32, 150 + 64, 0}, {32, -150, 0}};
  for (int v = 0; v < 3; v++) {
    assert_close(r.work.fiber.force[v].x, expected[v][0], 1e-12);
    assert_close(r.work.fiber.force[v].y, expected[v][1], 1e-12);
    assert_close(r.work.fiber.force[v].z, expected[v][2], 1e-12);
  }
  struct fiber_energy e = fiber_energies(&r.state, &r.model);
  assert_close(e.bond, 0.5 * 100 * (0.25 + 2.25), 1e-12);
  assert_close(e.bend, 64.0, 1e-12);

  /* Eq. (8): V += F fraction dt / M */
  r.state.velocity[2] = (struct vec3){1, 1, 1};
  fiber_kick(&r.state, &r.model, r.work.fiber.force, 0.5);
  assert_close(r.state.velocity[2].x, 1 + 32 * 0.005 / 5, 1e-15);
  assert_close(r.state.velocity[2].y, 1 - 150 * 0.005 / 5, 1e-15);
  assert_close(r.state.velocity[2].z, 1, 0);
  test_end(&r);
}

/* A bond of half the shortest edge stops the run, in whichever direction and with or without rest length; one unit less
 * does not. */
static void long_bonds_are_refused(void **unused)
{
  (void)unused;
  for (int k = 0; k < 24; k++) {
    struct model m = test_model(6, 4, 5, 0, 0.01, 2);
    struct fiber_kind *kind = test_add_kind(&m, 2, 4);
    if (k % 2)
      kind->bond_length = kind->bending = 0.0;
    struct dice d = {1};
    struct test_run r = dice_run(m, &d);
    for (uint32_t v = 0; v < 8; v++)
      r.state.position[v] = (struct point){(int64_t)v << 38, 0, 0};
    int64_t length = 2 * LATTICE_CELL - (k / 2 % 4 == 3 ? 1 : 0);
    struct point *end = &r.state.position[7], *before = &r.state.position[6];
    *end = *before;
    *(k / 8 == 0 ? &end->x : k / 8 == 1 ? &end->y : &end->z) += k / 4 % 2 ? length : -length;
    bool ok = fiber_forces(&r.state, &r.model, r.work.fiber.force, 5, &r.work.fault);
    assert_true(ok == (length < 2 * LATTICE_CELL));
    if (!ok) {
      assert_int_equal(r.work.fault.code, FAULT_BOND_TOO_LONG);
      assert_true(r.work.fault.entity == 6 && r.work.fault.step == 5);
      assert_close(r.work.fault.value, 2.0, 1e-15);
      assert_close(r.work.fault.limit, 2.0, 0.0);
    }
    test_end(&r);
  }
}

/* A bond of no length at all has no direction: nothing becomes NaN. */
static void coinciding_vertices_stay_finite(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++) {
    struct model m = test_model(6, 6, 6, 0, 0.01, 2);
    struct fiber_kind *kind = test_add_kind(&m, 1, 4);
    if (k)
      kind->bond_length = kind->bending = 0.0;
    struct dice d = {1};
    struct test_run r = dice_run(m, &d);
    for (uint32_t v = 0; v < 4; v++)
      r.state.position[v] = (struct point){v < 2 ? 0 : (int64_t)v << 38, 0, 0};
    assert_true(fiber_forces(&r.state, &r.model, r.work.fiber.force, 5, &r.work.fault));
    for (uint32_t v = 0; v < 4; v++)
      assert_true(isfinite(r.work.fiber.force[v].x) && isfinite(r.work.fiber.force[v].y));
    const struct fiber_energy energy = fiber_energies(&r.state, &r.model);
    assert_true(isfinite(energy.bond) && isfinite(energy.bend));
    test_end(&r);
  }
}

/* A ring's closing bond leads to vertex 0 of the first ring: a square of bonds 0.5 a0 longer than at rest, but one. */
static void energy_of_a_ring(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.01, 2);
  struct fiber_kind *kind = test_add_kind(&m, 1, 4);
  kind->ring = true;
  kind->bending = 0.0;
  const double l0 = kind->bond_length;
  struct dice d = {1};
  struct test_run r = dice_run(m, &d);
  const int64_t side = (int64_t)ldexp(l0 + 0.5, 40), closing = (int64_t)ldexp(l0 + 1.0, 40);
  r.state.position[0] = (struct point){0, 0, 0};
  r.state.position[1] = (struct point){side, 0, 0};
  r.state.position[2] = (struct point){side, side, 0};
  r.state.position[3] = (struct point){0, closing, 0};
  const double last = hypot(l0 + 0.5, 0.5) - l0; /* from 2 to 3 */
  assert_close(fiber_energies(&r.state, &r.model).bond, 0.5 * 100.0 * (0.25 + 0.25 + last * last + 1.0), 1e-9);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_are_slopes_of_energies),
      cmocka_unit_test(forces_by_hand),
      cmocka_unit_test(long_bonds_are_refused),
      cmocka_unit_test(coinciding_vertices_stay_finite),
      cmocka_unit_test(energy_of_a_ring),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
