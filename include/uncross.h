/*
 * uncross: noncrossing fibers and chains in a hydrodynamic solvent (Padding, J. Chem. Phys. 130, 144903, 2009).
 *
 * The interface of libuncross, for C99 and C++. docs/library.md explains it with examples.
 *
 * Units: a0 (edge of a collision cell) = kT = m (mass of a solvent particle) = 1; time in t0 = a0 sqrt(m/kT).
 * Positions are whole lattice units: one is UNCROSS_LATTICE_UNIT a0.
 *
 * Errors: a function that can fail returns a code (UNCROSS_OK is 0), or a handle that is NULL. It then fills *error,
 * if that is not NULL. The library never ends the process, never prints, and leaves signals and the locale alone.
 * A handle that is NULL is an error of the caller: functions with a code say UNCROSS_BAD_INPUT, others return 0 or
 * NULL. A free of NULL does nothing. Pointers to results must not be NULL unless a function says so.
 *
 * Memory: whatever is returned as a pointer to const belongs to its handle. A text that is returned as `char *` is the
 * caller's, who gives it back with uncross_free.
 *
 * Threads: different handles may be used by different threads at the same time. One handle is for one thread at a time.
 * Functions that read or write files are marked FILES: they call HDF5. Debian builds HDF5 for threads
 * (H5is_library_threadsafe); with an HDF5 that is not, only one thread of a process may be in such a function.
 *
 * Readers: HDF5 files are read by a process of its own, the program uncross of the same build. It is looked for in
 * $UNCROSS_READER (an absolute path), beside the library, in ../bin, and in bin of the prefix that was built for.
 *
 * Processes: a process that forks off (fork) has a copy of every handle. A simulation may be used in both; each has its
 * own. A run in a folder stays with the process that opened it. In the other one it can be looked at; advance and save
 * are errors, close and free do nothing.
 */
#ifndef UNCROSS_INTERFACE_H
#define UNCROSS_INTERFACE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define UNCROSS_API __attribute__((visibility("default")))
#else
#define UNCROSS_API
#endif

/* --- versions ---------------------------------------------------------------------------------------------------- */

/* Number of this binary interface, also in the name of the shared library: libuncross.so.0. */
#define UNCROSS_INTERFACE 0

/* Functions that were added since interface 0 began are counted here; nothing is ever taken away under one number. */
#define UNCROSS_INTERFACE_AGE 0

/* The release of the library that runs, e.g. "0.1.0". */
UNCROSS_API const char *uncross_version(void);

/* UNCROSS_INTERFACE and UNCROSS_INTERFACE_AGE of the library that runs. A program that was compiled with a larger age
 * than uncross_interface_age() uses functions that this library does not have. */
UNCROSS_API int uncross_interface(void);
UNCROSS_API int uncross_interface_age(void);

/* --- errors ------------------------------------------------------------------------------------------------------ */

/* All are exit codes of the program too. */
enum uncross_code {
  UNCROSS_OK = 0,
  UNCROSS_NO_MEMORY = 1,  /* memory is short; a reader of a scene or file may call this BAD_INPUT */
  UNCROSS_BAD_INPUT = 2,  /* a scene, a file that is read, or an argument; nothing was written */
  UNCROSS_STOPPED = 3,    /* the physics cannot go on: uncross_error says step, entity and cause */
  UNCROSS_NOT_WRITTEN = 4 /* a file or folder cannot be written, or is another process's */
};

/* Causes of UNCROSS_STOPPED. `value` and `limit` of the error are in the units given here. */
enum uncross_cause {
  UNCROSS_CAUSE_NONE = 0,
  UNCROSS_CAUSE_SOLVENT_MOVE,   /* a solvent particle moves too far in one flight; a0 */
  UNCROSS_CAUSE_SOLVENT_SPEED,  /* its momentum is beyond the range of its cell's sums; m a0/t0 */
  UNCROSS_CAUSE_VERTEX_SPEED,   /* the same of a vertex */
  UNCROSS_CAUSE_SOLVENT_ENERGY, /* its m v^2 is beyond the range of the thermostat's sum; m a0^2/t0^2 */
  UNCROSS_CAUSE_VERTEX_ENERGY,  /* the same of a vertex */
  UNCROSS_CAUSE_CELL_MASS,      /* a cell holds too much mass; m */
  UNCROSS_CAUSE_VERTEX_MOVE,    /* a vertex moves too far in one time step; a0 */
  UNCROSS_CAUSE_VERTEX_PLACE,   /* a vertex is too far from the origin, unwrapped; a0 */
  UNCROSS_CAUSE_BOND_TOO_LONG,  /* a bond is longer than half the shortest edge of the box; a0 */
  UNCROSS_CAUSE_NO_MEMORY,      /* memory is short for the lists of bonds that may touch */
  UNCROSS_CAUSE_OTHER           /* one that is newer than this list */
};

