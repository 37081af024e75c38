/* The collision on the grid: binning, conservation in each cell, one-step factors, range faults, and equal bits with a
 * plain driver that knows one cell at a time. */
#include <gsl/gsl_randist.h>

#include "exact.h"
#include "fiber/start.h"
#include "fluid/fluid.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/rules/srd.h"

static struct model small_model(double degrees)
{
  struct model m = test_model(3, 2, 4, 5, 0.01, 2);
  m.solvent.rotation_angle = degrees;
  test_add_kind(&m, 6, 4);
  test_add_kind(&m, 5, 1)->mass = 0.25;
  test_add_kind(&m, 3, 2)->mass = 12.0 + MODEL_MASS_UNIT;
  return m;
}

/* A member of a cell: where its velocity is. */
struct member {
  double mass;
  struct vec3 v;
  int64_t who; /* solvent: memory index; vertex v: -1 - v */
};

/* The members of a cell, found one by one; in memory order. */
static uint32_t gather(const struct test_run *r, struct point shift, uint32_t cell, struct member *member)
{
  uint32_t n = 0;
  const struct solvent *s = &r->state.solvent;
  for (uint32_t i = 0; i < s->n; i++)
    if (cell_by_floor(&r->model.box, (struct point){s->x[i], s->y[i], s->z[i]}, shift) == cell)
      member[n++] = (struct member){1.0, solvent_v(&r->state, i), i};
  for (uint32_t v = 0; v < r->state.vertices; v++)
    if (cell_by_floor(&r->model.box, r->state.position[v], shift) == cell)
      member[n++] = (struct member){r->model.mass[v], r->state.velocity[v], -1 - (int64_t)v};
  return n;
}

static struct vec3 velocity_of(const struct test_run *r, const uint32_t *slot, const uint32_t *id, int64_t who)
{
  return who < 0 ? r->state.velocity[-1 - who] : solvent_v(&r->state, slot[id[who]]);
}

/* Every cell's collision done by hand with cell_add (in some order), cell_solve, srd_apply: the same bits as
 * solvent_collide; momentum and energy per cell to 1e-12; lone members keep their bits. */
static void compare_with_plain_driver(double degrees, uint64_t seed, double fastest)
{
  struct dice d = {seed};
  struct test_run r = dice_run(small_model(degrees), &d);
  for (uint32_t i = 0; i < r.state.solvent.n && fastest > 0.0; i += 1 + (uint32_t)dice_integer(&d, 0, 100))
    r.state.solvent.vy[i] = dice_between(&d, -fastest, fastest);
  const uint64_t step = (uint64_t)dice_integer(&d, 1, (int64_t)1 << 40);
  r.model.seed = dice_u64(&d);
  const struct point shift = grid_shift(&r.model, step);
  const uint32_t most = r.state.solvent.n + r.state.vertices;
  const int64_t cells = box_cell_count(&r.model.box);
  struct member *before = malloc((size_t)cells * most * sizeof *before);
  uint32_t count[64], *id = malloc(most * sizeof *id), *slot = malloc(most * sizeof *slot);
  for (int64_t k = 0; k < cells; k++)
    count[k] = gather(&r, shift, (uint32_t)k, &before[k * most]);
  memcpy(id, r.state.solvent.id, r.state.solvent.n * sizeof *id);
  assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, step, &r.work.fault));
  state_solvent_slots(&r.state, slot); /* the collision may have re-sorted the particles */

  uint32_t members = 0;
  for (int64_t k = 0; k < cells; k++) {
    struct member *m = &before[k * most];
    struct cell_sum sum = {0};
    struct cell_turn turn = {.active = 0.0};
    for (uint32_t i = count[k]; i-- > 0;) /* backwards: the order must not matter */
      cell_add(&sum, m[i].mass, cell_load(m[i].mass), m[i].v);
    cell_solve(&sum, &turn);
    turn.axis = random_axis(r.model.seed, RANDOM_ROTATION_AXIS, step, (uint32_t)k);
    struct vec3 change = {0, 0, 0};
    double energy = 0.0, scale = 1.0;
    for (uint32_t i = 0; i < count[k]; i++) {
      struct vec3 v = m[i].v, now = velocity_of(&r, slot, id, m[i].who);
      if (count[k] > 1)
        v = srd_apply(&turn, v, degrees == 90.0, r.model.solvent.cosine, r.model.solvent.sine, true);
      if (memcmp(&v, &now, sizeof v) != 0)
        fail_msg("seed %lu: cell %ld of %u members differs", (unsigned long)seed, (long)k, count[k]);
      change = vec3_add_scaled(change, m[i].mass, vec3_sub(now, m[i].v));
      energy += m[i].mass * (vec3_dot(now, now) - vec3_dot(m[i].v, m[i].v));
      scale += m[i].mass * vec3_dot(m[i].v, m[i].v);
    }
    assert_close(vec3_norm(change), 0.0, 1e-12 * sqrt(scale * 10));
    assert_close(energy, 0.0, 1e-12 * scale);
    members += count[k];
  }
  assert_int_equal(members, most);
  free(before);
  free(id);
  free(slot);
  test_end(&r);
}

