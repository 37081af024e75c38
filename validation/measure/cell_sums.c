/*
 * What order-independent cell sums cost, and what they do to conservation.
 *
 * Cost: the same loop over the same particles adds each one's momentum to its cell, by cell_add (64-bit integers in
 * units of 2^-44) or in plain doubles; ns per particle, medians of 15 alternating repetitions. Particles are sorted by
 * cell, as in a run, and binned on a shifted grid.
 *
 * Conservation: 10^4 collisions (binned on randomly shifted grids, streamed between) of one box with either kind of sum
 * and otherwise the same code; |change of total momentum| and relative change of energy, summed with compensation.
 */
#include "fluid/fluid.h"
#include "measure.h"
#include "mpc/grid.h"
#include "mpc/rules/srd.h"

#define REPETITIONS 15

struct plain_sum {
  double px, py, pz;
  uint64_t load; /* as in struct cell_sum */
};

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int by_size(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(double *x, size_t n)
{
  qsort(x, n, sizeof *x, by_size);
  return x[n / 2];
}

/* --- the two sums ------------------------------------------------------------------------------------------------- */

static void bin(struct run *run, struct point shift)
{
  const struct solvent *s = &run->state.solvent;
  for (uint32_t i = 0; i < s->n; i++)
    run->work.mpc.solvent_cell[i] = grid_cell_of(&run->model.box, (struct point){s->x[i], s->y[i], s->z[i]}, shift);
}

static uint64_t sum_integers(struct run *run)
{
  const struct solvent *s = &run->state.solvent;
  struct mpc *c = &run->work.mpc;
  const uint64_t load = cell_load(1.0);
  uint64_t span = 0;
  memset(c->sum, 0, (size_t)box_cell_count(&run->model.box) * sizeof *c->sum);
  for (uint32_t i = 0; i < s->n; i++)
    span |= cell_add(&c->sum[c->solvent_cell[i]], 1.0, load, (struct vec3){s->vx[i], s->vy[i], s->vz[i]});
  return span;
}

static void sum_doubles(struct run *run, struct plain_sum *sum)
{
  const struct solvent *s = &run->state.solvent;
  const uint32_t *cell = run->work.mpc.solvent_cell;
  const uint64_t load = cell_load(1.0);
  memset(sum, 0, (size_t)box_cell_count(&run->model.box) * sizeof *sum);
  for (uint32_t i = 0; i < s->n; i++) {
    struct plain_sum *c = &sum[cell[i]];
    c->px += s->vx[i];
    c->py += s->vy[i];
    c->pz += s->vz[i];
    c->load += load;
  }
}

/* --- cost --------------------------------------------------------------------------------------------------------- */

static void compare_cost(int edge)
{
  struct run run;
  run_start(&run, standard_model(edge, edge, edge, 5, 0.02, 1), 1);
  run_steps(&run, 1); /* sorts the particles */
  bin(&run, grid_shift(&run.model, 2));
  struct plain_sum *plain = calloc((size_t)box_cell_count(&run.model.box), sizeof *plain);
  double integers[REPETITIONS], doubles[REPETITIONS], collision[REPETITIONS];
  const double n = run.state.solvent.n;
  const int loops = 1 + (int)(4e6 / n);
  uint64_t span = 0;
  for (int k = 0; k < REPETITIONS; k++) {
    double start = now();
    for (int l = 0; l < loops; l++)
      span |= sum_integers(&run);
    integers[k] = (now() - start) / n / loops * 1e9;
    start = now();
    for (int l = 0; l < loops; l++)
      sum_doubles(&run, plain);
    doubles[k] = (now() - start) / n / loops * 1e9;
  }
  for (int k = 0; k < REPETITIONS; k++) {
    double start = now();
    run_steps(&run, (uint64_t)loops);
    collision[k] = (now() - start) / n / loops * 1e9;
  }
  double a = median(integers, REPETITIONS), b = median(doubles, REPETITIONS);
  printf("%2d^3: integers %.2f ns, doubles %.2f ns per particle: ratio %.2f, difference %+.2f ns; whole step %.2f ns\n",
         edge, a, b, a / b, a - b, median(collision, REPETITIONS));
  if (span == 0 || plain[0].load == UINT64_MAX)
    printf("no particles\n");
  free(plain);
  run_end(&run);
}

/* --- conservation ------------------------------------------------------------------------------------------------- */

struct totals {
  struct vec3 momentum;
  double energy;
};

/* Compensated sums (Neumaier), so that what is seen is not the rounding of the looking. */
static void add_to(double *sum, double *rest, double x)
{
  double t = *sum + x;
  *rest += fabs(*sum) >= fabs(x) ? (*sum - t) + x : (x - t) + *sum;
  *sum = t;
}

static struct totals totals(const struct solvent *s)
{
  double sum[4] = {0}, rest[4] = {0};
  for (uint32_t i = 0; i < s->n; i++) {
    const double v[3] = {s->vx[i], s->vy[i], s->vz[i]};
    for (int k = 0; k < 3; k++) {
      add_to(&sum[k], &rest[k], v[k]);
      add_to(&sum[3], &rest[3], 0.5 * v[k] * v[k]);
    }
  }
  return (struct totals){{sum[0] + rest[0], sum[1] + rest[1], sum[2] + rest[2]}, sum[3] + rest[3]};
}

/* The transform of each cell from plain sums, as cell_solve makes it from integers. */
static void solve_plain(struct run *run, const struct plain_sum *sum, uint64_t step)
{
  struct cell_turn *turn = run->work.mpc.turn;
  for (int64_t k = 0; k < box_cell_count(&run->model.box); k++) {
    turn[k] = (struct cell_turn){.factor = 1.0, .active = sum[k].load >> 40 >= 2};
    if (turn[k].active == 0.0)
      continue;
    turn[k].center = vec3_scale(1.0 / (double)(sum[k].load >> 40), (struct vec3){sum[k].px, sum[k].py, sum[k].pz});
    turn[k].axis = random_axis(run->model.seed, RANDOM_ROTATION_AXIS, step, (uint32_t)k);
  }
}

static void solve_integers(struct run *run, uint64_t step)
{
  struct mpc *c = &run->work.mpc;
  for (int64_t k = 0; k < box_cell_count(&run->model.box); k++) {
    cell_solve(&c->sum[k], &c->turn[k]);
    if (c->turn[k].active != 0.0)
      c->turn[k].axis = random_axis(run->model.seed, RANDOM_ROTATION_AXIS, step, (uint32_t)k);
  }
}

static void turn_all(struct run *run)
{
  struct solvent *s = &run->state.solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    const struct cell_turn *t = &run->work.mpc.turn[run->work.mpc.solvent_cell[i]];
    if (t->active == 0.0)
      continue;
    struct vec3 v = srd_apply(t, (struct vec3){s->vx[i], s->vy[i], s->vz[i]}, true, 0.0, 1.0, true);
    s->vx[i] = v.x;
    s->vy[i] = v.y;
    s->vz[i] = v.z;
  }
}

