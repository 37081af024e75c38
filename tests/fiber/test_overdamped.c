/* Overdamped motion: tensors, their factors, one step, and chains whose statics are known at any step. */
#include <gsl/gsl_eigen.h>

#include "exact.h"
#include "fiber/mobility.h"
#include "fiber/overdamped.h"
#include "statistics.h"
#include "theory/medium.h"

static const double pi = 3.14159265358979323846;

/* --- tensors ------------------------------------------------------------------------------------------------------ */

/* What is known of p and q: the divergence p' + q' + 2 q/r is 0 (by differences, away from r = 2a); the mean over
 * directions p + q/3 is a/r beyond contact, 1 - r/4a below; RPY and its slope are continuous at r = 2a, and it is D0 I
 * at r = 0. */
static void blocks(void **unused)
{
  (void)unused;
  const double a = 0.7, h = 1e-5;
  for (int tensor = TENSOR_OSEEN; tensor < MEDIUM_TENSORS; tensor++) {
    const struct mobility *m = mobility_of((enum medium_tensor)tensor);
    for (int k = 1; k < 60; k++) {
      const double r = 0.1 * k + 0.0321;
      double p, q, p1, q1, p0, q0;
      m->block(r, a, &p, &q);
      m->block(r + h, a, &p1, &q1);
      m->block(r - h, a, &p0, &q0);
      assert_close((p1 - p0 + q1 - q0) / (2.0 * h) + 2.0 * q / r, 0.0, 1e-9 * (1.0 + pow(r, -4)));
      assert_close(p + q / 3.0, tensor == TENSOR_RPY && r < 2.0 * a ? 1.0 - 0.25 * r / a : a / r, 1e-14 / r);
    }
  }
  double p[3], q[3];
  const struct mobility *rpy = mobility_of(TENSOR_RPY);
  for (int k = 0; k < 3; k++)
    rpy->block(2.0 * a + (k - 1) * h, a, &p[k], &q[k]);
  assert_close(p[1], 7.0 / 16.0, 1e-14);
  assert_close(q[1], 3.0 / 16.0, 1e-14);
  assert_close((p[2] - p[1]) / h, (p[1] - p[0]) / h, 1e-4);
  assert_close((q[2] - q[1]) / h, (q[1] - q[0]) / h, 1e-4);
  rpy->block(0.0, a, &p[0], &q[0]);
  assert_close(p[0], 1.0, 0.0);
  assert_close(q[0], 0.0, 0.0);
  assert_null(mobility_of(TENSOR_NONE)->block);
}

/* RPY is positive for all places: spheres in heaps, two at one place among them. L L^T is D; products are those of the
 * matrix. */
static void factors(void **unused)
{
  (void)unused;
  enum { N = 9, ORDER = 3 * N };
  struct dice d = {dice_seed(3401)};
  for (int k = 0; k < 1000; k++) {
    static double tensor[ORDER * ORDER], root[ORDER * ORDER];
    struct vec3 place[N];
    const double spread = dice_between(&d, 0.2, 4.0);
    for (int i = 0; i < N; i++)
      place[i] = dice_vector(&d, spread);
    if (k % 10 == 0)
      place[N - 1] = place[0];
    mobility_fill(mobility_of(TENSOR_RPY), 0.5, N, place, tensor);
    memcpy(root, tensor, sizeof root);
    double pivot, x[ORDER], y[ORDER], z[ORDER];
    assert_true(mobility_factor(ORDER, root, &pivot));
    for (int i = 0; i < ORDER; i++)
      x[i] = dice_normal(&d);
    mobility_apply(ORDER, tensor, x, y);
    mobility_root(ORDER, root, x, z);
    for (int i = 0; i < ORDER; i++) {
      double product = 0.0, applied = 0.0, rooted = 0.0;
      for (int j = 0; j < ORDER; j++) {
        applied += (i >= j ? tensor[j * ORDER + i] : tensor[i * ORDER + j]) * x[j];
        rooted += i >= j ? root[j * ORDER + i] * x[j] : 0.0;
      }
      assert_close(y[i], applied, 1e-13);
      assert_close(z[i], rooted, 1e-13);
      for (int j = 0; j <= i; j++) {
        product = 0.0;
        for (int l = 0; l <= j; l++)
          product += root[l * ORDER + i] * root[l * ORDER + j];
        assert_close(product, tensor[j * ORDER + i], 2e-12);
      }
    }
  }
}

static double inner(uint32_t n, const double *x, const double *y)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < n; i++)
    sum += x[i] * y[i];
  return sum;
}

