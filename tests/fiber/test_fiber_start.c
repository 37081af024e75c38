/* Starting fibers: the exact equilibrium of the phantom chain (THEORY 2.8), straight fibers, circles, places. */
#include <gsl/gsl_integration.h>

#include "exact.h"
#include "fiber/force.h"
#include "fiber/start.h"
#include "system/fiber_kind.h"

/* --- p(l) ~ l^2 exp(-k (l-l0)^2 / 2), integrated numerically ------------------------------------------------------ */

struct weight {
  double k, l0;
  int power; /* of l, beyond the l^2 of the sphere */
};

static double density(double l, void *parameters)
{
  const struct weight *w = parameters;
  return pow(l, 2 + w->power) * exp(-0.5 * w->k * (l - w->l0) * (l - w->l0));
}

static double integral(struct weight w, double from, double to)
{
  gsl_integration_workspace *space = gsl_integration_workspace_alloc(1000);
  gsl_function f = {density, &w};
  double result, error;
  gsl_integration_qag(&f, from, to, 0.0, 1e-11, 1000, GSL_INTEG_GAUSS61, space, &result, &error);
  gsl_integration_workspace_free(space);
  return result;
}

static double bond_moment(double k, double l0, int power)
{
  const double far = l0 + 12.0 / sqrt(k);
  return integral((struct weight){k, l0, power}, 0.0, far) / integral((struct weight){k, l0, 0}, 0.0, far);
}

/* THEORY 2.8 prints these; the integrals must give them, and fiber_mean_bond the integrals. */
static void mean_bond_lengths(void **unused)
{
  (void)unused;
  assert_close(bond_moment(100, 0.5, 1), 0.538462, 1e-6);
  assert_close(bond_moment(100, 0.5, 2), 0.299231, 1e-6);
  assert_close(bond_moment(100, 0.5, -1), 1.923077, 1e-6);
  assert_close(bond_moment(3, 0, 1), 0.921318, 1e-6);
  assert_close(bond_moment(3, 0, 2), 1.0, 1e-9);
  assert_close(bond_moment(3, 0, -1), 1.381977, 1e-6);
  const double k[] = {100, 3, 1, 1000, 12, 0.5}, l0[] = {0.5, 0, 1, 0.3, 0.2, 2};
  for (int i = 0; i < 6; i++) {
    struct fiber_kind kind = {.spring = k[i], .bond_length = l0[i]};
    assert_close(fiber_mean_bond(&kind), bond_moment(k[i], l0[i], 1), 1e-9);
  }
}

/* --- equilibrium
 * ------------------------------------------------------------------------------------------------------ */

static struct test_run started(struct model m)
{
  struct test_run r = {.model = m};
  test_finish(&r.model);
  assert_true(state_alloc(&r.state, &r.model) && work_alloc(&r.work, &r.model));
  fiber_start(&r.state, &r.model, NULL, &(uint32_t){0});
  return r;
}

struct chain {
  double k, l0, kappa;
};

static const struct chain chains[] = {{100, 0.5, 64}, {3, 0, 0}, {100, 0.5, 2}, {20, 0.3, 0}};

static struct test_run many_chains(const struct chain *c, uint32_t count, uint32_t vertices, uint64_t seed)
{
  struct model m = test_model(20, 24, 28, 0, 0.01, 2);
  m.seed = seed;
  struct fiber_kind *kind = test_add_kind(&m, count, vertices);
  kind->spring = c->k;
  kind->bond_length = c->l0;
  kind->bending = c->kappa;
  return started(m);
}

/* Chance that a bond is shorter than l: fractions of the integral on a grid, interpolated (Kolmogorov-Smirnov wants it
 * to a small part of 1/sqrt(n)). */
