/*
 * Droplets of one liquid of dissipative particles in another (medium: {kind: pairs, second: ...}), density 3, rate 9,
 * repulsion A within each and BETWEEN: the pressure inside and outside of them. Laplace: the difference is 2 sigma/R.
 *
 * At the start the particles that are nearest to the middle of the box are made the second liquid. 20 t0 are left out.
 * Inside is what is nearer to the droplet's center than R - 1.5 a0, outside what is further than R + 1.5 a0; p of a
 * region is kT n/V plus a third of its particles' halves of r.F, over V. Both regions are more than the range of forces
 * away from the surface. R is that of the equimolar surface: of a ball of the inner density that, with the outer
 * density beyond it, has all particles of the second liquid.
 *
 * Output: comma-separated, a row per droplet; errors of 16 parts of the run.
 */
#include "../../tests/statistics.h"
#include "measure.h"
#include "medium/near.h"
#include "medium/repulsion.h"

#define STEP 0.04   /* t0 */
#define EVERY 5     /* steps between samples */
#define SKIP 500    /* steps */
#define MARGIN 1.5  /* a0 from the surface */
#define DENSITY 3.0 /* of all, 1/a0^3 */

enum { PARTS = 16 };

static const double pi = 3.14159265358979323846;

struct question {
  double repulsion, between, time;
  uint64_t seed;
};

struct means {
  struct sample radius, inside, outside, difference, tension, density;
};

struct sums {
  double inside, outside;              /* p */
  double second_inside, second_beyond; /* density of the second liquid */
  double n;
};

static struct model model_of(const struct question *q, double radius, int edge)
{
  struct model m;
  memset(&m, 0, sizeof m);
  m.box = box_of_cells(edge, edge, edge);
  m.time_step = STEP;
  m.scheme = SCHEME_KICK_SPLIT;
  m.medium = (struct medium_model){.kind = MEDIUM_PAIRS,
                                   .density = DENSITY,
                                   .rate = 9.0,
                                   .draw = DRAW_RELAX,
                                   .weight = WEIGHT_QUADRATIC,
                                   .repulsion = q->repulsion};
  m.medium.second.share = 4.0 / 3.0 * pi * radius * radius * radius / box_volume(&m.box);
  m.medium.second.repulsion = q->between;
  m.medium.many.range = 0.75;
  return m;
}

/* --- places ---------------------------------------------------------------------------------------------------------
 */

static double nearest(double x, double edge)
{
  return x - edge * nearbyint(x / edge);
}

static double distance(const struct state *state, uint32_t i, const double center[3], double edge)
{
  const struct solvent *s = &state->solvent;
  const double at[3] = {(double)s->x[i] * LATTICE_UNIT, (double)s->y[i] * LATTICE_UNIT, (double)s->z[i] * LATTICE_UNIT};
  double sum = 0.0;
  for (int k = 0; k < 3; k++) {
    const double x = nearest(at[k] - center[k], edge);
    sum += x * x;
  }
  return sqrt(sum);
}

/* Of the second liquid, on circles. */
static void find_center(const struct run *run, double center[3])
{
  const struct solvent *s = &run->state.solvent;
  const double edge = run->model.box.cells[0], turn = 2.0 * pi / edge * LATTICE_UNIT;
  const int64_t *at[3] = {s->x, s->y, s->z};
  for (int k = 0; k < 3; k++) {
    double c = 0.0, d = 0.0;
    for (uint32_t i = 0; i < s->n; i++)
      if (s->id[i] >= run->model.medium.second.first)
        c += cos(turn * (double)at[k][i]), d += sin(turn * (double)at[k][i]);
    center[k] = atan2(d, c) * edge / (2.0 * pi);
  }
}

struct far {
  double distance;
  uint32_t place;
};

static int compare(const void *a, const void *b)
{
  const double x = ((const struct far *)a)->distance, y = ((const struct far *)b)->distance;
  return (x > y) - (x < y);
}

/* The particles nearest to the middle get the numbers of the second liquid. */
static void gather_droplet(struct run *run)
{
  struct solvent *s = &run->state.solvent;
  const double edge = run->model.box.cells[0], middle[3] = {0.5 * edge, 0.5 * edge, 0.5 * edge};
  struct far *far = calloc(s->n, sizeof *far);
  stop_unless(far != NULL, run);
  for (uint32_t i = 0; i < s->n; i++)
    far[i] = (struct far){distance(&run->state, i, middle, edge), i};
  qsort(far, s->n, sizeof *far, compare);
  for (uint32_t k = 0; k < s->n; k++)
    s->id[far[k].place] = s->n - 1 - k;
  free(far);
}

/* --- pressures ------------------------------------------------------------------------------------------------------
 */

struct virials {
  const struct model *model;
  double *of; /* [particles] by number: half of r.F of its pairs, kT */
};

static bool add_virials(const struct near_search *search, struct near_pairs *p)
{
  const struct virials *v = search->context;
  const struct medium_model *m = &v->model->medium;
  for (uint32_t k = 0; k < p->n; k++) {
    const uint32_t i = search->medium->number[p->a[k]], j = search->medium->number[p->b[k]];
    const bool unlike = (i >= m->second.first) != (j >= m->second.first);
    const double product = (unlike ? m->second.repulsion : m->repulsion) * (1.0 - p->r[k]) * p->r[k];
    v->of[i] += 0.5 * product;
    v->of[j] += 0.5 * product;
  }
  return true;
}

