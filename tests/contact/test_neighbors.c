/* Lists of partner bonds against brute force over all bonds and all images, after builds and thousands of redraws. */
#include <unistd.h>

#include "contact/capsule.h"
#include "contact/neighbors.h"
#include "contact/pairs.h"
#include "exact.h"

/* The images k for which [low2, high2] + k edge meets [low, high]: by floor divisions. */
static void image_range(int64_t low, int64_t high, int64_t low2, int64_t high2, int64_t edge, int64_t range[2])
{
  range[0] = -floor_divide(high2 - low, edge);
  range[1] = floor_divide(high - low2, edge);
}

static bool joined(const struct model *m, uint32_t a, uint32_t b)
{
  const uint32_t ends[2][2] = {{a, (uint32_t)m->next[a]}, {b, (uint32_t)m->next[b]}};
  return ends[0][0] == ends[1][0] || ends[0][0] == ends[1][1] || ends[0][1] == ends[1][0] || ends[0][1] == ends[1][1];
}

/* How many times the list has this pair, up to date, from either side. */
static uint32_t times_listed(const struct neighbors *nb, uint32_t bond, uint32_t other, int64_t i, int64_t j, int64_t k)
{
  uint32_t times = 0;
  for (uint32_t n = 0; n < nb->pairs.count; n++) {
    const uint32_t a = nb->pairs.bond[n], b = nb->pairs.other[n];
    if (!(a == bond && b == other) && !(a == other && b == bond))
      continue;
    const int64_t sign = a == bond ? 1 : -1;
    const int32_t *image = nb->pairs.detail[n].image.k;
    const bool same = sign * image[0] == i && sign * image[1] == j && sign * image[2] == k;
    times += same && !pairs_out_of_date(nb, n);
  }
  return times;
}

static struct vec3 apart_by(struct vec3 a, struct vec3 b, double s, struct vec3 c, struct vec3 d, double t)
{
  return vec3_sub(vec3_add_scaled(vec3_scale(1.0 - s, a), s, b), vec3_add_scaled(vec3_scale(1.0 - t, c), t, d));
}

/* The distance of a point p from the line between a and b. */
static double point_distance(struct vec3 p, struct vec3 a, struct vec3 b)
{
  const struct vec3 ab = vec3_sub(b, a);
  const double s = fmin(fmax(vec3_dot(vec3_sub(p, a), ab) / vec3_dot(ab, ab), 0.0), 1.0);
  return vec3_norm(vec3_sub(p, vec3_add_scaled(a, s, ab)));
}

/* The distance of two bonds: between ends and lines, and, where the closest points of the two infinite lines lie inside
 * both bonds (found by Cramer's rule from d/ds = d/dt = 0), between these. */
static double bond_distance(struct vec3 a, struct vec3 b, struct vec3 c, struct vec3 d)
{
  double least = fmin(fmin(point_distance(a, c, d), point_distance(b, c, d)),
                      fmin(point_distance(c, a, b), point_distance(d, a, b)));
  const struct vec3 u = vec3_sub(b, a), v = vec3_sub(d, c), w = vec3_sub(a, c);
  const double uu = vec3_dot(u, u), uv = vec3_dot(u, v), vv = vec3_dot(v, v), det = uu * vv - uv * uv;
  if (det > 1e-9 * uu * vv) {
    const double s = (uv * vec3_dot(v, w) - vv * vec3_dot(u, w)) / det;
    const double t = (uu * vec3_dot(v, w) - uv * vec3_dot(u, w)) / det;
    if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)
      least = fmin(least, vec3_norm(apart_by(a, b, s, c, d, t)));
  }
  return least;
}

struct totals {
  uint64_t partners, close; /* listed; and so close that they have to be */
};