static void length_distribution(const struct chain *c, double *l, size_t n)
{
  enum { GRID = 2000 };
  static double part[GRID + 1];
  const double far = c->l0 + 12.0 / sqrt(c->k), step = far / GRID;
  part[0] = 0.0;
  struct weight w = {c->k, c->l0, 0};
  for (int i = 0; i < GRID; i++) { /* Simpson */
    double a = density(i * step, &w), b = density((i + 0.5) * step, &w), d = density((i + 1) * step, &w);
    part[i + 1] = part[i] + (a + 4 * b + d) * step / 6;
  }
  for (size_t i = 0; i < n; i++) {
    int at = (int)(l[i] / step);
    assert_true(at >= 0 && at < GRID);
    l[i] = (part[at] + (part[at + 1] - part[at]) * (l[i] / step - at)) / part[GRID];
  }
}

/* Chance that the cosine is smaller than c: exp(kappa c), normalised. */
static double cosine_chance(double kappa, double c)
{
  return kappa == 0.0 ? 0.5 * (1.0 + c) : (exp(kappa * (c - 1.0)) - exp(-2.0 * kappa)) / (1.0 - exp(-2.0 * kappa));
}

/* Lengths, cosines, and the torsion angle have their distributions, and know nothing of each other. */
static void bonds_and_bends_have_their_distributions(void **unused)
{
  (void)unused;
  enum { COUNT = 4000, VERTICES = 8 };
  for (int k = 0; k < 4; k++) {
    const struct chain *c = &chains[k];
    struct test_run r = many_chains(c, COUNT, VERTICES, dice_seed(1201) + (uint64_t)k);
    double *length = malloc(COUNT * VERTICES * sizeof *length), *cosine = malloc(COUNT * VERTICES * sizeof *cosine);
    double *torsion = malloc(COUNT * VERTICES * sizeof *torsion);
    size_t lengths = 0, cosines = 0, torsions = 0;
    struct tally l1 = {0}, l2 = {0}, l4 = {0}, inverse = {0}, energy = {0}, lc = {0}, ll = {0}, cc = {0};
    const double mean = bond_moment(c->k, c->l0, 1);
    const double mean_cosine = c->kappa == 0.0 ? 0.0 : 1.0 / tanh(c->kappa) - 1.0 / c->kappa;
    for (uint32_t f = 0; f < COUNT; f++) {
      struct vec3 u[VERTICES - 1];
      double last_l = 0.0, last_c = 0.0;
      for (uint32_t i = 0; i < VERTICES - 1; i++) {
        u[i] = fiber_bond(&r.state, &r.model, f * VERTICES + i);
        const double l = vec3_norm(u[i]);
        u[i] = vec3_scale(1.0 / l, u[i]);
        length[lengths++] = l;
        tally_add(&l1, l), tally_add(&l2, l * l), tally_add(&l4, l * l * l * l), tally_add(&inverse, 1.0 / l);
        tally_add(&energy, 0.5 * c->k * (l - c->l0) * (l - c->l0));
        if (i > 0) {
          const double cos_now = vec3_dot(u[i - 1], u[i]);
          cosine[cosines++] = cosine_chance(c->kappa, cos_now);
          tally_add(&ll, (l - mean) * (last_l - mean));
          tally_add(&lc, (l - mean) * (cos_now - mean_cosine));
          if (i > 1) {
            tally_add(&cc, (cos_now - mean_cosine) * (last_c - mean_cosine));
            const struct vec3 p = vec3_cross(u[i - 2], u[i - 1]), q = vec3_cross(u[i - 1], u[i]);
            torsion[torsions++] = 0.5 + atan2(vec3_dot(vec3_cross(p, q), u[i - 1]), vec3_dot(p, q)) / 6.283185307179586;
          }
          last_c = cos_now;
        }
        last_l = l;
      }
    }
    assert_sigma(tally_mean(&l1), tally_error(&l1), mean, 4.5);
    assert_sigma(tally_mean(&l2), tally_error(&l2), bond_moment(c->k, c->l0, 2), 4.5);
    assert_sigma(tally_mean(&l4), tally_error(&l4), bond_moment(c->k, c->l0, 4), 4.5);
    assert_sigma(tally_mean(&inverse), tally_error(&inverse), bond_moment(c->k, c->l0, -1), 4.5);
    if (k == 0)
      assert_sigma(tally_mean(&energy), tally_error(&energy), 0.538462, 4.5); /* not 1/2 */
    if (k == 1)
      assert_sigma(tally_mean(&l4), tally_error(&l4), 5.0 / 3.0, 4.5);
    assert_sigma(tally_mean(&ll), tally_error(&ll), 0.0, 4.5);
    assert_sigma(tally_mean(&lc), tally_error(&lc), 0.0, 4.5);
    assert_sigma(tally_mean(&cc), tally_error(&cc), 0.0, 4.5);
    length_distribution(c, length, lengths);
    assert_true(kolmogorov(length, lengths) < KOLMOGOROV_LIMIT);
    assert_true(kolmogorov(cosine, cosines) < KOLMOGOROV_LIMIT);
    assert_true(kolmogorov(torsion, torsions) < KOLMOGOROV_LIMIT);
    free(length);
    free(cosine);
    free(torsion);
    test_end(&r);
  }
}

