/* The state in which a run of a scene begins. */
#ifndef UNCROSS_FILES_START_H
#define UNCROSS_FILES_START_H

#include "base/message.h"
#include "scene/scene.h"
#include "system/stream.h"
#include "work.h"

/* The state in which a run of the scene begins, drawn or its snapshot: a file whose bonds fit the box, and whose center
 * of mass moves with the scene's flow. The stream of the run becomes the key of the model's random numbers. state and
 * work are allocated for scene->model. */
bool scene_start(struct scene *scene, struct state *state, struct work *work, struct stream *stream,
                 struct message *message);

/* What a reader of a run's results should know of how it began: calls `tell` for each; returns the number of calls.
 * stream: the run's. */
int start_warnings(const struct scene *scene, const struct stream *stream,
                   void (*tell)(void *context, const char *text), void *context);

/* Lays the fibers of a drawn start where they exclude each other or a bead, and forgets them. True if each has room, as
 * in a run; else a message as that of scene_start. It takes the time of a run's start, but no memory for solvent. */
bool scene_has_room(const struct scene *scene, struct message *message);

#endif
