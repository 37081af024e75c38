/* Hydrodynamics off: the solvent's velocities are permuted, by particle id, uniformly; sorting changes nothing. */
#include "base/random.h"
#include "exact.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/sort.h"

static struct model swapping(uint32_t particles)
{
  struct model m = test_model(4, 3, 5, 1, 0.01, 2);
  test_particles(&m, particles);
  m.solvent.hydrodynamics = false;
  test_add_kind(&m, 4, 3);
  return m;
}

/* Swaps, and looks at each particle. */
static void swap_by_id(struct test_run *r, uint64_t step)
{
  const uint32_t n = r->state.solvent.n;
  struct vec3 *v = malloc(n * sizeof *v), *after = malloc(n * sizeof *after);
  struct point *x = malloc(n * sizeof *x);
  uint32_t *order = malloc(n * sizeof *order), moved = 0;
  for (uint32_t i = 0; i < n; i++) {
    v[r->state.solvent.id[i]] = solvent_v(&r->state, i);
    x[r->state.solvent.id[i]] = (struct point){r->state.solvent.x[i], r->state.solvent.y[i], r->state.solvent.z[i]};
  }
  struct vec3 vertex = r->state.velocity[5];
  mpc_swap_velocities(&r->state, &r->model, &r->work.mpc, step);
  random_permutation(r->model.seed, RANDOM_VELOCITY_SWAP, 0, step, n, order);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t id = r->state.solvent.id[i];
    after[id] = solvent_v(&r->state, i);
    assert_memory_equal(&after[id], &v[order[id]], sizeof *v);
    assert_true(r->state.solvent.x[i] == x[id].x && r->state.solvent.y[i] == x[id].y &&
                r->state.solvent.z[i] == x[id].z);
    moved += order[id] != id;
  }
  assert_true(n < 10 || moved > n / 2);
  assert_memory_equal(&vertex, &r->state.velocity[5], sizeof vertex);
  free(v);
  free(after);
  free(x);
  free(order);
}

/* Particle id takes the velocity of particle order[id], wherever the two are in memory, also after they have moved in
 * it; ids, places, vertices stay. */
static void swap_is_defined_by_id(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 50; k++) {
    struct dice d = {dice_seed(601) + k};
    struct test_run r = dice_run(swapping((uint32_t)dice_integer(&d, 1, 400)), &d);
    for (uint64_t step = 31 + k; step < 34 + k; step++) {
      shuffle_memory(&r.state, &d);
      swap_by_id(&r, step);
      swap_by_id(&r, step + 100);
    }
    test_end(&r);
  }
}

/* The multiset of velocities is kept bit by bit, each component with its fellows. */
static void velocities_are_only_rearranged(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(602)};
  struct test_run r = dice_run(swapping(500), &d);
  double before[3][500], after[3][500];
  memcpy(before[0], r.state.solvent.vx, sizeof before[0]);
  for (uint32_t i = 0; i < 500; i++) {
    r.state.solvent.vy[i] = 2.0 * r.state.solvent.vx[i]; /* triples are tied together */
    r.state.solvent.vz[i] = -r.state.solvent.vx[i];
  }
  mpc_swap_velocities(&r.state, &r.model, &r.work.mpc, 8);
  memcpy(after[0], r.state.solvent.vx, sizeof after[0]);
  for (uint32_t i = 0; i < 500; i++)
    assert_true(r.state.solvent.vy[i] == 2.0 * after[0][i] && r.state.solvent.vz[i] == -after[0][i]);
  qsort(before[0], 500, sizeof(double), compare_doubles);
  qsort(after[0], 500, sizeof(double), compare_doubles);
  assert_memory_equal(before[0], after[0], sizeof after[0]);
  test_end(&r);
}

/* All 3! arrangements equally often over the steps. */
static void swap_is_uniform(void **unused)
{
  (void)unused;
  struct dice d = {1};
  struct model m = swapping(3);
  m.seed = dice_seed(603);
  struct test_run r = dice_run(m, &d);
  uint64_t count[6] = {0};
  for (uint64_t step = 0; step < 120000; step++) {
    for (uint32_t i = 0; i < 3; i++)
      r.state.solvent.vx[i] = i;
    mpc_swap_velocities(&r.state, &r.model, &r.work.mpc, step);
    const double *v = r.state.solvent.vx;
    count[2 * (int)v[0] + (v[1] > v[2])]++;
  }
  assert_true(equal_chances(count, 6) > LEAST_CHANCE);
  test_end(&r);
}

/* A collision without hydrodynamics is the one with hydrodynamics, then the swap; vertices do not take part in it. */
static void collision_comes_first(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(604)}, e = d;
  struct model with = swapping(300);
  with.solvent.hydrodynamics = true;
  struct test_run on = dice_run(with, &d), off = dice_run(swapping(300), &e);
  assert_true(state_hash(&on.state) == state_hash(&off.state));
  assert_true(mpc_collide(&on.state, &on.model, &on.work.mpc, 6, &on.work.fault));
  assert_true(mpc_collide(&off.state, &off.model, &off.work.mpc, 6, &off.work.fault));
  assert_true(state_hash(&on.state) != state_hash(&off.state));
  mpc_swap_velocities(&on.state, &off.model, &off.work.mpc, 6); /* off's work has room for a swap */
  assert_true(state_hash(&on.state) == state_hash(&off.state));
  test_end(&on);
  test_end(&off);
}

/* Sorting moves particles in memory, whole; cells come out in ascending order. */
static void sorting_keeps_particles_whole(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(605)};
  struct test_run r = dice_run(swapping(700), &d);
  shuffle_memory(&r.state, &d);
  const uint64_t before = state_hash(&r.state);
  mpc_sort(&r.state, &r.model, &r.work.mpc);
  assert_true(state_hash(&r.state) == before);
  uint32_t last = 0;
  const struct point unshifted = {0, 0, 0};
  for (uint32_t i = 0; i < 700; i++) {
    struct point p = {r.state.solvent.x[i], r.state.solvent.y[i], r.state.solvent.z[i]};
    uint32_t cell = cell_by_floor(&r.model.box, p, unshifted);
    assert_true(cell >= last);
    last = cell;
  }
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(swap_is_defined_by_id),
      cmocka_unit_test(velocities_are_only_rearranged),
      cmocka_unit_test(swap_is_uniform),
      cmocka_unit_test(collision_comes_first),
      cmocka_unit_test(sorting_keeps_particles_whole),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
