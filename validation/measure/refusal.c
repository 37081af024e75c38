/*
 * What a refused move, or a contact, costs, for each rule: 16^3 cells, gamma 5, dt_c 0.02, no thermostat, kick-split,
 * 208 fibers x 38 vertices, as many vertices per volume as cL^3 = 1000 of 64 has, in a flow of 0.54 a0/t0 (Padding
 * 2009, Fig. 3, fastest). refusal.h says what the columns are.
 */
#include "refusal.h"

static const double steps_dt[] = {0.02, 0.01, 0.005};

int main(int argc, char **argv)
{
  const double factor = effort(argc, argv);
  printf("%-14s %-6s %-20s %-24s %-12s %-10s %-10s %s\n", "rule", "dt", "heat, kT/executed", "lag", "executed",
         "negative", "exec/poss", "CPU s/t0");
  for (size_t s = 0; s < sizeof steps_dt / sizeof *steps_dt; s++)
    for (size_t r = 0; r < sizeof refusal_rules / sizeof *refusal_rules; r++) {
      const struct refusal_setup setup = {16, 208, 38, 0.54, steps_dt[s], factor * 24.0, SCHEME_KICK_SPLIT, 21};
      const struct refusal_cost c = refusal_measure(&refusal_rules[r], &setup);
      printf("%-14s %-6g %.3e +- %.1e   %+.2e +- %.0e    %-12.4f %-10.4f %-10.4f %.3f\n", refusal_rules[r].name,
             steps_dt[s], c.heat.mean, sample_error(&c.heat), c.lag.mean, sample_error(&c.lag), c.rate.mean,
             c.negative / c.executed, c.executed / c.possible, c.seconds / c.total_time);
      fflush(stdout);
    }
  return 0;
}
