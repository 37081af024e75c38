#include "io/yaml.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool refuse_at(const char *path, yaml_mark_t mark, struct message *message, const char *what)
{
  return message_at(message, path, mark.line + 1, mark.column + 1, "%s", what);
}

/* --- parsing ----------------------------------------------------------------------------------------------------- */

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

static bool refuse_syntax(const yaml_parser_t *parser, const char *path, const char *text, struct message *message)
{
  bool unreadable = parser->error == YAML_READER_ERROR;
  yaml_mark_t mark = unreadable ? mark_of_offset(text, parser->problem_offset) : parser->problem_mark;
  const char *problem = parser->problem ? parser->problem : "out of memory";
  char context[128] = "";
  if (parser->context && !unreadable)
    snprintf(context, sizeof context, "%s (begun in line %zu), ", parser->context, parser->context_mark.line + 1);
  return message_at(message, path, mark.line + 1, mark.column + 1, "not YAML: %s%s; a scene is a YAML mapping in UTF-8",
                    context, problem);
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

/* A first pass over the events, since the document API forgets anchors and resolves aliases. */
static bool check_plain(const char *path, const char *text, size_t size, struct message *message)
{
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser))
    return message_set(message, "%s: out of memory", path);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
  bool ok = true, end = false;
  for (int documents = 0; ok && !end;) {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser, &event)) {
      ok = refuse_syntax(&parser, path, text, message);
      break;
    }
    documents += event.type == YAML_DOCUMENT_START_EVENT;
    const char *what = forbidden_feature(&event, documents);
    if (what)
      ok = refuse_at(path, event.start_mark, message, what);
    end = event.type == YAML_STREAM_END_EVENT;
    yaml_event_delete(&event);
  }
  yaml_parser_delete(&parser);
  return ok;
}

char *yaml_read_file(const char *path, size_t *size, struct message *message)
{
  FILE *file = fopen(path, "rb");
  char *text = NULL;
  size_t room = 1 << 14;
  *size = 0;
  bool ok = file && (text = malloc(room)) != NULL;
  while (ok && !feof(file)) {
    *size += fread(text + *size, 1, room - *size, file);
    if (ferror(file) || *size > YAML_MOST_BYTES) {
      ok = false;
    } else if (*size == room) {
      char *more = realloc(text, room *= 2);
      ok = more != NULL;
      text = more ? more : text;
    }
  }
  if (!ok) {
    message_set(message, "%s: cannot be read: %s; a scene is a YAML file of at most 64 MiB", path,
                *size > YAML_MOST_BYTES ? "too large" : strerror(errno));
    free(text);
    text = NULL;
  }
  if (file)
    fclose(file);
  return text;
}

bool yaml_file_open(struct yaml_file *file, const char *path, const char *text, size_t size, struct message *message)
{
  const char *zero = memchr(text, 0, size);
  if (zero)
    return refuse_at(path, mark_of_offset(text, (size_t)(zero - text)), message,
                     "a NUL byte; a scene is a YAML mapping in UTF-8");
  if (!check_plain(path, text, size, message))
    return false;
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser))
    return message_set(message, "%s: out of memory", path);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
  file->path = path;
  bool ok = yaml_parser_load(&parser, &file->document) || refuse_syntax(&parser, path, text, message);
  yaml_parser_delete(&parser);
  return ok;
}

void yaml_file_close(struct yaml_file *file)
{
  yaml_document_delete(&file->document);
}

/* --- nodes ------------------------------------------------------------------------------------------------------- */

/* libyaml's getters take a document that they do not change, but not as const. */
static const yaml_node_t *node_number(const struct yaml_file *file, int index)
{
  return yaml_document_get_node((yaml_document_t *)&file->document, index);
}

const yaml_node_t *yaml_file_root(const struct yaml_file *file)
{
  return yaml_document_get_root_node((yaml_document_t *)&file->document);
}

size_t yaml_items(const yaml_node_t *sequence)
{
  if (!sequence || sequence->type != YAML_SEQUENCE_NODE)
    return 0;
  return (size_t)(sequence->data.sequence.items.top - sequence->data.sequence.items.start);
}

const yaml_node_t *yaml_item(const struct yaml_file *file, const yaml_node_t *sequence, size_t i)
{
  return node_number(file, sequence->data.sequence.items.start[i]);
}

size_t yaml_pairs(const yaml_node_t *mapping)
{
  if (!mapping || mapping->type != YAML_MAPPING_NODE)
    return 0;
  return (size_t)(mapping->data.mapping.pairs.top - mapping->data.mapping.pairs.start);
}

const yaml_node_t *yaml_pair(const struct yaml_file *file, const yaml_node_t *mapping, size_t i,
                             const yaml_node_t **value)
{
  const yaml_node_pair_t *pair = &mapping->data.mapping.pairs.start[i];
  *value = node_number(file, pair->value);
  return node_number(file, pair->key);
}

const yaml_node_t *yaml_value_of(const struct yaml_file *file, const yaml_node_t *mapping, const char *key)
{
  for (size_t i = 0; i < yaml_pairs(mapping); i++) {
    const yaml_node_t *value;
    const char *name = yaml_text(yaml_pair(file, mapping, i, &value));
    if (name && strcmp(name, key) == 0)
      return value;
  }
  return NULL;
}

bool yaml_refuse(const struct yaml_file *file, const yaml_node_t *node, struct message *message, const char *format,
                 ...)
{
  char what[sizeof message->text];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(what, sizeof what, format, arguments);
  va_end(arguments);
  return refuse_at(file->path, node->start_mark, message, what);
}

/* --- scalars ----------------------------------------------------------------------------------------------------- */

const char *yaml_text(const yaml_node_t *node)
{
  if (!node || node->type != YAML_SCALAR_NODE)
    return NULL;
  const char *text = (const char *)node->data.scalar.value;
  return strlen(text) == node->data.scalar.length ? text : NULL; /* "\\0" may stand in quotes */
}

/* The text of an unquoted scalar; NULL if the node is none. */
static const char *plain_text(const yaml_node_t *node)
{
  const char *text = yaml_text(node);
  return text && node->data.scalar.style == YAML_PLAIN_SCALAR_STYLE ? text : NULL;
}

bool yaml_whole(const yaml_node_t *node, uint64_t *value)
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

bool yaml_number(const yaml_node_t *node, double *value)
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

bool yaml_switch(const yaml_node_t *node, bool *value)
{
  const char *text = plain_text(node);
  if (!text || (strcmp(text, "true") != 0 && strcmp(text, "false") != 0))
    return false;
  *value = text[0] == 't';
  return true;
}
