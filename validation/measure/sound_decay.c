/*
 * A standing sound wave: v_y = A cos(ky), k = 2 pi/EDGE, added to an equilibrium solvent in a box of 8 x EDGE x 8
 * cells; or, with `heat` as the last argument, a wave of temperature T = 1 + A cos(ky). Runs with +A and -A start from
 * the same state with the same random numbers; half their difference keeps the wave and loses what is even in A (heat
 * made by viscosity, the second harmonic).
 *
 * The amplitude of sound, (2/N) sum v_y cos(ky), goes as exp(-Gamma k^2 t) cos(c k t): for small k, c = sqrt(5/3) where
 * energy is conserved, 1 under a thermostat. That of heat, (2/N) sum (v^2 - 5)/3 cos(ky), is T' - (2/3) rho'/rho, the
 * part of the wave that sound does not carry away: for small k it goes as exp(-(3/5) D k^2 t), D the diffusivity of
 * heat at constant density.
 *
 * Output: comma-separated; a row per look: its time, then the amplitude in units of A, of each block of pairs.
 */
#include "measure.h"

#define WIDTH 8
#define BLOCKS 24
#define LOOKS 160

/* Adds a wave of this amplitude; the amplitude of a wave right after a collision, when the solvent does not lag. */
struct wave_kind {
  void (*add)(struct solvent *s, double k, double amplitude);
  double (*amplitude)(const struct solvent *s, double k);
};

struct question {
  int edge;
  double per_cell, interval, angle, amplitude;
  uint32_t every, pairs; /* collisions between looks; pairs of runs per block */
  uint64_t seed;
  const struct wave_kind *wave;
};

static double phase(const struct solvent *s, uint32_t i, double k)
{
  return k * (double)s->y[i] * LATTICE_UNIT;
}

static void add_sound(struct solvent *s, double k, double amplitude)
{
  for (uint32_t i = 0; i < s->n; i++)
    s->vy[i] += amplitude * cos(phase(s, i, k));
}

static double sound_amplitude(const struct solvent *s, double k)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++)
    sum += s->vy[i] * cos(phase(s, i, k));
  return 2.0 * sum / s->n;
}

static void add_heat(struct solvent *s, double k, double amplitude)
{
  for (uint32_t i = 0; i < s->n; i++) {
    const double factor = sqrt(1.0 + amplitude * cos(phase(s, i, k)));
    s->vx[i] *= factor;
    s->vy[i] *= factor;
    s->vz[i] *= factor;
  }
}

static double heat_amplitude(const struct solvent *s, double k)
{
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    const double square = s->vx[i] * s->vx[i] + s->vy[i] * s->vy[i] + s->vz[i] * s->vz[i];
    sum += (square - 5.0) / 3.0 * cos(phase(s, i, k));
  }
  return 2.0 * sum / s->n;
}

static const struct wave_kind sound = {add_sound, sound_amplitude}, heat = {add_heat, heat_amplitude};

static struct question read_question(int argc, char **argv)
{
  const struct wave_kind *wave = &sound;
  if (argc == 10)
    wave = strcmp(argv[9], "heat") == 0 ? &heat : NULL;
  if (argc < 9 || argc > 10 || !wave) {
    fprintf(stderr, "usage: %s EDGE PER_CELL DT_C ANGLE AMPLITUDE EVERY PAIRS SEED [heat]\n", argv[0]);
    exit(2);
  }
  return (struct question){.edge = atoi(argv[1]),
                           .per_cell = atof(argv[2]),
                           .interval = atof(argv[3]),
                           .angle = atof(argv[4]),
                           .amplitude = atof(argv[5]),
                           .every = (uint32_t)atoi(argv[6]),
                           .pairs = (uint32_t)atoi(argv[7]),
                           .seed = strtoull(argv[8], NULL, 10),
                           .wave = wave};
}

/* One run from the equilibrium of this seed; adds its part of the mean over pairs and signs. */
static void add_run(struct run *run, const struct question *q, double sign, uint64_t seed, double *amplitude)
{
  const double k = 6.283185307179586477 / q->edge;
  run->model.seed = seed;
  stop_unless(start_state(&run->state, &run->model, &run->work), run);
  q->wave->add(&run->state.solvent, k, sign * q->amplitude);
  for (int n = 0; n < LOOKS; n++) {
    amplitude[n] += sign * q->wave->amplitude(&run->state.solvent, k) / q->amplitude / (2.0 * q->pairs);
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
