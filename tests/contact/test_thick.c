/* Thick fibers in runs: no tubes ever overlap, whatever moves them; contacts keep what they must; and starts. Distances
 * are those of tubes.h, of all pairs, without lists. */
#include "contact/tubes.h"

#include "contact/laying.h"
#include "contact/rule.h"

/* --- all distances ------------------------------------------------------------------------------------------------ */

/* The pair of bonds with the deepest overlap: the distance of its axes less the reach, a0. */
struct closest {
  double gap;
  uint64_t looked;
};

/* Bonds of a fiber that share a vertex do not see each other, nor those with a bond between them if D > 0.6366 of its
 * mean length (pi D/2 along it), or more than this length less 3 times the width of its spring. */
static bool see_each_other(const struct model *m, uint32_t a, uint32_t b)
{
  if (m->fiber_of[a] != m->fiber_of[b])
    return true;
  const struct fiber_kind *k = &m->kind[m->fiber_kind_of[m->fiber_of[a]]];
  const uint32_t between = a > b ? a - b : b - a, around = k->ring ? k->vertices - between : between,
                 least = between < around ? between : around;
  const double l0 = k->bond_length, square = 1.0 / k->spring,
               mean = (l0 * l0 * l0 + 3.0 * l0 * square) / (l0 * l0 + square); /* of l^2 exp(-k (l - l0)^2/2) */
  return least >= (k->diameter < 0.6366 * mean && k->diameter < mean - 3.0 * sqrt(square) ? 2u : 3u);
}

static void look_at_pair(const struct test_run *r, uint32_t a, uint32_t b, struct closest *c)
{
  const struct model *m = &r->model;
  const double reach =
      0.5 * (m->kind[m->fiber_kind_of[m->fiber_of[a]]].diameter + m->kind[m->fiber_kind_of[m->fiber_of[b]]].diameter);
  const struct point *at = r->state.position;
  const struct vec3 p = point_difference(at[m->next[a]], at[a]), q = point_difference(at[m->next[b]], at[b]);
  struct point w = point_minus(at[b], at[a]);
  int64_t *along[3] = {&w.x, &w.y, &w.z};
  for (int k = 0; k < 3; k++)
    *along[k] -= m->box.edge[k] * llrint((double)*along[k] / (double)m->box.edge[k]);
  if (reach == 0.0 || vec3_norm(point_in_a0(w)) > vec3_norm(p) + vec3_norm(q) + reach)
    return;
  const struct flight_pair pair = {
      .p = point_minus(at[m->next[a]], at[a]), .q = point_minus(at[m->next[b]], at[b]), .w = w};
  c->looked++;
  c->gap = fmin(c->gap, (double)axes_distance(&pair, 0.0L) - reach);
}

/* Of the nearest images, by their first vertices: boxes are wider than two bonds and a reach. */
static struct closest closest_of(const struct test_run *r)
{
  const struct model *m = &r->model;
  struct closest c = {1e9, 0};
  for (uint32_t a = 0; a < m->vertices; a++)
    for (uint32_t b = a + 1; m->next[a] >= 0 && b < m->vertices; b++)
      if (m->next[b] >= 0 && see_each_other(m, a, b))
        look_at_pair(r, a, b, &c);
  return c;
}

/* --- runs --------------------------------------------------------------------------------------------------------- */

static struct fiber_kind *add_thick(struct model *m, uint32_t count, uint32_t vertices, double diameter)
{
  struct fiber_kind *k = test_add_kind(m, count, vertices);
  m->crossing.rule = CROSSING_EVENT_DRIVEN;
  k->diameter = diameter;
  return k;
}