enum { MOST = 27 };

/* Lanczos' vectors q[steps] of D from z on, orthogonal, and the tridiagonal matrix a, b that D is in their space.
 * Returns their number. */
static uint32_t lanczos(uint32_t n, const double *d, const double *z, double q[MOST][MOST], double *a, double *b)
{
  const double size = sqrt(inner(n, z, z));
  for (uint32_t i = 0; i < n; i++)
    q[0][i] = z[i] / size;
  for (uint32_t step = 0;; step++) {
    double w[MOST];
    mobility_apply(n, d, q[step], w);
    a[step] = inner(n, q[step], w);
    for (uint32_t k = 0; k < 2 * (step + 1); k++) { /* twice against each */
      const double share = inner(n, q[k / 2], w);
      for (uint32_t i = 0; i < n; i++)
        w[i] -= share * q[k / 2][i];
    }
    b[step] = sqrt(inner(n, w, w));
    if (step + 1 == n || b[step] < 1e-10)
      return step + 1;
    for (uint32_t i = 0; i < n; i++)
      q[step + 1][i] = w[i] / b[step];
  }
}

/* The symmetric root of D times z, from products with D alone (Ando et al., J. Chem. Phys. 137, 064106 (2012)). */
static void lanczos_root(uint32_t n, const double *d, const double *z, double *y)
{
  double q[MOST][MOST], a[MOST], b[MOST];
  const uint32_t m = lanczos(n, d, z, q, a, b);
  gsl_matrix *t = gsl_matrix_calloc(m, m), *v = gsl_matrix_alloc(m, m);
  gsl_vector *e = gsl_vector_alloc(m);
  gsl_eigen_symmv_workspace *space = gsl_eigen_symmv_alloc(m);
  for (uint32_t k = 0; k < m; k++) {
    gsl_matrix_set(t, k, k, a[k]);
    if (k + 1 < m)
      gsl_matrix_set(t, k + 1, k, b[k]);
  }
  gsl_eigen_symmv(t, e, v, space);
  memset(y, 0, n * sizeof *y);
  for (uint32_t k = 0; k < m; k++)
    for (uint32_t j = 0; j < m; j++) {
      const double root = sqrt(fmax(gsl_vector_get(e, k), 0.0)) * gsl_matrix_get(v, j, k) * gsl_matrix_get(v, 0, k);
      for (uint32_t i = 0; i < n; i++)
        y[i] += sqrt(inner(n, z, z)) * root * q[j][i];
    }
  gsl_eigen_symmv_free(space);
  gsl_matrix_free(t);
  gsl_matrix_free(v);
  gsl_vector_free(e);
}

/* The second opinion on Cholesky's root: that of Lanczos, of every unit vector, is symmetric, and its square is L L^T.
 * So both noises have the same covariance. */
static void lanczos_agrees(void **unused)
{
  (void)unused;
  enum { N = 9, ORDER = 3 * N };
  struct dice dice = {dice_seed(3405)};
  for (int k = 0; k < 50; k++) {
    static double d[ORDER * ORDER], left[ORDER * ORDER], root[ORDER][ORDER], column[ORDER][ORDER];
    struct vec3 place[N];
    const double spread = dice_between(&dice, 0.5, 4.0);
    double pivot;
    for (int i = 0; i < N; i++)
      place[i] = dice_vector(&dice, spread);
    mobility_fill(mobility_of(TENSOR_RPY), 0.5, N, place, d);
    memcpy(left, d, sizeof left);
    assert_true(mobility_factor(ORDER, left, &pivot));
    for (int i = 0; i < ORDER; i++) {
      double unit[ORDER] = {0};
      unit[i] = 1.0;
      lanczos_root(ORDER, d, unit, root[i]);
      mobility_root(ORDER, left, unit, column[i]);
    }
    for (int i = 0; i < ORDER; i++)
      for (int j = 0; j <= i; j++) {
        double square = 0.0, product = 0.0;
        for (int l = 0; l < ORDER; l++) {
          square += root[l][i] * root[l][j];
          product += column[l][i] * column[l][j];
        }
        assert_close(root[i][j], root[j][i], 1e-9);
        assert_close(square, product, 1e-10);
      }
  }
}

/* Oseen: two spheres along the line between them need r > 3a/2; a straight chain of spacing b needs a/b < 1/(3 ln 2) =
 * 0.48090 where it is long; at a/b = 1/2 ten are too many. */
