/*
 * Tables of keys: each value that a model or a scene can be given, and where it is stored. Each key is declared once,
 * in a row. From the row come reading (scene/read.h), the effective scene and its fingerprint (scene/write.c), the
 * tables of docs/scene.md (scene/document.c), the JSON schema (scene/schema.c), and the check of a model that was built
 * by hand (keys_check).
 */
#ifndef UNCROSS_SYSTEM_KEYS_H
#define UNCROSS_SYSTEM_KEYS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a value is, and the C type it is stored as. */
enum key_type {
  KEY_WHOLE64, /* uint64_t, within least .. most */
  KEY_WHOLE32, /* uint32_t, within least .. most */
  KEY_NUMBER,  /* double, within low .. high */
  KEY_VECTOR,  /* struct vec3: a list of three numbers, each within low .. high */
  KEY_CELLS,   /* int[3]: a list of three whole numbers, each within least .. most */
  KEY_SWITCH,  /* bool */
  KEY_CHOICE,  /* an enum: `first` and the place of the word in `choice` */
  KEY_NAME,    /* char[MODEL_NAME_SIZE]: letters, digits, - and _ */
  KEY_TEXT,    /* char *: allocated, NULL if absent */
  KEY_SECTION, /* a mapping with keys of its own, stored from `offset` on */
  KEY_LIST,    /* a list of mappings: an allocated array, and its length at `count_offset` */
  KEY_INCLUDE  /* no key: the keys of another table stand here, stored from `offset` on */
};

struct key_table;

/* A key is required if it has no `absent` value and is not `optional`. */
struct key {
  const char *name;
  const char *text; /* meaning, one line of Markdown */

  /* The value of the key in files without it, written as in a scene. It never changes, so that old files keep their
   * meaning. */
  const char *absent;
  const char *fallback; /* the default: the value in a new scene without the key; NULL: as `absent` */

  /* Of a required key that has no meaning where another key of the same mapping is 1: that key, a KEY_WHOLE32 which
   * stands earlier in the table, and the value that is stored if this one is missing there. NULL: always required. */
  const char *idle_with, *idle;

  double low, high;             /* numbers */
  uint64_t least, most;         /* whole numbers */
  const char *const *choice;    /* words, ended by NULL */
  const char *excludes;         /* a key of the same mapping that may not be given too; NULL: none */
  const struct key_table *keys; /* of a section, of each item of a list, or to be included */
  size_t item_size;             /* of a list */
  size_t count_offset;          /* of a list's length, a uint32_t */
  size_t offset;                /* of the destination, in the struct that is filled */
  const char *unit, *symbol;    /* symbol: the paper's; NULL: none */
  int first;                    /* the enum's value of a choice's first word */
  enum key_type type;

  bool optional; /* may be absent; then nothing is stored, and zero means absent */
  bool above;    /* numbers: low itself is not allowed */
  bool aside;    /* has no effect on the physics: not in the fingerprint */
  bool
      first_format; /* written into the fingerprint even at its absent value; keys of later formats are left out then */
  bool derives;     /* sets another key, which is written instead of it */
  bool line;        /* section, items of a list: written on one line, {a: 1, b: 2} */
};

struct key_table {
  const char *path; /* "solvent", "fibers.places"; "" at the top */
  const char *text; /* above the table in docs/scene.md; NULL: nothing */
  size_t count;
  const struct key *key;
};

/* Address of a value in a struct that the table describes. */
static inline const void *key_at(const struct key *key, const void *from)
{
  return (const char *)from + key->offset;
}

static inline bool key_is_required(const struct key *key)
{
  return !key->absent && !key->optional && key->type != KEY_INCLUDE;
}

/* Items of a list, and their number. */
const void *key_items(const struct key *key, const void *from, uint32_t *count);

/* Bytes of a value where it is stored; 0 for sections. */
size_t key_size(const struct key *key);

/* Whether a value differs from zero, or a list has items. This is so for each required or optional key that was given.
 */
bool key_is_set(const struct key *key, const void *from);

/* Whether the mapping of this table is there, in a struct that it describes: its first required key is not zero;
 * without such a key, if it has values of its own, one of its optional values is not zero, or one of its sections is
 * there. */
bool keys_are_there(const struct key_table *table, const void *from);

/* Writes which values this key takes, e.g. "number > 0, <= 1", "whole number 1 .. 1024", "none | rescale". */
void key_describe(const struct key *key, char *text, size_t size);

bool key_allows_number(const struct key *key, double value);
bool key_allows_whole(const struct key *key, uint64_t value);
bool key_allows_name(const char *name);

/* Number of words of a choice. */
int key_choices(const struct key *key);

/* What is wrong with a model. path: the key, such as "fibers.1.mass" (items count from 0; "": the model as a whole).
 * text: what is wrong, and what is allowed. */
struct model_error {
  char path[192];
  char text[512];
};

/* Writes an error. Always returns false. */
bool model_reject(struct model_error *error, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Checks every value in a filled struct against its row. Sections that are not there are skipped. */
bool keys_check(const struct key_table *table, const void *from, struct model_error *error);

#endif
