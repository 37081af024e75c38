/* What is read off: each observable against a number that is known without it, where the solvent flows, in a plane, of
 * dumbbells, with forces of pairs. Statistics: 4.5 standard errors, a false alarm in 150,000 numbers. */
#include "exact.h"
#include "statistics.h"

#include "../observe/tables.h"
#include "observe/meaning.h"
#include "observe/units.h"
#include "scene/scene_keys.h"

/* --- rows by name ------------------------------------------------------------------------------------------------- */

/* What a scene says, read as a run reads it. */
static bool read_whole(const char *text, struct scene *scene, struct message *message)
{
  return scene_read_source(&(struct scene_source){.keys = &scene_keys,
                                                  .path = "scene.yaml",
                                                  .text = text,
                                                  .size = strlen(text),
                                                  .missing = MISSING_ABSENT,
                                                  .message = message},
                           scene);
}

static struct scene scene_of(const char *text)
{
  struct scene scene;
  struct message message;
  if (!read_whole(text, &scene, &message))
    fail_msg("%s", message.text);
  return scene;
}

/* The rows of a series, as a file has them. */
struct rows {
  size_t columns, count;
  double value[1 << 16];
};

static bool add_row(void *context, enum observable which, size_t columns, const double *values)
{
  struct rows *r = context;
  (void)which;
  assert_true((r->count + 1) * columns <= sizeof r->value / sizeof *r->value);
  memcpy(&r->value[r->count++ * columns], values, columns * sizeof *values);
  r->columns = columns;
  return true;
}

/* The header of a series, and the names of summaries, as a user sees them. */
struct outcome {
  struct scene scene;
  struct rows rows;
  char header[40][64];
  size_t columns;
  struct kept *kept;
};

static bool is_series(const struct scene *scene, enum observable which, struct outcome *o)
{
  const char *names[OBSERVE_MOST_COLUMNS];
  o->columns = observe_series_columns(&scene->model, which, names);
  for (size_t k = 0; k < o->columns; k++)
    snprintf(o->header[k], sizeof o->header[k], "%s", names[k]);
  return o->columns > 0;
}

/* Runs a scene that asks for this observable. */
static struct outcome *run_of(const char *text, enum observable which)
{
  struct outcome *o = calloc(1, sizeof *o);
  struct state state;
  struct work work;
  assert_non_null(o);
  o->scene = scene_of(text);
  const struct model *m = &o->scene.model;
  const struct observe_sink sink = {add_row, &o->rows};
  struct observers *observers = observers_create(&o->scene.observe, m);
  assert_true(observers && state_alloc(&state, m) && work_alloc(&work, m) && start_state(&state, m, &work));
  observers_watch(observers, &work);
  assert_true(observers_sample(observers, m, &state, &sink));
  for (uint64_t step = 0; step < o->scene.steps; step++) {
    assert_true(step_advance(&state, m, &work, observers_contacts(observers)));
    assert_true(observers_sample(observers, m, &state, &sink));
  }
  if (!is_series(&o->scene, which, o))
    o->kept = keep_summaries(observers, m);
  observers_free(observers);
  work_free(&work);
  state_free(&state);
  return o;
}

static void end_of(struct outcome *o)
{
  free(o->kept);
  scene_free(&o->scene);
  free(o);
}

static bool has(const struct outcome *o, const char *name)
{
  for (size_t k = 0; k < o->columns; k++)
    if (strcmp(o->header[k], name) == 0)
      return true;
  return false;
}

static double at(const struct outcome *o, size_t row, const char *name)
{
  for (size_t k = 0; k < o->columns; k++)
    if (strcmp(o->header[k], name) == 0)
      return o->rows.value[row * o->rows.columns + k];
  fail_msg("no column %s", name);
  return NAN;
}

/* Mean of a column from this row on, in 20 blocks. */
static struct sample mean_of(const struct outcome *o, const char *name, size_t from)
{
  struct blocks b = {.length = (o->rows.count - from) / 20};
  for (size_t k = from; k < o->rows.count; k++)
    blocks_add(&b, at(o, k, name));
  return b.of_blocks;
}

#define expect(o, name, expected)                                                                                      \
  do {                                                                                                                 \
    const struct sample found_ = mean_of(o, name, 20);                                                                 \
    print_message("  %s:", name);                                                                                      \
    assert_sigma(found_.mean, sample_error(&found_), expected, 4.5);                                                   \
  } while (0)

/* --- pressure ----------------------------------------------------------------------------------------------------- */

