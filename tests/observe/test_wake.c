/* The network around the bead: density and displacement of vertices, cell by cell. */
#include "exact.h"
#include "tables.h"

#include "system/bead.h"

enum { SHELLS = 9, SECTORS = 4, CELLS = SHELLS * SECTORS }; /* (12/2 - 1.5)/0.5 shells */

static const double radius = 1.5;

static struct model crowd_around_a_bead(void)
{
  struct model m = test_model(12, 12, 13, 0.2, 0.05, 1);
  struct fiber_kind *k = test_add_kind(&m, 40, 4);
  k->bond_length = 0.3;
  k = test_add_kind(&m, 30, 2);
  k->bond_length = 0.3;
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  m.bead.radius = radius;
  m.bead.center = (struct vec3){11.9, 0.2, 6.0};
  m.bead.drive.force = (struct vec3){0.5, 1.0, -1.0};
  return m;
}

static const struct vec3 drive = {1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0};

/* A place relative to the center in a cell: anywhere in it, but not within 1e-3 of its faces. out: away from the line
 * along the drive. */
static struct vec3 place_in(struct dice *d, int cell, struct vec3 *out)
{
  const double distance = radius + 0.5 * (cell / SECTORS + dice_between(d, 0.001, 0.999)),
               cosine = -1.0 + 0.5 * (cell % SECTORS + dice_between(d, 0.001, 0.999));
  const struct vec3 any = dice_vector(d, 1.0), across = vec3_add_scaled(any, -vec3_dot(any, drive), drive);
  *out = vec3_scale(1.0 / vec3_norm(across), across);
  return vec3_add_scaled(vec3_scale(distance * cosine, drive), distance * sqrt(1.0 - cosine * cosine), *out);
}

/* How many stand in a cell, and how far they go along the drive and away from its line. */
static int number_in(int cell)
{
  return cell % 5;
}

static double goes_along(int cell)
{
  return 0.01 * (cell + 1);
}

static double goes_away(int cell)
{
  return 0.2 - 0.013 * cell;
}

/* An image of a place relative to the bead. */
static struct point image_of(const struct test_run *r, struct dice *d, struct vec3 place)
{
  const struct point at = point_move(r->state.bead->position, place);
  const int32_t shift[3] = {(int32_t)(dice_u64(d) % 3) - 1, (int32_t)(dice_u64(d) % 5) - 2, 0};
  return point_image(at, shift, &r->model.box);
}

/* Puts all vertices in known cells, or in corners further than half of the box, and says how each will go. */
static void set_up(struct test_run *r, struct dice *d, struct vec3 *gone)
{
  uint32_t v = 0;
  struct vec3 out;
  r->state.bead->position = point_move(r->state.bead->position, dice_vector(d, 20.0));
  for (int cell = 0; cell < CELLS; cell++)
    for (int k = 0; k < number_in(cell); k++, v++) {
      assert_true(v < r->model.vertices);
      r->state.position[v] = image_of(r, d, place_in(d, cell, &out));
      gone[v] = vec3_add_scaled(vec3_scale(goes_along(cell), drive), goes_away(cell), out);
    }
  assert_true(v + 20 < r->model.vertices);
  for (; v < r->model.vertices; v++) {
    r->state.position[v] = image_of(r, d, (struct vec3){4.5, -4.2, dice_between(d, 4.0, 4.5)});
    gone[v] = (struct vec3){1.0, 2.0, 3.0};
  }
}

static void check_cells(const struct kept *kept)
{
  for (int cell = 0; cell < CELLS; cell++) {
    const size_t row = (size_t)cell;
    const double inner = radius + 0.5 * (cell / SECTORS), outer = inner + 0.5,
                 volume = 3.141592653589793 / 3.0 * (outer * outer * outer - inner * inner * inner);
    assert_close(kept_value(kept, "wake", row, "distance"), 0.5 * (inner + outer), 1e-12);
    assert_close(kept_value(kept, "wake", row, "cosine"), -0.75 + 0.5 * (cell % SECTORS), 1e-12);
    assert_close(kept_value(kept, "wake", row, "number"), number_in(cell) / volume, 1e-9);
    assert_close(kept_value(kept, "wake", row, "samples"), 1, 0);
    if (number_in(cell) == 0) {
      assert_true(isnan(kept_value(kept, "wake", row, "along")) && isnan(kept_value(kept, "wake", row, "away")));
      continue;
    }
    assert_close(kept_value(kept, "wake", row, "along"), goes_along(cell), 1e-9);
    assert_close(kept_value(kept, "wake", row, "away"), goes_away(cell), 1e-9);
  }
}

/* The bead goes elsewhere meanwhile: cells are those of the sample before, ways those of the laboratory. */
static void cells_by_hand(void **unused)
{
  (void)unused;
  struct test_run r = test_start(crowd_around_a_bead());
  struct vec3 gone[256];
  assert_true(r.model.vertices <= 256);
  struct dice d = {dice_seed(5101)};
  for (int round = 0; round < 20; round++) {
    struct observe_plan plan = {0};
    plan.every[OBSERVE_WAKE] = 10;
    struct observers *o = observers_create(&plan, &r.model);
    set_up(&r, &d, gone);
    r.state.step = 30;
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
    r.state.bead->position = point_move(r.state.bead->position, dice_vector(&d, 2.0));
    for (uint32_t i = 0; i < r.model.vertices; i++)
      r.state.position[i] = point_move(r.state.position[i], gone[i]);
    r.state.step = 40;
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
    struct kept *kept = keep_summaries(o, &r.model);
    check_cells(kept);
    free(kept);
    observers_free(o);
  }
  test_end(&r);
}

/* Which way is along: that of the force, else that of the trap's motion, else that of its swing, else x. */
static void along_is_that_of_the_drive(void **unused)
{
  (void)unused;
  const struct vec3 none = {0, 0, 0}, a = {0, 0.3, 0}, b = {0, 0, -0.2};
  const struct {
    struct vec3 force, velocity, amplitude, along;
  } rows[] = {
      {a, b, none, {0, 1, 0}}, {none, b, a, {0, 0, -1}}, {none, none, a, {0, 1, 0}}, {none, none, none, {1, 0, 0}}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    struct model m = crowd_around_a_bead();
    m.bead.drive = (struct bead_drive){.force = rows[k].force,
                                       .velocity = rows[k].velocity,
                                       .amplitude = rows[k].amplitude,
                                       .spring = 10.0,
                                       .period = vec3_norm(rows[k].amplitude) > 0.0 ? 40.0 : 0.0};
    struct test_run r = test_start(m);
    struct observe_plan plan = {0};
    plan.every[OBSERVE_WAKE] = 1;
    struct observers *o = observers_create(&plan, &r.model);
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
    for (uint32_t i = 0; i < r.model.vertices; i++)
      r.state.position[i] = point_move(r.state.position[i], vec3_scale(0.25, rows[k].along));
    r.state.step++;
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
    struct kept *kept = keep_summaries(o, &r.model);
    int seen = 0;
    for (size_t row = 0; row < CELLS; row++) {
      const double along = kept_value(kept, "wake", row, "along");
      assert_true(isnan(along) || fabs(along - 0.25) < 1e-9);
      seen += !isnan(along);
    }
    assert_true(seen > CELLS / 2);
    free(kept);
    observers_free(o);
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(cells_by_hand),
      cmocka_unit_test(along_is_that_of_the_drive),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
