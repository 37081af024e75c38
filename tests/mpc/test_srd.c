/* The collision rule in one cell, members in a row: conservation, rotation, order of members, range. */
#include "exact.h"
#include "mpc/rules/srd.h"

enum { MOST = 40 };

/* A cell's members as a plain driver has them. */
struct cell {
  int n;
  double mass[MOST];
  struct vec3 v[MOST];
};

static struct cell random_cell(struct dice *d)
{
  struct cell c = {.n = (int)dice_integer(d, 2, MOST)};
  for (int i = 0; i < c.n; i++) {
    c.mass[i] = i % 3 ? 1.0 : (double)dice_integer(d, 1, 20 << 16) * MODEL_MASS_UNIT;
    c.v[i] = dice_vector(d, 1.0 / sqrt(c.mass[i]));
  }
  return c;
}

static struct cell_sum add_all(const struct cell *c, const uint32_t *order)
{
  struct cell_sum sum = {0};
  for (int k = 0; k < c->n; k++) {
    int i = order ? (int)order[k] : k;
    cell_add(&sum, c->mass[i], cell_load(c->mass[i]), c->v[i]);
  }
  return sum;
}

static void collide_cell(struct cell *c, struct vec3 axis, double degrees)
{
  struct cell_sum sum = add_all(c, NULL);
  struct cell_turn turn;
  memset(&turn, 0xff, sizeof turn);
  cell_solve(&sum, &turn);
  turn.axis = axis;
  const double angle = degrees * 3.14159265358979323846 / 180.0;
  for (int i = 0; i < c->n; i++)
    c->v[i] = srd_apply(&turn, c->v[i], degrees == 90.0, cos(angle), sin(angle), true);
}

static struct vec3 momentum(const struct cell *c)
{
  struct vec3 p = {0, 0, 0};
  for (int i = 0; i < c->n; i++)
    p = vec3_add_scaled(p, c->mass[i], c->v[i]);
  return p;
}

static double twice_energy(const struct cell *c)
{
  double e = 0.0;
  for (int i = 0; i < c->n; i++)
    e += c->mass[i] * vec3_dot(c->v[i], c->v[i]);
  return e;
}

static double total_mass(const struct cell *c)
{
  double m = 0.0;
  for (int i = 0; i < c->n; i++)
    m += c->mass[i];
  return m;
}

/* Momentum and kinetic energy of the cell, masses from 2^-16 to 20, a flow on top: to 1e-12 (THEORY test 11). */
static void cell_keeps_momentum_and_energy(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(201);
  struct dice d = {seed};
  const double angles[] = {90.0, 130.0, 10.0, 180.0, 60.0, 97.3};
  for (int k = 0; k < 6000; k++) {
    struct cell c = random_cell(&d);
    struct vec3 flow = dice_vector(&d, 0.5);
    for (int i = 0; i < c.n; i++)
      c.v[i] = vec3_add(c.v[i], flow);
    const struct vec3 before = momentum(&c);
    const double energy = twice_energy(&c), scale = total_mass(&c) + energy;
    collide_cell(&c, dice_direction(&d), angles[k % 6]);
    const struct vec3 after = momentum(&c);
    if (!(vec3_norm(vec3_sub(after, before)) <= 1e-12 * fmax(1.0, sqrt(scale))))
      fail_msg("seed %lu case %d: momentum changes by %g", (unsigned long)seed, k, vec3_norm(vec3_sub(after, before)));
    if (!(fabs(twice_energy(&c) - energy) <= 1e-12 * scale))
      fail_msg("seed %lu case %d: energy changes by %g of %g", (unsigned long)seed, k, twice_energy(&c) - energy,
               energy);
  }
}

