/* The bath of phantoms: whom a vertex collides with, and that nothing but the cells of the vertices matters. */
#include <gsl/gsl_randist.h>

#include "base/random.h"
#include "exact.h"
#include "mpc/grid.h"
#include "mpc/random_solvent.h"
#include "observe/conserved.h"

static struct model bath_in(int lx, int ly, int lz, double per_cell, uint32_t light, uint32_t heavy)
{
  struct model m = test_model(lx, ly, lz, per_cell, 0.02, 1);
  m.solvent.hydrodynamics = false;
  m.solvent.bath = BATH_PHANTOMS;
  m.flow = (struct vec3){0.25, -0.5, 1.0};
  test_add_kind(&m, heavy, 1);
  test_add_kind(&m, light, 1)->mass = 1.5;
  return m;
}

static struct model bath_model(double per_cell, uint32_t light, uint32_t heavy)
{
  return bath_in(4, 3, 5, per_cell, light, heavy);
}

static void turn_by(struct model *m, double degrees)
{
  m->solvent.rotation_angle = degrees;
}

/* --- phantoms ----------------------------------------------------------------------------------------------------- */

/* Counts of n against Poisson's law (GSL); the last class is all that is more. */
static void numbers_are_poisson(void **unused)
{
  (void)unused;
  enum { CLASSES = 13, DRAWS = 200000 };
  struct model m = bath_model(5.0, 1, 1);
  m.seed = dice_seed(701);
  double count[CLASSES] = {0.0}, chi2 = 0.0;
  for (uint32_t k = 0; k < DRAWS; k++) {
    const double n = random_solvent_phantoms(&m, k / 100, k % 100).mass;
    count[n < CLASSES - 1 ? (int)n : CLASSES - 1] += 1.0;
  }
  for (unsigned n = 0; n < CLASSES; n++) {
    const double chance = n < CLASSES - 1 ? gsl_ran_poisson_pdf(n, 5.0) : gsl_cdf_poisson_Q(CLASSES - 2, 5.0);
    chi2 += pow(count[n] - DRAWS * chance, 2.0) / (DRAWS * chance);
  }
  print_message("  chi^2 %.1f of %d degrees of freedom\n", chi2, CLASSES - 1);
  assert_true(gsl_cdf_chisq_Q(chi2, CLASSES - 1) > LEAST_CHANCE);
  model_free(&m);
}

/* Means of any size, drawn in parts or not: mean and variance are gamma; sqrt(2/n) is the scatter of a variance. */
static void numbers_of_any_mean(void **unused)
{
  (void)unused;
  static const double means[] = {1e-3, 0.7, 255.0, 256.5, 1000.0};
  enum { DRAWS = 20000 };
  for (size_t k = 0; k < sizeof means / sizeof *means; k++) {
    struct model m = bath_model(means[k], 1, 1);
    m.seed = dice_seed(702);
    struct tally n = {0}, squares = {0};
    for (uint32_t i = 0; i < DRAWS; i++) {
      const double x = random_solvent_phantoms(&m, 3, i).mass;
      tally_add(&n, x);
      tally_add(&squares, (x - means[k]) * (x - means[k]));
    }
    assert_sigma(tally_mean(&n), sqrt(means[k] / DRAWS), means[k], 5.0);
    assert_sigma(tally_mean(&squares), sqrt((2.0 * means[k] * means[k] + means[k]) / DRAWS), means[k], 5.0);
    model_free(&m);
  }
}