/* All images of bond b that may come near bond a. */
static void check_pair(const struct test_run *r, uint32_t a, uint32_t b, uint64_t seed, struct totals *sum)
{
  const struct neighbors *nb = &r->work.contact.neighbors;
  const struct reference_position *p[2] = {&nb->reference[a], &nb->reference[r->model.next[a]]};
  const struct reference_position *q[2] = {&nb->reference[b], &nb->reference[r->model.next[b]]};
  const double skin = fmax(p[0]->skin, p[1]->skin) + fmax(q[0]->skin, q[1]->skin);
  const int64_t *edge = r->model.box.edge;
  int64_t range[3][2];
  for (int k = 0; k < 3; k++) {
    const int64_t *u = &p[0]->at.x, *v = &p[1]->at.x, *x = &q[0]->at.x, *y = &q[1]->at.x, wide = lattice_from_a0(skin);
    image_range((u[k] < v[k] ? u[k] : v[k]) - wide, (u[k] > v[k] ? u[k] : v[k]) + wide, x[k] < y[k] ? x[k] : y[k],
                x[k] > y[k] ? x[k] : y[k], edge[k], range[k]);
  }
  const struct point o = p[0]->at;
  for (int64_t i = range[0][0]; i <= range[0][1]; i++)
    for (int64_t j = range[1][0]; j <= range[1][1]; j++)
      for (int64_t k = range[2][0]; k <= range[2][1]; k++) {
        const struct point back = {o.x - i * edge[0], o.y - j * edge[1], o.z - k * edge[2]};
        const double distance = bond_distance((struct vec3){0, 0, 0}, point_difference(p[1]->at, o),
                                              point_difference(q[0]->at, back), point_difference(q[1]->at, back));
        const uint32_t times = times_listed(nb, a, b, i, j, k);
        assert_true(times <= 1); /* twice would count a hit twice */
        sum->partners += times;
        sum->close += distance <= skin;
        if (distance <= skin && times == 0)
          fail_msg("seed %lu: bond %u misses bond %u in image %ld %ld %ld", (unsigned long)seed, a, b, (long)i, (long)j,
                   (long)k);
      }
}

/* The list holds all pairs of bonds and images that are within reach of each other, each once, and none beyond the
 * boxes around both; no vertex has left its anchor. */
static struct totals check_lists(const struct test_run *r, uint64_t seed)
{
  const struct neighbors *nb = &r->work.contact.neighbors;
  struct totals sum = {0, 0};
  uint64_t listed_in_all = 0;
  for (uint32_t a = 0; a < r->model.vertices; a++) {
    const double from_anchor = vec3_norm(point_difference(r->state.position[a], nb->reference[a].at));
    assert_true(from_anchor <= nb->reference[a].skin + 1e-9);
    for (uint32_t b = a + 1; b < r->model.vertices && r->model.next[a] >= 0; b++)
      if (r->model.next[b] >= 0 && !joined(&r->model, a, b))
        check_pair(r, a, b, seed, &sum);
  }
  for (uint32_t n = 0; n < nb->pairs.count; n++)
    listed_in_all += !pairs_out_of_date(nb, n);
  assert_true(listed_in_all == sum.partners); /* nothing else is in the list */
  return sum;
}

/* Where a fiber of these numbers is: in the box, or further away than a byte can count boxes. */
static struct point taken_far(const struct model *m, uint32_t fiber, struct point p)
{
  const int32_t far[3][3] = {{0, 0, 0}, {150, -170, 300}, {-129, 128, 1}};
  return point_image(p, far[fiber % 3], &m->box);
}

/* Bonds of all lengths up to half the shortest edge, rings and open fibers, in images far away. */
static struct test_run random_bonds(int lx, int ly, int lz, uint32_t count, struct dice *d)
{
  struct model m = test_model(lx, ly, lz, 0, 0.01, 2);
  test_add_kind(&m, count, 2);
  test_add_kind(&m, count / 2, 3);
  test_add_kind(&m, count / 2, 3)->ring = true;
  test_add_kind(&m, count / 2, 5);
  for (uint32_t k = 0; k < m.kinds; k++) /* of bonds that a small box allows; here they are laid by hand */
    m.kind[k].bond_length = fmin(0.5, 0.25 * box_shortest_edge(&m.box));
  struct test_run r = dice_run(m, d);
  const double half = 0.5 * box_shortest_edge(&r.model.box), longest = fmin(half, 1.6);
  for (uint32_t v = 0; v < r.state.vertices; v++) {
    const uint32_t first = r.model.fiber_first[r.model.fiber_of[v]];
    if (v == first) {
      r.state.position[v] = taken_far(&r.model, r.model.fiber_of[v], r.state.position[v]);
      continue;
    }
    const bool ring = r.model.kind[r.model.fiber_kind_of[r.model.fiber_of[v]]].ring;
    double length = dice_between(d, 0.0, ring ? 0.5 : 0.999) * longest;
    r.state.position[v] =
        point_move(r.state.position[v - (ring ? v - first : 1)], vec3_scale(length, dice_direction(d)));
  }
  return r;
}