static void grid_equals_plain_driver(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 40; k++) {
    compare_with_plain_driver(90.0, dice_seed(301) + 2 * k, 0.0);
    compare_with_plain_driver(130.0, dice_seed(301) + 2 * k + 1, 0.0);
    compare_with_plain_driver(90.0, dice_seed(301) + 2 * k, k % 2 ? 150.0 : 5000.0); /* past 64 and 128 a0/t0 */
  }
}

/* Few particles in many cells: most are alone, and keep every bit. */
static void lone_members_keep_their_velocities(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(302)};
  struct model m = test_model(12, 12, 12, 0.05, 0.01, 2);
  test_add_kind(&m, 60, 1);
  struct test_run r = dice_run(m, &d);
  uint32_t lone = 0, together = 0, n = r.state.solvent.n;
  struct vec3 *before = malloc((n + 60) * sizeof *before);
  uint32_t *cell = malloc((n + 60) * sizeof *cell), *slot = malloc(n * sizeof *slot);
  const struct point shift = grid_shift(&r.model, 7);
  for (uint32_t i = 0; i < n; i++) {
    before[i] = solvent_v(&r.state, i);
    cell[i] = cell_by_floor(&r.model.box,
                            (struct point){r.state.solvent.x[i], r.state.solvent.y[i], r.state.solvent.z[i]}, shift);
  }
  for (uint32_t v = 0; v < 60; v++) {
    before[n + v] = r.state.velocity[v];
    cell[n + v] = cell_by_floor(&r.model.box, r.state.position[v], shift);
  }
  assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 7, &r.work.fault));
  state_solvent_slots(&r.state, slot);
  for (uint32_t i = 0; i < n + 60; i++) {
    struct vec3 now = i < n ? solvent_v(&r.state, slot[i]) : r.state.velocity[i - n];
    uint32_t here = 0;
    for (uint32_t k = 0; k < n + 60; k++)
      here += cell[k] == cell[i];
    assert_true((memcmp(&now, &before[i], sizeof now) == 0) == (here == 1));
    lone += here == 1;
    together += here > 1;
  }
  assert_true(lone > 50 && together > 5);
  free(before);
  free(cell);
  free(slot);
  test_end(&r);
}

/* grid_cell_of against floor divisions: points anywhere, on faces, in boxes down to one cell. */
static void cells_are_where_they_should_be(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(303);
  struct dice d = {seed};
  for (int k = 0; k < 60000; k++) {
    struct box box = box_of_cells(1 + k % 6, 1 + k / 6 % 6, (int)dice_integer(&d, 1, 1024));
    int64_t p[3];
    for (int c = 0; c < 3; c++) {
      p[c] = dice_integer(&d, -5 * box.edge[c], 5 * box.edge[c]);
      if (k % 3 == 0)
        p[c] =
            floor_divide(p[c], LATTICE_CELL) * LATTICE_CELL + dice_integer(&d, -1, 1); /* around the faces of cells */
    }
    struct point at = {p[0], p[1], p[2]}, shift = {dice_integer(&d, 0, LATTICE_CELL - 1),
                                                   k % 2 ? 0 : dice_integer(&d, 0, LATTICE_CELL - 1), LATTICE_CELL - 1};
    if (grid_cell_of(&box, at, shift) != cell_by_floor(&box, at, shift))
      fail_msg("seed %lu case %d: cell %u, expected %u", (unsigned long)seed, k, grid_cell_of(&box, at, shift),
               cell_by_floor(&box, at, shift));
  }
}

/* Grid shifts are uniform in [0, one cell) in each direction, and the three are independent. */
static void grid_shift_is_uniform(void **unused)
{
  (void)unused;
  enum { N = 100000 };
  struct model m = test_model(4, 4, 4, 5, 0.01, 2);
  m.seed = dice_seed(304);
  double *u[3];
  uint64_t cube[64] = {0};
  for (int c = 0; c < 3; c++)
    u[c] = malloc(N * sizeof *u[c]);
  for (uint64_t step = 0; step < N; step++) {
    struct point s = grid_shift(&m, step);
    const int64_t x[3] = {s.x, s.y, s.z};
    int corner = 0;
    for (int c = 0; c < 3; c++) {
      assert_true(x[c] >= 0 && x[c] < LATTICE_CELL);
      u[c][step] = (double)x[c] * 0x1p-40;
      corner = 4 * corner + (int)(4 * u[c][step]);
    }
    cube[corner]++;
  }
  for (int c = 0; c < 3; c++) {
    assert_true(kolmogorov(u[c], N) < KOLMOGOROV_LIMIT);
    free(u[c]);
  }
  assert_true(equal_chances(cube, 64) > LEAST_CHANCE);
}

