/* What library.js calls besides functions of include/uncross.h: those that would call JavaScript, and what a picture
 * shows that the library has no function for. */
#include <stdio.h>
#include <stdlib.h>

#include "api/handle.h"
#include "cli/command.h"
#include "files/start.h"
#include "wall/motion.h"

char *live_warnings(const uncross_sim *sim, uncross_error *error);
int live_report(const uncross_scene *scene, uncross_error *error);
int live_bead(const uncross_sim *sim, double position[3]);
double live_offset(const uncross_sim *sim);
int live_advance(uncross_sim *sim, uint32_t steps, uint32_t *bond, uint32_t room, uint32_t *count,
                 uncross_error *error);

static void tell(void *context, const char *text)
{
  fprintf(context, "%s\n", text);
}

/* uncross_sim_warnings as lines, to be given back with uncross_free; NULL, with an error. */
char *live_warnings(const uncross_sim *sim, uncross_error *error)
{
  char *text = NULL;
  size_t size;
  FILE *stream = open_memstream(&text, &size);
  if (!stream)
    return NULL;
  const int code = uncross_sim_warnings(sim, tell, stream, error);
  if (fclose(stream) == 0 && code == UNCROSS_OK)
    return text;
  free(text);
  return NULL;
}

/* Prints what `uncross check` prints. */
int live_report(const uncross_scene *from, uncross_error *error)
{
  struct scene scene;
  const int code = handle_read(from, NULL, &scene, error);
  if (code != UNCROSS_OK)
    return code;
  const struct stream stream = stream_of_seed(scene.seed);
  scene_report(&scene, &stream, false);
  fflush(stdout);
  scene_free(&scene);
  return UNCROSS_OK;
}

/* Place of the center of the bead, a0, unwrapped; returns the number of beads. */
int live_bead(const uncross_sim *sim, double position[3])
{
  if (sim->state.beads == 0)
    return 0;
  const struct vec3 at = point_in_a0(sim->state.bead[0].position);
  position[0] = at.x;
  position[1] = at.y;
  position[2] = at.z;
  return 1;
}

/* How far the image beyond y = L has slid along x now, a0 within the box; 0 unless the box is sheared. */
double live_offset(const uncross_sim *sim)
{
  return (double)shear_offset(&sim->scene.model, 2 * sim->state.step) * LATTICE_UNIT;
}

/* Bonds of contacts, two for each, as far as there is room; `also` is told, too. */
struct seen {
  const struct contact_log *also;
  uint32_t *bond, room, count;
};

static void see(void *context, const struct contact_event *event)
{
  struct seen *seen = context;
  if (event->executed && seen->count + 2 <= seen->room) {
    seen->bond[seen->count++] = event->moving_bond;
    seen->bond[seen->count++] = event->standing_bond;
  }
  if (seen->also)
    seen->also->record(seen->also->context, event);
}

/* uncross_sim_advance, and bond[0 .. *count - 1] are those that met, named by their first vertices. */
int live_advance(uncross_sim *sim, uint32_t steps, uint32_t *bond, uint32_t room, uint32_t *count, uncross_error *error)
{
  struct seen seen = {observers_contacts(sim->observers), bond, room, 0};
  const struct contact_log log = {see, &seen};
  bool ok = true;
  for (uint32_t k = 0; ok && !sim->stopped && k < steps; k++) {
    sim->stopped = !step_advance(&sim->state, &sim->scene.model, &sim->work, &log);
    ok = sim->stopped || tables_sample(sim);
  }
  sim_look(sim);
  *count = seen.count;
  return sim->stopped ? uncross_sim_advance(sim, 1, error)
         : ok         ? UNCROSS_OK
                      : fail(error, UNCROSS_NO_MEMORY, "no memory for tables", NULL);
}
