/* Runs in a folder behind include/uncross.h. */
#include <stdio.h>
#include <stdlib.h>

#include "api/handle.h"

static int open_run(struct uncross_run *run, const struct uncross_scene *scene, const char *folder, bool resume,
                    uncross_error *error)
{
  const struct folder by_name = {folder, FOLDER_BY_NAME};
  char checkpoint[4096];
  folder_path(&by_name, "checkpoint.h5", checkpoint, sizeof checkpoint);
  const int code = sim_make(&run->sim, scene, resume ? checkpoint : NULL, error);
  if (code != UNCROSS_OK)
    return code;
  const struct run_parts parts = sim_parts(&run->sim);
  const enum run_code opened =
      run_open(&run->run, &parts, folder, resume, scene->has_seed ? &scene->seed : NULL, &run->note);
  run->sim.of_run = true;
  sim_look(&run->sim);
  return opened == RUN_FINE ? UNCROSS_OK : fail(error, (int)opened, run->note.text, &run->sim.work.fault);
}

uncross_run *uncross_run_open(const uncross_scene *scene, const char *folder, int mode, uncross_error *error)
{
  if (!scene || !folder) {
    fail_null(error, "scene or folder");
    return NULL;
  }
  if (mode != UNCROSS_NEW && mode != UNCROSS_RESUME) {
    fail(error, UNCROSS_BAD_INPUT, "mode: neither UNCROSS_NEW nor UNCROSS_RESUME", NULL);
    return NULL;
  }
  uncross_run *run = calloc(1, sizeof *run);
  if (!run) {
    fail(error, UNCROSS_NO_MEMORY, "no memory to begin with", NULL);
    return NULL;
  }
  run->run.folder.fd = FOLDER_BY_NAME;
  struct call call;
  call_begin(&call, true);
  const int code = open_run(run, scene, folder, mode == UNCROSS_RESUME, error);
  call_end(&call);
  if (code == UNCROSS_OK)
    return run;
  uncross_run_free(run);
  return NULL;
}

const char *uncross_run_note(const uncross_run *run)
{
  return run ? run->note.text : NULL;
}

uint64_t uncross_run_wanted(const uncross_run *run)
{
  return run ? run->sim.scene.steps : 0;
}

const uncross_sim *uncross_run_sim(const uncross_run *run)
{
  return run ? &run->sim : NULL;
}

struct watched {
  struct uncross_run *run;
  uncross_run_watch *watch;
  void *context;
};

static bool keep_on(void *context)
{
  const struct watched *w = context;
  sim_look(&w->run->sim);
  return (!w->watch || w->watch(w->context, w->run)) && !w->run->unwanted;
}

/* A copy in a forked process. HDF5 is not called there either: another thread may have been at work in it. */
static int fail_forked(uncross_error *error)
{
  return fail(error, UNCROSS_BAD_INPUT,
              "this process was forked off while the run was open: the run goes on in the other", NULL);
}

int uncross_run_advance(uncross_run *run, uint64_t steps, uncross_run_watch *watch, void *context, uncross_error *error)
{
  if (!run)
    return fail_null(error, "run");
  if (!run_is_ours(&run->run))
    return fail_forked(error);
  if (run->advancing)
    return fail(error, UNCROSS_BAD_INPUT, "run: is being advanced, and is no further by its own watch", NULL);
  if (steps > MOST_STEPS)
    return fail_steps(error, MOST_STEPS);
  struct call call;
  struct message message;
  struct watched watched = {run, watch, context};
  call_begin(&call, true);
  run->advancing = true;
  const enum run_code code = run_advance(&run->run, steps, keep_on, &watched, &message);
  run->advancing = false;
  sim_look(&run->sim);
  call_end(&call);
  const struct fault fault = run->sim.work.fault;
  if (run->unwanted)
    uncross_run_free(run);
  return code == RUN_FINE ? UNCROSS_OK : fail(error, (int)code, message.text, &fault);
}

int uncross_run_save(uncross_run *run, uncross_error *error)
{
  if (!run)
    return fail_null(error, "run");
  if (!run_is_ours(&run->run))
    return fail_forked(error);
  struct call call;
  struct message message;
  call_begin(&call, true);
  const enum run_code code = run_save(&run->run, &message);
  call_end(&call);
  return code == RUN_FINE ? UNCROSS_OK : fail(error, (int)code, message.text, NULL);
}

int uncross_run_close(uncross_run *run, uncross_error *error)
{
  if (!run)
    return fail_null(error, "run");
  if (!run_is_ours(&run->run))
    return UNCROSS_OK;
  struct call call;
  struct message message;
  call_begin(&call, true);
  const enum run_code code = run_close(&run->run, &message);
  call_end(&call);
  if (code == RUN_FINE)
    run->note = message;
  return code == RUN_FINE ? UNCROSS_OK : fail(error, (int)code, message.text, NULL);
}

void uncross_run_free(uncross_run *run)
{
  if (!run || (run->run.owner && !run_is_ours(&run->run)))
    return;
  run->unwanted = true;
  if (run->advancing) /* which uses it */
    return;
  struct call call;
  call_begin(&call, true);
  run_release(&run->run);
  call_end(&call);
  sim_clear(&run->sim);
  free(run);
}
