#include "scene/differ.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/yaml.h"

/* The effective scene as a tree, which stays empty if memory is short. */
static void tree_of(const struct scene *scene, bool physics_only, struct tree *tree)
{
  char *text = NULL;
  size_t size = 0;
  struct message ignored;
  FILE *stream = open_memstream(&text, &size);
  *tree = (struct tree){0};
  bool ok = stream && scene_write(scene, stream, physics_only);
  if (stream)
    ok = fclose(stream) == 0 && ok;
  if (ok && !yaml_read(tree, "scene", text, size, &ignored))
    *tree = (struct tree){0};
  free(text);
}

static bool is_value(const struct node *node)
{
  return node->type == NODE_SCALAR ||
         (node->type == NODE_LIST && node->count > 0 && node->item[0]->type == NODE_SCALAR);
}

/* A value as a scene writes it; what is a section is only said to be there. */
static void tell(const struct node *node, char *text, size_t size)
{
  snprintf(text, size, "%s",
           !node                     ? "none"
           : node_text(node)         ? node_text(node)
           : node->type == NODE_LIST ? "["
                                     : "given");
  for (size_t k = 0; node && is_value(node) && k < node->count && strlen(text) < size; k++)
    snprintf(text + strlen(text), size - strlen(text), "%s%s", node_text(node->item[k]),
             k + 1 < node->count ? ", " : "]");
}

static bool compare(const struct node *a, const struct node *b, struct scene_difference *d);

/* A part of both, of this name. */
static bool compare_part(const struct node *a, const struct node *b, const char *name, struct scene_difference *d)
{
  const size_t used = strlen(d->key);
  snprintf(d->key + used, sizeof d->key - used, "%s%s", used ? "." : "", name);
  if (compare(a, b, d))
    return true;
  d->key[used] = '\0';
  return false;
}

static bool compare_items(const struct node *a, const struct node *b, struct scene_difference *d)
{
  const size_t count = a->count > b->count ? a->count : b->count;
  bool differ = false;
  for (size_t k = 0; !differ && k < count; k++) {
    char number[24];
    snprintf(number, sizeof number, "%zu", k);
    differ = compare_part(node_item(a, k), node_item(b, k), number, d);
  }
  return differ;
}

static bool compare_keys(const struct node *a, const struct node *b, struct scene_difference *d)
{
  bool differ = false;
  for (size_t k = 0; !differ && k < a->count; k++)
    differ = compare_part(a->item[k], node_value(b, node_text(a->key[k])), node_text(a->key[k]), d);
  for (size_t k = 0; !differ && k < b->count; k++)
    if (!node_value(a, node_text(b->key[k])))
      differ = compare_part(NULL, b->item[k], node_text(b->key[k]), d);
  return differ;
}

static bool compare(const struct node *a, const struct node *b, struct scene_difference *d)
{
  if (a && b && a->type == NODE_MAPPING && b->type == NODE_MAPPING)
    return compare_keys(a, b, d);
  if (a && b && a->type == NODE_LIST && b->type == NODE_LIST && !is_value(a) && !is_value(b))
    return compare_items(a, b, d);
  tell(a, d->value, sizeof d->value);
  tell(b, d->other, sizeof d->other);
  return strcmp(d->value, d->other) != 0;
}

/* Physics leaves out what is a default: the whole scene has it. */
static void tell_default(const struct scene *scene, const char *key, char *text, size_t size)
{
  struct tree tree;
  tree_of(scene, false, &tree);
  const struct node *node = tree.root;
  while (node && *key) {
    char part[128];
    const size_t length = strcspn(key, ".");
    snprintf(part, sizeof part, "%.*s", (int)length, key);
    node = node->type == NODE_LIST ? node_item(node, strtoul(part, NULL, 10)) : node_value(node, part);
    key += length + (key[length] == '.');
  }
  tell(node, text, size);
  tree_free(&tree);
}

bool scene_differs(const struct scene *scene, const struct scene *other, struct scene_difference *d)
{
  struct tree a, b;
  *d = (struct scene_difference){.key = ""};
  tree_of(scene, true, &a);
  tree_of(other, true, &b);
  const bool differ = a.root && b.root && compare(a.root, b.root, d);
  if (differ && strcmp(d->value, "none") == 0)
    tell_default(scene, d->key, d->value, sizeof d->value);
  if (differ && strcmp(d->other, "none") == 0)
    tell_default(other, d->key, d->other, sizeof d->other);
  tree_free(&a);
  tree_free(&b);
  return differ;
}
