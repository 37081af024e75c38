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

/* A valid file in memory, and where it is put, changed, to be read. */
struct victim {
  uint8_t *data;
  size_t size;
  char path[64];
};

static struct {
  struct scene scene, starter; /* starter: its start is the foreign trajectory */
  struct state state;
  struct victim checkpoint, trajectory, pack, foreign, ours;
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

static void take_file(struct victim *victim)
{
  FILE *file = fopen(victim->path, "rb");
  require(file != NULL, "fopen");
  victim->data = malloc(1 << 20);
  victim->size = fread(victim->data, 1, 1 << 20, file);
  fclose(file);
}

static void put(const char *path, const uint8_t *data, size_t size)
{
  FILE *file = fopen(path, "wb");
  require(file && fwrite(data, 1, size, file) == size, "fwrite");
  fclose(file);
}

/* A word of the reader about a failure that is the file's, not one of our own code in the process that reads it. */
static void require_reason(const struct message *message, const char *name)
{
  require(message->text[0] != '\0' && !strstr(message->text, "ended early"), name);
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

/* The changed file, to be freed, and its length. */
static uint8_t *changed(const struct victim *victim, bool sealed, const uint8_t *data, size_t size, size_t *length)
{
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
  if (sealed) {
    seal_make(copy, end, copy + end);
    end += SEAL_BYTES;
  }
  *length = end;
  return copy;
}

/* Puts the changed file where it is read. */
static void damage(const struct victim *victim, bool sealed, const uint8_t *data, size_t size)
{
  size_t length;
  uint8_t *copy = changed(victim, sealed, data, size, &length);
  put(victim->path, copy, length);
  free(copy);
}

#endif
