/* The exchange of momentum of one pair of bonds (THEORY test 3): conservation laws, reversal, involution, Eq. (28). */
#include "contact/impulse.h"
#include "exact.h"

/* Two bonds in contact: R[0], R[1] moving (vertex, pivot), R[2], R[3] standing, touching at (s, s'). */
struct meeting {
  double s, s_standing, mass[4];
  struct vec3 r[4], v[4], n;
};

static struct meeting random_contact(struct dice *d, bool equal_masses)
{
  struct meeting c;
  c.s = dice_uniform(d);
  c.s_standing = dice_uniform(d);
  switch (dice_integer(d, 0, 7)) { /* ends of bonds included */
  case 0:
    c.s = 0.0;
    break;
  case 1:
    c.s = 1.0;
    break;
  case 2:
    c.s_standing = 0.0;
    break;
  case 3:
    c.s_standing = 1.0;
    break;
  default:
    break;
  }
  const struct vec3 p = dice_vector(d, 0.5), q = dice_vector(d, 0.5), at = dice_vector(d, 2.0);
  c.n = vec3_cross(p, q);
  c.n = vec3_scale((dice_u64(d) & 1 ? 1.0 : -1.0) / vec3_norm(c.n), c.n);
  c.r[0] = vec3_add_scaled(at, -c.s, p);
  c.r[1] = vec3_add_scaled(at, 1.0 - c.s, p);
  c.r[2] = vec3_add_scaled(at, -c.s_standing, q);
  c.r[3] = vec3_add_scaled(at, 1.0 - c.s_standing, q);
  for (int k = 0; k < 4; k++) {
    c.mass[k] = equal_masses ? 5.0 : exp(dice_between(d, -3.0, 3.0));
    c.v[k] = dice_vector(d, 1.0);
  }
  return c;
}

static double exchange(struct meeting *c)
{
  const struct impulse_end moving[2] = {{&c->v[0], 1.0 / c->mass[0]}, {&c->v[1], 1.0 / c->mass[1]}};
  const struct impulse_end standing[2] = {{&c->v[2], 1.0 / c->mass[2]}, {&c->v[3], 1.0 / c->mass[3]}};
  return impulse_exchange(moving, standing, c->s, c->s_standing, c->n);
}

/* Velocity of the contact point of the moving bond relative to that of the standing one, along n. */
static double contact_velocity(const struct meeting *c)
{
  struct vec3 moving = vec3_add(vec3_scale(1.0 - c->s, c->v[0]), vec3_scale(c->s, c->v[1]));
  struct vec3 standing = vec3_add(vec3_scale(1.0 - c->s_standing, c->v[2]), vec3_scale(c->s_standing, c->v[3]));
  return vec3_dot(vec3_sub(moving, standing), c->n);
}

static void laws_of_the_exchange(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(801);
  struct dice d = {seed};
  int negative = 0;
  for (int k = 0; k < 20000; k++) {
    const struct meeting before = random_contact(&d, k % 2);
    struct meeting after = before;
    const double dp = exchange(&after);
    struct vec3 momentum = {0, 0, 0}, angular = {0, 0, 0};
    double energy = 0.0, scale = 1.0;
    for (int i = 0; i < 4; i++) {
      struct vec3 change = vec3_scale(before.mass[i], vec3_sub(after.v[i], before.v[i]));
      momentum = vec3_add(momentum, change);
      angular = vec3_add(angular, vec3_cross(before.r[i], change));
      energy += before.mass[i] * (vec3_dot(after.v[i], after.v[i]) - vec3_dot(before.v[i], before.v[i]));
      scale += before.mass[i] * vec3_dot(before.v[i], before.v[i]) * (1.0 + vec3_norm(before.r[i]));
      assert_close(vec3_norm(vec3_cross(change, before.n)), 0.0, 1e-12 * scale); /* all changes lie along n */
    }
    assert_close(vec3_norm(momentum), 0.0, 1e-12 * scale);
    assert_close(energy, 0.0, 1e-12 * scale);
    assert_close(vec3_norm(angular), 0.0, 1e-12 * scale);
    assert_close(contact_velocity(&after), -contact_velocity(&before), 1e-12 * scale);
    assert_true((dp < 0.0) == (contact_velocity(&before) < 0.0)); /* footnote 61: its sign is kept */
    negative += dp < 0.0;

    struct meeting twice = after;
    assert_close(exchange(&twice), -dp, 1e-12 * scale);
    for (int i = 0; i < 4; i++)
      assert_close(vec3_norm(vec3_sub(twice.v[i], before.v[i])), 0.0, 1e-12 * scale / before.mass[i]);

    struct meeting turned = before; /* n may point either way */
    turned.n = vec3_scale(-1.0, before.n);
    assert_close(exchange(&turned), -dp, 1e-12 * scale);
    for (int i = 0; i < 4; i++)
      assert_close(vec3_norm(vec3_sub(turned.v[i], after.v[i])), 0.0, 1e-12 * scale / before.mass[i]);
  }
  assert_true(negative > 9000 && negative < 11000);
}

