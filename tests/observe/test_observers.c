/* The observers as a run sees them: energies and temperatures, cadence, checkpoints, memory order. */
#include "tables.h"

#include "mpc/grid.h"
#include "observe/conserved.h"
#include "theory/theory.h"

/* A small suspension with a body force (net force zero), a flow, and a thermostat-free solvent. */
static struct model suspension(void)
{
  struct model m = test_model(6, 6, 6, 5, 0.01, 4);
  test_add_kind(&m, 12, 12);
  struct fiber_kind *ring = test_add_kind(&m, 3, 16);
  ring->ring = true;
  ring->start = START_CIRCLE;
  ring->bending = 8;
  m.flow = (struct vec3){0.25, 0, -0.125};
  m.solvent.acceleration = (struct vec3){0.0625, 0, 0};
  m.kind[0].force = (struct vec3){-0.0625 * 1080 / 192, 0, 0};
  m.kind[1].force = m.kind[0].force;
  return m;
}

static const struct observe_plan everything = {.every = {2, 3, 2, 2, 5, 2, 4}, .longest_lag = 64, .slabs = 4};

/* --- conserved ---------------------------------------------------------------------------------------------------- */

/* By hand: two solvent particles, one dumbbell stretched by 0.25 and at rest in the half step ahead. */
static void energy_by_hand(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.125, 2);
  test_particles(&m, 2);
  m.solvent.acceleration = (struct vec3){0, 1, 0};
  test_add_kind(&m, 1, 2);
  m.kind[0].mass = 2;
  test_finish(&m);
  struct state s;
  assert_true(state_alloc(&s, &m));
  s.solvent.vx[0] = 3;
  s.solvent.vz[1] = -1;
  s.solvent_lag = 2; /* half steps: each has gained 1/8 along y */
  s.position[1].x = 3 * LATTICE_CELL / 4;
  const struct conserved c = observe_conserved(&m, &s);
  /* force 100 x 0.25 pulls both inwards: on the step they still moved outwards at 25/2 x 1/16 */
  const double v = 25.0 / 2 / 16;
  assert_close(c.solvent_kinetic, 0.5 * (9 + 1 + 2 / 64.0), 0);
  assert_close(c.vertex_kinetic, 2 * v * v, 0);
  assert_close(c.bond, 50 * 0.0625, 0);
  assert_close(c.bend, 0, 0);
  assert_close(c.total, c.solvent_kinetic + c.vertex_kinetic + c.bond, 0);
  assert_close(c.momentum.x, 3, 0);
  assert_close(c.momentum.y, 0.25, 0);
  assert_close(c.momentum.z, -1, 0);
  s.solvent.vy[1] = NAN;
  assert_true(isnan(observe_conserved(&m, &s).total) && isnan(observe_conserved(&m, &s).momentum.y));
  state_free(&s);
  model_free(&m);
}

/* Largest departure of the energy of crossable fibers without solvent from its mean, over 2 t0. */
static double energy_swing(double dt)
{
  struct model m = test_model(32, 32, 32, 0, dt, 1);
  m.crossing.forbidden = false;
  test_add_kind(&m, 10, 32);
  struct test_run r = test_start(m);
  double low = INFINITY, high = -INFINITY;
  for (int k = 0; k < (int)(2 / dt + 0.5); k++) {
    test_steps(&r, 1);
    const double e = observe_conserved(&r.model, &r.state).total;
    low = fmin(low, e);
    high = fmax(high, e);
  }
  test_end(&r);
  return high - low;
}

/* On-step velocities: the leap-frog's energy swings by O(dt^2); with half-step velocities it would by O(dt). */
static void energy_of_the_leapfrog_swings_by_dt_squared(void **unused)
{
  (void)unused;
  const double coarse = energy_swing(0.004), fine = energy_swing(0.002);
  print_message("  swing %.3g kT at dt 0.004, %.3g at 0.002: ratio %.2f\n", coarse, fine, coarse / fine);
  assert_close(coarse / fine, 4, 0.6);
}