static bool renew(struct test_run *r, uint32_t vertex, struct point to)
{
  return neighbors_renew(&r->state, &r->model, &r->work.contact, 1, &vertex, &r->state.position[vertex], &to,
                         &r->work.fault);
}

/* Moves a random vertex by up to `size`, as a sweep does: a new anchor if need be, then go (or, every third time,
 * stay). Moves that would make a bond longer than half the box are left out. */
static void random_move(struct test_run *r, struct dice *d, double size)
{
  const uint32_t v = (uint32_t)dice_integer(d, 0, r->state.vertices - 1);
  const struct point to = point_move(r->state.position[v], dice_rod(d, 0.0, size));
  const int32_t pivot[2] = {r->model.prev[v], r->model.next[v]};
  const double half = 0.5 * box_shortest_edge(&r->model.box);
  for (int k = 0; k < 2; k++)
    if (pivot[k] >= 0 && vec3_norm(point_difference(to, r->state.position[pivot[k]])) >= half)
      return;
  if (!neighbors_hold(&r->work.contact.neighbors, v, to))
    assert_true(renew(r, v, to));
  assert_true(neighbors_hold(&r->work.contact.neighbors, v, to));
  if (dice_integer(d, 0, 2))
    r->state.position[v] = to;
}

struct place {
  int lx, ly, lz;
  uint32_t count;
};

static const struct place places[] = {{1, 1, 1, 8},  {1, 2, 3, 10}, {2, 2, 2, 16},  {3, 2, 5, 24},
                                      {4, 4, 4, 40}, {5, 3, 4, 40}, {12, 7, 9, 90}, {20, 20, 1, 40}};

static void lists_are_complete_after_a_build(void **unused)
{
  (void)unused;
  uint64_t partners = 0, close = 0;
  for (size_t p = 0; p < sizeof places / sizeof *places; p++)
    for (uint64_t again = 0; again < 4; again++) {
      const uint64_t seed = dice_seed(1001) + 10 * p + again;
      struct dice d = {seed};
      struct test_run r = random_bonds(places[p].lx, places[p].ly, places[p].lz, places[p].count, &d);
      assert_true(neighbors_build(&r.state, &r.model, &r.work.contact, &r.work.fault));
      const struct totals sum = check_lists(&r, seed);
      assert_true(sum.close > 0);
      partners += sum.partners;
      close += sum.close;
      for (uint32_t v = 0; v < r.state.vertices; v++) /* all images move: a rebuild finds as many partners */
        r.state.position[v].x += 7 * r.model.box.edge[0], r.state.position[v].z -= 1000 * r.model.box.edge[2];
      assert_true(neighbors_build(&r.state, &r.model, &r.work.contact, &r.work.fault));
      assert_true(check_lists(&r, seed).partners == sum.partners);
      test_end(&r);
    }
  print_message("  %lu pairs, %lu of them within reach\n", (unsigned long)partners, (unsigned long)close);
  assert_true(partners == close);
}