/* Solvent and vertices clustered at one point (vertices in other images of it) share one cell and one V_cm, on any
 * shifted grid (THEORY test 14): all relative velocities turn about the same exact centre by the same rotation. */
static void vertices_and_solvent_share_the_grid(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 200; k++) {
    const uint64_t seed = dice_seed(305) + k;
    struct dice d = {seed};
    struct model m = test_model(3, 5, 2, 0.2, 0.01, 2);
    test_add_kind(&m, 3, 1);
    struct test_run r = dice_run(m, &d);
    const int64_t *edge = r.model.box.edge;
    struct solvent *s = &r.state.solvent;
    for (uint32_t i = 1; i < s->n; i++) {
      s->x[i] = s->x[0];
      s->y[i] = s->y[0];
      s->z[i] = s->z[0];
    }
    for (uint32_t v = 0; v < 3; v++) {
      const struct point image = dice_point(&d, 4, 4, 4);
      r.state.position[v] =
          (struct point){s->x[0] + image.x * edge[0], s->y[0] + image.y * edge[1], s->z[0] + image.z * edge[2]};
    }
    struct vec3 center = {0, 0, 0}, before[16];
    double mass = s->n + 15.0;
    for (uint32_t i = 0; i < s->n; i++)
      center = vec3_add_scaled(center, 1.0 / mass, before[i] = solvent_v(&r.state, i));
    for (uint32_t v = 0; v < 3; v++)
      center = vec3_add_scaled(center, 5.0 / mass, before[s->n + v] = r.state.velocity[v]);
    uint32_t slot[16];
    assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, k, &r.work.fault));
    state_solvent_slots(&r.state, slot);
    for (uint32_t i = 0; i < s->n + 3; i++)
      for (uint32_t j = 0; j <= i; j++) { /* all scalar products of relative velocities are kept, but no velocity is */
        struct vec3 vi = i < s->n ? solvent_v(&r.state, slot[i]) : r.state.velocity[i - s->n];
        struct vec3 vj = j < s->n ? solvent_v(&r.state, slot[j]) : r.state.velocity[j - s->n];
        assert_close(vec3_dot(vec3_sub(vi, center), vec3_sub(vj, center)),
                     vec3_dot(vec3_sub(before[i], center), vec3_sub(before[j], center)), 1e-12);
        assert_true(i != j || memcmp(&vi, &before[i], sizeof vi) != 0);
      }
    test_end(&r);
  }
}

/* Expected one-step factor of a member of mass M (THEORY 2.2): c = 1 - (2/3)(1 - cos a) <M_others / (M + M_others)>
 * over Poisson numbers of solvent (gamma) and of other vertices (load, mass 5 each) in its cell. */
static double expected_factor(double mass, double degrees, double gamma, double load)
{
  double mean = 0.0;
  for (unsigned n = 0; n < 60; n++)
    for (unsigned k = 0; k < (load > 0.0 ? 40u : 1u); k++) {
      double others = n + 5.0 * k;
      double chance = gsl_ran_poisson_pdf(n, gamma) * (load > 0.0 ? gsl_ran_poisson_pdf(k, load) : 1.0);
      mean += chance * others / (mass + others);
    }
  return 1.0 - 2.0 / 3.0 * (1.0 - cos(degrees * 3.14159265358979323846 / 180.0)) * mean;
}