/* Total momentum is that of the flow and stays; naive sums in another order agree to rounding. */
static void momentum_is_that_of_the_flow(void **unused)
{
  (void)unused;
  struct test_run r = test_start(suspension());
  for (int k = 0; k < 3; k++) {
    const struct conserved c = observe_conserved(&r.model, &r.state);
    double naive = 0;
    for (uint32_t i = 0; i < r.state.solvent.n; i++) {
      const double vx = r.state.solvent.vx[i] + 0.0625 * 0.005 * r.state.solvent_lag;
      naive += 0.5 * (vx * vx + r.state.solvent.vy[i] * r.state.solvent.vy[i] +
                      r.state.solvent.vz[i] * r.state.solvent.vz[i]);
    }
    assert_close(c.solvent_kinetic, naive, 1e-9);
    assert_close(c.momentum.x, 0.25 * r.model.total_mass, 1e-9);
    assert_close(c.momentum.y, 0, 1e-9);
    assert_close(c.momentum.z, -0.125 * r.model.total_mass, 1e-9);
    test_steps(&r, 7); /* between collisions, where the solvent lags behind */
  }
  test_end(&r);
}

/* A trajectory's frame holds solvent velocities of the frame's own time, the lag's share added: the same numbers. */
static void frame_measures_as_the_state_does(void **unused)
{
  (void)unused;
  struct test_run r = test_start(suspension());
  test_steps(&r, 7);
  assert_true(r.state.solvent_lag > 0);
  const struct conserved then = observe_conserved(&r.model, &r.state);
  for (uint32_t i = 0; i < r.state.solvent.n; i++)
    r.state.solvent.vx[i] += 0.5 * r.state.solvent_lag * 0.01 * 0.0625;
  r.state.solvent_lag = 0;
  const struct conserved now = observe_conserved(&r.model, &r.state);
  assert_memory_equal(&then, &now, sizeof now);
  test_end(&r);
}

/* Twelve solvent particles and four vertices of mass 5, many starts, in a flow: the means are 1 (with 3N degrees of
 * freedom they would be 31/32 and 27/32), and no component is special. */
static void temperature_of_a_small_system_is_one(void **unused)
{
  (void)unused;
  enum { STARTS = 20000 };
  double sum[5] = {0}, squares[5] = {0};
  struct model m = test_model(4, 4, 4, 0, 1e-6, 2);
  test_particles(&m, 12);
  m.flow = (struct vec3){2, -1, 0.5};
  test_add_kind(&m, 4, 1);
  struct test_run r = test_start(m);
  for (r.model.seed = 1; r.model.seed <= STARTS; r.model.seed++) {
    assert_true(start_state(&r.state, &r.model, &r.work));
    const struct motion motion = motion_measure(&r.model, &r.state, r.work.fiber.force);
    const struct temperatures t = motion_temperatures(&r.model, &motion);
    const double now[] = {t.solvent.x, t.solvent.y, t.solvent.z, t.vertex, t.vertex_half};
    for (int k = 0; k < 5; k++) {
      sum[k] += now[k] / STARTS;
      squares[k] += now[k] * now[k] / STARTS;
    }
  }
  for (int k = 0; k < 5; k++) {
    const double error = sqrt((squares[k] - sum[k] * sum[k]) / STARTS);
    assert_sigma(sum[k], error, 1.0, 3.5);
  }
  test_end(&r);
}

/* --- a run -------------------------------------------------------------------------------------------------------- */

struct outcome {
  struct kept_rows *rows;
  struct kept *kept;
};

static void end_outcome(struct outcome *o)
{
  free(o->rows);
  free(o->kept);
}

static void assert_same_outcome(const struct outcome *a, const struct outcome *b)
{
  assert_int_equal(a->rows->count, b->rows->count);
  assert_memory_equal(a->rows->value, b->rows->value, a->rows->count * sizeof *a->rows->value);
  assert_int_equal(a->kept->tables, b->kept->tables);
  for (size_t i = 0; i < a->kept->tables; i++) {
    const struct kept_table *p = &a->kept->table[i], *q = &b->kept->table[i];
    assert_string_equal(p->name, q->name);
    assert_int_equal(p->rows, q->rows);
    assert_memory_equal(p->value, q->value, p->rows * p->columns * sizeof *p->value);
  }
}

/* Blocks by value, found again by name. */
struct saved {
  char name[128];
  size_t bytes;
  void *data;
};

static size_t save_blocks(struct observers *observers, struct saved *saved)
{
  const struct observe_block *block;
  const size_t n = observers_blocks(observers, &block);
  for (size_t i = 0; i < n; i++) {
    snprintf(saved[i].name, sizeof saved[i].name, "%s", block[i].name);
    saved[i].bytes = block[i].count * 8;
    saved[i].data = malloc(saved[i].bytes);
    memcpy(saved[i].data, block[i].data, saved[i].bytes);
    for (size_t j = 0; j < i; j++)
      assert_string_not_equal(saved[i].name, saved[j].name);
  }
  return n;
}

