/*
 * Diffusion of chains or rods from their answer to a force, in place of their Brownian motion.
 *
 * A force F on a fiber, shared evenly by its vertices, acts from t = 0 on, when all is in equilibrium. By the
 * fluctuation-dissipation theorem the mean displacement of the center of mass along it is
 *
 *   <x(t)> = F g(t)/6 (kT = 1),    g(t) = <|r(t) - r(0)|^2> without a force,
 *
 * at every time t as long as the answer is linear. So x/(F t) is the running estimate g/6t of D, with all its memory.
 * Its noise is Brownian, sqrt(2 D t): its relative error sqrt(2/(D t n))/F for n fibers falls as 1/F. The force may be
 * large, because a fiber hardly changes its shape within a time that is short beside its own relaxation.
 *
 * Half of the fibers are pulled along +x, half along -x. So there is no net force, and fibers carry each other along
 * with no mean. But the places of the fibers hardly change, and so this flow would be noise as large as a fifth of the
 * answer. It is taken off, by linear hydrodynamics: each wave k that fiber j makes is a part F_j rho_j(k) of the force
 * on the fluid, rho_j the mean of exp(-i k.r) over its vertices, and it drives a flow that decays at the rate nu k^2
 * (struct flow). Whatever is wrong with it (the viscosity, waves that are left out) makes noise, and no bias.
 *
 * With `signs` 2 the run is made a second time from the same start, with the same random numbers and opposite forces;
 * `shared` tells how much of the noise both have in common, and therefore loses in their difference.
 *
 * Output: comma-separated. time (t0); D, x/(F t); way, the mean of x/F; since_error, the error of its growth since the
 * time FIRST, from the scatter over fibers; others, how much the others' flow has taken from or added to `way`; shared:
 * correlation of the noise of both runs, 0 with one.
 */
#include "measure.h"

#define MOST_FIBERS 256

struct question {
  bool rods;
  uint32_t vertices; /* of a fiber */
  uint32_t fibers;   /* even */
  int edge;          /* a0 */
  double force;      /* on a fiber, kT/a0 */
  double last;       /* t0 */
  double interval;   /* between rows, t0 */
  double first;      /* t0 */
  uint32_t signs;    /* 1 or 2 */
  uint64_t seed;
};

static bool is_sound(const struct question *q)
{
  const double steps = q->interval / 0.02;
  return q->vertices > 0 && q->fibers > 2 && q->fibers <= MOST_FIBERS && q->fibers % 2 == 0 && q->edge > 3 &&
         q->force > 0.0 && steps >= 1.0 && fabs(steps - floor(steps + 0.5)) < 1e-6 && q->last >= q->interval &&
         q->first < q->last && (q->signs == 1 || q->signs == 2);
}

