/* Filaments: inextensible fibers in overdamped motion without noise. Exact values of resistive-force theory, of the
 * drag of rows of spheres, and the linear response to a force across them, from a program of its own (boundary value
 * problem). */
#include "exact.h"
#include "fiber/mobility.h"
#include "fiber/tension.h"

/* n vertices in a row along `along` (not of unit length: it is the bond vector), D0 = 1, bending 1, under the force
 * strength/n on each, along z. B = strength (n - 1)^2 where bonds have the length 1. */
static struct test_run row(uint32_t n, struct vec3 along, double strength, double dt, enum medium_tensor tensor,
                           double radius)
{
  struct model m = test_model(60, 60, 60, 0, dt, 0);
  m.medium = (struct medium_model){
      .kind = MEDIUM_OVERDAMPED, .rate = 1.0, .tensor = tensor, .radius = radius, .inextensible = true};
  m.crossing.forbidden = false;
  struct fiber_kind *k = test_add_kind(&m, 1, n);
  k->mass = 1.0;
  k->bond_length = vec3_norm(along);
  k->spring = 100.0;
  k->bending = 1.0;
  k->force = (struct vec3){0, 0, strength / n};
  k->start = START_STRAIGHT;
  struct test_run r = test_start(m);
  for (uint32_t v = 0; v < n; v++)
    r.state.position[v] = point_move((struct point){0, 0, 0}, vec3_scale(v, along));
  return r;
}

static const struct vec3 along_x = {1, 0, 0};

/* One step across the row. Oseen: v_i = f [1 + (3a/4b) (H_{i-1} + H_{N-i})] with harmonic numbers. RPY, N = 21, a =
 * b/2: the mean is 1 + (2/N) sum_k (N - k) p(k), 3.1246265 f. */
static void drag_across(void **unused)
{
  (void)unused;
  enum { N = 21 };
  const double dt = 0.001, f = 10.0;
  struct test_run r = row(N, along_x, f * N, dt, TENSOR_OSEEN, 0.25);
  test_steps(&r, 1);
  for (uint32_t i = 0; i < N; i++) {
    double sum = 0.0;
    for (uint32_t k = 1; k < N; k++)
      sum += (k <= i ? 1.0 / k : 0.0) + (k < N - i ? 1.0 / k : 0.0);
    assert_close(point_in_a0(r.state.position[i]).z, f * dt * (1.0 + 0.75 * 0.25 * sum), 1e-12);
    assert_close(point_in_a0(r.state.position[i]).x, (double)i, 1e-12);
  }
  test_end(&r);
  r = row(N, along_x, f * N, dt, TENSOR_RPY, 0.5);
  test_steps(&r, 1);
  double mean = 0.0;
  for (uint32_t i = 0; i < N; i++)
    mean += point_in_a0(r.state.position[i]).z / (N * f * dt);
  assert_close(mean, 3.1246265371, 1e-9);
  test_end(&r);
}

/* The forces that move a row of spheres at one velocity v = 1 across or along it: more at its ends than in the middle.
 * RPY, a = b/2. Across has 1.48 and 1.62 times the drag of along; 2 is the limit of long rods. Apart from this program:
 * numpy.linalg.solve(D, ones), D_ij = p (across) or p + q (along) of |i - j| b.
 */
static void ends_have_more_friction(void **unused)
{
  (void)unused;
  enum { MOST = 101, ORDER = 3 * MOST };
  static const struct {
    uint32_t n, axis; /* of the velocity; the row is along x */
    double end, middle, sum;
  } rows[] = {{21, 2, 0.5549818872, 0.2884499279, 6.8456833375},
              {21, 0, 0.5003850485, 0.1833191349, 4.6343536153},
              {101, 2, 0.4903876358, 0.2172797269, 23.7580669977},
              {101, 0, 0.4338380768, 0.1305798253, 14.6947618006}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    static double tensor[ORDER * ORDER], force[ORDER];
    struct vec3 place[MOST];
    const uint32_t n = rows[k].n;
    for (uint32_t i = 0; i < n; i++)
      place[i] = (struct vec3){i, 0, 0};
    for (uint32_t i = 0; i < 3 * n; i++)
      force[i] = i % 3 == rows[k].axis;
    double pivot, sum = 0.0;
    mobility_fill(mobility_of(TENSOR_RPY), 0.5, n, place, tensor);
    assert_true(mobility_factor(3 * n, tensor, &pivot));
    mobility_solve(3 * n, tensor, force);
    for (uint32_t i = 0; i < n; i++)
      sum += force[3 * i + rows[k].axis];
    assert_close(force[rows[k].axis], rows[k].end, 2e-10);
    assert_close(force[3 * (n / 2) + rows[k].axis], rows[k].middle, 2e-10);
    assert_close(sum, rows[k].sum, 2e-9);
  }
}

