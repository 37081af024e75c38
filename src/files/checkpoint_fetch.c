/* Checkpoints for a model: a process of its own reads them (apart.h), this one checks what it is handed. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files/apart.h"
#include "files/checkpoint_parts.h"
#include "files/structure.h"

/* What is asked of a file. The process apart has a copy of it all. */
struct wish {
  const char *path;
  const struct model *model; /* NULL: only the summary */
  const struct state *state;
  const struct observe_block *blocks;
  size_t block_count;
};

#define SAME "; they must be equal"

static bool fits_vertices(hid_t file, const char *path, const struct model *m, struct message *message)
{
  const hsize_t rows[1] = {m->vertices};
  struct message why = {"its masses cannot be read"};
  hid_t group = h5_open_group(file, "structure");
  const bool same = group >= 0 && structure_same_bonds(group, m);
  double *mass = malloc(((size_t)m->vertices + 1) * sizeof *mass);
  const bool fits = same && mass && h5_array_read(group, "mass", H5T_NATIVE_DOUBLE, 1, rows, mass) &&
                    !structure_masses_differ(mass, m->vertices, m, &why);
  free(mass);
  h5_close(group);
  if (!same)
    return message_set(message, "%s: its bonds are not the scene's (other fibers, or a damaged file)", path);
  return fits || message_set(message, "%s: %s", path, why.text);
}

static bool fits_model(hid_t file, const char *path, const struct checkpoint_summary *s, const struct model *m,
                       struct message *message)
{
  const int *cells = m->box.cells;
  if (memcmp(s->cells, cells, sizeof s->cells) != 0)
    return message_set(message, "%s: its box is %d x %d x %d cells, the scene's %d x %d x %d" SAME, path, s->cells[0],
                       s->cells[1], s->cells[2], cells[0], cells[1], cells[2]);
  if (s->particles != m->solvent.particles)
    return message_set(message, "%s: it holds %u solvent particles, the scene %u" SAME, path, s->particles,
                       m->solvent.particles);
  if (s->vertices != m->vertices)
    return message_set(message, "%s: it holds %u fiber vertices, the scene %u" SAME, path, s->vertices, m->vertices);
  if (s->dumbbells != m->dumbbells.pairs)
    return message_set(message, "%s: it holds %u dumbbells, the scene %u" SAME, path, s->dumbbells, m->dumbbells.pairs);
  if ((s->wall_rows > 0) != model_has_walls(m))
    return message_set(message, "%s: it is of a box %s walls, the scene's box has %s", path,
                       s->wall_rows > 0 ? "between" : "without", s->wall_rows > 0 ? "none" : "walls");
  if ((s->beads > 0) != model_has_bead(m))
    return message_set(message, "%s: it is of a solvent %s bead, the scene has %s", path,
                       s->beads > 0 ? "around a" : "without a", s->beads > 0 ? "none" : "one");
  return fits_vertices(file, path, m, message);
}

/* Earlier checkpoints hold no settings; they are taken to be the scene's, or 0 if there was no such setting. */
static bool same_setting(hid_t group, const char *name, const char *path, const struct observe_block *block,
                         struct message *message)
{
  const hsize_t dims[1] = {1};
  const int64_t wanted = *(const int64_t *)block->data;
  int64_t stored = block->later ? 0 : wanted;
  if (group >= 0 && h5_has(group, name) && !h5_array_read(group, name, H5T_NATIVE_INT64, 1, dims, &stored))
    return message_set(message, "%s: damaged checkpoint: '%s' cannot be read", path, name);
  return stored == wanted ||
         message_set(message,
                     "observe.%s: %" PRId64 " in the scene, but %" PRId64 " in the run so far (%s), whose averages go "
                     "on; a resumed run keeps it",
                     name, wanted, stored, path);
}

/* Numbers of a block come into `data`, which has room for one more. */
static bool read_block(hid_t group, const char *path, const struct observe_block *block, void *data,
                       struct message *message)
{
  char name[256];
  const hsize_t dims[1] = {block->count};
  checkpoint_block_name(block, name, sizeof name);
  if (block->setting)
    return same_setting(group, name, path, block, message);
  if (block->later && group >= 0 && !h5_has(group, name)) {
    for (size_t k = 0; k < block->count; k++)
      ((double *)data)[k] = NAN;
    return true;
  }
  return (group >= 0 && h5_has(group, name) &&
          h5_array_read(group, name, checkpoint_block_type(block), 1, dims, data)) ||
         message_set(
             message,
             "%s: no memory of the observable '%s' in this size (damaged, or not sampled by this run so far: resume "
             "without it, or begin a run from this checkpoint with start.snapshot)",
             path, block->name);
}

