/* Every fast kernel gives the bits of the plain one: state, cells, sums, turns, faults. Each test runs for each kernel
 * that this processor can run, in the same program as the plain one; it fails if it cannot run any of those compiled.
 * States are thrown by dice. There is no tolerance, so there are no false alarms. */
#include "exact.h"
#include "kernel/choose.h"
#include "mpc/cell.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "mpc/mpc.h"
#include "mpc/rule.h"
#include "mpc/sort.h"

enum { STEP = 4 };

/* Two runs in the same state: the first collides by the plain kernel, the second by a fast one. */
struct pair {
  struct test_run plain, fast;
};

static void copy_state(struct state *to, const struct state *from)
{
  const struct solvent *s = &from->solvent;
  const struct solvent *t = &to->solvent;
  memcpy(t->x, s->x, s->n * sizeof *s->x);
  memcpy(t->y, s->y, s->n * sizeof *s->y);
  memcpy(t->z, s->z, s->n * sizeof *s->z);
  memcpy(t->vx, s->vx, s->n * sizeof *s->vx);
  memcpy(t->vy, s->vy, s->n * sizeof *s->vy);
  memcpy(t->vz, s->vz, s->n * sizeof *s->vz);
  to->solvent_lag = from->solvent_lag;
  to->solvent_time = from->solvent_time;
}

/* The model of both runs must be made twice: a run owns what it allocates. */
static struct pair start(struct model (*make)(void), const struct kernel *kernel, uint64_t seed)
{
  struct dice d = {seed}, same = {seed};
  struct pair p = {.plain = dice_run(make(), &d), .fast = dice_run(make(), &same)};
  struct test_run *runs[] = {&p.plain, &p.fast};
  for (int k = 0; k < 2; k++) {
    runs[k]->state.solvent_lag = 2 * runs[k]->model.solvent.interval_steps;
    runs[k]->work.mpc.since_sort = 1; /* a sort would overwrite cells and sums */
    runs[k]->work.mpc.keeps_sums = true;
  }
  p.plain.work.mpc.kernel = kernel_plain;
  p.fast.work.mpc.kernel = kernel_mix(kernel, &p.fast.model);
  return p;
}

static void end(struct pair *p)
{
  test_end(&p->plain);
  test_end(&p->fast);
}

#define assert_bits(a, b, n, what)                                                                                     \
  do {                                                                                                                 \
    if ((n) > 0 && memcmp(a, b, (size_t)(n) * sizeof *(a)) != 0)                                                       \
      fail_msg("%s: %s differ from those of the plain kernel", name, what);                                            \
  } while (0)

static void assert_same_turns(const struct mpc *a, const struct mpc *b, const char *name)
{
  for (uint32_t k = 0; k < a->cells; k++) {
    const struct cell_turn *t = &a->turn[k], *u = &b->turn[k];
    assert_bits(&t->active, &u->active, 1, "flags of cells");
    if (t->active == 0.0) {
      assert_true(isfinite(u->center.x + u->center.y + u->center.z));
      continue;
    }
    assert_bits(&t->center, &u->center, 1, "centers");
    assert_bits(&t->axis, &u->axis, 1, "axes");
    assert_bits(&t->factor, &u->factor, 1, "factors");
    if (a->rule->spinning)
      assert_bits(&a->middle[k], &b->middle[k], 1, "lattice points next to centres of mass");
  }
}

/* In the order of memory, which is the same for both. */
static void assert_same(const struct pair *p, const char *name)
{
  const struct state *a = &p->plain.state, *b = &p->fast.state;
  const struct solvent *s = &a->solvent, *t = &b->solvent;
  const struct mpc *c = &p->plain.work.mpc, *d = &p->fast.work.mpc;
  assert_bits(s->x, t->x, s->n, "x");
  assert_bits(s->y, t->y, s->n, "y");
  assert_bits(s->z, t->z, s->n, "z");
  assert_bits(s->vx, t->vx, s->n, "v_x");
  assert_bits(s->vy, t->vy, s->n, "v_y");
  assert_bits(s->vz, t->vz, s->n, "v_z");
  assert_bits(a->velocity, b->velocity, a->vertices, "velocities of vertices");
  assert_bits(c->solvent_cell, d->solvent_cell, s->n, "cells");
  assert_bits(c->sum, d->sum, c->cells, "sums");
  if (c->thermostat)
    assert_bits(c->relative, d->relative, c->cells, "energies of cells");
  assert_same_turns(c, d, name);
  assert_true(state_hash(a) == state_hash(b));
}

static bool collide(struct test_run *r, uint64_t step)
{
  r->work.fault = (struct fault){0};
  return mpc_collide(&r->state, &r->model, &r->work.mpc, step, &r->work.fault);
}

