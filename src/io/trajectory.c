/* Trajectories are opened, closed and read. */
#include "io/trajectory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- opening and closing ----------------------------------------------------------------------------------------- */

struct trajectory *trajectory_allocate(const char *path)
{
  struct trajectory *t = calloc(1, sizeof *t);
  if (!t)
    return NULL;
  t->file = t->group = t->position = t->velocity = t->edges = t->step = t->time = -1;
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
  const hid_t handles[] = {t->position, t->velocity, t->edges, t->step, t->time, t->group, t->file};
  bool ok = true;
  for (size_t k = 0; k < sizeof handles / sizeof *handles; k++)
    ok &= h5_close(handles[k]);
  if (!ok)
    h5_fail(message, t->path, "not closed properly, its last frames may be lost");
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
  hid_t object = found > 0 ? H5Oopen(parent, name, H5P_DEFAULT) : -1;
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
  return !t->unread;
}

struct trajectory *trajectory_open_existing(const char *path, bool writable, enum h5_trouble *trouble,
                                            struct message *message)
{
  struct trajectory *t = trajectory_allocate(path);
  *trouble = H5_UNREADABLE;
  if (!t) {
    message_set(message, "%s: out of memory", path);
    return NULL;
  }
  t->file = h5_open(path, writable, trouble, message);
  if (t->file < 0)
    return trajectory_give_up(t);
  if (!find_contents(t)) {
    *trouble = H5_DAMAGED;
    if (t->unread)
      h5_fail(message, path, "damaged, its contents cannot be read");
    else
      message_set(message, "%s: an HDF5 file without an H5MD trajectory (particles/trajectory/position/value)", path);
    return trajectory_give_up(t);
  }
  return t;
}

/* --- reading ----------------------------------------------------------------------------------------------------- */

struct trajectory *trajectory_open_read(const char *path, struct message *message)
{
  enum h5_trouble trouble;
  struct trajectory *t = trajectory_open_existing(path, false, &trouble, message);
  if (t && (t->row = malloc(((size_t)t->particles + 1) * 3 * sizeof *t->row)) == NULL) {
    message_set(message, "%s: out of memory", path);
    return trajectory_give_up(t);
  }
  return t;
}

uint64_t trajectory_frames(const struct trajectory *t)
{
  return t->frames;
}

bool trajectory_has_steps(const struct trajectory *t)
{
  return t->step >= 0;
}

bool trajectory_has_velocities(const struct trajectory *t)
{
  return t->velocity >= 0;
}

bool trajectory_has_solvent(const struct trajectory *t, const struct model *model)
{
  return model_has_solvent(model) && t->particles == model->vertices + model->solvent.particles;
}

char *trajectory_scene_text(const struct trajectory *t)
{
  hid_t parameters = h5_open_group(t->file, "parameters"), own = h5_open_group(parameters, "uncross");
  char *text = own < 0 ? NULL : h5_text_read(own, "scene");
  h5_close(own);
  h5_close(parameters);
  return text;
}

static bool read_block(hid_t dataset, uint64_t frame, int rank, hid_t type, void *data)
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

bool trajectory_rows(const struct trajectory *t, hid_t dataset, uint64_t frame, double *rows)
{
  hsize_t dims[3];
  return h5_shape(dataset, 3, dims) == 3 && dims[1] == t->particles &&
         read_block(dataset, frame, 3, H5T_NATIVE_DOUBLE, rows);
}

bool trajectory_moment(const struct trajectory *t, uint64_t frame, uint64_t *step, double *time)
{
  int64_t number = 0;
  *time = 0.0;
  bool ok = (t->step < 0 || read_block(t->step, frame, 1, H5T_NATIVE_INT64, &number)) &&
            (t->time < 0 || read_block(t->time, frame, 1, H5T_NATIVE_DOUBLE, time));
  *step = (uint64_t)number;
  return ok && number >= 0;
}

