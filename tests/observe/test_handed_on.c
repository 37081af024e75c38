/* What contacts of thick fibers hand on, against what happens to the vertices: in a drift each flies straight, changes
 * its velocity, and flies on, so that its part of the virial is its place at that time, times the change of its
 * momentum. That needs neither the impulse nor the points of contact nor the normal. */
#include "exact.h"
#include "tables.h"

enum { MOST_EVENTS = 64, MOST_VERTICES = 1024 };

/* Thick rods, chains and rings of three diameters, and thin chains. */
static struct model crowd(double per_cell)
{
  struct model m = test_model(4, 4, 3, per_cell, 0.005, 2);
  static const struct {
    uint32_t count, vertices;
    double diameter, length;
    bool ring;
  } rows[] = {{25, 2, 0.3, 0.8, false}, {12, 6, 0.15, 0.5, false}, {3, 7, 0.25, 0.6, true}, {8, 5, 0.0, 0.5, false}};
  m.crossing.rule = CROSSING_EVENT_DRIVEN, m.seed = dice_seed(2701);
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
    struct fiber_kind *k = test_add_kind(&m, rows[r].count, rows[r].vertices);
    k->diameter = rows[r].diameter, k->bond_length = rows[r].length, k->ring = rows[r].ring, k->bending = 2.0;
    k->mass = 2.0 + (double)r;
  }
  return m;
}

/* --- observers and their last rows -------------------------------------------------------------------------------- */

struct watched {
  const struct model *model;
  struct observers *observers;
  double row[OBSERVABLES][OBSERVE_MOST_COLUMNS];
  size_t rows;
};

static bool keep(void *context, enum observable which, size_t columns, const double *values)
{
  struct watched *w = context;
  memcpy(w->row[which], values, columns * sizeof *values);
  w->rows++;
  return true;
}

static struct watched watched_of(const struct model *m, uint64_t every)
{
  struct observe_plan plan = {.slabs = 1};
  plan.every[OBSERVE_PRESSURE] = plan.every[OBSERVE_STRESS] = every;
  struct watched w = {.model = m, .observers = observers_create(&plan, m)};
  assert_non_null(w.observers);
  return w;
}

static void look(struct watched *w, const struct state *state)
{
  const struct observe_sink sink = {keep, w};
  assert_true(observers_sample(w->observers, w->model, state, &sink));
}

static double last(const struct watched *w, enum observable which, const char *column)
{
  const char *names[OBSERVE_MOST_COLUMNS];
  const size_t columns = observe_series_columns(w->model, which, names);
  for (size_t k = 0; k < columns; k++)
    if (strcmp(names[k], column) == 0)
      return w->row[which][k];
  fail_msg("no column %s", column);
  return NAN;
}

/* --- a step that is watched --------------------------------------------------------------------------------------- */

struct flight {
  const struct model *model;
  struct vec3 start[MOST_VERTICES], before[MOST_VERTICES],
      after[MOST_VERTICES]; /* places; velocities about the drift */
  struct contact_event event[MOST_EVENTS];
  size_t events;
  const struct watched *to[2]; /* who else hears of contacts */
};

static void hear(void *context, const struct contact_event *event)
{
  struct flight *f = context;
  assert_true(f->events < MOST_EVENTS);
  f->event[f->events++] = *event;
  for (int k = 0; k < 2; k++)
    if (f->to[k]) {
      const struct contact_log *log = observers_contacts(f->to[k]->observers);
      log->record(log->context, event);
    }
}

static void landed(void *context, const char *stage, const struct state *state)
{
  struct flight *f = context;
  for (uint32_t v = 0; strcmp(stage, "drift") == 0 && v < f->model->vertices; v++)
    f->after[v] = state->velocity[v];
}

static void fly(struct test_run *r, struct flight *f)
{
  const struct contact_log log = {hear, f};
  const struct step_watch watch = {landed, f};
  assert_true(r->model.vertices <= MOST_VERTICES);
  f->model = &r->model, f->events = 0;
  for (uint32_t v = 0; v < r->model.vertices; v++) {
    f->start[v] = point_in_a0(r->state.position[v]);
    f->before[v] = r->state.velocity[v];
  }
  assert_true(step_advance_watched(&r->state, &r->model, &r->work, &log, &watch));
}

/* Vertices of a contact, and how far off the image is that each is of. */
struct four {
  uint32_t vertex[4];
  struct vec3 off[4];
};