/* Ends the program if the sum is not that of the program's own observers. */
static void find_virials(struct run *run, double *of)
{
  const uint32_t n = run->state.solvent.n;
  struct virials virials = {&run->model, of};
  const struct near_search search = {
      .model = &run->model, .medium = &run->work.medium, .look = add_virials, .context = &virials};
  struct repulsion_sums sums;
  double sum = 0.0;
  memset(of, 0, n * sizeof *of);
  members_gather(&run->state, &run->model, &run->work.medium);
  near_find(&search);
  stop_unless(repulsion_measure(&run->state, &run->model, NULL, &sums), run);
  for (uint32_t i = 0; i < n; i++)
    sum += of[i];
  const double all = sums.virial[STRESS_XX] + sums.virial[STRESS_YY] + sums.virial[STRESS_ZZ];
  if (fabs(sum - all) > 1e-9 * all) {
    fprintf(stderr, "virials of pairs are %.12g, and %.12g by observers\n", sum, all);
    exit(1);
  }
}

static void take_sample(struct run *run, double radius, double *virial, struct sums *sums)
{
  const struct solvent *s = &run->state.solvent;
  const double edge = run->model.box.cells[0], near = radius - MARGIN, beyond = radius + MARGIN,
               core = 4.0 / 3.0 * pi * near * near * near,
               rest = edge * edge * edge - 4.0 / 3.0 * pi * beyond * beyond * beyond;
  double center[3], inside = 0.0, outside = 0.0, second_inside = 0.0, second_beyond = 0.0;
  find_center(run, center);
  find_virials(run, virial);
  for (uint32_t i = 0; i < s->n; i++) {
    const double d = distance(&run->state, i, center, edge), part = 1.0 + virial[s->id[i]] / 3.0;
    const bool second = s->id[i] >= run->model.medium.second.first;
    inside += d < near ? part : 0.0;
    outside += d > beyond ? part : 0.0;
    second_inside += d < near && second;
    second_beyond += d > beyond && second;
  }
  sums->inside += inside / core;
  sums->outside += outside / rest;
  sums->second_inside += second_inside / core;
  sums->second_beyond += second_beyond / rest;
  sums->n += 1.0;
}

static void add_part(const struct run *run, const struct sums *s, struct means *m)
{
  const double volume = box_volume(&run->model.box), inside = s->inside / s->n, outside = s->outside / s->n,
               dense = s->second_inside / s->n, thin = s->second_beyond / s->n,
               number = run->state.solvent.n - run->model.medium.second.first;
  const double radius = cbrt((number - thin * volume) / (dense - thin) * 3.0 / (4.0 * pi));
  sample_add(&m->radius, radius);
  sample_add(&m->inside, inside);
  sample_add(&m->outside, outside);
  sample_add(&m->difference, inside - outside);
  sample_add(&m->tension, 0.5 * radius * (inside - outside));
  sample_add(&m->density, dense);
}

static void measure_droplet(const struct question *q, double radius, int edge)
{
  struct run run;
  struct means means;
  const double before = cpu_seconds();
  const uint32_t samples = (uint32_t)lround(q->time / (EVERY * STEP)) / PARTS * PARTS;
  memset(&means, 0, sizeof means);
  run_start(&run, model_of(q, radius, edge), q->seed);
  gather_droplet(&run);
  double *virial = calloc(run.state.solvent.n, sizeof *virial);
  stop_unless(virial != NULL, &run);
  run_steps(&run, SKIP);
  for (int part = 0; part < PARTS; part++) {
    struct sums sums;
    memset(&sums, 0, sizeof sums);
    for (uint32_t k = 0; k < samples / PARTS; k++) {
      run_steps(&run, EVERY);
      take_sample(&run, radius, virial, &sums);
    }
    add_part(&run, &sums, &means);
  }
  const struct sample *columns[] = {&means.radius,     &means.inside,  &means.outside,
                                    &means.difference, &means.tension, &means.density};
  printf("%g,%d,%u", radius, edge, run.state.solvent.n);
  for (size_t k = 0; k < sizeof columns / sizeof *columns; k++)
    printf(",%.8g,%.3g", columns[k]->mean, sample_error(columns[k]));
  printf(",%.1f\n", cpu_seconds() - before);
  fflush(stdout);
  free(virial);
  run_end(&run);
}

int main(int argc, const char **argv)
{
  if (argc < 7 || argc % 2 == 0) {
    fprintf(stderr, "usage: %s A BETWEEN TIME SEED RADIUS EDGE ...\n", argv[0]);
    return 2;
  }
  const struct question q = {atof(argv[1]), atof(argv[2]), atof(argv[3]), strtoull(argv[4], NULL, 10)};
  if (q.time < PARTS * EVERY * STEP) {
    fprintf(stderr, "TIME is at least %g\n", PARTS * EVERY * STEP);
    return 2;
  }
  printf(
      "asked,edge,particles,radius,radius_error,inside,inside_error,outside,outside_error,difference,difference_error,"
      "tension,tension_error,density,density_error,seconds\n");
  for (int k = 5; k + 1 < argc; k += 2)
    measure_droplet(&q, atof(argv[k]), atoi(argv[k + 1]));
  return 0;
}
