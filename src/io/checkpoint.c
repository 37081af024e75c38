#include "io/checkpoint.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/folder.h"
#include "io/structure.h"

/* --- the numbers, listed once for writing and reading ------------------------------------------------------------ */

struct field {
  const char *group, *name;
  enum { U32, U64, I32, REAL } type;
  size_t count; /* 0: a scalar */
  size_t offset;
};

#define AT(member) offsetof(struct checkpoint_summary, member)

static const struct field fields[] = {
    {"head", "fingerprint", U64, 0, AT(head.fingerprint)},
    {"head", "seed", U64, 0, AT(head.seed)},
    {"head", "state_hash", U64, 0, AT(head.state_hash)},
    {"head", "wall_seconds", REAL, 0, AT(head.wall_seconds)},
    {"head", "start_energy", REAL, 0, AT(head.start_energy)},
    {"head", "start_momentum", REAL, 3, AT(head.start_momentum)},
    {"structure", "cells", I32, 3, AT(cells)},
    {"structure", "time_step", REAL, 0, AT(time_step)},
    {"structure", "acceleration", REAL, 3, AT(acceleration)},
    {"structure", "particles", U32, 0, AT(particles)},
    {"structure", "vertices", U32, 0, AT(vertices)},
    {"state", "step", U64, 0, AT(step)},
    {"state", "solvent_lag", U32, 0, AT(solvent_lag)},
    {"state", "moves", U64, 0, AT(counts.moves)},
    {"state", "possible", U64, 0, AT(counts.possible)},
    {"state", "executed", U64, 0, AT(counts.executed)},
    {"state", "negative", U64, 0, AT(counts.negative)},
};

static hid_t type_of(const struct field *field)
{
  const hid_t type[] = {
      [U32] = H5T_NATIVE_UINT32, [U64] = H5T_NATIVE_UINT64, [I32] = H5T_NATIVE_INT32, [REAL] = H5T_NATIVE_DOUBLE};
  return type[field->type];
}

static bool each_field(hid_t file, struct checkpoint_summary *summary, bool write)
{
  bool ok = true;
  for (size_t k = 0; ok && k < sizeof fields / sizeof *fields; k++) {
    const struct field *f = &fields[k];
    char *at = (char *)summary + f->offset;
    hid_t group = h5_open_group(file, f->group);
    ok = group >= 0 &&
         (write ? h5_put(group, f->name, type_of(f), f->count, at) : h5_get(group, f->name, type_of(f), f->count, at));
    h5_close(group);
  }
  return ok;
}

/* --- writing ----------------------------------------------------------------------------------------------------- */

static bool write_rows(hid_t group, const char *name, hid_t type, uint32_t rows, const void *data)
{
  const hsize_t dims[2] = {rows, 3};
  return h5_array_write(group, name, type, 2, dims, data);
}

/* The solvent in id order: the same bytes whatever the order in memory. */
static bool write_solvent(hid_t group, const struct state *state)
{
  const struct solvent *p = &state->solvent;
  uint32_t *slot = malloc(((size_t)p->n + 1) * sizeof *slot);
  int64_t(*x)[3] = malloc(((size_t)p->n + 1) * sizeof *x);
  double(*v)[3] = malloc(((size_t)p->n + 1) * sizeof *v);
  bool ok = slot && x && v;
  if (ok) {
    state_solvent_slots(state, slot);
    for (uint32_t id = 0; id < p->n; id++) {
      uint32_t i = slot[id];
      x[id][0] = p->x[i], x[id][1] = p->y[i], x[id][2] = p->z[i];
      v[id][0] = p->vx[i], v[id][1] = p->vy[i], v[id][2] = p->vz[i];
    }
    ok = write_rows(group, "solvent_position", H5T_NATIVE_INT64, p->n, x) &&
         write_rows(group, "solvent_velocity", H5T_NATIVE_DOUBLE, p->n, v);
  }
  free(slot);
  free(x);
  free(v);
  return ok;
}

