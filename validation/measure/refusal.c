/*
 * What a refused move costs, for each rule: 16^3 cells, gamma 5, dt_c 0.02, no thermostat, kick-split, 208 fibers x 38
 * vertices, as many vertices per volume as cL^3 = 1000 of 64 has, in a flow of 0.54 a0/t0 (Padding 2009, Fig. 3,
 * fastest).
 *
 * heat      total energy gained per executed collision, kT: slope of a straight line through the energies on step
 *           (energy.h), its error from eight parts of the run
 * lag       1 - how far the vertices went, of how far their velocities would have taken them, along the flow
 * executed  per vertex and t0;   negative: share of them with dP < 0
 */
#include "../../tests/statistics.h"
#include "energy.h"
#include "measure.h"

enum { PARTS = 8 };

struct rule {
  const char *name;
  enum refusal refusal;
  enum frame frame;
};

static const struct rule rules[] = {{"stay", REFUSAL_STAY, FRAME_LABORATORY},
                                    {"bounce", REFUSAL_BOUNCE, FRAME_LABORATORY},
                                    {"stay, flow", REFUSAL_STAY, FRAME_FLOW},
                                    {"bounce, flow", REFUSAL_BOUNCE, FRAME_FLOW}};
static const double steps_dt[] = {0.02, 0.01, 0.005};

struct cost {
  double heat, heat_error, lag, lag_error, rate, negative, executed_per_possible, seconds;
};

static double mean_x(const struct state *s)
{
  double sum = 0.0;
  for (uint32_t v = 0; v < s->vertices; v++)
    sum += (double)s->position[v].x * LATTICE_UNIT;
  return sum / s->vertices;
}

static double mean_vx(const struct state *s)
{
  double sum = 0.0;
  for (uint32_t v = 0; v < s->vertices; v++)
    sum += s->velocity[v].x;
  return sum / s->vertices;
}

/* A part of the run: its collisions, the heat in it, and how far the vertices went and should have gone. */
static void measure_part(struct run *run, uint64_t steps, struct sample *heat, struct sample *lag)
{
  const uint64_t executed = run->state.counts.executed;
  const double from = mean_x(&run->state);
  struct energy e = energy_on_step(&run->state, &run->model, &run->work);
  const double first = energy_total(&e);
  struct line line = {0};
  double expected = 0.0;
  for (uint64_t k = 0; k < steps; k++) {
    expected += run->model.time_step * mean_vx(&run->state);
    run_steps(run, 1);
    if ((k + 1) % run->model.solvent.interval_steps == 0) {
      e = energy_on_step(&run->state, &run->model, &run->work);
      line_add(&line, (double)(k + 1), energy_total(&e) - first);
    }
  }
  sample_add(heat, line_slope(&line) * (double)steps / (double)(run->state.counts.executed - executed));
  sample_add(lag, 1.0 - (mean_x(&run->state) - from) / expected);
}

static struct cost measure(const struct rule *rule, double dt, double time, uint64_t seed)
{
  struct model m = standard_model(16, 16, 16, 5, dt, (uint32_t)(0.02 / dt + 0.5));
  m.flow = (struct vec3){0.54, 0, 0};
  m.crossing.refusal = rule->refusal;
  m.crossing.frame = rule->frame;
  add_kind(&m, 208, 38);
  struct run run;
  run_start(&run, m, seed);
  run_steps(&run, (uint64_t)(1.0 / dt));
  struct sample heat = {0}, lag = {0};
  const double start = cpu_seconds();
  const struct collision_counts c = run.state.counts;
  for (int p = 0; p < PARTS; p++)
    measure_part(&run, (uint64_t)(time / PARTS / dt / 4) * 4, &heat, &lag);
  const double executed = (double)(run.state.counts.executed - c.executed);
  const struct cost cost = {heat.mean,
                            sample_error(&heat),
                            lag.mean,
                            sample_error(&lag),
                            executed / run.model.vertices / time,
                            (double)(run.state.counts.negative - c.negative) / executed,
                            executed / (double)(run.state.counts.possible - c.possible),
                            (cpu_seconds() - start) / time};
  run_end(&run);
  return cost;
}

int main(int argc, char **argv)
{
  const double factor = effort(argc, argv);
  printf("%-14s %-6s %-20s %-24s %-12s %-10s %-10s %s\n", "rule", "dt", "heat, kT/executed", "lag", "executed",
         "negative", "exec/poss", "CPU s/t0");
  for (size_t s = 0; s < sizeof steps_dt / sizeof *steps_dt; s++)
    for (size_t r = 0; r < sizeof rules / sizeof *rules; r++) {
      const struct cost c = measure(&rules[r], steps_dt[s], factor * 24.0, 21);
      printf("%-14s %-6g %.4f +- %.4f     %.2e +- %.0e     %-12.4f %-10.4f %-10.4f %.3f\n", rules[r].name, steps_dt[s],
             c.heat, c.heat_error, c.lag, c.lag_error, c.rate, c.negative, c.executed_per_possible, c.seconds);
      fflush(stdout);
    }
  return 0;
}
