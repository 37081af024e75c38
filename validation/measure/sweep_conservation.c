/*
 * What bond collisions conserve, over sweeps with nothing else between them: no solvent, no forces. Largest change of
 * kinetic energy (kT) and of total momentum (m a0/t0, largest component) in one sweep, divided by its refused moves: to
 * rounding, whatever the rule. A table for validation/cases/conservation.
 *
 * usage: sweep_conservation CELLS FIBERS VERTICES DT SWEEPS SEED
 */
#include "contact/contact.h"
#include "refusal.h"

struct totals {
  long double kinetic, x, y, z;
};

static struct totals totals_of(const struct run *run)
{
  struct totals t = {0};
  for (uint32_t v = 0; v < run->state.vertices; v++) {
    const long double mass = run->model.mass[v];
    const struct vec3 u = run->state.velocity[v];
    t.kinetic += 0.5L * mass * ((long double)u.x * u.x + (long double)u.y * u.y + (long double)u.z * u.z);
    t.x += mass * u.x;
    t.y += mass * u.y;
    t.z += mass * u.z;
  }
  return t;
}

static void measure(const struct refusal_rule *rule, char **argv)
{
  const int cells = atoi(argv[1]), sweeps = atoi(argv[5]);
  struct model m = standard_model(cells, cells, cells, 0, atof(argv[4]), 1);
  m.crossing.rejection = rule->refusal;
  m.crossing.frame = rule->frame;
  add_kind(&m, (uint32_t)atoi(argv[2]), (uint32_t)atoi(argv[3]));
  struct run run;
  run_start(&run, m, strtoull(argv[6], NULL, 10));
  long double energy = 0.0L, momentum = 0.0L;
  for (int k = 0; k < sweeps; k++) {
    const uint64_t executed = run.state.counts.executed;
    const struct totals a = totals_of(&run);
    stop_unless(
        contact_drift(&run.state, &run.model, &run.work.contact, 1.0, (uint64_t)k + 1, 0, NULL, &run.work.fault), &run);
    const struct totals b = totals_of(&run);
    const uint64_t count = run.state.counts.executed - executed;
    if (count == 0)
      continue;
    energy = fmaxl(energy, fabsl(b.kinetic - a.kinetic) / (long double)count);
    momentum = fmaxl(momentum, fmaxl(fabsl(b.x - a.x), fmaxl(fabsl(b.y - a.y), fabsl(b.z - a.z))) / (long double)count);
  }
  printf("%s,%u,%s,%d,%llu,%.3Lg,%.3Lg\n", rule->name, run.state.vertices, argv[4], sweeps,
         (unsigned long long)run.state.counts.executed, energy, momentum);
  run_end(&run);
}

int main(int argc, char **argv)
{
  if (argc != 7) {
    fprintf(stderr, "usage: %s CELLS FIBERS VERTICES DT SWEEPS SEED\n", argv[0]);
    return 2;
  }
  printf("rule,vertices,dt,sweeps,executed,energy_change,momentum_change\n");
  for (size_t r = 0; r < sizeof refusal_rules / sizeof *refusal_rules; r++)
    measure(&refusal_rules[r], argv);
  return 0;
}
