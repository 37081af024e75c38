/* Diffusion coefficient of loose vertices (M = 5) at the paper's point, hydrodynamics off and on: see diffusion.h. */
#include "diffusion.h"
#include "measure.h"

struct box_of_vertices {
  bool hydrodynamics;
  int cells; /* edge of the cubic box */
  uint32_t vertices;
  uint32_t lag[2]; /* looks, 0.6 t0 apart */
  uint32_t looks;
};

static const struct box_of_vertices boxes[] = {
    {false, 8, 8, {1, 3}, 48000},
    {false, 8, 32, {1, 3}, 20000},
    {true, 8, 8, {5, 15}, 40000},
    {true, 16, 64, {5, 15}, 6000},
};

int main(int argc, char **argv)
{
  const double factor = effort(argc, argv), pi = 3.141592653589793;
  const double eta = 2.148 * 5.0; /* measured, viscosity.c */
  printf("loose vertices, M = 5, gamma 5, dt_c 0.02, 90 degrees\n");
  printf("%-4s %-6s %-9s %-11s %-22s %-20s %-22s %s\n", "HI", "box", "vertices", "chaos", "D/kT", "D/chaos",
         "D + images", "CPU s");
  for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++) {
    const struct box_of_vertices *b = &boxes[i];
    struct model m = standard_model(b->cells, b->cells, b->cells, 5, 0.02, 1);
    m.solvent.hydrodynamics = b->hydrodynamics;
    add_kind(&m, b->vertices, 1);
    struct run run;
    struct sample d;
    double start = cpu_seconds();
    run_start(&run, m, 7);
    stop_unless(diffusion_run(&run.model, &run.state, &run.work, 30, 100 + (uint32_t)(factor * b->looks), b->lag, &d),
                &run);
    const double chaos = diffusion_chaos(&run.model);
    /* hydrodynamic interaction with the images: kT 2.837297/(6 pi eta L) */
    const double images = b->hydrodynamics ? 2.837297 / (6.0 * pi * eta * b->cells) : 0.0;
    printf("%-4s %2d^3   %-9u %.6f    %.6f +- %.6f   %.4f +- %.4f     %.6f +- %.6f   %.0f\n",
           b->hydrodynamics ? "on" : "off", b->cells, b->vertices, chaos, d.mean, sample_error(&d), d.mean / chaos,
           sample_error(&d) / chaos, d.mean + images, sample_error(&d), cpu_seconds() - start);
    fflush(stdout);
    run_end(&run);
  }
  return 0;
}