/* n_d dumbbells per volume have the pressure n_d kT: springs take away the half of that of their particles. Less the
 * one particle that the rest of the box is not free to be: kT per volume. And two particles of a spring have the
 * configurational temperature kT. */
static void dumbbells_are_a_gas(void **unused)
{
  (void)unused;
  test_begin_statistics();
  struct outcome *o = run_of("box: [4, 4, 4]\ntime_step: 0.1\nsteps: 4000\nseed: 31\n"
                             "solvent: {per_cell: 10, collision_interval: 0.1, rule: at-a}\ndumbbells: {spring: 3}\n"
                             "observe: {pressure: {every: 4}}\n",
                             OBSERVE_PRESSURE);
  expect(o, "pressure", 5.0 - 1.0 / 64.0);
  expect(o, "p_xx", 5.0 - 1.0 / 64.0);
  expect(o, "configurational", 1.0);
  expect(o, "potential", 0.5 * 3.0 * 320.0);
  end_of(o);
}

/* A gas that is sheared is a gas: n kT along each axis, about its flow, whose 0.3^2 (6^2 - 1)/12 = 0.26 is no heat.
 * p_xy is minus the kinetic stress, some eta_kin rate: 8 0.1 0.5 0.3 at most. */
static void a_sheared_gas(void **unused)
{
  (void)unused;
  test_begin_statistics();
  struct outcome *o = run_of("box: [6, 6, 4]\ntime_step: 0.1\nsteps: 3000\nseed: 32\n"
                             "solvent: {per_cell: 8, collision_interval: 0.1, rule: at-a}\nshear: {rate: 0.3}\n"
                             "observe: {pressure: {every: 3}}\n",
                             OBSERVE_PRESSURE);
  expect(o, "p_yy", 8.0 - 1.0 / 144.0);
  expect(o, "p_zz", 8.0 - 1.0 / 144.0);
  /* a flight of 0.1 through the gradient: <w_x^2> = 1 + rate^2 (t^2/3 to t^2), and rate^2/6 just after a collision */
  const struct sample xx = mean_of(o, "p_xx", 20);
  assert_close(xx.mean, 8.0 * (1.0 + 0.5 * 0.09 / 6.0), 8.0 * 0.09 / 12.0 + 4.5 * sample_error(&xx));
  end_of(o);
}

/* Where the force of a box without end pulls everything, the flow that it makes is no pressure. */
static void an_accelerated_gas(void **unused)
{
  (void)unused;
  struct outcome *o = run_of("box: [4, 4, 4]\ntime_step: 0.1\nsteps: 400\nseed: 33\n"
                             "solvent: {per_cell: 5, collision_interval: 0.1, rule: at-a, acceleration: [0.05, 0, 0]}\n"
                             "observe: {pressure: {every: 2}, }\n",
                             OBSERVE_PRESSURE);
  expect(o, "p_xx", 5.0 - 1.0 / 64.0); /* at the end the flow is 2 a0/t0, rho v^2 = 20 */
  end_of(o);
}

/* The stress on walls is the pressure of a gas at rest: what particles hand to a wall that reverses them. Here by the
 * mean over the gap, n kT, in which the momentum along each axis is free. */
static void a_gas_between_walls(void **unused)
{
  (void)unused;
  test_begin_statistics();
  struct outcome *o = run_of("box: [6, 5, 6]\ntime_step: 0.05\nsteps: 4000\nseed: 34\n"
                             "solvent: {per_cell: 6, collision_interval: 0.1, rule: at-a}\nwalls: {kind: no-slip}\n"
                             "fibers: [{name: chain, count: 12, vertices: 5, mass: 3, bond_length: 0, spring: 10}]\n"
                             "crossing: {forbidden: false}\nobserve: {pressure: {every: 4}}\n",
                             OBSERVE_PRESSURE);
  assert_true(has(o, "potential") && !has(o, "configurational") && !has(o, "laplacian"));
  /* across: of the gas, and of chains as a whole. Along: the same, since the walls push at no slant. */
  expect(o, "p_xx", 6.0 + 12.0 / 180.0);
  end_of(o);
}

/* Rods of one bond, l = 1 and D = 0.2, are a gas of spherocylinders: p = n kT Z, Z by virial coefficients, the second
 * one exact, the others of spherocylinders with l/D = 5 by Monte Carlo of others (docs/thick.md). The last term of Z is
 * 0.006, and the step's share of it 0.003. Without contacts Z is 1. */