/* One collision from uniform positions: <v'.v> / <v.v>, per component. */
static void measure_factors(double degrees, uint32_t vertices, uint32_t collisions, uint64_t seed,
                            struct tally solvent[3], struct tally vertex[3])
{
  struct model m = test_model(16, 16, 16, 5, 0.01, 2);
  m.seed = seed;
  m.solvent.rotation_angle = degrees;
  if (vertices)
    test_add_kind(&m, vertices, 1)->start = START_STRAIGHT;
  struct test_run r = {.model = m};
  test_finish(&r.model);
  assert_true(state_alloc(&r.state, &r.model) && work_alloc(&r.work, &r.model));
  struct vec3 *before = malloc((r.state.solvent.n + 1) * sizeof *before);
  struct vec3 *vertex_before = malloc((vertices + 1) * sizeof *vertex_before);
  for (uint32_t k = 0; k < collisions; k++) {
    r.model.seed = seed + k;
    fluid_points.start(&r.state, &r.model);
    fiber_start(&r.state, &r.model, NULL, &(uint32_t){0});
    for (uint32_t i = 0; i < r.state.solvent.n; i++)
      before[r.state.solvent.id[i]] = solvent_v(&r.state, i);
    memcpy(vertex_before, r.state.velocity, vertices * sizeof *vertex_before);
    assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 2, &r.work.fault));
    for (uint32_t i = 0; i < r.state.solvent.n; i++) {
      struct vec3 v = solvent_v(&r.state, i), u = before[r.state.solvent.id[i]];
      tally_add(&solvent[0], v.x * u.x);
      tally_add(&solvent[1], v.y * u.y);
      tally_add(&solvent[2], v.z * u.z);
    }
    for (uint32_t i = 0; i < vertices; i++) {
      struct vec3 v = r.state.velocity[i], u = vertex_before[i];
      tally_add(&vertex[0], 5.0 * v.x * u.x);
      tally_add(&vertex[1], 5.0 * v.y * u.y);
      tally_add(&vertex[2], 5.0 * v.z * u.z);
    }
  }
  free(before);
  free(vertex_before);
  test_end(&r);
}

/* THEORY 2.2 prints these for few vertices; the formula, summed here, must give them. */
static void factor_formula(void **unused)
{
  (void)unused;
  const double mass[] = {1, 2, 5, 10, 20};
  const double at90[] = {.465768, .547026, .684094, .787624, .870863};
  const double at130[] = {.122371, .255860, .481034, .651112, .787855};
  for (int k = 0; k < 5; k++) {
    assert_close(expected_factor(mass[k], 90, 5, 0), at90[k], 6e-7);
    assert_close(expected_factor(mass[k], 130, 5, 0), at130[k], 6e-7);
  }
  assert_close(expected_factor(5, 90, 10, 0), .566133, 6e-7);
}

/* Per component, so that an axis that is not uniform shows (THEORY test 10: uniform theta gives .599 and .399). */
static void one_step_factors(void **unused)
{
  (void)unused;
  const double degrees[] = {90.0, 130.0};
  for (int k = 0; k < 2; k++) {
    struct tally solvent[3] = {{0}}, none[3] = {{0}}, vertex[3] = {{0}}, loaded[3] = {{0}};
    measure_factors(degrees[k], 0, 60, dice_seed(9000), solvent, none);
    measure_factors(degrees[k], 2048, 150, dice_seed(9500), loaded, vertex);
    for (int c = 0; c < 3; c++) {
      /* <v.v> of a sample is not exactly 1, but <v'.v> is, on average: v is Maxwell */
      assert_sigma(tally_mean(&solvent[c]), tally_error(&solvent[c]), expected_factor(1, degrees[k], 5, 0), 4.5);
      assert_sigma(tally_mean(&vertex[c]), tally_error(&vertex[c]), expected_factor(5, degrees[k], 5, 0.5), 4.5);
      assert_sigma(tally_mean(&loaded[c]), tally_error(&loaded[c]), expected_factor(1, degrees[k], 5, 0.5), 4.5);
    }
  }
}

/* Numbers that cannot be summed stop the run; velocities near the limit do not. */
static void range_faults(void **unused)
{
  (void)unused;
  const double bad[] = {NAN, -NAN, INFINITY, -INFINITY, 1e300, -1e19, 6e5, -6e5};
  for (int k = 0; k < 48; k++) {
    struct dice d = {dice_seed(306) + (uint64_t)k};
    struct model m = test_model(3, 3, 3, 1, 0.01, 2);
    test_add_kind(&m, 4, 1);
    struct test_run r = dice_run(m, &d);
    const double v = bad[k / 6];
    double *component[] = {&r.state.solvent.vx[3], &r.state.solvent.vy[0], &r.state.solvent.vz[26],
                           &r.state.velocity[3].x, &r.state.velocity[0].y, &r.state.velocity[1].z};
    *component[k % 6] = v;
    assert_false(mpc_collide(&r.state, &r.model, &r.work.mpc, 17, &r.work.fault));
    const bool solvent = k % 6 < 3;
    const int64_t who[] = {r.state.solvent.id[3], r.state.solvent.id[0], r.state.solvent.id[26], 3, 0, 1};
    assert_int_equal(r.work.fault.code, solvent ? FAULT_SOLVENT_SPEED : FAULT_VERTEX_SPEED);
    assert_true(r.work.fault.entity == who[k % 6]);
    assert_true(r.work.fault.step == 17);
    char text[512];
    fault_describe(&r.work.fault, text, sizeof text);
    assert_non_null(strstr(text, solvent ? "step 17: solvent particle" : "step 17: vertex"));
    test_end(&r);
  }
  struct dice d = {1};
  struct model m = test_model(3, 3, 3, 1, 0.01, 2);
  struct test_run r = dice_run(m, &d);
  r.state.solvent.vx[5] = 30000.0; /* 2^15 times 2^44, and not more than 16 members */
  assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 17, &r.work.fault));
  test_end(&r);
}

