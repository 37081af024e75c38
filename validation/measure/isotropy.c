/*
 * Is the SRD solvent isotropic, although its cells are cubes? The kinematic viscosity at the paper's point (gamma 5,
 * dt_c 0.02, 90 degrees) from the decay of shear waves in four ways: a cubic medium has two viscosities, and the waves
 * along [110] tell them apart by the direction of their velocity.
 *
 * A wave A e cos(k.r) is added to an equilibrium state, with both signs and the same random numbers; half the
 * difference keeps the wave. Estimates as in shear_wave.h. A wave of finite length loses k^2 a^2/30, which is divided
 * out.
 *
 * usage: isotropy EDGE PAIRS SEED; output: comma-separated, a row per wave.
 */
#include "../../tests/statistics.h"
#include "measure.h"

enum { EVERY = 5, FIRST = 5, LOOKS = 26 };

#define AMPLITUDE 1.0 /* a0/t0 */
#define EXPECTED 2.15 /* a0^2/t0, for weights */

struct slant {
  const char *name;
  int k[3], e[3]; /* whole waves per edge; direction of the velocity */
};

static const struct slant slants[] = {
    {"100-010", {1, 0, 0}, {0, 1, 0}},
    {"110-001", {1, 1, 0}, {0, 0, 1}},
    {"110-1m10", {1, 1, 0}, {1, -1, 0}},
    {"111-1m10", {1, 1, 1}, {1, -1, 0}},
};

static double length(const int v[3])
{
  return sqrt((double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
}

static double phase(const struct run *run, const struct slant *w, uint32_t i)
{
  const struct solvent *s = &run->state.solvent;
  const double unit = 6.283185307179586477 / run->model.box.cells[0] * LATTICE_UNIT;
  return unit * (w->k[0] * (double)s->x[i] + w->k[1] * (double)s->y[i] + w->k[2] * (double)s->z[i]);
}

static void add_wave(struct run *run, const struct slant *w, double amplitude)
{
  struct solvent *s = &run->state.solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    const double by = amplitude * cos(phase(run, w, i)) / length(w->e);
    s->vx[i] += by * w->e[0], s->vy[i] += by * w->e[1], s->vz[i] += by * w->e[2];
  }
}

static double amplitude_of(const struct run *run, const struct slant *w)
{
  const struct solvent *s = &run->state.solvent;
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++)
    sum += (s->vx[i] * w->e[0] + s->vy[i] * w->e[1] + s->vz[i] * w->e[2]) * cos(phase(run, w, i));
  return 2.0 * sum / (s->n * length(w->e));
}

static void add_pair(struct run *run, const struct slant *w, double rate, struct ratio *lambda)
{
  double a[LOOKS + 1] = {0.0}, after = 0.0, before = 0.0;
  for (int sign = -1; sign <= 1; sign += 2) {
    stop_unless(start_state(&run->state, &run->model, &run->work), run);
    add_wave(run, w, sign * AMPLITUDE);
    for (int n = 0; n <= LOOKS; n++) {
      if (n > 0)
        run_steps(run, EVERY);
      a[n] += 0.5 * sign * amplitude_of(run, w);
    }
  }
  for (int n = FIRST; n < LOOKS; n++) {
    after += exp(-rate * n) * a[n + 1];
    before += exp(-rate * n) * a[n];
  }
  ratio_add(lambda, after, before);
}

int main(int argc, const char **argv)
{
  if (argc < 4) {
    fprintf(stderr, "usage: %s EDGE PAIRS SEED\n", argv[0]);
    return 2;
  }
  const int edge = atoi(argv[1]), pairs = atoi(argv[2]);
  printf("wave,k,nu,nu_error\n");
  for (size_t n = 0; n < sizeof slants / sizeof *slants; n++) {
    struct run run;
    struct ratio lambda = {0};
    const double k = 6.283185307179586477 / edge * length(slants[n].k), time = EVERY * 0.02;
    run_start(&run, standard_model(edge, edge, edge, 5, 0.02, 1), 1);
    for (int p = 0; p < pairs; p++) {
      run.model.seed = strtoull(argv[3], NULL, 10) * 1000000 + (uint64_t)p;
      add_pair(&run, &slants[n], EXPECTED * k * k * time, &lambda);
    }
    const double scale = 1.0 / (k * k * time * (1.0 - k * k / 30.0));
    printf("%s,%.8g,%.8g,%.3g\n", slants[n].name, k, -log(ratio_value(&lambda)) * scale,
           ratio_error(&lambda) / ratio_value(&lambda) * scale);
    fflush(stdout);
    run_end(&run);
  }
  return 0;
}
