/*
 * Diffusion of chains or rods from their answer to a force, in place of their Brownian motion.
 *
 * A force F on a fiber, shared evenly by its vertices, acts from t = 0 on, when all is in equilibrium. By the
 * fluctuation-dissipation theorem the mean displacement of the center of mass along it is
 *
 *   <x(t)> = F g(t)/6 (kT = 1),    g(t) = <|r(t) - r(0)|^2> without a force,
 *
 * at every time t as long as the answer is linear. So x/(F t) is the running estimate g/6t of D, with all its memory.
 * Its noise is Brownian, sqrt(2 D t). Its relative error is sqrt(2/(D t n))/F for n fibers: it falls as 1/F. The force may be
 * large, because a fiber hardly changes its shape within a time that is short beside its own relaxation.
 *
 * Half of the fibers are pulled along +x, half along -x. So there is no net force, and every error that is even in F
 * cancels in the mean. With `signs` 2 the run is made a second time from the same start, with the same random numbers and
 * opposite forces; `shared` tells how much of the noise both have in common, and therefore loses in their difference.
 *
 * Output: comma-separated. time (t0); x/(F t), its error from the scatter over fibers; the mean of x/F, and the error of its
 * increment since the row before (increments are independent); shared: correlation of the noise of both runs, 0 with one.
 */
#include "measure.h"

struct question {
  bool rods;
  uint32_t vertices; /* of a fiber */
  uint32_t fibers;   /* even */
  int edge;          /* a0 */
  double force;      /* on a fiber, kT/a0 */
  double last;       /* t0 */
  double interval;   /* between rows, t0 */
  uint32_t signs;    /* 1 or 2 */
  uint64_t seed;
};

static struct question read_question(int argc, const char **argv)
{
  if (argc == 10 && (strcmp(argv[1], "chains") == 0 || strcmp(argv[1], "rods") == 0))
    return (struct question){.rods = strcmp(argv[1], "rods") == 0,
                             .vertices = (uint32_t)atoi(argv[2]),
                             .fibers = (uint32_t)atoi(argv[3]),
                             .edge = atoi(argv[4]),
                             .force = atof(argv[5]),
                             .last = atof(argv[6]),
                             .interval = atof(argv[7]),
                             .signs = (uint32_t)atoi(argv[8]),
                             .seed = strtoull(argv[9], NULL, 10)};
  fprintf(stderr, "usage: %s chains|rods VERTICES FIBERS EDGE FORCE TIME INTERVAL SIGNS SEED\n", argv[0]);
  exit(2);
}

/* Two kinds of fibers, which differ in the sign of their force. */
static struct model pulled(const struct question *q, double sign)
{
  struct model m = q->rods ? standard_model(q->edge, q->edge, q->edge, 5, 0.01, 2)
                           : standard_model(q->edge, q->edge, q->edge, 5, 0.02, 1);
  m.crossing.forbidden = false;
  for (int side = 0; side < 2; side++) {
    struct fiber_kind *k = add_kind(&m, q->fibers / 2, q->vertices);
    k->bond_length = q->rods ? 0.5 : 0.0;
    k->spring = q->rods ? 100.0 : 3.0;
    k->bending = q->rods ? 2.0 * q->vertices : 0.0; /* l_p = 2 L */
    k->force.x = (side == 0 ? sign : -sign) * q->force / q->vertices;
  }
  return m;
}

/* x of the center of mass of each fiber, along its force: [fibers], a0. */
static void centers(const struct question *q, const struct state *state, double sign, double *x)
{
  for (uint32_t f = 0; f < q->fibers; f++) {
    double sum = 0.0;
    for (uint32_t v = f * q->vertices; v < (f + 1) * q->vertices; v++)
      sum += (double)state->position[v].x;
    x[f] = (f < q->fibers / 2 ? sign : -sign) * sum * LATTICE_UNIT / q->vertices;
  }
}

/* Displacements of all fibers along their forces: [rows + 1][fibers], a0. */
static void pull(const struct question *q, double sign, uint32_t rows, double *x)
{
  struct run run;
  run_start(&run, pulled(q, sign), q->seed);
  const uint64_t steps = (uint64_t)(q->interval / run.model.time_step + 0.5);
  centers(q, &run.state, sign, x);
  for (uint32_t row = 1; row <= rows; row++) {
    run_steps(&run, steps);
    centers(q, &run.state, sign, &x[(size_t)row * q->fibers]);
    fprintf(stderr, "\r%.0f of %.0f t0", row * q->interval, q->last);
  }
  fprintf(stderr, "\n");
  for (uint32_t row = rows + 1; row-- > 0;)
    for (uint32_t f = 0; f < q->fibers; f++)
      x[(size_t)row * q->fibers + f] -= x[f];
  run_end(&run);
}

/* The mean of y over fibers, and the error of this mean. */
static double mean(const double *y, uint32_t n, double *error)
{
  double sum = 0.0, squares = 0.0;
  for (uint32_t f = 0; f < n; f++)
    sum += y[f];
  for (uint32_t f = 0; f < n; f++)
    squares += (y[f] - sum / n) * (y[f] - sum / n);
  *error = sqrt(squares / n / (n - 1.0));
  return sum / n;
}

/* How much the deviations of both rows from their means are correlated. */
static double correlation(const double *y, const double *z, uint32_t n)
{
  double unused;
  const double my = mean(y, n, &unused), mz = mean(z, n, &unused);
  double yy = 0.0, zz = 0.0, yz = 0.0;
  for (uint32_t f = 0; f < n; f++) {
    yy += (y[f] - my) * (y[f] - my);
    zz += (z[f] - mz) * (z[f] - mz);
    yz += (y[f] - my) * (z[f] - mz);
  }
  return yz / sqrt(yy * zz);
}

static void print_rows(const struct question *q, uint32_t rows, const double *x, const double *back, double *work)
{
  double *step = work, *before = work + q->fibers;
  memset(before, 0, q->fibers * sizeof *before);
  printf("time,D,D_error,way,step_error,shared\n");
  for (uint32_t row = 1; row <= rows; row++) {
    const double t = row * q->interval, *one = &x[(size_t)row * q->fibers], *other = &back[(size_t)row * q->fibers];
    double *way = work + (size_t)2 * q->fibers, error, step_error;
    for (uint32_t f = 0; f < q->fibers; f++) {
      way[f] = (q->signs == 2 ? 0.5 * (one[f] + other[f]) : one[f]) / q->force;
      step[f] = way[f] - before[f];
    }
    const double value = mean(way, q->fibers, &error);
    mean(step, q->fibers, &step_error);
    /* Displacements are taken along each run's own force: the noise that both share has opposite signs. */
    printf("%.8g,%.8g,%.3g,%.8g,%.3g,%.3f\n", t, value / t, error / t, value, step_error,
           q->signs == 2 ? -correlation(one, other, q->fibers) : 0.0);
    memcpy(before, way, q->fibers * sizeof *before);
  }
}

int main(int argc, const char **argv)
{
  const struct question q = read_question(argc, argv);
  const uint32_t rows = (uint32_t)(q.last / q.interval + 0.5);
  const size_t size = (size_t)(rows + 1) * q.fibers;
  double *x = calloc(2 * size + (size_t)3 * q.fibers, sizeof *x);
  if (x == NULL) {
    fprintf(stderr, "no memory\n");
    return 1;
  }
  pull(&q, 1.0, rows, x);
  if (q.signs == 2)
    pull(&q, -1.0, rows, x + size);
  print_rows(&q, rows, x, x + size, x + 2 * size);
  free(x);
  return 0;
}