/* H5MD allows edges as a vector or as a matrix, and for each frame or once. */
static bool read_edges(const struct trajectory *t, uint64_t frame, double *values, int *count)
{
  hsize_t dims[3];
  hid_t box = h5_open_group(t->group, "box");
  bool per_frame = box >= 0 && H5Oexists_by_name(box, "edges/value", H5P_DEFAULT) > 0;
  hid_t edges = box < 0 ? -1 : H5Dopen2(box, per_frame ? "edges/value" : "edges", H5P_DEFAULT);
  int rank = h5_shape(edges, 3, dims);
  bool ok = rank >= (per_frame ? 2 : 1) && dims[rank - 1] == 3;
  *count = rank - (per_frame ? 1 : 0) == 2 ? 9 : 3;
  ok = ok && (*count == 3 || dims[rank - 2] == 3) && rank == (per_frame ? 1 : 0) + (*count == 9 ? 2 : 1);
  if (ok)
    ok = per_frame ? read_block(edges, frame, rank, H5T_NATIVE_DOUBLE, values)
                   : H5Dread(edges, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
  h5_close(edges);
  h5_close(box);
  H5Eclear2(H5E_DEFAULT);
  return ok;
}

bool trajectory_edges(const struct trajectory *t, uint64_t frame, double edge[3])
{
  double values[9];
  int count;
  if (!read_edges(t, frame, values, &count))
    return false;
  bool rectangular = true;
  for (int k = 0; k < 3; k++)
    edge[k] = count == 9 ? values[4 * k] : values[k];
  for (int k = 0; count == 9 && k < 9; k++)
    rectangular &= k % 4 == 0 || values[k] == 0.0;
  return rectangular;
}

static bool fits_model(const struct trajectory *t, const struct model *m, uint64_t frame, struct message *message)
{
  double edge[3];
  if (frame >= t->frames)
    return message_set(message, "%s: frame %llu asked for; it has %llu", t->path, (unsigned long long)frame,
                       (unsigned long long)t->frames);
  if (t->particles != m->vertices && !trajectory_has_solvent(t, m))
    return message_set(message, "%s: its frames hold %u particles; the scene has %u vertices and %u solvent particles",
                       t->path, t->particles, m->vertices, m->solvent.particles);
  if (!trajectory_edges(t, frame, edge))
    return message_set(message, "%s: its box (box/edges) cannot be read or is not rectangular", t->path);
  for (int k = 0; k < 3; k++)
    if (edge[k] != m->box.cells[k])
      return message_set(message, "%s: its box has edges %.17g, %.17g, %.17g; the scene %d, %d, %d", t->path, edge[0],
                         edge[1], edge[2], m->box.cells[0], m->box.cells[1], m->box.cells[2]);
  return true;
}

/* Numbers of a frame must be finite and below the limit. */
static bool sound(const struct trajectory *t, const char *what, uint64_t frame, double limit, struct message *message)
{
  for (size_t k = 0; k < 3 * (size_t)t->particles; k++)
    if (!(fabs(t->row[k]) < limit))
      return message_set(message, "%s: frame %llu: %s of particle %zu is %g; allowed are finite numbers below %g",
                         t->path, (unsigned long long)frame, what, k / 3, t->row[k], limit);
  return true;
}

/* llrint instead of lattice_round: the latter ends at 2048 a0. */
static int64_t to_lattice(double x)
{
  return llrint(x * LATTICE_PER_A0);
}

static void take_positions(const struct trajectory *t, const struct model *m, struct state *state)
{
  const double *row = t->row;
  struct solvent *p = &state->solvent;
  for (uint32_t v = 0; v < state->vertices; v++, row += 3)
    state->position[v] = (struct point){to_lattice(row[0]), to_lattice(row[1]), to_lattice(row[2])};
  if (!trajectory_has_solvent(t, m))
    return;
  for (uint32_t i = 0; i < p->n; i++, row += 3) {
    p->id[i] = i;
    p->x[i] = lattice_fold(to_lattice(row[0]), m->box.edge[0]);
    p->y[i] = lattice_fold(to_lattice(row[1]), m->box.edge[1]);
    p->z[i] = lattice_fold(to_lattice(row[2]), m->box.edge[2]);
  }
}

static void take_velocities(const struct trajectory *t, const struct model *m, struct state *state)
{
  const double *row = t->row;
  memcpy(state->velocity, row, (size_t)state->vertices * sizeof *state->velocity);
  row += 3 * (size_t)state->vertices;
  for (uint32_t i = 0; trajectory_has_solvent(t, m) && i < state->solvent.n; i++, row += 3) {
    state->solvent.vx[i] = row[0];
    state->solvent.vy[i] = row[1];
    state->solvent.vz[i] = row[2];
  }
}

bool trajectory_read(struct trajectory *t, const struct model *model, uint64_t frame, struct state *state,
                     struct message *message)
{
  double time;
  if (!fits_model(t, model, frame, message))
    return false;
  if (!trajectory_moment(t, frame, &state->step, &time) || !trajectory_rows(t, t->position, frame, t->row))
    return h5_fail(message, t->path, "a frame cannot be read");
  if (!sound(t, "a position", frame, TRAJECTORY_LIMIT, message))
    return false;
  take_positions(t, model, state);
  state->solvent_lag = 0;
  if (t->velocity < 0)
    return true;
  if (!trajectory_rows(t, t->velocity, frame, t->row))
    return h5_fail(message, t->path, "a frame cannot be read");
  if (!sound(t, "a velocity", frame, HUGE_VAL, message))
    return false;
  take_velocities(t, model, state);
  return true;
}
