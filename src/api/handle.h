/* What stands behind the handles of include/uncross.h, and what all its functions share. */
#ifndef UNCROSS_API_HANDLE_H
#define UNCROSS_API_HANDLE_H

#include <hdf5.h>
#include <locale.h>

#include "files/run.h"
#include "uncross.h"

/* A scene is what was said; it is read anew by each user, so that no two simulations share memory. */
struct uncross_scene {
  char *name, *text;      /* text: NULL if it is made of settings alone */
  char **setting;         /* [settings] "path=value" */
  size_t settings, given; /* given: so many of them when the scene was read, which name each key once */
  bool has_steps, has_seed;
  uint64_t steps, seed; /* instead of the text's */
  uncross_start_watch *watch;
  void *context; /* of the watch */
};

/* A table that the library owns. */
struct table {
  struct uncross_table face; /* its pointers lead to the following */
  char *name;
  char **column;
  double *value;
  size_t room; /* rows */
};

struct uncross_sim {
  struct scene scene;
  struct state state;
  struct work work;
  struct observers *observers;
  struct checkpoint_head head;
  struct uncross_view view;
  bool stopped;                     /* work.fault says why */
  bool of_run;                      /* part of a struct uncross_run, which alone advances, saves and frees it */
  struct table series[OBSERVABLES]; /* rows since the start of this handle; without columns where not asked for */
  struct table *summary;            /* [summaries] of the last call of uncross_sim_tables */
  size_t summaries;
  const uncross_table **listed; /* series and summaries */
};

struct uncross_run {
  struct uncross_sim sim;
  struct run run;
  struct message note;
  bool advancing; /* so this call comes from its watch */
  bool unwanted;  /* to be freed at the end of the advance */
};

/* Surroundings of a call: numbers are read and written as in the C locale, by this thread only, and (files) HDF5 does
 * not print. call_end puts back what was there. */
struct call {
  locale_t ours, theirs;
  bool files;
  H5E_auto2_t print;
  void *print_data;
};
void call_begin(struct call *call, bool files);
void call_end(struct call *call);

/* Fills *error, if it is not NULL; returns the code. fault: NULL, or why the physics stopped. */
int fail(uncross_error *error, int code, const char *message, const struct fault *fault);

/* For a handle, or another pointer, that is NULL. */
int fail_null(uncross_error *error, const char *what);

/* For steps that are more than so many. */
#define MOST_STEPS ((uint64_t)INT64_MAX) /* of a run, as the scene's key says */
int fail_steps(uncross_error *error, uint64_t most);

/* The scene as it is read, with the steps and the seed that were set: to be freed with scene_free. checkpoint: of a run
 * that goes on and keeps what its scene meant when it was begun (scene_read_as), or NULL. */
int handle_read(const struct uncross_scene *from, const char *checkpoint, struct scene *scene, uncross_error *error);

/* Scene, state, work and observers of a simulation that has not begun; checkpoint as above. sim_clear in any case. */
int sim_make(struct uncross_sim *sim, const struct uncross_scene *scene, const char *checkpoint, uncross_error *error);
void sim_clear(struct uncross_sim *sim);
struct run_parts sim_parts(struct uncross_sim *sim);

/* Brings the view up to date. */
void sim_look(struct uncross_sim *sim);

/* Its tables (tables.c): series without rows; what this step adds to them; all freed, the last list of summaries too.
 * False if memory is short. */
bool tables_begin(struct uncross_sim *sim);
bool tables_sample(struct uncross_sim *sim);
void tables_clear(struct uncross_sim *sim);

#endif
