/*
 * What an integrator of dissipative particle dynamics does to a fluid of density 3 (dpd_integrators.h), gamma 4.5 as a
 * rule: the box is EDGE^3, 20 t0 are left out, TIME t0 are measured.
 *
 * Output: comma-separated, a row per time step. kinetic: temperature of the velocities at the time of the places;
 * predicted: of those that friction is taken with; configurational: <|grad U|^2>/<laplacian of U>; pressure: with the
 * mean of the first temperature; gap: predicted less kinetic; D: (g(2t) - g(t))/6t, t = 4 t0; close: pairs nearer than
 * 0.1 a0, over those of an ideal gas. Errors are those of 16 parts of the run. A row of nan: a particle flew further in
 * a step than the program allows.
 */
#include "dpd_integrators.h"
#include "../../tests/statistics.h"
#include "measure.h"

#define SAMPLE 0.2 /* t0 between samples */
#define SKIP 20.0  /* t0 */
#define LAG 4.0    /* t0 */

enum { PARTS = 16, VALUES = 7, D_PARTS = 8 };

static const char *const names[VALUES] = {"kinetic", "predicted", "configurational", "pressure", "close", "gap", "D"};

enum { KINETIC, PREDICTED, CONFIGURATIONAL, PRESSURE, CLOSE, GAP, DIFFUSION };

struct question {
  const struct dpd_scheme *scheme;
  int edge;
  double repulsion, friction, time;
  uint64_t seed;
};

struct series {
  uint32_t n, particles;
  double interval;           /* t0 */
  double (*row)[VALUES + 1]; /* [n] force_square and laplacian in place of their ratio: CONFIGURATIONAL and the last */
  struct vec3 *far;          /* [n][particles] unwrapped places, a0 */
};

static struct model model_of(const struct question *q, double dt)
{
  struct model m;
  memset(&m, 0, sizeof m);
  m.box = box_of_cells(q->edge, q->edge, q->edge);
  m.time_step = dt;
  m.scheme = SCHEME_KICK_SPLIT;
  m.medium = (struct medium_model){.kind = MEDIUM_PAIRS,
                                   .density = 3.0,
                                   .rate = 2.0 * q->friction,
                                   .draw = q->scheme->draw,
                                   .weight = q->scheme->weight,
                                   .repulsion = q->repulsion};
  m.medium.many.range = 0.75;
  return m;
}

/* --- a sample -------------------------------------------------------------------------------------------------------
 */

/* velocity: those at the time of the places. */
static double square_of(const struct dpd *d, const struct vec3 *velocity)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < d->state->solvent.n; i++)
    sum += vec3_dot(velocity[i], velocity[i]);
  return sum;
}

static void take_velocities(struct dpd *d, const struct dpd_scheme *scheme)
{
  const struct solvent *s = &d->state->solvent;
  for (uint32_t i = 0; scheme->own && i < s->n; i++)
    d->v[s->id[i]] = solvent_velocity(s, i);
  for (uint32_t i = 0; i < s->n; i++)
    d->scratch[i] = vec3_add_scaled(d->v[i], scheme->behind * d->model->time_step, d->push[i]);
}

/* The step from the place of the sample before, to the nearest image. */
static struct vec3 moved(const struct box *box, const int64_t now[3], const int64_t before[3])
{
  double by[3];
  for (int k = 0; k < 3; k++) {
    const int64_t edge = box->edge[k], apart = now[k] - before[k];
    by[k] = (double)(apart - (apart > edge / 2 ? edge : apart < -edge / 2 ? -edge : 0)) * LATTICE_UNIT;
  }
  return (struct vec3){by[0], by[1], by[2]};
}

static void take_places(const struct dpd *d, struct series *s, int64_t (*last)[3])
{
  const struct solvent *p = &d->state->solvent;
  for (uint32_t i = 0; i < p->n; i++) {
    const int64_t now[3] = {p->x[i], p->y[i], p->z[i]};
    const uint32_t id = p->id[i];
    struct vec3 *far = &s->far[(size_t)s->n * s->particles + id];
    *far = s->n > 0 ? vec3_add(far[-(ptrdiff_t)s->particles], moved(&d->model->box, now, last[id]))
                    : (struct vec3){0, 0, 0};
    memcpy(last[id], now, sizeof now);
  }
}

static void take_sample(const struct question *q, struct dpd *d, struct run *run, struct series *s, int64_t (*last)[3])
{
  const double n = s->particles, volume = box_volume(&d->model->box);
  struct repulsion_sums sums;
  double square = 0.0;
  if (q->scheme->own)
    stop_unless(dpd_find(d), run); /* push, and the close pairs, of the places now */
  stop_unless(repulsion_measure(d->state, d->model, d->scratch, &sums), run);
  for (uint32_t i = 0; i < s->particles && model_repels(d->model); i++)
    square += vec3_dot(d->scratch[i], d->scratch[i]);
  take_velocities(d, q->scheme);
  const double kinetic = square_of(d, d->scratch) / (3.0 * (n - 1.0));
  double *row = s->row[s->n];
  row[KINETIC] = kinetic;
  row[PREDICTED] = q->scheme->predicts ? square_of(d, d->trial) / (3.0 * (n - 1.0)) : NAN;
  row[GAP] = row[PREDICTED] - kinetic;
  row[CONFIGURATIONAL] = square;
  row[VALUES] = sums.laplacian;
  row[PRESSURE] =
      (n * kinetic + (sums.virial[STRESS_XX] + sums.virial[STRESS_YY] + sums.virial[STRESS_ZZ]) / 3.0) / volume;
  row[CLOSE] = d->close / (0.5 * n * (n - 1.0) * 4.188790204786391 * DPD_CLOSE * DPD_CLOSE * DPD_CLOSE / volume);
  take_places(d, s, last);
  s->n++;
}

