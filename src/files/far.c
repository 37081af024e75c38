/* The side that asks. */
#include "files/far.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/reader.h"

bool far_open(struct far *far, const char *path, enum h5_trouble *trouble, struct message *message)
{
  uint64_t sealed = 0;
  *far = (struct far){.lost = {.text = ""}};
  *trouble = H5_UNREADABLE;
  if (!apart_start(&far->apart, path, "hdf5", message))
    return false;
  const int verdict = apart_get_verdict(&far->apart, message);
  const bool ok =
      verdict == H5_FINE && (apart_get(&far->apart, &sealed, sizeof sealed) || apart_lost(&far->apart, message));
  far->sealed = sealed;
  far->budget = reader_memory(far->apart.bytes);
  *trouble = ok ? H5_FINE : verdict == H5_DAMAGED ? H5_DAMAGED : far->apart.died ? H5_DEADLY : H5_UNREADABLE;
  return ok;
}

void far_close(struct far *far)
{
  apart_end(&far->apart);
}

int far_fail(const struct far *far, struct message *message, const char *doing)
{
  if (far->lost.text[0])
    *message = far->lost;
  else
    message_set(message, "%s: %s%s%s", far->apart.path, doing, far->reason[0] ? ": " : "", far->reason);
  return 0;
}

bool far_whole(const struct far *far, uint64_t failures, const char *damaged, struct message *message)
{
  if (far->lost.text[0])
    *message = far->lost;
  else if (far->failures != failures)
    message_set(message, "%s: %s", far->apart.path, damaged);
  return !far->lost.text[0] && far->failures == failures;
}

bool far_affords(struct far *far, uint64_t bytes)
{
  const bool affordable = bytes <= far->budget;
  far->budget -= affordable ? bytes : 0;
  return affordable;
}

void *far_room(struct far *far, size_t count, size_t size, struct message *message)
{
  const bool affordable = count < SIZE_MAX / size && far_affords(far, ((uint64_t)count + 1) * size);
  void *found = affordable ? calloc(count + 1, size) : NULL;
  if (!found)
    message_no_memory(message, "out of memory");
  return found;
}

/* --- questions --------------------------------------------------------------------------------------------------- */

/* The answer's bytes into data. */
static int ask(struct far *far, const char *in, const char *name, const char *attribute, struct far_question q,
               void *data)
{
  struct far_answer a;
  const int length = snprintf(q.path, sizeof q.path, "%s%s%s", in, *in && *name ? "/" : "", name);
  snprintf(q.attribute, sizeof q.attribute, "%s", attribute);
  if (far->lost.text[0] || length >= (int)sizeof q.path)
    return -1;
  if (!apart_put(&far->apart, &q, sizeof q) || !apart_get(&far->apart, &a, sizeof a) ||
      (a.found > 0 && !apart_get(&far->apart, data, (size_t)q.bytes))) {
    apart_lost(&far->apart, &far->lost);
    return -1;
  }
  far->failures = a.failures;
  if (a.no_memory)
    message_no_memory(&far->lost, "%s: out of memory", far->apart.path);
  memcpy(far->reason, a.reason, sizeof far->reason);
  return (int)a.found;
}

struct far_thing far_look(struct far *far, const char *in, const char *name)
{
  struct far_thing thing = {.kind = FAR_BROKEN};
  const int found = ask(far, in, name, "", (struct far_question){.type = FAR_THING, .bytes = sizeof thing}, &thing);
  return found > 0 ? thing : (struct far_thing){.kind = found};
}

bool far_has(struct far *far, const char *in, const char *name)
{
  return far_look(far, in, name).kind > FAR_NOTHING;
}

bool far_is(const struct far_thing *thing, int rank)
{
  return thing->kind == FAR_DATASET && thing->rank == rank;
}

bool far_link(struct far *far, const char *in, uint64_t k, char *name, size_t size)
{
  return ask(far, in, "", "", (struct far_question){.type = FAR_LINK, .row = k, .bytes = size}, name) > 0;
}

static const size_t bytes_of[FAR_NUMBERS] = {sizeof(double), sizeof(int64_t), sizeof(int32_t), sizeof(uint64_t),
                                             sizeof(uint32_t)};

bool far_read(struct far *far, const char *in, const char *name, uint64_t row, enum far_type type, int rank,
              const uint64_t *dims, void *data)
{
  struct far_question q = {.type = type, .row = row, .rank = (uint64_t)rank, .bytes = bytes_of[type]};
  for (int k = 0; k < rank; k++) {
    q.dims[k] = dims[k];
    q.bytes *= k == 0 && row < FAR_PLAIN ? 1 : dims[k];
  }
  return ask(far, in, name, "", q, data) > 0;
}

/* So many bytes that are to be freed, and one more. */
static void *ask_bytes(struct far *far, const char *in, const char *name, enum far_type type, uint64_t bytes)
{
  struct message ignored;
  void *data = far_room(far, (size_t)bytes, 1, &ignored);
  if (data && ask(far, in, name, "", (struct far_question){.type = type, .row = FAR_ALL, .bytes = bytes}, data) > 0)
    return data;
  if (!data)
    message_no_memory(&far->lost, "%s: out of memory", far->apart.path);
  free(data);
  return NULL;
}

char *far_text(struct far *far, const char *in, const char *name)
{
  const struct far_thing thing = far_look(far, in, name);
  return far_is(&thing, 0) && thing.class == FAR_TEXTS ? ask_bytes(far, in, name, FAR_TEXT, thing.size) : NULL;
}

void *far_names(struct far *far, const char *in, const char *name, size_t size, uint64_t *count)
{
  *count = far_look(far, in, name).links;
  return ask_bytes(far, in, name, FAR_NAMES, *count * size);
}

int far_get(struct far *far, const char *in, const char *name, const char *attribute, enum far_type type, size_t count,
            void *data)
{
  const struct far_question q = {.type = type, .dims = {count}, .bytes = (count ? count : 1) * bytes_of[type]};
  return ask(far, in, name, attribute, q, data);
}

int far_get_text(struct far *far, const char *in, const char *name, const char *attribute, size_t count, char *text,
                 size_t size)
{
  const struct far_question q = {.type = FAR_TEXT, .dims = {count}, .bytes = (count ? count : 1) * size};
  return ask(far, in, name, attribute, q, text);
}