/* Sums that would wrap although each member fits: all in one cell, all in one direction. */
static void crowded_cells_fault_rather_than_wrap(void **unused)
{
  (void)unused;
  struct dice d = {2};
  for (int k = 0; k < 2; k++) {
    struct test_run r = dice_run(test_model(2, 2, 2, 512, 0.01, 2), &d);
    struct solvent *s = &r.state.solvent;
    for (uint32_t i = 0; i < s->n; i++) {
      s->x[i] = s->y[i] = s->z[i] = 12345;
      set_solvent_v(&r.state, i, (struct vec3){k ? 200.0 : 120.0, 0, 0}); /* 4096 x 128 x 2^44 = 2^63 */
    }
    assert_true(mpc_collide(&r.state, &r.model, &r.work.mpc, 1, &r.work.fault) == (k == 0));
    if (k == 0)
      for (uint32_t i = 0; i < s->n; i++)
        assert_close(s->vx[i], 120.0, 1e-12);
    test_end(&r);
  }
  struct model m = test_model(2, 2, 2, 1, 0.01, 2); /* mass 2^24 and more in one cell */
  test_add_kind(&m, 300, 1)->mass = 65536.0;
  struct test_run r = dice_run(m, &d);
  for (uint32_t v = 0; v < 300; v++) {
    r.state.position[v] = (struct point){99, 99, 99};
    r.state.velocity[v] = (struct vec3){0, 0, 0};
  }
  assert_false(mpc_collide(&r.state, &r.model, &r.work.mpc, 1, &r.work.fault));
  test_end(&r);
}

/* A vertex is in any image of the box, up to the range of positions. Its cell is that of a division in integers, at the
 * ends of images too, where the quotient of rows is a product that rounds: 49 times 1/49 is less than 1. */
static void vertices_are_in_any_image(void **unused)
{
  (void)unused;
  enum { IMAGES = 9, PLACES = 5, VERTICES = IMAGES * PLACES };
  struct point position[VERTICES];
  uint32_t cell[VERTICES];
  for (int edge = 1; edge <= LATTICE_MAX_EDGE; edge++) {
    struct model m = test_model(edge, edge, edge, 0.0, 0.01, 2);
    const int64_t far = (LATTICE_REACH - 2 * LATTICE_CELL) / m.box.edge[0];
    const int64_t image[IMAGES] = {0, 1, 2, 3, far, -1, -2, -3, -far};
    const int64_t place[PLACES] = {0, -1, LATTICE_CELL, 1 - LATTICE_CELL, -LATTICE_CELL};
    for (uint32_t v = 0; v < VERTICES; v++) {
      const int64_t x = image[v / PLACES] * m.box.edge[0] + place[v % PLACES];
      position[v] = (struct point){x, -x, image[(v + 7) % VERTICES / PLACES] * m.box.edge[0]};
    }
    const struct point shifts[] = {{0, 0, 0}, {1, LATTICE_CELL - 1, 12345}, {LATTICE_CELL - 1, 1, 0}};
    for (int k = 0; k < 3; k++) {
      struct mpc c = {.shift = shifts[k], .vertex_cell = cell};
      const struct state state = {.vertices = VERTICES, .position = position};
      grid_bin_vertices(&state, &m, &c);
      for (uint32_t v = 0; v < VERTICES; v++)
        assert_int_equal(cell[v], cell_by_floor(&m.box, position[v], shifts[k]));
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(grid_equals_plain_driver),
      cmocka_unit_test(lone_members_keep_their_velocities),
      cmocka_unit_test(cells_are_where_they_should_be),
      cmocka_unit_test(grid_shift_is_uniform),
      cmocka_unit_test(vertices_are_in_any_image),
      cmocka_unit_test(vertices_and_solvent_share_the_grid),
      cmocka_unit_test(factor_formula),
      cmocka_unit_test(one_step_factors),
      cmocka_unit_test(range_faults),
      cmocka_unit_test(crowded_cells_fault_rather_than_wrap),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
