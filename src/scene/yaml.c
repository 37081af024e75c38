#include "scene/yaml.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#include "base/opening.h"

static bool refuse_at(const char *path, yaml_mark_t mark, struct message *message, const char *what)
{
  return message_at(message, path, mark.line + 1, mark.column + 1, "%s", what);
}

/* --- events ------------------------------------------------------------------------------------------------------ */

/* Where byte number `offset` of the text stands. */
static yaml_mark_t mark_of_offset(const char *text, size_t offset)
{
  yaml_mark_t mark = {offset, 0, 0};
  for (size_t i = 0; i < offset; i++) {
    mark.column = text[i] == '\n' ? 0 : mark.column + 1;
    mark.line += text[i] == '\n';
  }
  return mark;
}

/* Whether this line begins with a tab, after spaces and the dashes of lists. */
static bool tab_indents(const char *text, size_t size, size_t line)
{
  size_t at = 0;
  while (at < size && line > 0)
    line -= text[at++] == '\n';
  while (at < size && (text[at] == ' ' || text[at] == '-'))
    at++;
  return at < size && text[at] == '\t';
}

static bool refuse_syntax(const yaml_parser_t *parser, const char *path, const char *text, size_t size,
                          struct message *message)
{
  bool unreadable = parser->error == YAML_READER_ERROR;
  yaml_mark_t mark = unreadable ? mark_of_offset(text, parser->problem_offset) : parser->problem_mark;
  const char *problem = parser->problem ? parser->problem : "out of memory";
  char context[128] = "";
  if (parser->context && !unreadable)
    snprintf(context, sizeof context, "%s (begun in line %zu), ", parser->context, parser->context_mark.line + 1);
  return message_at(message, path, mark.line + 1, mark.column + 1, "not YAML: %s%s; %s", context, problem,
                    tab_indents(text, size, mark.line) ? "a tab indents this line: YAML indents by spaces"
                                                       : "a scene is a YAML mapping in UTF-8");
}

/* What a scene may not use of YAML in this event; NULL if all is well. */
static const char *forbidden_feature(const yaml_event_t *event, int documents)
{
  static const char anchor[] = "anchors (&) are not read; write the value where it is needed";
  static const char tag[] = "tags (!) are not read; write the plain value";
  switch (event->type) {
  case YAML_DOCUMENT_START_EVENT:
    if (documents > 1)
      return "a second document begins here; a scene is one document";
    if (event->data.document_start.version_directive ||
        event->data.document_start.tag_directives.start != event->data.document_start.tag_directives.end)
      return "directives (%) are not read; leave them out";
    return NULL;
  case YAML_ALIAS_EVENT:
    return "aliases (*) are not read; write the value here";
  case YAML_SCALAR_EVENT:
    return event->data.scalar.anchor ? anchor : event->data.scalar.tag ? tag : NULL;
  case YAML_SEQUENCE_START_EVENT:
    return event->data.sequence_start.anchor ? anchor : event->data.sequence_start.tag ? tag : NULL;
  case YAML_MAPPING_START_EVENT:
    return event->data.mapping_start.anchor ? anchor : event->data.mapping_start.tag ? tag : NULL;
  default:
    return NULL;
  }
}

/* --- a tree from events ------------------------------------------------------------------------------------------ */

/* A list or mapping that is not closed yet. */
struct open_node {
  struct node *node;
  struct node *key; /* of a mapping: read, and its value is not */
  struct open_node *outer;
};

/* A scene nests 5 deep. libyaml's time grows with the square of the depth. */
enum { MOST_NESTED = 32 };

struct builder {
  struct tree *tree;
  const char *path;
  struct open_node *open; /* innermost */
  int depth;
};

/* Puts a finished or a new node where it belongs. */
static bool place_node(struct builder *b, struct node *node)
{
  struct open_node *in = b->open;
  if (!in)
    b->tree->root = node;
  else if (in->node->type == NODE_LIST)
    return tree_append(b->tree, in->node, NULL, node);
  else if (!in->key)
    in->key = node;
  else {
    struct node *key = in->key;
    in->key = NULL;
    return tree_append(b->tree, in->node, key, node);
  }
  return true;
}