/* Short moves, as in a run, and long ones; lists grow on the way. */
static void lists_stay_complete_under_moves(void **unused)
{
  (void)unused;
  uint64_t renewed = 0;
  for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
    const uint64_t seed = dice_seed(1002) + p;
    struct dice d = {seed};
    struct test_run r = random_bonds(places[p].lx, places[p].ly, places[p].lz, places[p].count, &d);
    assert_true(neighbors_build(&r.state, &r.model, &r.work.contact, &r.work.fault));
    for (int k = 0; k < 6000; k++) {
      random_move(&r, &d, k % 100 ? NEIGHBORS_SKIN : 0.45 * box_shortest_edge(&r.model.box));
      if (k % 250 == 249)
        check_lists(&r, seed);
    }
    renewed += r.work.contact.neighbors.renewed;
    test_end(&r);
  }
  print_message("  %lu reference positions taken\n", (unsigned long)renewed);
  assert_true(renewed > 5000);
}

/* A vertex within the margin of its anchor is held; one lattice unit beyond, it is not. A new anchor reaches to where
 * the vertex goes and to where it was. */
static void anchors_hold_within_the_margin(void **unused)
{
  (void)unused;
  struct dice d = {3};
  struct test_run r = random_bonds(6, 6, 6, 10, &d);
  struct neighbors *nb = &r.work.contact.neighbors;
  assert_true(neighbors_build(&r.state, &r.model, &r.work.contact, &r.work.fault));
  const struct point a = r.state.position[1];
  const int64_t margin = lattice_from_a0(NEIGHBORS_SKIN);
  const struct point within = {a.x + margin - 1, a.y, a.z}, beyond = {a.x, a.y, a.z - margin - 1};
  assert_true(neighbors_hold(nb, 1, within) && !neighbors_hold(nb, 1, beyond));
  assert_true(renew(&r, 1, beyond));
  /* a move of just more than the margin: from its middle, both ends are within the margin */
  assert_true(neighbors_hold(nb, 1, beyond) && neighbors_hold(nb, 1, a));
  assert_true(nb->renewed == 1 && llabs(nb->reference[1].at.z - (a.z - margin / 2)) <= 1);
  assert_close(nb->reference[1].skin, NEIGHBORS_SKIN, 1e-11);
  const struct point far = {a.x, a.y + lattice_from_a0(2.0), a.z}, further = {a.x, a.y + lattice_from_a0(2.001), a.z};
  assert_true(renew(&r, 1, far));
  assert_close(nb->reference[1].skin, 1.0, 1e-11);
  assert_true(neighbors_hold(nb, 1, far) && neighbors_hold(nb, 1, a) && !neighbors_hold(nb, 1, further));
  /* a short one: the anchor stands where a vertex goes that is at rest */
  r.state.velocity[0] = r.state.velocity[1] = (struct vec3){0, 0, 0};
  const struct point near = {a.x + margin / 2, a.y, a.z};
  assert_true(renew(&r, 1, near));
  assert_true(nb->reference[1].at.x == near.x && nb->reference[1].at.y == near.y && neighbors_hold(nb, 1, a));
  assert_close(nb->reference[1].skin, NEIGHBORS_SKIN, 1e-11);
  check_lists(&r, 3);
  test_end(&r);
}

/* Without a solvent the anchor of a short move stands ahead, by 0.3 t0 times the mean velocity of five vertices; beyond
 * an end, the end counts again. Both ends of the move stay within the margin: the lead is at most 0.7 of what the move
 * leaves of it. With a solvent, particles or not, there is no lead. */
