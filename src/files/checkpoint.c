/* Checkpoints are read: their numbers, ranged, and their arrays. Their numbers are listed here for writing, too. */
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

#define FIELDS (sizeof fields / sizeof *fields)

bool checkpoint_put_fields(hid_t file, const struct checkpoint_summary *summary)
{
  const hid_t type[] = {
      [U32] = H5T_NATIVE_UINT32, [U64] = H5T_NATIVE_UINT64, [I32] = H5T_NATIVE_INT32, [REAL] = H5T_NATIVE_DOUBLE};
  bool ok = true;
  for (size_t k = 0; ok && k < FIELDS; k++) {
    const struct field *f = &fields[k];
    hid_t group = h5_open_group(file, f->group);
    ok = group >= 0 && h5_put(group, f->name, type[f->type], f->count, (const char *)summary + f->offset);
    h5_close(group);
  }
  return ok;
}

/* An attribute of a group; `late`: 0 where there is none. */
static bool get(struct far *far, const char *group, const char *name, bool late, enum far_type type, size_t count,
                void *at)
{
  const int found = far_get(far, "", group, name, type, count, at);
  return found > 0 || (found == 0 && late);
}

static bool get_fields(struct far *far, struct checkpoint_summary *summary)
{
  static const enum far_type type[] = {
      [U32] = FAR_SHORT_COUNT, [U64] = FAR_COUNT, [I32] = FAR_SHORT, [REAL] = FAR_REAL};
  bool ok = true;
  for (size_t k = 0; ok && k < FIELDS; k++) {
    const struct field *f = &fields[k];
    ok = get(far, f->group, f->name, f->late, type[f->type], f->count, (char *)summary + f->offset);
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
  for (size_t n = 0; n < FIELDS; n++)
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

bool checkpoint_put_numbers(hid_t group, const struct state *numbers)
{
  bool ok = group >= 0;
  for (size_t k = 0; ok && k < state_number_count; k++) {
    const struct state_number *n = &state_numbers[k];
    ok = h5_put(group, n->name, n->bytes == 8 ? H5T_NATIVE_UINT64 : H5T_NATIVE_UINT32, 0,
                (const char *)numbers + n->offset);
  }
  return ok;
}

/* The state's numbers, as state_numbers lists them, into the summary's copy of the state. */
static bool get_numbers(struct far *far, struct checkpoint_summary *summary)
{
  bool ok = true;
  for (size_t k = 0; ok && k < state_number_count; k++) {
    const struct state_number *n = &state_numbers[k];
    ok = get(far, "state", n->name, n->late, n->bytes == 8 ? FAR_COUNT : FAR_SHORT_COUNT, 0,
             (char *)&summary->numbers + n->offset);
  }
  summary->wall_rows = ok && far_has(far, "state", "wall_momentum") ? WALLS * ACCOUNT_SHARES : 0;
  summary->beads = ok && far_has(far, "state", "bead_position");
  return ok;
}

bool checkpoint_has_group(const struct state_group *group)
{
  return group->rows > 0 || !group->optional;
}

/* A block's name as that of a dataset, which may hold no slash. */
void checkpoint_block_name(const struct observe_block *block, char *name, size_t size)
{
  snprintf(name, size, "%s", block->name);
  for (char *c = name; *c; c++)
    if (*c == '/')
      *c = ':';
}

/* --- reading ----------------------------------------------------------------------------------------------------- */

bool checkpoint_is(struct far *far)
{
  char format[64];
  return far_get_text(far, "", "", "format", 0, format, sizeof format) > 0 && strcmp(format, CHECKPOINT_FORMAT) == 0;
}

/* Version 2 has a seal: without it something is cut off. */
static bool known_version(struct far *far, int32_t *version, struct message *message)
{
  const char *path = far->apart.path;
  if (far_get(far, "", "", "format_version", FAR_SHORT, 0, version) <= 0)
    return far_fail(far, message, "damaged or incomplete checkpoint");
  if (*version < 1 || *version > CHECKPOINT_VERSION)
    return message_set(message, "%s: checkpoint format %d; this program reads formats 1 to %d", path, *version,
                       CHECKPOINT_VERSION);
  return far->sealed || *version == 1 ||
         message_set(message, "%s: damaged checkpoint: its end with the seal is missing or changed", path);
}

static bool read_summary(struct far *far, struct checkpoint_summary *summary, struct message *message)
{
  struct checkpoint_head *head = &summary->head;
  memset(summary, 0, sizeof *summary);
  if (!checkpoint_is(far))
    return message_set(message, "%s: an HDF5 file, but not a checkpoint%s", far->apart.path,
                       far_has(far, "", "particles") ? ": it holds a trajectory" : "");
  if (!known_version(far, &summary->version, message))
    return false;
  if (far_get_text(far, "", "head", "version", 0, head->version, sizeof head->version) <= 0 ||
      !get_fields(far, summary) || !get_numbers(far, summary))
    return far_fail(far, message, "damaged or incomplete checkpoint");
  get(far, "head", "frames_end", true, FAR_COUNT, 0, &head->frames_end); /* earlier checkpoints do not know it */
  if (head->stream.from == STREAM_UNTOLD)
    head->stream = stream_of_seed(head->seed);
  return in_range(summary, far->apart.path, message);
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
static bool has_arrays(struct far *far, const struct checkpoint_summary *summary)
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
  bool ok = true;
  for (int g = 0; ok && g < STATE_GROUPS; g++)
    for (size_t f = 0; ok && f < rows[g].fields && !(rows[g].optional && claimed[g] == 0); f++) {
      const struct far_thing thing = far_look(far, "state", rows[g].field[f].name);
      ok = far_is(&thing, 2) && thing.dims[0] == claimed[g] && thing.dims[1] == 3;
    }
  return ok;
}

bool checkpoint_find(struct far *far, struct checkpoint_summary *summary, struct message *message)
{
  if (!read_summary(far, summary, message))
    return false;
  return has_arrays(far, summary) ||
         far_fail(far, message, "damaged checkpoint: its positions or velocities are not as many as it says");
}

/* --- the state --------------------------------------------------------------------------------------------------- */

static bool read_arrays(struct far *far, struct state *state, struct message *message)
{
  struct state_group group[STATE_GROUPS];
  state_groups(state, group);
  bool ok = true;
  for (int g = 0; ok && g < STATE_GROUPS; g++)
    for (size_t f = 0; ok && f < group[g].fields && checkpoint_has_group(&group[g]); f++) {
      const struct state_field *field = &group[g].field[f];
      const uint64_t dims[2] = {group[g].rows, 3};
      void *rows = malloc(((size_t)group[g].rows + 1) * 24);
      ok = rows
               ? far_read(far, "state", field->name, FAR_ALL, field->integer ? FAR_INTEGER : FAR_REAL, 2, dims, rows) ||
                     far_fail(far, message,
                              "damaged checkpoint: its positions or velocities cannot be read or fail their check")
               : message_no_memory(message, "%s: out of memory", far->apart.path);
      if (ok)
        state_field_set(&group[g], field, rows);
      free(rows);
    }
  return ok;
}

/* Whether it is the state that was written, and a state at all: a file that somebody made up fits its checksums too. */
static bool is_state(const struct state *state, const struct checkpoint_summary *summary, int32_t *next,
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

bool checkpoint_read_state(struct far *far, const struct checkpoint_summary *summary, struct state *state,
                           int32_t *next, struct message *message)
{
  if (!read_arrays(far, state, message))
    return false;
  checkpoint_take_numbers(state, &summary->numbers);
  return is_state(state, summary, next, far->apart.path, message);
}
