/* The JSON schema of a scene, from the tables of keys. */
#include <inttypes.h>
#include <stdio.h>

#include "scene/scene_keys.h"

/* A text in JSON's double quotes. */
static void write_string(FILE *f, const char *text)
{
  fputc('"', f);
  for (const unsigned char *c = (const unsigned char *)text; *c; c++) {
    if (*c < 0x20)
      fprintf(f, "\\u%04x", *c);
    else
      fprintf(f, "%s%c", *c == '"' || *c == '\\' ? "\\" : "", *c);
  }
  fputc('"', f);
}

static void write_numbers(FILE *f, const struct key *key)
{
  fprintf(f, "\"type\": \"number\", \"%s\": %.15g, \"maximum\": %.15g", key->above ? "exclusiveMinimum" : "minimum",
          key->low, key->high);
}

static void write_wholes(FILE *f, const struct key *key)
{
  fprintf(f, "\"type\": \"integer\", \"minimum\": %" PRIu64 ", \"maximum\": %" PRIu64, key->least, key->most);
}

static void write_triple(FILE *f, const struct key *key, void (*write_item)(FILE *, const struct key *))
{
  fputs("\"type\": \"array\", \"minItems\": 3, \"maxItems\": 3, \"items\": {", f);
  write_item(f, key);
  fputc('}', f);
}

static void write_choice(FILE *f, const struct key *key)
{
  fputs("\"enum\": [", f);
  for (const char *const *word = key->choice; *word; word++) {
    fputs(word > key->choice ? ", " : "", f);
    write_string(f, *word);
  }
  fputc(']', f);
}

static void write_mapping(FILE *f, const struct key_table *table, int indent);

static void write_type(FILE *f, const struct key *key, int indent)
{
  switch (key->type) {
  case KEY_WHOLE64:
  case KEY_WHOLE32:
    write_wholes(f, key);
    return;
  case KEY_NUMBER:
    write_numbers(f, key);
    return;
  case KEY_VECTOR:
    write_triple(f, key, write_numbers);
    return;
  case KEY_CELLS:
    write_triple(f, key, write_wholes);
    return;
  case KEY_SWITCH:
    fputs("\"type\": \"boolean\"", f);
    return;
  case KEY_CHOICE:
    write_choice(f, key);
    return;
  case KEY_NAME:
    fputs("\"type\": \"string\", \"pattern\": \"^[A-Za-z0-9_-]{1,63}$\"", f);
    return;
  case KEY_TEXT:
    fputs("\"type\": \"string\", \"minLength\": 1", f);
    return;
  case KEY_LIST:
    fputs("\"type\": \"array\", \"items\": {", f);
    write_mapping(f, key->keys, indent);
    fputc('}', f);
    return;
  default:
    write_mapping(f, key->keys, indent);
  }
}

/* What the key means, its unit and the paper's symbol, and its default. */
static void write_meaning(FILE *f, const struct key *key)
{
  const char *fallback = key->fallback ? key->fallback : key->absent;
  char text[2048];
  snprintf(text, sizeof text, "%s%s%s%s%s%s%s", key->text, key->unit ? " Unit: " : "", key->unit ? key->unit : "",
           key->unit ? "." : "", key->symbol ? " The paper's " : "", key->symbol ? key->symbol : "",
           key->symbol ? "." : "");
  fputs(", \"description\": ", f);
  write_string(f, text);
  if (!fallback)
    return;
  const bool word = key->type == KEY_CHOICE || key->type == KEY_NAME || key->type == KEY_TEXT;
  fputs(", \"default\": ", f);
  if (word)
    write_string(f, fallback);
  else
    fputs(fallback, f); /* a number, a switch or a list of numbers is written in JSON as in YAML */
}

static size_t write_properties(FILE *f, const struct key_table *table, int indent, size_t written)
{
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    if (key->type == KEY_INCLUDE) {
      written = write_properties(f, key->keys, indent, written);
      continue;
    }
    fprintf(f, "%s\n%*s", written++ ? "," : "", indent + 2, "");
    write_string(f, key->name);
    fputs(": {", f);
    write_type(f, key, indent + 2);
    write_meaning(f, key);
    fputc('}', f);
  }
  return written;
}

static size_t write_required(FILE *f, const struct key_table *table, size_t written)
{
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    if (key->type == KEY_INCLUDE) {
      written = write_required(f, key->keys, written);
    } else if (key_is_required(key) && !key->idle) {
      fputs(written++ ? ", " : "", f);
      write_string(f, key->name);
    }
  }
  return written;
}

/* Keys that are required unless another key is 1. */
static void write_idle(FILE *f, const struct key_table *table)
{
  const char *other = NULL;
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    if (!key->idle)
      continue;
    if (!other)
      fprintf(f, "\"if\": {\"not\": {\"properties\": {\"%s\": {\"const\": 1}}}}, \"then\": {\"required\": [",
              key->idle_with);
    fprintf(f, "%s\"%s\"", other ? ", " : "", key->name);
    other = key->idle_with;
  }
  fputs(other ? "]}, " : "", f);
}

/* Pairs of keys that are not given together. */
static void write_exclusions(FILE *f, const struct key_table *table)
{
  bool any = false;
  for (size_t k = 0; k < table->count; k++)
    if (table->key[k].excludes) {
      fprintf(f, "%s{\"not\": {\"required\": [\"%s\", \"%s\"]}}", any ? ", " : "\"allOf\": [", table->key[k].excludes,
              table->key[k].name);
      any = true;
    }
  fputs(any ? "], " : "", f);
}

static void write_mapping(FILE *f, const struct key_table *table, int indent)
{
  fputs("\"type\": \"object\", \"additionalProperties\": false, \"minProperties\": 1, ", f);
  write_exclusions(f, table);
  write_idle(f, table);
  fputs("\"required\": [", f);
  write_required(f, table, 0);
  fputs("], \"properties\": {", f);
  write_properties(f, table, indent, 0);
  fprintf(f, "\n%*s}", indent, "");
}

void scene_schema(FILE *f)
{
  fputs("{\"$schema\": \"https://json-schema.org/draft/2020-12/schema\", \"title\": \"uncross scene\",\n ", f);
  write_mapping(f, &scene_keys, 1);
  fputs("}\n", f);
}