/* <R^2> and R_g^2 of whole chains: the table of THEORY 2.8 (N = 10, kappa = 20), and N-1, (N^2-1)/(6N) for the flexible
 * one of N = 20; tangents decay as <cos>^d; directions are isotropic. */
static void chains_have_their_size(void **unused)
{
  (void)unused;
  const struct chain rod = {100, 0.5, 20}, coil = {3, 0, 0};
  const uint32_t vertices[] = {10, 20};
  const double end_to_end[] = {20.3764, 19.0}, gyration[] = {2.1905, 3.325};
  for (int k = 0; k < 2; k++) {
    const uint32_t count = 20000, n = vertices[k];
    struct test_run r = many_chains(k ? &coil : &rod, count, n, dice_seed(1202) + (uint64_t)k);
    struct tally r2 = {0}, rg2 = {0}, axis[3] = {{0}}, tangent[4] = {{0}};
    for (uint32_t f = 0; f < count; f++) {
      const struct point *x = &r.state.position[f * n];
      struct vec3 end = point_difference(x[n - 1], x[0]), sum = {0, 0, 0}, u[4];
      double squares = 0.0;
      for (uint32_t i = 0; i < n; i++) {
        struct vec3 d = point_difference(x[i], x[0]);
        sum = vec3_add(sum, d);
        squares += vec3_dot(d, d);
      }
      tally_add(&r2, vec3_dot(end, end));
      tally_add(&rg2, squares / n - vec3_dot(sum, sum) / n / n);
      tally_add(&axis[0], end.x * end.x), tally_add(&axis[1], end.y * end.y), tally_add(&axis[2], end.z * end.z);
      for (int i = 0; i < 4; i++) {
        u[i] = point_difference(x[i + 1], x[i]);
        tally_add(&tangent[i], vec3_dot(u[0], u[i]) / vec3_norm(u[0]) / vec3_norm(u[i]));
      }
    }
    assert_sigma(tally_mean(&r2), tally_error(&r2), end_to_end[k], 4.5);
    assert_sigma(tally_mean(&rg2), tally_error(&rg2), gyration[k], 4.5);
    for (int c = 0; c < 3; c++)
      assert_sigma(tally_mean(&axis[c]), tally_error(&axis[c]), end_to_end[k] / 3.0, 4.5);
    for (int i = 1; i < 4; i++)
      assert_sigma(tally_mean(&tangent[i]), tally_error(&tangent[i]), k ? 0.0 : pow(0.95, i), 4.5);
    test_end(&r);
  }
}