static struct four four_of(const struct flight *f, const struct contact_event *e)
{
  const uint32_t mine = e->moving_bond, its = e->standing_bond;
  struct four four = {{mine, (uint32_t)f->model->next[mine], its, (uint32_t)f->model->next[its]}, {{0, 0, 0}}};
  for (int k = 2; k < 4; k++)
    four.off[k] =
        (struct vec3){(double)e->image[0] * f->model->box.cells[0], (double)e->image[1] * f->model->box.cells[1],
                      (double)e->image[2] * f->model->box.cells[2]};
  return four;
}

/* False if a vertex meets two others: its change of momentum is that of both. */
static bool all_meet_once(const struct flight *f)
{
  uint8_t met[MOST_VERTICES] = {0};
  bool once = true;
  for (size_t n = 0; n < f->events; n++) {
    const struct four four = four_of(f, &f->event[n]);
    for (int k = 0; k < 4; k++)
      once &= met[four.vertex[k]]++ == 0;
  }
  return once;
}

struct virial {
  double xx, yy, zz, xy;
};

static struct virial virial_of(const struct flight *f)
{
  struct virial sum = {0, 0, 0, 0};
  for (size_t n = 0; n < f->events; n++) {
    const struct contact_event *e = &f->event[n];
    const struct four four = four_of(f, e);
    for (int k = 0; k < 4; k++) {
      const uint32_t v = four.vertex[k];
      const struct vec3 place = vec3_add(vec3_add_scaled(f->start[v], e->hit.time * f->model->time_step, f->before[v]),
                                         four.off[k]),
                        push = vec3_scale(f->model->mass[v], vec3_sub(f->after[v], f->before[v]));
      sum.xx += place.x * push.x, sum.yy += place.y * push.y, sum.zz += place.z * push.z, sum.xy += place.x * push.y;
    }
  }
  return sum;
}

/* --- tests -------------------------------------------------------------------------------------------------------- */

#define TOLERANCE 3e-6 /* kT t0: flights are rounded to 2^-25 a0, places to 2^-40; impulses are some 10 m a0/t0 */

static double more(const struct watched *heard, const struct watched *deaf, enum observable which, const char *column)
{
  return last(heard, which, column) - last(deaf, which, column);
}