static void anchors_lead_without_a_solvent(void **unused)
{
  (void)unused;
  struct dice d = {7};
  struct test_run r = random_bonds(6, 6, 6, 10, &d);
  struct neighbors *nb = &r.work.contact.neighbors;
  assert_true(neighbors_build(&r.state, &r.model, &r.work.contact, &r.work.fault));
  const struct point a = r.state.position[1], near = {a.x + lattice_from_a0(0.05), a.y, a.z};
  r.state.velocity[0] = (struct vec3){0, 0, -0.1}; /* the dumbbell's other end: twice; vertex 1 itself: three times */
  r.state.velocity[1] = (struct vec3){0, 0.2, 0};
  assert_true(renew(&r, 1, near));
  struct vec3 lead = point_difference(nb->reference[1].at, near);
  assert_close(lead.x, 0.0, 1e-11);
  assert_close(lead.y, 0.036, 1e-11);
  assert_close(lead.z, -0.012, 1e-11);
  r.state.velocity[0] = r.state.velocity[1] = (struct vec3){300.0, 0, -400.0};
  assert_true(renew(&r, 1, near));
  lead = point_difference(nb->reference[1].at, near);
  assert_close(lead.x, 0.6 * 0.7 * (NEIGHBORS_SKIN - 0.05), 1e-11);
  assert_close(lead.z, -0.8 * 0.7 * (NEIGHBORS_SKIN - 0.05), 1e-11);
  assert_true(neighbors_hold(nb, 1, a) && neighbors_hold(nb, 1, near));
  const uint32_t middle = r.state.vertices - 3; /* of the last fiber, of five */
  for (uint32_t k = 0; k < 5; k++)
    r.state.velocity[middle - 2 + k] = (struct vec3){0, 0.01 * (1u << k), 0}; /* mean 0.062 */
  const struct point here = r.state.position[middle];
  assert_true(renew(&r, middle, here));
  assert_close(point_difference(nb->reference[middle].at, here).y, 0.0186, 1e-11);
  r.model.solvent.per_cell = 5.0;
  assert_true(renew(&r, 1, near));
  assert_true(nb->reference[1].at.x == near.x && nb->reference[1].at.y == near.y && nb->reference[1].at.z == near.z);
  check_lists(&r, 7);
  test_end(&r);
}

/* The distance of two bonds, by halving brackets: from a point of p to q it is a convex function of the place on p. */
static long double distance_by_search(struct vec3 p, struct vec3 q, struct vec3 w)
{
  const long double P[3] = {p.x, p.y, p.z}, Q[3] = {q.x, q.y, q.z}, W[3] = {w.x, w.y, w.z};
  long double qq = 0, low = 0, high = 1, least = INFINITY;
  for (int k = 0; k < 3; k++)
    qq += Q[k] * Q[k];
  for (int step = 0; step < 400; step++) {
    long double at[2] = {low + (high - low) / 3, high - (high - low) / 3}, square[2];
    for (int side = 0; side < 2; side++) {
      long double along = 0;
      for (int k = 0; k < 3; k++)
        along += Q[k] * (at[side] * P[k] - W[k]);
      const long double t = qq > 0 ? fminl(fmaxl(along / qq, 0), 1) : 0;
      square[side] = 0;
      for (int k = 0; k < 3; k++)
        square[side] += powl(W[k] + t * Q[k] - at[side] * P[k], 2);
      least = fminl(least, sqrtl(square[side]));
    }
    if (square[0] < square[1])
      high = at[1];
    else
      low = at[0];
  }
  return least;
}

/* Bonds of all angles down to parallel ones, of all lengths down to none, that touch or not. */
/* Planted: a bond of 3.6 million a0 along each axis touches 10^19 search cells. alarm ends a test that spins. */
static void endless_bonds_are_a_fault(void **unused)
{
  (void)unused;
  struct model model = test_model(6, 5, 7, 0.0, 0.01, 2);
  model.solvent.collision_interval = 0.0;
  test_add_kind(&model, 2, 4);
  struct test_run r = test_start(model);
  r.state.position[5] = (struct point){LATTICE_REACH, -LATTICE_REACH, LATTICE_REACH};
  alarm(20);
  assert_false(neighbors_build(&r.state, &r.model, &r.work.contact, &r.work.fault));
  alarm(0);
  assert_int_equal(r.work.fault.code, FAULT_BOND_TOO_LONG);
  assert_int_equal(r.work.fault.entity, 4);
  assert_close(r.work.fault.limit, 2.5, 0.0);
  test_end(&r);
}