/* Without hydrodynamic interactions all vertices move alike: a filament across the force stays straight, to the bit,
 * and a bent one has bends that relax, but no force bends it. */
static void no_interactions_no_bend(void **unused)
{
  (void)unused;
  struct test_run r = row(11, along_x, 20.0, 0.05, TENSOR_NONE, 0.0);
  test_steps(&r, 2000);
  const int64_t z = r.state.position[0].z;
  assert_true(z > 0);
  for (uint32_t i = 0; i < 11; i++) {
    assert_int_equal(r.state.position[i].z, z);
    assert_int_equal(r.state.position[i].x, (int64_t)i << LATTICE_BITS);
    assert_int_equal(r.state.position[i].y, 0);
  }
  test_end(&r);
}

/* Amplitude over length of a filament across a small force is c B, B = F L^2/kappa: c of the boundary value problem,
 * five digits. Beyond rounding of these, terms of the order of the amplitude squared are left, 1e-6. */
static void low_force_amplitude(void **unused)
{
  (void)unused;
  static const struct {
    uint32_t n;
    enum medium_tensor tensor;
    double radius, c;
  } rows[] = {{11, TENSOR_OSEEN, 0.25, 7.0776e-4},
              {11, TENSOR_RPY, 0.25, 7.2338e-4},
              {11, TENSOR_RPY, 0.5, 1.45102e-3},
              {21, TENSOR_RPY, 0.5, 1.12418e-3}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    const uint32_t n = rows[k].n;
    /* 15 times the slowest time, which is that without interactions at most: zeta L^4/(4.73^4 kappa), L = N b. */
    const double length = n - 1.0, time = 15.0 * pow(n, 4) / pow(4.73004, 4);
    struct test_run r = row(n, along_x, 1.0 / (length * length), 0.05, rows[k].tensor, rows[k].radius);
    test_steps(&r, (uint64_t)(time / 0.05));
    const double ends = 0.5 * (point_in_a0(r.state.position[0]).z + point_in_a0(r.state.position[n - 1]).z);
    const double amplitude = (point_in_a0(r.state.position[n / 2]).z - ends) / length;
    print_message("  N = %u: %.6g, wanted %.6g\n", n, amplitude, rows[k].c);
    assert_close(amplitude, rows[k].c, 2e-5 * rows[k].c);
    test_end(&r);
  }
}

/* Rate at which a filament at 45 degrees to the force turns, after its bend has formed. */
static double turning(double strength)
{
  struct test_run r = row(11, (struct vec3){1, 0, 1}, strength, 0.05, TENSOR_RPY, 0.5);
  double angle[2];
  for (int k = 0; k < 2; k++) {
    test_steps(&r, 8000);
    const struct vec3 ends = point_difference(r.state.position[10], r.state.position[0]);
    angle[k] = atan2(ends.z, ends.x);
  }
  test_end(&r);
  return (angle[1] - angle[0]) / 400.0;
}

/* The turn goes with B^2: with the bend, which goes with B, and the velocity. The law is one of small B: 0.5 %. */
static void turn_goes_as_the_square(void **unused)
{
  (void)unused;
  const double small = turning(0.003), large = turning(0.03);
  print_message("  rates %.6g and %.6g, ratio %.5g\n", small, large, large / small);
  assert_true(fabs(small) > 0.0);
  assert_close(large / small, 100.0, 0.5);
}

