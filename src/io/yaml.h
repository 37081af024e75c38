/*
 * A strict reading of YAML, over libyaml's document API: every node knows its line and column, every conversion
 * consumes the whole scalar, and what makes YAML surprising is refused: anchors, aliases, tags, directives, several
 * documents.
 *
 * Lines and columns count from 1. A conversion that fails says nothing; the caller knows what is allowed.
 */
#ifndef UNCROSS_YAML_H
#define UNCROSS_YAML_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <yaml.h>

#include "io/message.h"

/* A file as a tree of nodes. */
struct yaml_file {
  const char *path; /* for messages; not owned */
  yaml_document_t document;
};

#define YAML_MOST_BYTES ((size_t)1 << 26) /* a scene is written by a person or a small script */

/* The whole text of a file of at most 64 MiB, to be freed; NULL, with a message, on failure: with a size of more than
 * that if the file is larger. */
char *yaml_read_file(const char *path, size_t *size, struct message *message);

/* Parses `size` bytes of text. On failure leaves a message `path:line:col: ...`, and nothing to close. */
bool yaml_file_open(struct yaml_file *file, const char *path, const char *text, size_t size, struct message *message);
void yaml_file_close(struct yaml_file *file);

/* The outermost node; NULL if the file holds nothing. */
const yaml_node_t *yaml_file_root(const struct yaml_file *file);

/* The value of this key of a mapping; NULL if there is none, or `mapping` is NULL or no mapping. */
const yaml_node_t *yaml_value_of(const struct yaml_file *file, const yaml_node_t *mapping, const char *key);

/* Number of items of a sequence (0 if it is none), and item number i of it. */
size_t yaml_items(const yaml_node_t *sequence);
const yaml_node_t *yaml_item(const struct yaml_file *file, const yaml_node_t *sequence, size_t i);

/* Number of pairs of a mapping (0 if it is none), and pair number i of it. */
size_t yaml_pairs(const yaml_node_t *mapping);
const yaml_node_t *yaml_pair(const struct yaml_file *file, const yaml_node_t *mapping, size_t i,
                             const yaml_node_t **value);

/* The text of a scalar; NULL if the node is none. */
const char *yaml_text(const yaml_node_t *node);

/* A whole number: decimal digits only, no leading zero, not quoted, within 64 bits. */
bool yaml_whole(const yaml_node_t *node, uint64_t *value);

/* A finite decimal number, not quoted: 5, -0.5, 1e-3. A number that underflows to 0 is refused. */
bool yaml_number(const yaml_node_t *node, double *value);

/* true or false, not quoted. */
bool yaml_switch(const yaml_node_t *node, bool *value);

/* Leaves the message `path:line:col: ...` about this node. Always returns false, for `return yaml_refuse(...)`. */
bool yaml_refuse(const struct yaml_file *file, const yaml_node_t *node, struct message *message, const char *format,
                 ...) __attribute__((format(printf, 4, 5)));

#endif
