/* Where a run is stable, and how far its energies are off: the time step against the stiffness of springs and of bends,
 * order kick-split, no thermostat, crossings free. Prints docs/pictures/stability.tsv, which
 * docs/pictures/draw-measured draws.
 *
 * Springs: dumbbells without rest length, M = 5; k <r^2>/3 over kT, which is 1/(1 - (omega dt/2)^2) for a leap-frog
 * whose on-step velocities have kT. Bends: fibers of 8 vertices, k = 100, l0 = 0.5; the mean bend energy over its exact
 * value, kappa (1 - coth kappa) + 1. Both over the solvent's kT. Drift: gain of total energy in kT per t0 and degree of
 * freedom of motion. */
#include "energy.h"
#include "measure.h"
#include "statistics.h"
#include "system/fiber_kind.h"
#include "theory/theory.h"

static struct model springs(double constant, double dt, uint32_t interval)
{
  struct model m = standard_model(6, 6, 6, 5, dt, interval);
  m.crossing.forbidden = false;
  struct fiber_kind *k = add_kind(&m, 64, 2);
  k->spring = constant;
  k->bond_length = k->bending = 0.0;
  return m;
}

static struct model bends(double constant, double dt, uint32_t interval)
{
  struct model m = standard_model(6, 6, 6, 5, dt, interval);
  m.crossing.forbidden = false;
  add_kind(&m, 16, 8)->bending = constant;
  return m;
}

static double spring_expected(const struct model *m)
{
  return 1.5 * m->fibers;
}

static double bend_expected(const struct model *m)
{
  const double kappa = m->kind[0].bending;
  return (kappa * (1.0 - 1.0 / tanh(kappa)) + 1.0) * m->fibers * (m->kind[0].vertices - 2);
}

static const struct panel {
  const char *name;
  struct model (*make)(double constant, double dt, uint32_t interval);
  double (*expected)(const struct model *m);
  double least;
} panels[] = {{"spring", springs, spring_expected, 10.0}, {"bend", bends, bend_expected, 1.0}};

static const double time_steps[] = {0.0025, 0.005, 0.01, 0.02, 0.04, 0.08, 0.16};

/* What a run gave: ratio and drift are good if it reached its end. */
struct outcome {
  double reached;
  struct sample ratio;
  double drift;
};

/* kT of the solvent; it holds most of the energy, and one of fixed total momentum. */
static double solvent_temperature(const struct run *run, const struct energy *e)
{
  return e->solvent / (1.5 * run->state.solvent.n * (1.0 - 1.0 / run->model.total_mass));
}

static struct outcome run_for(struct run *run, const struct panel *panel, double time)
{
  const double dt = run->model.time_step, expected = panel->expected(&run->model), settled = 5.0;
  const uint64_t look = (uint64_t)fmax(1.0, 0.1 / dt);
  struct blocks blocks = {.length = 150};
  double first = NAN, last = NAN, t = 0.0;
  while (t < time) {
    for (uint64_t k = 0; k < look; k++, t += dt)
      if (!step_advance(&run->state, &run->model, &run->work, NULL))
        return (struct outcome){.reached = t};
    if (t < settled)
      continue;
    const struct energy e = energy_on_step(&run->state, &run->model, &run->work);
    last = energy_total(&e);
    first = isnan(first) ? last : first;
    blocks_add(&blocks, (panel->make == springs ? e.bonds : e.bends) / expected / solvent_temperature(run, &e));
  }
  const double freedoms = 3.0 * (run->state.solvent.n + run->state.vertices);
  return (struct outcome){t, blocks.of_blocks, (last - first) / freedoms / (t - settled)};
}

/* A model is finished with a step that it is stable at; the map goes on to steps that model_finish rejects. */
#define STABLE 1e-4

static void measure(const struct panel *panel, double constant, double dt, double time)
{
  struct run run;
  const uint32_t interval = (uint32_t)fmax(1.0, nearbyint(0.02 / dt));
  struct model model = panel->make(constant, STABLE, interval);
  finish(&model);
  model.time_step = dt;
  run_start_finished(&run, model, 77);
  const double omega = fiber_highest_frequency(&run.model.kind[0]);
  const struct outcome o = run_for(&run, panel, time);
  printf("%-7s %8.4g %7.4g %8.3g %12.4g", panel->name, constant, dt, omega * dt, 2.0 / omega);
  if (o.reached < time)
    printf(" %12s %7s %9s fault at %.3g t0\n", "nan", "nan", "nan", o.reached);
  else
    printf(" %12.4g %7.2g %9.1e runs\n", o.ratio.mean, sample_error(&o.ratio), o.drift);
  fflush(stdout);
  run_end(&run);
}

int main(int argc, char **argv)
{
  const double time = 200.0 * (argc > 1 ? atof(argv[1]) : 1.0);
  printf("# what constant      dt omega_dt refused_from energy/exact   error     drift outcome\n");
  for (int p = 0; p < 2; p++) {
    for (int k = 0; k < 9; k++)
      for (size_t i = 0; i < sizeof time_steps / sizeof *time_steps; i++)
        measure(&panels[p], panels[p].least * pow(10.0, 0.5 * k), time_steps[i], time);
    printf("\n\n");
  }
  return 0;
}