/* sqrt(n) (v - flow) is normal in each component, whatever n; and no two components, cells or steps are alike. */
static void velocities_are_maxwellian(void **unused)
{
  (void)unused;
  enum { DRAWS = 20000 };
  static double u[3][DRAWS];
  struct model m = bath_model(3.0, 1, 1);
  m.seed = dice_seed(703);
  size_t drawn = 0;
  double products[4] = {0.0};
  struct vec3 last = {0, 0, 0};
  for (uint32_t k = 0; drawn < DRAWS; k++) {
    const struct phantoms p = random_solvent_phantoms(&m, k / 50, k % 50);
    if (p.mass == 0.0)
      continue;
    const struct vec3 g = vec3_scale(sqrt(p.mass), vec3_sub(p.velocity, m.flow));
    u[0][drawn] = gsl_cdf_ugaussian_P(g.x);
    u[1][drawn] = gsl_cdf_ugaussian_P(g.y);
    u[2][drawn++] = gsl_cdf_ugaussian_P(g.z);
    const double pair[4] = {g.x * g.y, g.y * g.z, g.z * g.x, g.x * last.x};
    for (int i = 0; i < 4; i++)
      products[i] += pair[i] / sqrt(DRAWS);
    last = g;
  }
  for (int i = 0; i < 3; i++)
    assert_true(kolmogorov(u[i], DRAWS) < KOLMOGOROV_LIMIT);
  for (int i = 0; i < 4; i++)
    assert_close(products[i], 0.0, 5.0);
  model_free(&m);
}

/* --- a sheared box ------------------------------------------------------------------------------------------------ */

static struct model sheared_bath(double per_cell, uint32_t vertices, double rate)
{
  struct model m = bath_model(per_cell, vertices, vertices);
  m.flow = (struct vec3){0.25, 0, 1.0};
  m.crossing.forbidden = false;
  m.shear.rate = rate;
  return m;
}

/* Mean height of each cell's points, from the middle of the box, as the cell sees them: those whose shift takes them
 * beyond the edge belong to the image below. The points stand 1/64 a0 apart, so these are the heights of the cells'
 * middles to 1/128. */
static void heights_of_cells(const struct model *m, struct point shift, double height[60])
{
  enum { FINE = 64 };
  double n[60] = {0};
  memset(height, 0, 60 * sizeof *height);
  for (int64_t column = 0; column < 20; column++)
    for (int64_t k = 0; k < 3 * FINE; k++) {
      const int64_t y = k * (LATTICE_CELL / FINE);
      const struct point p = {column / 5 * LATTICE_CELL, y, column % 5 * LATTICE_CELL};
      const uint32_t cell = cell_by_floor(&m->box, p, shift);
      const int64_t image = floor_divide(y + shift.y, m->box.edge[1]);
      height[cell] += (double)(y - image * m->box.edge[1]) * LATTICE_UNIT - 1.5;
      n[cell] += 1.0;
    }
  for (int cell = 0; cell < 60; cell++)
    height[cell] /= n[cell];
}

/* Phantoms of a sheared box are those of a box at rest, moved by rate times height of their cell: none is random. The
 * rate of an oscillation is that of the middle of the interval that the collision ends, one seventh of a period. */
static void compare_with_bath_at_rest(double per_cell, int oscillates)
{
  const double rate = 1.5, pi = 3.14159265358979324;
  struct model still = sheared_bath(per_cell, 1, 0.0), flows = sheared_bath(per_cell, 1, rate);
  still.seed = flows.seed = dice_seed(709);
  still.solvent.collision_interval = flows.solvent.collision_interval = 2 * flows.time_step;
  flows.shear.period = oscillates ? 7 * flows.solvent.collision_interval : 0.0;
  test_finish(&still);
  test_finish(&flows);
  for (uint64_t collision = 1; collision <= 30; collision++) {
    const uint64_t step = 2 * collision;
    const double now = oscillates ? rate * cos(2.0 * pi * ((double)collision - 0.5) / 7.0) : rate;
    double height[60];
    heights_of_cells(&flows, grid_shift(&flows, step), height);
    for (uint32_t cell = 0; cell < 60; cell++) {
      const struct phantoms a = random_solvent_phantoms(&still, step, cell),
                            b = random_solvent_phantoms(&flows, step, cell);
      const struct vec3 flow = vec3_sub(b.velocity, a.velocity);
      assert_true(a.mass == b.mass);
      assert_close(flow.x, now * height[cell], fabs(now) / 128.0 + 1e-12);
      assert_close(fabs(flow.y) + fabs(flow.z), 0.0, 0.0);
    }
  }
  model_free(&still);
  model_free(&flows);
}

static void phantoms_flow_with_their_cell(void **unused)
{
  (void)unused;
  for (int oscillates = 0; oscillates < 2; oscillates++) {
    compare_with_bath_at_rest(0.2, oscillates);
    compare_with_bath_at_rest(5.0, oscillates);
  }
}

