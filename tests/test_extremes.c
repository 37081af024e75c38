/* Scenes at and beyond the edges of what is sensible: each runs right, or is refused by the scene reader, or ends in a
 * fault that says why. A table of scenes, and the box filled in ways no scene would. */
#include "exact.h"
#include "fiber/force.h"
#include "scene/scene.h"
#include "system/fiber_kind.h"
#include "theory/theory.h"

#include "../validation/measure/energy.h"

/* --- what a run must keep ----------------------------------------------------------------------------------------- */

static struct vec3 total_momentum(const struct test_run *r, double *scale)
{
  struct vec3 p = {0, 0, 0};
  *scale = 0.0;
  for (uint32_t i = 0; i < r->state.solvent.n; i++) {
    p = vec3_add(p, solvent_v(&r->state, i));
    *scale += vec3_norm(solvent_v(&r->state, i));
  }
  for (uint32_t v = 0; v < r->state.vertices; v++) {
    p = vec3_add_scaled(p, r->model.mass[v], r->state.velocity[v]);
    *scale += r->model.mass[v] * vec3_norm(r->state.velocity[v]);
  }
  return p;
}

/* Everybody is somewhere, moves at a normal speed, and the total momentum is what it was, but in a bath, which
 * takes it up. */
static void assert_sane(const char *name, const struct test_run *r, struct vec3 before, double cells)
{
  double scale;
  const struct vec3 p = total_momentum(r, &scale);
  const double rounding = 1e-12 * scale + 0x1p-40 * cells * (double)r->state.step;
  const double tolerance = model_has_phantoms(&r->model) ? INFINITY : rounding;
  if (!(vec3_norm(vec3_sub(p, before)) <= tolerance))
    fail_msg("%s: momentum changes by %g", name, vec3_norm(vec3_sub(p, before)));
  for (uint32_t i = 0; i < r->state.solvent.n; i++) {
    const struct solvent *s = &r->state.solvent;
    const int64_t *edge = r->model.box.edge;
    assert_true(s->x[i] >= 0 && s->y[i] >= 0 && s->z[i] >= 0);
    assert_true(s->x[i] < edge[0] && s->y[i] < edge[1] && s->z[i] < edge[2]);
    assert_true(isfinite(s->vx[i]) && isfinite(s->vy[i]) && isfinite(s->vz[i]));
  }
  for (uint32_t v = 0; v < r->state.vertices; v++)
    assert_true(isfinite(vec3_norm(r->state.velocity[v])));
}

/* --- scenes ------------------------------------------------------------------------------------------------------- */

enum outcome { RUNS, REFUSED, FAULTS };

struct extreme {
  const char *name, *box, *time_step, *solvent, *fibers; /* NULL: none */
  enum outcome outcome;
  const char *why; /* part of the message, if it does not run */
};

#define SOLVENT "per_cell: 5, collision_interval: 0.02"
#define FIBERS "count: 4, vertices: 5, mass: 5, bond_length: 0.5, spring: 300, bending: 5"

