/*
 * Viscosity of a solvent in equilibrium, from the fluctuations of its stress: see green_kubo.h. A cubic box without
 * vertices, all particles together at rest and, at the start, at kT = 1.
 *
 * Output: comma-separated, a row per lag: C_k/(V dt_c) and eta(lag), with errors from blocks. The last columns are the
 * same in each row: theory's eta (molecular chaos), kT over the run, and the largest total momentum per particle.
 */
#include "green_kubo.h"
#include "measure.h"
#include "theory/theory.h"

enum {
  BLOCKS = 32,   /* that errors come from */
  WARM_UP = 100, /* collisions */
};

struct question {
  int edge;
  double per_cell, interval;
  const char *rule;
  uint32_t lags, collisions;
  uint64_t seed;
};

static struct question read_question(int argc, char **argv)
{
  if (argc != 8) {
    fprintf(stderr, "usage: %s EDGE PER_CELL DT_C ANGLE|at-a LAGS COLLISIONS SEED\n", argv[0]);
    exit(2);
  }
  return (struct question){.edge = atoi(argv[1]),
                           .per_cell = atof(argv[2]),
                           .interval = atof(argv[3]),
                           .rule = argv[4],
                           .lags = (uint32_t)atoi(argv[5]),
                           .collisions = (uint32_t)atoi(argv[6]),
                           .seed = strtoull(argv[7], NULL, 10)};
}

static double twice_kinetic_energy(const struct solvent *s)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++)
    sum += s->vx[i] * s->vx[i] + s->vy[i] * s->vy[i] + s->vz[i] * s->vz[i];
  return sum;
}

/* kT of a closed box at rest. */
static double temperature(const struct solvent *s)
{
  return twice_kinetic_energy(s) / 3.0 / (s->n - 1.0);
}

/* The energy of a start scatters by sqrt(2/3N), and some rules keep it: all velocities times one factor. */
static void set_temperature(struct solvent *s)
{
  const double factor = 1.0 / sqrt(temperature(s));
  for (uint32_t i = 0; i < s->n; i++) {
    s->vx[i] *= factor;
    s->vy[i] *= factor;
    s->vz[i] *= factor;
  }
}

/* The largest component of the total momentum, per particle. */
static double momentum(const struct solvent *s)
{
  struct vec3 p = {0, 0, 0};
  for (uint32_t i = 0; i < s->n; i++)
    p = vec3_add(p, solvent_velocity(s, i));
  return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) / s->n;
}

int main(int argc, char **argv)
{
  const struct question q = read_question(argc, argv);
  struct model model = standard_model(q.edge, q.edge, q.edge, q.per_cell, q.interval, 1);
  set_rule(&model, q.rule);
  struct run run;
  run_start(&run, model, q.seed);
  set_temperature(&run.state.solvent);

  struct green_kubo g;
  const uint32_t length = q.collisions / BLOCKS;
  stop_unless(length > 0 && green_kubo_alloc(&g, q.lags, length), &run);
  struct blocks kt = {.length = length};
  double m[GREEN_KUBO_COMPONENTS], drift = 0.0;
  for (uint32_t n = 0; n < WARM_UP; n++)
    stop_unless(green_kubo_interval(&run.state, &run.model, &run.work.mpc, m, &run.work.fault), &run);
  for (uint32_t n = 0; n < q.lags + BLOCKS * length; n++) {
    stop_unless(green_kubo_interval(&run.state, &run.model, &run.work.mpc, m, &run.work.fault), &run);
    green_kubo_add(&g, m);
    blocks_add(&kt, temperature(&run.state.solvent));
    if (n % length == 0)
      drift = fmax(drift, momentum(&run.state.solvent));
  }

  const double scale = 1.0 / (box_volume(&run.model.box) * model_collision_interval(&run.model));
  const double theory = theory_viscosity(collision_rule_of(&run.model), run.model.dimensions, q.per_cell,
                                         run.model.solvent.cosine, q.interval);
  printf("lag,time,correlation,correlation_error,eta,eta_error,theory,kT,kT_error,momentum\n");
  for (uint32_t k = 0; k <= q.lags; k++)
    printf("%u,%.8g,%.8g,%.3g,%.8g,%.3g,%.8g,%.8g,%.3g,%.3g\n", k, k * q.interval, scale * g.c[k].mean,
           scale * sample_error(&g.c[k]), scale * g.eta[k].mean, scale * sample_error(&g.eta[k]), theory,
           kt.of_blocks.mean, sample_error(&kt.of_blocks), drift);
  green_kubo_free(&g);
  run_end(&run);
  return 0;
}
