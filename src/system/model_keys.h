/* The keys of a model. A new key is one row in model_keys.c. */
#ifndef UNCROSS_SYSTEM_MODEL_KEYS_H
#define UNCROSS_SYSTEM_MODEL_KEYS_H

#include "system/keys.h"
#include "system/model.h"

/* The top level, of a struct model. */
extern const struct key_table model_keys;

/* The word for a kind's start. */
const char *model_start_word(enum fiber_start start);

#endif
