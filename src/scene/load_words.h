/* What to say of vertices that load the fluid (theory/load.h): `check`, run.json and `map` use the same words. */
#ifndef UNCROSS_SCENE_LOAD_WORDS_H
#define UNCROSS_SCENE_LOAD_WORDS_H

#include <stdbool.h>
#include <stddef.h>

#include "system/model.h"

/* Writes one sentence with remedies. False, and nothing is written, if the load is below THEORY_HEAVY_LOAD. mass,
 * per_cell: how the remedies name the keys. */
bool load_words(const struct model *model, const char *mass, const char *per_cell, char *text, size_t size);

#endif