/* --- a run ----------------------------------------------------------------------------------------------------------
 */

/* False if a flight is too far. */
static bool go(const struct question *q, struct dpd *d, uint32_t steps)
{
  for (uint32_t k = 0; k < steps; k++)
    if (!q->scheme->step(d))
      return false;
  return true;
}

static bool run_series(const struct question *q, struct run *run, struct series *s)
{
  struct dpd d;
  const double dt = run->model.time_step;
  const uint32_t every = (uint32_t)lround(SAMPLE / dt), samples = (uint32_t)lround(q->time / (every * dt));
  int64_t(*last)[3] = calloc(run->state.solvent.n, sizeof *last);
  *s = (struct series){.particles = run->state.solvent.n, .interval = every * dt};
  s->row = calloc(samples, sizeof *s->row);
  s->far = calloc((size_t)samples * s->particles, sizeof *s->far);
  stop_unless(last && s->row && s->far && dpd_begin(&d, &run->model, &run->state, &run->work), run);
  bool ok = go(q, &d, (uint32_t)lround(SKIP / dt));
  while (ok && s->n < samples) {
    ok = go(q, &d, every);
    if (ok)
      take_sample(q, &d, run, s, last);
  }
  dpd_end(&d);
  free(last);
  return ok;
}

/* --- means ----------------------------------------------------------------------------------------------------------
 */

/* Of one part of the run. */
static double part_mean(const struct series *s, int value, uint32_t part)
{
  const uint32_t first = part * s->n / PARTS, end = (part + 1) * s->n / PARTS;
  double sum = 0.0, below = 0.0;
  for (uint32_t k = first; k < end; k++) {
    sum += s->row[k][value];
    below += value == CONFIGURATIONAL ? s->row[k][VALUES] : 1.0;
  }
  return sum / below;
}

/* Mean square displacement over `lag` samples from origins in a part of the run. */
static double displacement(const struct series *s, uint32_t lag, uint32_t part)
{
  const uint32_t origins = s->n - 2 * (uint32_t)lround(LAG / s->interval), first = part * origins / D_PARTS,
                 end = (part + 1) * origins / D_PARTS;
  double sum = 0.0;
  for (uint32_t k = first; k < end; k++)
    for (uint32_t i = 0; i < s->particles; i++) {
      const struct vec3 *at = &s->far[(size_t)k * s->particles + i];
      const struct vec3 by = vec3_sub(at[(size_t)lag * s->particles], *at);
      sum += vec3_dot(by, by);
    }
  return sum / ((double)(end - first) * s->particles);
}

static struct sample mean_of(const struct series *s, int value)
{
  struct sample found = {0};
  const uint32_t lag = (uint32_t)lround(LAG / s->interval);
  for (uint32_t part = 0; value != DIFFUSION && part < PARTS; part++)
    sample_add(&found, part_mean(s, value, part));
  for (uint32_t part = 0; value == DIFFUSION && part < D_PARTS; part++)
    sample_add(&found, (displacement(s, 2 * lag, part) - displacement(s, lag, part)) / (6.0 * lag * s->interval));
  return found;
}

static void measure_step(const struct question *q, double dt)
{
  struct run run;
  struct series series;
  const double before = cpu_seconds();
  run_start(&run, model_of(q, dt), q->seed);
  const bool ok = run_series(q, &run, &series);
  printf("%.8g", dt);
  for (int value = 0; value < VALUES; value++) {
    const struct sample found = ok ? mean_of(&series, value) : (struct sample){.mean = NAN};
    printf(",%.8g,%.3g", found.mean, ok ? sample_error(&found) : NAN);
  }
  printf(",%.1f\n", cpu_seconds() - before);
  fflush(stdout);
  free(series.row);
  free(series.far);
  run_end(&run);
}

static const struct dpd_scheme *scheme_of(const char *word)
{
  for (int k = 0; k < DPD_SCHEMES; k++)
    if (strcmp(word, dpd_schemes[k].name) == 0)
      return &dpd_schemes[k];
  fprintf(stderr, "no scheme %s:", word);
  for (int k = 0; k < DPD_SCHEMES; k++)
    fprintf(stderr, " %s", dpd_schemes[k].name);
  fprintf(stderr, "\n");
  exit(2);
}

int main(int argc, const char **argv)
{
  if (argc < 8) {
    fprintf(stderr, "usage: %s SCHEME EDGE REPULSION GAMMA TIME SEED DT ...\n", argv[0]);
    return 2;
  }
  const struct question q = {scheme_of(argv[1]), atoi(argv[2]), atof(argv[3]),
                             atof(argv[4]),      atof(argv[5]), strtoull(argv[6], NULL, 10)};
  if (q.time < 4.0 * LAG) {
    fprintf(stderr, "TIME is at least %g\n", 4.0 * LAG);
    return 2;
  }
  printf("dt");
  for (int value = 0; value < VALUES; value++)
    printf(",%s,%s_error", names[value], names[value]);
  printf(",seconds\n");
  for (int k = 7; k < argc; k++)
    measure_step(&q, atof(argv[k]));
  return 0;
}