static void distances_of_bonds(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1003)};
  double worst = 0.0;
  for (int k = 0; k < 20000; k++) {
    const double scale = pow(10.0, dice_between(&d, -3.0, 1.5)), angle = pow(10.0, dice_between(&d, -16.0, 0.0));
    const struct vec3 p = vec3_scale(k % 50 ? scale : 0.0, dice_direction(&d));
    const struct vec3 aside = vec3_scale(angle * scale, dice_direction(&d));
    const struct vec3 q = vec3_add_scaled(aside, k % 70 ? dice_between(&d, -2.0, 2.0) : 0.0, p);
    const struct vec3 on_p = vec3_scale(dice_between(&d, -0.5, 1.5), p);
    struct vec3 w = vec3_add_scaled(on_p, -dice_between(&d, -0.5, 1.5), q);
    w = vec3_add_scaled(w, k % 3 ? pow(10.0, dice_between(&d, -12.0, 1.0)) : 0.0, dice_direction(&d));
    const double found = capsule_distance(p, q, w), exact = (double)distance_by_search(p, q, w);
    worst = fmax(worst, fabs(found - exact) / (vec3_norm(p) + vec3_norm(q) + vec3_norm(w)));
  }
  print_message("  largest error over the lengths: %.1e\n", worst);
  assert_true(worst < 1e-8);
}

/* A run from the start of seed 2. used: with the work of a run of seed 1. Without a solvent, whose order in memory
 * shows in the last bit of the momentum that a start takes off. */
static struct test_run start_of_seed_2(enum crossing_kind rule, bool used)
{
  struct model m = test_model(6, 5, 7, 0, 0.01, 2);
  m.solvent.collision_interval = 0.0;
  test_add_kind(&m, 60, 12);
  m.crossing.rule = rule;
  m.seed = used ? 1 : 2;
  struct test_run r = test_start(m);
  if (used) {
    test_steps(&r, 10);
    r.model.seed = 2;
    r.state.counts = (struct collision_counts){0};
    assert_true(start_state(&r.state, &r.model, &r.work));
  }
  return r;
}

/* The same work, counted, and the same places. Else partners would be those of the old places, so that contacts were
 * missed, and searches would go as far as vertices have been put. */
static void a_used_work_searches_anew_at_a_start(void **unused)
{
  (void)unused;
  const enum crossing_kind rules[] = {CROSSING_SEQUENTIAL, CROSSING_EVENT_DRIVEN};
  for (int k = 0; k < 2; k++) {
    struct test_run fresh = start_of_seed_2(rules[k], false), used = start_of_seed_2(rules[k], true);
    const struct neighbors *a = &fresh.work.contact.neighbors, *b = &used.work.contact.neighbors;
    const uint64_t before = b->renewed;
    test_steps(&fresh, 1), test_steps(&used, 1);
    const uint32_t pairs[2] = {a->pairs.count, b->pairs.count};
    test_steps(&fresh, 99), test_steps(&used, 99);
    const uint64_t renewed[2] = {a->renewed, b->renewed - before};
    const uint64_t contacts[2] = {fresh.state.counts.executed, used.state.counts.executed};
    print_message(
        "  pairs of the first step: %u, used %u; new reference positions: %lu, used %lu; contacts: %lu, used %lu\n",
        pairs[0], pairs[1], (unsigned long)renewed[0], (unsigned long)renewed[1], (unsigned long)contacts[0],
        (unsigned long)contacts[1]);
    assert_true(renewed[0] > 0 && contacts[0] > 0);
    assert_int_equal(contacts[1], contacts[0]);
    assert_int_equal(pairs[1], pairs[0]);
    assert_int_equal(renewed[1], renewed[0]);
    assert_memory_equal(used.state.position, fresh.state.position, fresh.state.vertices * sizeof *fresh.state.position);
    test_end(&fresh);
    test_end(&used);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lists_are_complete_after_a_build),
      cmocka_unit_test(lists_stay_complete_under_moves),
      cmocka_unit_test(anchors_hold_within_the_margin),
      cmocka_unit_test(anchors_lead_without_a_solvent),
      cmocka_unit_test(distances_of_bonds),
      cmocka_unit_test(endless_bonds_are_a_fault),
      cmocka_unit_test(a_used_work_searches_anew_at_a_start),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
