/*
 * CPU time of a step against volume and density, for validation/cases/cost: systems of the paper's fibers in turn, so
 * that a busy machine is unfair to none; of each the least of several rounds, and by how much the next is more.
 *
 * usage: step_cost ROUNDS STEPS CELLS:FIBERS[:VERTICES[:RULE[:SCHEME[:DT]]]]...     64 vertices; gamma 5, dt_c 0.02,
 * global rescaling; RULE sequential, SCHEME kick-split, DT 0.01 if none is given
 */
#include "rules.h"

enum { SYSTEMS_AT_MOST = 32 };

struct system {
  int cells;
  uint32_t fibers, vertices;
  char rule[32], scheme[32];
  double dt;
  double least, next; /* s per step */
  struct run run;
};

static void start(struct system *s, uint64_t seed)
{
  struct model m = standard_model(s->cells, s->cells, s->cells, 5, s->dt, (uint32_t)(0.02 / s->dt + 0.5));
  set_crossing(&m, rule_of_word(s->rule));
  m.scheme = scheme_of_word(s->scheme);
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
    fprintf(stderr, "usage: %s ROUNDS STEPS CELLS:FIBERS[:VERTICES[:RULE[:SCHEME[:DT]]]]...\n", argv[0]);
    return 2;
  }
  for (int k = 0; k < count; k++) {
    systems[k] = (struct system){.vertices = 64, .rule = "sequential", .scheme = "kick-split", .dt = 0.01};
    if (sscanf(argv[k + 3], "%d:%u:%u:%31[^:]:%31[^:]:%lf", &systems[k].cells, &systems[k].fibers, &systems[k].vertices,
               systems[k].rule, systems[k].scheme, &systems[k].dt) < 2)
      return 2;
    start(&systems[k], (uint64_t)k + 1);
  }
  for (int r = 0; r < rounds; r++)
    for (int k = 0; k < count; k++) {
      const double from = cpu_seconds();
      run_steps(&systems[k].run, (uint64_t)steps);
      note(&systems[k], (cpu_seconds() - from) / steps);
    }
  printf("cells,fibers,vertices,rule,scheme,dt,cL3,milliseconds,milliseconds_error\n");
  for (int k = 0; k < count; k++) {
    struct system *s = &systems[k];
    const double length = 0.5 * s->vertices;
    printf("%d,%u,%u,%s,%s,%g,%.6g,%.6g,%.6g\n", s->cells, s->fibers, s->vertices, s->rule, s->scheme, s->dt,
           s->fibers * pow(length / s->cells, 3.0), 1000.0 * s->least, 1000.0 * (s->next - s->least));
    run_end(&s->run);
  }
  return 0;
}
