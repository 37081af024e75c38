/* Writing of a filled struct as YAML that its table reads back. */
#ifndef UNCROSS_SCENE_WRITE_H
#define UNCROSS_SCENE_WRITE_H

#include <stdbool.h>
#include <stdio.h>

#include "system/keys.h"

/* Writes all keys, every default filled in. physics_only leaves out keys that are `aside`, and keys at their `absent`
 * value except those of the first format; the hash of this text is a fingerprint. False if memory is short. */
bool keys_write(const struct key_table *table, const void *from, FILE *f, bool physics_only);

/* One value, without its key. */
void key_write_value(FILE *f, const struct key *key, const void *at);

#endif
