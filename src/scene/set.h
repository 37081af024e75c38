/* Setting single keys by their path, on top of a file or without one. */
#ifndef UNCROSS_SCENE_SET_H
#define UNCROSS_SCENE_SET_H

#include "base/message.h"
#include "scene/tree.h"
#include "system/keys.h"

/*
 * Sets one key of the scene in the tree, given or not. Sections on the way are made if they are not there.
 *
 * - path: "time_step", "solvent.per_cell"; in a list by number (from 0) or by name: "fibers.0.count",
 *   "fibers.rods.count". The number after the last one appends an item.
 * - value: as value_read (scene/value.h) takes it.
 * - source: the origin of the value, for messages, e.g. "--set time_step=0.01"; copied.
 * - once: a key that was set before is refused, by whatever path; else the later value replaces the earlier one.
 *
 * Rejects an unknown key, a path that ends at a section or goes on beyond a value, an item that is not there, and text
 * that is not a value. keys_read checks later whether the value fits the key.
 */
bool tree_set(struct tree *tree, const struct key_table *table, const char *source, const char *path, const char *value,
              bool once, struct message *message);

/* The same from "path=value", with the source "--set path=value". */
bool tree_set_option(struct tree *tree, const struct key_table *table, const char *option, bool once,
                     struct message *message);

#endif