static void assert_same_collision(struct pair *p, uint64_t step, const char *name)
{
  const bool plain = collide(&p->plain, step), fast = collide(&p->fast, step);
  const struct fault *a = &p->plain.work.fault, *b = &p->fast.work.fault;
  if (plain != fast || a->code != b->code || a->entity != b->entity || a->step != b->step)
    fail_msg("%s: fault %d of %lld, plain: %d of %lld", name, (int)b->code, (long long)b->entity, (int)a->code,
             (long long)a->entity);
  if (plain)
    assert_same(p, name);
}

/* --- kernels and scenes ------------------------------------------------------------------------------------------ */

/* The lanes of AVX2 and AVX-512 with any processor's instructions: each order of lanes is seen on each machine. */
extern const struct kernel kernel_four, kernel_eight;

static void for_each_kernel(void (*test)(const struct kernel *))
{
  for (size_t k = 0; k < kernel_row_count; k++)
    if (kernel_rows[k].runs())
      test(kernel_rows[k].kernel);
  test(&kernel_four);
  test(&kernel_eight);
}

/* 1223 particles: no multiple of any register, and more than four chunks. */
static struct model dense(void)
{
  struct model m = test_model(5, 7, 6, 5.0, 0.01, 2);
  test_particles(&m, 1223);
  m.seed = 77;
  return m;
}

static struct model accelerated(void)
{
  struct model m = dense();
  m.solvent.acceleration = (struct vec3){0.3, 0.0, -0.7};
  return m;
}

static struct model turned_by(double degrees)
{
  struct model m = dense();
  m.solvent.rotation_angle = degrees;
  return m;
}

static struct model by_130(void)
{
  return turned_by(130.0);
}

static struct model by_minus_60(void)
{
  return turned_by(60.0);
}

static struct model kept(enum thermostat_kind kind, double degrees)
{
  struct model m = turned_by(degrees);
  m.solvent.thermostat = kind;
  return m;
}

static struct model rescaled(void)
{
  return kept(THERMOSTAT_RESCALE, 90.0);
}

static struct model canonical(void)
{
  return kept(THERMOSTAT_MAXWELL_BOLTZMANN, 130.0);
}

static struct model layered(void)
{
  return kept(THERMOSTAT_RESCALE_LAYERS, 90.0);
}

static struct model thin(void)
{
  struct model m = dense();
  test_particles(&m, 101);
  return m;
}

static struct model few(void)
{
  struct model m = dense();
  test_particles(&m, 3);
  return m;
}

static struct model between_walls(void)
{
  struct model m = dense();
  m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .fill = FILL_PLANAR, .shear_rate = 0.1};
  return m;
}

static struct model sheared(void)
{
  struct model m = dense();
  m.shear.rate = 0.05;
  return m;
}

/* So high that most blocks of particles are clear of both ends. */
static struct model high(struct model m)
{
  m.box = test_model(3, 64, 2, 5.0, 0.01, 2).box;
  test_particles(&m, 1901);
  m.walls.shear_rate *= 0.1; /* walls and images stay slower than sound */
  m.shear.rate *= 0.1;
  return m;
}

static struct model high_walls(void)
{
  return high(between_walls());
}

static struct model high_walls_accelerated(void)
{
  struct model m = high_walls();
  m.solvent.acceleration = (struct vec3){0.3, 0.0, 0.0};
  return m;
}

static struct model high_slip(void)
{
  struct model m = high_walls();
  m.walls = (struct wall_model){.kind = WALL_SLIP};
  return m;
}

static struct model high_sheared(void)
{
  return high(sheared());
}

static struct model springs(void)
{
  struct model m = dense();
  test_particles(&m, 1222);
  m.dumbbells = (struct dumbbell_model){.spring = 1.0, .fraction = 0.5};
  return m;
}

static struct model high_springs(void)
{
  struct model m = high(springs());
  test_particles(&m, 1922);
  return m;
}

static struct model springs_at_walls(void)
{
  struct model m = high_springs();
  m.walls = high_walls().walls;
  return m;
}

static struct model springs_sheared(void)
{
  struct model m = high_springs();
  m.shear = high_sheared().shear;
  return m;
}

static struct model swapped(void)
{
  struct model m = dense();
  m.solvent.hydrodynamics = false;
  return m;
}

static struct model with_fibers(void)
{
  struct model m = dense();
  test_add_kind(&m, 5, 9);
  return m;
}

static struct model longest(void)
{
  struct model m = test_model(1024, 2, 3, 5.0, 0.01, 2);
  test_particles(&m, 30011);
  return m;
}

static struct model driven(void)
{
  struct model m = accelerated();
  m.solvent.profile = PROFILE_SINE;
  m.solvent.acceleration = (struct vec3){0.3, 0.0, 0.0};
  return m;
}

