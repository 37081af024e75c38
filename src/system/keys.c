#include "system/keys.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/vec3.h"
#include "system/model.h"

/* --- what is allowed --------------------------------------------------------------------------------------------- */

bool key_allows_number(const struct key *key, double value)
{
  return value <= key->high && (key->above ? value > key->low : value >= key->low);
}

bool key_allows_whole(const struct key *key, uint64_t value)
{
  return value >= key->least && value <= key->most;
}

bool key_allows_name(const char *name)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  const size_t length = strlen(name);
  return length > 0 && length < MODEL_NAME_SIZE && name[strspn(name, letters)] == '\0';
}

int key_choices(const struct key *key)
{
  int words = 0;
  while (key->choice[words])
    words++;
  return words;
}

static void describe_number(const struct key *key, char *text, size_t size)
{
  snprintf(text, size, "%s %s %.15g, <= %.15g", key->type == KEY_VECTOR ? "[x, y, z], each a number" : "number",
           key->above ? ">" : ">=", key->low, key->high);
}

static void describe_whole(const struct key *key, char *text, size_t size)
{
  snprintf(text, size, "%s %" PRIu64 " .. %" PRIu64,
           key->type == KEY_CELLS ? "[x, y, z], each a whole number" : "whole number", key->least, key->most);
}

static void describe_choice(const struct key *key, char *text, size_t size)
{
  size_t used = 0;
  for (const char *const *word = key->choice; *word && used < size; word++)
    used += (size_t)snprintf(text + used, size - used, "%s%s", used ? " | " : "", *word);
}

void key_describe(const struct key *key, char *text, size_t size)
{
  static const char *const plain[] = {
      [KEY_SWITCH] = "true | false",     [KEY_NAME] = "1 to 63 letters, digits, - and _",
      [KEY_TEXT] = "a file name",        [KEY_SECTION] = "a mapping",
      [KEY_LIST] = "a list of mappings", [KEY_INCLUDE] = "keys",
  };
  switch (key->type) {
  case KEY_WHOLE64:
  case KEY_WHOLE32:
  case KEY_CELLS:
    describe_whole(key, text, size);
    return;
  case KEY_NUMBER:
  case KEY_VECTOR:
    describe_number(key, text, size);
    return;
  case KEY_CHOICE:
    describe_choice(key, text, size);
    return;
  default:
    snprintf(text, size, "%s", plain[key->type]);
  }
}

/* --- what is there ----------------------------------------------------------------------------------------------- */

const void *key_items(const struct key *key, const void *from, uint32_t *count)
{
  const void *items;
  memcpy(&items, key_at(key, from), sizeof items);
  memcpy(count, (const char *)from + key->count_offset, sizeof *count);
  return items;
}

size_t key_size(const struct key *key)
{
  static const size_t sizes[] = {
      [KEY_WHOLE64] = sizeof(uint64_t),
      [KEY_WHOLE32] = sizeof(uint32_t),
      [KEY_NUMBER] = sizeof(double),
      [KEY_VECTOR] = sizeof(struct vec3),
      [KEY_CELLS] = 3 * sizeof(int),
      [KEY_SWITCH] = sizeof(bool),
      [KEY_CHOICE] = sizeof(int),
      [KEY_NAME] = MODEL_NAME_SIZE,
      [KEY_TEXT] = sizeof(char *),
      [KEY_LIST] = sizeof(void *),
      [KEY_SECTION] = 0,
      [KEY_INCLUDE] = 0,
  };
  return sizes[key->type];
}

bool key_is_set(const struct key *key, const void *from)
{
  const unsigned char *at = key_at(key, from);
  uint32_t count = 1;
  if (key->type == KEY_LIST)
    key_items(key, from, &count);
  for (size_t i = 0; i < key_size(key); i++)
    if (at[i] != 0)
      return count > 0;
  return false;
}

bool keys_are_there(const struct key_table *table, const void *from)
{
  bool any = false;
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    if (key_is_required(key))
      return key_is_set(key, from);
    any = any || (key->type == KEY_SECTION ? keys_are_there(key->keys, key_at(key, from))
                                           : !key->optional || key_is_set(key, from));
  }
  return any;
}

/* --- checks ------------------------------------------------------------------------------------------------------ */

/* One mapping that is looked at: its table, its values, its path. */
struct check {
  const struct key_table *table;
  const void *from;
  const char *path;
  struct model_error *error;
};