static struct question read_question(int argc, const char **argv)
{
  struct question q = {0};
  if (argc == 11 && (strcmp(argv[1], "chains") == 0 || strcmp(argv[1], "rods") == 0))
    q = (struct question){.rods = strcmp(argv[1], "rods") == 0,
                          .vertices = (uint32_t)atoi(argv[2]),
                          .fibers = (uint32_t)atoi(argv[3]),
                          .edge = atoi(argv[4]),
                          .force = atof(argv[5]),
                          .last = atof(argv[6]),
                          .interval = atof(argv[7]),
                          .first = atof(argv[8]),
                          .signs = (uint32_t)atoi(argv[9]),
                          .seed = strtoull(argv[10], NULL, 10)};
  if (is_sound(&q))
    return q;
  fprintf(stderr,
          "usage: %s chains|rods VERTICES FIBERS EDGE FORCE TIME INTERVAL FIRST SIGNS SEED\n"
          "  FIBERS even, 4 to %d; EDGE above 3; INTERVAL a multiple of 0.02; SIGNS 1 or 2\n",
          argv[0], MOST_FIBERS);
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

/* The next three are NU, PER_CELL and SHORTEST_WAVE of validation/lib/dilute.py. */
#define VISCOSITY 2.148 /* kinematic, of the paper's solvent: docs/accuracy.md */
#define DENSITY 5.0
#define SHORTEST 2.0  /* k a0 of the shortest waves */
#define MOST_WAVES 13 /* along an edge, in large boxes */

/* The flow that each fiber makes: waves k of half the space, for k and -k are one. */
struct flow {
  uint32_t waves, fibers;
  struct vec3 *k; /* [waves] 1/a0 */
  double *decay;  /* [waves] nu k^2 */
  double *push;   /* [waves] of a unit force along x on the amplitude of the flow along x, in the limit of long times */
  double (*rho)[2];     /* [waves][fibers] mean of cos k.r, -sin k.r over the vertices */
  double (*speed)[2];   /* [waves][fibers] amplitude of the fiber's own flow */
  double (*average)[2]; /* [waves][fibers] the same, averaged over the last interval */
};

static void flow_alloc(struct flow *f, const struct question *q)
{
  const double unit = 6.283185307179586477 / q->edge, volume = pow(q->edge, 3.0);
  const int reach = (int)fmin(MOST_WAVES, SHORTEST / unit);
  const size_t most = (size_t)pow(2.0 * reach + 1.0, 3.0) / 2 + 1, all = most * q->fibers;
  *f = (struct flow){.fibers = q->fibers,
                     .k = calloc(most, sizeof *f->k),
                     .decay = calloc(most, sizeof *f->decay),
                     .push = calloc(most, sizeof *f->push),
                     .rho = calloc(all, sizeof *f->rho),
                     .speed = calloc(all, sizeof *f->speed),
                     .average = calloc(all, sizeof *f->average)};
  for (int z = 0; z <= reach; z++)
    for (int y = z > 0 ? -reach : 0; y <= reach; y++)
      for (int x = z > 0 || y > 0 ? -reach : 1; x <= reach; x++) {
        const double square = unit * unit * (x * x + y * y + z * z);
        if (x * x + y * y + z * z > reach * reach)
          continue;
        f->k[f->waves] = (struct vec3){unit * x, unit * y, unit * z};
        f->decay[f->waves] = VISCOSITY * square;
        f->push[f->waves] = 2.0 * (1.0 - unit * unit * x * x / square) / (DENSITY * VISCOSITY * square * volume);
        f->waves++;
      }
}

static void flow_free(struct flow *f)
{
  free(f->k), free(f->decay), free(f->push), free(f->rho), free(f->speed), free(f->average);
}

/* The waves of all fibers go on for a time, pushed as in the places of now: exact for an exponential decay. */
static void flow_advance(struct flow *f, const struct question *q, const struct state *state, double sign, double time)
{
  for (uint32_t w = 0; w < f->waves; w++) {
    const struct vec3 k = f->k[w];
    const double kept = exp(-f->decay[w] * time), mean_kept = (1.0 - kept) / (f->decay[w] * time);
    for (uint32_t j = 0; j < f->fibers; j++) {
      const size_t at = (size_t)w * f->fibers + j;
      double sums[2] = {0, 0};
      for (uint32_t v = j * q->vertices; v < (j + 1) * q->vertices; v++) {
        const struct point *r = &state->position[v];
        const double phase = (k.x * (double)r->x + k.y * (double)r->y + k.z * (double)r->z) * LATTICE_UNIT;
        sums[0] += cos(phase);
        sums[1] -= sin(phase);
      }
      const double force = (j < f->fibers / 2 ? sign : -sign) * q->force;
      for (int part = 0; part < 2; part++) {
        f->rho[at][part] = sums[part] / q->vertices;
        const double end = f->push[w] * force * f->rho[at][part], start = f->speed[at][part];
        f->average[at][part] = end + (start - end) * mean_kept;
        f->speed[at][part] = end + (start - end) * kept;
      }
    }
  }
}

/* Mean velocity along x, over the last interval, of each fiber in the flow of the others: [fibers]. */
static void flow_of_others(const struct flow *f, double *u)
{
  memset(u, 0, f->fibers * sizeof *u);
  for (uint32_t w = 0; w < f->waves; w++) {
    double(*rho)[2] = &f->rho[(size_t)w * f->fibers], (*own)[2] = &f->average[(size_t)w * f->fibers];
    double all[2] = {0, 0};
    for (uint32_t j = 0; j < f->fibers; j++)
      all[0] += own[j][0], all[1] += own[j][1];
    for (uint32_t j = 0; j < f->fibers; j++)
      u[j] += (all[0] - own[j][0]) * rho[j][0] + (all[1] - own[j][1]) * rho[j][1];
  }
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

/* Displacements of all fibers along their forces, less those in the flow of the others, and the latter: [rows +
 * 1][fibers], a0. */
static void pull(const struct question *q, double sign, uint32_t rows, double *x, double *others)
{
  struct run run;
  struct flow flow;
  run_start(&run, pulled(q, sign), q->seed);
  flow_alloc(&flow, q);
  double *u = calloc(q->fibers, sizeof *u);
  stop_unless(u && flow.k && flow.decay && flow.push && flow.rho && flow.speed && flow.average, &run);
  const uint64_t steps = (uint64_t)(q->interval / run.model.time_step + 0.5);
  centers(q, &run.state, sign, x);
  for (uint32_t row = 1; row <= rows; row++) {
    flow_advance(&flow, q, &run.state, sign, q->interval);
    flow_of_others(&flow, u);
    run_steps(&run, steps);
    double *at = &x[(size_t)row * q->fibers], *carried = &others[(size_t)row * q->fibers];
    centers(q, &run.state, sign, at);
    for (uint32_t f = 0; f < q->fibers; f++) {
      carried[f] = carried[f - (ptrdiff_t)q->fibers] + (f < q->fibers / 2 ? sign : -sign) * u[f] * q->interval;
      at[f] -= carried[f];
    }
    fprintf(stderr, "\r%.0f of %.0f t0", row * q->interval, q->last);
  }
  fprintf(stderr, "\n");
  for (uint32_t row = rows + 1; row-- > 0;)
    for (uint32_t f = 0; f < q->fibers; f++)
      x[(size_t)row * q->fibers + f] -= x[f];
  free(u);
  flow_free(&flow);
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

/* x, others: of the first run; back: x of the second one, which is not looked at with one sign. */
/* How much of the flow of the others is in the ways that fibers went, over fibers: 1 if it is right; and its error. */
static void print_slope(const struct question *q, const double *way, const double *others)
{
  double unused, xy = 0.0, yy = 0.0, rest = 0.0;
  const double mx = mean(way, q->fibers, &unused), my = mean(others, q->fibers, &unused);
  for (uint32_t f = 0; f < q->fibers; f++) {
    xy += (way[f] - mx) * (others[f] - my);
    yy += (others[f] - my) * (others[f] - my);
  }
  for (uint32_t f = 0; f < q->fibers; f++) {
    const double left = way[f] - mx - xy / yy * (others[f] - my);
    rest += left * left;
  }
  printf("# flow of the others, as computed, in the ways that fibers went: %.3f +- %.3f of it\n", 1.0 + xy / yy,
         sqrt(rest / (q->fibers - 2.0) / yy));
}

static void print_rows(const struct question *q, uint32_t rows, const double *x, const double *others,
                       const double *back)
{
  double way[MOST_FIBERS], since[MOST_FIBERS], unused, error;
  const uint32_t from = (uint32_t)(q->first / q->interval + 0.5);
  printf("time,D,way,since_error,others,shared\n");
  for (uint32_t row = 1; row <= rows; row++) {
    const double t = row * q->interval, *one = &x[(size_t)row * q->fibers], *other = &back[(size_t)row * q->fibers];
    for (uint32_t f = 0; f < q->fibers; f++) {
      const size_t then = (size_t)from * q->fibers + f;
      way[f] = (q->signs == 2 ? 0.5 * (one[f] + other[f]) : one[f]) / q->force;
      since[f] = way[f] - (q->signs == 2 ? 0.5 * (x[then] + back[then]) : x[then]) / q->force;
    }
    const double value = mean(way, q->fibers, &unused);
    mean(since, q->fibers, &error);
    /* Displacements are taken along each run's own force: the noise that both share has opposite signs. */
    printf("%.8g,%.8g,%.8g,%.3g,%.3g,%.3f\n", t, value / t, value, error,
           mean(&others[(size_t)row * q->fibers], q->fibers, &unused) / q->force,
           q->signs == 2 ? -correlation(one, other, q->fibers) : 0.0);
  }
  print_slope(q, &x[(size_t)rows * q->fibers], &others[(size_t)rows * q->fibers]);
}

int main(int argc, const char **argv)
{
  const struct question q = read_question(argc, argv);
  const uint32_t rows = (uint32_t)(q.last / q.interval + 0.5);
  const size_t size = (size_t)(rows + 1) * q.fibers;
  double *x = calloc(4 * size, sizeof *x);
  if (x == NULL) {
    fprintf(stderr, "no memory\n");
    return 1;
  }
  for (uint32_t run = 0; run < q.signs; run++)
    pull(&q, run == 0 ? 1.0 : -1.0, rows, x + 2 * run * size, x + (2 * run + 1) * size);
  print_rows(&q, rows, x, x + size, x + 2 * size);
  free(x);
  return 0;
}
