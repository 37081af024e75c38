/*
 * Velocity autocorrelation and diffusion of solvent particles, against molecular chaos.
 *
 *   C(t) = <v(0).v(t)>/<v.v>          D(t) = <|r(t) - r(0)|^2>/(6 t kT)
 *
 * The run is cut into windows; each one's first state is the origin of all its times. Displacements are summed from the
 * velocities, for positions are wrapped. kT is measured: a closed box keeps what it was given. Errors are the scatter
 * of windows; what goes on for longer than a window is seen by runs of other seeds only.
 *
 * Output: comma-separated columns; lines with # are comments. Molecular chaos has C = c^n after n collisions, and
 * D(t) = (dt_c/2n) sum_{i,j < n} c^|i-j|.
 */
#include <math.h>

#include "../../tests/statistics.h"
#include "measure.h"
#include "theory/theory.h"

#define WARM_UP 200 /* collisions before the first window */

struct question {
  int cells; /* edge of the cubic box */
  double per_cell, interval, angle;
  uint32_t length, windows; /* of windows, in collisions, and their number */
  uint64_t seed;
};

struct answer {
  struct sample *vacf, *diffusion; /* [length]: by collisions since the origin */
};

/* Velocities of the origin, and displacements since, by particle id. */
struct origin {
  double (*velocity)[3], (*displacement)[3];
  double speeds; /* sum of v^2 */
};

static void usage(const char *program)
{
  fprintf(stderr,
          "usage: %s [CELLS PER_CELL DT_C ANGLE LENGTH WINDOWS SEED]\n"
          "  CELLS    edge of the cubic box, a0 (32)         ANGLE    of rotation, degrees (90)\n"
          "  PER_CELL particles per cell (5)                 LENGTH   of a window, collisions (250)\n"
          "  DT_C     collision interval, t0 (0.02)          WINDOWS  (5)\n",
          program);
  exit(2);
}

static struct question read_question(int argc, char **argv)
{
  struct question q = {32, 5.0, 0.02, 90.0, 250, 5, 1};
  if (argc == 1)
    return q;
  if (argc != 8)
    usage(argv[0]);
  q.cells = atoi(argv[1]);
  q.per_cell = atof(argv[2]);
  q.interval = atof(argv[3]);
  q.angle = atof(argv[4]);
  q.length = (uint32_t)atoi(argv[5]);
  q.windows = (uint32_t)atoi(argv[6]);
  q.seed = strtoull(argv[7], NULL, 10);
  if (q.cells < 1 || q.per_cell <= 0.0 || q.interval <= 0.0 || q.angle <= 0.0 || q.length < 2 || q.windows < 1)
    usage(argv[0]);
  return q;
}

static struct model model_of(const struct question *q)
{
  struct model m = standard_model(q->cells, q->cells, q->cells, q->per_cell, q->interval, 1);
  m.solvent.rotation_angle = q->angle;
  return m;
}

static void origin_set(struct origin *o, const struct solvent *s)
{
  o->speeds = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    const double v[3] = {s->vx[i], s->vy[i], s->vz[i]};
    memcpy(o->velocity[s->id[i]], v, sizeof v);
    o->speeds += v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  }
  memset(o->displacement, 0, s->n * sizeof *o->displacement);
}

/* Sums of v(0).v and of squared displacements. */
static void origin_compare(const struct origin *o, const struct solvent *s, double *products, double *squares)
{
  *products = *squares = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    const double *v = o->velocity[s->id[i]], *d = o->displacement[s->id[i]];
    *products += v[0] * s->vx[i] + v[1] * s->vy[i] + v[2] * s->vz[i];
    *squares += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  }
}

/* The flight that comes next. */
static void origin_fly(struct origin *o, const struct solvent *s, double interval)
{
  for (uint32_t i = 0; i < s->n; i++) {
    double *d = o->displacement[s->id[i]];
    d[0] += s->vx[i] * interval;
    d[1] += s->vy[i] * interval;
    d[2] += s->vz[i] * interval;
  }
}

static void measure_window(struct run *run, const struct question *q, struct origin *o, struct answer *a)
{
  const struct solvent *s = &run->state.solvent;
  origin_set(o, s);
  const double kt = o->speeds / 3.0 / (s->n - 1.0);
  for (uint32_t k = 0; k < q->length; k++) {
    double products, squares;
    origin_compare(o, s, &products, &squares);
    sample_add(&a->vacf[k], products / o->speeds);
    if (k > 0)
      sample_add(&a->diffusion[k], squares / s->n / (6.0 * k * q->interval * kt));
    origin_fly(o, s, q->interval);
    run_steps(run, 1);
  }
}

static void print_answer(const struct question *q, const struct answer *a, double cosine, double kt, double cpu)
{
  printf("# box %d^3, %g per cell, dt_c %g, %g degrees, %u windows of %u collisions, seed %llu\n", q->cells,
         q->per_cell, q->interval, q->angle, q->windows, q->length, (unsigned long long)q->seed);
  printf("# kT %.6f; molecular chaos: c = %.6f, D = %.6f kT; %.0f s of CPU time\n", kt,
         1.0 - 2.0 / 3.0 * (1.0 - cosine) * theory_partners(q->per_cell) / q->per_cell,
         theory_solvent_diffusion(&srd_rule, 3, q->per_cell, cosine, q->interval), cpu);
  printf("collisions,time,vacf,vacf_error,D,D_error\n");
  for (uint32_t k = 0; k < q->length; k++)
    printf("%u,%.8g,%.8e,%.2e,%.8e,%.2e\n", k, k * q->interval, a->vacf[k].mean, sample_error(&a->vacf[k]),
           k > 0 ? a->diffusion[k].mean : 0.0, k > 0 ? sample_error(&a->diffusion[k]) : 0.0);
}

int main(int argc, char **argv)
{
  const struct question q = read_question(argc, argv);
  struct run run;
  const double start = cpu_seconds();
  run_start(&run, model_of(&q), q.seed);
  const size_t n = run.state.solvent.n;
  struct origin o = {malloc(n * sizeof *o.velocity), malloc(n * sizeof *o.displacement), 0.0};
  struct answer a = {calloc(q.length, sizeof *a.vacf), calloc(q.length, sizeof *a.diffusion)};
  stop_unless(o.velocity && o.displacement && a.vacf && a.diffusion, &run);
  run_steps(&run, WARM_UP);
  for (uint32_t w = 0; w < q.windows; w++)
    measure_window(&run, &q, &o, &a);
  print_answer(&q, &a, run.model.solvent.cosine, o.speeds / 3.0 / ((double)n - 1.0), cpu_seconds() - start);
  free(o.velocity);
  free(o.displacement);
  free(a.vacf);
  free(a.diffusion);
  run_end(&run);
  return 0;
}
