#include "system/stream.h"

#include <xxhash.h>

struct stream stream_of_seed(uint64_t seed)
{
  return (struct stream){.key = seed, .from = STREAM_SEED};
}

struct stream stream_asked(uint64_t seed, bool has_parent, uint64_t parent, uint64_t parent_step)
{
  return (struct stream){.key = seed,
                         .from = STREAM_ASKED,
                         .parent = has_parent ? parent : 0,
                         .parent_step = has_parent ? parent_step : 0};
}

struct stream stream_of_snapshot(uint64_t seed, bool has_parent, uint64_t parent, uint64_t parent_step,
                                 uint64_t parent_state)
{
  const uint64_t word[4] = {seed, has_parent ? parent : 0, parent_step, parent_state}; /* little-endian */
  return (struct stream){.key = XXH64(word, sizeof word, 0),
                         .from = has_parent ? STREAM_SNAPSHOT : STREAM_FOREIGN,
                         .parent = word[1],
                         .parent_step = parent_step,
                         .parent_state = parent_state};
}
