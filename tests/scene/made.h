/* Scenes without a file. */
#ifndef UNCROSS_TESTS_SCENE_MADE_H
#define UNCROSS_TESTS_SCENE_MADE_H

#include "scene/scene_keys.h"

/* A scene made of settings alone: each of them "path=value", in order. Missing keys take their defaults. */
static inline bool scene_make(const struct scene_settings *settings, struct scene *scene, struct message *message)
{
  const struct scene_source source = {
      .keys = &scene_keys, .path = "settings", .settings = settings, .look_for_files = true, .message = message};
  return scene_read_source(&source, scene);
}

#endif
