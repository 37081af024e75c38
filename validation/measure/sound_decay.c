/*
 * A standing sound wave: v_y = A cos(ky), k = 2 pi/EDGE, added to an equilibrium solvent in a box of 8 x EDGE x 8
 * cells. Runs with +A and -A start from the same state with the same random numbers; half their difference keeps the
 * wave and loses what is even in A (heat, the second harmonic).
 *
 * The amplitude (2/N) sum v_y cos(ky) goes as exp(-Gamma k^2 t) cos(c k t): for small k, c = sqrt(5/3) where energy is
 * conserved, 1 under a thermostat.
 *
 * Output: comma-separated; a row per look: its time, then the amplitude in units of A, of each block of pairs.
 */
#include "measure.h"

#define WIDTH 8
#define BLOCKS 24
#define LOOKS 160

struct question {
  int edge;
  double per_cell, interval, angle, amplitude;
  uint32_t every, pairs; /* collisions between looks; pairs of runs per block */
  uint64_t seed;
};

static struct question read_question(int argc, char **argv)
{
  if (argc != 9) {
    fprintf(stderr, "usage: %s EDGE PER_CELL DT_C ANGLE AMPLITUDE EVERY PAIRS SEED\n", argv[0]);
    exit(2);
  }
  return (struct question){.edge = atoi(argv[1]),
                           .per_cell = atof(argv[2]),
                           .interval = atof(argv[3]),
                           .angle = atof(argv[4]),
                           .amplitude = atof(argv[5]),
                           .every = (uint32_t)atoi(argv[6]),
                           .pairs = (uint32_t)atoi(argv[7]),
                           .seed = strtoull(argv[8], NULL, 10)};
}

static void add_wave(struct solvent *s, double k, double amplitude)
{
  for (uint32_t i = 0; i < s->n; i++)
    s->vy[i] += amplitude * cos(k * (double)s->y[i] * LATTICE_UNIT);
}

/* Right after a collision, when the solvent does not lag. */
static double wave_amplitude(const struct solvent *s, double k)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++)
    sum += s->vy[i] * cos(k * (double)s->y[i] * LATTICE_UNIT);
  return 2.0 * sum / s->n;
}

/* One run from the equilibrium of this seed; adds its part of the mean over pairs and signs. */
static void add_run(struct run *run, const struct question *q, double sign, uint64_t seed, double *amplitude)
{
  const double k = 6.283185307179586477 / q->edge;
  run->model.seed = seed;
  stop_unless(start_state(&run->state, &run->model, &run->work), run);
  add_wave(&run->state.solvent, k, sign * q->amplitude);
  for (int n = 0; n < LOOKS; n++) {
    amplitude[n] += sign * wave_amplitude(&run->state.solvent, k) / q->amplitude / (2.0 * q->pairs);
    run_steps(run, q->every);
  }
}

int main(int argc, char **argv)
{
  const struct question q = read_question(argc, argv);
  static double amplitude[BLOCKS][LOOKS];
  struct run run;
  run_start(&run, turned_model(WIDTH, q.edge, WIDTH, q.per_cell, q.interval, q.angle), q.seed);
  for (uint32_t b = 0; b < BLOCKS; b++)
    for (uint32_t n = 0; n < q.pairs; n++)
      for (int sign = -1; sign <= 1; sign += 2)
        add_run(&run, &q, sign, q.seed * 1000000 + b * q.pairs + n, amplitude[b]);
  printf("time");
  for (int b = 0; b < BLOCKS; b++)
    printf(",block%d", b + 1);
  for (int n = 0; n < LOOKS; n++) {
    printf("\n%.8g", n * q.every * q.interval);
    for (int b = 0; b < BLOCKS; b++)
      printf(",%.6g", amplitude[b][n]);
  }
  printf("\n");
  run_end(&run);
  return 0;
}