static bool write_state(hid_t group, const struct state *state)
{
  return write_solvent(group, state) &&
         write_rows(group, "vertex_position", H5T_NATIVE_INT64, state->vertices, state->position) &&
         write_rows(group, "vertex_velocity", H5T_NATIVE_DOUBLE, state->vertices, state->velocity);
}

/* A block's name as that of a dataset, which may hold no slash. */
static void block_name(const struct observe_block *block, char *name, size_t size)
{
  snprintf(name, size, "%s", block->name);
  for (char *c = name; *c; c++)
    if (*c == '/')
      *c = ':';
}

static hid_t block_type(const struct observe_block *block)
{
  return block->integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
}

static bool write_blocks(hid_t group, const struct observe_block *blocks, size_t count)
{
  bool ok = true;
  for (size_t b = 0; ok && b < count; b++) {
    char name[256];
    const hsize_t dims[1] = {blocks[b].count};
    const int64_t nothing = 0;
    block_name(&blocks[b], name, sizeof name);
    ok = h5_array_write(group, name, block_type(&blocks[b]), 1, dims, blocks[b].data ? blocks[b].data : &nothing);
  }
  return ok;
}

struct contents {
  struct checkpoint_summary summary;
  const struct model *model;
  const struct state *state;
  const struct observe_block *blocks;
  size_t block_count;
  const char *scene_text;
};

static bool write_contents(hid_t file, struct contents *c)
{
  const int32_t version = CHECKPOINT_VERSION;
  hid_t head = h5_group(file, "head"), structure = h5_group(file, "structure");
  hid_t state = h5_group(file, "state"), observers = h5_group(file, "observers");
  bool ok = h5_put_text(file, "format", CHECKPOINT_FORMAT) &&
            h5_put(file, "format_version", H5T_NATIVE_INT32, 0, &version) &&
            h5_put_text(head, "version", c->summary.head.version) && each_field(file, &c->summary, true) &&
            h5_put(head, "frames_end", H5T_NATIVE_UINT64, 0, &c->summary.head.frames_end) &&
            structure_write_particles(structure, c->model, false) && structure_write_bonds(structure, c->model) &&
            write_state(state, c->state) && write_blocks(observers, c->blocks, c->block_count) &&
            h5_text_write(file, "scene", c->scene_text ? c->scene_text : "");
  h5_close(head);
  h5_close(structure);
  h5_close(state);
  h5_close(observers);
  return ok;
}

static struct checkpoint_summary summary_of(const struct checkpoint_head *head, const struct model *model,
                                            const struct state *state)
{
  struct checkpoint_summary s = {.head = *head,
                                 .time_step = model->time_step,
                                 .acceleration = model->solvent.acceleration,
                                 .step = state->step,
                                 .solvent_lag = state->solvent_lag,
                                 .particles = state->solvent.n,
                                 .vertices = state->vertices,
                                 .counts = state->counts};
  s.head.version[sizeof s.head.version - 1] = '\0';
  memcpy(s.cells, model->box.cells, sizeof s.cells);
  return s;
}

/* The whole file as bytes: it is made in memory, so that every error of the disk is met in file_replace. */
static void *make_image(struct contents *c, size_t *bytes, const char *path, struct message *message)
{
  size_t estimate = ((size_t)c->state->solvent.n + c->state->vertices) * 64;
  for (size_t b = 0; b < c->block_count; b++)
    estimate += c->blocks[b].count * sizeof(double) + 1024;
  hid_t file = h5_create_in_memory(estimate);
  void *image = file >= 0 && write_contents(file, c) ? h5_image(file, bytes) : NULL;
  if (!image)
    h5_fail(message, path, "the checkpoint could not be put together (memory?)");
  h5_close(file);
  return image;
}

bool checkpoint_write(const char *path, struct checkpoint_head *head, const struct model *model,
                      const struct state *state, const struct observe_block *blocks, size_t block_count,
                      const char *scene_text, struct message *message)
{
  head->state_hash = state_hash(state);
  struct contents contents = {summary_of(head, model, state), model, state, blocks, block_count, scene_text};
  size_t bytes;
  if (head->state_hash == 0)
    return message_set(message, "%s: checkpoint not written: no memory; an earlier one is untouched", path);
  void *image = make_image(&contents, &bytes, path, message);
  bool ok = image && file_replace(path, image, bytes, message);
  free(image);
  return ok;
}