/* Seven cells: fewer than the largest register takes. */
static struct model tiny(void)
{
  struct model m = test_model(7, 1, 1, 5.0, 0.01, 2);
  test_particles(&m, 61);
  return m;
}

static struct model plane(void)
{
  struct model m = dense();
  m.box = box_of_cells(14, 15, 1);
  test_particles(&m, 1223);
  m.dimensions = 2;
  return m;
}

static struct model drawn(struct model m)
{
  m.solvent.rule = RULE_AT_A;
  return m;
}

static struct model at_a(void)
{
  return drawn(dense());
}

static struct model at_a_accelerated(void)
{
  return drawn(accelerated());
}

static struct model at_a_plane(void)
{
  return drawn(plane());
}

static struct model at_a_fibers(void)
{
  return drawn(with_fibers());
}

static struct model at_a_walls(void)
{
  return drawn(between_walls());
}

static struct model at_a_sheared(void)
{
  return drawn(sheared());
}

static struct model at_a_high_walls(void)
{
  return drawn(high_walls());
}

static struct model at_a_high_sheared(void)
{
  return drawn(high_sheared());
}

static struct model at_a_springs(void)
{
  return drawn(springs());
}

static struct model at_a_thin(void)
{
  return drawn(thin());
}

static struct model at_a_few(void)
{
  return drawn(few());
}

static struct model at_a_swapped(void)
{
  return drawn(swapped());
}

static struct model at_a_driven(void)
{
  return drawn(driven());
}

static struct model at_a_tiny(void)
{
  return drawn(tiny());
}

static struct model spinning(struct model m)
{
  m.solvent.rule = RULE_AT_PLUS_A;
  return m;
}

static struct model at_plus_a(void)
{
  return spinning(dense());
}

static struct model at_plus_a_accelerated(void)
{
  return spinning(accelerated());
}

static struct model at_plus_a_plane(void)
{
  return spinning(plane());
}

static struct model at_plus_a_fibers(void)
{
  return spinning(with_fibers());
}

static struct model at_plus_a_walls(void)
{
  return spinning(between_walls());
}

static struct model at_plus_a_high_walls(void)
{
  return spinning(high_walls());
}

static struct model at_plus_a_slip(void)
{
  return spinning(high_slip());
}

static struct model at_plus_a_sheared(void)
{
  return spinning(sheared());
}

static struct model at_plus_a_high_sheared(void)
{
  return spinning(high_sheared());
}

static struct model at_plus_a_springs(void)
{
  return spinning(springs());
}

static struct model at_plus_a_thin(void)
{
  return spinning(thin());
}

static struct model at_plus_a_few(void)
{
  return spinning(few());
}

static struct model at_plus_a_swapped(void)
{
  return spinning(swapped());
}

static struct model at_plus_a_tiny(void)
{
  return spinning(tiny());
}

/* Two particles in each cell: most cells with company are on a line. */
static struct model at_plus_a_pairs(void)
{
  struct model m = at_plus_a();
  test_particles(&m, 401);
  return m;
}

/* 19,000 particles, which the test of crowded cells brings together. */
static struct model at_plus_a_many(void)
{
  struct model m = at_plus_a();
  m.solvent.per_cell = 90.0;
  test_particles(&m, 19001);
  return m;
}

static const struct scene {
  const char *name;
  struct model (*make)(void);
} scenes[] = {{"dense", dense},
              {"accelerated", accelerated},
              {"130 degrees", by_130},
              {"60 degrees", by_minus_60},
              {"rescale", rescaled},
              {"maxwell-boltzmann", canonical},
              {"layers", layered},
              {"thin", thin},
              {"few", few},
              {"walls", between_walls},
              {"sheared", sheared},
              {"high walls", high_walls},
              {"high walls, accelerated", high_walls_accelerated},
              {"high slip walls", high_slip},
              {"high and sheared", high_sheared},
              {"dumbbells", springs},
              {"dumbbells, walls", springs_at_walls},
              {"dumbbells, sheared", springs_sheared},
              {"swap", swapped},
              {"fibers", with_fibers},
              {"1024 cells", longest},
              {"driven", driven},
              {"seven cells", tiny},
              {"plane", plane},
              {"AT-a", at_a},
              {"AT-a, accelerated", at_a_accelerated},
              {"AT-a, plane", at_a_plane},
              {"AT-a, fibers", at_a_fibers},
              {"AT-a, walls", at_a_walls},
              {"AT-a, sheared", at_a_sheared},
              {"AT-a, high walls", at_a_high_walls},
              {"AT-a, high and sheared", at_a_high_sheared},
              {"AT-a, dumbbells", at_a_springs},
              {"AT-a, thin", at_a_thin},
              {"AT-a, few", at_a_few},
              {"AT-a, swap", at_a_swapped},
              {"AT-a, driven", at_a_driven},
              {"AT-a, seven cells", at_a_tiny},
              {"AT+a", at_plus_a},
              {"AT+a, accelerated", at_plus_a_accelerated},
              {"AT+a, plane", at_plus_a_plane},
              {"AT+a, fibers", at_plus_a_fibers},
              {"AT+a, walls", at_plus_a_walls},
              {"AT+a, high walls", at_plus_a_high_walls},
              {"AT+a, slip walls", at_plus_a_slip},
              {"AT+a, sheared", at_plus_a_sheared},
              {"AT+a, high and sheared", at_plus_a_high_sheared},
              {"AT+a, dumbbells", at_plus_a_springs},
              {"AT+a, thin", at_plus_a_thin},
              {"AT+a, few", at_plus_a_few},
              {"AT+a, swap", at_plus_a_swapped},
              {"AT+a, seven cells", at_plus_a_tiny},
              {"AT+a, pairs", at_plus_a_pairs}};

