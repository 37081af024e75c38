/* `uncross run` and `uncross analyze`: a scene from start to end, with everything that goes into its folder. */
#ifndef UNCROSS_RUN_H
#define UNCROSS_RUN_H

#include <stdbool.h>
#include <stdint.h>

/* Exit codes of the program. */
enum exit_code {
  EXIT_DONE = 0,
  EXIT_TROUBLE = 1,     /* no memory, or a bug */
  EXIT_BAD_INPUT = 2,   /* options, scene, snapshot: nothing was written */
  EXIT_STOPPED = 3,     /* the physics could not go on; the last checkpoint stays */
  EXIT_NOT_WRITTEN = 4, /* a file or the folder could not be written, or the folder is another process's (its lock);
                           the last checkpoint stays */
  EXIT_INTERRUPTED = 5, /* SIGINT or SIGTERM; a checkpoint was written, --resume goes on */
  EXIT_CLOSE = 6,       /* oracle compare: different within tolerance */
  EXIT_DIFFERS = 7,     /* oracle compare: different beyond it; oracle judge: different */
  EXIT_CANNOT_TELL = 8  /* oracle judge: observables missing, or errors too large */
};

struct run_options {
  const char *scene;
  const char *folder;
  bool has_steps, has_seed;
  uint64_t steps, seed; /* instead of the scene's */
  bool resume, quiet;
};

enum exit_code run_scene(const struct run_options *options);

/* Recomputes the observables of a trajectory's scene from its frames, into tables in the folder. */
enum exit_code run_analyze(const char *path, const char *folder);

#endif
