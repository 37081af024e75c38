/*
 * The velocity autocorrelation of solvent particles at long lags, C(t) = <v(0).v(t)>/<v.v>, from many origins of time.
 *
 * At long lags C is as small as 10^-5, where one origin leaves 1/sqrt(3 N) of noise, 10^-3 in a box of 32^3. But a
 * particle forgets its velocity within some collisions. So origins, and lags, that are so far apart are nearly
 * independent: each look is an origin for later ones. solvent_vacf has one origin for all its lags, and short ones.
 *
 * Output: comma-separated; lag (t0), C, its standard error from the scatter of blocks of looks. The last row has the
 * time -1: the mean over all lags, and its error, which counts what lags have in common.
 */
#include <math.h>

#include "../../tests/statistics.h"
#include "measure.h"

#define WARM_UP 200 /* collisions before the first origin */
#define BLOCK 200   /* looks whose mean is one value for the error */

struct question {
  int cells;            /* edge of the cubic box */
  double interval;      /* between collisions, t0 */
  uint32_t every;       /* collisions between looks */
  uint32_t first, last; /* lags, in looks */
  uint32_t looks;
  uint64_t seed;
};

/* Velocities of looks so far: by look (modulo last + 1), component, particle's id. */
struct history {
  uint32_t n, kept;
  float *velocity;
};

static struct question read_question(int argc, char **argv)
{
  struct question q = {0};
  if (argc == 8) {
    q.cells = atoi(argv[1]);
    q.interval = atof(argv[2]);
    q.every = (uint32_t)atoi(argv[3]);
    q.first = (uint32_t)atoi(argv[4]);
    q.last = (uint32_t)atoi(argv[5]);
    q.looks = (uint32_t)atoi(argv[6]);
    q.seed = strtoull(argv[7], NULL, 10);
  }
  if (q.cells > 0 && q.interval > 0.0 && q.every > 0 && q.last >= q.first && q.looks > q.last)
    return q;
  fprintf(stderr, "usage: %s CELLS DT_C COLLISIONS FIRST_LAG LAST_LAG LOOKS SEED   (lags in looks)\n", argv[0]);
  exit(2);
}

static float *velocities(const struct history *h, uint32_t look)
{
  return h->velocity + (size_t)(look % h->kept) * 3 * h->n;
}

static void keep(struct history *h, uint32_t look, const struct solvent *s)
{
  float *v = velocities(h, look);
  for (uint32_t i = 0; i < h->n; i++) {
    v[s->id[i]] = (float)s->vx[i];
    v[h->n + s->id[i]] = (float)s->vy[i];
    v[2 * h->n + s->id[i]] = (float)s->vz[i];
  }
}

/* Sum of v.v of two looks over all particles. */
static double product(const struct history *h, uint32_t look, uint32_t other)
{
  const float *v = velocities(h, look), *w = velocities(h, other);
  double sum = 0.0;
  for (uint32_t first = 0; first < 3 * h->n; first += 1024) {
    const uint32_t end = first + 1024 < 3 * h->n ? first + 1024 : 3 * h->n;
    float part[16] = {0};
    uint32_t i = first;
    for (; i + 16 <= end; i += 16)
      for (uint32_t k = 0; k < 16; k++)
        part[k] += v[i + k] * w[i + k];
    for (; i < end; i++)
      part[0] += v[i] * w[i];
    for (uint32_t k = 0; k < 16; k++)
      sum += part[k];
  }
  return sum;
}

static void print_sample(double time, const struct sample *s)
{
  printf("%.8g,%.8e,%.2e\n", time, s->mean, sample_error(s));
}

int main(int argc, char **argv)
{
  const struct question q = read_question(argc, argv);
  struct run run;
  run_start(&run, standard_model(q.cells, q.cells, q.cells, 5.0, q.interval, 1), q.seed);
  struct history h = {run.state.solvent.n, q.last + 1, NULL};
  const uint32_t lags = q.last - q.first + 1;
  h.velocity = malloc((size_t)h.kept * 3 * h.n * sizeof *h.velocity);
  struct sample *c = calloc(lags + 1, sizeof *c);
  double *block = calloc(lags, sizeof *block);
  stop_unless(h.velocity && c && block, &run);
  run_steps(&run, WARM_UP);
  uint32_t filled = 0;
  for (uint32_t look = 0; look < q.looks; look++, run_steps(&run, q.every)) {
    keep(&h, look, &run.state.solvent);
    if (look < q.last)
      continue;
    const double square = product(&h, look, look);
    for (uint32_t k = 0; k < lags; k++)
      block[k] += product(&h, look, look - q.first - k) / square;
    if (++filled < BLOCK)
      continue;
    double mean = 0.0;
    for (uint32_t k = 0; k < lags; k++) {
      sample_add(&c[k], block[k] / BLOCK);
      mean += block[k] / BLOCK / lags;
      block[k] = 0.0;
    }
    sample_add(&c[lags], mean);
    filled = 0;
    fprintf(stderr, "\r%u of %u looks", look + 1, q.looks);
  }
  fprintf(stderr, "\n");
  printf("time,vacf,vacf_error\n");
  for (uint32_t k = 0; k < lags; k++)
    print_sample((q.first + k) * q.every * q.interval, &c[k]);
  print_sample(-1.0, &c[lags]);
  free(h.velocity);
  free(c);
  free(block);
  run_end(&run);
  return 0;
}