/* --- reading ----------------------------------------------------------------------------------------------------- */

bool checkpoint_is(hid_t file)
{
  char format[64];
  bool is = h5_get_text(file, "format", format, sizeof format) && strcmp(format, CHECKPOINT_FORMAT) == 0;
  H5Eclear2(H5E_DEFAULT);
  return is;
}

static bool read_summary(hid_t file, const char *path, struct checkpoint_summary *summary, struct message *message)
{
  int32_t version = 0;
  memset(summary, 0, sizeof *summary);
  if (!checkpoint_is(file))
    return message_set(message, "%s: an HDF5 file, but not a checkpoint%s", path,
                       h5_has(file, "particles") ? ": it holds a trajectory" : "");
  if (!h5_get(file, "format_version", H5T_NATIVE_INT32, 0, &version) || version != CHECKPOINT_VERSION)
    return message_set(message, "%s: checkpoint format %d; this program reads format %d", path, version,
                       CHECKPOINT_VERSION);
  hid_t head = h5_open_group(file, "head");
  bool ok = head >= 0 && h5_get_text(head, "version", summary->head.version, sizeof summary->head.version) &&
            each_field(file, summary, false);
  if (ok) /* else 0: earlier checkpoints do not know it */
    h5_get(head, "frames_end", H5T_NATIVE_UINT64, 0, &summary->head.frames_end);
  h5_close(head);
  if (!ok)
    h5_fail(message, path, "damaged or incomplete checkpoint");
  return ok;
}

hid_t checkpoint_open(const char *path, struct checkpoint_summary *summary, struct message *message)
{
  enum h5_trouble trouble;
  hid_t file = h5_open(path, false, &trouble, message);
  if (file >= 0 && !read_summary(file, path, summary, message)) {
    h5_close(file);
    return -1;
  }
  return file;
}

static bool read_rows(hid_t group, const char *name, hid_t type, uint32_t rows, void *data)
{
  const hsize_t dims[2] = {rows, 3};
  return h5_array_read(group, name, type, 2, dims, data);
}

static bool read_solvent(hid_t group, struct solvent *p)
{
  int64_t(*x)[3] = malloc(((size_t)p->n + 1) * sizeof *x);
  double(*v)[3] = malloc(((size_t)p->n + 1) * sizeof *v);
  bool ok = x && v && read_rows(group, "solvent_position", H5T_NATIVE_INT64, p->n, x) &&
            read_rows(group, "solvent_velocity", H5T_NATIVE_DOUBLE, p->n, v);
  for (uint32_t i = 0; ok && i < p->n; i++) {
    p->id[i] = i;
    p->x[i] = x[i][0], p->y[i] = x[i][1], p->z[i] = x[i][2];
    p->vx[i] = v[i][0], p->vy[i] = v[i][1], p->vz[i] = v[i][2];
  }
  free(x);
  free(v);
  return ok;
}

bool checkpoint_read_state(hid_t file, const char *path, const struct checkpoint_summary *summary, struct state *state,
                           struct message *message)
{
  hid_t group = h5_open_group(file, "state");
  bool ok = group >= 0 && read_solvent(group, &state->solvent) &&
            read_rows(group, "vertex_position", H5T_NATIVE_INT64, state->vertices, state->position) &&
            read_rows(group, "vertex_velocity", H5T_NATIVE_DOUBLE, state->vertices, state->velocity);
  h5_close(group);
  if (!ok)
    return h5_fail(message, path, "damaged checkpoint: its positions or velocities cannot be read or fail their check");
  state->step = summary->step;
  state->solvent_lag = summary->solvent_lag;
  state->counts = summary->counts;
  uint64_t hash = state_hash(state);
  if (hash != summary->head.state_hash)
    return message_set(message, "%s: damaged checkpoint: its state has hash %016llx, it should be %016llx", path,
                       (unsigned long long)hash, (unsigned long long)summary->head.state_hash);
  return true;
}