/* --- collisions --------------------------------------------------------------------------------------------------- */

/* What the rule says of a cell, in doubles: its members, phantoms last, turned by Rodrigues' formula. */
struct plain_cell {
  uint32_t member[64], members;
  struct phantoms phantoms;
};

static struct vec3 plain_turn(const struct model *m, struct vec3 w, struct vec3 n)
{
  const double c = m->solvent.cosine, s = m->solvent.sine;
  return vec3_add(vec3_add(vec3_scale(c, w), vec3_scale((1.0 - c) * vec3_dot(n, w), n)),
                  vec3_scale(s, vec3_cross(n, w)));
}

static void collide_plainly(const struct test_run *before, const struct test_run *after, const struct plain_cell *cell,
                            uint32_t number, uint64_t step)
{
  const struct model *m = &before->model;
  struct vec3 momentum = vec3_scale(cell->phantoms.mass, cell->phantoms.velocity), gained = {0, 0, 0};
  double mass = cell->phantoms.mass, energy = 0.0;
  for (uint32_t k = 0; k < cell->members; k++) {
    momentum = vec3_add_scaled(momentum, m->mass[cell->member[k]], before->state.velocity[cell->member[k]]);
    mass += m->mass[cell->member[k]];
  }
  const struct vec3 center = vec3_scale(1.0 / mass, momentum);
  const struct vec3 axis = random_axis(m->seed, RANDOM_ROTATION_AXIS, step, number);
  for (uint32_t k = 0; k < cell->members; k++) {
    const uint32_t v = cell->member[k];
    const struct vec3 old = before->state.velocity[v], now = after->state.velocity[v];
    const struct vec3 expected = vec3_add(center, plain_turn(m, vec3_sub(old, center), axis));
    assert_close(vec3_norm(vec3_sub(now, expected)), 0.0, 1e-12);
    gained = vec3_add_scaled(gained, m->mass[v], vec3_sub(now, old));
    energy += 0.5 * m->mass[v] * (vec3_dot(now, now) - vec3_dot(old, old));
  }
  /* what the vertices gain the phantoms lose */
  const struct vec3 left = vec3_sub(cell->phantoms.velocity, center), turned = plain_turn(m, left, axis);
  gained = vec3_add_scaled(gained, cell->phantoms.mass, vec3_sub(turned, left));
  const struct vec3 then = vec3_add(center, turned);
  energy +=
      0.5 * cell->phantoms.mass * (vec3_dot(then, then) - vec3_dot(cell->phantoms.velocity, cell->phantoms.velocity));
  assert_close(vec3_norm(gained), 0.0, 1e-11);
  assert_close(energy, 0.0, 1e-11);
}

/* Every cell of the box is gone through here; those without a vertex have no part in it. Returns lone vertices that met
 * nobody: their bits stay. */
static uint32_t compare_with_plain(const struct test_run *before, const struct test_run *after, uint64_t step)
{
  const struct model *m = &before->model;
  const struct point shift = grid_shift(m, step);
  uint32_t alone = 0;
  for (uint32_t number = 0; number < box_cell_count(&m->box); number++) {
    struct plain_cell cell = {.members = 0, .phantoms = random_solvent_phantoms(m, step, number)};
    for (uint32_t v = 0; v < m->vertices; v++)
      if (cell_by_floor(&m->box, before->state.position[v], shift) == number)
        cell.member[cell.members++] = v;
    if (cell.members == 1 && cell.phantoms.mass == 0.0) {
      const uint32_t v = cell.member[0];
      assert_memory_equal(&before->state.velocity[v], &after->state.velocity[v], sizeof(struct vec3));
      alone++;
    } else if (cell.members > 0) {
      collide_plainly(before, after, &cell, number, step);
    }
  }
  return alone;
}

/* In more occupied cells than are drawn at a time; those of the last blocks as well. */
static void collision_in_many_cells_is_the_plain_rule(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 4; k++) {
    struct dice d = {dice_seed(714) + k}, e = d;
    struct test_run before = dice_run(bath_in(7, 5, 6, 2.0, 200, 100), &d),
                    after = dice_run(bath_in(7, 5, 6, 2.0, 200, 100), &e);
    assert_true(random_solvent_collide(&after.state, &after.model, &after.work.mpc, 17 + k, &after.work.fault));
    assert_true(after.work.mpc.cells > 2 * 64 && after.work.mpc.cells % 64 != 0);
    compare_with_plain(&before, &after, 17 + k);
    test_end(&before);
    test_end(&after);
  }
}

