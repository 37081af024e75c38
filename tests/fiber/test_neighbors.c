/* Lists of partner bonds against brute force over all bonds and all images, after builds and thousands of redraws. */
#include "exact.h"
#include "fiber/neighbors.h"

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

static bool listed(const struct neighbors *nb, uint32_t bond, int32_t other, int64_t i, int64_t j, int64_t k)
{
  uint32_t times = 0;
  for (uint32_t n = 0; n < nb->count[bond]; n++) {
    const struct neighbor *e = &nb->list[(size_t)bond * nb->stride + n];
    times += e->bond == other && e->image[0] == i && e->image[1] == j && e->image[2] == k;
  }
  assert_true(times <= 1); /* twice would count a hit twice */
  return times == 1;
}

/* Every list holds exactly the bonds and images whose margin boxes overlap its own, each once; no bond has left its
 * box. Returns the number of partners. */
static uint64_t check_lists(const struct test_run *r, uint64_t seed)
{
  const struct neighbors *nb = &r->work.fiber.neighbors;
  const int64_t *edge = r->model.box.edge;
  uint64_t partners = 0;
  for (uint32_t a = 0; a < r->model.vertices; a++) {
    if (r->model.next[a] < 0)
      continue;
    const struct margin_box *p = &nb->box[a];
    assert_true(margin_box_holds(p, r->state.position[a]) && margin_box_holds(p, r->state.position[r->model.next[a]]));
    uint64_t expected = 0;
    for (uint32_t b = 0; b < r->model.vertices; b++) {
      if (r->model.next[b] < 0 || joined(&r->model, a, b))
        continue;
      const struct margin_box *q = &nb->box[b];
      int64_t x[2], y[2], z[2];
      image_range(p->low.x, p->high.x, q->low.x, q->high.x, edge[0], x);
      image_range(p->low.y, p->high.y, q->low.y, q->high.y, edge[1], y);
      image_range(p->low.z, p->high.z, q->low.z, q->high.z, edge[2], z);
      for (int64_t i = x[0]; i <= x[1]; i++)
        for (int64_t j = y[0]; j <= y[1]; j++)
          for (int64_t k = z[0]; k <= z[1]; k++) {
            expected++;
            if (!listed(nb, a, (int32_t)b, i, j, k))
              fail_msg("seed %lu: bond %u misses bond %u in image %ld %ld %ld", (unsigned long)seed, a, b, (long)i,
                       (long)j, (long)k);
          }
    }
    if (expected != nb->count[a])
      fail_msg("seed %lu: bond %u has %u partners, expected %lu", (unsigned long)seed, a, nb->count[a],
               (unsigned long)expected);
    partners += expected;
  }
  return partners;
}

/* Bonds of all lengths up to half the shortest edge, rings and open fibers, in images far away. */
static struct test_run random_bonds(int lx, int ly, int lz, uint32_t count, struct dice *d)
{
  struct model m = test_model(lx, ly, lz, 0, 0.01, 2);
  test_add_kind(&m, count, 2);
  test_add_kind(&m, count / 2, 3);
  test_add_kind(&m, count / 2, 3)->ring = true;
  test_add_kind(&m, count / 2, 5);
  struct test_run r = dice_run(m, d);
  const double half = 0.5 * box_shortest_edge(&r.model.box), longest = fmin(half, 1.6);
  for (uint32_t v = 0; v < r.state.vertices; v++) {
    const uint32_t first = r.model.fiber_first[r.model.fiber_of[v]];
    if (v == first)
      continue;
    const bool ring = r.model.kind[r.model.fiber_kind_of[r.model.fiber_of[v]]].ring;
    double length = dice_between(d, 0.0, ring ? 0.5 : 0.999) * longest;
    r.state.position[v] =
        point_move(r.state.position[v - (ring ? v - first : 1)], vec3_scale(length, dice_direction(d)));
  }
  return r;
}

/* Moves a random vertex by up to `size`, as a sweep does: cover both bonds, then go (or, every third time, stay). Moves
 * that would make a bond longer than half the box are left out. */
