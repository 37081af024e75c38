/*
 * Observables: const state in, numbers out. An observable that the scene does not ask for costs nothing; the others are
 * sampled each at its own interval. An observer's memory is two flat blocks. A checkpoint stores them, so an
 * interrupted run ends with the tables of an uninterrupted one.
 */
#ifndef UNCROSS_OBSERVE_OBSERVE_H
#define UNCROSS_OBSERVE_OBSERVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "contact/contact.h"
#include "system/model.h"
#include "system/state.h"

enum observable {
  OBSERVE_CONSERVED,   /* time series: energies, momentum */
  OBSERVE_TEMPERATURE, /* time series: solvent and vertex temperature */
  OBSERVE_STATICS,     /* averages per kind of fiber: bonds, bends, end-to-end distance */
  OBSERVE_DYNAMICS,    /* against lag, per kind: g(t), g_cm(t), d^2(t), end-to-end correlation, diffusion coefficient */
  OBSERVE_COLLISIONS,  /* time series: crossings possible, executed, negative, and their rates */
  OBSERVE_PROFILE,     /* averages in slabs along y: density, velocity, temperature */
  OBSERVE_STRESS,      /* time series: stress of the solvent in the bulk, of fibers, and on walls */
  OBSERVE_DUMBBELLS,   /* averages: second moments of the vectors of dumbbells */
  OBSERVE_ORIENTATION, /* averages per kind of fiber: second moments of end-to-end vectors and of directions of bonds */
  OBSERVE_MEMORY,      /* averages against lag, per kind: memory of velocities and of the stress of fibers */
  OBSERVE_BEAD,        /* time series: place, velocity and force of the bead */
  OBSERVE_PRESSURE,    /* time series: pressure tensor, potential energy, configurational temperature */
  OBSERVE_WAKE,        /* averages around the bead: density and displacement of vertices */
  OBSERVE_TOPOLOGY,    /* counts: crossings of bonds from sample to sample */
  OBSERVABLES
};

/* The observables that a scene asks for. */
struct observe_plan {
  uint64_t every[OBSERVABLES]; /* steps between samples; 0: not asked for */
  uint64_t longest_lag;        /* of the dynamics, in steps; 0: 2^20 samples. Decides the size of its memory. */
  uint64_t slabs;              /* of the profile */
  uint64_t from; /* step from which on averages (statics, dynamics, profile, dumbbells, orientation, memory, wake) and
                    crossings (topology) are made; time series begin at 0 */
};

/* Names as scenes and files use them: "conserved", "temperature", ... */
extern const char *const observable_names[OBSERVABLES];

/* A table of numbers. A time series grows by rows; a summary is made anew each time it is asked for. */
struct observe_table {
  const char *name;          /* file name without ".csv" */
  const char *const *column; /* [columns] e.g. "time", "g", "g_error" */
  size_t columns, rows;
  double *value; /* [rows * columns] */
};

/* Whether a run of this model may make a table of this name; model NULL: of any. */
bool observe_is_table(const struct model *model, const char *name);

struct observers; /* all observers of a run */

/* Receives the rows of time series. */
struct observe_sink {
  bool (*row)(void *context, enum observable which, size_t columns, const double *values);
  void *context;
};

/* Observers for this plan; NULL if memory is short. */
struct observers *observers_create(const struct observe_plan *plan, const struct model *model);
void observers_free(struct observers *observers);

/* Bytes that the observers of this plan keep, which a checkpoint stores; scratch: those that they need beside. The
 * model's numbers are enough (model_finish_numbers). */
uint64_t observers_bytes(const struct observe_plan *plan, const struct model *model, uint64_t *scratch);

struct work;

/* Has the steps of this work sum what observers read of them: after work_alloc, and when observers are new. */
void observers_watch(struct observers *observers, struct work *work);

/* What is to receive the contacts of each step (step_advance). NULL if no observer asks for them. */
const struct contact_log *observers_contacts(const struct observers *observers);

/* True if an observer is due at this step. */
bool observers_due(const struct observers *observers, uint64_t step);

/* Shows the state to every observer that is due; rows of time series go to the sink, if it is not NULL. Call once per
 * step, at step 0 too; the same step shown again counts once. Numbers depend on the state alone, so states read from a
 * trajectory, shown at the same steps, make the same tables. False if the sink fails. */
bool observers_sample(struct observers *observers, const struct model *model, const struct state *state,
                      const struct observe_sink *sink);

enum { OBSERVE_MOST_COLUMNS = 40 };

/* Column names of a time series of this model, for its file's first line: their number; 0 if `which` is not a time
 * series. */
size_t observe_series_columns(const struct model *model, enum observable which,
                              const char *names[OBSERVE_MOST_COLUMNS]);

/* Summaries as they stand now. Each is given to `take`, then freed. */
bool observers_summaries(const struct observers *observers, const struct model *model,
                         bool (*take)(void *context, const struct observe_table *table), void *context);

/* The observers' memory, for checkpoints: blocks of doubles or of 64-bit integers, each under a name that is unique and
 * stable. A resumed run creates the observers from the same plan and model, and fills the blocks of the same names. */
struct observe_block {
  const char *name;
  bool integer;
  size_t count;
  void *data;   /* double or int64_t [count] */
  bool setting; /* not memory, but a key of the scene that determines the memory: it must be unchanged in a resume */
  bool later;   /* checkpoints of earlier programs have none: such a setting was 0, such memory (doubles) is unknown,
                   NaN, as are all columns made of it */
  bool wraps;   /* integers of any size; others are marks of steps, places and counts, below OBSERVE_MOST_INTEGER */
};
#define OBSERVE_MOST_INTEGER ((int64_t)1 << 62) /* so that the difference of two is a 64-bit number */
size_t observers_blocks(struct observers *observers, const struct observe_block **blocks);

/* 1 + the last step that this observer has sampled, 0 if none; part of its memory. A time series has a row for that
 * step. */
uint64_t observers_end(const struct observers *observers, enum observable which);

/* Energy and momentum of a state, at the time of the step (conserved.h); independent of memory order. NaN if memory is
 * short. */
struct conserved {
  double solvent_kinetic, vertex_kinetic, bond, bend, pairs, total; /* kT */
  struct vec3 momentum;                                             /* m a0/t0 */
};
struct conserved observe_conserved(const struct model *model, const struct state *state);

#endif
