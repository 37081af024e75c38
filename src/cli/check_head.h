/* The head of `uncross check`: how long the run is beside what it has to last, and what it will write. */
#ifndef UNCROSS_CLI_CHECK_HEAD_H
#define UNCROSS_CLI_CHECK_HEAD_H

#include "scene/scene.h"

/* Prints comment lines, so that what follows them is still a scene. */
void check_head(const struct scene *scene);

/* Prints the rows of memory. */
void check_memory(const struct scene *scene);

#endif
