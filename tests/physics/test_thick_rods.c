/* Thick rods against known answers: their second virial coefficient, how often they touch, and the pressure of their
 * contacts (docs/thick.md). */
#include "../../validation/measure/rods.h"
#include "contact/laying.h"
#include "statistics.h"

/* --- pairs laid at random ----------------------------------------------------------------------------------------- */

struct pair_of_kinds {
  uint32_t vertices[2]; /* straight rods of one bond or more */
  double length[2], diameter[2];
  int angle; /* between them, degrees; -1: any */
};

static struct model two_rods(const struct pair_of_kinds *row)
{
  struct model m = test_model(6, 6, 6, 0, 0.01, 1); /* twice the reach of a pair, at least */
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  for (int k = 0; k < 2; k++) {
    struct fiber_kind *kind = test_add_kind(&m, 1, row->vertices[k]);
    kind->bond_length = row->length[k] / (row->vertices[k] - 1), kind->diameter = row->diameter[k];
    kind->bending = 0.0;
  }
  test_finish(&m);
  return m;
}

static void lay_rod(const struct model *m, struct point *at, uint32_t fiber, struct point start, struct vec3 rod)
{
  const uint32_t first = m->fiber_first[fiber], bonds = m->fiber_first[fiber + 1] - first - 1;
  for (uint32_t j = 0; j <= bonds; j++)
    at[first + j] = point_move(start, vec3_scale((double)j / bonds, rod));
}

/* Half the volume in which the two overlap, by the test of starting states, and its error. */
static double overlap_volume(const struct pair_of_kinds *row, struct dice *d, int draws, double *error)
{
  struct model m = two_rods(row);
  struct point at[32];
  double hits = 0.0;
  for (int n = 0; n < draws; n++) {
    struct laying l;
    struct vec3 rod[2] = {dice_direction(d), dice_direction(d)};
    if (row->angle >= 0) {
      const double angle = row->angle * ROD_PI / 180.0;
      struct vec3 across = vec3_cross(rod[0], rod[1]);
      across = vec3_scale(1.0 / vec3_norm(across), across);
      rod[1] = vec3_add_scaled(vec3_scale(cos(angle), rod[0]), sin(angle), vec3_cross(across, rod[0]));
    }
    assert_true(laying_begin(&l, &m));
    for (uint32_t k = 0; k < 2; k++)
      lay_rod(&m, at, k, dice_point(d, 3 * LATTICE_CELL, 3 * LATTICE_CELL, 3 * LATTICE_CELL),
              vec3_scale(row->length[k], rod[k]));
    assert_int_equal(laying_add(&l, at, 0), LAYING_FITS);
    hits += laying_add(&l, at, 1) == LAYING_OVERLAPS;
    laying_end(&l);
  }
  const double share = hits / draws, volume = 0.5 * box_volume(&m.box);
  *error = volume * sqrt(share * (1.0 - share) / draws);
  model_free(&m);
  return volume * share;
}

/* Half of 2 R |p x q| + pi R^2 (|p| + |q|) + (4/3) pi R^3, R half the sum of the diameters: exact, and pi/4 for the
 * sine in the mean over all directions. 4.5 errors: one false alarm in 10^5 for each row. */
static void overlaps_fill_their_volume(void **unused)
{
  (void)unused;
  static const struct pair_of_kinds rows[] = {
      {{2, 2}, {1.0, 1.0}, {0.5, 0.5}, -1},   {{2, 2}, {2.5, 2.5}, {0.5, 0.5}, -1},
      {{2, 2}, {2.0, 2.0}, {0.02, 0.02}, -1}, {{2, 2}, {1.5, 0.8}, {0.2, 0.6}, -1},
      {{6, 6}, {2.5, 2.5}, {0.2, 0.2}, -1},   {{2, 2}, {2.0, 2.0}, {0.5, 0.5}, 0},
      {{2, 2}, {2.0, 2.0}, {0.5, 0.5}, 30},   {{2, 3}, {2.0, 2.0}, {0.5, 0.0}, 90},
  };
  struct dice d = {dice_seed(1911)};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    const struct pair_of_kinds *r = &rows[k];
    double error;
    const double measured = overlap_volume(r, &d, 1000000, &error), reach = 0.5 * (r->diameter[0] + r->diameter[1]);
    const double sine = r->angle < 0 ? ROD_PI / 4.0 : sin(r->angle * ROD_PI / 180.0);
    const double expected = r->length[0] * r->length[1] * sine * reach +
                            0.5 * ROD_PI * reach * reach * (r->length[0] + r->length[1]) +
                            2.0 / 3.0 * ROD_PI * pow(reach, 3);
    print_message("  l %g, %g  D %g, %g  angle %d: %.4f +- %.4f a0^3, exact %.4f\n", r->length[0], r->length[1],
                  r->diameter[0], r->diameter[1], r->angle, measured, error, expected);
    assert_sigma(measured, error, expected, 4.5);
    if (r->angle < 0 && r->length[0] == r->length[1])
      assert_close(expected, rod_b2(r->length[0], reach), 1e-12);
  }
}