static bool check_table(const struct check *c);

static void path_of(const struct check *c, const struct key *key, char *path, size_t size)
{
  snprintf(path, size, "%s%s%s", c->path, *c->path ? "." : "", key->name);
}

/* Always returns false. */
static bool out_of_range(const struct check *c, const struct key *key, const char *value)
{
  char allowed[256];
  key_describe(key, allowed, sizeof allowed);
  path_of(c, key, c->error->path, sizeof c->error->path);
  snprintf(c->error->text, sizeof c->error->text, "%s is out of range; allowed: %s", value, allowed);
  return false;
}

static bool check_number(const struct check *c, const struct key *key, double value)
{
  char text[32];
  snprintf(text, sizeof text, "%.15g", value);
  return key_allows_number(key, value) || out_of_range(c, key, text);
}

static bool check_whole(const struct check *c, const struct key *key, uint64_t value)
{
  char text[32];
  snprintf(text, sizeof text, "%" PRIu64, value);
  return key_allows_whole(key, value) || out_of_range(c, key, text);
}

static bool check_cells(const struct check *c, const struct key *key, const int *cells)
{
  char text[32];
  for (int i = 0; i < 3; i++) {
    snprintf(text, sizeof text, "%d", cells[i]);
    if (cells[i] < 0 || !key_allows_whole(key, (uint64_t)cells[i]))
      return out_of_range(c, key, text);
  }
  return true;
}

static bool check_choice(const struct check *c, const struct key *key, const void *at)
{
  int value;
  char text[32];
  memcpy(&value, at, sizeof value);
  snprintf(text, sizeof text, "%d", value);
  if (key->optional && value == 0)
    return true;
  return (value >= key->first && value < key->first + key_choices(key)) || out_of_range(c, key, text);
}

static bool check_section(const struct check *c, const struct key *key)
{
  char path[sizeof c->error->path];
  path_of(c, key, path, sizeof path);
  const struct check inner = {key->keys, key_at(key, c->from), path, c->error};
  return !keys_are_there(key->keys, inner.from) || check_table(&inner);
}

static bool check_list(const struct check *c, const struct key *key)
{
  uint32_t count;
  const char *item = key_items(key, c->from, &count);
  for (uint32_t i = 0; i < count; i++) {
    char path[sizeof c->error->path];
    snprintf(path, sizeof path, "%s%s%s.%" PRIu32, c->path, *c->path ? "." : "", key->name, i);
    const struct check inner = {key->keys, item + i * key->item_size, path, c->error};
    if (!check_table(&inner))
      return false;
  }
  return true;
}

static bool check_key(const struct check *c, const struct key *key)
{
  const void *at = key_at(key, c->from);
  const struct vec3 *v = at;
  switch (key->type) {
  case KEY_WHOLE64:
    return check_whole(c, key, *(const uint64_t *)at);
  case KEY_WHOLE32:
    return check_whole(c, key, *(const uint32_t *)at);
  case KEY_NUMBER:
    return check_number(c, key, *(const double *)at);
  case KEY_VECTOR:
    return check_number(c, key, v->x) && check_number(c, key, v->y) && check_number(c, key, v->z);
  case KEY_CELLS:
    return check_cells(c, key, at);
  case KEY_CHOICE:
    return check_choice(c, key, at);
  case KEY_NAME:
    return memchr(at, 0, MODEL_NAME_SIZE) ? key_allows_name(at) || out_of_range(c, key, "this name")
                                          : out_of_range(c, key, "this name");
  case KEY_SECTION:
    return check_section(c, key);
  case KEY_LIST:
    return check_list(c, key);
  case KEY_INCLUDE:
    return check_table(&(struct check){key->keys, at, c->path, c->error});
  default:
    return true; /* a bool and a pointer have no range */
  }
}

static bool check_table(const struct check *c)
{
  for (size_t k = 0; k < c->table->count; k++)
    if (!check_key(c, &c->table->key[k]))
      return false;
  return true;
}

bool model_reject(struct model_error *error, const char *path, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  snprintf(error->path, sizeof error->path, "%s", path);
  vsnprintf(error->text, sizeof error->text, format, arguments);
  va_end(arguments);
  return false;
}

bool keys_check(const struct key_table *table, const void *from, struct model_error *error)
{
  return check_table(&(struct check){table, from, "", error});
}
