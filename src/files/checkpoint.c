/* Checkpoints are read: their numbers, ranged, and their arrays. */
#include "files/checkpoint_parts.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/structure.h"
#include "system/sound.h"
#include "wall/account.h"

/* --- the numbers, listed once for writing and reading ------------------------------------------------------------ */

struct field {
  const char *group, *name;
  enum { U32, U64, I32, REAL } type;
  size_t count; /* 0: a scalar */
  size_t offset;
  double least, most; /* when read; a real number is finite in any case */
  bool late;          /* earlier checkpoints lack it: 0 */
};

#define AT(member) offsetof(struct checkpoint_summary, member)
#define ANY -HUGE_VAL, HUGE_VAL

static const struct field fields[] = {
    {"head", "fingerprint", U64, 0, AT(head.fingerprint), ANY, false},
    {"head", "seed", U64, 0, AT(head.seed), ANY, false},
    {"head", "stream", U64, 0, AT(head.stream.key), ANY, true},
    {"head", "stream_from", U32, 0, AT(head.stream.from), 0.0, STREAM_ASKED, true},
    {"head", "untold", U32, 0, AT(head.stream.untold), 0.0, UNTOLD_ALL, true},
    {"head", "parent_stream", U64, 0, AT(head.stream.parent), ANY, true},
    {"head", "parent_step", U64, 0, AT(head.stream.parent_step), ANY, true},
    {"head", "parent_state", U64, 0, AT(head.stream.parent_state), ANY, true},
    {"head", "state_hash", U64, 0, AT(head.state_hash), ANY, false},
    {"head", "state_digest", U64, 0, AT(head.state_digest), ANY, true},
    {"head", "wall_seconds", REAL, 0, AT(head.wall_seconds), 0.0, 1e12, false},
    {"head", "start_energy", REAL, 0, AT(head.start_energy), ANY, false},
    {"head", "start_momentum", REAL, 3, AT(head.start_momentum), ANY, false},
    {"head", "slide", U64, 0, AT(head.slide), 0.0, LATTICE_MAX_EDGE *LATTICE_PER_A0, true},
    {"structure", "cells", I32, 3, AT(cells), 1.0, LATTICE_MAX_EDGE, false},
    {"structure", "time_step", REAL, 0, AT(time_step), 1e-300, 1e300, false},
    {"structure", "acceleration", REAL, 3, AT(acceleration), ANY, false},
    {"structure", "particles", U32, 0, AT(particles), 0.0, INT32_MAX, false},
    {"structure", "vertices", U32, 0, AT(vertices), 0.0, INT32_MAX, false},
    {"structure", "dimensions", U32, 0, AT(dimensions), 0.0, 3.0, true},
    {"structure", "dumbbells", U32, 0, AT(dumbbells), 0.0, INT32_MAX, true},
};

static hid_t type_of(const struct field *field)
{
  const hid_t type[] = {
      [U32] = H5T_NATIVE_UINT32, [U64] = H5T_NATIVE_UINT64, [I32] = H5T_NATIVE_INT32, [REAL] = H5T_NATIVE_DOUBLE};
  return type[field->type];
}

bool checkpoint_fields(hid_t file, struct checkpoint_summary *summary, bool write)
{
  bool ok = true;
  for (size_t k = 0; ok && k < sizeof fields / sizeof *fields; k++) {
    const struct field *f = &fields[k];
    char *at = (char *)summary + f->offset;
    hid_t group = h5_open_group(file, f->group);
    const bool absent = !write && f->late && group >= 0 && H5Aexists(group, f->name) == 0;
    ok = group >= 0 && (absent  ? true
                        : write ? h5_put(group, f->name, type_of(f), f->count, at)
                                : h5_get(group, f->name, type_of(f), f->count, at));
    h5_close(group);
  }
  return ok;
}

/* Number k of a field, as a real one. */
static double value_of(const struct field *f, const struct checkpoint_summary *summary, size_t k)
{
  const char *at = (const char *)summary + f->offset;
  switch (f->type) {
  case U32:
    return ((const uint32_t *)(const void *)at)[k];
  case I32:
    return ((const int32_t *)(const void *)at)[k];
  case U64:
    return (double)((const uint64_t *)(const void *)at)[k];
  default:
    return ((const double *)(const void *)at)[k];
  }
}

#define MOST_COUNT ((uint64_t)1 << 62) /* of steps and counts, so that their differences are 64-bit numbers */

static bool in_range(const struct checkpoint_summary *summary, const char *path, struct message *message)
{
  for (size_t n = 0; n < sizeof fields / sizeof *fields; n++)
    for (size_t k = 0; k < (fields[n].count ? fields[n].count : 1); k++) {
      const struct field *f = &fields[n];
      const double value = value_of(f, summary, k);
      if (!isfinite(value) || value < f->least || value > f->most)
        return message_set(message, "%s: damaged checkpoint: %s/%s is %.17g; allowed: %.10g to %.10g", path, f->group,
                           f->name, value, f->least, f->most);
    }
  for (size_t k = 0; k < state_number_count; k++) {
    const struct state_number *n = &state_numbers[k];
    uint64_t value = 0;
    memcpy(&value, (const char *)&summary->numbers + n->offset, n->bytes);
    if (!n->wraps && value > MOST_COUNT)
      return message_set(message, "%s: damaged checkpoint: state/%s is %" PRIu64 "; allowed: at most %" PRIu64, path,
                         n->name, value, MOST_COUNT);
  }
  return true;
}