/* --- rods in flight ----------------------------------------------------------------------------------------------- */

struct rod_answers {
  struct ratio ends[3], virial, all; /* measured over expected */
};

static void watch_rods(struct test_run *r, double time, struct rod_answers *a)
{
  const struct fiber_kind *k = &r->model.kind[0];
  const double n = r->model.fibers, volume = box_volume(&r->model.box), length = rod_length_moment(k, 1),
               phi = n * rod_volume(length, k->diameter) / volume, g = rod_contact_value(phi), d = k->diameter;
  const struct rod_rates rates = rod_rates_expected(k);
  const uint64_t steps = (uint64_t)(time / r->model.time_step + 0.5);
  struct rod_watch w = {.model = &r->model, .state = &r->state};
  const struct contact_log log = {rod_record, &w};
  double speed = 0.0, heat = 0.0, expected[3];
  for (uint64_t s = 0; s < steps; s++) {
    assert_true(step_advance(&r->state, &r->model, &r->work, &log));
    const double kt = rod_temperature(&r->state, &r->model);
    speed += sqrt(kt) / (double)steps, heat += kt / (double)steps;
  }
  for (int e = 0; e < 3; e++) {
    expected[e] = 0.5 * n * (n - 1.0) / volume * rates.by_ends[e] * g * speed * time;
    ratio_add(&a->ends[e], w.contacts[e], expected[e]);
  }
  ratio_add(&a->all, w.contacts[0] + w.contacts[1] + w.contacts[2], expected[0] + expected[1] + expected[2]);
  ratio_add(&a->virial, w.virial / (3.0 * time), n * (n - 1.0) / volume * rod_b2(length, d) * g * heat);
}

static struct rod_answers rods_in_flight(double diameter, uint32_t count, int edge, int runs, double time)
{
  struct rod_answers a = {.all = {0}};
  for (int run = 0; run < runs; run++) {
    struct model m = test_model(edge, edge, edge, 0, 0.005, 1);
    m.crossing.rule = CROSSING_EVENT_DRIVEN, m.seed = dice_seed(1912) + (uint64_t)run;
    struct fiber_kind *k = test_add_kind(&m, count, 2);
    k->bond_length = 1.0, k->spring = 400.0, k->bending = 0.0, k->diameter = diameter;
    struct test_run r = test_start(m);
    watch_rods(&r, time, &a);
    test_end(&r);
  }
  print_message("  D %-6g %6.0f contacts, over expected: %.4f +- %.4f; side on side %.4f +- %.4f", diameter, a.all.x,
                ratio_value(&a.all), ratio_error(&a.all), ratio_value(&a.ends[0]), ratio_error(&a.ends[0]));
  for (int e = 1; e < 3 && diameter > 0.0; e++)
    print_message(e == 1 ? ", end on side %.4f +- %.4f" : ", end on end %.4f +- %.4f", ratio_value(&a.ends[e]),
                  ratio_error(&a.ends[e]));
  print_message("\n");
  if (diameter > 0.0)
    print_message("           pressure of contacts over expected: %.4f +- %.4f\n", ratio_value(&a.virial),
                  ratio_error(&a.virial));
  return a;
}

/* Rates of each kind of contact, for lines (D = 0), in the limit of thin tubes, and for thick ones; and the pressure of
 * contacts against B2. 5.2 errors of 20 runs: one false alarm in 20,000 each (Student's t). */
static void rods_touch_as_often_and_as_hard_as_they_should(void **unused)
{
  (void)unused;
  static const struct {
    double diameter;
    uint32_t count;
    int edge;
    double time;
  } rows[] = {{0.0, 400, 12, 20}, {1e-3, 400, 12, 20}, {0.1, 200, 12, 60}, {0.5, 200, 20, 60}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    const struct rod_answers a = rods_in_flight(rows[k].diameter, rows[k].count, rows[k].edge, 20, rows[k].time);
    assert_true(ratio_error(&a.all) < 0.03);
    assert_sigma(ratio_value(&a.all), ratio_error(&a.all), 1.0, 5.2);
    assert_sigma(ratio_value(&a.ends[0]), ratio_error(&a.ends[0]), 1.0, 5.2);
    if (rows[k].diameter < 0.1)
      continue;
    for (int e = 1; e < 3; e++)
      assert_sigma(ratio_value(&a.ends[e]), ratio_error(&a.ends[e]), 1.0, 5.2);
    assert_sigma(ratio_value(&a.virial), ratio_error(&a.virial), 1.0, 5.2);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(overlaps_fill_their_volume),
                                     cmocka_unit_test(rods_touch_as_often_and_as_hard_as_they_should)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
