/* How large files become, by numbers alone. */
#include "files/structure.h"
#include "files/trajectory.h"

#define CHUNK_PLACE 80         /* bytes of the index for a chunk: its nodes are more than half full */
#define CHECKPOINT_ONCE 8600.0 /* bytes of all that a checkpoint has once: groups, attributes, the seal */
#define TRAJECTORY_ONCE 21e3   /* bytes of all that a trajectory has once */

double checkpoint_bytes(const struct model *model, uint64_t observed)
{
  return (double)(state_bytes(model) + observed) + STRUCTURE_PARTICLE * model->vertices +
         STRUCTURE_BOND * model->bonds + CHECKPOINT_ONCE;
}

/* Bytes of a dataset of so many rows, `row` bytes each: whole chunks, and their places in its index. */
static double in_chunks(uint64_t rows, uint64_t row, uint64_t chunk)
{
  const uint64_t chunks = rows / chunk + (rows % chunk > 0);
  return (double)chunks * (double)(chunk * row + CHUNK_PLACE);
}

double trajectory_bytes(uint64_t rows, uint64_t bonds, bool velocities, uint64_t frames)
{
  const uint64_t vectors = 24 * rows, few = vectors < TRAJECTORY_CHUNK && vectors > 0 ? TRAJECTORY_CHUNK / vectors : 1;
  const double structure = STRUCTURE_PARTICLE * (double)rows + STRUCTURE_BOND * (double)bonds;
  return TRAJECTORY_ONCE + structure + (velocities ? 2.0 : 1.0) * in_chunks(frames, vectors, few) +
         in_chunks(frames, 72, TRAJECTORY_CHUNK / 72) + 2.0 * in_chunks(frames, 8, 1024) +
         in_chunks(frames, 8 * FRAME_SUMS, 1024 / FRAME_SUMS);
}