static void thick_rods_are_a_gas(void **unused)
{
  (void)unused;
  test_begin_statistics();
  struct outcome *o =
      run_of("box: [5, 5, 5]\ntime_step: 0.01\nsteps: 8000\nseed: 39\nmedium: {kind: private, rate: 1}\n"
             "fibers: [{name: rod, count: 351, vertices: 2, mass: 5, bond_length: 1, spring: 400, "
             "diameter: 0.2}]\ncrossing: {rule: event-driven}\nobserve: {pressure: {every: 2}}\n",
             OBSERVE_PRESSURE);
  const double pi = 3.14159265358979323846, l = 1.0075 / 1.0025, d = 0.2, n = 351.0 / 125.0;
  const double v = pi / 4.0 * d * d * l + pi / 6.0 * d * d * d, phi = n * v,
               b2 = 2.0 / 3.0 * pi * d * d * d + pi * l * d * d + pi / 4.0 * l * l * d,
               z = 1.0 + b2 * n + phi * phi * (29.67 + phi * (31.39 + phi * 55.5));
  static const char *const names[] = {"pressure", "p_xx", "p_yy", "p_zz", "p_xy"};
  for (size_t k = 0; k < 5; k++) {
    const struct sample p = mean_of(o, names[k], 200);
    print_message("  %s %.4f +- %.4f, expected %.4f\n", names[k], p.mean, sample_error(&p), k < 4 ? n * z : 0.0);
    assert_close(p.mean, k < 4 ? n * z : 0.0, 4.5 * sample_error(&p) + 0.01 * n);
    assert_true(sample_error(&p) < 0.03 * n);
  }
  end_of(o);
}

/* --- temperature -------------------------------------------------------------------------------------------------- */

/* Chains in phantoms, in a sheared box of height 8: the flow would count as 5 0.1^2 8^2/12 3 = 0.089. The leap-frog of
 * kick-split is exact at the step to second order: (omega dt)^2 is 4 20/3 0.0004 = 0.01 at most, and has no part. */
static void vertices_in_shear(void **unused)
{
  (void)unused;
  test_begin_statistics();
  struct outcome *o = run_of("box: [8, 8, 8]\ntime_step: 0.02\nsteps: 6000\nseed: 35\n"
                             "solvent: {per_cell: 5, collision_interval: 0.02, bath: phantoms, hydrodynamics: false}\n"
                             "shear: {rate: 0.1}\n"
                             "fibers: [{name: chain, count: 40, vertices: 5, mass: 5, bond_length: 0, spring: 20}]\n"
                             "crossing: {forbidden: false}\nobserve: {temperature: {every: 5}}\n",
                             OBSERVE_TEMPERATURE);
  /* phantoms of a cell have its middle's flow: at most rate^2/12 M is added to the heat bath's kT */
  const struct sample t = mean_of(o, "vertex", 20);
  print_message("  vertex %.5f +- %.5f\n", t.mean, sample_error(&t));
  assert_close(t.mean, 1.0, 4.5 * sample_error(&t) + 0.01 * 5.0 / 12.0);
  end_of(o);
}

/* DPD by drift-split: kT = 1 is that of half a step ahead. Half a step later the repulsion has changed it by
 * omega^2 dt^2/4, at dt = 0.06 some 4 %. Temperature, profile and the kinetic part of the pressure. */
static void pairs_by_halves(void **unused)
{
  (void)unused;
  test_begin_statistics();
  static const char text[] =
      "box: [5, 5, 5]\ntime_step: 0.06\nsteps: 1500\nseed: 36\norder: drift-split\n"
      "medium: {kind: pairs, rate: 9, draw: cayley, weight: quadratic, density: 3, repulsion: 25}\n"
      "observe: {from: 100, %s}\n";
  char scene[512];
  snprintf(scene, sizeof scene, text, "temperature: {every: 5}");
  struct outcome *o = run_of(scene, OBSERVE_TEMPERATURE);
  const struct sample t = mean_of(o, "solvent", 20);
  print_message("  solvent %.5f +- %.5f\n", t.mean, sample_error(&t));
  assert_close(t.mean, 1.0, 4.5 * sample_error(&t) + 0.003); /* the error of fourth order, and of Shardlow's pairs */
  end_of(o);
  snprintf(scene, sizeof scene, text, "profile: {every: 5, slabs: 1}");
  o = run_of(scene, OBSERVE_PROFILE);
  const double heat = kept_value(o->kept, "profile", 0, "temperature"),
               error = kept_value(o->kept, "profile", 0, "temperature_error");
  assert_close(heat, 1.0, 4.5 * error + 0.003);
  end_of(o);
}