static const struct extreme extremes[] = {
    /* boxes and bonds */
    {"box of one cell", "1, 1, 1", "0.01", SOLVENT,
     "count: 2, vertices: 4, mass: 5, bond_length: 0.2, spring: 3000, bending: 2", RUNS, NULL},
    {"box of 1 x 1 x 3", "1, 1, 3", "0.01", SOLVENT,
     "count: 4, vertices: 4, mass: 5, bond_length: 0.2, spring: 3000, bending: 2", RUNS, NULL},
    {"box of 2 x 1 x 1", "2, 1, 1", "0.01", SOLVENT, "count: 3, vertices: 8, mass: 5, bond_length: 0.2, spring: 3000",
     RUNS, NULL},
    {"box of two cells", "2, 2, 2", "0.01", SOLVENT, FIBERS, RUNS, NULL},
    {"box of three cells", "3, 3, 3", "0.01", SOLVENT, FIBERS, RUNS, NULL},
    {"needle of a box", "1024, 1, 1", "0.01", SOLVENT, "count: 9, vertices: 2, mass: 5, bond_length: 0.2, spring: 3000",
     RUNS, NULL},
    {"box of no cells", "0, 4, 4", "0.01", SOLVENT, NULL, REFUSED, "box"},
    {"box of 1025 cells", "1025, 1, 1", "0.01", SOLVENT, NULL, REFUSED, "box"},
    {"bonds near half the box", "3, 3, 3", "0.01", SOLVENT,
     "count: 4, vertices: 5, mass: 5, bond_length: 1.35, spring: 3000", RUNS, NULL},
    {"bonds of half the box", "3, 3, 3", "0.01", SOLVENT,
     "count: 4, vertices: 5, mass: 5, bond_length: 1.5, spring: 3000", REFUSED, "half the shortest edge"},
    {"bonds that reach half the box", "2, 2, 2", "0.01", SOLVENT,
     "count: 90, vertices: 5, mass: 5, bond_length: 0, spring: 3", FAULTS, "longer than half the shortest box edge"},
    {"one fiber fills the box", "2, 2, 2", "0.01", SOLVENT,
     "count: 1, vertices: 400, mass: 5, bond_length: 0.3, spring: 1000", RUNS, NULL},
    /* few of everything */
    {"one vertex", "4, 4, 4", "0.01", SOLVENT, "count: 1, vertices: 1, mass: 5, bond_length: 1, spring: 1", RUNS, NULL},
    {"one vertex alone", "1, 1, 1", "0.01", NULL, "count: 1, vertices: 1, mass: 5, bond_length: 1, spring: 1", RUNS,
     NULL},
    {"one bond alone", "2, 2, 2", "0.01", NULL, "count: 1, vertices: 2, mass: 5, bond_length: 0.5, spring: 300", RUNS,
     NULL},
    {"no vertices", "4, 4, 4", "0.01", SOLVENT, NULL, RUNS, NULL},
    {"no solvent", "4, 4, 4", "0.01", NULL, FIBERS, RUNS, NULL},
    {"nothing", "4, 4, 4", "0.01", NULL, NULL, REFUSED, "nothing to simulate"},
    {"ring of three", "4, 4, 4", "0.01", SOLVENT,
     "count: 3, vertices: 3, ring: true, mass: 5, bond_length: 0.5, spring: 100", RUNS, NULL},
    {"ring of two", "4, 4, 4", "0.01", SOLVENT,
     "count: 3, vertices: 2, ring: true, mass: 5, bond_length: 0.5, spring: 100", REFUSED, "3 or more"},
    {"no fiber of a kind", "4, 4, 4", "0.01", SOLVENT, "count: 0, vertices: 2, mass: 5, bond_length: 1, spring: 1",
     REFUSED, "count"},
    {"too many vertices", "4, 4, 4", "0.01", SOLVENT,
     "count: 2000000000, vertices: 2, mass: 5, bond_length: 0.1, spring: 1e4", REFUSED, "2147483647"},
    /* solvent */
    {"one particle", "10, 10, 10", "0.01", "per_cell: 0.001, collision_interval: 0.02", FIBERS, RUNS, NULL},
    {"less than one particle", "10, 10, 10", "0.01", "per_cell: 1e-5, collision_interval: 0.02", NULL, REFUSED,
     "allowed: 1 to 2147483647"},
    {"ten thousand in a cell", "1, 1, 1", "0.01", "per_cell: 10000, collision_interval: 0.02", NULL, RUNS, NULL},
    {"a collision in a thousand steps", "4, 4, 4", "0.001", "per_cell: 5, collision_interval: 1", FIBERS, RUNS, NULL},
    {"flights longer than the box", "2, 2, 2", "1", "per_cell: 5, collision_interval: 10", NULL, RUNS, NULL},
    {"an interval that is no multiple", "4, 4, 4", "0.01", "per_cell: 5, collision_interval: 0.025", NULL, REFUSED,
     "collision_interval"},
    {"hardly any rotation", "4, 4, 4", "0.01", SOLVENT ", rotation_angle: 1e-9", FIBERS, RUNS, NULL},
    {"rotation by 180", "4, 4, 4", "0.01", SOLVENT ", rotation_angle: 180", FIBERS, RUNS, NULL},
    {"no hydrodynamics", "4, 4, 4", "0.01", SOLVENT ", hydrodynamics: false, thermostat: rescale", FIBERS, RUNS, NULL},
    {"one phantom in a thousand cells", "4, 4, 4", "0.01",
     "per_cell: 0.001, collision_interval: 0.02, hydrodynamics: false, bath: phantoms", FIBERS, RUNS, NULL},
    {"a thousand phantoms in a cell", "4, 4, 4", "0.01",
     "per_cell: 1000, collision_interval: 0.02, hydrodynamics: false, bath: phantoms", FIBERS, RUNS, NULL},
    {"phantoms without fibers", "4, 4, 4", "0.01", SOLVENT ", hydrodynamics: false, bath: phantoms", NULL, REFUSED,
     "and there are none"},
    /* masses, springs, bends */
    {"mass 0.01", "4, 4, 4", "0.002", "per_cell: 5, collision_interval: 0.02",
     "count: 4, vertices: 5, mass: 0.01, bond_length: 0.5, spring: 300", RUNS, NULL},
    {"mass 1000", "4, 4, 4", "0.01", SOLVENT, "count: 4, vertices: 5, mass: 1000, bond_length: 0.5, spring: 300", RUNS,
     NULL},
    {"mass 65536", "4, 4, 4", "0.01", SOLVENT, "count: 4, vertices: 5, mass: 65536, bond_length: 0.5, spring: 300",
     RUNS, NULL},
    {"mass 1e-6", "4, 4, 4", "0.01", SOLVENT, "count: 4, vertices: 5, mass: 1e-6, bond_length: 0.5, spring: 300",
     REFUSED, "rounded to a multiple"},
    {"omega dt = 1.98", "4, 4, 4", "0.01", SOLVENT, "count: 4, vertices: 2, mass: 5, bond_length: 0.5, spring: 98010",
     RUNS, NULL},
    {"omega dt = 2.01", "4, 4, 4", "0.01", SOLVENT, "count: 4, vertices: 2, mass: 5, bond_length: 0.5, spring: 101003",
     REFUSED, "unstable"},
    {"a spring of 1e9", "4, 4, 4", "1e-5", "per_cell: 5, collision_interval: 1e-3",
     "count: 4, vertices: 3, mass: 5, bond_length: 0.5, spring: 1e9", RUNS, NULL},
    {"a spring of 1e9, coarse steps", "4, 4, 4", "0.01", SOLVENT,
     "count: 4, vertices: 3, mass: 5, bond_length: 0.5, spring: 1e9", REFUSED, "unstable"},
    {"a bend of 1e9", "4, 4, 4", "0.01", SOLVENT,
     "count: 4, vertices: 3, mass: 5, bond_length: 0.5, spring: 100, bending: 1e9", REFUSED, "unstable"},
    {"springs without length", "6, 6, 6", "0.01", SOLVENT, "count: 20, vertices: 5, mass: 5, bond_length: 0, spring: 8",
     RUNS, NULL},
    /* speed */
    {"Mach 60: one fiber, moves of 1.6 a0", "4, 4, 4", "0.02", SOLVENT,
     "count: 1, vertices: 2, mass: 5, bond_length: 0.5, spring: 300", RUNS, NULL},
    /* vertices move one at a time: in a fast flow each sweeps through all that stands, and moves are refused wildly */
    {"Mach 60: many fibers", "4, 4, 4", "0.02", SOLVENT,
     "count: 9, vertices: 5, mass: 5, bond_length: 0.5, spring: 300", FAULTS, "a heated system"},
    {"Mach 77: moves of 2 a0", "4, 4, 4", "0.02", SOLVENT,
     "count: 1, vertices: 2, mass: 5, bond_length: 0.5, spring: 300", FAULTS, "vertex"},
    {"a force of 1e6", "4, 4, 4", "0.01", SOLVENT,
     "count: 1, vertices: 5, mass: 5, bond_length: 0.5, spring: 300, force: [1e6, 0, 0]", FAULTS, "vertex"},
    {"momentum beyond the sums", "1, 1, 1", "0.01", "per_cell: 10000, collision_interval: 0.02", NULL, FAULTS,
     "beyond the range of its cell's sums"},
};