/* Two thicknesses, thin lines, rings and flexible chains in one small box. */
static struct model many_kinds(double per_cell, uint64_t seed)
{
  struct model m = test_model(6, 6, 6, per_cell, 0.01, 2);
  m.seed = seed;
  m.solvent.thermostat = per_cell > 0.0 ? THERMOSTAT_RESCALE : THERMOSTAT_NONE;
  add_thick(&m, 10, 8, 0.25);
  add_thick(&m, 10, 2, 0.5)->bending = 0.0;
  struct fiber_kind *k = add_thick(&m, 6, 10, 0.1);
  k->ring = true, k->bending = 2.0;
  add_thick(&m, 20, 8, 0.0);
  k = add_thick(&m, 6, 12, 0.3);
  k->bending = 0.0, k->mass = 2.0;
  return m;
}

static void no_tubes_overlap_in_a_run(void **unused)
{
  (void)unused;
  for (int solvent = 0; solvent < 2; solvent++) {
    struct test_run r = test_start(many_kinds(solvent ? 5.0 : 0.0, dice_seed(1903)));
    struct closest all = closest_of(&r);
    assert_true(all.gap > 0.0);
    for (int step = 0; step < 2500; step++) {
      test_steps(&r, 1);
      const struct closest now = closest_of(&r);
      all.gap = fmin(all.gap, now.gap), all.looked += now.looked;
      if (!(now.gap > -1e-14))
        fail_msg("step %d: an overlap of %g a0", step + 1, -now.gap);
    }
    print_message("  %lu contacts, %lu rigid; %lu pairs near; the least gap %.2g a0\n",
                  (unsigned long)r.state.counts.executed, (unsigned long)r.state.counts.rigid,
                  (unsigned long)all.looked, all.gap);
    assert_true(r.state.counts.executed > 1000 && all.looked > 1000000 && all.gap < 1e-5);
    assert_true(r.state.counts.rigid < r.state.counts.executed / 100);
    test_end(&r);
  }
}

/* --- what contacts keep --------------------------------------------------------------------------------------------
 */

static struct vec3 angular_momentum(const struct test_run *r)
{
  struct vec3 sum = {0, 0, 0};
  for (uint32_t i = 0; i < r->model.vertices; i++)
    sum = vec3_add_scaled(sum, r->model.mass[i], vec3_cross(point_in_a0(r->state.position[i]), r->state.velocity[i]));
  return sum;
}

/* What the log has of contacts: how far from the reach they were, and how far the normal from the shortest line. */
struct seen {
  const struct test_run *run;
  uint64_t contacts;
  double worst;
};

static void see(void *context, const struct contact_event *e)
{
  struct seen *s = context;
  s->contacts++;
  s->worst = fmax(s->worst, fabs(vec3_norm(e->hit.normal) - 1.0));
  assert_true(e->impulse > 0.0);
  assert_true(e->hit.s >= 0.0 && e->hit.s <= 1.0 && e->hit.s_standing >= 0.0 && e->hit.s_standing <= 1.0);
}

/* Fibers alone, in the middle of a wide box: pushes along the line of the nearest points keep the angular momentum, as
 * drifts and forces do. Places are rounded to 2^-25 a0 in a drift, at random: 1e-7 per step is ample room, and a push
 * with a lever or a direction that is wrong by 1 % would change it by 1e-2 at each contact. */
