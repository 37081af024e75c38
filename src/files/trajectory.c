/* Trajectories as HDF5 sees them. */
#include "files/trajectory.h"
#include "files/foreign.h"
#include "files/frames.h"
#include "fluid/fluid.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#define MOST_EDGE 1e9 /* a0, of a box of any program */

/* --- opening and closing ----------------------------------------------------------------------------------------- */

struct trajectory *trajectory_allocate(const char *path)
{
  struct trajectory *t = calloc(1, sizeof *t);
  if (!t)
    return NULL;
  t->file = t->group = t->position = t->velocity = t->edges = t->step = t->time = t->checksum = -1;
  t->path = strdup(path);
  if (!t->path) {
    free(t);
    return NULL;
  }
  return t;
}

bool trajectory_close(struct trajectory *t, struct message *message)
{
  if (!t)
    return true;
  const hid_t handles[] = {t->position, t->velocity, t->edges, t->step, t->time, t->checksum, t->group};
  bool ok = true;
  for (size_t k = 0; k < sizeof handles / sizeof *handles; k++)
    ok &= h5_close(handles[k]);
  ok &= h5_close_locked(t->file);
  if (!ok)
    h5_fail(message, t->path, "not closed properly, its last frames may be lost");
  frames_close(t->frames_apart);
  free(t->path);
  free(t->row);
  free(t->slot);
  free(t);
  return ok;
}

struct trajectory *trajectory_give_up(struct trajectory *t)
{
  struct message ignored;
  trajectory_close(t, &ignored);
  return NULL;
}

/* --- finding what a file holds ----------------------------------------------------------------------------------- */

/* An object of this name, or below 0; that it cannot be read must not look as if it were not there. */
static hid_t find_object(struct trajectory *t, hid_t parent, const char *name)
{
  int found = parent < 0 ? 0 : h5_look(parent, name);
  hid_t object = found > 0 ? h5_open_object(parent, name) : -1;
  t->unread |= found < 0 || (found > 0 && object < 0);
  return object;
}

/* The rank of a dataset, -1 for another object or none. */
static int find_shape(struct trajectory *t, hid_t object, hsize_t dims[3])
{
  if (object < 0 || H5Iget_type(object) != H5I_DATASET)
    return -1;
  int rank = h5_shape(object, 3, dims);
  t->unread |= rank == -2;
  return rank;
}

/* particles/trajectory, or the first group of particles that another program wrote. */
static hid_t find_particles(struct trajectory *t)
{
  hid_t particles = find_object(t, t->file, "particles");
  hid_t group = find_object(t, particles, "trajectory");
  char name[256];
  if (particles >= 0 && group < 0 &&
      H5Lget_name_by_idx(particles, ".", H5_INDEX_NAME, H5_ITER_INC, 0, name, sizeof name, H5P_DEFAULT) > 0)
    group = find_object(t, particles, name);
  h5_close(particles);
  return group;
}

/* `name`/value of shape [frames][particles][3]; fewer frames than so far known bound the number of whole frames. */
static hid_t find_vectors(struct trajectory *t, const char *name)
{
  hsize_t dims[3];
  hid_t element = find_object(t, t->group, name), value = find_object(t, element, "value");
  h5_close(element);
  if (find_shape(t, value, dims) != 3 || dims[2] != 3 || dims[1] > INT32_MAX ||
      (t->particles && t->particles != dims[1])) {
    h5_close(value);
    return -1;
  }
  t->particles = (uint32_t)dims[1];
  t->frames = dims[0] < t->frames ? dims[0] : t->frames;
  return value;
}

/* A dataset with one entry per frame, or below 0. */
static hid_t find_series(struct trajectory *t, hid_t parent, const char *name, int rank)
{
  hsize_t dims[3];
  hid_t series = find_object(t, parent, name);
  if (find_shape(t, series, dims) != rank) {
    h5_close(series);
    return -1;
  }
  t->frames = dims[0] < t->frames ? dims[0] : t->frames;
  return series;
}

/* What we wrote says so in parameters/uncross, with a version; version 2 has checksums. */
static void find_checksums(struct trajectory *t)
{
  hsize_t dims[3];
  hid_t parameters = find_object(t, t->file, "parameters"), own = find_object(t, parameters, "uncross");
  const bool ours = own >= 0 && H5Aexists(own, "format_version") != 0;
  t->unread |= ours && !h5_get(own, "format_version", H5T_NATIVE_INT32, 0, &t->version);
  if (ours && t->version >= 2)
    t->checksum = find_series(t, own, "checksum", 2);
  if (t->checksum >= 0 && (h5_shape(t->checksum, 2, dims) != 2 || dims[1] != FRAME_SUMS)) {
    h5_close(t->checksum);
    t->checksum = -1;
  }
  t->ours = ours;
  h5_close(own);
  h5_close(parameters);
}

static bool is_known(const struct trajectory *t)
{
  return !t->ours || (t->version >= 1 && t->version <= TRAJECTORY_VERSION);
}