/* heard: observers that know of contacts; deaf: others that do not. What they differ by is what contacts hand on. */
static void expect(const struct watched *heard, const struct watched *deaf, const struct virial *v)
{
  const double scale = box_volume(&heard->model->box) * heard->model->time_step, mean = (v->xx + v->yy + v->zz) / 3.0;
  const struct {
    enum observable of;
    const char *column;
    double expected;
  } rows[] = {{OBSERVE_PRESSURE, "p_xx", v->xx},
              {OBSERVE_PRESSURE, "p_yy", v->yy},
              {OBSERVE_PRESSURE, "p_zz", v->zz},
              {OBSERVE_PRESSURE, "p_xy", v->xy},
              {OBSERVE_PRESSURE, "pressure", mean},
              {OBSERVE_PRESSURE, "pressure_contacts", mean},
              {OBSERVE_STRESS, "sigma_xy", -v->xy},
              {OBSERVE_STRESS, "sigma_xy_contacts", -v->xy},
              {OBSERVE_STRESS, "pressure", mean},
              {OBSERVE_STRESS, "N1", v->yy - v->xx},
              {OBSERVE_STRESS, "N1_contacts", v->yy - v->xx}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
    assert_close(scale * more(heard, deaf, rows[k].of, rows[k].column), rows[k].expected, TOLERANCE);
  assert_true(more(heard, deaf, OBSERVE_STRESS, "sigma_xy_fibers") == 0.0);
}

/* Each step by itself, fibers alone: contacts of all sorts, across the faces of the box as well. */
static void contacts_hand_on_their_virial(void **unused)
{
  (void)unused;
  struct test_run r = test_start(crowd(0.0));
  struct watched heard = watched_of(&r.model, 1), deaf = watched_of(&r.model, 1);
  static struct flight f;
  size_t steps = 0, contacts = 0, across = 0, ends = 0;
  f.to[0] = &heard;
  look(&heard, &r.state), look(&deaf, &r.state);
  assert_int_equal(heard.rows, 0); /* at step 0 there is no time to average over */
  for (int step = 0; step < 1500; step++) {
    fly(&r, &f);
    look(&heard, &r.state), look(&deaf, &r.state);
    if (!all_meet_once(&f))
      continue;
    const struct virial v = virial_of(&f);
    expect(&heard, &deaf, &v);
    steps++, contacts += f.events;
    for (size_t n = 0; n < f.events; n++) {
      const struct contact_event *e = &f.event[n];
      across += (e->image[0] | e->image[1] | e->image[2]) != 0;
      ends += fmod(e->hit.s, 1.0) == 0.0 || fmod(e->hit.s_standing, 1.0) == 0.0;
    }
  }
  print_message("  %zu contacts in %zu steps, %zu across a face, %zu of an end\n", contacts, steps, across, ends);
  assert_int_equal(heard.rows, 3000);
  assert_true(contacts > 400 && across > 200 && ends > 200);
  observers_free(heard.observers), observers_free(deaf.observers);
  test_end(&r);
}

/* Takes over the memory of other observers, as a resumed run does. earlier: that of a program that had none of
 * contacts. */
static void take_over(struct watched *w, bool earlier)
{
  const struct watched next = watched_of(w->model, 6);
  const struct observe_block *from, *to;
  const size_t n = observers_blocks(w->observers, &from);
  size_t later = 0;
  assert_int_equal(observers_blocks(next.observers, &to), n);
  for (size_t k = 0; k < n; k++) {
    assert_string_equal(from[k].name, to[k].name);
    memcpy(to[k].data, from[k].data, from[k].count * sizeof(double));
    for (size_t j = 0; earlier && to[k].later && j < to[k].count; j++)
      ((double *)to[k].data)[j] = NAN;
    later += to[k].later;
  }
  assert_int_equal(later, 2);
  observers_free(w->observers);
  w->observers = next.observers;
}

/* A row is the mean over the steps since the row before, to the bit also where observers are laid down and taken up
 * between two rows. What an earlier program has not counted is no number, in one row. */
static void rows_are_means(void **unused)
{
  (void)unused;
  struct test_run r = test_start(crowd(0.0));
  struct watched whole = watched_of(&r.model, 6), parts = watched_of(&r.model, 6);
  static struct flight f;
  const double scale = box_volume(&r.model.box) * 6.0 * r.model.time_step;
  double sum = 0.0;
  bool once = true;
  size_t rows = 0;
  f.to[0] = &whole, f.to[1] = &parts;
  for (int step = 0; step <= 600; step++) {
    if (step % 6 == 0) {
      look(&whole, &r.state), look(&parts, &r.state);
      if (step != 600)
        assert_memory_equal(whole.row, parts.row, sizeof whole.row);
      if (step > 0 && once) {
        assert_close(scale * last(&whole, OBSERVE_PRESSURE, "pressure_contacts"), sum, 6.0 * TOLERANCE);
        rows++;
      }
      sum = 0.0, once = true;
    }
    if (step == 3 || step == 304 || step == 595)
      take_over(&parts, step == 595);
    fly(&r, &f);
    once &= all_meet_once(&f);
    const struct virial v = virial_of(&f);
    sum += (v.xx + v.yy + v.zz) / 3.0;
  }
  print_message("  %zu rows\n", rows);
  assert_true(rows > 10);
  assert_int_equal(whole.rows, 200);
  assert_true(isnan(last(&parts, OBSERVE_PRESSURE, "pressure")) && isnan(last(&parts, OBSERVE_STRESS, "N1_contacts")));
  assert_true(last(&parts, OBSERVE_PRESSURE, "potential") == last(&whole, OBSERVE_PRESSURE, "potential"));
  for (r.state.step = 606; isnan(last(&parts, OBSERVE_PRESSURE, "pressure")); r.state.step += 6) {
    assert_int_equal(r.state.step, 606);
    look(&parts, &r.state);
  }
  observers_free(whole.observers), observers_free(parts.observers);
  test_end(&r);
}

/* Nobody hears of contacts where nobody asks, or nothing is handed on. */
static void nobody_asks(void **unused)
{
  (void)unused;
  struct model thick = crowd(0.0), thin = crowd(0.0);
  for (uint32_t k = 0; k < thin.kinds; k++)
    thin.kind[k].diameter = 0.0;
  test_finish(&thick), test_finish(&thin);
  const struct observe_plan plans[] = {{.every = {[OBSERVE_PRESSURE] = 5, [OBSERVE_STRESS] = 5}},
                                       {.every = {[OBSERVE_PRESSURE] = 5}},
                                       {.every = {[OBSERVE_STRESS] = 5}},
                                       {.every = {[OBSERVE_CONSERVED] = 5, [OBSERVE_COLLISIONS] = 5}}};
  for (int k = 0; k < 8; k++) {
    struct observers *o = observers_create(&plans[k / 2], k % 2 ? &thin : &thick);
    assert_true((observers_contacts(o) != NULL) == (k / 2 < 3 && k % 2 == 0));
    observers_free(o);
  }
  model_free(&thick), model_free(&thin);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(contacts_hand_on_their_virial), cmocka_unit_test(rows_are_means),
                                     cmocka_unit_test(nobody_asks)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