/* --- tests ------------------------------------------------------------------------------------------------------- */

/* Ten collisions of each scene, with a new lag before each. */
static void all_scenes(const struct kernel *kernel)
{
  for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
    struct pair p = start(scenes[k].make, kernel, dice_seed(800) + k);
    char name[96];
    snprintf(name, sizeof name, "%s, %s", kernel->name, scenes[k].name);
    for (uint64_t step = 2; step <= 20; step += 2) {
      assert_same_collision(&p, step, name);
      p.plain.state.solvent_lag = p.fast.state.solvent_lag = 2 * p.plain.model.solvent.interval_steps;
    }
    end(&p);
  }
}

static void bits_of_all_scenes(void **unused)
{
  (void)unused;
  for_each_kernel(all_scenes);
}

/* Cells are far in memory only where there are many; what is then asked for ahead must not change anything. */
static void prefetched(const struct kernel *kernel)
{
  struct pair p = start(dense, kernel, dice_seed(820));
  p.fast.work.mpc.prefetch = true;
  assert_same_collision(&p, STEP, kernel->name);
  end(&p);
}

static void asking_ahead_changes_nothing(void **unused)
{
  (void)unused;
  for_each_kernel(prefetched);
}

/* Places at the edges of box and cells, velocities that round at the half, zeros of both signs. */
static void edges(const struct kernel *kernel)
{
  static struct model (*const makes[])(void) = {dense,
                                                accelerated,
                                                at_a,
                                                at_a_accelerated,
                                                rescaled,
                                                high_walls,
                                                high_walls_accelerated,
                                                high_slip,
                                                high_sheared,
                                                at_a_high_walls,
                                                at_plus_a,
                                                at_plus_a_pairs};
  static const double fixed[] = {0.0, -0.0, 0x1p-46, -0x1p-46, 0x1.8p-45, 0x1p-1060, 31.25, -31.25, 50.0, -50.0};
  for (uint64_t k = 0; k < 96; k++) {
    struct pair p = start(makes[k % 12], kernel, dice_seed(830) + k);
    struct dice d = {dice_seed(831) + k};
    struct solvent *s = &p.plain.state.solvent;
    int64_t *x[3] = {s->x, s->y, s->z};
    double *v[3] = {s->vx, s->vy, s->vz};
    for (uint32_t i = 0; i < s->n; i++)
      for (int a = 0; a < 3; a++) {
        const int64_t cells = p.plain.model.box.cells[a], edge = p.plain.model.box.edge[a];
        const int64_t near = dice_integer(&d, 0, cells) * LATTICE_CELL + dice_integer(&d, -2, 1);
        x[a][i] = near < 0 ? 0 : near >= edge ? edge - 1 : near;
        if (dice_integer(&d, 0, 1))
          v[a][i] = fixed[dice_integer(&d, 0, (int64_t)(sizeof fixed / sizeof *fixed) - 1)];
      }
    copy_state(&p.fast.state, &p.plain.state);
    assert_same_collision(&p, STEP + k, kernel->name);
    end(&p);
  }
}

static void bits_at_edges(void **unused)
{
  (void)unused;
  for_each_kernel(edges);
}

/* Members at one place, on one line, in the farthest corners of their cell, next to each other; so many in one cell
 * that sums in halves could not tell the integer (spin.h), or just not so many. */
