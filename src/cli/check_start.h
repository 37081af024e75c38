/* The start of a run in `uncross check`: whether it can be made, and which random numbers are drawn. */
#ifndef UNCROSS_CLI_CHECK_START_H
#define UNCROSS_CLI_CHECK_START_H

#include "base/message.h"
#include "scene/scene.h"
#include "system/stream.h"

/* Finds the stream of a run. A snapshot is read for this, as a run would read it: the memory that it takes is that of a
 * run. Fibers that exclude each other, or a bead, are laid: this takes the time of a run's start. False, with a
 * message, if no run starts so. */
bool check_start(const char *path, const struct scene_settings *settings, const struct scene *scene,
                 struct stream *stream, struct message *message);

/* Prints the stream of a run of this seed. */
void check_stream(uint64_t seed, const struct stream *stream);

#endif