static void compare_conservation(bool integers, uint32_t collisions)
{
  struct run run;
  run_start(&run, standard_model(16, 16, 16, 5, 0.02, 1), 1);
  struct plain_sum *plain = calloc((size_t)box_cell_count(&run.model.box), sizeof *plain);
  const struct totals first = totals(&run.state.solvent);
  printf("%s sums:\n", integers ? "integer" : "double");
  for (uint32_t n = 1; n <= collisions; n++) {
    run.state.solvent_lag = 2;
    stop_unless(fluid_stream(&run.state, &run.model, &run.work.fault), &run);
    bin(&run, grid_shift(&run.model, n));
    if (integers) {
      (void)sum_integers(&run);
      solve_integers(&run, n);
    } else {
      sum_doubles(&run, plain);
      solve_plain(&run, plain, n);
    }
    turn_all(&run);
    if (n != collisions / 100 && n != collisions / 10 && n != collisions)
      continue;
    const struct totals t = totals(&run.state.solvent);
    printf("  after %5u collisions: momentum %.2e m a0/t0, energy %+.2e of itself\n", n,
           vec3_norm(vec3_sub(t.momentum, first.momentum)), t.energy / first.energy - 1.0);
  }
  free(plain);
  run_end(&run);
}

int main(int argc, char **argv)
{
  const double factor = effort(argc, argv);
  for (int edge = 8; edge <= 64; edge *= 2)
    compare_cost(edge);
  printf("16^3, 20480 particles\n");
  compare_conservation(true, (uint32_t)(factor * 1e4));
  compare_conservation(false, (uint32_t)(factor * 1e4));
  return 0;
}