/* --- energies ----------------------------------------------------------------------------------------------------- */

/* The columns of energies make up the total. */
static void parts_make_the_total(void **unused)
{
  (void)unused;
  struct outcome *o =
      run_of("box: [4, 4, 4]\ntime_step: 0.02\nsteps: 20\nseed: 37\n"
             "medium: {kind: pairs, rate: 9, draw: relax, weight: quadratic, density: 3, repulsion: 25}\n"
             "fibers: [{name: chain, count: 5, vertices: 5, mass: 1, bond_length: 0, spring: 20}]\n"
             "crossing: {forbidden: false}\nobserve: {conserved: {every: 5}}\n",
             OBSERVE_CONSERVED);
  for (size_t k = 0; k < o->rows.count; k++) {
    double sum = 0.0;
    for (size_t c = 1; strcmp(o->header[c], "total") != 0; c++)
      sum += at(o, k, o->header[c]);
    assert_close(sum, at(o, k, "total"), 1e-9 * fabs(sum));
    assert_true(at(o, k, "total") > 1000.0);
  }
  end_of(o);
}

/* --- motion ------------------------------------------------------------------------------------------------------- */

/* Beads that go at v, whatever forces say: the drift is v where nothing accelerates everything, v - a t/2 less where a
 * force does. */
static void drift_is_that_of_the_places(void **unused)
{
  (void)unused;
  static const struct {
    const char *name, *box;
    double background; /* acceleration of everything */
  } rows[] = {
      {"no-slip",
       "solvent: {per_cell: 5, collision_interval: 0.1, acceleration: [0.05, 0, 0]}\nwalls: {kind: no-slip}\n", 0.0},
      {"slip", "solvent: {per_cell: 5, collision_interval: 0.1, acceleration: [0.05, 0, 0]}\nwalls: {kind: slip}\n",
       0.05 * 320.0 / 328.0},
      {"sine", "solvent: {per_cell: 5, collision_interval: 0.1, acceleration: [0.05, 0, 0], profile: sine}\n", 0.0},
      {"reverse", "solvent: {per_cell: 5, collision_interval: 0.1, acceleration: [0.05, 0, 0], profile: reverse}\n",
       0.0},
      {"periodic", "solvent: {per_cell: 5, collision_interval: 0.1, acceleration: [0.05, 0, 0]}\n",
       0.05 * 320.0 / 328.0},
      {"private", "medium: {kind: private, rate: 1}\n", 0.0},
  };
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    char text[512];
    snprintf(text, sizeof text,
             "box: [4, 4, 4]\ntime_step: 0.1\nsteps: 16\n%sfibers: [{name: bead, count: 4, vertices: 1, mass: 2}]\n"
             "observe: {dynamics: {every: 1}}\n",
             rows[k].box);
    struct scene scene = scene_of(text);
    struct state state;
    struct observers *o = observers_create(&scene.observe, &scene.model);
    assert_true(state_alloc(&state, &scene.model));
    for (state.step = 0; state.step <= 16; state.step++) {
      for (uint32_t v = 0; v < 4; v++)
        state.position[v] =
            point_move((struct point){0, LATTICE_CELL, 0}, (struct vec3){0.3 * 0.1 * (double)state.step, 0, 0});
      assert_true(observers_sample(o, &scene.model, &state, NULL));
    }
    struct kept *kept = keep_summaries(o, &scene.model);
    size_t row = 0;
    while (kept_value(kept, "dynamics-bead", row, "time") < 1.55)
      row++;
    print_message("  %s: %.17g\n", rows[k].name, kept_value(kept, "dynamics-bead", row, "drift_x"));
    assert_close(kept_value(kept, "dynamics-bead", row, "drift_x"), 0.3 - 0.5 * rows[k].background * 1.6, 1e-9);
    free(kept);
    observers_free(o);
    state_free(&state);
    scene_free(&scene);
  }
}