/* A bent filament under a strong force keeps the length of its bonds; what a step leaves goes with dt^2. */
static void bonds_keep_their_length(void **unused)
{
  (void)unused;
  double worst[2] = {0.0, 0.0};
  for (int half = 0; half < 2; half++) {
    const double dt = half ? 0.005 : 0.01;
    struct test_run r = row(21, along_x, 10.0, dt, TENSOR_RPY, 0.5);
    for (int step = 0; step < (half ? 4000 : 2000); step++) {
      test_steps(&r, 1);
      for (uint32_t v = 0; v < 20; v++)
        worst[half] = fmax(worst[half], fabs(vec3_norm(fiber_bond(&r.state, &r.model, v)) - 1.0));
    }
    const struct vec3 ends = point_difference(r.state.position[20], r.state.position[0]);
    assert_true(vec3_norm(ends) < 19.0); /* it is bent */
    test_end(&r);
  }
  print_message("  worst bond %.3g, at half the step %.3g\n", worst[0], worst[1]);
  assert_true(worst[0] < 1e-4);
  assert_close(worst[0] / worst[1], 4.0, 0.4);
}

/* Whatever the places, the tensor and the forces: G D (F + G^T T) = -excess. Chains and rings. */
static void tensions_solve_their_equation(void **unused)
{
  (void)unused;
  enum { N = 8, ORDER = 3 * N };
  struct dice dice = {dice_seed(3501)};
  for (int k = 0; k < 200; k++) {
    struct vec3 place[N];
    struct tension_bond bond[N];
    double d[ORDER * ORDER], matrix[N * N], t[N], force[ORDER], pull[ORDER], pivot;
    const uint32_t bonds = k % 2 ? N : N - 1;
    for (int i = 0; i < N; i++)
      place[i] = dice_vector(&dice, 3.0);
    for (uint32_t i = 0; i < bonds; i++) {
      const struct vec3 r = vec3_sub(place[(i + 1) % N], place[i]);
      bond[i] = (struct tension_bond){vec3_scale(1.0 / vec3_norm(r), r), dice_between(&dice, -1, 1), i, (i + 1) % N};
    }
    for (int i = 0; i < ORDER; i++)
      force[i] = dice_normal(&dice);
    mobility_fill(mobility_of(TENSOR_RPY), 0.5, N, place, d);
    mobility_apply(ORDER, d, force, pull);
    assert_true(tension_add(ORDER, d, pull, bonds, bond, matrix, t, force, &pivot));
    mobility_apply(ORDER, d, force, pull);
    for (uint32_t i = 0; i < bonds; i++) {
      double apart = bond[i].excess;
      const double u[3] = {bond[i].along.x, bond[i].along.y, bond[i].along.z};
      for (int c = 0; c < 3; c++)
        apart += u[c] * (pull[3 * bond[i].to + c] - pull[3 * bond[i].from + c]);
      assert_close(apart, 0.0, 1e-10);
    }
  }
}

/* Oseen: two spheres nearer than 3a/2 would go apart when they are pushed together. And a bond without length has no
 * direction. Then there is no tension. */
static void tensions_that_cannot_be_found(void **unused)
{
  (void)unused;
  struct test_run r = row(3, along_x, 1.0, 0.01, TENSOR_RPY, 0.25);
  r.model.kind[0].bending = 0.0;
  r.state.position[2] = r.state.position[1];
  assert_false(step_advance(&r.state, &r.model, &r.work, NULL));
  assert_int_equal(r.work.fault.code, FAULT_TENSION);
  test_end(&r);
  r = row(2, along_x, 1.0, 0.01, TENSOR_OSEEN, 0.7);
  assert_false(step_advance(&r.state, &r.model, &r.work, NULL));
  char text[512];
  fault_describe(&r.work.fault, text, sizeof text);
  print_message("  %s\n", text);
  assert_int_equal(r.work.fault.code, FAULT_TENSION);
  assert_non_null(strstr(text, "cannot be found"));
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(drag_across),
      cmocka_unit_test(ends_have_more_friction),
      cmocka_unit_test(no_interactions_no_bend),
      cmocka_unit_test(low_force_amplitude),
      cmocka_unit_test(turn_goes_as_the_square),
      cmocka_unit_test(bonds_keep_their_length),
      cmocka_unit_test(tensions_solve_their_equation),
      cmocka_unit_test(tensions_that_cannot_be_found),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
