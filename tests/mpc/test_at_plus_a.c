/* MPC-AT+a in one cell: momentum, angular momentum about any point, members in special places, virtual members. */
#include "base/normal.h"
#include "exact.h"
#include "mpc/border.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/rule.h"
#include "mpc/rules/spin.h"

enum { MOST = 24 };

struct cell {
  int n;
  double mass[MOST];
  struct point place[MOST]; /* relative to the middle of the cell, lattice units */
  struct vec3 v[MOST], xi[MOST];
};

static struct point anywhere(struct dice *d)
{
  const int64_t half = LATTICE_CELL / 2;
  const int64_t x = dice_integer(d, -half, half - 1), y = dice_integer(d, -half, half - 1);
  return (struct point){x, y, dice_integer(d, -half, half - 1)};
}

static struct cell random_cell(struct dice *d, int n)
{
  struct cell c = {.n = n};
  for (int i = 0; i < n; i++) {
    c.mass[i] = i % 3 ? 1.0 : (double)dice_integer(d, 1 << 14, 20 << 16) * MODEL_MASS_UNIT;
    c.place[i] = anywhere(d);
    c.v[i] = dice_vector(d, 1.0 / sqrt(c.mass[i]));
    c.xi[i] = dice_vector(d, 1.0 / sqrt(c.mass[i]));
  }
  return c;
}

/* The same cell after the collision. */
static struct cell collide_cell(const struct cell *old)
{
  struct cell_sum sum = {0};
  struct cell_spin spin = {0};
  struct cell_turn turn;
  struct point middle = {0, 0, 0};
  memset(&turn, 0xff, sizeof turn);
  for (int i = 0; i < old->n; i++) {
    const struct vec3 u = vec3_sub(old->v[i], old->xi[i]);
    cell_add(&sum, old->mass[i], cell_load(old->mass[i]), u);
    if (old->mass[i] == 1.0 && i % 2)
      spin_add_particle(&spin, old->place[i], spin_momentum(1.0, u));
    else
      spin_add(&spin, old->place[i], old->mass[i], u);
  }
  spin_solve(&sum, &spin, &turn, &middle);
  struct cell new = *old;
  for (int i = 0; i < old->n && turn.active != 0.0; i++)
    new.v[i] = vec3_add(spin_velocity(&turn, middle, old->place[i]), old->xi[i]);
  return new;
}

/* Sums about a point of the cell, in long double. */
static void total(const struct cell *c, struct vec3 about, long double p[3], long double l[3])
{
  for (int k = 0; k < 3; k++)
    p[k] = l[k] = 0.0L;
  for (int i = 0; i < c->n; i++) {
    const struct vec3 at = point_in_a0(c->place[i]);
    const long double x = (long double)at.x - about.x, y = (long double)at.y - about.y, z = (long double)at.z - about.z;
    const long double px = (long double)c->mass[i] * c->v[i].x, py = (long double)c->mass[i] * c->v[i].y,
                      pz = (long double)c->mass[i] * c->v[i].z;
    p[0] += px;
    p[1] += py;
    p[2] += pz;
    l[0] += y * pz - z * py;
    l[1] += z * px - x * pz;
    l[2] += x * py - y * px;
  }
}

/*
 * Both sums are kept to the rounding of N momenta to 2^-44, sqrt(3) N 2^-45 for momentum, and that times the distance
 * from the point for angular momentum; and of doubles, 2^-49 of what is added up.
 */
static void assert_kept(const struct cell *old, const struct cell *new, const char *what)
{
  const struct vec3 points[] = {{0, 0, 0}, {0.5, -0.5, 0.5}, {-3.0, 1.0, 2.0}};
  double sizes = 0.0;
  for (int i = 0; i < old->n; i++)
    sizes += old->mass[i] * (vec3_norm(old->v[i]) + 2.0 * vec3_norm(old->xi[i]) + vec3_norm(new->v[i]));
  for (size_t k = 0; k < sizeof points / sizeof *points; k++) {
    long double p[3], l[3], q[3], m[3];
    total(old, points[k], p, l);
    total(new, points[k], q, m);
    const double bound = 0x1p-44 * old->n + 0x1p-49 * sizes, arm = 1.0 + vec3_norm(points[k]);
    for (int j = 0; j < 3; j++) {
      if (!(fabsl(q[j] - p[j]) <= bound))
        fail_msg("%s, %d members: momentum is off by %.3Lg, allowed %.3g", what, old->n, q[j] - p[j], bound);
      if (!(fabsl(m[j] - l[j]) <= arm * bound))
        fail_msg("%s, %d members: angular momentum is off by %.3Lg, allowed %.3g", what, old->n, m[j] - l[j],
                 arm * bound);
    }
  }
}

static void momenta_are_kept(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2801)};
  for (int k = 0; k < 20000; k++) {
    const struct cell old = random_cell(&d, 2 + k % (MOST - 2)), new = collide_cell(&old);
    assert_kept(&old, &new, "random places");
  }
}