/* First vertices are uniform in the box, velocities Maxwell with <M v^2> = 1 in each component. */
static void places_and_velocities(void **unused)
{
  (void)unused;
  enum { COUNT = 30000 };
  struct model m = test_model(5, 9, 3, 0, 0.01, 2);
  m.seed = dice_seed(1203);
  test_add_kind(&m, COUNT, 2)->mass = 2.0;
  test_add_kind(&m, COUNT, 1)->mass = 20.0;
  struct test_run r = started(m);
  double *u = malloc(COUNT * sizeof *u), *v = malloc(COUNT * sizeof *v);
  for (int kind = 0; kind < 2; kind++)
    for (int c = 0; c < 3; c++) {
      for (uint32_t f = 0; f < COUNT; f++) {
        uint32_t first = r.model.fiber_first[kind * COUNT + f];
        const struct point p = r.state.position[first];
        const struct vec3 w = r.state.velocity[first];
        int64_t at = c == 0 ? p.x : c == 1 ? p.y : p.z;
        u[f] = (double)at / (double)r.model.box.edge[c];
        assert_true(at >= 0 && at <= r.model.box.edge[c]);
        v[f] = gsl_cdf_ugaussian_P((c == 0 ? w.x : c == 1 ? w.y : w.z) * sqrt(kind ? 20.0 : 2.0));
      }
      assert_true(kolmogorov(u, COUNT) < KOLMOGOROV_LIMIT);
      assert_true(kolmogorov(v, COUNT) < KOLMOGOROV_LIMIT);
    }
  free(u);
  free(v);
  test_end(&r);
}

/* --- stated shapes
 * ---------------------------------------------------------------------------------------------------- */

static void place(struct fiber_kind *kind, struct vec3 center, struct vec3 direction)
{
  kind->placed = 1;
  kind->place = malloc(sizeof *kind->place);
  *kind->place = (struct fiber_place){center, direction};
}

/* Straight: evenly spaced by the mean bond length, along the direction, about the centre. The second fiber of the kind
 * has no place: it is as straight elsewhere. */
static void straight_fibers(void **unused)
{
  (void)unused;
  struct model m = test_model(20, 20, 20, 0, 0.01, 2);
  test_add_kind(&m, 3, 4);
  struct fiber_kind *kind = test_add_kind(&m, 2, 9);
  kind->start = START_STRAIGHT;
  place(kind, (struct vec3){3, -4, 25}, (struct vec3){2, -1, 2});
  struct test_run r = started(m);
  for (uint32_t f = 3; f < 5; f++) {
    const struct point *x = &r.state.position[r.model.fiber_first[f]];
    struct vec3 u = point_difference(x[1], x[0]);
    assert_close(vec3_norm(u), bond_moment(100, 0.5, 1), 1e-11);
    for (int i = 0; i < 8; i++)
      assert_close(vec3_norm(vec3_sub(point_difference(x[i + 1], x[i]), u)), 0.0, 1e-11);
    if (f == 3) {
      assert_close(vec3_norm(vec3_sub(point_in_a0(x[4]), (struct vec3){3, -4, 25})), 0.0, 1e-11);
      assert_close(vec3_norm(vec3_sub(vec3_scale(3.0 / vec3_norm(u), u), (struct vec3){2, -1, 2})), 0.0, 1e-10);
    }
  }
  test_end(&r);
}

/* Circle: every bond has the mean length, the closing one included; all vertices at one distance from the centre, in
 * the plane across the direction. */
static void circles(void **unused)
{
  (void)unused;
  const struct vec3 directions[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {1, 1, 1}, {-0.7, 0.1, 0.2}, {0.61, -0.3, 0.1}};
  for (int k = 0; k < 6; k++) {
    const struct vec3 center = {7, 3, -20}, n = directions[k];
    struct model m = test_model(20, 20, 20, 0, 0.01, 2);
    struct fiber_kind *kind = test_add_kind(&m, 2, (uint32_t)(3 + 4 * k));
    kind->start = START_CIRCLE;
    kind->ring = true;
    place(kind, center, n);
    struct test_run r = started(m);
    const double radius = bond_moment(100, 0.5, 1) / (2.0 * sin(3.14159265358979323846 / (3 + 4 * k)));
    for (uint32_t v = 0; v < kind->vertices; v++) {
      const struct vec3 at = vec3_sub(point_in_a0(r.state.position[v]), center);
      assert_close(vec3_norm(fiber_bond(&r.state, &r.model, v)), bond_moment(100, 0.5, 1), 1e-11);
      assert_close(vec3_norm(at), radius, 1e-11);
      assert_close(vec3_dot(at, n), 0.0, 1e-11 * (1.0 + vec3_norm(n)));
    }
    test_end(&r);
  }
}