/* The state's numbers, from one to another. */
void checkpoint_take_numbers(struct state *state, const struct state *numbers)
{
  for (size_t k = 0; k < state_number_count; k++)
    memcpy((char *)state + state_numbers[k].offset, (const char *)numbers + state_numbers[k].offset,
           state_numbers[k].bytes);
}

/* The state's numbers, as state_numbers lists them, in the summary's copy of the state. */
bool checkpoint_numbers(hid_t group, struct state *numbers, bool write)
{
  bool ok = group >= 0;
  for (size_t k = 0; ok && k < state_number_count; k++) {
    const struct state_number *n = &state_numbers[k];
    const hid_t type = n->bytes == 8 ? H5T_NATIVE_UINT64 : H5T_NATIVE_UINT32;
    char *at = (char *)numbers + n->offset;
    if (!write && n->late && H5Aexists(group, n->name) == 0)
      memset(at, 0, n->bytes);
    else
      ok = write ? h5_put(group, n->name, type, 0, at) : h5_get(group, n->name, type, 0, at);
  }
  return ok;
}

bool checkpoint_has_group(const struct state_group *group)
{
  return group->rows > 0 || !group->optional;
}

hid_t checkpoint_field_type(const struct state_field *field)
{
  return field->integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
}

/* A block's name as that of a dataset, which may hold no slash. */
void checkpoint_block_name(const struct observe_block *block, char *name, size_t size)
{
  snprintf(name, size, "%s", block->name);
  for (char *c = name; *c; c++)
    if (*c == '/')
      *c = ':';
}

hid_t checkpoint_block_type(const struct observe_block *block)
{
  return block->integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE;
}

/* --- reading ----------------------------------------------------------------------------------------------------- */

bool checkpoint_is(hid_t file)
{
  char format[64];
  bool is = h5_get_text(file, "format", format, sizeof format) && strcmp(format, CHECKPOINT_FORMAT) == 0;
  H5Eclear2(H5E_DEFAULT);
  return is;
}

static bool read_numbers(hid_t file, struct checkpoint_summary *summary)
{
  hid_t group = h5_open_group(file, "state");
  const bool ok = checkpoint_numbers(group, &summary->numbers, false);
  summary->wall_rows = ok && h5_has(group, "wall_momentum") ? WALLS * ACCOUNT_SHARES : 0;
  summary->beads = ok && h5_has(group, "bead_position");
  h5_close(group);
  return ok;
}

/* Version 2 has a seal: without it something is cut off. */
static bool known_version(hid_t file, const char *path, bool sealed, int32_t *version, struct message *message)
{
  if (!h5_get(file, "format_version", H5T_NATIVE_INT32, 0, version))
    return h5_fail(message, path, "damaged or incomplete checkpoint");
  if (*version < 1 || *version > CHECKPOINT_VERSION)
    return message_set(message, "%s: checkpoint format %d; this program reads formats 1 to %d", path, *version,
                       CHECKPOINT_VERSION);
  return sealed || *version == 1 ||
         message_set(message, "%s: damaged checkpoint: its end with the seal is missing or changed", path);
}

static bool read_summary(hid_t file, const char *path, bool sealed, struct checkpoint_summary *summary,
                         struct message *message)
{
  memset(summary, 0, sizeof *summary);
  if (!checkpoint_is(file))
    return message_set(message, "%s: an HDF5 file, but not a checkpoint%s", path,
                       h5_has(file, "particles") ? ": it holds a trajectory" : "");
  if (!known_version(file, path, sealed, &summary->version, message))
    return false;
  hid_t head = h5_open_group(file, "head");
  bool ok = head >= 0 && h5_get_text(head, "version", summary->head.version, sizeof summary->head.version) &&
            checkpoint_fields(file, summary, false) && read_numbers(file, summary);
  if (ok) /* else 0: earlier checkpoints do not know it */
    h5_get(head, "frames_end", H5T_NATIVE_UINT64, 0, &summary->head.frames_end);
  if (summary->head.stream.from == STREAM_UNTOLD)
    summary->head.stream = stream_of_seed(summary->head.seed);
  h5_close(head);
  return ok ? in_range(summary, path, message) : h5_fail(message, path, "damaged or incomplete checkpoint");
}

struct model checkpoint_model(const struct checkpoint_summary *s)
{
  struct model model = {.box = box_of_cells(s->cells[0], s->cells[1], s->cells[2]),
                        .dimensions = s->dimensions,
                        .time_step = s->time_step};
  model.solvent.particles = s->particles;
  model.solvent.acceleration = s->acceleration;
  model.vertices = s->vertices;
  model.dumbbells.pairs = s->dumbbells;
  model.bead.radius = s->beads;
  if (s->wall_rows > 0)
    box_bound(&model.box, 1, BOUNDARY_WALL);
  return model;
}