/* The flow of scenes whose name begins so. */
static const struct {
  const char *name, *flow;
} flows[] = {{"Mach 60", "[80, 40, -20]"}, {"Mach 77", "[100, 0, 0]"}, {"momentum beyond", "[100, 0, 0]"}};

static void write_scene(const struct extreme *e, char text[2000])
{
  const char *flow = "[0, 0, 0]";
  for (int k = 0; k < 3; k++)
    if (strncmp(e->name, flows[k].name, strlen(flows[k].name)) == 0)
      flow = flows[k].flow;
  snprintf(text, 2000, "box: [%s]\ntime_step: %s\nsteps: 400\nflow: %s\n%s%s%s%s%s%s", e->box, e->time_step, flow,
           e->solvent ? "solvent: {" : "", e->solvent ? e->solvent : "", e->solvent ? "}\n" : "",
           e->fibers ? "fibers: [{name: f, " : "", e->fibers ? e->fibers : "", e->fibers ? "}]\n" : "");
}

static bool run_scene(const struct extreme *e, struct test_run *r, char text[512])
{
  struct vec3 before;
  double scale;
  bool ok = state_alloc(&r->state, &r->model) && work_alloc(&r->work, &r->model) &&
            start_state(&r->state, &r->model, &r->work);
  before = total_momentum(r, &scale);
  for (int k = 0; ok && k < 400; k++)
    ok = step_advance(&r->state, &r->model, &r->work, NULL);
  if (ok)
    assert_sane(e->name, r, before, (double)box_cell_count(&r->model.box));
  else
    fault_describe(&r->work.fault, text, 512);
  work_free(&r->work);
  state_free(&r->state);
  return ok;
}