static void contacts_keep_momentum_and_angular_momentum(void **unused)
{
  (void)unused;
  struct model m = test_model(32, 32, 32, 0, 0.005, 1);
  m.seed = dice_seed(1904);
  struct fiber_kind *k = add_thick(&m, 36, 3, 0.3);
  k->start = START_STRAIGHT, k->placed = 36, k->place = calloc(36, sizeof *k->place);
  struct dice d = {dice_seed(1905)};
  for (int n = 0; n < 36; n++) {
    k->place[n].center = (struct vec3){15.0 + 0.6 * (n % 6), 15.0 + 0.6 * (n / 6), 16.0};
    k->place[n].direction = (struct vec3){0.2 * dice_between(&d, -1, 1), 0.2 * dice_between(&d, -1, 1), 1.0};
  }
  struct test_run r = test_start(m);
  const struct vec3 start = angular_momentum(&r);
  struct seen seen = {&r, 0, 0.0};
  const struct contact_log log = {see, &seen};
  for (int step = 0; step < 1000; step++)
    assert_true(step_advance(&r.state, &r.model, &r.work, &log));
  struct vec3 sum = {0, 0, 0};
  for (uint32_t i = 0; i < r.model.vertices; i++)
    sum = vec3_add_scaled(sum, r.model.mass[i], r.state.velocity[i]);
  const double change = vec3_norm(vec3_sub(angular_momentum(&r), start));
  print_message("  %lu contacts; L = %.3g changed by %.2g, P by %.2g\n", (unsigned long)seen.contacts, vec3_norm(start),
                change, vec3_norm(sum));
  assert_true(seen.contacts > 30);
  assert_true(seen.worst < 1e-14);
  assert_close(vec3_norm(sum), 0.0, 1e-11);
  assert_close(change, 0.0, 1e-4);
  test_end(&r);
}

/* Two equal rods, parallel, side on: they exchange their velocities when their axes are D apart. */
static void a_head_on_contact_by_hand(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.01, 1);
  struct fiber_kind *k = add_thick(&m, 2, 2, 0.25);
  k->bending = 0.0, k->start = START_STRAIGHT, k->placed = 2, k->place = calloc(2, sizeof *k->place);
  k->place[0] = (struct fiber_place){{4, 4, 4}, {0, 0, 1}};
  k->place[1] = (struct fiber_place){{4.5, 4, 4}, {0, 0, 1}};
  struct test_run r = test_start(m);
  const double speed[4] = {2.0, 2.0, -1.0, -1.0};
  for (int i = 0; i < 4; i++)
    r.state.velocity[i] = (struct vec3){speed[i], 0, 0};
  test_steps(&r, 8); /* they meet at 0.25/3 = 0.0833 */
  assert_int_equal(r.state.counts.executed, 0);
  test_steps(&r, 1);
  assert_int_equal(r.state.counts.executed, 1);
  for (int i = 0; i < 4; i++)
    assert_close(r.state.velocity[i].x, i < 2 ? -1.0 : 2.0, 1e-9);
  /* 4 + 2 t until the contact, then back with 1: t_c = 1/12 */
  const double met = 0.25 / 3.0;
  assert_close((double)r.state.position[0].x * LATTICE_UNIT, 4.0 + 2.0 * met - (0.09 - met), 1e-6);
  assert_close((double)r.state.position[2].x * LATTICE_UNIT, 4.5 - met + 2.0 * (0.09 - met), 1e-6);
  test_end(&r);
}

static void kick_back(struct test_run *r)
{
  assert_true(fiber_forces(&r->state, &r->model, r->work.fiber.force, 0, &r->work.fault));
  for (uint32_t i = 0; i < r->model.vertices; i++)
    r->state.velocity[i] =
        vec3_scale(-1.0, vec3_add_scaled(r->state.velocity[i], -r->model.time_step * r->model.inverse_mass[i],
                                         r->work.fiber.force[i]));
}

/* As in test_event_driven.c: a tick's motion at each contact, grown tenfold at most. Round tubes defocus: a place that
 * is off by e turns the push by e/D, so errors grow faster than those of lines. */
static void drifts_of_tubes_run_backwards(void **unused)
{
  (void)unused;
  uint64_t contacts = 0;
  double worst = 0.0;
  for (int start = 0; start < 16; start++) {
    struct test_run r = test_start(many_kinds(0.0, dice_seed(1906) + (uint64_t)start));
    struct point *first = malloc(r.model.vertices * sizeof *first);
    memcpy(first, r.state.position, r.model.vertices * sizeof *first);
    test_steps(&r, 20);
    contacts += r.state.counts.executed;
    kick_back(&r);
    test_steps(&r, 20);
    for (uint32_t i = 0; i < r.model.vertices; i++)
      worst = fmax(worst, vec3_norm(point_difference(r.state.position[i], first[i])));
    free(first);
    test_end(&r);
  }
  print_message("  %lu contacts, back within %.2g a0\n", (unsigned long)contacts, worst);
  assert_true(contacts > 100);
  assert_true(worst < 1e-4);
}

