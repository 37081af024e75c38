/*
 * CPU time of a step against volume and density, for validation/claims/cost: systems of the paper's fibers (64
 * vertices) in turn, so that a busy machine is unfair to none; of each the least of several rounds.
 *
 * usage: step_cost ROUNDS STEPS CELLS:FIBERS...     gamma 5, dt 0.01, dt_c 0.02, kick-split, uncrossable, global
 * rescaling
 */
#include "measure.h"

enum { SYSTEMS_AT_MOST = 32 };

struct system {
  int cells;
  uint32_t fibers;
  double least; /* s per step */
  struct run run;
};

static void start(struct system *s, uint64_t seed)
{
  struct model m = standard_model(s->cells, s->cells, s->cells, 5, 0.01, 2);
  m.solvent.thermostat = THERMOSTAT_RESCALE;
  if (s->fibers > 0)
    add_kind(&m, s->fibers, 64);
  run_start(&s->run, m, seed);
  run_steps(&s->run, 20); /* lists and caches are warm */
  s->least = INFINITY;
}

int main(int argc, char **argv)
{
  static struct system systems[SYSTEMS_AT_MOST];
  const int rounds = argc > 3 ? atoi(argv[1]) : 0, steps = argc > 3 ? atoi(argv[2]) : 0, count = argc - 3;
  if (rounds < 1 || steps < 2 || count > SYSTEMS_AT_MOST) {
    fprintf(stderr, "usage: %s ROUNDS STEPS CELLS:FIBERS...\n", argv[0]);
    return 2;
  }
  for (int k = 0; k < count; k++) {
    if (sscanf(argv[k + 3], "%d:%u", &systems[k].cells, &systems[k].fibers) != 2)
      return 2;
    start(&systems[k], (uint64_t)k + 1);
  }
  for (int r = 0; r < rounds; r++)
    for (int k = 0; k < count; k++) {
      const double from = cpu_seconds();
      run_steps(&systems[k].run, (uint64_t)steps);
      systems[k].least = fmin(systems[k].least, (cpu_seconds() - from) / steps);
    }
  printf("cells,fibers,cL3,milliseconds\n");
  for (int k = 0; k < count; k++) {
    struct system *s = &systems[k];
    printf("%d,%u,%.6g,%.6g\n", s->cells, s->fibers, s->fibers * pow(32.0 / s->cells, 3.0), 1000.0 * s->least);
    run_end(&s->run);
  }
  return 0;
}