/* What a file of ours lacks though its version promises it, or NULL. */
static const char *what_is_missing(const struct trajectory *t)
{
  const struct {
    hid_t object;
    const char *text;
  } promised[] = {{t->step, "its steps (position/step)"},
                  {t->time, "its times (position/time)"},
                  {t->checksum, "its checksums (parameters/uncross/checksum)"}};
  for (size_t k = 0; t->version >= 2 && k < sizeof promised / sizeof *promised; k++)
    if (promised[k].object < 0)
      return promised[k].text;
  return NULL;
}

static bool find_contents(struct trajectory *t)
{
  t->frames = UINT64_MAX;
  t->group = find_particles(t);
  t->position = t->group < 0 ? -1 : find_vectors(t, "position");
  if (t->position < 0)
    return false;
  t->velocity = find_vectors(t, "velocity");
  hid_t element = find_object(t, t->group, "position");
  t->step = find_series(t, element, "step", 1);
  t->time = find_series(t, element, "time", 1);
  hid_t box = find_object(t, t->group, "box"), edges = find_object(t, box, "edges");
  t->edges = find_series(t, edges, "value", 3);
  h5_close(edges);
  h5_close(box);
  h5_close(element);
  find_checksums(t);
  return !t->unread && is_known(t) && !what_is_missing(t);
}

bool trajectory_find(struct trajectory *t, struct message *message)
{
  if (find_contents(t))
    return true;
  if (t->unread)
    return h5_fail(message, t->path, "damaged, or its contents cannot be used");
  if (t->position < 0)
    return message_set(message, "%s: an HDF5 file without an H5MD trajectory (particles/trajectory/position/value)",
                       t->path);
  if (!is_known(t))
    return message_set(message, "%s: damaged, or of a later program: its version is %" PRId32 "; allowed: 1 to %d",
                       t->path, t->version, TRAJECTORY_VERSION);
  return message_set(message,
                     "%s: damaged: %s are missing, or of another shape; no trajectory of version 2 is read "
                     "without them",
                     t->path, what_is_missing(t));
}

int trajectory_read_scene(const struct trajectory *t, char **text)
{
  hid_t parameters = h5_open_group(t->file, "parameters"), own = h5_open_group(parameters, "uncross");
  const int found = own < 0 ? 0 : h5_look(own, "scene");
  *text = found > 0 ? h5_text_read(own, "scene") : NULL;
  h5_close(own);
  h5_close(parameters);
  return *text ? 1 : found == 0 ? 0 : -1;
}

/* --- rows of a frame --------------------------------------------------------------------------------------------- */

void frame_positions(const struct state *state, const struct model *model, const uint32_t *slot, double *row)
{
  for (uint32_t v = 0; v < state->vertices; v++, row += 3) {
    const struct vec3 r = point_in_a0(state->position[v]);
    memcpy(row, &r, sizeof r);
  }
  for (uint32_t id = 0; slot && id < state->solvent.n; id++, row += 3) {
    const struct vec3 r = point_in_a0(fluid_position_now(state, model, slot[id]));
    memcpy(row, &r, sizeof r);
  }
}

void frame_velocities(const struct state *state, const struct model *model, const uint32_t *slot, double *row)
{
  memcpy(row, state->velocity, state->vertices * sizeof *state->velocity);
  row += 3 * (size_t)state->vertices;
  for (uint32_t id = 0; slot && id < state->solvent.n; id++, row += 3) {
    const struct vec3 v = fluid_velocity_now(state, model, slot[id]);
    memcpy(row, &v, sizeof v);
  }
}

/* --- frames ------------------------------------------------------------------------------------------------------ */

uint64_t frame_sum_moment(uint64_t frame, int64_t step, double time)
{
  const struct {
    int64_t step;
    double time;
  } moment = {step, time};
  return XXH64(&moment, sizeof moment, frame);
}

uint64_t frame_sum_numbers(uint64_t frame, const double *number, size_t count)
{
  return XXH64(number, count * sizeof *number, frame);
}

bool trajectory_read_block(hid_t dataset, uint64_t frame, int rank, hid_t type, void *data)
{
  hsize_t count[3], start[3] = {frame};
  if (h5_shape(dataset, 3, count) != rank || frame >= count[0])
    return false;
  count[0] = 1;
  hid_t file_space = H5Dget_space(dataset), memory = H5Screate_simple(rank, count, NULL);
  bool ok = H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
            H5Dread(dataset, type, memory, file_space, H5P_DEFAULT, data) >= 0;
  h5_close(memory);
  h5_close(file_space);
  return ok;
}

/* One frame of positions or velocities: [3 particles]. */
static bool read_rows(const struct trajectory *t, hid_t dataset, uint64_t frame, double *rows)
{
  hsize_t dims[3];
  return h5_shape(dataset, 3, dims) == 3 && dims[1] == t->particles && dims[2] == 3 &&
         trajectory_read_block(dataset, frame, 3, H5T_NATIVE_DOUBLE, rows);
}