static void special_cells(const struct kernel *kernel)
{
  for (uint64_t k = 0; k < 40; k++) {
    struct pair p = start(k < 4 ? at_plus_a_many : k % 2 ? at_plus_a : at_plus_a_fibers, kernel, dice_seed(895) + k);
    struct dice d = {dice_seed(896) + k};
    struct solvent *s = &p.plain.state.solvent;
    const struct point shift = grid_shift(&p.plain.model, STEP + k);
    const int64_t low[3] = {LATTICE_CELL - shift.x, LATTICE_CELL - shift.y, LATTICE_CELL - shift.z};
    const uint32_t crowd = k % 2 ? 2047 : 2048 + (uint32_t)dice_integer(&d, 0, 9000);
    const double fastest = k == 1 ? 120.0 : k == 3 ? 240.0 : 0.0; /* 2047 of them are near the limit of cell_add */
    for (uint32_t i = 0; i < s->n && fastest > 0.0; i++)
      s->vx[i] = fastest * (i % 2 ? 1.0 : -1.0), s->vy[i] = fastest, s->vz[i] = -fastest;
    p.plain.state.solvent_lag = p.fast.state.solvent_lag = 0;
    for (uint32_t i = 0; i < s->n; i++) {
      int64_t *x[3] = {&s->x[i], &s->y[i], &s->z[i]};
      const int64_t kind = (int64_t)(i / 8 % 5), along = dice_integer(&d, 0, LATTICE_CELL - 1);
      for (int a = 0; a < 3; a++) {
        const int64_t there = k >= 4 ? low[a] + LATTICE_CELL * (int64_t)(i / 8 /
                                                                         (a == 0   ? 1
                                                                          : a == 1 ? 4
                                                                                   : 20) %
                                                                         4)
                                     : low[a] + LATTICE_CELL * (i >= crowd && a == 0);
        const int64_t corner = dice_integer(&d, 0, 1) * (LATTICE_CELL - 1), near = 77 + dice_integer(&d, 0, 1);
        *x[a] = there + (kind == 0   ? 12345
                         : kind == 1 ? along
                         : kind == 2 ? corner
                         : kind == 3 ? near
                                     : along / (a + 1));
      }
    }
    copy_state(&p.fast.state, &p.plain.state);
    assert_same_collision(&p, STEP + k, kernel->name);
    end(&p);
  }
}

static void bits_of_special_cells(void **unused)
{
  (void)unused;
  for_each_kernel(special_cells);
}

/* One collision of both, from the state of the plain one; then the end of both. True if it has no fault. */
static bool collide_once(struct pair *p, const char *name)
{
  copy_state(&p->fast.state, &p->plain.state);
  assert_same_collision(p, STEP, name);
  const bool fine = p->plain.work.fault.code == FAULT_NONE;
  end(p);
  return fine;
}

/* Some particles with velocities beyond what a register takes: flights over several boxes, up to LATTICE_MAX_MOVE and
 * beyond; momenta and energies beyond lattice_round; infinities and NaN. Same state, or the same fault. */
static void wild(const struct kernel *kernel)
{
  static const double wild_speeds[] = {400.0,       -400.0,  1500.0, 2.0e3, -9.0e4, 1.1e5,    -1.1e5,
                                       0x1p52,      -0x1p60, 1e300,  0x1p8, 63.9,   INFINITY, -INFINITY,
                                       (double)NAN, 0x1p7,   -0x1p7, 0x1p6, -0x1p6, 300.0};
  const int64_t kinds = sizeof wild_speeds / sizeof *wild_speeds;
  static struct model (*const makes[])(void) = {accelerated,
                                                dense,
                                                at_a,
                                                dense,
                                                at_a_accelerated,
                                                at_a,
                                                at_a_fibers,
                                                rescaled,
                                                canonical,
                                                high_walls,
                                                high_walls_accelerated,
                                                high_sheared,
                                                at_a_high_walls,
                                                high_springs,
                                                at_plus_a,
                                                at_plus_a_accelerated};
  uint32_t all[2] = {0, 0};
  for (uint64_t k = 0; k < 1600; k++) {
    struct pair p = start(makes[k % 16], kernel, dice_seed(840) + k);
    struct dice d = {dice_seed(841) + k};
    struct solvent *s = &p.plain.state.solvent;
    double *v[3] = {s->vx, s->vy, s->vz};
    for (int64_t n = dice_integer(&d, 1, 3); n > 0; n--) {
      const int64_t i = dice_integer(&d, 0, 3) ? dice_integer(&d, 0, s->n - 1) : s->n - dice_integer(&d, 1, 9);
      v[dice_integer(&d, 0, 2)][i] = wild_speeds[k % 2 ? dice_integer(&d, 0, kinds - 1) : dice_integer(&d, 0, 2)];
    }
    if (k % 5 == 0) /* a flight so long that velocities in the range of momenta come back to the box from afar */
      p.plain.state.solvent_lag = 2 * (uint32_t)dice_integer(&d, 1, 2000);
    all[collide_once(&p, kernel->name)]++;
  }
  assert_true(all[false] > 40 && all[true] > 40);
}