/* The sums are the exact sums of the rounded momenta 2^44 m v (GMP), mass and number exactly, in any order. */
static void sums_are_exact_in_any_order(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(202)};
  mpq_t term, scale;
  mpq_inits(term, scale, NULL);
  for (int k = 0; k < 500; k++) {
    struct cell c = random_cell(&d);
    uint32_t order[MOST];
    for (int i = 0; i < c.n; i++)
      order[i] = (uint32_t)i;
    struct cell_sum plain = add_all(&c, NULL);
    dice_shuffle(&d, order, (uint32_t)c.n);
    struct cell_sum shuffled = add_all(&c, order);
    assert_memory_equal(&plain, &shuffled, sizeof plain);

    double exact[3] = {0, 0, 0}, mass = 0.0;
    for (int i = 0; i < c.n; i++) {
      const double v[3] = {c.v[i].x, c.v[i].y, c.v[i].z};
      mass += c.mass[i]; /* exact: few multiples of 2^-16 */
      for (int a = 0; a < 3; a++) {
        mpq_set_d(term, c.mass[i]);
        mpq_set_d(scale, v[a]);
        mpq_mul(term, term, scale);
        mpq_mul_2exp(term, term, 44);
        exact[a] += mpq_get_d(term);
      }
    }
    assert_close((double)plain.px, exact[0], 0.51 * c.n); /* half a unit each, and the doubles' own rounding */
    assert_close((double)plain.py, exact[1], 0.51 * c.n);
    assert_close((double)plain.pz, exact[2], 0.51 * c.n);
    assert_int_equal(cell_members(&plain), c.n);
    assert_close(cell_mass(&plain), mass, 0.0);
    struct vec3 center = cell_center(&plain);
    assert_close(center.x, exact[0] * 0x1p-44 / mass, c.n * 0x1p-44 / mass + 1e-15);
    assert_close(center.y, exact[1] * 0x1p-44 / mass, c.n * 0x1p-44 / mass + 1e-15);
    assert_close(center.z, exact[2] * 0x1p-44 / mass, c.n * 0x1p-44 / mass + 1e-15);
  }
  mpq_clears(term, scale, NULL);
}

/* w turned about n by an angle, through quaternions: q w q*. */
static struct vec3 by_quaternion(struct vec3 w, struct vec3 n, long double angle)
{
  const long double c = cosl(angle / 2), s = sinl(angle / 2), x = s * n.x, y = s * n.y, z = s * n.z;
  const long double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - c * z), 2 * (x * z + c * y)},
                               {2 * (x * y + c * z), 1 - 2 * (x * x + z * z), 2 * (y * z - c * x)},
                               {2 * (x * z - c * y), 2 * (y * z + c * x), 1 - 2 * (x * x + y * y)}};
  return (struct vec3){(double)(m[0][0] * w.x + m[0][1] * w.y + m[0][2] * w.z),
                       (double)(m[1][0] * w.x + m[1][1] * w.y + m[1][2] * w.z),
                       (double)(m[2][0] * w.x + m[2][1] * w.y + m[2][2] * w.z)};
}

static void assert_same(struct vec3 a, struct vec3 b, double tolerance)
{
  assert_close(a.x, b.x, tolerance);
  assert_close(a.y, b.y, tolerance);
  assert_close(a.z, b.z, tolerance);
}

static void rotation_is_a_rotation(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(203)};
  /* right-handed: a quarter turn about z takes x to y */
  assert_same(srd_quarter_turn((struct vec3){1, 0, 0}, (struct vec3){0, 0, 1}), (struct vec3){0, 1, 0}, 0.0);
  assert_same(srd_turn((struct vec3){0, 1, 0}, (struct vec3){1, 0, 0}, 0.0, 1.0), (struct vec3){0, 0, 1}, 0.0);
  for (int k = 0; k < 20000; k++) {
    const struct vec3 n = dice_direction(&d), w = dice_vector(&d, 1.0);
    const double angle = dice_between(&d, 0.0, 6.2831853), c = cos(angle), s = sin(angle);
    assert_same(srd_turn(w, n, c, s), by_quaternion(w, n, (long double)angle), 4e-15);
    assert_same(srd_turn(w, n, 0.0, 1.0), srd_quarter_turn(w, n), 4e-15);

    const struct vec3 x = srd_turn((struct vec3){1, 0, 0}, n, c, s), y = srd_turn((struct vec3){0, 1, 0}, n, c, s),
                      z = srd_turn((struct vec3){0, 0, 1}, n, c, s);
    assert_close(vec3_dot(x, x), 1.0, 4e-15);
    assert_close(vec3_dot(y, y), 1.0, 4e-15);
    assert_close(vec3_dot(x, y), 0.0, 4e-15);
    assert_same(vec3_cross(x, y), z, 4e-15); /* determinant +1 */
    assert_close(x.x + y.y + z.z, 1.0 + 2.0 * c, 4e-15);
    assert_same(srd_turn(n, n, c, s), n, 4e-15);
  }
}