/* Two members at any distance, down to one lattice unit: what they turn with is along no line but theirs. */
static void pairs_keep_momenta(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2802)};
  for (int k = 0; k < 20000; k++) {
    struct cell old = random_cell(&d, 2);
    const int64_t reach = (int64_t)1 << (k % 39);
    old.place[0] = (struct point){reach / 3, -reach / 5, reach / 7};
    old.place[1] = (struct point){dice_integer(&d, -reach, reach), dice_integer(&d, -reach, reach),
                                  dice_integer(&d, -reach, reach)};
    const struct cell new = collide_cell(&old);
    assert_kept(&old, &new, "a pair");
    for (int i = 0; i < 2; i++)
      assert_true(isfinite(vec3_norm(new.v[i])) && vec3_norm(new.v[i]) < 1e3);
  }
}

/* On one line, along an axis or not, and all at one place. */
static void lines_and_points_keep_momenta(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2803)};
  for (int k = 0; k < 20000; k++) {
    struct cell old = random_cell(&d, 2 + k % 5);
    const struct point step[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {3, -5, 2}, {0, 0, 0}, {1, 1, 0}};
    const struct point s = step[k % 6], from = {dice_integer(&d, -1000, 1000), 17, -dice_integer(&d, 0, 1000)};
    for (int i = 0; i < old.n; i++) {
      const int64_t at = dice_integer(&d, -((int64_t)1 << 35), (int64_t)1 << 35);
      old.place[i] = (struct point){from.x + at * s.x, from.y + at * s.y, from.z + at * s.z};
    }
    const struct cell new = collide_cell(&old);
    assert_kept(&old, &new, k % 6 == 4 ? "one place" : "a line");
  }
}

static void one_member_is_left_alone(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2804)};
  const struct cell old = random_cell(&d, 1), new = collide_cell(&old);
  assert_memory_equal(&old.v[0], &new.v[0], sizeof old.v[0]);
}

/* Pi^-1 against the definition: Pi Omega = L, where the members are in no special places. */
static void rate_solves_its_equation(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(2805)};
  for (int k = 0; k < 10000; k++) {
    double c[6] = {0};
    for (int i = 0; i < 5; i++) {
      const struct vec3 y = dice_vector(&d, 0.3);
      const double add[6] = {y.x * y.x, y.y * y.y, y.z * y.z, y.y * y.z, y.z * y.x, y.x * y.y};
      for (int j = 0; j < 6; j++)
        c[j] += add[j];
    }
    const struct vec3 l = dice_vector(&d, 1.0), w = spin_rate(c, l);
    const double trace = c[0] + c[1] + c[2];
    assert_close(trace * w.x - c[0] * w.x - c[5] * w.y - c[4] * w.z, l.x, 1e-13 * (1.0 + trace * vec3_norm(w)));
    assert_close(trace * w.y - c[5] * w.x - c[1] * w.y - c[3] * w.z, l.y, 1e-13 * (1.0 + trace * vec3_norm(w)));
    assert_close(trace * w.z - c[4] * w.x - c[3] * w.y - c[2] * w.z, l.z, 1e-13 * (1.0 + trace * vec3_norm(w)));
  }
}

/* Whole collisions: angular momentum of each cell, with places that are found here by division, vertices far outside
 * the box, in space and in a plane. In half of them a particle is so fast that its momentum is beyond lattice_round. */
static void collisions_keep_angular_momentum(void **unused)
{
  (void)unused;
  for (uint32_t k = 0; k < 20; k++) {
    struct dice d = {dice_seed(2807) + k};
    struct model model = k % 2 ? test_model(4, 5, 3, 2, 0.1, 1) : test_model(10, 6, 1, 2, 0.1, 1);
    model.dimensions = k % 2 ? 3 : 2;
    model.crossing.forbidden = false;
    model.solvent.rule = RULE_AT_PLUS_A;
    model.seed = dice_u64(&d);
    test_add_kind(&model, 40, 1)->mass = 2.7;
    struct test_run r = dice_run(model, &d);
    const uint32_t n = r.state.solvent.n, cells = (uint32_t)box_cell_count(&model.box);
    const struct point shift = grid_shift(&r.model, 3);
    if (k >= 10)
      r.state.solvent.vx[dice_integer(&d, 0, n - 1)] = 300.0;
    struct cell *old = calloc(cells, sizeof *old), *new = calloc(cells, sizeof *new);
    for (int after = 0; after < 2; after++) {
      for (uint32_t i = 0; i < n + r.state.vertices; i++) {
        const struct solvent *s = &r.state.solvent;
        const struct point p = i < n ? (struct point){s->x[i], s->y[i], s->z[i]} : r.state.position[i - n];
        struct cell *c = &(after ? new : old)[cell_by_floor(&model.box, p, shift)];
        assert_true(c->n < MOST);
        c->place[c->n] =
            (struct point){lattice_fold(p.x + shift.x, LATTICE_CELL), lattice_fold(p.y + shift.y, LATTICE_CELL),
                           lattice_fold(p.z + shift.z, LATTICE_CELL)};
        c->mass[c->n] = i < n ? 1.0 : r.model.mass[i - n];
        c->v[c->n] = i < n ? solvent_velocity(s, i) : r.state.velocity[i - n];
        c->xi[c->n++] = (struct vec3){5, 5, 5}; /* they are not known here: a size that they do not reach */
      }
      if (!after)
        assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 3, &r.work.fault));
    }
    for (uint32_t j = 0; j < cells; j++)
      assert_kept(&old[j], &new[j], "a cell of a box");
    free(old);
    free(new);
    test_end(&r);
  }
}

