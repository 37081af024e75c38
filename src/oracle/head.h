/* The head of a pack, and the model that it describes (docs/port/formats.md). Packs may come from anywhere. */
#ifndef UNCROSS_ORACLE_HEAD_H
#define UNCROSS_ORACLE_HEAD_H

#include "oracle/schema.h"

/* The table that a place of a pack should have, with so many rows; NULL, with a message, if it has none, or one of
 * another shape. Where no rows are due, none is an empty one: text has no line for it. */
const struct pack_table *head_table(const struct pack *pack, const struct pack_place *place,
                                    const struct oracle_table *wanted, uint32_t rows, struct message *message);

/* Whether the head says no more than fibers and points in a periodic box do. */
bool head_is_plain(const struct pack *pack);

/* The seed alone. False, with a message, if there is none. */
bool head_seed(const struct pack *pack, uint64_t *seed, struct message *message);

/* The model of a plain head, finished; each fiber is a kind of its own. False, with a message, if a table is missing,
 * or says what no scene can. The model needs freeing in any case. */
bool head_model(const struct pack *pack, struct model *model, struct message *message);

#endif