static void far_flights_and_faults_are_the_same(void **unused)
{
  (void)unused;
  for_each_kernel(wild);
}

/* Particles in the order of their heights, some of them at rest at both ends of the box. Two or three have wild
 * velocities, in one block or in neighboring ones: so blocks with faults along different axes meet, and the last block
 * is not full. */
static void wild_in_layers(const struct kernel *kernel)
{
  static const double wild_speeds[] = {400.0, -400.0, 2.0e3, -9.0e4, 1.1e5, -1.1e5, 0x1p60, INFINITY, (double)NAN};
  const int64_t kinds = sizeof wild_speeds / sizeof *wild_speeds;
  static struct model (*const makes[])(void) = {high_walls, high_walls_accelerated, high_slip, high_sheared,
                                                at_a_high_walls};
  uint32_t all[2] = {0, 0};
  for (uint64_t k = 0; k < 500; k++) {
    struct pair p = start(makes[k % 5], kernel, dice_seed(890) + k);
    struct dice d = {dice_seed(891) + k};
    struct solvent *s = &p.plain.state.solvent;
    const int64_t n = s->n, edge = p.plain.model.box.edge[1],
                  highest = model_has_walls(&p.plain.model) ? edge : edge - 1;
    double *v[3] = {s->vx, s->vy, s->vz};
    for (int64_t i = 0; i < n; i++)
      s->y[i] = edge / n * i;
    for (int64_t m = 0; m < 20; m++) {
      const int64_t i = dice_integer(&d, 0, n - 1);
      s->y[i] = highest * dice_integer(&d, 0, 1), s->vy[i] = 0.0; /* they stay there */
    }
    const int64_t at = dice_integer(&d, 0, 2) ? dice_integer(&d, 0, n - 1) : n - 1 - dice_integer(&d, 0, 44);
    const bool far = k / 5 % 3 > 0, level = k / 5 % 3 > 1; /* too far; none of them along y */
    for (int64_t m = dice_integer(&d, 2, 3); m > 0; m--) {
      const int64_t near = at + dice_integer(&d, -80, 80), i = near < 0 ? 0 : near >= n ? n - 1 : near;
      const int64_t axis = level ? 2 * dice_integer(&d, 0, 1) : dice_integer(&d, 0, 2);
      v[axis][i] = wild_speeds[far ? dice_integer(&d, 2, kinds - 1) : dice_integer(&d, 0, 1)];
    }
    all[collide_once(&p, kernel->name)]++;
  }
  assert_true(all[false] > 40 && all[true] > 40);
}

static void faults_near_boundaries_are_the_same(void **unused)
{
  (void)unused;
  for_each_kernel(wild_in_layers);
}

static void assert_all_zero(const struct mpc *c, const char *name)
{
  const struct cell_sum zero = {0};
  for (uint32_t k = 0; k < c->cells; k++)
    assert_bits(&c->sum[k], &zero, 1, "cleared sums");
}

static void assert_same_sums(const struct mpc *a, const struct mpc *b, const char *name)
{
  assert_bits(a->sum, b->sum, a->cells, "sums");
}

static struct model even(void)
{
  struct model m = dense();
  m.box = test_model(4, 8, 6, 5.0, 0.01, 2).box;
  return m;
}

static struct model odd(void)
{
  struct model m = dense();
  m.box = test_model(5, 7, 5, 5.0, 0.01, 2).box;
  return m;
}

static struct model with_thermostat(struct model m, enum thermostat_kind kind)
{
  m.solvent.thermostat = kind;
  return m;
}

static struct model rescaled_fibers(void)
{
  return with_thermostat(with_fibers(), THERMOSTAT_RESCALE);
}

static struct model rescaled_thin(void)
{
  return with_thermostat(thin(), THERMOSTAT_RESCALE);
}

static struct model canonical_fibers(void)
{
  return with_thermostat(with_fibers(), THERMOSTAT_MAXWELL_BOLTZMANN);
}

static struct model canonical_thin(void)
{
  return with_thermostat(thin(), THERMOSTAT_MAXWELL_BOLTZMANN);
}

static struct model canonical_odd(void)
{
  return with_thermostat(odd(), THERMOSTAT_MAXWELL_BOLTZMANN);
}

static struct model (*const unread[])(void) = {dense, with_fibers, at_a,      at_a_fibers,    thin,
                                               even,  odd,         at_plus_a, at_plus_a_pairs};
