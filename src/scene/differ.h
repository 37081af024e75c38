/* In which key two scenes differ: what a resumed run must keep. */
#ifndef UNCROSS_SCENE_DIFFER_H
#define UNCROSS_SCENE_DIFFER_H

#include "scene/scene.h"

struct scene_difference {
  char key[192];             /* "fibers.0.spring"; items count from 0 */
  char value[64], other[64]; /* as a scene writes them; "none" */
};

/* The first key of the physics (those of the fingerprint) that has another value in the other scene. False if there is
 * none, or memory is short. */
bool scene_differs(const struct scene *scene, const struct scene *other, struct scene_difference *difference);

#endif
