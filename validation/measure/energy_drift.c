/*
 * Energy drift without a thermostat at the demo's parameters, for the three orders of drift, collision and kick, for
 * each crossing rule: 32^3 cells, gamma 5, 100 fibers x 64 vertices, dt 0.01, dt_c 0.02.
 *
 * The total energy of positions and on-step velocities (energy.h) at intervals of 0.2 t0; drift = slope of a straight
 * line through them, its error from the slopes of eight parts of the run. Per degree of freedom: 3 (solvent +
 * vertices).
 */
#include "../../tests/statistics.h"
#include "contact/rule.h"
#include "energy.h"
#include "measure.h"

static const char *const order_names[] = {
    [SCHEME_PAPER] = "paper", [SCHEME_KICK_SPLIT] = "kick-split", [SCHEME_DRIFT_SPLIT] = "drift-split"};

struct scene {
  enum scheme order;
  enum crossing_kind rule;
  double dt;       /* collisions every 0.02 */
  uint32_t fibers; /* cL^3 */
  double time;     /* t0 */
};

static const struct scene scenes[] = {
    {SCHEME_PAPER, CROSSING_FREE, 0.01, 100, 10},
    {SCHEME_PAPER, CROSSING_FREE, 0.005, 100, 10},
    {SCHEME_KICK_SPLIT, CROSSING_FREE, 0.01, 100, 40},
    {SCHEME_KICK_SPLIT, CROSSING_FREE, 0.005, 100, 40},
    {SCHEME_DRIFT_SPLIT, CROSSING_FREE, 0.01, 100, 40},
    {SCHEME_DRIFT_SPLIT, CROSSING_FREE, 0.005, 100, 40},
    {SCHEME_PAPER, CROSSING_SEQUENTIAL, 0.01, 100, 10},
    {SCHEME_PAPER, CROSSING_SEQUENTIAL, 0.005, 100, 10},
    {SCHEME_KICK_SPLIT, CROSSING_SEQUENTIAL, 0.01, 100, 120},
    {SCHEME_KICK_SPLIT, CROSSING_SEQUENTIAL, 0.005, 100, 120},
    {SCHEME_DRIFT_SPLIT, CROSSING_SEQUENTIAL, 0.01, 100, 120},
    {SCHEME_DRIFT_SPLIT, CROSSING_SEQUENTIAL, 0.005, 100, 120},
    {SCHEME_KICK_SPLIT, CROSSING_SEQUENTIAL, 0.01, 1000, 4},
    {SCHEME_KICK_SPLIT, CROSSING_SEQUENTIAL, 0.005, 1000, 4},
    {SCHEME_DRIFT_SPLIT, CROSSING_SEQUENTIAL, 0.01, 1000, 4},
    {SCHEME_DRIFT_SPLIT, CROSSING_SEQUENTIAL, 0.005, 1000, 4},
    {SCHEME_KICK_SPLIT, CROSSING_EVENT_DRIVEN, 0.01, 100, 120},
    {SCHEME_KICK_SPLIT, CROSSING_EVENT_DRIVEN, 0.005, 100, 120},
    {SCHEME_DRIFT_SPLIT, CROSSING_EVENT_DRIVEN, 0.01, 100, 120},
    {SCHEME_DRIFT_SPLIT, CROSSING_EVENT_DRIVEN, 0.02, 100, 120},
    {SCHEME_KICK_SPLIT, CROSSING_FREE, 0.01, 1000, 40},
    {SCHEME_KICK_SPLIT, CROSSING_EVENT_DRIVEN, 0.01, 1000, 40},
    {SCHEME_DRIFT_SPLIT, CROSSING_FREE, 0.01, 1000, 40},
    {SCHEME_DRIFT_SPLIT, CROSSING_EVENT_DRIVEN, 0.01, 1000, 40},
    {SCHEME_DRIFT_SPLIT, CROSSING_FREE, 0.02, 1000, 40},
    {SCHEME_DRIFT_SPLIT, CROSSING_EVENT_DRIVEN, 0.02, 1000, 40},
};

#define PARTS 8

struct drift {
  double slope, error; /* kT per t0, whole box */
  double relative;     /* of the total energy, per t0 */
  double per_freedom;  /* kT per t0 and degree of freedom */
  double executed;     /* collisions per t0 */
  double noise;        /* scatter of the energy about the line, kT */
  double seconds;      /* CPU, per t0 */
};

static struct drift measure(const struct scene *scene, double time)
{
  const double dt = scene->dt;
  const uint32_t interval = (uint32_t)(0.02 / dt + 0.5);
  struct model m = standard_model(32, 32, 32, 5, dt, interval);
  m.scheme = scene->order;
  m.crossing.forbidden = scene->rule != CROSSING_FREE;
  m.crossing.rule = scene->rule;
  add_kind(&m, scene->fibers, 64);
  struct run run;
  run_start(&run, m, 11);
  run_steps(&run, interval); /* the first collision is behind us */
  struct energy e = energy_on_step(&run.state, &run.model, &run.work);
  const double first = energy_total(&e), start = cpu_seconds();
  const uint64_t executed = run.state.counts.executed, steps = (uint64_t)(0.2 / dt + 0.5);
  const int looks = (int)(time / 0.2 + 0.5);
  struct line whole = {0}, part[PARTS];
  memset(part, 0, sizeof part);
  for (int n = 0; n < looks; n++) {
    run_steps(&run, steps);
    e = energy_on_step(&run.state, &run.model, &run.work);
    line_add(&whole, 0.2 * n, energy_total(&e) - first);
    line_add(&part[n * PARTS / looks], 0.2 * n, energy_total(&e) - first);
  }
  struct sample slopes = {0};
  for (int p = 0; p < PARTS; p++)
    sample_add(&slopes, line_slope(&part[p]));
  const double freedoms = 3.0 * (run.model.solvent.particles + run.model.vertices), total = 0.2 * looks;
  struct drift d = {line_slope(&whole),
                    sample_error(&slopes),
                    line_slope(&whole) / first,
                    line_slope(&whole) / freedoms,
                    (double)(run.state.counts.executed - executed) / total,
                    0.0,
                    (cpu_seconds() - start) / total};
  d.noise =
      sqrt(fmax(0.0, (whole.yy - whole.y * whole.y / whole.n) - d.slope * (whole.xy - whole.x * whole.y / whole.n)) /
           whole.n);
  run_end(&run);
  return d;
}

int main(int argc, char **argv)
{
  const double factor = effort(argc, argv);
  printf("32^3, gamma 5, fibers x 64, no thermostat\n");
  printf("%-12s %-13s %-6s %-6s %-24s %-14s %-14s %-12s %-12s %-12s %s\n", "order", "crossings", "fibers", "dt",
         "drift, kT/t0", "of E, per t0", "kT/t0/freedom", "executed/t0", "kT/executed", "scatter, kT", "CPU s/t0");
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    const struct scene *s = &scenes[i];
    struct drift d = measure(s, factor * s->time);
    printf("%-12s %-13s %-6u %-6g %+.3e +- %.1e     %+.2e      %+.2e      %-12.2f %-12.4f %-12.2f %.2f\n",
           order_names[s->order], crossing_rule_row(s->rule)->name, s->fibers, s->dt, d.slope, d.error, d.relative,
           d.per_freedom, d.executed, d.executed > 0.0 ? d.slope / d.executed : 0.0, d.noise, d.seconds);
    fflush(stdout);
  }
  return 0;
}