/* What went wrong. The caller provides it; its layout never changes under one UNCROSS_INTERFACE. */
typedef struct uncross_error {
  int code;           /* enum uncross_code */
  int cause;          /* enum uncross_cause; UNCROSS_CAUSE_NONE unless the physics stopped */
  uint64_t step;      /* of the cause: the step that was being made */
  int64_t entity;     /* of the cause: id of a solvent particle, number of a vertex, bond (its first vertex) or cell */
  double value;       /* of the cause: what was found */
  double limit;       /* of the cause: what is allowed */
  char message[1024]; /* one sentence in English; of a scene `file:line:column: what is wrong; what is allowed` */
} uncross_error;

/* --- scenes ------------------------------------------------------------------------------------------------------ */

/* What a simulation is of: docs/scene.md lists every key. */
typedef struct uncross_scene uncross_scene;

/* Reads a scene file. settings: [count] texts "path=value" that replace or add keys, e.g. "solvent.per_cell=5",
 * "fibers.0.count=12" (or by name: "fibers.rods.count=12"), "box=[8, 8, 8]". A value is a word, a number, or a list of
 * them; a section is set key by key; a key that two settings name is refused. NULL, with an error, if the file cannot
 * be read or the scene is refused. A snapshot that the scene starts from is looked for when a run begins, not before: a
 * resume does not need it. */
UNCROSS_API uncross_scene *uncross_scene_read(const char *path, const char *const *settings, size_t count,
                                              uncross_error *error);

/* The same from text (UTF-8, NUL-terminated). `name` stands for the file in messages, and a snapshot that the scene
 * starts from is looked for relative to the folder of this name. */
UNCROSS_API uncross_scene *uncross_scene_parse(const char *name, const char *text, const char *const *settings,
                                               size_t count, uncross_error *error);

/* An empty scene, to be filled with uncross_scene_set. NULL, with an error, if memory is short. */
UNCROSS_API uncross_scene *uncross_scene_new(uncross_error *error);

/* Replaces or adds one key of any scene: path and value as in a setting above; the number that follows the last one of
 * a list appends an item. A path that names no key, or what is no value, is refused at once, and the scene stays as it
 * was. Whether keys fit together is looked at by uncross_scene_check, and by all that use the scene: so keys may be set
 * in any order. */
UNCROSS_API int uncross_scene_set(uncross_scene *scene, const char *path, const char *value, uncross_error *error);

/* Steps and seed instead of those of the scene's text: the text that files keep stays as it is. The seed of a run that
 * is resumed must be the one that it has. */
UNCROSS_API int uncross_scene_set_steps(uncross_scene *scene, uint64_t steps, uncross_error *error);
UNCROSS_API int uncross_scene_set_seed(uncross_scene *scene, uint64_t seed, uncross_error *error);

/* Asked, whenever a fiber is laid that excludes others, by those that start from this scene; 0: the start is given up,
 * with UNCROSS_BAD_INPUT. Many thick fibers take seconds. watch: NULL if nobody wants to be asked. */
typedef int uncross_start_watch(void *context);
UNCROSS_API int uncross_scene_watch_start(uncross_scene *scene, uncross_start_watch *watch, void *context,
                                          uncross_error *error);

/* Whether the scene can be run: types, ranges, stability. */
UNCROSS_API int uncross_scene_check(const uncross_scene *scene, uncross_error *error);

/* The effective scene as YAML, every default filled in; uncross_free gives it back. NULL, with an error, if the scene
 * is refused or memory is short. */
UNCROSS_API char *uncross_scene_text(const uncross_scene *scene, uncross_error *error);

/* The value of one key of the effective scene, defaults included, e.g. "solvent.per_cell", "fibers.0.name" or
 * "fibers.rods.count": a word, a number, or "[a, b, c]", to be given back with uncross_free. The second is for a key
 * that holds one number. */
UNCROSS_API char *uncross_scene_get(const uncross_scene *scene, const char *path, uncross_error *error);
UNCROSS_API int uncross_scene_number(const uncross_scene *scene, const char *path, double *value, uncross_error *error);

/* Calls `tell` for each limit of the paper that the scene leaves. */
UNCROSS_API int uncross_scene_warnings(const uncross_scene *scene, void (*tell)(void *context, const char *text),
                                       void *context, uncross_error *error);

/* Frees a scene. Simulations and runs made from it keep what they need. */
UNCROSS_API void uncross_scene_free(uncross_scene *scene);

/* Frees a text that the library returned. */
UNCROSS_API void uncross_free(void *memory);

/* --- simulations ------------------------------------------------------------------------------------------------- */

/* One simulation in memory. */
typedef struct uncross_sim uncross_sim;

