#include "scene/set.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/read.h"
#include "scene/value.h"

enum { PART_SIZE = 80 };

/* A path on its way down the tree. */
struct way {
  struct tree *tree;
  const char *source;
  const char *rest; /* of the path, still to go */
  const char *value;
  bool once;
  char part[PART_SIZE]; /* that was taken last */
  struct message *message;
};

/* Always returns false. */
static bool refuse(const struct way *w, const char *what, const char *allowed)
{
  return message_set(w->message, "%s: '%s' %s; allowed: %s", w->source, w->part, what, allowed);
}

static bool no_memory(const struct way *w)
{
  return message_no_memory(w->message, "%s: out of memory", w->source);
}

static struct node *new_node(const struct way *w, enum node_type type)
{
  return tree_node(w->tree, type, w->source, 0, 0);
}

static bool take_part(struct way *w)
{
  const size_t length = strcspn(w->rest, ".");
  const bool fits = length < sizeof w->part;
  snprintf(w->part, sizeof w->part, "%.*s", (int)(fits ? length : sizeof w->part - 1), w->rest);
  w->rest += length + (w->rest[length] == '.');
  return (length > 0 && fits) || refuse(w, "is no key", "keys with dots between, as solvent.per_cell");
}

/* Puts a node under this key of a mapping, in place of the one that is there. */
static bool put(const struct way *w, struct node *mapping, struct node *node)
{
  for (size_t i = 0; i < mapping->count; i++) {
    const char *name = node_text(mapping->key[i]);
    if (name && strcmp(name, w->part) == 0) {
      if (w->once && mapping->item[i]->line == 0) /* of no file */
        return message_set(w->message, "%s: '%s' is set already, by '%s'; allowed: one of them", w->source, w->part,
                           mapping->item[i]->source);
      mapping->item[i] = node;
      return true;
    }
  }
  struct node *key = new_node(w, NODE_SCALAR);
  if (!key)
    return no_memory(w);
  key->plain = true;
  key->text = tree_text(w->tree, w->part, strlen(w->part));
  return (key->text && tree_append(w->tree, mapping, key, node)) || no_memory(w);
}

/* The node under this key of a mapping: the one that is there, if it is of this type, or a new one. */
static struct node *inner_node(const struct way *w, struct node *mapping, enum node_type type)
{
  struct node *node = node_value(mapping, w->part);
  if (node && node->type != type) {
    refuse(w, type == NODE_MAPPING ? "is no mapping in the file" : "is no list in the file", "one that is");
    return NULL;
  }
  if (!node) {
    node = new_node(w, type);
    if (!node)
      no_memory(w);
    else if (!put(w, mapping, node))
      return NULL;
  }
  return node;
}

static bool set_in_mapping(struct way *w, struct node *mapping, const struct key_table *table);

static bool set_in_list(struct way *w, struct node *list, const struct key_table *table)
{
  if (!take_part(w))
    return false;
  struct node *item = node_item_of(list, w->part);
  char next[24];
  snprintf(next, sizeof next, "%zu", list->count);
  if (!item && strcmp(w->part, next) == 0) {
    item = new_node(w, NODE_MAPPING);
    if (!tree_append(w->tree, list, NULL, item))
      return no_memory(w);
  }
  if (!item || item->type != NODE_MAPPING) {
    char allowed[64];
    snprintf(allowed, sizeof allowed, "a name, or 0 to %zu (which appends one)", list->count);
    return refuse(w, "is no item of the list", allowed);
  }
  if (!*w->rest)
    return refuse(w, "is not all of a path", "a key of the item behind it");
  return set_in_mapping(w, item, table);
}

static bool set_in_mapping(struct way *w, struct node *mapping, const struct key_table *table)
{
  if (!take_part(w))
    return false;
  const struct key *key = keys_find(table, w->part);
  if (!key) {
    struct node here = {.source = w->source};
    return keys_refuse(&here, w->part, table, w->message);
  }
  const bool nests = key->type == KEY_SECTION || key->type == KEY_LIST;
  if (nests && *w->rest) {
    struct node *inner = inner_node(w, mapping, key->type == KEY_LIST ? NODE_LIST : NODE_MAPPING);
    return inner && (key->type == KEY_LIST ? set_in_list(w, inner, key->keys) : set_in_mapping(w, inner, key->keys));
  }
  if (key->type == KEY_SECTION && strcmp(w->value, "{}") == 0) /* it is there, as in a file */
    return inner_node(w, mapping, NODE_MAPPING) != NULL;
  if (nests)
    return refuse(w, "has keys of its own", "a path to one of them");
  if (*w->rest)
    return refuse(w, "has no keys of its own", "a path that ends here");
  struct node *value = value_read(w->tree, w->source, w->value, w->message);
  return value && put(w, mapping, value);
}

bool tree_set(struct tree *tree, const struct key_table *table, const char *source, const char *path, const char *value,
              bool once, struct message *message)
{
  struct way way = {tree, tree_text(tree, source, strlen(source)), path, value, once, "", message};
  if (way.source && !tree->root)
    tree->root = new_node(&way, NODE_MAPPING);
  if (!way.source || !tree->root)
    return message_no_memory(message, "%s: out of memory", source);
  if (tree->root->type != NODE_MAPPING)
    return node_refuse(tree->root, message, "not a mapping; a scene is a YAML mapping, see docs/scene.md");
  return set_in_mapping(&way, tree->root, table);
}

bool tree_set_option(struct tree *tree, const struct key_table *table, const char *option, bool once,
                     struct message *message)
{
  const char *equals = strchr(option, '=');
  const size_t length = strlen(option) + sizeof "--set ";
  char *text = malloc(2 * length);
  if (!text)
    return message_no_memory(message, "--set %.200s: out of memory", option);
  char *source = text, *path = text + length;
  snprintf(source, length, "--set %s", option);
  snprintf(path, length, "%.*s", equals ? (int)(equals - option) : 0, option);
  const bool ok = equals ? tree_set(tree, table, source, path, equals + 1, once, message)
                         : message_set(message, "%s: no '='; allowed: --set path=value", source);
  free(text);
  return ok;
}