static void restore_blocks(struct observers *observers, const struct saved *saved, size_t n)
{
  const struct observe_block *block;
  assert_int_equal(observers_blocks(observers, &block), n);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      if (strcmp(block[j].name, saved[i].name) == 0) {
        assert_int_equal(block[j].count * 8, saved[i].bytes);
        memcpy(block[j].data, saved[i].data, saved[i].bytes);
      }
  for (size_t i = 0; i < n; i++)
    free(saved[i].data);
}

/* New observers that take over from the old ones, as a resumed run does. */
static struct observers *checkpoint(struct observers *old, const struct model *model)
{
  struct saved saved[24];
  const size_t n = save_blocks(old, saved);
  observers_free(old);
  struct observers *new = observers_create(&everything, model);
  assert_non_null(new);
  restore_blocks(new, saved, n);
  return new;
}

/* The solvent in id order, as a checkpoint leaves it. */
static void put_in_id_order(struct state *s)
{
  struct solvent *p = &s->solvent;
  uint32_t *slot = malloc(p->n * sizeof *slot);
  int64_t *copy = malloc(p->n * sizeof *copy);
  void *column[] = {p->x, p->y, p->z, p->vx, p->vy, p->vz};
  state_solvent_slots(s, slot);
  for (int k = 0; k < 6; k++) {
    memcpy(copy, column[k], p->n * sizeof *copy);
    for (uint32_t id = 0; id < p->n; id++)
      memcpy((char *)column[k] + 8 * id, &copy[slot[id]], 8);
  }
  for (uint32_t id = 0; id < p->n; id++)
    p->id[id] = id;
  free(slot);
  free(copy);
}

/* A run of 150 steps, interrupted at step `stop` (0: never), its solvent re-sorted then. */
static struct outcome observed_run(uint64_t stop)
{
  struct test_run r = test_start(suspension());
  struct outcome o = {.rows = calloc(1, sizeof *o.rows)};
  struct observers *observers = observers_create(&everything, &r.model);
  const struct observe_sink sink = {keep_row, o.rows};
  observers_watch(observers, &r.work);
  for (uint64_t step = 0;; step++) {
    if (observers_due(observers, step))
      assert_true(observers_sample(observers, &r.model, &r.state, &sink));
    if (step == 150)
      break;
    if (step == stop && stop > 0) {
      observers = checkpoint(observers, &r.model);
      observers_watch(observers, &r.work);
      put_in_id_order(&r.state);
    }
    test_steps(&r, 1);
  }
  o.kept = keep_summaries(observers, &r.model);
  observers_free(observers);
  test_end(&r);
  return o;
}

/* An interruption changes no bit of any table or row, wherever it falls, and although the solvent lies in another order
 * afterwards. */
static void interrupted_run_gives_the_same_tables(void **unused)
{
  (void)unused;
  struct outcome whole = observed_run(0);
  assert_int_equal(whole.kept->tables, 5);
  for (uint64_t stop = 76; stop <= 78; stop++) {
    struct outcome parts = observed_run(stop);
    assert_same_outcome(&whole, &parts);
    end_outcome(&parts);
  }
  end_outcome(&whole);
}

/* Each at its own cadence: conserved every 2 steps, temperature every 3, collisions every 5; and only the columns that
 * observe_series_columns names. */
static void cadence(void **unused)
{
  (void)unused;
  struct outcome o = observed_run(0);
  struct model model = suspension();
  size_t rows[OBSERVABLES] = {0}, at = 0;
  test_finish(&model);
  while (at < o.rows->count) {
    const enum observable which = (enum observable)o.rows->value[at];
    const char *names[OBSERVE_MOST_COLUMNS];
    const size_t columns = observe_series_columns(&model, which, names);
    const bool late = which == OBSERVE_STRESS || which == OBSERVE_COLLISIONS; /* from the first that has a time */
    assert_true(columns > 0 && strcmp(names[0], "time") == 0);
    assert_close(o.rows->value[at + 1], 0.01 * (double)((rows[which]++ + late) * everything.every[which]), 1e-12);
    at += columns + 1;
  }
  assert_int_equal(rows[OBSERVE_CONSERVED], 76);
  assert_int_equal(rows[OBSERVE_TEMPERATURE], 51);
  assert_int_equal(rows[OBSERVE_COLLISIONS], 30);
  assert_int_equal(rows[OBSERVE_STRESS], 37); /* from the first that has an average */
  assert_int_equal(rows[OBSERVE_PROFILE] + rows[OBSERVE_STATICS] + rows[OBSERVE_DYNAMICS], 0);
  assert_close(kept_value(o.kept, "statics-kind1", 0, "samples"), 76, 0);
  assert_close(kept_value(o.kept, "dynamics-kind2", 0, "intervals"), 75, 0);
  end_outcome(&o);
  model_free(&model);
}

