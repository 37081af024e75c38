#include "cli/check_start.h"

#include <inttypes.h>
#include <stdio.h>

#include "cli/sheet.h"
#include "files/start.h"
#include "start/fibers.h"

/* scene: read as a whole, with its lists of vertices. */
static bool start_whole(struct scene *scene, struct stream *stream, struct message *message)
{
  if (!scene->snapshot)
    return scene_has_room(scene, message);
  struct state state = {0};
  struct work work = {0};
  message_set(message, "%s: no memory for the start", scene->path);
  const bool ok = state_alloc(&state, &scene->model) && work_alloc(&work, &scene->model) &&
                  scene_start(scene, &state, &work, stream, message);
  work_free(&work);
  state_free(&state);
  return ok;
}

bool check_start(const char *path, const struct scene_settings *settings, const struct scene *scene,
                 struct stream *stream, struct message *message)
{
  struct scene whole;
  *stream = stream_of_seed(scene->seed);
  if (!scene->snapshot && !start_is_crowded(&scene->model))
    return true;
  if (!scene_read_set(path, settings, &whole, message))
    return false;
  const bool ok = start_whole(&whole, stream, message);
  scene_free(&whole);
  return ok;
}

void check_stream(uint64_t seed, const struct stream *s)
{
  sheet_heading("Random numbers");
  printf("  stream %" PRIu64 ", ", s->key);
  if (s->from == STREAM_SNAPSHOT)
    printf("of seed %" PRIu64 " and of the snapshot's stream %" PRIu64 " at step %" PRIu64 "\n", seed, s->parent,
           s->parent_step);
  else if (s->from == STREAM_FOREIGN)
    printf("of seed %" PRIu64 " and of the snapshot's positions and velocities\n", seed);
  else
    printf("which is the seed\n");
}
