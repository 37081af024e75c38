/*
 * Decay of transverse modes against their wave number, at one point of the solvent: see shear_wave.h, and viscosity.c
 * for points in a table. A box of 8 x EDGE x 8 cells has its wave of k = 2 pi/EDGE. With vertices, loose ones of the
 * paper's mass, 5, go along with the fluid and make it heavier and more viscous.
 *
 * Output: comma-separated, a row per box; nu(k) = rate/k^2. Theory: Padding 2009, Eqs. (30), (31), for k -> 0;
 * for other rules the same average. In two dimensions the box is 8 x EDGE x 1, and the wave has its x component alone.
 */
#include "measure.h"
#include "shear_wave.h"
#include "theory/theory.h"

#define WIDTH 8 /* a0, across the wave */

struct question {
  double per_cell, interval;
  const char *rule;   /* `at-a`, `at+a`, or SRD's angle; with `,plane` in two dimensions */
  double vertices;    /* per cell */
  double amplitude;   /* A, a0/t0 */
  uint32_t skip;      /* collisions left out while correlations build up */
  uint32_t pairs;     /* of runs in the longest box; shorter ones have more, in proportion to 1/EDGE^2 */
  uint64_t seed;      /* of the first pair */
  const char **edges; /* decreasing */
  int boxes;
};

static struct question read_question(int argc, const char **argv)
{
  if (argc < 9) {
    fprintf(stderr, "usage: %s PER_CELL[:VERTICES] DT_C ANGLE|at-a|at+a[,plane] AMPLITUDE SKIP PAIRS SEED EDGE ...\n",
            argv[0]);
    exit(2);
  }
  const char *vertices = strchr(argv[1], ':');
  return (struct question){.per_cell = atof(argv[1]),
                           .vertices = vertices ? atof(vertices + 1) : 0.0,
                           .interval = atof(argv[2]),
                           .rule = argv[3],
                           .amplitude = atof(argv[4]),
                           .skip = (uint32_t)atoi(argv[5]),
                           .pairs = (uint32_t)atoi(argv[6]),
                           .seed = strtoull(argv[7], NULL, 10),
                           .edges = argv + 8,
                           .boxes = argc - 8};
}

static void measure_box(const struct question *q, int edge, uint32_t pairs)
{
  struct run run;
  struct model model = standard_model(WIDTH, edge, WIDTH, q->per_cell, q->interval, 1);
  set_rule(&model, q->rule);
  if (strstr(q->rule, ",plane")) {
    model.dimensions = 2;
    model.box = box_of_cells(WIDTH, edge, 1);
    model.crossing.forbidden = false;
  }
  if (q->vertices > 0.0)
    add_kind(&model, (uint32_t)(q->vertices * WIDTH * edge * WIDTH), 1);
  run_start(&run, model, q->seed);
  const double k = shear_wave_number(&run.model);
  const double theory = theory_viscosity(collision_rule_of(&run.model), run.model.dimensions, q->per_cell,
                                         run.model.solvent.cosine, q->interval) /
                        q->per_cell;
  const double life = 1.0 / (theory * k * k * q->interval); /* collisions to 1/e */
  struct shear_wave wave = {.amplitude = q->amplitude, .expected = theory, .every = 1 + (uint32_t)(life / 25.0)};
  wave.first = (q->skip + wave.every - 1) / wave.every;
  wave.last = wave.first + 1 + (uint32_t)(1.2 * life / wave.every);
  double *amplitude = calloc(wave.last + 1, sizeof *amplitude);
  stop_unless(amplitude != NULL, &run);
  struct ratio lambda = {0};
  for (uint32_t n = 0; n < pairs; n++)
    stop_unless(shear_wave_pair(&run.model, &run.state, &run.work, &wave, q->seed * 1000000 + n, amplitude, &lambda),
                &run);
  printf("%d,%.8g,%.8g,%.3g,%.8g,%u\n", edge, k, shear_wave_viscosity(&run.model, &wave, &lambda),
         shear_wave_error(&run.model, &wave, &lambda), theory, pairs);
  fflush(stdout);
  free(amplitude);
  run_end(&run);
}

int main(int argc, const char **argv)
{
  const struct question q = read_question(argc, argv);
  const double longest = atof(q.edges[0]);
  printf("edge,k,nu,nu_error,theory,pairs\n");
  for (int b = 0; b < q.boxes; b++)
    measure_box(&q, atoi(q.edges[b]), (uint32_t)ceil(q.pairs * pow(longest / atof(q.edges[b]), 2.0)));
  return 0;
}
