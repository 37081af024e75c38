#include "io/keys.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/vec3.h"
#include "state/model.h"

enum { WORD_MAX = 40, WORDS_MAX = 40 };

/* --- words ------------------------------------------------------------------------------------------------------- */

static size_t least_of(size_t a, size_t b, size_t c)
{
  size_t m = a < b ? a : b;
  return m < c ? m : c;
}

/* How many letters must be changed, put in or left out, or neighbors exchanged, to get from a to b (Damerau 1964,
 * "optimal string alignment"). Both shorter than WORD_MAX. */
static size_t edit_distance(const char *a, const char *b)
{
  size_t d[WORD_MAX + 1][WORD_MAX + 1];
  const size_t n = strlen(a), m = strlen(b);
  for (size_t i = 0; i <= n; i++)
    d[i][0] = i;
  for (size_t j = 0; j <= m; j++)
    d[0][j] = j;
  for (size_t i = 1; i <= n; i++)
    for (size_t j = 1; j <= m; j++) {
      size_t change = d[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      d[i][j] = least_of(change, d[i - 1][j] + 1, d[i][j - 1] + 1);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && d[i - 2][j - 2] + 1 < d[i][j])
        d[i][j] = d[i - 2][j - 2] + 1;
    }
  return d[n][m];
}

const char *nearest_word(const char *word, const char *const *words)
{
  const size_t length = strlen(word);
  const char *nearest = NULL;
  size_t best = length / 2 + 1; /* half the letters must be right */
  for (; length < WORD_MAX && *words; words++) {
    bool begins = length >= 3 && strncmp(word, *words, length) == 0;
    size_t distance = begins ? 1 : strlen(*words) < WORD_MAX ? edit_distance(word, *words) : best;
    if (distance < best) {
      best = distance;
      nearest = *words;
    }
  }
  return nearest;
}

/* ", did you mean 'x'" or the list of all words. */
static void suggest(const char *word, const char *const *words, char *text, size_t size)
{
  const char *nearest = nearest_word(word, words);
  if (nearest) {
    snprintf(text, size, "did you mean '%s'?", nearest);
    return;
  }
  size_t used = (size_t)snprintf(text, size, "allowed:");
  for (; *words && used < size; words++)
    used += (size_t)snprintf(text + used, size - used, " %s", *words);
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
      [KEY_LIST] = "a list of mappings",
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

/* --- values ------------------------------------------------------------------------------------------------------ */

/* Everything that the reading of one value needs. */
struct reading {
  const struct yaml_file *file;
  const struct key_table *table;
  const struct key *key;
  const yaml_node_t *node;
  void *to;
  struct message *message;
};

/* "table.key: what; allowed: ..." at this node. Always returns false. */
static bool refuse_value(const struct reading *r, const yaml_node_t *node, const char *problem)
{
  char allowed[512];
  key_describe(r->key, allowed, sizeof allowed);
  const char *text = yaml_text(node);
  return yaml_refuse(r->file, node, r->message, "%s%s%s: %s%.60s%s%s; allowed: %s", r->table->path,
                     *r->table->path ? "." : "", r->key->name, text ? "'" : "", text ? text : "a list or mapping",
                     text ? "' " : " ", problem, allowed);
}

static bool read_whole(const struct reading *r, const yaml_node_t *node, uint64_t *value)
{
  if (!yaml_whole(node, value))
    return refuse_value(r, node, "is not a whole number of 64 bits");
  return (*value >= r->key->least && *value <= r->key->most) || refuse_value(r, node, "is out of range");
}

static bool read_number(const struct reading *r, const yaml_node_t *node, double *value)
{
  if (!yaml_number(node, value))
    return refuse_value(r, node, "is not a finite number");
  bool low_enough = *value <= r->key->high, high_enough = r->key->above ? *value > r->key->low : *value >= r->key->low;
  return (low_enough && high_enough) || refuse_value(r, node, "is out of range");
}

static bool is_triple(const struct reading *r)
{
  return yaml_items(r->node) == 3 || refuse_value(r, r->node, "is not a list of three");
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
  return is_triple(r) && read_number(r, yaml_item(r->file, r->node, 0), &v->x) &&
         read_number(r, yaml_item(r->file, r->node, 1), &v->y) && read_number(r, yaml_item(r->file, r->node, 2), &v->z);
}

static bool read_cells(const struct reading *r)
{
  if (!is_triple(r))
    return false;
  for (size_t i = 0; i < 3; i++) {
    uint64_t value;
    if (!read_whole(r, yaml_item(r->file, r->node, i), &value))
      return false;
    ((int *)r->to)[i] = (int)value;
  }
  return true;
}

static bool read_switch(const struct reading *r)
{
  return yaml_switch(r->node, r->to) || refuse_value(r, r->node, "is neither true nor false");
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
  const char *word = yaml_text(r->node);
  int number = word ? choice_number(r->key, word) : -1;
  if (number < 0) {
    const char *nearest = word ? nearest_word(word, r->key->choice) : NULL;
    char problem[128];
    snprintf(problem, sizeof problem, "is no choice here%s%s%s", nearest ? ", did you mean '" : "",
             nearest ? nearest : "", nearest ? "'?" : "");
    return refuse_value(r, r->node, problem);
  }
  enum any value = (enum any)number;
  memcpy(r->to, &value, sizeof value);
  return true;
}

static bool read_name(const struct reading *r)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  const char *text = yaml_text(r->node);
  size_t length = text ? strlen(text) : 0;
  if (length == 0 || length >= MODEL_NAME_SIZE || text[strspn(text, letters)] != '\0')
    return refuse_value(r, r->node, "is not a name");
  memcpy(r->to, text, length + 1);
  return true;
}