static void nobody_asked(void **unused)
{
  (void)unused;
  struct test_run r = test_start(suspension());
  const struct observe_plan nothing = {.longest_lag = 0};
  const struct observe_block *block;
  const char *names[OBSERVE_MOST_COLUMNS];
  struct observers *observers = observers_create(&nothing, &r.model);
  assert_false(observers_due(observers, 0));
  assert_true(observers_sample(observers, &r.model, &r.state, NULL));
  assert_int_equal(observers_blocks(observers, &block), 0);
  assert_int_equal(observe_series_columns(&r.model, OBSERVE_STATICS, names), 0);
  struct kept *kept = keep_summaries(observers, &r.model);
  assert_int_equal(kept->tables, 0);
  free(kept);
  observers_free(observers);
  observers_free(NULL);
  test_end(&r);
}

/* The same step shown twice counts once; a sink that fails is told of. */
static bool refuse(void *context, enum observable which, size_t columns, const double *values)
{
  (void)context;
  (void)which;
  return columns == 0 || isnan(values[0]);
}

static void repeated_and_refused_samples(void **unused)
{
  (void)unused;
  struct test_run r = test_start(suspension());
  struct observers *observers = observers_create(&everything, &r.model);
  struct kept_rows *rows = calloc(1, sizeof *rows);
  const struct observe_sink good = {keep_row, rows}, bad = {refuse, NULL};
  assert_true(observers_sample(observers, &r.model, &r.state, &good));
  assert_true(observers_sample(observers, &r.model, &r.state, &good));
  assert_int_equal(rows->rows, 2); /* stress and contacts have none yet */
  struct kept *kept = keep_summaries(observers, &r.model);
  assert_close(kept_value(kept, "statics-kind1", 0, "samples"), 1, 0);
  test_steps(&r, 2);
  assert_false(observers_sample(observers, &r.model, &r.state, &bad));
  free(kept);
  free(rows);
  observers_free(observers);
  test_end(&r);
}

/* Rates are per vertex and t0, and over theory, since the row before: 192 vertices; 0.1 t0 between rows. */
static void collision_rates(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.02, 1);
  test_add_kind(&m, 12, 16);
  struct puppet p = puppet_start(m, OBSERVE_COLLISIONS, 5, 0);
  struct kept_rows *rows = calloc(1, sizeof *rows);
  const struct observe_sink sink = {keep_row, rows};
  const struct collision_counts counts[] = {{0}, {960, 20, 16, 2, 5, 0}, {1920, 80, 40, 3, 6, 1}};
  for (int k = 0; k < 3; k++) {
    p.state.step = 5 * (uint64_t)k;
    p.state.counts = counts[k];
    assert_true(observers_sample(p.observers, &p.model, &p.state, &sink));
  }
  enum { COLUMNS = 11 };
  const double theory = theory_collision_rate(&p.model); /* test_theory.c */
  const double expected[2][COLUMNS] = {
      {OBSERVE_COLLISIONS, 0.1, 960, 20, 16, 2, 0.8, 16 / 192.0 / 0.1, 16 / (0.1 * theory), 5, 0},
      {OBSERVE_COLLISIONS, 0.2, 1920, 80, 40, 3, 0.5, 24 / 192.0 / 0.1, 24 / (0.1 * theory), 6, 1}};
  assert_int_equal(rows->count, 2 * COLUMNS);
  for (int k = 0; k < 2 * COLUMNS; k++)
    assert_close(rows->value[k], expected[k / COLUMNS][k % COLUMNS], 1e-12);
  free(rows);
  puppet_end(&p);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(energy_by_hand),
      cmocka_unit_test(energy_of_the_leapfrog_swings_by_dt_squared),
      cmocka_unit_test(momentum_is_that_of_the_flow),
      cmocka_unit_test(frame_measures_as_the_state_does),
      cmocka_unit_test(temperature_of_a_small_system_is_one),
      cmocka_unit_test(interrupted_run_gives_the_same_tables),
      cmocka_unit_test(cadence),
      cmocka_unit_test(nobody_asked),
      cmocka_unit_test(repeated_and_refused_samples),
      cmocka_unit_test(collision_rates),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