/* Equal masses: Eq. (28), and Eqs. (22)-(25), as printed. */
static void equal_masses_as_printed(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(802)};
  for (int k = 0; k < 5000; k++) {
    const struct meeting c = random_contact(&d, true);
    struct meeting after = c;
    const double dp = exchange(&after), s = c.s, t = c.s_standing, mass = 5.0;
    struct vec3 sum = vec3_scale(1 - s, c.v[0]);
    sum = vec3_add_scaled(sum, s, c.v[1]);
    sum = vec3_add_scaled(sum, -(1 - t), c.v[2]);
    sum = vec3_add_scaled(sum, -t, c.v[3]);
    const double expected = 2 * mass * vec3_dot(sum, c.n) / ((1 - s) * (1 - s) + s * s + (1 - t) * (1 - t) + t * t);
    assert_close(dp, expected, 1e-12 * (1.0 + fabs(expected)));
    const double share[4] = {-(1 - s), -s, 1 - t, t};
    for (int i = 0; i < 4; i++)
      assert_close(vec3_norm(vec3_sub(after.v[i], vec3_add_scaled(c.v[i], share[i] * expected / mass, c.n))), 0.0,
                   1e-12);
  }
}

/* By hand: two bonds cross at their middles and meet head on: velocities along n change sign. A blow on the very end of
 * a bond is felt by that vertex only, as in a collision of two points. */
static void exchanges_by_hand(void **unused)
{
  (void)unused;
  struct meeting c = {.s = 0.5, .s_standing = 0.5, .mass = {5, 5, 5, 5}, .n = {0, 0, 1}};
  for (int k = 0; k < 4; k++)
    c.v[k] = (struct vec3){0.25, 0, k < 2 ? 1.0 : -1.0};
  assert_close(exchange(&c), 20.0, 1e-15);
  for (int k = 0; k < 4; k++) {
    assert_close(c.v[k].z, k < 2 ? -1.0 : 1.0, 1e-15);
    assert_close(c.v[k].x, 0.25, 0.0);
  }
  struct meeting ends = {.s = 0.0, .s_standing = 1.0, .mass = {1, 7, 9, 3}, .n = {1, 0, 0}};
  ends.v[0].x = 2.0; /* mass 1 at 2 meets mass 3 at rest: -1 and 1 */
  assert_close(exchange(&ends), 3.0, 1e-15);
  assert_close(ends.v[0].x, -1.0, 1e-15);
  assert_close(ends.v[1].x, 0.0, 0.0);
  assert_close(ends.v[2].x, 0.0, 0.0);
  assert_close(ends.v[3].x, 1.0, 1e-15);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(laws_of_the_exchange),
      cmocka_unit_test(equal_masses_as_printed),
      cmocka_unit_test(exchanges_by_hand),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
