#include "scene/read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec3.h"
#include "scene/synonyms.h"
#include "scene/value.h"
#include "scene/words.h"
#include "system/model.h"

/* --- values ------------------------------------------------------------------------------------------------------ */

/* Everything that the reading of one value needs. */
struct reading {
  const struct key_table *table;
  const struct key *key;
  const struct node *node;
  const char *source; /* of the whole */
  void *to;
  void *from; /* the struct that holds `to` */
  struct key_gaps *gaps;
  struct message *message;
};

/* "table.key: what; allowed: ..." at this node. Always returns false. */
static bool refuse_value(const struct reading *r, const struct node *node, const char *problem)
{
  char allowed[512];
  key_describe(r->key, allowed, sizeof allowed);
  const char *text = node_text(node);
  char list[40];
  snprintf(list, sizeof list, "a list of %zu", node->count);
  const char *what = text ? text : node->type == NODE_LIST ? list : "a mapping";
  return node_refuse(node, r->message, "%s%s%s: %s%.60s%s%s; allowed: %s", r->table->path, *r->table->path ? "." : "",
                     r->key->name, text ? "'" : "", what, text ? "' " : " ", problem, allowed);
}

static bool read_whole(const struct reading *r, const struct node *node, uint64_t *value)
{
  double number;
  char problem[64] = "is not a whole number of 64 bits";
  if (!node_whole(node, value)) {
    if (node_number(node, &number) && number >= 0.0 && number < 0x1p53 && floor(number) == number)
      snprintf(problem, sizeof problem, "is a whole number, but not in digits: write %.0f", number);
    return refuse_value(r, node, problem);
  }
  return key_allows_whole(r->key, *value) || refuse_value(r, node, "is out of range");
}

static bool read_number(const struct reading *r, const struct node *node, double *value)
{
  if (!node_number(node, value))
    return refuse_value(r, node, "is not a finite number");
  return key_allows_number(r->key, *value) || refuse_value(r, node, "is out of range");
}

static bool is_triple(const struct reading *r)
{
  return (r->node->type == NODE_LIST && r->node->count == 3) || refuse_value(r, r->node, "is not a list of three");
}

static bool read_whole64(const struct reading *r)
{
  return read_whole(r, r->node, r->to);
}

static bool read_whole32(const struct reading *r)
{
  uint64_t value;
  if (!read_whole(r, r->node, &value))
    return false;
  *(uint32_t *)r->to = (uint32_t)value;
  return true;
}

static bool read_a_number(const struct reading *r)
{
  return read_number(r, r->node, r->to);
}

static bool read_vector(const struct reading *r)
{
  struct vec3 *v = r->to;
  return is_triple(r) && read_number(r, node_item(r->node, 0), &v->x) && read_number(r, node_item(r->node, 1), &v->y) &&
         read_number(r, node_item(r->node, 2), &v->z);
}

static bool read_cells(const struct reading *r)
{
  if (!is_triple(r))
    return false;
  for (size_t i = 0; i < 3; i++) {
    uint64_t value;
    if (!read_whole(r, node_item(r->node, i), &value))
      return false;
    ((int *)r->to)[i] = (int)value;
  }
  return true;
}

static bool read_switch(const struct reading *r)
{
  return node_switch(r->node, r->to) || refuse_value(r, r->node, "is neither true nor false");
}

/* The place of a word in the key's choices; -1 if it is none of them. */
static int choice_number(const struct key *key, const char *word)
{
  for (int i = 0; key->choice[i]; i++)
    if (strcmp(word, key->choice[i]) == 0)
      return i;
  return -1;
}

enum any { ANY }; /* how an enum is stored */

static bool read_choice(const struct reading *r)
{
  const char *word = node_text(r->node);
  int number = word ? choice_number(r->key, word) : -1;
  if (number < 0) {
    const char *nearest = word ? nearest_word(word, r->key->choice) : NULL;
    char problem[128];
    snprintf(problem, sizeof problem, "is no choice here%s%s%s", nearest ? ", did you mean '" : "",
             nearest ? nearest : "", nearest ? "'?" : "");
    return refuse_value(r, r->node, problem);
  }
  enum any value = (enum any)(r->key->first + number);
  memcpy(r->to, &value, sizeof value);
  return true;
}

static bool read_name(const struct reading *r)
{
  const char *text = node_text(r->node);
  if (!text || !key_allows_name(text))
    return refuse_value(r, r->node, "is not a name");
  memcpy(r->to, text, strlen(text) + 1);
  return true;
}

/* Always returns false. */
static bool no_memory(const struct reading *r)
{
  return message_no_memory(r->message, "%s: out of memory", r->node->source);
}