static bool read_moment(const struct trajectory *t, uint64_t frame, int64_t *step, double *time)
{
  *step = 0;
  *time = 0.0;
  return (t->step < 0 || trajectory_read_block(t->step, frame, 1, H5T_NATIVE_INT64, step)) &&
         (t->time < 0 || trajectory_read_block(t->time, frame, 1, H5T_NATIVE_DOUBLE, time));
}

/* H5MD allows edges as a vector or as a matrix, and for each frame or once. */
static bool read_edges(const struct trajectory *t, uint64_t frame, double *values, int *count)
{
  hsize_t dims[3];
  hid_t box = h5_open_group(t->group, "box"), edges = h5_open_object(box, "edges");
  const bool per_frame = edges >= 0 && H5Iget_type(edges) == H5I_GROUP;
  hid_t value = per_frame ? h5_open_dataset(edges, "value") : edges;
  const int rank = h5_shape(value, 3, dims), times = per_frame ? 1 : 0;
  bool ok = rank >= times + 1 && dims[rank - 1] == 3;
  *count = rank - times == 2 ? 9 : 3;
  ok = ok && (*count == 3 || dims[rank - 2] == 3) && rank == times + (*count == 9 ? 2 : 1);
  if (ok)
    ok = per_frame ? trajectory_read_block(value, frame, rank, H5T_NATIVE_DOUBLE, values)
                   : H5Dread(value, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  if (per_frame)
    h5_close(value);
  h5_close(edges);
  h5_close(box);
  H5Eclear2(H5E_DEFAULT);
  return ok;
}

/* False if there are no edges, or the box is not rectangular. */
static bool read_box(const struct trajectory *t, uint64_t frame, double edge[3])
{
  double values[9];
  int count;
  if (!read_edges(t, frame, values, &count))
    return false;
  bool rectangular = true;
  for (int k = 0; k < 3; k++) {
    edge[k] = count == 9 ? values[4 * k] : values[k];
    rectangular &= edge[k] > 0.0 && edge[k] <= MOST_EDGE;
  }
  for (int k = 0; count == 9 && k < 9; k++)
    rectangular &= k % 4 == 0 || values[k] == 0.0;
  return rectangular;
}

static bool odd_frame(const struct trajectory *t, uint64_t frame, int64_t step, const char *what,
                      struct message *message)
{
  return message_set(message, "%s: frame %" PRIu64 " (step %" PRId64 ") is damaged: %s", t->path, frame, step, what);
}

/* Names the first table that is not what was written. */
static bool fits_sums(const struct trajectory *t, uint64_t frame, const uint64_t found[FRAME_SUMS], int64_t step,
                      struct message *message)
{
  static const char *const wrong[FRAME_SUMS] = {
      [SUM_MOMENT] = "its step or time does not fit its checksum",
      [SUM_EDGES] = "its box (box/edges) does not fit its checksum",
      [SUM_POSITION] = "its positions (position/value) do not fit their checksum",
      [SUM_VELOCITY] = "its velocities (velocity/value) do not fit their checksum"};
  uint64_t stored[FRAME_SUMS];
  if (!trajectory_read_block(t->checksum, frame, 2, H5T_NATIVE_UINT64, stored))
    return odd_frame(t, frame, step, "its checksums cannot be read", message);
  for (int k = 0; k < FRAME_SUMS; k++)
    if (stored[k] != found[k])
      return odd_frame(t, frame, step, wrong[k], message);
  return true;
}

bool trajectory_load(const struct trajectory *t, uint64_t frame, uint64_t *step, double *time, double edge[3],
                     bool *has_box, double *position, double *velocity, struct message *message)
{
  const size_t numbers = 3 * (size_t)t->particles;
  int64_t number = 0;
  if (!read_moment(t, frame, &number, time))
    return odd_frame(t, frame, 0, "its step or time cannot be read", message);
  *step = (uint64_t)number;
  memset(edge, 0, 3 * sizeof *edge);
  *has_box = read_box(t, frame, edge);
  if (!read_rows(t, t->position, frame, position))
    return odd_frame(t, frame, number, "its positions (position/value) cannot be read", message);
  if (t->velocity >= 0 && !read_rows(t, t->velocity, frame, velocity))
    return odd_frame(t, frame, number, "its velocities (velocity/value) cannot be read", message);
  const uint64_t found[FRAME_SUMS] = {frame_sum_moment(frame, number, *time), frame_sum_numbers(frame, edge, 3),
                                      frame_sum_numbers(frame, position, numbers),
                                      t->velocity >= 0 ? frame_sum_numbers(frame, velocity, numbers) : 0};
  if (t->checksum >= 0 && !fits_sums(t, frame, found, number, message))
    return false;
  if (!foreign_unfold(t, frame, edge, position))
    return odd_frame(t, frame, number, "its images (image/value) cannot be read, or have no rectangular box", message);
  return (number >= 0 && isfinite(*time)) ||
         odd_frame(t, frame, number, "its step or time is no number that a step or time can be", message);
}
