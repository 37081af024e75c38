/* Forces of pairs against sums over all pairs that are written here, and against differences; what observers make of
 * them; the equation of state of DPD. */
#include "exact.h"
#include "medium/repulsion.h"
#include "observe/observe.h"
#include "statistics.h"

static const double pi = 3.14159265358979323846;

enum form { DPD, GROUPS, MANY, FORMS };

static struct model fluid(int edge, double density, double dt, enum form form)
{
  struct model m = test_model(edge, edge, edge, 0, dt, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_PAIRS,
                                   .rate = 9.0,
                                   .draw = DRAW_RELAX,
                                   .weight = WEIGHT_QUADRATIC,
                                   .density = density,
                                   .repulsion = form == MANY ? -40.0 : 25.0};
  if (form == GROUPS)
    m.medium.second.share = 0.5, m.medium.second.repulsion = 60.0;
  if (form == MANY)
    m.medium.many.repulsion = 25.0, m.medium.many.range = 0.75;
  m.crossing.forbidden = false;
  return m;
}

/* Few members: particles and one chain. */
static struct model small(enum form form, uint64_t seed)
{
  struct model m = fluid(3, 1.2, 0.01, form);
  struct fiber_kind *k = test_add_kind(&m, 2, 4);
  k->mass = 2.0;
  k->bending = 3.0;
  m.seed = seed;
  return m;
}

static double image(double x, double edge)
{
  return x - edge * nearbyint(x / edge);
}

static struct vec3 place(const struct test_run *r, uint32_t number)
{
  const struct solvent *s = &r->state.solvent;
  for (uint32_t i = 0; i < s->n; i++)
    if (s->id[i] == number)
      return point_in_a0((struct point){s->x[i], s->y[i], s->z[i]});
  return point_in_a0(r->state.position[number - s->n]);
}

/* U by its definition, over all pairs in O(n^2), with all distances times `scale`. */
static double energy(const struct test_run *r, double scale)
{
  const struct medium_model *m = &r->model.medium;
  const uint32_t n = r->state.solvent.n, all = n + r->state.vertices;
  double sum = 0.0;
  for (uint32_t i = 0; i < all; i++) {
    double density = 0.0;
    for (uint32_t j = 0; j < all; j++) {
      const struct vec3 a = place(r, i), b = place(r, j);
      const double x = image(a.x - b.x, r->model.box.cells[0]), y = image(a.y - b.y, r->model.box.cells[1]),
                   z = image(a.z - b.z, r->model.box.cells[2]), s = scale * sqrt(x * x + y * y + z * z);
      if (i == j)
        continue;
      const bool second = i >= m->second.first && i < n, other = j >= m->second.first && j < n;
      const double strength = m->second.share > 0.0 && second != other ? m->second.repulsion : m->repulsion;
      sum += s < 1.0 ? 0.25 * strength * (1.0 - s) * (1.0 - s) : 0.0;
      if (m->many.repulsion != 0.0 && s < m->many.range)
        density += 15.0 / (2.0 * pi * pow(m->many.range, 3)) * pow(1.0 - s / m->many.range, 2);
    }
    if (m->many.repulsion != 0.0)
      sum += pi * pow(m->many.range, 4) / 30.0 * m->many.repulsion * density * density;
  }
  return sum;
}

static void shift(struct test_run *r, uint32_t number, int axis, int64_t by)
{
  struct solvent *s = &r->state.solvent;
  if (number >= s->n) {
    struct point *p = &r->state.position[number - s->n];
    *(axis == 0 ? &p->x : axis == 1 ? &p->y : &p->z) += by;
    return;
  }
  for (uint32_t i = 0; i < s->n; i++)
    if (s->id[i] == number) {
      int64_t *x = axis == 0 ? s->x : axis == 1 ? s->y : s->z;
      x[i] = lattice_fold(x[i] + by, r->model.box.edge[axis]);
    }
}

