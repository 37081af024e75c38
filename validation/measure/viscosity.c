/* Kinematic viscosity of the solvent at four points, in two boxes each: see shear_wave.h. docs/accuracy.md has the
 * numbers. */
#include "measure.h"
#include "shear_wave.h"

struct point_of_solvent {
  const char *name;
  double per_cell, angle, collision_interval;
  double theory;     /* nu of Padding 2009, Eqs. (30), (31) */
  double amplitude;  /* A */
  uint32_t first;    /* collisions left out while correlations build up */
  uint32_t pairs[2]; /* runs with L_y = 16 and 32 */
};

/* The wave's own energy, A^2/2 per particle, ends as heat: the kinetic part of nu, proportional to T, asks for a small
 * A where it matters. With these the mean bias of nu is below 0.05, 0.1, 0.3 and 0.1 %. */
static const struct point_of_solvent points[] = {
    {"gamma  5,  90 deg, dt_c 0.02", 5, 90, 0.02, 2.236764, 0.6, 25, {1600, 100}},
    {"gamma  5,  90 deg, dt_c 0.1 ", 5, 90, 0.1, 0.4992, 0.25, 20, {2000, 300}},
    {"gamma  5,  90 deg, dt_c 0.5 ", 5, 90, 0.5, 0.3590, 0.15, 8, {5000, 1200}},
    {"gamma 10, 130 deg, dt_c 0.1 ", 10, 130, 0.1, 0.8700, 0.3, 15, {1200, 150}},
};

struct value {
  double nu, error;
};

static struct value measure(const struct point_of_solvent *p, int ly, uint32_t pairs)
{
  struct model m = standard_model(8, ly, 8, p->per_cell, p->collision_interval, 1);
  m.solvent.rotation_angle = p->angle;
  struct run run;
  run_start(&run, m, 1);

  const double k = shear_wave_number(&run.model);
  const double life = 1.0 / (p->theory * k * k * p->collision_interval); /* collisions to 1/e */
  struct shear_wave wave = {
      .amplitude = p->amplitude, .expected = 0.96 * p->theory, .every = 1 + (uint32_t)(life / 25.0)};
  wave.first = (p->first + wave.every - 1) / wave.every;
  wave.last = wave.first + (uint32_t)(1.2 * life / wave.every);
  double *amplitude = calloc(wave.last + 1, sizeof *amplitude);
  struct ratio lambda = {0};
  for (uint32_t n = 0; n < pairs; n++)
    stop_unless(shear_wave_pair(&run.model, &run.state, &run.work, &wave, 1000 + n, amplitude, &lambda), &run);
  struct value v = {shear_wave_viscosity(&run.model, &wave, &lambda), shear_wave_error(&run.model, &wave, &lambda)};
  free(amplitude);
  run_end(&run);
  return v;
}

int main(int argc, char **argv)
{
  const double factor = effort(argc, argv);
  const double k2 = 6.283185307179586477 * 6.283185307179586477 / 256.0;
  printf("kinematic viscosity, a0^2/t0; boxes 8 x L_y x 8; k -> 0: linear in k^2 through both boxes\n");
  printf("%-29s %-8s %-17s %-17s %-17s %-9s %s\n", "point", "theory", "nu(k), L_y = 16", "nu(k), L_y = 32",
         "nu, k -> 0", "/theory", "CPU s");
  for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
    const struct point_of_solvent *p = &points[i];
    double start = cpu_seconds();
    struct value a = measure(p, 16, 2 + (uint32_t)(factor * p->pairs[0]));
    struct value b = measure(p, 32, 2 + (uint32_t)(factor * p->pairs[1]));
    double nu = (4.0 * b.nu - a.nu) / 3.0, error = sqrt(16.0 * b.error * b.error + a.error * a.error) / 3.0;
    printf("%-29s %-8.4f %.4f +- %.4f  %.4f +- %.4f  %.4f +- %.4f  %.3f     %.0f\n", p->name, p->theory, a.nu, a.error,
           b.nu, b.error, nu, error, nu / p->theory, cpu_seconds() - start);
    printf("%-29s L_y = 16 corrected by 1/(1 - k^2/30): %.4f +- %.4f\n", "", a.nu / (1.0 - k2 / 30.0),
           a.error / (1.0 - k2 / 30.0));
    fflush(stdout);
  }
  return 0;
}
