#include "scene/tree.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- memory ------------------------------------------------------------------------------------------------------ */

enum { BLOCK_BYTES = 1 << 14 };

struct tree_block {
  struct tree_block *next;
  size_t used, size;
  _Alignas(max_align_t) char bytes[];
};

void tree_free(struct tree *tree)
{
  while (tree->blocks) {
    struct tree_block *next = tree->blocks->next;
    free(tree->blocks);
    tree->blocks = next;
  }
  tree->root = NULL;
}

void *tree_alloc(struct tree *tree, size_t size)
{
  const size_t step = _Alignof(max_align_t), whole = (size + step - 1) / step * step;
  struct tree_block *block = tree->blocks;
  if (!block || block->size - block->used < whole) {
    const size_t room = whole > BLOCK_BYTES ? whole : BLOCK_BYTES;
    block = calloc(1, sizeof *block + room);
    if (!block)
      return NULL;
    block->size = room;
    block->next = tree->blocks;
    tree->blocks = block;
  }
  void *at = block->bytes + block->used;
  block->used += whole;
  return at;
}

char *tree_text(struct tree *tree, const char *text, size_t length)
{
  char *copy = tree_alloc(tree, length + 1);
  if (copy)
    memcpy(copy, text, length);
  return copy;
}

struct node *tree_node(struct tree *tree, enum node_type type, const char *source, size_t line, size_t column)
{
  struct node *node = tree_alloc(tree, sizeof *node);
  if (node)
    *node = (struct node){.type = type, .source = source, .line = line, .column = column};
  return node;
}

/* Doubles the room of a row of nodes; the old row is left to the tree. */
static bool grow(struct tree *tree, struct node ***row, size_t count, size_t room)
{
  struct node **more = tree_alloc(tree, room * sizeof(struct node *));
  if (!more)
    return false;
  if (count > 0)
    memcpy(more, *row, count * sizeof(struct node *));
  *row = more;
  return true;
}

bool tree_append(struct tree *tree, struct node *to, struct node *key, struct node *value)
{
  if (!value)
    return false;
  if (to->count == to->room) {
    const size_t room = to->room ? 2 * to->room : 4;
    if (!grow(tree, &to->item, to->count, room) || (key && !grow(tree, &to->key, to->count, room)))
      return false;
    to->room = room;
  }
  if (key)
    to->key[to->count] = key;
  to->item[to->count++] = value;
  return true;
}

/* --- nodes ------------------------------------------------------------------------------------------------------- */

struct node *node_value(const struct node *mapping, const char *key)
{
  for (size_t i = 0; mapping && mapping->type == NODE_MAPPING && i < mapping->count; i++) {
    const char *name = node_text(mapping->key[i]);
    if (name && strcmp(name, key) == 0)
      return mapping->item[i];
  }
  return NULL;
}

struct node *node_item(const struct node *list, size_t i)
{
  return list && list->type == NODE_LIST && i < list->count ? list->item[i] : NULL;
}

struct node *node_item_of(const struct node *list, const char *part)
{
  const bool digits = *part && part[strspn(part, "0123456789")] == '\0';
  struct node *item = digits ? node_item(list, strtoull(part, NULL, 10)) : NULL;
  for (size_t i = 0; !item && list && list->type == NODE_LIST && i < list->count; i++) {
    const char *name = node_text(node_value(list->item[i], "name"));
    if (name && strcmp(name, part) == 0)
      item = list->item[i];
  }
  return item;
}

const struct node *node_near(const struct node *root, const char *path)
{
  const struct node *node = root;
  while (*path) {
    char part[80];
    const size_t length = strcspn(path, ".");
    snprintf(part, sizeof part, "%.*s", (int)length, path);
    const struct node *next = node->type == NODE_LIST ? node_item_of(node, part) : node_value(node, part);
    if (!next)
      break;
    node = next;
    path += length + (path[length] == '.');
  }
  return node;
}

bool node_refuse(const struct node *node, struct message *message, const char *format, ...)
{
  char what[sizeof message->text];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(what, sizeof what, format, arguments);
  va_end(arguments);
  return node->line > 0 ? message_at(message, node->source, node->line, node->column, "%s", what)
                        : message_set(message, "%s: %s", node->source, what);
}

/* --- scalars ----------------------------------------------------------------------------------------------------- */

const char *node_text(const struct node *node)
{
  return node && node->type == NODE_SCALAR ? node->text : NULL;
}

/* The text of an unquoted scalar; NULL if the node is none. */
static const char *plain_text(const struct node *node)
{
  return node && node->plain ? node_text(node) : NULL;
}

bool node_whole(const struct node *node, uint64_t *value)
{
  const char *text = plain_text(node);
  size_t digits = text ? strspn(text, "0123456789") : 0;
  if (digits == 0 || text[digits] != '\0' || (digits > 1 && text[0] == '0'))
    return false;
  errno = 0;
  unsigned long long n = strtoull(text, NULL, 10);
  if (errno != 0 || n > UINT64_MAX)
    return false;
  *value = n;
  return true;
}

bool node_number(const struct node *node, double *value)
{
  const char *text = plain_text(node);
  if (!text)
    return false;
  const char *digits = text + (*text == '-' || *text == '+');
  if (strspn(digits, "0123456789.") == 0 || digits[strspn(digits, "0123456789.+-eE")] != '\0')
    return false;
  char *end;
  double x = strtod(text, &end);
  bool lost = x == 0.0 && strcspn(digits, "123456789") < strcspn(digits, "eE");
  if (*end != '\0' || !isfinite(x) || lost)
    return false;
  *value = x == 0.0 ? 0.0 : x; /* no negative zero: it would be another scene's fingerprint */
  return true;
}

bool node_switch(const struct node *node, bool *value)
{
  const char *text = plain_text(node);
  if (!text || (strcmp(text, "true") != 0 && strcmp(text, "false") != 0))
    return false;
  *value = text[0] == 't';
  return true;
}