static void oseen_is_not_positive(void **unused)
{
  (void)unused;
  static double tensor[900 * 900];
  static const struct {
    uint32_t n;
    double ratio;
    bool positive;
  } rows[] = {{2, 1 / 1.51, true}, {2, 1 / 1.49, false}, {300, 0.480, true},
              {300, 0.482, false}, {9, 0.482, true},     {10, 0.5, false}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    struct vec3 place[300];
    double pivot;
    for (uint32_t i = 0; i < rows[k].n; i++)
      place[i] = (struct vec3){i, 0, 0};
    mobility_fill(mobility_of(TENSOR_OSEEN), rows[k].ratio, rows[k].n, place, tensor);
    assert_int_equal(mobility_factor(3 * rows[k].n, tensor, &pivot), rows[k].positive);
  }
}

/* --- steps -------------------------------------------------------------------------------------------------------- */

static struct model chains(uint32_t count, uint32_t vertices, double dt, enum medium_tensor tensor)
{
  struct model m = test_model(40, 40, 40, 0, dt, 0);
  m.medium = (struct medium_model){
      .kind = MEDIUM_OVERDAMPED, .rate = 0.5, .tensor = tensor, .radius = tensor == TENSOR_NONE ? 0.0 : 0.25};
  m.crossing.forbidden = false;
  struct fiber_kind *k = test_add_kind(&m, count, vertices);
  k->mass = 2.0;
  k->bond_length = k->bending = 0.0;
  k->spring = 3.0;
  return m;
}

/* One step of pairs at a given distance: along the line between them, the relative displacement has the mean
 * -2 (1 - d) F dt and the variance 4 (1 - d) dt, d = p + q; across it 4 (1 - p) dt; their middle moves by (1 + d) dt
 * and (1 + p) dt. 40 000 pairs, 4 standard errors. */
static void one_step(void **unused)
{
  (void)unused;
  enum { PAIRS = 40000 };
  const double dt = 0.01;
  struct model m = chains(PAIRS, 2, dt, TENSOR_RPY);
  m.kind[0].start = START_STRAIGHT;
  m.seed = dice_seed(3402);
  struct test_run r = test_start(m);
  struct sample along[2] = {{0}}, across[2] = {{0}}, mean = {0};
  struct point *old = calloc(2 * PAIRS, sizeof *old);
  memcpy(old, r.state.position, 2 * PAIRS * sizeof *old);
  test_steps(&r, 1);
  const double length = vec3_norm(point_difference(old[1], old[0])), s = 0.25 / length;
  const double p = 0.75 * s * (1.0 + 2.0 / 3.0 * s * s), q = 0.75 * s * (1.0 - 2.0 * s * s),
               drift = 2.0 * (1.0 - p - q) * 3.0 * length * dt;
  for (uint32_t v = 0; v < 2 * PAIRS; v += 2) {
    const struct vec3 e = vec3_scale(1.0 / length, point_difference(old[v + 1], old[v])),
                      a = point_difference(r.state.position[v], old[v]),
                      b = point_difference(r.state.position[v + 1], old[v + 1]), apart = vec3_sub(b, a),
                      middle = vec3_scale(0.5, vec3_add(a, b));
    const double x = vec3_dot(apart, e), y = vec3_dot(middle, e);
    sample_add(&mean, x);
    sample_add(&along[0], (x + drift) * (x + drift));
    sample_add(&along[1], y * y);
    sample_add(&across[0], 0.5 * (vec3_dot(apart, apart) - x * x));
    sample_add(&across[1], 0.5 * (vec3_dot(middle, middle) - y * y));
  }
  assert_true(length > 0.6);
  assert_sigma(mean.mean, sample_error(&mean), -drift, 4.0);
  assert_sigma(along[0].mean, sample_error(&along[0]), 4.0 * (1.0 - p - q) * dt, 4.0);
  assert_sigma(along[1].mean, sample_error(&along[1]), (1.0 + p + q) * dt, 4.0);
  assert_sigma(across[0].mean, sample_error(&across[0]), 4.0 * (1.0 - p) * dt, 4.0);
  assert_sigma(across[1].mean, sample_error(&across[1]), (1.0 + p) * dt, 4.0);
  free(old);
  test_end(&r);
}

/* Without a tensor a chain of N has D = D0/N over any number of steps, about the flow, and a mode of rate lambda has
 * 1/(1 - lambda dt/2) of its size: <l^2> = (1/(N-1)) sum_p 1/(1 - lambda_p dt/2), lambda_p = 12 sin^2(p pi/2N).
 * N = 5, dt = 0.05; 400 chains, blocks of 5 t0; 4 standard errors. */