static void judge_scene(const struct extreme *e)
{
  struct scene scene;
  struct message message = {.text = ""};
  enum outcome outcome = REFUSED;
  char why[sizeof message.text] = "";
  char text[2000];
  write_scene(e, text);
  if (scene_read_text(e->name, text, strlen(text), &scene, &message)) {
    struct test_run r = {.model = scene.model};
    outcome = run_scene(e, &r, why) ? RUNS : FAULTS;
    scene_free(&scene);
  } else {
    snprintf(why, sizeof why, "%s", message.text);
  }
  static const char *const words[] = {"runs", "refused", "stops"};
  print_message("  %-34s %s%s%s\n", e->name, words[outcome], why[0] ? ": " : "", why);
  if (outcome != e->outcome || (e->why && !strstr(why, e->why)))
    fail_msg("%s: %s %s; expected: %s %s", e->name, words[outcome], why, words[e->outcome], e->why ? e->why : "");
}

static void scenes_run_or_say_why_not(void **unused)
{
  (void)unused;
  for (size_t k = 0; k < sizeof extremes / sizeof extremes[0]; k++)
    judge_scene(&extremes[k]);
}

/* --- cells -------------------------------------------------------------------------------------------------------- */

static double kinetic_energy(const struct state *s)
{
  double e = 0.0;
  for (uint32_t i = 0; i < s->solvent.n; i++)
    e += 0.5 * vec3_dot(solvent_v(s, i), solvent_v(s, i));
  return e;
}

/* All particles in a heap smaller than a cell, the other cells empty; then one particle per cell, in its middle. After
 * a step momentum and energy are what they were; a particle alone in its cell keeps its velocity. */
static void cells_of_all_occupancies(void **unused)
{
  (void)unused;
  for (int k = 0; k < 2; k++) {
    const bool heap = k == 0;
    struct model m = test_model(6, 5, 4, heap ? 800 : 1, 1e-6, 1);
    struct dice d = {dice_seed(1601)};
    struct test_run r = dice_run(m, &d);
    struct solvent *s = &r.state.solvent;
    for (uint32_t i = 0; i < s->n; i++) {
      const uint32_t cell = heap ? 7 : i;
      s->x[i] = (2 * (cell % 6) + 1) * (LATTICE_CELL / 2) + (heap ? dice_integer(&d, -1000000, 1000000) : 0);
      s->y[i] = (2 * (cell / 6 % 5) + 1) * (LATTICE_CELL / 2);
      s->z[i] = (2 * (cell / 30) + 1) * (LATTICE_CELL / 2);
    }
    double scale;
    struct vec3 before = total_momentum(&r, &scale);
    const double energy = kinetic_energy(&r.state);
    const struct vec3 some = solvent_v(&r.state, 3);
    test_steps(&r, 1);
    assert_sane("cells", &r, before, 120);
    assert_close(kinetic_energy(&r.state), energy, 1e-9 * energy);
    const double turned = vec3_norm(vec3_sub(solvent_v(&r.state, 3), some));
    assert_true(heap ? turned > 0.01 : turned == 0.0);
    test_end(&r);
  }
}

/* --- six decades
 * ------------------------------------------------------------------------------------------------------ */

/* Springs from 3 to 3e6 and bends from 1e-2 to 1e4, each at a twentieth of its own period over 2 pi: the energy of
 * phantoms keeps to a percent or so, with and without solvent. */
static void constants_over_six_decades(void **unused)
{
  (void)unused;
  for (int k = 0; k < 28; k++) {
    const bool bends = k % 2, solvent = k / 2 % 2;
    const double spring = bends ? 300.0 : 3.0 * pow(10.0, k / 4), bending = bends ? 1e-2 * pow(10.0, k / 4) : 0.0;
    struct model m = test_model(10, 10, 10, solvent ? 1 : 0, 0.01, 2);
    m.crossing.forbidden = false;
    m.seed = dice_seed(1602) + (uint64_t)k;
    struct fiber_kind *kind = test_add_kind(&m, 20, 4);
    kind->spring = spring;
    kind->bending = bending;
    kind->bond_length = spring > 10.0 ? 0.5 : 0.0;
    m.time_step = 0.05 / fiber_highest_frequency(kind);
    m.solvent.collision_interval = 2 * m.time_step;
    struct test_run r = test_start(m);
    double least = INFINITY, most = -INFINITY;
    for (int n = 0; n < 100; n++) {
      test_steps(&r, 20);
      const struct energy e = energy_on_step(&r.state, &r.model, &r.work);
      const double part = energy_total(&e);
      least = fmin(least, part);
      most = fmax(most, part);
    }
    if (!(most - least < 0.01 * most))
      fail_msg("spring %g, bending %g: energy from %g to %g", spring, bending, least, most);
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(scenes_run_or_say_why_not),
      cmocka_unit_test(cells_of_all_occupancies),
      cmocka_unit_test(constants_over_six_decades),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