/* A simulation of this scene at step 0, in its starting state, drawn or read from the scene's snapshot (FILES, if it
 * has one). NULL, with an error, if the scene is refused, memory is short, or a bond does not fit the box. */
UNCROSS_API uncross_sim *uncross_sim_start(const uncross_scene *scene, uncross_error *error);

/* A simulation that goes on from a checkpoint of uncross_sim_save or of the program: it reaches the hashes of a
 * simulation that was never interrupted. The checkpoint must be of this scene (steps, cadences and comments may
 * differ). Averages go on too; time series begin anew. FILES. */
UNCROSS_API uncross_sim *uncross_sim_resume(const uncross_scene *scene, const char *path, uncross_error *error);

/* Makes `steps` time steps and samples what the scene's `observe` asks for. Those made before and these are fewer than
 * 2^63, or none is made. On an error the simulation stands at the step that could not be finished: it may be looked at
 * and must be freed, and every further advance fails in the same way. */
UNCROSS_API int uncross_sim_advance(uncross_sim *sim, uint64_t steps, uncross_error *error);

/* Writes a checkpoint: the file is at every moment either the old one or the new one. Nothing is replaced but a
 * checkpoint: another file, a link, a pipe or a device under this name is an error, and so is one named PATH.part,
 * which is needed for a moment. FILES. */
UNCROSS_API int uncross_sim_save(uncross_sim *sim, const char *path, uncross_error *error);

UNCROSS_API void uncross_sim_free(uncross_sim *sim);

/* Steps made since the scene's start; t0 since then. */
UNCROSS_API uint64_t uncross_sim_step(const uncross_sim *sim);
UNCROSS_API double uncross_sim_time(const uncross_sim *sim);

/* The hash of the state (XXH64; docs/conventions.md lists the bytes): equal for equal bits, whatever the order in
 * memory. The same number as `state_hash` of run.json. */
UNCROSS_API int uncross_sim_hash(const uncross_sim *sim, uint64_t *hash, uncross_error *error);

/* Calls `tell` for what a reader of the results should know: what uncross_scene_warnings tells, and how a snapshot
 * began the simulation. */
UNCROSS_API int uncross_sim_warnings(const uncross_sim *sim, void (*tell)(void *context, const char *text),
                                     void *context, uncross_error *error);

/* Contacts of bonds since the start. */
typedef struct uncross_counts {
  uint64_t moves;    /* trial moves of vertices */
  uint64_t possible; /* contacts found */
  uint64_t executed; /* moves rejected, with an exchange of momentum */
  uint64_t negative; /* of these, with a negative impulse */
} uncross_counts;
UNCROSS_API int uncross_sim_counts(const uncross_sim *sim, uncross_counts *counts, uncross_error *error);

/* Edge of one lattice unit, in a0: exact, 2^-40. */
#define UNCROSS_LATTICE_UNIT (1.0 / 1099511627776.0)

/*
 * The state, without copies. Bond j joins vertices j and next[j].
 *
 * The library owns the struct, so later versions may append fields. The struct and the arrays stay where they are as
 * long as the simulation lives; their contents change with every advance. Between steps velocities of vertices are
 * those of the half step ahead (leap-frog). Solvent particles are streamed once per collision interval: their columns
 * show the last streaming, `lag` time steps ago, and are in memory order, which changes; `id` says who is who.
 * uncross_sim_solvent gives them at the time of the step, in order.
 */
typedef struct uncross_view {
  uint64_t step;
  double lag;                 /* time steps since the solvent was last streamed */
  uint32_t particles;         /* of the solvent */
  uint32_t vertices;          /* of all fibers */
  uint32_t fibers, kinds;     /* fibers; kinds of fibers */
  int32_t cells[3];           /* edges of the box, a0 */
  int64_t edge[3];            /* edges of the box, lattice units */
  const int64_t *position;    /* [vertices][3] lattice units, unwrapped */
  const double *velocity;     /* [vertices][3] a0/t0, half a step ahead */
  const double *mass;         /* [vertices] m */
  const int32_t *next;        /* [vertices] the vertex that the bond goes on to, or -1 */
  const uint32_t *fiber;      /* [vertices] number of the vertex's fiber */
  const uint32_t *first;      /* [fibers + 1] first vertex of each fiber; first[fibers] is `vertices` */
  const uint32_t *kind;       /* [fibers] number of the fiber's kind, in the order of the scene */
  const int64_t *x, *y, *z;   /* [particles] lattice units, within the box, at the last streaming */
  const double *vx, *vy, *vz; /* [particles] a0/t0, at the last streaming */
  const uint32_t *id;         /* [particles] 0 .. particles - 1, each once */
} uncross_view;
UNCROSS_API const uncross_view *uncross_sim_view(const uncross_sim *sim);