/* In a plane directions at random have S = 0 in the mean of many; that of space would be 1/4 there. */
static void order_in_a_plane(void **unused)
{
  (void)unused;
  struct outcome *o = run_of("box: [40, 40, 1]\ndimensions: 2\ntime_step: 0.02\nsteps: 0\nseed: 38\n"
                             "solvent: {per_cell: 3, collision_interval: 0.02}\n"
                             "fibers: [{name: rod, count: 2000, vertices: 2, mass: 3, bond_length: 0.5, spring: 100}]\n"
                             "crossing: {forbidden: false}\nobserve: {orientation: {every: 1}}\n",
                             OBSERVE_ORIENTATION);
  /* n independent directions: sqrt(pi/4n) in the mean, its scatter half of it */
  assert_close(kept_value(o->kept, "orientation-rod", 0, "S"), 0.0198, 5.0 * 0.0104);
  end_of(o);
}

/* What a net force accelerates is no equilibrium: it pulls the solvent, behind which fibers lag. */
static void no_memory_of_what_is_accelerated(void **unused)
{
  (void)unused;
  struct scene scene = scene_of("box: [6, 6, 6]\ntime_step: 0.1\nsteps: 1\n"
                                "solvent: {per_cell: 5, collision_interval: 0.1, acceleration: [2, 0, 0]}\n"
                                "fibers: [{name: point, count: 60, vertices: 1, mass: 5}]\n");
  assert_non_null(meaning_refusal(&scene.model, OBSERVE_MEMORY));
  scene_free(&scene);
}

/* Gaussian chains of four in a bath, in a plane and in space. A mean over components is one over those that there are:
 * <v.v>/d = kT/M of vertices and kT/4M of centers. A bond of such a chain has <b_x^2> K = kT, whatever d, so each of
 * three adds (kT)^2 to <s_ab^2> of every shear component, of which a plane has one. The leap-frog's bonds have
 * 1/(1 - (omega dt)^2/4) of it, omega^2 = K (2 - sqrt 2, 2, 2 + sqrt 2)/M: 0.25 % in the mean of the squares. */
static void means_over_the_components_that_there_are(void **unused)
{
  (void)unused;
  test_begin_statistics();
  for (int d = 2; d <= 3; d++) {
    char text[512];
    snprintf(text, sizeof text,
             "box: [10, 10, %d]\ndimensions: %d\ntime_step: 0.05\nsteps: 4000\nseed: 43\n"
             "medium: {kind: private, rate: 1}\n"
             "fibers: [{name: chain, count: 60, vertices: 4, mass: 2, bond_length: 0, spring: 2}]\n"
             "crossing: {forbidden: false}\nobserve: {memory: {every: 10}}\n",
             d == 2 ? 1 : 10, d);
    struct outcome *o = run_of(text, OBSERVE_MEMORY);
    const struct {
      const char *column;
      double expected;
    } rows[] = {{"vertices", 0.5}, {"center", 0.125}, {"stress_memory", 3.0 * 1.0025}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
      char error[64];
      snprintf(error, sizeof error, "%s_error", rows[k].column);
      print_message("  %s in %d dimensions:", rows[k].column, d);
      assert_sigma(kept_value(o->kept, "memory-chain", 0, rows[k].column),
                   kept_value(o->kept, "memory-chain", 0, error), rows[k].expected, 4.5);
    }
    end_of(o);
  }
}

/* The first row of contacts is the first that has a time before it. */
static void contacts_begin_with_a_rate(void **unused)
{
  (void)unused;
  struct outcome *o =
      run_of("box: [4, 4, 4]\ntime_step: 0.05\nsteps: 20\nmedium: {kind: private, rate: 1}\n"
             "fibers: [{name: chain, count: 20, vertices: 5, mass: 3, bond_length: 0.5, spring: 100, bending: 2}]\n"
             "observe: {collisions: {every: 4}}\n",
             OBSERVE_COLLISIONS);
  assert_int_equal(o->rows.count, 5);
  assert_close(at(o, 0, "time"), 0.2, 1e-12);
  for (size_t k = 0; k < 5; k++)
    assert_true(isfinite(at(o, k, "rate_over_theory")));
  assert_close(at(o, 0, "rate_per_vertex"), at(o, 0, "executed") / (0.2 * 100.0), 1e-12);
  end_of(o);
}

/* The first row of the stress is the first that has an average. */
static void stress_begins_with_an_average(void **unused)
{
  (void)unused;
  struct outcome *o =
      run_of("box: [4, 4, 4]\ntime_step: 0.05\nsteps: 20\nsolvent: {per_cell: 5, collision_interval: 0.1}\n"
             "walls: {kind: no-slip, shear_rate: 0.1}\nobserve: {stress: {every: 1}}\n",
             OBSERVE_STRESS);
  assert_close(at(o, 0, "time"), 0.1, 1e-12);
  for (size_t k = 0; k < o->rows.count; k++)
    assert_true(isfinite(at(o, k, "sigma_lower")));
  assert_true(isfinite(at(o, 0, "sigma_xy")));
  end_of(o);
}