static void free_draining(void **unused)
{
  (void)unused;
  enum { N = 5, CHAINS = 400 };
  struct model m = chains(CHAINS, N, 0.05, TENSOR_NONE);
  m.flow = (struct vec3){0.25, 0, -1.0};
  m.seed = dice_seed(3403);
  struct test_run r = test_start(m);
  struct sample size = {0}, spread = {0};
  double expected = 0.0;
  for (int p = 1; p < N; p++)
    expected += 1.0 / (1.0 - 6.0 * pow(sin(p * pi / (2 * N)), 2) * 0.05) / (N - 1);
  struct vec3 *old = calloc(CHAINS, sizeof *old);
  test_steps(&r, 100);
  for (int block = 0; block < 40; block++) {
    double bonds = 0.0, square = 0.0;
    for (int half = 0; half < 2; half++) {
      for (uint32_t c = 0; c < CHAINS; c++) {
        struct vec3 middle = {0, 0, 0};
        for (uint32_t i = 0; i < N; i++) {
          const uint32_t v = c * N + i;
          middle = vec3_add_scaled(middle, 1.0 / N, point_in_a0(r.state.position[v]));
          if (half && i + 1 < N) {
            const struct vec3 bond = point_difference(r.state.position[v + 1], r.state.position[v]);
            bonds += vec3_dot(bond, bond) / (CHAINS * (N - 1));
          }
        }
        const struct vec3 moved = vec3_sub(vec3_add_scaled(middle, -5.0, r.model.flow), old[c]);
        square += half ? vec3_dot(moved, moved) / (CHAINS * 3) : 0.0;
        old[c] = middle;
      }
      if (!half)
        test_steps(&r, 100);
    }
    sample_add(&size, bonds);
    sample_add(&spread, square);
  }
  assert_sigma(size.mean, sample_error(&size), expected, 4.0);
  assert_sigma(spread.mean, sample_error(&spread), 2.0 * 5.0 / N, 4.0);
  free(old);
  test_end(&r);
}

/* Kirkwood's D over exact samples of the chain: 0.28559 of D0 for N = 10, a/b = 1/4. */
static void kirkwood_of_samples(void **unused)
{
  (void)unused;
  enum { N = 10, CHAINS = 3000 };
  static double tensor[9 * N * N];
  struct model m = chains(CHAINS, N, 0.01, TENSOR_RPY);
  m.seed = dice_seed(3404);
  struct test_run r = test_start(m);
  struct sample d = {0};
  for (uint32_t c = 0; c < CHAINS; c++) {
    struct vec3 place[N];
    double trace = 0.0;
    for (uint32_t i = 0; i < N; i++)
      place[i] = point_difference(r.state.position[c * N + i], r.state.position[c * N]);
    mobility_fill(mobility_of(TENSOR_RPY), 0.25, N, place, tensor);
    for (uint32_t j = 0; j < N; j++)
      for (uint32_t i = j; i < N; i++)
        for (uint32_t k = 0; k < 3; k++)
          trace += (i == j ? 1.0 : 2.0) * tensor[(3 * j + k) * 3 * N + 3 * i + k];
    sample_add(&d, trace / (3.0 * N * N));
  }
  assert_sigma(d.mean, sample_error(&d), 0.28559, 4.0);
  test_end(&r);
}

/* A chain whose vertices come near each other stops with the reason under `oseen`; it goes on under `rpy`. */
static void oseen_stops(void **unused)
{
  (void)unused;
  for (int tensor = TENSOR_OSEEN; tensor < MEDIUM_TENSORS; tensor++) {
    struct test_run r = test_start(chains(20, 10, 0.01, (enum medium_tensor)tensor));
    bool ok = true;
    for (int k = 0; k < 50 && ok; k++)
      ok = step_advance(&r.state, &r.model, &r.work, NULL);
    assert_int_equal(ok, tensor == TENSOR_RPY);
    if (!ok) {
      char text[512];
      fault_describe(&r.work.fault, text, sizeof text);
      print_message("  %s\n", text);
      assert_int_equal(r.work.fault.code, FAULT_MOBILITY);
      assert_non_null(strstr(text, "not positive"));
    }
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks),
      cmocka_unit_test(factors),
      cmocka_unit_test(lanczos_agrees),
      cmocka_unit_test(oseen_is_not_positive),
      cmocka_unit_test(one_step),
      cmocka_unit_test(free_draining),
      cmocka_unit_test(kirkwood_of_samples),
      cmocka_unit_test(oseen_stops),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