static struct model (*const scaled[])(void) = {rescaled, rescaled_fibers, rescaled_thin};
static struct model (*const redrawn[])(void) = {canonical, canonical_fibers, canonical_thin, canonical_odd};
enum {
  UNREAD = sizeof unread / sizeof *unread,
  SCALED = sizeof scaled / sizeof *scaled,
  REDRAWN = sizeof redrawn / sizeof *redrawn
};

/* Where nobody reads the sums of a collision, a kernel clears them when it solves the cells, or when their energies are
 * drawn: of which there are a multiple of any register, or not. A sort in between leaves its counts there. Layers do
 * not clear them. */
static void cleared(const struct kernel *kernel)
{
  for (uint64_t m = 0; m <= UNREAD + SCALED + REDRAWN; m++) {
    const bool clears = m < UNREAD + SCALED + REDRAWN;
    struct pair p = start(m < UNREAD            ? unread[m]
                          : m < UNREAD + SCALED ? scaled[m - UNREAD]
                          : clears              ? redrawn[m - UNREAD - SCALED]
                                                : layered,
                          kernel, dice_seed(850) + m);
    struct mpc *c = &p.fast.work.mpc;
    c->keeps_sums = false;
    for (uint64_t step = STEP; step < STEP + 12; step += 2) {
      assert_true(collide(&p.plain, step) && collide(&p.fast, step));
      assert_true(state_hash(&p.plain.state) == state_hash(&p.fast.state));
      assert_same_turns(&p.plain.work.mpc, c, kernel->name);
      assert_int_equal(c->sum_is_clear, clears);
      if (clears)
        assert_all_zero(c, kernel->name);
      else
        assert_same_sums(&p.plain.work.mpc, c, kernel->name);
      if (step == STEP + 2) {
        mpc_sort(&p.plain.state, &p.plain.model, &p.plain.work.mpc);
        mpc_sort(&p.fast.state, &p.fast.model, c);
      }
      p.plain.state.solvent_lag = p.fast.state.solvent_lag = 2 * p.fast.model.solvent.interval_steps;
    }
    end(&p);
  }
}

struct outcomes {
  uint32_t sure, doubts, faults;
};

/* One particle has this speed where nobody reads the sums. If the kernel's bounds allow a doubt, the sums are made
 * anew: then they are not clear. */
static void collide_with_one_fast(struct model (*make)(void), const struct kernel *kernel, uint64_t seed, double speed,
                                  struct outcomes *all)
{
  struct pair p = start(make, kernel, seed);
  struct mpc *c = &p.fast.work.mpc;
  c->keeps_sums = false;
  p.plain.state.solvent.vx[3] = p.fast.state.solvent.vx[3] = speed;
  p.plain.state.solvent_lag = p.fast.state.solvent_lag = 0;
  const bool fine = collide(&p.plain, STEP);
  assert_true(collide(&p.fast, STEP) == fine);
  assert_int_equal(p.fast.work.fault.code, p.plain.work.fault.code);
  assert_int_equal(p.fast.work.fault.entity, p.plain.work.fault.entity);
  if (fine) {
    assert_true(state_hash(&p.plain.state) == state_hash(&p.fast.state));
    assert_same_turns(&p.plain.work.mpc, c, kernel->name);
  }
  if (fine && !c->sum_is_clear)
    assert_same_sums(&p.plain.work.mpc, c, kernel->name);
  all->sure += fine && c->sum_is_clear;
  all->doubts += fine && !c->sum_is_clear;
  all->faults += !fine;
  end(&p);
}

/* One particle is so fast that a sum may have wrapped, by the bounds that the kernel returns. Then the sums are made
 * once more and tested, and the answer is that of the plain kernel. */
static void doubtful(const struct kernel *kernel)
{
  struct outcomes all = {0};
  for (uint64_t m = 0; m < UNREAD; m++)
    for (uint64_t k = 0; k < 20; k++)
      collide_with_one_fast(unread[m], kernel, dice_seed(860) + k, 2e4 * pow(1.1, (double)k), &all);
  if (all.doubts < 5 || all.faults < 20)
    fail_msg("%s: %u doubts and %u faults", kernel->name, all.doubts, all.faults);
}

/* With one factor for all cells, the energies of all members make one sum, and no cell has its own. A member may be so
 * hot that its cell's may have wrapped, by the bounds. Then each cell is tested. Above 3e3 a0/t0 all energies together
 * have more than 53 bits. */
static void doubtful_energy(const struct kernel *kernel)
{
  struct outcomes all = {0};
  for (uint64_t m = 0; m < SCALED; m++)
    for (uint64_t k = 0; k < 40; k++)
      collide_with_one_fast(scaled[m], kernel, dice_seed(870) + k, 1e3 * pow(1.1, (double)k), &all);
  if (all.sure < 20 || all.doubts < 5 || all.faults < 20)
    fail_msg("%s: %u sure, %u doubts and %u faults", kernel->name, all.sure, all.doubts, all.faults);
}

