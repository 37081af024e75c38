/* Frames are appended to a trajectory. */
#include <string.h>

#include "files/frames.h"
#include "files/lock.h"
#include "files/structure.h"
#include "files/trajectory.h"

bool trajectory_reserve(const struct trajectory *t, size_t bytes, struct message *message)
{
  int error = h5_reserve(t->file, bytes);
  return error == 0 || message_set(message, "%s: no room for %zu bytes more: %s", t->path, bytes, strerror(error));
}

static bool append_block(hid_t dataset, uint64_t frame, int rank, const hsize_t *frame_dims, hid_t type,
                         const void *data)
{
  hsize_t dims[3] = {frame + 1}, start[3] = {frame}, count[3] = {1};
  for (int k = 1; k < rank; k++)
    dims[k] = count[k] = frame_dims[k - 1];
  if (H5Dset_extent(dataset, dims) < 0)
    return false;
  hid_t file_space = H5Dget_space(dataset), memory = H5Screate_simple(rank, count, NULL);
  bool ok = H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
            H5Dwrite(dataset, type, memory, file_space, H5P_DEFAULT, data) >= 0;
  h5_close(memory);
  h5_close(file_space);
  return ok;
}

/* The step comes last: a frame without it does not count. A file of version 1 is continued without checksums. */
static bool write_frame(struct trajectory *t, const struct model *model, const struct state *state)
{
  const hsize_t rows[2] = {t->particles, 3}, matrix[2] = {3, 3}, sums[1] = {FRAME_SUMS};
  const size_t numbers = 3 * (size_t)t->particles;
  const int *cells = model->box.cells;
  const double edges[9] = {cells[0], 0, 0, 0, cells[1], 0, 0, 0, cells[2]};
  const double diagonal[3] = {cells[0], cells[1], cells[2]};
  const double time = (double)state->step * model->time_step;
  const int64_t step = (int64_t)state->step;
  uint64_t sum[FRAME_SUMS] = {[SUM_MOMENT] = frame_sum_moment(t->frames, step, time),
                              [SUM_EDGES] = frame_sum_numbers(t->frames, diagonal, 3),
                              [SUM_POSITION] = frame_sum_numbers(t->frames, t->row, numbers)};
  bool ok = append_block(t->position, t->frames, 3, rows, H5T_NATIVE_DOUBLE, t->row);
  if (ok && t->velocity >= 0) {
    frame_velocities(state, model, t->slot, t->row);
    sum[SUM_VELOCITY] = frame_sum_numbers(t->frames, t->row, numbers);
    ok = append_block(t->velocity, t->frames, 3, rows, H5T_NATIVE_DOUBLE, t->row);
  }
  return ok && append_block(t->edges, t->frames, 3, matrix, H5T_NATIVE_DOUBLE, edges) &&
         append_block(t->time, t->frames, 1, NULL, H5T_NATIVE_DOUBLE, &time) &&
         (t->checksum < 0 || append_block(t->checksum, t->frames, 2, sums, H5T_NATIVE_UINT64, sum)) &&
         append_block(t->step, t->frames, 1, NULL, H5T_NATIVE_INT64, &step) && H5Fflush(t->file, H5F_SCOPE_GLOBAL) >= 0;
}

/* Between frames the file is whole, and its lock is one that readers share: HDF5 in another program finds nothing else
 * than what was flushed. While a frame is written the run has the file to itself. A reader that stays is waited for
 * once; then frames are written all the same, until it has gone. */
static void keep_readers_out(struct trajectory *t)
{
  const int fd = h5_descriptor(t->file);
  t->read = lock_wait(fd, true, t->read ? 0.0 : 1.0) == LOCK_IN_USE;
}

void trajectory_let_readers_in(struct trajectory *t)
{
  lock_take(h5_descriptor(t->file), false);
}

/* The most that a frame can take: a new chunk of every dataset. */
static size_t frame_bytes(const struct trajectory *t)
{
  size_t rows = 24 * (size_t)t->particles;
  return 2 * (rows > TRAJECTORY_CHUNK ? rows : TRAJECTORY_CHUNK) + TRAJECTORY_CHUNK + TRAJECTORY_SLACK;
}

bool trajectory_append(struct trajectory *t, const struct model *model, const struct state *state,
                       struct message *message)
{
  if (t->broken)
    return message_set(message, "%s: an earlier frame could not be written", t->path);
  if (t->frames > 0 && state->step == t->last_step)
    return true;
  if (t->frames > 0 && state->step < t->last_step)
    return message_set(message, "%s: a frame of step %llu cannot follow that of step %llu", t->path,
                       (unsigned long long)state->step, (unsigned long long)t->last_step);
  if (t->slot)
    state_solvent_slots(state, t->slot);
  frame_positions(state, model, t->slot, t->row);
  keep_readers_out(t);
  const size_t most = frame_bytes(t);
  const bool room = h5_has_memory(t->path, most, message) && trajectory_reserve(t, most, message);
  const bool ok = room && write_frame(t, model, state);
  h5_trim(t->file);
  trajectory_let_readers_in(t);
  if (!room)
    return false;
  if (!ok) {
    t->broken = true;
    return h5_fail(message, t->path, "a frame could not be written");
  }
  t->frames++;
  t->last_step = state->step;
  return true;
}

bool trajectory_sync(struct trajectory *t, struct message *message)
{
  const int error = h5_sync(t->file);
  return error == 0 || message_set(message, "%s: not synced: %s", t->path, strerror(error));
}

int trajectory_descriptor(const struct trajectory *t)
{
  return h5_descriptor(t->file);
}

uint64_t trajectory_end(const struct trajectory *t)
{
  return t && t->frames > 0 ? t->last_step + 1 : 0;
}
