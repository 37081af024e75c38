/* Reading of values from a command line or from a row of keys, without the YAML library. */
#ifndef UNCROSS_SCENE_VALUE_H
#define UNCROSS_SCENE_VALUE_H

#include "scene/tree.h"

/* Reads a scalar (5, kick-split, "a b"), or a list of values in brackets ([0, 0, 1]), into a node of this source. NULL
 * with a message otherwise, or if memory is short. */
struct node *value_read(struct tree *tree, const char *source, const char *text, struct message *message);

#endif