/* Where energies of cells are drawn, the sums that were made once more are cleared afterwards; so doubts are not
 * counted. */
static void doubtful_cells(const struct kernel *kernel)
{
  struct outcomes all = {0};
  for (uint64_t m = 0; m < REDRAWN; m++)
    for (uint64_t k = 0; k < 50; k++)
      collide_with_one_fast(redrawn[m], kernel, dice_seed(880) + k, 1e3 * pow(1.1, (double)k), &all);
  if (all.sure < 20 || all.doubts > 0 || all.faults < 20)
    fail_msg("%s: %u sure, %u doubts and %u faults", kernel->name, all.sure, all.doubts, all.faults);
}

static void doubtful_sums_are_tested(void **unused)
{
  (void)unused;
  for_each_kernel(doubtful);
  for_each_kernel(doubtful_energy);
  for_each_kernel(doubtful_cells);
}

static void sums_are_cleared(void **unused)
{
  (void)unused;
  for_each_kernel(cleared);
}

/* The table of what a kernel does, written out once more. */
static void parts_by_scene(void **unused)
{
  (void)unused;
  static const struct {
    struct model (*make)(void);
    struct kernel_parts parts;
  } wanted[] = {{dense, {true, true, true}},
                {accelerated, {true, true, true}},
                {by_130, {true, true, true}},
                {rescaled, {true, true, true}},
                {thin, {true, true, false}},
                {swapped, {true, true, true}},
                {sheared, {true, true, true}},
                {springs, {true, true, true}},
                {plane, {true, false, true}},
                {between_walls, {true, true, true}},
                {with_fibers, {true, true, true}},
                {tiny, {true, false, true}},
                {at_a, {true, true, true}},
                {at_a_accelerated, {true, true, true}},
                {at_a_thin, {true, true, false}},
                {at_a_fibers, {true, true, true}},
                {at_a_sheared, {true, true, true}},
                {at_a_springs, {true, true, true}},
                {at_a_plane, {true, true, true}},
                {at_a_walls, {true, true, true}},
                {at_a_tiny, {true, false, true}},
                {at_plus_a, {true, true, true}},
                {at_plus_a_thin, {true, true, false}},
                {at_plus_a_fibers, {true, true, true}},
                {at_plus_a_walls, {true, true, true}},
                {at_plus_a_plane, {true, true, true}},
                {at_plus_a_tiny, {false, false, false}}};
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
    struct model m = wanted[k].make();
    test_finish(&m);
    const struct kernel_parts parts = kernel_parts_for(&m);
    assert_int_equal(parts.gather, wanted[k].parts.gather);
    assert_int_equal(parts.solve, wanted[k].parts.solve);
    assert_int_equal(parts.turn, wanted[k].parts.turn);
    model_free(&m);
  }
  struct model m = at_plus_a_many();
  m.solvent.per_cell = 300.0;
  test_finish(&m);
  assert_false(kernel_parts_for(&m).gather || kernel_parts_for(&m).solve || kernel_parts_for(&m).turn);
  model_free(&m);
}

/* Runs get what the table says, of the last row that the processor runs. */
static void runs_get_the_best(void **unused)
{
  (void)unused;
  const struct kernel *best = &kernel_plain;
  for (size_t k = 0; k < kernel_row_count; k++)
    best = kernel_rows[k].runs() ? kernel_rows[k].kernel : best;
  struct test_run r = test_start(dense());
  assert_ptr_equal(r.work.mpc.kernel.ways.gather, best->ways.gather);
  assert_ptr_equal(r.work.mpc.kernel.ways.solve, best->ways.solve);
  assert_ptr_equal(r.work.mpc.kernel.ways.energies, best->ways.energies);
  assert_ptr_equal(r.work.mpc.kernel.ways.canonical, best->ways.canonical);
  assert_ptr_equal(r.work.mpc.kernel.ways.turn, best->ways.turn);
  assert_true(work_add_everything(&r.work, &r.model));
  assert_ptr_equal(r.work.mpc.kernel.ways.gather, best->ways.gather);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bits_of_all_scenes),
      cmocka_unit_test(asking_ahead_changes_nothing),
      cmocka_unit_test(bits_at_edges),
      cmocka_unit_test(bits_of_special_cells),
      cmocka_unit_test(far_flights_and_faults_are_the_same),
      cmocka_unit_test(faults_near_boundaries_are_the_same),
      cmocka_unit_test(parts_by_scene),
      cmocka_unit_test(runs_get_the_best),
      cmocka_unit_test(sums_are_cleared),
      cmocka_unit_test(doubtful_sums_are_tested),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
