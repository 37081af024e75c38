/*
 * Which random numbers a run draws. All of them are addressed by purpose, step and entity (base/random.h), so two runs
 * with one key draw the same noise at the same steps. The key of a run is its stream: the seed, if the run begins with
 * the scene's own start. If it begins with a snapshot, the stream is a hash of the seed and of the snapshot: its own
 * stream, its step, and the state that it gives. So a run that goes on from another one has noise of its own, and only
 * a run with the same seed from the same snapshot has the same.
 */
#ifndef UNCROSS_SYSTEM_STREAM_H
#define UNCROSS_SYSTEM_STREAM_H

#include <stdbool.h>
#include <stdint.h>

/* Numbers are those of checkpoints. */
enum stream_from {
  STREAM_UNTOLD,   /* an earlier program's checkpoint does not say: the stream is the seed */
  STREAM_SEED,     /* the scene's own start */
  STREAM_SNAPSHOT, /* a snapshot of this program */
  STREAM_FOREIGN,  /* a snapshot of another program, which has no stream */
  STREAM_ASKED     /* the seed, though the run begins with a snapshot: start.stream */
};

/* What the file of a snapshot does not say, so that the run begins without it: bits. */
enum stream_untold { UNTOLD_SLIDE = 1, UNTOLD_BONDS = 2, UNTOLD_ALL = 3 };

struct stream {
  uint64_t key; /* of every random number: model.seed */
  uint32_t from, untold;
  uint64_t parent, parent_step, parent_state; /* of a snapshot: stream (0: none), step, hash of the state it gives (not
                                               * of STREAM_ASKED) */
};

struct stream stream_of_seed(uint64_t seed);

/* has_parent: the snapshot has a stream. The key is the XXH64, seed 0, of four little-endian 64-bit words: seed,
 * parent, parent_step, parent_state. */
struct stream stream_of_snapshot(uint64_t seed, bool has_parent, uint64_t parent, uint64_t parent_step,
                                 uint64_t parent_state);

/* The seed of a run that begins with a snapshot all the same. */
struct stream stream_asked(uint64_t seed, bool has_parent, uint64_t parent, uint64_t parent_step);

/* Whether it is made of a snapshot. */
static inline bool stream_has_parent(const struct stream *stream)
{
  return stream->from == STREAM_SNAPSHOT || stream->from == STREAM_FOREIGN;
}

#endif
