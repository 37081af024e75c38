/* Names that other codes give to what a key of a scene means. */
#ifndef UNCROSS_SCENE_SYNONYMS_H
#define UNCROSS_SCENE_SYNONYMS_H

#include <stddef.h>

#include "system/keys.h"

/* What to say to whoever writes `name` in the section of this path ("": at the top): "did you mean 'time_step'?"; NULL
 * if nothing is known. */
const char *synonym_hint(const char *name, const char *path);

/* The same of a key that is in one or two sections below the top: "did you mean 'solvent.thermostat'?". hint stays as
 * it is if there is none, or if there are more. */
void synonym_places(const struct key_table *top, const char *name, char *hint, size_t size);

#endif
