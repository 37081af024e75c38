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