static void collision_is_the_plain_rule(void **unused)
{
  (void)unused;
  static const double angles[] = {90.0, 130.0}, per_cell[] = {0.2, 5.0};
  uint32_t alone = 0;
  for (uint64_t k = 0; k < 80; k++) {
    struct dice d = {dice_seed(704) + k}, e = d;
    struct model m = bath_model(per_cell[k / 2 % 2], 20, k < 4 ? 1 : 40),
                 n = bath_model(per_cell[k / 2 % 2], 20, k < 4 ? 1 : 40);
    turn_by(&m, angles[k % 2]);
    turn_by(&n, angles[k % 2]);
    struct test_run before = dice_run(m, &d), after = dice_run(n, &e);
    assert_true(random_solvent_collide(&after.state, &after.model, &after.work.mpc, 17 + k, &after.work.fault));
    alone += compare_with_plain(&before, &after, 17 + k);
    test_end(&before);
    test_end(&after);
  }
  assert_true(alone > 100);
}

/* Vertices numbered otherwise have the same velocities, bit by bit: sums are integers, numbers belong to cells. */
static void numbering_does_not_matter(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(705)};
  struct model m = bath_model(2.0, 1, 150), n = bath_model(2.0, 1, 150);
  struct test_run a = dice_run(m, &d), b = dice_run(n, &d);
  uint32_t order[150];
  for (uint32_t v = 0; v < 150; v++)
    order[v] = v;
  dice_shuffle(&d, order, 150);
  for (uint32_t v = 0; v < 151; v++) {
    const uint32_t from = v < 150 ? order[v] : v;
    b.state.position[v] = a.state.position[from];
    b.state.velocity[v] = a.state.velocity[from];
  }
  for (uint64_t step = 1; step < 20; step++) {
    assert_true(random_solvent_collide(&a.state, &a.model, &a.work.mpc, step, &a.work.fault));
    assert_true(random_solvent_collide(&b.state, &b.model, &b.work.mpc, step, &b.work.fault));
  }
  for (uint32_t v = 0; v < 150; v++)
    assert_memory_equal(&b.state.velocity[v], &a.state.velocity[order[v]], sizeof(struct vec3));
  test_end(&a);
  test_end(&b);
}

/* Every occupied cell is listed once, and each vertex finds its own. */
static void occupied_cells_are_listed_once(void **unused)
{
  (void)unused;
  for (uint64_t k = 0; k < 60; k++) {
    struct dice d = {dice_seed(706) + k};
    struct test_run r = dice_run(bath_model(5.0, 1 + (uint32_t)(k * k) / 8, 1), &d);
    const struct point shift = grid_shift(&r.model, k);
    const struct mpc *c = &r.work.mpc;
    uint8_t vertices_in[60] = {0}, listed[60] = {0};
    random_solvent_bin(&r.state, &r.model, shift, &r.work.mpc);
    for (uint32_t v = 0; v < r.state.vertices; v++) {
      const uint32_t cell = cell_by_floor(&r.model.box, r.state.position[v], shift);
      assert_true(c->vertex_cell[v] < c->cells);
      assert_int_equal(c->occupied[c->vertex_cell[v]], cell);
      vertices_in[cell] = 1;
    }
    for (uint32_t i = 0; i < c->cells; i++)
      listed[c->occupied[i]]++;
    assert_memory_equal(listed, vertices_in, sizeof listed);
    test_end(&r);
  }
}

/* --- runs --------------------------------------------------------------------------------------------------------- */

/* From rest, vertices of two masses take up the bath's temperature, kT = 1, about its flow: <(v - u)^2> = 3/M. Blocks
 * of 50 collisions are longer than any memory, c = 0.68 for M = 5. The observed temperature is 1 too. */