/* Averaged over uniform axes, <R> = (1 + 2 cos a)/3 times the unit matrix: THEORY 1.2, after Eq. (6). */
static void mean_rotation(void **unused)
{
  (void)unused;
  const double degrees[] = {90.0, 130.0};
  for (int k = 0; k < 2; k++) {
    const double angle = degrees[k] * 3.14159265358979323846 / 180.0, c = k ? cos(angle) : 0.0,
                 s = k ? sin(angle) : 1.0;
    struct tally m[3][3];
    memset(m, 0, sizeof m);
    for (uint32_t i = 0; i < 100000; i++) {
      const struct vec3 n = random_axis(dice_seed(1), RANDOM_ROTATION_AXIS, 3, i);
      for (int column = 0; column < 3; column++) {
        struct vec3 w = {column == 0, column == 1, column == 2};
        struct vec3 r = k ? srd_turn(w, n, c, s) : srd_quarter_turn(w, n);
        tally_add(&m[0][column], r.x);
        tally_add(&m[1][column], r.y);
        tally_add(&m[2][column], r.z);
      }
    }
    for (int row = 0; row < 3; row++)
      for (int column = 0; column < 3; column++)
        assert_sigma(tally_mean(&m[row][column]), tally_error(&m[row][column]),
                     row == column ? (1.0 + 2.0 * cos(angle)) / 3.0 : 0.0, 5.0);
  }
}

/* A collision is the rotation of each velocity about the mass-weighted centre, and the factor scales the rest. */
static void apply_turns_about_the_center(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(204)};
  for (int k = 0; k < 2000; k++) {
    const struct vec3 n = dice_direction(&d), v = dice_vector(&d, 1.0), center = dice_vector(&d, 1.0);
    const double angle = dice_between(&d, 0.0, 3.2), factor = dice_between(&d, 0.5, 2.0);
    const struct cell_turn turn = {.center = center, .active = 1.0, .axis = n, .factor = factor};
    struct vec3 w = by_quaternion(vec3_sub(v, center), n, (long double)angle);
    assert_same(srd_apply(&turn, v, false, cos(angle), sin(angle), true), vec3_add_scaled(center, factor, w), 2e-14);
    w = by_quaternion(vec3_sub(v, center), n, 1.57079632679489661923L);
    assert_same(srd_apply(&turn, v, true, 0.0, 1.0, true), vec3_add_scaled(center, factor, w), 2e-14);
  }
}

static void lone_members_are_left_alone(void **unused)
{
  (void)unused;
  struct cell_turn turn = {.active = 1.0};
  struct cell_sum sum = {0};
  cell_solve(&sum, &turn);
  assert_true(turn.active == 0.0);
  cell_add(&sum, 5.0, cell_load(5.0), (struct vec3){1, 2, 3});
  cell_solve(&sum, &turn);
  assert_true(turn.active == 0.0);
  cell_add(&sum, 1.0, cell_load(1.0), (struct vec3){1, 2, 3});
  cell_solve(&sum, &turn);
  assert_true(turn.active == 1.0 && turn.factor == 1.0);
}

/* The span that cell_add returns bounds |m v| 2^44 of each component, and shows numbers that do not fit. */
static void span_shows_the_largest_momentum(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(205)};
  for (int k = 0; k < 20000; k++) {
    struct cell_sum sum = {0};
    double size = exp2(dice_between(&d, -44.0, 18.0)), v[3] = {0, 0, 0};
    v[k % 3] = k % 2 ? size : -size;
    uint64_t span = cell_add(&sum, 1.0, cell_load(1.0), (struct vec3){v[0], v[1], v[2]});
    uint64_t units = (uint64_t)llrint(size * 0x1p44);
    assert_true(2 * span + 1 >= units && span <= units); /* same highest bit, or one unit less */
  }
  const double bad[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 0x1p19};
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    struct cell_sum sum = {0};
    uint64_t span = cell_add(&sum, 1.0, cell_load(1.0), (struct vec3){0, bad[k], 0});
    assert_true((double)span >= 0x1p62);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cell_keeps_momentum_and_energy),  cmocka_unit_test(sums_are_exact_in_any_order),
      cmocka_unit_test(rotation_is_a_rotation),          cmocka_unit_test(mean_rotation),
      cmocka_unit_test(apply_turns_about_the_center),    cmocka_unit_test(lone_members_are_left_alone),
      cmocka_unit_test(span_shows_the_largest_momentum),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