static bool read_text(const struct reading *r)
{
  const char *text = node_text(r->node);
  if (!text || !*text)
    return refuse_value(r, r->node, "is not a text");
  char *copy = strdup(text);
  memcpy(r->to, &copy, sizeof copy);
  return copy || no_memory(r);
}

static bool read_mapping(const struct reading *r, const struct node *mapping, const struct key_table *table, void *to);

/* A value that the key allows, for an example. */
static const char *example_of(const struct key *key)
{
  static const char *const example[] = {
      [KEY_WHOLE64] = "100",     [KEY_WHOLE32] = "100", [KEY_NUMBER] = "0.5", [KEY_VECTOR] = "[0, 0, 1]",
      [KEY_CELLS] = "[8, 8, 8]", [KEY_SWITCH] = "true", [KEY_NAME] = "a",     [KEY_TEXT] = "file",
      [KEY_SECTION] = "{...}",   [KEY_LIST] = "[...]",  [KEY_INCLUDE] = "",
  };
  if (key->type == KEY_CHOICE)
    return key->choice[0];
  return key->type == KEY_NUMBER && !key_allows_number(key, 0.5) ? "2" : example[key->type];
}

/* "is not a mapping, as {every: 100}": the keys that the section must have, or its first. */
static void describe_missing_mapping(const struct key_table *table, const char *what, char *text, size_t size)
{
  size_t used = (size_t)snprintf(text, size, "%s, as {", what), required = 0;
  for (size_t k = 0; k < table->count; k++)
    required += key_is_required(&table->key[k]);
  const char *between = "";
  for (size_t k = 0; k < table->count && used < size; k++) {
    const struct key *key = &table->key[k];
    if (required ? !key_is_required(key) : k > 0)
      continue;
    used += (size_t)snprintf(text + used, size - used, "%s%s: %s", between, key->name, example_of(key));
    between = ", ";
  }
  if (used < size)
    snprintf(text + used, size - used, "}");
}

static bool read_section(const struct reading *r)
{
  char problem[256];
  if (r->node->type != NODE_MAPPING) {
    describe_missing_mapping(r->key->keys, "is not a mapping", problem, sizeof problem);
    return refuse_value(r, r->node, problem);
  }
  if (r->node->count == 0) {
    describe_missing_mapping(r->key->keys, "at least one key", problem, sizeof problem);
    return node_refuse(r->node, r->message, "%s%s%s: is empty; allowed: %s, or no such section", r->table->path,
                       *r->table->path ? "." : "", r->key->name, problem);
  }
  return read_mapping(r, r->node, r->key->keys, r->to);
}

static bool read_list(const struct reading *r)
{
  if (r->node->type != NODE_LIST)
    return refuse_value(r, r->node, "is not a list");
  if (r->node->count > INT32_MAX)
    return refuse_value(r, r->node, "is too long");
  const uint32_t count = (uint32_t)r->node->count;
  char *items = calloc(count ? count : 1, r->key->item_size);
  if (!items)
    return no_memory(r);
  memcpy(r->to, &items, sizeof items);
  memcpy((char *)r->from + r->key->count_offset, &count, sizeof count);
  for (uint32_t i = 0; i < count; i++) {
    const struct node *item = r->node->item[i];
    if (item->type != NODE_MAPPING)
      return refuse_value(r, item, "is not a mapping");
    if (!read_mapping(r, item, r->key->keys, items + i * r->key->item_size))
      return false;
  }
  return true;
}

static bool (*const readers[KEY_INCLUDE + 1])(const struct reading *) = {
    [KEY_WHOLE64] = read_whole64, [KEY_WHOLE32] = read_whole32, [KEY_NUMBER] = read_a_number,
    [KEY_VECTOR] = read_vector,   [KEY_CELLS] = read_cells,     [KEY_SWITCH] = read_switch,
    [KEY_CHOICE] = read_choice,   [KEY_NAME] = read_name,       [KEY_TEXT] = read_text,
    [KEY_SECTION] = read_section, [KEY_LIST] = read_list,
};

/* --- mappings ---------------------------------------------------------------------------------------------------- */

const struct key *keys_find(const struct key_table *table, const char *name)
{
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    const struct key *found = key->type == KEY_INCLUDE       ? keys_find(key->keys, name)
                              : strcmp(key->name, name) == 0 ? key
                                                             : NULL;
    if (found)
      return found;
  }
  return NULL;
}

enum { WORDS_MAX = 60 };

static size_t collect_words(const struct key_table *table, const char **words, size_t count)
{
  for (size_t k = 0; k < table->count && count < WORDS_MAX; k++)
    if (table->key[k].type == KEY_INCLUDE)
      count = collect_words(table->key[k].keys, words, count);
    else
      words[count++] = table->key[k].name;
  return count;
}

