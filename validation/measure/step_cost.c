/*
 * CPU time of a step against volume and density, for validation/claims/cost: systems of the paper's fibers in turn, so
 * that a busy machine is unfair to none; of each the least of several rounds, and by how much the next is more.
 *
 * usage: step_cost ROUNDS STEPS CELLS:FIBERS[:VERTICES]...     64 vertices; gamma 5, dt 0.01, dt_c 0.02, kick-split,
 * uncrossable, global rescaling
 */
#include "measure.h"

enum { SYSTEMS_AT_MOST = 32 };

struct system {
  int cells;
  uint32_t fibers, vertices;
  double least, next; /* s per step */
  struct run run;
};

static void start(struct system *s, uint64_t seed)
{
  struct model m = standard_model(s->cells, s->cells, s->cells, 5, 0.01, 2);
  m.solvent.thermostat = THERMOSTAT_RESCALE;
  if (s->fibers > 0)
    add_kind(&m, s->fibers, s->vertices);
  run_start(&s->run, m, seed);
  run_steps(&s->run, 20); /* lists and caches are warm */
  s->least = s->next = INFINITY;
}

static void note(struct system *s, double seconds)
{
  if (seconds < s->least)
    s->next = s->least, s->least = seconds;
  else
    s->next = fmin(s->next, seconds);
}

int main(int argc, char **argv)
{
  static struct system systems[SYSTEMS_AT_MOST];
  const int rounds = argc > 3 ? atoi(argv[1]) : 0, steps = argc > 3 ? atoi(argv[2]) : 0, count = argc - 3;
  if (rounds < 2 || steps < 2 || count > SYSTEMS_AT_MOST) {
    fprintf(stderr, "usage: %s ROUNDS STEPS CELLS:FIBERS[:VERTICES]...\n", argv[0]);
    return 2;
  }
  for (int k = 0; k < count; k++) {
    systems[k].vertices = 64;
    if (sscanf(argv[k + 3], "%d:%u:%u", &systems[k].cells, &systems[k].fibers, &systems[k].vertices) < 2)
      return 2;
    start(&systems[k], (uint64_t)k + 1);
  }
  for (int r = 0; r < rounds; r++)
    for (int k = 0; k < count; k++) {
      const double from = cpu_seconds();
      run_steps(&systems[k].run, (uint64_t)steps);
      note(&systems[k], (cpu_seconds() - from) / steps);
    }
  printf("cells,fibers,vertices,cL3,milliseconds,milliseconds_error\n");
  for (int k = 0; k < count; k++) {
    struct system *s = &systems[k];
    const double length = 0.5 * s->vertices;
    printf("%d,%u,%u,%.6g,%.6g,%.6g\n", s->cells, s->fibers, s->vertices, s->fibers * pow(length / s->cells, 3.0),
           1000.0 * s->least, 1000.0 * (s->next - s->least));
    run_end(&s->run);
  }
  return 0;
}