/* --- the thin limit ----------------------------------------------------------------------------------------------- */

/* Bonds that cross, ever thinner tubes around them: contacts come before those of lines, by about the time in which the
 * reach is flown, and in the limit at the same tick. */
static void thin_tubes_meet_as_lines_do(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1907)};
  uint64_t hits = 0, lines = 0;
  double wait[3] = {0, 0, 0};
  for (int n = 0; n < 20000; n++) {
    struct tube_query k = draw_tubes(&d, TUBE_SIDES);
    k.from = 0;
    const int32_t line = axes_distance(&k.pair, 0.0L) > 2e-2L ? flight_contact(&k.pair, 0) : 0;
    if (line == 0)
      continue;
    lines += line < FLIGHT_TICKS;
    for (int thin = 0; thin < 3; thin++) {
      const double reach = (double[]){1e-2, 1e-3, 1e-4}[thin];
      const int32_t tick = tube_contact(&k.pair, llrint(reach * 0x1p40), 0);
      assert_true(tick <= line); /* no bond crosses another one before the tubes around them meet */
      if (line < FLIGHT_TICKS)
        wait[thin] += fmin(line - tick, 30000);
      hits += tick < FLIGHT_TICKS && thin == 2;
    }
  }
  print_message("  %lu crossings, %lu contacts of the thinnest; ticks between: %.0f, %.0f, %.0f\n",
                (unsigned long)lines, (unsigned long)hits, wait[0] / (double)lines, wait[1] / (double)lines,
                wait[2] / (double)lines);
  assert_true(lines > 1000 && hits < 11 * lines / 10);
  assert_true(wait[1] < 0.3 * wait[0] && wait[2] < 0.2 * wait[1]);
}

/* --- starts ------------------------------------------------------------------------------------------------------- */

static bool starts(struct model m, struct test_run *r)
{
  *r = (struct test_run){.model = m};
  test_finish(&r->model);
  assert_true(state_alloc(&r->state, &r->model) && work_alloc(&r->work, &r->model));
  return start_state(&r->state, &r->model, &r->work);
}

/* At random: as dense as 100000 draws for each fiber allow. Every start is looked at by all pairs. */
static void random_starts_do_not_overlap(void **unused)
{
  (void)unused;
  for (int n = 0; n < 40; n++) {
    struct model m = test_model(6, 8, 16, 0, 0.01, 1);
    m.seed = dice_seed(1908) + (uint64_t)n;
    add_thick(&m, 30, 9, 0.1 + 0.01 * n);
    add_thick(&m, 10, 20, 0.02)->bending = 0.0;
    struct test_run r = test_start(m);
    const struct closest c = closest_of(&r);
    assert_true(c.looked > 1000 && c.gap > 0.0);
    test_end(&r);
  }
}

/* Two crossed rods, so far apart; across the box's edge as well. */
static bool two_rods_start(double apart, double at, double diameter)
{
  struct model m = test_model(8, 8, 8, 0, 0.01, 1);
  struct fiber_kind *k = add_thick(&m, 2, 5, diameter);
  k->start = START_STRAIGHT, k->placed = 2, k->place = calloc(2, sizeof *k->place);
  k->place[0] = (struct fiber_place){{at, 4, 4}, {0, 0, 1}};
  k->place[1] = (struct fiber_place){{at + apart, 4, 4}, {0, 1, 0}};
  struct test_run r;
  const bool ok = starts(m, &r);
  if (!ok) {
    assert_int_equal(r.work.fault.code, FAULT_OVERLAP);
    assert_close(r.work.fault.value, fabs(apart), 1e-9);
    assert_close(r.work.fault.limit, diameter, 1e-9);
  } else {
    assert_true(start_sound(&r.state, &r.model, &r.work.fault));
    r.state.position[0].x = r.state.position[5].x, r.state.position[1].x = r.state.position[5].x;
    r.state.position[0].z -= 0x1p39, r.state.position[1].z += 0x1p40;
    memcpy(&r.state.position[5], &r.state.position[0], 2 * sizeof *r.state.position);
    assert_true(!start_sound(&r.state, &r.model, &r.work.fault) && r.work.fault.code == FAULT_OVERLAP);
  }
  test_end(&r);
  return ok;
}