static void vertices_take_the_baths_temperature(void **unused)
{
  (void)unused;
  struct model m = bath_model(5.0, 16, 16);
  m.crossing.forbidden = false;
  m.seed = dice_seed(707);
  struct test_run r = test_start(m);
  struct tally kt[2] = {{.n = 0.0}, {.n = 0.0}}, along = {0}, observed = {0};
  memset(r.state.velocity, 0, r.state.vertices * sizeof *r.state.velocity);
  test_steps(&r, 100);
  for (int block = 0; block < 300; block++) {
    double square[2] = {0.0, 0.0}, x = 0.0, t = 0.0;
    for (int k = 0; k < 50; k++) {
      test_steps(&r, 1);
      for (uint32_t v = 0; v < 32; v++) {
        const struct vec3 w = vec3_sub(r.state.velocity[v], r.model.flow);
        square[v >= 16] += r.model.mass[v] * vec3_dot(w, w) / 3.0 / 16.0 / 50.0;
        x += w.x / 32.0 / 50.0;
      }
      const struct motion motion = motion_measure(&r.model, &r.state, r.work.fiber.force);
      t += motion_temperatures(&r.model, &motion).vertex / 50.0;
    }
    tally_add(&kt[0], square[0]);
    tally_add(&kt[1], square[1]);
    tally_add(&along, x);
    tally_add(&observed, t);
  }
  assert_true(tally_error(&kt[0]) < 0.006 && tally_error(&kt[1]) < 0.006);
  assert_sigma(tally_mean(&kt[0]), tally_error(&kt[0]), 1.0, 4.5);
  assert_sigma(tally_mean(&kt[1]), tally_error(&kt[1]), 1.0, 4.5);
  assert_sigma(tally_mean(&along), tally_error(&along), 0.0, 4.5);
  assert_sigma(tally_mean(&observed), tally_error(&observed), 1.0, 4.5);
  test_end(&r);
}

/* Vertices are carried along by the flow of their height: what is left of v_x has no mean and no slope in the height
 * within the box, of which all are equally likely. The vertices cross the boundary many times. Blocks of 50 collisions
 * are longer than the memory of velocities. But slopes of 146 seeds scatter by 1.25 times the error that their blocks
 * give, for a reason that is not known. So 5 errors are 4 standard deviations, a false alarm once in 16,000 seeds. */
static void vertices_take_the_flow_of_a_sheared_box(void **unused)
{
  (void)unused;
  const double rate = 0.5;
  struct model m = sheared_bath(5.0, 16, rate);
  m.seed = dice_seed(710);
  struct test_run r = test_start(m);
  struct tally slope = {0}, mean = {0};
  test_steps(&r, 100);
  for (int block = 0; block < 400; block++) {
    double product = 0.0, square = 0.0, sum = 0.0;
    for (int k = 0; k < 50; k++) {
      test_steps(&r, 1);
      for (uint32_t v = 0; v < r.state.vertices; v++) {
        const int64_t y = r.state.position[v].y, edge = r.model.box.edge[1];
        const double w = r.state.velocity[v].x - r.model.flow.x - rate * ((double)y * LATTICE_UNIT - 1.5),
                     inside = (double)(y - floor_divide(y, edge) * edge) * LATTICE_UNIT - 1.5;
        product += w * inside;
        square += inside * inside;
        sum += w / r.state.vertices / 50.0;
      }
    }
    tally_add(&slope, product / square);
    tally_add(&mean, sum);
  }
  assert_true(tally_error(&slope) < 0.005 && tally_error(&mean) < 0.005);
  assert_sigma(tally_mean(&slope), tally_error(&slope), 0.0, 5.0);
  assert_sigma(tally_mean(&mean), tally_error(&mean), 0.0, 5.0);
  test_end(&r);
}

/* A run whose state is taken over by a new one, with work of its own, after any step ends in the same bits: nothing
 * else is remembered. In a step without collision, or with a box a thousand times as large, the bath has no part. */
