/* What a crossing rule costs, measured over a run without a thermostat: shared by `refusal` (docs/accuracy.md) and
 * `refused_moves` (validation/cases/conservation, galilean).
 *
 * heat      total energy gained per executed collision, kT: slope of a straight line through the energies on step
 *           (energy.h), its error from 24 parts of the run
 * drift     the same per t0
 * lag       1 - how far the vertices went, of how far their velocities would have taken them, along the flow
 * executed  per vertex and t0;   negative: share of them with dP < 0 */
#ifndef UNCROSS_REFUSAL_H
#define UNCROSS_REFUSAL_H

#include "../../tests/statistics.h"
#include "energy.h"
#include "measure.h"

enum { REFUSAL_PARTS = 24 };

struct refusal_rule {
  const char *name;
  enum rejection refusal;
  enum frame frame;
  enum crossing_kind rule;
};

static const struct refusal_rule refusal_rules[] = {
    {"stay", REJECTION_STAY, FRAME_LABORATORY, CROSSING_SEQUENTIAL},
    {"bounce", REJECTION_BOUNCE, FRAME_LABORATORY, CROSSING_SEQUENTIAL},
    {"stay-flow", REJECTION_STAY, FRAME_FLOW, CROSSING_SEQUENTIAL},
    {"bounce-flow", REJECTION_BOUNCE, FRAME_FLOW, CROSSING_SEQUENTIAL},
    {"event-driven", REJECTION_STAY, FRAME_LABORATORY, CROSSING_EVENT_DRIVEN}};

/* What to run: cells along each edge, fibers of so many vertices, flow along x, t0 to run after one of settling. */
struct refusal_setup {
  int cells;
  uint32_t fibers, vertices;
  double flow, dt, time;
  enum scheme order;
  uint64_t seed;
};

struct refusal_cost {
  struct sample heat, drift, lag, rate; /* of the parts */
  double total_time, executed, possible, negative, momentum, seconds;
};

/* Sums over vertices: mean x in a0, mean x velocity in a0/t0. */
static inline double refusal_mean_x(const struct state *s)
{
  double sum = 0.0;
  for (uint32_t v = 0; v < s->vertices; v++)
    sum += (double)s->position[v].x * LATTICE_UNIT;
  return sum / s->vertices;
}

static inline double refusal_mean_vx(const struct state *s)
{
  double sum = 0.0;
  for (uint32_t v = 0; v < s->vertices; v++)
    sum += s->velocity[v].x;
  return sum / s->vertices;
}

/* Total momentum along x, m a0/t0; the net of all internal forces is zero, so half steps do not matter. */
static inline double refusal_momentum(const struct run *run)
{
  const struct solvent *s = &run->state.solvent;
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++)
    sum += s->vx[i];
  for (uint32_t v = 0; v < run->state.vertices; v++)
    sum += run->model.mass[v] * run->state.velocity[v].x;
  return sum;
}

/* A part of the run: its collisions, the heat in it, and how far the vertices went and should have gone. */
static inline void refusal_measure_part(struct run *run, uint64_t steps, struct refusal_cost *cost)
{
  const uint64_t before = run->state.counts.executed;
  const double from = refusal_mean_x(&run->state), time = (double)steps * run->model.time_step;
  struct energy e = energy_on_step(&run->state, &run->model, &run->work);
  const double first = energy_total(&e);
  struct line line = {0};
  double expected = 0.0;
  for (uint64_t k = 0; k < steps; k++) {
    expected += run->model.time_step * refusal_mean_vx(&run->state);
    run_steps(run, 1);
    if ((k + 1) % run->model.solvent.interval_steps == 0) {
      e = energy_on_step(&run->state, &run->model, &run->work);
      line_add(&line, (double)(k + 1), energy_total(&e) - first);
    }
  }
  const double executed = (double)(run->state.counts.executed - before), gained = line_slope(&line) * (double)steps;
  sample_add(&cost->heat, gained / executed);
  sample_add(&cost->drift, gained / time);
  sample_add(&cost->lag, 1.0 - (refusal_mean_x(&run->state) - from) / expected);
  sample_add(&cost->rate, executed / run->model.vertices / time);
}

static inline struct refusal_cost refusal_measure(const struct refusal_rule *rule, const struct refusal_setup *setup)
{
  struct model m =
      standard_model(setup->cells, setup->cells, setup->cells, 5, setup->dt, (uint32_t)(0.02 / setup->dt + 0.5));
  m.flow = (struct vec3){setup->flow, 0, 0};
  m.scheme = setup->order;
  m.crossing.rejection = rule->refusal;
  m.crossing.frame = rule->frame;
  m.crossing.rule = rule->rule;
  add_kind(&m, setup->fibers, setup->vertices);
  struct run run;
  run_start(&run, m, setup->seed);
  run_steps(&run, (uint64_t)(1.0 / setup->dt));
  struct refusal_cost cost = {.momentum = 0.0};
  const double start = cpu_seconds(), momentum = refusal_momentum(&run);
  const struct collision_counts c = run.state.counts;
  const uint64_t steps = (uint64_t)(setup->time / REFUSAL_PARTS / setup->dt / 4) * 4;
  for (int p = 0; p < REFUSAL_PARTS; p++)
    refusal_measure_part(&run, steps, &cost);
  cost.total_time = (double)(REFUSAL_PARTS * steps) * setup->dt;
  cost.executed = (double)(run.state.counts.executed - c.executed);
  cost.possible = (double)(run.state.counts.possible - c.possible);
  cost.negative = (double)(run.state.counts.negative - c.negative);
  cost.momentum = refusal_momentum(&run) - momentum;
  cost.seconds = cpu_seconds() - start;
  run_end(&run);
  return cost;
}

#endif
