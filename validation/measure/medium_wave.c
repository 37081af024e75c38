/*
 * Viscosity of a fluid of pairs (medium: {kind: pairs}) from the decay of a shear wave, see shear_wave.h. The box is 6
 * x EDGE x 6, so the wave has k = 2 pi/EDGE. At dt 0.01 and more the fluid of order `kick-split` is meant.
 *
 * Output: comma-separated, a row per box; eta(k) = rho nu(k), and what molecular chaos says of it (theory/medium.h,
 * without forces of pairs).
 */
#include "measure.h"
#include "shear_wave.h"
#include "theory/medium.h"

#define WIDTH 6 /* a0, across the wave */

struct question {
  struct medium_model medium;
  double time_step, amplitude; /* t0; A, a0/t0 */
  double skip;                 /* t0 left out while correlations build up */
  uint32_t pairs;              /* of runs */
  uint64_t seed;               /* of the first pair */
  const char **edges;
  int boxes;
};

static const char *const draws[] = {[DRAW_REPLACE] = "replace", [DRAW_RELAX] = "relax", [DRAW_CAYLEY] = "cayley"};

static enum medium_draw draw_of(const char *word)
{
  for (int d = 0; d < MEDIUM_DRAWS; d++)
    if (strcmp(word, draws[d]) == 0)
      return (enum medium_draw)d;
  fprintf(stderr, "no draw %s: replace, relax or cayley\n", word);
  exit(2);
}

static struct question read_question(int argc, const char **argv)
{
  if (argc < 12) {
    fprintf(stderr, "usage: %s DENSITY RATE DRAW hat|quadratic REPULSION DT AMPLITUDE SKIP PAIRS SEED EDGE ...\n",
            argv[0]);
    exit(2);
  }
  return (struct question){.medium = {.kind = MEDIUM_PAIRS,
                                      .density = atof(argv[1]),
                                      .rate = atof(argv[2]),
                                      .draw = draw_of(argv[3]),
                                      .weight = strcmp(argv[4], "hat") == 0 ? WEIGHT_HAT : WEIGHT_QUADRATIC,
                                      .repulsion = atof(argv[5])},
                           .time_step = atof(argv[6]),
                           .amplitude = atof(argv[7]),
                           .skip = atof(argv[8]),
                           .pairs = (uint32_t)atoi(argv[9]),
                           .seed = strtoull(argv[10], NULL, 10),
                           .edges = argv + 11,
                           .boxes = argc - 11};
}

static struct model medium_model_of(const struct question *q, int edge)
{
  struct model m;
  memset(&m, 0, sizeof m);
  m.box = box_of_cells(WIDTH, edge, WIDTH);
  m.time_step = q->time_step;
  m.scheme = SCHEME_KICK_SPLIT;
  m.medium = q->medium;
  m.medium.many.range = 0.75;
  return m;
}

static void measure_box(const struct question *q, int edge)
{
  struct run run;
  run_start(&run, medium_model_of(q, edge), q->seed);
  const double k = shear_wave_number(&run.model), rho = q->medium.density;
  const double theory = theory_medium_viscosity_kinetic(&run.model) + theory_medium_viscosity_collisional(&run.model);
  const double life = rho / (theory * k * k * q->time_step); /* steps to 1/e */
  struct shear_wave wave = {.amplitude = q->amplitude, .expected = theory / rho, .every = 1 + (uint32_t)(life / 25.0)};
  wave.first = (uint32_t)ceil(q->skip / q->time_step / wave.every);
  wave.last = wave.first + 1 + (uint32_t)(1.2 * life / wave.every);
  double *amplitude = calloc(wave.last + 1, sizeof *amplitude);
  stop_unless(amplitude != NULL, &run);
  struct ratio lambda = {0};
  for (uint32_t n = 0; n < q->pairs; n++)
    stop_unless(shear_wave_pair(&run.model, &run.state, &run.work, &wave, q->seed * 1000000 + n, amplitude, &lambda),
                &run);
  printf("%d,%.8g,%.8g,%.3g,%.8g,%u\n", edge, k, rho * shear_wave_viscosity(&run.model, &wave, &lambda),
         rho * shear_wave_error(&run.model, &wave, &lambda), theory, q->pairs);
  fflush(stdout);
  free(amplitude);
  run_end(&run);
}

int main(int argc, const char **argv)
{
  const struct question q = read_question(argc, argv);
  printf("edge,k,eta,eta_error,theory,pairs\n");
  for (int b = 0; b < q.boxes; b++)
    measure_box(&q, atoi(q.edges[b]));
  return 0;
}
