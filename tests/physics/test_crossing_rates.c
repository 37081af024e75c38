/* How often bonds meet: geometry (Buffon's needle) and kinetic theory, both exact. */
#include "../../validation/measure/needles.h"
#include "base/random.h"
#include "statistics.h"
#include "support.h"

/* --- Buffon ------------------------------------------------------------------------------------------------------- */

/* A vertex that moves by d while all others stand still sweeps a triangle of area |bond x d|/2 for each of its bonds.
 * Standing bonds of total length l_total, placed uniformly in the volume V and turned uniformly, pierce a triangle of
 * area A on average l_total A/(2V) times: the mean of |cos| over the sphere is 1/2. Exact for every size of triangle.
 */

static double swept_area(const struct state *s, const struct model *m, uint32_t vertex, struct vec3 d)
{
  double area = 0.0;
  const int32_t neighbor[2] = {m->prev[vertex], m->next[vertex]};
  for (int k = 0; k < 2; k++)
    if (neighbor[k] >= 0)
      area += 0.5 * vec3_norm(vec3_cross(point_difference(s->position[neighbor[k]], s->position[vertex]), d));
  return area;
}

/* Length of all bonds of fibers other than this one. */
static double length_of_others(const struct state *s, const struct model *m, uint32_t fiber)
{
  double length = 0.0;
  for (uint32_t j = 0; j < m->vertices; j++)
    if (m->next[j] >= 0 && m->fiber_of[j] != fiber)
      length += vec3_norm(point_difference(s->position[m->next[j]], s->position[j]));
  return length;
}

struct count {
  uint32_t vertex;
  uint64_t hits;
};

static void count_hit(void *context, const struct contact_event *event)
{
  struct count *c = context;
  c->hits += event->vertex == c->vertex;
}

/* Hits of one vertex while the others stand still; the state is put back afterwards. scratch: room for all vertices. */
static uint64_t hits_of_one(struct test_run *r, uint32_t vertex, struct vec3 velocity, uint64_t step,
                            struct point *scratch)
{
  struct count count = {vertex, 0};
  const struct contact_log log = {count_hit, &count};
  const size_t n = r->model.vertices;
  memset(r->state.velocity, 0, n * sizeof *r->state.velocity);
  memcpy(scratch, r->state.position, n * sizeof *scratch);
  r->state.velocity[vertex] = velocity;
  assert_true(contact_drift(&r->state, &r->model, &r->work.contact, 1.0, step, 0, &log, &r->work.fault));
  memcpy(r->state.position, scratch, n * sizeof *scratch);
  return count.hits;
}

/* Fibers of two or three vertices in a box of 3 cells, bonds of about 1 (a third of the box, so that images matter). In
 * every configuration vertex number `which` of each fiber moves once, by `far` in a random direction; a configuration
 * is one independent entry. */
static struct ratio count_crossings(uint32_t fibers, uint32_t vertices, uint32_t which, double far,
                                    uint32_t configurations)
{
  struct model m = test_model(3, 3, 3, 0, 0.01, 1);
  struct fiber_kind *k = test_add_kind(&m, fibers, vertices);
  k->bond_length = 1.0;
  k->bending = 0.0;
  struct test_run r = test_start(m);
  r.model.time_step = 1.0; /* a velocity is a displacement */
  struct point *scratch = calloc(r.model.vertices, sizeof *scratch);
  struct ratio ratio = {0};
  for (uint32_t c = 0; c < configurations; c++) {
    r.model.seed = 1 + c;
    assert_true(start_state(&r.state, &r.model, &r.work));
    double expected = 0.0;
    uint64_t hits = 0;
    for (uint32_t f = 0; f < fibers; f++) {
      const uint32_t v = f * vertices + which;
      const struct vec3 d = vec3_scale(far, random_axis(r.model.seed, RANDOM_VERTEX_VELOCITY, 1, v));
      expected += 0.5 * length_of_others(&r.state, &r.model, f) / box_volume(&r.model.box) *
                  swept_area(&r.state, &r.model, v, d);
      hits += hits_of_one(&r, v, d, f, scratch);
    }
    ratio_add(&ratio, (double)hits, expected);
  }
  free(scratch);
  test_end(&r);
  return ratio;
}

/* Gates: the error bar is small enough for `tolerance` to be 3 sigma, and the count is within 3 of its own. With other
 * seeds each would raise a false alarm once in 370. */
static void assert_buffon(const struct ratio *ratio, double least_hits, double tolerance)
{
  print_message("  %.0f hits\n", ratio->x);
  assert_true(ratio->x > least_hits);
  assert_true(ratio_error(ratio) < tolerance / 3.0);
  assert_sigma(ratio_value(ratio), ratio_error(ratio), 1.0, 3.0);
}

static void an_end_meets_as_many_bonds_as_buffon_says(void **unused)
{
  (void)unused;
  struct ratio ratio = count_crossings(60, 2, 0, 1.2, 3500);
  assert_buffon(&ratio, 1e5, 0.015);
}

static void a_middle_vertex_sweeps_with_both_its_bonds(void **unused)
{
  (void)unused;
  struct ratio ratio = count_crossings(30, 3, 1, 1.2, 3500);
  assert_buffon(&ratio, 1e5, 0.015);
}

static void short_moves_too(void **unused)
{
  (void)unused;
  struct ratio ratio = count_crossings(60, 2, 1, 0.1, 2000);
  assert_buffon(&ratio, 4e3, 0.06);
}

/* --- kinetic theory ----------------------------------------------------------------------------------------------- */

/* False alarms: the gate is at least 3 sigma wide on either side. The share of spurious collisions, and the surplus of
 * executed ones (1.15 to 1.16 of the exact rate), were found the same in independent programs at three time steps. */
static void assert_rates(const struct rates *r)
{
  print_message("  net/exact %.4f +- %.4f, executed/exact %.4f +- %.4f, negative/executed %.4f +- %.4f\n",
                ratio_value(&r->net), ratio_error(&r->net), ratio_value(&r->executed), ratio_error(&r->executed),
                ratio_value(&r->negative), ratio_error(&r->negative));
  assert_true(ratio_error(&r->net) < 0.005);
  assert_close(ratio_value(&r->net), 1.0, 0.015);
  assert_close(ratio_value(&r->negative), 0.07, 0.005);
}

static struct rates measure(double dt, uint32_t runs)
{
  struct model m = test_model(4, 4, 4, 0, dt, 1);
  struct fiber_kind *k = test_add_kind(&m, 474, 2);
  k->bond_length = 1.0;
  k->bending = 0.0;
  struct test_run r = test_start(m);
  struct rates rates = {.net = {0}};
  assert_true(needle_rates(&r.model, &r.state, &r.work, 1, runs, &rates));
  test_end(&r);
  return rates;
}

static void net_collision_rate_is_that_of_kinetic_theory(void **unused)
{
  (void)unused;
  struct rates rates = measure(0.01, 75);
  assert_rates(&rates);
}

static void net_collision_rate_does_not_depend_on_the_step(void **unused)
{
  (void)unused;
  struct rates rates = measure(0.005, 75);
  assert_rates(&rates);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(an_end_meets_as_many_bonds_as_buffon_says),
                                     cmocka_unit_test(a_middle_vertex_sweeps_with_both_its_bonds),
                                     cmocka_unit_test(short_moves_too),
                                     cmocka_unit_test(net_collision_rate_is_that_of_kinetic_theory),
                                     cmocka_unit_test(net_collision_rate_does_not_depend_on_the_step)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
