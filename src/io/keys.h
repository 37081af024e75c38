/*
 * Tables of keys: what a mapping may hold, and where its values go. One reader walks them all, so that every key gets
 * the same checks and the same messages, and docs/scene.md can be held against them.
 */
#ifndef UNCROSS_KEYS_H
#define UNCROSS_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/yaml.h"

/* What a value is, and the C type it is stored as. */
enum key_type {
  KEY_WHOLE64, /* uint64_t, within least .. most */
  KEY_WHOLE32, /* uint32_t, within least .. most */
  KEY_NUMBER,  /* double, within low .. high */
  KEY_VECTOR,  /* struct vec3: a list of three numbers, each within low .. high */
  KEY_CELLS,   /* int[3]: a list of three whole numbers, each within least .. most */
  KEY_SWITCH,  /* bool */
  KEY_CHOICE,  /* an enum: the place of the word in `choice` */
  KEY_NAME,    /* char[MODEL_NAME_SIZE]: letters, digits, - and _ */
  KEY_TEXT,    /* char *: allocated, NULL if absent */
  KEY_SECTION, /* a mapping with keys of its own, stored in the same struct */
  KEY_LIST     /* a list of mappings: struct key_list, allocated */
};

/* An array of structs, one per item of a list. */
struct key_list {
  void *item;
  uint32_t count;
};

struct key_table;

struct key {
  const char *name;
  const char *fallback;         /* value if absent, as a scene would say it; NULL: must be given, unless `optional` */
  double low, high;             /* numbers */
  uint64_t least, most;         /* whole numbers */
  const char *const *choice;    /* words, ended by NULL */
  const struct key_table *keys; /* of a section, or of each item of a list */
  size_t item_size;             /* of a list */
  size_t offset;                /* of the destination, in the struct that is filled */
  const char *unit, *symbol;    /* for docs/scene.md; symbol: the paper's; NULL: none */
  enum key_type type;
  bool optional; /* may be absent; then nothing is stored */
  bool above;    /* numbers: low itself is not allowed */
};

struct key_table {
  const char *path; /* "solvent", "fibers.places"; "" at the top */
  size_t count;
  const struct key *key;
};

/* Fills *destination (zeroed before) from this mapping; NULL: nothing but defaults. Refuses unknown keys, keys given
 * twice, missing ones, wrong types and values out of range. On failure leaves a message; what was allocated by then
 * still has to be freed by the caller (texts, lists). */
bool keys_read(const struct yaml_file *file, const yaml_node_t *mapping, const struct key_table *table,
               void *destination, struct message *message);

/* What values this key takes, e.g. "number > 0, <= 1", "whole number 1 .. 1024", "none | rescale". */
void key_describe(const struct key *key, char *text, size_t size);

/* The word of `words` (ended by NULL) that is most like this one; NULL if none is near. */
const char *nearest_word(const char *word, const char *const *words);

#endif
