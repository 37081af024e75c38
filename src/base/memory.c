#define _DEFAULT_SOURCE /* madvise, MAP_ANONYMOUS. NOLINT(bugprone-reserved-identifier) */
#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define CACHE_LINE ((size_t)64)
#define LARGE_PAGE ((size_t)2 << 20)
/* From half a large page on: no array takes more than twice its bytes. Positions of 64,000 vertices, or one component
 * of 164,000 particles, fill 400 small pages, more than a processor remembers the places of (docs/speed.md). */
#define LARGE_ARRAY (LARGE_PAGE / 2)

/* The bytes of an array's large pages; a rest of less than half a page is in small ones. */
static uint64_t in_large_pages(uint64_t bytes)
{
  return bytes < LARGE_ARRAY ? 0 : (bytes + LARGE_PAGE / 2) / LARGE_PAGE * LARGE_PAGE;
}

void *memory_alloc(size_t count, size_t size)
{
  if (size > 0 && count > (SIZE_MAX - LARGE_PAGE) / size)
    return NULL;
  const size_t needed = count * size > 0 ? count * size : 1;
  const size_t edge = needed < LARGE_ARRAY ? CACHE_LINE : LARGE_PAGE, room = (needed + edge - 1) / edge * edge;
  void *memory = aligned_alloc(edge, room);
  if (!memory)
    return NULL;
#ifdef MADV_HUGEPAGE
  if (edge == LARGE_PAGE)
    (void)madvise(memory, in_large_pages(needed), MADV_HUGEPAGE); /* a wish */
#endif
  memset(memory, 0, needed);
  return memory;
}

bool memory_grow(void **list, size_t count, size_t size)
{
  void *bigger = count > SIZE_MAX / size ? NULL : realloc(*list, count * size);
  if (bigger)
    *list = bigger;
  return bigger;
}

bool memory_room(void **list, uint32_t *room, uint32_t count, size_t size)
{
  if (count <= *room)
    return true;
  if (!memory_grow(list, count, size))
    return false;
  *room = count;
  return true;
}

bool memory_double(void **list, uint32_t *room, uint32_t first, size_t size)
{
  const uint32_t twice = *room > 0 ? 2 * *room : first;
  if (twice <= *room || !memory_grow(list, twice, size))
    return false;
  *room = twice;
  return true;
}

bool memory_take(const struct memory_need *need, size_t needs)
{
  bool ok = true;
  for (size_t k = 0; k < needs; k++) {
    *need[k].where = ok && need[k].count > 0 ? memory_alloc(need[k].count, need[k].size) : NULL;
    ok = ok && (need[k].count == 0 || *need[k].where);
  }
  if (!ok)
    memory_release(need, needs);
  return ok;
}

void memory_release(const struct memory_need *need, size_t needs)
{
  for (size_t k = 0; k < needs; k++) {
    free(*need[k].where);
    *need[k].where = NULL;
  }
}

bool memory_to_spare(size_t bytes)
{
  void *room = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return room != MAP_FAILED && munmap(room, bytes) == 0;
}

uint64_t memory_taken(uint64_t bytes)
{
  const uint64_t large = in_large_pages(bytes);
  return large > bytes ? large : bytes;
}

uint64_t memory_bytes(const struct memory_need *need, size_t needs)
{
  uint64_t bytes = 0;
  for (size_t k = 0; k < needs; k++)
    bytes += memory_taken((uint64_t)need[k].count * need[k].size);
  return bytes;
}
