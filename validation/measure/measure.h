/* What the measuring programs share: models at the paper's standard point, and a run that ends the program if it fails.
 */
#ifndef UNCROSS_MEASURE_H
#define UNCROSS_MEASURE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "start/start.h"
#include "step.h"

struct run {
  struct model model;
  struct state state;
  struct work work;
};

/* gamma = per_cell, 90 degrees, kick-split, uncrossable, no fibers; a collision every `interval` steps of dt. */
static inline struct model standard_model(int lx, int ly, int lz, double per_cell, double dt, uint32_t interval)
{
  struct model m;
  memset(&m, 0, sizeof m);
  m.box = box_of_cells(lx, ly, lz);
  m.time_step = dt;
  m.scheme = SCHEME_KICK_SPLIT;
  m.solvent.per_cell = per_cell;
  m.solvent.collision_interval = interval * dt;
  m.solvent.rotation_angle = 90.0;
  m.solvent.hydrodynamics = true;
  m.crossing.forbidden = true;
  return m;
}

/* The same solvent, rotated by `angle` degrees, with a collision in every step. */
static inline struct model turned_model(int lx, int ly, int lz, double per_cell, double dt, double angle)
{
  struct model m = standard_model(lx, ly, lz, per_cell, dt, 1);
  m.solvent.rotation_angle = angle;
  return m;
}

/* The collision rule from a program's argument: `at-a`, or SRD by its angle in degrees. */
static inline void set_rule(struct model *m, const char *word)
{
  m->solvent.rule = strncmp(word, "at-a", 4) == 0   ? RULE_AT_A
                    : strncmp(word, "at+a", 4) == 0 ? RULE_AT_PLUS_A
                                                    : RULE_SRD;
  m->solvent.rotation_angle = m->solvent.rule == RULE_SRD ? atof(word) : 90.0;
}

/* Adds a kind of the paper's fibers: M = 5, k = 100, l0 = 0.5, kappa = 64, in equilibrium. */
static inline struct fiber_kind *add_kind(struct model *m, uint32_t count, uint32_t vertices)
{
  m->kind = realloc(m->kind, (m->kinds + 1) * sizeof *m->kind);
  struct fiber_kind *k = &m->kind[m->kinds++];
  memset(k, 0, sizeof *k);
  snprintf(k->name, sizeof k->name, "kind%u", m->kinds);
  k->count = count;
  k->vertices = vertices;
  k->mass = 5.0;
  k->bond_length = 0.5;
  k->spring = 100.0;
  k->bending = 64.0;
  return k;
}

static inline void stop_unless(bool ok, const struct run *run)
{
  char text[512] = "no memory";
  if (ok)
    return;
  if (run->work.fault.code != FAULT_NONE)
    fault_describe(&run->work.fault, text, sizeof text);
  fprintf(stderr, "%s\n", text);
  exit(1);
}

/* Finishes the model, or ends the program. */
static inline void finish(struct model *model)
{
  struct model_error error;
  if (model_finish(model, &error))
    return;
  fprintf(stderr, "%s: %s\n", error.path, error.text);
  exit(1);
}

/* Starts a finished model from its equilibrium state of this seed. */
static inline void run_start_finished(struct run *run, struct model model, uint64_t seed)
{
  memset(run, 0, sizeof *run);
  run->model = model;
  run->model.seed = seed;
  stop_unless(state_alloc(&run->state, &run->model) && work_alloc(&run->work, &run->model), run);
  stop_unless(start_state(&run->state, &run->model, &run->work), run);
}

/* The same of a model that is not finished yet. */
static inline void run_start(struct run *run, struct model model, uint64_t seed)
{
  finish(&model);
  run_start_finished(run, model, seed);
}

static inline void run_steps(struct run *run, uint64_t steps)
{
  for (uint64_t k = 0; k < steps; k++)
    stop_unless(step_advance(&run->state, &run->model, &run->work, NULL), run);
}

static inline void run_end(struct run *run)
{
  work_free(&run->work);
  state_free(&run->state);
  model_free(&run->model);
}

static inline double cpu_seconds(void)
{
  return (double)clock() / CLOCKS_PER_SEC;
}

/* The first argument as a factor on the length of the measurement; 1 without one. */
static inline double effort(int argc, char **argv)
{
  double factor = argc > 1 ? atof(argv[1]) : 1.0;
  if (factor > 0.0)
    return factor;
  fprintf(stderr, "usage: %s [factor on the number of runs, 1 by default]\n", argv[0]);
  exit(2);
}

#endif