/* A virtual particle drawn here from its address, as docs/conventions.md says. */
static void draw(const struct test_run *r, uint64_t step, uint32_t cell, uint32_t k, const struct virtual_members *m,
                 struct point *place, struct vec3 *change)
{
  const struct random_words xz = random_at(r->model.seed, 14, 2 * k, step, cell);
  const struct random_words y = random_at(r->model.seed, 14, 2 * k + 1, step, cell);
  const double height = m->low + (m->high - m->low) * random_uniform(y, 0);
  double xi[3];
  random_normal_three(random_at(r->model.seed, 13, k, step, cell), xi);
  *place = (struct point){(int64_t)(random_uniform(xz, 0) * 0x1p40) - LATTICE_CELL / 2,
                          (int64_t)(height * 0x1p40) - LATTICE_CELL / 2,
                          (int64_t)(random_uniform(xz, 1) * 0x1p40) - LATTICE_CELL / 2};
  *change = vec3_add_scaled(m->flow, sqrt(2.0), (struct vec3){xi[0], xi[1], xi[2]});
}

/* With virtual members in a cell: momentum is kept with that which they gain, and so is angular momentum with their
 * places; a lone real member collides with them. The places are within their part of the cell. */
static void virtual_members_take_part(void **unused)
{
  (void)unused;
  struct model model = test_model(3, 3, 3, 2, 0.1, 1);
  model.solvent.rule = RULE_AT_PLUS_A;
  model.seed = dice_seed(2806);
  struct test_run r = test_start(model);
  struct mpc *c = &r.work.mpc;
  const struct virtual_members virtual = {
      .n = 3.0, .velocity = {0.3, 0, 0}, .flow = {0.3, -0.1, 0.2}, .low = 0.25, .high = 0.75};
  uint32_t lone = 0, changed = 0;
  for (uint64_t step = 0; step < 40; step++) {
    struct solvent *s = &r.state.solvent;
    const uint32_t n = s->n, cell = (uint32_t)(step % 27);
    struct cell old = {0}, new;
    uint32_t who[MOST];
    grid_bin(&r.state, &r.model, grid_shift(&r.model, step), c);
    for (uint32_t i = 0; i < n; i++)
      if (c->solvent_cell[i] == cell) {
        who[old.n] = i;
        old.mass[old.n] = 1.0;
        old.place[old.n] = spin_place((struct point){s->x[i], s->y[i], s->z[i]}, c->shift);
        old.v[old.n++] = solvent_velocity(s, i);
      }
    assert_true(collide_sum(&r.state, &r.model, c, step, &r.work.fault));
    c->rule->add_virtual(&r.model, c, step, cell, &virtual);
    collide_solve(&r.model, c, step);
    collide_turn(&r.state, &r.model, c, false);
    const struct vec3 gain = c->rule->virtual_gain(&r.model, c, step, cell, &virtual, false);
    new = old;
    for (int i = 0; i < old.n; i++)
      new.v[i] = solvent_velocity(s, who[i]);
    lone += old.n == 1;
    changed += old.n == 1 && vec3_norm(vec3_sub(old.v[0], new.v[0])) > 1e-6;
    struct vec3 gained = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++) {
      struct vec3 change;
      draw(&r, step, cell, k, &virtual, &old.place[old.n], &change);
      assert_true(fabs((double)old.place[old.n].y) <= 0x1p38);
      old.mass[old.n] = 1.0;
      old.v[old.n] = change;
      old.xi[old.n] = (struct vec3){0, 0, 0};
      new.mass[old.n] = 1.0;
      new.place[old.n] = old.place[old.n];
      new.v[old.n] = spin_velocity(&c->turn[cell], c->middle[cell], old.place[old.n]);
      gained = vec3_add(gained, vec3_sub(new.v[old.n], change));
      old.n++;
      new.n = old.n;
    }
    assert_close(vec3_norm(vec3_sub(gain, gained)), 0.0, 1e-13);
    assert_kept(&old, &new, "with virtual members");
  }
  assert_true(lone > 3 && changed == lone);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(momenta_are_kept),
      cmocka_unit_test(pairs_keep_momenta),
      cmocka_unit_test(lines_and_points_keep_momenta),
      cmocka_unit_test(one_member_is_left_alone),
      cmocka_unit_test(rate_solves_its_equation),
      cmocka_unit_test(collisions_keep_angular_momentum),
      cmocka_unit_test(virtual_members_take_part),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