static bool add_scalar(struct builder *b, const yaml_event_t *event)
{
  const char *text = (const char *)event->data.scalar.value;
  const size_t length = event->data.scalar.length;
  struct node *node =
      tree_node(b->tree, NODE_SCALAR, b->path, event->start_mark.line + 1, event->start_mark.column + 1);
  if (!node)
    return false;
  node->plain = event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
  if (!memchr(text, 0, length)) /* "\\0" may stand in quotes */
    node->text = tree_text(b->tree, text, length);
  return (node->text || memchr(text, 0, length)) && place_node(b, node);
}

static bool open_nest(struct builder *b, const yaml_event_t *event, enum node_type type)
{
  struct node *node = tree_node(b->tree, type, b->path, event->start_mark.line + 1, event->start_mark.column + 1);
  struct open_node *open = tree_alloc(b->tree, sizeof *open);
  if (!node || !open || !place_node(b, node))
    return false;
  *open = (struct open_node){node, NULL, b->open};
  b->open = open;
  b->depth++;
  return true;
}

static bool opens_nest(const yaml_event_t *event)
{
  return event->type == YAML_SEQUENCE_START_EVENT || event->type == YAML_MAPPING_START_EVENT;
}

/* False if memory is short. */
static bool add_event(struct builder *b, const yaml_event_t *event)
{
  switch (event->type) {
  case YAML_SCALAR_EVENT:
    return add_scalar(b, event);
  case YAML_SEQUENCE_START_EVENT:
    return open_nest(b, event, NODE_LIST);
  case YAML_MAPPING_START_EVENT:
    return open_nest(b, event, NODE_MAPPING);
  case YAML_SEQUENCE_END_EVENT:
  case YAML_MAPPING_END_EVENT:
    if (b->open)
      b->open = b->open->outer;
    b->depth--;
    return true;
  default:
    return true;
  }
}

static bool read_events(struct builder *b, yaml_parser_t *parser, const char *text, size_t size,
                        struct message *message)
{
  int documents = 0;
  for (bool end = false; !end;) {
    yaml_event_t event;
    if (!yaml_parser_parse(parser, &event))
      return refuse_syntax(parser, b->path, text, size, message);
    documents += event.type == YAML_DOCUMENT_START_EVENT;
    end = event.type == YAML_STREAM_END_EVENT;
    const char *what = forbidden_feature(&event, documents);
    if (!what && opens_nest(&event) && b->depth == MOST_NESTED)
      what = "nested too deeply; allowed: 32 lists and mappings in each other";
    bool ok = what ? refuse_at(b->path, event.start_mark, message, what)
                   : add_event(b, &event) || message_no_memory(message, "%s: out of memory", b->path);
    yaml_event_delete(&event);
    if (!ok)
      return false;
  }
  return true;
}

bool yaml_read(struct tree *tree, const char *path, const char *text, size_t size, struct message *message)
{
  *tree = (struct tree){NULL, NULL};
  const char *zero = memchr(text, 0, size);
  if (zero)
    return refuse_at(path, mark_of_offset(text, (size_t)(zero - text)), message,
                     "a NUL byte; a scene is a YAML mapping in UTF-8");
  struct builder builder = {tree, tree_text(tree, path, strlen(path)), NULL, 0};
  yaml_parser_t parser;
  if (!builder.path || !yaml_parser_initialize(&parser)) {
    tree_free(tree);
    return message_no_memory(message, "%s: out of memory", path);
  }
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
  const bool ok = read_events(&builder, &parser, text, size, message);
  yaml_parser_delete(&parser);
  if (!ok)
    tree_free(tree);
  return ok;
}

/* --- files ------------------------------------------------------------------------------------------------------- */

char *yaml_read_file(const char *path, size_t *size, struct message *message)
{
  uint64_t bytes = 0;
  *size = 0;
  FILE *file = open_input(path, &bytes, message);
  if (!file)
    return NULL;
  const bool large = bytes > YAML_MOST_BYTES;
  char *text = large ? NULL : malloc((size_t)bytes + 1);
  if (text)
    *size = fread(text, 1, (size_t)bytes, file); /* what is written meanwhile is not looked for */
  if (!text || ferror(file)) {
    message_set(message, "%s: cannot be read: %s; a scene is a YAML file of at most 64 MiB", path,
                large ? "too large" : strerror(errno));
    *size = large ? YAML_MOST_BYTES + 1 : 0;
    free(text);
    text = NULL;
  }
  fclose(file);
  return text;
}
