/*
 * Growth of the energy without a thermostat, compared between crossing rules, schemes and time steps: gamma particles
 * per cell, dt_c 0.02, 90 degrees.
 *
 * usage: energy_growth CELLS FIBERS VERTICES KAPPA GAMMA TIME RUNS SEED RULE:SCHEME:DT...
 *   Every choice makes RUNS runs of TIME t0, after one of settling, from the same equilibrium states. Growth of a run:
 *   slope of a straight line through its energies on step (energy.h), five per t0. Errors are from the scatter of runs.
 *
 * Columns: growth in kT/t0; of the total energy; beyond that of the first choice, of the total energy; executed
 * contacts per t0; the largest gain between two looks, kT (an accident of the leap-frog stands out); CPU s per t0.
 */
#include "../../tests/statistics.h"
#include "energy.h"
#include "rules.h"

enum { CHOICES = 12 };

struct choice {
  const char *name;
  enum crossing_kind rule;
  enum scheme scheme;
  double dt;
  struct sample growth, relative, beyond;
  double contacts, jump, seconds;
};

static double measure(struct choice *c, char **argv, uint64_t seed)
{
  const int cells = atoi(argv[1]);
  const double time = atof(argv[6]);
  struct model m = standard_model(cells, cells, cells, atof(argv[5]), c->dt, (uint32_t)(0.02 / c->dt + 0.5));
  m.scheme = c->scheme;
  set_crossing(&m, c->rule);
  add_kind(&m, (uint32_t)atoi(argv[2]), (uint32_t)atoi(argv[3]))->bending = atof(argv[4]);
  struct run run;
  run_start(&run, m, seed);
  run_steps(&run, (uint64_t)(1.0 / c->dt + 0.5));
  struct energy e = energy_on_step(&run.state, &run.model, &run.work);
  const double first = energy_total(&e), start = cpu_seconds();
  const uint64_t executed = run.state.counts.executed;
  const int looks = (int)(5.0 * time + 0.5);
  double before = first;
  struct line line = {0};
  for (int n = 0; n < looks; n++) {
    run_steps(&run, (uint64_t)(0.2 / c->dt + 0.5));
    e = energy_on_step(&run.state, &run.model, &run.work);
    line_add(&line, 0.2 * n, energy_total(&e) - first);
    c->jump = fmax(c->jump, fabs(energy_total(&e) - before));
    before = energy_total(&e);
  }
  c->seconds += cpu_seconds() - start;
  c->contacts += (double)(run.state.counts.executed - executed);
  sample_add(&c->growth, line_slope(&line));
  sample_add(&c->relative, line_slope(&line) / first);
  run_end(&run);
  return line_slope(&line) / first;
}

int main(int argc, char **argv)
{
  static struct choice choice[CHOICES];
  const int choices = argc - 9;
  if (choices < 1 || choices > CHOICES) {
    fprintf(stderr, "usage: %s CELLS FIBERS VERTICES KAPPA GAMMA TIME RUNS SEED RULE:SCHEME:DT...\n", argv[0]);
    return 2;
  }
  const int runs = atoi(argv[7]);
  for (int c = 0; c < choices; c++) {
    char rule[32], scheme[32];
    choice[c].name = argv[9 + c];
    if (sscanf(argv[9 + c], "%31[^:]:%31[^:]:%lf", rule, scheme, &choice[c].dt) != 3)
      return 2;
    choice[c].rule = rule_of_word(rule);
    choice[c].scheme = scheme_of_word(scheme);
  }
  for (int r = 0; r < runs; r++) {
    double of_first = 0.0;
    for (int c = 0; c < choices; c++) {
      const double found = measure(&choice[c], argv, strtoull(argv[8], NULL, 10) + (uint64_t)r);
      of_first = c == 0 ? found : of_first;
      sample_add(&choice[c].beyond, found - of_first);
    }
  }
  puts(
      "choice,growth,growth_error,of_energy,of_energy_error,beyond,beyond_error,contacts_per_t0,largest_jump,runs,time,"
      "seconds_per_t0");
  for (int c = 0; c < choices; c++) {
    const struct choice *k = &choice[c];
    const double total = runs * atof(argv[6]);
    printf("%s,%+.5g,%.2g,%+.3e,%.1e,%+.3e,%.1e,%.5g,%.3g,%d,%s,%.3g\n", k->name, k->growth.mean,
           sample_error(&k->growth), k->relative.mean, sample_error(&k->relative), k->beyond.mean,
           sample_error(&k->beyond), k->contacts / total, k->jump, runs, argv[6], k->seconds / total);
  }
  return 0;
}