static bool fits_model(hid_t file, const char *path, const struct checkpoint_summary *s, const struct model *m,
                       struct message *message)
{
  const int *cells = m->box.cells;
  if (memcmp(s->cells, cells, sizeof s->cells) != 0)
    return message_set(message, "%s: its box is %d x %d x %d cells, the scene's %d x %d x %d", path, s->cells[0],
                       s->cells[1], s->cells[2], cells[0], cells[1], cells[2]);
  if (s->particles != m->solvent.particles)
    return message_set(message, "%s: it holds %u solvent particles, the scene %u", path, s->particles,
                       m->solvent.particles);
  if (s->vertices != m->vertices)
    return message_set(message, "%s: it holds %u fiber vertices, the scene %u", path, s->vertices, m->vertices);
  hid_t group = h5_open_group(file, "structure");
  bool same = group >= 0 && structure_same_bonds(group, m);
  h5_close(group);
  if (!same)
    return message_set(message, "%s: its bonds are not the scene's (other fibers, or a damaged file)", path);
  return true;
}

static bool within_reach(const struct state *state, const char *path, struct message *message)
{
  const uint32_t lost = state_lost_vertex(state);
  return lost == state->vertices || message_set(message, "%s: vertex %u is more than %g a0 from the origin, unwrapped",
                                                path, lost, (double)LATTICE_REACH * LATTICE_UNIT);
}

hid_t checkpoint_open_for(const char *path, const struct model *model, struct checkpoint_summary *summary,
                          struct state *state, struct message *message)
{
  hid_t file = checkpoint_open(path, summary, message);
  if (file >= 0 &&
      !(fits_model(file, path, summary, model, message) && checkpoint_read_state(file, path, summary, state, message) &&
        within_reach(state, path, message))) {
    h5_close(file);
    return -1;
  }
  return file;
}

/* Earlier checkpoints hold no settings; they are taken to be the scene's. */
static bool same_setting(hid_t group, const char *name, const char *path, const struct observe_block *block,
                         struct message *message)
{
  const hsize_t dims[1] = {1};
  const int64_t wanted = *(const int64_t *)block->data;
  int64_t stored = wanted;
  if (group >= 0 && h5_has(group, name) && !h5_array_read(group, name, H5T_NATIVE_INT64, 1, dims, &stored))
    return message_set(message, "%s: damaged checkpoint: '%s' cannot be read", path, name);
  return stored == wanted ||
         message_set(message,
                     "observe.%s: %" PRId64 " in the scene, but %" PRId64 " in the run so far (%s), whose averages go "
                     "on; a resumed run keeps it",
                     name, wanted, stored, path);
}

static bool read_blocks(hid_t file, const char *path, const struct observe_block *blocks, size_t count,
                        struct message *message)
{
  hid_t group = h5_open_group(file, "observers");
  bool ok = true;
  for (size_t b = 0; ok && b < count; b++) {
    char name[256];
    int64_t nothing;
    const hsize_t dims[1] = {blocks[b].count};
    block_name(&blocks[b], name, sizeof name);
    if (blocks[b].setting) {
      ok = same_setting(group, name, path, &blocks[b], message);
      continue;
    }
    ok = group >= 0 && h5_has(group, name) &&
         h5_array_read(group, name, block_type(&blocks[b]), 1, dims, blocks[b].data ? blocks[b].data : &nothing);
    if (!ok)
      message_set(
          message,
          "%s: no memory of the observable '%s' in this size (damaged, or not sampled by this run so far: resume "
          "without it, or begin a run from this checkpoint with start.snapshot)",
          path, blocks[b].name);
  }
  h5_close(group);
  return ok;
}

bool checkpoint_read(const char *path, const struct model *model, struct checkpoint_head *head, struct state *state,
                     const struct observe_block *blocks, size_t block_count, struct message *message)
{
  struct checkpoint_summary summary;
  hid_t file = checkpoint_open_for(path, model, &summary, state, message);
  if (file < 0)
    return false;
  bool ok = read_blocks(file, path, blocks, block_count, message);
  h5_close(file);
  *head = summary.head;
  return ok;
}
