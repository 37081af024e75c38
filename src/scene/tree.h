/*
 * The content of a scene as a tree of texts, lists and mappings. Each node knows its place in the file. A YAML file
 * fills the tree (scene/yaml.h), settings of single keys fill or change it (scene/set.h), and the reader of keys
 * (scene/read.h) uses nothing else.
 *
 * All nodes and texts of a tree are freed with it.
 */
#ifndef UNCROSS_SCENE_TREE_H
#define UNCROSS_SCENE_TREE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/message.h"

enum node_type { NODE_SCALAR, NODE_LIST, NODE_MAPPING };

struct node {
  enum node_type type;
  bool plain;          /* scalar: not quoted */
  const char *source;  /* a file, or "--set path=value" */
  size_t line, column; /* in the file, from 1; line 0: the source has no lines */
  const char *text;    /* scalar; NULL if it holds a NUL byte */
  struct node **item;  /* [count] of a list; of a mapping: the values */
  struct node **key;   /* [count] of a mapping, else NULL */
  size_t count, room;
};

struct tree_block;

struct tree {
  struct node *root; /* NULL: nothing was said */
  struct tree_block *blocks;
};

void tree_free(struct tree *tree);

/* Memory that lives as long as the tree, zeroed; NULL if it is short. */
void *tree_alloc(struct tree *tree, size_t size);

/* A copy of `length` bytes, with a NUL behind them. */
char *tree_text(struct tree *tree, const char *text, size_t length);

/* A node without content. NULL if memory is short, as below. */
struct node *tree_node(struct tree *tree, enum node_type type, const char *source, size_t line, size_t column);

/* Appends a value to a list (key NULL), or a key and its value to a mapping. */
bool tree_append(struct tree *tree, struct node *to, struct node *key, struct node *value);

/* The value of this key of a mapping; NULL if there is none, or `mapping` is NULL or no mapping. */
struct node *node_value(const struct node *mapping, const char *key);

/* Item number i of a list; NULL if there is none. */
struct node *node_item(const struct node *list, size_t i);

/* The item that a part of a path means: by its number, from 0, or else by its `name`; NULL if there is none. */
struct node *node_item_of(const struct node *list, const char *part);

/* The node at "fibers.1.mass" or "fibers.rods.mass", or the last one on the way to it that is there. */
const struct node *node_near(const struct node *root, const char *path);

/* The text of a scalar; NULL if the node is none. */
const char *node_text(const struct node *node);

/* A whole number: decimal digits only, no leading zero, not quoted, within 64 bits. */
bool node_whole(const struct node *node, uint64_t *value);

/* A finite decimal number, not quoted: 5, -0.5, 1e-3. A number that underflows to 0 is refused. */
bool node_number(const struct node *node, double *value);

/* true or false, not quoted. */
bool node_switch(const struct node *node, bool *value);

/* Leaves the message "source:line:col: ..." about this node, or "source: ..." where there are no lines. Always returns
 * false, for `return node_refuse(...)`. */
bool node_refuse(const struct node *node, struct message *message, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
