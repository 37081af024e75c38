/* The text form of packs, for ports without HDF5: docs/port/formats.md. */
#ifndef UNCROSS_ORACLE_PACK_TEXT_H
#define UNCROSS_ORACLE_PACK_TEXT_H

#include "oracle/pack.h"

/* Reads lines `operator step row table.component value` to the end; `path` serves messages only. */
bool pack_read_text(FILE *in, const char *path, struct pack *pack, struct message *message);

/* pack_begins, of text. */
bool pack_text_begins(FILE *in);

#endif