static void only_the_state_is_remembered(void **unused)
{
  (void)unused;
  struct model m[2] = {bath_model(5.0, 30, 1), bath_model(5.0, 30, 1)};
  for (int k = 0; k < 2; k++) {
    m[k].solvent.collision_interval = 3 * m[k].time_step;
    m[k].kind[1].vertices = 10;
    m[k].kind[1].count = 3;
    m[k].kind[1].spring = 30.0;
  }
  struct test_run whole = test_start(m[0]), parts = test_start(m[1]);
  test_steps(&whole, 40);
  for (int k = 0; k < 40; k++) {
    work_free(&parts.work);
    assert_true(work_alloc(&parts.work, &parts.model));
    test_steps(&parts, 1);
  }
  assert_true(state_hash(&whole.state) == state_hash(&parts.state) && state_hash(&whole.state) != 0);
  test_end(&whole);
  test_end(&parts);
}

static uint64_t work_of_box(int edge)
{
  struct model m = bath_model(5.0, 10, 10);
  m.box = box_of_cells(edge, edge, edge);
  test_finish(&m);
  const uint64_t bytes = work_bytes(&m);
  model_free(&m);
  return bytes;
}

static void memory_is_that_of_the_vertices(void **unused)
{
  (void)unused;
  assert_true(work_of_box(8) == work_of_box(1024));
  assert_true(work_of_box(8) < 20 * 1000);
}

/* What the sums cannot hold stops the run, and names a vertex or the cell. */
static void range_is_checked(void **unused)
{
  (void)unused;
  struct dice d = {708};
  struct test_run r = dice_run(bath_model(5.0, 5, 5), &d);
  r.state.velocity[7] = (struct vec3){0.0, -0.9 * 262144.0 / 1.5, 0.0};
  assert_true(random_solvent_collide(&r.state, &r.model, &r.work.mpc, 4, &r.work.fault));
  r.state.velocity[7] = (struct vec3){0.0, -1.1 * 262144.0 / 1.5, 0.0};
  assert_false(random_solvent_collide(&r.state, &r.model, &r.work.mpc, 5, &r.work.fault));
  assert_int_equal(r.work.fault.code, FAULT_VERTEX_SPEED);
  const struct point shift = grid_shift(&r.model, 5);
  assert_int_equal(cell_by_floor(&r.model.box, r.state.position[r.work.fault.entity], shift),
                   cell_by_floor(&r.model.box, r.state.position[7], shift));
  test_end(&r);

  struct model heavy = bath_model(5.0, 1, 256);
  heavy.kind[0].mass = 65535.99;
  r = dice_run(heavy, &d);
  for (uint32_t v = 0; v < 257; v++)
    r.state.position[v] = r.state.position[0];
  assert_false(random_solvent_collide(&r.state, &r.model, &r.work.mpc, 5, &r.work.fault));
  assert_int_equal(r.work.fault.code, FAULT_CELL_MASS);
  assert_int_equal(r.work.fault.entity, cell_by_floor(&r.model.box, r.state.position[0], grid_shift(&r.model, 5)));
  test_end(&r);

  /* 256 of them are 3 m below the limit of 2^24 m: some 100 phantoms are too many. */
  heavy = bath_model(100.0, 1, 255);
  heavy.kind[0].mass = heavy.kind[1].mass = 65535.99;
  r = dice_run(heavy, &d);
  for (uint32_t v = 0; v < 256; v++)
    r.state.position[v] = r.state.position[0];
  assert_false(random_solvent_collide(&r.state, &r.model, &r.work.mpc, 5, &r.work.fault));
  assert_int_equal(r.work.fault.code, FAULT_CELL_MASS);
  assert_close(r.work.fault.limit, 0x1p24, 0.0);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_are_poisson),
      cmocka_unit_test(numbers_of_any_mean),
      cmocka_unit_test(velocities_are_maxwellian),
      cmocka_unit_test(phantoms_flow_with_their_cell),
      cmocka_unit_test(collision_is_the_plain_rule),
      cmocka_unit_test(collision_in_many_cells_is_the_plain_rule),
      cmocka_unit_test(numbering_does_not_matter),
      cmocka_unit_test(occupied_cells_are_listed_once),
      cmocka_unit_test(vertices_take_the_baths_temperature),
      cmocka_unit_test(vertices_take_the_flow_of_a_sheared_box),
      cmocka_unit_test(only_the_state_is_remembered),
      cmocka_unit_test(memory_is_that_of_the_vertices),
      cmocka_unit_test(range_is_checked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
