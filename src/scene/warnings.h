/* Warnings of a scene (scene_warnings, scene.h): who hears them, and those that are of one kind of fibers. */
#ifndef UNCROSS_SCENE_WARNINGS_H
#define UNCROSS_SCENE_WARNINGS_H

#include "scene/scene.h"
#include "theory/flow.h"

/* tell may be NULL: then warnings are counted only. */
struct teller {
  void (*tell)(void *context, const char *text);
  void *context;
  int told;
};

/* Tells a warning of at most 511 characters. */
void warn(struct teller *teller, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A time step of few digits, t0, at most this one if so many are allowed: the collision interval over 2^a 5^b. */
double warnings_time_step(const struct model *model, double most);

/* Warns of what one kind of fibers is, and of what the flow does to it. */
void warn_fibers(struct teller *teller, const struct scene *scene, const struct theory_shear *shear,
                 const struct fiber_kind *kind);

#endif