static bool read_text(const struct reading *r)
{
  const char *text = yaml_text(r->node);
  if (!text || !*text)
    return refuse_value(r, r->node, "is not a text");
  char *copy = strdup(text);
  *(char **)r->to = copy;
  return copy || message_set(r->message, "%s: out of memory", r->file->path);
}

static bool read_section(const struct reading *r)
{
  if (r->node->type != YAML_MAPPING_NODE)
    return refuse_value(r, r->node, "is not a mapping");
  return keys_read(r->file, r->node, r->key->keys, r->to, r->message);
}

static bool read_list(const struct reading *r)
{
  if (r->node->type != YAML_SEQUENCE_NODE)
    return refuse_value(r, r->node, "is not a list");
  struct key_list *list = r->to;
  size_t count = yaml_items(r->node);
  list->item = calloc(count ? count : 1, r->key->item_size);
  if (!list->item)
    return message_set(r->message, "%s: out of memory", r->file->path);
  list->count = (uint32_t)count; /* libyaml numbers nodes by int */
  for (size_t i = 0; i < count; i++) {
    const yaml_node_t *item = yaml_item(r->file, r->node, i);
    if (item->type != YAML_MAPPING_NODE)
      return refuse_value(r, item, "is not a mapping");
    if (!keys_read(r->file, item, r->key->keys, (char *)list->item + i * r->key->item_size, r->message))
      return false;
  }
  return true;
}

static bool (*const readers[])(const struct reading *) = {
    [KEY_WHOLE64] = read_whole64, [KEY_WHOLE32] = read_whole32, [KEY_NUMBER] = read_a_number,
    [KEY_VECTOR] = read_vector,   [KEY_CELLS] = read_cells,     [KEY_SWITCH] = read_switch,
    [KEY_CHOICE] = read_choice,   [KEY_NAME] = read_name,       [KEY_TEXT] = read_text,
    [KEY_SECTION] = read_section, [KEY_LIST] = read_list,
};

/* --- mappings ---------------------------------------------------------------------------------------------------- */

/* What is stored where a key is absent. Zero is there already: vectors, lists, and "as long as ..." defaults. */
static void store_default(const struct key *key, void *to)
{
  if (!key->fallback)
    return;
  uint64_t whole = 0;
  switch (key->type) {
  case KEY_WHOLE64:
    yaml_text_whole(key->fallback, to);
    break;
  case KEY_WHOLE32:
    yaml_text_whole(key->fallback, &whole);
    *(uint32_t *)to = (uint32_t)whole;
    break;
  case KEY_NUMBER:
    yaml_text_number(key->fallback, to);
    break;
  case KEY_SWITCH:
    *(bool *)to = strcmp(key->fallback, "true") == 0;
    break;
  case KEY_CHOICE: {
    enum any value = (enum any)choice_number(key, key->fallback);
    memcpy(to, &value, sizeof value);
    break;
  }
  default:
    break;
  }
}

static bool refuse_key(const struct yaml_file *file, const yaml_node_t *node, const char *name,
                       const struct key_table *table, struct message *message)
{
  const char *words[WORDS_MAX + 1] = {NULL};
  for (size_t k = 0; k < table->count && k < WORDS_MAX; k++)
    words[k] = table->key[k].name;
  char hint[512];
  suggest(name, words, hint, sizeof hint);
  return yaml_refuse(file, node, message, "unknown key '%.60s'%s%s; %s", name, *table->path ? " in " : "", table->path,
                     hint);
}

static bool key_is_known(const struct key_table *table, const char *name)
{
  for (size_t k = 0; k < table->count; k++)
    if (strcmp(table->key[k].name, name) == 0)
      return true;
  return false;
}

/* Every key of the mapping is known, and given once. */
static bool check_names(const struct yaml_file *file, const yaml_node_t *mapping, const struct key_table *table,
                        struct message *message)
{
  for (size_t i = 0; i < yaml_pairs(mapping); i++) {
    const yaml_node_t *value, *other;
    const yaml_node_t *node = yaml_pair(file, mapping, i, &value);
    const char *name = yaml_text(node);
    if (!name)
      return yaml_refuse(file, node, message, "a key must be a word; see docs/scene.md");
    if (!key_is_known(table, name))
      return refuse_key(file, node, name, table, message);
    for (size_t k = 0; k < i; k++) {
      const yaml_node_t *earlier = yaml_pair(file, mapping, k, &other);
      if (strcmp(yaml_text(earlier), name) == 0)
        return yaml_refuse(file, node, message, "key '%s' is given twice, first in line %zu; give it once", name,
                           earlier->start_mark.line + 1);
    }
  }
  return true;
}

bool keys_read(const struct yaml_file *file, const yaml_node_t *mapping, const struct key_table *table,
               void *destination, struct message *message)
{
  if (mapping && !check_names(file, mapping, table, message))
    return false;
  for (size_t k = 0; k < table->count; k++) {
    const struct key *key = &table->key[k];
    const yaml_node_t *node = yaml_value_of(file, mapping, key->name);
    void *to = (char *)destination + key->offset;
    const struct reading reading = {file, table, key, node, to, message};
    if (node) {
      if (!readers[key->type](&reading))
        return false;
      continue;
    }
    if (mapping && !key->fallback && !key->optional) {
      char allowed[512];
      key_describe(key, allowed, sizeof allowed);
      return yaml_refuse(file, mapping, message, "%s%skey '%s' is missing; allowed: %s", table->path,
                         *table->path ? ": " : "", key->name, allowed);
    }
    store_default(key, to);
    if (key->type == KEY_SECTION && !keys_read(file, NULL, key->keys, to, message))
      return false;
  }
  return true;
}
