/*
 * Strict reading of YAML into a tree, from libyaml's events. Features that make YAML surprising are refused: anchors,
 * aliases, tags, directives, several documents.
 */
#ifndef UNCROSS_SCENE_YAML_H
#define UNCROSS_SCENE_YAML_H

#include <stddef.h>

#include "base/message.h"
#include "scene/tree.h"

#define YAML_MOST_BYTES ((size_t)1 << 26) /* a scene is written by a person or a small script */

/* The whole text of a file of at most 64 MiB, to be freed; NULL, with a message, on failure: with a size of more than
 * that if the file is larger. */
char *yaml_read_file(const char *path, size_t *size, struct message *message);

/* Reads `size` bytes of text into a tree, whose root is NULL if the text holds nothing. `path` is the source of all
 * nodes, copied. On failure leaves a message `path:line:col: ...`, and nothing to free. */
bool yaml_read(struct tree *tree, const char *path, const char *text, size_t size, struct message *message);

#endif