/* Looks at the shapes of the arrays; nothing is allocated by a claimed number. */
static bool has_arrays(hid_t file, const struct checkpoint_summary *summary)
{
  const uint32_t claimed[STATE_GROUPS] = {summary->particles, summary->vertices, summary->dumbbells, summary->wall_rows,
                                          summary->beads};
  struct point nowhere;
  struct vec3 still;
  struct bead bead;
  const struct state none = {.position = &nowhere,
                             .velocity = &still,
                             .wall_momentum = &nowhere,
                             .bead = &bead}; /* only names are looked at */
  struct state_group rows[STATE_GROUPS];
  state_groups(&none, rows);
  hid_t group = h5_open_group(file, "state");
  bool ok = group >= 0;
  for (int g = 0; ok && g < STATE_GROUPS; g++)
    for (size_t f = 0; ok && f < rows[g].fields && !(rows[g].optional && claimed[g] == 0); f++) {
      const hsize_t dims[2] = {claimed[g], 3};
      ok = h5_array_is(group, rows[g].field[f].name, 2, dims);
    }
  h5_close(group);
  return ok;
}

bool checkpoint_find(hid_t file, const char *path, bool sealed, struct checkpoint_summary *summary,
                     struct message *message)
{
  if (!read_summary(file, path, sealed, summary, message))
    return false;
  return has_arrays(file, summary) ||
         h5_fail(message, path, "damaged checkpoint: its positions or velocities are not as many as it says");
}

/* --- the state --------------------------------------------------------------------------------------------------- */

static bool no_array(const char *path, struct message *message)
{
  return h5_fail(message, path, "damaged checkpoint: its positions or velocities cannot be read or fail their check");
}

bool checkpoint_each_array(struct state *state, checkpoint_rows *read, void *from, const char *path,
                           struct message *message)
{
  struct state_group group[STATE_GROUPS];
  state_groups(state, group);
  bool ok = true;
  for (int g = 0; ok && g < STATE_GROUPS; g++)
    for (size_t f = 0; ok && f < group[g].fields && checkpoint_has_group(&group[g]); f++) {
      void *rows = malloc(((size_t)group[g].rows + 1) * 24);
      ok = rows ? read(from, &group[g], &group[g].field[f], rows, message)
                : message_no_memory(message, "%s: out of memory", path);
      if (ok)
        state_field_set(&group[g], &group[g].field[f], rows);
      free(rows);
    }
  return ok;
}

bool checkpoint_rows_of_file(void *from, const struct state_group *group, const struct state_field *field, void *rows,
                             struct message *message)
{
  const struct checkpoint_arrays *file = from;
  const hsize_t dims[2] = {group->rows, 3};
  return h5_array_read(file->group, field->name, checkpoint_field_type(field), 2, dims, rows) ||
         no_array(file->path, message);
}

bool checkpoint_check(const struct state *state, const struct checkpoint_summary *summary, int32_t *next,
                      const char *path, struct message *message)
{
  struct model then = checkpoint_model(summary);
  then.next = next;
  if (then.box.boundary[1] == BOUNDARY_PERIODIC) /* a file does not say whether images slide: vectors may lead to any */
    box_bound(&then.box, 1, BOUNDARY_SHEAR);
  struct fault fault = {.code = FAULT_NONE};
  char why[512];
  const uint64_t hash = state_hash(state);
  if (hash == 0 && summary->head.state_hash != 0)
    return message_no_memory(message, "%s: out of memory", path);
  if (hash != summary->head.state_hash)
    return message_set(message, "%s: damaged checkpoint: its state has hash %016llx, it should be %016llx", path,
                       (unsigned long long)hash, (unsigned long long)summary->head.state_hash);
  const uint64_t digest = state_digest(state);
  if (summary->head.state_digest != 0 && digest != summary->head.state_digest)
    return message_set(message, "%s: damaged checkpoint: its state has digest %016llx, it should be %016llx", path,
                       (unsigned long long)digest, (unsigned long long)summary->head.state_digest);
  if (state_sound(state, &then, &fault))
    return true;
  fault_describe(&fault, why, sizeof why);
  return message_set(message, "%s: no run goes on from this state: %s", path, why);
}

bool checkpoint_read_state(hid_t file, const char *path, const struct checkpoint_summary *summary, struct state *state,
                           struct message *message)
{
  struct checkpoint_arrays from = {h5_open_group(file, "state"), path};
  const bool ok = from.group >= 0 ? checkpoint_each_array(state, checkpoint_rows_of_file, &from, path, message)
                                  : no_array(path, message);
  h5_close(from.group);
  if (!ok)
    return false;
  checkpoint_take_numbers(state, &summary->numbers);
  return checkpoint_check(state, summary, NULL, path, message);
}
