/*
 * A scene from a file, a thousand steps, and the end-to-end distance of its fibers.
 *
 *   cc end_to_end.c $(pkg-config --cflags --libs uncross) -lm -o end_to_end
 *   ./end_to_end scene.yaml 1000
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <uncross.h>

/* Root mean square over all open fibers, in a0. */
static double end_to_end(const uncross_view *view)
{
  double sum = 0.0;
  int open = 0;
  for (uint32_t f = 0; f < view->fibers; f++) {
    const uint32_t first = view->first[f], last = view->first[f + 1] - 1;
    if (view->next[last] >= 0)
      continue; /* a ring */
    for (int k = 0; k < 3; k++) {
      const int64_t d = view->position[3 * (size_t)last + k] - view->position[3 * (size_t)first + k];
      sum += pow((double)d * UNCROSS_LATTICE_UNIT, 2);
    }
    open++;
  }
  return open ? sqrt(sum / open) : 0.0;
}

int main(int count, char **words)
{
  uncross_error error;
  if (count != 3) {
    fprintf(stderr, "usage: end_to_end SCENE STEPS\n");
    return UNCROSS_BAD_INPUT;
  }
  uint64_t hash = 0;
  uncross_scene *scene = uncross_scene_read(words[1], NULL, 0, &error);
  uncross_sim *sim = scene ? uncross_sim_start(scene, &error) : NULL;
  if (!sim || uncross_sim_advance(sim, strtoull(words[2], NULL, 10), &error) != UNCROSS_OK ||
      uncross_sim_hash(sim, &hash, &error) != UNCROSS_OK) {
    fprintf(stderr, "%s\n", error.message);
    uncross_sim_free(sim);
    uncross_scene_free(scene);
    return error.code;
  }
  printf("step %" PRIu64 ", hash %016" PRIx64 ", end-to-end distance %.6f a0\n", uncross_sim_step(sim), hash,
         end_to_end(uncross_sim_view(sim)));
  uncross_sim_free(sim);
  uncross_scene_free(scene);
  return UNCROSS_OK;
}
