/*
 * Words for the rows of tables of keys (system/keys.h), so that a row reads as a line: name, values, place, what else
 * is so, meaning.
 *
 *   {"rate", NUMBER_ABOVE(0, 1e6), IN_MODEL(medium.rate), UNIT("1/t0"), SYMBOL("Gamma"), TEXT("Rate at which ...")}
 *
 * Each word sets the members of struct key that stand in it. Only the files that declare keys include this one.
 */
#ifndef UNCROSS_SYSTEM_KEY_ROWS_H
#define UNCROSS_SYSTEM_KEY_ROWS_H

#include "system/keys.h"

/* values */
#define NUMBER(lowest, highest) .type = KEY_NUMBER, .low = (lowest), .high = (highest)
#define NUMBER_ABOVE(lowest, highest) .type = KEY_NUMBER, .low = (lowest), .high = (highest), .above = true
#define VECTOR(lowest, highest) .type = KEY_VECTOR, .low = (lowest), .high = (highest)
#define WHOLE64(lowest, highest) .type = KEY_WHOLE64, .least = (lowest), .most = (highest)
#define WHOLE32(lowest, highest) .type = KEY_WHOLE32, .least = (lowest), .most = (highest)
#define CELLS(lowest, highest) .type = KEY_CELLS, .least = (lowest), .most = (highest)
#define SWITCH .type = KEY_SWITCH
#define CHOICE(words) .type = KEY_CHOICE, .choice = (words)
#define CHOICE_FROM(value, words) .type = KEY_CHOICE, .choice = (words), .first = (value)
#define NAME .type = KEY_NAME
#define FILE_NAME .type = KEY_TEXT
#define SECTION(table) .type = KEY_SECTION, .keys = &(table)
#define LIST(table, item, length)                                                                                      \
  .type = KEY_LIST, .keys = &(table), .item_size = sizeof(item), .count_offset = (length)
#define INCLUDE(table) .type = KEY_INCLUDE, .keys = &(table)

/* place; a file adds words for its own structs */
#define AT(type, member) .offset = offsetof(type, member)

/* what else is so */
#define UNIT(words) .unit = (words)
#define SYMBOL(letters) .symbol = (letters)
#define ABSENT(value) .absent = (value)
#define FALLBACK(value) .fallback = (value)
#define IDLE_WITH(key, value) .idle_with = (key), .idle = (value)
#define EXCLUDES(key) .excludes = (key)
#define OPTIONAL .optional = true
#define ASIDE .aside = true
#define FIRST_FORMAT .first_format = true
#define DERIVES .derives = true
#define ONE_LINE .line = true

/* meaning */
#define TEXT(words) .text = (words)

/* the rows of a table: {"solvent", NULL, ROWS(solvent_keys)} */
#define ROWS(keys) sizeof(keys) / sizeof(keys)[0], keys

#endif
