/* The effective scene, written out: every default filled in, every number to the last bit. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "base/vec3.h"
#include "scene/read.h"
#include "scene/scene_keys.h"
#include "scene/write.h"
#include "system/model.h"

/* --- values ------------------------------------------------------------------------------------------------------ */

static void write_number(FILE *f, double x)
{
  text_print_reals(f, 1, &x);
}

/* A text in double quotes, as YAML reads it. */
static void write_quoted(FILE *f, const char *text)
{
  fputc('"', f);
  while (*text) {
    uint32_t code = (unsigned char)*text;
    const size_t found = text_character(text, &code), bytes = found > 0 ? found : 1;
    if (text_acts(code))
      fprintf(f, code < 0x100 ? "\\x%02x" : "\\u%04x", (unsigned)code);
    else
      fprintf(f, "%s%.*s", *text == '"' || *text == '\\' ? "\\" : "", (int)bytes, text);
    text += bytes;
  }
  fputc('"', f);
}

void key_write_value(FILE *f, const struct key *key, const void *at)
{
  const struct vec3 *v = at;
  const int *cells = at;
  int choice;
  char *text;
  switch (key->type) {
  case KEY_WHOLE64:
    fprintf(f, "%" PRIu64, *(const uint64_t *)at);
    return;
  case KEY_WHOLE32:
    fprintf(f, "%" PRIu32, *(const uint32_t *)at);
    return;
  case KEY_NUMBER:
    write_number(f, *(const double *)at);
    return;
  case KEY_VECTOR:
    for (int i = 0; i < 3; i++) {
      fputs(i ? ", " : "[", f);
      write_number(f, i == 0 ? v->x : i == 1 ? v->y : v->z);
    }
    fputc(']', f);
    return;
  case KEY_CELLS:
    fprintf(f, "[%d, %d, %d]", cells[0], cells[1], cells[2]);
    return;
  case KEY_SWITCH:
    fputs(*(const bool *)at ? "true" : "false", f);
    return;
  case KEY_CHOICE:
    memcpy(&choice, at, sizeof choice);
    fputs(key->choice[choice - key->first], f);
    return;
  case KEY_NAME:
    fputs(at, f);
    return;
  case KEY_TEXT:
    memcpy(&text, at, sizeof text);
    write_quoted(f, text);
    return;
  default:
    return; /* sections and lists are no values */
  }
}

/* --- mappings ---------------------------------------------------------------------------------------------------- */

/* What is written, and where. */
struct writing {
  FILE *f;
  int indent;
  bool physics_only;
  bool failed; /* memory was short */
  bool line;   /* within { } */
  bool first;  /* nothing stands within { } yet */
  bool dash;   /* the next key begins an item of a list */
};

static void write_table(struct writing *w, const struct key_table *table, const void *from);

/* Whether the value is what a file without the key means. */
static bool is_absent(struct writing *w, const struct key *key, const void *from)
{
  union {
    struct vec3 vector;
    char name[MODEL_NAME_SIZE];
    uint64_t whole;
    int cells[3];
  } absent;
  memset(&absent, 0, sizeof absent);
  if (key->absent && !key_read_text(key, key->absent, &absent))
    w->failed = true;
  return memcmp(&absent, key_at(key, from), key_size(key)) == 0;
}

static bool is_written(struct writing *w, const struct key *key, const void *from)
{
  if (key->derives || (w->physics_only && key->aside))
    return false;
  if (key->type == KEY_INCLUDE || key->type == KEY_SECTION) {
    const void *inner = key_at(key, from);
    bool any = false;
    for (size_t k = 0; k < key->keys->count && keys_are_there(key->keys, inner); k++)
      any = any || is_written(w, &key->keys->key[k], inner);
    return any;
  }
  if (key->optional)
    return key_is_set(key, from);
  return !w->physics_only || key->first_format || key_is_required(key) || !is_absent(w, key, from);
}

static void begin_key(struct writing *w, const char *name)
{
  if (w->line)
    fprintf(w->f, "%s%s: ", w->first ? "" : ", ", name);
  else
    fprintf(w->f, "%*s%s%s:", w->dash ? w->indent - 2 : w->indent, "", w->dash ? "- " : "", name);
  w->first = w->dash = false;
}

static void write_braces(struct writing *w, const struct key_table *table, const void *from)
{
  struct writing inner = {.f = w->f, .physics_only = w->physics_only, .line = true, .first = true};
  fputc('{', w->f);
  write_table(&inner, table, from);
  w->failed = w->failed || inner.failed;
  fputc('}', w->f);
}

static void write_section(struct writing *w, const struct key *key, const void *at)
{
  if (key->line) {
    fputc(' ', w->f);
    write_braces(w, key->keys, at);
    fputc('\n', w->f);
    return;
  }
  struct writing inner = {.f = w->f, .indent = w->indent + 2, .physics_only = w->physics_only};
  fputc('\n', w->f);
  write_table(&inner, key->keys, at);
  w->failed = w->failed || inner.failed;
}

static void write_list(struct writing *w, const struct key *key, const void *from)
{
  uint32_t count;
  const char *item = key_items(key, from, &count);
  fputc('\n', w->f);
  for (uint32_t i = 0; i < count; i++) {
    const void *at = item + i * key->item_size;
    struct writing inner = {.f = w->f, .indent = w->indent + 4, .physics_only = w->physics_only, .dash = true};
    if (key->line) {
      fprintf(w->f, "%*s- ", w->indent + 2, "");
      write_braces(w, key->keys, at);
      fputc('\n', w->f);
    } else {
      write_table(&inner, key->keys, at);
      w->failed = w->failed || inner.failed;
    }
  }
}

static void write_key(struct writing *w, const struct key *key, const void *from)
{
  const void *at = key_at(key, from);
  if (key->type == KEY_INCLUDE) {
    write_table(w, key->keys, at);
    return;
  }
  if (!is_written(w, key, from))
    return;
  begin_key(w, key->name);
  if (key->type == KEY_SECTION) {
    write_section(w, key, at);
  } else if (key->type == KEY_LIST) {
    write_list(w, key, from);
  } else {
    if (!w->line)
      fputc(' ', w->f);
    key_write_value(w->f, key, at);
    if (!w->line)
      fputc('\n', w->f);
  }
}

static void write_table(struct writing *w, const struct key_table *table, const void *from)
{
  for (size_t k = 0; k < table->count; k++)
    write_key(w, &table->key[k], from);
}

bool keys_write(const struct key_table *table, const void *from, FILE *f, bool physics_only)
{
  struct writing w = {.f = f, .physics_only = physics_only};
  write_table(&w, table, from);
  return !w.failed;
}

bool scene_write(const struct scene *scene, FILE *f, bool physics_only)
{
  return keys_write(&scene_keys, scene, f, physics_only);
}