static void serve_arrays(struct apart *link, hid_t file, const struct wish *wish)
{
  struct message message = {""};
  struct checkpoint_arrays from = {h5_open_group(file, "state"), wish->path};
  struct state_group group[STATE_GROUPS];
  state_groups(wish->state, group);
  for (int g = 0; g < STATE_GROUPS; g++)
    for (size_t f = 0; f < group[g].fields && checkpoint_has_group(&group[g]); f++) {
      const size_t bytes = (size_t)group[g].rows * 24;
      void *rows = malloc(bytes + 1);
      const bool ok = rows ? checkpoint_rows_of_file(&from, &group[g], &group[g].field[f], rows, &message)
                           : message_set(&message, "%s: out of memory", wish->path);
      apart_put_verdict(link, ok ? 0 : 1, &message);
      if (ok)
        apart_put(link, rows, bytes);
      free(rows);
      if (!ok)
        return;
    }
}

static void serve_blocks(struct apart *link, hid_t file, const struct wish *wish)
{
  hid_t group = h5_open_group(file, "observers");
  for (size_t b = 0; b < wish->block_count; b++) {
    const struct observe_block *block = &wish->blocks[b];
    struct message message = {""};
    void *data = malloc((block->count + 1) * sizeof(double));
    const bool ok = data ? read_block(group, wish->path, block, data, &message)
                         : message_set(&message, "%s: out of memory", wish->path);
    apart_put_verdict(link, ok ? 0 : 1, &message);
    if (ok && !block->setting)
      apart_put(link, data, block->count * sizeof(double));
    free(data);
    if (!ok)
      return;
  }
}

static void serve(struct apart *link, void *context)
{
  const struct wish *wish = context;
  struct checkpoint_summary summary;
  struct message message = {""};
  enum h5_trouble trouble;
  bool sealed;
  unsigned failures;
  hid_t file = h5_open(wish->path, false, &sealed, &trouble, &message);
  apart_shut();
  h5_watch(&failures);
  const bool ok =
      file >= 0 && checkpoint_find(file, wish->path, sealed, &summary, &message) &&
      (!wish->model || fits_model(file, wish->path, &summary, wish->model, &message)) &&
      (failures == 0 || message_set(&message, "%s: damaged checkpoint: HDF5 cannot read some part of it", wish->path));
  apart_put_verdict(link, ok ? 0 : 1, &message);
  if (!ok || !apart_put(link, &summary, sizeof summary) || !wish->model)
    return;
  serve_arrays(link, file, wish);
  serve_blocks(link, file, wish);
}

static bool get_rows(void *from, const struct state_group *group, const struct state_field *field, void *rows,
                     struct message *message)
{
  struct apart *apart = from;
  (void)field;
  return apart_get_verdict(apart, message) == 0 &&
         (apart_get(apart, rows, (size_t)group->rows * 24) || apart_lost(apart, message));
}

static bool get_blocks(struct apart *apart, const struct observe_block *blocks, size_t count, struct message *message)
{
  bool ok = true;
  for (size_t b = 0; ok && b < count; b++) {
    ok = apart_get_verdict(apart, message) == 0;
    if (ok && !blocks[b].setting && blocks[b].count > 0)
      ok = apart_get(apart, blocks[b].data, blocks[b].count * sizeof(double)) || apart_lost(apart, message);
  }
  return ok;
}

static bool get_summary(struct apart *apart, struct checkpoint_summary *summary, struct message *message)
{
  if (apart_get_verdict(apart, message) != 0)
    return false;
  if (!apart_get(apart, summary, sizeof *summary))
    return apart_lost(apart, message);
  summary->head.version[sizeof summary->head.version - 1] = '\0';
  return true;
}

bool checkpoint_look(const char *path, struct checkpoint_summary *summary, struct message *message)
{
  struct wish wish = {.path = path};
  struct apart apart;
  if (!apart_start(&apart, path, serve, &wish, message))
    return false;
  const bool ok = get_summary(&apart, summary, message);
  apart_end(&apart);
  return ok;
}

bool checkpoint_fetch(const char *path, const struct model *model, struct checkpoint_summary *summary,
                      struct state *state, const struct observe_block *blocks, size_t block_count,
                      struct message *message)
{
  struct wish wish = {path, model, state, blocks, block_count};
  struct apart apart;
  if (!apart_start(&apart, path, serve, &wish, message))
    return false;
  const bool ok = get_summary(&apart, summary, message) &&
                  checkpoint_each_array(state, get_rows, &apart, path, message) &&
                  get_blocks(&apart, blocks, block_count, message);
  apart_end(&apart);
  if (!ok)
    return false;
  checkpoint_take_numbers(state, &summary->numbers);
  return checkpoint_check(state, summary, model->next, path, message);
}

bool checkpoint_read(const char *path, const struct model *model, struct checkpoint_head *head, struct state *state,
                     const struct observe_block *blocks, size_t block_count, struct message *message)
{
  struct checkpoint_summary summary;
  if (!checkpoint_fetch(path, model, &summary, state, blocks, block_count, message))
    return false;
  *head = summary.head;
  return true;
}