static void placed_starts_are_judged(void **unused)
{
  (void)unused;
  for (int k = 0; k < 32; k++) { /* wherever the pair is, relative to the cells of the search */
    const double at = 0.25 * k;
    assert_true(two_rods_start(0.3000001, at, 0.3) && two_rods_start(-0.3000001, at, 0.3));
    assert_false(two_rods_start(0.2999999, at, 0.3) || two_rods_start(-0.2999999, at, 0.3));
  }
}

/* A rod that is longer than the box meets its own image if it runs along an edge, and lies beside it if it is tilted.
 */
static void images_of_a_fiber_are_others(void **unused)
{
  (void)unused;
  for (int tilted = 0; tilted < 2; tilted++) {
    struct model m = test_model(6, 6, 6, 0, 0.01, 1);
    struct fiber_kind *k = add_thick(&m, 1, 20, 0.2);
    k->start = START_STRAIGHT, k->placed = 1, k->place = calloc(1, sizeof *k->place);
    k->place[0] = (struct fiber_place){{3, 3, 3}, {0, tilted ? 0.2 : 0.0, 1}};
    struct test_run r;
    assert_int_equal(starts(m, &r), tilted);
    test_end(&r);
  }
}

/* A fiber that overlaps leaves the cells as they were: it is drawn anew, and its old place is nobody's. */
static void a_refused_fiber_leaves_no_entry(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.01, 1);
  struct fiber_kind *k = add_thick(&m, 2, 5, 0.3);
  k->start = START_STRAIGHT, k->placed = 2, k->place = calloc(2, sizeof *k->place);
  k->place[0] = (struct fiber_place){{4, 4, 4}, {0, 0, 1}};
  k->place[1] = (struct fiber_place){{5, 4, 4}, {0, 1, 0}};
  struct test_run r;
  assert_true(starts(m, &r));
  struct laying laying;
  assert_true(laying_begin(&laying, &r.model));
  assert_int_equal(laying_add(&laying, r.state.position, 0), LAYING_FITS);
  const uint32_t before = laying.count;
  for (uint32_t v = 5; v < 10; v++) /* the middle of it is in the first rod then */
    r.state.position[v].x -= 0x1p40;
  assert_int_equal(laying_add(&laying, r.state.position, 1), LAYING_OVERLAPS);
  assert_int_equal(laying.count, before);
  for (uint32_t cell = 0; cell < (uint32_t)(laying.cells[0] * laying.cells[1] * laying.cells[2]); cell++)
    assert_true(laying.first[cell] <= before);
  for (uint32_t v = 5; v < 10; v++)
    r.state.position[v].x += 0x1p40;
  assert_int_equal(laying_add(&laying, r.state.position, 1), LAYING_FITS);
  assert_true(laying.count > before);
  laying_end(&laying);
  test_end(&r);
}

static void there_is_no_room(void **unused)
{
  (void)unused;
  struct model m = test_model(6, 6, 6, 0, 0.01, 1);
  add_thick(&m, 4000, 2, 0.5)->bending = 0.0;
  struct test_run r;
  assert_false(starts(m, &r));
  assert_int_equal(r.work.fault.code, FAULT_NO_ROOM);
  /* rods of 0.6 and 0.5 fill more than a tenth of the box before the next finds no room, and less than all of it */
  const double volume = (3.14159 / 4 * 0.25 * sqrt(0.28) + 3.14159 / 6 * 0.125) * (double)r.work.fault.entity / 216.0;
  print_message("  volume fraction %.3f\n", volume);
  assert_true(volume > 0.2 && volume < 0.6);
  test_end(&r);
}

