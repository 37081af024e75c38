/*
 * Decay of a shear wave (shear_wave.h) in the suspension of Padding 2009, Sec. V: fibers of 64 vertices of mass 5, 1000
 * in 32^3 cells. How much do bonds resist the flow? The vertices are `loose` (no bonds), `free` (bonds, which may
 * cross), or `forbidden` (bonds, which may not).
 *
 * Output: comma-separated; share of the wave's amplitude that is left against time (t0), mean and standard error over
 * the pairs of runs. The box is a cube, so that a fiber is as long as the wave.
 */
#include "measure.h"
#include "shear_wave.h"

struct question {
  const char *bonds;
  double amplitude; /* A, a0/t0 */
  double last;      /* t0 */
  uint32_t looks;
  uint32_t pairs; /* of runs */
  uint64_t seed;  /* of the first pair */
  int edge;       /* a0 */
};

#define VERTICES 64   /* of a fiber */
#define LENGTH 32.0   /* of a fiber by the paper's count, a0 */
#define DENSITY 1000. /* c L^3 */

static const char *const kinds[] = {"loose", "free", "forbidden"};

static struct question read_question(int argc, const char **argv)
{
  for (size_t k = 0; argc == 8 && k < sizeof kinds / sizeof *kinds; k++)
    if (strcmp(argv[1], kinds[k]) == 0)
      return (struct question){.bonds = kinds[k],
                               .amplitude = atof(argv[2]),
                               .last = atof(argv[3]),
                               .looks = (uint32_t)atoi(argv[4]),
                               .pairs = (uint32_t)atoi(argv[5]),
                               .seed = strtoull(argv[6], NULL, 10),
                               .edge = atoi(argv[7])};
  fprintf(stderr, "usage: %s loose|free|forbidden AMPLITUDE TIME LOOKS PAIRS SEED EDGE\n", argv[0]);
  exit(2);
}

static struct model suspension(const struct question *q)
{
  struct model m = standard_model(q->edge, q->edge, q->edge, 5, 0.01, 2);
  const uint32_t fibers = (uint32_t)(DENSITY * pow(q->edge / LENGTH, 3.0) + 0.5);
  const bool loose = strcmp(q->bonds, "loose") == 0;
  m.crossing.forbidden = strcmp(q->bonds, "forbidden") == 0;
  add_kind(&m, loose ? VERTICES * fibers : fibers, loose ? 1 : VERTICES);
  return m;
}

int main(int argc, const char **argv)
{
  const struct question q = read_question(argc, argv);
  struct run run;
  run_start(&run, suspension(&q), q.seed);
  const double interval = model_collision_interval(&run.model);
  struct shear_wave wave = {.amplitude = q.amplitude,
                            .expected = 2.0,
                            .every = (uint32_t)(q.last / (q.looks * interval) + 0.5),
                            .last = q.looks};
  double *amplitude = calloc(q.looks + 1, sizeof *amplitude), *sum = calloc(2 * (q.looks + 1), sizeof *sum);
  stop_unless(amplitude != NULL && sum != NULL, &run);
  double *squares = sum + q.looks + 1;
  struct ratio unused = {0};
  for (uint32_t n = 0; n < q.pairs; n++) {
    stop_unless(shear_wave_pair(&run.model, &run.state, &run.work, &wave, q.seed * 1000000 + n, amplitude, &unused),
                &run);
    for (uint32_t look = 0; look <= q.looks; look++) {
      const double share = amplitude[look] / q.amplitude;
      sum[look] += share;
      squares[look] += share * share;
    }
  }
  printf("time,share,share_error\n");
  for (uint32_t look = 0; look <= q.looks; look++) {
    const double mean = sum[look] / q.pairs;
    printf("%.8g,%.8g,%.3g\n", look * wave.every * interval, mean,
           sqrt(fmax(0.0, squares[look] / q.pairs - mean * mean) / fmax(1.0, q.pairs - 1.0)));
  }
  free(amplitude);
  free(sum);
  run_end(&run);
  return 0;
}