bool keys_refuse(const struct node *node, const char *name, const struct key_table *table, struct message *message)
{
  const char *words[WORDS_MAX + 1];
  words[collect_words(table, words, 0)] = NULL;
  char hint[512];
  suggest_word(name, words, hint, sizeof hint);
  if (!*table->path)
    synonym_places(table, name, hint, sizeof hint);
  const char *meant = synonym_hint(name, table->path);
  return node_refuse(node, message, "unknown key '%.60s'%s%s; %s", name, *table->path ? " in " : "", table->path,
                     meant ? meant : hint);
}

/* Every key of the mapping is known, and given once. Known keys are few, so a mapping with many has one twice early. */
static bool check_names(const struct node *mapping, const struct key_table *table, struct message *message)
{
  for (size_t i = 0; i < mapping->count; i++) {
    const struct node *node = mapping->key[i];
    const char *name = node_text(node);
    if (!name)
      return node_refuse(node, message, "a key must be a word; see docs/scene.md");
    if (!keys_find(table, name))
      return keys_refuse(node, name, table, message);
    for (size_t k = 0; k < i; k++)
      if (strcmp(mapping->key[k]->text, name) == 0)
        return node_refuse(node, message, "key '%s' is given twice, first in line %zu; give it once", name,
                           mapping->key[k]->line);
  }
  return true;
}

bool key_read_text(const struct key *key, const char *text, void *to)
{
  static const struct key_table none = {"", NULL, 0, NULL};
  struct tree tree = {NULL, NULL};
  struct message ignored;
  struct reading r = {.table = &none, .key = key, .to = to, .message = &ignored};
  r.node = value_read(&tree, key->name, text, &ignored);
  const bool ok = r.node && key->type != KEY_INCLUDE && readers[key->type](&r);
  tree_free(&tree);
  return ok;
}

static bool read_table(const struct reading *r, const struct node *mapping, const struct key_table *table, void *to);

/* A value that is there, alone or with others. */
static bool read_given(const struct reading *r, const struct node *mapping)
{
  const char *other = r->key->excludes;
  if (other && node_value(mapping, other))
    return node_refuse(r->node, r->message, "%s.%s: %s is given too; allowed: one of the two", r->table->path,
                       r->key->name, other);
  return readers[r->key->type](r);
}

/* Whether the key has no meaning here, because of another key's value, which has been read. */
static bool is_idle(const struct reading *r)
{
  for (size_t k = 0; r->key->idle_with && k < r->table->count; k++) {
    const struct key *other = &r->table->key[k];
    if (strcmp(other->name, r->key->idle_with) == 0)
      return *(const uint32_t *)key_at(other, r->from) == 1;
  }
  return false;
}

/* What a key means that is not there: scalars only, for sections say it themselves. */
static bool read_missing(const struct reading *r, const struct node *mapping)
{
  const struct key *key = r->key;
  if (mapping && is_idle(r))
    return key_read_text(key, key->idle, r->to) || message_no_memory(r->message, "%s: out of memory", r->source);
  if (mapping && key_is_required(key)) {
    char allowed[512];
    key_describe(key, allowed, sizeof allowed);
    return node_refuse(mapping, r->message, "%s%skey '%s' is missing; allowed: %s", r->table->path,
                       *r->table->path ? ": " : "", key->name, allowed);
  }
  if (key->type == KEY_SECTION)
    return read_table(r, NULL, key->keys, r->to);
  if (key->fallback)
    r->gaps->defaults = true;
  const char *text = r->gaps->missing == MISSING_DEFAULT && key->fallback ? key->fallback : key->absent;
  return !text || key_read_text(key, text, r->to) || message_no_memory(r->message, "%s: out of memory", r->source);
}

/* From a mapping; NULL: nothing but what missing keys mean. */
static bool read_table(const struct reading *r, const struct node *mapping, const struct key_table *table, void *to)
{
  for (size_t k = 0; k < table->count; k++) {
    struct reading inner = *r;
    inner.table = table;
    inner.key = &table->key[k];
    inner.from = to;
    inner.to = (char *)to + inner.key->offset;
    bool ok;
    if (inner.key->type == KEY_INCLUDE) {
      ok = read_table(&inner, mapping, inner.key->keys, inner.to);
    } else {
      inner.node = node_value(mapping, inner.key->name);
      ok = inner.node ? read_given(&inner, mapping) : read_missing(&inner, mapping);
    }
    if (!ok)
      return false;
  }
  return true;
}

static bool read_mapping(const struct reading *r, const struct node *mapping, const struct key_table *table, void *to)
{
  return check_names(mapping, table, r->message) && read_table(r, mapping, table, to);
}

bool keys_read(const struct node *mapping, const struct key_table *table, struct key_gaps *gaps, void *destination,
               struct message *message)
{
  const struct reading r = {.source = mapping->source, .gaps = gaps, .message = message};
  return read_mapping(&r, mapping, table, destination);
}
