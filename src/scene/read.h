/* The reader of keys: from a tree into the structs that a table describes. Every key gets the same checks and the same
 * messages. */
#ifndef UNCROSS_SCENE_READ_H
#define UNCROSS_SCENE_READ_H

#include "base/message.h"
#include "scene/tree.h"
#include "system/keys.h"

/* The value of a missing key. */
enum key_missing {
  MISSING_DEFAULT, /* the default of today: in a scene that a user gives */
  MISSING_ABSENT   /* the row's `absent` value: in a scene that was stored in a file */
};

/* How missing keys are read, and whether that made a difference. */
struct key_gaps {
  enum key_missing missing;
  bool defaults; /* set if a key was missing whose default is not its `absent` value */
};

/* Fills *destination (zeroed before) from this mapping. Rejects unknown keys, keys given twice, missing ones, wrong
 * types and values out of range. On failure leaves a message; what was allocated by then still has to be freed by the
 * caller (texts, lists). */
bool keys_read(const struct node *mapping, const struct key_table *table, struct key_gaps *gaps, void *destination,
               struct message *message);

/* The row of this key, also where it is included; NULL if there is none. */
const struct key *keys_find(const struct key_table *table, const char *name);

/* Says at this node that the table has no key of this name, and which was meant. Always returns false. */
bool keys_refuse(const struct node *node, const char *name, const struct key_table *table, struct message *message);

/* Reads the text of a value that a row holds (its `absent` value, its default) into `to`. */
bool key_read_text(const struct key *key, const char *text, void *to);

#endif