/* Fibers without a place have uniform centres and directions, independent from fiber to fiber. */
static void random_places_of_stated_shapes(void **unused)
{
  (void)unused;
  enum { COUNT = 20000 };
  struct model m = test_model(4, 6, 8, 0, 0.01, 2);
  m.seed = dice_seed(1204);
  test_add_kind(&m, COUNT, 3)->start = START_STRAIGHT;
  struct test_run r = started(m);
  double *u = malloc(COUNT * sizeof *u), *z = malloc(COUNT * sizeof *z);
  struct tally neighbor = {0};
  struct vec3 last = {0, 0, 0};
  for (uint32_t f = 0; f < COUNT; f++) {
    const struct point *x = &r.state.position[3 * f];
    struct vec3 n = point_difference(x[2], x[0]);
    n = vec3_scale(1.0 / vec3_norm(n), n);
    tally_add(&neighbor, vec3_dot(n, last));
    last = n;
    u[f] = 0.5 + 0.5 * n.y;
    z[f] = (double)x[1].z / (double)r.model.box.edge[2];
  }
  assert_true(kolmogorov(u, COUNT) < KOLMOGOROV_LIMIT);
  assert_true(kolmogorov(z, COUNT) < KOLMOGOROV_LIMIT);
  assert_sigma(tally_mean(&neighbor), tally_error(&neighbor), 0.0, 4.5);
  free(u);
  free(z);
  test_end(&r);
}

/* The end-to-end vector is Gaussian for Gaussian springs of any number, and for any springs if they are many. n
 * independent bonds b without preferred direction have <R_x^4>/<R_x^2>^2 - 3 = (<b_x^4>/<b_x^2>^2 - 3)/n, with <b_x^2>
 * = <l^2>/3 and <b_x^4> = <l^4>/5. */
static void end_to_end_vectors_become_gaussian(void **unused)
{
  (void)unused;
  enum { COUNT = 20000 };
  static const struct chain stiff = {100, 0.5, 0}, soft = {3, 0, 0};
  static const struct {
    const struct chain *chain;
    uint32_t bonds;
    bool gaussian; /* within what COUNT of them can tell */
  } rows[] = {{&stiff, 1, false}, {&stiff, 4, true}, {&stiff, 32, true}, {&soft, 1, true}, {&soft, 4, true}};
  double *chance = malloc(COUNT * sizeof *chance);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    const struct chain *c = rows[k].chain;
    const uint32_t n = rows[k].bonds;
    struct test_run r = many_chains(c, COUNT, n + 1, dice_seed(1208) + k);
    const double l2 = bond_moment(c->k, c->l0, 2), l4 = bond_moment(c->k, c->l0, 4), square = n * l2 / 3.0;
    struct tally fourth = {0};
    for (uint32_t f = 0; f < COUNT; f++) {
      struct vec3 end = {0, 0, 0};
      for (uint32_t i = 0; i < n; i++)
        end = vec3_add(end, fiber_bond(&r.state, &r.model, f * (n + 1) + i));
      tally_add(&fourth, end.x * end.x * end.x * end.x / (square * square) - 3.0);
      chance[f] = 0.5 * erfc(-end.x / sqrt(2.0 * square));
    }
    const double away = kolmogorov(chance, COUNT);
    print_message("  %u bonds: fourth moment %.3f +- %.3f, distance from a Gaussian %.2f\n", n, tally_mean(&fourth),
                  tally_error(&fourth), away);
    assert_sigma(tally_mean(&fourth), tally_error(&fourth), (l4 / 5.0 / (l2 * l2 / 9.0) - 3.0) / n, 4.5);
    assert_true((away < KOLMOGOROV_LIMIT) == rows[k].gaussian);
    test_end(&r);
  }
  free(chance);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(mean_bond_lengths),
      cmocka_unit_test(bonds_and_bends_have_their_distributions),
      cmocka_unit_test(chains_have_their_size),
      cmocka_unit_test(end_to_end_vectors_become_gaussian),
      cmocka_unit_test(places_and_velocities),
      cmocka_unit_test(straight_fibers),
      cmocka_unit_test(circles),
      cmocka_unit_test(random_places_of_stated_shapes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