static double along(struct vec3 v, int axis)
{
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* U as the definition has it; F = -grad U; sum of r.F = -dU/d ln scale; the Laplacian is the divergence of -F.
 * Differences over 2 h = 2^-23 a0: forces have a kink at 1 a0, and no pair should be that near to it. Rounding of U
 * leaves 1e-6, that of forces 2e-3 per coordinate. */
static void forces_are_gradients(void **unused)
{
  (void)unused;
  for (int form = 0; form < FORMS; form++) {
    struct test_run r = test_start(small((enum form)form, dice_seed(3301) + (uint64_t)form));
    const uint32_t all = r.state.solvent.n + r.state.vertices;
    const int64_t h = LATTICE_CELL >> 24;
    const double step = 2.0 * (double)h * LATTICE_UNIT;
    struct vec3 *force = calloc(all, sizeof *force), *moved = calloc(all, sizeof *moved);
    struct repulsion_sums sums, ignored;
    double worst = 0.0, laplacian = 0.0;
    assert_true(repulsion_measure(&r.state, &r.model, force, &sums));
    assert_close(sums.energy, energy(&r, 1.0), 1e-9 * (1.0 + fabs(sums.energy)));
    for (uint32_t i = 0; i < all; i++)
      for (int axis = 0; axis < 3; axis++) {
        shift(&r, i, axis, h);
        const double up = energy(&r, 1.0);
        assert_true(repulsion_measure(&r.state, &r.model, moved, &ignored));
        laplacian -= along(moved[i], axis) / step;
        shift(&r, i, axis, -2 * h);
        const double down = energy(&r, 1.0);
        assert_true(repulsion_measure(&r.state, &r.model, moved, &ignored));
        laplacian += along(moved[i], axis) / step;
        shift(&r, i, axis, h);
        worst = fmax(worst, fabs(along(force[i], axis) + (up - down) / step));
      }
    const double scaled = (energy(&r, 1.0 + 1e-6) - energy(&r, 1.0 - 1e-6)) / 2e-6;
    const double trace = sums.virial[STRESS_XX] + sums.virial[STRESS_YY] + sums.virial[STRESS_ZZ];
    print_message("  form %d: forces to %.1e kT/a0, r.F %.8g, -dU/dln s %.8g, laplacian %.8g, by differences %.8g\n",
                  form, worst, trace, -scaled, sums.laplacian, laplacian);
    assert_true(fabs(trace) > 1.0);
    assert_close(worst, 0.0, 1e-4);
    assert_close(trace, -scaled, 1e-5 * (1.0 + fabs(trace)));
    assert_close(laplacian, sums.laplacian, 1e-3 * (1.0 + fabs(sums.laplacian)));
    free(force);
    free(moved);
    test_end(&r);
  }
}

/* What one member gets is what its partners give: the sum of the forces in their own units is 0, to the bit. And the
 * order in memory does not matter. */
static void forces_cancel(void **unused)
{
  (void)unused;
  for (int form = 0; form < FORMS; form++) {
    struct test_run r = test_start(fluid(5, 3.0, 0.02, (enum form)form));
    test_steps(&r, 5);
    const uint32_t n = r.state.solvent.n;
    struct vec3 *force = calloc(n, sizeof *force), *same = calloc(n, sizeof *same);
    struct repulsion_sums sums, after;
    assert_true(repulsion_measure(&r.state, &r.model, force, &sums));
    int64_t total[3] = {0};
    for (uint32_t i = 0; i < n; i++)
      for (int axis = 0; axis < 3; axis++)
        total[axis] += (int64_t)(along(force[i], axis) * REPULSION_SCALE);
    for (int axis = 0; axis < 3; axis++)
      assert_int_equal(total[axis], 0);
    struct solvent *s = &r.state.solvent;
    for (uint32_t i = 0; i < n / 2; i++) {
      const uint32_t j = n - 1 - i;
      const struct point p = {s->x[i], s->y[i], s->z[i]};
      const uint32_t id = s->id[i];
      s->x[i] = s->x[j], s->y[i] = s->y[j], s->z[i] = s->z[j], s->id[i] = s->id[j];
      s->x[j] = p.x, s->y[j] = p.y, s->z[j] = p.z, s->id[j] = id;
    }
    assert_true(repulsion_measure(&r.state, &r.model, same, &after));
    assert_memory_equal(force, same, n * sizeof *force);
    assert_memory_equal(&sums, &after, sizeof sums);
    free(force);
    free(same);
    test_end(&r);
  }
}

/* --- observers -----------------------------------------------------------------------------------------------------
 */

enum { TIME, PRESSURE, XX, YY, ZZ, XY, POTENTIAL, SQUARE, LAPLACIAN, CONFIGURATIONAL, COLUMNS };

static bool keep_row(void *context, enum observable which, size_t columns, const double *values)
{
  double *row = context;
  const bool flat = which == OBSERVE_PRESSURE && columns == COLUMNS - 1;  /* without p_zz */
  const bool held = which == OBSERVE_PRESSURE && columns == COLUMNS - XY; /* without a pressure */
  assert_true(which != OBSERVE_PRESSURE || flat || held || columns == COLUMNS);
  for (size_t k = 0; k < columns && which == OBSERVE_PRESSURE; k++)
    row[flat && k >= ZZ ? k + 1 : held && k >= PRESSURE ? k + XY : k] = values[k];
  if (which == OBSERVE_PRESSURE)
    return true;
  memcpy(row + COLUMNS, values, 2 * sizeof *values);
  return true;
}

/* Temperatures are those of the step: velocities are taken back by half of one. */
static void velocities_of_the_step(void **unused)
{
  (void)unused;
  struct model m = fluid(5, 3.0, 0.04, DPD);
  test_add_kind(&m, 5, 4)->mass = 2.0;
  struct test_run r = test_start(m);
  const struct observe_plan plan = {.every[OBSERVE_TEMPERATURE] = 1};
  struct observers *o = observers_create(&plan, &r.model);
  double row[COLUMNS + 2], square = 0.0;
  const struct observe_sink sink = {keep_row, row};
  test_steps(&r, 20);
  const uint32_t n = r.state.solvent.n;
  struct vec3 *force = calloc(n + r.state.vertices, sizeof *force), sum = {0, 0, 0};
  struct repulsion_sums sums;
  assert_true(repulsion_measure(&r.state, &r.model, force, &sums));
  for (uint32_t i = 0; i < n; i++) {
    const struct vec3 v = vec3_add_scaled(solvent_velocity(&r.state.solvent, i), -0.02, force[r.state.solvent.id[i]]);
    square += vec3_dot(v, v);
    sum = vec3_add(sum, v);
  }
  assert_true(observers_sample(o, &r.model, &r.state, &sink));
  assert_close(row[COLUMNS + 1], square / (3.0 * n * (1.0 - 1.0 / r.model.total_mass)), 1e-9);
  assert_true(vec3_norm(sum) > 0.1); /* vertices have the rest of the momentum */
  free(force);
  observers_free(o);
  test_end(&r);
}

/* At the start particles, too, get their half kick: beside the same start without forces, velocities differ by F dt/2.
 */
static void the_first_half_kick(void **unused)
{
  (void)unused;
  struct model m = fluid(5, 3.0, 0.04, DPD), n = fluid(5, 3.0, 0.04, DPD);
  n.medium.repulsion = 0.0;
  struct test_run r = test_start(m), free_run = test_start(n);
  struct vec3 *force = calloc(r.state.solvent.n, sizeof *force);
  struct repulsion_sums sums;
  assert_true(repulsion_measure(&r.state, &r.model, force, &sums));
  for (uint32_t i = 0; i < r.state.solvent.n; i++) {
    assert_int_equal(r.state.solvent.id[i], free_run.state.solvent.id[i]);
    assert_close(r.state.solvent.vx[i], free_run.state.solvent.vx[i] + 0.02 * force[r.state.solvent.id[i]].x, 1e-13);
  }
  free(force);
  test_end(&r);
  test_end(&free_run);
}

/* The Laplacian of bonds and bends, in the coordinates of what is not held: minus the divergence of their forces, by
 * differences. */
static void laplacian_of_fibers(void **unused)
{
  (void)unused;
  for (int round = 0; round < 4; round++) {
    const bool flat = round % 2, held = round / 2;
    struct model m = test_model(8, 8, flat ? 1 : 8, 0, 0.01, 0);
    m.medium = (struct medium_model){.kind = MEDIUM_PRIVATE, .rate = 1.0};
    m.dimensions = flat ? 2 : 3;
    m.crossing.forbidden = false;
    m.seed = dice_seed(3302);
    test_add_kind(&m, 2, 6)->force = held ? (struct vec3){0, 0, 0} : (struct vec3){1.0, -2.0, 0.0};
    test_add_kind(&m, 1, 5)->ring = true;
    struct fiber_kind *gauss = test_add_kind(&m, 1, 4);
    gauss->bond_length = gauss->bending = 0.0;
    test_add_kind(&m, 1, 5)->held = held ? HELD_ENDS : HELD_NONE;
    struct fiber_kind *pinned = test_add_kind(&m, 1, 5);
    pinned->ring = true, pinned->held = held ? HELD_FIRST : HELD_NONE;
    struct test_run r = test_start(m);
    test_steps(&r, 200);
    const struct observe_plan plan = {.every[OBSERVE_PRESSURE] = 1};
    struct observers *o = observers_create(&plan, &r.model);
    double row[COLUMNS + 2], laplacian = 0.0, square = 0.0;
    const struct observe_sink sink = {keep_row, row};
    assert_true(observers_sample(o, &r.model, &r.state, &sink));
    const int64_t h = LATTICE_CELL >> 16;
    struct vec3 *force = r.work.fiber.force;
    for (uint32_t i = 0; i < r.state.vertices; i++)
      for (int axis = 0; axis < (flat ? 2 : 3) && !model_is_held(&r.model, i); axis++) {
        const struct vec3 outer = r.model.kind[r.model.fiber_kind_of[r.model.fiber_of[i]]].force;
        assert_true(fiber_forces(&r.state, &r.model, force, 0, &r.work.fault));
        square += pow(along(force[i], axis) - along(outer, axis), 2);
        shift(&r, i, axis, h);
        assert_true(fiber_forces(&r.state, &r.model, force, 0, &r.work.fault));
        laplacian -= along(force[i], axis);
        shift(&r, i, axis, -2 * h);
        assert_true(fiber_forces(&r.state, &r.model, force, 0, &r.work.fault));
        laplacian += along(force[i], axis);
        shift(&r, i, axis, h);
      }
    laplacian /= 2.0 * (double)h * LATTICE_UNIT;
    assert_close(row[LAPLACIAN] / laplacian, 1.0, 1e-6);
    assert_close(row[SQUARE] / square, 1.0, 1e-12);
    observers_free(o);
    test_end(&r);
  }
}

/* Gaussian chains in a private bath, with the bath between two half drifts: bonds are exact at any step, and so are
 * <|grad U|^2> = <laplacian> and the virial, minus the number of bonds each of three directions; p V = kT per chain. */
static void ideal_chains(void **unused)
{
  (void)unused;
  enum { CHAINS = 40, VERTICES = 8 };
  struct model m = test_model(30, 30, 30, 0, 0.1, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_PRIVATE, .rate = 2.0, .draw = DRAW_RELAX};
  m.scheme = SCHEME_DRIFT_SPLIT;
  m.crossing.forbidden = false;
  m.seed = dice_seed(3303);
  struct fiber_kind *k = test_add_kind(&m, CHAINS, VERTICES);
  k->mass = 1.0;
  k->bond_length = k->bending = 0.0;
  k->spring = 3.0;
  struct test_run r = test_start(m);
  const struct observe_plan plan = {.every[OBSERVE_PRESSURE] = 1};
  struct observers *o = observers_create(&plan, &r.model);
  double row[COLUMNS + 2];
  const struct observe_sink sink = {keep_row, row};
  struct sample conf = {0};
  for (int block = 0; block < 60; block++) {
    double sum = 0.0;
    for (int n = 0; n < 20; n++) {
      test_steps(&r, 10);
      assert_true(observers_sample(o, &r.model, &r.state, &sink));
      assert_close(row[LAPLACIAN], 18.0 * CHAINS * (VERTICES - 1), 1e-9);
      assert_close(row[SQUARE] / row[LAPLACIAN], row[CONFIGURATIONAL], 1e-14);
      assert_close(row[XX] + row[YY] + row[ZZ], 3.0 * row[PRESSURE], 1e-12);
      sum += row[CONFIGURATIONAL] / 20.0;
    }
    sample_add(&conf, sum);
  }
  assert_sigma(conf.mean, sample_error(&conf), 1.0, 4.0);
  observers_free(o);
  test_end(&r);
}

/* Groot and Warren's fluid: rho 3, a 25, gamma 4.5. Its pressure was measured by a program of its own: 23.65 +- 0.02 in
 * the limit of small steps. At dt 0.02 the step adds less than 0.02. Temperatures: 1, and a term in dt^2 that is below
 * 0.02 here; 4 standard errors more. */
static void equation_of_state(void **unused)
{
  (void)unused;
  struct model m = fluid(5, 3.0, 0.02, DPD);
  m.seed = dice_seed(3304);
  struct test_run r = test_start(m);
  const struct observe_plan plan = {.every[OBSERVE_PRESSURE] = 1, .every[OBSERVE_TEMPERATURE] = 1};
  struct observers *o = observers_create(&plan, &r.model);
  double row[COLUMNS + 2];
  const struct observe_sink sink = {keep_row, row};
  struct sample p = {0}, t = {0};
  struct ratio conf = {0};
  test_steps(&r, 500);
  for (int block = 0; block < 20; block++) {
    double sum[4] = {0.0};
    for (int n = 0; n < 20; n++) {
      test_steps(&r, 10);
      assert_true(observers_sample(o, &r.model, &r.state, &sink));
      const double values[] = {row[PRESSURE], row[COLUMNS + 1], row[SQUARE], row[LAPLACIAN]};
      for (int k = 0; k < 4; k++)
        sum[k] += values[k] / 20.0;
    }
    sample_add(&p, sum[0] + 1.0 / 125.0); /* kT/V: total momentum is fixed */
    sample_add(&t, sum[1]);
    ratio_add(&conf, sum[2], sum[3]);
  }
  print_message("  p %.3f +- %.3f, T %.4f +- %.4f, T_conf %.4f +- %.4f\n", p.mean, sample_error(&p), t.mean,
                sample_error(&t), ratio_value(&conf), ratio_error(&conf));
  assert_close(p.mean, 23.65, 4.0 * hypot(sample_error(&p), 0.02) + 0.02);
  assert_close(t.mean, 1.0, 4.0 * sample_error(&t) + 0.02);
  assert_close(ratio_value(&conf), 1.0, 4.0 * ratio_error(&conf) + 0.02);
  observers_free(o);
  test_end(&r);
}

/* Particles that do not repel stay an ideal gas in the bath: as many pairs nearer than s as chance makes, in every
 * draw. A bath that pulls with old velocities makes them gather. Counts of pairs in 40 states that are 2 t0 apart; 4.5
 * standard errors. */
static void ideal_gas(void **unused)
{
  (void)unused;
  for (int draw = 0; draw < MEDIUM_DRAWS; draw++) {
    struct model m = fluid(5, 3.0, 0.05, DPD);
    m.medium.repulsion = 0.0;
    m.medium.draw = (enum medium_draw)draw;
    m.seed = dice_seed(3305) + (uint64_t)draw;
    struct test_run r = test_start(m);
    struct sample near = {0};
    for (int k = 0; k < 40; k++) {
      test_steps(&r, 40);
      double pairs = 0.0;
      const struct solvent *s = &r.state.solvent;
      for (uint32_t i = 0; i < s->n; i++)
        for (uint32_t j = i + 1; j < s->n; j++) {
          const double x = image((double)(s->x[i] - s->x[j]) * LATTICE_UNIT, 5.0),
                       y = image((double)(s->y[i] - s->y[j]) * LATTICE_UNIT, 5.0),
                       z = image((double)(s->z[i] - s->z[j]) * LATTICE_UNIT, 5.0);
          pairs += x * x + y * y + z * z < 0.09;
        }
      sample_add(&near, pairs);
    }
    assert_sigma(near.mean, sample_error(&near), 0.5 * 375.0 * 374.0 * 4.0 / 3.0 * pi * 0.027 / 125.0, 4.5);
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_are_gradients),   cmocka_unit_test(forces_cancel),
      cmocka_unit_test(laplacian_of_fibers),    cmocka_unit_test(the_first_half_kick),
      cmocka_unit_test(velocities_of_the_step), cmocka_unit_test(ideal_chains),
      cmocka_unit_test(equation_of_state),      cmocka_unit_test(ideal_gas),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