static void random_move(struct test_run *r, struct dice *d, double size)
{
  const uint32_t v = (uint32_t)dice_integer(d, 0, r->state.vertices - 1);
  const struct point to = point_move(r->state.position[v], dice_rod(d, 0.0, size));
  const int32_t bond[2] = {r->model.prev[v], r->model.next[v] >= 0 ? (int32_t)v : -1};
  const double half = 0.5 * box_shortest_edge(&r->model.box);
  for (int k = 0; k < 2; k++)
    if (bond[k] >= 0) {
      uint32_t pivot = k == 0 ? (uint32_t)bond[0] : (uint32_t)r->model.next[v];
      if (vec3_norm(point_difference(to, r->state.position[pivot])) >= half)
        return;
    }
  for (int k = 0; k < 2; k++)
    if (bond[k] >= 0) {
      assert_true(neighbors_cover(&r->state, &r->model, &r->work, (uint32_t)bond[k], to));
      assert_true(margin_box_holds(&r->work.fiber.neighbors.box[bond[k]], to));
    }
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
  for (size_t p = 0; p < sizeof places / sizeof *places; p++)
    for (uint64_t again = 0; again < 4; again++) {
      const uint64_t seed = dice_seed(1001) + 10 * p + again;
      struct dice d = {seed};
      struct test_run r = random_bonds(places[p].lx, places[p].ly, places[p].lz, places[p].count, &d);
      assert_true(neighbors_build(&r.state, &r.model, &r.work));
      uint64_t partners = check_lists(&r, seed);
      assert_true(partners > 0);
      for (uint32_t v = 0; v < r.state.vertices; v++) /* all images move: a rebuild finds as many partners */
        r.state.position[v].x += 7 * r.model.box.edge[0], r.state.position[v].z -= 1000 * r.model.box.edge[2];
      assert_true(neighbors_build(&r.state, &r.model, &r.work));
      assert_true(check_lists(&r, seed) == partners);
      test_end(&r);
    }
}

/* Short moves, as in a run, and long ones; lists grow on the way. */
static void lists_stay_complete_under_moves(void **unused)
{
  (void)unused;
  uint64_t redrawn = 0;
  for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
    const uint64_t seed = dice_seed(1002) + p;
    struct dice d = {seed};
    struct test_run r = random_bonds(places[p].lx, places[p].ly, places[p].lz, places[p].count, &d);
    assert_true(neighbors_build(&r.state, &r.model, &r.work));
    for (int k = 0; k < 3000; k++) {
      random_move(&r, &d, k % 100 ? 0.1 : 0.45 * box_shortest_edge(&r.model.box));
      if (k % 250 == 249)
        check_lists(&r, seed);
    }
    redrawn += r.work.fiber.neighbors.redrawn;
    test_end(&r);
  }
  print_message("  %lu margin boxes redrawn\n", (unsigned long)redrawn);
  assert_true(redrawn > 5000);
}

/* A bond within its margin costs nothing; one step beyond, it is redrawn, around the place it may go to as well. */
static void boxes_are_redrawn_when_left(void **unused)
{
  (void)unused;
  struct dice d = {3};
  struct test_run r = random_bonds(6, 6, 6, 10, &d);
  assert_true(neighbors_build(&r.state, &r.model, &r.work));
  const struct margin_box box = r.work.fiber.neighbors.box[0];
  const struct point a = r.state.position[0], b = r.state.position[1];
  const int64_t high = a.x > b.x ? a.x : b.x;
  assert_true(box.high.x > high && box.low.y < a.y && box.low.z < b.z);
  uint64_t drawn = r.work.fiber.neighbors.redrawn;
  assert_true(neighbors_cover(&r.state, &r.model, &r.work, 0, (struct point){box.high.x, a.y, a.z}));
  assert_true(r.work.fiber.neighbors.redrawn == drawn);
  const struct point out = {box.high.x + 1, a.y, a.z};
  assert_true(neighbors_cover(&r.state, &r.model, &r.work, 0, out));
  assert_true(r.work.fiber.neighbors.redrawn == drawn + 1);
  assert_true(margin_box_holds(&r.work.fiber.neighbors.box[0], out));
  check_lists(&r, 3);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lists_are_complete_after_a_build),
      cmocka_unit_test(lists_stay_complete_under_moves),
      cmocka_unit_test(boxes_are_redrawn_when_left),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
