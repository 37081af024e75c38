#include "scene/value.h"

#include <stdio.h>
#include <string.h>

enum { MOST_NESTING = 16 };

/* A text that is read from the left. */
struct reading {
  struct tree *tree;
  const char *source;
  const char *at;
  int depth; /* lists that are open */
  struct message *message;
};

static const char blanks[] = " \t\r\n";

static void skip_blanks(struct reading *r)
{
  r->at += strspn(r->at, blanks);
}

/* Always returns NULL. */
static struct node *refuse(const struct reading *r, const char *what)
{
  message_set(r->message, "%s: %s; allowed: a word or number, or a list [a, b, c]", r->source, what);
  return NULL;
}

static struct node *no_memory(const struct reading *r)
{
  message_no_memory(r->message, "%s: out of memory", r->source);
  return NULL;
}

static struct node *scalar(struct reading *r, const char *text, size_t length, bool plain)
{
  struct node *node = tree_node(r->tree, NODE_SCALAR, r->source, 0, 0);
  if (!node)
    return no_memory(r);
  node->plain = plain;
  node->text = tree_text(r->tree, text, length);
  return node->text ? node : no_memory(r);
}

/* Up to the next quote of the same kind: a value needs no escapes. */
static struct node *quoted(struct reading *r)
{
  const char quote = *r->at, *text = r->at + 1, *end = strchr(text, quote);
  if (!end || memchr(text, '\\', (size_t)(end - text)))
    return refuse(r, end ? "a backslash in quotes" : "a quote that is not closed");
  r->at = end + 1;
  return scalar(r, text, (size_t)(end - text), false);
}

/* Outside of lists all of the text, within one up to the next comma or bracket. */
static struct node *plain(struct reading *r)
{
  size_t length = r->depth > 0 ? strcspn(r->at, ",[]") : strlen(r->at);
  const char *text = r->at;
  r->at += length;
  while (length > 0 && strchr(blanks, text[length - 1]))
    length--;
  if (text[0] == '{')
    return refuse(r, "a mapping; its keys are set one by one");
  return scalar(r, text, length, true);
}

static struct node *value(struct reading *r);

static struct node *list(struct reading *r)
{
  struct node *node = tree_node(r->tree, NODE_LIST, r->source, 0, 0);
  if (!node)
    return no_memory(r);
  if (++r->depth > MOST_NESTING)
    return refuse(r, "lists too deep");
  r->at++;
  for (skip_blanks(r); *r->at != ']'; skip_blanks(r)) {
    struct node *item = value(r);
    if (!item)
      return NULL;
    if (!tree_append(r->tree, node, NULL, item))
      return no_memory(r);
    skip_blanks(r);
    if (*r->at != ',' && *r->at != ']')
      return refuse(r, "a list that is not closed");
    r->at += *r->at == ',';
  }
  r->at++;
  r->depth--;
  return node;
}

static struct node *value(struct reading *r)
{
  skip_blanks(r);
  return *r->at == '[' ? list(r) : *r->at == '"' || *r->at == '\'' ? quoted(r) : plain(r);
}

struct node *value_read(struct tree *tree, const char *source, const char *text, struct message *message)
{
  struct reading r = {tree, source, text, 0, message};
  struct node *node = value(&r);
  if (node) {
    skip_blanks(&r);
    if (*r.at)
      return refuse(&r, "something follows the value");
  }
  return node;
}
