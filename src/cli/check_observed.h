/* What `uncross check` says of observables that mean something particular in a scene, or lack columns. */
#ifndef UNCROSS_CLI_CHECK_OBSERVED_H
#define UNCROSS_CLI_CHECK_OBSERVED_H

#include "scene/scene.h"

/* Prints the rows of observe/meaning.h that hold in this scene, of observables that it asks for; nothing without any.
 */
void check_observed(const struct scene *scene);

#endif