/* The name of a kind of fibers, NULL if there is no such kind. */
UNCROSS_API const char *uncross_sim_kind(const uncross_sim *sim, uint32_t kind);

/* Positions of the vertices in a0, unwrapped, into position: [vertices][3]. */
UNCROSS_API int uncross_sim_positions(const uncross_sim *sim, double *position, uncross_error *error);

/* The solvent now, its lag made good, in the order of ids, into position: [particles][3] a0, within the box; and
 * velocity: [particles][3] a0/t0. Either may be NULL. */
UNCROSS_API int uncross_sim_solvent(const uncross_sim *sim, double *position, double *velocity, uncross_error *error);

/* --- observables ------------------------------------------------------------------------------------------------- */

/* Energies and momentum at the time of the step (velocities of vertices half a step back). */
typedef struct uncross_conserved {
  double solvent_kinetic, vertex_kinetic, bond, bend, total; /* kT */
  double momentum[3];                                        /* m a0/t0 */
} uncross_conserved;
UNCROSS_API int uncross_sim_conserved(const uncross_sim *sim, uncross_conserved *conserved, uncross_error *error);

/* A table of numbers. The library owns the struct, so later versions may append fields. */
typedef struct uncross_table {
  const char *name; /* as the file of the program, without ".csv", e.g. "conserved", "dynamics-fiber" */
  size_t columns, rows;
  const char *const *column; /* [columns] names; docs/observables.md explains them */
  const double *value;       /* [rows][columns] */
} uncross_table;

/* The tables of what the scene's `observe` asks for, made anew. Time series hold their samples since the start or
 * resume of this handle; averages are those of now. tables: receives [*count] pointers, good until the next call of
 * this function, the next advance, or the end of the simulation. Of the simulation of a run: its averages, since its
 * time series are files. */
UNCROSS_API int uncross_sim_tables(const uncross_sim *sim, const uncross_table *const **tables, size_t *count,
                                   uncross_error *error);

/* --- runs in a folder -------------------------------------------------------------------------------------------- */

/* What `uncross run` does: a folder that nobody else writes to, with tables, trajectory, checkpoints and run.json
 * (docs/files.md). All functions of this section except those that only look are FILES. */
typedef struct uncross_run uncross_run;

enum uncross_mode {
  UNCROSS_NEW = 0,   /* the folder is made, or holds nothing of a run; nothing is written over */
  UNCROSS_RESUME = 1 /* goes on from the folder's checkpoint */
};

/* Opens a run of this scene in this folder and writes what belongs to its first step; of a new run, its first
 * checkpoint too. A failure leaves no file of a new run, and no folder that was made for it. */
UNCROSS_API uncross_run *uncross_run_open(const uncross_scene *scene, const char *folder, int mode,
                                          uncross_error *error);

/* What there is to say about a run that was opened, or closed, all the same; "" if nothing. After uncross_run_open e.g.
 * that a damaged trajectory was set aside; after uncross_run_close that its folder was moved meanwhile. */
UNCROSS_API const char *uncross_run_note(const uncross_run *run);

/* Steps wanted in all: `steps` of the scene. */
UNCROSS_API uint64_t uncross_run_wanted(const uncross_run *run);

/* The simulation of the run, to look at. It lives as long as the run; it is not advanced, saved or freed by itself. */
UNCROSS_API const uncross_sim *uncross_run_sim(const uncross_run *run);

/* Asked after every step; 0: stop here. A watch may save, close and free its run: a run that it closed or freed makes
 * no further step. It may not advance it. */
typedef int uncross_run_watch(void *context, const uncross_run *run);

/* Makes `steps` time steps (below 2^63), fewer if the run's end comes first, with all that belongs into the folder, and
 * a checkpoint whenever the scene's `checkpoint.seconds` have passed. watch: NULL if nobody wants to be asked. On an
 * error the run is over, and run.json says why; the last checkpoint stays. */
UNCROSS_API int uncross_run_advance(uncross_run *run, uint64_t steps, uncross_run_watch *watch, void *context,
                                    uncross_error *error);

/* Writes checkpoint, averages and run.json of this step, and goes on. */
UNCROSS_API int uncross_run_save(uncross_run *run, uncross_error *error);

/* Saves, closes all files and lets go of the folder: run.json says `finished`, or `interrupted` if the run's end is not
 * reached. A run that failed, or that was past its end when it was opened, is closed as it is. After this the run can
 * only be looked at and freed. */
UNCROSS_API int uncross_run_close(uncross_run *run, uncross_error *error);

/* Frees a run. One that was not closed loses what came after its last checkpoint, as if the process had died. */
UNCROSS_API void uncross_run_free(uncross_run *run);

#ifdef __cplusplus
}
#endif

#endif
