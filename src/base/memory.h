/* Memory of the large arrays. */
#ifndef UNCROSS_BASE_MEMORY_H
#define UNCROSS_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Allocates `count` elements of `size` bytes, zeroed, aligned to a cache line. Large arrays ask for large pages: with
 * 100^3 cells a collision then takes 12 % less time, since the processor reads ahead only within a page. To be freed
 * with free. NULL if memory is short. */
void *memory_alloc(size_t count, size_t size);

/* Enlarges a list to `count` elements and keeps its content; *list is to be freed with free. False, with *list as it
 * was, if memory is short. */
bool memory_grow(void **list, size_t count, size_t size);

/* Enlarges a list whose capacity *room is below `count`. Otherwise as memory_grow. */
bool memory_room(void **list, uint32_t *room, uint32_t count, size_t size);

/* Doubles the capacity *room of a list, or makes it `first` if it was 0. Otherwise as memory_grow. */
bool memory_double(void **list, uint32_t *room, uint32_t first, size_t size);

/* An array of scratch: address of its pointer, number of entries, bytes of an entry. */
struct memory_need {
  void **where;
  size_t count, size;
};

/* Allocates all of them as memory_alloc; the pointer of an array without entries is NULL. False, with all of them NULL,
 * if memory is short. */
bool memory_take(const struct memory_need *need, size_t needs);

/* Frees all of them, and sets them to NULL. */
void memory_release(const struct memory_need *need, size_t needs);

/* Whether so many bytes could be had now; they are not taken, nor written to. For what is to happen before a library is
 * called that does not bear to be refused memory. */
bool memory_to_spare(size_t bytes);

/* Bytes that an array of so many bytes takes: large pages are whole. */
uint64_t memory_taken(uint64_t bytes);

/* Bytes that all of them take. */
uint64_t memory_bytes(const struct memory_need *need, size_t needs);

#endif