/* --- what a scene may ask for --------------------------------------------------------------------------------------
 */

static const char *refusal(struct model m)
{
  static struct model_error error;
  error.text[0] = 0;
  if (model_finish(&m, &error))
    error.text[0] = 0;
  model_free(&m);
  return error.text;
}

static struct model plain_thick(double diameter)
{
  struct model m = test_model(8, 8, 8, 5, 0.01, 2);
  add_thick(&m, 1, 8, diameter);
  return m;
}

static void wrong_models_are_refused(void **unused)
{
  (void)unused;
  struct model m = plain_thick(0.3);
  assert_string_equal(refusal(m), "");
  assert_non_null(strstr(refusal(plain_thick(0.6)), "length of a bond"));
  assert_non_null(strstr(refusal(plain_thick(9e-5)), "a thin line, or from 0.0001"));
  m = plain_thick(0.3), m.crossing.rule = CROSSING_SEQUENTIAL;
  assert_non_null(strstr(refusal(m), "event-driven"));
  m = plain_thick(0.3), m.crossing.forbidden = false;
  assert_non_null(strstr(refusal(m), "pass through"));
  m = plain_thick(0.3), m.kind->vertices = 1, m.kind->bending = 0.0;
  assert_non_null(strstr(refusal(m), "no bond"));
  m = plain_thick(0.3), m.walls.kind = WALL_NO_SLIP;
  assert_non_null(strstr(refusal(m), "walls know"));
  m = plain_thick(0.3), m.shear.rate = 0.01;
  assert_non_null(strstr(refusal(m), "sheared"));
}

/* By hand: bonds of a mean length of 0.53846 and a width of 0.1, so one bond keeps two apart for D up to 0.23846, and
 * two for D up to 1.07692 - 0.42426 = 0.65266; on the way round a bend, up to 0.34280 and 0.68560. */
static void near_bonds_are_blind(void **unused)
{
  (void)unused;
  static const struct {
    double diameter;
    uint32_t blind;
  } rows[] = {{0.0001, 2}, {0.2, 2}, {0.2384, 2}, {0.2385, 3}, {0.3431, 3}, {0.5, 3}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    struct model m = plain_thick(rows[k].diameter);
    test_finish(&m);
    for (uint32_t j = 1; j < 7; j++)
      assert_int_equal(model_tube_is_blind(&m, 0, j), j < rows[k].blind);
    assert_int_equal(model_reach(&m, 0, 5), llrint(rows[k].diameter * 0x1p39) * 2);
    model_free(&m);
  }
  struct model m = plain_thick(0.5);
  m.kind->ring = true, m.kind->vertices = 12;
  test_finish(&m);
  for (uint32_t j = 1; j < 12; j++)
    assert_int_equal(model_tube_is_blind(&m, 0, j), j < 3 || j > 9);
  model_free(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_tubes_overlap_in_a_run),       cmocka_unit_test(contacts_keep_momentum_and_angular_momentum),
      cmocka_unit_test(a_head_on_contact_by_hand),       cmocka_unit_test(drifts_of_tubes_run_backwards),
      cmocka_unit_test(thin_tubes_meet_as_lines_do),     cmocka_unit_test(random_starts_do_not_overlap),
      cmocka_unit_test(placed_starts_are_judged),        cmocka_unit_test(images_of_a_fiber_are_others),
      cmocka_unit_test(a_refused_fiber_leaves_no_entry), cmocka_unit_test(there_is_no_room),
      cmocka_unit_test(wrong_models_are_refused),        cmocka_unit_test(near_bonds_are_blind),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
