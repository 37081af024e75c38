#include "cli/check_head.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "cli/sheet.h"
#include "files/snapshot.h"
#include "mpc/rule.h"
#include "system/fiber_kind.h"
#include "theory/dumbbell.h"
#include "theory/flow.h"
#include "theory/theory.h"
#include "work.h"

struct slowest {
  const char *what, *kind; /* kind: NULL if it is no fibers' */
  double time;             /* t0; 0: none is known */
};

static void take(struct slowest *s, const char *what, const char *kind, double time)
{
  if (time > s->time)
    *s = (struct slowest){what, kind, time};
}

/* Theory of a single fiber in the solvent; none for what it does not describe. */
static void look_at_kind(struct slowest *s, const struct model *m, const struct fiber_kind *k)
{
  const double p = k->vertices > 1 ? theory_aspect_ratio(theory_length(k), THEORY_RADIUS) : 0.0;
  if (k->ring || fiber_held(k) > 0 || k->vertices < 2 || model_is_flat(m) || !model_has_solvent(m) ||
      !model_in_cells(m))
    return;
  if (k->bending > 0.0 && p > 2.0)
    take(s, "in which a fiber turns", k->name, theory_rod_relaxation(theory_model_viscosity(m), theory_length(k), p));
  if (k->bending == 0.0 && k->bond_length == 0.0) {
    const double d0 = theory_vertex_diffusion(collision_rule_of(m), m->dimensions, k->mass, m->solvent.per_cell,
                                              m->solvent.cosine, model_collision_interval(m));
    take(s, "of the slowest mode of a chain, without hydrodynamics", k->name, theory_rouse_time(k, 1.0 / d0));
  }
}

static struct slowest slowest_of(const struct model *m)
{
  struct slowest s = {0};
  for (uint32_t k = 0; k < m->kinds; k++)
    look_at_kind(&s, m, &m->kind[k]);
  if (model_has_solvent(m) && model_in_cells(m))
    take(&s, "in which the flow becomes steady", NULL,
         theory_flow_transient(m, theory_model_viscosity(m) / m->solvent.per_cell));
  return s;
}

static void tell_length(const struct scene *scene)
{
  const struct model *m = &scene->model;
  const struct slowest s = slowest_of(m);
  const double time = m->time_step * (double)scene->steps;
  printf("# It lasts %.6g t0.", time);
  if (s.time > 0.0) {
    printf(" The slowest time known is that %s%s%s%s, %.4g t0", s.what, s.kind ? " of '" : "",
           s.kind ? text_shown(s.kind) : "", s.kind ? "'" : "", s.time);
    if (time < s.time)
      printf(": averages still show the start; steps: %.0f is that long, and errors need ten times as much",
             ceil(s.time / m->time_step));
    putchar('.');
  }
  putchar('\n');
}

static void tell_bytes(double bytes, const char *what, const char *before)
{
  const bool large = bytes >= 0.95e9;
  printf("%s%.3g %s of %s", before, bytes / (large ? 1e9 : 1e6), large ? "GB" : "MB", what);
}

#define MEBI 1048576.0

/* Frames are not compressed; tables are small beside them. */
static void tell_files(const struct scene *scene)
{
  const struct model *m = &scene->model;
  uint64_t scratch;
  const uint64_t state = state_bytes(m), observed = observers_bytes(&scene->observe, m, &scratch);
  const double text = (double)strlen(scene->text);
  printf("# It writes");
  tell_bytes(checkpoint_bytes(m, observed) + text, "checkpoint", " about ");
  if (observed > state)
    tell_bytes((double)observed, "that for observables", ", ");
  if (scene->trajectory_every > 0) {
    const uint64_t frames = 1 + scene->steps / scene->trajectory_every;
    const uint64_t rows = (uint64_t)m->vertices + (scene->trajectory_solvent ? m->solvent.particles : 0);
    tell_bytes(trajectory_bytes(rows, m->bonds, scene->trajectory_velocities, frames) + text, "trajectory", ", ");
  }
  printf(", and tables.\n\n");
}

void check_head(const struct scene *scene)
{
  tell_length(scene);
  tell_files(scene);
}

#define PROGRAM 16.0 /* MiB of the program and its libraries, with no scene, and of lists of contacts */
#define MARGIN 1.05  /* beside the arrays, memory of libraries and of the allocator: up to 4.5 % in scenes of 1 GiB */
#define COPIES 2.06  /* of a checkpoint, while it is made: one with room to grow (files/checkpoint_write.c) */

void check_memory(const struct scene *scene)
{
  const struct model *m = &scene->model;
  uint64_t scratch;
  const double kept = (double)observers_bytes(&scene->observe, m, &scratch);
  const double memory = (double)work_bytes(m) + kept + (double)scratch;
  sheet_row(false, "memory", "", memory / MEBI, "MiB", "with observables");
  sheet_row(false, "... while a checkpoint is written", "",
            PROGRAM + MARGIN * (memory + COPIES * ((double)state_bytes(m) + kept)) / MEBI, "MiB",
            "at most, with the program's 16");
}