/* --- the whole table -----------------------------------------------------------------------------------------------
 */

#define CELLS "solvent: {per_cell: 3, collision_interval: 0.02}\n"
#define CHAINS "fibers: [{name: chain, count: 3, vertices: 4, mass: 3, bond_length: 0.5, spring: 100, bending: 2%s}]\n"

/* A scene for each circumstance, and more keys of its fibers; NULL: without fibers. */
static const struct {
  const char *before, *more;
} examples[CIRCUMSTANCES] = {
    [ANYWHERE] = {CELLS, ""},
    [NO_FIBERS] = {CELLS "dumbbells: {spring: 20}\n", NULL},
    [NO_FIBERS_NO_DUMBBELLS] = {CELLS, NULL},
    [NO_BEAD] = {CELLS, ""},
    [NO_NETWORK] = {CELLS "bead: {radius: 1.5, center: [4, 4, 4]}\n", NULL},
    [NO_TRAP] = {CELLS "bead: {radius: 1.5, center: [4, 4, 4]}\n", NULL},
    [NO_PAIR_FORCES] = {CELLS, ""},
    [NO_TUBES] = {CELLS, ""},
    [NO_DUMBBELLS] = {CELLS, ""},
    [NO_PARTICLES] = {"medium: {kind: private, rate: 1}\n", ""},
    [NO_WALLS] = {CELLS, ""},
    [NO_BONDS] = {CELLS, NULL},
    [NO_FORCES] = {CELLS, ", frozen: true"},
    [IN_A_PLANE] = {CELLS "dimensions: 2\ncrossing: {forbidden: false}\n", ""},
    [IN_SHEAR] = {CELLS "shear: {rate: 0.1}\n", ""},
    [BETWEEN_WALLS] = {CELLS "walls: {kind: no-slip}\n", ""},
    [IN_A_FLOW] = {CELLS "walls: {kind: no-slip, shear_rate: 0.1}\n", ""},
    [BY_A_FORCE_ON_FIBERS] = {"medium: {kind: private, rate: 1}\n", ", force: [1, 0, 0]"},
    [ACCELERATED] = {"solvent: {per_cell: 3, collision_interval: 0.02, acceleration: [0.1, 0, 0]}\n", ""},
    [IN_A_BATH_WITH_FLOW] = {"solvent: {per_cell: 3, collision_interval: 0.02, bath: phantoms, hydrodynamics: false}\n",
                             ""},
    [IN_PAIRS] = {"medium: {kind: pairs, rate: 4, density: 3, repulsion: 25}\ncrossing: {forbidden: false}\n", ""},
    [PERMUTED] = {"solvent: {per_cell: 3, collision_interval: 0.02, hydrodynamics: false}\n", ""},
    [OVERDAMPED] = {"medium: {kind: overdamped, rate: 1}\ncrossing: {forbidden: false}\n", ""},
    [INEXTENSIBLE] = {"medium: {kind: overdamped, rate: 1, inextensible: true}\ncrossing: {forbidden: false}\n", ""},
    [DRIFT_SPLIT] = {CELLS "order: drift-split\n", ""},
    [THICK] = {CELLS "crossing: {rule: event-driven}\n", ", diameter: 0.1"},
    [BESIDE_HELD] = {CELLS, ", held: ends"},
    [NOT_CROSSABLE] = {CELLS, ""},
    [LONG_AND_BENDING] = {CELLS, ""},
    [WITH_DUMBBELLS] = {CELLS "dumbbells: {spring: 20}\n", ""},
    [WITH_A_BEAD] = {CELLS
                     "bead: {radius: 1.5, center: [4, 4, 4], drive: {spring: 10}}\ncrossing: {rule: event-driven}\n",
                     ""},
};

static void example(enum circumstance where, const char *observe, char *text, size_t size)
{
  char chains[256] = "";
  if (examples[where].more)
    snprintf(chains, sizeof chains, CHAINS, examples[where].more);
  snprintf(text, size, "box: [8, 8, %d]\ntime_step: 0.02\nsteps: 8\n%s%sobserve:%s\n", where == IN_A_PLANE ? 1 : 8,
           examples[where].before, chains, observe);
}

