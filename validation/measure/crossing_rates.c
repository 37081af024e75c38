/* Collision rates of needles against kinetic theory, and what each collision heats, for both rules: see needles.h. */
#include "measure.h"
#include "needles.h"

int main(int argc, char **argv)
{
  const double factor = effort(argc, argv);
  const double steps[] = {0.02, 0.01, 0.005};
  const uint32_t runs[] = {300, 300, 200};
  static const struct {
    const char *name;
    enum crossing_kind rule;
  } rules[] = {{"sequential", CROSSING_SEQUENTIAL}, {"event-driven", CROSSING_EVENT_DRIVEN}};
  printf("474 needles, k = 100, l0 = 1, M = 5, in 4 x 4 x 4; runs of 2 t0\n");
  printf("%-13s %-6s %-20s %-20s %-20s %-24s %s\n", "rule", "dt", "net/exact", "executed/exact", "negative/executed",
         "heat per executed, kT", "CPU s");
  for (size_t n = 0; n < 2 * sizeof steps / sizeof *steps; n++) {
    const size_t i = n / 2;
    struct model m = standard_model(4, 4, 4, 0, steps[i], 1);
    m.crossing.rule = rules[n % 2].rule;
    struct fiber_kind *k = add_kind(&m, 474, 2);
    k->bond_length = 1.0;
    k->bending = 0.0;
    struct run run;
    struct rates r = {.net = {0}};
    double start = cpu_seconds();
    run_start(&run, m, 1);
    stop_unless(needle_rates(&run.model, &run.state, &run.work, 1000, 2 + (uint32_t)(factor * runs[i]), &r), &run);
    printf("%-13s %-6g %.4f +- %.4f     %.4f +- %.4f     %.4f +- %.4f     %.3e +- %.0e      %.0f\n", rules[n % 2].name,
           steps[i], ratio_value(&r.net), ratio_error(&r.net), ratio_value(&r.executed), ratio_error(&r.executed),
           ratio_value(&r.negative), ratio_error(&r.negative), ratio_value(&r.heat), ratio_error(&r.heat),
           cpu_seconds() - start);
    fflush(stdout);
    run_end(&run);
  }
  return 0;
}
