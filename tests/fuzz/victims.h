/* What the readers of the fuzzer share: files in memory that are changed, streams into memory, what is asserted. */
#ifndef UNCROSS_TESTS_FUZZ_VICTIMS_H
#define UNCROSS_TESTS_FUZZ_VICTIMS_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "files/seal.h"
#include "files/snapshot.h"
#include "oracle/check.h"
#include "scene/scene.h"
#include "work.h"

static const char scene_text[] = "box: [4, 4, 4]\ntime_step: 0.01\nsteps: 2\nseed: 1\nsolvent: {per_cell: 2, "
                                 "collision_interval: 0.02}\nfibers:\n  - {name: a, count: 2, vertices: 4, mass: 5, "
                                 "bond_length: 0.5, spring: 100, bending: 4}\n";

/* HDF5's own checksum: its library has the function for everybody, and the declaration for itself. */
uint32_t H5_checksum_lookup3(const void *key, size_t length, uint32_t first);

/* What describes a group, a dataset, or attributes; its checksum follows. */
struct header {
  size_t at, bytes;
};
#define MOST_HEADERS 256

/* A valid file in memory, and where it is put, changed, to be read. */
struct victim {
  uint8_t *data;
  size_t size;
  struct header header[MOST_HEADERS];
  size_t headers;
  char path[64];
};

static struct {
  struct scene scene, starter; /* starter: its start is the foreign trajectory */
  struct state state;
  struct victim checkpoint, trajectory, pack, port, foreign, ours; /* port: a pack as other programs write it */
  size_t numbers[2]; /* where positions and velocities of the foreign frame are; [3 rows] doubles each */
  uint32_t rows;
  struct work work;
  struct pack whole;
  uint64_t hash;
  char *frame, *dump; /* the export of the whole trajectory, and the text of the whole pack */
  char text[64];      /* where tables and records are put */
  const char *readers;
} all;

static void require(bool what, const char *name)
{
  if (what)
    return;
  fprintf(stderr, "fuzz_readers: %s\n", name);
  abort();
}

/* From the specification of the file format, version 3: "OHDR", version 2, flags, times (bit 5), phases (bit 4), length
 * of the messages in 1, 2, 4 or 8 bytes (bits 0, 1), messages, checksum. */
static void find_headers(struct victim *victim)
{
  victim->headers = 0;
  for (size_t at = 0; at + 32 < victim->size && victim->headers < MOST_HEADERS; at++) {
    const uint8_t *h = victim->data + at;
    if (h[0] != 'O' || h[1] != 'H' || h[2] != 'D' || h[3] != 'R' || h[4] != 2)
      continue;
    const size_t before = 6 + (h[5] & 32 ? 16 : 0) + (h[5] & 16 ? 4 : 0), bytes = (size_t)1 << (h[5] & 3);
    uint64_t length = 0;
    uint32_t sum = 0;
    memcpy(&length, h + before, bytes);
    const size_t whole = before + bytes + (size_t)length;
    if (length > victim->size || at + whole + sizeof sum > victim->size)
      continue;
    memcpy(&sum, h + whole, sizeof sum);
    if (sum == H5_checksum_lookup3(h, whole, 0))
      victim->header[victim->headers++] = (struct header){at, whole};
  }
}

static void take_file(struct victim *victim)
{
  FILE *file = fopen(victim->path, "rb");
  require(file != NULL, "fopen");
  victim->data = malloc(1 << 20);
  victim->size = fread(victim->data, 1, 1 << 20, file);
  fclose(file);
  find_headers(victim);
}

static void put(const char *path, const uint8_t *data, size_t size)
{
  FILE *file = fopen(path, "wb");
  require(file && fwrite(data, 1, size, file) == size, "fwrite");
  fclose(file);
}

/* A word of the reader about a failure that is the file's, not one of our own code in the process that reads it. What a
 * message quotes of the file does not end it. */
static void require_reason(const struct message *message, const char *name)
{
  static const char ours[] = "the process that read it ended early";
  const size_t length = strlen(message->text), end = sizeof ours - 1;
  require(length > 0 && (length < end || strcmp(message->text + length - end, ours) != 0), name);
}

/* What goes to a stream, to be freed. */
struct sink {
  FILE *stream;
  char *text;
  size_t size;
};

static void sink_open(struct sink *sink)
{
  sink->text = NULL;
  sink->stream = open_memstream(&sink->text, &sink->size);
  require(sink->stream != NULL, "memory");
}

static char *sink_close(struct sink *sink)
{
  fclose(sink->stream);
  return sink->text;
}

/* Makes the checksums of the headers of objects anew. */
static void rehash_headers(const struct victim *victim, uint8_t *copy)
{
  for (size_t k = 0; k < victim->headers; k++) {
    const struct header *h = &victim->header[k];
    const uint32_t sum = H5_checksum_lookup3(copy + h->at, h->bytes, 0);
    memcpy(copy + h->at + h->bytes, &sum, sizeof sum);
  }
}

/* What is made anew in a changed file. */
enum renewed { NOTHING, HEADERS, SEAL, HEADERS_AND_SEAL };

/* The changed file, to be freed, and its length. */
static uint8_t *changed(const struct victim *victim, enum renewed renewed, const uint8_t *data, size_t size,
                        size_t *length)
{
  const bool sealed = renewed & SEAL;
  uint8_t *copy = malloc(victim->size);
  size_t changes = size / 4 < 16 ? size / 4 : 16, end = victim->size - (sealed ? SEAL_BYTES : 0);
  const size_t room = end;
  memcpy(copy, victim->data, victim->size);
  for (size_t k = 0; k < changes; k++) {
    const uint8_t *c = data + 4 * k;
    size_t at = ((size_t)c[0] << 16 | (size_t)c[1] << 8 | c[2]) % room;
    copy[at] ^= c[3];
    end = changes % 2 && !sealed ? at : end;
  }
  if (renewed & HEADERS)
    rehash_headers(victim, copy);
  if (sealed) {
    seal_make(copy, end, copy + end);
    end += SEAL_BYTES;
  }
  *length = end;
  return copy;
}

/* Puts the changed file where it is read. */
static void damage(const struct victim *victim, enum renewed renewed, const uint8_t *data, size_t size)
{
  size_t length;
  uint8_t *copy = changed(victim, renewed, data, size, &length);
  put(victim->path, copy, length);
  free(copy);
}

#endif