/* A scene that asks for what has no meaning is refused at the key, with the words of the table. */
static void refuses(enum circumstance where, enum observable which)
{
  char observe[64], text[1024], place[32];
  snprintf(observe, sizeof observe, "\n  %s: {every: 2%s}", observable_names[which],
           which == OBSERVE_PROFILE ? ", slabs: 2" : "");
  example(where, observe, text, sizeof text);
  struct scene scene;
  struct message message;
  if (read_whole(text, &scene, &message))
    fail_msg("taken: %s", text);
  size_t lines = 0;
  for (const char *c = strstr(text, "observe:"); c > text; c--)
    lines += c[-1] == '\n';
  snprintf(place, sizeof place, ":%zu:", lines + 2);
  if (!strstr(message.text, place) || !strstr(message.text, observable_names[which]) ||
      !strstr(message.text, "; allowed "))
    fail_msg("%s\n%s", text, message.text);
}

/* A row of the table as it should be: those columns are there that no row of meanings leaves out, and hold numbers. */
static void has_columns(const struct model *m, enum observable which, size_t columns, const char *const *names)
{
  for (size_t k = 0; k < meaning_count; k++) {
    const struct meaning *row = &meanings[k];
    char list[256];
    snprintf(list, sizeof list, "%s", row->columns ? row->columns : "");
    for (char *word = strtok(list, " "); word && row->of == which && row->verdict == LEFT_OUT;
         word = strtok(NULL, " ")) {
      bool there = false;
      for (size_t c = 0; c < columns; c++)
        there |= strncmp(names[c], word, strlen(word)) == 0 &&
                 (names[c][strlen(word)] == '\0' || strcmp(names[c] + strlen(word), "_error") == 0);
      if (there && meaning_holds(row->where, m))
        fail_msg("%s of %s is there", word, observable_names[which]);
    }
  }
}

struct check {
  const struct model *model;
  enum observable which;
  size_t tables;
};

static bool check_summary(void *context, const struct observe_table *table)
{
  struct check *c = context;
  has_columns(c->model, c->which, table->columns, table->column);
  for (size_t k = 0; k < table->columns; k++)
    if (!observe_unit(table->column[k]))
      fail_msg("%s has no unit", table->column[k]);
  c->tables++;
  return true;
}

static bool check_series(void *context, enum observable which, size_t columns, const double *values)
{
  struct check *c = context;
  const char *names[OBSERVE_MOST_COLUMNS];
  assert_int_equal(observe_series_columns(c->model, which, names), columns);
  has_columns(c->model, which, columns, names);
  for (size_t k = 0; k < columns; k++) {
    if (!observe_unit(names[k]))
      fail_msg("%s has no unit", names[k]);
    if (!isfinite(values[k]))
      fail_msg("%s: %s is no number at time %g", observable_names[which], names[k], values[0]);
  }
  c->tables++;
  return true;
}

/* Whether a word of the table names a column that some scene has. */
static bool named[512];

static void mark(enum observable which, size_t columns, const char *const *names)
{
  for (size_t k = 0; k < meaning_count; k++)
    for (size_t c = 0; c < columns && meanings[k].of == which && meanings[k].columns; c++)
      named[k] |= strstr(meanings[k].columns, names[c]) != NULL;
}

static bool mark_summary(void *context, const struct observe_table *table)
{
  mark(*(enum observable *)context, table->columns, table->column);
  return true;
}

/* Each observable in each circumstance: taken, and its table is as it says; or refused. */
static void everything_everywhere(void **unused)
{
  (void)unused;
  for (int where = 0; where < CIRCUMSTANCES; where++) {
    char text[1024];
    example((enum circumstance)where, " {from: 0}", text, sizeof text);
    struct scene scene = scene_of(text);
    if (!meaning_holds((enum circumstance)where, &scene.model))
      fail_msg("no example:\n%s", text);
    struct state state;
    struct work work;
    assert_true(state_alloc(&state, &scene.model) && work_alloc(&work, &scene.model) &&
                start_state(&state, &scene.model, &work));
    for (int k = 0; k < OBSERVABLES; k++) {
      if (meaning_refusal(&scene.model, (enum observable)k)) {
        refuses((enum circumstance)where, (enum observable)k);
        continue;
      }
      struct observe_plan plan = {.slabs = 2};
      plan.every[k] = 2;
      struct observers *o = observers_create(&plan, &scene.model);
      struct check check = {&scene.model, (enum observable)k, 0};
      const struct observe_sink sink = {check_series, &check};
      observers_watch(o, &work);
      for (int step = 0; step < 8; step++) {
        assert_true(observers_sample(o, &scene.model, &state, &sink));
        assert_true(step_advance(&state, &scene.model, &work, observers_contacts(o)));
      }
      assert_true(observers_summaries(o, &scene.model, check_summary, &check));
      assert_true(observers_summaries(o, &scene.model, mark_summary, &check.which));
      const char *names[OBSERVE_MOST_COLUMNS];
      mark((enum observable)k, observe_series_columns(&scene.model, (enum observable)k, names), names);
      observers_free(o);
    }
    work_free(&work);
    state_free(&state);
    scene_free(&scene);
  }
  assert_true(meaning_count < sizeof named);
  for (size_t k = 0; k < meaning_count; k++)
    if (meanings[k].columns && !named[k])
      fail_msg("no table has a column of '%s'", meanings[k].columns);
}

/* Does a row say that a drift of fibers counts in this column? */
static bool tells_of_drift(const struct model *m, enum observable of, const char *column)
{
  bool found = false;
  for (size_t k = 0; k < meaning_count; k++)
    found |= meanings[k].of == of && meanings[k].verdict == MEANS && meanings[k].columns &&
             (meanings[k].where == BY_A_FORCE_ON_FIBERS || meanings[k].where == ACCELERATED) &&
             meaning_holds(meanings[k].where, m) && strstr(meanings[k].columns, column);
  return found;
}

/* Squares of velocities about another velocity than their own mean hold the square of the difference. */
static void what_a_drift_counts_in_is_told(void **unused)
{
  (void)unused;
  static const struct {
    enum observable of;
    const char *column;
  } rows[] = {{OBSERVE_TEMPERATURE, "solvent_x"},  {OBSERVE_TEMPERATURE, "vertex"}, {OBSERVE_STRESS, "sigma_xy"},
              {OBSERVE_STRESS, "sigma_xy_fibers"}, {OBSERVE_STRESS, "N1"},          {OBSERVE_STRESS, "pressure"},
              {OBSERVE_PRESSURE, "p_xy"}};
  static const char *const forces[] = {CELLS "fibers: [{name: a, count: 2, vertices: 1, mass: 5, force: [1, 1, 0]}]\n",
                                       "solvent: {per_cell: 3, collision_interval: 0.02, acceleration: [0.1, 0, 0]}\n"
                                       "fibers: [{name: a, count: 2, vertices: 1, mass: 5}]\n"};
  for (size_t f = 0; f < sizeof forces / sizeof *forces; f++) {
    char text[1024];
    snprintf(text, sizeof text, "box: [8, 8, 8]\ntime_step: 0.02\nsteps: 8\n%s", forces[f]);
    struct scene scene = scene_of(text);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
      if (!tells_of_drift(&scene.model, rows[k].of, rows[k].column))
        fail_msg("%s: %s: no word of a drift in\n%s", observable_names[rows[k].of], rows[k].column, text);
    scene_free(&scene);
  }
}

/* A table of zeros and nan means nothing. */
static void tables_of_nothing_are_refused(void **unused)
{
  (void)unused;
  struct scene alone = scene_of("box: [8, 8, 8]\ntime_step: 0.02\nsteps: 8\nmedium: {kind: private, rate: 1}\n"
                                "fibers: [{name: a, count: 2, vertices: 1, mass: 5}]\n");
  assert_non_null(meaning_refusal(&alone.model, OBSERVE_PROFILE));
  assert_non_null(meaning_refusal(&alone.model, OBSERVE_DUMBBELLS));
  scene_free(&alone);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(dumbbells_are_a_gas),
      cmocka_unit_test(a_sheared_gas),
      cmocka_unit_test(an_accelerated_gas),
      cmocka_unit_test(a_gas_between_walls),
      cmocka_unit_test(thick_rods_are_a_gas),
      cmocka_unit_test(vertices_in_shear),
      cmocka_unit_test(pairs_by_halves),
      cmocka_unit_test(parts_make_the_total),
      cmocka_unit_test(drift_is_that_of_the_places),
      cmocka_unit_test(everything_everywhere),
      cmocka_unit_test(what_a_drift_counts_in_is_told),
      cmocka_unit_test(tables_of_nothing_are_refused),
      cmocka_unit_test(order_in_a_plane),
      cmocka_unit_test(no_memory_of_what_is_accelerated),
      cmocka_unit_test(means_over_the_components_that_there_are),
      cmocka_unit_test(stress_begins_with_an_average),
      cmocka_unit_test(contacts_begin_with_a_rate),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
